//! Plans reversed, cut and joined; programs told from tracks; random programs through all of it.

use crate::judge::truss_judge::keyframe;
use crate::support::programs::*;
use crate::support::robots::{FRONT, LEFT, TILT, at_rest, chain, walk4};
use modl::behavior::Scheduled;
use modl::plan::{
    Body, Cause, CauseId, CellLimits, Change, Command, Compare, Counter, DockingKind, Interpolation, Law,
    Model, Node, NodePaths, OperationError, Plan, Program, Provenance, Ratio, Run, Settings, Snapshot, Stage,
    Stages, Tracks, TrussLimits, World, WorldFrom, joined, reversed, sliced, timeline,
};
use modl::robot::{Assembly, JointId, Mismatch, PortRef, State};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

const L: u32 = LEFT as u32;
const F: u32 = FRONT as u32;
const T: u32 = TILT as u32;

pub fn plan_of(scheduled: Scheduled) -> Plan {
    let cause = |i: usize| Cause {
        file: "test.mod".into(),
        line: i + 1,
        column: 1,
        text: "move(...)".into(),
        instance: String::new(),
        caller: None,
    };
    Plan {
        provenance: Provenance {
            planner: "behavior".into(),
            tool: "modl test".into(),
            ..Provenance::default()
        },
        worlds: vec![WorldFrom { from: 0.0, world: World::default() }],
        settings: Settings::default(),
        library: scheduled.tracks.robot.library.clone(),
        body: Body::Tracks(scheduled.tracks),
        program: Some(scheduled.program),
        nominal: scheduled.nominal,
        causes: (0..1000).map(cause).collect(),
        exemptions: scheduled.exemptions,
        paths: vec![],
        verdict: None,
    }
}

fn planned(robot: Assembly, program: Arc<Node>) -> Plan {
    plan_of(plan(robot, program).expect("the program can be scheduled"))
}

fn tracks(plan: &Plan) -> &Tracks {
    plan.body.tracks().expect("it is a plan of tracks")
}

/// What must hold of every scheduled plan.
fn check_tracks(tracks: &Tracks) {
    for pair in tracks.tracks.windows(2) {
        assert!(pair[0].joint < pair[1].joint);
    }
    for track in &tracks.tracks {
        let mut at = tracks.start.joints[track.joint.0 as usize];
        let mut now = 0.0;
        for segment in &track.segments {
            assert!(now <= segment.start && segment.start < segment.end && segment.end <= tracks.duration);
            assert_eq!(segment.control[0], at, "the joint jumps at {}", segment.start);
            assert!(segment.control.iter().all(|c| c.is_finite()));
            (at, now) = (segment.last(), segment.end);
        }
    }
}

/// Programs of one module in three joints, conflicts and all: what may come from a user.
fn programs() -> impl Strategy<Value = Arc<Node>> {
    let number = || (-8..9_i32).prop_map(|n| f64::from(n) / 4.0);
    let duration = || (1..9_i32).prop_map(|n| f64::from(n) / 3.0);
    let leaf = (0..8_u32, number(), duration(), 0..100_u32, 0..3_usize).prop_map(|(kind, x, d, cause, j)| {
        let joint = [L, F, T][j];
        match kind {
            0 => wait(d),
            1 => spin_for(joint, x, d, cause),
            2 => go(joint, x, cause),
            3 => by(joint, x, cause),
            4 => act(moving(joint, modl::plan::Target::To(x), None, modl::plan::Profile::Trapezoid), cause),
            5 => go_in(joint, x, d, cause),
            6 => {
                let seen =
                    until(spinning(joint, x, Some(d)), angle([F, T, L][j], Compare::Greater, x / 2.0), cause);
                node(modl::plan::Action { timeout: Some(d), ..seen })
            }
            _ => series(vec![spin(joint, x, cause), wait(d), by(joint, 0.5, cause)]),
        }
    });
    leaf.prop_recursive(4, 24, 4, |inner| {
        let list = proptest::collection::vec(inner.clone(), 0..4);
        let cyclic = (inner, 0..5_u32, 0..4_u32).prop_map(|(body, shift, kind)| {
            let (shift, cause) = (f64::from(shift) / 4.0, CauseId(9));
            match kind {
                0 => repeat(body, 2),
                1 => Arc::new(Node::Phase { body, shift, cause }),
                2 => Arc::new(Node::Approach { body, shift, cause }),
                _ => Arc::new(Node::Stretch { body, duration: 4.0 * shift + 1.0, cause }),
            }
        });
        prop_oneof![
            (list, any::<bool>()).prop_map(|(list, beside)| if beside {
                parallel(list)
            } else {
                series(list)
            }),
            cyclic,
        ]
    })
}

