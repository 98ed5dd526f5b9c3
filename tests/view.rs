//! Pages: one file that loads nothing and can't be broken out of, the same bytes for the same plan.

use crate::cli::{Sandbox, json};
use crate::plan_operations::{plan_of, squeezing};
use crate::programs::*;
use crate::robots::{LEFT, chain};
use modl::plan::{Body, Plan};
use modl::view::{Showing, page};
use serde_json::Value;

/// Most bytes of a page without its plan.
const PAGE_BYTES_MAX: usize = 120_000;

const HOSTILE: &str = "</script><img src=x onerror=alert(1)>\"'&\u{202e}\u{0}\u{1}";

fn rover() -> Plan {
    plan_of(plan(chain(1), spin_for(LEFT as u32, 1.0, 1.0, 0)).expect("it can be scheduled"))
}

fn shown(title: &str, plan: &Plan) -> String {
    page(&Showing { title, plan, texts: &[], command: "modl run rover.mod" })
}

/// The text of the plan's data, as it stands in the page.
fn data_text(page: &str) -> &str {
    let from = page.split_once("id=\"plan\">").expect("a page holds a plan").1;
    from.split_once("</script>").expect("the data ends").0
}

fn data(page: &str) -> Value {
    serde_json::from_str(data_text(page)).expect("the data is JSON")
}

#[test]
fn a_page_is_small_and_loads_nothing() {
    let page = shown("rover", &rover());
    let own = page.len() - data_text(&page).len();
    assert!(own <= PAGE_BYTES_MAX, "{own} bytes without the plan");
    for loading in ["://", "src=", "href=", "import ", "@import", "url(", "fetch(", "XMLHttp", "Worker("] {
        assert!(!page.replace(data_text(&page), "").contains(loading), "{loading}");
    }
}

#[test]
fn names_can_not_break_out() {
    let mut plan = rover();
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a robot's plan") };
    tracks.robot.modules[0].name = HOSTILE.into();
    let page = shown(HOSTILE, &plan);
    let text = data_text(&page);
    assert!(!text.contains(['<', '>', '&']) && !text.contains(char::is_control), "{text}");
    assert_eq!(page.matches("</script>").count(), 2, "the plan's and the scripts' own");
    assert_eq!(page.matches("<img").count(), 0);
    assert_eq!(data(&page)["body"]["modules"][0][0], HOSTILE, "and yet the name is there");
    let title = page.split_once("<title>").expect("a title").1.split_once("</title>").expect("its end").0;
    assert!(title.starts_with("&lt;/script&gt;&lt;img") && !title.contains(char::is_control), "{title}");
}

#[test]
fn the_same_plan_gives_the_same_bytes() {
    assert!(shown("rover", &rover()) == shown("rover", &rover()));
}

#[test]
fn a_plan_of_too_many_segments_is_thinned_and_says_so() {
    let mut plan = rover();
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a robot's plan") };
    let count = 1_000_000;
    let (cause, time) = (tracks.tracks[0].segments[0].cause, |i: usize| i as f64 / 1024.0);
    let angle = |i: usize| time(i) * 0.1;
    let segment = |i: usize| modl::plan::Segment {
        start: time(i),
        end: time(i + 1),
        control: vec![angle(i), angle(i + 1)],
        cause,
    };
    tracks.tracks[0].segments = (0..count).map(segment).collect();
    tracks.duration = time(count);
    // The walk over the ground is not what is tested here.
    plan.settings.samples_max = 10;
    let page = shown("rover", &plan);
    assert!(page.len() < 6_000_000, "{} bytes", page.len());
    let data = data(&page);
    let notes = data["notes"].as_array().expect("a list");
    assert!(notes.iter().any(|n| n.as_str().is_some_and(|n| n.contains("1000000 segments"))), "{notes:?}");
    let segments = data["body"]["tracks"][0][1].as_array().expect("a list");
    let last = segments.last().expect("some are left").as_array().expect("a list");
    let end = last.last().and_then(Value::as_f64).expect("a number");
    assert!((end - angle(count)).abs() < 1e-6, "it still ends where it ends: {end}");
}

