//! Crystalline robots: cubes that expand and shrink along each axis by themselves.

/// A cube of the kinodynamic-reconfiguration paper: unit mass, unit force, sizes from one half to one.
///
/// In its units: size 1 is 100 mm, force 1 moves mass 1 with an acceleration of 10 m/s^2, speed 1 is one cube in
/// the unit of time.
cell ExpandingCube { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 1m/s }

/// The same cube with a connector in the middle of each face, by which cells hold each other, and nothing else: cells
/// do not slide along each other while they hold on, as those of the robots Crystalline and Telecube do not.
///
/// Blocks of 2 × 2 × 2 of them change places, as `squeeze` plans it.
///
/// Example:
/// ```modl
/// use std.crystal.DockedCube
/// lattice Bar of DockedCube = enlarged(row(3))
/// lattice Corner of DockedCube = enlarged(cells("""
///   #.
///   ##
/// """))
/// let p = squeeze(Bar, Corner)
/// print(p.duration, p.method, verify(p).ok)
/// ```
cell DockedCube { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 1m/s  slides false }
