//! Behaviours to plans, and plans before the judge.

use super::causes::PlanCauses;
use super::design::Design;
use super::interpreter::Interpreter;
use super::plan_value::{Judged, PlanValue};
use super::record::{Record, StateValue, first_world};
use super::robot::Robot;
use super::stop::{Eval, Stop, fault};
use super::value::{Behavior, Value};
use crate::behavior::{self, Problem, Scheduled};
use crate::geometry::Vec3;
use crate::plan::{
    Body, CauseId, Node, Plan, Provenance, Settings, Snapshot, Tracks, Verdict, World, WorldFrom, file,
};
use crate::robot::{JointId, Library, State};
use crate::source::{Span, code};
use std::cell::OnceCell;
use std::rc::Rc;
use std::sync::Arc;

/// Plans that are kept, so that `verify` and `emit` of one behaviour plan and judge it once.
const KEPT_MAX: usize = 32;

/// Who set the start pose: joints, and bonds by index.
#[derive(Default)]
struct StartCauses {
    joints: Vec<(JointId, CauseId)>,
    bonds: Vec<(usize, CauseId)>,
}

/// The state in which a behaviour begins (else the robot's start pose), and its world.
#[derive(Default)]
pub struct Beginning {
    /// The state in which the behaviour begins.
    pub start: Option<State>,
    /// The world that is assumed.
    pub world: World,
}

