//! `at_rest`, `move_nodes`, `merge_nodes` and `split_node`: plans of trusses that are stated step by step.

use super::Native;
use super::show::nodes;
use super::truss::truss_of;
use super::truss_limits::no_strut;
use crate::geometry::Vec3;
use crate::interpret::argument::{Positive, parameters};
use crate::interpret::design::Instance;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::plan::{
    self, CauseId, DynamicsModel, Ground, NodePaths, NodePathsFault, PlanFault, TopologyChange,
    TopologyEvent, World,
};
use crate::planners::truss::stated_steps::stated_steps;
use crate::robot::Library;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;
use std::sync::Arc;

/// The name by which plans say that they were stated step by step.
const PLANNER: &str = "truss_steps";

/// The most steps of one motion.
const STEPS_MAX: usize = 10_000;

/// The built-ins that state plans of trusses step by step: the key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::on_run("at_rest", parameters![truss: &Rc<Instance>, weight: bool, friction: Positive], at_rest),
    Native::on_run(
        "move_nodes",
        parameters![plan: &Value, nodes: &[Value], to: &[Value], steps: usize],
        move_nodes,
    ),
    Native::on_run("merge_nodes", parameters![plan: &Value, node: &str, into: &str], merge_nodes),
    Native::on_run("split_node", parameters![plan: &Value, node: &str, struts: &[Value]], split_node),
];

/// Runs `at_rest`: a truss as it is declared, as a plan that lasts no time.
fn at_rest(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let design = call.get::<&Rc<Instance>>("truss")?.design.clone();
    let friction = call.positive("friction", "the friction")?;
    let world = if call.get("weight")? {
        World { dynamics: DynamicsModel::Statics, ground: Ground::Settle, friction, ..World::default() }
    } else {
        World::FREE
    };
    let mut library = Library::default();
    let Some(paths) = truss_of(&design).and_then(|truss| nodes(truss, &mut library)) else {
        return Ok(Value::Unknown);
    };
    let causes = interpreter.planner_causes(call.span);
    let plan = interpreter.bare_plan(PLANNER, paths.into(), Arc::new(library), world, &causes);
    Ok(value(PlanValue::new(design, None, plan, causes.ids, 0)))
}

/// Runs `move_nodes`.
///
/// # Errors
/// A fault where the plan is not one of a truss, a node is unknown, twice there or merged into another, there are not as many
/// places as nodes, or a strut would have no length.
fn move_nodes(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = interpreter.plan_of(call.arg("plan"), call.at("plan"))? else {
        return Ok(Value::Unknown);
    };
    let paths = truss_plan(call, &planned)?;
    let steps: usize = call.get("steps")?;
    if !(1..=STEPS_MAX).contains(&steps) {
        return Err(call.refuse("steps", format!("a motion has from 1 to {STEPS_MAX} steps")));
    }
    let (names, places) = (call.get::<&[Value]>("nodes")?, call.get::<&[Value]>("to")?);
    if names.len() != places.len() {
        let (found, wanted) = (places.len(), names.len());
        return Err(call.refuse("to", format!("there are {found} places for {wanted} nodes")));
    }
    let topology = paths.topology_at_end();
    let mut to: Vec<(usize, Vec3)> = Vec::new();
    for (name, place) in names.iter().zip(places) {
        let Value::Text(name) = name else { return Err(call.refuse("nodes", "names of nodes are wanted")) };
        let Value::Vec3(place, _) = place else { return Err(call.refuse("to", "points are wanted")) };
        let node = node_of(call, "nodes", paths, name)?;
        if to.iter().any(|(other, _)| *other == node) {
            return Err(call.refuse("nodes", format!("the node {name} is there twice")));
        }
        if topology.merged[node].is_some() {
            let carrier = &paths.node_names[topology.carrier(node)];
            return Err(Diagnostic::error(
                code::BAD_VALUE,
                format!("the node {name} is merged into {carrier}"),
            )
            .label(call.at("nodes"), "it does not move on its own")
            .hint(format!("move {carrier}, or split {name} off with `split_node` first"))
            .into());
        }
        to.push((node, *place));
    }
    let (strut, world) = (strut_of(&planned, paths), world_at_end(&planned));
    let Some(strut) = strut else { return Ok(Value::Unknown) };
    let piece = stated_steps((paths, strut), world, &to, steps)
        .map_err(|invalid| call.refuse("plan", invalid.to_string()))?;
    let vanishes = |nodes: &[[f64; 3]]| piece.struts.iter().any(|&(a, b)| nodes[a] == nodes[b]);
    if !piece.duration().is_finite() || piece.keyframes.iter().any(|keyframe| vanishes(&keyframe.nodes)) {
        return Err(call.refuse("to", "a strut would have no length on the way"));
    }
    extended(interpreter, call, &planned, piece, "to")
}

