//! Declarations checked by themselves, with the defaults of their parameters.

use crate::check::typed::{DefId, DefKind, MemberId, MemberKind};
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use std::rc::Rc;

impl Interpreter<'_> {
    /// Elaborates a declaration with its defaults, evaluates all that its body declares, and warns of links that
    /// overlap or are too thin. A `let` is evaluated.
    ///
    /// # Errors
    /// [`Stop::Halt`](crate::interpret::stop::Stop::Halt) if a limit is reached or the user cancels; faults are
    /// reported.
    pub(super) fn elaborate_with_defaults(&mut self, def: DefId) -> Eval<()> {
        let program = self.shared.program;
        let declared = program.def(def);
        match &declared.kind {
            DefKind::Let(_) => {
                let value = self.global(def, declared.span);
                self.recover(value)?;
            }
            DefKind::Study(_) => {
                self.attempt(|this| this.study(def))?;
            }
            DefKind::Connector(_) => {
                self.connector(def)?;
            }
            _ => {
                if let Some(design) = self.attempt(|this| this.default_design(def))?.flatten() {
                    self.check_members(&design)?;
                    self.check_sweep(def, &design)?;
                    self.check_thickness(def, &design)?;
                }
            }
        }
        Ok(())
    }

    /// Evaluates the lets, ports and behaviours of a body that nothing may have needed yet.
    fn check_members(&mut self, design: &Rc<Design>) -> Eval<()> {
        let program = self.shared.program;
        let body = program.def(design.def).kind.instantiable().expect("only such declarations have designs");
        let whole = self.whole(design);
        for (index, member) in body.members.iter().enumerate() {
            if matches!(member.kind, MemberKind::Let(_) | MemberKind::Port { .. }) {
                let id = MemberId(index as u32);
                let value = self.member(&whole, id, member.span);
                self.recover(value)?;
            }
        }
        let DefKind::Config(config) = &program.def(design.def).kind else { return Ok(()) };
        for declared in &config.behaviors {
            self.attempt(|this| match this.default_behavior(&whole, declared)? {
                Some(Value::Behavior(behavior)) => this.check_behavior(&behavior, declared.span).map(drop),
                _ => Ok(()),
            })?;
        }
        Ok(())
    }
}
