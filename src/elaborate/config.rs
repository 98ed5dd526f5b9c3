//! Configurations: parts, connections, initial positions; Definitions IV.2 and V.1.

use crate::check::typed::{ConfigClause, ConfigDef, Expr, PartCount, PartDef, Require};
use crate::interpret::design::{
    ConfigDesign, Design, FlatModule, Instance, PartElement, PartGroup, SetRecord, join_path,
};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::routines::Args;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::robot::JointOwner;
use crate::source::{Diagnostic, Span, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// A `require` clause with the local variables at its place, to be checked when the body is complete.
pub(super) struct Deferred<'d> {
    /// The clause `require`, with its condition and message.
    pub require: &'d Require,
    /// The values of the body's variables at the clause.
    pub frame: Frame,
}

impl Interpreter<'_> {
    /// Elaborates the body of a configuration into `design`, which exists before so that a body that needs itself is
    /// found. The design is marked as broken where parts are unknown.
    ///
    /// # Errors
    /// A fault of the body that ends it, or `Stop::Halt` if a limit is reached or the user cancels; other faults are
    /// reported.
    pub(super) fn elaborate_config(&mut self, def: &ConfigDef, design: &Rc<Design>) -> Eval<()> {
        let config = design.config().expect("made as a configuration");
        let this = self.whole(design);
        let complete = self.elaborate_parts(def, design, config, &this)?;
        let mut frame = Frame::new(def.frame, Some(this.clone()));
        let mut requirements = Vec::new();
        if complete {
            let mark = self.reported.errors;
            self.run_clauses(&def.clauses, config, &mut frame, &mut requirements)?;
            self.elaborate_world(def, config, &mut frame)?;
            self.force_members(def, &this)?;
            self.find_base(def, config, &this)?;
            // A connection that failed leaves parts unconnected; saying so would be a consequence.
            if !self.failed_since(mark) && !design.broken.get() {
                match def.scene {
                    true => self.check_scene(def, design)?,
                    false => self.check_connected(def, design, config)?,
                }
            }
            if self.failed_since(mark) {
                design.broken.set(true);
            }
        }
        config.complete.set(true);
        if complete {
            self.check_places(def, design)?;
            self.check_closure(def, design)?;
            self.check_requirements(requirements)?;
        } else {
            design.broken.set(true);
        }
        Ok(())
    }

    /// Elaborates the parts and lists their modules; returns true if all are known.
    fn elaborate_parts(
        &mut self,
        def: &ConfigDef,
        design: &Rc<Design>,
        config: &ConfigDesign,
        this: &Rc<Instance>,
    ) -> Eval<bool> {
        let mut groups = Vec::new();
        let mut modules = Vec::new();
        let mut order = 0;
        let mut complete = true;
        for part in &def.parts {
            let mut frame = Frame::new(def.frame, Some(this.clone()));
            let group = match self.elaborate_part(part, &mut frame, modules.len()) {
                Ok(group) => group,
                Err(Stop::Fault(diagnostic)) => {
                    self.report(*diagnostic);
                    None
                }
                Err(halt) => return Err(halt),
            };
            let Some(group) = group else {
                complete = false;
                continue;
            };
            for element in &group.elements {
                order = order.max(element.design.order());
                self.inherit(element, config, &mut modules);
            }
            self.check_modules(modules.len(), part.span)?;
            groups.push(group);
        }
        if complete {
            config.order.set(order + 1);
            assert!(config.modules.set(modules).is_ok(), "a body is elaborated once");
            assert!(config.parts.set(groups).is_ok(), "a body is elaborated once");
        } else {
            design.broken.set(true);
        }
        Ok(complete)
    }

    /// Ends the run where a robot has more modules than the limit.
    fn check_modules(&mut self, count: usize, span: Span) -> Eval<()> {
        let limit = self.limits().modules;
        if count <= limit {
            return Ok(());
        }
        let message = format!("a robot of more than {limit} modules is not allowed");
        self.halt(Diagnostic::error(code::SIZE_LIMIT, message).label(span, "too many parts"))
    }

    /// Returns a part or a list of parts, whose modules count from `offset`; `None` where a part or the length
    /// of the list is unknown.
    fn elaborate_part(
        &mut self,
        part: &PartDef,
        frame: &mut Frame,
        offset: usize,
    ) -> Eval<Option<PartGroup>> {
        let mut elements = Vec::new();
        let mut next = offset;
        let mut known = true;
        let mut add = |this: &mut Self, frame: &mut Frame, name: String| -> Eval<()> {
            match this.part_design(part, frame)? {
                Some(design) => {
                    let count = design.module_count();
                    let place = this.part_place(part, frame)?;
                    elements.push(PartElement { design, offset: next, name: name.as_str().into(), place });
                    next += count;
                    this.check_modules(next, part.span)?;
                }
                None => known = false,
            }
            Ok(())
        };
        match &part.count {
            None => add(self, frame, part.name.to_string())?,
            Some(PartCount::Number(count)) => {
                let Some(count) = self.part_count(count, frame)? else { return Ok(None) };
                for i in 0..count {
                    add(self, frame, format!("{}[{i}]", part.name))?;
                }
            }
            Some(PartCount::Each { binder, range }) => {
                let values = self.eval(range, frame)?;
                let mut i = 0;
                let complete = self.for_each(&values, *binder, range.span, frame, |this, frame| {
                    add(this, frame, format!("{}[{i}]", part.name))?;
                    i += 1;
                    Ok(())
                })?;
                known &= complete;
            }
        }
        Ok(known.then_some(PartGroup { list: part.count.is_some(), elements }))
    }

    /// Returns the length of a list of parts; `None` where it is unknown.
    fn part_count(&mut self, count: &Expr, frame: &mut Frame) -> Eval<Option<i64>> {
        match self.eval(count, frame)? {
            Value::Int(n) if n >= 0 => Ok(Some(n)),
            Value::Unknown => Ok(None),
            value => Err(fault(
                code::BAD_VALUE,
                count.span,
                format!("there can't be {} parts", self.show(&value)),
                "a whole number of at least 0 is wanted",
            )),
        }
    }

    /// Returns the design of a part; `None` where it is broken.
    fn part_design(&mut self, part: &PartDef, frame: &mut Frame) -> Eval<Option<Rc<Design>>> {
        let args: Args = self.eval_args(&part.args, part.ty_span, frame)?;
        let design = self.design_of(part.of, args, part.ty_span)?;
        Ok(design.filter(|d| !d.broken.get() && (d.module().is_some() || d.config().is_some())))
    }

    /// Takes over the modules, bonds and initial positions of a part.
    fn inherit(&mut self, part: &PartElement, config: &ConfigDesign, modules: &mut Vec<FlatModule>) {
        let Some(inner) = part.design.config() else {
            modules.push(FlatModule { name: part.name.clone(), design: part.design.clone() });
            return;
        };
        let listed = inner.modules.get().map_or(&[][..], Vec::as_slice);
        modules.extend(
            listed
                .iter()
                .map(|m| FlatModule { name: join_path(&part.name, &m.name), design: m.design.clone() }),
        );
        let shift = part.offset;
        let bonds = config.bonds.borrow().len();
        for bond in inner.bonds.borrow().iter() {
            let mut bond = bond.clone();
            bond.a.0 += shift;
            bond.b.0 += shift;
            bond.instance = inherited(&part.name, &bond.instance);
            config.add_bond(bond);
        }
        for set in inner.sets.borrow().iter() {
            let mut set = set.clone();
            match &mut set.joint {
                JointOwner::Module { module, .. } => *module += shift,
                JointOwner::Bond(bond) => *bond += bonds,
            }
            set.instance = inherited(&part.name, &set.instance);
            config.sets.borrow_mut().push(set);
        }
    }

    fn run_clauses<'d>(
        &mut self,
        clauses: &'d [ConfigClause],
        config: &ConfigDesign,
        frame: &mut Frame,
        requirements: &mut Vec<Deferred<'d>>,
    ) -> Eval<()> {
        for clause in clauses {
            match self.run_clause(clause, config, frame, requirements) {
                Err(Stop::Fault(diagnostic)) => self.report(*diagnostic),
                other => other?,
            }
        }
        Ok(())
    }

    /// Runs a clause: makes its connection, sets its joint, binds its local, or collects its requirement.
    fn run_clause<'d>(
        &mut self,
        clause: &'d ConfigClause,
        config: &ConfigDesign,
        frame: &mut Frame,
        requirements: &mut Vec<Deferred<'d>>,
    ) -> Eval<()> {
        match clause {
            ConfigClause::Connect { a, b, turn, span } => {
                self.connect(config, a, b, turn.as_ref(), *span, frame)
            }
            ConfigClause::Set { joint, value, span } => self.set(config, joint, value, *span, frame),
            ConfigClause::Let { local, value } => {
                let value = self.eval_bound(value, frame)?;
                frame.set(*local, value);
                Ok(())
            }
            ConfigClause::Obstacle(obstacle) => self.obstacle(obstacle, config, frame),
            ConfigClause::Require(require) => {
                requirements.push(Deferred { require, frame: frame.clone() });
                Ok(())
            }
            ConfigClause::If { condition, then, otherwise } => match self.eval(condition, frame)? {
                Value::Bool(true) => self.run_clauses(then, config, frame, requirements),
                Value::Bool(false) => self.run_clauses(otherwise, config, frame, requirements),
                _ => Ok(()),
            },
            ConfigClause::For { binder, iterable, body } => {
                let values = self.eval(iterable, frame)?;
                self.for_each(&values, *binder, iterable.span, frame, |this, frame| {
                    this.run_clauses(body, config, frame, requirements)
                })?;
                Ok(())
            }
        }
    }

    /// Adds the start position of a clause `set joint = value`.
    ///
    /// # Errors
    /// A fault where the joint follows others, or the position is outside its range.
    fn set(
        &mut self,
        config: &ConfigDesign,
        joint: &Expr,
        value: &Expr,
        span: Span,
        frame: &mut Frame,
    ) -> Eval<()> {
        let target = self.eval(joint, frame)?;
        let position = self.eval(value, frame)?;
        let (Value::Joint(target), Some(position)) = (target, position.as_number()) else { return Ok(()) };
        let limits = match target.owner {
            JointOwner::Module { module, joint: index } => {
                let declared = &target.robot.module_type(module).joints[index];
                if declared.mimic.is_some() {
                    let message = format!("`{}` follows other joints and can't be set", target.name());
                    return Err(fault(code::BAD_ACTION, joint.span, message, "follows other joints"));
                }
                declared.limits
            }
            JointOwner::Bond(bond) => self.hinge_limits(&target.robot, bond)?,
        };
        if let Some((low, high)) = limits.range
            && !(low..=high).contains(&position)
        {
            return Err(out_of_range(&target.name(), position, (low, high), target.dimension, value.span));
        }
        let record = SetRecord {
            joint: target.owner,
            value: position,
            span,
            instance: self.binder_notes().as_str().into(),
        };
        config.sets.borrow_mut().push(record);
        Ok(())
    }

    /// Evaluates the ports and lets of a body, so that their mistakes are found.
    fn force_members(&mut self, def: &ConfigDef, this: &Rc<Instance>) -> Eval<()> {
        use crate::check::typed::{MemberId, MemberKind};
        for (index, member) in def.members.iter().enumerate() {
            if matches!(member.kind, MemberKind::Port { .. }) {
                let id = MemberId(u32::try_from(index).expect("members are few"));
                let value = self.member(this, id, member.span);
                self.recover(value)?;
            }
        }
        Ok(())
    }

    /// Finds the module that the clause `base` names: of a part that is a configuration, that part's base.
    fn find_base(&mut self, def: &ConfigDef, config: &ConfigDesign, this: &Rc<Instance>) -> Eval<()> {
        let Some(base) = &def.base else { return Ok(()) };
        let value = self.eval(base, &mut Frame::new(def.frame, Some(this.clone())))?;
        if let Value::Instance(part) = value {
            // Of a part that is a configuration, its own base.
            let inner = part.design.config().and_then(|c| c.base.get()).unwrap_or(0);
            config.base.set(Some(part.modules.index(inner)));
        }
        Ok(())
    }

    /// Reports the requirements whose conditions are false, in their order.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while a condition or message is evaluated.
    pub(super) fn check_requirements(&mut self, requirements: Vec<Deferred>) -> Eval<()> {
        for Deferred { require, mut frame } in requirements {
            self.check_requirement(require, &mut frame)?;
        }
        Ok(())
    }

    /// Reports a requirement if its condition is false; an unknown condition has been reported before.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while the condition or the message is evaluated.
    pub(super) fn check_requirement(&mut self, require: &Require, frame: &mut Frame) -> Eval<()> {
        if !matches!(self.eval(&require.condition, frame)?, Value::Bool(false)) {
            return Ok(());
        }
        let said = match self.eval_optional(require.message.as_ref(), frame)? {
            Some(Value::Text(message)) => message.to_string(),
            _ => "a requirement does not hold".to_string(),
        };
        let sides = self.sides(&require.condition, frame)?;
        let label = if sides.is_empty() { "this is false".to_string() } else { sides };
        self.report(Diagnostic::error(code::REQUIREMENT, said).label(require.condition.span, label));
        Ok(())
    }
}

