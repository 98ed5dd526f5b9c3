//! Programs as they stand in a plan file: a table of nodes whose children come before them, so that
//! what is shared stays shared and nothing nests deeply.

use crate::plan::cause::CauseId;
use crate::plan::fault::PlanFault;
use crate::plan::program::{Action, Command, Condition, Node, Otherwise, Program, Signal};
use crate::plan::stated::Stated;
use crate::plan::tracks::RobotNames;
use crate::plan::visit::Graph;
use crate::plan::world::ExemptionKind;
use crate::robot::JointId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// A series-parallel graph of actions as a table of nodes.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Program", deny_unknown_fields)]
pub(super) struct ProgramJson<'a> {
    /// Children stand before the nodes that they are children of.
    nodes: Vec<NodeJson<'a>>,
    root: usize,
}

/// A node; its children by index.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Node", rename_all = "snake_case", deny_unknown_fields)]
enum NodeJson<'a> {
    Action(ActionJson<'a>),
    Series(Vec<usize>),
    Parallel(Vec<usize>),
    Repeat {
        body: usize,
        /// The number of times that the body is carried out, at most.
        times: u64,
        /// The condition that ends the repetition if it holds after one of these times.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        until: Option<Cow<'a, Condition>>,
        /// The names of the joints, ports and modules in `until`, in its order.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        until_on: Vec<String>,
    },
    Phase {
        body: usize,
        shift: f64,
        cause: CauseId,
    },
    Approach {
        body: usize,
        shift: f64,
        cause: CauseId,
    },
    Stretch {
        body: usize,
        duration: f64,
        cause: CauseId,
    },
    Exempt {
        body: usize,
        kind: ExemptionKind,
        /// The names of the modules or of the joint that it excuses.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        on: Vec<String>,
        cause: CauseId,
    },
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Action", deny_unknown_fields)]
struct ActionJson<'a> {
    command: Cow<'a, Command>,
    /// The names of the joint or the ports that the command is about, in its order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    on: Vec<String>,
    /// The condition that ends the action when it begins to hold.
    until: Option<Cow<'a, Condition>>,
    /// The names of the joints, ports and modules in `until`, in its order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    until_on: Vec<String>,
    /// The timeout, s.
    timeout: Option<f64>,
    otherwise: OtherwiseJson,
    cause: CauseId,
}

/// The continuation after a timeout.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Otherwise", rename_all = "snake_case", deny_unknown_fields)]
enum OtherwiseJson {
    Proceed,
    Abort(String),
    Node(usize),
}

