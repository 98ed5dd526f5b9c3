//! Meshes to fold, morph to and learn from: the convex deltahedra, tubes, spheres, and a few shapes
//! with a purpose.
//!
//! All are centred, except where their documentation says otherwise; faces are listed
//! counterclockwise from outside.

// Points given as multiples of a length.
fn _scaled(points: List<Vec3<Number>>, by: Length) -> List<Vec3<Length>> = [p * by for p in points]

// `n` points on a circle about the z axis, the first at the angle `from`.
fn _ring(n: Int, radius: Length, z: Length, from: Angle = 0deg) -> List<Vec3<Length>> =
  [[radius * cos(360deg * i / n + from), radius * sin(360deg * i / n + from), z] for i in 0..n]

// The golden ratio.
let _golden = (1 + sqrt(5)) / 2

// The two tips of a bipyramid.
fn _tips(z: Length) -> List<Vec3<Length>> = [[0m, 0m, z], [0m, 0m, -z]]

/// Four triangles.
///
/// Example:
/// ```modl
/// use std.shapes.tetrahedron
/// print(faces(tetrahedron(edge: 80mm)))
/// ```
fn tetrahedron(edge: Length) -> Mesh = polyhedron(
  _scaled([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], edge / sqrt(8)),
  [
    [0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2],
  ],
)

/// Six triangles: two tetrahedra, face on face.
///
/// Example:
/// ```modl
/// use std.shapes.triangular_bipyramid
/// print(faces(triangular_bipyramid(edge: 80mm)))
/// ```
fn triangular_bipyramid(edge: Length) -> Mesh = polyhedron(
  _ring(3, edge / sqrt(3), 0m) ++ _tips(edge * sqrt(2 / 3)),
  [
    [0, 1, 3], [0, 4, 1], [0, 3, 2], [0, 2, 4], [1, 2, 3], [1, 4, 2],
  ],
)

/// Eight triangles.
///
/// Example:
/// ```modl
/// use std.shapes.octahedron
/// print(faces(octahedron(edge: 80mm)))
/// ```
fn octahedron(edge: Length) -> Mesh = polyhedron(
  _scaled([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], edge / sqrt(2)),
  [
    [0, 2, 4], [0, 5, 2], [0, 4, 3], [0, 3, 5], [1, 4, 2], [1, 2, 5], [1, 3, 4], [1, 5, 3],
  ],
)

/// Eight triangles: three tetrahedra about a common edge. As many as an octahedron has, but re-entrant.
///
/// Example:
/// ```modl
/// use std.shapes.boat
/// print(faces(boat(edge: 80mm)))
/// ```
fn boat(edge: Length) -> Mesh = polyhedron(
  [[0m, 0m, edge / 2], [0m, 0m, -edge / 2]]
    ++ [[edge * sqrt(0.75) * cos(i * acos(1 / 3)), edge * sqrt(0.75) * sin(i * acos(1 / 3)), 0m] for i in 0..4],
  [
    [2, 0, 1], [0, 2, 3], [0, 3, 4], [0, 4, 5], [1, 3, 2], [1, 4, 3], [1, 5, 4], [5, 1, 0],
  ],
)

/// Ten triangles: two pyramids on a pentagon.
///
/// Example:
/// ```modl
/// use std.shapes.pentagonal_bipyramid
/// print(faces(pentagonal_bipyramid(edge: 80mm)))
/// ```
fn pentagonal_bipyramid(edge: Length) -> Mesh = polyhedron(
  _ring(5, edge / (2 * sin(36deg)), 0m) ++ _tips(edge * sqrt(1 - (1 / (2 * sin(36deg)))^2)),
  [
    [0, 1, 5], [0, 6, 1], [0, 5, 4], [0, 4, 6], [1, 2, 5], [1, 6, 2], [2, 3, 5], [2, 6, 3],
    [3, 4, 5], [3, 6, 4],
  ],
)

