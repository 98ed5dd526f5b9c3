//! Conflicts, found without running anything: two commands with different setpoints for one joint,
//! neither of which comes before the other in the series-parallel order.
//!
//! Two actions are unordered where the lowest node over both is parallel. So a node needs to know of
//! each joint under it no more than one command, and one with another setpoint if there is one; where
//! two branches of a parallel node share a joint, these show a contradiction if there is any. A command that a
//! finished branch left in force counts, since its command is not before those of its siblings.
//!
//! Every distinct node is visited once. Tables are handed up, the smaller merged into the larger; a
//! table is copied only where a node is used twice. In a tree an entry moves at most log2(n) times;
//! with sharing, the work is at most that of joints times distinct edges.

use crate::plan::visit::{Graph, children};
use crate::plan::{Action, CauseId, Command, Node, Target};
use crate::robot::JointId;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

/// A conflict of a program: two commands to one joint, neither of which comes before the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Conflict {
    /// The lesser cause of the two commands, by its index; equal to `second` where a command runs beside itself.
    pub first: CauseId,
    /// The greater cause of the two commands, by its index.
    pub second: CauseId,
    /// The joint that both commands move.
    pub joint: JointId,
}

/// The conflicts of a program, which commands one controller to hold two positions at one time (Definition IV.5 of
/// the compositional-design paper, Tosun, Jing, Kress-Gazit and Yim).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conflicts {
    /// The conflicts with different setpoints, each pair of causes once, with the first joint found. There is one if
    /// any two commands contradict each other, but not every such pair is listed.
    pub errors: Vec<Conflict>,
    /// The conflicts with equal setpoints, which are harmless, each pair of causes once; not every such pair is
    /// listed.
    pub warnings: Vec<Conflict>,
    /// True if more than [`PAIRS_MAX`] pairs of one kind were found, of which the rest was dropped.
    pub more: bool,
    /// The number of nodes visited and table entries handled: a measure of the work.
    pub work: usize,
}

/// The greatest number of pairs of causes in each of [`Conflicts::errors`] and [`Conflicts::warnings`], so that a
/// program in which all commands conflict is answered in bounded time; [`Conflicts::more`] says if pairs were dropped.
pub const PAIRS_MAX: usize = 100;

/// Returns the conflicts of a program (Definition IV.5 of the compositional-design paper, Tosun, Jing, Kress-Gazit
/// and Yim), found on its graph without running it. The work grows as n log n with the n nodes of a tree; if nodes
/// are shared, with the number of joints times that of distinct edges.
pub fn conflicts(program: &Arc<Node>) -> Conflicts {
    let graph = Graph::of(program);
    let mut search = Search { found: Conflicts::default(), seen: BTreeSet::new() };
    let mut tables: Vec<Option<Rc<Table>>> = Vec::with_capacity(graph.nodes.len());
    let mut uses = vec![0_usize; graph.nodes.len()];
    for node in &graph.nodes {
        children(node).for_each(|child| uses[graph.position(child)] += 1);
    }
    for node in &graph.nodes {
        let mut below = Vec::new();
        for child in children(node) {
            let index = graph.position(child);
            uses[index] -= 1;
            // Taken by its last user, shared by the others.
            let table = if uses[index] == 0 { tables[index].take() } else { tables[index].clone() };
            below.push((index, table.expect("a table stays until its last use")));
        }
        tables.push(Some(search.table(node, below)));
    }
    search.found
}

/// The commands under a node, by joint.
type Table<'a> = BTreeMap<JointId, Commanded<'a>>;

/// One command to a joint, and one with another setpoint.
#[derive(Clone, Copy)]
struct Commanded<'a> {
    one: &'a Action,
    other: Option<&'a Action>,
}

/// The search for conflicts.
struct Search {
    found: Conflicts,
    /// The pairs found already, with true where their setpoints are equal.
    seen: BTreeSet<(bool, CauseId, CauseId)>,
}

