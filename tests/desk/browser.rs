//! Pages in a browser: headless Chromium opens one of every family and uses it as a person would
//! (`tests/browser/check.mjs`). Skipped, with a message, where Node.js, playwright-core or Chromium is
//! missing; `.ci/run` installs them.
#![allow(non_snake_case)]

use crate::desk::cli::Sandbox;
use crate::judge::truss_judge::keyframe;
use crate::plans::plan_operations::plan_of;
use crate::support::lattices::small_cell;
use crate::support::programs::*;
use crate::support::robots::{TILT, chain, reel};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::plan::{
    Anchor, Body, CauseId, CellLimits, Counter, Interpolation, Law, Model, NodePaths, Obstacle, Plan, Ratio,
    Run, Stage, Stages, Surroundings, TrussLimits, verify,
};
use modl::robot::{Kinematics, Library};
use modl::simulate::{Settings, simulate};
use modl::view::{RenderInput, page};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;

/// playwright-core and Chromium: where `MODL_PLAYWRIGHT` and `MODL_CHROMIUM` say, or where `.ci/run`
/// puts them.
pub fn tools() -> Option<(PathBuf, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let or = |name: &str, local: PathBuf| std::env::var_os(name).map_or(local, PathBuf::from);
    let playwright = or("MODL_PLAYWRIGHT", root.join("target/browser/node_modules/playwright-core"));
    let chromium = or("MODL_CHROMIUM", "/usr/bin/chromium".into());
    let node = Command::new("node").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    (node.is_ok_and(|s| s.success()) && playwright.exists() && chromium.exists())
        .then_some((playwright, chromium))
}

/// The positions of all links at some times, by the kinematics of the judge.
fn places(plan: &Plan, times: &[f64]) -> Value {
    let Body::Tracks(tracks) = &plan.body else { return json!([]) };
    let walked = verify::articulated::history(plan, plan.body.duration());
    let at = |t: f64| {
        let moment = walked.iter().min_by(|a, b| (a.time - t).abs().total_cmp(&(b.time - t).abs()));
        let (time, base) = moment.map_or((t, tracks.start.base), |m| (m.time, m.base));
        let state = tracks.state(time);
        let kinematics = Kinematics::new(&tracks.robot, &state.bonds, tracks.robot.base);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&state.joints, &base, &mut poses);
        let bodies = poses.iter().enumerate().map(|(i, X)| {
            let p = X.translation.vector;
            json!([i, p.x, p.y, p.z])
        });
        std::iter::once(json!(time)).chain(bodies).collect::<Value>()
    };
    times.iter().map(|t| at(*t)).collect()
}

/// 300 modules in a row that bend at every tenth of them, by turns up and down.
fn snake() -> Plan {
    let joint = |module: u32| 4 * module + TILT as u32;
    let bent = |i: u32, to: f64| go_in(joint(10 * i), if i.is_multiple_of(2) { to } else { -to }, 2.0, 0);
    let wave = |to: f64| parallel((0..30).map(|i| bent(i, to)).collect());
    let mut snake = plan_of(
        plan(chain(300), series(vec![wave(0.2), wave(-0.2), wave(0.0)])).expect("it can be scheduled"),
    );
    let Body::Tracks(tracks) = &mut snake.body else { unreachable!("a robot's plan") };
    tracks.obstacles = Arc::new([Obstacle { name: "post".to_owned(), shapes: post() }]);
    snake
}

/// A post aside of what moves.
fn post() -> Vec<Placed> {
    let shape = Shape::Box { size: Vec3::new(0.1, 0.1, 0.4) };
    vec![Placed { pose: shifted(Vec3::new(0.0, -1.5, 0.2)), shape }]
}

fn block(sizes: [Ratio; 3], n: u64) -> Run {
    let counter = |axis: usize, stride: i64| Counter {
        count: n,
        stride,
        step: std::array::from_fn(|k| if k == axis { sizes[k] } else { Ratio::ZERO }),
    };
    Run {
        first: 0,
        counters: vec![counter(2, (n * n) as i64), counter(1, n as i64), counter(0, 1)],
        center: sizes.map(|s| Ratio(s.0, 2 * s.1)),
        size: sizes,
    }
}

