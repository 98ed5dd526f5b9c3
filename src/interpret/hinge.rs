//! Joints that live in connections: the hinges of connectors such as Mori's edges.

use super::design::Design;
use super::interpreter::Interpreter;
use super::stop::Eval;
use super::value::{JointValue, PortValue, Value};
use crate::robot::{Hinge, JointOwner};
use crate::source::{Diagnostic, Span, code};
use crate::units::Dimension;
use std::rc::Rc;

impl Interpreter<'_> {
    /// The joint of the connection at a port, from whichever of its two sides it is named.
    pub fn hinge_of(&mut self, port: &PortValue, span: Span) -> Eval<Value> {
        let at = (port.module, port.port);
        let bond = port.robot.config().and_then(|config| config.taken.borrow().get(&at).copied());
        let no_hinge = |label: &str| {
            let message = format!("there is no joint at {}", port.name());
            Diagnostic::error(code::NO_HINGE, message).label(span, label)
        };
        let Some(bond) = bond else {
            let hint = "a hinge belongs to a connection that `connect` made";
            return Err(no_hinge("nothing is connected here").hint(hint).into());
        };
        // The hinge is that of the first port's connector, as in an assembly.
        let first = port.robot.bonds()[bond].a;
        if self.hinge_at(&port.robot, first)?.is_none() {
            let made = self.connector_name(&port.robot, first);
            let d = no_hinge(&format!("connections of {made} do not turn"));
            return Err(d.hint(format!("`hinge(...)` in `connector {made}` makes a joint of each")).into());
        }
        let owner = JointOwner::Bond(bond);
        Ok(Value::Joint(JointValue { robot: port.robot.clone(), owner, dimension: Dimension::ANGLE }))
    }

    /// The hinge of the connector at a port: module and index of the port.
    pub fn hinge_at(&mut self, robot: &Rc<Design>, (module, port): (usize, usize)) -> Eval<Option<Hinge>> {
        let design = robot.module_at(module);
        let module = design.module().expect("only modules are listed");
        let def = module.connectors[module.module.ports[port].connector];
        Ok(self.connector(def)?.and_then(|connector| connector.connector.hinge.clone()))
    }

    fn connector_name(&self, robot: &Rc<Design>, (module, port): (usize, usize)) -> String {
        let design = robot.module_at(module);
        let module = design.module().expect("only modules are listed");
        self.name(module.connectors[module.module.ports[port].connector]).to_string()
    }
}
