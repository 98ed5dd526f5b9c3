//! Masses of robot descriptions, as a module can have them: centres within it, inertias of bodies that fit into it.

use super::urdf_reader::{Urdf, UrdfLink, UrdfShape};
use crate::formats::masses::{MASS_MIN, sound};
use crate::geometry::{Pose, Vec3};

/// The part of the greatest moment of inertia below which a product of inertia is rounding.
const PRODUCT: f64 = 1e-6;
/// The part of the greatest moment of inertia that a body within the module can have that one is made of which states more:
/// less than all of it, for rounding.
const WITHIN: f64 = 0.999;
/// The distance by which a centre of mass may be outside of the module's box, m: less than what a module may have.
const OUTSIDE: f64 = 5e-7;

/// The mass of a link, as a module can have it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LinkMass {
    /// The mass, kg.
    pub(super) mass: f64,
    /// The centre of mass in the link's frame, m; `None`: not stated.
    pub(super) centre: Option<Vec3>,
    /// The moments of inertia about it along the axes of the link, kg·m²; `None`: not stated.
    pub(super) moments: Option<[f64; 3]>,
    /// True if a ball of a point's size at the centre of mass makes room for it in the module.
    pub(super) needs_room: bool,
}

/// Returns the masses of all links and notes in words on what is not as stated. `poses`: the pose of each link in the
/// module's frame, all joints at zero.
pub(super) fn masses(urdf: &Urdf, poses: &[Pose]) -> (Vec<LinkMass>, Vec<String>) {
    let mut notes = Vec::new();
    let mut stated: Vec<LinkMass> = urdf.links.iter().map(|link| of_link(link, &mut notes)).collect();
    let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let mut widen = |p: Vec3| (low, high) = (low.inf(&p), high.sup(&p));
    for ((link, X), mass) in urdf.links.iter().zip(poses).zip(&stated) {
        let shapes = link.shapes.iter().flat_map(|(X_LS, shape)| corners(shape).map(move |p| X * X_LS * p));
        shapes.for_each(|p| widen(p.coords));
        if link.shapes.is_empty() {
            // A point stands for it, at its centre of mass.
            widen(X.transform_point(&mass.centre.unwrap_or_default().into()).coords);
        }
    }
    for ((link, X), mass) in urdf.links.iter().zip(poses).zip(&mut stated) {
        let Some(centre) = mass.centre else { continue };
        let centre = X.transform_point(&centre.into()).coords;
        let outside = (low - centre).sup(&(centre - high)).max();
        if outside > OUTSIDE && !link.shapes.is_empty() {
            notes.push(format!(
                "a point at the centre of mass of `{}` is a part of it: {outside:.3} m outside of all shapes",
                link.name
            ));
            mass.needs_room = true;
            (low, high) = (low.inf(&centre), high.sup(&centre));
        }
    }
    for ((link, X), mass) in urdf.links.iter().zip(poses).zip(&mut stated) {
        let (Some(centre), Some(moments)) = (mass.centre, &mut mass.moments) else { continue };
        let centre = X.transform_point(&centre.into()).coords;
        let farthest = (centre - low).sup(&(high - centre)).norm();
        let most = moments.iter().copied().fold(0.0, f64::max);
        let bound = mass.mass * farthest * farthest * WITHIN;
        if most > bound {
            *moments = moments.map(|moment| moment * bound / most);
            notes.push(format!(
                "the moments of inertia of `{}` are made less: no body of its mass within the robot has {most} kg*m^2",
                link.name
            ));
        }
    }
    (stated, notes)
}

/// Returns the mass of a link, its moments those of a body that can be.
fn of_link(link: &UrdfLink, notes: &mut Vec<String>) -> LinkMass {
    let stated = link.mass.unwrap_or(0.0);
    // A link has some mass in the language.
    let mut found = LinkMass { mass: stated.max(MASS_MIN), centre: None, moments: None, needs_room: false };
    if stated <= 0.0 {
        return found;
    }
    found.centre = Some(link.centre.translation.vector);
    let [xx, yy, zz, xy, xz, yz] = link.inertia;
    let R = link.centre.rotation.to_rotation_matrix();
    let own = nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let I = R.matrix() * own * R.matrix().transpose();
    let most = I.diagonal().max();
    if most <= 0.0 {
        return found;
    }
    let products = [I[(0, 1)], I[(0, 2)], I[(1, 2)]];
    if products.iter().any(|product| product.abs() > PRODUCT * most) {
        notes.push(format!("the products of inertia of `{}` are left out", link.name));
    }
    let along = [I[(0, 0)], I[(1, 1)], I[(2, 2)], 0.0, 0.0, 0.0];
    let [x, y, z, ..] = sound(along);
    if (x - along[0]).abs() > PRODUCT * most {
        notes.push(format!("the moments of inertia of `{}` are made more: no body has them", link.name));
    }
    found.moments = Some([x, y, z]);
    found
}

/// Returns points of a shape in its frame between which it lies along each axis of any frame: corners of a box around it.
fn corners(shape: &UrdfShape) -> impl Iterator<Item = nalgebra::Point3<f64>> {
    let half = match shape {
        UrdfShape::Box(size) => size / 2.0,
        UrdfShape::Cylinder { radius, length } => Vec3::new(*radius, *radius, length / 2.0),
        UrdfShape::Capsule { radius, length } => Vec3::new(*radius, *radius, length / 2.0 + radius),
        UrdfShape::Sphere(radius) => Vec3::repeat(*radius),
        UrdfShape::Points(_) => Vec3::zeros(),
    };
    let points = match shape {
        UrdfShape::Points(points) => points.clone(),
        _ => (0..8)
            .map(|k| Vec3::from_fn(|axis, _| if k >> axis & 1 == 0 { -half[axis] } else { half[axis] }))
            .collect(),
    };
    points.into_iter().map(nalgebra::Point3::from)
}