proptest! {
    #![proptest_config(crate::support::properties::cases(400))]

    #[test]
    fn random_programs_give_sound_tracks_or_a_refusal(program in programs(), cut in 0.0..1.0) {
        let Ok(scheduled) = plan(chain(1), program) else { return Ok(()) };
        check_tracks(&scheduled.tracks);
        let plan = plan_of(scheduled);
        let whole = tracks(&plan);

        let back = reversed(&plan);
        check_tracks(tracks(&back));
        // A robot that has tipped begins as it lies, and need not roll back to where it was drawn.
        let mut forth = tracks(&reversed(&back)).clone();
        forth.start.base = whole.start.base;
        prop_assert_eq!(&forth, whole);
        for i in 0..=10 {
            let t = whole.duration * f64::from(i) / 10.0;
            let (a, b) = (whole.state(t).joints, tracks(&back).state(whole.duration - t).joints);
            prop_assert!(a.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-9), "at {}", t);
        }

        let cut = whole.duration * cut;
        let (first, second) = (sliced(&plan, 0.0, cut), sliced(&plan, cut, whole.duration));
        let (first, second) = (first.expect("a part"), second.expect("a part"));
        check_tracks(tracks(&first));
        check_tracks(tracks(&second));
        let again = joined(&first, &second).expect("the parts fit together");
        check_tracks(tracks(&again));
        prop_assert_eq!(tracks(&again).duration, whole.duration);
        for i in 0..=20 {
            let t = whole.duration * f64::from(i) / 20.0;
            let (a, b) = (whole.state(t).joints, tracks(&again).state(t).joints);
            prop_assert!(a.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-9), "at {}", t);
        }

        // Bounds hold, and what tracks say can be said as a program.
        for track in &whole.tracks {
            let (low, high) = whole.bounds(track.joint, cut / 2.0, cut);
            for i in 0..=10 {
                let at = whole.state(cut / 2.0 + cut / 2.0 * f64::from(i) / 10.0).joints[track.joint.0 as usize];
                prop_assert!(low - 1e-12 <= at && at <= high + 1e-12);
            }
        }
        if let Ok(root) = timeline(whole) {
            let told = plan_from_start(whole, root);
            prop_assert_eq!(told.duration, whole.duration);
            for i in 0..=10 {
                let t = whole.duration * f64::from(i) / 10.0;
                let (a, b) = (whole.state(t).joints, told.state(t).joints);
                prop_assert!(a.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-9), "at {}", t);
            }
        }
    }
}

fn plan_from_start(whole: &Tracks, root: Arc<Node>) -> Tracks {
    plan_from(whole.robot.clone(), whole.start.clone(), root).expect("what was done can be told").tracks
}

#[test]
fn what_is_reversed_keeps_an_executable_program() {
    let plan = planned(chain(2), series(vec![go(T, 1.0, 0), go(4 + T, -0.5, 1)]));
    let back = reversed(&plan);
    let program = back.program.as_ref().expect("smooth moves run backwards as smooth moves");
    assert_eq!(plan_from_start(tracks(&back), program.root.clone()).tracks, tracks(&back).tracks);
    assert_eq!(back.provenance.history, [Change::Reversed]);
    // A move cut in two is no command any more.
    let half = sliced(&plan, 0.0, 0.5).expect("a part");
    assert!(half.program.is_none());
    assert!(matches!(half.provenance.history[..], [Change::Sliced { .. }, Change::ProgramDropped(_)]));
}

