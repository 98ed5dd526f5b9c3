//! `fastest`: the time-optimal trajectory of an articulated robot along the path of a plan, by time-optimal path
//! parameterisation based on reachability analysis (TOPP-RA, Pham and Pham 2018, *A New Approach to Time-Optimal Path
//! Parameterization Based on Reachability Analysis*), under limits of speed, acceleration and torque.
//!
//! The path is cut into stretches at the instants at which the robot has to be at rest. In a stretch the velocity of
//! the path is the greatest under the limits on a grid, with constant acceleration of the path from point to point:
//! positions are the old polynomials composed with quadratic time laws, exactly. Their greatest speeds and
//! accelerations are bounded from the control points, and what is above a limit between points of the grid is slowed
//! down.
//!
//! ```
//! use modl::plan::{Body, Cause, CauseId, Plan, Segment, Settings, Track, Tracks, World, retimed};
//! use modl::planners::{NoProgress, fastest};
//! use modl::robot::*;
//! use std::sync::Arc;
//!
//! // A joint without load that turns at 2 rad/s, and gets there in half a second.
//! let limits = Limits { speed: Some(2.0), acceleration: Some(4.0), ..Limits::default() };
//! # use modl::geometry::{Placed, Pose, Shape, Vec3};
//! # let ball = vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: 0.02 } }];
//! # let link = |name: &str| Link {
//! #     name: name.to_owned(),
//! #     pose: Pose::identity(),
//! #     shape: ball.clone(),
//! #     collides: ball.clone(),
//! #     left_out: 0.0,
//! #     mass: 1.0,
//! #     com: Vec3::zeros(),
//! #     inertia: [1e-3, 1e-3, 1e-3, 0.0, 0.0, 0.0],
//! #     friction: 0.5,
//! #     surface: Surface::default(),
//! # };
//! # let module = ModuleType {
//! #     name: "Hinge".to_owned(),
//! #     links: vec![link("stand"), link("arm")],
//! #     joints: vec![Joint {
//! #         name: "turn".to_owned(),
//! #         parent: 0,
//! #         child: 1,
//! #         kind: JointKind::Revolute,
//! #         pose: Pose::identity(),
//! #         axis: Vec3::z(),
//! #         limits,
//! #         passive: false,
//! #         servo: modl::robot::Servo::default(),
//! #         mimic: None,
//! #     }],
//! #     ports: vec![],
//! #     motors: vec![],
//! #     touching: vec![(0, 1)],
//! #     touch: ModuleType::TOUCH_DEFAULT,
//! #     contact: ModuleType::CONTACT_DEFAULT,
//! # };
//! # let library = Arc::new(Library { modules: vec![module], ..Library::default() });
//! # let modules = vec![ModuleInstance { name: "hinge".to_owned(), kind: 0 }];
//! # let (name, bonds) = ("Turner".to_owned(), vec![]);
//! # let robot = Assembly { name, library: library.clone(), modules, bonds, base: 0, closed: false, misalignments: vec![] };
//! # let start = State { base: Pose::identity(), joints: vec![0.0], bonds: vec![], clusters: vec![], misalignments: vec![] };
//! // Three radians in ten seconds.
//! let control = vec![0.0, 0.0, 0.0, 3.0, 3.0, 3.0];
//! let segment = Segment { start: 0.0, end: 10.0, control, cause: CauseId(0) };
//! let tracks = vec![Track { joint: JointId(0), segments: vec![segment] }];
//! let tracks = Tracks { tracks, duration: 10.0, ..Tracks::at_rest(robot, start) };
//! let plan = Plan::bare(library, Body::Tracks(tracks), World::FREE, Settings::default());
//! let plan = Plan { causes: vec![Cause::planner_call()], ..plan };
//!
//! let settings = fastest::Settings::default();
//! let solution = fastest::plan(&fastest::Problem { plan: &plan }, &settings, &mut NoProgress)?;
//! // 3 rad at 2 rad/s, and half a second to get there, half of it at each end.
//! assert!((solution.body.duration() - 2.0).abs() < 1e-6);
//! let clock = |time: f64| solution.report.clock.at(time);
//! let tracks = solution.body.tracks().expect("a robot with joints");
//! let faster = retimed(&plan, tracks.clone(), &clock, settings.reserve);
//! assert!(modl::plan::verify::verify(&faster).ok());
//! # Ok::<(), fastest::Refusal>(())
//! ```

mod constraints;
mod drives;
mod motion;
mod path;
mod reachability;
mod slowdown;
mod time_law;
mod tolerances;
mod torque;

pub use motion::Clock;