/// Runs `merge_nodes`.
///
/// # Errors
/// A fault where the plan is not one of a truss, a node is unknown, or the two can't merge.
fn merge_nodes(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = interpreter.plan_of(call.arg("plan"), call.at("plan"))? else {
        return Ok(Value::Unknown);
    };
    let paths = truss_plan(call, &planned)?;
    let node = node_of(call, "node", paths, call.get::<&str>("node")?)?;
    let into = node_of(call, "into", paths, call.get::<&str>("into")?)?;
    let piece = event(paths, TopologyChange::Merge { node, into });
    extended(interpreter, call, &planned, piece, "node")
}

/// Runs `split_node`.
///
/// # Errors
/// A fault where the plan is not one of a truss, the node or a strut is unknown, or the node can't split off with these struts.
fn split_node(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = interpreter.plan_of(call.arg("plan"), call.at("plan"))? else {
        return Ok(Value::Unknown);
    };
    let paths = truss_plan(call, &planned)?;
    let node = node_of(call, "node", paths, call.get::<&str>("node")?)?;
    let ends = paths.topology_at_end().struts;
    let known: Vec<String> = ends.iter().map(|&ends| paths.strut_name(ends)).collect();
    let mut struts = Vec::new();
    for name in call.get::<&[Value]>("struts")? {
        let Value::Text(name) = name else { return Err(call.refuse("struts", "names of struts are wanted")) };
        let turned = name.split_once(" -- ").map(|(a, b)| format!("{b} -- {a}"));
        let same = |other: &String| **other == **name || turned.as_ref() == Some(other);
        let Some(strut) = known.iter().position(same) else {
            return Err(no_strut(call, "struts", name, &known));
        };
        if struts.contains(&strut) {
            return Err(call.refuse("struts", format!("the strut {name} is there twice")));
        }
        struts.push(strut);
    }
    struts.sort_unstable();
    let piece = event(paths, TopologyChange::Split { node, struts });
    extended(interpreter, call, &planned, piece, "struts")
}

fn value(planned: PlanValue) -> Value {
    Value::Record(Rc::new(Record::Plan(Rc::new(planned))))
}

/// Returns the body of a truss's plan.
///
/// # Errors
/// A fault at the argument `plan` for a plan of another robot.
fn truss_plan<'p>(call: &Call, planned: &'p PlanValue) -> Eval<&'p NodePaths> {
    planned.plan.body.node_paths().ok_or_else(|| {
        let name = &planned.robot.name;
        Diagnostic::error(code::BAD_VALUE, format!("{name} is no truss"))
            .label(call.at("plan"), "the plan of a truss is wanted")
            .hint("`at_rest`, `morph` and `locomote` make plans of trusses")
            .into()
    })
}

/// Returns the index of a node by its name.
///
/// # Errors
/// A fault at an argument where the truss has no node of that name.
fn node_of(call: &Call, argument: &'static str, paths: &NodePaths, name: &str) -> Eval<usize> {
    let found = paths.node_names.iter().position(|other| other == name);
    found.ok_or_else(|| {
        let diagnostic = Diagnostic::error(code::BAD_VALUE, format!("the truss has no node `{name}`"))
            .label(call.at(argument), "not a node of it");
        match suggest(name, paths.node_names.iter().map(String::as_str)) {
            Some(near) => diagnostic.hint(format!("did you mean `{near}`?")).into(),
            None => diagnostic.hint(format!("its nodes are {}", plan::listed(&paths.node_names))).into(),
        }
    })
}

fn strut_of<'p>(planned: &'p PlanValue, paths: &NodePaths) -> Option<&'p crate::robot::Strut> {
    planned.plan.library.struts.get(paths.strut)
}

