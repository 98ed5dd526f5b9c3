//! Pages: one file that loads nothing and can't be broken out of, the same bytes for the same plan.
#![allow(non_snake_case)]

use crate::desk::cli::{Sandbox, json};
use crate::plans::plan_operations::{plan_of, rolling, squeezing};
use crate::support::lattices::small_cell;
use crate::support::programs::*;
use crate::support::robots::{H, LEFT, TILT, chain, walk4};
use modl::geometry::{Placed, Pose, Shape, Solid, Vec3};
use modl::plan::{Body, Plan};
use modl::robot::Kinematics;
use modl::view::{PictureStyle, RenderInput, Side, StillOptions, page, png, svg};
use serde_json::Value;
use std::collections::BTreeSet;

/// Most bytes of a page without its plan.
const PAGE_BYTES_MAX: usize = 160_000;

const HOSTILE: &str = "</script><img src=x onerror=alert(1)>\"'&\u{202e}\u{0}\u{1}";

fn rover() -> Plan {
    plan_of(plan(chain(1), spin_for(LEFT as u32, 1.0, 1.0, 0)).expect("it can be scheduled"))
}

fn shown(title: &str, plan: &Plan) -> String {
    page(&RenderInput { title, plan, texts: &[], command: "modl run rover.mod" })
}

/// The text of the plan's data, as it stands in the page.
fn data_text(page: &str) -> &str {
    let from = page.split_once("id=\"plan\">").expect("a page holds a plan").1;
    from.split_once("</script>").expect("the data ends").0
}

/// The page without its plan's data, with its still picture.
fn bare(page: &str) -> String {
    page.replace(data_text(page), "")
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
    plan.library =
        std::sync::Arc::new(modl::robot::Library { cells: vec![small_cell()], ..Default::default() });
    (plan.body, plan.program) = (Body::Stages(squeezing()), None);
    let data = data(&shown("row", &plan));
    assert_eq!(data["body"]["form"], "stages");
    assert_eq!(data["verdict"]["stamp"], "not judged");
}

/// An arm of eight modules that a car can't balance.
const FALLS: &str = include_str!("../acceptance/falls.mod");

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
    let input = RenderInput { title: "rover", plan: &plan, texts: &[], command: "" };
    let still = |time, side| {
        png(&input, &StillOptions { time, side, width: 160, height: 100, ..StillOptions::default() })
    };
    let (corner, top) = (still(0.0, Side::Corner), still(0.0, Side::Top));
    assert!(corner == still(0.0, Side::Corner), "the same bytes again");
    assert!(corner != top);
    let (width, height, of_corner) = pixels(&corner);
    assert_eq!((width, height), (160, 100));
    // The module is blue but for its docks, and the paper is not; it stands in the middle and not at the rim.
    let blue = |p: &[u8; 3]| i32::from(p[2]) > i32::from(p[0]) + 30;
    let middle = (30..70).flat_map(|y| (60..100).map(move |x| 160 * y + x));
    assert!(middle.filter(|i| blue(&of_corner[*i])).count() > 400, "in the middle");
    assert!(!blue(&of_corner[0]) && !blue(&of_corner[160 * 100 - 1]));
    let share = of_corner.iter().filter(|p| blue(p)).count();
    assert!((1600..8000).contains(&share), "{share} pixels of 16000");
    // From the left and from the right a module is as wide, mirrored: symmetric in y.
    let wide = |side| pixels(&still(0.0, side)).2.iter().filter(|p| blue(p)).count() as f64;
    let (left, right) = (wide(Side::Left), wide(Side::Right));
    assert!((left / right - 1.0).abs() < 0.05, "{left} {right}");
}

