//! Gravity torques of a robot with a fixed base, proved at every instant and not only at samples.
//!
//! In the middle of an interval every torque is known; the bound on its difference until the ends follows from the
//! bounds on the turns of the joints. Seen from the piece before a joint, the links distal to it change by each turn
//! beyond the joint no more than the angle times the arm; and the piece before turns against gravity by no more than
//! all angles before it. Intervals are halved until that is enough.

use super::in_force::world_at;
use super::model::{Model, Posture};
use super::motion_bounds::{Interval, JointMotion, MotionBounds};
use super::rollout_input::Rollout;
use super::statics::{LoadKind, Structure, moves};
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::interrupt;
use crate::plan::{ExemptionKind, Ground};
use crate::robot::Motion;

/// The result of the proof about the torques between samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum BetweenSamples {
    /// No load is ever over its limit.
    Proved,
    /// The loads were not examined, or not decided.
    Open,
    /// A load is over its limit at the time `time` (s). `load`: its index in [`Structure::loads`]; `ratio`: the load as
    /// a fraction of the limit.
    Over { time: f64, load: usize, ratio: f64 },
}

/// Proves that the torques of weight stay within their limits at all instants, also between samples, by bisection
/// with bounds on the motion of the joints. [`BetweenSamples::Open`] unless a fixture holds the base all the time,
/// all loads are of joints that turn, no loop leaves their distribution open, and no overload is exempt.
pub(super) fn prove(rollout: &Rollout) -> BetweenSamples {
    let held = |world: &crate::plan::World| world.ground == Ground::Held;
    let excused = |e: &crate::plan::Exemption| matches!(e.kind, ExemptionKind::Overload(_));
    if !rollout.worlds.iter().all(|w| held(&w.world)) || rollout.exemptions.iter().any(excused) {
        return BetweenSamples::Open;
    }
    // Between instants at which anything begins or ends the tree of bonds and the gravity stay.
    let bounds = MotionBounds::new(rollout.tracks);
    let instants = rollout.instants();
    let mut bonds = rollout.tracks.bonds(rollout.from());
    let mut loads = GravityLoads::new(rollout, &bonds);
    for ends in instants.windows(2) {
        let now = rollout.tracks.bonds(ends[0]);
        if now != bonds {
            bonds = now;
            loads = GravityLoads::new(rollout, &bonds);
        }
        if !loads.decides() {
            return BetweenSamples::Open;
        }
        let gravity = world_at(rollout.worlds, ends[0]).gravity;
        // Bisection: an interval is discarded if the bound proves the loads in all of it.
        let mut open = vec![(ends[0], ends[1])];
        while let Some((from, to)) = open.pop() {
            interrupt::checkpoint();
            let interval = bounds.interval(from, to);
            let motions: Vec<JointMotion> =
                (0..bounds.joint_count()).map(|joint| bounds.over(joint, &interval)).collect();
            match loads.assess(&interval, &motions, gravity) {
                Assessment::Within => {}
                Assessment::Over { load, ratio } => {
                    return BetweenSamples::Over { time: interval.middle, load, ratio };
                }
                Assessment::Near if to - from < rollout.tolerances.load_interval => {
                    return BetweenSamples::Open;
                }
                Assessment::Near => open.extend([(interval.middle, to), (from, interval.middle)]),
            }
        }
    }
    BetweenSamples::Proved
}

/// The model for the gravity loads of one posture after the other.
struct GravityLoads<'a> {
    tolerances: &'a Tolerances,
    model: Model<'a>,
    structure: Structure,
    /// The unit vector downwards, in the frame of the base's body.
    down: Vec3,
    /// The index of the step of the kinematics that leads to each link, by its number; `None` for the base and for
    /// links that are not connected with it.
    step_of: Vec<Option<usize>>,
    /// The indices of the steps that move, in the order of the structure's cuts.
    moving: Vec<usize>,
    /// A buffer for the poses of the links.
    poses: Vec<crate::geometry::Pose>,
}

/// The assessment of the loads in an interval of time.
enum Assessment {
    /// The bound proves all loads within their limits.
    Within,
    /// The bound does not decide.
    Near,
    /// A load, given by its index, is over its limit in the middle of the interval: `ratio` as a fraction of it.
    Over { load: usize, ratio: f64 },
}

/// The links distal to a step, with bounds on their motion in an interval of time.
#[derive(Clone, Copy, Default)]
struct DistalLoad {
    /// The weight, N.
    weight: f64,
    /// The sum of weights times positions in the frame of the base's body, N·m.
    moment: Vec3,
    /// The sum of weights times distances from the point of the step's axis, N·m.
    arms: f64,
    /// An upper bound on the displacement of the step from the middle of the interval, rad or m.
    turn: f64,
    /// An upper bound on the sum of weights times displacements of the distal links, by this step and those beyond it,
    /// N·m.
    shift: f64,
    /// The sum of the bounds on the angles of all steps before it, rad.
    before: f64,
}

