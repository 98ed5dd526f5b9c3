//! Planning of behaviours, and judging of plans.

use super::argument::{Auto, WordOr};
use super::causes::PlanCauses;
use super::design::Design;
use super::goals::Stated;
use super::interpreter::Interpreter;
use super::plan_value::{Judged, PlanValue};
use super::record::{Record, StateValue, first_world};
use super::robot::Robot;
use super::stop::{Eval, Stop, fault};
use super::value::{Behavior, Value};
use crate::behavior::{self, Problem, Scheduled};
use crate::geometry::{Pose, Vec3};
use crate::plan::visit::equal;
use crate::plan::{Body, CauseId, Node, Plan, Provenance, Settings, Snapshot, Tracks, Verdict, World, file};
use crate::robot::{JointId, Library, State};
use crate::source::{Diagnostic, Span, code};
use std::cell::OnceCell;
use std::rc::Rc;
use std::sync::Arc;

/// The greatest number of plans that are kept, so that `verify` and `emit` of one behaviour plan and judge it
/// once.
const KEPT_MAX: usize = 32;

/// The causes of the start pose.
#[derive(Default)]
struct StartCauses {
    /// The causes of start positions: (joint, cause).
    joints: Vec<(JointId, CauseId)>,
    /// The cause of each bond: (bond, cause).
    bonds: Vec<(usize, CauseId)>,
}

/// The state in which a behaviour begins, and the world that it assumes.
#[derive(Default)]
pub struct Beginning {
    /// The state in which the behaviour begins; `None`: the robot's start pose.
    pub start: Option<State>,
    /// The world that is assumed for the whole behaviour; `None`: that of the scene, or the default.
    pub world: Option<World>,
}

