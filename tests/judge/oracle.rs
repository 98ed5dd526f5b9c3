//! The judge beside an independent collision library (coal, from PyPI): random robots of boxes, cylinders, spheres,
//! capsules and hulls, with joints, hinges and rigid bonds, in random motion. Skipped, with a message, where Python
//! or the library is missing.

use crate::robots::urdf;
use crate::support::motions::Motion;
use crate::support::numbers::Numbers;
use crate::support::properties::whole;
use crate::support::robots::{self, Design, face};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Pose, Shape, Solid, Vec3};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Ground, Plan, Verdict, World, file};
use modl::robot::{
    Assembly, Capture, Connector, Hinge, Joint, JointKind, Library, Limits, Link, ModuleType, Port,
};
use serde_json::json;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Arc;

/// Behaviours in the gate, and in `.ci/full oracles`.
const FEW: u32 = 8;
const MANY: u32 = 1000;

/// The clearance is stated to this, m: the judge's own tolerance, and rounding of the other library.
const TOL_CLEARANCE: f64 = 2.1e-5;

/// Two libraries measure one pair at one instant alike, m.
const TOL_DISTANCE: f64 = 2e-6;

/// Penetrations that are this near to what is allowed may be judged either way, m: the other library's precision with round
/// bodies.
const TOL_DEPTH: f64 = 5e-6;

/// Plans handed to one run of the script.
const BATCH: usize = 20;

const RIGID: usize = 0;
const GUIDED: usize = 1;
const HINGED: usize = 2;

/// A convex shape of 15 to 70 mm.
fn shape(n: &mut Numbers) -> Shape {
    let (radius, length, axis) = (n.between(0.008, 0.03), n.between(0.015, 0.06), n.direction());
    match n.below(5) {
        0 => Shape::Box { size: Vec3::repeat(0.015) + (n.vector() + Vec3::repeat(1.0)) * 0.025 },
        1 => Shape::Cylinder { radius, length, axis },
        2 => Shape::Sphere { radius },
        3 => Shape::Capsule { radius, length, axis },
        _ => Shape::Hull { points: (0..8).map(|_| n.direction() * n.between(0.015, 0.035)).collect() },
    }
}

/// One convex shape, or two.
fn link(n: &mut Numbers, name: String, pose: Pose) -> Link {
    let mut shapes = vec![Placed { pose: n.rotation(), shape: shape(n) }];
    if n.below(3) == 0 {
        shapes.push(Placed { pose: shifted(n.direction() * 0.02) * n.rotation(), shape: shape(n) });
    }
    // The link's origin may be outside of a random hull, where no mass can be.
    let (low, high) = Solid::new(&shapes).expect("the shapes are sound").bounds;
    let mass = robots::link(&name, shapes, 0.1, (low + high) / 2.0, 0.5);
    Link { pose, ..mass }
}

fn joint(n: &mut Numbers, index: usize, parent: usize, child: usize, between: Vec3) -> Joint {
    let (kind, range) = match n.below(4) {
        0 => (JointKind::Prismatic, Some((-0.1, 0.1))),
        1 if index > 0 => (JointKind::Fixed, None),
        _ => (JointKind::Revolute, None),
    };
    let limits = Limits { range, ..Limits::default() };
    robots::joint(&format!("j{index}"), (parent, child), kind, shifted(between), n.direction(), limits)
}

/// A place where the module reaches farthest in some direction, most often a little above the surface and sometimes beneath.
fn port(n: &mut Numbers, index: usize, links: &[Link]) -> Port {
    let outward = n.direction();
    let surface = |link: &Link| {
        let solid = Solid::new(&link.collides).expect("the shapes are sound");
        let own = link.pose.rotation.inverse() * outward;
        let points = solid.parts.iter().map(|part| part.support(&own));
        points.max_by(|p, q| p.dot(&own).total_cmp(&q.dot(&own))).expect("a link has a shape")
    };
    let reach = |link: &Link| link.pose.transform_point(&surface(link).into()).coords.dot(&outward);
    let farthest = (0..links.len()).max_by(|a, b| reach(&links[*a]).total_cmp(&reach(&links[*b])));
    let link = farthest.expect("a module has a link");
    let above = match n.below(40) {
        0 => -0.02,
        1..=4 => n.between(-2e-3, 0.0),
        _ => n.between(0.0, 2e-3),
    };
    let own = links[link].pose.rotation.inverse() * outward;
    let toward = nalgebra::UnitQuaternion::rotation_between(&Vec3::x(), &own).unwrap_or_default();
    let place = surface(&links[link]) + own * above;
    let pose = Pose::from_parts(place.into(), toward) * turned(Vec3::x(), n.between(-3.0, 3.0));
    let connector = [RIGID, GUIDED, HINGED, HINGED][n.below(4)];
    Port { name: format!("p{index}"), link, pose, connector }
}

