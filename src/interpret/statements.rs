//! The execution of statements and tests.

use super::frame::Frame;
use super::host::{Mode, TestResult};
use super::interpreter::Interpreter;
use super::stop::{Eval, Stop};
use super::value::{ContractValue, Value};
use crate::check::typed::{Body, Expr, Stmt, StmtKind};
use crate::source::{Diagnostic, code};

impl Interpreter<'_> {
    /// Executes the statements of a body in order; the names that a failed statement declares are unknown, and the
    /// statements after it are executed nevertheless.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn execute_body(&mut self, body: &Body) -> Eval<()> {
        let mut frame = Frame::new(body.frame, None);
        for statement in &body.statements {
            self.execute(statement, &mut frame)?;
        }
        Ok(())
    }

    /// Executes a statement; faults are reported. `frame`: the variables of the body in which it stands.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn execute(&mut self, statement: &Stmt, frame: &mut Frame) -> Eval<()> {
        match &statement.kind {
            StmtKind::Let { local, value } => {
                let value = self.eval_bound(value, frame)?;
                frame.set(*local, value);
            }
            StmtKind::Expr(expr) => {
                self.eval(expr, frame)?;
            }
            StmtKind::Expect { condition, message } => self.expect(condition, message.as_ref(), frame)?,
            StmtKind::Contract(clause) => {
                let (slots, this) = (frame.slots.clone(), frame.this.clone());
                frame.contracts.push(ContractValue { clause: clause.clone(), slots, this });
            }
            StmtKind::If { condition, then, otherwise } => {
                let branch = match self.eval(condition, frame)? {
                    Value::Bool(true) => then,
                    Value::Bool(false) => otherwise,
                    _ => return Ok(()),
                };
                self.execute_all(branch, frame)?;
            }
            StmtKind::For { binder, iterable, body } => {
                let values = self.eval(iterable, frame)?;
                let looped = self.for_each(&values, *binder, iterable.span, frame, |this, frame| {
                    this.execute_all(body, frame)
                });
                match looped {
                    Err(Stop::Fault(diagnostic)) => self.report(*diagnostic),
                    other => drop(other?),
                }
            }
        }
        Ok(())
    }

    fn execute_all(&mut self, statements: &[Stmt], frame: &mut Frame) -> Eval<()> {
        statements.iter().try_for_each(|statement| self.execute(statement, frame))
    }

    fn expect(&mut self, condition: &Expr, message: Option<&Expr>, frame: &mut Frame) -> Eval<()> {
        let value = self.eval(condition, frame)?;
        self.reported.unjudged |= value.is_unknown();
        if self.shared.mode == Mode::Check || !matches!(value, Value::Bool(false)) {
            return Ok(());
        }
        let text = self.shared.sources.text(condition.span).split_whitespace().collect::<Vec<_>>().join(" ");
        let said = match self.eval_optional(message, frame)? {
            Some(Value::Text(message)) => format!("{message}: `{text}` does not hold"),
            _ => format!("`{text}` does not hold"),
        };
        let found = self.sides(condition, frame)?;
        let label = if found.is_empty() { "this is false".to_string() } else { found };
        self.report(Diagnostic::error(code::EXPECTATION, said).label(condition.span, label));
        Ok(())
    }

    /// Returns the text in which a message shows a false comparison with the values of its sides, `1.2mm > 2mm is
    /// false`; empty if `condition` is not a comparison. `condition` must have come out false: that is not tested.
    /// Both sides are evaluated again. `frame`: the variables of the body in which it stands.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn sides(&mut self, condition: &Expr, frame: &mut Frame) -> Eval<String> {
        use crate::check::typed::{BinaryOp as Op, ExprKind};
        let ExprKind::Binary { op, left, right } = &condition.kind else { return Ok(String::new()) };
        let sign = match op {
            Op::Eq => "==",
            Op::Ne => "!=",
            Op::Lt => "<",
            Op::Le => "<=",
            Op::Gt => ">",
            Op::Ge => ">=",
            _ => return Ok(String::new()),
        };
        let (left, right) = (self.eval(left, frame)?, self.eval(right, frame)?);
        Ok(format!("{} {sign} {} is false", self.show(&left), self.show(&right)))
    }

    /// Runs the tests whose name contains the filter, and records their results; each passes unless it reported
    /// an error or a condition in it is unknown.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn run_tests(&mut self) -> Eval<()> {
        let program = self.shared.program;
        let filter = self.shared.options.filter.as_deref().unwrap_or_default();
        for test in program.tests.iter().filter(|test| test.name.contains(filter)) {
            let mark = self.reported.errors;
            self.reported.unjudged = false;
            let ended = self.execute_body(&test.body);
            let passed = ended.is_ok() && !self.reported.unjudged && !self.failed_since(mark);
            self.reported.tests.push(TestResult { name: test.name.clone(), passed });
            ended?;
        }
        Ok(())
    }
}
