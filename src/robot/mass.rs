//! Mass, centre of mass and inertia of links, from shapes and density.

use crate::geometry::{Placed, Unsound, Vec3, volume};

/// The mass properties of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// The mass of the body, kg.
    pub mass: f64,
    /// The centre of mass in the frame that the shapes are placed in, m.
    pub com: Vec3,
    /// The inertia about the centre of mass, kg·m²: the entries xx, yy, zz, xy, xz, yz of the symmetric matrix, along
    /// the axes of the frame that the shapes are placed in.
    pub inertia: [f64; 6],
}

/// Returns the mass properties of shapes that fill space with `density` (kg/m³), in the frame that they are placed in.
/// If shapes overlap, the overlap counts as often as shapes share it.
///
/// # Errors
/// The first fault of a shape, or [`Unsound::Empty`] if there is none.
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

/// Splits a module's mass (kg) over its links, each given by its shapes and its own mass (kg), `None` if that is not
/// stated. Links with a stated mass take theirs from the whole, the others share the rest by volume, at one density.
/// Returns the mass properties of every link, in the order given and in the frame of its shapes; `None` if the stated
/// masses exceed the whole. If all links state their masses, a rest is in none of them.
///
/// # Errors
/// The first fault of a shape, or [`Unsound::Empty`] for a link without shapes.
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
