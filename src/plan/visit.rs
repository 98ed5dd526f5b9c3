//! Programs as graphs: every node once, however often it is used.

use super::program::{Action, Condition, Node, Otherwise};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The distinct nodes of a program under a root, children before parents; two nodes are distinct if their addresses
/// are.
pub struct Graph<'a> {
    /// The nodes, in order of first completion; the root is last.
    pub nodes: Vec<&'a Arc<Node>>,
    index: HashMap<*const Node, usize>,
    /// The length of the longest path from the root down, in nodes, the root included.
    pub depth: usize,
}

impl<'a> Graph<'a> {
    /// Returns the graph of the nodes under a root. The traversal has a stack of its own, so that no depth overflows.
    pub fn of(root: &'a Arc<Node>) -> Graph<'a> {
        let mut graph = Graph { nodes: Vec::new(), index: HashMap::new(), depth: 0 };
        let mut depths = Vec::new();
        let mut stack = vec![(root, 0)];
        while let Some((node, next)) = stack.pop() {
            if next == 0 && graph.index.contains_key(&Arc::as_ptr(node)) {
                continue;
            }
            if let Some(child) = child(node, next) {
                stack.push((node, next + 1));
                stack.push((child, 0));
                continue;
            }
            let below = children(node).map(|c| depths[graph.position(c)]).max().unwrap_or(0);
            depths.push(below + 1);
            graph.depth = graph.depth.max(below + 1);
            graph.index.insert(Arc::as_ptr(node), graph.nodes.len());
            graph.nodes.push(node);
        }
        graph
    }

    /// Returns the index in [`nodes`](Graph::nodes) of a node of the graph. Panics if the graph does not have the
    /// node.
    pub fn position(&self, node: &Arc<Node>) -> usize {
        self.index[&Arc::as_ptr(node)]
    }

    /// Returns every distinct action, in the order of [`Graph::nodes`]; the actions of `else` branches are among them.
    pub fn actions(&self) -> impl Iterator<Item = &'a Action> + '_ {
        self.nodes.iter().filter_map(|node| match &***node {
            Node::Action(action) => Some(action),
            _ => None,
        })
    }
}

/// The size of a program as it is carried out, in actions and steps; counts saturate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// The number of actions that begin, repetitions included; `else` branches are not.
    pub actions: u64,
    /// The number of nodes that are entered, repetitions included.
    pub steps: u64,
}

/// Returns the extent of a program. A phase, approach or stretch counts in it as one step without actions, since its
/// body is carried out by itself; each count of the result is the greatest among the program and all such bodies. The
/// work is linear in the distinct nodes, however often each is carried out.
pub fn extent(root: &Arc<Node>) -> Extent {
    let graph = Graph::of(root);
    let mut extents: Vec<Extent> = Vec::with_capacity(graph.nodes.len());
    let mut largest = Extent::default();
    for node in &graph.nodes {
        let of = |child: &Arc<Node>| extents[graph.position(child)];
        let extent = match &***node {
            Node::Action(_) => Extent { actions: 1, steps: 1 },
            Node::Goal(goal) => Extent { actions: goal.stand_ins.len() as u64, steps: 1 },
            Node::Series(list) | Node::Parallel(list) => {
                list.iter().map(of).fold(Extent { actions: 0, steps: 1 }, Extent::plus)
            }
            Node::Repeat { body, times, .. } => {
                let Extent { actions, steps } = of(body);
                let steps = steps.saturating_mul(*times).saturating_add(1);
                Extent { actions: actions.saturating_mul(*times), steps }
            }
            Node::Exempt { body, .. } | Node::Contract { body, .. } => {
                Extent { actions: 0, steps: 1 }.plus(of(body))
            }
            Node::Phase { body, .. } | Node::Approach { body, .. } | Node::Stretch { body, .. } => {
                largest = largest.max(of(body));
                Extent { actions: 0, steps: 1 }
            }
        };
        extents.push(extent);
    }
    largest.max(extents.pop().expect("a graph has its root"))
}

impl Extent {
    fn plus(self, other: Extent) -> Extent {
        let actions = self.actions.saturating_add(other.actions);
        Extent { actions, steps: self.steps.saturating_add(other.steps) }
    }

    fn max(self, other: Extent) -> Extent {
        Extent { actions: self.actions.max(other.actions), steps: self.steps.max(other.steps) }
    }
}

/// Returns true if two programs are equal: the same nodes in the same order, causes included. Each pair of nodes is
/// compared once, however often it occurs. `a` and `b`: their root nodes.
pub fn equal(a: &Arc<Node>, b: &Arc<Node>) -> bool {
    let mut seen = HashSet::new();
    let mut stack = vec![(a, b)];
    while let Some((a, b)) = stack.pop() {
        if Arc::ptr_eq(a, b) || !seen.insert((Arc::as_ptr(a), Arc::as_ptr(b))) {
            continue;
        }
        if !alike(a, b) || children(a).count() != children(b).count() {
            return false;
        }
        stack.extend(children(a).zip(children(b)));
    }
    true
}

