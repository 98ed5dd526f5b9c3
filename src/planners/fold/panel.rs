//! Panels: triangular modules with a hinge at each edge, in numbers.

use super::sweep_collision::Solids;
use super::tolerances::TOLERANCES;
use crate::behavior::law;
use crate::geometry::{Part, Pose, Solid, Vec3};
use crate::plan::Profile;
use crate::robot::{Library, Link, Port};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::fmt;
use std::sync::Arc;

/// The granularity of the time of steps, s.
const STEP_GRAIN: f64 = 0.01;

/// The time of a step whose hinges have no limits of speed and acceleration, s.
const STEP_UNLIMITED: f64 = 1.0;

/// A triangular panel module in numbers: geometry, mass, and the limits of the hinges at its edges.
#[derive(Clone, Debug)]
pub struct Panel {
    /// The mass of the panel, kg.
    pub mass: f64,
    /// The lengths of the sides in the order of the module's ports, counterclockwise seen from the front, m.
    pub sides: [f64; 3],
    /// The thickness of a uniform plate of the same mass with the same second moment along its normal, m.
    pub thickness: f64,
    /// The greatest speed and acceleration of the hinges at the panel's edges, rad/s and rad/s²; each `None` where no
    /// limit is stated.
    pub able: law::MotionLimits,
    /// The greatest torque that the panel's hinges hold, N·m; `None` where no limit is stated.
    pub torque: Option<f64>,
    /// The depth to which a panel may enter another panel or the ground before that is a collision, m.
    pub touch: f64,
    /// The height over the ground below which a panel touches the ground, m.
    pub contact: f64,
    /// The convex parts of the panel's collision shape, in the panel frame of [`Solids`].
    pub parts: Vec<Part>,
}

/// The reason why a module type is not a panel: the first property of a panel that it lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotAPanel {
    /// The module type has another number of ports than three.
    Ports,
    /// The module type has another number of links than one.
    Links,
    /// The ports of the module type are not at the middles of the edges of a triangle, facing outwards.
    PortPoses,
    /// The connector of the ports of the module type has no hinge.
    NoHinge,
    /// The collision shape of the module type is not a solid.
    Shape,
}

impl fmt::Display for NotAPanel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NotAPanel::Ports => "it needs one port for each edge",
            NotAPanel::Links => "it has more than one link",
            NotAPanel::PortPoses => {
                "its ports are not at the middles of its edges, facing outwards, counterclockwise, \
                 with `up` to its front"
            }
            NotAPanel::NoHinge => "its edges have no hinge",
            NotAPanel::Shape => "its shape is not sound",
        })
    }
}

impl std::error::Error for NotAPanel {}

impl Panel {
    /// Returns the module type `kind` (an index in [`Library::modules`]) of a library as a panel. Panics if the
    /// library has no such type.
    ///
    /// # Errors
    /// The first property of a panel that this module type lacks, as [`NotAPanel`].
    pub fn of(library: &Library, kind: usize) -> Result<Panel, NotAPanel> {
        let module = &library.modules[kind];
        let [a, b, c] = &module.ports[..] else { return Err(NotAPanel::Ports) };
        let [link] = &module.links[..] else { return Err(NotAPanel::Links) };
        let sides = sides(&[a, b, c]).ok_or(NotAPanel::PortPoses)?;
        let hinge = library.connectors[a.connector].hinge.as_ref().ok_or(NotAPanel::NoHinge)?;
        let solid = Solid::new(&link.collides).map_err(|_| NotAPanel::Shape)?;
        let panel_of_link = frame(a, b, c).inverse();
        Ok(Panel {
            mass: link.mass,
            sides,
            thickness: thickness(link, a.pose.rotation * Vec3::z()),
            able: law::MotionLimits { speed: hinge.limits.speed, acceleration: hinge.limits.acceleration },
            torque: hinge.limits.effort,
            touch: module.touch,
            contact: module.contact,
            parts: solid.parts.iter().map(|part| part.moved(&panel_of_link)).collect(),
        })
    }

    /// Returns true if the second and the third side of the panel each differ from the first by at most
    /// `TOLERANCES.side` of the longest.
    pub fn is_equilateral(&self) -> bool {
        equal_sides(self.sides, [self.sides[0]; 3], TOLERANCES.side)
    }

    /// Returns this panel with the lesser limits of the hinges and the greater thickness and `touch` of the two; a
    /// limit that only one states is kept. Mass, sides, `contact` and parts are those of this panel.
    pub fn weaker(self, other: &Panel) -> Panel {
        let least = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(f64::min);
        let able = law::MotionLimits {
            speed: least(self.able.speed, other.able.speed),
            acceleration: least(self.able.acceleration, other.able.acceleration),
        };
        Panel {
            able,
            torque: least(self.torque, other.torque),
            thickness: self.thickness.max(other.thickness),
            touch: self.touch.max(other.touch),
            ..self
        }
    }

