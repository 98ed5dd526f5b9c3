//! Behaviours: the robot that they move, what excuses them, and what is wrong with them before any run.

use super::causes::CauseRecord;
use super::design::{Design, Subject, port_ref};
use super::frame::Frame;
use super::identity::Name;
use super::interpreter::Interpreter;
use super::robot::Robot;
use super::stop::{Eval, Stop, fault};
use super::value::{Behavior, ConditionValue, JointValue, Value};
use crate::behavior::{self, Conflict, Issue, IssueKind, Part};
use crate::check::typed::{Exemption, ExemptionKind};
use crate::plan::visit::extent;
use crate::plan::{self, Action, CauseId, Condition, Node, Otherwise};
use crate::source::{Code, Diagnostic, Span, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;
use std::sync::Arc;

impl Interpreter<'_> {
    /// Returns the one robot that two things belong to, `None` standing for a thing of no robot; `None` if neither
    /// belongs to one. `a` and `b`: the robots of the two things.
    ///
    /// # Errors
    /// A fault at `span` where they belong to two robots.
    pub fn common_robot(
        &self,
        a: Option<&Rc<Design>>,
        b: Option<&Rc<Design>>,
        span: Span,
    ) -> Eval<Option<Rc<Design>>> {
        match (a, b) {
            (Some(a), Some(b)) if !Rc::ptr_eq(a, b) => Err(other_robot(a, b, span)),
            (a, b) => Ok(a.or(b).cloned()),
        }
    }

    /// Returns the one robot that parts of a behaviour move or sense; `None` if neither names one. Equal robots are
    /// one; but where the program holds them under two names, it means two. `a` and `b`: the robots of the two parts.
    ///
    /// # Errors
    /// A fault at `span` where there are two robots, or two names.
    pub fn common_subject(
        &self,
        a: Option<&Subject>,
        b: Option<&Subject>,
        span: Span,
    ) -> Eval<Option<Subject>> {
        self.common_robot(a.map(|a| &**a), b.map(|b| &**b), span)?;
        let (Some(a), Some(b)) = (a, b) else { return Ok(a.or(b).cloned()) };
        if let Some(names) = a.identity.apart(&b.identity) {
            return Err(two_names(&a.design, names, span));
        }
        let identity = a.identity.clone().better_known(&b.identity);
        Ok(Some(Subject { design: a.design.clone(), identity }))
    }

    /// Returns the robot of a joint, for an action, even if its configuration has mistakes; `None` where it can't be
    /// assembled, which has been reported. `design`: the design of the robot.
    ///
    /// # Errors
    /// A fault at `span` where the robot is a configuration whose clauses still run.
    pub fn robot_at(&mut self, design: &Rc<Design>, span: Span) -> Eval<Option<Rc<Robot>>> {
        let running = design.config().is_some_and(|config| !config.complete.get());
        if running {
            let message = format!("`{}` is not complete here", design.name);
            return Err(fault(
                code::DECLARATION_CYCLE,
                span,
                message,
                "asked before all connections are made",
            ));
        }
        self.robot_of_checked(design, span)
    }

    /// Returns the robot even of a configuration with mistakes, so that its behaviours can be checked.
    fn robot_of_checked(&mut self, design: &Rc<Design>, span: Span) -> Eval<Option<Rc<Robot>>> {
        let broken = design.broken.replace(false);
        let robot = self.robot_of(design, span);
        design.broken.set(broken);
        robot
    }

    /// Returns a behaviour with the exemptions of `allows unstable, collision(a, b)`, the first one outermost;
    /// `Value::Unknown` where an operand is unknown. `behavior`: the behaviour without them; `frame`: the variables
    /// that operands of exemptions may name.
    ///
    /// # Errors
    /// A fault where an exemption names another robot, or `collision` something that is not a single module.
    pub fn exempt(
        &mut self,
        behavior: &Rc<Behavior>,
        allows: &[Exemption],
        frame: &mut Frame,
    ) -> Eval<Value> {
        let mut node = behavior.node.clone();
        for exemption in allows.iter().rev() {
            let Some(kind) = self.exemption_kind(&exemption.kind, behavior, frame)? else {
                return Ok(Value::Unknown);
            };
            let cause = self.cause(exemption.span, Vec::new(), "");
            node = Arc::new(Node::Exempt { body: node, kind, cause });
        }
        Ok(Value::Behavior(Rc::new(Behavior { robot: behavior.robot.clone(), node })))
    }

    /// Returns an exemption with the modules or the joint that it names; `None` where one of them is unknown.
    fn exemption_kind(
        &mut self,
        kind: &ExemptionKind,
        behavior: &Behavior,
        frame: &mut Frame,
    ) -> Eval<Option<plan::ExemptionKind>> {
        Ok(Some(match kind {
            ExemptionKind::Unstable => plan::ExemptionKind::Unstable,
            ExemptionKind::Slip => plan::ExemptionKind::Slip,
            ExemptionKind::Acceleration => plan::ExemptionKind::Acceleration,
            ExemptionKind::Balance => plan::ExemptionKind::Balance,
            ExemptionKind::Traction => plan::ExemptionKind::Traction,
            ExemptionKind::Saturation => plan::ExemptionKind::Saturation,
            ExemptionKind::Collision(None) => plan::ExemptionKind::Collision(None),
            ExemptionKind::Overload(None) => plan::ExemptionKind::Overload(None),
            ExemptionKind::Collision(Some((a, b))) => {
                let parts = (self.eval(a, frame)?, self.eval(b, frame)?);
                let (Value::Instance(x), Value::Instance(y)) = parts else { return Ok(None) };
                for (part, expr) in [(&x, a), (&y, b)] {
                    self.common_subject(behavior.robot.as_ref(), Some(&part.robot), expr.span)?;
                    if part.design.module().is_none() {
                        let message = "`collision` names two modules, or none";
                        return Err(fault(code::BAD_ACTION, expr.span, message, "not a single module"));
                    }
                }
                plan::ExemptionKind::Collision(Some((x.modules.index(0), y.modules.index(0))))
            }
            ExemptionKind::Overload(Some(joint)) => {
                let Value::Joint(value) = self.eval(joint, frame)? else { return Ok(None) };
                self.common_subject(behavior.robot.as_ref(), Some(&value.robot), joint.span)?;
                let Some(robot) = self.robot_at(&value.robot, joint.span)? else { return Ok(None) };
                plan::ExemptionKind::Overload(Some(robot.joint(&value).0))
            }
        }))
    }

    /// Returns the condition `a <-> b`, that two ports are docked to each other; `Value::Unknown` where one is not a
    /// port.
    ///
    /// # Errors
    /// A fault at `span` where the ports belong to two robots.
    pub fn mated_condition(&mut self, a: &Value, b: &Value, span: Span) -> Eval<Value> {
        let (Value::Port(a), Value::Port(b)) = (a, b) else { return Ok(Value::Unknown) };
        let robot = self.common_subject(Some(&a.robot), Some(&b.robot), span)?;
        let condition = Condition::Mated(port_ref(a), port_ref(b));
        Ok(Value::Condition(Rc::new(ConditionValue { robot, condition })))
    }

    /// Refuses a behaviour that takes more actions, or more steps (repeated groups included), than
    /// [`behavior::Settings`] allow by default, before anything traverses them.
    ///
    /// # Errors
    /// A fault at `span` where it does.
    pub fn check_extent(&self, behavior: &Behavior, span: Span) -> Eval<()> {
        let settings = behavior::Settings::default();
        let extent = extent(&behavior.node);
        let (limit, what) = if extent.actions > settings.actions_max {
            (settings.actions_max, "actions")
        } else if extent.steps > settings.steps_max {
            (settings.steps_max, "steps")
        } else {
            return Ok(());
        };
        let message = format!("this behaviour takes more than {limit} {what}, which is the limit");
        Err(fault(code::SIZE_LIMIT, span, message, format!("too many {what}")))
    }

    /// Reports the commands in conflict and what is wrong with single actions ([`behavior::issues`]), before any run.
    /// Returns true if no error was reported: equal commands are only warned of. True also for a behaviour of no robot,
    /// false where its robot is unknown. `span`: the code that uses the behaviour.
    ///
    /// # Errors
    /// A fault where the behaviour exceeds a limit of its size.
    pub fn check_behavior(&mut self, behavior: &Behavior, span: Span) -> Eval<bool> {
        self.check_extent(behavior, span)?;
        let Some(design) = &behavior.robot else { return Ok(true) };
        let declared = self.shared.program.def(design.def).span;
        let Some(robot) = self.robot_of_checked(design, declared)? else { return Ok(false) };
        let mark = self.reported.errors;
        let assembly = &robot.assembly;
        let tol = behavior::Settings::default().tol_duration;
        for issue in behavior::issues(assembly, &behavior.node, tol) {
            let diagnostic = self.issue(&issue);
            self.add_report(diagnostic);
        }
        let found = behavior::conflicts(&behavior.node);
        for (list, error) in [(&found.errors, true), (&found.warnings, false)] {
            for conflict in list {
                let diagnostic = self.conflict(conflict, &robot, error);
                self.add_report(diagnostic);
            }
        }
        Ok(!self.failed_since(mark))
    }

    /// Returns the diagnostic of two commands to one joint at one time: an error, or a warning if they are
    /// equal.
    fn conflict(&self, conflict: &Conflict, robot: &Robot, error: bool) -> Diagnostic {
        let joint = robot.joint_name(conflict.joint);
        let (a, b) = (self.memory.causes.get(conflict.first), self.memory.causes.get(conflict.second));
        let diagnostic = if error {
            Diagnostic::error(code::CONFLICT, format!("two commands to {joint} at one time"))
        } else {
            Diagnostic::warning(
                code::EQUAL_SETPOINTS,
                format!("the same command to {joint} twice at one time"),
            )
        };
        let first = with_instance(format!("commands {joint}"), a);
        let second = with_instance("and so does this, in parallel".to_string(), b);
        let diagnostic = diagnostic.label(a.primary(), first).label(b.primary(), second);
        let diagnostic = in_library(in_library(diagnostic, a), b);
        if error {
            diagnostic.hint("put one after the other with `Sc`")
        } else {
            diagnostic.hint("leave one of them out")
        }
    }

    /// Returns the diagnostic of an action that asks its joint or ports for what they can't do, or has a number that is
    /// negative or not finite. It is labelled at the argument concerned; for an action of the library, at the user's
    /// call.
    pub fn issue(&self, issue: &Issue) -> Diagnostic {
        let record = self.memory.causes.get(issue.cause);
        let (code, message, label) = issue_words(&issue.kind);
        let at = if record.caller.is_some() { record.primary() } else { record.argument(issue.part) };
        let label = if message.contains(&*record.instance) { label } else { with_instance(label, record) };
        let diagnostic = Diagnostic::error(code, message).label(at, label);
        let diagnostic = in_library(diagnostic, record);
        match &issue.kind {
            IssueKind::TooShort { needed, .. } => {
                diagnostic.hint(format!("the least time is {}", quantity(*needed, Dimension::TIME)))
            }
            _ => diagnostic,
        }
    }

    /// Returns the cause of an action on a joint, whose path name is the subject of the cause. `args`: the spans of
    /// the arguments. `span`: the command in the source.
    pub fn action_cause(&mut self, span: Span, args: Vec<(Part, Span)>, joint: &JointValue) -> CauseId {
        let subject = joint.name();
        self.cause(span, args, &subject)
    }
}

