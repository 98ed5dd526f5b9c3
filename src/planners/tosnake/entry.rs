//! The entry of the planner: from an assembly of RoFI modules to a scheduled motion.

use super::bound::fewest_changes;
use super::cache::{SearchCache, SearchKey};
use super::conversion::{Translated, translated};
use super::gravity::{GravityModel, JointLoad};
use super::mass_model::{gravity_model, turned_down};
use super::refusal::{Operation, Overload, Refusal};
use super::robot::Robot;
use super::search::{self, StepSequence};
use super::settings::{Collisions, Settings};
use super::stance::Stance;
use super::state::{self, Step};
use super::status::SearchStatus;
use super::tolerances::TOLERANCES;
use super::validation;
use crate::behavior;
use crate::geometry::Vec3;
use crate::plan::{Body, CauseId, World};
use crate::planners::{Progress, Solution};
use crate::robot::{Assembly, State};
use std::rc::Rc;
use std::sync::Arc;

/// A problem of unwinding: a robot that is to become a snake, with its start and its world.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The robot: an assembly of RoFI modules of one pitch.
    pub robot: &'a Assembly,
    /// The state at the start: joint positions (rad), closed bonds, pose of the base in the world frame.
    pub start: &'a State,
    /// The world of the plan. With gravity the base module is held fixed, whatever the ground, and no joint may exceed
    /// its torque limit; without gravity the robot floats.
    pub world: World,
}

/// The figures of a plan to the snake and of the search for it: numbers of actions and attempts, joint travel and
/// work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The number of docking actions of the plan.
    pub docks: usize,
    /// The number of undocking actions of the plan.
    pub undocks: usize,
    /// The least number of docking and undocking actions of any plan to a snake.
    pub fewest_changes: usize,
    /// The joint travel of the plan: the sum of the absolute angles of all turns of all joints, rad.
    pub joint_travel: f64,
    /// The number of attempts to bring a pair of ends together; if the steps come from the cache, those of the search
    /// that found them.
    pub tried: u64,
    /// The number of forward kinematics of the whole robot that were evaluated; if the steps come from the cache,
    /// those of the search that found them.
    pub work: u64,
    /// The number of actions of the plan's program.
    pub actions: u64,
}

impl Report {
    /// Returns the figures of this plan and another one in reverse after it.
    pub(crate) fn and_back(&self, back: &Report) -> Report {
        Report {
            docks: self.docks + back.undocks,
            undocks: self.undocks + back.docks,
            fewest_changes: self.fewest_changes + back.fewest_changes,
            joint_travel: self.joint_travel + back.joint_travel,
            tried: self.tried + back.tried,
            work: self.work + back.work,
            actions: self.actions + back.actions,
        }
    }
}

/// Plans the motion from a configuration of RoFI modules to a snake, after [Mrázek et al.](super): one straight chain
/// of all modules, dock -Z on dock -Z. `settings`: the settings of the search.
///
/// All causes of the solution are cause 0; its program is a series of steps, in each of which all joints
/// move at once. The robot never falls apart and its modules never overlap, as far as the planner checks and provided
/// that [`Settings::collisions`] is [`Collisions::Motion`]; the judge has to confirm it.
///
/// # Errors
/// [`Refusal`]: the assembly is none of RoFI modules, the start is invalid, the docks of a bond that closes a loop do
/// not meet, torque limits or the budget do not suffice, [Mrázek et al.](super)'s method fails or is asked for under
/// gravity, the steps can't be scheduled, or `progress` ended the search.
///
/// # Examples
/// ```
/// use modl::plan::World;
/// use modl::planners::{NoProgress, tosnake};
/// use modl::robot::{rofi, rofi_assembly};
///
/// // Two chains of three modules, end to end with a quarter turn.
/// let file = "C\nM 0 0 0 0\nM 1 0 0 0\nM 2 0 0 0\nM 3 0 0 0\nM 4 0 0 0\nM 5 0 0 0\n\
///     E 0 B -Z N -Z A 1\nE 1 B -Z N -Z A 2\nE 2 B -Z E -Z A 3\nE 3 B -Z N -Z A 4\nE 4 B -Z N -Z A 5\n";
/// let world = rofi::read(file).expect("the text is a configuration");
/// let (robot, start) = rofi_assembly::assembly(&world, 0.1);
///
/// let problem = tosnake::Problem { robot: &robot, start: &start, world: World::FREE };
/// let solution = tosnake::plan(&problem, &tosnake::Settings::default(), &mut NoProgress)?;
/// // Their other ends dock, and the bond between them is undocked.
/// assert_eq!((solution.report.docks, solution.report.undocks), (1, 1));
/// assert!(solution.body.duration() > 0.0);
/// # Ok::<(), tosnake::Refusal>(())
/// ```
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    plan_with_cache(problem, settings, &mut SearchCache::default(), progress)
}

