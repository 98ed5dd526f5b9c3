//! Values as a person in a session wants to see them: a robot as the tree of its parts, a behaviour
//! as its series-parallel tree, a plan as a sketch of its time, cells and patterns as characters.

use super::shape;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::natives::folding::LayoutValue;
use crate::natives::plot::PlotValue;
use crate::source::floor_char_boundary;
use std::any::Any;

/// The greatest number of lines of a displayed tree; the number of those left out is shown.
pub(super) const LINES_MAX: usize = 40;

/// The greatest number of bytes of a display; the rest is cut.
const BYTES_MAX: usize = 1 << 16;

impl Interpreter<'_> {
    /// Returns a value as text on as many lines as it needs, the first of which can stand alone; text that is too long
    /// to read is cut.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while the value is judged or planned.
    pub(super) fn display_value(&mut self, value: &Value) -> Eval<String> {
        let mut shown = self.display_whole(value)?;
        if shown.len() > BYTES_MAX {
            shown.truncate(floor_char_boundary(&shown, BYTES_MAX));
            shown.push_str(" ...");
        }
        Ok(shown)
    }

    /// Returns a value as a session shows it, however long.
    fn display_whole(&mut self, value: &Value) -> Eval<String> {
        Ok(match value {
            Value::Text(text) => quoted(text),
            Value::Instance(instance) => self.display_instance(instance)?,
            Value::Behavior(behavior) => self.display_behavior(behavior)?,
            Value::Cells(cells) => shape::cells(cells),
            Value::Record(record) => match &**record {
                Record::Plan(planned) => self.display_plan(planned)?,
                Record::Native(record) => {
                    let record: &dyn Any = record.as_ref();
                    match (record.downcast_ref::<LayoutValue>(), record.downcast_ref::<PlotValue>()) {
                        (Some(layout), _) => shape::pattern(layout.report()),
                        (_, Some(plot)) => plot.text(),
                        _ => self.show(value),
                    }
                }
                _ => self.show(value),
            },
            Value::List(_) if let Some(table) = self.table(value) => {
                self.show_table(&table).unwrap_or_else(|| self.show(value))
            }
            Value::List(elements) if elements.iter().any(|e| matches!(e, Value::Text(_))) => {
                let shown = elements.iter().map(|e| match e {
                    Value::Text(text) => quoted(text),
                    other => self.show(other),
                });
                format!("[{}]", shown.collect::<Vec<_>>().join(", "))
            }
            _ => self.show(value),
        })
    }
}

/// Returns a text as a program could write it: in double quotes, with escapes.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '{' => out.push_str("\\{"),
            '}' => out.push_str("\\}"),
            c if c.is_control() => out.push_str(&format!("\\u{{{:x}}}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A branch of a tree that is displayed with lines: a text, and the branches below it.
pub(super) struct Branch {
    /// The text on the line of the branch itself.
    pub text: String,
    /// The branches that go off this one, from the top.
    pub below: Vec<Branch>,
}

impl Branch {
    /// Returns a branch with nothing below it.
    pub(super) fn leaf(text: impl Into<String>) -> Branch {
        Branch { text: text.into(), below: Vec::new() }
    }

    /// Returns the tree as text, indented by two columns for each level; lines beyond [`LINES_MAX`] are left out and
    /// counted.
    pub(super) fn drawn(&self) -> String {
        let mut lines = vec![self.text.clone()];
        self.draw_below("", &mut lines);
        let more = lines.len().saturating_sub(LINES_MAX);
        if more > 1 {
            lines.truncate(LINES_MAX);
            lines.push(format!("... and {more} more lines"));
        }
        lines.join("\n")
    }

    fn draw_below(&self, indent: &str, lines: &mut Vec<String>) {
        for (i, branch) in self.below.iter().enumerate() {
            let last = i + 1 == self.below.len();
            lines.push(format!("{indent}{} {}", if last { "└" } else { "├" }, branch.text));
            branch.draw_below(&format!("{indent}{} ", if last { " " } else { "│" }), lines);
        }
    }
}

/// Returns names in words, in their order: the first six, and the number of the rest.
pub(super) fn listed(names: &[String]) -> String {
    const SHOWN: usize = 6;
    let shown = names.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN { format!("{shown} and {} more", names.len() - SHOWN) } else { shown }
}
