//! Models of MuJoCo: their text is well formed; loaded by MuJoCo itself (from PyPI), they have the same masses and the
//! same poses of all links along plans; and behaviours that are verified happen in a simulation. What needs Python and
//! MuJoCo is skipped, with a message, where they are missing.
#![allow(non_snake_case)]

use crate::behavior::behaviors_of_designs::BEHAVIORS;
use crate::judge::oracle;
use crate::robots::urdf;
use crate::support::desk::run_clean;
use crate::support::properties::whole;
use modl::formats::mjcf;
use modl::geometry::{Pose, Vec3};
use modl::plan::verify::articulated::{base_at, standing};
use modl::plan::verify::verify;
use modl::plan::{Body, DynamicsModel, Plan, Verdict, file};
use modl::robot::Kinematics;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::{Arc, LazyLock};

/// Poses of links, m and parts of a rotation: above the rounding of thirty joints in a row.
const TOL: f64 = 1e-12;

/// Masses, inertias and what follows from them: a link without mass has the least that MuJoCo moves.
const MASS_TOL: f64 = 1e-9;

/// Instants of a plan at which poses are compared.
const MOMENTS: usize = 20;

/// The share of the limits up to which torque must suffice for a plan to happen as the judge says.
const RESERVE: f64 = 0.9;

/// Random robots in the gate, and in `.ci/full dynamics`.
const FEW: u64 = 12;
const MANY: u64 = 300;

/// Robots and behaviours: a loop that opens and closes at two places, joints that slide, that follow one and several
/// others, that are fixed, hinges of bonds, of which one closes a loop, a base that is fixed, one that settles, and two robots
/// among obstacles.
pub const PROGRAMS: &[&str] = &[
    "use std.smores.Ring12
let ring = Ring12()
let first = Sc(undock(ring.m[11].bottom), wait(1s), dock(ring.m[11].bottom, ring.m[0].top))
let second = Sc(undock(ring.m[5].bottom), wait(1s), dock(ring.m[5].bottom, ring.m[6].top))
let p = plan(Sc(first, second), world: world(ground: off, gravity: off))",
    "use std.smores.TwoCars
let p = plan(TwoCars().open(), world: world(ground: off, gravity: off))",
    "use std.smores.Driver1
let p = plan(Driver1().drive(t: 1s), world: world(ground: fixed))",
    "use std.smores.Driver1
let p = plan(Driver1().turn(), world: world(friction: 0.5))",
    "use std.mori.Mori
config Strip { part m[3]: Mori
  for i in 0..2 { connect m[i].edge[1] -- m[i + 1].edge[0] }
  set m[0].edge[1].joint = 90deg
  base m[1]
  behavior fold = move(m[1].edge[1].joint, to: 60deg)
}
let p = plan(Strip().fold(), world: world(ground: held))",
    "use std.mori.Mori
config Cap closed { part m[4]: Mori
  for i in 0..4 {
    connect m[i].edge[1] -- m[(i + 1) % 4].edge[2]
    set m[i].edge[1].joint = acos(1 / 3)
  }
  base m[0]
  behavior rest = move(m[0].edge[1].joint, to: acos(1 / 3), in: 1s)
}
let p = plan(Cap().rest(), world: world(ground: off, gravity: off))",
    "connector Face { mates Face, turns 4 }
module Odd(length: Length = 300mm) {
  link rail = union(
    placed(box(length, 50mm, 50mm), at: [0mm, 0mm, 10mm]),
    placed(hull([[0mm, 0mm, 0mm], [20mm, 0mm, 0mm], [0mm, 20mm, 0mm], [0mm, 0mm, -20mm]]), at: [0mm, 0mm, 0mm]),
    mass: 1kg,
  )
  link cart = capsule(radius: 20mm, length: 30mm, axis: X, mass: 200g) at [0mm, 0mm, 80mm]
  link twin = cylinder(radius: 20mm, length: 30mm, axis: Y, mass: 200g) at [0mm, 0mm, 130mm]
  link arm = box(100mm, 10mm, 10mm, mass: 100g) at [50mm, 90mm, 0mm]
  link sensor = sphere(radius: 4mm, mass: 5g) at [110mm, 90mm, 0mm]
  link lever = box(10mm, 60mm, 10mm, mass: 50g) at [0mm, -80mm, 0mm]
  link wheel = cylinder(radius: 20mm, length: 10mm, axis: X, mass: 50g) at [170mm, 0mm, 0mm]
  joint x : rail -> cart = prismatic(axis: X, range: -80mm..80mm, max_speed: 50mm/s, max_force: 100N)
  joint y : cart -> twin = prismatic(axis: X + Y)
  joint y = 0.5 * x
  joint a : rail -> arm = revolute(axis: Z, range: -90deg..90deg, max_speed: 2rad/s, max_torque: 3N*m)
    at [0mm, 90mm, 0mm]
  joint held : arm -> sensor = fixed()
  joint b : rail -> lever = revolute(axis: X) at [0mm, -40mm, 10mm]
  joint b = a - 0.5 * c
  joint c : rail -> wheel = revolute(axis: X, max_speed: 2rad/s, max_accel: 9rad/s^2) at [160mm, 0mm, 0mm]
  port end : Face on arm at [80mm, 0mm, 0mm] facing +X up +Z
  port start : Face on rail at [-150mm, 0mm, 0mm] facing -X up +Z
}
config Odds {
  part o[2]: Odd
  connect o[0].end -- o[1].start turn 90deg
  base o[1]
  behavior go =
    Pc(move(o[0].x, to: 30mm), move(o[0].a, to: 20deg), spin(o[0].c, 1rad/s, for: 1s), move(o[1].a, to: -5deg))
}
let p = plan(Odds().go(), world: world(ground: off, gravity: off))",
    "use std.smores.{Driver1, Tank7}
scene Pair {
  part a: Tank7
  part b: Driver1 at [700mm, 200mm, 0m] turned(Z, 90deg)
  obstacle wall = box(50mm, 800mm, 200mm) at [-800mm, -200mm, 100mm]
  obstacle post = union(
    placed(hull([[0mm, 0mm, 0mm], [90mm, 0mm, 0mm], [0mm, 90mm, 0mm], [0mm, 0mm, 90mm]]), at: [0mm, 0mm, 0mm]),
    placed(capsule(radius: 20mm, length: 30mm, axis: X), at: [0mm, 0mm, 200mm]),
  ) at [0mm, 900mm, 0m] turned(Z, 30deg)
  behavior go = Pc(a.drive(t: 1s), b.drive(t: 1s))
}
let p = plan(Pair().go())",
];