fn world_at_end(planned: &PlanValue) -> World {
    planned.plan.worlds.last().map_or(World::FREE, |last| last.world)
}

/// Returns what happens at the end of a plan as node paths that last no time: a change of the topology.
fn event(paths: &NodePaths, change: TopologyChange) -> NodePaths {
    let topology = paths.topology_at_end();
    let mut keyframes = paths.keyframes.clone();
    keyframes.drain(..keyframes.len().saturating_sub(1));
    keyframes.iter_mut().for_each(|keyframe| (keyframe.time, keyframe.cause) = (0.0, CauseId(0)));
    NodePaths {
        struts: topology.struts.clone(),
        merged: topology.riders(),
        keyframes,
        events: vec![TopologyEvent { time: 0.0, change, cause: CauseId(0) }],
        ..paths.clone()
    }
}

/// Returns a plan with a piece after it.
///
/// # Errors
/// A fault where the plan gets too long or unsound; faults of the piece are shown at an argument.
fn extended(
    interpreter: &mut Interpreter,
    call: &Call,
    planned: &Rc<PlanValue>,
    piece: NodePaths,
    argument: &'static str,
) -> Eval<Value> {
    let before = &planned.plan;
    let causes = interpreter.planner_causes(call.span);
    let planner = match before.provenance.planner.ends_with(PLANNER) {
        true => before.provenance.planner.clone(),
        false => PLANNER.to_owned(),
    };
    let (library, world) = (before.library.clone(), world_at_end(planned));
    let piece = interpreter.bare_plan(&planner, piece.into(), library, world, &causes);
    let mut plan = plan::joined(before, &piece)
        .map_err(|unfit| fault(code::NO_MATCH, call.span, unfit.to_string(), "after this plan"))?;
    plan.provenance.history.clone_from(&before.provenance.history);
    plan::validation::check(&plan).map_err(|unsound| refused(call, argument, &unsound))?;
    let ids = planned.causes.iter().chain(&causes.ids).copied().collect();
    Ok(value(PlanValue::new(planned.robot.clone(), None, plan, ids, 0)))
}

/// Returns the fault of a motion or an event that makes a plan unsound.
fn refused(call: &Call, argument: &'static str, unsound: &PlanFault) -> Stop {
    let PlanFault::NodePaths(found) = unsound else { return call.refuse(argument, unsound.to_string()) };
    let (message, label, hint) = match found {
        NodePathsFault::Apart { node, into, distance, .. } => (
            format!("the node {node} is {} from {into}", quantity(*distance, Dimension::LENGTH)),
            "nodes merge in one place",
            format!("move {node} to where {into} is first, with `move_nodes`"),
        ),
        NodePathsFault::MergesTwice { node, .. } => (
            format!("the node {node} is merged already"),
            "it has no struts of its own",
            format!("merge the node that carries {node}, or split {node} off first"),
        ),
        NodePathsFault::MergesIntoItself { node, .. } => (
            format!("the node {node} can't merge into itself"),
            "it is there already",
            "name another node that is in the same place".to_owned(),
        ),
        NodePathsFault::MergesStrut { strut, .. } => (
            format!("the strut {strut} joins the two"),
            "it would have no length",
            "only nodes that no strut joins can merge".to_owned(),
        ),
        NodePathsFault::DoubleStrut { strut, .. } => (
            format!("the strut {strut} would be there twice"),
            "both nodes have a strut to the same node",
            "only nodes without a common neighbour can merge".to_owned(),
        ),
        NodePathsFault::SplitsNothing { node, .. } => (
            format!("the node {node} is merged into no other"),
            "there is nothing to split it off from",
            "merge it with `merge_nodes` first".to_owned(),
        ),
        NodePathsFault::SplitsElsewhere { strut, node, .. } => (
            format!("the strut {strut} does not end at {node}"),
            "it can't be taken along",
            format!("name struts of {node}, as in `{node} -- ...`"),
        ),
        NodePathsFault::WithoutStruts { node, .. } => (
            format!("the node {node} would be without struts"),
            "nothing would hold it",
            "name the struts that hold it, at least three in the air".to_owned(),
        ),
        _ => return call.refuse(argument, unsound.to_string()),
    };
    Diagnostic::error(code::BAD_VALUE, message).label(call.at(argument), label).hint(hint).into()
}
