//! Random robots with random gaits, judged under full dynamics and played in MuJoCo with servos of three stiffnesses:
//! what the judge passes happens, and what happens with torque to spare is not refused. Skipped, with a message, where
//! Python or MuJoCo is missing.
#![allow(non_snake_case)]

use super::gait_programs::{Gait, gait};
use super::mjcf::{SURE, number, played, turned_apart};
use crate::support::desk;
use crate::support::properties::whole;
use crate::support::suite::MapFiles;
use modl::formats::mjcf;
use modl::geometry::Vec3;
use modl::interpret::Mode;
use modl::plan::verify::articulated::history;
use modl::plan::verify::verify;
use modl::plan::{DynamicsModel, Plan, Settings, Verdict, World, file};
use serde_json::{Value, json};
use std::io::Write as _;
use std::ops::Range;

/// The seeds of the gaits in the gate: a snake, a car, an inchworm and a cross, which take little time.
const GATE: Range<u64> = 2..6;

/// The number of gaits in `.ci/full dynamics`.
const MANY: usize = 200;

/// The first seed of as many others, by which no parameter of the judge was chosen.
const OTHERS: u64 = 100_000;

/// The stiffness of the servos, N·m/rad; their damping is in proportion, 6 N·m·s/rad at 150.
const STIFFNESSES: [f64; 3] = [60.0, 150.0, 500.0];

/// The reserves of torque and bond load that are compared.
const RESERVES: [f64; 5] = [0.0, 0.05, 0.10, 0.15, 0.20];

/// The error of travel that is none: a part of the travel, and a distance, m.
const TRAVEL_PART: f64 = 0.1;
const TRAVEL_LEAST: f64 = 5e-3;

/// The error of the turn that is none: a part of it, and an angle, rad.
const TURN_PART: f64 = 0.1;
const TURN_LEAST: f64 = 3.0 * DEGREE;

/// The greatest lag of a joint, and the greatest angle between the attitude of the base and that of the plan, rad.
const LAG_MAX: f64 = 10.0 * DEGREE;
const LEAN_MAX: f64 = 12.0 * DEGREE;

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The part of what happens with torque to spare that may be refused.
const REFUSED_MAX: f64 = 0.1;

/// A gait with its verdict and the simulations of it.
struct Case {
    seed: u64,
    gait: Gait,
    plan: Plan,
    model: String,
    verdict: Verdict,
    /// The vertical in the axes of the base, as planned, with its time, s.
    ups: Vec<(f64, Vec3)>,
    simulated: Vec<Value>,
}

/// Returns the case of a seed, not yet simulated; `None` if the robot meets itself, so that there is nothing to compare.
fn case(seed: u64) -> Option<Case> {
    let gait = gait(seed);
    // Without ground and weight only what a gait commands is judged.
    let program = format!(
        "{}emit(plan(b, world: world(ground: off, gravity: off, dynamics: statics)), \"p.json\")\n",
        gait.program
    );
    let (_, written, _) = desk::run(&MapFiles::of(&program), Mode::Run);
    written.written.get("p.json")?;
    let mut plan = written.plan("p.json");
    plan.verdict = None;
    let friction = gait.friction;
    plan.worlds[0].world = World { friction, dynamics: DynamicsModel::Full, ..World::default() };
    // The verdict tells what is left of the limits.
    plan.settings.reserve = 0.0;
    let verdict = verify(&plan);
    let model = mjcf::write(&plan).expect("the robot has links and joints");
    let tracks = plan.body.tracks().expect("the robot has joints");
    let moments = history(&plan, tracks.duration);
    let ups = moments.iter().map(|m| (m.time, m.base.rotation.inverse() * Vec3::z())).collect();
    Some(Case { seed, gait, plan, model, verdict, ups, simulated: vec![] })
}

impl Case {
    fn task(&self) -> Value {
        let text = file::write(&self.plan).expect("the plan can be written");
        json!({ "model": self.model, "plan": serde_json::from_str::<Value>(&text).expect("a plan file is JSON") })
    }

    /// Returns true if the judge passes the gait with this reserve.
    fn passes(&self, reserve: f64) -> bool {
        let left = [&self.verdict.torque_margin, &self.verdict.bond_margin];
        self.verdict.ok() && left.into_iter().flatten().all(|margin| margin.value >= reserve)
    }

