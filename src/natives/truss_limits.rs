//! The limits that a call of `morph` or `locomote` sets beside those of the struts, and the obstacles it names.

use crate::geometry::Vec3;
use crate::interpret::argument::{Auto, WordOr, arguments};
use crate::interpret::design::TrussDesign;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::planners::truss::{Limits, rigidity_kept};
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, code};

arguments! {
    /// The values of the arguments about limits of a truss's shape, which `morph` and `locomote` share.
    pub(super) struct LimitArguments<'c> {
        angle: f64,
        rigidity: WordOr<Auto, f64>,
        failed: &'c [Value],
        perimeters: &'c [Value],
        obstacles: &'c [Value],
    }
}

/// Returns the limits of a truss's shape that the arguments state, with struts by their indices in the truss.
///
/// # Errors
/// A fault where the truss has no strut of a name, or a strut is named twice.
pub(super) fn limits(call: &Call, truss: &TrussDesign, arguments: &LimitArguments) -> Eval<Limits> {
    let nodes: Vec<Vec3> = truss.nodes.iter().map(|node| node.position).collect();
    let mut loops = Vec::new();
    for list in arguments.perimeters {
        let Value::List(list) = list else {
            return Err(call.refuse("perimeters", "lists of struts are wanted here"));
        };
        loops.push(struts(call, "perimeters", list, truss)?);
    }
    Ok(Limits {
        angle: arguments.angle,
        rigidity: match arguments.rigidity {
            WordOr::Value(rigidity) => rigidity,
            WordOr::Word(Auto) => rigidity_kept(&nodes, &truss.struts),
        },
        forces: None,
        locked: struts(call, "failed", arguments.failed, truss)?,
        loops,
    })
}

/// Returns the indices of struts by their names, `a -- b` or `b -- a`.
///
/// # Errors
/// A fault where the truss has no strut of a name, or a strut is named twice.
fn struts(call: &Call, parameter: &'static str, names: &[Value], truss: &TrussDesign) -> Eval<Vec<usize>> {
    let known: Vec<String> = (0..truss.struts.len()).map(|strut| truss.strut_name(strut)).collect();
    let mut found = Vec::new();
    for name in names {
        let Value::Text(name) = name else {
            return Err(call.refuse(parameter, "names of struts are wanted here"));
        };
        let turned = name.split_once(" -- ").map(|(a, b)| format!("{b} -- {a}"));
        let same = |other: &String| **other == **name || turned.as_ref() == Some(other);
        let Some(strut) = known.iter().position(same) else {
            return Err(no_strut(call, parameter, name, &known));
        };
        if found.contains(&strut) {
            return Err(call.refuse(parameter, format!("the strut {name} is there twice")));
        }
        found.push(strut);
    }
    Ok(found)
}

/// Returns the fault of a name that is not that of a strut, at the argument that it stands in; `known`: the names of all.
pub(super) fn no_strut(call: &Call, parameter: &'static str, name: &str, known: &[String]) -> Stop {
    let diagnostic = Diagnostic::error(code::BAD_VALUE, format!("the truss has no strut `{name}`"))
        .label(call.at(parameter), "not a strut of it");
    let example = known.first().map_or("a -- b", String::as_str);
    let hint = match suggest(name, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("struts are named by their nodes, as in `{example}`"),
    };
    diagnostic.hint(hint).into()
}