/// Returns the node of `action else b`, in which `b` follows the action's timeout; `None` where `action` is not a
/// single action with a timeout.
pub(super) fn with_otherwise(action: &Node, otherwise: &Arc<Node>) -> Option<Node> {
    let Node::Action(action) = action else { return None };
    let mut action = action.clone();
    action.timeout?;
    action.otherwise = match &**otherwise {
        Node::Series(nodes) if nodes.is_empty() => Otherwise::Proceed,
        Node::Action(Action { otherwise: Otherwise::Abort(message), timeout: Some(0.0), .. }) => {
            Otherwise::Abort(message.clone())
        }
        _ => Otherwise::Node(otherwise.clone()),
    };
    Some(Node::Action(action))
}

impl Interpreter<'_> {
    /// Returns the cause of a command at `span` in the state of evaluation: with `subject` (may be empty), the
    /// loop variables, and the call in the user's own file where `span` is in the library. `args`: the spans of
    /// the arguments.
    pub fn cause(&mut self, span: Span, args: Vec<(Part, Span)>, subject: &str) -> CauseId {
        let notes = self.binder_notes();
        let instance = match (subject.is_empty(), notes.is_empty()) {
            (false, false) => format!("{subject} ({notes})"),
            (false, true) => subject.to_string(),
            _ => notes,
        };
        let caller = if self.is_library(span) { self.user_call().map(|call| call.span) } else { None };
        self.memory.causes.add(CauseRecord { span, args, instance: instance.as_str().into(), caller })
    }
}

