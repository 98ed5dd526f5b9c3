//! What a truss passes: obstacles that its struts keep their clearance from, and ground that is not flat.
//!
//! Between the keyframes by conservative advancement. A convex part stays behind the plane through its nearest
//! point, and what comes near it does so no faster than its ends, or than the farthest of its points from
//! the line about which it rolls.

use super::judge::{Judged, Leg};
use crate::geometry::distance::signed_distance_within;
use crate::geometry::{HeightField, Part, Pose, Solid, Unsound, Vec3, pose::turned};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Failure, Interpolation, NodePaths};
use crate::units::{Dimension, quantity};

/// Distances may be less than the clearance by this much, m: rounding.
const TOL_DISTANCE: f64 = 2e-9;
/// Nodes on uneven ground may be this far below it, and struts farther than they may, m: rounding, and so
/// that few looks are enough.
const TOL_GROUND: f64 = 1e-6;
/// Looks at one strut and one part, or at one node or strut on uneven ground, on one leg.
const LOOKS_MAX: usize = 100_000;

/// The plan's obstacles.
pub struct Obstacle {
    solid: Solid,
    /// As it is called.
    name: String,
}

/// `Err` for shapes that are no solids.
pub fn obstacles(paths: &NodePaths) -> Result<Vec<Obstacle>, Unsound> {
    let obstacles = paths.surroundings.obstacles.iter().enumerate();
    obstacles
        .map(|(i, shapes)| Ok(Obstacle { solid: Solid::new(shapes)?, name: format!("obstacle {}", i + 1) }))
        .collect()
}

/// Where a point is at a part of a leg.
pub fn place(leg: &Leg, node: usize, part: f64) -> Vec3 {
    match leg.interpolation {
        Interpolation::Linear => leg.from[node] + (leg.to[node] - leg.from[node]) * part,
        Interpolation::RigidRoll { edge, angle } => {
            let origin = leg.from[edge.0];
            let turn = turned(leg.from[edge.1] - origin, angle * part);
            origin + turn.rotation * (leg.from[node] - origin)
        }
    }
}

/// The longest way of a node on a leg, m.
fn way(leg: &Leg, node: usize) -> f64 {
    match leg.interpolation {
        Interpolation::Linear => (leg.to[node] - leg.from[node]).norm(),
        Interpolation::RigidRoll { edge, angle } => {
            let along = (leg.from[edge.1] - leg.from[edge.0]).normalize();
            (leg.from[node] - leg.from[edge.0]).cross(&along).norm() * angle.abs()
        }
    }
}

