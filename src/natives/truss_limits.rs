//! The limits that a call of `morph` or `locomote` sets beside those of the struts: what they are in the
//! program, for the planner and in the plan.

use crate::elaborate::truss::TrussDesign;
use crate::interpret::call::Call;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::plan::{LengthSum, TrussLimits};
use crate::planners::truss::{Limits, Loop, Structure};
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, code};
use std::f64::consts::FRAC_PI_3;

/// A larger truss takes minutes for its singular values.
const RIGIDITY_NODES_MAX: usize = 200;
/// Three struts that make a triangle can't all be farther apart in angle.
const ANGLE_MAX: f64 = FRAC_PI_3;

/// Where the parameters are: `angle`, `rigidity`, `failed`, `perimeters`, in this order.
pub fn of(call: &Call, first: usize, truss: &TrussDesign) -> Eval<Limits> {
    let angle = call.number(first)?;
    if !(0.0..ANGLE_MAX).contains(&angle) {
        return Err(call.refuse(first, "an angle between struts is at least 0 and less than 60deg"));
    }
    let rigidity = call.number(first + 1)?;
    if rigidity.is_nan() || rigidity < 0.0 {
        return Err(call.refuse(first + 1, "a singular value is not negative"));
    }
    if rigidity > 0.0 && truss.nodes.len() > RIGIDITY_NODES_MAX {
        let message = format!(
            "the singular values of a truss of more than {RIGIDITY_NODES_MAX} nodes take too long; this one has {}",
            truss.nodes.len()
        );
        return Err(call.refuse(first + 1, message));
    }
    let still = struts(call, first + 2, call.list(first + 2)?, truss)?;
    let mut loops = Vec::new();
    for list in call.list(first + 3)?.iter() {
        let Value::List(list) = list else {
            return Err(call.refuse(first + 3, "lists of struts are wanted here"));
        };
        let struts = struts(call, first + 3, list, truss)?;
        if struts.len() < 2 {
            return Err(call.refuse(first + 3, "a perimeter has at least two struts"));
        }
        loops.push(Loop { struts, range: (0.0, 0.0) });
    }
    Ok(Limits { angle, rigidity, still, loops })
}

/// Struts by their names, `a -- b` or the other way round.
fn struts(call: &Call, index: usize, names: &[Value], truss: &TrussDesign) -> Eval<Vec<usize>> {
    let known: Vec<String> = (0..truss.struts.len()).map(|strut| truss.strut_name(strut)).collect();
    let mut found = Vec::new();
    for name in names {
        let Value::Text(name) = name else {
            return Err(call.refuse(index, "names of struts are wanted here"));
        };
        let turned = name.split_once(" -- ").map(|(a, b)| format!("{b} -- {a}"));
        let same = |other: &String| **other == **name || turned.as_ref() == Some(other);
        let Some(strut) = known.iter().position(same) else {
            return Err(no_strut(call, index, name, &known));
        };
        if found.contains(&strut) {
            return Err(call.refuse(index, format!("the strut {name} is there twice")));
        }
        found.push(strut);
    }
    Ok(found)
}

fn no_strut(call: &Call, index: usize, name: &str, known: &[String]) -> Stop {
    let diagnostic = Diagnostic::error(code::BAD_VALUE, format!("the truss has no strut `{name}`"))
        .label(call.at(index), "not a strut of it");
    let example = known.first().map_or("a -- b", String::as_str);
    let hint = match suggest(name, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("struts are named by their nodes, as in `{example}`"),
    };
    diagnostic.hint(hint).into()
}

/// The same in the plan.
pub fn planned(structure: &Structure) -> TrussLimits {
    let still = structure.limits.still.iter().map(|&strut| (vec![strut], structure.lengths[strut]));
    let loops = structure.limits.loops.iter().map(|around| (around.struts.clone(), around.range));
    TrussLimits {
        angle: structure.limits.angle,
        rigidity: structure.limits.rigidity,
        sums: still.chain(loops).map(|(struts, range)| LengthSum { struts, range }).collect(),
    }
}