/// Plans as [`plan`] does, and takes the steps from `cache` if the same robot was unwound from the same start (joint
/// positions and bonds) with the same gravity and the same settings, but for the number of threads. Otherwise it
/// searches, and stores what it finds. A failed search stores nothing. `problem`: the robot with its start and world;
/// `progress` receives reports and may end the search.
///
/// # Errors
/// As [`plan`].
pub fn plan_with_cache(
    problem: &Problem,
    settings: &Settings,
    cache: &mut SearchCache,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let task = Task::new(problem, settings)?;
    let found = task.search(settings, cache, progress)?;
    task.solution(&found)
}

/// A problem of unwinding translated into the planner's own model.
#[derive(Clone)]
pub(crate) struct Task<'a> {
    problem: Problem<'a>,
    translated: Rc<Translated<'a>>,
    /// The gravity model of a robot that is held fast; `None` if it floats.
    pub(crate) gravity: Option<GravityModel>,
}

impl<'a> Task<'a> {
    /// Translates a problem into the planner's model.
    ///
    /// # Errors
    /// [`Refusal::NotRofi`] for other modules; [`Refusal::GravityUnsupported`] if the settings choose the method of
    /// [Mrázek et al.](super) under gravity.
    pub(crate) fn new(problem: &Problem<'a>, settings: &Settings) -> Result<Task<'a>, Refusal> {
        let Problem { robot, start, world } = *problem;
        let translated = translated(robot, start).map_err(Refusal::NotRofi)?;
        let mut gravity = None;
        if world.gravity > 0.0 {
            if settings.collisions != Collisions::Motion {
                return Err(Refusal::GravityUnsupported);
            }
            gravity = Some(gravity_model(robot, &start.base, world.gravity).map_err(Refusal::NotRofi)?);
        }
        Ok(Task { problem: *problem, translated: Rc::new(translated), gravity })
    }

    /// Returns the same task with this gravity model in place of its own.
    pub(crate) fn with_gravity(&self, gravity: GravityModel) -> Task<'a> {
        Task { gravity: Some(gravity), ..self.clone() }
    }

    /// Returns the rests on the floor in which the robot may begin or end, as unit vectors of gravity in the frame of
    /// the shoe that its gravity model names: that in which it was drawn if it leans by no more than
    /// [`upright`](super::Tolerances::upright) when it is put down, else all that are found, those nearest to that into
    /// which it rolls first.
    ///
    /// # Errors
    /// [`Refusal::InvalidStart`] and [`Refusal::OpenLoop`] as for a robot that floats; [`Refusal::DoesNotStand`] if
    /// there is no rest but on a brink; [`Refusal::Overload`] if joints are overloaded in each. Panics if the problem
    /// has no gravity.
    pub(crate) fn rests(&self) -> Result<Vec<Vec3>, Refusal> {
        validation::check(self.start())?;
        let gravity = self.gravity.as_ref().expect("what falls has a weight");
        let mut state = state::State::new(self.start().clone());
        let drawn = state.poses[state.tree.index[gravity.held]].rotation * gravity.down;
        let mut all = gravity.rests(&state.tree, &state.poses, drawn);
        let Some(first) = all.first().map(|rest| rest.down) else {
            let settled = gravity.settled(&state.tree, &state.poses, drawn);
            return Err(Refusal::DoesNotStand { margin: settled.map_or(0.0, |rest| rest.margin) });
        };
        if first.dot(&drawn) > libm::cos(TOLERANCES.upright) {
            all.truncate(1);
        }
        all.sort_by(|p, q| q.down.dot(&first).total_cmp(&p.down.dot(&first)));
        let stance = Stance::new(Arc::new(gravity.clone()), gravity.held, gravity.down);
        let mut held = Vec::new();
        for rest in &all {
            let stance = stance.turned(&state.tree, &state.poses, rest.down);
            let down = stance.down;
            state.stance = Some(stance);
            if state.stands() {
                held.push(down);
            }
        }
        if held.is_empty() {
            let load = stance.least_overload().unwrap_or(JointLoad::NONE);
            let (operation, status) = (Operation::HoldingStart, SearchStatus::default());
            return Err(Refusal::Overload(Overload { load, operation, status }));
        }
        Ok(held)
    }

