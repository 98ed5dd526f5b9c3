//! Plan files of every family, altered by a generator: the judge accepts one only where a second look finds nothing
//! wrong with what it describes, never breaks down, and computes no longer than ten seconds.
//!
//! A part of them here; a thousand with `MODL_WHOLE=1`, from another seed with `MODL_SEED`.

use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::json::Altered;
use crate::fuzz::inputs::plans::{FOLDS, HELD, MORPHS, ROLLS, SQUEEZES, UNWINDS, WALKS};
use crate::support::properties::whole;
use crate::support::recount;
use modl::behavior::unfaithful;
use modl::plan::facts::{self, declarations};
use modl::plan::{self, Body, CauseId, Plan, Provenance, verify::verify};
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// The longest that the judge may compute for one file, s.
const SECONDS_MAX: f64 = 10.0;

/// Half of the alterations are in what moves, a third in the library, the rest anywhere.
const PARTS: &[&str] = &["/body", "/body", "/body", "/library", "/library", ""];

/// A plan that is right, with its file to be altered.
struct Family {
    name: &'static str,
    file: Altered,
    plan: Plan,
}

fn families(whole: bool) -> Vec<Family> {
    let programs = [
        ("held", HELD),
        ("rolls", ROLLS),
        ("unwinds", UNWINDS),
        ("folds", FOLDS),
        ("squeezes", SQUEEZES),
        ("morphs", MORPHS),
        ("walks", WALKS),
    ];
    let family = |(name, program): (&'static str, &str)| {
        let (observed, desk, _) = crate::support::desk::run(
            &crate::support::suite::MapFiles::of(program),
            modl::interpret::Mode::Run,
        );
        let errors: Vec<_> =
            observed.diagnostics.iter().filter(|d| d.is_error()).map(|d| &d.message).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
        let text = desk.text("p.plan.json");
        let plan = plan::file::read(text).expect("it was written to be read");
        assert!(verify(&plan).ok() && unfaithful(&plan).is_none(), "{name} is right");
        assert_eq!(recount::wrongs(&plan), Vec::<String>::new(), "{name}: the second look agrees");
        let file: Value = serde_json::from_str(text).expect("plans are JSON");
        Family { name, file: Altered::new(file), plan }
    };
    // The judge takes a second for a robot of so many modules.
    programs.into_iter().filter(|(name, _)| whole || *name != "unwinds").map(family).collect()
}

/// A plan without what no judge rests on: who made it, who is to blame, names of stages, what it says of itself.
fn meaning(plan: &Plan) -> Plan {
    let mut plan = plan.clone();
    plan.provenance = Provenance::default();
    (plan.causes, plan.verdict, plan.nominal, plan.program) = (Vec::new(), None, false, None);
    plan.exemptions.iter_mut().for_each(|e| e.cause = CauseId(0));
    match &mut plan.body {
        Body::Tracks(tracks) => {
            tracks.tracks.iter_mut().flat_map(|t| &mut t.segments).for_each(|s| s.cause = CauseId(0));
            tracks.events.iter_mut().for_each(|dock| dock.cause = CauseId(0));
            (tracks.start_causes, tracks.bond_causes) = (Vec::new(), Vec::new());
            tracks.robot.name.clear();
        }
        Body::Stages(stages) => stages.stages.iter_mut().for_each(|stage| {
            stage.cause = CauseId(0);
            stage.name.clear();
        }),
        Body::NodePaths(paths) => {
            paths.keyframes.iter_mut().for_each(|keyframe| keyframe.cause = CauseId(0));
            paths.events.iter_mut().for_each(|event| event.cause = CauseId(0));
        }
    }
    plan
}

/// Returns the faults of a plan that was accepted, in words; none for one that means the same as before.
fn wrongs(family: &Family, plan: &Plan) -> Vec<String> {
    if meaning(plan) == meaning(&family.plan) {
        return Vec::new();
    }
    let mut wrongs = recount::wrongs(plan);
    // Who reads the facts sees that the modules are others.
    let digests = |plan: &Plan| {
        let all = declarations(&plan.library).into_iter().map(|d| facts::facts(&plan.library, d).digest);
        all.collect::<Vec<_>>()
    };
    let judged =
        |plan: &Plan| (plan.library.modules.clone(), plan.library.cells.clone(), plan.library.struts.clone());
    if judged(plan) != judged(&family.plan) && digests(plan) == digests(&family.plan) {
        wrongs.push("the library is another, and the facts are the same".into());
    }
    wrongs
}

#[derive(Debug, PartialEq)]
enum Outcome {
    Refused,
    Accepted(Box<Plan>),
}

fn judged(text: &str) -> Outcome {
    let Ok(plan) = plan::file::read(text) else { return Outcome::Refused };
    if verify(&plan).ok() && unfaithful(&plan).is_none() {
        Outcome::Accepted(Box::new(plan))
    } else {
        Outcome::Refused
    }
}

/// Returns the seconds that this thread has computed for, which others on the machine do not lengthen; since
/// `test_began`, where the system does not count them.
fn computed(test_began: Instant) -> f64 {
    // The first of three numbers, in nanoseconds.
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let counted = counted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    counted.map_or_else(|| test_began.elapsed().as_secs_f64(), |nanoseconds| nanoseconds * 1e-9)
}

#[test]
fn altered_files_are_accepted_only_where_they_are_right() {
    let whole = whole();
    let seed = std::env::var("MODL_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(1_u64);
    let count = if whole { 1000 } else { 175 };
    let families = families(whole);
    let test_began = Instant::now();
    let (mut faults, mut accepted, mut slowest) = (Vec::new(), 0, (0.0, String::new()));
    for k in 0..count {
        let family = &families[k % families.len()];
        let mut dice = Dice::new(seed.wrapping_mul(1_000_003).wrapping_add(k as u64));
        let mut file = family.file.file.clone();
        let mut done = vec![family.name.to_owned()];
        (0..1 + dice.below(2)).for_each(|_| done.push(family.file.alter(&mut file, &mut dice, PARTS)));
        let done = done.join("\n    ");
        let begun = computed(test_began);
        let outcome = catch_unwind(AssertUnwindSafe(|| judged(&file.to_string())));
        let seconds = computed(test_began) - begun;
        if seconds > slowest.0 {
            slowest = (seconds, done.clone());
        }
        if seconds > SECONDS_MAX {
            faults.push(format!("takes {seconds:.1} s: {done}"));
        }
        match outcome {
            Err(_) => faults.push(format!("breaks the judge: {done}")),
            Ok(Outcome::Refused) => {}
            Ok(Outcome::Accepted(plan)) => {
                accepted += 1;
                let wrongs = wrongs(family, &plan);
                if !wrongs.is_empty() {
                    faults.push(format!(
                        "accepted, though {}: {done}",
                        wrongs[..wrongs.len().min(3)].join(", ")
                    ));
                }
            }
        }
    }
    println!(
        "{accepted} of {count} altered files were accepted; the slowest took {:.1} s: {}",
        slowest.0, slowest.1
    );
    assert!(faults.is_empty(), "{} of {count}:\n{}", faults.len(), faults.join("\n"));
    // Most alterations are seen, and some change nothing that counts.
    assert!(accepted > count / 20 && accepted < count * 7 / 10, "{accepted} of {count} accepted");
}
