//! Joints that live in connections: the hinges of connectors such as Mori's edges.

use crate::interpret::design::ConnectorDesign;
use crate::interpret::design::{Design, Subject};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::interpret::value::{JointValue, PortValue, Value};
use crate::robot::{JointOwner, Limits};
use crate::source::{Diagnostic, Span, code};
use crate::units::Dimension;
use std::rc::Rc;

impl Interpreter<'_> {
    /// Returns the joint of the connection at a port, from either of its two sides; [`Value::Unknown`] where its
    /// connector is broken.
    ///
    /// # Errors
    /// A fault at `span` where nothing is connected there, or the connector has no hinge.
    pub(super) fn find_hinge(&mut self, port: &PortValue, span: Span) -> Eval<Value> {
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
        let Some(connector) = self.connector_of(&port.robot, bond)? else { return Ok(Value::Unknown) };
        if connector.connector.hinge.is_none() {
            let made = &connector.connector.name;
            let d = no_hinge(&format!("connections of {made} do not turn"));
            return Err(d.hint(format!("`hinge(...)` in `connector {made}` makes a joint of each")).into());
        }
        let owner = JointOwner::Bond(bond);
        Ok(Value::Joint(JointValue { robot: port.robot.clone(), owner, dimension: Dimension::ANGLE }))
    }

    /// Returns the limits of the joint that the bond of this index (from 0) of a robot makes, in rad, rad/s, rad/s² and
    /// N·m; no limits where its connector is broken or has no hinge.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while the connector is elaborated.
    pub(super) fn hinge_limits(&mut self, robot: &Rc<Design>, bond: usize) -> Eval<Limits> {
        let connector = self.connector_of(robot, bond)?;
        let hinge = connector.and_then(|connector| connector.connector.hinge.as_ref().map(|h| h.limits));
        Ok(hinge.unwrap_or_default())
    }

    /// Returns the connector whose hinge a connection has: that of its first port, as in an assembly. `None`
    /// where it is broken.
    fn connector_of(&mut self, robot: &Rc<Design>, bond: usize) -> Eval<Option<Rc<ConnectorDesign>>> {
        let (module, port) = robot.bond(bond).a;
        self.connector_at(&PortValue { robot: Subject::new(robot.clone()), module, port })
    }
}
