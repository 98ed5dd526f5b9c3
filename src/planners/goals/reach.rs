//! Inverse kinematics of a frame of a robot: postures that bring it to a place, and of those the one to take.
//!
//! Damped least squares within the limits of the joints ([`Chain`]), begun from where the robot stands and from random
//! postures. Of several solutions those in which nothing meets are taken before others, and of these the one that is
//! nearest. If the task leaves freedom, projected descent serves the secondary tasks: bodies keep a clearance, and the centre
//! of mass of a robot that stands on the ground stays above where it was.

use super::free_space::FreeSpace;
use super::tolerances::TOLERANCES;
use crate::geometry::{Pose, Vec3};
use crate::optimize::random::SplitMix64;
use crate::planners::Progress;
use crate::robot::chain::{Chain, DescentSettings, Orientation, PoseError, Target};
use crate::units::{Dimension, quantity};
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt;

/// A frame that is to be somewhere.
pub struct Problem<'a> {
    /// The chain from the link that stays where it is to the frame.
    pub chain: &'a Chain,
    /// The place, in the frame of that link.
    pub target: Target,
    /// The positions of all joints in which the motion begins, rad or m.
    pub joints: &'a [f64],
    /// The names of all joints, for refusals.
    pub names: &'a [String],
}

/// The settings of [`plan`](plan()).
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The greatest number of postures from which the search begins. Default 20.
    pub starts: usize,
    /// The number of solutions in which nothing meets, after which the search ends. Default 4.
    pub solutions: usize,
    /// The seed of the random postures. Default 0.
    pub seed: u64,
    /// The limits of each descent.
    pub descent: DescentSettings,
    /// The distance that bodies keep as far as the task leaves freedom, m. Default 5 mm.
    pub clearance: f64,
    /// True if the centre of mass is to stay above where it was as far as the task leaves freedom. Default false.
    pub balance: bool,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            starts: 20,
            solutions: 4,
            seed: 0,
            descent: DescentSettings::default(),
            clearance: 5e-3,
            balance: false,
        }
    }
}

/// A posture that reaches the place.
#[derive(Clone, Debug, PartialEq)]
pub struct Posture {
    /// The positions of all joints, rad or m.
    pub joints: Vec<f64>,
    /// The error that is left.
    pub error: PoseError,
    /// The number of postures from which the search began.
    pub starts: usize,
    /// True if nothing meets.
    pub free: bool,
}

/// The reason why there is no posture.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The place is farther away than the chain is long.
    TooFar {
        /// The distance of the place from the link that stays where it is, m.
        distance: f64,
        /// The length of the chain from axis to axis, m.
        length: f64,
    },
    /// No descent came to the place.
    Unreachable {
        /// The error of the nearest posture.
        error: PoseError,
        /// The place of the frame in it, in the frame of the link that stays where it is, unless who passes the refusal
        /// on says otherwise.
        nearest: Pose,
        /// The number of postures from which the search began.
        starts: usize,
        /// The joints that are at an end of their range in it, by name.
        at_limit: Vec<String>,
    },
    /// The chain has no joints that take commands.
    NoJoints,
    /// The observer ended the search.
    Stopped,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let length = |x: f64| quantity(x, Dimension::LENGTH);
        match self {
            Refusal::TooFar { distance, length: reach } => write!(
                f,
                "the place is {} away, and the chain is {} long from axis to axis",
                length(*distance),
                length(*reach)
            ),
            Refusal::Unreachable { error, nearest, starts, at_limit } => {
                // Less than a nanometre is rounding.
                let p =
                    nearest.translation.vector.map(|x| if x.abs() < TOLERANCES.rounding { 0.0 } else { x });
                let place = format!("[{}, {}, {}]", length(p.x), length(p.y), length(p.z));
                write!(f, "the nearest of {starts} starts comes to {place}, {}", apart(error))?;
                match at_limit.as_slice() {
                    [] => Ok(()),
                    joints => write!(f, ", with {} at the end of the range", quoted(joints)),
                }
            }
            Refusal::NoJoints => write!(f, "no joint that takes commands is on the way"),
            Refusal::Stopped => write!(f, "the search was stopped"),
        }
    }
}

impl Error for Refusal {}

/// Returns an error of a pose in words: `12 mm and 3 deg off`.
pub(super) fn apart(error: &PoseError) -> String {
    let distance = quantity(error.distance, Dimension::LENGTH);
    if error.angle == 0.0 {
        return format!("{distance} off");
    }
    format!("{distance} and {} off", quantity(error.angle, Dimension::ANGLE))
}

