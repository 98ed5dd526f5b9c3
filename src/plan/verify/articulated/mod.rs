//! The judgement of articulated robots, whose plans are tracks of joints.
//!
//! In this order: joint and motor limits, from the control points of the polynomials themselves; docking,
//! from the poses at the instants of docking; then one rollout of the plan over the ground, from sample
//! to sample, which the checks of loops, stability, slip and torque watch; the torque between samples
//! where the base is fixed; collisions, by conservative advancement; and last the blame for what failed.

mod tolerances;

mod extremum;
mod limits;

mod support;

mod model;

mod align;
mod carry;
mod contact;
mod descend;
mod stance;

mod sample;
mod walk;

mod bolted;
mod forces;
mod programme;
mod stability;
mod statics;
mod torque;
mod travel;

mod bodies;
mod frame;
mod levels;
mod pairs;
mod search;
mod swing;

pub mod collision;

mod area;
mod blame;
mod docking;
mod history;
mod meeting;
mod nearness;
mod thinned;

pub use area::area;
pub use bodies::{Bodies, UnsoundLink};
pub use collision::{Collision, Findings, Precision};
pub use contact::{Patch, Touch};
pub use history::{CONTACTS_MAX, MOMENTS_MAX, Moment, base_at, history};
pub use model::Model;
pub use nearness::{clearances, collision_point};
pub use stance::Stance;
pub use tolerances::Tolerances;
pub use walk::{Course, Ended, Sample, Tip, Waypoint, walk};

use super::ledger::Ledger;
use crate::plan::{CheckKind, Failure, Plan, Status, Tracks, Verdict};
use crate::units::{Dimension, quantity};
use thinned::Thinned;

/// Judges the plan of an articulated robot.
pub fn judge(plan: &Plan, tracks: &Tracks) -> Verdict {
    let tolerances = Tolerances::default();
    let mut ledger = Ledger::new(&plan.exemptions, tracks.duration);
    limits::judge(tracks, &tolerances, &mut ledger);
    let course = Course {
        tracks,
        worlds: &plan.worlds,
        exemptions: &plan.exemptions,
        settings: &plan.settings,
        tolerances: &tolerances,
        held: None,
    };
    let missed = docking::judge(&course, &mut ledger);
    let samples = sample::count(tracks, &plan.worlds, &plan.exemptions, &plan.settings, &tolerances);
    if samples > plan.settings.samples_max {
        ledger.fail(too_many_samples(samples, plan.settings.samples_max));
    } else {
        let waypoints = on_the_way(&course, missed, &mut ledger);
        meeting::judge(&course, &mut ledger);
        blame::blame(&course, &waypoints, ledger.failures_mut());
    }
    ledger.check(CheckKind::Form, Status::Proved);
    // Conflicts are found where a behaviour becomes a plan: here each joint has one track.
    ledger.check(CheckKind::Conflict, Status::Proved);
    // After its last segment a joint holds.
    ledger.check(CheckKind::Rest, Status::Proved);
    ledger.finish()
}

/// Waypoints that are kept for walking parts of the way again.
const WAYPOINTS_MAX: usize = 16;

/// Everything that is judged from sample to sample. Returns places to walk on from.
fn on_the_way(course: &Course, missed: Vec<usize>, ledger: &mut Ledger) -> Vec<Waypoint> {
    let mut loops = docking::Watch::new(course, missed);
    let mut waypoints = Thinned::new(WAYPOINTS_MAX);
    let mut standing = stability::Watch::new(course.settings, course.tolerances);
    let mut travel = travel::Watch::new(course.tolerances);
    let mut torque = torque::Watch::new(course.tolerances);
    let ended = walk(*course, None, course.tracks.duration, &mut |sample, waypoint| {
        if waypoints.turn() {
            waypoints.keep(waypoint());
        }
        loops.see(sample);
        if let Some(lack) = standing.see(sample, ledger) {
            ledger.fail(lack.failure());
        }
        travel.see(sample, ledger);
        torque.see(sample, ledger);
        true
    });
    if let Some(lack) = standing.end(course.tracks.duration) {
        ledger.fail(lack.failure());
    }
    if let Ended::Limit(time) = ended {
        ledger.fail(limit_reached(course.settings.samples_max, time));
    }
    ledger.verdict.samples = waypoints.seen();
    torque.between(&bolted::between(course), course);
    torque.overloaded().iter().for_each(|over| ledger.fail(over.failure()));
    torque.finish(ledger);
    standing.finish(ledger);
    let names = |link| link_name(course, link);
    travel.finish(names, ledger);
    loops.finish(ledger);
    waypoints.into_kept()
}

fn link_name(course: &Course, link: usize) -> String {
    let robot = &course.tracks.robot;
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

fn limit_reached(samples_max: usize, time: f64) -> Failure {
    let reached = quantity(time, Dimension::TIME);
    let message =
        format!("the judge took {samples_max} samples, the most allowed, and got to {reached} only");
    Failure { time, value: samples_max as f64, limit: samples_max as f64, ..Failure::form(message) }
}

fn too_many_samples(samples: usize, samples_max: usize) -> Failure {
    let message = format!(
        "at the stated time between samples the plan needs {samples} of them, and {samples_max} are allowed"
    );
    Failure { value: samples as f64, limit: samples_max as f64, ..Failure::form(message) }
}
