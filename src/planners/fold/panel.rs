//! Panels: modules that are flat convex polygons with a hinge at each edge, in numbers.

use super::polygon;
use super::sweep_collision::{Solids, panel_pose};
use super::target::SIDES_MAX;
use super::tolerances::TOLERANCES;
use crate::behavior::law;
use crate::geometry::{Part, Solid, Vec3};
use crate::plan::Profile;
use crate::robot::{Library, Link, Port};
use nalgebra::Matrix3;
use std::fmt;
use std::sync::Arc;

/// The granularity of the time of steps, s.
const STEP_GRAIN: f64 = 0.01;

/// The time of a step whose hinges have no limits of speed and acceleration, s.
const STEP_UNLIMITED: f64 = 1.0;

/// A panel module in numbers: geometry, mass, and the limits of the hinges at its edges.
#[derive(Clone, Debug)]
pub struct Panel {
    /// The mass of the panel, kg.
    pub mass: f64,
    /// The lengths of the sides in the order of the module's ports, counterclockwise seen from the front, m.
    pub sides: Vec<f64>,
    /// The lengths that tell the panel from others, m: [`measures`](polygon::measures) of its outline.
    pub measures: Vec<f64>,
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
    /// The module type has fewer than three ports, or more than [`SIDES_MAX`].
    Ports,
    /// The module type has another number of links than one.
    Links,
    /// The ports of the module type are not at the middles of the edges of a convex polygon, facing outwards.
    PortPoses,
    /// The connector of the ports of the module type has no hinge.
    NoHinge,
    /// The collision shape of the module type is not a solid.
    Shape,
}

impl fmt::Display for NotAPanel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NotAPanel::Ports => "it needs one port for each edge, of which there are at least three",
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
        if module.ports.len() < 3 || module.ports.len() > SIDES_MAX {
            return Err(NotAPanel::Ports);
        }
        let [link] = &module.links[..] else { return Err(NotAPanel::Links) };
        let outline = outline(&module.ports).ok_or(NotAPanel::PortPoses)?;
        let first = &module.ports[0];
        let hinge = library.connectors[first.connector].hinge.as_ref().ok_or(NotAPanel::NoHinge)?;
        let solid = Solid::new(&link.collides).map_err(|_| NotAPanel::Shape)?;
        let front = first.pose.rotation * Vec3::z();
        let panel_of_link = panel_pose(&outline, &front).inverse();
        Ok(Panel {
            mass: link.mass,
            sides: polygon::sides(&outline),
            measures: polygon::measures(&outline),
            thickness: thickness(link, front),
            able: law::MotionLimits { speed: hinge.limits.speed, acceleration: hinge.limits.acceleration },
            torque: hinge.limits.effort,
            touch: module.touch,
            contact: module.contact,
            parts: solid.parts.iter().map(|part| part.moved(&panel_of_link)).collect(),
        })
    }

    /// Returns true if the panel is a regular polygon: its sides are equal, and its angles, up to `TOLERANCES.side`.
    pub fn is_regular(&self) -> bool {
        let (sides, diagonals) = self.measures.split_at(self.sides.len());
        let alike = |lengths: &[f64]| {
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            lengths.iter().all(|length| (length - lengths[0]).abs() <= TOLERANCES.side * longest)
        };
        alike(sides) && alike(diagonals)
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

/// Returns the corners (m) of a convex polygon with these ports, at least three, at the middles of its sides, facing
/// outwards with their z axes to the front, counterclockwise from there; corner k is where side k begins. `None` where
/// the ports are not so.
fn outline(ports: &[Port]) -> Option<Vec<Vec3>> {
    let n = ports.len();
    let front = ports[0].pose.rotation * Vec3::z();
    let middle = |k: usize| ports[k % n].pose.translation.vector;
    let out = |k: usize| ports[k % n].pose.rotation * Vec3::x();
    // A corner is where the lines of two sides cross: seen from the middle of the second side, along it.
    let corner = |k: usize| {
        let (before, after) = (k + n - 1, k);
        let along = front.cross(&out(after));
        let apart = out(before).dot(&along);
        let away = out(before).dot(&(middle(before) - middle(after))) / apart;
        middle(after) + along * away
    };
    let corners: Vec<Vec3> = (0..n).map(corner).collect();
    let longest = polygon::sides(&corners).into_iter().fold(0.0, f64::max);
    for (k, port) in ports.iter().enumerate() {
        let (from, to) = (corners[k], corners[(k + 1) % n]);
        let off = ((from + to) / 2.0 - middle(k)).norm() / longest;
        let outwards = (to - from).cross(&front).normalize();
        // Ports in one line have no corner between them: what is then not a number does not fit.
        let fits = |error: f64| error <= TOLERANCES.side;
        let turned = [port.pose.rotation * Vec3::z() - front, out(k) - outwards];
        if !fits(off) || !turned.iter().all(|error| fits(error.norm())) {
            return None;
        }
    }
    let is_facing_front = polygon::check(&corners).is_ok() && polygon::normal(&corners).dot(&front) > 0.0;
    is_facing_front.then_some(corners)
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
