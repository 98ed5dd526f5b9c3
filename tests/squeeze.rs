//! Lattice plans: the planner against values found another way, and the judge against plans that are
//! wrong in one way each.
//!
//! `tests/squeeze/truth.json` comes from an independent reference: an exact verifier of end points with
//! dense sampling, in another language.

use modl::plan::verify::verify;
use modl::plan::{
    Body, Cause, CauseId, CellLimits, CheckKind, Ground, Model, Plan, Provenance, Ratio, Settings, Stage,
    Stages, Verdict, World, WorldFrom,
};
use modl::planners::squeeze::{Profile, Terms, Way, accordion, fold, shear};
use modl::robot::{Cell, Library};
use serde_json::Value;
use std::sync::Arc;

/// Limits of 1 in units of 1, as in the paper.
pub const UNIT: CellLimits = CellLimits { smallest: Ratio(1, 2), speed_squared: Ratio::ONE };
pub const TERMS: Terms = Terms { limits: UNIT, profile: Profile::BangBang };
const BALANCED: Model = Model { balanced: true, contact_force: None };
const PAPER: Model = Model { balanced: false, contact_force: None };

fn truth() -> Value {
    serde_json::from_str(include_str!("squeeze/truth.json")).expect("the truth is JSON")
}

pub fn stages_of(way: Way, model: Model) -> Stages {
    let mut configurations = way.configurations.into_iter();
    let start = configurations.next().expect("a way begins somewhere");
    let stage = |(leg, end): (modl::planners::squeeze::Leg, _)| Stage {
        name: leg.name.into(),
        time_squared: leg.time_squared,
        law: leg.law,
        end,
        cause: CauseId(0),
    };
    Stages {
        cell: 0,
        count: way.count,
        time_unit: 1.0,
        limits: UNIT,
        model,
        start,
        stages: way.legs.into_iter().zip(configurations).map(stage).collect(),
    }
}

pub fn plan_of(stages: Stages) -> Plan {
    let cell = Cell { name: "Unit".into(), size: 1.0, shrinks_to: 0.5, mass: 1.0, force: 1.0, speed: 1.0 };
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
        worlds: vec![WorldFrom {
            from: 0.0,
            world: World { gravity: 0.0, ground: Ground::Off, friction: 1.0 },
        }],
        settings: Settings::default(),
        library: Arc::new(Library { cells: vec![cell], ..Library::default() }),
        body: Body::Stages(stages),
        program: None,
        nominal: false,
        causes: vec![cause],
        exemptions: vec![],
        verdict: None,
    }
}

pub fn judged(way: Way, model: Model) -> Verdict {
    verify(&plan_of(stages_of(way, model)))
}

fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-9 * expected.abs().max(1.0)
}

#[test]
fn totals_are_those_of_the_reference() {
    for row in truth()["table"].as_array().expect("a list") {
        let n = row["n"].as_u64().expect("a number");
        if n > 20_000 {
            continue;
        }
        type Construction = fn(Terms, u64) -> Result<Way, modl::planners::squeeze::Refusal>;
        for (name, construction) in
            [("fold", fold as Construction), ("accordion", accordion), ("shear", shear)]
        {
            let way = construction(TERMS, n).expect("there is a way");
            let expected = row[name].as_f64().expect("a number");
            let found = way.duration();
            assert!(near(found, expected), "{name} of {n}: {found} where {expected} is right");
        }
    }
}

#[test]
fn rows_become_columns() {
    for n in (1..70).chain([96, 97, 127, 128, 129, 256, 1000]) {
        for (name, way) in
            [("fold", fold(TERMS, n)), ("accordion", accordion(TERMS, n)), ("shear", shear(TERMS, n))]
        {
            let way = way.expect("there is a way");
            let balanced = way.is_balanced();
            let verdict = judged(way.clone(), PAPER);
            assert!(verdict.ok(), "{name} of {n}: {:?}", verdict.failures);
            let dynamics = verdict.dynamics.expect("a lattice has them");
            assert_eq!(dynamics.angular_momentum == 0.0, balanced, "{name} of {n}");
        }
    }
    let _ = (BALANCED, CheckKind::Form);
}
