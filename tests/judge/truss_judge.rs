//! The judge on plans of trusses: hand-made ones whose faults are known, at and between their keyframes.

use crate::desk::cli::Sandbox;
use crate::plans::plan_operations::plan_of;
use crate::support::programs::*;
use crate::support::robots::{chain, reel};
use modl::plan::{
    Body, CauseId, CheckKind, Ground, Interpolation, Keyframe, LengthSum, Margins, NodePaths, Plan, Ramps,
    TrussLimits, Verdict, World, WorldFrom, verify,
};
use modl::robot::Library;
use std::fs;
use std::sync::Arc;

type Place = [f64; 3];

const A: Place = [0.0, 0.0, 0.0];
const B: Place = [1.0, 0.0, 0.0];
/// Root of three quarters.
const HIGH: f64 = 0.866_025_403_784_438_6;
const C: Place = [0.5, HIGH, 0.0];
const TOP: Place = [0.5, HIGH / 3.0, 0.8];

const FREE: World = World::FREE;
const STANDING: World = World { gravity: 9.80665, ground: Ground::Settle, ..World::FREE };

pub fn keyframe(time: f64, interpolation: Interpolation, nodes: &[Place]) -> Keyframe {
    let (nodes, cause, margins) = (nodes.to_vec(), CauseId(0), Margins::default());
    Keyframe { time, interpolation, ramps: Ramps::NONE, nodes, cause, margins }
}

pub fn straight(time: f64, nodes: &[Place]) -> Keyframe {
    keyframe(time, Interpolation::Linear, nodes)
}

pub fn plan_in(world: World, struts: &[(usize, usize)], keyframes: Vec<Keyframe>) -> Plan {
    let names = (0..keyframes[0].nodes.len()).map(|i| format!("n{i}")).collect();
    let paths = NodePaths {
        strut: 0,
        node_names: names,
        struts: struts.to_vec(),
        merged: Vec::new(),
        keyframes,
        events: Vec::new(),
        limits: TrussLimits::default(),
        surroundings: modl::plan::Surroundings::default(),
    };
    let plan = plan_of(plan(chain(1), wait(1.0)).expect("it can be scheduled"));
    Plan {
        library: Arc::new(Library { struts: vec![reel()], ..Library::default() }),
        body: Body::NodePaths(paths),
        program: None,
        worlds: vec![WorldFrom { from: 0.0, world }],
        ..plan
    }
}

/// A tetrahedron on the ground whose keyframes are as given.
fn tetra(world: World, keyframes: Vec<Keyframe>) -> Verdict {
    verify::verify(&plan_in(world, &[(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)], keyframes))
}

/// The same plan with limits beside those of its struts.
fn limited(limits: TrussLimits, keyframes: Vec<Keyframe>) -> Verdict {
    let mut plan = plan_in(FREE, &[(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)], keyframes);
    let Body::NodePaths(paths) = &mut plan.body else { unreachable!("it is a truss") };
    paths.limits = limits;
    verify::verify(&plan)
}

/// A plan of one keyframe is that of a truss that only is there: it is judged as it is, from the start.
#[test]
fn a_truss_that_only_stands_is_judged_where_it_stands() {
    let first = |verdict: &Verdict| verdict.failures.first().map(|failure| (failure.kind, failure.time));
    assert_eq!(first(&tetra(STANDING, vec![straight(0.0, &[A, B, C, TOP])])), None);
    // A strut of 3.2 m, where 3 m is the longest; and a top that is beyond all feet.
    let far = [0.5, HIGH / 3.0, 3.2];
    assert_eq!(first(&tetra(FREE, vec![straight(0.0, &[A, B, C, far])])), Some((CheckKind::JointRange, 0.0)));
    let aside = || vec![straight(0.0, &[A, B, C, [2.5, HIGH / 3.0, 0.8]])];
    assert_eq!(first(&tetra(STANDING, aside())), Some((CheckKind::Stability, 0.0)));
    // Without weight it doesn't topple.
    assert_eq!(first(&tetra(World { gravity: 0.0, ..STANDING }, aside())), None);
}

