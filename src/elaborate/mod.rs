//! Declarations to designs and robots.
//!
//! A declaration with its arguments is elaborated once to a design (`instance`): modules with their links,
//! joints and ports (`module`), configurations of modules (`config`, `connect`), lattices of cells
//! (`lattice`, `facts`), trusses (`truss`). The back end (robotics) gets them as robots
//! (`robot_of`).

mod check;
mod config;
mod connect;
mod connector;
mod facts;
mod hinge;
mod instance;
mod lattice;
mod module;
mod robot_of;
mod scene;
mod sweep;
mod thickness;
mod tolerances;
mod truss;

pub(crate) use config::outside;
pub(crate) use connect::free_ports;
pub(crate) use module::{default_up, port_rotation};

use crate::check::typed::DefId;
use crate::interpret::design::{Design, DesignKind};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::robot::Robot;
use crate::interpret::routines::Args;
use crate::interpret::stop::Eval;
use crate::interpret::value::{PortValue, Value};
use crate::robot::Library;
use crate::source::Span;
use std::rc::Rc;

/// Returns an instance of a declaration with these arguments; [`Value::Unknown`] where it is broken or an argument is
/// unknown. `def`: the declaration; `args`: its arguments in the order of the parameters; `interpreter`: the run.
///
/// # Errors
/// A fault at `span` where the declaration needs itself, or `Stop::Halt` if a limit is reached or the user cancels.
pub fn instantiate(interpreter: &mut Interpreter, def: DefId, args: Args, span: Span) -> Eval<Value> {
    interpreter.make_instance(def, args, span)
}

/// Returns the library of a declaration with its defaults: its module types with their connectors, its cell, or its
/// strut. `None` where it is broken, a parameter has no default, or it declares none of these. `def`: the
/// declaration; `interpreter`: the run, which elaborates it.
///
/// # Errors
/// A fault of a declaration that it needs, or `Stop::Halt` if a limit is reached or the user cancels.
pub fn library_of(interpreter: &mut Interpreter, def: DefId) -> Eval<Option<Library>> {
    let Some(design) = interpreter.default_design(def)?.filter(|design| !design.broken.get()) else {
        return Ok(None);
    };
    match &design.kind {
        DesignKind::Module(_) | DesignKind::Config(_) => {
            Ok(interpreter.library_of(&design)?.map(|(library, _)| library))
        }
        _ => Ok(design.library_of_element()),
    }
}

/// Returns the robot of a design, assembled once; `None` where the design is broken, not complete yet, or no robot.
/// `span`: the code that asks for it. `interpreter`: the run, which keeps the robot.
///
/// # Errors
/// A fault at `span` for a configuration without modules, a fault of a declaration that the robot needs, or
/// `Stop::Halt` if a limit is reached or the user cancels.
pub fn robot_of(interpreter: &mut Interpreter, design: &Rc<Design>, span: Span) -> Eval<Option<Rc<Robot>>> {
    interpreter.assemble_robot(design, span)
}

/// Returns the joint of the connection at a port, from either of its sides; [`Value::Unknown`] where its connector is
/// broken. `interpreter`: the run that the port belongs to.
///
/// # Errors
/// A fault at `span` where nothing is connected there, or the connector has no hinge.
pub fn hinge_of(interpreter: &mut Interpreter, port: &PortValue, span: Span) -> Eval<Value> {
    interpreter.find_hinge(port, span)
}

/// Elaborates a declaration with its defaults, evaluates all that its body declares, and warns of links that overlap
/// or are too thin. A `let` is evaluated. `def`: the declaration; `interpreter`: the run.
///
/// # Errors
/// `Stop::Halt` if a limit is reached or the user cancels; faults are reported.
pub fn check_declaration(interpreter: &mut Interpreter, def: DefId) -> Eval<()> {
    interpreter.elaborate_with_defaults(def)
}
