//! Cells and struts: the facts that the families of expanding cubes and linear actuators ask for.

use crate::check::family::{Fact, FactForm, FactsFamily, Family};
use crate::check::typed::{DefId, Expr, FactsDef};
use crate::interpret::design::{DesignKind, Instance};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::Value;
use crate::robot::validation::{check_cell, check_strut};
use crate::robot::{Cell, LibraryFault, Strut};
use crate::source::{Span, code};
use std::rc::Rc;

/// The facts that a declaration states, each by its name.
struct Stated {
    facts: Vec<(&'static Fact, (f64, f64), Span)>,
}

impl Stated {
    fn of(&self, name: &str) -> &(&'static Fact, (f64, f64), Span) {
        self.facts.iter().find(|(fact, ..)| fact.name == name).expect("the family lists the fact")
    }

    /// Returns a range, SI.
    fn range(&self, name: &str) -> (f64, f64) {
        self.of(name).1
    }

    /// Returns a quantity, SI.
    fn quantity(&self, name: &str) -> f64 {
        self.of(name).1.0
    }

    /// Returns a quantity that may be left out, SI.
    fn optional(&self, name: &str) -> Option<f64> {
        self.facts.iter().find(|(fact, ..)| fact.name == name).map(|(_, (quantity, _), _)| *quantity)
    }

    /// Returns a truth value that is true where it is left out.
    fn is_true(&self, name: &str) -> bool {
        self.optional(name) != Some(0.0)
    }

    /// Returns the span of a value.
    fn span(&self, name: &str) -> Span {
        self.of(name).2
    }

    /// Returns the cell with these facts.
    fn cell(&self, name: String) -> Cell {
        Cell {
            name,
            size: self.quantity("size"),
            shrinks_to: self.quantity("shrinks_to"),
            mass: self.quantity("mass"),
            force: self.quantity("max_force"),
            speed: self.quantity("max_speed"),
            slides: self.is_true("slides"),
        }
    }

    /// Returns the strut with these facts.
    fn strut(&self, name: String) -> Strut {
        Strut {
            name,
            length: self.range("length"),
            speed: self.quantity("max_speed"),
            force: self.quantity("max_force"),
            mass: self.quantity("mass"),
            clearance: self.quantity("clearance"),
            acceleration: self.optional("max_accel"),
            buckling: self.optional("buckling"),
            node_mass: self.optional("node_mass"),
        }
    }
}

impl Interpreter<'_> {
    /// Returns the design of a cell or a strut; `None` where a fact is missing, unknown or out of range, which has been
    /// reported. `title`: the name with its arguments, for messages.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels; faults are reported.
    pub(super) fn elaborate_facts(
        &mut self,
        def: &FactsDef,
        id: DefId,
        this: &Rc<Instance>,
        title: &str,
    ) -> Eval<Option<DesignKind>> {
        let mut frame = Frame::new(def.frame, Some(this.clone()));
        let mark = self.reported.errors;
        let (mut facts, mut stated) = (Vec::new(), 0);
        for (fact, value) in Family::from(def.family).facts().iter().zip(&def.facts) {
            let Some(value) = value else {
                // `check` reports a fact that is missing.
                if fact.required {
                    return Ok(None);
                }
                continue;
            };
            stated += 1;
            let read = self.attempt(|this| this.fact(fact, value, &mut frame))?.flatten();
            facts.extend(read.map(|read| (fact, read, value.span)));
        }
        // A fact that can't be read was reported, or is unknown.
        if facts.len() < stated || self.failed_since(mark) {
            return Ok(None);
        }
        let (stated, title) = (Stated { facts }, title.to_string());
        let span = self.shared.program.def(id).span;
        let unsound = |why: &str| fault(code::BAD_MODULE, span, why, "not sound");
        match def.family {
            FactsFamily::Cell => {
                let cell = stated.cell(title);
                let checked = check_cell(&cell).map_err(|found| match found {
                    LibraryFault::NoShrinking => {
                        let span = stated.span("shrinks_to");
                        fault(code::BAD_MODULE, span, found.to_string(), "no smaller than the cell")
                    }
                    found => unsound(&found.to_string()),
                });
                Ok(self.attempt(|_| checked)?.map(|()| DesignKind::Cell(cell)))
            }
            FactsFamily::Strut => {
                let strut = stated.strut(title);
                let checked = check_strut(&strut).map_err(|found| unsound(&found.to_string()));
                Ok(self.attempt(|_| checked)?.map(|()| DesignKind::Strut(strut)))
            }
        }
    }

    /// Reads the value of a fact, SI; the two ends of a quantity are equal, and a truth value is 1 or 0. `None` where
    /// it is unknown.
    fn fact(&mut self, fact: &Fact, value: &Expr, frame: &mut Frame) -> Eval<Option<(f64, f64)>> {
        match fact.form {
            FactForm::Positive => {
                let quantity = self.positive(value, &format!("`{}`", fact.name), frame)?;
                Ok(Some((quantity, quantity)))
            }
            FactForm::Truth => {
                let Value::Bool(holds) = self.eval(value, frame)? else { return Ok(None) };
                let number = f64::from(u8::from(holds));
                Ok(Some((number, number)))
            }
            FactForm::PositiveRange => {
                let Value::Range(ends) = self.eval(value, frame)? else { return Ok(None) };
                let Some((low, high)) = ends.0.as_number().zip(ends.1.as_number()) else { return Ok(None) };
                if !(low > 0.0 && low < high) {
                    let message = "the length of a strut is a range from a positive length to a larger one";
                    return Err(fault(code::BAD_MODULE, value.span, message, "no such range"));
                }
                Ok(Some((low, high)))
            }
        }
    }
}