#[test]
fn angles_sums_and_rigidity_are_judged_where_a_plan_keeps_them() {
    let sunk = [0.5, HIGH / 3.0, 0.3];
    let keyframes = || vec![straight(0.0, &[A, B, C, TOP]), straight(100.0, &[A, B, C, sunk])];
    // From a corner of the ground to the top it goes up by 0.3 over a circumradius of 1 / root 3.
    let slope = libm::atan2(0.3, 1.0 / libm::sqrt(3.0));
    // The angle with the side, half of 60 degrees off in the plane.
    let least = libm::acos(libm::cos(slope) * libm::cos(std::f64::consts::FRAC_PI_6));
    let angle = |angle: f64| limited(TrussLimits { angle, ..TrussLimits::default() }, keyframes());
    assert_eq!(kinds(&angle(least + 1e-6)), [CheckKind::JointRange]);
    let kept = angle(least - 1e-6);
    assert_eq!(kept.failures, vec![]);
    assert!((kept.angle.expect("told").value - least).abs() < 1e-9);

    // A node that passes by another: their distance dips between the keyframes.
    let aside = |y: f64| [0.5, HIGH / 3.0, y];
    let swing = vec![straight(0.0, &[A, B, C, aside(0.8)]), straight(100.0, &[A, B, C, aside(-0.8)])];
    let whole = 3.0 * libm::sqrt(0.64 + 1.0 / 3.0);
    let sum = |low: f64| {
        let sums = vec![LengthSum { struts: vec![2, 4, 5], range: (low, whole + 1e-6) }];
        limited(TrussLimits { sums, ..TrussLimits::default() }, swing.clone())
    };
    let flat = 3.0 / libm::sqrt(3.0);
    assert_eq!(sum(flat - 1e-6).failures.iter().filter(|f| f.at.len() == 3).count(), 0);
    let short = sum(flat + 1e-3);
    assert!(short.failures.iter().any(|f| f.kind == CheckKind::JointRange && f.at.len() == 3));

    // A flat tetrahedron has a motion that changes no length to first order.
    let flattened = vec![straight(0.0, &[A, B, C, TOP]), straight(100.0, &[A, B, C, aside(0.0)])];
    let rigid = limited(TrussLimits { rigidity: 0.1, ..TrussLimits::default() }, flattened);
    assert!(rigid.failures.iter().any(|f| f.message.contains("rigidity")), "{:?}", rigid.failures);
    assert!(rigid.rigidity.expect("told").value < 1e-6);
}

/// The top goes through the plane of its feet after two thirds of the way, where nothing holds it: at both ends and in the
/// middle it is far from that.
#[test]
fn rigidity_that_is_lost_between_the_samples_is_found() {
    let way = |last: f64| {
        let keyframes = vec![
            straight(0.0, &[A, B, C, [0.5, HIGH / 3.0, 0.8]]),
            straight(100.0, &[A, B, C, [0.5, HIGH / 3.0, last]]),
        ];
        limited(TrussLimits { rigidity: 0.05, ..TrussLimits::default() }, keyframes)
    };
    assert_eq!(way(0.2).failures, vec![]);
    let through = way(-0.4);
    let [failure] = &through.failures[..] else { panic!("one failure: {:?}", through.failures) };
    assert_eq!((failure.kind, failure.limit), (CheckKind::Rigidity, 0.025));
    // Half of the way it still has half of its height, and at two thirds none.
    assert!((60.0..72.0).contains(&failure.time), "{}", failure.time);
    assert!(failure.value < 0.025);
}

fn kinds(verdict: &Verdict) -> Vec<CheckKind> {
    let mut kinds: Vec<CheckKind> = verdict.failures.iter().map(|f| f.kind).collect();
    kinds.dedup();
    kinds
}

