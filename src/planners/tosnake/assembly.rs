//! From an assembly of RoFI modules, or one of its files, to the planner's robot, and from steps to a
//! program.

use super::robot::{Bond, Dock, Robot};
use super::state::Step;
use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target};
use crate::robot::rofi;
use crate::robot::{Assembly, JointId, Kinematics, PortRef, State};
use std::sync::Arc;

/// The names of alpha, beta and gamma.
pub const JOINTS: [&str; 3] = ["alpha", "beta", "gamma"];

/// Pitches that differ by less than this part are the same.
const TOL_PITCH: f64 = 1e-9;

/// How long a turn of one radian takes a joint without a limit, s.
const RATE_FREE: f64 = 1.0;

/// Durations are longer than the least by this part: what rounding takes.
const SPARE: f64 = 1e-9;

/// A smooth motion's greatest speed over its mean speed.
const SMOOTH_PEAK: f64 = 15.0 / 8.0;

/// Why an assembly is no robot of RoFI modules.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoRofi {
    /// This module has other joints or ports.
    Kind(usize),
    /// This module has another pitch than the first.
    Pitch(usize),
}

/// A configuration as a file has it.
pub fn of_world(world: &rofi::World) -> Robot {
    let dock = |dock: &rofi::Dock| {
        let place = (0..super::robot::DOCKS).find(|&place| port_name(dock.module, place) == dock.port());
        Dock { module: dock.module, dock: place.expect("both name the docks of one module") }
    };
    Robot {
        joints: world.modules.iter().map(|m| m.joints.map(f64::to_radians)).collect(),
        bonds: world.edges.iter().map(|e| Bond { a: dock(&e.a), b: dock(&e.b), turn: e.turn }).collect(),
        holds: vec![true; world.edges.len()],
    }
}

/// What a file says of a configuration. Bonds that do not hold are left out.
pub fn to_world(robot: &Robot) -> rofi::World {
    let joints = |q: &[f64; 3]| q.map(|angle| libm::round(angle.to_degrees() * PARTS) / PARTS);
    let module = |(id, q): (usize, &[f64; 3])| rofi::Module { id: id as u64, joints: joints(q), line: 0 };
    let dock = |dock: Dock| {
        rofi::Dock::of_port(dock.module, port_name(dock.module, dock.dock)).expect("it is a dock's name")
    };
    rofi::World {
        modules: robot.joints.iter().enumerate().map(module).collect(),
        edges: robot
            .held()
            .map(|(_, bond)| rofi::Edge { a: dock(bond.a), b: dock(bond.b), turn: bond.turn, line: 0 })
            .collect(),
    }
}

/// Parts of a degree that are written: without the rounding of radians.
const PARTS: f64 = 1e9;

/// An assembly of RoFI modules, as the planner numbers things.
pub struct Translated<'a> {
    assembly: &'a Assembly,
    /// The assembly's number of each module's alpha, beta and gamma.
    joints: Vec<[usize; 3]>,
    pub robot: Robot,
}

/// Reads a robot in a state.
pub fn translated<'a>(assembly: &'a Assembly, state: &State) -> Result<Translated<'a>, NoRofi> {
    let kinematics = Kinematics::new(assembly, &state.bonds, assembly.base);
    let mut joints = Vec::with_capacity(assembly.modules.len());
    let mut pitch: Option<f64> = None;
    for module in 0..assembly.modules.len() {
        let kind = assembly.module_type(module);
        let place = |name: &&str| kind.joints.iter().position(|joint| joint.name == **name);
        let places: Option<Vec<usize>> = JOINTS.iter().map(place).collect();
        let Some([alpha, beta, gamma]) = places.as_deref() else { return Err(NoRofi::Kind(module)) };
        let docks = kind.ports.iter().filter(|port| rofi::Dock::of_port(module, &port.name).is_some());
        if docks.count() != super::robot::DOCKS {
            return Err(NoRofi::Kind(module));
        }
        let own = 2.0 * kind.ports[0].pose.translation.vector.norm();
        if (own - *pitch.get_or_insert(own)).abs() > TOL_PITCH * own {
            return Err(NoRofi::Pitch(module));
        }
        joints.push([*alpha, *beta, *gamma].map(|joint| kinematics.joint(module, joint)));
    }
    let dock = |port: PortRef| dock_of(assembly, port).ok_or(NoRofi::Kind(port.module));
    let mut bonds = Vec::with_capacity(assembly.bonds.len());
    for bond in &assembly.bonds {
        bonds.push(Bond { a: dock(bond.a)?, b: dock(bond.b)?, turn: bond.turn });
    }
    let positions = joints.iter().map(|joints| joints.map(|joint| state.joints[joint])).collect();
    let robot = Robot { joints: positions, bonds, holds: state.bonds.clone() };
    Ok(Translated { assembly, joints, robot })
}