impl<'a> GravityLoads<'a> {
    fn new(rollout: &Rollout<'a>, bonds: &[bool]) -> GravityLoads<'a> {
        let model = Model::new(&rollout.tracks.robot, bonds);
        let structure = Structure::new(&model);
        let steps = &model.kinematics.steps;
        let mut step_of = vec![None; model.bodies.len()];
        steps.iter().enumerate().for_each(|(index, step)| step_of[step.link] = Some(index));
        let moving = (0..steps.len()).filter(|&index| moves(&steps[index])).collect();
        let down = rollout.tracks.start.base.rotation.inverse() * -Vec3::z();
        GravityLoads {
            tolerances: rollout.tolerances,
            model,
            structure,
            down,
            step_of,
            moving,
            poses: Vec::new(),
        }
    }

    /// Returns true if loads follow from the weights alone, and all are of joints that turn.
    fn decides(&self) -> bool {
        let turns = |kind| matches!(kind, LoadKind::Joint { turns: true, .. });
        self.structure.closing.is_empty()
            && !self.structure.motors_open
            && self.structure.loads.iter().all(|load| turns(load.kind))
    }

    /// Compares the torques in the middle of an interval with their limits, and bounds those in all of it.
    fn assess(&mut self, interval: &Interval, motions: &[JointMotion], gravity: f64) -> Assessment {
        let positions: Vec<f64> = motions.iter().map(|motion| motion.at).collect();
        let posture = self.model.posture(&positions, &mut self.poses);
        let distal = self.distal(&posture, (interval, motions), gravity);
        let (mut over, mut near) = (None, false);
        for (index, load) in self.structure.loads.iter().enumerate() {
            let (mut size, mut deviation) = (0.0, 0.0);
            for &(cut, factor) in &load.terms {
                let step = self.moving[cut];
                let own = &distal[step];
                let arm = own.moment - self.point(&posture, step) * own.weight;
                size += factor * self.axis(&posture, step).dot(&arm.cross(&self.down));
                deviation += factor.abs() * (own.shift + own.before * own.arms);
            }
            let ratio = size.abs() / load.limit;
            if ratio > 1.0 + self.tolerances.load && over.is_none_or(|(_, worst)| ratio > worst) {
                over = Some((index, ratio));
            }
            near |= ratio + deviation / load.limit > 1.0 + self.tolerances.load;
        }
        match over {
            Some((load, ratio)) => Assessment::Over { load, ratio },
            None if near => Assessment::Near,
            None => Assessment::Within,
        }
    }

    /// Returns the distal links of each step, by the index of the step, in the middle of an interval; `gravity` in
    /// m/s².
    fn distal(
        &self,
        posture: &Posture,
        (interval, motions): (&Interval, &[JointMotion]),
        gravity: f64,
    ) -> Vec<DistalLoad> {
        let steps = &self.model.kinematics.steps;
        let mut distal = vec![DistalLoad::default(); steps.len()];
        let points: Vec<Vec3> = (0..steps.len()).map(|step| self.point(posture, step)).collect();
        for (index, step) in steps.iter().enumerate() {
            let reach = |joint: usize| (motions[joint].rate.abs() + motions[joint].deviation) * interval.half;
            let turn = step.terms().iter().map(|&(joint, factor)| factor.abs() * reach(joint)).sum();
            let parent = self.step_of[step.parent].map_or(0.0, |p| distal[p].before + self.angle(p, &distal));
            (distal[index].turn, distal[index].before) = (turn, parent);
        }
        for &link in &self.model.attached {
            let body = &self.model.bodies[link];
            let (weight, place) = (body.mass * gravity, posture.R[link] * body.com + posture.p[link]);
            let mut at = self.step_of[link];
            while let Some(step) = at {
                let own = &mut distal[step];
                own.weight += weight;
                own.moment += place * weight;
                own.arms += weight * (place - points[step]).norm();
                at = self.step_of[steps[step].parent];
            }
        }
        for index in (0..steps.len()).rev() {
            let own = distal[index];
            // Along a line every point moves by the same; about an axis by the angle times its arm.
            let each = if self.angle(index, &distal) > 0.0 { own.arms } else { own.weight };
            distal[index].shift += own.turn * each;
            if let Some(parent) = self.step_of[steps[index].parent] {
                let shift = distal[index].shift;
                distal[parent].shift += shift;
            }
        }
        distal
    }

    /// Returns an upper bound on the angle by which a step turns, rad; zero for a slide.
    fn angle(&self, step: usize, distal: &[DistalLoad]) -> f64 {
        match self.model.kinematics.steps[step].motion {
            Motion::Along(_) => 0.0,
            _ => distal[step].turn,
        }
    }

    /// Returns a point on the axis of a step, in the frame of the base's body, m.
    fn point(&self, posture: &Posture, step: usize) -> Vec3 {
        let step = &self.model.kinematics.steps[step];
        posture.p[step.link] - posture.R[step.link] * step.offset
    }

    /// Returns the unit vector along the axis of a step, in the frame of the base's body; zero for a fixed one.
    fn axis(&self, posture: &Posture, step: usize) -> Vec3 {
        let step = &self.model.kinematics.steps[step];
        posture.R[step.link] * step.motion.axis().unwrap_or_else(Vec3::zeros)
    }
}
