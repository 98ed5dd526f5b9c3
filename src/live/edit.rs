//! Changes that are made in the picture, as changes of the text: each replaces or adds the bytes of one node, or of the two that
//! dock a module.

use super::joint::Joint;
use super::literal::{FINEST, Written, literal, number, rounded};
use super::model::Model;
use super::parameter::Parameter;
use super::robot::config_of;
use crate::source::Span;
use crate::syntax::ast::{Config, ConfigClause, ConfigClauseKind, ItemKind};
use crate::units;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::ops::Range;

/// A change that is asked for. `robot`: the name of the declaration whose text is changed.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "edit", rename_all = "snake_case", deny_unknown_fields)]
pub enum Edit {
    /// Another default of a parameter.
    Parameter {
        /// The configuration, lattice or truss.
        robot: String,
        /// The behaviour that has the parameter; `None` for one of the declaration.
        behavior: Option<String>,
        /// The name of the parameter.
        name: String,
        /// The new default.
        value: Setting,
    },
    /// Another start position of a joint.
    Joint {
        /// The configuration.
        robot: String,
        /// The path of the joint, as a [`Joint`] has it.
        joint: String,
        /// The position, rad or m.
        value: f64,
    },
    /// A part more, docked at a free port.
    Dock {
        /// The configuration.
        robot: String,
        /// The path of the free port.
        port: String,
        /// The name of the module or configuration that is docked.
        part: String,
        /// The name of its port.
        at: String,
        /// The turn of the connector, in steps of 360° divided by its number of turns.
        #[serde(default)]
        turn: u32,
    },
}

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Setting {
    /// A truth value.
    Bool(bool),
    /// A number, in the unit in which the default is written.
    Number(f64),
}

impl Edit {
    /// Returns the name of the declaration whose text is changed.
    pub fn robot(&self) -> &str {
        match self {
            Edit::Parameter { robot, .. } | Edit::Joint { robot, .. } | Edit::Dock { robot, .. } => robot,
        }
    }
}

/// Bytes of a text, and what takes their place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Replacement {
    range: Range<usize>,
    text: String,
}

/// Returns the text after a change. `model`: what `text` shows, with the robot of the change.
///
/// # Errors
/// The reason why the text can't be changed in this way.
pub(super) fn changed(text: &str, model: &Model, edit: &Edit) -> Result<String, String> {
    let mut replacements = replacements(text, model, edit)?;
    replacements.sort_by_key(|replacement| replacement.range.start);
    let mut changed = String::with_capacity(text.len() + 80);
    let mut at = 0;
    for Replacement { range, text: new } in replacements {
        changed.push_str(&text[at..range.start]);
        changed.push_str(&new);
        at = range.end;
    }
    changed.push_str(&text[at..]);
    Ok(changed)
}

fn replacements(text: &str, model: &Model, edit: &Edit) -> Result<Vec<Replacement>, String> {
    if model.error().is_some() {
        return Err("the program has errors; they are mended in the text first".to_owned());
    }
    let name = edit.robot();
    let robot = model.robot.as_ref().filter(|robot| robot.name == name);
    let robot = robot.ok_or_else(|| format!("the text has no `{name}` to change"))?;
    let config = || {
        let found = model.tree.as_ref().and_then(|tree| {
            let place = Span::new(tree.id, robot.place.start, robot.place.end);
            config_of(tree, place)
        });
        found.ok_or_else(|| format!("`{name}` is no configuration"))
    };
    match edit {
        Edit::Parameter { behavior, name, value, .. } => {
            let named = |known: &&Parameter| known.name == *name && known.behavior == *behavior;
            let parameter = robot.parameters.iter().find(named);
            let parameter =
                parameter.ok_or_else(|| format!("there is no parameter `{name}` with a slider"))?;
            Ok(vec![default(parameter, *value)?])
        }
        Edit::Joint { joint, value, .. } => {
            let found = robot.joints.iter().find(|known| known.name == *joint);
            let found = found.ok_or_else(|| format!("there is no joint `{joint}` that can be set"))?;
            Ok(vec![position(text, config()?, found, *value)?])
        }
        Edit::Dock { port, part, at, turn, .. } => {
            let free = robot.ports.iter().find(|known| known.name == *port);
            let free = free.ok_or_else(|| format!("`{port}` is no free port"))?;
            let mut offers = free.offers.iter().map(|index| &robot.offers[*index]);
            if !offers.any(|offer| offer.part == *part && offer.port == *at) {
                return Err(format!("`{at}` of `{part}` does not mate with `{port}`"));
            }
            if *turn >= free.turns {
                return Err(format!("`{port}` mates in {} turns, from 0", free.turns));
            }
            docked(text, model, config()?, (port, free.turns), (part, at, *turn))
        }
    }
}

/// Returns the change of a default.
fn default(parameter: &Parameter, value: Setting) -> Result<Replacement, String> {
    if let Some(why) = &parameter.fixed {
        return Err(why.clone());
    }
    let name = &parameter.name;
    let text = match (value, &parameter.written) {
        (Setting::Bool(value), Some(Written::Bool(_))) => Some(value.to_string()),
        (Setting::Number(value), Some(Written::Number { unit, .. })) => {
            if parameter.whole && value.fract() != 0.0 {
                return Err(format!("`{name}` is a whole number"));
            }
            number(value, unit)
        }
        _ => None,
    };
    let text = text.ok_or_else(|| format!("this is no value of `{name}`"))?;
    Ok(Replacement { range: parameter.place.start..parameter.place.end, text })
}

