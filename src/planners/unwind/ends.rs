//! The ends of a module: the two docks by which it is joined to its neighbours in a snake.

use super::tolerances::{COS_OPPOSITE, SIN_BENDS, TOL_DISTANCE};
use crate::geometry::{Pose, Vec3};
use crate::robot::{Assembly, JointKind, ModuleType};
use std::cmp::Ordering;
use std::fmt;

/// The two docks of each module, by the index of the port in the type of the module.
pub type Ends = Vec<[usize; 2]>;

/// A module that lacks what the method needs, by its index in the assembly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// The module has no two docks of which each mates with itself and with the other.
    Docks(usize),
    /// The docks of the module are hinges.
    Hinged(usize),
    /// No joint that takes commands moves one of the module's docks against another.
    Rigid(usize),
    /// The docks at the ends of the two modules do not mate.
    Strangers([usize; 2]),
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unfit::Docks(module) => {
                write!(f, "module {module} has no two docks that mate with each other and with their like")
            }
            Unfit::Hinged(module) => write!(f, "the docks of module {module} are hinges"),
            Unfit::Rigid(module) => write!(f, "no joint moves one dock of module {module} against another"),
            Unfit::Strangers([a, b]) => write!(f, "the docks of modules {a} and {b} do not mate"),
        }
    }
}

/// Returns the ends of every module: of the pairs of genderless docks those that face opposite ways before others, then
/// those between which the most joints bend, then the pair that is farthest apart, all joints at zero; of equal ones
/// the first as declared.
///
/// # Errors
/// [`Unfit`] for the first module without such docks or without a joint between docks, and for two whose ends do not mate.
pub fn ends(robot: &Assembly) -> Result<Ends, Unfit> {
    let mut of_kinds: Vec<Option<[usize; 2]>> = vec![None; robot.library.modules.len()];
    let mut ends: Ends = Vec::new();
    for (module, instance) in robot.modules.iter().enumerate() {
        let found = match of_kinds[instance.kind] {
            Some(found) => found,
            None => ends_of(robot, module)?,
        };
        of_kinds[instance.kind] = Some(found);
        ends.push(found);
        let connector = |module: usize| robot.module_type(module).ports[ends[module][0]].connector;
        if !robot.library.connectors[connector(module)].mates.contains(&connector(0)) {
            return Err(Unfit::Strangers([0, module]));
        }
    }
    Ok(ends)
}

/// Returns the ends of a module.
fn ends_of(robot: &Assembly, module: usize) -> Result<[usize; 2], Unfit> {
    let kind = robot.module_type(module);
    let connectors = &robot.library.connectors;
    let mates =
        |a: usize, b: usize| connectors[kind.ports[a].connector].mates.contains(&kind.ports[b].connector);
    let docks: Vec<usize> = (0..kind.ports.len()).filter(|port| mates(*port, *port)).collect();
    let pairs = docks.iter().flat_map(|a| docks.iter().map(move |b| [*a, *b]));
    let pairs: Vec<[usize; 2]> = pairs.filter(|[a, b]| a < b && mates(*a, *b)).collect();
    if pairs.is_empty() {
        return Err(Unfit::Docks(module));
    }
    if pairs.iter().flatten().any(|port| connectors[kind.ports[*port].connector].hinge.is_some()) {
        return Err(Unfit::Hinged(module));
    }
    if pairs.iter().all(|[a, b]| joints_between(kind, [*a, *b]).is_empty()) {
        return Err(Unfit::Rigid(module));
    }
    let best = pairs
        .into_iter()
        .reduce(|best, pair| if merit(kind, pair).is_above(&merit(kind, best)) { pair } else { best });
    Ok(best.expect("there is a pair"))
}

/// The worth of a pair of docks as ends.
struct Merit {
    opposite: bool,
    bends: usize,
    distance: f64,
}

impl Merit {
    fn is_above(&self, other: &Merit) -> bool {
        match self.opposite.cmp(&other.opposite).then(self.bends.cmp(&other.bends)) {
            Ordering::Equal => self.distance > other.distance + TOL_DISTANCE,
            order => order == Ordering::Greater,
        }
    }
}

fn merit(kind: &ModuleType, pair: [usize; 2]) -> Merit {
    let [X_MA, X_MB] = pair.map(|port| port_pose(kind, port));
    let between = X_MB.translation.vector - X_MA.translation.vector;
    let line = between.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let bends = |joint: &usize| {
        let joint = &kind.joints[*joint];
        (joint.pose.rotation * joint.axis).cross(&line).norm() > SIN_BENDS
    };
    let [a, b] = [X_MA, X_MB].map(|X_MP| X_MP.rotation * Vec3::x());
    Merit {
        opposite: a.dot(&b) < COS_OPPOSITE,
        bends: joints_between(kind, pair).iter().filter(|joint| bends(joint)).count(),
        distance: between.norm(),
    }
}

/// Returns the pose of a port in the frame of its module, all joints at zero.
fn port_pose(kind: &ModuleType, port: usize) -> Pose {
    let port = &kind.ports[port];
    kind.links[port.link].pose * port.pose
}

/// Returns the joints that take commands and move one port against another.
fn joints_between(kind: &ModuleType, pair: [usize; 2]) -> Vec<usize> {
    let to_body = |port: usize| {
        let mut link = kind.ports[port].link;
        let mut joints = Vec::new();
        while let Some(joint) = kind.joints.iter().position(|joint| joint.child == link) {
            joints.push(joint);
            link = kind.joints[joint].parent;
        }
        joints
    };
    let [a, b] = pair.map(to_body);
    let one_only =
        a.iter().filter(|joint| !b.contains(joint)).chain(b.iter().filter(|joint| !a.contains(joint)));
    let moves = |joint: &usize| {
        let joint = &kind.joints[*joint];
        joint.kind != JointKind::Fixed && !joint.passive && joint.mimic.is_none()
    };
    one_only.copied().filter(moves).collect()
}
