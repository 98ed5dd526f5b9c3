//! Many simulations of one plan with friction, masses and motors that differ: does it still happen?

use super::{Moment, Refusal, Settings, Simulation, play};
use crate::interrupt;
use crate::optimize::random::SplitMix64;
use crate::plan::Plan;

/// The greatest deviations of quantities from what is stated, as fractions from 0 to below 1: a spread of 0.2 is a factor
/// that is uniform from 0.8 to 1.2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// The spread of the coefficients of friction, one factor for all.
    pub friction: f64,
    /// The spread of the masses, one factor for all.
    pub mass: f64,
    /// The spread of the greatest efforts of motors, one factor for all.
    pub effort: f64,
    /// The spread of the stiffness of servos, one factor for all.
    pub stiffness: f64,
    /// The most by which the zeros of joints that turn are off, rad, drawn for each joint.
    pub zero: f64,
}

/// Factors on what is stated, without unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// The factor on friction.
    pub friction: f64,
    /// The factor on masses.
    pub mass: f64,
    /// The factor on the greatest efforts.
    pub effort: f64,
    /// The factor on the stiffness of servos.
    pub stiffness: f64,
    /// The most by which the zeros of joints are off, rad, and the seed by which each is drawn.
    pub zero_error: (f64, u64),
}

/// One of many simulations, with the factors that it was made with.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The factors.
    pub factors: Factors,
    /// The result, without the motion.
    pub outcome: Simulation,
    /// The way of the base over the ground, as positions x and y in the world, m, evenly in time: at most 200, and fewer
    /// where there are more than 5000 runs.
    pub path: Vec<[f64; 2]>,
    /// The position of the base on the ground when something first [fails](Simulation::fails), m; `None` if nothing does.
    pub failed_at: Option<[f64; 2]>,
}

/// The numbers of runs in which something fails, by what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FailureCounts {
    /// Those in which anything [fails](Simulation::fails).
    pub fails: usize,
    /// Those in which a robot falls.
    pub falls: usize,
    /// Those in which a bond breaks.
    pub breaks: usize,
    /// Those in which ports that are to dock miss each other.
    pub misses: usize,
    /// Those in which the program is stopped before its end.
    pub stops: usize,
}

impl FailureCounts {
    /// Returns the numbers of some runs.
    pub fn of(runs: &[Run]) -> FailureCounts {
        let count = |of: fn(&Simulation) -> bool| runs.iter().filter(|run| of(&run.outcome)).count();
        FailureCounts {
            fails: count(Simulation::fails),
            falls: count(|outcome| outcome.fall.is_some()),
            breaks: count(Simulation::breaks),
            misses: count(Simulation::misses),
            stops: count(|outcome| outcome.stop.is_some()),
        }
    }
}

/// The most positions in the path of one run.
const PATH_MAX: usize = 200;

/// The most positions in the paths of all runs, unless they have [`PATH_MIN`] each.
const PATHS_MAX: usize = 1_000_000;

/// The least number of positions in a path that is thinned.
const PATH_MIN: usize = 8;

impl Spread {
    /// The most runs of one study.
    pub const RUNS_MAX: usize = 100_000;

    /// Returns the spreads of which each run has one factor, by their names in words.
    pub fn parts(&self) -> [(&'static str, f64); 4] {
        [
            ("friction", self.friction),
            ("mass", self.mass),
            ("torque", self.effort),
            ("stiffness", self.stiffness),
        ]
    }

    /// Returns the factors of the run of an index, from 0, of a study with this seed: those of one run do not depend on
    /// the others.
    fn factors(&self, seed: u64, index: usize) -> Factors {
        let mut numbers = SplitMix64(seed);
        numbers.skip(4 * index);
        let mut factor = |spread: f64| 1.0 + spread * numbers.next_signed();
        Factors {
            friction: factor(self.friction),
            mass: factor(self.mass),
            effort: factor(self.effort),
            stiffness: factor(self.stiffness),
            // The joints of each run have numbers of their own.
            zero_error: (self.zero, seed.rotate_left(32) ^ (index as u64 + 1)),
        }
    }

    /// Returns the size of factors as parts of this spread: the Euclidean norm, 0 for the quantities that it leaves alone.
    pub fn size(&self, factors: &Factors) -> f64 {
        let part = |spread: f64, factor: f64| if spread > 0.0 { (factor - 1.0) / spread } else { 0.0 };
        let parts = [
            part(self.friction, factors.friction),
            part(self.mass, factors.mass),
            part(self.effort, factors.effort),
            part(self.stiffness, factors.stiffness),
        ];
        parts.iter().map(|part| part * part).sum::<f64>().sqrt()
    }
}

/// Plays a plan `runs` times with factors drawn from a spread; the same runs for the same seed, on two threads where there
/// are two. The factors are on those of `settings`.
///
/// # Errors
/// The [`Refusal`] of the first run that is refused.
pub fn study(
    plan: &Plan,
    settings: &Settings,
    spread: &Spread,
    runs: usize,
    seed: u64,
) -> Result<Vec<Run>, Refusal> {
    let points = (PATHS_MAX / runs.max(1)).clamp(PATH_MIN, PATH_MAX);
    let every_other = |first: usize| {
        let mut found = Vec::new();
        for index in (first..runs).step_by(2) {
            let progress = |_: f64| format!("run {} of {runs}", index + 1);
            found.push(run(plan, settings, &spread.factors(seed, index), points, &progress));
        }
        found
    };
    let (even, odd) = interrupt::join(|| every_other(0), || every_other(1));
    let mut halves = [even.into_iter(), odd.into_iter()];
    (0..runs).map(|index| halves[index % 2].next().expect("each half has its runs")).collect()
}

/// Plays a plan with factors; keeps so many points of its way. `progress` says in words how far all the work is.
fn run(
    plan: &Plan,
    settings: &Settings,
    factors: &Factors,
    points: usize,
    progress: &dyn Fn(f64) -> String,
) -> Result<Run, Refusal> {
    let mut varied = settings.clone();
    varied.friction *= factors.friction;
    varied.mass *= factors.mass;
    varied.servo.effort *= factors.effort;
    varied.servo.factor *= factors.stiffness;
    varied.servo.zero_error = factors.zero_error;
    let mut outcome = play(plan, &varied, progress)?;
    let motion = std::mem::take(&mut outcome.motion);
    outcome.drives = Vec::new();
    let place = |moment: &Moment| [moment.base.translation.x, moment.base.translation.y];
    let count = points.min(motion.len());
    let index = |i: usize| i * (motion.len() - 1) / (count - 1).max(1);
    let path = (0..count).map(|i| place(&motion[index(i)])).collect();
    let failed = outcome.failed_first();
    let after = failed.map(|failed| motion.partition_point(|moment| moment.time < failed));
    let failed_at = after.and_then(|after| motion.get(after).or(motion.last())).map(place);
    Ok(Run { factors: *factors, outcome, path, failed_at })
}
