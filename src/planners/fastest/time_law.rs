//! The time law of a stretch: squared velocities of its parameter on a grid, with constant acceleration between.

use super::constraints::{Interval, interval};
use super::path::Stretch;
use super::reachability::{Failing, squares};
use super::tolerances::TOLERANCES;
use super::torque::{AtRest, Torques};
use super::{Refusal, Settings};
use crate::robot::{Assembly, Drive, JointId};

/// The least number of intervals of a piece of a path that is not a line.
const INTERVALS_MIN: usize = 12;

/// The greatest number of parts into which an interval is divided that takes long.
const DIVISIONS_MAX: f64 = 16.0;

/// The ratio of an interval to the one before it in the grid beside an instant of rest.
const GRADING: f64 = 1.08;

/// The points of a path, as values of its parameter, between which the parameter's acceleration is constant.
#[derive(Clone)]
pub(super) struct Grid {
    /// The parameters, ascending, with 0 and the length of the path.
    pub(super) nodes: Vec<f64>,
    /// The part of the limits of squared speed and of acceleration that may be used in each interval, from 0 to 1.
    usable: Vec<f64>,
}

impl Grid {
    /// Returns a grid with these parameters, ascending, in whose intervals all of each limit may be used but the
    /// fraction `TOLERANCES.limit`. Panics if there are none.
    pub(super) fn new(nodes: Vec<f64>) -> Grid {
        Grid { usable: vec![1.0 - TOLERANCES.limit; nodes.len() - 1], nodes }
    }
}

/// The velocity of a path's parameter at the points of a grid; between them its acceleration is constant, so its square
/// is linear in the parameter.
#[derive(Clone)]
pub(super) struct TimeLaw {
    /// The grid.
    pub(super) grid: Grid,
    /// The velocity of the parameter at each point, in its unit per second.
    pub(super) speeds: Vec<f64>,
}

impl TimeLaw {
    /// Returns the duration of the interval of this index, s; infinite if the velocity is zero at both ends.
    pub(super) fn duration(&self, index: usize) -> f64 {
        let length = self.grid.nodes[index + 1] - self.grid.nodes[index];
        2.0 * length / (self.speeds[index] + self.speeds[index + 1])
    }

    /// Returns a finer grid for the next time law: an interval in which a limit is exceeded is halved, or, if it lasts
    /// less than twice `TOLERANCES.interval`, may use less of its limits. `ratios`: for each interval the excess, as
    /// [`ratios`](super::motion::ratios) returns it.
    pub(super) fn refined(&self, ratios: &[f64]) -> Grid {
        let mut grid = Grid { nodes: vec![0.0], usable: Vec::new() };
        for (k, pair) in self.grid.nodes.windows(2).enumerate() {
            let usable = self.grid.usable[k];
            let exceeded = ratios[k] > 1.0 + TOLERANCES.excess;
            if exceeded && self.duration(k) >= 2.0 * TOLERANCES.interval {
                grid.nodes.extend([(pair[0] + pair[1]) / 2.0, pair[1]]);
                grid.usable.extend([usable; 2]);
            } else {
                grid.nodes.push(pair[1]);
                grid.usable.push(if exceeded { usable / (ratios[k] * ratios[k]) } else { usable });
            }
        }
        grid
    }
}

/// The limits that a stretch is timed under.
pub(super) struct Limits<'a> {
    /// The robot.
    pub(super) robot: &'a Assembly,
    /// The joints and motors that state a limit of speed or acceleration.
    pub(super) drives: &'a [Drive],
    /// The torques of the robot in the stretch; `None` where they do not limit the time law.
    pub(super) torques: Option<Torques<'a>>,
}

/// Returns the first grid of a stretch, as ascending parameters (rad, m or s): evenly spaced in each piece of the path,
/// and finer beside instants of rest of a curve, where the velocity of the parameter has no bound.
pub(super) fn grid(stretch: &Stretch, settings: &Settings) -> Vec<f64> {
    let breaks = stretch.breaks();
    let step = stretch.length / settings.intervals as f64;
    let last = breaks.len() - 2;
    let mut nodes = vec![0.0];
    for (index, pair) in breaks.windows(2).enumerate() {
        let (from, to) = (pair[0], pair[1]);
        let length = to - from;
        let first = TOLERANCES.first_interval * length;
        let step = step.min(length / INTERVALS_MIN as f64);
        let graded = |free: bool| if free { graded(first, step, length / 2.0) } else { vec![] };
        let (begin, end) = (graded(index == 0 && stretch.free[0]), graded(index == last && stretch.free[1]));
        let even_from = from + begin.last().copied().unwrap_or(0.0);
        let even_to = to - end.last().copied().unwrap_or(0.0);
        nodes.extend(begin.iter().map(|offset| from + offset));
        let count = libm::ceil((even_to - even_from) / step).max(1.0) as usize;
        nodes.extend((1..count).map(|i| even_from + (even_to - even_from) * i as f64 / count as f64));
        nodes.extend(end.iter().rev().map(|offset| to - offset));
        nodes.push(to);
    }
    nodes
}

/// Returns distances from an instant of rest that grow by the ratio [`GRADING`] from `first` on, until their steps
/// reach `step` or they reach `most`, all in the parameter.
fn graded(first: f64, step: f64, most: f64) -> Vec<f64> {
    let mut at = first;
    let mut found = Vec::new();
    while at < most && at * (GRADING - 1.0) < step {
        found.push(at);
        at *= GRADING;
    }
    found
}