/// A plan and its model.
#[derive(Clone)]
pub struct Case {
    name: String,
    pub plan: Plan,
    model: String,
}

impl Case {
    pub fn new(name: &str, plan: Plan) -> Case {
        let model = mjcf::write(&plan).expect("the robot has links and joints");
        Case { name: name.to_owned(), plan, model }
    }

    /// The plan of a program that leaves it in `p`, and the model that `save` writes.
    pub fn of(program: &str) -> Case {
        let written = run_clean(&format!("{program}\nemit(p, \"p.json\")\nsave(p, \"p.mjcf.xml\")\n"));
        let plan = written.plan("p.json");
        Case { name: program.to_owned(), plan, model: written.text("p.mjcf.xml").to_owned() }
    }

    fn tracks(&self) -> &modl::plan::Tracks {
        self.plan.body.tracks().expect("the robot has joints")
    }

    /// The name of every link in the model, by number.
    fn links(&self) -> Vec<String> {
        let robot = &self.tracks().robot;
        let of = |module: usize| {
            let links = &robot.module_type(module).links;
            links.iter().map(move |link| format!("{}.{}", robot.modules[module].name, link.name))
        };
        (0..robot.modules.len()).flat_map(of).collect()
    }

    fn times(&self) -> Vec<f64> {
        let duration = self.tracks().duration;
        (0..=MOMENTS).map(|i| duration * i as f64 / MOMENTS as f64).collect()
    }

