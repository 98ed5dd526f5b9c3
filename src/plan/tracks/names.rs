//! The names of what indices stand for in a robot, as plan files state them beside the indices.

use super::validation;
use crate::robot::validation::check_references;
use crate::robot::{Assembly, JointId, PortRef};

/// The names of the modules, joints, ports and bonds of an assembly. An index that points nowhere has the empty
/// name; so has every index where the assembly itself is not well formed.
pub(in crate::plan) struct RobotNames<'a> {
    robot: Option<&'a Assembly>,
    joints: Vec<String>,
}

impl<'a> RobotNames<'a> {
    /// Returns the names of an assembly, all empty if it is not well formed.
    pub(in crate::plan) fn of(robot: &'a Assembly) -> RobotNames<'a> {
        let well_formed = check_references(&robot.library).is_ok() && validation::robot(robot).is_ok();
        let robot = Some(robot).filter(|_| well_formed);
        let joints = robot.map_or_else(Vec::new, |robot| {
            robot.joints().map(|owner| robot.joint_name(owner)).collect::<Vec<_>>()
        });
        RobotNames { robot, joints }
    }

    /// Returns the path names of all joints, by the number in their `JointId`.
    pub(in crate::plan) fn joints(&self) -> &[String] {
        &self.joints
    }

    /// Returns the path name of a joint; empty if there is none.
    pub(in crate::plan) fn joint(&self, joint: JointId) -> String {
        self.joints.get(joint.0 as usize).cloned().unwrap_or_default()
    }

    /// Returns the path name of a module, by its index in the assembly; empty if there is none.
    pub(in crate::plan) fn module(&self, module: usize) -> String {
        let module = self.robot.and_then(|robot| robot.modules.get(module));
        module.map_or_else(String::new, |module| module.name.clone())
    }

    /// Returns the name of the type of a module, by the module's index in the assembly; empty if there is none.
    pub(in crate::plan) fn module_type(&self, module: usize) -> String {
        let robot = self.robot.filter(|robot| module < robot.modules.len());
        robot.map_or_else(String::new, |robot| robot.module_type(module).name.clone())
    }

    /// Returns the path name of a port; empty if there is none.
    pub(in crate::plan) fn port(&self, port: PortRef) -> String {
        let known = |robot: &&Assembly| {
            port.module < robot.modules.len() && port.port < robot.module_type(port.module).ports.len()
        };
        self.robot.filter(known).map_or_else(String::new, |robot| robot.port_name(port))
    }

    /// Returns the path names of the two ports, `a` then `b`, of the bond of an index; empty if there is none.
    pub(in crate::plan) fn ends(&self, bond: usize) -> [String; 2] {
        let bond = self.robot.and_then(|robot| robot.bonds.get(bond));
        bond.map_or_else(Default::default, |bond| [self.port(bond.a), self.port(bond.b)])
    }

    /// Returns the name of a bond, by its index: those of its two ports, `a -- b`, which also is the name of its
    /// hinge; the names of an index that points nowhere are empty.
    pub(in crate::plan) fn bond(&self, bond: usize) -> String {
        self.ends(bond).join(" -- ")
    }
}
