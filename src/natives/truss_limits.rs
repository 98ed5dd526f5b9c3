//! The limits that a call of `morph` or `locomote` sets beside those of the struts.

use crate::interpret::design::TrussDesign;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::planners::truss::Limits;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, code};

/// Where the parameters are: `angle`, `rigidity`, `failed`, `perimeters`, in this order.
pub fn limits(call: &Call, first: usize, truss: &TrussDesign) -> Eval<Limits> {
    let mut loops = Vec::new();
    for list in call.list(first + 3)?.iter() {
        let Value::List(list) = list else {
            return Err(call.refuse(first + 3, "lists of struts are wanted here"));
        };
        loops.push(struts(call, first + 3, list, truss)?);
    }
    Ok(Limits {
        angle: call.number(first)?,
        rigidity: call.number(first + 1)?,
        locked: struts(call, first + 2, call.list(first + 2)?, truss)?,
        loops,
    })
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