#[test]
fn docking_runs_backwards_as_undocking() {
    let port = |module, port| PortRef { module, port };
    let undock = act(Command::Undock { port: port(1, 2) }, 3);
    let dock = act(Command::Dock { a: port(0, 3), b: port(1, 2) }, 4);
    let plan = planned(chain(2), series(vec![wait(1.0), undock, wait(0.5)]));
    let back = reversed(&plan);
    assert_eq!(tracks(&back).events[0].kind, DockingKind::Dock);
    assert_eq!(tracks(&back).events[0].time, 0.5);
    assert_eq!(tracks(&back).start.bonds, [false]);
    assert_eq!(tracks(&back).end().bonds, [true]);
    // Backwards it begins as two robots where the judge left them, so that twice reversed it begins where it settled.
    assert_eq!(tracks(&back).start.clusters.len(), 1);
    let again = reversed(&back);
    let settled = tracks(&again).start.base;
    // The modules settled by some millimetres when they came apart, and dock backwards with that error.
    let [error] = tracks(&again).start.misalignments.as_slice() else { panic!("{:?}", tracks(&again).start) };
    let apart = error.pose.translation.vector.norm();
    assert!(error.bond == 0 && (0.001..0.02).contains(&apart), "{apart}");
    let start =
        State { base: tracks(&plan).start.base, misalignments: vec![], ..tracks(&again).start.clone() };
    assert_eq!(Tracks { start, ..tracks(&again).clone() }, *tracks(&plan));
    let height = settled.translation.z;
    assert!((0.03..0.06).contains(&height), "a module of 80 to 90 mm stands on its wheels: {height}");
    let _ = dock;
}

#[test]
fn worlds_and_exemptions_run_backwards_too() {
    let mut plan = planned(chain(1), wait(8.0));
    let floating = World { gravity: 0.0, ..World::default() };
    plan.worlds.push(WorldFrom { from: 6.0, world: floating });
    let back = reversed(&plan);
    let spans: Vec<(f64, f64)> = back.worlds.iter().map(|w| (w.from, w.world.gravity)).collect();
    assert_eq!(spans, [(0.0, 0.0), (2.0, World::default().gravity)]);
    assert_eq!(reversed(&back).worlds, plan.worlds);
    let last = sliced(&plan, 7.0, 8.0).expect("a part");
    assert_eq!(last.worlds, [WorldFrom { from: 0.0, world: floating }]);
}

/// The same robot with its modules listed the other way round, under other names.
fn renamed(robot: &Assembly) -> Assembly {
    let mut other = robot.clone();
    let last = robot.modules.len() - 1;
    other.modules.reverse();
    for (i, module) in other.modules.iter_mut().enumerate() {
        module.name = format!("x[{i}]");
    }
    for bond in &mut other.bonds {
        (bond.a.module, bond.b.module) = (last - bond.a.module, last - bond.b.module);
    }
    other.bonds.reverse();
    other.base = last - robot.base;
    other
}

#[test]
fn plans_are_joined_under_other_names() {
    let robot = walk4();
    let n = robot.modules.len() as u32;
    let p = planned(robot.clone(), parallel(vec![go(T, 0.5, 0), go(4 * 3 + T, -0.25, 1)]));
    let other = renamed(&robot);
    let mut start = at_rest(&other);
    // A wheel stands a whole number of turns from where the first plan leaves it.
    start.joints[(4 * (n - 1) + T) as usize] = 0.5;
    start.joints[(4 * (n - 1 - 3) + T) as usize] = -0.25;
    start.joints[(4 * (n - 1) + L) as usize] = 2.0 * TAU;
    let program = parallel(vec![go(4 * (n - 1) + T, 0.0, 0), go(4 * (n - 1) + L, 2.0 * TAU + 1.0, 1)]);
    let q = plan_of(plan_from(other, start, program).expect("it can be scheduled"));
    let all = joined(&p, &q).expect("they fit");
    check_tracks(tracks(&all));
    let end = tracks(&all).end();
    assert!(end.joints[T as usize].abs() < 1e-12);
    assert!((end.joints[(12 + T) as usize] + 0.25).abs() < 1e-12);
    assert!((end.joints[L as usize] - 1.0).abs() < 1e-12);
    let Some(Change::Joined { at, renamed, .. }) = all.provenance.history.last() else {
        panic!("it was joined")
    };
    assert_eq!(*at, tracks(&p).duration);
    assert!(renamed.contains(&(format!("x[{}]", n - 1), "b0".into())), "{renamed:?}");
    // The program of both does the same.
    let root = all.program.clone().expect("both have one").root;
    let told = plan_from_start(tracks(&all), root);
    assert!((told.end().joints[L as usize] - 1.0).abs() < 1e-12);
}

