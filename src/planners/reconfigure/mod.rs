//! `reconfigure`: from one configuration of RoFI modules to another of as many. There are two ways, and the plan is
//! the one that takes less time.
//!
//! Through the snake: both are unwound by [`tosnake`], and the second plan is run backwards.
//! Directly: a part that both have in common keeps its bonds, and only the others change.
//!
//! With gravity, on a floor, it is the direct way, and the robot stands all the time. Without a floor one shoe, one of
//! the two bodies of a RoFI module, is held fixed all the time. Then the second robot has to be held by a shoe that
//! ends at the same position in the snake as the shoe by which the first is held.

pub mod bound;
mod common_part;
mod direct;
mod paths;
mod standing;

use crate::optimize::random::SplitMix64;
use crate::plan::{self, Cause, Change, OperationError, Plan, Verdict, World, joined, reversed};
use crate::planners::tosnake::gravity::GravityModel;
use crate::planners::tosnake::search::StepSequence;
use crate::planners::tosnake::stance::Hindrances;
use crate::planners::tosnake::{self, Collisions, SearchCache, SearchStatus, Task};
use crate::planners::{Progress, Solution};
use crate::robot::{Assembly, State};
use std::error::Error;
use std::fmt;

pub use direct::Settings as DirectSettings;

/// A configuration of RoFI modules: a robot in a state.
#[derive(Clone, Copy, Debug)]
pub struct Configuration<'a> {
    /// The robot: an assembly of RoFI modules of one pitch.
    pub robot: &'a Assembly,
    /// The state of the robot: joint positions (rad), closed bonds, pose of the base in the world frame.
    pub state: &'a State,
}

impl<'a> Configuration<'a> {
    /// Returns the problem of unwinding the configuration into a snake.
    fn unwinding(&self, world: World) -> tosnake::Problem<'a> {
        tosnake::Problem { robot: self.robot, start: self.state, world }
    }
}

/// The start and the goal of a reconfiguration.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The configuration at the start, whose modules move.
    pub from: Configuration<'a>,
    /// The configuration at the goal, of as many modules as the start. Its modules have no identity: any of the
    /// start's may take the pose of any of the goal's.
    pub to: Configuration<'a>,
    /// The world of both halves. With gravity and a ground that bears, the robot rests on it; otherwise see
    /// [`tosnake::Problem::world`].
    pub world: World,
}

/// The settings of [`plan`](plan()): those of the searches for both halves of the motion, and of the judge.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The settings of the search for either half, with the defaults that its fields state.
    pub search: tosnake::Settings,
    /// The settings of the search for the direct way, with the defaults that its fields state.
    pub direct: DirectSettings,
    /// The settings of the search for the direct way on the floor, by default with more attempts
    /// ([`DirectSettings::on_floor`]).
    pub standing: DirectSettings,
    /// The settings of the judge. Under gravity the planner tries the shoes of the goal in turn as the one that is held
    /// (a shoe is one of the two bodies of a RoFI module), and the first plan of the whole motion that the judge
    /// accepts is the result. Without gravity nothing is judged. Default [`plan::Settings::default`].
    pub judge: plan::Settings,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            search: tosnake::Settings::default(),
            direct: DirectSettings::default(),
            standing: DirectSettings::on_floor(),
            judge: plan::Settings::default(),
        }
    }
}

/// The figures of a reconfiguration and of the search for it.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The figures of both halves together, without those of attempts under gravity that were not used.
    pub both: tosnake::Report,
    /// The way that the plan takes.
    pub way: Way,
    /// The least number of bonds that any plan has to dock or undock ([`bound::fewest_changes`]).
    pub fewest_changes: usize,
    /// The operations on plans by which the halves were joined, in order, for the plan's provenance: with names of
    /// modules of the goal that the start has otherwise, and a program that was dropped.
    pub history: Vec<Change>,
    /// The judge's verdict on the plan under gravity; `None` without gravity, where any pose of the goal will
    /// do and the plan is not judged here.
    pub verdict: Option<Verdict>,
}

