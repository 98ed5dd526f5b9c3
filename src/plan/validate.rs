//! Whether a plan that was read is sound in itself: every index points at something, times are in
//! order, tracks do not jump. Whether the plan is good is for the judge; this is what lets the judge,
//! and everyone else, index without asking.

use super::polynomial::DEGREE_MAX;
use super::time::DURATION_MAX;
use super::visit::Graph;
use super::{
    Action, Body, CauseId, Command, Condition, Dock, DockKind, ExemptionKind, Interpolation, Law, Node,
    NodePaths, Plan, Ratio, Run, Signal, Stages, Track, Tracks,
};
use crate::robot::{Assembly, JointId, Library, ModuleType, PortRef};
use std::collections::BTreeSet;

/// How far a joint may jump between two segments, rad or m: rounding, where plans were joined.
const TOL_JUMP: f64 = 1e-9;
/// Most cells of a lattice.
const CELLS_MAX: u64 = 4_000_000;

/// What is wrong with the plan, in words.
pub fn validate(plan: &Plan) -> Result<(), String> {
    library(&plan.library)?;
    let duration = plan.body.duration();
    need(duration.is_finite() && (0.0..=DURATION_MAX).contains(&duration), || {
        format!("the duration of {duration} s is outside 0..{DURATION_MAX}")
    })?;
    let causes = plan.causes.len();
    match &plan.body {
        Body::Tracks(body) => {
            tracks(body, causes)?;
            let robot = &body.robot;
            let joints = robot.joints().count();
            for exemption in &plan.exemptions {
                kind(&exemption.kind, robot, joints)?;
            }
            if let Some(program) = &plan.program {
                nodes(&Graph::of(&program.root), robot, joints, causes)?;
            }
        }
        Body::Stages(body) => stages(body, &plan.library, causes)?,
        Body::NodePaths(body) => paths(body, &plan.library, causes)?,
    }
    for exemption in &plan.exemptions {
        cause(exemption.cause, causes)?;
        need(exemption.from <= exemption.to, || "an exemption ends before it begins".into())?;
    }
    let starts: Vec<f64> = plan.worlds.iter().map(|w| w.from).collect();
    need(starts.first() == Some(&0.0), || "the first world must hold from 0 on".into())?;
    ascending(&starts, "the worlds")
}

fn need(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}

fn index(i: usize, len: usize, what: &str) -> Result<(), String> {
    need(i < len, || format!("there is no {what} {i}: there are {len}"))
}

fn cause(id: CauseId, causes: usize) -> Result<(), String> {
    index(id.0 as usize, causes, "cause")
}

fn ascending(times: &[f64], what: &str) -> Result<(), String> {
    need(times.windows(2).all(|w| w[0] < w[1]), || format!("{what} are not in order of time"))
}

fn library(library: &Library) -> Result<(), String> {
    for connector in &library.connectors {
        need(connector.turns >= 1, || format!("connector `{}` has no turn", connector.name))?;
        connector.mates.iter().try_for_each(|&m| index(m, library.connectors.len(), "connector"))?;
    }
    library.modules.iter().try_for_each(|module| module_type(module, library))
}

fn module_type(module: &ModuleType, library: &Library) -> Result<(), String> {
    let (links, joints) = (module.links.len(), module.joints.len());
    let link = |i| index(i, links, "link").map_err(|e| format!("in module `{}`: {e}", module.name));
    let joint = |i| index(i, joints, "joint").map_err(|e| format!("in module `{}`: {e}", module.name));
    link(0)?;
    let mut carried = BTreeSet::from([0]);
    for j in &module.joints {
        link(j.parent)?;
        link(j.child)?;
        need(j.axis.norm() > 0.0, || format!("joint `{}.{}` has no axis", module.name, j.name))?;
        need(carried.insert(j.child), || format!("two joints carry one link of module `{}`", module.name))?;
        j.mimic.iter().flatten().try_for_each(|m| joint(m.0))?;
    }
    need(carried.len() == links, || format!("a link of module `{}` hangs in the air", module.name))?;
    need(is_tree(module), || format!("the joints of module `{}` form a circle", module.name))?;
    module.motors.iter().flat_map(|m| &m.joints).try_for_each(|m| joint(m.0))?;
    module.touching.iter().try_for_each(|&(a, b)| link(a).and(link(b)))?;
    module
        .ports
        .iter()
        .try_for_each(|p| link(p.link).and(index(p.connector, library.connectors.len(), "connector")))
}

/// Whether every link is reached from the body.
fn is_tree(module: &ModuleType) -> bool {
    let mut reached = BTreeSet::from([0]);
    let mut stack = vec![0];
    while let Some(link) = stack.pop() {
        let children = module.joints.iter().filter(|j| j.parent == link).map(|j| j.child);
        stack.extend(children.filter(|&c| reached.insert(c)));
    }
    reached.len() == module.links.len()
}

