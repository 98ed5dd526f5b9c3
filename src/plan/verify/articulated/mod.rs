//! The judgement of articulated robots, whose plans are tracks of joints.
//!
//! In this order: joint and motor limits, and rest at both ends, from the control points of the polynomials; the paths in space
//! that the plan states of ports;
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

mod floating;
mod rollout;
mod rollout_input;
mod sample;
mod sampling;

mod dynamics;

mod base_motion;
mod contact_forces;
mod contact_lp;
mod fixed_base;
mod load_limits;
mod slope;
mod snapping;
mod stability;
mod statics;
mod torque;

mod advancement;
mod base_path;
mod between_clusters;
mod bodies;
mod bonded;
mod interval_state;
mod module_clusters;
mod motion_bounds;
mod polyline;
mod reference_links;
mod repetition;
mod separation;
mod window_begin;
mod work_budget;

pub mod collision;

mod blame;
mod clearance;
mod cluster_balls;
mod cluster_paths;
mod clusters;
mod collision_report;
mod decimated;
mod dock_turns;
mod docking;
mod entry;
mod history;
mod in_force;
mod joining;
mod link_paths;
mod one_robot;
mod parted;
mod placed_clusters;
mod stated_paths;
mod succession;
mod support_area;
mod time_series;

pub use bodies::{Bodies, UnsoundLink};
pub use clearance::{clearances, clearances_at, collision_point};
pub use cluster_paths::{ClusterPath, ClusterPaths, comes_apart, standing, start_poses};
pub use collision::{Collision, Findings};
pub use contact::{ContactPatch, ContactPoint};
pub use dock_turns::dock_turns;
pub use entry::Entry;
pub use history::{CONTACTS_MAX, MOMENTS_MAX, Moment, base_at, history, tipped_base};
pub use link_paths::LinkPaths;
pub use model::Model;
pub use rollout::{Checkpoint, RolloutEnd, roll_out};
pub use rollout_input::Rollout;
pub use sample::{Sample, TipOver};
pub use stance::Stance;
pub use support_area::area;
pub use time_series::{Detail, GroundForce, Instant, instants};
pub use tolerances::{Precision, Tolerances};

use super::ledger::Ledger;
use crate::plan::{CheckKind, Plan, Status, Tracks, Verdict};

/// Returns the verdict on the plan of an articulated robot, whose body is `tracks`. The plan must pass
/// [`validation::check`](crate::plan::validation::check), which is not done here: for one that does not, the verdict
/// may be wrong, or this panics.
pub fn judge(plan: &Plan, tracks: &Tracks) -> Verdict {
    let tolerances = Tolerances::default();
    let mut ledger = Ledger::new(&plan.exemptions, tracks.duration);
    let rollout = Rollout::of(plan, tracks, &tolerances);
    limits::judge(tracks, rollout.is_full(), &tolerances, &mut ledger);
    rest::judge(tracks, &tolerances, &mut ledger);
    stated_paths::judge(plan, tracks, &tolerances, &mut ledger);
    match parted::clusters(&rollout) {
        Some(mut clusters) => {
            parted::judge(&rollout, &mut clusters, &mut ledger);
            if rollout.is_full() {
                ledger.drop_consequences();
            }
            parted::in_words(&clusters).into_iter().for_each(|note| ledger.note(note));
            if rollout.is_full() {
                dynamics::bound_travel(&mut ledger.verdict);
            }
        }
        None => {
            let missed = docking::judge(&rollout, &mut ledger);
            one_robot::judge(&rollout, missed, &mut ledger, None);
        }
    }
    ledger.check(CheckKind::Form, Status::Proved);
    // Conflicts are found where a behaviour becomes a plan: here each joint has one track.
    ledger.check(CheckKind::Conflict, Status::Proved);
    ledger.finish()
}