/// The way of a reconfiguration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Way {
    /// Through the snake, with the duration (s) of the direct way if one was found.
    Snake {
        /// The duration of the direct way, s; `None` if none was found or looked for.
        direct: Option<f64>,
    },
    /// Directly, on the floor, with the bonds that stay.
    Standing {
        /// The number of bonds that are docked from the start to the end.
        kept: usize,
    },
    /// Directly, with the bonds that stay.
    Direct {
        /// The number of bonds that are docked from the start to the end.
        kept: usize,
        /// The duration of the way through the snake, s; `None` if none was found.
        snake: Option<f64>,
    },
    /// No bond differs, so that joints turn alone or nothing moves.
    #[default]
    Turning,
}

/// The reason why [`plan`](plan()) gives no reconfiguration.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The start and the goal have different numbers of modules.
    ModuleCount {
        /// The number of modules of the start.
        from: usize,
        /// The number of modules of the goal.
        to: usize,
    },
    /// The start can't be unwound into a snake, for the reason given.
    From(tosnake::Refusal),
    /// The goal can't be unwound into a snake, for the reason given.
    To(tosnake::Refusal),
    /// The two configurations unwind to different snakes.
    DifferentSnakes(OperationError),
    /// Under gravity, no motion found that unwinds the goal is held at the same position in the snake as the start and
    /// passes the judge.
    NotHeldAlike {
        /// The number of motions that unwind the goal that were found.
        unwound: usize,
    },
    /// On the floor, no direct way was found on which the robot stands all the time.
    NoStandingWay(NoStandingWay),
}

/// The reason why there is no way on the floor, and how far the search came.
#[derive(Clone, Debug, PartialEq)]
pub struct NoStandingWay {
    /// The hindrances of motions of the start's modules.
    pub hindrances: Hindrances,
    /// The number of pairs of docks that were tried, and of forward kinematics.
    pub status: SearchStatus,
    /// The number of ways that were found, none of which passed the judge.
    pub rejected: usize,
    /// True if the observer ended the search.
    pub stopped: bool,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::ModuleCount { from, to } => {
                write!(f, "a robot of {from} modules can't become one of {to}")
            }
            Refusal::From(refusal) => write!(f, "the start can't be unwound: {refusal}"),
            Refusal::To(refusal) => write!(f, "the goal can't be unwound: {refusal}"),
            Refusal::DifferentSnakes(error) => {
                write!(f, "both unwind to a snake, but not to the same one: {error}")
            }
            Refusal::NotHeldAlike { unwound } => write!(
                f,
                "no way under gravity: of {unwound} ways in which the second robot unwinds, none is held where the \
                 first one's snake is"
            ),
            Refusal::NoStandingWay(NoStandingWay { hindrances, status, .. }) => write!(
                f,
                "no way was found on which it stands all the time: {} pairs of docks were tried; on {} motions it would \
                 fall over, and on {} a joint would have too much to hold",
                status.tried, hindrances.falls, hindrances.overloads
            ),
        }
    }
}

impl Error for Refusal {}

