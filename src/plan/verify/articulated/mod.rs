//! The judgement of articulated robots, whose plans are tracks of joints.
//!
//! In this order: joint and motor limits, and rest at both ends, from the control points of the polynomials;
//! docking, from the poses at the instants of docking; then one rollout of the plan over the ground, from sample to
//! sample, which the checks of loops, stability, slip and torque watch; the torque between samples for a fixed base,
//! or, under full dynamics, the loads along the recorded attitudes; collisions, by conservative advancement; and last
//! the blame for the failures.

mod tolerances;

mod limits;
mod rest;

mod model;

mod alignment;
mod contact;
mod minimum_power;
mod settle;
mod stance;

mod rollout;
mod sampling;

mod dynamics;

mod base_motion;
mod contact_forces;
mod contact_lp;
mod fixed_base;
mod load_limits;
mod slope;
mod stability;
mod statics;
mod torque;

mod advancement;
mod bodies;
mod bonded;
mod interval_state;
mod module_clusters;
mod motion_bounds;
mod polyline;
mod reference_links;
mod separation;
mod window_begin;
mod work_budget;

pub mod collision;

mod blame;
mod clearance;
mod collision_report;
mod decimated;
mod docking;
mod history;
mod support_area;
mod time_series;

pub use bodies::{Bodies, UnsoundLink};
pub use clearance::{clearances, clearances_at, collision_point};
pub use collision::{Collision, Findings};
pub use contact::{ContactPatch, ContactPoint};
pub use history::{CONTACTS_MAX, MOMENTS_MAX, Moment, base_at, history};
pub use model::Model;
pub use rollout::{Checkpoint, Rollout, RolloutEnd, Sample, TipOver, roll_out};
pub use stance::Stance;
pub use support_area::area;
pub use time_series::{Detail, GroundForce, Instant, instants};
pub use tolerances::{Precision, Tolerances};

use super::ledger::Ledger;
use crate::interrupt;
use crate::plan::{CheckKind, Failure, Plan, Settings, Status, Tracks, Verdict};
use crate::units::{Dimension, quantity};
use decimated::Decimated;

/// Returns the verdict on the plan of an articulated robot, whose body is `tracks`. The plan must pass
/// [`validation::check`](crate::plan::validation::check), which is not done here: for one that does not, the verdict
/// may be wrong, or this panics.
pub fn judge(plan: &Plan, tracks: &Tracks) -> Verdict {
    let tolerances = Tolerances::default();
    let mut ledger = Ledger::new(&plan.exemptions, tracks.duration);
    let rollout = Rollout::of(plan, tracks, &tolerances);
    limits::judge(tracks, rollout.is_full(), &tolerances, &mut ledger);
    rest::judge(tracks, &tolerances, &mut ledger);
    let missed = docking::judge(&rollout, &mut ledger);
    let samples = sampling::count(tracks, &plan.worlds, &plan.exemptions, &plan.settings, &tolerances);
    let features = ground_features_of(plan, tracks, samples);
    if samples > rollout::samples_max(&plan.settings, features) {
        ledger.fail(too_many_samples(samples, &plan.settings, features));
    } else {
        // The relative poses of links do not depend on the ground.
        let ((checkpoints, deflected), collisions) = interrupt::join(
            || check_samples(&rollout, missed, &mut ledger),
            || collision_report::find(&rollout),
        );
        collision_report::judge(&rollout, collisions, deflected, &mut ledger);
        if rollout.is_full() {
            ledger.drop_consequences();
        }
        blame::blame(&rollout, &checkpoints, ledger.failures_mut());
    }
    ledger.check(CheckKind::Form, Status::Proved);
    // Conflicts are found where a behaviour becomes a plan: here each joint has one track.
    ledger.check(CheckKind::Conflict, Status::Proved);
    ledger.finish()
}

/// Returns the number of features of the robot of a plan that can touch the ground; 0 where there is no ground, or
/// where the samples are so few that it need not be known beforehand.
fn ground_features_of(plan: &Plan, tracks: &Tracks, samples: usize) -> usize {
    let few = samples.saturating_mul(tracks.robot.modules.len()) <= plan.settings.samples_max;
    if few || !plan.worlds.iter().any(|from| from.world.has_floor()) {
        return 0;
    }
    Model::new(&tracks.robot, &tracks.start.bonds).features.len()
}

