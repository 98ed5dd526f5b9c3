//! `load_plan`: ways that were found in one run serve in another; what a file may not do.

use crate::support::desk::{run, run_clean};
use crate::support::motions::STATICS;
use crate::support::suite::{MapFiles, Observed};
use modl::interpret::Mode;
use modl::plan::{self, CauseId, Ground, Plan, World};

const SHAPES: [&str; 3] = ["Chair", "Spider", "Human"];

/// Files of a project with a program, and with plans to the snake from a run before.
fn project(main: &str) -> MapFiles {
    let mut text = format!("use std.rofi.{{{}}}\n", SHAPES.join(", "));
    for shape in SHAPES {
        text += &format!("emit(tosnake({shape}()), \"{shape}.plan.json\")\n");
    }
    let desk = run_clean(&text);
    let mut files = MapFiles::of(main);
    for shape in SHAPES {
        let name = format!("{shape}.plan.json");
        files.0.insert(name.clone(), desk.text(&name).as_bytes().to_vec());
    }
    files
}

fn errors(observed: &Observed) -> Vec<String> {
    observed.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect()
}

/// When which joint is where and which bond holds, without who commanded it.
fn motion(plan: &Plan) -> impl PartialEq + use<> {
    let mut tracks = plan.body.tracks().expect("a plan of joints").clone();
    let nobody = CauseId(0);
    tracks.tracks.iter_mut().flat_map(|track| &mut track.segments).for_each(|s| s.cause = nobody);
    tracks.events.iter_mut().for_each(|dock| dock.cause = nobody);
    (tracks.robot, tracks.start, tracks.tracks, tracks.events, tracks.duration)
}

#[test]
fn stored_ways_are_those_that_a_search_finds() {
    let main = "use std.rofi.{Chair, Spider}
let chair = load_plan(\"Chair.plan.json\", Chair())
let spider = load_plan(\"Spider.plan.json\", Spider())
let p = chair ++ reverse(spider)
let q = tosnake(Chair()) ++ reverse(tosnake(Spider()))
print(verify(p).ok, p.steps == q.steps, p.actions == q.actions, p.duration == q.duration)
print(reconfigure(Chair(), Spider()).duration <= p.duration)
print(verify(p ++ plan(Spider().crawl(), world: world(dynamics: statics))).ok)
emit(p, \"p.plan.json\")
emit(q, \"q.plan.json\")
emit(chair, \"chair.plan.json\")
";
    let files = project(main);
    let (observed, desk, _) = run(&files, Mode::Run);
    assert!(errors(&observed).is_empty(), "{:?}", errors(&observed));
    assert_eq!(desk.printed, ["true true true true", "true", "true"]);
    let read = |name: &str| plan::file::read(desk.text(name)).expect("it was written to be read");
    assert!(motion(&read("p.plan.json")) == motion(&read("q.plan.json")), "another motion");
    let chair = read("chair.plan.json");
    assert_eq!(chair.provenance.planner, "tosnake");
    assert_eq!(modl::behavior::unfaithful(&chair), None);
}

/// The names are those of the robot that the plan is for now.
#[test]
fn a_stored_plan_takes_the_names_of_the_robot_that_it_is_for() {
    let main = "use std.rofi.Chair
config Furniture closed { part piece: Chair }
emit(load_plan(\"Chair.plan.json\", Furniture), \"p.plan.json\")
";
    let (observed, desk, _) = run(&project(main), Mode::Run);
    assert!(errors(&observed).is_empty(), "{:?}", errors(&observed));
    let plan = plan::file::read(desk.text("p.plan.json")).expect("it was written to be read");
    let tracks = plan.body.tracks().expect("a plan of joints");
    assert!(tracks.robot.modules.iter().all(|module| module.name.starts_with("piece.")));
}

#[test]
fn what_does_not_fit_or_is_not_sound_is_refused() {
    let spoilt = |name: &str, how: &dyn Fn(String) -> String| {
        let mut files = project(&format!("use std.rofi.Chair\nlet p = load_plan(\"{name}\", Chair())\n"));
        if let Some(bytes) = files.0.get_mut("Chair.plan.json") {
            *bytes = how(String::from_utf8(bytes.clone()).expect("plans are text")).into_bytes();
        }
        let (observed, _, _) = run(&files, Mode::Run);
        errors(&observed)
    };
    let as_it_is = |text: String| text;
    // As many modules, and another robot.
    let other = spoilt("Spider.plan.json", &as_it_is);
    assert!(other[0].starts_with("E0410 the plan in `Spider.plan.json` does not begin"), "{other:?}");
    let missing = spoilt("nowhere.plan.json", &as_it_is);
    assert!(missing[0].starts_with("E0703"), "{missing:?}");
    let half = spoilt("Chair.plan.json", &|text| text[..text.len() / 2].to_owned());
    assert!(half[0].starts_with("E0704"), "{half:?}");
    let program = spoilt("main.mod", &as_it_is);
    assert!(program[0].starts_with("E0704"), "{program:?}");
    // The program in the file turns another way than the motion that the judge sees.
    let two_faced = spoilt("Chair.plan.json", &|text| {
        let mut plan = plan::file::read(&text).expect("it was written to be read");
        plan.program = plan::reversed(&plan).program;
        plan::file::write(&plan).expect("numbers are finite")
    });
    assert!(two_faced[0].starts_with("E0704"), "{two_faced:?}");
}

/// A plan that was found for no weight, in a file that says that it was proved under gravity.
#[test]
fn a_stored_verdict_is_not_believed() {
    let main = "use std.rofi.Chair
let p = load_plan(\"Chair.plan.json\", Chair())
print(verify(p).ok)
emit(p, \"p.plan.json\")
";
    let mut files = project(main);
    let bytes = files.0.get_mut("Chair.plan.json").expect("it was put there");
    let mut plan = plan::file::read(std::str::from_utf8(bytes).expect("plans are text")).expect("a plan");
    plan.worlds[0].world = World { ground: Ground::Held, ..STATICS };
    assert!(plan.verdict.as_ref().is_some_and(|verdict| verdict.ok()));
    *bytes = plan::file::write(&plan).expect("numbers are finite").into_bytes();
    let (observed, desk, _) = run(&files, Mode::Run);
    assert_eq!(desk.printed, ["false"]);
    assert!(errors(&observed)[0].starts_with("E0603"), "{:?}", errors(&observed));
    assert!(desk.written.is_empty());
}