/// A thousand cubes squeezed along x, then along y, and let go along x, beside an obstacle.
fn lattice() -> Plan {
    let half = Ratio(1, 2);
    let stage = |name: &str, sizes| Stage {
        name: name.into(),
        time_squared: Ratio(4, 1),
        law: Law::BangBang,
        end: vec![block(sizes, 10)].into(),
        cause: CauseId(0),
    };
    let one = Ratio::ONE;
    let aside = Run { first: 0, counters: Vec::new(), center: [Ratio(25, 2), one, one], size: [one; 3] };
    let stages = Stages {
        cell: 0,
        count: 1000,
        time_unit: 0.5,
        limits: CellLimits::default(),
        model: Model::default(),
        anchor: Some(Anchor { cells: Vec::new(), obstacles: vec![aside] }),
        start: vec![block([one; 3], 10)],
        stages: vec![
            stage("x-squeeze", [half, one, one]),
            stage("y-squeeze", [half, half, one]),
            stage("x-release", [one, half, one]),
        ],
    };
    of_body(Body::Stages(stages), Library { cells: vec![small_cell()], ..Library::default() })
}

/// An arch of 100 triangles, 300 nodes, that leans and then rolls over an edge of its foot, behind a post.
fn truss() -> Plan {
    let corner = |level: usize, k: usize, lean: f64| {
        let along = std::f64::consts::PI * level as f64 / 99.0;
        let around = std::f64::consts::TAU * (k as f64 / 3.0 + level as f64 / 6.0);
        let (sin, cos) = libm::sincos(along);
        let (out, side) = libm::sincos(around);
        let radius = 20.0 + out;
        [radius * cos, side + lean * radius * sin, radius * sin + 1.0]
    };
    let nodes = |lean: f64| (0..300).map(|i| corner(i / 3, i % 3, lean)).collect::<Vec<_>>();
    let mut struts = Vec::new();
    for level in 0..100 {
        let at = |up: usize, k: usize| 3 * (level + up) + k % 3;
        for k in 0..3 {
            struts.push((at(0, k), at(0, k + 1)));
            if level < 99 {
                struts.extend([(at(0, k), at(1, k)), (at(0, k + 1), at(1, k))]);
            }
        }
    }
    let (edge, angle) = ((0, 1), -0.3);
    let leaning = keyframe(2.0, Interpolation::Linear, &nodes(0.3));
    let mut paths = NodePaths {
        limits: TrussLimits::default(),
        surroundings: Surroundings { obstacles: vec![post()], ..Surroundings::default() },
        strut: 0,
        node_names: (0..300).map(|i| format!("ring[{}][{}]", i / 3, i % 3)).collect(),
        struts,
        merged: Vec::new(),
        events: Vec::new(),
        keyframes: vec![keyframe(0.0, Interpolation::Linear, &nodes(0.0)), leaning.clone(), leaning],
    };
    paths.keyframes[2].time = 4.0;
    paths.keyframes[2].interpolation = Interpolation::RigidRoll { edge, angle };
    // Just before its end a roll is where it leads.
    paths.keyframes[2].nodes = paths.state(4.0 - 1e-12);
    of_body(Body::NodePaths(paths), Library { struts: vec![reel()], ..Library::default() })
}

fn of_body(body: Body, library: Library) -> Plan {
    let plan = plan_of(plan(chain(1), wait(1.0)).expect("it can be scheduled"));
    Plan { library: Arc::new(library), body, program: None, ..plan }
}

const HOSTILE: &str = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'\\";

fn hostile() -> Plan {
    let mut plan = plan_of(plan(chain(2), go(TILT as u32, 0.5, 0)).expect("it can be scheduled"));
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a robot's plan") };
    tracks.robot.modules[0].name = HOSTILE.into();
    plan.causes[0].text = HOSTILE.into();
    plan.verdict = Some(verify::verify(&plan));
    plan
}

