//! Maps programs and motions of one robot to another that matches it.

use super::motion::{DockingEvent, Segment, Track, Tracks};
use crate::plan::cause::CauseId;
use crate::plan::program::{Action, Command, Condition, Node, Otherwise, Signal, Target};
use crate::plan::stated_path::StatedPath;
use crate::plan::visit::{Graph, with_children};
use crate::plan::world::{Exemption, ExemptionKind};
use crate::robot::{Assembly, Bond, JointId, JointOwner, Kinematics, Matching, PortRef, State};
use std::sync::Arc;

/// A map from the modules, ports, joints, bonds and causes of robot B to those of robot A, by which two motions
/// become one. Robot A is given the bonds of B that it lacks.
#[derive(Clone, Debug)]
pub struct Remap {
    /// Robot A with the bonds of B.
    robot: Assembly,
    /// State at the start, those bonds open.
    start: State,
    found: Matching,
    /// The bond of A for every bond of B.
    bonds: Vec<usize>,
    /// The joint of A for every joint of B.
    joints: Vec<JointId>,
    /// The number to add to the index of a cause.
    causes: u32,
}

impl Remap {
    /// Returns the map for motion `a` and then motion `b`. `found` is the isomorphism from the robot of `b`, at its
    /// start, to that of `a`, at its end; the causes of `b` are numbered from `causes` on.
    pub fn new(a: &Tracks, b: &Tracks, found: &Matching, causes: u32) -> Remap {
        let (mut robot, mut start) = (a.robot.clone(), a.start.clone());
        let mut hinges = Vec::new();
        let mut bonds = Vec::new();
        for (index, bond) in b.robot.bonds.iter().enumerate() {
            let image = Bond { a: found.port(bond.a), b: found.port(bond.b), turn: bond.turn };
            let known = found.bonds[index].or_else(|| free_bond(&robot, &image, &start));
            bonds.push(known.unwrap_or_else(|| {
                robot.bonds.push(image);
                start.bonds.push(false);
                hinges.push(index);
                robot.bonds.len() - 1
            }));
        }
        let in_b = Kinematics::new(&b.robot, &b.start.bonds, b.robot.base);
        for bond in hinges {
            start.joints.extend(in_b.hinge(bond).map(|joint| b.start.joints[joint]));
        }
        let in_a = Kinematics::new(&robot, &start.bonds, robot.base);
        let image = |owner| match owner {
            JointOwner::Module { module, joint } => {
                let (module, joint) = found.joint(module, joint);
                in_a.joint(module, joint)
            }
            JointOwner::Bond(bond) => {
                in_a.hinge(bonds[bond]).expect("a hinge's bond is matched by one with a hinge")
            }
        };
        let joints = b.robot.joints().map(|owner| JointId(image(owner) as u32)).collect();
        Remap { robot, start, found: found.clone(), bonds, joints, causes }
    }

    /// Returns the names of B that differ in A, as (name in B, name in A), in the order of B's modules: of modules,
    /// and of the joints of modules that are mapped onto themselves turned round. `b`: robot B.
    pub fn renamed(&self, b: &Assembly) -> Vec<(String, String)> {
        let mut pairs = Vec::new();
        for (module, instance) in b.modules.iter().enumerate() {
            pairs.push((instance.name.clone(), self.robot.modules[self.found.modules[module]].name.clone()));
            for joint in 0..b.module_type(module).joints.len() {
                let (there, image) = self.found.joint(module, joint);
                if image != joint {
                    let name = |robot: &Assembly, module, joint| {
                        robot.joint_name(JointOwner::Module { module, joint })
                    };
                    pairs.push((name(b, module, joint), name(&self.robot, there, image)));
                }
            }
        }
        pairs.retain(|(b, a)| a != b);
        pairs
    }