fn module(n: &mut Numbers, name: &str) -> ModuleType {
    let mut links = vec![link(n, "l0".into(), Pose::identity())];
    let mut joints = vec![];
    for child in 1..1 + n.below(3) {
        let parent = n.below(child);
        let from = links[parent].pose.translation.vector;
        let at = from + n.direction() * n.between(0.05, 0.11);
        let between = (from + at) / 2.0;
        let pose = shifted(at) * n.rotation();
        links.push(link(n, format!("l{child}"), pose));
        joints.push(joint(n, child - 1, parent, child, between));
    }
    let ports = (0..6).map(|index| port(n, index, &links)).collect();
    ModuleType {
        name: name.into(),
        links,
        joints,
        ports,
        motors: vec![],
        touching: vec![],
        touch: 1e-4,
        contact: 1e-3,
    }
}

fn connectors() -> Vec<Connector> {
    let connector = |name: &str, mates: usize, capture, hinge: Option<Hinge>| Connector {
        name: name.into(),
        mates: vec![mates],
        turns: 4,
        capture,
        hinge,
        ..face()
    };
    let hinge = Hinge { axis: Vec3::y(), limits: Limits::default() };
    let capture = Capture::at_rest(4e-3, 0.05);
    vec![
        connector("Rigid", RIGID, None, None),
        connector("Guided", GUIDED, Some(capture), None),
        Connector { turns: 1, ..connector("Hinged", HINGED, None, Some(hinge)) },
    ]
}

/// A tree of modules; ports are used once.
fn robot(n: &mut Numbers) -> Assembly {
    let kinds = ["A", "B", "C"].map(|name| module(n, name));
    let library = Library { connectors: connectors(), modules: kinds.to_vec(), ..Library::default() };
    let mut design = Design::new("Random", Arc::new(library));
    let mut free: Vec<(usize, usize)> = vec![];
    for _ in 0..2 + n.below(4) {
        let kind = n.below(kinds.len());
        let index = design.0.modules.len();
        let connector =
            |design: &Design, at: (usize, usize)| design.0.module_type(at.0).ports[at.1].connector;
        let own: Vec<(usize, usize)> = (0..6).map(|port| (index, port)).collect();
        design.0.modules.push(modl::robot::ModuleInstance { name: format!("m{index}"), kind });
        if index > 0 {
            let mates =
                |a: &&(usize, usize), b: (usize, usize)| connector(&design, **a) == connector(&design, b);
            let pairs: Vec<_> = free
                .iter()
                .flat_map(|a| own.iter().filter(|b| mates(b, *a)).map(move |b| (*a, *b)))
                .collect();
            if pairs.is_empty() {
                design.0.modules.pop();
                continue;
            }
            let (a, b) = pairs[n.below(pairs.len())];
            let turns = if connector(&design, a) == HINGED { 1 } else { 4 };
            let turn = n.below(turns) as u32;
            design.connect(a, b, turn);
            free.retain(|port| *port != a);
            free.extend(own.iter().filter(|port| **port != b));
        } else {
            free.extend(own);
        }
    }
    design.0
}

/// Motions of most joints, of degree 1 to 5, in one to three pieces, some with pauses and jumps of speed.
pub fn plan(seed: u64) -> Plan {
    let mut n = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut motion = Motion::new(robot(&mut n));
    let wide = n.between(0.05, 0.8);
    let owners: Vec<_> = motion.tracks.robot.joints().collect();
    for (joint, owner) in owners.into_iter().enumerate() {
        let kind = match owner {
            modl::robot::JointOwner::Module { module, joint } => {
                motion.tracks.robot.module_type(module).joints[joint].kind
            }
            modl::robot::JointOwner::Bond(_) => JointKind::Revolute,
        };
        let reach = match kind {
            JointKind::Fixed => continue,
            JointKind::Prismatic => wide * 0.02,
            JointKind::Revolute => wide,
        };
        if n.below(4) == 0 {
            continue;
        }
        let (mut t, mut q) = (n.between(0.0, 0.3), n.between(-reach, reach) / 4.0);
        motion.tracks.start.joints[joint] = q;
        for _ in 0..1 + n.below(3) {
            let end = t + n.between(0.1, 1.0);
            let mut control = vec![q];
            control.extend((0..1 + n.below(5)).map(|_| n.between(-reach, reach)));
            q = control[control.len() - 1];
            motion = motion.segment(joint, t, end, control);
            t = end + if n.below(3) == 0 { n.between(0.0, 0.2) } else { 0.0 };
        }
    }
    motion.tracks.duration = motion.tracks.duration.max(0.1);
    motion.plan(World { ground: Ground::Off, gravity: 0.0, ..World::default() })
}