/// Programs whose pages are looked at: their names and texts.
const PROGRAMS: &[(&str, &str)] = &[
    ("walkbot", include_str!("../../examples/walkbot.mod")),
    ("falls", include_str!("../acceptance/falls.mod")),
    ("collision", COLLISION),
    ("octahedron", FOLD),
    ("slab", SQUEEZE),
    ("ring", RING),
    ("slides", SLIDES),
];

/// A flat pattern that folds up to an octahedron.
const FOLD: &str = "use std.mori.Mori
use std.shapes.octahedron
let octa = fold(octahedron(edge: 80mm), module: Mori)
emit(octa.plan, \"octahedron.plan.json\")
";

/// A row that becomes a slab.
const SQUEEZE: &str = "use std.crystal.ExpandingCube
lattice Row of ExpandingCube = row(16)
lattice Slab of ExpandingCube = block(4, 4)
emit(squeeze(Row, Slab), \"slab.plan.json\")
";

/// A chain that curls up into itself. Under full dynamics it would be overloaded before.
const COLLISION: &str = "use std.smores.{Smores, Chain3}
config Curl { part s[2]: Chain3
  connect s[0].head -- s[1].tail
  behavior curl = Pc([move(m.tilt, to: 90deg) for m in s[0].m ++ s[1].m])
}
emit(plan(Curl().curl(), world: world(dynamics: statics)), \"curl.plan.json\")
";

/// A ring that lets go of a connection, opens and closes again.
const RING: &str = "use std.smores.Ring12
config Loop {
  part ring: Ring12
  behavior open allows overload = Sc(
    undock(ring.m[11].bottom),
    move(ring.m[5].tilt, by: -10deg),
    move(ring.m[5].tilt, by: 10deg),
    dock(ring.m[11].bottom, ring.m[0].top),
  )
}
emit(plan(Loop().open(), world: world(dynamics: statics)), \"ring.plan.json\")
";

/// A walker on slippery ground, with runs.
const SLIDES: &str = "use std.smores.Walk4
let w = Walk4()
let walk = plan(Sc(w.stand(), w.walk(steps: 1)))
emit(walk, \"slides.plan.json\")
show(simulate(walk, friction: 0.3, runs: 2, friction_spread: 0.3), \"slides.html\")
";

/// One page of each family is opened on a phone, too.
const PHONES: &[&str] = &["walkbot", "octahedron", "slab", "snake", "truss"];

/// What the checks of a page need to know of its plan.
struct Looks {
    name: &'static str,
    plan: Plan,
    /// Whether a module's joints are told under the mouse.
    joints: bool,
    colours: &'static [&'static str],
    toggles: &'static [&'static str],
    curves: &'static [&'static str],
    /// Words that stand in the plan's data.
    data: Vec<String>,
    failure: Value,
}

impl Looks {
    fn wanted(&self, file: &str, title: &str, measured: bool) -> Value {
        let end = self.plan.body.duration();
        let times: Vec<f64> = [0.0, 0.13, 0.26, 0.41, 0.64, 0.95].iter().map(|part| part * end).collect();
        let failed = !self.failure.is_null();
        json!({
            "name": file,
            "title": title,
            "poses": if failed { json!([]) } else { places(&self.plan, &times) },
            "lit": if failed { json!([]) } else { lit(&self.plan, &times) },
            "joints": self.joints,
            "colours": self.colours,
            "toggles": self.toggles,
            "curves": self.curves,
            "data": self.data,
            "failure": self.failure,
            "measured": measured,
            "phone": PHONES.contains(&self.name),
        })
    }
}

/// The lines of a program that command the motion at some times: `[time, [file:line, ...]]`.
fn lit(plan: &Plan, times: &[f64]) -> Value {
    let commanding = |t: f64| -> BTreeSet<u32> {
        match &plan.body {
            Body::Tracks(tracks) => {
                let segments = tracks.tracks.iter().flat_map(|track| &track.segments);
                let docks = tracks.events.iter().filter(|dock| (dock.time - t).abs() < 0.25);
                let moving = segments.filter(|s| s.start <= t && t < s.end).map(|s| s.cause.0);
                moving.chain(docks.map(|dock| dock.cause.0)).collect()
            }
            // A planner's plan has one cause: the call.
            _ => BTreeSet::from([0]),
        }
    };
    let lines = |t: f64| -> BTreeSet<String> {
        let causes = commanding(t).into_iter().map(|cause| &plan.causes[cause as usize]);
        let places = causes.flat_map(|cause| std::iter::once(cause).chain(cause.caller.as_deref()));
        let own = places.filter(|place| !place.file.starts_with("std"));
        own.map(|place| format!("{}:{}", place.file, place.line)).collect()
    };
    times.iter().map(|&t| json!([t, lines(t)])).collect()
}

const OF_ROBOT: &[&str] = &["part", "load", "type"];
const ON_GROUND: &[&str] = &["mass", "contacts", "goal", "edges", "shadow"];
const OF_JOINTS: &[&str] = &["joints", "clearance", "stability margin", "joint load"];

/// A page that `modl show` made of a program.
fn of_program(sandbox: &Sandbox, name: &'static str) -> Looks {
    let text = fs::read_to_string(sandbox.path(&format!("out/{name}.plan.json"))).expect("written");
    let plan = modl::plan::file::read(&text).expect("a plan");
    let bare = Plan { verdict: None, ..plan.clone() };
    let hash = modl::plan::file::digest(&modl::plan::file::write(&bare).expect("it is a plan"));
    let command = format!("modl show {name}.mod");
    let data = ["planner", "seed", "energy", "verified", &command, &hash].map(str::to_owned).to_vec();
    let (joints, failure) = (true, Value::Null);
    Looks { name, plan, joints, colours: OF_ROBOT, toggles: ON_GROUND, curves: OF_JOINTS, data, failure }
}

/// A page of a plan that fails, of which there is no plan file.
fn of_failure(name: &'static str, says: &str, modules: &[&str], met: bool) -> Looks {
    let failure = json!({ "says": says, "modules": modules, "met": met });
    let plan = plan_of(plan(chain(1), wait(1.0)).expect("it can be scheduled"));
    let data = vec!["not verified".to_owned()];
    let curves = &["joints", "clearance", "stability margin"];
    Looks { name, plan, joints: true, colours: OF_ROBOT, toggles: &["mass", "goal"], curves, data, failure }
}

fn of_family(name: &'static str, plan: Plan, colours: &'static [&'static str]) -> Looks {
    let (toggles, data, failure) = (&["start", "goal", "edges"][..], vec!["planner".to_owned()], Value::Null);
    Looks { name, plan, joints: false, colours, toggles, curves: &[], data, failure }
}

/// The page of the simulation in [`SLIDES`]: links are where the kinematics have them for the measured joints.
fn of_simulation(sandbox: &Sandbox) -> Value {
    let mut looks = of_program(sandbox, "slides");
    looks.colours = &["part", "effort", "type"];
    looks.toggles = &["nominal", "forces", "paths", "goal", "edges", "shadow"];
    looks.curves = &["joints", "efforts"];
    looks.data = vec!["planner".into()];
    let mut wanted = looks.wanted("out/slides.html", "Walk4", false);
    let settings = Settings { friction: 0.3, ..Settings::default() };
    let simulation = simulate(&looks.plan, &settings).expect("it can be simulated");
    let tracks = looks.plan.body.tracks().expect("a robot's plan");
    let kinematics = Kinematics::new(&tracks.robot, &tracks.start.bonds, tracks.robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    let moments = simulation.motion.iter().step_by(simulation.motion.len() / 6);
    let placed = moments.map(|moment| {
        kinematics.link_poses(&moment.joints, &moment.base, &mut poses);
        let bodies = poses.iter().enumerate().map(|(i, X)| {
            let p = X.translation.vector;
            json!([i, p.x, p.y, p.z])
        });
        std::iter::once(json!(moment.time)).chain(bodies).collect::<Value>()
    });
    wanted["poses"] = placed.collect();
    wanted["ghost"] = json!(true);
    wanted
}

#[test]
fn pages_play_in_a_browser() {
    let Some((playwright, chromium)) = tools() else {
        println!("skipped: Node.js, playwright-core or Chromium is missing (see .ci/run)");
        return;
    };
    let sandbox = Sandbox::new(&[]);
    for (name, text) in PROGRAMS {
        let file = format!("{name}.mod");
        fs::write(sandbox.path(&file), text).expect("a file can be written");
        let ran = sandbox.run(&["show", &file]);
        assert!(ran.err.contains(".html"), "{name}: {}", ran.err);
    }
    let bound = |looks: Looks| Looks { data: [looks.data, vec!["lower bound".into()]].concat(), ..looks };
    let free = &["start", "goal", "edges"];
    let octahedron = of_program(&sandbox, "octahedron");
    let slab = of_program(&sandbox, "slab");
    let of_programs = [
        of_program(&sandbox, "walkbot"),
        of_program(&sandbox, "ring"),
        bound(Looks {
            colours: &["part", "type"],
            toggles: &["start", "goal", "collides", "edges"],
            curves: &["joints", "clearance"],
            ..octahedron
        }),
        bound(Looks { joints: false, colours: &["size", "type"], toggles: free, curves: &[], ..slab }),
        of_failure("dig", "falls over arm[0]", &["arm[0]"], false),
        // Four modules at right angles close a ring: the next comes down on the first.
        of_failure("curl", "meet", &["s[0].m[2]", "s[1].m[0]"], true),
    ];
    let mut wanted: Vec<Value> = of_programs
        .iter()
        .map(|looks| looks.wanted(&format!("out/{}.html", looks.name), "", false))
        .collect();
    let robot = Looks { joints: true, toggles: ON_GROUND, ..of_family("snake", snake(), OF_ROBOT) };
    let families = [
        robot,
        of_family("lattice", lattice(), &["size", "type"]),
        of_family("truss", truss(), &["length", "part", "type"]),
        Looks { joints: true, ..of_family(HOSTILE, hostile(), OF_ROBOT) },
    ];
    for looks in &families {
        let file =
            if looks.name == HOSTILE { "hostile.html".to_owned() } else { format!("{}.html", looks.name) };
        let input = RenderInput { title: looks.name, plan: &looks.plan, texts: &[], command: "" };
        fs::write(sandbox.path(&file), page(&input)).expect("a file can be written");
        let measured = std::env::var_os("MODL_PAGES").is_some();
        wanted.push(looks.wanted(&file, looks.name, measured));
    }
    wanted.push(of_simulation(&sandbox));
    if let Some(kept) = std::env::var_os("MODL_PAGES") {
        keep(&sandbox, &wanted, Path::new(&kept));
    }
    let found = check(&playwright, &chromium, &sandbox.path(""), &json!(wanted));
    let pages = found["pages"].as_array().expect("a list");
    assert!(pages.len() > wanted.len());
    let faulty = |page: &&Value| page["faults"].as_array().is_none_or(|faults| !faults.is_empty());
    pages.iter().for_each(|page| println!("{}: {}", page["name"], page["figures"]));
    assert_eq!(pages.iter().filter(faulty).collect::<Vec<_>>(), Vec::<&Value>::new());
}

/// Copies the pages to the folder that `MODL_PAGES` names, for a person to look at.
fn keep(sandbox: &Sandbox, wanted: &[Value], folder: &Path) {
    for page in wanted {
        let name = page["name"].as_str().expect("a name");
        let to = folder.join(Path::new(name).file_name().expect("a file"));
        fs::copy(sandbox.path(name), to).expect("the folder is there");
    }
}

fn check(playwright: &Path, chromium: &Path, folder: &Path, wanted: &Value) -> Value {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/check.mjs");
    let mut child = Command::new("node")
        .args([&script, playwright, chromium, folder])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("Node.js runs, it has before");
    let mut stdin = child.stdin.take().expect("it is piped");
    stdin.write_all(wanted.to_string().as_bytes()).expect("the script reads all of its input");
    drop(stdin);
    let output = child.wait_with_output().expect("the script ends");
    assert!(output.status.success(), "the script fails");
    serde_json::from_slice(&output.stdout).expect("the script prints JSON")
}
