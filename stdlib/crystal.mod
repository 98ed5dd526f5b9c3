//! Crystalline robots: cubes that expand and shrink along each axis by themselves.

/// A cube of the kinodynamic-reconfiguration paper: unit mass, unit force, sizes from one half to one.
///
/// In its units: size 1 is 100 mm, force 1 moves mass 1 with an acceleration of 10 m/s^2, speed 1 is one cube in
/// the unit of time.
cell ExpandingCube { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 1m/s }