/// The other library's findings: its least distance, the greatest depth beyond what is allowed, and the distance of the
/// pair that the judge names at the time that it names.
#[derive(serde::Deserialize, Debug)]
struct Answer {
    clearance: Option<f64>,
    when: f64,
    excess: f64,
    at: f64,
    told: Option<f64>,
}

fn task(plan: &Plan, verdict: &Verdict) -> serde_json::Value {
    let text = file::write(plan).expect("the plan can be written");
    let written: serde_json::Value = serde_json::from_str(&text).expect("a plan file is JSON");
    let module = |name: &String| name[1..].parse::<usize>().expect("modules are numbered");
    let modules = verdict.clearance.as_ref().map(|worst| match &worst.at[..] {
        [one] => [module(one); 2],
        names => [module(&names[0]), module(&names[1])],
    });
    json!({ "plan": written, "time": verdict.clearance.as_ref().map(|worst| worst.time), "modules": modules })
}

/// Compares one verdict with what sampling found; returns what differs.
fn compare(seed: u64, verdict: &Verdict, answer: &Answer) -> Vec<String> {
    let mut found = vec![];
    let failed = verdict.failures.iter().any(|failure| failure.kind == CheckKind::Collision);
    if !failed && answer.excess > TOL_DEPTH {
        found
            .push(format!("seed {seed}: missed {} m too deep at {} s: {answer:?}", answer.excess, answer.at));
    }
    if failed && answer.excess < -TOL_DEPTH {
        found.push(format!("seed {seed}: no collision for {answer:?}: {:?}", verdict.failures[0]));
    }
    if let (Some(worst), Some(told)) = (&verdict.clearance, answer.told)
        && (worst.value - told).abs() > TOL_DISTANCE
        && (worst.value > 0.0 || !failed)
    {
        found.push(format!("seed {seed}: {worst:?} is {told} m"));
    }
    match (&verdict.clearance, answer.clearance) {
        (Some(worst), Some(least))
            if (!failed || least > 0.0) && (worst.value - least).abs() > TOL_CLEARANCE =>
        {
            found.push(format!("seed {seed}: {worst:?}, but {least} m at {} s", answer.when));
        }
        (None, Some(least)) => found.push(format!("seed {seed}: no clearance, but {least} m")),
        _ => {}
    }
    found
}

/// A Python that has coal, as [`urdf::python`] finds one that has pinocchio.
fn python() -> Option<PathBuf> {
    let python = urdf::python()?;
    let found = Command::new(&python).args(["-c", "import coal"]).stderr(Stdio::null()).status();
    found.is_ok_and(|status| status.success()).then_some(python)
}

#[test]
fn an_independent_library_finds_the_same_collisions_and_clearances() {
    let say = |words: String| writeln!(std::io::stderr(), "{words}").expect("stderr is open");
    let Some(python) = python() else {
        return say(
            "skipped: collisions against another library: no Python with coal (.ci/run installs it)".into()
        );
    };
    let count = if whole() { MANY } else { FEW };
    let seeds: Vec<u64> = (0..u64::from(count)).collect();
    let (mut differences, mut failed, mut measured) = (vec![], 0, 0);
    for batch in seeds.chunks(BATCH) {
        let plans: Vec<Plan> = batch.iter().map(|seed| plan(*seed)).collect();
        let verdicts: Vec<Verdict> = plans.iter().map(verify).collect();
        let form = verdicts.iter().flat_map(|v| &v.failures).find(|f| f.kind == CheckKind::Form);
        assert!(form.is_none(), "a random plan is not well formed: {form:?}");
        let tasks: Vec<_> = plans.iter().zip(&verdicts).map(|(plan, verdict)| task(plan, verdict)).collect();
        let told = urdf::run(&python, include_str!("collision_oracle.py"), &json!(tasks));
        let answers: Vec<Answer> = serde_json::from_value(told).expect("the script answers so");
        for ((seed, verdict), answer) in batch.iter().zip(&verdicts).zip(&answers) {
            failed += u32::from(verdict.failures.iter().any(|f| f.kind == CheckKind::Collision));
            measured += u32::from(verdict.clearance.is_some());
            differences.extend(compare(*seed, verdict, answer));
        }
    }
    say(format!(
        "{count} random behaviours beside coal: {failed} with collisions, {measured} with a clearance"
    ));
    assert!(differences.is_empty(), "{} differ:\n{}", differences.len(), differences.join("\n"));
    assert!(failed > 0 && failed < count && measured > count / 2, "the random behaviours are one-sided");
}