impl Interpreter<'_> {
    /// Returns the plan of a behaviour from the start pose of its robot; `None` where something is wrong with it,
    /// which has been reported. `behavior`: the behaviour; `span`: the code that asks for the plan.
    ///
    /// # Errors
    /// As [`plan_from`](Self::plan_from).
    pub fn plan_behavior(&mut self, behavior: &Behavior, span: Span) -> Eval<Option<Rc<PlanValue>>> {
        self.plan_from(behavior, Beginning::default(), span)
    }

    /// Returns the plan of a behaviour from a state and under a world, not judged yet; `None` after an error that was
    /// reported, and when the program is only checked. A plan that is still kept is returned again. `behavior`: the
    /// behaviour; `beginning`: the state and the world.
    ///
    /// # Errors
    /// A fault at `span` where no action names a robot, where the behaviour exceeds a limit of its size, or
    /// where it has no motion.
    pub fn plan_from(
        &mut self,
        behavior: &Behavior,
        beginning: Beginning,
        span: Span,
    ) -> Eval<Option<Rc<PlanValue>>> {
        if self.shared.mode == super::host::Mode::Check {
            self.check_behavior(behavior, span)?;
            return Ok(None);
        }
        let Some(design) = behavior.robot.as_ref().map(|robot| robot.design.clone()) else {
            let message = "this behaviour moves no robot, so there is nothing to plan";
            return Err(fault(code::BAD_ACTION, span, message, "no action names a joint or a port"));
        };
        let Some(robot) = self.robot_of(&design, span)? else { return Ok(None) };
        self.check_extent(behavior, span)?;
        let mut causes = PlanCauses::default();
        let program = causes.renumber(&behavior.node);
        let start = beginning.start.unwrap_or_else(|| robot.start.clone());
        // Bonds that a motion added are not those of the robot as it is declared, with which a plan begins.
        if start.bonds.len() > robot.assembly.bonds.len() {
            let message = "where this begins, ports are docked that were not connected at the start";
            return Err(Diagnostic::error(code::BAD_VALUE, message)
                .label(span, "no plan begins there")
                .hint("plan the whole as one behaviour: `plan(Sc(before, behavior))`")
                .into());
        }
        let world = beginning.world.or(robot.world).unwrap_or_default();
        if let Some(kept) = self.kept_plan(&design, &program, &start, &world, &causes.ids) {
            return Ok(Some(kept));
        }
        if !self.check_behavior(behavior, span)? {
            return Ok(None);
        }
        let resolved = self.resolved(
            &Stated { design: &design, robot: &robot, start: &start, world, causes: &causes },
            &program,
            span,
        )?;
        let set = self.start_causes(&design, &robot, &mut causes);
        let problem = Problem {
            robot: robot.assembly.as_ref().clone(),
            start,
            program: resolved.program,
            start_causes: set.joints,
            bond_causes: set.bonds,
            settings: behavior::Settings::default(),
        };
        let scheduled = match behavior::schedule(problem) {
            Ok(scheduled) => scheduled,
            Err(refusal) => return Err(self.refused(&refusal, &causes.ids, span)),
        };
        let mut planned = self.assemble_plan(design, robot, scheduled, &causes, world);
        planned.0.plan.paths = resolved.paths;
        if !self.report_issues(&planned.1, &causes.ids) {
            return Ok(None);
        }
        let planned = Rc::new(planned.0.stated(program));
        self.keep_plan(planned.clone());
        Ok(Some(planned))
    }

    /// Returns (plan, issues) of a scheduled behaviour: the plan, and an issue for each action that is too fast for
    /// the joints' limits; their causes have the plan's numbers. `design` and `robot`: the robot that moves;
    /// `scheduled`: its motion; `causes`: the causes that the plan names; `world`: the world that is assumed.
    pub fn assemble_plan(
        &self,
        design: Rc<Design>,
        robot: Rc<Robot>,
        scheduled: Scheduled,
        causes: &PlanCauses,
        world: World,
    ) -> (PlanValue, Vec<behavior::Issue>) {
        let Scheduled { tracks, program, exemptions, contracts, nominal, actions, open_turns, issues } =
            scheduled;
        let library = tracks.robot.library.clone();
        let tracks = Tracks { obstacles: robot.obstacles.clone(), ..tracks };
        let bare = self.bare_plan("behavior", Body::Tracks(tracks), library, world, causes);
        let mut plan = Plan { program: Some(program), nominal, exemptions, ..bare };
        settle_turns(&mut plan, &open_turns);
        let planned = PlanValue::new(design, Some(robot), plan, causes.ids.clone(), actions);
        (planned.with_uses(contracts, false), issues)
    }

    /// Returns a plan of a motion without a program and without a verdict. `planner`: the name in its provenance.
    /// `body`: the motion; `library`: the library that it refers to; `world`: the world that is assumed; `causes`:
    /// the causes that the plan names.
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
            causes: causes.table(&self.memory.causes, self.shared.sources),
            ..Plan::bare(library, body, world, self.judge_settings())
        }
    }

    /// Returns the causes of a plan that one call of a planner commands as a whole: cause 0 is that call. `call`: its
    /// span.
    pub fn planner_causes(&mut self, call: Span) -> PlanCauses {
        let mut causes = PlanCauses::default();
        let cause = self.cause(call, Vec::new(), "");
        causes.number(cause);
        causes
    }

    /// Returns the default settings of the judge, with the sample limits of the run.
    pub fn judge_settings(&self) -> Settings {
        Settings { samples_max: self.limits().samples, ..Settings::default() }
    }

    /// Reports the actions that are too fast for the limits of the joints; returns true if there are none. `ids`: the
    /// run's number of each cause, indexed by the plan's number. `issues`: the actions.
    pub fn report_issues(&mut self, issues: &[behavior::Issue], ids: &[CauseId]) -> bool {
        for issue in issues {
            let issue = behavior::Issue { cause: ids[issue.cause.0 as usize], ..issue.clone() };
            let diagnostic = self.issue(&issue);
            self.add_report(diagnostic);
        }
        issues.is_empty()
    }

    /// Returns a kept plan of the same behaviour of the same robot; `None` if there is none. The causes must be
    /// the same, too: the same commands called from another line have others, and are planned again.
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
                && planned.stated_program().is_some_and(|stated| equal(stated, program))
        };
        self.memory.plans.iter().find(same).cloned()
    }

    fn keep_plan(&mut self, planned: Rc<PlanValue>) {
        if self.memory.plans.len() >= KEPT_MAX {
            self.memory.plans.remove(0);
        }
        self.memory.plans.push(planned);
    }

    /// Returns the causes of the joints' start positions and of the bonds.
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

    /// Returns the provenance of a plan of this run: the names and hashes of all texts, ascending by name, the seed
    /// and the version of modl. No planner is named.
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

    /// Returns the seed for a planner's random numbers: the one that is stated, else that of the run.
    pub fn seed(&self, stated: WordOr<Auto, usize>) -> u64 {
        match stated {
            WordOr::Word(Auto) => self.shared.options.seed,
            WordOr::Value(seed) => seed as u64,
        }
    }

    /// Returns the start pose of a robot as a plan of duration 0, not judged yet; `None` where its design is broken
    /// or no robot. Its world is that of the scene, or the default. `span`: the code that asks for the plan.
    ///
    /// # Errors
    /// As [`robot_of`](Self::robot_of).
    pub fn plan_pose(&mut self, design: &Rc<Design>, span: Span) -> Eval<Option<Rc<PlanValue>>> {
        let Some(robot) = self.robot_of(design, span)? else { return Ok(None) };
        let mut causes = PlanCauses::default();
        let set = self.start_causes(design, &robot, &mut causes);
        let still = Tracks::at_rest(robot.assembly.as_ref().clone(), robot.start.clone());
        let tracks = Tracks { start_causes: set.joints, bond_causes: set.bonds, ..still };
        let scheduled = Scheduled {
            tracks,
            program: crate::plan::Program { root: Arc::new(Node::Series(Vec::new())) },
            exemptions: Vec::new(),
            contracts: Vec::new(),
            nominal: false,
            actions: 0,
            open_turns: Vec::new(),
            issues: Vec::new(),
        };
        let world = robot.world.unwrap_or_default();
        Ok(Some(Rc::new(self.assemble_plan(design.clone(), robot, scheduled, &causes, world).0)))
    }

    /// Returns the verdict on a plan under these settings, and from its start on under `world` if it is given,
    /// otherwise under the plan's own worlds; the contracts of behaviours are judged with it. A verdict is computed once and
    /// kept with the plan. `planned`: the plan.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn judge(
        &mut self,
        planned: &PlanValue,
        settings: Settings,
        world: Option<World>,
    ) -> Eval<Rc<Verdict>> {
        let worlds = planned.worlds_in(world);
        let known = |judged: &&Judged| judged.settings == settings && judged.worlds == worlds;
        if let Some(judged) = planned.judged.borrow().iter().find(known) {
            return Ok(judged.verdict.clone());
        }
        crate::interrupt::start_task(format!("verifying {}", planned.robot.name));
        let plan = Plan { settings, worlds: worlds.clone(), ..planned.plan.clone() };
        let mut verdict = crate::plan::verify::verify(&plan);
        self.judge_contracts(planned, &plan, &mut verdict)?;
        let verdict = Rc::new(verdict);
        planned.judged.borrow_mut().push(Judged { settings, worlds, verdict: verdict.clone() });
        Ok(verdict)
    }

    /// Returns the state at a time (s), which is clamped to 0 and the duration of the plan, as a record. `planned`:
    /// the plan.
    ///
    /// # Errors
    /// A fault at `span` if the plan is of a lattice or a truss.
    pub fn state_at(&mut self, planned: &Rc<PlanValue>, time: f64, span: Span) -> Eval<Value> {
        let time = time.clamp(0.0, planned.plan.body.duration());
        self.require_joints(planned, span)?;
        let state = state_value(planned, &Rc::new(vec![time]), 0, OnceCell::new());
        Ok(state.map_or(Value::Unknown, |state| Value::Record(Rc::new(Record::State(Box::new(state))))))
    }

    /// Refuses a plan of a lattice or a truss, which has no joints. `planned`: the plan.
    ///
    /// # Errors
    /// A fault at `span` if the plan is of a lattice or a truss.
    pub fn require_joints(&self, planned: &PlanValue, span: Span) -> Eval<()> {
        if planned.body.is_some() {
            return Ok(());
        }
        let message = "a state is one of joints, and this robot has none";
        Err(fault(code::BAD_VALUE, span, message, "no joints; `show(.., at: ..)` draws it"))
    }

    /// Returns the plan that a value is or gives: a plan, a record about one, a behaviour, or the start pose of an
    /// instance's robot; `None` for other values, and where a plan could not be made, which has been reported.
    /// `span`: the code that asks for the plan.
    ///
    /// # Errors
    /// As [`plan_from`](Self::plan_from).
    pub fn plan_of(&mut self, value: &Value, span: Span) -> Eval<Option<Rc<PlanValue>>> {
        match value {
            Value::Behavior(behavior) => self.plan_behavior(behavior, span),
            Value::Record(record) => match &**record {
                Record::Plan(planned) => Ok(Some(planned.clone())),
                Record::Native(record) => Ok(record.plan().cloned()),
                _ => Ok(None),
            },
            Value::Instance(instance) => self.plan_pose(&instance.robot, span),
            _ => Ok(None),
        }
    }

    /// Returns the fault of a behaviour that has no motion, at the action to blame. `ids`: as for
    /// [`report_issues`](Self::report_issues). `refusal`: the reason why it has none; `span`: the code that asks for
    /// the plan.
    pub fn refused(&self, refusal: &behavior::Refusal, ids: &[CauseId], span: Span) -> Stop {
        super::verdicts::refused(self, refusal, ids, span)
    }
}