fn robot(robot: &Assembly) -> Result<(), String> {
    index(robot.base, robot.modules.len(), "module")?;
    let mut names = BTreeSet::new();
    for module in &robot.modules {
        index(module.kind, robot.library.modules.len(), "module type")?;
        need(names.insert(&module.name), || format!("two modules have the name `{}`", module.name))?;
    }
    for bond in &robot.bonds {
        port(bond.a, robot)?;
        port(bond.b, robot)?;
        let connector = robot.module_type(bond.a.module).ports[bond.a.port].connector;
        index(bond.turn as usize, robot.library.connectors[connector].turns as usize, "turn")?;
    }
    Ok(())
}

fn port(port: PortRef, robot: &Assembly) -> Result<(), String> {
    index(port.module, robot.modules.len(), "module")?;
    index(port.port, robot.module_type(port.module).ports.len(), "port")
}

fn tracks(body: &Tracks, causes: usize) -> Result<(), String> {
    robot(&body.robot)?;
    let (joints, bonds) = (body.robot.joints().count(), body.robot.bonds.len());
    need(body.start.joints.len() == joints, || format!("the start pose must have {joints} joint positions"))?;
    need(body.start.bonds.len() == bonds, || format!("the start pose must have {bonds} bonds"))?;
    need(body.tracks.windows(2).all(|w| w[0].joint < w[1].joint), || {
        "tracks are not in order of joint".into()
    })?;
    for track in &body.tracks {
        index(track.joint.0 as usize, joints, "joint")?;
        segments(track, body, causes).map_err(|e| format!("in the track of joint {}: {e}", track.joint.0))?;
    }
    docks(body, causes)?;
    for &(joint, id) in &body.start_causes {
        index(joint.0 as usize, joints, "joint").and(cause(id, causes))?;
    }
    body.bond_causes.iter().try_for_each(|&(bond, id)| index(bond, bonds, "bond").and(cause(id, causes)))
}

fn segments(track: &Track, body: &Tracks, causes: usize) -> Result<(), String> {
    let mut now = 0.0;
    let mut at = body.start.joints[track.joint.0 as usize];
    for segment in &track.segments {
        cause(segment.cause, causes)?;
        let (start, end) = (segment.start, segment.end);
        need((2..=DEGREE_MAX + 1).contains(&segment.control.len()), || {
            format!("at {start} s a segment has {} control points", segment.control.len())
        })?;
        need(now <= start && start < end && end <= body.duration, || {
            format!("the segment of {start}..{end} s is out of order or beyond the end")
        })?;
        need((segment.control[0] - at).abs() <= TOL_JUMP, || format!("the joint jumps at {start} s"))?;
        (now, at) = (end, segment.last());
    }
    Ok(())
}

fn docks(body: &Tracks, causes: usize) -> Result<(), String> {
    let mut now = 0.0;
    let mut holds = body.start.bonds.clone();
    for Dock { time, kind, bond, cause: id } in &body.docks {
        cause(*id, causes)?;
        index(*bond, holds.len(), "bond")?;
        need(now <= *time && *time <= body.duration, || format!("docking at {time} s is out of order"))?;
        let docks = *kind == DockKind::Dock;
        need(holds[*bond] != docks, || {
            format!("at {time} s bond {bond} {}", if docks { "holds already" } else { "does not hold" })
        })?;
        holds[*bond] = docks;
        now = *time;
    }
    Ok(())
}

fn kind(kind: &ExemptionKind, robot: &Assembly, joints: usize) -> Result<(), String> {
    match kind {
        ExemptionKind::Collision(Some((a, b))) => {
            let modules = robot.modules.len();
            index(*a, modules, "module").and(index(*b, modules, "module"))
        }
        ExemptionKind::Overload(Some(joint)) => index(*joint as usize, joints, "joint"),
        _ => Ok(()),
    }
}

fn nodes(graph: &Graph, robot: &Assembly, joints: usize, causes: usize) -> Result<(), String> {
    for node in &graph.nodes {
        match &***node {
            Node::Action(action) => self::action(action, robot, joints, causes)?,
            Node::Phase { cause: id, .. }
            | Node::Approach { cause: id, .. }
            | Node::Stretch { cause: id, .. } => {
                cause(*id, causes)?;
            }
            Node::Exempt { kind, cause: id, .. } => {
                cause(*id, causes)?;
                self::kind(kind, robot, joints)?;
            }
            Node::Series(_) | Node::Parallel(_) | Node::Repeat { .. } => {}
        }
    }
    Ok(())
}

fn action(action: &Action, robot: &Assembly, joints: usize, causes: usize) -> Result<(), String> {
    cause(action.cause, causes)?;
    let joint = |id: &JointId| index(id.0 as usize, joints, "joint");
    match &action.command {
        Command::Move { joint: id, .. }
        | Command::Spin { joint: id, .. }
        | Command::Follow { joint: id, .. } => {
            joint(id)?;
        }
        Command::Dock { a, b } => port(*a, robot).and(port(*b, robot))?,
        Command::Undock { port: p } => port(*p, robot)?,
        Command::Wait { .. } => {}
    }
    action.until.as_ref().map_or(Ok(()), |c| condition(c, robot, joints))
}