    /// Returns the motion `a`, then the motion `b` by the robot of `a`, as one motion: times of `b` are later by the
    /// duration of `a`, and its joints, bonds and causes are mapped. A track of `b` begins exactly where `a` leaves
    /// its joint. The two must be the motions that the map was made for.
    pub fn tracks(&self, a: &Tracks, b: &Tracks) -> Tracks {
        let end = a.end();
        let mut tracks: Vec<Track> = a.tracks.clone();
        for track in &b.tracks {
            let joint = self.joint(track.joint);
            let at = end.joints.get(joint.0 as usize).copied();
            let segments = self.segments(track, a.duration, at);
            match tracks.binary_search_by_key(&joint, |t| t.joint) {
                Ok(known) => tracks[known].segments.extend(segments),
                Err(index) => tracks.insert(index, Track { joint, segments }),
            }
        }
        let docks = b.events.iter().map(|d| DockingEvent {
            time: d.time + a.duration,
            bond: self.bonds[d.bond],
            cause: self.cause(d.cause),
            ..*d
        });
        Tracks {
            events: a.events.iter().cloned().chain(docks).collect(),
            tracks,
            duration: a.duration + b.duration,
            obstacles: a.obstacles.clone(),
            start_causes: a.start_causes.clone(),
            bond_causes: a.bond_causes.clone(),
            robot: self.robot.clone(),
            start: self.start.clone(),
        }
    }

    /// Returns the segments of a track of B, mapped to A and delayed by `seam` (s); the first begins exactly at the
    /// joint's position `at`, if that is given.
    fn segments(&self, track: &Track, seam: f64, at: Option<f64>) -> Vec<Segment> {
        let offset = self.found.offsets[track.joint.0 as usize];
        let mut segments: Vec<Segment> = track
            .segments
            .iter()
            .map(|s| Segment {
                start: s.start + seam,
                end: s.end + seam,
                control: s.control.iter().map(|c| c + offset).collect(),
                cause: self.cause(s.cause),
            })
            .collect();
        if let (Some(first), Some(at)) = (segments.first_mut(), at) {
            first.control[0] = at;
        }
        segments
    }

    /// Returns an exemption of motion B for robot A, its times later by `seam` (s), the time at which motion A ends.
    pub fn exemption(&self, exemption: &Exemption, seam: f64) -> Exemption {
        Exemption {
            kind: self.kind(&exemption.kind),
            from: exemption.from + seam,
            to: exemption.to + seam,
            cause: self.cause(exemption.cause),
        }
    }

    /// Returns a path of robot B as one of robot A, its times later by `seam` (s); `None` where a module lies in its image by a
    /// symmetry, so that the path would be another in its frame.
    pub fn path(&self, path: &StatedPath, seam: f64) -> Option<StatedPath> {
        let plain = |module: usize| {
            let turned = &self.found.turned[module];
            turned.ports.iter().enumerate().all(|(port, image)| port == *image)
        };
        (plain(path.module) && plain(path.port.module)).then(|| StatedPath {
            port: self.found.port(path.port),
            module: self.found.modules[path.module],
            from: path.from + seam,
            to: path.to + seam,
            cause: self.cause(path.cause),
            ..path.clone()
        })
    }

    fn kind(&self, kind: &ExemptionKind) -> ExemptionKind {
        match kind {
            ExemptionKind::Collision(Some((m, n))) => {
                ExemptionKind::Collision(Some((self.found.modules[*m], self.found.modules[*n])))
            }
            ExemptionKind::Overload(Some(joint)) => {
                ExemptionKind::Overload(Some(self.joint(JointId(*joint)).0))
            }
            other => other.clone(),
        }
    }

    /// Returns a program of robot B as one of robot A; shared nodes stay shared.
    pub fn program(&self, root: &Arc<Node>) -> Arc<Node> {
        let graph = Graph::of(root);
        let mut done: Vec<Arc<Node>> = Vec::with_capacity(graph.nodes.len());
        for node in &graph.nodes {
            let new = |child: &Arc<Node>| done[graph.position(child)].clone();
            let mut made = match &***node {
                Node::Action(action) => Node::Action(self.action(action, new)),
                Node::Repeat { body, times, until } => {
                    let until = until.as_ref().map(|condition| self.condition(condition));
                    Node::Repeat { body: new(body), times: *times, until }
                }
                other => with_children(other, new),
            };
            match &mut made {
                Node::Phase { cause, .. }
                | Node::Approach { cause, .. }
                | Node::Stretch { cause, .. }
                | Node::Contract { cause, .. } => *cause = self.cause(*cause),
                Node::Exempt { kind, cause, .. } => (*kind, *cause) = (self.kind(kind), self.cause(*cause)),
                Node::Action(_)
                | Node::Series(_)
                | Node::Parallel(_)
                | Node::Repeat { .. }
                | Node::Goal(_) => {}
            }
            done.push(Arc::new(made));
        }
        done.pop().expect("a graph has its root")
    }

