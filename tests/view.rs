//! Pages: one file that loads nothing and can't be broken out of, the same bytes for the same plan.

use crate::cli::{Sandbox, json};
use crate::plan_operations::{plan_of, rolling, squeezing};
use crate::programs::*;
use crate::robots::{LEFT, chain};
use modl::plan::{Body, Plan};
use modl::view::{Showing, Side, Still, page, png, svg};
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

/// The page without its plan: neither the data nor the still picture.
fn bare(page: &str) -> String {
    let still = page.split_once("base64,").expect("a still picture").1.split_once('"').expect("it ends").0;
    page.replace(data_text(page), "").replace(still, "")
}

fn data(page: &str) -> Value {
    serde_json::from_str(data_text(page)).expect("the data is JSON")
}

#[test]
fn a_page_is_small_and_loads_nothing() {
    let page = shown("rover", &rover());
    let own = bare(&page).len();
    assert!(own <= PAGE_BYTES_MAX, "{own} bytes without the plan");
    for loading in ["://", "src=", "href=", "import ", "@import", "url(", "fetch(", "XMLHttp", "Worker("] {
        assert!(!bare(&page).replace("src=\"data:image/png;base64,", "").contains(loading), "{loading}");
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
    assert_eq!(page.matches("<img").count(), 1, "the still picture");
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

/// Width, height and pixels (red, green, blue) of a PNG file.
fn pixels(bytes: &[u8]) -> (usize, usize, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG file");
    let mut raw = vec![0; reader.output_buffer_size().expect("it fits")];
    let info = reader.next_frame(&mut raw).expect("a picture");
    let pixels = raw.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width as usize, info.height as usize, pixels)
}

#[test]
fn a_picture_shows_the_robot_from_the_side_asked_for() {
    let plan = rover();
    let showing = Showing { title: "rover", plan: &plan, texts: &[], command: "" };
    let still = |time, side| png(&showing, &Still { time, side, width: 160, height: 100 });
    let (corner, top) = (still(0.0, Side::Corner), still(0.0, Side::Top));
    assert!(corner == still(0.0, Side::Corner), "the same bytes again");
    assert!(corner != top);
    let (width, height, of_corner) = pixels(&corner);
    assert_eq!((width, height), (160, 100));
    // The module is blue, and the paper is not; it stands in the middle and not at the rim.
    let blue = |p: &[u8; 3]| i32::from(p[2]) > i32::from(p[0]) + 40;
    assert!(blue(&of_corner[50 * 160 + 80]) && !blue(&of_corner[0]) && !blue(&of_corner[160 * 100 - 1]));
    let share = of_corner.iter().filter(|p| blue(p)).count();
    assert!((1600..8000).contains(&share), "{share} pixels of 16000");
    // From the left and from the right a module is as wide, mirrored: symmetric in y.
    let wide = |side| pixels(&still(0.0, side)).2.iter().filter(|p| blue(p)).count() as f64;
    let (left, right) = (wide(Side::Left), wide(Side::Right));
    assert!((left / right - 1.0).abs() < 0.05, "{left} {right}");
}

fn drawing(plan: &Plan) -> String {
    svg(&Showing { title: HOSTILE, plan, texts: &[], command: "" })
}

#[test]
fn drawings_follow_what_is_shown_and_no_name_breaks_out() {
    let mut plan = rover();
    let behavior = drawing(&plan);
    assert!(behavior.contains("at 1rad/s for 1s"), "{behavior}");
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a robot's plan") };
    tracks.robot.modules[0].name = HOSTILE.into();
    plan.program = None;
    let graph = drawing(&plan);
    assert_eq!(
        (graph.matches("<circle").count(), graph.matches("<img").count()),
        (2, 0),
        "the base is ringed"
    );
    assert!(graph.contains("&lt;/script&gt;") && !graph.contains(|c: char| c.is_control() && c != '\n'));
    plan.body = Body::Stages(squeezing());
    let lattice = drawing(&plan);
    // Four cells of three faces each, at the start and after two stages.
    assert_eq!(lattice.matches("<polygon").count(), 3 * 4 * 3);
    assert!(lattice.contains("1. x-squeeze") && lattice.contains("2. x-squeeze"));
    plan.body = Body::NodePaths(rolling());
    assert_eq!(drawing(&plan).matches("<polygon").count(), 3 * 3);
}

/// Two triangles of 80 mm with one edge in common.
const STRIP: &str = "use std.mori.Mori
config Pair { part m[2]: Mori  connect m[0].edge[1] -- m[1].edge[0] }
show(Pair(), \"pair.svg\")
";

#[test]
fn a_fold_pattern_is_true_to_scale() {
    let sandbox = Sandbox::new(&[("pair.mod", STRIP.as_bytes())]);
    let ran = sandbox.run(&["run", "pair.mod"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let text = std::fs::read_to_string(sandbox.path("out/pair.svg")).expect("written");
    let number = |name: &str| -> f64 {
        let from = text.split_once(&format!(" {name}=\"")).expect("an attribute").1;
        from.split_once("mm").expect("in millimetres").0.parse().expect("a number")
    };
    // A rhombus of 80 mm: 120 mm by 69.3 mm, or turned; each panel is 0.1 mm smaller all around.
    let rim = 2.0 * 0.12 * 80.0;
    let (wide, tall) = (number("width") - rim, number("height") - rim);
    let diagonal = libm::hypot(wide, tall);
    assert!((diagonal - libm::hypot(120.0, 40.0 * libm::sqrt(3.0))).abs() < 1.0, "{wide} x {tall}");
    assert_eq!(text.matches("<polygon").count(), 2);
    assert_eq!(text.matches("stroke-dasharray").count(), 1, "one fold");
}

#[test]
fn a_name_that_ends_otherwise_is_refused() {
    let text = ROVER.replace("emit", "show").replace(".plan.json", ".gif");
    let sandbox = Sandbox::new(&[("rover.mod", text.as_bytes())]);
    let ran = sandbox.run(&["run", "rover.mod"]);
    assert!(ran.code == 1 && ran.err.contains("E0506") && ran.err.contains(".html"), "{}", ran.err);
}