/// Twelve triangles. Its coordinates are roots of a cubic.
///
/// Example:
/// ```modl
/// use std.shapes.snub_disphenoid
/// print(faces(snub_disphenoid(edge: 80mm)))
/// ```
fn snub_disphenoid(edge: Length) -> Mesh = polyhedron(
  _scaled([
    [0.644584273224, 0.205561565853, 0],
    [-0.644584273224, 0.205561565853, 0],
    [0, -0.205561565853, 0.644584273224],
    [0, -0.205561565853, -0.644584273224],
    [0.5, -0.783930924233, 0],
    [-0.5, -0.783930924233, 0],
    [0, 0.783930924233, 0.5],
    [0, 0.783930924233, -0.5],
  ], edge),
  [
    [0, 2, 4], [6, 2, 0], [4, 3, 0], [0, 3, 7], [7, 6, 0], [5, 2, 1], [1, 2, 6], [1, 3, 5],
    [7, 3, 1], [1, 6, 7], [5, 4, 2], [3, 4, 5],
  ],
)

/// Fourteen triangles: a triangular prism with a pyramid on each side.
///
/// Example:
/// ```modl
/// use std.shapes.triaugmented_prism
/// print(faces(triaugmented_prism(edge: 80mm)))
/// ```
fn triaugmented_prism(edge: Length) -> Mesh = polyhedron(
  _ring(3, edge / sqrt(3), -edge / 2) ++ _ring(3, edge / sqrt(3), edge / 2)
    ++ _ring(3, edge * (1 / sqrt(12) + 1 / sqrt(2)), 0m, from: 60deg),
  [
    [0, 2, 1], [0, 1, 6], [0, 8, 2], [0, 6, 3], [0, 3, 8], [1, 2, 7], [1, 4, 6], [1, 7, 4],
    [2, 5, 7], [2, 8, 5], [3, 4, 5], [3, 6, 4], [3, 5, 8], [4, 7, 5],
  ],
)

/// Sixteen triangles: a square antiprism with a pyramid on either end.
///
/// Example:
/// ```modl
/// use std.shapes.gyroelongated_bipyramid
/// print(faces(gyroelongated_bipyramid(edge: 80mm)))
/// ```
fn gyroelongated_bipyramid(edge: Length) -> Mesh = polyhedron(
  _ring(4, edge / sqrt(2), -edge / (2 * sqrt(sqrt(2)))) ++
    _ring(4, edge / sqrt(2), edge / (2 * sqrt(sqrt(2))), from: 45deg)
    ++ _tips(-edge / sqrt(2) - edge / (2 * sqrt(sqrt(2)))),
  [
    [0, 1, 4], [0, 8, 1], [0, 7, 3], [0, 3, 8], [0, 4, 7], [1, 2, 5], [1, 8, 2], [1, 5, 4],
    [2, 3, 6], [2, 8, 3], [2, 6, 5], [3, 7, 6], [4, 5, 9], [4, 9, 7], [5, 6, 9], [6, 7, 9],
  ],
)

/// Twenty triangles.
///
/// Example:
/// ```modl
/// use std.shapes.icosahedron
/// print(faces(icosahedron(edge: 80mm)))
/// ```
fn icosahedron(edge: Length) -> Mesh = polyhedron(
  _scaled(
    [[0, a, b * _golden] for a in [1, -1] for b in [1, -1]]
      ++ [[a, b * _golden, 0] for a in [1, -1] for b in [1, -1]]
      ++ [[b * _golden, 0, a] for a in [1, -1] for b in [1, -1]],
    edge / 2,
  ),
  [
    [0, 2, 8], [0, 9, 2], [0, 4, 6], [0, 8, 4], [0, 6, 9], [1, 10, 3], [1, 3, 11], [1, 6, 4],
    [1, 4, 10], [1, 11, 6], [2, 7, 5], [2, 5, 8], [2, 9, 7], [3, 5, 7], [3, 10, 5], [3, 7, 11],
    [4, 8, 10], [5, 10, 8], [6, 11, 9], [7, 9, 11],
  ],
)

/// Twenty-four triangles: an octahedron with a tetrahedron on each face; two large tetrahedra that
/// pass through each other. Its edges along the octahedron's are re-entrant.
///
/// Example:
/// ```modl
/// use std.shapes.stella_octangula
/// print(faces(stella_octangula(edge: 80mm)))
/// ```
fn stella_octangula(edge: Length) -> Mesh = {
  let octahedron = [
    [0, 2, 4], [0, 5, 2], [0, 4, 3], [0, 3, 5], [1, 4, 2], [1, 2, 5], [1, 3, 4], [1, 5, 3],
  ]
  polyhedron(
    _scaled(
      [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1],
        [1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1], [-1, 1, 1], [-1, 1, -1], [-1, -1, 1], [-1, -1, -1]],
      edge / sqrt(2),
    ),
    [[octahedron[i][k], octahedron[i][(k + 1) % 3], 6 + i] for i in 0..8 for k in 0..3],
  )
}