impl<'a> ProgramJson<'a> {
    /// Returns a program as it stands in a plan file; `names`: those of its robot, `None` for one without joints.
    pub(super) fn of(program: &'a Program, names: Option<&RobotNames>) -> ProgramJson<'a> {
        let graph = Graph::of(&program.root);
        let nodes = graph.nodes.iter().map(|node| NodeJson::of(node, &graph, names)).collect::<Vec<_>>();
        ProgramJson { root: nodes.len() - 1, nodes }
    }

    /// Adds the names that the file states beside indices to `stated`, in the order of the file.
    pub(super) fn names(&self, stated: &mut Stated) {
        for node in &self.nodes {
            match node {
                NodeJson::Action(action) => {
                    stated.add_all("command subject", &action.on);
                    stated.add_all("condition subject", &action.until_on);
                }
                NodeJson::Exempt { on, .. } => stated.add_all("exempted subject", on),
                NodeJson::Repeat { until_on, .. } => stated.add_all("condition subject", until_on),
                NodeJson::Series(_)
                | NodeJson::Parallel(_)
                | NodeJson::Phase { .. }
                | NodeJson::Approach { .. }
                | NodeJson::Stretch { .. } => {}
            }
        }
    }

    /// Returns the program that stands in a file; its table of nodes is checked, and nothing else.
    ///
    /// # Errors
    /// [`PlanFault::ProgramChild`] or [`PlanFault::ProgramRoot`] for a node that is not in the table, or comes later
    /// in it.
    pub(super) fn into_program(self) -> Result<Program, PlanFault> {
        let mut done: Vec<Arc<Node>> = Vec::with_capacity(self.nodes.len());
        for (index, json) in self.nodes.into_iter().enumerate() {
            let node = json.into_node(|child: usize| {
                let before = done.get(child).cloned();
                before.ok_or(PlanFault::ProgramChild { node: index, child })
            })?;
            done.push(Arc::new(node));
        }
        let root = done.get(self.root).cloned();
        let root = root.ok_or(PlanFault::ProgramRoot { node: self.root })?;
        Ok(Program { root })
    }
}

impl<'a> NodeJson<'a> {
    fn of(node: &'a Node, graph: &Graph, names: Option<&RobotNames>) -> NodeJson<'a> {
        let at = |child: &Arc<Node>| graph.position(child);
        match node {
            Node::Action(action) => NodeJson::Action(ActionJson::of(action, graph, names)),
            Node::Series(list) => NodeJson::Series(list.iter().map(at).collect()),
            Node::Parallel(list) => NodeJson::Parallel(list.iter().map(at).collect()),
            Node::Repeat { body, times, until } => NodeJson::Repeat {
                body: at(body),
                times: *times,
                until: until.as_ref().map(Cow::Borrowed),
                until_on: of_until(until.as_ref(), names),
            },
            Node::Phase { body, shift, cause } => {
                NodeJson::Phase { body: at(body), shift: *shift, cause: *cause }
            }
            Node::Approach { body, shift, cause } => {
                NodeJson::Approach { body: at(body), shift: *shift, cause: *cause }
            }
            Node::Stretch { body, duration, cause } => {
                NodeJson::Stretch { body: at(body), duration: *duration, cause: *cause }
            }
            Node::Exempt { body, kind, cause } => {
                let on = names.map_or_else(Vec::new, |names| of_exemption(kind, names));
                NodeJson::Exempt { body: at(body), kind: kind.clone(), on, cause: *cause }
            }
            Node::Contract { .. } => {
                unreachable!("plans have no contracts: they are judged where they stand")
            }
            Node::Goal(_) => unreachable!("goals became actions when the plan was made"),
        }
    }

    fn into_node(self, child: impl Fn(usize) -> Result<Arc<Node>, PlanFault>) -> Result<Node, PlanFault> {
        Ok(match self {
            NodeJson::Action(action) => Node::Action(action.into_action(child)?),
            NodeJson::Series(list) => Node::Series(list.into_iter().map(child).collect::<Result<_, _>>()?),
            NodeJson::Parallel(list) => {
                Node::Parallel(list.into_iter().map(child).collect::<Result<_, _>>()?)
            }
            NodeJson::Repeat { body, times, until, .. } => {
                Node::Repeat { body: child(body)?, times, until: until.map(Cow::into_owned) }
            }
            NodeJson::Phase { body, shift, cause } => Node::Phase { body: child(body)?, shift, cause },
            NodeJson::Approach { body, shift, cause } => Node::Approach { body: child(body)?, shift, cause },
            NodeJson::Stretch { body, duration, cause } => {
                Node::Stretch { body: child(body)?, duration, cause }
            }
            NodeJson::Exempt { body, kind, cause, .. } => Node::Exempt { body: child(body)?, kind, cause },
        })
    }
}

impl<'a> ActionJson<'a> {
    fn of(action: &'a Action, graph: &Graph, names: Option<&RobotNames>) -> ActionJson<'a> {
        ActionJson {
            command: Cow::Borrowed(&action.command),
            on: names.map_or_else(Vec::new, |names| of_command(&action.command, names)),
            until: action.until.as_ref().map(Cow::Borrowed),
            until_on: of_until(action.until.as_ref(), names),
            timeout: action.timeout,
            otherwise: match &action.otherwise {
                Otherwise::Proceed => OtherwiseJson::Proceed,
                Otherwise::Abort(message) => OtherwiseJson::Abort(message.clone()),
                Otherwise::Node(node) => OtherwiseJson::Node(graph.position(node)),
            },
            cause: action.cause,
        }
    }

    fn into_action(self, child: impl Fn(usize) -> Result<Arc<Node>, PlanFault>) -> Result<Action, PlanFault> {
        let otherwise = match self.otherwise {
            OtherwiseJson::Proceed => Otherwise::Proceed,
            OtherwiseJson::Abort(message) => Otherwise::Abort(message),
            OtherwiseJson::Node(node) => Otherwise::Node(child(node)?),
        };
        Ok(Action {
            command: self.command.into_owned(),
            until: self.until.map(Cow::into_owned),
            timeout: self.timeout,
            otherwise,
            cause: self.cause,
        })
    }
}

/// Returns the names of the joint or the ports that a command is about.
fn of_command(command: &Command, names: &RobotNames) -> Vec<String> {
    match command {
        Command::Move { joint, .. } | Command::Spin { joint, .. } | Command::Follow { joint, .. } => {
            vec![names.joint(*joint)]
        }
        Command::Dock { a, b } => vec![names.port(*a), names.port(*b)],
        Command::Undock { port } => vec![names.port(*port)],
        Command::Wait { .. } => vec![],
    }
}

/// Returns the names of the joints, ports and modules in a condition, in its order; none without a condition or names.
fn of_until(condition: Option<&Condition>, names: Option<&RobotNames>) -> Vec<String> {
    let mut found = Vec::new();
    if let (Some(condition), Some(names)) = (condition, names) {
        add_of_condition(condition, names, &mut found);
    }
    found
}

/// Adds the names of the joints, ports and modules in a condition, in its order.
fn add_of_condition(condition: &Condition, names: &RobotNames, found: &mut Vec<String>) {
    match condition {
        Condition::Compare { signal, .. } => match signal {
            Signal::Angle(joint) | Signal::Speed(joint) | Signal::Effort(joint) => {
                found.push(names.joint(*joint));
            }
            Signal::Separation(a, b) => found.extend([names.port(*a), names.port(*b)]),
            Signal::Tilt(module) => found.push(names.module(*module)),
            Signal::Elapsed => {}
        },
        Condition::Touching(modules) => found.extend(modules.iter().map(|module| names.module(*module))),
        Condition::TouchingEachOther(a, b) => {
            found.extend(a.iter().chain(b).map(|module| names.module(*module)));
        }
        Condition::Docked(port) => found.push(names.port(*port)),
        Condition::Mated(a, b) => found.extend([names.port(*a), names.port(*b)]),
        Condition::And(a, b) | Condition::Or(a, b) => {
            add_of_condition(a, names, found);
            add_of_condition(b, names, found);
        }
        Condition::Not(a) => add_of_condition(a, names, found),
    }
}

/// Returns the names of the two modules or of the joint that an exemption is about; empty for one that names none.
pub(super) fn of_exemption(kind: &ExemptionKind, names: &RobotNames) -> Vec<String> {
    match kind {
        ExemptionKind::Collision(Some((a, b))) => vec![names.module(*a), names.module(*b)],
        ExemptionKind::Overload(Some(joint)) => vec![names.joint(JointId(*joint))],
        ExemptionKind::Unstable
        | ExemptionKind::Slip
        | ExemptionKind::Acceleration
        | ExemptionKind::Balance
        | ExemptionKind::Traction
        | ExemptionKind::Saturation
        | ExemptionKind::Collision(None)
        | ExemptionKind::Overload(None) => vec![],
    }
}
