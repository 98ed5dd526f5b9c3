//! Whether a plan can be judged at all: what [`validate`] asks, and that all numbers mean something.

use super::validate::validate;
use super::{Body, Ground, Interpolation, NodePaths, Plan, Tracks, finite};
use crate::geometry::{HeightField, Placed, soundness};
use crate::robot::{Assembly, JointKind, JointOwner, Library, Link, ModuleType};

/// Farther no joint turns (rad) or moves (m): what turns that often takes the judge for ever.
const POSITION_MAX: f64 = 1e6;
/// How far from 1 the norm of a direction or of a rotation may be.
const TOL_UNIT: f64 = 1e-6;

/// Everything that is wrong with the form of a plan, in words; nothing for a sound plan. The first
/// fault of each part is told.
pub fn faults(plan: &Plan) -> Vec<String> {
    let checks: [&dyn Fn() -> Result<(), String>; 5] = [
        &|| numbers(plan),
        &|| validate(plan),
        &|| options(plan),
        &|| library(&plan.library),
        &|| match &plan.body {
            Body::Tracks(tracks) => robot(tracks),
            Body::Stages(_) => Ok(()),
            Body::NodePaths(paths) => trusses(paths),
        },
    ];
    // Each check may rely on those before it.
    checks.iter().find_map(|check| check().err()).into_iter().collect()
}

/// No number is infinite or none at all.
fn numbers(plan: &Plan) -> Result<(), String> {
    let finite = |what: &str, checked: Result<(), finite::Fault>| checked.map_err(|e| format!("{what}: {e}"));
    finite("the library", finite::check(&*plan.library))?;
    finite("the settings", finite::check(&plan.settings))?;
    finite("the worlds", finite::check(&plan.worlds))?;
    finite("the exemptions", finite::check(&plan.exemptions))?;
    if let Body::Tracks(tracks) = &plan.body {
        finite("the start", finite::check(&tracks.start))?;
        finite("the tracks", finite::check(&tracks.tracks))?;
        finite("the docks", finite::check(&tracks.docks))?;
        finite("the robot", finite::check(&*tracks.robot.library))?;
    }
    Ok(())
}

/// Every strut has two ends, and every node a place.
fn trusses(paths: &NodePaths) -> Result<(), String> {
    let finite = |what: &str, checked: Result<(), finite::Fault>| checked.map_err(|e| format!("{what}: {e}"));
    finite("the keyframes", finite::check(&paths.keyframes))?;
    finite("the limits", finite::check(&paths.limits))?;
    finite("the surroundings", finite::check(&paths.surroundings))?;
    for placed in paths.surroundings.obstacles.iter().flatten() {
        soundness::check(&placed.shape).map_err(|fault| format!("an obstacle: {fault}"))?;
    }
    if let Some(fault) = paths.surroundings.terrain.as_ref().and_then(HeightField::fault) {
        return Err(fault.to_string());
    }
    need(paths.struts.iter().all(|(a, b)| a != b), || "a strut begins and ends at one node".to_owned())?;
    paths.keyframes.iter().try_for_each(|keyframe| match keyframe.interpolation {
        Interpolation::RigidRoll { edge: (a, b), .. } => need(keyframe.nodes[a] != keyframe.nodes[b], || {
            format!("the roll to {} s is about an edge without length", keyframe.time)
        }),
        Interpolation::Linear => Ok(()),
    })
}

fn need(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}

fn options(plan: &Plan) -> Result<(), String> {
    let settings = &plan.settings;
    need(settings.sample > 0.0, || format!("a sample every {} s is none", settings.sample))?;
    need(settings.unstable_for >= 0.0, || "`unstable_for` is negative".to_owned())?;
    need(settings.samples_max >= 1, || "no samples are allowed".to_owned())?;
    let has_base = matches!(plan.body, Body::Tracks(_));
    plan.worlds.iter().try_for_each(|w| {
        need(has_base || w.world.ground != Ground::Held, || {
            "only a robot of modules has a base to hold".to_owned()
        })?;
        need(w.world.gravity >= 0.0, || "gravity points upwards".to_owned())?;
        need(w.world.friction >= 0.0, || "friction is negative".to_owned())
    })
}

fn library(library: &Library) -> Result<(), String> {
    library.modules.iter().try_for_each(|module| {
        module_type(module).map_err(|fault| format!("module `{}`: {fault}", module.name))
    })
}

