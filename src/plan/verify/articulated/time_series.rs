//! The quantities that the judge works out, at times that others choose. Nothing is judged here.
//!
//! The rollout is the judge's own. A time between two of its samples is reached by one more step from the sample
//! before, so that what is asked for does not change the rollout.

use super::rollout::{Checkpoint, Rollout, Sample, roll_out};
use super::stability;
use super::tolerances::Tolerances;
use super::torque::{self, JudgedLoads};
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::ledger::Ledger;
use crate::plan::{Body, Plan, validation};

/// The judge's quantities of a robot at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// The time, s.
    pub time: f64,
    /// World pose of the base module's body (`X_WB`).
    pub base: Pose,
    /// The distance of the centre of mass inside the support, by the plan's rule of stability, m; negative outside.
    /// `None` where nothing stands, or the base is held while support is missing.
    pub margin: Option<f64>,
    /// The torque (N·m) or force (N) that a motor supplies at each joint, in the joint's positive direction. `None`
    /// where nothing is weighed, the judge does not know it, or it was not asked for.
    pub efforts: Vec<Option<f64>>,
    /// The forces of the ground; `None` where nothing is weighed, the judge does not know them, or they were not
    /// asked for.
    pub forces: Option<Vec<GroundForce>>,
}

/// The quantities of an instant that are worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// The pose and the stability margin of the robot.
    Stance,
    /// The loads as well, which take longer to find.
    Loads,
}

/// A force of the ground on a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundForce {
    /// The index of the module that it acts on.
    pub module: usize,
    /// The point of application in the world, m.
    pub point: Vec3,
    /// The force in the world, N.
    pub force: Vec3,
}

/// Returns what the judge knows at these times (s), which ascend and lie within the plan. Fewer where the judge took all
/// samples that are allowed before it got there; none for plans that are not of an articulated robot, or that mean
/// nothing.
pub fn instants(plan: &Plan, times: &[f64], detail: Detail) -> Vec<Instant> {
    let Body::Tracks(tracks) = &plan.body else { return vec![] };
    if validation::check(plan).is_err() {
        return vec![];
    }
    let tolerances = Tolerances::default();
    let rollout = Rollout {
        tracks,
        worlds: &plan.worlds,
        exemptions: &plan.exemptions,
        settings: &plan.settings,
        tolerances: &tolerances,
        held: None,
    };
    let mut gauge = Gauge {
        plan,
        detail,
        torque: torque::Monitor::new(&tolerances),
        standing: stability::Monitor::new(&plan.settings, &tolerances),
    };
    let mut found: Vec<Instant> = Vec::with_capacity(times.len());
    let mut last: Option<Checkpoint> = None;
    roll_out(rollout, None, tracks.duration, &mut |sample, checkpoint| {
        while let Some(&time) = times.get(found.len()).filter(|time| **time < sample.time) {
            let from = last.as_ref().expect("the first sample is at the start of the plan");
            roll_out(rollout, Some(from), time, &mut |between, _| {
                if between.time == time {
                    found.push(gauge.instant(between));
                }
                between.time < time
            });
            if found.last().is_none_or(|instant| instant.time != time) {
                return false;
            }
        }
        while times.get(found.len()).is_some_and(|time| *time == sample.time) {
            found.push(gauge.instant(sample));
        }
        last = Some(checkpoint());
        found.len() < times.len()
    });
    found
}

/// Reads what the judge's monitors know of samples.
struct Gauge<'a> {
    plan: &'a Plan,
    detail: Detail,
    torque: torque::Monitor<'a>,
    standing: stability::Monitor<'a>,
}

impl Gauge<'_> {
    fn instant(&mut self, sample: &Sample) -> Instant {
        // Of each sample by itself: no worst value of others decides how closely forces are sought.
        let mut ledger = Ledger::new(&self.plan.exemptions, self.plan.body.duration());
        let unknown = || JudgedLoads { efforts: vec![None; sample.joints.len()], forces: None };
        let loads = match self.detail {
            Detail::Loads => self.torque.read(sample, &mut ledger).unwrap_or_else(unknown),
            Detail::Stance => unknown(),
        };
        let place = sample.stance.place;
        let (s, c) = libm::sincos(place.yaw);
        let turned = |v: &Vec3| Vec3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
        let force = |push: &super::statics::Wrench| GroundForce {
            module: sample.model.kinematics.module_of(push.link),
            point: turned(&push.p) + Vec3::new(place.x, place.y, sample.stance.height),
            force: turned(&push.f),
        };
        Instant {
            time: sample.time,
            base: sample.stance.base_pose(sample.model),
            margin: self.standing.margin(sample),
            efforts: loads.efforts,
            forces: loads.forces.map(|forces| forces.iter().map(force).collect()),
        }
    }
}
