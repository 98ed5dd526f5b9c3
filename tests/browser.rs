//! Pages in a browser: headless Chromium opens one of every family and uses it as a person would
//! (`tests/browser/check.mjs`). Skipped, with a message, where Node.js, playwright-core or Chromium is
//! missing; `.ci/run` installs them.
#![allow(non_snake_case)]

use crate::cli::Sandbox;
use crate::plan_operations::plan_of;
use crate::programs::*;
use crate::robots::{TILT, chain};
use modl::geometry::Pose;
use modl::plan::{
    Body, CauseId, CellLimits, Counter, Knot, Law, Model, NodePaths, Plan, Ratio, Run, Stage, Stages, Way,
    verify,
};
use modl::robot::{Cell, Kinematics, Library, Strut};
use modl::view::{Showing, page};
use serde_json::{Value, json};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;

/// playwright-core and Chromium: where `MODL_PLAYWRIGHT` and `MODL_CHROMIUM` say, or where `.ci/run`
/// puts them.
fn tools() -> Option<(PathBuf, PathBuf)> {
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
    let walked = verify::history(plan, plan.body.duration());
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

/// 300 modules in a row that lift and lower every tenth of them.
fn snake() -> Plan {
    let joint = |module: u32| 4 * module + TILT as u32;
    let wave = |to: f64| parallel((0..30).map(|i| go_in(joint(10 * i), to, 2.0, 0)).collect());
    plan_of(plan(chain(300), series(vec![wave(0.2), wave(-0.2), wave(0.0)])).expect("it can be scheduled"))
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

/// A thousand cubes squeezed along x, then along y, and let go along x.
fn lattice() -> Plan {
    let half = Ratio(1, 2);
    let stage = |name: &str, sizes| Stage {
        name: name.into(),
        time_squared: Ratio(4, 1),
        law: Law::BangBang,
        end: vec![block(sizes, 10)],
        cause: CauseId(0),
    };
    let one = Ratio::ONE;
    let stages = Stages {
        cell: 0,
        count: 1000,
        time_unit: 0.5,
        limits: CellLimits::default(),
        model: Model::default(),
        start: vec![block([one; 3], 10)],
        stages: vec![
            stage("x-squeeze", [half, one, one]),
            stage("y-squeeze", [half, half, one]),
            stage("x-release", [one, half, one]),
        ],
    };
    let cell = Cell { name: "Cube".into(), size: 0.1, shrinks_to: 0.05, mass: 1.0, force: 10.0, speed: 0.1 };
    of_body(Body::Stages(stages), Library { cells: vec![cell], ..Library::default() })
}

/// An arch of 100 triangles, 300 nodes, that leans and then rolls over an edge of its foot.
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
    let knot = |time, way, nodes| Knot { time, way, nodes, cause: CauseId(0) };
    let (edge, angle) = ((0, 1), -0.3);
    let leaning = knot(2.0, Way::Straight, nodes(0.3));
    let mut paths = NodePaths {
        strut: 0,
        node_names: (0..300).map(|i| format!("ring[{}][{}]", i / 3, i % 3)).collect(),
        struts,
        knots: vec![knot(0.0, Way::Straight, nodes(0.0)), leaning.clone(), leaning],
    };
    paths.knots[2].time = 4.0;
    paths.knots[2].way = Way::Roll { edge, angle };
    // Just before its end a roll is where it leads.
    paths.knots[2].nodes = paths.state(4.0 - 1e-12);
    let strut = Strut {
        name: "Reel".into(),
        length: (0.3, 3.0),
        speed: 0.05,
        force: 200.0,
        mass: 1.0,
        clearance: 0.1,
    };
    of_body(Body::NodePaths(paths), Library { struts: vec![strut], ..Library::default() })
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

/// Programs whose pages are looked at, too: their names and texts.
const PROGRAMS: &[(&str, &str)] = &[
    ("walkbot", include_str!("../examples/walkbot.mod")),
    ("dig", include_str!("acceptance/falls.mod")),
    ("fold", FOLD),
];

/// Four panels that fold up.
const FOLD: &str = "use std.mori.Mori
config Strip {
  part m[4]: Mori
  for i in 0..3 { connect m[i].edge[1] -- m[i + 1].edge[0] }
  base m[0]
}
";

#[test]
fn pages_play_in_a_browser() {
    let Some((playwright, chromium)) = tools() else {
        println!("skipped: Node.js, playwright-core or Chromium is missing (see .ci/run)");
        return;
    };
    let sandbox = Sandbox::new(&[]);
    let mut wanted = Vec::new();
    for (name, text) in PROGRAMS {
        let file = format!("{name}.mod");
        fs::write(sandbox.path(&file), text).expect("a file can be written");
        let ran = sandbox.run(&["show", &file]);
        assert!(ran.err.contains(".html"), "{name}: {}", ran.err);
    }
    let text = fs::read_to_string(sandbox.path("out/walkbot.plan.json")).expect("written");
    let walk = modl::plan::file::read(&text).expect("a plan");
    let poses = places(&walk, &[0.0, 1.7, 3.3, 5.1, 8.2, 12.0]);
    for (name, moves, poses) in
        [("walkbot", true, poses), ("dig", true, json!([])), ("Strip", false, json!([]))]
    {
        wanted.push(json!({ "name": format!("out/{name}.html"), "moves": moves, "poses": poses }));
    }
    for (name, plan) in [("snake", snake()), ("lattice", lattice()), ("truss", truss()), (HOSTILE, hostile())]
    {
        let file = if name == HOSTILE { "hostile.html".to_owned() } else { format!("{name}.html") };
        let text = page(&Showing { title: name, plan: &plan, texts: &[], command: "" });
        fs::write(sandbox.path(&file), text).expect("a file can be written");
        let measured = std::env::var_os("MODL_PAGES").is_some();
        let poses = if name == HOSTILE { places(&plan, &[0.0, 0.2, 10.0]) } else { json!([]) };
        wanted.push(
            json!({ "name": file, "moves": true, "poses": poses, "title": name, "measured": measured }),
        );
    }
    if let Some(kept) = std::env::var_os("MODL_PAGES") {
        keep(&sandbox, &wanted, Path::new(&kept));
    }
    let found = check(&playwright, &chromium, &sandbox.path(""), &json!(wanted));
    let pages = found["pages"].as_array().expect("a list");
    assert_eq!(pages.len(), wanted.len() + 2);
    for page in pages {
        println!("{}: {}", page["name"], page["figures"]);
        assert_eq!(page["faults"], json!([]), "{}", page["name"]);
    }
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