/// Returns `leg[2] (i = 3)` from the path of a part and the label of its inside.
fn inherited(part: &str, inside: &str) -> Rc<str> {
    match inside {
        "" => part.into(),
        // A path goes on, a loop variable stands beside it.
        _ if inside.contains('=') && !inside.contains(" (") => format!("{part} ({inside})").into(),
        _ => format!("{part}.{inside}").into(),
    }
}

/// Returns the message that a joint can't be at a position, with its range, both in SI units of `dimension` (rad or
/// m).
pub(crate) fn outside(joint: &str, position: f64, (low, high): (f64, f64), dimension: Dimension) -> String {
    let [position, low, high] = [position, low, high].map(|x| quantity(x, dimension));
    format!("{joint} can't be at {position}: its range is {low} to {high}")
}

/// Returns the fault, at `span`, of a start position that the joint does not reach; position and range in SI units of
/// `dimension` (rad or m).
pub(super) fn out_of_range(
    joint: &str,
    position: f64,
    (low, high): (f64, f64),
    dimension: Dimension,
    span: Span,
) -> Stop {
    let show = |x| quantity(x, dimension);
    let message = outside(joint, position, (low, high), dimension);
    fault(code::OUT_OF_RANGE, span, message, format!("outside {} to {}", show(low), show(high)))
}