impl Judged<'_> {
    /// The struts of one leg beside the obstacles.
    pub fn obstacles(&self, leg: &Leg, ledger: &mut Ledger) {
        for obstacle in &self.obstacles {
            for strut in 0..self.paths.struts.len() {
                for part in &obstacle.solid.parts {
                    self.beside(leg, strut, (obstacle, part), ledger);
                }
            }
        }
    }

    fn beside(&self, leg: &Leg, strut: usize, (obstacle, part): (&Obstacle, &Part), ledger: &mut Ledger) {
        let (a, b) = self.paths.struts[strut];
        let clearance = self.strut.clearance;
        let fastest = way(leg, a).max(way(leg, b));
        let (p, q) = (leg.from[a], leg.from[b]);
        let gap = ((p + q) / 2.0 - part.centre).norm() - (p - q).norm() / 2.0 - part.radius;
        // Twice the clearance, so that a distance is told where nothing is nearer.
        if gap > 2.0 * clearance + fastest {
            return;
        }
        let look = |at: f64| {
            let (p, q) = (place(leg, a, at), place(leg, b, at));
            let segment = Part::capsule((p + q) / 2.0, (q - p) / 2.0, 0.0);
            signed_distance_within(&segment, part, &Pose::identity(), None, 2.0 * clearance + fastest)
                .distance
        };
        let (mut at, mut least) = (0.0, (look(1.0), 1.0));
        let mut holds = false;
        for _ in 0..LOOKS_MAX {
            let distance = look(at);
            if distance < least.0 {
                least = (distance, at);
            }
            let spare = distance - clearance + TOL_DISTANCE;
            holds = spare >= 0.0 && least.0 >= clearance - TOL_DISTANCE && spare >= fastest * (1.0 - at);
            if holds || spare < 0.0 || at >= 1.0 {
                break;
            }
            at = (at + spare / fastest).min(1.0);
        }
        let time = leg.begins + leg.lasts * least.1;
        let names = || vec![self.strut_name(strut), obstacle.name.clone()];
        if least.0 <= 2.0 * clearance {
            keep_least(&mut ledger.verdict.clearance, least.0, time, names);
        }
        if holds {
            return;
        }
        let [found, wanted] = [least.0, clearance].map(|x| quantity(x, Dimension::LENGTH));
        let (name, kind) = (self.strut_name(strut), &self.strut.name);
        let message = if least.0 < clearance {
            format!("the strut {name} comes within {found} of {}; a {kind} keeps {wanted}", obstacle.name)
        } else {
            format!("the strut {name} stays so near to {wanted} from {} that it is not proved", obstacle.name)
        };
        let failure = self.failure(CheckKind::Collision, time, names(), message);
        ledger.fail(Failure { value: least.0, limit: clearance, ..failure });
    }

    /// How near the struts are to the obstacles, m.
    pub fn nearest_obstacle(&self, x: &[Vec3]) -> Option<f64> {
        let parts = || self.obstacles.iter().flat_map(|obstacle| &obstacle.solid.parts);
        let mut least = None;
        for &(a, b) in &self.paths.struts {
            let segment = Part::capsule((x[a] + x[b]) / 2.0, (x[b] - x[a]) / 2.0, 0.0);
            for part in parts() {
                let gap = (segment.centre - part.centre).norm() - segment.radius - part.radius;
                if least.is_none_or(|least| gap < least) {
                    let apart =
                        signed_distance_within(&segment, part, &Pose::identity(), None, f64::MAX).distance;
                    least = Some(least.map_or(apart, |least: f64| least.min(apart)));
                }
            }
        }
        least
    }

    /// A truss that begins inside a hollow obstacle is in it, though it may be far from its walls.
    pub fn enclosed(&self, x: &[Vec3], ledger: &mut Ledger) {
        for obstacle in &self.obstacles {
            if let Some(node) = x.iter().position(|p| obstacle.solid.encloses(p)) {
                let name = self.paths.node_names[node].clone();
                let message = format!("the node {name} begins inside {}", obstacle.name);
                let names = vec![name, obstacle.name.clone()];
                ledger.fail(self.failure(CheckKind::Collision, 0.0, names, message));
            }
        }
    }

    /// Nodes above uneven ground, and struts not deeper in it than they may be.
    pub fn uneven(&self, leg: &Leg, terrain: &HeightField, ledger: &mut Ledger) {
        let nodes = (0..leg.from.len()).map(|node| (vec![node], 0.0));
        let struts = self.paths.struts.iter().map(|&(a, b)| (vec![a, b], self.strut.clearance / 2.0));
        let found = nodes.chain(struts).filter_map(|(ends, sink)| {
            let (depth, at) = self.below(leg, terrain, &ends, sink)?;
            Some((depth, at, ends))
        });
        let Some((depth, at, ends)) = found.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        let names: Vec<String> = ends.iter().map(|&node| self.paths.node_names[node].clone()).collect();
        let deep = quantity(depth, Dimension::LENGTH);
        let message = match &names[..] {
            [node] => format!("the node {node} goes {deep} into the ground"),
            _ => format!(
                "the strut {} goes {deep} into the ground; between its nodes it may go {}",
                names.join(" -- "),
                quantity(self.strut.clearance / 2.0, Dimension::LENGTH)
            ),
        };
        let failure = self.failure(CheckKind::Ground, leg.begins + at * leg.lasts, names, message);
        ledger.fail(Failure { value: depth, ..failure });
    }

    /// How deep a node, or a strut, gets into the ground if that is deeper than `sink`, m, and where on the leg.
    fn below(&self, leg: &Leg, terrain: &HeightField, ends: &[usize], sink: f64) -> Option<(f64, f64)> {
        // Going straight, a node is lowest above flat triangles where it crosses their sides.
        if let (&[node], Interpolation::Linear) = (ends, leg.interpolation) {
            let (at, height) = terrain.lowest(leg.from[node], leg.to[node]);
            return (height < -TOL_GROUND).then_some((-height, at));
        }
        let fastest = ends.iter().map(|&node| way(leg, node)).fold(0.0, f64::max);
        let falls = fastest * libm::hypot(1.0, self.steepest);
        let look = |at: f64| match *ends {
            [node] => terrain.above(place(leg, node, at)),
            [a, b, ..] => terrain.lowest(place(leg, a, at), place(leg, b, at)).1,
            [] => f64::INFINITY,
        };
        let mut at = 0.0;
        for _ in 0..LOOKS_MAX {
            let height = look(at);
            if height < -sink - TOL_GROUND {
                return Some((-height, at));
            }
            let lasts = height + sink + 2.0 * TOL_GROUND;
            if at >= 1.0 || lasts >= falls * (1.0 - at) {
                // The end counts as every look does.
                let last = look(1.0);
                return (last < -sink - TOL_GROUND).then_some((-last, 1.0));
            }
            at = (at + lasts / falls).min(1.0);
        }
        Some((-look(at), at))
    }
}
