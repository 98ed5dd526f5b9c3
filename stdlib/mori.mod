//! Mori: modular origami of triangular panels, joined along their edges.

/// An edge of a panel. The joint lives in the bond: two panels turn about the edge that they share.
///
/// A positive angle folds towards the back of the panels, as the faces of a convex shape do whose
/// outside is the panels' front.
connector Edge {
  mates Edge
  turns 1
  hinge(axis: Y, range: -180deg..180deg, max_speed: 90deg/s, max_torque: 0.1N*m)
}

/// A triangular panel of side `side`, drawn flat with its front up and its first edge towards -y.
///
/// Side, thickness and mass are those of the origami-folding paper, whose passive panels weigh 8 g; speed and torque of the edges
/// are round figures, for the paper states none. The edges are bevelled on both sides, so that two
/// panels close up to 60 degrees between them: the paper's hinges leave as much room.
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
