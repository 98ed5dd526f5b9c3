//! Connectors: what mates with what, at which turns.

use crate::check::Type;
use crate::check::typed::{ConnectorDef, DefId, DefKind, Expr};
use crate::interpret::design::ConnectorDesign;
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{JointSpec, Value};
use crate::robot::validation::{TURNS_MAX, check_connector};
use crate::robot::{Capture, Connector, Hinge};
use crate::source::{Diagnostic, Span, code};
use crate::units::Dimension;
use std::rc::Rc;

/// The angle (rad) that docking tolerates where `capture` states only a distance: any.
const CAPTURE_ANGLE_DEFAULT: f64 = std::f64::consts::PI;

impl Interpreter<'_> {
    /// Returns the connector of a declaration, elaborated once; `None` where it is broken, which has been reported,
    /// and for a declaration that is not a connector.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels.
    pub(super) fn connector(&mut self, def: DefId) -> Eval<Option<Rc<ConnectorDesign>>> {
        let index = def.0 as usize;
        if let Some(known) = &self.memory.connectors[index] {
            return Ok(known.clone());
        }
        let program = self.shared.program;
        let DefKind::Connector(declared) = &program.def(def).kind else { return Ok(None) };
        let mark = self.reported.errors;
        let design = match self.elaborate_connector(def, declared) {
            Ok(design) => Some(Rc::new(design)),
            Err(Stop::Fault(diagnostic)) => {
                self.report(*diagnostic);
                None
            }
            Err(halt) => return Err(halt),
        };
        let design = design.filter(|_| !self.failed_since(mark));
        self.memory.connectors[index] = Some(design.clone());
        Ok(design)
    }

    /// Returns the connector of a declaration.
    ///
    /// # Errors
    /// A fault where a value is out of range, or the connectors that it mates do not mate it.
    fn elaborate_connector(&mut self, def: DefId, declared: &ConnectorDef) -> Eval<ConnectorDesign> {
        let mut frame = Frame::new(declared.frame, None);
        let mut connector = Connector {
            name: self.name(def).to_string(),
            mates: Vec::new(),
            turns: self.turns(declared, &mut frame)?,
            holds_force: None,
            holds_moment: None,
            capture: None,
            snaps: declared.snaps,
            hinge: None,
        };
        self.holds(declared, &mut connector, &mut frame)?;
        if let Some(declared) = &declared.capture {
            let distance = self.positive(&declared.distance, "the distance of capture", &mut frame)?;
            let mut bound = |bound: &Option<Expr>, what: &str| {
                bound.as_ref().map(|bound| self.positive(bound, what, &mut frame)).transpose()
            };
            let angle = bound(&declared.angle, "the angle of capture")?.unwrap_or(CAPTURE_ANGLE_DEFAULT);
            let speed = bound(&declared.speed, "the speed of capture")?;
            let rate = bound(&declared.rate, "the angular speed of capture")?;
            connector.capture = Some(Capture { distance, angle, speed, rate });
        }
        if let Some((span, args)) = &declared.hinge {
            connector.hinge = self.hinge(*span, args, &mut frame)?;
        }
        // Its mates are declarations still; `check_mutual` checks them.
        check_connector(std::slice::from_ref(&connector), 0).map_err(|found| {
            let span = self.shared.program.def(def).span;
            fault(code::BAD_CONNECTOR, span, found.to_string(), "not sound")
        })?;
        self.check_mutual(def, declared)?;
        Ok(ConnectorDesign { def, connector, mates: declared.mates.iter().map(|(mate, _)| *mate).collect() })
    }

    /// Returns the number of turns at which a connector mates; 1 where none is stated, or it is unknown.
    fn turns(&mut self, declared: &ConnectorDef, frame: &mut Frame) -> Eval<u32> {
        let Some(turns) = &declared.turns else { return Ok(1) };
        match self.eval(turns, frame)? {
            Value::Int(n) if (1..=i64::from(TURNS_MAX)).contains(&n) => Ok(n as u32),
            Value::Unknown => Ok(1),
            _ => Err(fault(
                code::BAD_CONNECTOR,
                turns.span,
                format!("`turns` is how many turns are allowed in a full circle: 1 to {TURNS_MAX}"),
                "a whole number of at least 1 is wanted",
            )),
        }
    }

    fn holds(&mut self, declared: &ConnectorDef, connector: &mut Connector, frame: &mut Frame) -> Eval<()> {
        for holds in &declared.holds {
            let amount = self.positive(holds, "what a connector holds", frame)?;
            let is_force = holds.ty.dimension() == Some(Dimension::FORCE);
            let slot = if is_force { &mut connector.holds_force } else { &mut connector.holds_moment };
            if slot.replace(amount).is_some() {
                let message = "what the connector holds is stated twice";
                return Err(fault(code::BAD_CONNECTOR, holds.span, message, "stated before"));
            }
        }
        Ok(())
    }

    /// Returns the hinge of a connector, made as the prelude's `revolute` makes joints; `None` where it is
    /// unknown.
    fn hinge(&mut self, span: Span, args: &[Option<Expr>], frame: &mut Frame) -> Eval<Option<Hinge>> {
        let Some(revolute) = self.native_named("revolute") else { return Ok(None) };
        let Value::JointKind(spec) = self.call_def(revolute, args, &Type::JointKind, span, frame)? else {
            return Ok(None);
        };
        let JointSpec { axis, limits, .. } = *spec;
        Ok(Some(Hinge { axis: axis.normalize(), limits }))
    }

    /// Returns the declaration of the built-in with this key, such as `move`; `None` if the program has none.
    pub(super) fn native_named(&self, key: &str) -> Option<DefId> {
        let is_it = |kind: &DefKind| matches!(kind, DefKind::Native(native) if native.key == key);
        self.shared.program.identified().find(|(_, def)| is_it(&def.kind)).map(|(id, _)| id)
    }

    /// Refuses a connector whose mates do not mate it, or have another number of turns.
    ///
    /// # Errors
    /// A fault at the clause `mates`.
    fn check_mutual(&mut self, def: DefId, declared: &ConnectorDef) -> Eval<()> {
        let program = self.shared.program;
        for (mate, span) in &declared.mates {
            let DefKind::Connector(other) = &program.def(*mate).kind else { continue };
            let (this, that) = (self.name(def), self.name(*mate));
            if !other.mates.iter().any(|(back, _)| *back == def) {
                let message = format!("{this} mates {that}, but {that} does not mate {this}");
                return Err(Diagnostic::error(code::BAD_CONNECTOR, message)
                    .label(*span, format!("{that} does not say so"))
                    .label(program.def(*mate).span, "declared here")
                    .hint(format!("write `mates {this}` in {that}"))
                    .into());
            }
            let turns = self.turns(declared, &mut Frame::new(declared.frame, None))?;
            let others = self.turns(other, &mut Frame::new(other.frame, None))?;
            if turns != others {
                let message = format!("{this} has {turns} turns, and {that}, which it mates, has {others}");
                return Err(Diagnostic::error(code::BAD_CONNECTOR, message)
                    .label(*span, "connectors that mate have the same turns")
                    .label(program.def(*mate).span, "declared here")
                    .into());
            }
        }
        Ok(())
    }

    /// Returns the value, in SI units, of an expression that must be a positive number; 1 where it is unknown, which
    /// has been reported. `what`: its name for messages.
    ///
    /// # Errors
    /// A fault where it is not positive.
    pub(super) fn positive(&mut self, expr: &Expr, what: &str, frame: &mut Frame) -> Eval<f64> {
        match self.eval(expr, frame)?.as_number() {
            Some(x) if x > 0.0 => Ok(x),
            // An unknown value has been reported already; any stands in for it.
            None => Ok(1.0),
            Some(_) => {
                Err(fault(code::BAD_VALUE, expr.span, format!("{what} must be positive"), "must be positive"))
            }
        }
    }
}
