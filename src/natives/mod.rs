//! The bodies of the built-ins: the only bridge between the front end (the language) and the back end
//! (robotics).
//!
//! A built-in is declared in `stdlib/prelude.mod`; the file of its subject here lists it with its parameters
//! and supplies the body. A native reads its arguments by name, calls the back end, and turns a refusal into
//! a diagnostic. Nothing counts parameters, and their order here means nothing.
//!
//! - Few arguments: `Native::pure("join", parameters![list: &[Value], with: &str], join)`, and in the body
//!   `call.get::<&str>("with")?`. The type that is read is the one in the list.
//! - Many arguments: `arguments! { struct SqueezeArguments<'c> { .. } }` declares a field for each parameter;
//!   `SqueezeArguments::PARAMETERS` goes into the table, `SqueezeArguments::read(call)?` reads them all.
//! - Parameters that several natives have: an `arguments!` struct of their own, which each of the others takes in
//!   with `..search: SearchArguments`.
//! - A choice of words is an enum that implements [`Choice`](crate::interpret::argument::Choice): its words
//!   stand there and in the declaration, nowhere else.
//! - `T?` without a default is an `Option`; `auto | Int` is a `WordOr<Auto, usize>`, and `auto | three | all` a `WordOr<Auto, Hold>`;
//!   a parameter of several types is a `&Value`.
//! - The report of a planner beside its plan is a record: `impl ReportFields for Report` holds one table from
//!   field to reader. Other records of a native implement `NativeRecord`.
//!
//! A test compares names, types, what may be missing, words and fields with the declarations. A file of
//! natives has one line in `SUBJECTS`.

mod action;
mod embed;
mod family;
mod fastest;
mod fold;
mod fold_design;
mod fold_refusal;
pub mod fold_sheet;
mod fold_supply;
mod fold_surface;
pub mod folding;
mod goals;
mod list;
mod math;
mod measured;
mod mesh_file;
mod one_robot;
mod plan;
pub mod plot;
pub mod reconfigure;
pub mod refold;
mod robot;
mod rofi;
mod save;
mod save_table;
mod sequence;
mod series;
mod shape;
mod show;
mod simulate;
pub mod squeeze;
mod study;
pub mod tosnake;
pub mod truss;
mod truss_limits;
mod truss_steps;
mod unwind;
mod waypoints;

pub use embed::capabilities;

use crate::interpret::design::Design;
use crate::interpret::fields::fields;
use crate::interpret::interpreter::Interpreter;
pub use crate::interpret::native::Native;
use crate::interpret::plan_value::ReportFields;
use crate::interpret::stop::Eval;
use crate::plan::Plan;
use crate::source::{Span, Symbol};
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::LazyLock;

/// The natives of one file, with the records that it defines and the names of their fields.
struct Subject {
    natives: &'static [Native],
    records: fn() -> Vec<(&'static str, Vec<&'static str>)>,
}

/// Returns a subject that defines no records.
const fn natives(natives: &'static [Native]) -> Subject {
    Subject { natives, records: Vec::new }
}

/// The natives of all files: one entry for each.
const SUBJECTS: &[Subject] = &[
    natives(math::TABLE),
    natives(list::TABLE),
    natives(sequence::TABLE),
    natives(shape::TABLE),
    natives(family::TABLE),
    natives(robot::TABLE),
    natives(embed::TABLE),
    natives(waypoints::TABLE),
    natives(action::TABLE),
    natives(goals::TABLE),
    natives(plan::TABLE),
    natives(one_robot::TABLE),
    natives(fastest::TABLE),
    natives(show::TABLE),
    Subject { natives: simulate::TABLE, records: simulate::records },
    natives(measured::TABLE),
    natives(save::TABLE),
    Subject { natives: series::TABLE, records: series::records },
    natives(study::TABLE),
    Subject { natives: plot::TABLE, records: plot::records },
    natives(rofi::TABLE),
    Subject { natives: fold::TABLE, records: folding::records },
    Subject {
        natives: fold_sheet::TABLE,
        records: || vec![("SheetFolding", <crate::planners::fold_sheet::Report as ReportFields>::names())],
    },
    Subject {
        natives: refold::TABLE,
        records: || vec![("Refolding", <crate::planners::refold::Report as ReportFields>::names())],
    },
    Subject {
        natives: squeeze::TABLE,
        records: || vec![("Squeezing", crate::planners::squeeze::Report::names())],
    },
    Subject {
        natives: tosnake::TABLE,
        records: || vec![("Unwinding", <crate::planners::tosnake::Report as ReportFields>::names())],
    },
    Subject {
        natives: reconfigure::TABLE,
        records: || {
            vec![("Reconfiguration", <crate::planners::reconfigure::Report as ReportFields>::names())]
        },
    },
    Subject { natives: truss::TABLE, records: truss::records },
    natives(truss_steps::TABLE),
];

/// Returns all built-ins, file by file, each once.
pub fn all() -> impl Iterator<Item = &'static Native> {
    SUBJECTS.iter().flat_map(|subject| subject.natives)
}

/// Returns the names of the fields of a record type that a built-in defines in Rust, in order; `None` if none defines
/// it. A test compares them with the declaration.
pub fn fields_of(record: &str) -> Option<Vec<&'static str>> {
    let all = SUBJECTS.iter().flat_map(|subject| (subject.records)()).chain(fields());
    all.into_iter().find(|(name, _)| *name == record).map(|(_, fields)| fields)
}

/// Draws every configuration, lattice and truss of the project's own files, with its defaults, each as an HTML page
/// named after it. Faults are reported.
///
/// # Errors
/// `Stop::Halt` if a limit is reached or the user cancels.
pub fn draw_declared(interpreter: &mut Interpreter) -> Eval<()> {
    interpreter.draw_declarations()
}

/// Returns a configuration, lattice or truss as it is declared: a plan in which nothing moves, and that is not judged. `None`
/// for another design, and for what is broken. `at`: the code that asks for it.
///
/// # Errors
/// A fault at `at` for a configuration without modules, a fault of a declaration that the robot needs, or `Stop::Halt` if a
/// limit is reached or the user cancels.
pub fn as_declared(interpreter: &mut Interpreter, design: &Rc<Design>, at: Span) -> Eval<Option<Plan>> {
    interpreter.as_declared(design, at)
}

static BY_KEY: LazyLock<HashMap<Symbol, &'static Native>> =
    LazyLock::new(|| all().map(|native| (Symbol::new(native.key), native)).collect());

/// Returns the built-in of a key, such as `move` or `Plan.at`; `None` if there is none.
pub fn find(key: Symbol) -> Option<&'static Native> {
    BY_KEY.get(&key).copied()
}