#[test]
fn a_sound_plan_passes_on_the_ground_and_without() {
    let up = [0.5, HIGH / 3.0, 0.9];
    for world in [FREE, STANDING] {
        let verdict = tetra(world, vec![straight(0.0, &[A, B, C, TOP]), straight(10.0, &[A, B, C, up])]);
        assert_eq!(verdict.failures, vec![]);
        assert!(verdict.checks.iter().any(|c| c.kind == CheckKind::Collision));
    }
}

#[test]
fn struts_have_a_speed_and_a_range() {
    let up = [0.5, HIGH / 3.0, 0.9];
    let fast = tetra(FREE, vec![straight(0.0, &[A, B, C, TOP]), straight(0.5, &[A, B, C, up])]);
    assert_eq!(kinds(&fast), [CheckKind::Speed]);
    let far = [0.5, HIGH / 3.0, 3.1];
    let long = tetra(FREE, vec![straight(0.0, &[A, B, C, TOP]), straight(1000.0, &[A, B, C, far])]);
    assert_eq!(kinds(&long), [CheckKind::JointRange]);
    assert_eq!(long.failures.len(), 3);
    // Ends that pass each other: short between the keyframes only.
    let past =
        plan_in(FREE, &[(0, 1)], vec![straight(0.0, &[A, B]), straight(1000.0, &[A, [-1.0, 0.1, 0.0]])]);
    let past = verify::verify(&past);
    assert_eq!(kinds(&past), [CheckKind::JointRange]);
    assert!((past.failures[0].value - 0.05 / libm::sqrt(1.0 + 0.0025)).abs() < 1e-9, "{:?}", past.failures);
}

#[test]
fn struts_that_cross_between_the_knots_are_found() {
    let low = |z: f64| vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, z], [0.0, 1.0, z]];
    let crossing = |to: f64| {
        let keyframes = vec![straight(0.0, &low(1.0)), straight(100.0, &low(to))];
        verify::verify(&plan_in(FREE, &[(0, 1), (2, 3)], keyframes))
    };
    assert_eq!(kinds(&crossing(-1.0)), [CheckKind::Collision]);
    assert_eq!(kinds(&crossing(0.09)), [CheckKind::Collision]);
    let kept = crossing(0.1);
    assert_eq!(kept.failures, vec![]);
    assert!((kept.clearance.expect("told").value - 0.1).abs() < 1e-9);
}

#[test]
fn nothing_goes_into_the_ground() {
    let keyframes = vec![straight(0.0, &[A, B, C, TOP]), straight(100.0, &[A, B, [0.5, HIGH, -0.01], TOP])];
    let verdict = tetra(STANDING, keyframes.clone());
    assert!(kinds(&verdict).contains(&CheckKind::Ground), "{:?}", verdict.failures);
    assert_eq!(tetra(FREE, keyframes).failures, vec![]);
}

#[test]
fn it_falls_when_its_centre_of_mass_leaves_its_feet() {
    // The centre of mass is the mean of the four: over the edge at a top of y = -HIGH.
    let out = [0.5, -HIGH - 0.05, 0.5];
    let verdict = tetra(STANDING, vec![straight(0.0, &[A, B, C, TOP]), straight(100.0, &[A, B, C, out])]);
    assert_eq!(kinds(&verdict), [CheckKind::Stability]);
    let part = (HIGH / 3.0 + HIGH) / (HIGH / 3.0 + HIGH + 0.05);
    assert!((verdict.failures[0].time - 100.0 * part).abs() < 0.1, "{:?}", verdict.failures);
}

#[test]
fn feet_that_slide_are_told() {
    let aside = [1.25, 0.0, 0.0];
    let verdict = tetra(STANDING, vec![straight(0.0, &[A, B, C, TOP]), straight(100.0, &[A, aside, C, TOP])]);
    assert_eq!(verdict.failures, vec![]);
    assert!((verdict.slip.expect("told").value - 0.25).abs() < 1e-12);
}