#[test]
fn plans_that_do_not_fit_say_what_differs() {
    let p = planned(chain(3), go(T, 0.5, 0));
    let unfit = |q: &Plan| joined(&p, q).expect_err("they do not fit");
    assert_eq!(unfit(&planned(chain(2), wait(1.0))), OperationError::Robots(Mismatch::Count { a: 3, b: 2 }));
    let OperationError::Robots(Mismatch::Joint { a, b, a_position, b_position }) =
        unfit(&planned(chain(3), wait(1.0)))
    else {
        panic!("a joint differs")
    };
    assert_eq!((a.as_str(), b.as_str(), a_position, b_position), ("m0.tilt", "m0.tilt", 0.5, 0.0));
    let mut bent = chain(3);
    bent.bonds[1].turn = 1;
    let mut start = at_rest(&bent);
    start.joints[T as usize] = 0.5;
    let q = plan_of(plan_from(bent, start, wait(1.0)).expect("it can be scheduled"));
    assert!(matches!(unfit(&q), OperationError::Robots(Mismatch::Bond { .. })));
    let truss = Plan { body: Body::NodePaths(rolling()), program: None, ..p.clone() };
    assert_eq!(unfit(&truss), OperationError::Families);
}

#[test]
fn a_bond_made_by_the_second_plan_is_added() {
    let mut ring = crate::support::robots::ring12();
    ring.closed = true;
    let bend = parallel((0..12).map(|m| go(4 * m + T, PI / 6.0, m)).collect());
    let p = planned(ring.clone(), bend);
    let other = renamed(&ring);
    let mut start = at_rest(&other);
    (0..12).for_each(|m| start.joints[4 * m + TILT] = PI / 6.0);
    let port = |module, port| PortRef { module, port };
    let dock = series(vec![act(Command::Dock { a: port(11 - 11, 3), b: port(11, 2) }, 5), wait(1.0)]);
    let q = plan_of(plan_from(other, start, dock).expect("it can be scheduled"));
    let all = joined(&p, &q).expect("they fit");
    let bond = tracks(&all).robot.bonds[11];
    assert_eq!((bond.a, bond.b), (port(11, 3), port(0, 2)));
    assert_eq!(tracks(&all).start.bonds.len(), 12);
    assert!(!tracks(&all).start.bonds[11] && tracks(&all).end().bonds[11]);
    assert_eq!(tracks(&all).events[0].cause, CauseId(1005));
}

/// A row of four cells pulled together and let go, with an odd one out.
pub fn squeezing() -> Stages {
    let cells = |center: Ratio, step: Ratio, size: Ratio| Run {
        first: 0,
        counters: vec![Counter { count: 4, stride: 1, step: [step, Ratio::ZERO, Ratio::ZERO] }],
        center: [center, Ratio::ZERO, Ratio::ZERO],
        size: [size, Ratio::ONE, Ratio::ONE],
    };
    let stage = |end: Vec<Run>, law| Stage {
        name: "x-squeeze".into(),
        time_squared: Ratio(3, 1),
        law,
        end: end.into(),
        cause: CauseId(0),
    };
    let up = Run { counters: vec![], ..cells(Ratio(-3, 4), Ratio::ZERO, Ratio(1, 2)) };
    let up = Run { center: [Ratio(-3, 4), Ratio(1, 1), Ratio::ZERO], ..up };
    Stages {
        cell: 0,
        count: 4,
        time_unit: 2.0,
        limits: CellLimits { smallest: Ratio(1, 2), speed_squared: Ratio::ONE },
        model: Model::default(),
        anchor: None,
        start: vec![cells(Ratio(-3, 2), Ratio::ONE, Ratio::ONE)],
        stages: vec![
            stage(vec![cells(Ratio(-3, 4), Ratio(1, 2), Ratio(1, 2))], Law::BangBang),
            stage(vec![up], Law::Trapezoid(Ratio(1, 3))),
        ],
    }
}