#[test]
fn lattices_have_their_stages() {
    let mut plan = rover();
    let cell = modl::robot::Cell {
        name: "Cube".into(),
        size: 0.1,
        shrinks_to: 0.05,
        mass: 1.0,
        force: 10.0,
        speed: 0.1,
    };
    plan.library = std::sync::Arc::new(modl::robot::Library { cells: vec![cell], ..Default::default() });
    (plan.body, plan.program) = (Body::Stages(squeezing()), None);
    let data = data(&shown("row", &plan));
    assert_eq!(data["body"]["form"], "stages");
    assert_eq!(data["verdict"]["stamp"], "not judged");
}

/// An arm of eight modules that a car can't balance.
const FALLS: &str = include_str!("acceptance/falls.mod");

#[test]
fn what_fails_is_shown_up_to_the_failure_and_reported_with_the_page() {
    let text =
        FALLS.replace("emit(Backhoe().dig(), \"dig.plan.json\")", "show(Backhoe().dig(), \"dig.html\")");
    let sandbox = Sandbox::new(&[("dig.mod", text.as_bytes())]);
    let ran = sandbox.run(&["run", "--json", "dig.mod"]);
    assert_eq!(ran.code, 1, "{}", ran.out);
    let report = json(&ran);
    assert_eq!(report["written"][0], "out/dig.html");
    let hints = report["diagnostics"][0]["hints"].to_string();
    assert!(hints.contains("open `out/dig.html`"), "{hints}");
    let page = std::fs::read_to_string(sandbox.path("out/dig.html")).expect("written");
    let data = data(&page);
    assert_eq!(data["verdict"]["stamp"], "failed");
    let (end, failed) = (data["end"].as_f64(), data["verdict"]["failures"][0]["time"].as_f64());
    assert!(end == failed && end < data["duration"].as_f64(), "{end:?} {failed:?}");
    assert!(!data["verdict"]["failures"][0]["modules"].as_array().expect("a list").is_empty());
}

const ROVER: &str = "use std.smores.Driver1
emit(Driver1().drive(t: 1s), \"drive.plan.json\")
";

#[test]
fn modl_show_draws_programs_and_plan_files() {
    let declared = "use std.smores.Smores\nconfig One { part m: Smores }\n";
    let sandbox = Sandbox::new(&[("rover.mod", ROVER.as_bytes()), ("one.mod", declared.as_bytes())]);
    let ran = sandbox.run(&["show", "rover.mod"]);
    assert!(ran.code == 0 && ran.err.contains("wrote out/drive.html"), "{}", ran.err);
    let ran = sandbox.run(&["show", "one.mod"]);
    assert!(ran.code == 0 && ran.err.contains("wrote out/One.html"), "{}", ran.err);
    let ran = sandbox.run(&["show", "out/drive.plan.json", "--out", "again"]);
    assert!(ran.code == 0 && ran.err.contains("wrote again/drive.html"), "{}", ran.err);
    let read = |name: &str| data(&std::fs::read_to_string(sandbox.path(name)).expect("written"));
    let (one, two) = (read("out/drive.html"), read("again/drive.html"));
    assert_eq!(one["body"], two["body"], "the file plays as the program did");
    assert_eq!(one["sources"][0]["name"], "rover.mod");
}

#[test]
fn a_name_that_ends_otherwise_is_refused() {
    let text = ROVER.replace("emit", "show").replace(".plan.json", ".gif");
    let sandbox = Sandbox::new(&[("rover.mod", text.as_bytes())]);
    let ran = sandbox.run(&["run", "rover.mod"]);
    assert!(ran.code == 1 && ran.err.contains("E0506") && ran.err.contains(".html"), "{}", ran.err);
}