/// An open tube of equal triangles: `rings` bands of twice as many triangles as it has sides, one
/// above the other from z = 0 up.
///
/// Example:
/// ```modl
/// use std.shapes.tube
/// print(faces(tube(sides: 6, rings: 3, edge: 80mm)))
/// ```
fn tube(sides: Int, rings: Int, edge: Length) -> Mesh = {
  let radius = edge / (2 * sin(180deg / sides))
  // Each ring of vertices is turned by half a side against the one below.
  let height = sqrt(edge^2 - (2 * radius * sin(90deg / sides))^2)
  let n = sides
  polyhedron(
    [
      [
        radius * cos(360deg * i / n + (k % 2) * 180deg / n),
        radius * sin(360deg * i / n + (k % 2) * 180deg / n),
        k * height
      ]
      for k in 0..rings + 1 for i in 0..n],
    [
      if s == 0 {
        [k * n + i, k * n + (i + 1) % n, (k + 1) * n + (i + k % 2) % n]
      } else {
        [k * n + i, (k + 1) * n + (i + k % 2) % n, (k + 1) * n + (i + k % 2 + n - 1) % n]
      }
      for k in 0..rings for i in 0..n for s in 0..2],
  )
}

/// A geodesic sphere: an icosahedron with its faces subdivided, blown up to a sphere.
///
/// Its triangles are not quite equal; `subdivided` alone keeps them so.
///
/// Example:
/// ```modl
/// use std.shapes.geodesic
/// print(faces(geodesic(radius: 200mm, parts: 3)))
/// ```
fn geodesic(radius: Length, parts: Int) -> Mesh =
  on_sphere(subdivided(icosahedron(edge: radius), parts), radius)

/// A torus about the z axis: `around` times `across` quadrangles, each cut into two triangles.
///
/// Example:
/// ```modl
/// use std.shapes.torus
/// print(faces(torus(radius: 300mm, tube: 100mm, around: 12, across: 6)))
/// ```
fn torus(radius: Length, tube: Length, around: Int, across: Int) -> Mesh = {
  let n = across
  polyhedron(
    [[(radius + tube * cos(360deg * j / n)) * cos(360deg * i / around),
      (radius + tube * cos(360deg * j / n)) * sin(360deg * i / around),
      tube * sin(360deg * j / n)]
      for i in 0..around for j in 0..n],
    [
      if s == 0 {
        [i * n + j, (i + 1) % around * n + j, (i + 1) % around * n + (j + 1) % n]
      } else {
        [i * n + j, (i + 1) % around * n + (j + 1) % n, i * n + (j + 1) % n]
      }
      for i in 0..around for j in 0..n for s in 0..2],
  )
}