/// Returns true if two nodes are equal but for their children.
fn alike(a: &Node, b: &Node) -> bool {
    let leaf = Arc::new(Node::Series(Vec::new()));
    let bare = |node: &Node| match node {
        Node::Action(action) => Node::Action(Action {
            otherwise: match &action.otherwise {
                Otherwise::Node(_) => Otherwise::Node(leaf.clone()),
                other => other.clone(),
            },
            command: action.command.clone(),
            until: action.until.clone(),
            ..*action
        }),
        Node::Series(_) => Node::Series(Vec::new()),
        Node::Parallel(_) => Node::Parallel(Vec::new()),
        other => with_children(other, |_| leaf.clone()),
    };
    bare(a) == bare(b)
}

/// Returns the nodes directly under a node, in order; those of an action are its `else` branch, if it has one.
pub fn children(node: &Node) -> impl Iterator<Item = &Arc<Node>> {
    (0..).map_while(|i| child(node, i))
}

fn child(node: &Node, i: usize) -> Option<&Arc<Node>> {
    match node {
        Node::Series(list) | Node::Parallel(list) => list.get(i),
        Node::Action(Action { otherwise: Otherwise::Node(body), .. })
        | Node::Repeat { body, .. }
        | Node::Phase { body, .. }
        | Node::Approach { body, .. }
        | Node::Stretch { body, .. }
        | Node::Exempt { body, .. }
        | Node::Contract { body, .. } => Some(body).filter(|_| i == 0),
        Node::Goal(goal) => goal.body().filter(|_| i == 0),
        Node::Action(_) => None,
    }
}

/// Returns the same graph, sharing kept, with every action rewritten, children first; `rewrite` receives the action
/// with its `else` branch already rewritten, `condition` what ends a repetition. `root`: the root of the graph.
///
/// # Errors
/// The first error of `rewrite` or `condition`.
pub fn rewritten<E>(
    root: &Arc<Node>,
    mut rewrite: impl FnMut(&Action) -> Result<Action, E>,
    mut condition: impl FnMut(&Condition) -> Result<Condition, E>,
) -> Result<Arc<Node>, E> {
    let graph = Graph::of(root);
    let mut done: Vec<Arc<Node>> = Vec::with_capacity(graph.nodes.len());
    for node in &graph.nodes {
        let new = |child: &Arc<Node>| done[graph.position(child)].clone();
        let made = match &***node {
            Node::Action(action) => {
                let otherwise = match &action.otherwise {
                    Otherwise::Node(n) => Otherwise::Node(new(n)),
                    other => other.clone(),
                };
                let shallow = Action {
                    command: action.command.clone(),
                    until: action.until.clone(),
                    otherwise,
                    ..*action
                };
                Node::Action(rewrite(&shallow)?)
            }
            Node::Repeat { body, times, until } => {
                let until = until.as_ref().map(&mut condition).transpose()?;
                Node::Repeat { body: new(body), times: *times, until }
            }
            other => with_children(other, new),
        };
        done.push(Arc::new(made));
    }
    Ok(done.pop().expect("a graph has its root"))
}

/// Returns a copy of a node with the children that `new` returns for its own; an action is copied as it is, with its
/// `else` branch.
pub fn with_children(node: &Node, new: impl Fn(&Arc<Node>) -> Arc<Node>) -> Node {
    match node {
        Node::Action(action) => Node::Action(action.clone()),
        Node::Series(list) => Node::Series(list.iter().map(new).collect()),
        Node::Parallel(list) => Node::Parallel(list.iter().map(new).collect()),
        Node::Repeat { body, times, until } => {
            Node::Repeat { body: new(body), times: *times, until: until.clone() }
        }
        Node::Phase { body, shift, cause } => Node::Phase { body: new(body), shift: *shift, cause: *cause },
        Node::Approach { body, shift, cause } => {
            Node::Approach { body: new(body), shift: *shift, cause: *cause }
        }
        Node::Stretch { body, duration, cause } => {
            Node::Stretch { body: new(body), duration: *duration, cause: *cause }
        }
        Node::Exempt { body, kind, cause } => {
            Node::Exempt { body: new(body), kind: kind.clone(), cause: *cause }
        }
        Node::Contract { body, number, cause } => {
            Node::Contract { body: new(body), number: *number, cause: *cause }
        }
        Node::Goal(goal) => Node::Goal(Box::new(goal.with_body(new))),
    }
}

/// Returns true if behaviours under a root have contracts.
pub fn has_contracts(root: &Arc<Node>) -> bool {
    Graph::of(root).nodes.iter().any(|node| matches!(***node, Node::Contract { .. }))
}

/// Returns the same graph, sharing kept, with each behaviour in the place of its contracts. `root`: the root of the graph.
pub fn without_contracts(root: &Arc<Node>) -> Arc<Node> {
    if !has_contracts(root) {
        return root.clone();
    }
    let graph = Graph::of(root);
    let mut done: Vec<Arc<Node>> = Vec::with_capacity(graph.nodes.len());
    for node in &graph.nodes {
        let new = |child: &Arc<Node>| done[graph.position(child)].clone();
        let made = match &***node {
            Node::Contract { body, .. } => new(body),
            Node::Action(action) => {
                let otherwise = match &action.otherwise {
                    Otherwise::Node(body) => Otherwise::Node(new(body)),
                    other => other.clone(),
                };
                Arc::new(Node::Action(Action { otherwise, ..action.clone() }))
            }
            other => Arc::new(with_children(other, new)),
        };
        done.push(made);
    }
    done.pop().expect("a graph has its root")
}
