//! The form of a plan file: what stands in the JSON, in order, and how it becomes a plan and back.
//!
//! It differs from [`Plan`] in two places: the library stands once, beside the body, and a program is
//! a table of nodes whose children come before them, so that what is shared stays shared and nothing
//! nests deeply.

use super::visit::Graph;
use super::{
    Action, Body, Cause, CauseId, Command, Condition, Dock, Exemption, ExemptionKind, Node, NodePaths,
    Otherwise, Plan, Program, Provenance, Settings, Stages, Track, Tracks, Verdict, WorldFrom,
};
use crate::robot::{Assembly, Bond, JointId, Library, ModuleInstance, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// What the first field of every plan file says.
pub const FORMAT: &str = "modl plan";
/// The version of the form that is written, and the only one that is read.
pub const VERSION: u32 = 2;

/// A verified motion of a modular robot. SI units throughout: m, rad, s, kg, N, N·m; poses are a
/// position and a unit quaternion. Every reference is an index, from 0, into a list of this file.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Plan", deny_unknown_fields)]
pub struct PlanForm<'a> {
    /// Always `modl plan`.
    format: Cow<'a, str>,
    /// Always 2.
    version: u32,
    provenance: Cow<'a, Provenance>,
    worlds: Cow<'a, [WorldFrom]>,
    settings: Settings,
    /// Whether times depend on what sensors would say: then they hold for the undisturbed run.
    nominal: bool,
    library: Arc<Library>,
    body: BodyForm<'a>,
    program: Option<ProgramForm<'a>>,
    causes: Cow<'a, [Cause]>,
    exemptions: Cow<'a, [Exemption]>,
    verdict: Option<Cow<'a, Verdict>>,
}