/// A cube, of six squares.
///
/// Example:
/// ```modl
/// use std.shapes.cube
/// print(faces(cube(edge: 2m)))
/// ```
fn cube(edge: Length) -> Mesh = polyhedron(
  _scaled([[x, y, z] for z in [-1, 1] for y in [-1, 1] for x in [-1, 1]], edge / 2),
  [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
)

// The points that follow from one by all signs of its coordinates, for each of its three cyclic orders.
fn _round(p: Vec3<Number>) -> List<Vec3<Number>> = {
  let signs: List<List<Number>> = [if p[k] == 0 { [1] } else { [1, -1] } for k in 0..3]
  [[a * p[-r % 3], b * p[(1 - r) % 3], c * p[(2 - r) % 3]]
    for r in 0..3 for a in signs[-r % 3] for b in signs[(1 - r) % 3] for c in signs[(2 - r) % 3]]
}

/// Twelve regular pentagons.
///
/// Example:
/// ```modl
/// use std.shapes.dodecahedron
/// print(faces(dodecahedron(edge: 80mm)))
/// ```
fn dodecahedron(edge: Length) -> Mesh = polyhedron(
  _scaled(
    _round([0, 1 / _golden, _golden]) ++ [[a, b, c] for a in [1, -1] for b in [1, -1] for c in [1, -1]],
    edge * _golden / 2,
  ),
  [
    [0, 2, 14, 4, 12], [0, 12, 8, 10, 16], [0, 16, 6, 18, 2], [1, 3, 19, 7, 17], [1, 13, 5, 15, 3],
    [1, 17, 10, 8, 13], [2, 18, 11, 9, 14], [3, 15, 9, 11, 19], [4, 5, 13, 8, 12],
    [4, 14, 9, 15, 5], [6, 7, 19, 11, 18], [6, 16, 10, 17, 7],
  ],
)

/// Four triangles and four regular hexagons: a tetrahedron whose corners are cut off.
///
/// Example:
/// ```modl
/// use std.shapes.truncated_tetrahedron
/// print(faces(truncated_tetrahedron(edge: 80mm)))
/// ```
fn truncated_tetrahedron(edge: Length) -> Mesh = polyhedron(
  _scaled(
    [[s[0] * p[0], s[1] * p[1], s[2] * p[2]]
      for p in [[3, 1, 1], [1, 3, 1], [1, 1, 3]] for s in [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]],
    edge / sqrt(8),
  ),
  [
    [0, 1, 9, 10, 6, 4], [0, 4, 8], [0, 8, 11, 7, 5, 1], [1, 5, 9], [2, 3, 11, 8, 4, 6], [2, 6, 10],
    [2, 10, 9, 5, 7, 3], [3, 7, 11],
  ],
)

/// Eight triangles and six squares: a cube whose corners are cut off at the middles of its edges.
///
/// Example:
/// ```modl
/// use std.shapes.cuboctahedron
/// print(faces(cuboctahedron(edge: 80mm)))
/// ```
fn cuboctahedron(edge: Length) -> Mesh = polyhedron(
  _scaled(_round([0, 1, 1]), edge / sqrt(2)),
  [
    [0, 4, 8], [0, 6, 2, 4], [0, 8, 1, 10], [0, 10, 6], [1, 5, 3, 7], [1, 7, 10], [1, 8, 5],
    [2, 6, 11], [2, 9, 4], [2, 11, 3, 9], [3, 5, 9], [3, 11, 7], [4, 9, 5, 8], [6, 10, 7, 11],
  ],
)

/// Twelve regular pentagons and twenty regular hexagons: a soccer ball.
///
/// Example:
/// ```modl
/// use std.shapes.truncated_icosahedron
/// print(faces(truncated_icosahedron(edge: 80mm)))
/// ```
fn truncated_icosahedron(edge: Length) -> Mesh = polyhedron(
  _scaled(
    _round([0, 1, 3 * _golden]) ++ _round([1, 2 + _golden, 2 * _golden])
      ++ _round([_golden, 2, 2 * _golden + 1]),
    edge / 2,
  ),
  [
    [0, 2, 38, 22, 20, 36], [0, 36, 12, 16, 40], [0, 40, 24, 26, 42, 2], [1, 3, 43, 27, 25, 41],
    [1, 37, 21, 23, 39, 3], [1, 41, 17, 13, 37], [2, 42, 18, 14, 38], [3, 39, 15, 19, 43],
    [4, 5, 45, 29, 28, 44], [4, 44, 20, 22, 46], [4, 46, 30, 31, 47, 5], [5, 47, 23, 21, 45],
    [6, 7, 51, 35, 34, 50], [6, 48, 32, 33, 49, 7], [6, 50, 26, 24, 48], [7, 49, 25, 27, 51],
    [8, 10, 56, 16, 12, 52], [8, 52, 28, 29, 53], [8, 53, 13, 17, 57, 10], [9, 11, 59, 19, 15, 55],
    [9, 54, 14, 18, 58, 11], [9, 55, 31, 30, 54], [10, 57, 33, 32, 56], [11, 58, 34, 35, 59],
    [12, 36, 20, 44, 28, 52], [13, 53, 29, 45, 21, 37], [14, 54, 30, 46, 22, 38],
    [15, 39, 23, 47, 31, 55], [16, 56, 32, 48, 24, 40], [17, 41, 25, 49, 33, 57],
    [18, 42, 26, 50, 34, 58], [19, 59, 35, 51, 27, 43],
  ],
)

/// A Miura-ori, partly folded: rows times columns equal parallelograms, one border in the xy plane.
///
/// `along` and `across` are their sides, `sector` the acute angle between these. At a `fold` of zero it is flat, at 90
/// degrees all panels lie on each other. The formulas are those of Schenk and Guest, *Geometry of Miura-folded
/// metamaterials* (2013).
///
/// Example:
/// ```modl
/// use std.shapes.miura
/// print(faces(miura(rows: 3, columns: 4, along: 80mm, across: 80mm, sector: 60deg, fold: 45deg)))
/// ```
fn miura(rows: Int, columns: Int, along: Length, across: Length, sector: Angle, fold: Angle) -> Mesh = {
  let slope = sqrt(1 + (cos(fold) * tan(sector))^2)
  let height = along * sin(fold) * sin(sector)
  let pace = along * sqrt(1 - (sin(fold) * sin(sector))^2)
  let width = across * cos(fold) * tan(sector) / slope
  polyhedron(
    [[width * j, pace * i + (j % 2) * across / slope, (i % 2) * height] for i in 0..rows + 1 for j in 0..columns + 1],
    [
      [i * (columns + 1) + j, i * (columns + 1) + j + 1, (i + 1) * (columns + 1) + j + 1, (i + 1) * (columns + 1) + j]
      for i in 0..rows for j in 0..columns],
  )
}

/// An L: two square bars of the given length and width that share a corner, lying in the xy plane.
///
/// The corner of the L is at the origin; the bars are as high as wide, from z = 0 up.
///
/// Example:
/// ```modl
/// use std.shapes.ell
/// print(faces(ell(length: 3m, width: 1m)))
/// ```
fn ell(length: Length, width: Length) -> Mesh = {
  let outline = [[0m, 0m], [length, 0m], [length, width], [width, width], [width, length], [0m, length]]
  polyhedron(
    [[p[0], p[1], z] for z in [0m, width] for p in outline],
    [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11]] ++ [[i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6] for i in 0..6],
  )
}