fn dock_of(assembly: &Assembly, port: PortRef) -> Option<Dock> {
    let name = &assembly.module_type(port.module).ports[port.port].name;
    (0..super::robot::DOCKS)
        .find(|&dock| port_name(port.module, dock) == name)
        .map(|dock| Dock { module: port.module, dock })
}

/// The name of a dock's port in the library's module.
pub fn port_name(module: usize, dock: usize) -> &'static str {
    let sides = [rofi::Side::A, rofi::Side::B];
    let faces = [rofi::Face::PlusX, rofi::Face::MinusX, rofi::Face::MinusZ];
    rofi::Dock { module, side: sides[dock / faces.len()], face: faces[dock % faces.len()] }.port()
}

impl Translated<'_> {
    /// The steps as a program: one after the other, in each all joints at once. `bonds` are those that
    /// the steps number.
    pub fn program(&self, steps: &[Step], bonds: &[Bond], cause: CauseId) -> Arc<Node> {
        let mut positions = self.robot.joints.clone();
        let action = |command| {
            let otherwise = Otherwise::Proceed;
            Arc::new(Node::Action(Action { command, until: None, timeout: None, otherwise, cause }))
        };
        let mut series = Vec::with_capacity(steps.len());
        for step in steps {
            series.push(match step {
                Step::Dock(bond) => {
                    let [a, b] = [bonds[*bond].a, bonds[*bond].b].map(|dock| self.port(dock));
                    action(Command::Dock { a, b })
                }
                Step::Undock(bond) => action(Command::Undock { port: self.port(bonds[*bond].a) }),
                Step::Turn(turns) => {
                    let duration = turns
                        .iter()
                        .map(|&(module, joint, to)| self.time(module, joint, to - positions[module][joint]))
                        .fold(0.0, f64::max);
                    let moves = turns.iter().map(|&(module, joint, to)| {
                        positions[module][joint] = to;
                        action(Command::Move {
                            joint: JointId(self.joints[module][joint] as u32),
                            target: Target::To(to),
                            duration: Some(duration),
                            profile: Profile::Smooth,
                        })
                    });
                    Arc::new(Node::Parallel(moves.collect()))
                }
            });
        }
        Arc::new(Node::Series(series))
    }

    /// The least time for a turn, s.
    fn time(&self, module: usize, joint: usize, turn: f64) -> f64 {
        let kind = self.assembly.module_type(module);
        let limits = kind.joints.iter().find(|j| j.name == JOINTS[joint]).map(|j| j.limits);
        let limits = limits.unwrap_or_default();
        let steady = turn.abs() / limits.speed.unwrap_or(RATE_FREE);
        // A smooth motion's greatest acceleration is 10/√3 of the turn over the time squared.
        let from_rest =
            limits.acceleration.map_or(0.0, |a| libm::sqrt(10.0 / libm::sqrt(3.0) * turn.abs() / a));
        f64::max(SMOOTH_PEAK * steady, from_rest) * (1.0 + SPARE)
    }

    fn port(&self, dock: Dock) -> PortRef {
        let name = port_name(dock.module, dock.dock);
        let ports = &self.assembly.module_type(dock.module).ports;
        let port = ports.iter().position(|port| port.name == name).expect("the ports were found by name");
        PortRef { module: dock.module, port }
    }
}
