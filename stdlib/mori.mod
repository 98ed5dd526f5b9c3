//! Mori: modular origami of triangular panels, joined along their edges; and panels of other forms with Mori's edges.

/// An edge of a panel. The joint lives in the bond: two panels turn about the edge that they share.
///
/// A positive angle folds towards the back of the panels, as the faces of a convex shape do whose
/// outside is the panels' front. The range is that of equations 1 and 2 of the origami-folding paper: panels of
/// thickness d on a hinge of radius r come no nearer than the angle a with sin(a / 2) = d / (2 * r). With
/// r = d that is 60 degrees between them, 120 degrees from flat.
///
/// The paper states no speed and no torque. The torque is what its Figure 4 shows, rounded up: Mori folds a quadruped of 18
/// panels, which takes 0.096 N·m where all weigh 26 g (`fold(quadruped18(edge: 80mm), gravity: on)`). Speed and
/// acceleration are assumptions: full speed after an eighth of a second.
connector Edge {
  mates Edge
  turns 1
  hinge(axis: Y, range: -120deg..120deg, max_speed: 90deg/s, max_accel: 720deg/s^2, max_torque: 0.1N*m)
}

/// A triangular panel of side `side`, drawn flat with its front up and its first edge towards -y.
///
/// Side, thickness and mass are those of the origami-folding paper, whose passive panels weigh 8 g. The edges are bevelled
/// by 30 degrees on both sides, so that two panels close up to 60 degrees between them, as on the paper's hinges whose
/// radius is the thickness.
module Mori(side: Length = 80mm, thickness: Length = 6mm, weight: Mass = 26g) {
  let apothem = side / (2 * sqrt(3))

  // A tenth of a millimetre inside the edges, so that panels side by side do not meet.
  let middle = apothem - 0.1mm

  // Where the bevel ends: half the thickness above the middle, at 30 degrees.
  let outside = middle - thickness / 2 * sqrt(3)

  require outside > 0mm, "the panel is too thick for its side: the bevels meet"

  mass weight

  // Drawn, and weighed, as it lies flat; judged with its bevels.
  link panel = prism(
    [[2 * middle * cos(a), 2 * middle * sin(a), 0mm] for a in [-150deg, -30deg, 90deg]],
    height: thickness,
  )
    collides hull(
      [[2 * middle * cos(a), 2 * middle * sin(a), 0mm] for a in [-150deg, -30deg, 90deg]]
        ++ [[2 * outside * cos(a), 2 * outside * sin(a), z]
          for a in [-150deg, -30deg, 90deg] for z in [-thickness / 2, thickness / 2]],
    )

  for i in 0..3 {
    port edge[i] : Edge on panel
      at [apothem * cos(120deg * i - 90deg), apothem * sin(120deg * i - 90deg), 0mm]
      facing [cos(120deg * i - 90deg), sin(120deg * i - 90deg), 0] up +Z
  }
}

/// A triangular panel with sides of one's own, in millimetres or metres; otherwise as Mori, drawn flat with
/// its front up, about the middle of its corners, its first side towards -y.
///
/// `fold` makes these to measure: each face of the shape becomes a panel with its sides, so that spheres,
/// tori and any other surface of triangles can be folded. The motors of a panel weigh the same whatever its
/// size, its plate goes with its area; a panel with sides of 80 mm weighs as much as a Mori.
///
/// Example:
/// ```modl
/// use std.mori.Panel
/// print(mass(Panel()), mass(Panel(sides: [60mm, 80mm, 100mm])))
/// ```
module Panel(
  sides: List<Length> = [80mm, 80mm, 80mm],
  thickness: Length = 6mm,
  motors: Mass = 18g,
  plate: Quantity<kg/m^2> = 8g / (sqrt(3) / 4 * (80mm)^2),
) {
  require len(sides) == 3, "a panel has three sides"
  require min(sides) > 0mm and 2 * max(sides) < sum(sides), "no triangle has such sides"

  // The first side along x, the third corner above it.
  let foot = (sides[0]^2 + sides[2]^2 - sides[1]^2) / (2 * sides[0])
  let top = sqrt(max(sides[2]^2 - foot^2, 0mm^2))
  let middle: Vec3<Length> = [(sides[0] + foot) / 3, top / 3, 0mm]
  let corner: List<Vec3<Length>> =
    [-middle, [sides[0] - middle[0], -middle[1], 0mm], [foot - middle[0], top - middle[1], 0mm]]

  // The circle that touches all sides: what is drawn inside the sides is smaller about its centre.
  let area = sides[0] * top / 2
  let radius = 2 * area / sum(sides)
  let centre = (corner[0] * sides[1] + corner[1] * sides[2] + corner[2] * sides[0]) / sum(sides)

  // A tenth of a millimetre inside the edges, so that panels side by side do not meet; and where the bevel ends.
  let inside = radius - 0.1mm
  let outside = inside - thickness / 2 * sqrt(3)

  require outside > 0mm, "the panel is too thick for its sides: the bevels meet"

  mass motors + plate * area

  let inner = [centre + (c - centre) * (inside / radius) for c in corner]
  let outer = [centre + (c - centre) * (outside / radius) for c in corner]

  link panel = prism(inner, height: thickness)
    collides hull(inner ++ [c + [0mm, 0mm, z] for c in outer for z in [-thickness / 2, thickness / 2]])

  for i in 0..3 {
    let along = (corner[(i + 1) % 3] - corner[i]) / sides[i]
    port edge[i] : Edge on panel
      at (corner[i] + corner[(i + 1) % 3]) / 2
      facing [along[1], -along[0], 0] up +Z
  }
}