impl Search {
    /// Returns the table of a node from those of its children, and reports the conflicts between them.
    fn table<'a>(&mut self, node: &'a Node, below: Vec<(usize, Rc<Table<'a>>)>) -> Rc<Table<'a>> {
        self.found.work += 1 + below.len();
        if matches!(node, Node::Repeat { times: 0, .. }) {
            return Rc::default();
        }
        let parallel = matches!(node, Node::Parallel(_));
        let mut table = Rc::<Table>::default();
        if let Node::Action(action) = node
            && let Some(joint) = commanded(&action.command)
        {
            table = Rc::new(BTreeMap::from([(joint, Commanded { one: action, other: None })]));
        }
        // A goal commands what its own behaviour does, in its place.
        if let Node::Goal(goal) = node {
            let stand_ins =
                goal.stand_ins.iter().filter_map(|action| Some((commanded(&action.command)?, action)));
            return Rc::new(stand_ins.map(|(joint, one)| (joint, Commanded { one, other: None })).collect());
        }
        // The same child again adds nothing, but for once where it runs beside itself.
        let mut times = BTreeMap::new();
        for (child, entries) in below {
            let time: &mut usize = times.entry(child).or_default();
            *time += 1;
            if *time <= if parallel { 2 } else { 1 } {
                table = self.merged(table, entries, parallel);
            }
        }
        table
    }

    /// Returns two tables merged; those of parallel branches are compared.
    fn merged<'a>(&mut self, a: Rc<Table<'a>>, b: Rc<Table<'a>>, parallel: bool) -> Rc<Table<'a>> {
        let (mut large, small) = if a.len() >= b.len() { (a, b) } else { (b, a) };
        if small.is_empty() {
            return large;
        }
        if Rc::strong_count(&large) > 1 {
            self.found.work += large.len();
        }
        let into = Rc::make_mut(&mut large);
        for (&joint, &theirs) in small.iter() {
            self.found.work += 1;
            let Some(ours) = into.get_mut(&joint) else {
                into.insert(joint, theirs);
                continue;
            };
            if parallel {
                self.beside(joint, *ours, theirs);
            }
            ours.other = ours.other.or_else(|| theirs.unlike(ours.one));
        }
        large
    }

    /// Merges the commands of two branches to one joint: a contradiction, or the same command twice.
    fn beside(&mut self, joint: JointId, a: Commanded, b: Commanded) {
        if let Some(unlike) = b.unlike(a.one) {
            self.report(joint, a.one, unlike, false);
        } else if let Some(unlike) = a.unlike(b.one) {
            self.report(joint, unlike, b.one, false);
        } else {
            self.report(joint, a.one, b.one, true);
        }
    }

    /// Reports a conflict, once for each pair of causes.
    fn report(&mut self, joint: JointId, a: &Action, b: &Action, equal: bool) {
        let (first, second) = (a.cause.min(b.cause), a.cause.max(b.cause));
        let list = if equal { &mut self.found.warnings } else { &mut self.found.errors };
        if self.seen.contains(&(equal, first, second)) {
            return;
        }
        if list.len() == PAIRS_MAX {
            self.found.more = true;
            return;
        }
        self.seen.insert((equal, first, second));
        list.push(Conflict { first, second, joint });
    }
}

impl<'a> Commanded<'a> {
    /// Returns one of the commands whose setpoint differs from that of the action given; `None` if neither does.
    fn unlike(&self, action: &Action) -> Option<&'a Action> {
        [Some(self.one), self.other].into_iter().flatten().find(|a| !same(&a.command, &action.command))
    }
}

/// Returns the joint that a command sets a setpoint for; `None` if it commands none.
fn commanded(command: &Command) -> Option<JointId> {
    match command {
        Command::Move { joint, .. } | Command::Spin { joint, .. } | Command::Follow { joint, .. } => {
            Some(*joint)
        }
        Command::Wait { .. } | Command::Dock { .. } | Command::Undock { .. } => None,
    }
}

/// Returns `true` where two commands to one joint set the same setpoint. A setpoint relative to the joint's
/// position at that time never equals another.
fn same(a: &Command, b: &Command) -> bool {
    match (a, b) {
        (Command::Move { target: Target::To(a), .. }, Command::Move { target: Target::To(b), .. }) => a == b,
        (Command::Spin { .. }, Command::Spin { .. }) | (Command::Follow { .. }, Command::Follow { .. }) => {
            a == b
        }
        _ => false,
    }
}
