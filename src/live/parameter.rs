//! The parameters of a declaration and of its behaviours, as the text states their defaults.

use super::literal::{Written, literal};
use super::robot::{Place, place};
use crate::check::Type;
use crate::check::typed::{self, DefKind};
use crate::source::SourceFile;
use crate::syntax::ast;
use crate::units::Dimension;
use serde::Serialize;

/// A parameter with a default, of the shown declaration or of one of its behaviours.
#[derive(Clone, Debug, Serialize)]
pub struct Parameter {
    /// The behaviour that has the parameter; `None` for one of the declaration.
    pub behavior: Option<String>,
    /// The name of the parameter.
    pub name: String,
    /// The default, where it is a literal: a number in [`unit`](Self::unit), or a truth value as 0 or 1.
    pub value: Option<f64>,
    /// The unit that the default is written in; empty for a plain number.
    pub unit: String,
    /// True for whole numbers.
    pub whole: bool,
    /// True for truth values.
    pub truth: bool,
    /// The least value that a slider offers, in the unit.
    pub low: f64,
    /// The greatest value that a slider offers, in the unit.
    pub high: f64,
    /// The distance between values of a slider, in the unit.
    pub step: f64,
    /// The reason why the page can't change the default; `None` if it can.
    pub fixed: Option<String>,
    /// The place of the default in the text.
    pub place: Place,
    #[serde(skip)]
    pub(super) written: Option<Written>,
}

/// Returns the parameters of a declaration, and those of the behaviours of a configuration, that are numbers or truth values and
/// have a default. `item`: the declaration as it is written; `def`: as it was checked.
pub(super) fn parameters(item: &ast::ItemKind, def: &DefKind, file: &SourceFile) -> Vec<Parameter> {
    let (config, def) = match (item, def) {
        (ast::ItemKind::Config(config), DefKind::Config(def)) => (config, def),
        (ast::ItemKind::Lattice(lattice), DefKind::Lattice(def)) => {
            return listed(None, &lattice.params, &def.params, file);
        }
        (ast::ItemKind::Truss(truss), DefKind::Truss(def)) => {
            return listed(None, &truss.params, &def.params, file);
        }
        _ => return Vec::new(),
    };
    let mut all = listed(None, &config.params, &def.params, file);
    for clause in &config.clauses {
        let ast::ConfigClauseKind::Behavior(behavior) = &clause.kind else { continue };
        let checked = def.behaviors.iter().find(|known| known.span == behavior.name.span);
        let Some(checked) = checked else { continue };
        all.extend(listed(Some(behavior.name.text.as_str()), &behavior.params, &checked.params, file));
    }
    all
}

fn listed(
    behavior: Option<&str>,
    written: &[ast::Param],
    checked: &[typed::Param],
    file: &SourceFile,
) -> Vec<Parameter> {
    let pairs = written.iter().zip(checked).filter(|(written, checked)| written.name.text == checked.name);
    pairs.filter_map(|(written, checked)| parameter(behavior, written, &checked.ty, file)).collect()
}

/// Returns a parameter; `None` for one without a default or of a type that no slider has.
fn parameter(behavior: Option<&str>, param: &ast::Param, ty: &Type, file: &SourceFile) -> Option<Parameter> {
    let default = param.default.as_ref()?;
    let (whole, truth, angle) = match ty {
        Type::Int => (true, false, false),
        Type::Bool => (false, true, false),
        Type::Quantity(dimension) => (false, false, *dimension == Dimension::ANGLE),
        _ => return None,
    };
    let name = param.name.text.as_str();
    let written = literal(default, &file.text).filter(|written| matches!(written, Written::Bool(_)) == truth);
    let fixed = match written {
        Some(_) => None,
        None => {
            let shown = file.text.get(default.span.range()).unwrap_or_default();
            Some(format!("the default of `{name}` is worked out by `{shown}`; it is changed in the text"))
        }
    };
    let (value, unit, factor) = match &written {
        Some(Written::Number { value, unit, factor }) => (Some(*value), unit.clone(), *factor),
        Some(Written::Bool(value)) => (Some(f64::from(u8::from(*value))), String::new(), 1.0),
        None => (None, String::new(), 1.0),
    };
    let half_turn = angle.then(|| std::f64::consts::PI / factor);
    let (low, high, step) = range(value.unwrap_or(0.0), whole, half_turn);
    Some(Parameter {
        behavior: behavior.map(str::to_owned),
        name: name.to_owned(),
        value,
        unit,
        whole,
        truth,
        low,
        high,
        step,
        fixed,
        place: place(file, default.span),
        written,
    })
}

/// Returns the range of a slider with its step: whole numbers up to twice the value and ten at least, angles up to half a
/// turn (in the unit) to both sides, others up to twice the value.
fn range(value: f64, whole: bool, half_turn: Option<f64>) -> (f64, f64, f64) {
    let signed = |high: f64| if value < 0.0 { -high } else { 0.0 };
    if whole {
        let high = (2.0 * value.abs()).max(10.0);
        return (signed(high), high, 1.0);
    }
    if let Some(half) = half_turn {
        let half = half.max(value.abs());
        return (-half, half, round_step(half / 180.0));
    }
    let high = if value == 0.0 { 1.0 } else { 2.0 * value.abs() };
    (signed(high), high, round_step(high / 200.0))
}

/// Returns the power of ten at or below a positive number.
fn round_step(x: f64) -> f64 {
    libm::pow(10.0, libm::floor(libm::log10(x) + ROUNDING))
}

/// Makes up for the rounding of a logarithm of a power of ten.
const ROUNDING: f64 = 1e-9;