/// The pixels of a picture for print that are not grey: the robot; shadows on the white ground are.
fn coloured(plan: &Plan, side: Side, (width, height): (usize, usize)) -> Vec<(usize, usize)> {
    let input = RenderInput { title: "", plan, texts: &[], command: "" };
    let options = StillOptions { side, width, height, look: PictureStyle::Figure, ..StillOptions::default() };
    let (_, _, found) = pixels(&png(&input, &options));
    let chroma = |[r, g, b]: [u8; 3]| r.max(g).max(b) - r.min(g).min(b);
    let places = (0..width * height).filter(|i| chroma(found[*i]) > 18);
    places.map(|i| (i % width, i / width)).collect()
}

#[test]
fn a_picture_is_filled_and_cuts_nothing_off() {
    let long = plan_of(plan(chain(12), wait(1.0)).expect("it can be scheduled"));
    for (plan, size) in [(rover(), (120, 80)), (long.clone(), (120, 80)), (long, (80, 120))] {
        for side in [Side::Corner, Side::Front, Side::Back, Side::Left, Side::Right, Side::Top] {
            let found = coloured(&plan, side, size);
            let range = |pick: fn(&(usize, usize)) -> usize| {
                let values = || found.iter().map(pick);
                (values().min().expect("it is seen"), values().max().expect("it is seen"))
            };
            let ((left, right), (top, bottom)) = (range(|p| p.0), range(|p| p.1));
            let inside = left > 0 && top > 0 && right + 1 < size.0 && bottom + 1 < size.1;
            let fill = f64::max((right - left) as f64 / size.0 as f64, (bottom - top) as f64 / size.1 as f64);
            assert!(inside && fill > 0.7, "{side:?} of {size:?}: {left}..{right}, {top}..{bottom}");
        }
    }
}

#[test]
fn docks_are_drawn_at_the_ports_and_nowhere_else() {
    let sandbox = Sandbox::new(&[("snake.mod", b"use std.rofi.Snake\nshow(Snake(n: 2), \"snake.html\")\n")]);
    sandbox.run(&["run", "snake.mod"]);
    let page = std::fs::read_to_string(sandbox.path("out/snake.html")).expect("written");
    let data = data(&page);
    let links = data["body"]["kinds"][0]["links"].as_array().expect("a list");
    let count = |link: usize| links[link]["fittings"].as_array().expect("a list").len();
    // A shoe has three docks of a disc and four pins; between the bodies is a shaft.
    assert_eq!([count(0), count(1), count(2), count(3)], [15, 1, 0, 15]);
    let disc = &links[0]["fittings"][0];
    let number = |value: &Value| value.as_f64().expect("a number");
    let end = number(&disc["p"][0]) + number(&disc["s"][2]) / 2.0;
    assert!((end - 0.05).abs() < 1e-3, "it ends at the port, half a pitch from the middle: {end}");
    let shaft = &links[1]["fittings"][0];
    assert!((number(&shaft["p"][2]) - 0.05).abs() < 1e-6, "half way between the two bodies");
}