/// Returns a label's text with the instance that the cause is about, as `label [instance]`; the label alone if it names
/// the instance already.
pub(super) fn with_instance(label: String, record: &CauseRecord) -> String {
    if label.contains(&*record.instance) { label } else { format!("{label} [{}]", record.instance) }
}

/// Adds a second label at the line in the standard library where the cause is, after that at the user's own line;
/// nothing if the cause is in the user's own files.
pub(super) fn in_library(diagnostic: Diagnostic, record: &CauseRecord) -> Diagnostic {
    match record.caller {
        Some(_) => diagnostic.label(record.span, "the command itself, in the library"),
        None => diagnostic,
    }
}

/// Returns the code, the message and the label of an action that a joint can't carry out.
fn issue_words(kind: &IssueKind) -> (Code, String, String) {
    let unit = |prismatic: bool| if prismatic { Dimension::LENGTH } else { Dimension::ANGLE };
    let speed_unit = |prismatic: bool| if prismatic { Dimension::SPEED } else { Dimension::ANGULAR_SPEED };
    match kind {
        IssueKind::OutOfRange { joint, position, range, prismatic } => {
            let show = |x: f64| quantity(x, unit(*prismatic));
            let (low, high) = (show(range.0), show(range.1));
            let at = show(*position);
            (
                code::OUT_OF_RANGE,
                format!("{joint} can't go to {at}: its range is {low} to {high}"),
                format!("outside {low} to {high}"),
            )
        }
        IssueKind::TooFast { joint, speed, limit, prismatic } => {
            let show = |x: f64| quantity(x, speed_unit(*prismatic));
            let (speed, limit) = (show(*speed), show(*limit));
            (
                code::TOO_FAST,
                format!("{joint} can't turn at {speed}: its limit is {limit}"),
                format!("faster than {limit}"),
            )
        }
        IssueKind::TooShort { joint, given, needed } => {
            let show = |x: f64| quantity(x, Dimension::TIME);
            (
                code::TOO_FAST,
                format!("{joint} can't do this in {}: it needs {}", show(*given), show(*needed)),
                "too short".to_string(),
            )
        }
        IssueKind::NoCommands { joint, why } => {
            let why = match why {
                behavior::Uncommandable::Passive => "has no motor",
                behavior::Uncommandable::Mimic => "follows other joints",
                behavior::Uncommandable::Fixed => "is fixed",
            };
            (code::PASSIVE_JOINT, format!("{joint} {why} and takes no commands"), why.to_string())
        }
        IssueKind::NoMate { a, b } => {
            (code::BAD_DOCK, format!("the connectors of {a} and {b} do not mate"), "can't dock".to_string())
        }
        IssueKind::BadNumber { value } => (
            code::BAD_ACTION,
            format!("an action can't have {value} here"),
            "negative, or no finite number".to_string(),
        ),
    }
}