    /// Returns the start with its base turned by the least angle so that gravity acts along a unit vector, given in the
    /// frame of the shoe that the robot's gravity model names.
    pub(crate) fn laid(&self, down: Vec3) -> State {
        let Problem { robot, start, .. } = self.problem;
        let base = turned_down(robot, &start.base, down).expect("it was translated: it is of RoFI modules");
        State { base, ..start.clone() }
    }

    /// Returns the start configuration.
    pub(crate) fn start(&self) -> &Robot {
        &self.translated.robot
    }

    /// Returns the least duration (s) of a smooth turn of a joint of a module by an angle (rad) from rest to rest.
    pub(crate) fn turn_duration(&self, module: usize, joint: usize, turn: f64) -> f64 {
        self.translated.duration(module, joint, turn)
    }

    /// Returns the steps to the snake from the cache; searches for them if they are not there, and stores them.
    ///
    /// # Errors
    /// As [`search::unwind`](super::search::unwind); nothing is stored then.
    pub(crate) fn search(
        &self,
        settings: &Settings,
        cache: &mut SearchCache,
        progress: &mut dyn Progress,
    ) -> Result<Rc<StepSequence>, Refusal> {
        let (robot, gravity) = (self.start().clone(), self.gravity.clone());
        let key = SearchKey::new(robot, settings, gravity);
        if let Some(found) = cache.get(&key) {
            return Ok(found);
        }
        progress.task_started(&|| format!("unwinding {}", self.problem.robot.name));
        let found = Rc::new(search::unwind(self.start(), self.gravity.as_ref(), settings, progress)?);
        cache.insert(key, found.clone());
        Ok(found)
    }

    /// Schedules a step sequence as a motion of the assembly, with the report of the search; all its causes are 0.
    ///
    /// # Errors
    /// [`Refusal::Schedule`] if the steps can't be scheduled.
    pub(crate) fn solution(&self, found: &StepSequence) -> Result<Solution<Report>, Refusal> {
        let Problem { robot, start, .. } = self.problem;
        let scheduled = behavior::schedule(behavior::Problem {
            robot: robot.clone(),
            start: start.clone(),
            program: self.translated.program(&found.steps, &found.robot.bonds, CauseId(0)),
            start_causes: Vec::new(),
            bond_causes: (0..robot.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
            settings: behavior::Settings::default(),
        })
        .map_err(Refusal::Schedule)?;
        assert!(scheduled.exemptions.is_empty() && !scheduled.nominal, "steps have neither");
        let report = Report { actions: scheduled.actions, ..report(self.start(), found) };
        Ok(Solution { body: Body::Tracks(scheduled.tracks), program: Some(scheduled.program), report })
    }
}

/// Returns the figures of a step sequence, without the number of actions.
fn report(start: &Robot, found: &StepSequence) -> Report {
    let bonds = start.held().map(|(_, bond)| ([bond.a.module, bond.b.module], bond.is_snake_bond()));
    let mut report = Report {
        fewest_changes: fewest_changes(start.modules(), bonds),
        tried: found.status.tried,
        work: found.status.work,
        ..Report::default()
    };
    let mut joints = start.joints.clone();
    for step in &found.steps {
        match step {
            Step::Dock(_) => report.docks += 1,
            Step::Undock(_) => report.undocks += 1,
            Step::Turn(turns) => {
                for &(module, joint, to) in turns {
                    report.joint_travel += (to - joints[module][joint]).abs();
                    joints[module][joint] = to;
                }
            }
        }
    }
    report
}