/// Over the edge from A to B, with the centre of mass right above it.
fn rolling(angle: f64, told: f64, top: Place, world: World) -> Verdict {
    let (s, c) = libm::sincos(angle);
    let turned = |[x, y, z]: Place| [x, c * y - s * z, s * y + c * z];
    let before = [A, B, C, top];
    let after = before.map(turned);
    tetra(
        world,
        vec![
            straight(0.0, &[A, B, C, TOP]),
            straight(100.0, &before),
            keyframe(101.0, Interpolation::RigidRoll { edge: (0, 1), angle: told }, &after),
        ],
    )
}

#[test]
fn it_rolls_over_an_edge_once_its_centre_of_mass_is_there() {
    let top = [0.5, -HIGH, 0.5];
    let angle = libm::atan2(0.5, HIGH);
    let verdict = rolling(angle, angle, top, STANDING);
    assert_eq!(verdict.failures, vec![]);
    assert_eq!(verdict.events.len(), 1);
    // Farther, and the top is in the ground.
    assert_eq!(kinds(&rolling(angle + 0.1, angle + 0.1, top, STANDING)), [CheckKind::Ground]);
    // Elsewhere than it says.
    assert_eq!(kinds(&rolling(angle, angle - 0.1, top, STANDING)), [CheckKind::Stability]);
    // Backwards, through the ground.
    assert!(kinds(&rolling(-angle, -angle, top, STANDING)).contains(&CheckKind::Ground));
    // Too early.
    let early = [0.5, -HIGH + 0.1, 0.5];
    let angle = libm::atan2(0.5, HIGH - 0.1);
    assert_eq!(kinds(&rolling(angle, angle, early, STANDING)), [CheckKind::Stability]);
    // Nothing pulls it over.
    assert_eq!(kinds(&rolling(angle, angle, top, FREE)), [CheckKind::Ground]);
}

/// What the planners make passes; each change of it is found.
#[test]
fn plans_of_the_planners_pass_and_changed_ones_fail() {
    let sandbox = Sandbox::new(&[("truss.mod", include_bytes!("../../examples/truss.mod"))]);
    let ran = sandbox.run(&["run", "truss.mod"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    for name in ["cube", "walk"] {
        let text = fs::read_to_string(sandbox.path(&format!("out/{name}.plan.json"))).expect("written");
        let plan = modl::plan::file::read(&text).expect("a plan");
        assert_eq!(verify::verify(&plan).failures, vec![], "{name}");
        let changed = |change: &dyn Fn(&mut NodePaths)| {
            let mut plan = plan.clone();
            let Body::NodePaths(paths) = &mut plan.body else { unreachable!("a truss's plan") };
            change(paths);
            kinds(&verify::verify(&plan))
        };
        let faster = changed(&|paths| {
            paths.keyframes.iter_mut().for_each(|Keyframe { time, ramps, .. }| {
                (*time, ramps.up, ramps.down) = (*time / 1.01, ramps.up / 1.01, ramps.down / 1.01);
            });
        });
        assert!(faster.contains(&CheckKind::Speed), "{name}: {faster:?}");
        let sunk = changed(&|paths| {
            paths.keyframes.iter_mut().flat_map(|keyframe| &mut keyframe.nodes).for_each(|p| p[2] -= 1e-6);
        });
        assert_eq!(sunk.contains(&CheckKind::Ground), name == "walk", "{name}: {sunk:?}");
        let crossed = changed(&|paths| {
            let last = paths.keyframes.len() - 1;
            let middle = paths.struts[40];
            let (a, b) = (paths.keyframes[last].nodes[middle.0], paths.keyframes[last].nodes[middle.1]);
            let far = (0..paths.node_names.len()).find(|n| *n != middle.0 && *n != middle.1).expect("more");
            paths.keyframes[last].nodes[far] = std::array::from_fn(|k| (a[k] + b[k]) / 2.0);
        });
        assert!(crossed.contains(&CheckKind::Collision), "{name}: {crossed:?}");
        let without = changed(&|paths| {
            paths.keyframes.retain(|keyframe| keyframe.interpolation == Interpolation::Linear)
        });
        assert_eq!(without.is_empty(), name == "cube", "{name}: {without:?}");
    }
}