    /// The bonds that hold and the world poses of all links at a time, with the base where it stands at the start.
    fn poses(&self, t: f64) -> (Vec<bool>, Vec<Pose>) {
        let tracks = self.tracks();
        let state = tracks.state(t);
        let kinematics = Kinematics::new(&tracks.robot, &state.bonds, tracks.robot.base);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        let X_WB = base_at(&self.plan, 0.0).expect("the plan is valid");
        kinematics.link_poses(&state.joints, &X_WB, &mut poses);
        let others = standing(&self.plan, 0.0).map_or(vec![], |stands| stands.clusters);
        assert!(kinematics.tree.loose.is_empty() || !others.is_empty(), "one robot hangs together");
        for cluster in others {
            let own = Kinematics::new(&tracks.robot, &state.bonds, cluster.reference);
            own.link_poses(&state.joints, &cluster.pose, &mut poses);
        }
        (state.bonds, poses)
    }

    pub fn task(&self) -> Value {
        let text = file::write(&self.plan).expect("the plan can be written");
        let links = self.links();
        let moment = |t: f64| {
            let (_, poses) = self.poses(t);
            let roots = links.iter().zip(&poses).map(|(link, X)| {
                let (p, q) = (X.translation.vector, X.rotation);
                (link.clone(), json!([p.x, p.y, p.z, q.w, q.i, q.j, q.k]))
            });
            json!({ "time": t, "roots": roots.collect::<BTreeMap<_, _>>() })
        };
        json!({
            "model": self.model,
            "plan": serde_json::from_str::<Value>(&text).expect("a plan file is JSON"),
            "moments": self.times().into_iter().map(moment).collect::<Vec<_>>(),
        })
    }
}

/// A random robot; of every other one the last links of modules have no mass.
pub fn random(seed: u64) -> Plan {
    let mut plan = oracle::plan(seed);
    if seed % 2 == 1 {
        let mut library = (*plan.library).clone();
        for link in library.modules.iter_mut().filter_map(|module| module.links[1..].last_mut()) {
            (link.mass, link.inertia) = (0.0, [0.0; 6]);
        }
        plan.library = Arc::new(library);
        let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
        tracks.robot.library = plan.library.clone();
    }
    plan
}

/// Random robots, [`PROGRAMS`], and with `MODL_WHOLE=1` the behaviours of `std.smores`.
static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let whole = whole();
    let seeds = 0..if whole { MANY } else { FEW };
    let mut cases: Vec<Case> = seeds.map(|seed| Case::new(&format!("robot {seed}"), random(seed))).collect();
    cases.extend(PROGRAMS.iter().map(|program| Case::of(program)));
    if whole {
        cases.extend(BEHAVIORS.iter().map(|(robot, behavior, _)| {
            Case::of(&format!("use std.smores.{robot}\nlet x = {robot}()\nlet p = plan({behavior})"))
        }));
    }
    cases
});

/// An element of XML: its name and its attributes.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) attributes: BTreeMap<String, String>,
}

/// Reads the elements of a document that has a line for each tag, in order; panics where it is not well formed.
pub(super) fn elements(text: &str) -> Vec<Element> {
    let mut found = vec![];
    let mut open: Vec<String> = vec![];
    for line in text.lines().map(str::trim) {
        let inner = line.strip_prefix('<').and_then(|line| line.strip_suffix('>')).expect("a line is a tag");
        if let Some(comment) = inner.strip_prefix("!--") {
            let comment = comment.strip_suffix("--").expect("a comment ends");
            assert!(!comment.contains("--") && !comment.contains(['<', '>']), "{line}");
            continue;
        }
        if let Some(name) = inner.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name));
            continue;
        }
        let (inner, empty) = inner.strip_suffix('/').map_or((inner, false), |inner| (inner, true));
        let mut parts = inner.split('"');
        let head = parts.next().expect("a tag has a name");
        let (name, mut key) = head.split_once(' ').unwrap_or((head, ""));
        let mut attributes = BTreeMap::new();
        while let Some(value) = parts.next() {
            assert!(!value.contains(['<', '>']) && !value.contains(char::is_control), "{line}");
            let plain =
                ["&lt;", "&gt;", "&quot;", "&amp;"].iter().fold(value.to_owned(), |v, e| v.replace(e, ""));
            assert!(!plain.contains('&'), "{line}");
            let key_name = key.trim().strip_suffix('=').expect("a value has a key").to_owned();
            assert!(attributes.insert(key_name, value.to_owned()).is_none(), "{line}");
            key = parts.next().expect("a value ends");
        }
        found.push(Element { name: name.to_owned(), attributes });
        if !empty {
            open.push(name.to_owned());
        }
    }
    assert!(open.is_empty());
    found
}