/// Plans the motion from one configuration of RoFI modules to another. Through the snake, the first half unwinds the
/// start, as [`tosnake`] does, and the second half is the unwinding of the goal, run backwards. Directly, the bonds of a
/// common part stay, and the others are exchanged one by one. Of both the plan that takes less time is the result; the
/// direct way is looked for without gravity and with [`Collisions::Motion`]. `settings`: the settings of all searches and
/// of the judge; `progress` receives reports and may end the search.
///
/// Both ends are put down on a ground that bears them ([`World::floor_bears`]), and then the direct way alone is looked
/// for: the robot rests on what touches the floor at every instant, and its modules' joints hold that.
///
/// In the solution, cause 0 is that of the first half and cause 1 that of the second. At the end the start's modules
/// are in the poses of the goal's, up to one rigid motion of the whole robot. Under gravity the plan was verified by
/// the judge; without, it was not judged.
///
/// # Errors
/// [`Refusal`]: the numbers of modules differ; either configuration can't be unwound, or not within the budget, or the
/// search was stopped; the two snakes differ; under gravity, no motion found that unwinds the goal is held at the
/// same position in the snake as the start and passes the judge; or, on the floor, an end does not stand, or no way is
/// found.
///
/// # Examples
/// ```
/// use modl::plan::World;
/// use modl::planners::{NoProgress, reconfigure};
/// use modl::robot::{rofi, rofi_assembly};
///
/// // Two chains of three modules, end to end with a quarter turn to the one or the other side.
/// let twisted = |turn| {
///     let file = format!(
///         "C\nM 0 0 0 0\nM 1 0 0 0\nM 2 0 0 0\nM 3 0 0 0\nM 4 0 0 0\nM 5 0 0 0\n\
///         E 0 B -Z N -Z A 1\nE 1 B -Z N -Z A 2\nE 2 B -Z {turn} -Z A 3\nE 3 B -Z N -Z A 4\nE 4 B -Z N -Z A 5\n"
///     );
///     rofi_assembly::assembly(&rofi::read(&file).expect("the text is a configuration"), 0.1)
/// };
/// let ((east, east_state), (west, west_state)) = (twisted("E"), twisted("W"));
///
/// let problem = reconfigure::Problem {
///     from: reconfigure::Configuration { robot: &east, state: &east_state },
///     to: reconfigure::Configuration { robot: &west, state: &west_state },
///     world: World::FREE,
/// };
/// let solution = reconfigure::plan(&problem, &reconfigure::Settings::default(), &mut NoProgress)?;
/// // Both chains stay, and the bond between them is docked elsewhere before it is undocked.
/// assert_eq!((solution.report.both.docks, solution.report.both.undocks), (1, 1));
/// assert_eq!(solution.report.fewest_changes, 2);
/// # Ok::<(), reconfigure::Refusal>(())
/// ```
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    plan_with_cache(problem, settings, &mut SearchCache::default(), progress)
}

/// Plans as [`plan()`] does, and takes the steps of either half from `cache` if they were found before from the same
/// configuration with the same gravity and the same settings of the search, but for the number of threads; stores
/// those that it finds. `problem`: the start and the goal; `progress` receives reports and may end the search.
///
/// # Errors
/// As [`plan()`].
pub fn plan_with_cache(
    problem: &Problem,
    settings: &Settings,
    cache: &mut SearchCache,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let (from, to) = (problem.from.robot.modules.len(), problem.to.robot.modules.len());
    if from != to {
        return Err(Refusal::ModuleCount { from, to });
    }
    let (first, second) = (problem.from.unwinding(problem.world), problem.to.unwinding(problem.world));
    let first = tosnake::Task::new(&first, &settings.search).map_err(Refusal::From)?;
    let second = tosnake::Task::new(&second, &settings.search).map_err(Refusal::To)?;
    let fewest_changes = bound::fewest_changes(first.start(), second.start());
    if problem.world.floor_bears() {
        return Search { problem, settings, cache, progress, fewest_changes }.standing(&first, &second);
    }
    let mut search = Search { problem, settings, cache, progress, fewest_changes };
    if first.gravity.is_some() {
        return search.held_all_the_way(&first, second);
    }
    let snake = search.through_snake(&first, &second);
    // A start that is no valid configuration has no direct way either.
    if let Err(Refusal::From(invalid) | Refusal::To(invalid)) = &snake
        && !matches!(invalid, tosnake::Refusal::BudgetSpent(_))
    {
        return snake;
    }
    let limit = snake.as_ref().map_or(f64::INFINITY, |snake| snake.body.duration());
    let direct = match settings.search.collisions {
        Collisions::Motion => search.directly(&first, &second, limit)?,
        Collisions::None | Collisions::Detection | Collisions::Avoidance => None,
    };
    shorter(snake, direct)
}

/// Returns the solution of less duration, with that of the other in its report.
fn shorter(
    snake: Result<Solution<Report>, Refusal>,
    direct: Option<Solution<Report>>,
) -> Result<Solution<Report>, Refusal> {
    match (snake, direct) {
        (snake, None) => snake,
        (Ok(mut snake), Some(direct)) if snake.body.duration() <= direct.body.duration() => {
            snake.report.way = Way::Snake { direct: Some(direct.body.duration()) };
            Ok(snake)
        }
        (snake, Some(mut direct)) => {
            if let Way::Direct { snake: duration, .. } = &mut direct.report.way {
                *duration = snake.ok().map(|snake| snake.body.duration());
            }
            Ok(direct)
        }
    }
}

