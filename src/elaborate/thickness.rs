//! Links that are thinner than what counts as a touch.

use crate::check::typed::{DefId, DefKind};
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

impl Interpreter<'_> {
    /// Warns of links that are thinner than the `touch` of their module: the judge lets two such links pass through
    /// each other. Designs other than modules give no warning.
    ///
    /// # Errors
    /// None: the result is always `Ok`.
    pub(super) fn check_thickness(&mut self, def: DefId, design: &Rc<Design>) -> Eval<()> {
        let program = self.shared.program;
        let (DefKind::Module(declared), Some(module)) = (&program.def(def).kind, design.module()) else {
            return Ok(());
        };
        let module = &module.module;
        for (link, declared) in module.links.iter().zip(&declared.links) {
            let thickness =
                link.collides.iter().map(|placed| placed.shape.thickness()).fold(f64::INFINITY, f64::min);
            if thickness >= module.touch {
                continue;
            }
            let words = |length| quantity(length, Dimension::LENGTH);
            let (thin, touch) = (words(thickness), words(module.touch));
            let message = format!(
                "`{}` is {thin} thin, less than the {touch} by which links may be in each other",
                link.name
            );
            self.add_report(
                Diagnostic::warning(code::THIN_LINK, message)
                    .label(declared.span, "two such links pass through each other unseen")
                    .hint(format!("make the link thicker, or state a `touch` below {thin}")),
            );
        }
        Ok(())
    }
}
