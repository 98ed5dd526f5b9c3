//! The quantities that the judge computes, at times that others choose. Nothing is judged here.
//!
//! The rollout is the judge's own. A time between two of its samples is reached by one more step from the sample
//! before, so that the choice of times does not change the rollout.

use super::cluster_paths::roll_out_path;
use super::clusters::Cluster;
use super::dynamics::{Recorder, RolloutLoads};
use super::parted;
use super::rollout::{Checkpoint, roll_out};
use super::rollout_input::Rollout;
use super::sample::Sample;
use super::stability;
use super::succession;
use super::tolerances::Tolerances;
use super::torque::{self, JudgedLoads};
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::ledger::Ledger;
use crate::plan::{Body, Plan, Tracks, validation};
use crate::robot::JointOwner;

/// The quantities that the judge computes of a robot at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// The time from the start of the plan, s.
    pub time: f64,
    /// The world pose of the base module's body (`X_WB`), in metres.
    pub base: Pose,
    /// The static stability margin (McGhee and Frank 1968), m: the distance of the centre of mass inside the support,
    /// by the plan's rule of stability; negative outside, 0 in a support without area. `None` without a ground or
    /// weight, and while the base is held because support is missing.
    pub margin: Option<f64>,
    /// The torque (N·m) or force (N) that a motor supplies at each joint, by the number in its
    /// [`JointId`](crate::robot::JointId), in the joint's positive direction. An entry is `None` without weight, if
    /// the judge does not know it, and if it was not requested.
    pub efforts: Vec<Option<f64>>,
    /// The forces of the ground; `None` without weight, if the judge does not know them, and if they were not
    /// requested.
    pub forces: Option<Vec<GroundForce>>,
}

/// The extent of the quantities that are computed of an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// The pose of the robot and its stability margin.
    Stance,
    /// The pose and the margin, and the loads as well, which take longer to find.
    Loads,
}

/// A contact force of the ground on a module of a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundForce {
    /// The index in the assembly of the module that the force acts on.
    pub module: usize,
    /// The point of application in the world, m.
    pub point: Vec3,
    /// The force in the world, N.
    pub force: Vec3,
    /// The part of the force along the normal of the ground, N.
    pub normal: f64,
}

/// Returns the judge's quantities at these times (s), one instant for each, in the order of `times`. `times` must
/// ascend (equal ones may follow each other) and lie between 0 and the duration of the plan; a negative one panics.
/// The list ends early at a time beyond the duration or out of order, and if the judge took all samples that are
/// allowed before. It is empty for plans of other families, and for plans that are not valid. `reference`: of several
/// robots, a module of the one that is meant, by its index in the plan's robot, with what is docked with it; its body is
/// then the base. `None`: that with the plan's base.
pub fn instants(plan: &Plan, times: &[f64], detail: Detail, reference: Option<usize>) -> Vec<Instant> {
    let Body::Tracks(tracks) = &plan.body else { return vec![] };
    if validation::check(plan).is_err() {
        return vec![];
    }
    let tolerances = Tolerances::default();
    let rollout = Rollout::of(plan, tracks, &tolerances);
    let reference = reference.unwrap_or(tracks.robot.base);
    let Some(mut clusters) = parted::several(&rollout) else {
        return of_rollout(&rollout, tracks.robot.base, times, detail);
    };
    let until = times.iter().copied().fold(0.0, f64::max);
    let mut found: Vec<Instant> = Vec::with_capacity(times.len());
    succession::follow(&rollout, &mut clusters, until, &mut |begun| {
        let (cluster, part) = (begun.cluster(), begun.rollout(&rollout));
        if let Ok(own) = cluster.modules.binary_search(&reference) {
            let its = times.iter().skip(found.len()).take_while(|time| cluster.exists(**time));
            let its: Vec<f64> = its.copied().collect();
            let known = of_rollout(&part, own, &its, detail);
            found.extend(known.into_iter().map(|instant| in_numbers_of_plan(instant, cluster, tracks)));
        }
        roll_out_path(part, until)
    });
    found
}

