//! The validation of libraries: module types and connectors.

use crate::geometry::{Placed, Pose, soundness};
use crate::plan::fault::{LibraryFault, PlanFault, need, need_index};
use crate::plan::tolerances::TOLERANCES;
use crate::robot::{Library, Link, ModuleType};
use std::collections::BTreeSet;

/// Checks that every index in a library points at something, and that the joints of every module carry
/// its links as a tree.
pub(in crate::plan) fn references(library: &Library) -> Result<(), PlanFault> {
    let connectors = library.connectors.len();
    for connector in &library.connectors {
        need(connector.turns >= 1, || LibraryFault::NoTurn { connector: connector.name.clone() })?;
        connector.mates.iter().try_for_each(|&mate| need_index(mate, connectors, "connector"))?;
    }
    library.modules.iter().try_for_each(|module| tree(module, connectors))
}

/// Checks the references of a module type, and that its joints form a tree from the body.
fn tree(module: &ModuleType, connectors: usize) -> Result<(), PlanFault> {
    let name = || module.name.clone();
    let inside = |checked: Result<(), PlanFault>| {
        checked.map_err(|fault| PlanFault::InModule { module: name(), fault: Box::new(fault) })
    };
    let link = |i| inside(need_index(i, module.links.len(), "link"));
    let joint = |i| inside(need_index(i, module.joints.len(), "joint"));
    link(0)?;
    let mut carried = BTreeSet::from([0]);
    for j in &module.joints {
        link(j.parent)?;
        link(j.child)?;
        let joint_name = || j.name.clone();
        need(j.axis.norm() > 0.0, || LibraryFault::NoAxis { module: name(), joint: joint_name() })?;
        need(carried.insert(j.child), || LibraryFault::SharedLink { module: name() })?;
        j.mimic.iter().flatten().try_for_each(|m| joint(m.0))?;
    }
    need(carried.len() == module.links.len(), || LibraryFault::LooseLink { module: name() })?;
    need(is_tree(module), || LibraryFault::CyclicJoints { module: name() })?;
    module.motors.iter().flat_map(|m| &m.joints).try_for_each(|m| joint(m.0))?;
    module.touching.iter().try_for_each(|&(a, b)| link(a).and(link(b)))?;
    let port = |link_of, connector| link(link_of).and(need_index(connector, connectors, "connector"));
    module.ports.iter().try_for_each(|p| port(p.link, p.connector))
}

/// Returns `true` where every link is reached from the body by joints.
fn is_tree(module: &ModuleType) -> bool {
    let mut reached = BTreeSet::from([0]);
    let mut stack = vec![0];
    while let Some(link) = stack.pop() {
        let children = module.joints.iter().filter(|j| j.parent == link).map(|j| j.child);
        stack.extend(children.filter(|&c| reached.insert(c)));
    }
    reached.len() == module.links.len()
}

/// Checks that masses, limits, shapes and poses of a library are in their ranges.
pub(in crate::plan) fn ranges(library: &Library) -> Result<(), PlanFault> {
    library.modules.iter().try_for_each(|module| {
        module_ranges(module)
            .map_err(|fault| PlanFault::InModule { module: module.name.clone(), fault: Box::new(fault) })
    })
}

fn module_ranges(module: &ModuleType) -> Result<(), PlanFault> {
    need(module.touch >= 0.0 && module.contact >= 0.0, || LibraryFault::NegativeTolerance)?;
    module.links.iter().try_for_each(link_ranges)?;
    let mass: f64 = module.links.iter().map(|l| l.mass).sum();
    need(mass > 0.0, || LibraryFault::NoMass)?;
    for joint in &module.joints {
        let name = || joint.name.clone();
        let unit = (joint.axis.norm() - 1.0).abs() < TOLERANCES.unit_norm;
        need(unit, || LibraryFault::AxisNorm { joint: name() })?;
        rigid(&joint.pose, &joint.name)?;
        let in_order = joint.limits.range.is_none_or(|(low, high)| low <= high);
        need(in_order, || LibraryFault::JointRange { joint: name() })?;
    }
    let limits = module.joints.iter().map(|j| &j.limits).chain(module.motors.iter().map(|m| &m.limits));
    for limits in limits {
        let stated = [limits.speed, limits.acceleration, limits.effort];
        let positive = stated.iter().flatten().all(|limit| *limit > 0.0);
        need(positive, || LibraryFault::Limit)?;
    }
    module.ports.iter().try_for_each(|port| rigid(&port.pose, &port.name))
}

fn link_ranges(link: &Link) -> Result<(), PlanFault> {
    let name = || link.name.clone();
    need(link.mass >= 0.0, || LibraryFault::LinkMass { link: name() })?;
    need(link.friction >= 0.0, || LibraryFault::LinkFriction { link: name() })?;
    rigid(&link.pose, &link.name)?;
    need(!link.collides.is_empty(), || LibraryFault::NoShape { link: name() })?;
    link.collides.iter().chain(&link.shape).try_for_each(|placed| solid(placed, &link.name))
}

/// Checks that a shape of a link is a solid at a rigid pose.
fn solid(placed: &Placed, link: &str) -> Result<(), PlanFault> {
    rigid(&placed.pose, link)?;
    soundness::check(&placed.shape)
        .map_err(|fault| LibraryFault::Shape { link: link.to_owned(), fault }.into())
}

/// Checks that the rotation of a pose is a unit quaternion.
pub(in crate::plan) fn rigid(pose: &Pose, of: &str) -> Result<(), PlanFault> {
    let norm = pose.rotation.quaternion().norm();
    need((norm - 1.0).abs() < TOLERANCES.unit_norm, || LibraryFault::Pose { of: of.to_owned() })
}
