//! A plan as a value of the language, and what its planner reports of it.

use super::design::{Design, Instance};
use super::interpreter::Interpreter;
use super::robot::Robot;
use super::value::Value;
use crate::behavior::ContractInterval;
use crate::geometry::Pose;
use crate::plan::verify::articulated::{self, ClusterPaths, Detail, Instant};
use crate::plan::{CauseId, Node, Plan, Settings, Verdict, World, WorldFrom};
use std::any::Any;
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// A plan with what the language knows about it: its robot, causes and verdict.
pub struct PlanValue {
    /// The robot, lattice or truss that moves.
    pub robot: Rc<Design>,
    /// The robot as an assembly; `None` for a lattice or a truss.
    pub body: Option<Rc<Robot>>,
    /// The plan in numbers, without spans.
    pub plan: Plan,
    /// The run's number of each cause of the plan; the index here is the plan's number.
    pub causes: Vec<CauseId>,
    /// The number of actions that the plan carries out; 0 for a lattice or a truss.
    pub actions: u64,
    /// The program of the behaviour as it is stated, which has goals where the plan's has actions; `None` for plans that
    /// were not made of a behaviour.
    stated: Option<Arc<Node>>,
    /// The uses of behaviours with contracts, in the order in which they begin.
    contracts: Vec<ContractInterval>,
    /// True if the plan was made of one whose contracts it does not keep.
    drops_contracts: bool,
    /// The planner's report; `None` for plans that no planner made.
    report: Option<Rc<dyn PlannerReport>>,
    /// The robot as a value, once it was asked for: one and the same at each time.
    instance: OnceCell<Rc<Instance>>,
    /// The verdicts so far.
    pub(super) judged: RefCell<Vec<Judged>>,
    /// The judge's quantities of the plan's base and of each robot at the times that were asked for last: without loads, and
    /// with them.
    instants: RefCell<BTreeMap<Option<usize>, [AtTimes<Instant>; 2]>>,
    /// The least distances of links that may not touch at the times that were asked for last, m, of all robots and of each.
    clearances: RefCell<BTreeMap<Option<usize>, AtTimes<Option<f64>>>>,
    /// True if the robot comes apart; empty until it is asked for.
    comes_apart: OnceCell<bool>,
    /// The world poses of all links at the time (s) that was asked for last, of a robot that comes apart.
    placed: RefCell<Option<(f64, Rc<[Pose]>)>>,
}

/// Times (s) with what is known at them.
type AtTimes<T> = (Rc<Vec<f64>>, Rc<Vec<T>>);

/// The verdict on a plan, with the settings and worlds under which it was given.
pub(super) struct Judged {
    /// The settings of the judge under which the verdict was made.
    pub settings: Settings,
    /// The worlds that were assumed, in order of time.
    pub worlds: Vec<WorldFrom>,
    /// The verdict of the judge on the plan.
    pub verdict: Rc<Verdict>,
}

/// A planner's report of its plan: the fields of a record type that `is Plan`.
pub trait PlannerReport: Any {
    /// Returns the value of a field of the report, by its name; `None` if the report has no such field, as with those
    /// that all plans have. `plan`: the plan that the report is about; `interpreter`: the evaluator of the run.
    fn read(&self, interpreter: &mut Interpreter, plan: &Rc<PlanValue>, field: &str) -> Option<Value>;
}

/// The name of a field of a report, with the function that reads it.
pub type ReportField<R> = (&'static str, fn(&mut Interpreter, &Rc<PlanValue>, &R) -> Value);

/// A report of a planner whose fields are listed in one table.
pub trait ReportFields: Sized + 'static {
    /// The fields of the report, in the order of the declaration.
    const FIELDS: &'static [ReportField<Self>];

    /// Returns the names of the report's fields, to be compared with the declaration.
    fn names() -> Vec<&'static str> {
        Self::FIELDS.iter().map(|(name, _)| *name).collect()
    }
}

impl<R: ReportFields> PlannerReport for R {
    fn read(&self, interpreter: &mut Interpreter, plan: &Rc<PlanValue>, field: &str) -> Option<Value> {
        let found = R::FIELDS.iter().find(|(name, _)| *name == field);
        found.map(|(_, read)| read(interpreter, plan, self))
    }
}

impl std::fmt::Debug for PlanValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a plan of {}", self.robot.name)
    }
}

impl PlanValue {
    /// Returns the worlds that the plan is judged in: `world` from its beginning on if it is given, else the plan's
    /// own.
    pub fn worlds_in(&self, world: Option<World>) -> Vec<WorldFrom> {
        match world {
            Some(world) => vec![WorldFrom { from: 0.0, world }],
            None => self.plan.worlds.clone(),
        }
    }

    /// Returns a plan that was not judged yet, without a planner's report. `robot`: what moves; `body`: the robot as
    /// an assembly, `None` for a lattice or a truss; `causes`: the run's number of each cause of the plan; `actions`:
    /// the number of its actions.
    pub fn new(
        robot: Rc<Design>,
        body: Option<Rc<Robot>>,
        plan: Plan,
        causes: Vec<CauseId>,
        actions: u64,
    ) -> PlanValue {
        PlanValue {
            robot,
            body,
            plan,
            causes,
            actions,
            stated: None,
            contracts: Vec::new(),
            drops_contracts: false,
            report: None,
            instance: OnceCell::new(),
            judged: RefCell::default(),
            instants: RefCell::default(),
            clearances: RefCell::default(),
            comes_apart: OnceCell::new(),
            placed: RefCell::default(),
        }
    }

