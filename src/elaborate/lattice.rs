//! Lattices: cells of one kind in a connected arrangement.

use crate::check::typed::{DefId, LatticeDef};
use crate::interpret::design::{DesignKind, Instance, LatticeDesign};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::Value;
use crate::source::{Diagnostic, code};
use std::rc::Rc;

impl Interpreter<'_> {
    /// Returns the design of a lattice; `None` where it is unknown, empty or not connected, which has been
    /// reported.
    ///
    /// # Errors
    /// A fault of the kind of cells, or `Stop::Halt` if a limit is reached or the user cancels; faults of the lattice
    /// itself are reported.
    pub(super) fn elaborate_lattice(
        &mut self,
        lattice: &LatticeDef,
        def: DefId,
        this: &Rc<Instance>,
    ) -> Eval<Option<DesignKind>> {
        let mut frame = Frame::new(lattice.frame, Some(this.clone()));
        let of = self.default_design(lattice.of)?.filter(|design| !design.broken.get());
        let value = self.eval(&lattice.value, &mut frame)?;
        let (Some(of), Value::Cells(cells)) = (of, value) else { return Ok(None) };
        let declared = self.shared.program.def(def);
        let span = self.stack.calls.last().map_or(declared.span, |call| call.span);
        if cells.positions.is_empty() {
            let message = format!("the lattice `{}` has no cells", declared.name);
            return self.attempt(|_| Err(fault(code::BAD_LATTICE, span, message, "no cells")));
        }
        let pieces = cells.pieces();
        if pieces.len() > 1 {
            let sizes = pieces_in_words(&pieces);
            let message = format!("the lattice `{}` is not connected: {sizes}", declared.name);
            let mut diagnostic = Diagnostic::error(code::BAD_LATTICE, message).label(span, sizes);
            if span != lattice.value.span {
                diagnostic = diagnostic.label(lattice.value.span, "these cells do not hang together");
            }
            self.add_report(diagnostic.hint("cells hang together where they share a face"));
            return Ok(None);
        }
        Ok(Some(DesignKind::Lattice(LatticeDesign { of, cells })))
    }
}

/// Returns the pieces in words: `a piece of 4 cells and one of 5`.
fn pieces_in_words(pieces: &[usize]) -> String {
    let cells = |n: usize| if n == 1 { "1 cell".to_string() } else { format!("{n} cells") };
    match pieces {
        [a, b] => format!("a piece of {} and one of {b}", cells(*a)),
        [a, rest @ ..] => format!("a piece of {} and {} more", cells(*a), rest.len()),
        [] => "no cells".to_string(),
    }
}