/// Only what tells the versions apart.
#[derive(Deserialize)]
pub struct Header {
    pub format: Option<String>,
    pub version: Option<u32>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Body", rename_all = "snake_case", deny_unknown_fields)]
enum BodyForm<'a> {
    Tracks(TracksForm<'a>),
    Stages(Cow<'a, Stages>),
    NodePaths(Cow<'a, NodePaths>),
}

/// Joint motions over time, and which bonds hold.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Tracks", deny_unknown_fields)]
struct TracksForm<'a> {
    robot: RobotForm<'a>,
    start: Cow<'a, State>,
    /// Seconds.
    duration: f64,
    /// At most one a joint, in order of joint. A joint without a track keeps its start position.
    tracks: Cow<'a, [Track]>,
    /// In order of time.
    docks: Cow<'a, [Dock]>,
    /// Who set which joint of the start pose.
    start_causes: Cow<'a, [(JointId, CauseId)]>,
    /// Who connected which bond.
    bond_causes: Cow<'a, [(usize, CauseId)]>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Robot", deny_unknown_fields)]
struct RobotForm<'a> {
    name: Cow<'a, str>,
    modules: Cow<'a, [ModuleInstance]>,
    /// Every bond that exists at some time.
    bonds: Cow<'a, [Bond]>,
    /// The module whose body frame is drawn upright at the start, and whose pose is reported.
    base: usize,
    /// Whether the connections may close loops.
    closed: bool,
}

/// A series-parallel graph of actions as a table of nodes.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Program", deny_unknown_fields)]
struct ProgramForm<'a> {
    /// Children stand before the nodes that they are children of.
    nodes: Vec<NodeForm<'a>>,
    root: usize,
}

/// A node; its children by index.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Node", rename_all = "snake_case", deny_unknown_fields)]
enum NodeForm<'a> {
    Action(ActionForm<'a>),
    Series(Vec<usize>),
    Parallel(Vec<usize>),
    Repeat { body: usize, times: u64 },
    Phase { body: usize, shift: f64, cause: CauseId },
    Approach { body: usize, shift: f64, cause: CauseId },
    Stretch { body: usize, duration: f64, cause: CauseId },
    Exempt { body: usize, kind: ExemptionKind, cause: CauseId },
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Action", deny_unknown_fields)]
struct ActionForm<'a> {
    command: Cow<'a, Command>,
    /// Ends the action when it holds.
    until: Option<Cow<'a, Condition>>,
    /// Seconds.
    timeout: Option<f64>,
    otherwise: OtherwiseForm,
    cause: CauseId,
}

/// What follows a timeout.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Otherwise", rename_all = "snake_case", deny_unknown_fields)]
enum OtherwiseForm {
    Proceed,
    Abort(String),
    Node(usize),
}

impl<'a> PlanForm<'a> {
    /// The form of a plan; it borrows what is large.
    pub fn of(plan: &'a Plan) -> PlanForm<'a> {
        PlanForm {
            format: Cow::Borrowed(FORMAT),
            version: VERSION,
            provenance: Cow::Borrowed(&plan.provenance),
            worlds: Cow::Borrowed(&plan.worlds),
            settings: plan.settings,
            nominal: plan.nominal,
            library: plan.library.clone(),
            body: BodyForm::of(&plan.body),
            program: plan.program.as_ref().map(ProgramForm::of),
            causes: Cow::Borrowed(&plan.causes),
            exemptions: Cow::Borrowed(&plan.exemptions),
            verdict: plan.verdict.as_ref().map(Cow::Borrowed),
        }
    }

    /// The plan, or what is wrong with the table of its program.
    pub fn plan(self) -> Result<Plan, String> {
        let program = self.program.map(ProgramForm::program).transpose()?;
        let body = self.body.body(&self.library);
        Ok(Plan {
            provenance: self.provenance.into_owned(),
            worlds: self.worlds.into_owned(),
            settings: self.settings,
            nominal: self.nominal,
            library: self.library,
            body,
            program,
            causes: self.causes.into_owned(),
            exemptions: self.exemptions.into_owned(),
            verdict: self.verdict.map(Cow::into_owned),
        })
    }
}

impl<'a> BodyForm<'a> {
    fn of(body: &'a Body) -> BodyForm<'a> {
        match body {
            Body::Tracks(tracks) => BodyForm::Tracks(TracksForm::of(tracks)),
            Body::Stages(stages) => BodyForm::Stages(Cow::Borrowed(stages)),
            Body::NodePaths(paths) => BodyForm::NodePaths(Cow::Borrowed(paths)),
        }
    }

    fn body(self, library: &Arc<Library>) -> Body {
        match self {
            BodyForm::Tracks(tracks) => Body::Tracks(tracks.tracks(library)),
            BodyForm::Stages(stages) => Body::Stages(stages.into_owned()),
            BodyForm::NodePaths(paths) => Body::NodePaths(paths.into_owned()),
        }
    }
}

impl<'a> TracksForm<'a> {
    fn of(tracks: &'a Tracks) -> TracksForm<'a> {
        let robot = &tracks.robot;
        TracksForm {
            robot: RobotForm {
                name: Cow::Borrowed(&robot.name),
                modules: Cow::Borrowed(&robot.modules),
                bonds: Cow::Borrowed(&robot.bonds),
                base: robot.base,
                closed: robot.closed,
            },
            start: Cow::Borrowed(&tracks.start),
            duration: tracks.duration,
            tracks: Cow::Borrowed(&tracks.tracks),
            docks: Cow::Borrowed(&tracks.docks),
            start_causes: Cow::Borrowed(&tracks.start_causes),
            bond_causes: Cow::Borrowed(&tracks.bond_causes),
        }
    }

    fn tracks(self, library: &Arc<Library>) -> Tracks {
        let robot = Assembly {
            name: self.robot.name.into_owned(),
            library: library.clone(),
            modules: self.robot.modules.into_owned(),
            bonds: self.robot.bonds.into_owned(),
            base: self.robot.base,
            closed: self.robot.closed,
        };
        Tracks {
            robot,
            start: self.start.into_owned(),
            tracks: self.tracks.into_owned(),
            docks: self.docks.into_owned(),
            duration: self.duration,
            start_causes: self.start_causes.into_owned(),
            bond_causes: self.bond_causes.into_owned(),
        }
    }
}

impl<'a> ProgramForm<'a> {
    fn of(program: &'a Program) -> ProgramForm<'a> {
        let graph = Graph::of(&program.root);
        let nodes = graph.nodes.iter().map(|node| NodeForm::of(node, &graph)).collect::<Vec<_>>();
        ProgramForm { root: nodes.len() - 1, nodes }
    }

    fn program(self) -> Result<Program, String> {
        let mut done: Vec<Arc<Node>> = Vec::with_capacity(self.nodes.len());
        for (index, form) in self.nodes.into_iter().enumerate() {
            let node = form.node(|child: usize| {
                let before = done.get(child).cloned();
                before.ok_or_else(|| format!("node {index} of the program has node {child} as a child, which does not stand before it"))
            })?;
            done.push(Arc::new(node));
        }
        let root = done.get(self.root).cloned();
        let root = root.ok_or_else(|| format!("the program has no node {} to begin with", self.root))?;
        Ok(Program { root })
    }
}

impl<'a> NodeForm<'a> {
    fn of(node: &'a Node, graph: &Graph) -> NodeForm<'a> {
        let at = |child: &Arc<Node>| graph.position(child);
        match node {
            Node::Action(action) => NodeForm::Action(ActionForm::of(action, graph)),
            Node::Series(list) => NodeForm::Series(list.iter().map(at).collect()),
            Node::Parallel(list) => NodeForm::Parallel(list.iter().map(at).collect()),
            Node::Repeat { body, times } => NodeForm::Repeat { body: at(body), times: *times },
            Node::Phase { body, shift, cause } => {
                NodeForm::Phase { body: at(body), shift: *shift, cause: *cause }
            }
            Node::Approach { body, shift, cause } => {
                NodeForm::Approach { body: at(body), shift: *shift, cause: *cause }
            }
            Node::Stretch { body, duration, cause } => {
                NodeForm::Stretch { body: at(body), duration: *duration, cause: *cause }
            }
            Node::Exempt { body, kind, cause } => {
                NodeForm::Exempt { body: at(body), kind: kind.clone(), cause: *cause }
            }
        }
    }

    fn node(self, child: impl Fn(usize) -> Result<Arc<Node>, String>) -> Result<Node, String> {
        Ok(match self {
            NodeForm::Action(action) => Node::Action(action.action(child)?),
            NodeForm::Series(list) => Node::Series(list.into_iter().map(child).collect::<Result<_, _>>()?),
            NodeForm::Parallel(list) => {
                Node::Parallel(list.into_iter().map(child).collect::<Result<_, _>>()?)
            }
            NodeForm::Repeat { body, times } => Node::Repeat { body: child(body)?, times },
            NodeForm::Phase { body, shift, cause } => Node::Phase { body: child(body)?, shift, cause },
            NodeForm::Approach { body, shift, cause } => Node::Approach { body: child(body)?, shift, cause },
            NodeForm::Stretch { body, duration, cause } => {
                Node::Stretch { body: child(body)?, duration, cause }
            }
            NodeForm::Exempt { body, kind, cause } => Node::Exempt { body: child(body)?, kind, cause },
        })
    }
}

impl<'a> ActionForm<'a> {
    fn of(action: &'a Action, graph: &Graph) -> ActionForm<'a> {
        ActionForm {
            command: Cow::Borrowed(&action.command),
            until: action.until.as_ref().map(Cow::Borrowed),
            timeout: action.timeout,
            otherwise: match &action.otherwise {
                Otherwise::Proceed => OtherwiseForm::Proceed,
                Otherwise::Abort(message) => OtherwiseForm::Abort(message.clone()),
                Otherwise::Node(node) => OtherwiseForm::Node(graph.position(node)),
            },
            cause: action.cause,
        }
    }

    fn action(self, child: impl Fn(usize) -> Result<Arc<Node>, String>) -> Result<Action, String> {
        let otherwise = match self.otherwise {
            OtherwiseForm::Proceed => Otherwise::Proceed,
            OtherwiseForm::Abort(message) => Otherwise::Abort(message),
            OtherwiseForm::Node(node) => Otherwise::Node(child(node)?),
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