    /// Returns the plan's robot as a value, the same instance at each call.
    pub fn instance(&self) -> Rc<Instance> {
        self.instance.get_or_init(|| Instance::whole(self.robot.clone())).clone()
    }

    /// Returns the plan with the program of the behaviour that it was made of, as it is stated.
    pub fn stated(self, program: Arc<Node>) -> PlanValue {
        PlanValue { stated: Some(program), ..self }
    }

    /// Returns the plan with uses of behaviours with contracts, in the order in which they begin. `dropped`: true if others
    /// are not kept.
    pub fn with_uses(self, contracts: Vec<ContractInterval>, dropped: bool) -> PlanValue {
        PlanValue { contracts, drops_contracts: dropped, ..self }
    }

    /// Returns the uses of behaviours with contracts, in the order in which they begin.
    pub fn contracts(&self) -> &[ContractInterval] {
        &self.contracts
    }

    /// Returns true if the plan was made of one whose contracts it does not keep.
    pub fn drops_contracts(&self) -> bool {
        self.drops_contracts
    }

    /// Returns the program of the behaviour that the plan was made of, as it is stated; `None` if it was made otherwise.
    pub fn stated_program(&self) -> Option<&Arc<Node>> {
        self.stated.as_ref()
    }

    /// Returns the plan with the report of the planner that made it.
    pub fn with_report(self, report: impl PlannerReport) -> PlanValue {
        PlanValue { report: Some(Rc::new(report)), ..self }
    }

    /// Returns the planner's report; `None` for a plan that no planner made.
    pub(super) fn any_report(&self) -> Option<Rc<dyn PlannerReport>> {
        self.report.clone()
    }

    /// Returns the planner's report if it is of the type `R`; `None` where another planner made the plan, or none.
    pub fn report<R: PlannerReport>(&self) -> Option<&R> {
        let report: &dyn Any = self.report.as_deref()?;
        report.downcast_ref()
    }

    /// Keeps the verdict that a planner got on this plan under the plan's own settings and worlds, so that
    /// [`Interpreter::judge`] finds it.
    pub fn remember_verdict(&self, verdict: Verdict) {
        let (settings, worlds) = (self.plan.settings, self.plan.worlds.clone());
        self.judged.borrow_mut().push(Judged { settings, worlds, verdict: Rc::new(verdict) });
    }

    /// Returns the judge's quantities at these times (s, ascending), one instant for each; fewer if the limit of
    /// samples is reached before the last. Kept for the next call with the same times. `detail`: the quantities that
    /// are computed; `robot`: the base of the robot that is meant, by its index, `None` for that of the plan.
    pub fn instants(&self, times: &Rc<Vec<f64>>, detail: Detail, robot: Option<usize>) -> Rc<Vec<Instant>> {
        let mut all = self.instants.borrow_mut();
        let kept = &mut all.entry(robot).or_default()[usize::from(detail == Detail::Loads)];
        if kept.0 != *times {
            *kept = (times.clone(), Rc::new(articulated::instants(&self.plan, times, detail, robot)));
        }
        kept.1.clone()
    }

    /// Returns true if the robot of the plan comes apart, so that its parts have poses of their own.
    pub fn comes_apart(&self) -> bool {
        *self.comes_apart.get_or_init(|| articulated::comes_apart(&self.plan))
    }

    /// Returns the world poses `X_WL` of all links at a time (s), m, by their numbers, of a robot that comes apart, as the
    /// judge's rollout has brought them there; a link that it did not bring there is where the plan's base begins. `None` for
    /// other plans. Kept for the next call with the same time.
    pub fn placed(&self, time: f64) -> Option<Rc<[Pose]>> {
        if let Some((at, poses)) = &*self.placed.borrow()
            && *at == time
        {
            return Some(poses.clone());
        }
        let paths = ClusterPaths::of(&self.plan, time)?;
        let mut poses =
            vec![self.plan.body.tracks()?.start.base; self.body.as_ref()?.kinematics.link_count()];
        paths.place(time, &mut poses);
        let poses: Rc<[Pose]> = poses.into();
        *self.placed.borrow_mut() = Some((time, poses.clone()));
        Some(poses)
    }

    /// Returns the least signed distance of links that may not touch at each of these times (s), m; `None` where there
    /// are no two such links. Empty for a plan that is not of an articulated robot, or is not valid. Kept for the next
    /// call with the same times. `robot`: the base of the robot that is meant, by its index, `None` for all.
    pub fn clearances(&self, times: &Rc<Vec<f64>>, robot: Option<usize>) -> Rc<Vec<Option<f64>>> {
        let mut all = self.clearances.borrow_mut();
        let kept = all.entry(robot).or_default();
        if kept.0 != *times {
            let found = articulated::clearances_at(&self.plan, times, robot).unwrap_or_default();
            *kept = (times.clone(), Rc::new(found));
        }
        kept.1.clone()
    }

    /// Returns the number of actions of the plan; the greatest `usize` if it is larger.
    pub fn actions(&self) -> usize {
        usize::try_from(self.actions).unwrap_or(usize::MAX)
    }

    /// Returns the number of intervals between the instants at which the plan's law of motion changes, its beginning
    /// and end included.
    pub fn steps(&self) -> usize {
        self.plan.body.instants().len().saturating_sub(1)
    }
}