use super::{Progress, Solution};
use crate::plan::time::DURATION_MAX;
use crate::plan::validation::check;
use crate::plan::{Body, Failure, Plan, PlanFault};
use crate::robot::dynamics::Dynamics;
use crate::units::{Dimension, quantity};
use motion::{Timed, ratios};
use path::{Part, Stretch};
use std::fmt;
use time_law::{Grid, Limits, TimeLaw, equidistributed, grid, solve};
use tolerances::TOLERANCES;

/// The greatest number of times that a time law is slowed down by its greatest ratio to a limit. After the first, only
/// rounding of durations and control points is left.
const SCALINGS_MAX: u32 = 12;

/// A problem of retiming: a plan whose path is to be taken in less time.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The plan, of an articulated robot.
    pub plan: &'a Plan,
}

/// The settings of [`plan`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The part of the limits of torque and of the loads of bonds that is left unused, without unit, from 0 to below 1.
    /// Default 0.15: loads are known within some 10 %, and a plan that takes the least time is at its limits
    /// throughout.
    pub reserve: f64,
    /// The least number of intervals of the first grid of a stretch; finer ones are added beside instants of rest.
    /// Default 250.
    pub intervals: usize,
    /// The greatest number of times that the grid is refined, or limits lowered, where they are exceeded between its
    /// points. Default 6.
    pub refinements: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { reserve: 0.15, intervals: 250, refinements: 6 }
    }
}

/// The figures of a retimed plan: its clock, and the numbers of its parts and of the verdicts that it took.
#[derive(Clone)]
pub struct Report {
    /// The new times of the old ones, for events other than the tracks.
    pub clock: Clock,
    /// The number of stretches between instants of rest.
    pub stretches: usize,
    /// The number of intervals of the last grids of all stretches.
    pub intervals: usize,
    /// The greatest factor on the duration of a stretch that was slowed down because the judge found a load too great;
    /// 1 if there is none.
    pub slowed: f64,
    /// The number of verdicts that were asked for.
    pub verdicts: usize,
}

/// The reason why a plan is not retimed. Times are those of the plan, s.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The plan is not sound.
    Unsound(PlanFault),
    /// The plan is of a lattice or a truss.
    Family,
    /// The reserve is below 0, 1 or more, or no number.
    Reserve,
    /// A joint moves that states no acceleration limit, nor does a motor that drives it; or nothing limits the velocity
    /// of its path.
    NoAcceleration {
        /// The path name of the joint.
        joint: String,
        /// The beginning of the stretch in which it moves, s.
        time: f64,
    },
    /// A joint has a polynomial of too high a degree, on a path that is not a straight line: composed with a time law,
    /// which doubles it, it would exceed that of plans.
    Degree {
        /// The path name of the joint.
        joint: String,
        /// The beginning of the polynomial, s.
        time: f64,
        /// The degree of the polynomial.
        degree: usize,
    },
    /// The torque of a joint or motor is over its limit at rest.
    Overloaded {
        /// The path name of the joint or motor.
        name: String,
        /// The torque at rest, N·m or N.
        torque: f64,
        /// The part of the stated limit that the reserve leaves, N·m or N.
        allowed: f64,
        /// The stated limit, N·m or N.
        limit: f64,
        /// True for a torque, false for a force.
        turns: bool,
        /// The beginning of the stretch, s.
        from: f64,
        /// The end of the stretch, s.
        to: f64,
    },
    /// The judge finds a load too great however slow the motion is.
    Unholdable {
        /// The failure, at a time of the slow motion.
        failure: Box<Failure>,
    },
    /// The plan would last longer than a plan may, or for ever.
    TooLong,
    /// The observer ended the work.
    Stopped,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let seconds = |t: f64| quantity(t, Dimension::TIME);
        match self {
            Refusal::Unsound(fault) => fault.fmt(f),
            Refusal::Family => f.write_str("only plans of robots with joints are retimed"),
            Refusal::Reserve => f.write_str("a reserve is from 0 to below 1"),
            Refusal::NoAcceleration { joint, time } => {
                write!(f, "{joint} moves from {} on, and states no greatest acceleration", seconds(*time))
            }
            Refusal::Degree { joint, time, degree } => write!(
                f,
                "{joint} moves by a polynomial of degree {degree} from {} on, along a curve: with a time law it \
                 would be of a degree above that of plans",
                seconds(*time)
            ),
            Refusal::Overloaded { name, torque, allowed, limit, turns, from, to } => {
                let dimension = if *turns { Dimension::TORQUE } else { Dimension::FORCE };
                let [torque, allowed, limit] = [torque, allowed, limit].map(|v| quantity(*v, dimension));
                let (from, to) = (seconds(*from), seconds(*to));
                write!(f, "{name} holds {torque} at rest between {from} and {to}; ")?;
                write!(f, "it can hold {limit}, {allowed} of it with the reserve")
            }
            Refusal::Unholdable { failure } => {
                write!(f, "slower motion does not help: {}", failure.message)
            }
            Refusal::TooLong => write!(f, "a plan lasts at most {}", seconds(DURATION_MAX)),
            Refusal::Stopped => f.write_str("the work was ended"),
        }
    }
}

