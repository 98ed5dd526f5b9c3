//! Obstacles that struts keep their clearance from, and uneven ground, by conservative advancement.
//!
//! A convex part stays behind the plane through its nearest point, and a strut comes near it no faster than the
//! faster of the strut's ends.

use super::judgement::{Judgement, Step};
use crate::geometry::distance::signed_distance_within;
use crate::geometry::{HeightField, Part, Pose, Solid, Unsound, Vec3, pose::turned};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Failure, Interpolation, NodePaths};
use crate::units::{Dimension, quantity};

/// An obstacle of the plan's surroundings, fixed in the world.
pub(super) struct Obstacle {
    /// The shape of the obstacle, in the frame of the world.
    solid: Solid,
    /// The name of the obstacle in a report.
    name: String,
}

/// Returns the obstacles of a plan as solids in the frame of the world, in the order of the plan.
///
/// # Errors
/// The fault of the first obstacle whose shapes are not a solid.
pub(super) fn obstacles(paths: &NodePaths) -> Result<Vec<Obstacle>, Unsound> {
    let obstacles = paths.surroundings.obstacles.iter().enumerate();
    obstacles
        .map(|(i, shapes)| Ok(Obstacle { solid: Solid::new(shapes)?, name: format!("obstacle {}", i + 1) }))
        .collect()
}

/// Returns the world position of a node, m, at the fraction `part` of a step, 0 to 1; `node`: its index.
pub(super) fn position(step: &Step, node: usize, part: f64) -> Vec3 {
    match step.interpolation {
        Interpolation::Linear => step.from[node] + (step.to[node] - step.from[node]) * part,
        Interpolation::RigidRoll { edge, angle } => {
            let origin = step.from[edge.0];
            let turn = turned(step.from[edge.1] - origin, angle * part);
            origin + turn.rotation * (step.from[node] - origin)
        }
    }
}

/// Returns the length of the path of a node on a step, m: an upper bound on its speed per step.
fn path_length(step: &Step, node: usize) -> f64 {
    match step.interpolation {
        Interpolation::Linear => (step.to[node] - step.from[node]).norm(),
        Interpolation::RigidRoll { edge, angle } => {
            let along = (step.from[edge.1] - step.from[edge.0]).normalize();
            (step.from[node] - step.from[edge.0]).cross(&along).norm() * angle.abs()
        }
    }
}