/// Names of elements of one kind must differ, and those that are referred to must exist.
fn check_names(text: &str) {
    let all = elements(text);
    let named = |kinds: &[&str]| -> Vec<String> {
        let of = all.iter().filter(|e| kinds.contains(&e.name.as_str()));
        of.filter_map(|e| e.attributes.get("name").cloned()).collect()
    };
    let mut known = BTreeMap::new();
    for kinds in [
        &["body"][..],
        &["joint", "freejoint"],
        &["site"],
        &["geom"],
        &["mesh"],
        &["weld", "connect"],
        &["fixed"],
    ] {
        let mut names = named(kinds);
        if kinds[0] == "joint" {
            let below_body = |e: &&Element| e.name == "joint" && e.attributes.contains_key("joint1");
            let equalities = all.iter().filter(below_body).filter_map(|e| e.attributes.get("name"));
            let equalities: BTreeSet<&String> = equalities.collect();
            names.retain(|name| !equalities.contains(name));
        }
        let set: BTreeSet<String> = names.iter().cloned().collect();
        assert_eq!(set.len(), names.len(), "names of {kinds:?} repeat");
        known.insert(kinds[0], set);
    }
    let references = [
        ("body1", "body"),
        ("body2", "body"),
        ("site1", "site"),
        ("site2", "site"),
        ("joint", "joint"),
        ("joint1", "joint"),
        ("joint2", "joint"),
        ("mesh", "mesh"),
        ("geom1", "geom"),
        ("geom2", "geom"),
        ("tendon1", "fixed"),
    ];
    for element in &all {
        for (key, kind) in references {
            if let Some(name) = element.attributes.get(key) {
                assert!(known[kind].contains(name), "`{name}` is no {kind}");
            }
        }
    }
}

#[test]
fn models_are_well_formed_and_refer_to_what_they_have() {
    for case in CASES.iter() {
        check_names(&case.model);
        assert_eq!(Some(&case.model), mjcf::write(&case.plan).ok().as_ref(), "{}: two texts", case.name);
        let bodies = elements(&case.model).iter().filter(|element| element.name == "body").count();
        assert_eq!(bodies, case.links().len(), "{}", case.name);
    }
}

#[test]
fn names_and_numbers_of_any_kind_leave_a_model_well_formed() {
    let mut plan = oracle::plan(3);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
    tracks.robot.name = "--><a b=\"&\">\u{1}---".to_owned();
    for (index, module) in tracks.robot.modules.iter_mut().enumerate() {
        module.name = format!("<{index}&\"'\n--");
    }
    tracks.robot.modules[0].name = "ä 漢".to_owned();
    let model = mjcf::write(&plan).expect("names are free");
    check_names(&model);
    assert!(model.contains("ä 漢.l0"));
}

/// Runs a script on tasks, with the modules of this folder in reach; `None`, with a message, where Python or MuJoCo is
/// missing.
pub(super) fn answers(script: &str, tasks: &[Value]) -> Option<Vec<Value>> {
    let Some(python) = python() else {
        let why = "no Python with mujoco (.ci/run installs it)";
        writeln!(std::io::stderr(), "skipped: models of MuJoCo: {why}").expect("stderr is open");
        return None;
    };
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/dynamics").display().to_string();
    let script = format!("import sys; sys.path.insert(0, {folder:?}); {script}");
    let answers = urdf::run(&python, &script, &json!(tasks));
    Some(answers.as_array().expect("a list").clone())
}