impl Interpreter<'_> {
    /// The plan of a behaviour from the start pose of its robot; `None` where something is wrong
    /// with it, which has been reported.
    pub fn plan_behavior(&mut self, behavior: &Behavior, span: Span) -> Eval<Option<Rc<PlanValue>>> {
        self.plan_from(behavior, Beginning::default(), span)
    }

    /// Plans a behaviour from a state and under a world; `None` after an error that was reported.
    pub fn plan_from(
        &mut self,
        behavior: &Behavior,
        beginning: Beginning,
        span: Span,
    ) -> Eval<Option<Rc<PlanValue>>> {
        if self.shared.mode == super::host::Mode::Check {
            self.check_behavior(behavior)?;
            return Ok(None);
        }
        let Some(design) = behavior.robot.clone() else {
            let message = "this behaviour moves no robot, so there is nothing to plan";
            return Err(fault(code::BAD_ACTION, span, message, "no action names a joint or a port"));
        };
        let Some(robot) = self.robot_of(&design)? else { return Ok(None) };
        let mut causes = PlanCauses::default();
        let program = causes.renumber(&behavior.node);
        let start = beginning.start.unwrap_or_else(|| robot.start.clone());
        if let Some(kept) = self.kept_plan(&design, &program, &start, &beginning.world, &causes.ids) {
            return Ok(Some(kept));
        }
        if !self.check_behavior(behavior)? {
            return Ok(None);
        }
        let set = self.start_causes(&design, &robot, &mut causes);
        let problem = Problem {
            robot: robot.assembly.as_ref().clone(),
            start,
            program,
            start_causes: set.joints,
            bond_causes: set.bonds,
            settings: behavior::Settings::default(),
        };
        let scheduled = match behavior::schedule(problem) {
            Ok(scheduled) => scheduled,
            Err(refusal) => return Err(self.refused(&refusal, &causes.ids, span)),
        };
        let planned = self.assemble_plan(design, robot, scheduled, &causes, beginning.world);
        if !self.report_issues(&planned.1, &causes.ids) {
            return Ok(None);
        }
        let planned = Rc::new(planned.0);
        self.keep_plan(planned.clone());
        Ok(Some(planned))
    }

    /// A plan of what was scheduled, with what was too fast in it.
    pub fn assemble_plan(
        &self,
        design: Rc<Design>,
        robot: Rc<Robot>,
        scheduled: Scheduled,
        causes: &PlanCauses,
        world: World,
    ) -> (PlanValue, Vec<behavior::Issue>) {
        let Scheduled { tracks, program, exemptions, nominal, actions, issues } = scheduled;
        let library = tracks.robot.library.clone();
        let bare = self.bare_plan("behavior", Body::Tracks(tracks), library, world, causes);
        let plan = Plan { program: Some(program), nominal, exemptions, ..bare };
        (PlanValue::new(design, Some(robot), plan, causes.ids.clone(), actions), issues)
    }

    /// A plan without a program, and without a verdict. Without a planner nobody planned it.
    pub fn bare_plan(
        &self,
        planner: &str,
        body: Body,
        library: Arc<Library>,
        world: World,
        causes: &PlanCauses,
    ) -> Plan {
        Plan {
            provenance: Provenance { planner: planner.to_owned(), ..self.provenance() },
            worlds: vec![WorldFrom { from: 0.0, world }],
            settings: self.judge_settings(),
            library,
            body,
            program: None,
            nominal: false,
            causes: causes.table(&self.memory.causes, self.shared.sources),
            exemptions: Vec::new(),
            verdict: None,
        }
    }

    /// The causes of a plan all of which one call of a planner commands: number 0 is that call.
    pub fn planner_causes(&mut self, call: Span) -> PlanCauses {
        let mut causes = PlanCauses::default();
        let cause = self.cause(call, Vec::new(), "");
        causes.number(cause);
        causes
    }

    /// The default options of the judge, within the limits of the run.
    pub fn judge_settings(&self) -> Settings {
        Settings { samples_max: self.limits().samples, ..Settings::default() }
    }

    /// Durations that turned out shorter than the joints' limits allow; gives whether there are none.
    pub fn report_issues(&mut self, issues: &[behavior::Issue], ids: &[CauseId]) -> bool {
        for issue in issues {
            let issue = behavior::Issue { cause: ids[issue.cause.0 as usize], ..issue.clone() };
            let diagnostic = self.issue(&issue);
            self.add_report(diagnostic);
        }
        issues.is_empty()
    }

    /// A plan of the same behaviour of the same robot. Causes may differ: the same commands called
    /// from another line are other causes, and then it is planned anew.
    fn kept_plan(
        &self,
        design: &Rc<Design>,
        program: &Arc<Node>,
        start: &State,
        world: &World,
        causes: &[CauseId],
    ) -> Option<Rc<PlanValue>> {
        let same = |planned: &&Rc<PlanValue>| {
            let plan = &planned.plan;
            let Some(tracks) = plan.body.tracks() else { return false };
            Rc::ptr_eq(&planned.robot, design)
                && planned.causes.starts_with(causes)
                && first_world(plan) == *world
                && tracks.start == *start
                && plan.program.as_ref().is_some_and(|p| p.root == *program)
        };
        self.memory.plans.iter().find(same).cloned()
    }

    fn keep_plan(&mut self, planned: Rc<PlanValue>) {
        if self.memory.plans.len() >= KEPT_MAX {
            self.memory.plans.remove(0);
        }
        self.memory.plans.push(planned);
    }

    /// Causes of the joints' start positions and of the bonds.
    fn start_causes(&mut self, design: &Rc<Design>, robot: &Robot, causes: &mut PlanCauses) -> StartCauses {
        let mut start = StartCauses::default();
        for set in design.sets() {
            let cause = self.start_cause(set.span, &set.instance);
            let joint = robot.joint_of(set.joint);
            // A later `set` of a joint replaces an earlier one.
            start.joints.retain(|(other, _)| *other != joint);
            start.joints.push((joint, causes.number(cause)));
        }
        for (index, bond) in design.bonds().iter().enumerate() {
            let cause = self.start_cause(bond.span, &bond.instance);
            start.bonds.push((index, causes.number(cause)));
        }
        start
    }

    fn start_cause(&mut self, span: Span, instance: &str) -> CauseId {
        self.memory.causes.add(super::causes::CauseRecord {
            span,
            args: Vec::new(),
            instance: instance.into(),
            caller: None,
        })
    }

    /// Names and hashes of all texts.
    pub fn provenance(&self) -> Provenance {
        let mut sources: Vec<(String, String)> = self
            .shared
            .sources
            .files()
            .map(|(_, source)| (source.name.to_string(), file::digest(&source.text)))
            .collect();
        sources.sort();
        Provenance {
            sources,
            seed: Some(self.shared.options.seed),
            tool: format!("modl {}", env!("CARGO_PKG_VERSION")),
            ..Provenance::default()
        }
    }

    /// A robot in its start pose as a plan that lasts no time.
    pub fn plan_pose(&mut self, design: &Rc<Design>, world: World) -> Eval<Option<Rc<PlanValue>>> {
        let Some(robot) = self.robot_of(design)? else { return Ok(None) };
        let mut causes = PlanCauses::default();
        let set = self.start_causes(design, &robot, &mut causes);
        let tracks = Tracks {
            robot: robot.assembly.as_ref().clone(),
            start: robot.start.clone(),
            tracks: Vec::new(),
            docks: Vec::new(),
            duration: 0.0,
            start_causes: set.joints,
            bond_causes: set.bonds,
        };
        let scheduled = Scheduled {
            tracks,
            program: crate::plan::Program { root: Arc::new(Node::Series(Vec::new())) },
            exemptions: Vec::new(),
            nominal: false,
            actions: 0,
            issues: Vec::new(),
        };
        Ok(Some(Rc::new(self.assemble_plan(design.clone(), robot, scheduled, &causes, world).0)))
    }

    /// The verdict on a plan under these options; each asked for once.
    pub fn judge(&mut self, planned: &PlanValue, settings: Settings, world: Option<World>) -> Rc<Verdict> {
        let worlds = match world {
            Some(world) => vec![WorldFrom { from: 0.0, world }],
            None => planned.plan.worlds.clone(),
        };
        let known = |judged: &&Judged| judged.settings == settings && judged.worlds == worlds;
        if let Some(judged) = planned.judged.borrow().iter().find(known) {
            return judged.verdict.clone();
        }
        crate::interrupt::start_task(format!("verifying {}", planned.robot.name));
        let plan = Plan { settings, worlds: worlds.clone(), ..planned.plan.clone() };
        let verdict = Rc::new(crate::plan::verify::verify(&plan));
        planned.judged.borrow_mut().push(Judged { settings, worlds, verdict: verdict.clone() });
        verdict
    }

    /// The state at a time; refused where there are no joints, at the place that asks.
    pub fn state_at(&mut self, planned: &Rc<PlanValue>, time: f64, span: Span) -> Eval<Value> {
        let Some(body) = &planned.body else {
            let message = "a state is one of joints, and this robot has none";
            return Err(fault(code::BAD_VALUE, span, message, "no joints; `show(.., at: ..)` draws it"));
        };
        let time = time.clamp(0.0, planned.plan.body.duration());
        let Snapshot::Robot(state) = planned.plan.body.state(time) else { return Ok(Value::Unknown) };
        Ok(Value::Record(Rc::new(Record::State(StateValue {
            robot: planned.robot.clone(),
            body: body.clone(),
            state,
            time,
            planned: planned.clone(),
            base: OnceCell::new(),
        }))))
    }

    /// The plan that a value is or gives.
    pub fn plan_of(&mut self, value: &Value, span: Span) -> Eval<Option<Rc<PlanValue>>> {
        match value {
            Value::Behavior(behavior) => self.plan_behavior(behavior, span),
            Value::Record(record) => match &**record {
                Record::Plan(planned) => Ok(Some(planned.clone())),
                Record::Native(record) => Ok(record.plan().cloned()),
                _ => Ok(None),
            },
            Value::Instance(instance) => self.plan_pose(&instance.robot, World::default()),
            _ => Ok(None),
        }
    }

    /// Returns the fault of a behaviour that has no motion.
    pub fn refused(&self, refusal: &behavior::Refusal, ids: &[CauseId], span: Span) -> Stop {
        super::verdicts::refused(self, refusal, ids, span)
    }
}

/// The corners of the area that a robot stands on, in the frame of its base as it rests.
pub fn footprint(robot: &Robot) -> Vec<Vec3> {
    crate::plan::verify::articulated::area(&robot.assembly, &robot.start)
}