    /// Returns the angle between the attitude of the base in a simulation and as planned, at its greatest, rad.
    fn lean(&self, simulated: &Value) -> f64 {
        let ups = simulated["ups"].as_array().expect("a list");
        let angle = |(index, up): (usize, &Value)| {
            let t = 0.1 * index as f64;
            let after = self.ups.partition_point(|(time, _)| *time < t).min(self.ups.len() - 1);
            Vec3::from([0, 1, 2].map(|axis| number(&up[axis]))).angle(&self.ups[after].1)
        };
        ups.iter().enumerate().map(angle).fold(0.0, f64::max)
    }

    /// Returns what does not happen as the verdict says. `as_known`: travel and turn may be off by as much as the verdict
    /// says.
    fn unlike(&self, simulated: &Value, as_known: bool) -> Vec<String> {
        let mut found = vec![];
        let lag = number(&simulated["lag"][0]);
        if simulated["fell"] == true {
            found.push("falls".to_owned());
        }
        if lag > LAG_MAX {
            found.push(format!("lags {:.0}°", lag / DEGREE));
        }
        let lean = self.lean(simulated);
        if lean > LEAN_MAX {
            found.push(format!("leans {:.0}°", lean / DEGREE));
        }
        let (theirs, off) = (travel(simulated).xy(), self.off(simulated));
        let known = if as_known { self.verdict.travel_within.unwrap_or(0.0) } else { 0.0 };
        if off > TRAVEL_LEAST.max(TRAVEL_PART * theirs.norm()).max(known) {
            found.push(format!("travels {:.0} mm, {:.0} mm off", 1e3 * theirs.norm(), 1e3 * off));
        }
        let yaw = number(&simulated["yaw"]);
        let known = if as_known { self.verdict.heading_within.unwrap_or(0.0) } else { 0.0 };
        if turned_apart(yaw, self.verdict.heading) > TURN_LEAST.max(TURN_PART * yaw.abs()).max(known) {
            found.push(format!("turns {:.0}°", yaw / DEGREE));
        }
        found
    }

    /// Returns the distance between where the base ends in a simulation and where the verdict says, m.
    fn off(&self, simulated: &Value) -> f64 {
        (travel(simulated) - Vec3::from(self.verdict.travel)).xy().norm()
    }

    fn happens(&self, as_known: bool) -> bool {
        self.simulated.iter().all(|simulated| self.unlike(simulated, as_known).is_empty())
    }

    /// Returns true if the gait happens with torque to spare.
    fn is_sure(&self) -> bool {
        self.happens(false) && self.needed() <= SURE
    }

    /// Returns the greatest torque that is needed, in parts of its limit.
    fn needed(&self) -> f64 {
        self.simulated.iter().map(|simulated| number(&simulated["needed"][0])).fold(0.0, f64::max)
    }

    /// Returns a row of the table of what disagrees.
    fn row(&self) -> String {
        let verdict = &self.verdict;
        let least = |margin: &Option<modl::plan::Worst>| margin.as_ref().map_or(1.0, |worst| worst.value);
        let simulated = self.simulated.iter().map(|simulated| {
            let unlike = self.unlike(simulated, false);
            if unlike.is_empty() {
                format!("happens, {:.1} mm off", 1e3 * self.off(simulated))
            } else {
                unlike.join(", ")
            }
        });
        let failed = verdict.failures.first().map_or("passed".to_owned(), |f| f.message.clone());
        format!(
            "| {} | {} | {:.2} | {:.0} mm, {:.0}° | {:.0} mm, {:.0} mm | {} | {:.2} | {failed} |",
            self.seed,
            self.gait.kind,
            1.0 - least(&verdict.torque_margin),
            1e3 * Vec3::from(verdict.travel).xy().norm(),
            verdict.heading / DEGREE,
            1e3 * verdict.slip.as_ref().map_or(0.0, |slip| slip.value),
            1e3 * verdict.travel_within.unwrap_or(0.0),
            simulated.collect::<Vec<_>>().join(" | "),
            self.needed(),
        )
    }
}

/// Returns the displacement of the base in a simulation, m.
fn travel(simulated: &Value) -> Vec3 {
    Vec3::from([0, 1, 2].map(|axis| number(&simulated["travel"][axis])))
}

/// Plays all cases at all stiffnesses, with options of the runner; false without MuJoCo.
fn play(cases: &mut [Case], options: &str) -> bool {
    cases.iter_mut().for_each(|case| case.simulated.clear());
    for stiffness in STIFFNESSES {
        let all: Vec<Value> = cases.iter().map(Case::task).collect();
        let Some(found) = played(&all, stiffness, "both", options) else { return false };
        cases.iter_mut().zip(found).for_each(|(case, simulated)| case.simulated.push(simulated));
    }
    true
}

