//! The bodies of the built-ins: the only bridge between the wings.
//!
//! What a built-in is called, takes and gives is declared in `stdlib/prelude.mod`; a test fails
//! where that and these tables disagree.

use super::call::Call;
use super::interpreter::Interpreter;
use super::stop::Eval;
use super::value::Value;
use super::{
    natives_action, natives_family, natives_fold, natives_list, natives_math, natives_plan, natives_refold,
    natives_robot, natives_rofi, natives_save, natives_shape, natives_show, natives_squeeze, natives_tosnake,
    natives_truss,
};
use crate::source::Symbol;
use std::collections::HashMap;
use std::sync::LazyLock;

pub use natives_action::with_otherwise;

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
        natives_math::TABLE,
        natives_list::TABLE,
        natives_refold::TABLE,
        natives_rofi::TABLE,
        natives_save::TABLE,
        natives_shape::TABLE,
        natives_family::TABLE,
        natives_robot::TABLE,
        natives_action::TABLE,
        natives_plan::TABLE,
        natives_squeeze::TABLE,
        natives_tosnake::TABLE,
        natives_truss::TABLE,
        natives_fold::TABLE,
        natives_show::TABLE,
    ];
    tables.into_iter().flatten()
}

static BY_KEY: LazyLock<HashMap<Symbol, &'static Native>> =
    LazyLock::new(|| all().map(|native| (Symbol::new(native.key), native)).collect());

pub fn find(key: Symbol) -> Option<&'static Native> {
    BY_KEY.get(&key).copied()
}