    /// Returns the least time (s) in which a hinge folds by `angle` (rad) from rest to rest under the quintic law,
    /// rounded up to a multiple of 10 ms; 1 s if no limit bounds it or the angle is 0.
    pub fn step_time(&self, angle: f64) -> f64 {
        match law::least_duration(Profile::Smooth, angle, self.able) {
            Some(least) if least > 0.0 => (least / STEP_GRAIN).ceil() * STEP_GRAIN,
            Some(_) | None => STEP_UNLIMITED,
        }
    }
}

/// Returns true if each side of a triangle differs from that of the same index of another by at most `tol` times the
/// longest side of the first.
pub fn equal_sides(a: [f64; 3], b: [f64; 3], tol: f64) -> bool {
    let longest = a.into_iter().fold(0.0, f64::max);
    a.iter().zip(b).all(|(x, y)| (x - y).abs() <= tol * longest)
}

/// Returns the side lengths of a triangle with these ports at the middles of its sides, facing outwards with
/// their z axes to the front, counterclockwise from there; `None` where the ports are not so.
fn sides(ports: &[&Port; 3]) -> Option<[f64; 3]> {
    let middle = ports.map(|port| port.pose.translation.vector);
    let front = ports[0].pose.rotation * Vec3::z();
    let mut sides = [0.0; 3];
    for k in 0..3 {
        // The segment between the middles of two sides is half the third side, in its direction.
        let half = middle[(k + 2) % 3] - middle[(k + 1) % 3];
        sides[k] = 2.0 * half.norm();
        let out = -half.cross(&front) / half.norm();
        let turn = &ports[k].pose.rotation;
        let off = (turn * Vec3::x() - out).norm().max((turn * Vec3::z() - front).norm());
        if off.is_nan() || off > TOLERANCES.side {
            return None;
        }
    }
    Some(sides)
}

/// Returns the panel frame in the frame of its link: the origin is the centroid, x points to the middle of
/// side 0, z along the normal.
fn frame(a: &Port, b: &Port, c: &Port) -> Pose {
    let [p, q, r] = [a, b, c].map(|port| port.pose.translation.vector);
    let middle = (p + q + r) / 3.0;
    let (x, z) = ((p - middle).normalize(), a.pose.rotation * Vec3::z());
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]));
    Pose::from_parts(middle.into(), UnitQuaternion::from_rotation_matrix(&turn))
}

/// Returns the thickness d of a uniform plate whose second moment along `normal` is that of the link: d²/12 of
/// its mass.
fn thickness(link: &Link, normal: Vec3) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = link.inertia;
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let across = inertia.trace() / 2.0 - normal.dot(&(inertia * normal));
    libm::sqrt((12.0 * across / link.mass).max(0.0))
}

/// The panels of a sheet, one for each face of the target: face k is panel k.
#[derive(Clone, Debug)]
pub struct Panels {
    /// The module types and connectors that the panels are made of.
    pub library: Arc<Library>,
    /// The module type of each face's panel, in the order of [`Target::faces`](super::Target::faces), as an index in
    /// [`Library::modules`].
    pub kinds: Vec<usize>,
    /// The mass of each face's panel, in the order of the target's faces, kg.
    pub masses: Vec<f64>,
    /// The thickness of each face's panel, in the order of the target's faces, m.
    pub thickness: Vec<f64>,
    /// The convex collision parts of each face's panel.
    pub solids: Solids,
    /// The first face's panel with the least limits and the greatest thickness and `touch` of all ([`Panel::weaker`]).
    pub weakest: Panel,
}

impl Panels {
    /// Returns the panels of all faces; `kinds`: for each face, in the order of the target's, the index of its module
    /// type in [`Library::modules`]. Panics if `kinds` is empty, or an index is none of the library.
    ///
    /// # Errors
    /// [`NotAPanel`] for the first face whose module type is not a panel.
    pub fn new(library: Arc<Library>, kinds: Vec<usize>) -> Result<Panels, NotAPanel> {
        let mut known: Vec<Option<Panel>> = vec![None; library.modules.len()];
        for &kind in &kinds {
            if known[kind].is_none() {
                known[kind] = Some(Panel::of(&library, kind)?);
            }
        }
        let panel = |kind: &usize| known[*kind].as_ref().expect("all that are used were read");
        let panels: Vec<&Panel> = kinds.iter().map(panel).collect();
        let first = panels.first().expect("a target has faces");
        Ok(Panels {
            masses: panels.iter().map(|panel| panel.mass).collect(),
            thickness: panels.iter().map(|panel| panel.thickness).collect(),
            solids: Solids {
                parts: panels.iter().map(|panel| panel.parts.clone()).collect(),
                touch: panels.iter().map(|panel| panel.touch).fold(0.0, f64::max),
            },
            weakest: panels.iter().fold((*first).clone(), |weakest, panel| weakest.weaker(panel)),
            library,
            kinds,
        })
    }
}