/// Gives bonds of a plan, by their indices, the turns that are nearest to how their ports stand when they dock, as the robots
/// have come there.
fn settle_turns(plan: &mut Plan, bonds: &[usize]) {
    if bonds.is_empty() {
        return;
    }
    let turns = crate::plan::verify::articulated::dock_turns(plan, bonds);
    if let Body::Tracks(tracks) = &mut plan.body {
        turns.into_iter().for_each(|(bond, turn)| tracks.robot.bonds[bond].turn = turn);
    }
}

/// Returns the state of a plan's robot at `times[own]`, a time (s) within the plan; `None` for plans of lattices and
/// trusses. `times`: those of all states that are made together; `base`: the pose of its base in the world, if it is
/// known already. `planned`: the plan.
pub fn state_value(
    planned: &Rc<PlanValue>,
    times: &Rc<Vec<f64>>,
    own: usize,
    base: OnceCell<Pose>,
) -> Option<StateValue> {
    let body = planned.body.clone()?;
    let time = times[own];
    let Snapshot::Robot(state) = planned.plan.body.state(time) else { return None };
    let (robot, planned, among) = (planned.robot.clone(), planned.clone(), (times.clone(), own));
    Some(StateValue { robot, body, state, time, planned, base, among, only: None })
}

/// Returns the corners of the support polygon of a robot that stands at rest in its start state on level ground under
/// standard gravity, counter-clockwise from above, m, in the frame of its base module's body; fewer than three if the
/// contacts span no area.
pub fn footprint(robot: &Robot) -> Vec<Vec3> {
    crate::plan::verify::articulated::area(&robot.assembly, &robot.start)
}