fn module_type(module: &ModuleType) -> Result<(), String> {
    need(module.touch >= 0.0 && module.contact >= 0.0, || "a tolerance is negative".to_owned())?;
    module.links.iter().try_for_each(link)?;
    let mass: f64 = module.links.iter().map(|l| l.mass).sum();
    need(mass > 0.0, || "it has no mass".to_owned())?;
    for joint in &module.joints {
        let name = &joint.name;
        need((joint.axis.norm() - 1.0).abs() < TOL_UNIT, || {
            format!("the axis of `{name}` is no unit vector")
        })?;
        upright(&joint.pose, name)?;
        need(joint.limits.range.is_none_or(|(low, high)| low <= high), || {
            format!("the range of `{name}` ends before it begins")
        })?;
    }
    let limits = module.joints.iter().map(|j| &j.limits).chain(module.motors.iter().map(|m| &m.limits));
    for limits in limits {
        let stated = [limits.speed, limits.acceleration, limits.effort];
        let positive = stated.iter().flatten().all(|limit| *limit > 0.0);
        need(positive, || "a limit is not positive".to_owned())?;
    }
    module.ports.iter().try_for_each(|port| upright(&port.pose, &port.name))
}

fn link(link: &Link) -> Result<(), String> {
    need(link.mass >= 0.0, || format!("the mass of `{}` is negative", link.name))?;
    need(link.friction >= 0.0, || format!("the friction of `{}` is negative", link.name))?;
    upright(&link.pose, &link.name)?;
    need(!link.collides.is_empty(), || format!("`{}` has no shape", link.name))?;
    link.collides.iter().chain(&link.shape).try_for_each(|placed| shape(placed, &link.name))
}

fn shape(placed: &Placed, name: &str) -> Result<(), String> {
    upright(&placed.pose, name)?;
    soundness::check(&placed.shape).map_err(|fault| format!("a shape of `{name}`: {fault}"))
}

/// Whether a pose has a rotation in it, and nothing else.
fn upright(pose: &crate::geometry::Pose, name: &str) -> Result<(), String> {
    let norm = pose.rotation.quaternion().norm();
    need((norm - 1.0).abs() < TOL_UNIT, || format!("the pose of `{name}` is no rigid displacement"))
}

fn robot(tracks: &Tracks) -> Result<(), String> {
    library(&tracks.robot.library)?;
    upright(&tracks.start.base, "the base")?;
    let owners: Vec<JointOwner> = tracks.robot.joints().collect();
    for track in &tracks.tracks {
        let far = track.segments.iter().flat_map(|s| &s.control).any(|q| q.abs() > POSITION_MAX);
        need(!far, || format!("a joint is moved beyond {POSITION_MAX} rad or m"))?;
        let owner = owners[track.joint.0 as usize];
        need(takes_commands(&tracks.robot, owner), || {
            format!("{} takes no commands", tracks.robot.joint_name(owner))
        })?;
    }
    ports(&tracks.robot, &tracks.start.bonds)?;
    let mut bonds = tracks.start.bonds.clone();
    tracks.docks.iter().try_for_each(|dock| {
        bonds[dock.bond] = !bonds[dock.bond];
        ports(&tracks.robot, &bonds).map_err(|fault| format!("at {} s {fault}", dock.time))
    })
}

fn takes_commands(robot: &Assembly, owner: JointOwner) -> bool {
    match owner {
        JointOwner::Module { module, joint } => {
            let joint = &robot.module_type(module).joints[joint];
            joint.kind != JointKind::Fixed && !joint.passive && joint.mimic.is_none()
        }
        JointOwner::Bond(_) => true,
    }
}

/// Bonds that hold mate what mates, and no port twice.
fn ports(robot: &Assembly, holds: &[bool]) -> Result<(), String> {
    let mut taken = std::collections::BTreeSet::new();
    for (bond, _) in robot.bonds.iter().zip(holds).filter(|(_, holds)| **holds) {
        for port in [bond.a, bond.b] {
            need(taken.insert(port), || format!("{} is taken twice", robot.port_name(port)))?;
        }
        let connector =
            |port: crate::robot::PortRef| robot.module_type(port.module).ports[port.port].connector;
        let mates = &robot.library.connectors[connector(bond.a)].mates;
        need(mates.contains(&connector(bond.b)), || {
            format!("{} does not mate with {}", robot.port_name(bond.a), robot.port_name(bond.b))
        })?;
    }
    Ok(())
}