impl std::error::Error for Refusal {}

/// Returns the trajectory along the path of a plan that takes the least time under its limits, up to the resolution of
/// the grid (TOPP-RA, Pham and Pham 2018): tracks with the causes of the old ones, and docking at the same points of
/// the path. Worlds and exemptions are moved by the clock of the report ([`crate::plan::retimed`]).
///
/// Torque and loads of bonds count under full dynamics only. The torques of a robot whose base a fixture holds limit
/// the time law itself; for all other loads stretches are slowed down as a whole until the judge passes them.
///
/// # Errors
/// The [`Refusal`] that keeps the plan from being retimed.
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    if !(0.0..1.0).contains(&settings.reserve) {
        return Err(Refusal::Reserve);
    }
    let plan = problem.plan;
    let old = plan.body.tracks().ok_or(Refusal::Family)?;
    check(plan).map_err(Refusal::Unsound)?;
    let drives = drives::limited(&old.robot);
    let dynamics = Dynamics::new(&old.robot);
    let parts = path::parts(old)?;
    let count = parts.len();
    let mut timed = Vec::with_capacity(count);
    let (mut stretches, mut intervals) = (0, 0);
    for (index, part) in parts.into_iter().enumerate() {
        progress.report(&|| format!("{index} of {count} parts of the path"));
        if !progress.should_continue() {
            return Err(Refusal::Stopped);
        }
        let law = match &part {
            Part::Pause { .. } => None,
            Part::Stretch(stretch) => {
                drives::check(stretch, &old.robot, &drives)?;
                let torques = torque::torques(plan, old, stretch, &dynamics, settings.reserve);
                let limits = Limits { robot: &old.robot, drives: &drives, torques };
                let law = law(stretch, &limits, settings)?;
                (stretches, intervals) = (stretches + 1, intervals + law.grid.nodes.len() - 1);
                Some(law)
            }
        };
        timed.push(Timed::new(part, law));
    }
    let (_, clock) = motion::tracks(old, &timed);
    too_long(&clock)?;
    let found = slowdown::slowed(plan, old, &mut timed, settings, progress)?;
    too_long(&found.clock)?;
    let report =
        Report { clock: found.clock, stretches, intervals, slowed: found.factor, verdicts: found.verdicts };
    Ok(Solution { body: Body::Tracks(found.tracks), program: None, report })
}

/// Checks that a plan does not last longer than a plan may.
///
/// # Errors
/// [`Refusal::TooLong`].
fn too_long(clock: &Clock) -> Result<(), Refusal> {
    if clock.duration() <= DURATION_MAX { Ok(()) } else { Err(Refusal::TooLong) }
}

/// Returns the time law of a stretch that keeps its limits of speed and acceleration at every instant: on a grid that
/// is refined where they are exceeded between its points, and then slowed down by the greatest ratio to a limit, at
/// most [`SCALINGS_MAX`] times; what rounding leaves above a limit after that is left to the judge.
///
/// # Errors
/// Those of [`solve`].
fn law(stretch: &Stretch, limits: &Limits, settings: &Settings) -> Result<TimeLaw, Refusal> {
    let mut law = solve(stretch, Grid::new(grid(stretch, settings)), limits)?;
    if !stretch.straight || limits.torques.is_some() {
        law = solve(stretch, equidistributed(stretch, &law, settings), limits)?;
    }
    for _ in 0..settings.refinements {
        let ratios = ratios(stretch, &law, limits.drives);
        if ratios.iter().all(|ratio| *ratio <= 1.0 + TOLERANCES.excess) {
            break;
        }
        law = solve(stretch, law.refined(&ratios), limits)?;
    }
    // Slowing down by the greatest ratio that is left, with ever more room for rounding.
    for round in 0..SCALINGS_MAX {
        let worst = ratios(stretch, &law, limits.drives).into_iter().fold(0.0, f64::max);
        if worst <= 1.0 {
            break;
        }
        let spare = 1.0 + TOLERANCES.limit * f64::from(1u32 << round);
        law.speeds.iter_mut().for_each(|speed| *speed /= worst * spare);
    }
    Ok(law)
}