fn other_robot(a: &Rc<Design>, b: &Rc<Design>, span: Span) -> Stop {
    let message = format!("this mixes two robots: {} and {}", a.name, b.name);
    Diagnostic::error(code::OTHER_ROBOT, message)
        .label(span, "one behaviour moves one robot")
        .hint("make both parts of one configuration, or of one `scene`")
        .into()
}

/// Returns the fault of equal robots under two names, with the places where they got these names.
fn two_names(robot: &Rc<Design>, (a, b): (Name, Name), span: Span) -> Stop {
    let place = |name: Name| name.index.map_or_else(String::new, |i| format!(", element {i}"));
    let message = format!("one behaviour reaches {} under two names, and both are one robot", robot.name);
    let diagnostic = Diagnostic::error(code::OTHER_ROBOT, message)
        .label(span, "one behaviour moves one robot")
        .label(a.span, format!("one name is bound here{}", place(a)));
    let diagnostic = if a.span == b.span {
        diagnostic.hint(format!("the other is element {} of the same list", b.index.unwrap_or(0)))
    } else {
        diagnostic.label(b.span, format!("and the other here{}", place(b)))
    };
    diagnostic
        .hint("configurations are values, and equal ones are one robot: bind it once and use that name")
        .hint("for two robots, make them parts of one `scene`")
        .into()
}
