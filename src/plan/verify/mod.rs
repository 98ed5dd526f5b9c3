//! The one judge of plans. It knows no planner, and believes nothing that a plan says of itself.
//!
//! A plan's robot is walked over its ground from sample to sample ([`walk`]); each check watches it.
//! Joint and motor limits are judged on the polynomials themselves.
#![allow(non_snake_case)]

mod ledger;
mod tolerances;

mod extremum;
mod limits;

mod support;

mod model;

mod align;
mod carry;
mod contact;
mod descend;
mod footprint;
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
mod judge;
mod meeting;
mod nearness;
mod thinned;

pub mod lattice;
mod lattice_bound;
mod lattice_boxes;
mod lattice_contacts;
mod lattice_grid;
mod lattice_lanes;
mod lattice_law;
mod lattice_moments;
mod lattice_tiles;
mod lattice_window;

pub mod truss;
mod truss_around;
mod truss_distance;
mod truss_lengths;
mod truss_margins;
mod truss_shape;
mod truss_standing;

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

use super::{
    Body, Check, CheckKind, Failure, Plan, Provenance, Settings, Status, Tracks, Verdict, World, WorldFrom,
    sound,
};
use crate::robot::{Assembly, State};

/// Judges a plan under its stated worlds and settings. What it says of itself is recomputed.
pub fn verify(plan: &Plan) -> Verdict {
    let faults = sound::faults(plan);
    if !faults.is_empty() {
        return unsound(faults);
    }
    match &plan.body {
        Body::Tracks(tracks) => judge::tracks(plan, tracks),
        Body::Stages(stages) => lattice::judge(plan, stages),
        Body::NodePaths(paths) => truss::judge(plan, paths),
    }
}

/// Judges one state of a robot: Definition V.2 of the compositional-design paper.
pub fn verify_state(robot: &Assembly, state: &State, world: &World, settings: &Settings) -> Verdict {
    let tracks = Tracks {
        robot: robot.clone(),
        start: state.clone(),
        tracks: vec![],
        docks: vec![],
        duration: 0.0,
        start_causes: vec![],
        bond_causes: vec![],
    };
    verify(&Plan {
        provenance: Provenance::default(),
        worlds: vec![WorldFrom { from: 0.0, world: *world }],
        settings: *settings,
        library: robot.library.clone(),
        body: Body::Tracks(tracks),
        program: None,
        nominal: false,
        causes: vec![],
        exemptions: vec![],
        verdict: None,
    })
}

/// A plan that means nothing is judged no further.
fn unsound(faults: Vec<String>) -> Verdict {
    Verdict {
        checks: vec![Check { kind: CheckKind::Form, status: Status::Failed }],
        failures: faults.into_iter().map(Failure::form).collect(),
        ..Verdict::default()
    }
}