/// A quadruped of eighteen triangles: a shell cut from an icosahedron, and four legs of two triangles.
///
/// It stands on the plane z = 0; its hips are splayed by 45 degrees, its knees bent by 20. It is open
/// below. Its faces have 108 spanning trees.
///
/// Example:
/// ```modl
/// use std.shapes.quadruped18
/// print(faces(quadruped18(edge: 80mm)))
/// ```
fn quadruped18(edge: Length) -> Mesh = polyhedron(
  _scaled([
    [-0.288675134595, -0.5, 1.42986478007],
    [-0.288675134595, 0.5, 1.42986478007],
    [0.57735026919, 0, 1.42986478007],
    [-0.467086179481, 0.809016994375, 0.495692421109],
    [0.934172358963, 0, 0.495692421109],
    [-0.467086179481, -0.809016994375, 0.495692421109],
    [0.467086179481, -0.809016994375, 0.852514510883],
    [-0.934172358963, 0, 0.852514510883],
    [0.467086179481, 0.809016994375, 0.852514510883],
    [-1.35416587795, -0.538244912745, 0.121831366208],
    [-1.02499222787, -1.4746218808, 0],
    [-1.35416587795, 0.538244912745, 0.121831366208],
    [-1.02499222787, 1.4746218808, 0],
    [1.14321670687, -0.903619594872, 0.121831366208],
    [1.78955612368, -0.150358367616, 0],
    [1.14321670687, 0.903619594872, 0.121831366208],
    [1.78955612368, 0.150358367616, 0],
  ], edge),
  [
    [2, 1, 0], [0, 1, 7], [6, 2, 0], [0, 5, 6], [7, 5, 0], [1, 2, 8],
    [1, 3, 7], [8, 3, 1], [6, 4, 2], [2, 4, 8], [5, 7, 9], [5, 9, 10],
    [7, 3, 11], [12, 11, 3], [4, 6, 13], [4, 13, 14], [8, 4, 15], [16, 15, 4],
  ],
)