/// Nesting is limited by that of the text.
fn condition(c: &Condition, robot: &Assembly, joints: usize) -> Result<(), String> {
    match c {
        Condition::Compare { signal: Signal::Angle(id) | Signal::Speed(id), .. } => {
            index(id.0 as usize, joints, "joint")
        }
        Condition::Compare { signal: Signal::Elapsed, .. } => Ok(()),
        Condition::Docked(p) => port(*p, robot),
        Condition::Mated(a, b) => port(*a, robot).and(port(*b, robot)),
        Condition::And(a, b) | Condition::Or(a, b) => {
            condition(a, robot, joints).and(condition(b, robot, joints))
        }
        Condition::Not(a) => condition(a, robot, joints),
    }
}

fn stages(body: &Stages, library: &Library, causes: usize) -> Result<(), String> {
    index(body.cell, library.cells.len(), "cell type")?;
    need(body.count <= CELLS_MAX, || format!("more than {CELLS_MAX} cells"))?;
    need(body.time_unit > 0.0, || "the unit of time must be positive".into())?;
    let limits = &body.limits;
    ratio(limits.smallest)?;
    ratio(limits.speed_squared)?;
    let sound =
        limits.smallest.0 > 0 && limits.smallest.order(Ratio::ONE).is_le() && limits.speed_squared.0 > 0;
    need(sound, || "the limits of the cells are out of range".into())?;
    if let Some(force) = body.model.contact_force {
        ratio(force)?;
        need(force.0 > 0, || "the greatest contact force must be positive".into())?;
    }
    let named: u64 = body.start.iter().map(|r| size_of(r).unwrap_or(0)).fold(0, u64::saturating_add);
    need(named >= body.count, || "the start does not say where every cell is".into())?;
    body.start.iter().try_for_each(|run| self::run(run, body.count))?;
    for stage in &body.stages {
        cause(stage.cause, causes)?;
        ratio(stage.time_squared)?;
        need(stage.time_squared.0 >= 0, || format!("stage `{}` lasts no real time", stage.name))?;
        law(stage.law).map_err(|fault| format!("in stage `{}`: {fault}", stage.name))?;
        stage.end.iter().try_for_each(|run| self::run(run, body.count))?;
    }
    Ok(())
}

fn law(law: Law) -> Result<(), String> {
    let (part, most) = match law {
        Law::BangBang => return Ok(()),
        Law::Trapezoid(part) => (part, Ratio(1, 2)),
        Law::SpeedUp(part) | Law::SlowDown(part) => (part, Ratio::ONE),
    };
    ratio(part)?;
    // Products of two of them are to fit.
    need(part.1 < 1 << 60, || "a ramp is too fine a part of the time".into())?;
    need(part.0 > 0 && part.order(most).is_le(), || "a ramp takes none of the time, or too much".into())
}

fn size_of(run: &Run) -> Option<u64> {
    run.counters.iter().try_fold(1_u64, |size, c| size.checked_mul(c.count))
}

fn run(run: &Run, count: u64) -> Result<(), String> {
    need(size_of(run).is_some_and(|n| (1..=count).contains(&n)), || {
        "a run of no cells, or of too many".into()
    })?;
    let counters = &run.counters;
    counters.iter().flat_map(|c| c.step).chain(run.center).chain(run.size).try_for_each(ratio)?;
    // Lowest and highest cell, in numbers too wide to overflow.
    let ends = counters.iter().map(|c| i128::from(c.stride) * (i128::from(c.count) - 1));
    let (low, high) = ends.fold((0, 0), |(low, high), end| (low + end.min(0), high + end.max(0)));
    let (low, high) = (i128::from(run.first) + low, i128::from(run.first) + high);
    need(low >= 0 && high < i128::from(count), || {
        format!("a run holds the cells {low} to {high}: there are {count}")
    })
}

fn ratio(ratio: Ratio) -> Result<(), String> {
    need(ratio.1 > 0, || {
        format!("{} / {} is no rational number with a positive denominator", ratio.0, ratio.1)
    })
}

fn paths(body: &NodePaths, library: &Library, causes: usize) -> Result<(), String> {
    index(body.strut, library.struts.len(), "strut type")?;
    let count = body.node_names.len();
    let node = |i| index(i, count, "node");
    body.struts.iter().try_for_each(|&(a, b)| node(a).and(node(b)))?;
    let strut = |i: &usize| index(*i, body.struts.len(), "strut");
    body.limits.sums.iter().flat_map(|sum| &sum.struts).try_for_each(strut)?;
    let times: Vec<f64> = body.keyframes.iter().map(|k| k.time).collect();
    need(times.first() == Some(&0.0), || "the first keyframe must be at 0".into())?;
    ascending(&times, "the keyframes")?;
    for keyframe in &body.keyframes {
        cause(keyframe.cause, causes)?;
        need(keyframe.nodes.len() == count, || {
            format!("the keyframe at {} s has not {count} nodes", keyframe.time)
        })?;
        if let Interpolation::RigidRoll { edge: (a, b), .. } = keyframe.interpolation {
            node(a).and(node(b))?;
            need(a != b, || format!("the roll to {} s is about no edge", keyframe.time))?;
        }
    }
    Ok(())
}
