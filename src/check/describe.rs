//! Types in words and as they are written, for messages.

use super::checker::Checker;
use super::typed::{DefId, Program};
use super::types::Type;
use crate::source::Symbol;
use crate::units::{Dimension, base_units, usual_unit};

/// Returns the noun phrase for a quantity of a dimension in messages, such as `an angular speed`.
pub(super) fn dimension_words(d: Dimension) -> String {
    let words = match d.name() {
        Some("Number") => "a number",
        Some("Length") => "a length",
        Some("Angle") => "an angle",
        Some("Time") => "a time",
        Some("Mass") => "a mass",
        Some("Speed") => "a speed",
        Some("AngularSpeed") => "an angular speed",
        Some("Acceleration") => "an acceleration",
        Some("AngularAcceleration") => "an angular acceleration",
        Some("Force") => "a force",
        Some("Torque") => "a torque or energy",
        Some("Energy") => "an energy",
        Some("Power") => "a power",
        Some("Area") => "an area",
        Some("Volume") => "a volume",
        Some("Frequency") => "a frequency",
        _ => return format!("a quantity in {}", base_units(d)),
    };
    words.to_string()
}

/// Returns the noun phrase for a quantity of a dimension with the usual unit, such as `an angular speed (rad/s)`.
pub(super) fn dimension_with_unit(d: Dimension) -> String {
    let unit = usual_unit(d);
    let words = dimension_words(d);
    if unit.is_empty() || d.name().is_none() { words } else { format!("{words} ({unit})") }
}

impl Checker<'_> {
    /// Returns the noun phrase for a value of a type in messages: `an angle`, `a list of lengths`, ``a `Smores` ``.
    pub(super) fn words(&self, ty: &Type) -> String {
        match ty {
            Type::Quantity(d) => dimension_words(*d),
            Type::Int => "a whole number".into(),
            Type::Bool => "true or false".into(),
            Type::Nothing => "nothing".into(),
            Type::Optional(inner) => format!("{}, or nothing", self.words(inner)),
            Type::Choice(choice) => {
                let words = choice.words.iter().map(|w| format!("`{w}`"));
                let types = choice.types.iter().map(|t| self.words(t));
                words.chain(types).collect::<Vec<_>>().join(" or ")
            }
            Type::Error => "something unknown".into(),
            Type::Instance(id) => format!("a `{}`", self.def(*id).name),
            _ => format!("a `{}`", self.name(ty)),
        }
    }

    /// Returns a type as programs write it, such as `List<Length>`.
    pub(super) fn name(&self, ty: &Type) -> String {
        type_name(ty, &|id| self.def(id).name, &[])
    }
}

impl Program {
    /// Returns a type as programs write it, such as `List<Length>`; `?` for [`Type::Error`], `nothing` for no value.
    pub fn type_name(&self, ty: &Type) -> String {
        type_name(ty, &|id| self.def(id).name, &[])
    }

    /// Returns a type as [`type_name`](Self::type_name) does, with the type parameters by their names in `params`, in
    /// order: `Signal<Quantity<D/s>>`. `ty`: the type, which may have type parameters.
    pub fn type_name_with(&self, ty: &Type, params: &[Symbol]) -> String {
        type_name(ty, &|id| self.def(id).name, params)
    }
}

/// Returns a type as it is written; `def_name` gives the names of declarations, and `params` holds those of the type
/// parameters that it may mention, in order. Parameters without a name are described in words.
fn type_name(ty: &Type, def_name: &dyn Fn(DefId) -> Symbol, params: &[Symbol]) -> String {
    let name = |ty: &Type| type_name(ty, def_name, params);
    let args = |outer: &str, t: &Type| format!("{outer}<{}>", name(t));
    match ty {
        Type::Error => "?".into(),
        Type::Nothing => "nothing".into(),
        Type::Any => "Any".into(),
        Type::Quantity(d) => match d.name() {
            Some(name) => name.into(),
            None => format!("Quantity<{}>", base_units(*d)),
        },
        Type::Int => "Int".into(),
        Type::Bool => "Bool".into(),
        Type::Text => "Text".into(),
        Type::List(t) => args("List", t),
        Type::Vec3(t) => args("Vec3", t),
        Type::Pose => "Pose".into(),
        Type::Range(t) => args("Range", t),
        Type::Optional(t) => format!("{}?", name(t)),
        Type::Fn(f) => {
            let params: Vec<String> = f.params.iter().map(&name).collect();
            format!("fn({}) -> {}", params.join(", "), name(&f.result))
        }
        Type::Choice(choice) => {
            let words = choice.words.iter().map(|w| w.to_string());
            words.chain(choice.types.iter().map(name)).collect::<Vec<_>>().join(" | ")
        }
        Type::Joint(t) => args("Joint", t),
        Type::Port => "Port".into(),
        Type::Behavior => "Behavior".into(),
        Type::Signal(t) => args("Signal", t),
        Type::Study(t) => args("Study", t),
        Type::Condition => "Condition".into(),
        Type::Shape => "Shape".into(),
        Type::JointKind => "JointKind".into(),
        Type::Cells => "Cells".into(),
        Type::Mesh => "Mesh".into(),
        Type::Cloud => "Cloud".into(),
        Type::Terrain => "Terrain".into(),
        Type::Instance(id) | Type::Record(id) => def_name(*id).to_string(),
        Type::AnyOf(family) => family.name().into(),
        Type::Opaque(_, name) => name.to_string(),
        Type::Param(i) => params.get(usize::from(*i)).map_or("any type".into(), Symbol::to_string),
        Type::QuantityParam { param, power, times } => {
            let named = params.get(usize::from(*param));
            let units = named.and_then(|param| param_units(*param, *power, *times));
            units.map_or("Quantity".into(), |units| format!("Quantity<{units}>"))
        }
    }
}

/// Returns a power of a dimension parameter times a dimension in base units: `D`, `D^2`, `D/s`; `None` where an
/// exponent is too large.
fn param_units(param: Symbol, power: i8, times: Dimension) -> Option<String> {
    let whole = Dimension::PARAM.power(i64::from(power))?.times(times)?;
    // No unit has a capital D in it.
    Some(base_units(whole).replacen('D', param.as_str(), 1))
}