#[test]
fn what_becomes_what_is_the_title_and_the_goal_is_drawn() {
    let program = "use std.crystal.ExpandingCube
use std.truss.PneumaticReel
use std.shapes.cube
lattice Em of ExpandingCube = row(4)
lattice Ow of ExpandingCube = block(2, 2)
truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 2, interior: false)
let way = squeeze(Em, Ow)
emit(way, \"way.plan.json\")
emit(reverse(way), \"back.plan.json\")
show(morph(Pyramid, cube(edge: 1500mm), budget: 3), \"made.html\")
";
    let sandbox = Sandbox::new(&[("way.mod", program.as_bytes())]);
    let ran = sandbox.run(&["run", "way.mod"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    for (file, title) in [("way", "Em \u{2192} Ow"), ("back", "Ow \u{2192} Em")] {
        let ran = sandbox.run(&["show", &format!("out/{file}.plan.json")]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        let page = std::fs::read_to_string(sandbox.path(&format!("out/{file}.html"))).expect("written");
        assert!(page.contains(&format!("<title>{title}</title>")), "{file}");
        assert_eq!(data(&page)["goal"], true);
    }
    let page = std::fs::read_to_string(sandbox.path("out/made.html")).expect("written");
    let data = data(&page);
    assert_eq!(data["title"], "Pyramid \u{2192} cube(edge: 1500mm)");
    // The eight corners of a cube of this edge.
    let index = data["target"].as_u64().expect("a target") as usize;
    let points = data["meshes"][index]["points"].as_array().expect("a list");
    let points: Vec<f64> = points.iter().map(|x| x.as_f64().expect("a number")).collect();
    assert_eq!(points.len(), 24);
    let corner = |i: usize| Vec3::new(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    let apart = (1..8).map(|i| (corner(i) - corner(0)).norm());
    let longest = apart.fold(0.0, f64::max);
    assert!((longest - 1.5 * 3.0_f64.sqrt()).abs() < 1e-5, "{longest}");
}

#[test]
fn the_page_colours_the_words_of_the_grammar() {
    let page = shown("rover", &rover());
    let list = page
        .split_once("const KEYWORDS = new Set((")
        .expect("a list")
        .1
        .split_once(").split")
        .expect("its end")
        .0;
    let quoted =
        |text: &str| -> Vec<String> { text.split('"').skip(1).step_by(2).map(str::to_owned).collect() };
    let coloured: BTreeSet<String> = quoted(list)
        .iter()
        .flat_map(|part| part.split(' '))
        .filter(|w| !w.is_empty())
        .map(str::to_owned)
        .collect();
    let grammar = include_str!("../../grammar/modl.pest");
    let code: String = grammar.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let word = |text: &String| text.len() > 1 && text.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    let escaped = code.replace("\\\"", "");
    let of_grammar: BTreeSet<String> = quoted(&escaped).into_iter().filter(word).collect();
    assert_eq!(coloured, of_grammar);
}

fn drawing(plan: &Plan) -> String {
    svg(&RenderInput { title: HOSTILE, plan, texts: &[], command: "" })
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

/// The colours of a list in the page's scripts: red, green and blue in 0..1, in linear light.
fn colours(page: &str, name: &str) -> Vec<[f64; 3]> {
    let list = page.split_once(&format!("const {name} = [")).expect("a list").1;
    let list = list.split_once(']').expect("it ends").0;
    let part = |hex: &str| f64::from(u8::from_str_radix(hex, 16).expect("two digits")) / 255.0;
    let linear = |c: f64| if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) };
    let hex = list.split('#').skip(1);
    hex.map(|hex| [0, 2, 4].map(|at| linear(part(&hex[at..at + 2])))).collect()
}

/// What people see: all colours, and without one kind of cones (Machado, Oliveira and Fernandes 2009).
const EYES: [[[f64; 3]; 3]; 4] = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
    [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
];

/// CIELAB of a colour as an eye sees it, in daylight.
fn lab(colour: [f64; 3], eye: &[[f64; 3]; 3]) -> [f64; 3] {
    let weighed = |row: &[f64; 3]| row.iter().zip(&colour).map(|(w, c)| w * c).sum::<f64>().clamp(0.0, 1.0);
    let [r, g, b] = eye.each_ref().map(weighed);
    let f = |t: f64| if t > 216.0 / 24389.0 { libm::cbrt(t) } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
    let x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
    let y = f(0.2126729 * r + 0.7151522 * g + 0.072175 * b);
    let z = f((0.0193339 * r + 0.119192 * g + 0.9503041 * b) / 1.08883);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

#[test]
fn colours_are_told_apart_by_every_eye() {
    /// Four times what is just noticed between colours that lie beside each other.
    const APART: f64 = 9.2;
    let page = shown("rover", &rover());
    let failed = page.split_once("const FAILED = ").expect("a colour").1[1..8].to_owned();
    for list in ["PALETTE", "INKS", "INKS_DARK"] {
        let mut all = colours(&page, list);
        if list == "PALETTE" {
            all.extend(colours(&format!("const FAILED = [\"{failed}\"]"), "FAILED"));
        }
        for (eye, (i, j)) in (0..EYES.len())
            .flat_map(|eye| (0..all.len()).flat_map(move |j| (0..j).map(move |i| (eye, (i, j)))))
        {
            let (a, b) = (lab(all[i], &EYES[eye]), lab(all[j], &EYES[eye]));
            let apart = (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt();
            assert!(apart > APART, "{list}: colours {i} and {j} are {apart:.1} apart for eye {eye}");
        }
    }
    // Amounts go by lightness: more is brighter.
    let ramp = colours(&page, "RAMP");
    for eye in &EYES {
        assert!(ramp.windows(2).all(|pair| lab(pair[1], eye)[0] > lab(pair[0], eye)[0] + 5.0));
    }
}

/// World poses of all links at a time, by the judge's walk.
fn posed(plan: &Plan, time: f64) -> (Vec<Pose>, Kinematics) {
    let Body::Tracks(tracks) = &plan.body else { unreachable!("a robot's plan") };
    let state = tracks.state(time);
    let kinematics = Kinematics::new(&tracks.robot, &state.bonds, tracks.robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    let base = modl::plan::verify::articulated::base_at(plan, time).expect("it stands");
    kinematics.link_poses(&state.joints, &base, &mut poses);
    (poses, kinematics)
}

#[test]
fn contacts_are_where_the_feet_are() {
    let plan = plan_of(plan(walk4(), wait(0.1)).expect("it can be scheduled"));
    let data = data(&shown("walker", &plan));
    let first = data["contacts"][0].as_array().expect("a moment");
    assert_eq!(first[0], 0);
    let numbers: Vec<f64> =
        first[1].as_array().expect("places").iter().map(|x| x.as_f64().expect("a number")).collect();
    let Body::Tracks(tracks) = &plan.body else { unreachable!("a robot's plan") };
    let (poses, kinematics) = posed(&plan, 0.0);
    // The lowest module of each leg, and nothing else, is within its own size of the ground.
    let feet: Vec<usize> = (0..tracks.robot.modules.len())
        .filter(|m| poses[kinematics.link(*m, 0)].translation.vector.z < 1.2 * H)
        .collect();
    let mut touched = std::collections::BTreeSet::new();
    for place in numbers.chunks_exact(2) {
        let away = |m: &usize| {
            let p = poses[kinematics.link(*m, 0)].translation.vector;
            libm::hypot(p.x - place[0], p.y - place[1])
        };
        let foot = feet.iter().min_by(|a, b| away(a).total_cmp(&away(b))).expect("it stands on something");
        assert!(away(foot) < 1.6 * H, "{place:?} is under no foot");
        touched.insert(*foot);
    }
    assert!(feet.len() >= 3 && touched.len() == feet.len(), "{touched:?} of {feet:?}");
}

#[test]
fn a_collision_is_marked_where_the_modules_meet() {
    let tilts = (0..6).map(|m| go(4 * m + TILT as u32, 1.57, 0)).collect();
    let mut plan = plan_of(plan(chain(6), parallel(tilts)).expect("it can be scheduled"));
    plan.verdict = Some(modl::plan::verify::verify(&plan));
    let data = data(&shown("curl", &plan));
    let failures = data["verdict"]["failures"].as_array().expect("a list");
    let failure = failures.iter().find(|f| f["kind"] == "collision").expect("two modules meet");
    let numbers = |list: &Value| -> Vec<f64> {
        list.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    let point = Vec3::from_row_slice(&numbers(&failure["point"]));
    let (poses, kinematics) = posed(&plan, failure["time"].as_f64().expect("a time"));
    let Body::Tracks(tracks) = &plan.body else { unreachable!("a robot's plan") };
    let sphere = Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: 1e-4 } };
    let spot = Solid::new(&[sphere]).expect("a ball is sound");
    let modules = numbers(&failure["modules"]);
    assert_eq!(modules.len(), 2);
    for module in modules {
        let module = module as usize;
        let links = &tracks.robot.module_type(module).links;
        let gap = |(link, kind): (usize, &modl::robot::Link)| {
            let solid = Solid::new(&kind.collides).expect("the tests' shapes are sound");
            let X = poses[kinematics.link(module, link)];
            modl::geometry::distance::distance_of_solids(
                &spot,
                &modl::geometry::pose::shifted(point),
                &solid,
                &X,
            )
        };
        let least = links.iter().enumerate().map(gap).fold(f64::INFINITY, f64::min);
        assert!(least < 1e-3, "the mark is {least} m off module {module}");
    }
}

#[test]
fn clearances_are_told_of_robots_of_any_size() {
    let joint = |m: u32| 4 * m + TILT as u32;
    let wave = parallel((0..60).map(|i| go_in(joint(5 * i), 0.2, 2.0, 0)).collect());
    let mut plan = plan_of(plan(chain(300), wave).expect("it can be scheduled"));
    plan.settings.samples_max = 10;
    let page = data(&shown("snake", &plan));
    let curve = page["clearance"].as_array().expect("a list");
    assert!(curve.len() > 20, "{} points", curve.len());
    let said = page["notes"].to_string();
    assert!(
        said.contains(&format!("the curve of clearances goes through {} instants", curve.len())),
        "{said}"
    );
    // At the start all is straight, and modules are as far apart as those of a shorter chain.
    let short = plan_of(crate::support::programs::plan(chain(3), wait(1.0)).expect("it can be scheduled"));
    let first = |page: &Value| page["clearance"][0][1].as_f64().expect("a number");
    assert!((first(&page) - first(&data(&shown("short", &short)))).abs() < 0.05);
}

/// A joint that can't hold its module up, and says so.
const WEAK: &str = "connector Face { mates Face }
module Arm {
  mass 11kg
  link base = box(200mm, 200mm, 50mm, mass: 10kg)
  link tip = box(400mm, 40mm, 40mm, mass: 1kg) at [340mm, 0mm, 0mm]
  joint bend : base -> tip = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 0.5N*m) at [100mm, 0mm, 0mm]
  port back : Face on base at [-100mm, 0mm, 0mm] facing -X up +Z
}
config Weak {
  part a: Arm
  behavior hold allows overload = move(a.bend, to: -90deg)
  behavior up = Sc(hold())
}
print(verify(Weak().up()))
emit(Weak().up(), \"weak.plan.json\")
show(Weak().up(), \"weak.html\")
";

#[test]
fn a_verdict_with_exemptions_says_so_wherever_it_is_shown() {
    let sandbox = Sandbox::new(&[("weak.mod", WEAK.as_bytes())]);
    let ran = sandbox.run(&["run", "weak.mod"]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    let headline = "verified under full dynamics, except torque (allowed at line 11)";
    assert!(ran.out.starts_with(&format!("{headline}: ")), "{}", ran.out);
    let verified = sandbox.run(&["verify", "out/weak.plan.json"]);
    assert!(
        verified.code == 0 && verified.out.contains(&format!("weak.plan.json: {headline}\n")),
        "{}",
        verified.out
    );
    let page = std::fs::read_to_string(sandbox.path("out/weak.html")).expect("written");
    let data = data(&page);
    assert_eq!(
        (&data["verdict"]["stamp"], &data["verdict"]["headline"]),
        (&"excepted".into(), &headline.into())
    );
    assert!(data["verdict"]["load"].as_f64().is_some_and(|load| load > 1.0), "{}", data["verdict"]["load"]);
    let listed = data["data"]
        .as_array()
        .expect("a list")
        .iter()
        .any(|fact| fact[0] == "verdict" && fact[1] == headline);
    assert!(listed, "{}", data["data"]);
    let session = sandbox.run_with_input(&["repl", "weak.mod"], b"plan(Weak().up())\n");
    assert!(session.out.contains(&format!("of Weak, {headline}: Plan")), "{}", session.out);
}
