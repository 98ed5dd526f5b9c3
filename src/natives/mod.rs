//! The bodies of the built-ins: the only bridge between the wings.
//!
//! What a built-in is called, takes and gives is declared in `stdlib/prelude.mod`; a test fails
//! where that and these tables disagree.

mod action;
mod family;
mod fold;
mod fold_design;
mod fold_refusal;
mod fold_supply;
mod fold_surface;
pub mod folding;
mod list;
mod math;
mod plan;
pub mod refold;
mod robot;
mod rofi;
mod save;
mod shape;
mod show;
pub mod squeeze;
pub mod tosnake;
pub mod truss;
mod truss_around;
mod truss_limits;

use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::source::Symbol;
use std::collections::HashMap;
use std::sync::LazyLock;

pub use action::with_otherwise;

/// When a built-in does its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Whenever it is called.
    None,
    /// Only when the program is run: `modl check` evaluates its arguments and no more.
    OnRun,
}

pub struct Native {
    /// `move`, or `Plan.at` for a method, which takes its object first.
    pub key: &'static str,
    pub params: usize,
    pub effect: Effect,
    pub body: fn(&mut Interpreter, &Call) -> Eval<Value>,
}

/// A built-in that does its work whenever it is called.
pub const fn pure(
    key: &'static str,
    params: usize,
    body: fn(&mut Interpreter, &Call) -> Eval<Value>,
) -> Native {
    Native { key, params, effect: Effect::None, body }
}

/// A built-in that only a run carries out.
pub const fn on_run(
    key: &'static str,
    params: usize,
    body: fn(&mut Interpreter, &Call) -> Eval<Value>,
) -> Native {
    Native { key, params, effect: Effect::OnRun, body }
}

/// All built-ins, one table a subject.
pub fn all() -> impl Iterator<Item = &'static Native> {
    let tables: [&'static [Native]; 15] = [
        math::TABLE,
        list::TABLE,
        refold::TABLE,
        rofi::TABLE,
        save::TABLE,
        shape::TABLE,
        family::TABLE,
        robot::TABLE,
        action::TABLE,
        plan::TABLE,
        squeeze::TABLE,
        tosnake::TABLE,
        truss::TABLE,
        fold::TABLE,
        show::TABLE,
    ];
    tables.into_iter().flatten()
}

static BY_KEY: LazyLock<HashMap<Symbol, &'static Native>> =
    LazyLock::new(|| all().map(|native| (Symbol::new(native.key), native)).collect());

pub fn find(key: Symbol) -> Option<&'static Native> {
    BY_KEY.get(&key).copied()
}