/// Returns an instant of a cluster with the numbers of the plan's modules and joints: of joints of others nothing is known.
fn in_numbers_of_plan(instant: Instant, cluster: &Cluster, tracks: &Tracks) -> Instant {
    let robot = &tracks.robot;
    let mut own = instant.efforts.into_iter();
    let owned = |owner: JointOwner| match owner {
        JointOwner::Module { module, .. } => cluster.modules.binary_search(&module).is_ok(),
        JointOwner::Bond(bond) => cluster.bonds.binary_search(&bond).is_ok(),
    };
    let efforts =
        robot.joints().map(|owner| if owned(owner) { own.next().flatten() } else { None }).collect();
    let of_plan = |push: GroundForce| GroundForce { module: cluster.modules[push.module], ..push };
    let forces = instant.forces.map(|forces| forces.into_iter().map(of_plan).collect());
    Instant { efforts, forces, ..instant }
}

/// Returns the quantities of a rollout at these times (s), as [`instants`] does; `base`: the module whose body is the base,
/// by its index in the rollout's robot.
fn of_rollout(rollout: &Rollout, base: usize, times: &[f64], detail: Detail) -> Vec<Instant> {
    let until = rollout.tracks.duration;
    let mut recorder = Recorder::default();
    let full = rollout.is_full() && detail == Detail::Loads && !times.is_empty();
    if full {
        roll_out(*rollout, None, until, &mut |sample, _| {
            recorder.observe(sample);
            true
        });
    }
    let mut gauge = Gauge {
        loads: full.then(|| RolloutLoads::new(rollout, recorder)),
        rollout,
        base,
        detail,
        torque: torque::Monitor::new(rollout.tolerances),
        standing: stability::Monitor::new(rollout.settings, rollout.tolerances),
    };
    let mut found: Vec<Instant> = Vec::with_capacity(times.len());
    if times.is_empty() {
        return found;
    }
    let mut last: Option<Checkpoint> = None;
    roll_out(*rollout, None, until, &mut |sample, checkpoint| {
        while let Some(&time) = times.get(found.len()).filter(|time| **time < sample.time) {
            let from = last.as_ref().expect("the first sample is at the start of the plan");
            roll_out(*rollout, Some(from), time, &mut |between, _| {
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

/// Reads the quantities of samples from the judge's monitors.
struct Gauge<'a> {
    /// The loads in motion; `None` under statics, and where loads were not requested.
    loads: Option<RolloutLoads<'a>>,
    rollout: &'a Rollout<'a>,
    /// The module whose body is the base, by its index in the rollout's robot.
    base: usize,
    detail: Detail,
    torque: torque::Monitor<'a>,
    standing: stability::Monitor<'a>,
}

impl Gauge<'_> {
    fn instant(&mut self, sample: &Sample) -> Instant {
        // Of each sample by itself: no worst value of others decides how closely forces are sought.
        let mut ledger = Ledger::new(self.rollout.exemptions, self.rollout.end);
        let unknown = || JudgedLoads { efforts: vec![None; sample.joints.len()], forces: None };
        let loads = match (&self.loads, self.detail) {
            (Some(loads), _) => loads.read(sample.time).map(|(efforts, forces)| JudgedLoads {
                efforts: efforts.into_iter().map(Some).collect(),
                forces: Some(forces),
            }),
            (None, Detail::Loads) => self.torque.read(sample, &mut ledger),
            (None, Detail::Stance) => None,
        };
        let mut loads = loads.unwrap_or_else(unknown);
        let loose = &sample.model.kinematics.tree.loose;
        if !loose.is_empty() {
            // The rollout is that of the part with the base: of others nothing is known here.
            let robot = sample.model.robot;
            for (effort, owner) in loads.efforts.iter_mut().zip(robot.joints()) {
                if loose.contains(&robot.module_of(owner)) {
                    *effort = None;
                }
            }
            loads.forces = None;
        }
        let force = |push: &super::statics::Wrench| GroundForce {
            module: sample.model.kinematics.module_of(push.link),
            point: sample.stance.world_point(&push.p),
            force: sample.stance.world_vector(&push.f),
            normal: push.f.z,
        };
        Instant {
            time: sample.time,
            base: sample.stance.link_pose(sample.model.kinematics.link(self.base, 0)),
            margin: self.standing.margin(sample),
            efforts: loads.efforts,
            forces: loads.forces.map(|forces| forces.iter().map(force).collect()),
        }
    }
}
