//! Lattice plans for the tests and the benches: ways in the paper's units, as plans for the judge.
#![allow(dead_code)]

use modl::plan::verify::verify;
use modl::plan::{
    Body, Cause, CellLimits, Model, Plan, Provenance, Ratio, Settings, Stages, Verdict, World, WorldFrom,
};
use modl::planners::squeeze::{Motion, PlanHeader, PlanLimits, Profile};
use modl::robot::{Cell, Library};
use std::sync::Arc;

/// Limits of 1 in units of 1.
pub const UNIT: CellLimits = CellLimits { smallest: Ratio(1, 2), speed_squared: Ratio::ONE };
pub const TERMS: PlanLimits = PlanLimits { cell: UNIT, profile: Profile::BangBang, euclidean: false };
pub const BALANCED: Model = Model { balanced: true, contact_force: None, euclidean: false };
pub const PAPER: Model = Model { balanced: false, contact_force: None, euclidean: false };

pub fn unit_cell() -> Cell {
    Cell { name: "Unit".into(), size: 1.0, shrinks_to: 0.5, mass: 1.0, force: 1.0, speed: 1.0 }
}

pub fn stages_of(motion: Motion, model: Model) -> Stages {
    motion.into_stages(PlanHeader { cell: 0, time_unit: 1.0, limits: UNIT, model })
}

pub fn plan_of(stages: Stages) -> Plan {
    let cause = Cause {
        file: "test.mod".into(),
        line: 1,
        column: 1,
        text: "squeeze(...)".into(),
        instance: String::new(),
        caller: None,
    };
    Plan {
        provenance: Provenance { planner: "squeeze".into(), ..Provenance::default() },
        worlds: vec![WorldFrom { from: 0.0, world: World::FREE }],
        settings: Settings::default(),
        library: Arc::new(Library { cells: vec![unit_cell()], ..Library::default() }),
        body: Body::Stages(stages),
        program: None,
        nominal: false,
        causes: vec![cause],
        exemptions: vec![],
        paths: vec![],
        verdict: None,
    }
}

pub fn judged_plan(plan: &Plan) -> Verdict {
    verify(plan)
}

pub fn judged(motion: Motion, model: Model) -> Verdict {
    verify(&plan_of(stages_of(motion, model)))
}