/// The parts that both halves share.
struct Search<'s> {
    problem: &'s Problem<'s>,
    settings: &'s Settings,
    cache: &'s mut SearchCache,
    progress: &'s mut dyn Progress,
    fewest_changes: usize,
}

/// One half: the plan to the snake, with its figures.
struct Half {
    plan: Plan,
    report: tosnake::Report,
}

impl Search<'_> {
    /// Plans the way through the snake without gravity.
    fn through_snake(&mut self, first: &Task, second: &Task) -> Result<Solution<Report>, Refusal> {
        let found = self.unwind(first).map_err(Refusal::From)?;
        let there = self.half(first, &found).map_err(Refusal::From)?;
        let found = self.unwind(second).map_err(Refusal::To)?;
        let back = self.half(second, &found).map_err(Refusal::To)?;
        let way = Way::Snake { direct: None };
        Ok(self.solution(whole(&there, &back)?, (&there, &back), way, None))
    }

    /// Plans the way under gravity.
    fn held_all_the_way(&mut self, first: &Task, second: Task) -> Result<Solution<Report>, Refusal> {
        let gravity = first.gravity.clone().expect("it is held");
        let found = self.unwind(first).map_err(Refusal::From)?;
        let there = self.half(first, &found).map_err(Refusal::From)?;
        self.held((&there, &found, &gravity), second)
    }

    /// Looks for direct ways of a duration below `limit` (s), from the start to the goal and from the goal to the start,
    /// and returns the plan of the one with the least duration; `None` if none is found.
    fn directly(
        &mut self,
        first: &Task,
        second: &Task,
        limit: f64,
    ) -> Result<Option<Solution<Report>>, Refusal> {
        let name = &self.problem.from.robot.name;
        self.progress.task_started(&|| format!("a direct way for {name}"));
        let settings = &self.settings.direct;
        let mut best: Option<(direct::Found, bool)> = None;
        let mut status = SearchStatus::default();
        for backwards in [false, true] {
            let (from, to) = if backwards { (second, first) } else { (first, second) };
            let all = common_part::correspondences(from.start(), to.start(), settings.correspondences_max);
            for correspondence in all.into_iter().filter(|all| all.exchanges <= settings.exchanges_max) {
                let mut search = direct::Search {
                    start: from.start(),
                    correspondence: &correspondence,
                    stance: None,
                    ends: &[],
                    pace: &|module, joint, turn| from.turn_duration(module, joint, turn),
                    settings,
                    ik: settings.inverse_kinematics,
                    rng: SplitMix64(self.settings.search.seed),
                    limit: best.as_ref().map_or(limit, |(known, _)| known.duration),
                    work: 0,
                    tried: 0,
                };
                let found = search.run(self.progress);
                (status.work, status.tried) = (status.work + search.work, status.tried + search.tried);
                best = found.map(|found| (found, backwards)).or(best);
            }
        }
        let Some((found, backwards)) = best else { return Ok(None) };
        let ends = if backwards { (second, first) } else { (first, second) };
        let (plan, halves, kept) = self.direct_plan(ends, found, (status, backwards))?;
        let way = kept.map_or(Way::Turning, |kept| Way::Direct { kept, snake: None });
        Ok(Some(self.solution(plan, (&halves[0], &halves[1]), way, None)))
    }

    /// Returns the plan of a direct way, with its two halves and the number of bonds that stay, `None` if no bond
    /// changes. `from`, `to`: the ends as the search had them; `backwards`: true if it went from the goal to the start.
    fn direct_plan(
        &self,
        (from, to): (&Task, &Task),
        found: direct::Found,
        (status, backwards): (SearchStatus, bool),
    ) -> Result<(Plan, [Half; 2], Option<usize>), Refusal> {
        let sequence = |(robot, steps), status| StepSequence { robot, steps, status };
        let none = SearchStatus::default();
        let near = self.half(from, &sequence(found.there, status)).map_err(Refusal::From)?;
        let far = self.half(to, &sequence(found.back, none)).map_err(Refusal::To)?;
        let (there, back) = if backwards { (far, near) } else { (near, far) };
        let plan = whole(&there, &back)?;
        let undocks = there.report.undocks + back.report.docks;
        let docks = there.report.docks + back.report.undocks;
        let first = if backwards { to } else { from };
        let kept = first.start().held().count().saturating_sub(undocks);
        Ok((plan, [there, back], (docks + undocks > 0).then_some(kept)))
    }

    /// Returns the solution of a whole plan, with the figures of its halves.
    fn solution(
        &self,
        plan: Plan,
        (there, back): (&Half, &Half),
        way: Way,
        verdict: Option<Verdict>,
    ) -> Solution<Report> {
        let both = there.report.and_back(&back.report);
        let history = plan.provenance.history;
        let report = Report { both, way, fewest_changes: self.fewest_changes, history, verdict };
        Solution { body: plan.body, program: plan.program, report }
    }

    /// Searches for the steps of one half, unless the cache has them.
    fn unwind(&mut self, task: &tosnake::Task) -> Result<std::rc::Rc<StepSequence>, tosnake::Refusal> {
        task.search(&self.settings.search, self.cache, self.progress)
    }

    /// Returns the plan of a step sequence, with one cause that stands for the call.
    fn half(&self, task: &tosnake::Task, found: &StepSequence) -> Result<Half, tosnake::Refusal> {
        let Solution { body, program, report } = task.solution(found)?;
        let library = body.tracks().expect("RoFI modules move by joints").robot.library.clone();
        let bare = Plan::bare(library, body, self.problem.world, self.settings.judge);
        let plan = Plan { program, causes: vec![Cause::planner_call()], ..bare };
        Ok(Half { plan, report })
    }

    /// Returns both halves with gravity. The goal is unwound held by each of its shoes in turn, with loops
    /// opened near each of its modules, until one is held where the first half's snake is: the position of a
    /// shoe in the snake is known only once the goal is unwound.
    fn held(
        &mut self,
        (there, first, gravity): (&Half, &StepSequence, &GravityModel),
        second: tosnake::Task,
    ) -> Result<Solution<Report>, Refusal> {
        let place = first.robot.beyond(gravity.held);
        let own = second.gravity.clone().expect("both robots have a gravity model");
        let (shoes, modules) = (own.shoes.len(), own.limits.len());
        let (mut work, mut unwound, mut last_refusal) = (first.status.work, 0, None);
        // Loops are opened far from the shoe that is held at first.
        let choices = (0..modules).flat_map(|turn| (0..shoes).map(move |held| (held, held / 2 + turn)));
        for (held, root) in choices {
            let gravity = GravityModel { held, root: root % modules, ..own.clone() };
            let task = second.with_gravity(gravity);
            match self.unwind(&task) {
                Err(refusal @ tosnake::Refusal::Stopped(_)) => return Err(Refusal::To(refusal)),
                Err(refusal) => last_refusal = Some(refusal),
                Ok(found) => {
                    (work, unwound) = (work + found.status.work, unwound + 1);
                    if found.robot.beyond(held) == place {
                        let back = self.half(&task, &found).map_err(Refusal::To)?;
                        let plan = whole(there, &back)?;
                        let name = &self.problem.from.robot.name;
                        self.progress.task_started(&|| format!("verifying {name}"));
                        let verdict = plan::verify::verify(&plan);
                        if verdict.ok() {
                            let way = Way::Snake { direct: None };
                            return Ok(self.solution(plan, (there, &back), way, Some(verdict)));
                        }
                    }
                }
            }
            if work > self.settings.search.budget {
                break;
            }
        }
        Err(match last_refusal.filter(|_| unwound == 0) {
            Some(refusal) => Refusal::To(refusal),
            None => Refusal::NotHeldAlike { unwound },
        })
    }
}

/// Returns the plan of the first half, and then the second half backwards.
fn whole(there: &Half, back: &Half) -> Result<Plan, Refusal> {
    joined(&there.plan, &reversed(&back.plan)).map_err(Refusal::DifferentSnakes)
}