// The outline whose sides are moved inwards by a distance. Seen from the front, what a side has on its left is inside.
fn _inset(corners: List<Vec3<Length>>, by: Length) -> List<Vec3<Length>> = {
  let n = len(corners)
  let along = [(corners[(k + 1) % n] - corners[k]) / norm(corners[(k + 1) % n] - corners[k]) for k in 0..n]
  let left: List<Vec3<Number>> = [[-along[k][1], along[k][0], 0] for k in 0..n]
  [corners[k] + (left[(k + n - 1) % n] + left[k]) * (by / (1 + dot(left[(k + n - 1) % n], left[k]))) for k in 0..n]
}

// The length of the shortest side of an outline, each measured along the same side of another outline, which may be
// turned round where that side has vanished.
fn _shortest(corners: List<Vec3<Length>>, of: List<Vec3<Length>>) -> Length = {
  let n = len(of)
  let along = [(of[(k + 1) % n] - of[k]) / norm(of[(k + 1) % n] - of[k]) for k in 0..n]
  min([
    (corners[(k + 1) % n] - corners[k])[0] * along[k][0] + (corners[(k + 1) % n] - corners[k])[1] * along[k][1]
    for k in 0..n])
}

/// The corners of a regular polygon about the origin, counterclockwise, the first side towards -y.
///
/// Example:
/// ```modl
/// use std.mori.{Polygon, regular}
/// print(mass(Polygon(corners: regular(6, side: 80mm))))
/// ```
fn regular(sides: Int, side: Length) -> List<Vec3<Length>> = {
  let radius = side / (2 * sin(180deg / sides))
  [
    [radius * cos(360deg * (k - 0.5) / sides - 90deg), radius * sin(360deg * (k - 0.5) / sides - 90deg), 0mm]
    for k in 0..sides]
}

/// A panel that is a convex polygon, with corners of one's own, drawn with its front up; otherwise as Mori.
///
/// Its corners are in the plane z = 0, counterclockwise from above; side `k` runs from corner `k` to the next. `fold` makes
/// these to measure: each face of the shape becomes a panel with its corners, so that cubes, soccer balls and any other
/// surface of flat convex faces can be folded, of triangles too.
///
/// An assumption, for no source states such panels: a motor weighs a third of those of a Mori, and each side has one; the
/// plate goes with its area, as heavy for the area as Mori's passive panels. Edges and bevels are Mori's.
///
/// Example:
/// ```modl
/// use std.mori.{Polygon, regular}
/// use std.shapes.cube
/// print(mass(Polygon()), fold(cube(edge: 80mm), module: Polygon).layouts)
/// ```
module Polygon(
  corners: List<Vec3<Length>> = regular(4, side: 80mm),
  thickness: Length = 6mm,
  motor: Mass = 6g,
  plate: Quantity<kg/m^2> = 8g / (sqrt(3) / 4 * (80mm)^2),
) {
  require len(corners) >= 3, "a panel has at least three corners"
  let n = len(corners)
  require max([abs(c[2]) for c in corners]) == 0mm, "the corners of a panel are in the plane z = 0"
  require min([norm(corners[(k + 1) % n] - corners[k]) for k in 0..n]) > 0mm, "a panel names each corner once"
  let area = sum([corners[k][0] * corners[(k + 1) % n][1] - corners[k][1] * corners[(k + 1) % n][0] for k in 0..n]) / 2
  require area > 0mm^2, "the corners of a panel are counterclockwise from above"

  // A tenth of a millimetre inside the edges, so that panels side by side do not meet. The bevel ends half the thickness
  // above the middle, at 30 degrees.
  let inner = _inset(corners, 0.1mm)
  let outer = _inset(corners, 0.1mm + thickness / 2 * sqrt(3))
  require _shortest(outer, corners) > 0mm, "the panel is too thick for its sides: the bevels meet"

  mass motor * n + plate * area

  link panel = prism(inner, height: thickness)
    collides hull(inner ++ [c + [0mm, 0mm, z] for c in outer for z in [-thickness / 2, thickness / 2]])

  for i in 0..n {
    let along = (corners[(i + 1) % n] - corners[i]) / norm(corners[(i + 1) % n] - corners[i])
    port edge[i] : Edge on panel
      at (corners[i] + corners[(i + 1) % n]) / 2
      facing [along[1], -along[0], 0] up +Z
  }
}

/// A regular panel of so many equal sides, for shapes whose faces are as it is; otherwise as Polygon.
///
/// Example:
/// ```modl
/// use std.mori.{Mori, Regular}
/// use std.shapes.truncated_tetrahedron
/// print(fold(truncated_tetrahedron(edge: 80mm), module: [Mori, Regular(6)]).layouts)
/// ```
module Regular(count: Int = 4, side: Length = 80mm, thickness: Length = 6mm, motor: Mass = 6g) {
  require count >= 3, "a panel has at least three sides"
  require side > 0mm, "a panel has sides of some length"
  let corner = regular(count, side: side)
  let inner = _inset(corner, 0.1mm)
  let outer = _inset(corner, 0.1mm + thickness / 2 * sqrt(3))
  require _shortest(outer, corner) > 0mm, "the panel is too thick for its side: the bevels meet"

  // The plate is as heavy for its area as Mori's passive panels.
  let area = count * side^2 / (4 * tan(180deg / count))
  mass motor * count + 8g * area / (sqrt(3) / 4 * (80mm)^2)

  link panel = prism(inner, height: thickness)
    collides hull(inner ++ [c + [0mm, 0mm, z] for c in outer for z in [-thickness / 2, thickness / 2]])

  for i in 0..count {
    let out = 360deg * i / count - 90deg
    port edge[i] : Edge on panel
      at [side / (2 * tan(180deg / count)) * cos(out), side / (2 * tan(180deg / count)) * sin(out), 0mm]
      facing [cos(out), sin(out), 0] up +Z
  }
}
