//! Mass, centre of mass and inertia of links, from shapes and density.

use crate::geometry::{Placed, Unsound, Vec3, volume};

/// A rigid body's mass (kg), centre of mass (m, in the frame that its shapes are placed in) and
/// inertia about that centre (kg·m²; xx, yy, zz, xy, xz, yz as entries of the symmetric matrix).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    pub mass: f64,
    pub com: Vec3,
    pub inertia: [f64; 6],
}

/// Of shapes that fill space with `density` (kg/m³). Where shapes overlap, the overlap counts twice.
/// Refuses a shape that encloses no volume.
pub fn of_shapes(shapes: &[Placed], density: f64) -> Result<Mass, Unsound> {
    let whole = volume::of_placed(shapes)?;
    let inertia = whole.inertia();
    let entries = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    Ok(Mass {
        mass: density * whole.volume,
        com: whole.centre,
        inertia: entries.map(|entry| density * inertia[entry]),
    })
}

/// Splits a module's mass over its links by volume: of uniform density, links with a mass of their
/// own (`stated`, kg) take it from the whole first. `None` where the stated masses exceed the whole.
pub fn split(links: &[(&[Placed], Option<f64>)], mass: f64) -> Result<Option<Vec<Mass>>, Unsound> {
    let unit: Vec<Mass> =
        links.iter().map(|(shapes, _)| of_shapes(shapes, 1.0)).collect::<Result<_, Unsound>>()?;
    let stated: f64 = links.iter().filter_map(|(_, m)| *m).sum();
    let open: f64 = unit.iter().zip(links).filter(|(_, (_, m))| m.is_none()).map(|(u, _)| u.mass).sum();
    if stated > mass {
        return Ok(None);
    }
    let density = if open > 0.0 { (mass - stated) / open } else { 0.0 };
    let scaled = |u: &Mass, m: Option<f64>| {
        let factor = m.map_or(density, |m| m / u.mass);
        Mass { mass: u.mass * factor, com: u.com, inertia: u.inertia.map(|i| i * factor) }
    };
    Ok(Some(unit.iter().zip(links).map(|(u, (_, m))| scaled(u, *m)).collect()))
}