impl Judgement<'_> {
    /// Checks that all struts keep their clearance from all obstacles on a step, by conservative advancement, and
    /// keeps the least distance found.
    pub(super) fn obstacles(&self, step: &Step, ledger: &mut Ledger) {
        for obstacle in &self.obstacles {
            for strut in 0..self.struts.len() {
                for part in &obstacle.solid.parts {
                    self.strut_obstacle(step, strut, (obstacle, part), ledger);
                }
            }
        }
    }

    /// Checks one strut against one convex part of an obstacle, by conservative advancement.
    fn strut_obstacle(
        &self,
        step: &Step,
        strut: usize,
        (obstacle, part): (&Obstacle, &Part),
        ledger: &mut Ledger,
    ) {
        let (a, b) = self.struts[strut];
        let clearance = self.strut.clearance;
        let fastest = path_length(step, a).max(path_length(step, b));
        // Broad phase: bounding spheres.
        let (p, q) = (step.from[a], step.from[b]);
        let gap = ((p + q) / 2.0 - part.centre).norm() - (p - q).norm() / 2.0 - part.radius;
        // Twice the clearance, so that a distance is reported where nothing is nearer.
        if gap > 2.0 * clearance + fastest {
            return;
        }
        let sample = |at: f64| {
            let (p, q) = (position(step, a, at), position(step, b, at));
            let segment = Part::capsule((p + q) / 2.0, (q - p) / 2.0, 0.0);
            signed_distance_within(&segment, part, &Pose::identity(), None, 2.0 * clearance + fastest)
                .distance
        };
        // Conservative advancement: a spare distance lasts as long as the fastest end takes to use it up.
        let (mut at, mut least) = (0.0, (sample(1.0), 1.0));
        let tolerance = self.tolerances.obstacle_distance;
        let decided = self.samples.advance(|| {
            let distance = sample(at);
            if distance < least.0 {
                least = (distance, at);
            }
            let spare = distance - clearance + tolerance;
            let holds = spare >= 0.0 && least.0 >= clearance - tolerance && spare >= fastest * (1.0 - at);
            if holds || spare < 0.0 || at >= 1.0 {
                return Some(holds);
            }
            at = (at + spare / fastest).min(1.0);
            None
        });
        // The least distance found goes to the verdict.
        let time = step.time(least.1);
        let names = || vec![self.strut_name(strut), obstacle.name.clone()];
        if least.0 <= 2.0 * clearance {
            keep_least(&mut ledger.verdict.clearance, least.0, time, names);
        }
        if decided == Some(true) {
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

    /// Returns the least signed distance of a strut to an obstacle with the nodes at `x` in the world (m), m;
    /// negative where they overlap, `None` without obstacles.
    pub(super) fn nearest_obstacle(&self, x: &[Vec3]) -> Option<f64> {
        let parts = || self.obstacles.iter().flat_map(|obstacle| &obstacle.solid.parts);
        let mut least = None;
        for &(a, b) in &self.struts {
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

    /// Checks that no node at `x` (m), its place at the start, is inside an obstacle's mesh that is not convex, where
    /// it may be far from the surface.
    pub(super) fn enclosed(&self, x: &[Vec3], ledger: &mut Ledger) {
        for obstacle in &self.obstacles {
            if let Some(node) = x.iter().position(|p| obstacle.solid.encloses(p)) {
                let name = self.node_name(node);
                let message = format!("the node {name} begins inside {}", obstacle.name);
                let names = vec![name, obstacle.name.clone()];
                ledger.fail(self.failure(CheckKind::Collision, 0.0, names, message));
            }
        }
    }

    /// Checks that on a step no node goes below the uneven ground `terrain`, and no strut deeper than half its
    /// clearance; the deepest is recorded.
    pub(super) fn uneven(&self, step: &Step, terrain: &HeightField, ledger: &mut Ledger) {
        let nodes = (0..step.from.len()).map(|node| (vec![node], 0.0));
        let struts = self.struts.iter().map(|&(a, b)| (vec![a, b], self.strut.clearance / 2.0));
        let found = nodes.chain(struts).filter_map(|(ends, sink)| {
            let (depth, at) = self.below(step, terrain, &ends, sink)?;
            Some((depth, at, ends))
        });
        let Some((depth, at, ends)) = found.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        let names: Vec<String> = ends.iter().map(|&node| self.node_name(node)).collect();
        let deep = quantity(depth, Dimension::LENGTH);
        let sink = if ends.len() > 1 { self.strut.clearance / 2.0 } else { 0.0 };
        let allowed = quantity(sink, Dimension::LENGTH);
        let what = match &names[..] {
            [node] => format!("the node {node}"),
            _ => format!("the strut {}", names.join(" -- ")),
        };
        let message = match ends.len() {
            _ if depth <= sink + self.tolerances.uneven_ground => {
                format!(
                    "{what} stays so near to {allowed} below the ground that it is not proved to go no deeper"
                )
            }
            1 => format!("{what} goes {deep} into the ground"),
            _ => format!("{what} goes {deep} into the ground; between its nodes it may go {allowed}"),
        };
        let failure = self.failure(CheckKind::Ground, step.time(at), names, message);
        ledger.fail(Failure { value: depth, ..failure });
    }

    /// Returns the depth of a node, or of a strut, below the ground if it is more than `sink`, m, and the fraction
    /// of the step at which it is found. The method is conservative advancement; `None` if the depth is proved to be
    /// less.
    fn below(&self, step: &Step, terrain: &HeightField, ends: &[usize], sink: f64) -> Option<(f64, f64)> {
        // Going straight, a node is lowest above flat triangles where it crosses their sides.
        if let (&[node], Interpolation::Linear) = (ends, step.interpolation) {
            let (at, height) = terrain.lowest(step.from[node], step.to[node]);
            return (height < -self.tolerances.uneven_ground).then_some((-height, at));
        }
        let fastest = ends.iter().map(|&node| path_length(step, node)).fold(0.0, f64::max);
        let falls = fastest * libm::hypot(1.0, self.steepest);
        let sample = |at: f64| match *ends {
            [node] => terrain.above(position(step, node, at)),
            [a, b, ..] => terrain.lowest(position(step, a, at), position(step, b, at)).1,
            [] => f64::INFINITY,
        };
        let mut at = 0.0;
        let decided = self.samples.advance(|| {
            let height = sample(at);
            if height < -sink - self.tolerances.uneven_ground {
                return Some(Some((-height, at)));
            }
            let lasts = height + sink + 2.0 * self.tolerances.uneven_ground;
            if at >= 1.0 || lasts >= falls * (1.0 - at) {
                // The end counts as every sample does.
                let last = sample(1.0);
                return Some((last < -sink - self.tolerances.uneven_ground).then_some((-last, 1.0)));
            }
            at = (at + lasts / falls).min(1.0);
            None
        });
        decided.unwrap_or_else(|| Some((-sample(at), at)))
    }
}
