//! Panels for callers without a module library: bevelled plates made to measure for each face.

use super::inertia::{Body, Inertia};
use super::panel::{NotAPanel, Panels};
use super::polygon;
use super::target::Target;
use super::tolerances::TOLERANCES;
use crate::geometry::{Placed, Pose, Shape, Vec3};
use crate::robot::{Connector, Hinge, Library, Limits, Link, ModuleType, Port, Surface};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::f64::consts::PI;
use std::sync::Arc;

/// The fold angle up to which the bevels of 30° leave room, rad: by equation 1 of the origami paper that of hinges
/// whose radius is the thickness.
const FOLD_MAX: f64 = 2.0 * PI / 3.0;

/// A uniform plate with motors in its edges. The edges are bevelled by 30° on both sides, so that two plates
/// close up to 60° between them.
#[derive(Clone, Copy, Debug)]
pub struct Plate {
    /// The thickness of the plate, m. Default 6 mm.
    pub thickness: f64,
    /// The distance by which the plate ends inside the sides of its face, so that plates side by side do not meet, m.
    /// Default 0.1 mm.
    pub gap: f64,
    /// The mass of the motors of a plate of three sides, whatever its size, spread evenly over the plate, kg: a third of it
    /// for each side. Default 18 g.
    pub motors: f64,
    /// The mass of the plate per area, without its motors, kg/m². Default some 2.887: 8 g for an equilateral triangle
    /// with sides of 80 mm.
    pub density: f64,
    /// The limits of the hinges at the plate's edges: range (rad), speed (rad/s), acceleration (rad/s²) and torque
    /// (N·m). Default 120° to both sides, 90°/s, no limit of acceleration, and 0.1 N·m.
    pub limits: Limits,
}

impl Default for Plate {
    /// Returns the plate of the origami paper: 6 mm thick, 18 g of motors, 8 g of plate for an equilateral
    /// triangle with sides of 80 mm; hinges with 120° to both sides, 90°/s and 0.1 N·m.
    fn default() -> Plate {
        let limits = Limits {
            range: Some((-FOLD_MAX, FOLD_MAX)),
            speed: Some(PI / 2.0),
            acceleration: None,
            effort: Some(0.1),
        };
        Plate { thickness: 0.006, gap: 1e-4, motors: 0.018, density: 2.886_751_345_948_129, limits }
    }
}

impl Plate {
    /// Returns a panel made to measure for each face of a target; congruent faces share a module type.
    ///
    /// # Errors
    /// [`NotAPanel::Shape`] if a face is too small for the thickness, so that the bevels meet.
    pub fn panels(&self, target: &Target) -> Result<Panels, NotAPanel> {
        let mut made: Vec<(Vec<f64>, usize)> = Vec::new();
        let mut kinds = Vec::with_capacity(target.faces.len());
        for face in 0..target.faces.len() {
            let wanted = target.measures(face);
            let known = made
                .iter()
                .position(|(measures, _)| polygon::equal(measures, &wanted, TOLERANCES.same_panel));
            kinds.push(known.unwrap_or_else(|| {
                made.push((wanted, face));
                made.len() - 1
            }));
        }
        let module = |(_, face): &(Vec<f64>, usize)| self.module(&target.outline(*face));
        let modules = made.iter().map(module).collect::<Result<Vec<_>, _>>()?;
        let edge = Connector {
            name: "Edge".into(),
            mates: vec![0],
            turns: 1,
            holds_force: None,
            holds_moment: None,
            capture: None,
            snaps: false,
            hinge: Some(Hinge { axis: Vec3::y(), limits: self.limits }),
        };
        let library = Library { connectors: vec![edge], modules, cells: Vec::new(), struts: Vec::new() };
        Panels::new(Arc::new(library), kinds)
    }

    /// Makes the module type of a plate with these corners (m), drawn about the centroid with its front up.
    fn module(&self, corners: &[Vec3]) -> Result<ModuleType, NotAPanel> {
        let sides = corners.len();
        // The bevel ends at half the thickness.
        let bevel = self.thickness / 2.0 * libm::sqrt(3.0);
        let inside = polygon::inset(corners, self.gap).ok_or(NotAPanel::Shape)?;
        let outside = polygon::inset(corners, self.gap + bevel).ok_or(NotAPanel::Shape)?;
        let level = |z: f64| outside.iter().map(|corner| corner + Vec3::new(0.0, 0.0, z)).collect::<Vec<_>>();
        let half = self.thickness / 2.0;
        let points = [inside, level(-half), level(half)].concat();
        let shape = vec![Placed { pose: Pose::identity(), shape: Shape::Hull { points } }];
        let motors = self.motors * sides as f64 / 3.0;
        let mass = motors + self.density * polygon::area(corners);
        let body = Body::of_panel(corners, mass, Inertia::Prism(self.thickness));
        let i = &body.inertia;
        let link = Link {
            name: "panel".into(),
            pose: Pose::identity(),
            shape: shape.clone(),
            collides: shape,
            left_out: 0.0,
            mass: body.mass,
            com: body.centre,
            inertia: [i[(0, 0)], i[(1, 1)], i[(2, 2)], i[(0, 1)], i[(0, 2)], i[(1, 2)]],
            friction: Link::FRICTION_DEFAULT,
            surface: Surface::default(),
        };
        let port = |k: usize| {
            let (from, to) = (corners[k], corners[(k + 1) % sides]);
            let along = (to - from).normalize();
            let out = Vec3::new(along.y, -along.x, 0.0);
            let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[
                out,
                Vec3::z().cross(&out),
                Vec3::z(),
            ]));
            let pose =
                Pose::from_parts(((from + to) / 2.0).into(), UnitQuaternion::from_rotation_matrix(&turn));
            Port { name: format!("edge[{k}]"), link: 0, pose, connector: 0 }
        };
        Ok(ModuleType {
            name: "Plate".into(),
            links: vec![link],
            joints: Vec::new(),
            ports: (0..sides).map(port).collect(),
            motors: Vec::new(),
            touching: Vec::new(),
            touch: ModuleType::TOUCH_DEFAULT,
            contact: ModuleType::CONTACT_DEFAULT,
        })
    }
}
