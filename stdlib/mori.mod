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
/// Side, thickness and mass are those of the origami-folding paper; speed and torque of the edges
/// are round figures, for the paper states none.
module Mori(side: Length = 80mm, thickness: Length = 6mm) {
  let apothem = side / (2 * sqrt(3))

  mass 26g

  // A tenth of a millimetre inside the edges, so that panels side by side do not meet.
  link panel = prism(
    [
      [2 * (apothem - 0.1mm) * cos(a), 2 * (apothem - 0.1mm) * sin(a), 0mm]
      for a in [-150deg, -30deg, 90deg]
    ],
    height: thickness,
  )

  for i in 0..3 {
    port edge[i] : Edge on panel
      at [apothem * cos(120deg * i - 90deg), apothem * sin(120deg * i - 90deg), 0mm]
      facing [cos(120deg * i - 90deg), sin(120deg * i - 90deg), 0] up +Z
  }
}