/// Returns the change of a start position: another value of the clause that sets it, or a clause more.
fn position(text: &str, config: &Config, joint: &Joint, value: f64) -> Result<Replacement, String> {
    if let Some(why) = &joint.fixed {
        return Err(why.clone());
    }
    let none = || format!("this is no position of `{}`", joint.name);
    let (unit, factor) = if joint.turns { ("deg", std::f64::consts::PI / 180.0) } else { ("mm", 1e-3) };
    let set = joint.set.and_then(|span| config.clauses.iter().find(|clause| clause.span == span));
    let Some(ConfigClauseKind::Set { value: written, .. }) = set.map(|clause| &clause.kind) else {
        let shown = in_range(joint, value, factor, unit).ok_or_else(none)?;
        let is_before = |clause: &ConfigClauseKind| {
            use ConfigClauseKind::{Connect, For, If, Part, Set};
            matches!(clause, Set { .. } | Connect { .. } | Part(_) | For { .. } | If { .. })
        };
        let line = format!("set {} = {shown}", joint.name);
        return after(text, config, is_before, &line);
    };
    let shown = match literal(written, text) {
        // A zero may be written without a unit.
        Some(Written::Number { unit, factor, .. }) if !unit.is_empty() => {
            in_range(joint, value, factor, &unit)
        }
        Some(_) => in_range(joint, value, factor, unit),
        None => {
            let shown = text.get(written.span.range()).unwrap_or_default();
            let why = format!(
                "`{}` is set to `{shown}`, which is worked out; it is changed in the text",
                joint.name
            );
            return Err(why);
        }
    };
    Ok(Replacement { range: written.span.range(), text: shown.ok_or_else(none)? })
}

/// Returns a position (rad or m) with its unit, of which one is `factor`: where rounding would lead it out of the joint's range, the next
/// number within. `None` for a number that is not finite.
fn in_range(joint: &Joint, value: f64, factor: f64, unit: &str) -> Option<String> {
    let (low, high) = joint.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let rounded = rounded(value / factor);
    // A limit that was computed may lie beyond itself by a rounding.
    let slack = FINEST * factor;
    let inward = match value {
        value if value <= high + slack && units::to_si(rounded, factor) > high => rounded - FINEST,
        value if value >= low - slack && units::to_si(rounded, factor) < low => rounded + FINEST,
        _ => rounded,
    };
    number(inward, unit)
}

/// Returns the two clauses of a part that is docked.
fn docked(
    text: &str,
    model: &Model,
    config: &Config,
    (port, turns): (&str, u32),
    (part, at, turn): (&str, &str, u32),
) -> Result<Vec<Replacement>, String> {
    let name = free_name(text, model, part);
    let turn = match turn {
        0 => String::new(),
        turn => {
            let angle = number(f64::from(turn) * 360.0 / f64::from(turns), "deg");
            format!(" turn {}", angle.ok_or("the connector has no turns")?)
        }
    };
    let is_part = |clause: &ConfigClauseKind| matches!(clause, ConfigClauseKind::Part(_));
    let is_bond = |clause: &ConfigClauseKind| {
        use ConfigClauseKind::{Connect, For, If, Part};
        matches!(clause, Connect { .. } | Part(_) | For { .. } | If { .. })
    };
    let mut declared = after(text, config, is_part, &format!("part {name}: {part}"))?;
    let connected = after(text, config, is_bond, &format!("connect {port} -- {name}.{at}{turn}"))?;
    if connected.range == declared.range {
        declared.text += &connected.text;
        return Ok(vec![declared]);
    }
    Ok(vec![declared, connected])
}

/// Returns a name for a part of a type: the type's with a small letter and the first number with which the text does not have it.
fn free_name(text: &str, model: &Model, part: &str) -> String {
    let own = part.rsplit('.').next().unwrap_or(part);
    let mut letters = own.chars();
    let first = letters.next().map_or_else(|| "part".to_owned(), |first| first.to_lowercase().collect());
    let stem = first + letters.as_str();
    let words: BTreeSet<&str> = text.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    let items = model.tree.iter().flat_map(|tree| &tree.items);
    let declared: BTreeSet<&str> =
        items.filter_map(|item| Some(ItemKind::name(&item.kind)?.text.as_str())).collect();
    let is_free = |name: &String| !words.contains(name.as_str()) && !declared.contains(name.as_str());
    let mut names = (1..).map(|n| format!("{stem}{n}"));
    names.find(is_free).expect("a text has finitely many words")
}

/// Returns a clause more, behind the last one of some kinds between the braces of a configuration.
///
/// # Errors
/// The reason why there is no place for it.
fn after(
    text: &str,
    config: &Config,
    is_before: impl Fn(&ConfigClauseKind) -> bool,
    clause: &str,
) -> Result<Replacement, String> {
    let last = config.clauses.iter().rev().find(|clause: &&ConfigClause| is_before(&clause.kind));
    let last = last.ok_or("the configuration has no parts")?.span.range();
    let line_end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let line_start = text[..last.start].rfind('\n').map_or(0, |at| at + 1);
    let line = &text[line_start..last.start];
    let outer: String = line.chars().take_while(|c| *c == ' ' || *c == '\t').collect();
    let begins = line.len() == outer.len();
    let indent = if begins { outer.clone() } else { format!("{outer}  ") };
    let rest = text[last.end..].split('\n').next().unwrap_or_default();
    let rest = rest.strip_suffix('\r').unwrap_or(rest);
    let is_end = rest.trim().is_empty() || rest.trim_start().starts_with("//");
    let (at, text) = match is_end {
        true => (last.end + rest.len(), format!("{line_end}{indent}{clause}")),
        // The rest of the line begins one of its own.
        false => (last.end, format!("{line_end}{indent}{clause}{line_end}{outer}")),
    };
    Ok(Replacement { range: at..at, text })
}