/// Returns names in quotes, in a list.
pub(super) fn quoted(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

/// The greatest number of steps of the secondary tasks.
const SECONDARY_STEPS_MAX: usize = 30;

/// Returns a posture that brings the frame to its place, the nearest that was found of those in which nothing meets; if
/// there are none of these, of all. `space`: the free space of the chain's joints.
///
/// # Errors
/// A [`Refusal`] where no posture was found.
pub fn plan(
    problem: &Problem,
    space: &mut FreeSpace,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Posture, Refusal> {
    let chain = problem.chain;
    if chain.joints().is_empty() {
        return Err(Refusal::NoJoints);
    }
    let distance = problem.target.position.norm();
    if distance > chain.length() + settings.descent.tolerance.distance {
        return Err(Refusal::TooFar { distance, length: chain.length() });
    }
    let mut rng = SplitMix64(settings.seed);
    let mut solutions: Vec<Posture> = Vec::new();
    let mut nearest: Option<(PoseError, Vec<f64>)> = None;
    let mut starts = 0;
    while starts < settings.starts {
        let mut joints = problem.joints.to_vec();
        let error = if starts == 0 {
            chain.descend(&problem.target, &mut joints, &settings.descent).0
        } else {
            chain.scatter(problem.joints, &mut joints, &mut rng);
            chain.attempt(&problem.target, &mut joints, &settings.descent)
        };
        starts += 1;
        if error.is_within(&settings.descent.tolerance) {
            unwind(chain, problem.joints, &mut joints);
            let free = space.meeting(&joints).is_none();
            solutions.push(Posture { joints, error, starts, free });
            if solutions.iter().filter(|found| found.free).count() >= settings.solutions {
                break;
            }
        } else if nearest.as_ref().is_none_or(|(least, _)| chain.merit(&error) < chain.merit(least)) {
            nearest = Some((error, joints));
        }
        progress.report(&|| format!("{starts} of {} starts", settings.starts));
        if !progress.should_continue() {
            return Err(Refusal::Stopped);
        }
    }
    let way = |found: &Posture| travel(chain, problem.joints, &found.joints);
    let best = solutions.into_iter().min_by(|a, b| b.free.cmp(&a.free).then(way(a).total_cmp(&way(b))));
    let Some(best) = best else {
        let (_, mut joints) = nearest.expect("a start that gives no solution gives a posture");
        let error = chain.approach(&problem.target, &mut joints, &settings.descent);
        let at_limit = chain.joints().iter().filter(|joint| {
            let at = joints[joint.joint];
            at <= joint.limits.0 || at >= joint.limits.1
        });
        let at_limit = at_limit.map(|joint| problem.names[joint.joint].clone()).collect();
        return Err(Refusal::Unreachable { error, nearest: chain.pose(&joints), starts, at_limit });
    };
    Ok(refined(problem, space, settings, Posture { starts, ..best }))
}

/// Takes whole turns off joints that turn for ever, so that they are within half a turn of `begin`.
fn unwind(chain: &Chain, begin: &[f64], joints: &mut [f64]) {
    for joint in chain.joints().iter().filter(|joint| !joint.slides && joint.limits.0 == f64::NEG_INFINITY) {
        let at = &mut joints[joint.joint];
        *at -= TAU * libm::round((*at - begin[joint.joint]) / TAU);
    }
}

/// Returns the greatest way of a joint.
fn travel(chain: &Chain, from: &[f64], to: &[f64]) -> f64 {
    chain.joints().iter().map(|joint| (to[joint.joint] - from[joint.joint]).abs()).fold(0.0, f64::max)
}

/// Returns a posture that is better in the secondary tasks, if the target leaves freedom.
fn refined(problem: &Problem, space: &mut FreeSpace, settings: &Settings, mut best: Posture) -> Posture {
    let chain = problem.chain;
    let rows = match problem.target.orientation {
        Orientation::Free => 3,
        Orientation::Along(_) => 5,
        Orientation::Full(_) => 6,
    };
    if chain.joints().len() <= rows {
        return best;
    }
    let stood = settings.balance.then(|| space.centre_of_mass(problem.joints));
    let mut cost = secondary(space, settings, stood, &best.joints);
    let mut step = TOLERANCES.secondary_step;
    for _ in 0..SECONDARY_STEPS_MAX {
        if cost < TOLERANCES.cost || step < TOLERANCES.slope_step {
            break;
        }
        let slopes: Vec<f64> = chain
            .joints()
            .iter()
            .map(|joint| {
                let mut near = best.joints.clone();
                near[joint.joint] += TOLERANCES.slope_step;
                (secondary(space, settings, stood, &near) - cost) / TOLERANCES.slope_step
            })
            .collect();
        let steepest = slopes.iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
        if steepest == 0.0 {
            break;
        }
        let mut joints = best.joints.clone();
        for (joint, slope) in chain.joints().iter().zip(&slopes) {
            let at = &mut joints[joint.joint];
            *at = (*at - step * slope / steepest).clamp(joint.limits.0, joint.limits.1);
        }
        let (error, _) = chain.descend(&problem.target, &mut joints, &settings.descent);
        let found = secondary(space, settings, stood, &joints);
        if error.is_within(&settings.descent.tolerance) && found < cost {
            cost = found;
            best = Posture { free: space.meeting(&joints).is_none(), joints, error, starts: best.starts };
        } else {
            step /= 2.0;
        }
    }
    best
}

/// Returns the cost of the secondary tasks: the square of what is missing of the clearance, and of the way of the centre of
/// mass over the ground.
fn secondary(space: &mut FreeSpace, settings: &Settings, stood: Option<Vec3>, joints: &[f64]) -> f64 {
    let nearest = space.nearest(joints, settings.clearance).map_or(settings.clearance, |near| near.distance);
    let missing = if settings.clearance > 0.0 { 1.0 - nearest / settings.clearance } else { 0.0 };
    let away = stood.map_or(0.0, |stood| {
        let off = space.centre_of_mass(joints) - stood;
        (off.x * off.x + off.y * off.y) / (TOLERANCES.balance * TOLERANCES.balance)
    });
    missing.max(0.0) * missing.max(0.0) + away
}