/// A Python that has MuJoCo: the one that `MODL_PYTHON` names, or that of the environment that `.ci/run` makes.
fn python() -> Option<PathBuf> {
    let local = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("target/python/bin/python");
    let python = std::env::var_os("MODL_PYTHON").map_or(local, PathBuf::from);
    let found = Command::new(&python).args(["-c", "import mujoco"]).stderr(Stdio::null()).status();
    found.is_ok_and(|status| status.success()).then_some(python)
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Compares masses of links and their friction on the ground with the declarations; returns the number of contacts.
fn compare_links(case: &Case, answer: &Value) -> usize {
    let robot = &case.tracks().robot;
    let declared = (0..robot.modules.len()).flat_map(|module| &robot.module_type(module).links);
    let world = case.plan.worlds[0].world;
    let mut contacts = 0;
    for (name, link) in case.links().iter().zip(declared) {
        let ours = std::iter::once(link.mass).chain(link.com.iter().copied()).chain(link.inertia);
        let theirs = answer["masses"][name].as_array().expect("a list");
        for (ours, theirs) in ours.zip(theirs) {
            let error = (ours - number(theirs)).abs();
            assert!(error <= 1.1 * MASS_TOL, "{}: {name}: {error:e}", case.name);
        }
        if let Some(friction) = answer["frictions"].get(name) {
            let error = (link.friction * world.friction - number(friction)).abs();
            assert!(error < MASS_TOL, "{}: {name}: friction {friction}", case.name);
            contacts += 1;
        }
    }
    assert!(world.has_floor() || contacts == 0, "{}: there is no floor", case.name);
    contacts
}

/// Compares what MuJoCo makes of a model with our own kinematics.
fn compare(case: &Case, answer: &Value) {
    let tracks = case.tracks();
    let (_, start) = case.poses(0.0);
    let declared = (0..tracks.robot.modules.len()).flat_map(|module| &tracks.robot.module_type(module).links);
    let (mut centre, mut mass) = (Vec3::zeros(), 0.0);
    for (link, X) in declared.zip(&start) {
        centre += X.transform_point(&link.com.into()).coords * link.mass;
        mass += link.mass;
    }
    centre /= mass;
    let links = case.links();
    // A link without mass has the least that MuJoCo moves, 1e-9 kg.
    let tol = MASS_TOL * links.len() as f64;
    assert!((number(&answer["mass"]) - mass).abs() <= tol, "{}: mass", case.name);
    for axis in 0..3 {
        assert!(
            (number(&answer["centre"][axis]) - centre[axis]).abs() < tol,
            "{}: centre of mass",
            case.name
        );
    }
    for (t, theirs) in case.times().into_iter().zip(answer["moments"].as_array().expect("a list")) {
        let (bonds, poses) = case.poses(t);
        for (link, X) in links.iter().zip(&poses) {
            let R = X.rotation.to_rotation_matrix();
            let ours = X.translation.vector.iter().copied().chain((0..9).map(|i| R[(i / 3, i % 3)]));
            let theirs = theirs["poses"][link].as_array().unwrap_or_else(|| panic!("no body {link}"));
            for (ours, theirs) in ours.zip(theirs) {
                let error = (ours - number(theirs)).abs();
                assert!(error < TOL, "{}: {link} at {t} s: {error:e}", case.name);
            }
        }
        let gaps = theirs["gaps"].as_object().expect("a table");
        let active = gaps.keys().filter(|name| !name.ends_with(", high")).count();
        let in_tree = tracks.start.bonds.iter().enumerate();
        let lasting = |bond: usize| tracks.events.iter().all(|event| event.bond != bond);
        let lasting: Vec<bool> = in_tree.map(|(bond, holds)| *holds && lasting(bond)).collect();
        let tree = Kinematics::new(&tracks.robot, &lasting, tracks.robot.base).tree;
        let within = lasting.iter().filter(|holds| **holds).count() - tree.closing.len();
        let holding = bonds.iter().filter(|holds| **holds).count();
        assert_eq!(active, holding - within, "{}: constraints at {t} s", case.name);
        for (bond, gap) in gaps {
            assert!(number(gap) < TOL, "{}: {bond} at {t} s: {gap}", case.name);
        }
    }
}

#[test]
fn mujoco_places_links_where_we_do() {
    let tasks: Vec<Value> = CASES.iter().map(Case::task).collect();
    let Some(answers) = answers("import mujoco_poses", &tasks) else { return };
    CASES.iter().zip(&answers).for_each(|(case, answer)| compare(case, answer));
    let contacts: usize = CASES.iter().zip(&answers).map(|(case, answer)| compare_links(case, answer)).sum();
    assert!(contacts >= 2, "a car stands on two wheels");
}

/// Behaviours of the library that do not happen as statics say, though torque suffices: wheels that scrub decide, and drag
/// the robot along; and a wheel bears on its two rims in MuJoCo, so that a car which turns on the spot does so about the outer
/// ones, by 86 degrees and not by 90 (with dry friction by 87).
const UNLIKE: &[(&str, &str)] = &[("Driver1", "x.turn()"), ("MobManip8", "Sc(x.raise(), x.forward())")];

/// The stiffness of the servos, N·m/rad, that behaviours are played with besides that of the models, 150.
const GAINS: [f64; 2] = [60.0, 500.0];

/// The torque in parts of its limit up to which what happens must be passed.
pub(super) const SURE: f64 = 0.8;

/// Returns the verdict on a plan under full dynamics, with no reserve.
fn under_full_dynamics(plan: &Plan) -> Verdict {
    let mut plan = plan.clone();
    plan.settings.reserve = 0.0;
    plan.worlds.iter_mut().for_each(|from| from.world.dynamics = DynamicsModel::Full);
    verify(&plan)
}

/// Plays plans on their models with servos of a stiffness (N·m/rad), and damping in proportion to it, by a function of
/// `mujoco_runner`, whose other arguments are `more`; `None` without MuJoCo.
pub fn played(tasks: &[Value], stiffness: f64, function: &str, more: &str) -> Option<Vec<Value>> {
    let damping = 6.0 * stiffness / 150.0;
    let script = format!(
        "import json, mujoco_runner; tasks = json.load(sys.stdin); play = mujoco_runner.{function}; \
         json.dump([play(t['plan'], t['model'], kp={stiffness}, kv={damping}{more}) for t in tasks], sys.stdout)"
    );
    answers(&script, tasks)
}

/// Returns the angle between two headings, rad: a simulation does not count whole turns.
pub(super) fn turned_apart(a: f64, b: f64) -> f64 {
    let turned = (a - b).rem_euclid(TAU);
    turned.min(TAU - turned)
}

/// Returns true if a simulation travels and turns as a verdict says, within 10 %, 5 mm or as it is known, and 10 % or 3
/// degrees, with no joint more than 10 degrees behind the plan.
pub(super) fn happens(verdict: &Verdict, simulated: &Value) -> bool {
    let travel = Vec3::from([0, 1, 2].map(|axis| number(&simulated["travel"][axis])));
    let yaw = number(&simulated["yaw"]);
    let known = verdict.travel_within.unwrap_or(0.0);
    (travel - Vec3::from(verdict.travel)).norm() < (0.1 * travel.xy().norm()).max(0.005).max(known)
        && turned_apart(yaw, verdict.heading)
            < (0.1 * yaw.abs()).max(verdict.heading_within.unwrap_or(0.0)).max(3_f64.to_radians())
        && number(&simulated["lag"][0]).to_degrees() < 10.0
        && simulated["fell"] == false
}

/// A behaviour of the library: the robot, the call, and the least distance that it gets straight ahead, mm.
pub type LibraryBehavior = (&'static str, &'static str, f64);

/// Returns the first behaviours of the library, with `MODL_WHOLE=1` all, their cases and the tasks of these.
pub fn of_the_library(few: usize) -> (&'static [LibraryBehavior], Vec<Case>, Vec<Value>) {
    let whole = whole();
    let some = &BEHAVIORS[..if whole { BEHAVIORS.len() } else { few }];
    let cases: Vec<Case> = some
        .iter()
        .map(|(robot, behavior, _)| {
            Case::of(&format!(
                "use std.smores.{robot}\nlet x = {robot}()\n\
                 let p = plan({behavior}, world: world(dynamics: statics))"
            ))
        })
        .collect();
    let tasks = cases.iter().map(Case::task).collect();
    (some, cases, tasks)
}

#[test]
fn what_is_verified_happens_with_other_servos() {
    let (some, cases, tasks) = of_the_library(1);
    let (Some(softer), Some(stiffer)) =
        (played(&tasks, GAINS[0], "both", ""), played(&tasks, GAINS[1], "both", ""))
    else {
        return;
    };
    let mut wrong = vec![];
    for (index, (case, (robot, behavior, _))) in cases.iter().zip(some).enumerate() {
        let verdict = under_full_dynamics(&case.plan);
        let told = [&softer[index], &stiffer[index]].map(|simulated| {
            let travel = [0, 1].map(|axis| number(&simulated["travel"][axis]));
            format!(
                "{:.0} mm, {:.0}° | {:.1}° | {:.2}",
                1e3 * libm::hypot(travel[0], travel[1]),
                number(&simulated["yaw"]).to_degrees().round() + 0.0,
                number(&simulated["lag"][0]).to_degrees(),
                number(&simulated["needed"][0])
            )
        });
        let word = if verdict.ok() { "passed" } else { "refused" };
        let row = format!("| `{robot}` | `{behavior}` | {} | {} | {word} |", told[0], told[1]);
        writeln!(std::io::stderr(), "{row}").expect("stderr is open");
        let happen = [&softer[index], &stiffer[index]].iter().all(|simulated| happens(&verdict, simulated));
        if verdict.ok() && !happen {
            wrong.push(row);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_verified_happens_in_a_simulation() {
    let (some, cases, tasks) = of_the_library(3);
    let Some(simulated) = played(&tasks, 150.0, "both", "") else { return };
    let mut wrong = vec![];
    for ((case, simulated), (robot, behavior, _)) in cases.iter().zip(&simulated).zip(some) {
        let verdict = case.plan.verdict.as_ref().expect("it was verified under statics");
        let ours = Vec3::from(verdict.travel);
        let (mm, whole) = (|x: f64| x * 1e3, |x: f64| x.to_degrees().round() + 0.0);
        let get = |key: &str, index: usize| number(&simulated[key][index]);
        let (theirs, yaw) =
            (Vec3::from([0, 1, 2].map(|axis| get("travel", axis))), number(&simulated["yaw"]));
        let needed = get("needed", 0);
        let row = format!(
            "| `{robot}` | `{behavior}` | {:.0} mm, {:.0}° | {:.0} mm, {:.0}° | {:.1}° | {needed:.2} |{}",
            mm(ours.xy().norm()),
            whole(verdict.heading),
            mm(theirs.xy().norm()),
            whole(yaw),
            get("lag", 0).to_degrees(),
            if simulated["fell"] == true { " falls |" } else { "" }
        );
        let full = under_full_dynamics(&case.plan);
        let row = format!(
            "{row} {:.0} mm, {:.0}° | {:.2} | {} |",
            mm(Vec3::from(full.travel).xy().norm()),
            whole(full.heading),
            1.0 - full.torque_margin.as_ref().map_or(1.0, |worst| worst.value),
            if full.ok() { "passed" } else { "refused" }
        );
        writeln!(std::io::stderr(), "{row}").expect("stderr is open");
        if full.ok() && !happens(&full, simulated) {
            wrong.push(format!("passed under full dynamics: {row}"));
        }
        if !full.ok() && needed < SURE {
            wrong.push(format!("refused under full dynamics: {row}"));
        }
        let off = (theirs - ours).norm();
        let alike = off < 0.01 + 0.05 * ours.xy().norm() && (yaw - verdict.heading).abs().to_degrees() < 3.0;
        if !alike && needed < RESERVE && !UNLIKE.contains(&(*robot, *behavior)) {
            wrong.push(row);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
