//! Conversions between the planner's robot, assemblies of RoFI modules, and configurations of RoFI's files.

use super::refusal::NotRofi;
use super::robot::{Bond, DOCKS, Dock, Robot};
use super::tolerances::TOLERANCES;
use crate::robot::rofi;
use crate::robot::{Assembly, Kinematics, PortRef, State};

/// The names of the joints alpha, beta and gamma in the library's module, in the order of [`Robot::joints`].
pub const JOINTS: [&str; 3] = ["alpha", "beta", "gamma"];

/// Returns the configuration of a RoFI file, with joints in radians and all bonds closed; modules and bonds keep their
/// order. Docks of edges must name modules by their indices in the file, from 0.
pub fn from_world(world: &rofi::World) -> Robot {
    let dock = |dock: &rofi::Dock| {
        let index = (0..DOCKS).find(|&index| port_name(dock.module, index) == dock.port());
        Dock { module: dock.module, dock: index.expect("both name the docks of one module") }
    };
    Robot {
        joints: world.modules.iter().map(|m| m.joints.map(f64::to_radians)).collect(),
        bonds: world.edges.iter().map(|e| Bond { a: dock(&e.a), b: dock(&e.b), turn: e.turn }).collect(),
        holds: vec![true; world.edges.len()],
    }
}

/// Returns the configuration as a RoFI file states it, with joints in degrees, rounded to a billionth of one, and
/// without open bonds. The identifier of a module is its index, from 0, and all line numbers are 0.
pub fn to_world(robot: &Robot) -> rofi::World {
    let joints = |q: &[f64; 3]| q.map(|angle| libm::round(angle.to_degrees() * DEGREE_PARTS) / DEGREE_PARTS);
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

/// Parts of a degree to which joints are rounded in files, which hides the rounding of radians.
const DEGREE_PARTS: f64 = 1e9;

/// An assembly of RoFI modules with the planner's own model of the same robot.
pub(super) struct Translated<'a> {
    /// The assembly that was translated.
    pub(super) assembly: &'a Assembly,
    /// The indices in the assembly's joints of alpha, beta and gamma of each module, by module.
    pub(super) joints: Vec<[usize; 3]>,
    /// The planner's robot; its bonds are those of the assembly, in order.
    pub(super) robot: Robot,
}

/// Returns the planner's model of an assembly in a state, whose joint positions and closed bonds it takes.
///
/// # Errors
/// [`NotRofi`] for the first module that has other joints or ports than a RoFI module, or another pitch than the first.
pub(super) fn translated<'a>(assembly: &'a Assembly, state: &State) -> Result<Translated<'a>, NotRofi> {
    let kinematics = Kinematics::new(assembly, &state.bonds, assembly.base);
    let mut joints = Vec::with_capacity(assembly.modules.len());
    let mut pitch: Option<f64> = None;
    for module in 0..assembly.modules.len() {
        let kind = assembly.module_type(module);
        let position = |name: &&str| kind.joints.iter().position(|joint| joint.name == **name);
        let positions: Option<Vec<usize>> = JOINTS.iter().map(position).collect();
        let Some([alpha, beta, gamma]) = positions.as_deref() else { return Err(NotRofi::Kind(module)) };
        let docks = kind.ports.iter().filter(|port| rofi::Dock::of_port(module, &port.name).is_some());
        if docks.count() != DOCKS {
            return Err(NotRofi::Kind(module));
        }
        let own = 2.0 * kind.ports[0].pose.translation.vector.norm();
        if (own - *pitch.get_or_insert(own)).abs() > TOLERANCES.pitch * own {
            return Err(NotRofi::Pitch(module));
        }
        joints.push([*alpha, *beta, *gamma].map(|joint| kinematics.joint(module, joint)));
    }
    let dock = |port: PortRef| dock_of(assembly, port).ok_or(NotRofi::Kind(port.module));
    let mut bonds = Vec::with_capacity(assembly.bonds.len());
    for bond in &assembly.bonds {
        bonds.push(Bond { a: dock(bond.a)?, b: dock(bond.b)?, turn: bond.turn });
    }
    let positions = joints.iter().map(|joints| joints.map(|joint| state.joints[joint])).collect();
    let robot = Robot { joints: positions, bonds, holds: state.bonds.clone() };
    Ok(Translated { assembly, joints, robot })
}

/// Returns the dock that a port of the assembly is; `None` if it is none.
fn dock_of(assembly: &Assembly, port: PortRef) -> Option<Dock> {
    let name = &assembly.module_type(port.module).ports[port.port].name;
    (0..DOCKS)
        .find(|&dock| port_name(port.module, dock) == name)
        .map(|dock| Dock { module: port.module, dock })
}

/// Returns the name of a dock's port in the library's module, such as `a_plus_x`. `dock`: 0 to 5 as in [`Dock::dock`];
/// any other is a panic. The name does not depend on `module`.
pub fn port_name(module: usize, dock: usize) -> &'static str {
    let sides = [rofi::Side::A, rofi::Side::B];
    let faces = [rofi::Face::PlusX, rofi::Face::MinusX, rofi::Face::MinusZ];
    rofi::Dock { module, side: sides[dock / faces.len()], face: faces[dock % faces.len()] }.port()
}