    fn action(&self, action: &Action, new: impl Fn(&Arc<Node>) -> Arc<Node>) -> Action {
        Action {
            command: self.command(&action.command),
            until: action.until.as_ref().map(|c| self.condition(c)),
            timeout: action.timeout,
            otherwise: match &action.otherwise {
                Otherwise::Node(node) => Otherwise::Node(new(node)),
                other => other.clone(),
            },
            cause: self.cause(action.cause),
        }
    }

    fn command(&self, command: &Command) -> Command {
        let mut new = command.clone();
        match &mut new {
            Command::Move { joint, target, .. } => {
                if let Target::To(position) = target {
                    *position += self.offset(*joint);
                }
                *joint = self.joint(*joint);
            }
            Command::Follow { joint, keyframes } => {
                keyframes.iter_mut().for_each(|keyframe| keyframe[1] += self.offset(*joint));
                *joint = self.joint(*joint);
            }
            Command::Spin { joint, .. } => *joint = self.joint(*joint),
            Command::Dock { a, b } => (*a, *b) = (self.port(*a), self.port(*b)),
            Command::Undock { port } => *port = self.port(*port),
            Command::Wait { .. } => {}
        }
        new
    }

    fn condition(&self, condition: &Condition) -> Condition {
        let boxed = |c: &Condition| Box::new(self.condition(c));
        match condition {
            Condition::Compare { signal, compare, value } => {
                let (signal, value) = match *signal {
                    Signal::Angle(joint) => (Signal::Angle(self.joint(joint)), value + self.offset(joint)),
                    Signal::Speed(joint) => (Signal::Speed(self.joint(joint)), *value),
                    Signal::Elapsed => (Signal::Elapsed, *value),
                    Signal::Effort(joint) => (Signal::Effort(self.joint(joint)), *value),
                    Signal::Separation(a, b) => (Signal::Separation(self.port(a), self.port(b)), *value),
                    Signal::Tilt(module) => (Signal::Tilt(self.found.modules[module]), *value),
                };
                Condition::Compare { signal, compare: *compare, value }
            }
            Condition::Docked(port) => Condition::Docked(self.port(*port)),
            Condition::Mated(a, b) => Condition::Mated(self.port(*a), self.port(*b)),
            Condition::Touching(modules) => Condition::Touching(self.modules(modules)),
            Condition::TouchingEachOther(a, b) => {
                Condition::TouchingEachOther(self.modules(a), self.modules(b))
            }
            Condition::And(a, b) => Condition::And(boxed(a), boxed(b)),
            Condition::Or(a, b) => Condition::Or(boxed(a), boxed(b)),
            Condition::Not(a) => Condition::Not(boxed(a)),
        }
    }

    fn joint(&self, joint: JointId) -> JointId {
        self.joints[joint.0 as usize]
    }

    fn offset(&self, joint: JointId) -> f64 {
        self.found.offsets[joint.0 as usize]
    }

    fn modules(&self, modules: &[usize]) -> Vec<usize> {
        modules.iter().map(|module| self.found.modules[*module]).collect()
    }

    fn port(&self, port: PortRef) -> PortRef {
        self.found.port(port)
    }

    fn cause(&self, cause: CauseId) -> CauseId {
        CauseId(cause.0 + self.causes)
    }
}

/// Returns a bond of A between the same ports that may serve again: one without a hinge, which might have turned
/// since. `None` if there is none.
fn free_bond(robot: &Assembly, image: &Bond, start: &State) -> Option<usize> {
    let swapped = Bond { a: image.b, b: image.a, turn: image.turn };
    let found = robot.bonds[..start.bonds.len()].iter().position(|b| b == image || *b == swapped)?;
    robot.hinge(found).is_none().then_some(found)
}