/// The greatest number of checkpoints that are kept for rolling out parts of the plan again.
const CHECKPOINTS_MAX: usize = 16;

/// Makes all checks that are made from sample to sample. Returns checkpoints to roll out from, and, under full
/// dynamics, the positions of the joints as servos yield.
fn check_samples(
    rollout: &Rollout,
    missed: Vec<usize>,
    ledger: &mut Ledger,
) -> (Vec<Checkpoint>, Option<dynamics::DeflectedMotion>) {
    let mut loops = docking::Monitor::new(rollout, missed);
    let mut checkpoints = Decimated::new(CHECKPOINTS_MAX);
    let mut standing = stability::Monitor::new(rollout.settings, rollout.tolerances);
    let mut base_motion = base_motion::Monitor::new(rollout.settings, rollout.tolerances);
    let mut torque = torque::Monitor::new(rollout.tolerances);
    let mut slope = slope::Monitor::new(rollout.tolerances);
    let full = rollout.is_full();
    let mut recorder = dynamics::Recorder::default();
    let ended = roll_out(*rollout, None, rollout.tracks.duration, &mut |sample, checkpoint| {
        if checkpoints.next_is_kept() {
            checkpoints.keep(checkpoint());
        }
        loops.observe(sample);
        if let Some(loss) = standing.observe(sample, ledger) {
            ledger.fail(loss.failure());
        }
        base_motion.observe(sample, ledger);
        slope.observe(sample, ledger);
        if full {
            recorder.observe(sample);
        } else {
            torque.observe(sample, ledger);
        }
        true
    });
    if let Some(loss) = standing.end(rollout.tracks.duration) {
        ledger.fail(loss.failure());
    }
    if let RolloutEnd::Limit { time, features } = ended {
        ledger.fail(limit_reached(rollout.settings, features, time));
    }
    ledger.verdict.samples = checkpoints.seen();
    let mut deflected = None;
    if full {
        deflected = Some(dynamics::RolloutLoads::new(rollout, recorder).judge(slope.free(), ledger));
    } else {
        torque.between(&fixed_base::prove(rollout), rollout);
        torque.overloaded().iter().for_each(|over| ledger.fail(over.failure()));
        torque.finish(ledger);
    }
    slope.finish(full, ledger);
    standing.finish(ledger);
    let names = |link| link_name(rollout, link);
    base_motion.finish(names, ledger);
    if full && ledger.verdict.slip.is_some() {
        ledger.note(dynamics::travel_tolerance(&ledger.verdict));
    }
    loops.finish(ledger);
    (checkpoints.into_kept(), deflected)
}

fn link_name(rollout: &Rollout, link: usize) -> String {
    let robot = &rollout.tracks.robot;
    let mut rest = link;
    for (module, instance) in robot.modules.iter().enumerate() {
        let links = &robot.module_type(module).links;
        if rest < links.len() {
            return format!("{}.{}", instance.name, links[rest].name);
        }
        rest -= links.len();
    }
    String::new()
}

/// Returns in words why a large robot may take fewer samples than the settings allow; nothing of a small one.
fn counted(settings: &Settings, features: usize) -> String {
    let most = settings.samples_max;
    if rollout::samples_max(settings, features) == most {
        return String::new();
    }
    format!(" of a robot with {features} corners and rims that can touch the ground ({most} of a small one)")
}

fn limit_reached(settings: &Settings, features: usize, time: f64) -> Failure {
    let reached = quantity(time, Dimension::TIME);
    let most = rollout::samples_max(settings, features);
    let counted = counted(settings, features);
    let message =
        format!("the judge took {most} samples, the most allowed{counted}, and got to {reached} only");
    Failure { time, value: most as f64, limit: most as f64, ..Failure::form(message) }
}

fn too_many_samples(samples: usize, settings: &Settings, features: usize) -> Failure {
    let (most, counted) = (rollout::samples_max(settings, features), counted(settings, features));
    let message = format!(
        "at the stated time between samples the plan needs {samples} of them, and {most} are allowed{counted}"
    );
    Failure { value: samples as f64, limit: most as f64, ..Failure::form(message) }
}