#[test]
fn lattice_stages_follow_their_closed_form_and_run_backwards() {
    let stages = squeezing();
    let whole = 2.0 * libm::sqrt(3.0);
    assert!((stages.duration() - 2.0 * whole).abs() < 1e-12);
    // At half the stage half the way is done; at a quarter an eighth.
    for (part, done) in [(0.5, 0.5), (0.25, 0.125)] {
        let cells = stages.state(whole * part);
        assert!((cells[3].center[0] - (1.5 - 0.75 * done)).abs() < 1e-12);
        assert!((cells[3].size[0] - (1.0 - 0.5 * done)).abs() < 1e-12);
    }
    // A trapezoid with thirds: the first third covers a quarter.
    assert!((stages.state(whole * (1.0 + 1.0 / 3.0))[0].center[1] - 0.25).abs() < 1e-12);
    let back = stages.reversed();
    for i in 0..=12 {
        let t = 2.0 * whole * f64::from(i) / 12.0;
        for (a, b) in stages.state(t).iter().zip(back.state(2.0 * whole - t)) {
            assert!(
                (0..3)
                    .all(|k| (a.center[k] - b.center[k]).abs() < 1e-12
                        && (a.size[k] - b.size[k]).abs() < 1e-12)
            );
        }
    }
    assert_eq!(back.reversed().state(1.0), stages.state(1.0));
}

/// A triangle that stretches and then rolls over one of its edges.
pub fn rolling() -> NodePaths {
    let flat = vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.5, 0.0]];
    let long = vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.5, 0.0]];
    let over = vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, -2.0]];
    NodePaths {
        limits: TrussLimits::default(),
        surroundings: modl::plan::Surroundings::default(),
        strut: 0,
        node_names: ["a", "b", "c"].map(String::from).to_vec(),
        struts: vec![(0, 1), (1, 2), (2, 0)],
        merged: Vec::new(),
        events: Vec::new(),
        keyframes: vec![
            keyframe(0.0, Interpolation::Linear, &flat),
            keyframe(2.0, Interpolation::Linear, &long),
            keyframe(4.0, Interpolation::RigidRoll { edge: (0, 1), angle: FRAC_PI_2 }, &over),
        ],
    }
}

#[test]
fn trusses_stretch_on_straight_lines_and_roll_rigidly() {
    let paths = rolling();
    assert_eq!(paths.state(1.0)[2], [1.5, 0.5, 0.0]);
    let lengths = paths.lengths(2.0);
    for t in [2.5, 3.0, 4.0] {
        assert!(paths.lengths(t).iter().zip(&lengths).all(|(a, b)| (a - b).abs() < 1e-12), "at {t}");
    }
    let half = paths.state(3.0)[2];
    let diagonal = libm::sqrt(2.0);
    assert!((half[0] - diagonal).abs() < 1e-12 && (half[2] + diagonal).abs() < 1e-12);
    let back = paths.reversed();
    for i in 0..=8 {
        let t = f64::from(i) / 2.0;
        for (a, b) in paths.state(t).iter().zip(back.state(4.0 - t)) {
            assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-12), "at {t}");
        }
    }
    let plan = planned(chain(1), wait(1.0));
    let plan = Plan { body: Body::NodePaths(paths.clone()), program: None, ..plan };
    let (p, q) = (sliced(&plan, 0.0, 3.0).expect("a part"), sliced(&plan, 3.0, 4.0).expect("a part"));
    let all = joined(&p, &q).expect("they fit");
    let Snapshot::Nodes(nodes) = all.body.state(3.5) else { panic!("it is a truss") };
    assert!((0..3).all(|k| (nodes[2][k] - paths.state(3.5)[2][k]).abs() < 1e-12));
    assert_eq!(
        joined(&q, &p).expect_err("they do not fit"),
        OperationError::Trusses { node: Some("c".into()) }
    );
}

#[test]
fn lattice_plans_are_cut_between_stages_only() {
    let plan = planned(chain(1), wait(1.0));
    let plan = Plan { body: Body::Stages(squeezing()), program: None, ..plan };
    let border = 2.0 * libm::sqrt(3.0);
    let second = sliced(&plan, border, 2.0 * border).expect("a part");
    let Snapshot::Cells(cells) = second.body.state(0.0) else { panic!("it is a lattice") };
    assert_eq!(cells[0].center, [-0.75, 0.0, 0.0]);
    assert!(matches!(sliced(&plan, 1.0, 2.0), Err(OperationError::InsideStage { .. })));
    // A column of squeezed cells is not the row that the plan begins with.
    assert_eq!(joined(&plan, &plan), Err(OperationError::Shapes));
    let _ = (Program { root: wait(0.0) }, JointId(0));
}
