//! Conflicts and limits of commands, found without running the program.

use crate::support::programs::*;
use crate::support::robots::{FRONT, LEFT, TILT, chain};
use modl::behavior::{Conflicts, IssueKind, Part, Uncommandable, conflicts, issues};
use modl::plan::visit::Graph;
use modl::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target};
use modl::robot::{JointId, PortRef};
use proptest::prelude::*;
use std::sync::Arc;

const L: u32 = LEFT as u32;
const F: u32 = FRONT as u32;
const T: u32 = TILT as u32;

/// Causes in pairs: those in conflict, or those that say the same.
type Pairs = Vec<(u32, u32)>;

fn pairs(found: &Conflicts) -> (Pairs, Pairs) {
    let of = |list: &[modl::behavior::Conflict]| list.iter().map(|c| (c.first.0, c.second.0)).collect();
    (of(&found.errors), of(&found.warnings))
}

fn check(program: Arc<Node>, errors: &[(u32, u32)], warnings: &[(u32, u32)]) {
    assert_eq!(pairs(&conflicts(&program)), (errors.to_vec(), warnings.to_vec()));
}

#[test]
fn two_setpoints_for_one_joint_in_parallel_conflict() {
    check(parallel(vec![go(T, 0.5, 1), go(T, -0.5, 2)]), &[(1, 2)], &[]);
    check(parallel(vec![go(T, 0.5, 1), go(F, -0.5, 2)]), &[], &[]);
    check(series(vec![go(T, 0.5, 1), go(T, -0.5, 2)]), &[], &[]);
    check(parallel(vec![spin(L, 1.0, 1), go(L, 1.0, 2)]), &[(1, 2)], &[]);
}

#[test]
fn equal_setpoints_are_a_warning() {
    check(parallel(vec![go(T, 0.5, 1), go_in(T, 0.5, 3.0, 2)]), &[], &[(1, 2)]);
    check(parallel(vec![spin(L, 1.0, 1), spin(L, 1.0, 2)]), &[], &[(1, 2)]);
    check(parallel(vec![by(L, 1.0, 1), by(L, 1.0, 2)]), &[(1, 2)], &[]);
}

#[test]
fn a_setpoint_left_behind_is_still_in_force() {
    let left_behind = series(vec![wait(1.0), go(T, 0.5, 1)]);
    check(parallel(vec![left_behind.clone(), go(T, -0.5, 2)]), &[(1, 2)], &[]);
    let later = series(vec![wait(9.0), go(F, 0.1, 3), go(T, -0.5, 2)]);
    check(parallel(vec![left_behind, later]), &[(1, 2)], &[]);
}

#[test]
fn the_second_setpoint_of_a_branch_counts_as_well() {
    let there_and_back = series(vec![go(T, 0.5, 1), go(T, -0.5, 2)]);
    check(parallel(vec![there_and_back.clone(), go(T, 0.5, 3)]), &[(2, 3)], &[]);
    check(parallel(vec![there_and_back.clone(), there_and_back]), &[(1, 2)], &[]);
}

#[test]
fn branches_taken_after_a_timeout_count() {
    let base = action(Command::Wait { duration: 1.0 }, 0);
    let branch = node(Action { timeout: Some(0.5), otherwise: Otherwise::Node(go(T, 0.5, 1)), ..base });
    check(parallel(vec![branch, go(T, -0.5, 2)]), &[(1, 2)], &[]);
}

#[test]
fn bodies_of_repetitions_are_in_series_with_themselves() {
    let stroke = series(vec![go(T, 0.5, 1), go(T, -0.5, 2)]);
    check(repeat(stroke.clone(), 1_000_000_000), &[], &[]);
    check(parallel(vec![repeat(stroke, 0), go(T, 0.1, 3)]), &[], &[]);
}

#[test]
fn pairs_of_causes_are_reported_once_and_not_without_end() {
    let clash = parallel(vec![go(T, 0.5, 1), go(T, -0.5, 2)]);
    check(series(vec![clash.clone(), parallel(vec![clash.clone(), wait(1.0)]), clash]), &[(1, 2)], &[]);
    let many = (0..1000).map(|i| go(T, f64::from(i), i)).collect();
    let found = conflicts(&parallel(many));
    assert!(found.more);
    assert_eq!(found.errors.len(), modl::behavior::PAIRS_MAX);
}

/// Unordered pairs by the definition: the lowest common node is parallel. Slow and plain.
fn by_definition(node: &Arc<Node>, errors: &mut bool, warnings: &mut bool) -> Vec<(u32, Option<u64>)> {
    match &**node {
        Node::Action(Action { command: Command::Move { joint, target, .. }, .. }) => match target {
            Target::To(x) => vec![(joint.0, Some(x.to_bits()))],
            Target::By(_) => vec![(joint.0, None)],
        },
        Node::Series(list) | Node::Parallel(list) => {
            let mut all: Vec<(u32, Option<u64>)> = Vec::new();
            for child in list {
                let below = by_definition(child, errors, warnings);
                if matches!(&**node, Node::Parallel(_)) {
                    for (a, b) in all.iter().flat_map(|a| below.iter().map(move |b| (a, b))) {
                        let (joint, equal) = (a.0 == b.0, a.1.is_some() && a.1 == b.1);
                        *errors |= joint && !equal;
                        *warnings |= joint && equal;
                    }
                }
                all.extend(below);
            }
            all
        }
        _ => vec![],
    }
}