/// Returns a grid for the next time law that is about even in time: intervals that take more than an even share of the
/// duration are divided, and points that follow others within `TOLERANCES.interval` are left out, as accelerations over
/// so short a time would be rounding of positions. Ends of pieces of the path stay.
pub(super) fn equidistributed(stretch: &Stretch, law: &TimeLaw, settings: &Settings) -> Grid {
    let breaks = stretch.breaks();
    let durations: Vec<f64> = (0..law.grid.usable.len()).map(|k| law.duration(k)).collect();
    let share = durations.iter().sum::<f64>() / settings.intervals as f64;
    let mut nodes = vec![0.0];
    let mut time = 0.0;
    for (pair, duration) in law.grid.nodes.windows(2).zip(durations) {
        let count = libm::ceil(duration / share.max(TOLERANCES.interval)).clamp(1.0, DIVISIONS_MAX);
        time += duration / count;
        for k in 1..=count as usize {
            let last = k as f64 == count;
            let node = if last { pair[1] } else { pair[0] + (pair[1] - pair[0]) * k as f64 / count };
            if time >= TOLERANCES.interval || breaks.contains(&node) {
                nodes.push(node);
                time = 0.0;
            }
            time += if last { 0.0 } else { duration / count };
        }
    }
    Grid::new(nodes)
}

/// Returns the time law of least duration of a stretch on a grid: in closed form for a straight path without torques,
/// else by reachability analysis (TOPP-RA).
///
/// # Errors
/// [`Refusal::NoAcceleration`] if nothing limits the velocity. If no velocity but zero is within the limits,
/// [`Refusal::Overloaded`] where torques count, else [`Refusal::TooLong`].
pub(super) fn solve(stretch: &Stretch, grid: Grid, limits: &Limits) -> Result<TimeLaw, Refusal> {
    if stretch.straight && limits.torques.is_none() {
        return trapezoid(stretch, limits);
    }
    let of = |(pair, usable): (&[f64], &f64)| {
        crate::interrupt::checkpoint();
        interval(stretch, limits.drives, limits.torques.as_ref(), (pair[0], pair[1]), *usable)
    };
    let intervals: Vec<Interval> = grid.nodes.windows(2).zip(&grid.usable).map(of).collect();
    let found = squares(&intervals, stretch.free).map_err(|failing| match failing {
        Failing::Unlimited => unlimited(stretch, limits.robot),
        Failing::Empty => overloaded(stretch, limits, &intervals),
    })?;
    // Bounds may be below zero by rounding.
    let speeds: Vec<f64> = found.into_iter().map(|square| libm::sqrt(square.max(0.0))).collect();
    if speeds.windows(2).any(|pair| pair[0] + pair[1] <= 0.0) {
        return Err(overloaded(stretch, limits, &intervals));
    }
    Ok(TimeLaw { grid, speeds })
}

/// Returns the refusal of a stretch whose velocity nothing limits, with the first of its moving joints.
fn unlimited(stretch: &Stretch, robot: &Assembly) -> Refusal {
    let joint = stretch.path.first().map_or(JointId(0), |track| track.joint);
    Refusal::NoAcceleration { joint: robot.name_of(joint), time: stretch.from }
}

/// Returns the refusal of a stretch that no velocity gets through: a torque at rest is too great, or, where torques do
/// not count, it would take for ever.
fn overloaded(stretch: &Stretch, limits: &Limits, intervals: &[Interval]) -> Refusal {
    let at_rest = intervals.iter().filter_map(|interval| interval.at_rest).reduce(AtRest::greater);
    match limits.torques.as_ref().zip(at_rest) {
        Some((torques, at_rest)) => torques.refusal(&at_rest, stretch),
        None => Refusal::TooLong,
    }
}

/// Returns the time law of a straight path from rest to rest under limits of speed and acceleration alone, in closed
/// form: constant acceleration, constant velocity, constant deceleration.
///
/// # Errors
/// [`Refusal::NoAcceleration`] if nothing limits the acceleration.
fn trapezoid(stretch: &Stretch, limits: &Limits) -> Result<TimeLaw, Refusal> {
    let length = stretch.length;
    let (mut square, mut acceleration) = (f64::INFINITY, f64::INFINITY);
    let able = 1.0 - TOLERANCES.limit;
    for drive in limits.drives {
        let slope = |&(joint, factor): &(usize, f64)| {
            let track = stretch.path.iter().find(|t| t.joint.0 as usize == joint);
            factor * track.map_or(0.0, |track| stretch.slope(track))
        };
        let slope = drive.terms.iter().map(slope).sum::<f64>().abs();
        if slope > TOLERANCES.derivative {
            let speed = drive.limits.speed.map_or(f64::INFINITY, |v| v / slope);
            square = square.min(speed * speed * able);
            acceleration =
                acceleration.min(drive.limits.acceleration.map_or(f64::INFINITY, |a| a / slope * able));
        }
    }
    if !acceleration.is_finite() {
        return Err(unlimited(stretch, limits.robot));
    }
    // A ramp as short as rounding would leave no point at which the path moves.
    acceleration = acceleration.min(square / (8.0 * TOLERANCES.derivative * length));
    let ramp = (square / (2.0 * acceleration)).min(length / 2.0);
    let mut nodes = stretch.breaks();
    nodes.extend([ramp, length - ramp]);
    nodes.sort_by(f64::total_cmp);
    nodes.dedup_by(|next, before| *next - *before <= TOLERANCES.derivative * length);
    if let Some(last) = nodes.last_mut() {
        *last = length;
    }
    let speed = |&s: &f64| libm::sqrt((2.0 * acceleration * s.min(length - s)).min(square).max(0.0));
    Ok(TimeLaw { speeds: nodes.iter().map(speed).collect(), grid: Grid::new(nodes) })
}
