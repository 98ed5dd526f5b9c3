//! Cells and struts: the facts that the families of expanding cubes and linear actuators ask for.

use crate::check::typed::{DefId, FactsDef};
use crate::interpret::design::{DesignKind, Instance};
use crate::interpret::eval::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::Value;
use crate::robot::{Cell, Strut};
use crate::source::code;
use std::rc::Rc;

const CELL_FACTS: [&str; 5] = ["size", "shrinks_to", "mass", "max_force", "max_speed"];
const STRUT_FACTS: [&str; 5] = ["length", "max_speed", "max_force", "mass", "clearance"];

impl Interpreter<'_> {
    pub(super) fn elaborate_cell(
        &mut self,
        facts: &FactsDef,
        def: DefId,
        this: &Rc<Instance>,
        title: &str,
    ) -> Eval<Option<DesignKind>> {
        let mut frame = Frame::new(facts.frame, Some(this.clone()));
        let mark = self.reported.errors;
        let values = self.positive_facts(facts, def, &CELL_FACTS, &mut frame)?;
        let [size, shrinks_to, mass, force, speed] = values[..] else { return Ok(None) };
        if shrinks_to >= size {
            let span = facts.facts[1].as_ref().map_or(self.shared.program.def(def).span, |e| e.span);
            let message = "`shrinks_to` must be less than `size`";
            return self.attempt(|_| Err(fault(code::BAD_MODULE, span, message, "no smaller than the cell")));
        }
        let cell = Cell { name: title.to_string(), size, shrinks_to, mass, force, speed };
        Ok((!self.failed_since(mark)).then_some(DesignKind::Cell(cell)))
    }

    pub(super) fn elaborate_strut(
        &mut self,
        facts: &FactsDef,
        def: DefId,
        this: &Rc<Instance>,
        title: &str,
    ) -> Eval<Option<DesignKind>> {
        let mut frame = Frame::new(facts.frame, Some(this.clone()));
        let mark = self.reported.errors;
        let span = self.shared.program.def(def).span;
        let length = match facts.facts.first() {
            Some(Some(length)) => match self.eval(length, &mut frame)? {
                Value::Range(ends) => ends.0.as_number().zip(ends.1.as_number()),
                _ => None,
            },
            _ => {
                let message = format!("the strut `{title}` has no `length`");
                return self.attempt(|_| Err(fault(code::BAD_MODULE, span, message, "lacks `length`")));
            }
        };
        let values = self.positive_facts(facts, def, &STRUT_FACTS, &mut frame)?;
        let ([speed, force, mass, clearance], Some((low, high))) = (&values[..], length) else {
            return Ok(None);
        };
        if !(low > 0.0 && low < high) {
            let span = facts.facts[0].as_ref().map_or(span, |e| e.span);
            let message = "the length of a strut is a range from a positive length to a larger one";
            return self.attempt(|_| Err(fault(code::BAD_MODULE, span, message, "no such range")));
        }
        let strut = Strut {
            name: title.to_string(),
            length: (low, high),
            speed: *speed,
            force: *force,
            mass: *mass,
            clearance: *clearance,
        };
        Ok((!self.failed_since(mark)).then_some(DesignKind::Strut(strut)))
    }

    /// Returns the facts that are positive quantities, in order, passing over ranges; fewer where one is
    /// missing, which is reported. Only `clearance` may be left out.
    fn positive_facts(
        &mut self,
        facts: &FactsDef,
        def: DefId,
        names: &[&str],
        frame: &mut Frame,
    ) -> Eval<Vec<f64>> {
        let declared = self.shared.program.def(def);
        let mut values = Vec::new();
        for (index, name) in names.iter().enumerate().filter(|(_, name)| **name != "length") {
            let value = match facts.facts.get(index) {
                Some(Some(expr)) => self.attempt(|this| this.positive(expr, &format!("`{name}`"), frame))?,
                _ if *name == "clearance" => Some(0.0),
                _ => self.attempt(|_| {
                    let message = format!("`{}` has no `{name}`", declared.name);
                    Err(fault(code::BAD_MODULE, declared.span, message, format!("lacks `{name}`")))
                })?,
            };
            values.extend(value);
        }
        Ok(values)
    }
}