fn programs() -> impl Strategy<Value = Arc<Node>> {
    let leaf = (0..4_u32, 0..3_u32, 0..1000_u32, any::<bool>()).prop_map(|(joint, to, cause, relative)| {
        if relative && to == 0 { by(joint, 1.0, cause) } else { go(joint, f64::from(to), cause) }
    });
    leaf.prop_recursive(5, 40, 4, |inner| {
        let list = proptest::collection::vec(inner, 0..4);
        (list, any::<bool>()).prop_map(|(list, beside)| if beside { parallel(list) } else { series(list) })
    })
}

proptest! {
    #![proptest_config(crate::support::properties::cases(256))]

    #[test]
    fn conflicts_agree_with_their_definition(program in programs()) {
        let (mut errors, mut warnings) = (false, false);
        by_definition(&program, &mut errors, &mut warnings);
        let found = conflicts(&program);
        prop_assert_eq!(!found.errors.is_empty(), errors);
        // Where setpoints contradict each other, equal ones are not told as well.
        prop_assert!(found.warnings.is_empty() || warnings);
        prop_assert!(errors || found.warnings.is_empty() != warnings);
    }
}

#[test]
fn a_million_shared_nodes_take_work_in_proportion() {
    // A hundred levels of ten thousand nodes, each over two nodes of the level below.
    let mut level: Vec<Arc<Node>> = (0..10_000).map(|i| go(i % 12, 0.5, i)).collect();
    for depth in 1..100_usize {
        let pick = |i: usize, k: usize| level[(i * 7919 + k * 104_729 + depth) % level.len()].clone();
        level = (0..level.len()).map(|i| series(vec![pick(i, 0), pick(i, 1)])).collect();
    }
    let root = series(level);
    let nodes = Graph::of(&root).nodes.len();
    let found = conflicts(&root);
    assert!(nodes > 700_000, "{nodes}");
    assert!(found.work <= 2 * 12 * (nodes + 2 * nodes), "{} for {nodes} nodes", found.work);
}

#[test]
fn a_wide_tree_over_many_joints_takes_work_in_proportion() {
    let legs =
        |n: u32| parallel((0..n).map(|i| repeat(series(vec![go(i, 0.5, i), go(i, -0.5, i)]), 9)).collect());
    let (small, large) = (conflicts(&legs(1_000)).work, conflicts(&legs(100_000)).work);
    assert!(large <= 101 * small, "{large} against {small}");
}

fn first_issue(program: Arc<Node>) -> (Part, IssueKind) {
    let mut robot = chain(2);
    let mut library = (*robot.library).clone();
    library.modules[0].joints[FRONT].passive = true;
    library.modules[0].motors[0].limits.speed = Some(1.5);
    robot.library = Arc::new(library);
    let found = issues(&robot, &program, 1e-9);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].cause, CauseId(7));
    (found[0].part, found[0].kind.clone())
}

#[test]
fn commands_beyond_the_joint_name_the_argument_at_fault() {
    let joint = || "m0.tilt".to_string();
    let (part, kind) = first_issue(go(T, 2.0, 7));
    assert_eq!(part, Part::Target);
    assert!(matches!(kind, IssueKind::OutOfRange { position: 2.0, .. }));
    let (part, kind) = first_issue(spin_for(L, 6.0, 5.0, 7));
    assert_eq!(part, Part::Speed);
    let too_fast =
        IssueKind::TooFast { joint: "m0.left".into(), speed: 6.0, limit: 2.4086, prismatic: false };
    assert_eq!(kind, too_fast);
    // A motor that drives the joint is slower than the joint.
    let (_, kind) = first_issue(spin_for(T, -2.0, 0.1, 7));
    assert_eq!(kind, IssueKind::TooFast { joint: joint(), speed: -2.0, limit: 1.5, prismatic: false });
    let (part, kind) = first_issue(spin(F, 0.1, 7));
    assert_eq!(
        (part, kind),
        (Part::Joint, IssueKind::NoCommands { joint: "m0.front".into(), why: Uncommandable::Passive })
    );
    let (part, kind) = first_issue(act(moving(T, Target::By(1.0), Some(0.5), Profile::Linear), 7));
    let needed = 1.0 / 1.5;
    assert_eq!((part, kind), (Part::Duration, IssueKind::TooShort { joint: joint(), given: 0.5, needed }));
    let keyframes = vec![[0.0, 0.0, 9.0], [1.0, 0.0, 9.0]];
    let (part, _) = first_issue(act(Command::Follow { joint: JointId(T), keyframes }, 7));
    assert_eq!(part, Part::Keyframes);
    let port = PortRef { module: 0, port: 0 };
    assert_eq!(first_issue(act(Command::Dock { a: port, b: port }, 7)).0, Part::Ports);
    assert_eq!(first_issue(go_in(T, 0.0, f64::NAN, 7)).0, Part::Duration);
}
