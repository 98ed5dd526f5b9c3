//! The goals of a program that are next: those before which no other goal comes.

use crate::plan::visit::{Graph, children, with_children};
use crate::plan::{CauseId, ExemptionKind, Goal, Node, Otherwise};
use std::sync::Arc;

/// The reason why a goal stands where its beginning is not known before a robot carries the program out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misplaced {
    /// The goal stands after `else`.
    Else,
    /// The goal stands in a repetition that ends by a condition.
    Until,
    /// The goal stands in a cycle or a stretched behaviour.
    Cycle,
}

/// Returns the first goal that stands where its beginning is not known; `None` if all stand well.
pub(super) fn misplaced(program: &Arc<Node>) -> Option<(&Goal, Misplaced)> {
    let graph = Graph::of(program);
    let has_goal = |root: &Arc<Node>| -> bool {
        Graph::of(root).nodes.iter().any(|node| matches!(&***node, Node::Goal(_)))
    };
    for node in &graph.nodes {
        let (body, why) = match &***node {
            Node::Action(action) => match &action.otherwise {
                Otherwise::Node(body) => (body, Misplaced::Else),
                Otherwise::Proceed | Otherwise::Abort(_) => continue,
            },
            Node::Repeat { body, until: Some(_), .. } => (body, Misplaced::Until),
            Node::Phase { body, .. } | Node::Approach { body, .. } | Node::Stretch { body, .. } => {
                (body, Misplaced::Cycle)
            }
            _ => continue,
        };
        if has_goal(body) {
            let at = graph.position(body);
            let found = graph.nodes[..=at].iter().rev().find_map(|node| match &***node {
                Node::Goal(goal) => Some(&**goal),
                _ => None,
            });
            return found.map(|goal| (goal, why));
        }
    }
    None
}

/// Returns a program in which every goal stands once: repetitions and shared nodes that have goals are written out. `None`
/// if there are more than `most`.
pub(super) fn written_out(node: &Arc<Node>, most: &mut usize) -> Option<Arc<Node>> {
    let goals = Graph::of(node).nodes.iter().any(|node| matches!(&***node, Node::Goal(_)));
    if !goals {
        return Some(node.clone());
    }
    let mut list = |list: &[Arc<Node>]| {
        list.iter().map(|node| written_out(node, most)).collect::<Option<Vec<Arc<Node>>>>()
    };
    Some(Arc::new(match &**node {
        Node::Series(nodes) => Node::Series(list(nodes)?),
        Node::Parallel(nodes) => Node::Parallel(list(nodes)?),
        Node::Repeat { body, times, .. } => {
            let mut rounds = Vec::new();
            for _ in 0..*times {
                rounds.push(written_out(body, most)?);
            }
            Node::Series(rounds)
        }
        Node::Goal(goal) => {
            *most = most.checked_sub(1)?;
            Node::Goal(goal.clone())
        }
        other => {
            let new: Vec<Arc<Node>> =
                children(other).map(|child| written_out(child, most)).collect::<Option<_>>()?;
            with_children(other, |_| new[0].clone())
        }
    }))
}

/// The first of the causes that mark goals in a program that is cut off before them.
const MARK: u32 = u32::MAX / 2;

/// Returns the program up to its next goals, each replaced by an empty behaviour that is marked by an exemption, with the
/// goals themselves, in order. Whatever runs beside them is in it.
pub(super) fn cut<'a>(node: &'a Arc<Node>, goals: &mut Vec<&'a Arc<Node>>) -> Arc<Node> {
    cut_node(node, goals).0
}

/// Returns the cause that marks the goal of an index.
pub(super) fn mark(index: usize) -> CauseId {
    CauseId(MARK + u32::try_from(index).expect("goals are counted in 16 bits"))
}

/// Returns a node cut off before its next goals, and true if it has none.
fn cut_node<'a>(node: &'a Arc<Node>, goals: &mut Vec<&'a Arc<Node>>) -> (Arc<Node>, bool) {
    match &**node {
        Node::Goal(_) => {
            let cause = mark(goals.len());
            goals.push(node);
            let body = Arc::new(Node::Series(Vec::new()));
            (Arc::new(Node::Exempt { body, kind: ExemptionKind::Slip, cause }), false)
        }
        Node::Series(list) => {
            let mut kept = Vec::new();
            for child in list {
                let (new, whole) = cut_node(child, goals);
                kept.push(new);
                if !whole {
                    return (Arc::new(Node::Series(kept)), false);
                }
            }
            (node.clone(), true)
        }
        Node::Parallel(list) => {
            let cut: Vec<(Arc<Node>, bool)> = list.iter().map(|child| cut_node(child, goals)).collect();
            if cut.iter().all(|(_, whole)| *whole) {
                return (node.clone(), true);
            }
            (Arc::new(Node::Parallel(cut.into_iter().map(|(new, _)| new).collect())), false)
        }
        Node::Exempt { body, .. } | Node::Contract { body, .. } => {
            let (new, whole) = cut_node(body, goals);
            if whole { (node.clone(), true) } else { (Arc::new(with_children(node, |_| new.clone())), false) }
        }
        Node::Action(_)
        | Node::Repeat { .. }
        | Node::Phase { .. }
        | Node::Approach { .. }
        | Node::Stretch { .. } => (node.clone(), true),
    }
}

/// Returns a program with another node in the place of one, which stands in it once.
pub(super) fn replaced(node: &Arc<Node>, old: &Arc<Node>, new: &Arc<Node>) -> Arc<Node> {
    if Arc::ptr_eq(node, old) {
        return new.clone();
    }
    match &**node {
        Node::Series(_) | Node::Parallel(_) | Node::Exempt { .. } | Node::Contract { .. } => {
            let below: Vec<Arc<Node>> = children(node).map(|child| replaced(child, old, new)).collect();
            if children(node).zip(&below).all(|(before, after)| Arc::ptr_eq(before, after)) {
                return node.clone();
            }
            match &**node {
                Node::Series(_) => Arc::new(Node::Series(below)),
                Node::Parallel(_) => Arc::new(Node::Parallel(below)),
                other => Arc::new(with_children(other, |_| below[0].clone())),
            }
        }
        _ => node.clone(),
    }
}
