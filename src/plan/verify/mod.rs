//! The one judge of plans. It knows no planner, and uses nothing that a plan states about its own
//! correctness.
//!
//! There is a judge for each family of plans: [`articulated`] robots are followed from sample to sample, and between
//! samples by conservative advancement, [`lattice`]s are judged in whole numbers, [`truss`]es in closed form. Each
//! family's module describes the order of its checks.
#![allow(non_snake_case)]

mod ledger;
mod support_polygon;

pub mod articulated;
pub mod lattice;
pub mod truss;

use super::{
    Body, Check, CheckKind, Failure, Plan, PlanFault, Settings, Status, Tracks, Verdict, World, validation,
};
use crate::robot::{Assembly, State};

/// Returns the verdict on a plan under its own worlds and settings (Definition V.3 of the compositional-design paper,
/// Tosun, Jing, Kress-Gazit and Yim); the verdict that the plan states is not read. A plan that [`validation::check`]
/// refuses gets a verdict whose only check, the form, has failed.
pub fn verify(plan: &Plan) -> Verdict {
    if let Err(fault) = validation::check(plan) {
        return malformed(&fault);
    }
    match &plan.body {
        Body::Tracks(tracks) => articulated::judge(plan, tracks),
        Body::Stages(stages) => lattice::judge(plan, stages),
        Body::NodePaths(paths) => truss::judge(plan, paths),
    }
}

/// Returns the verdict on one state of a robot, judged as a plan that lasts no time, under one world and without
/// exemptions: Definition V.2 of the compositional-design paper (Tosun, Jing, Kress-Gazit and Yim). `settings`: the
/// settings of the judge.
pub fn verify_state(robot: &Assembly, state: &State, world: &World, settings: &Settings) -> Verdict {
    let tracks = Tracks::at_rest(robot.clone(), state.clone());
    verify(&Plan::bare(robot.library.clone(), Body::Tracks(tracks), *world, *settings))
}

/// Returns the verdict on a plan with a fault of form, which is judged no further.
fn malformed(fault: &PlanFault) -> Verdict {
    Verdict {
        checks: vec![Check { kind: CheckKind::Form, status: Status::Failed }],
        failures: vec![Failure::form(fault.to_string())],
        ..Verdict::default()
    }
}