fn say(line: &str) {
    writeln!(std::io::stderr(), "{line}").expect("stderr is open");
}

/// Prints the table by reserve, and what disagrees.
fn tell(cases: &[Case]) {
    for reserve in RESERVES {
        let passed: Vec<&Case> = cases.iter().filter(|case| case.passes(reserve)).collect();
        let of = |wrong: &dyn Fn(&Case) -> bool| passed.iter().filter(|case| wrong(case)).count();
        let gives_way = |word: &String| !word.starts_with("travels") && !word.starts_with("turns");
        let yields = |case: &Case| {
            case.simulated.iter().any(|simulated| case.unlike(simulated, false).iter().any(gives_way))
        };
        let refused = cases.iter().filter(|case| case.is_sure() && !case.passes(reserve)).count();
        say(&format!(
            "| {reserve:.2} | {} | {} | {} | {} | {} | {refused} of {} |",
            passed.len(),
            of(&yields),
            of(&|case| case.needed() > 1.0),
            of(&|case| !case.happens(false)),
            of(&|case| !case.happens(true)),
            cases.iter().filter(|case| case.is_sure()).count(),
        ));
    }
    let disagrees = |case: &&Case| {
        let passes = case.passes(Settings::reserve_default());
        passes && !case.happens(false) || !passes && case.is_sure()
    };
    cases.iter().filter(disagrees).for_each(|case| say(&case.row()));
}

/// Plays a set of gaits, prints its table, and fails where what is passed does not happen, as far as the verdict says it is known, or
/// more is refused of what happens with torque to spare.
fn compare(mut cases: Vec<Case>) {
    if !play(&mut cases, "") {
        return;
    }
    tell(&cases);
    let reserve = Settings::reserve_default();
    let passed: Vec<&Case> = cases.iter().filter(|case| case.passes(reserve)).collect();
    let wrong: Vec<String> =
        passed.iter().filter(|case| !case.happens(true)).map(|case| case.row()).collect();
    assert!(wrong.is_empty(), "passed, and does not happen:\n{}", wrong.join("\n"));
    // A generator whose gaits all pass, or all fail, would show nothing.
    let part = passed.len() as f64 / cases.len() as f64;
    assert!(cases.len() < MANY || (0.3..0.7).contains(&part), "{part:.2} of the gaits pass");
    let sure: Vec<&Case> = cases.iter().filter(|case| case.is_sure()).collect();
    let refused = sure.iter().filter(|case| !case.passes(reserve)).count();
    assert!(refused as f64 <= REFUSED_MAX * sure.len() as f64, "{refused} of {} are refused", sure.len());
}

#[test]
fn random_gaits_that_pass_happen_and_few_that_happen_are_refused() {
    match whole() {
        true => {
            [0, OTHERS].into_iter().for_each(|first| compare((first..).filter_map(case).take(MANY).collect()))
        }
        false => compare(GATE.filter_map(case).collect()),
    }
}

/// A snake whose weight the ground does not balance for 60 ms as it drops its middle.
const UNBALANCED: u64 = 26;

#[test]
fn a_gait_that_the_ground_does_not_balance_for_a_moment_goes_on() {
    let mut cases = [case(UNBALANCED).expect("it does not meet itself")];
    assert!(cases[0].verdict.ok(), "{:?}", cases[0].verdict.failures);
    let notes = cases[0].verdict.notes.join("\n");
    assert!(notes.contains("no forces of the ground balance 0.21 of the weight"), "{notes}");
    if play(&mut cases, "") {
        assert!(cases[0].happens(false), "{}", cases[0].row());
    }
}

/// Prints the rows of the seeds that `MODL_SEEDS` names (`7,75`), with contacts of the exported model and with others: what depends
/// on how MuJoCo makes friction is no fault of a verdict. Without the variable nothing runs.
#[test]
fn random_gaits_of_some_seeds_beside_other_contacts() {
    let Ok(seeds) = std::env::var("MODL_SEEDS") else { return };
    let seeds = seeds.split(',').map(|seed| seed.trim().parse().expect("a seed"));
    let mut cases: Vec<Case> = seeds.filter_map(case).collect();
    for contacts in [
        "",
        ", plain=True",
        ", noslip=20",
        ", impratio=20000.0",
        ", softness=5e-3, impratio=20.0",
        ", softness=2e-3, impratio=20.0",
        ", dry=True",
    ] {
        say(&format!("contacts of the exported model{contacts}:"));
        if !play(&mut cases, contacts) {
            return;
        }
        cases.iter().for_each(|case| say(&case.row()));
    }
}
