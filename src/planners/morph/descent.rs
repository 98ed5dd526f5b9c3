//! The descent of a morph: step by step nearer to the target (section V of the paper), each step by
//! Algorithm 1 mended ([`step`](crate::planners::truss::step)).

use super::fit::{Distance, Guesses, Weights, fit};
use super::measure::measured;
use super::surface;
use super::target::Target;
use crate::geometry::{Pose, Vec3};
use crate::optimize::random::SplitMix64;
use crate::planners::Progress;
use crate::planners::truss::motion::TimeLaw;
use crate::planners::truss::step::{StepError, StepProblem, WarmStart, step};
use crate::planners::truss::{Structure, Tolerances};
use crate::units::{Dimension, quantity};
use nalgebra::UnitQuaternion;
use std::f64::consts::TAU;

/// One of so many screened orientations is screened again.
const SCREENED_PART: usize = 3;
/// The part of the ratio of the distances over the whole to those at sample points, as it was known last, from which it is
/// asked for again.
const RATIO_KNOWN: f64 = 0.98;
/// The number of attempts at a step, each with a quarter of the displacement before, until the descent is stuck.
const ATTEMPTS: usize = 4;

/// The settings of `morph`. Lengths in "units" are multiples of the mean strut length at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The greatest number of steps. Default 300: fits improve little beyond.
    pub steps_max: usize,
    /// The root mean square distance, of the target from the surface and of the surface from the target, m, up to
    /// which both have to come for the descent to be done. Default 20 mm.
    pub tolerance: f64,
    /// The number of orientations of the target, spread evenly over all, that are screened where it is not reached in its
    /// own; 0 for its own only. Default 15.
    pub orientations: usize,
    /// The number of steps for which an orientation is screened first, and those for which the better third is screened
    /// again. Default 20 and 60: the order of fits rarely changes later.
    pub screening_steps: [usize; 2],
    /// The number of orientations, the best of those screened, for which the whole descent is made. Default 2.
    pub finalists: usize,
    /// The seed of the rotation of all screened orientations; 0 for none. Default 0.
    pub seed: u64,
    /// The spacing of sample points on a target mesh, units. Default 0.125: the root mean square changes by 1.5
    /// percent from 0.25 to 0.0625.
    pub sample_spacing: f64,
    /// The greatest displacement of a node in a step, units. Default 0.05: longer steps gain nothing.
    pub displacement_max: f64,
    /// The weight of the mean squared strut length, relative to that of the mean squared distances, without unit: at
    /// the start, and from four fifths of the steps on; it falls geometrically in between. Default 3e-2 to 1e-6; both
    /// positive.
    pub springs: (f64, f64),
    /// The weight of the mean squared displacement, relative to that of the mean squared distances, without unit
    /// (damping after Levenberg 1944). Default 1e-3.
    pub damping: f64,
    /// The fraction, 0 to 1, of a squared distance that counts only across the surface (point to plane), so that
    /// points may slide along it. Default 0.9.
    pub point_to_plane: f64,
    /// The time law by which the steps of the plan are timed, with the defaults that its fields state.
    pub time_law: TimeLaw,
    /// The tolerances of the steps of trusses. Default [`Tolerances::DEFAULT`].
    pub tolerances: Tolerances,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            steps_max: 300,
            tolerance: 0.02,
            orientations: 15,
            screening_steps: [20, 60],
            finalists: 2,
            seed: 0,
            sample_spacing: 0.125,
            displacement_max: 0.05,
            springs: (3e-2, 1e-6),
            damping: 1e-3,
            point_to_plane: 0.9,
            time_law: TimeLaw::default(),
            tolerances: Tolerances::DEFAULT,
        }
    }
}

/// The reason why [`descend`] ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The target is reached: both distances, over the whole of both surfaces, are within the tolerance.
    Done,
    /// The steps that the settings allow were made, and the target is not reached.
    Steps,
    /// No step was found, not even a shortened one; the error is that of the longest.
    Stuck(StepError),
    /// The observer ended the search.
    Cancelled,
}

/// The motion that [`descend`] found, up to its best fit, with the distances at both ends.
#[derive(Clone, Debug)]
pub struct Descent {
    /// The positions of all nodes after every step, m: one list for each step, in order, each by node, up to the step
    /// that fits best by [`Distance::both`]; empty if none fits better than the start.
    pub steps: Vec<Vec<Vec3>>,
    /// The distances between surface and target at the start, with the target in its final orientation, at the points that
    /// are fitted.
    pub start: Distance,
    /// The distances between surface and target after the last of `steps`, at the points that are fitted.
    pub distance: Distance,
    /// The pose of the target's own frame in the world's, as it was moved (`X_WT`).
    pub target: Pose,
    /// The distances at the start over the whole of surface and target, which are not only less at the points that are
    /// fitted: root mean squares to about a percent, the greatest distance from below to a percent.
    pub start_measured: Distance,
    /// The same after the last of `steps`.
    pub measured: Distance,
    /// The reason why the search ended, which may have been some steps after the last of `steps`.
    pub end: End,
}

/// Morphs a truss with its nodes at `start` (m, in the world's frame, by index) into a target, which is moved so that
/// its centroid is the mean of the nodes (Section V of [Usevitch et al.](crate::planners::truss)). The target's own
/// orientation comes first; if the tolerance is not reached in it, those of [`Settings::orientations`] are screened for some
/// steps, and the truss descends to the best. The truss must have nodes and struts. If `progress` ends it, the result is the best of the
/// whole descents made, or the first as far as it came. `truss`: the truss with its limits; `settings`: the settings of the
/// descent.
///
/// This is the search beneath [`plan`](super::plan), for callers who have a [`Structure`] of their own.
///
/// # Errors
/// [`Open`](super::Open) if the truss has no outer surface of triangles.
pub fn descend(
    truss: &Structure,
    start: &[Vec3],
    target: &Target,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Descent, surface::Open> {
    let truss = &truss.tightened(truss.tolerances.clearance_margin);
    let mut monitor = Monitor { progress, least: f64::INFINITY };
    let faces = surface::outer(truss, start)?;
    let middle = start.iter().sum::<Vec3>() / start.len() as f64;
    let centroid = target.centroid();
    let placed = |turn: &UnitQuaternion<f64>| target.moved(|p| turn * (p - centroid) + middle);
    let pose = |turn: &UnitQuaternion<f64>| Pose::from_parts((middle - turn * centroid).into(), *turn);
    // The target's own orientation, if it can be reached, and else others.
    let unturned = UnitQuaternion::identity();
    let own = placed(&unturned);
    let found = descend_to(truss, start, &faces, &own, settings, &mut monitor);
    let is_over = |found: &Descent| matches!(found.end, End::Done | End::Cancelled);
    if is_over(&found) || settings.orientations == 0 {
        return Ok(found.measured_over(&faces, start, &own, pose(&unturned)));
    }
    let mut best = (found, own, unturned);
    let mut turns: Vec<UnitQuaternion<f64>> = evenly_spread(settings.orientations, settings.seed).collect();
    // Successive halving (Jamieson and Talwalkar 2016): the better ones go on for longer. Rigidity takes time, and changes
    // little in their order.
    let mut free = truss.clone();
    free.limits.rigidity = 0.0;
    let last = settings.finalists.max(1);
    for (steps, left) in settings.screening_steps.into_iter().zip([turns.len().div_ceil(SCREENED_PART), last])
    {
        if turns.len() <= last {
            break;
        }
        let short = Settings { steps_max: steps.min(settings.steps_max), ..settings.clone() };
        let mut tried = Vec::new();
        for turn in turns {
            let tried_one = descend_to(&free, start, &faces, &placed(&turn), &short, &mut monitor);
            if tried_one.end == End::Cancelled {
                let (found, goal, turn) = best;
                let found = Descent { end: End::Cancelled, ..found };
                return Ok(found.measured_over(&faces, start, &goal, pose(&turn)));
            }
            tried.push((tried_one.distance.both(), turn));
        }
        // The sort is stable: of equal ones the first stays first.
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        turns = tried.into_iter().take(left.max(last)).map(|(_, turn)| turn).collect();
    }
    for turn in &turns {
        let goal = placed(turn);
        let found = descend_to(truss, start, &faces, &goal, settings, &mut monitor);
        let over = is_over(&found);
        if over || found.distance.both() < best.0.distance.both() {
            best = (found, goal, *turn);
        }
        if over {
            break;
        }
    }
    let (found, goal, turn) = best;
    Ok(found.measured_over(&faces, start, &goal, pose(&turn)))
}

impl Descent {
    /// Returns the descent with its distances over the whole of surface and target; `X_WT`: the pose of the target's own
    /// frame.
    #[allow(non_snake_case)]
    fn measured_over(self, faces: &[[usize; 3]], start: &[Vec3], target: &Target, X_WT: Pose) -> Descent {
        let last = self.steps.last().map_or(start, |x| &x[..]);
        let [start_measured, measured] = [start, last].map(|x| measured(faces, x, target));
        Descent { start_measured, measured, target: X_WT, ..self }
    }
}

/// The observer, with the least distance (root mean square, m) seen in all descents.
struct Monitor<'a> {
    progress: &'a mut dyn Progress,
    least: f64,
}

impl Monitor<'_> {
    /// Reports a step that is about to begin; returns false if the observer ends the search.
    fn should_continue(&mut self, step: usize, distance: &Distance, settings: &Settings) -> bool {
        self.least = self.least.min(distance.target_to_surface);
        let both = [distance.target_to_surface, self.least];
        self.progress.report(&|| {
            let [apart, least] = both.map(|d| quantity(d, Dimension::LENGTH));
            format!("step {step} of at most {}, {apart} apart, {least} at best", settings.steps_max)
        });
        self.progress.should_continue()
    }
}

/// Descends from `start` to the target by shortened Gauss-Newton steps until it is within the tolerance, stuck,
/// cancelled or at the limit; keeps the steps up to the best fit.
fn descend_to(
    truss: &Structure,
    start: &[Vec3],
    faces: &[[usize; 3]],
    target: &Target,
    settings: &Settings,
    monitor: &mut Monitor,
) -> Descent {
    let mut guesses = Guesses::default();
    let mut x = start.to_vec();
    let mut warm_start = WarmStart::default();
    let mut found = fit(faces, &x, target, &mut guesses);
    let first = found.distance;
    let mut steps: Vec<Vec<Vec3>> = Vec::new();
    let mut best = (0, found.distance);
    let mut ratio = 1.0f64;
    let end = loop {
        // The distances at sample points are less than those over the whole.
        let supposed = found.distance.scaled(RATIO_KNOWN * ratio);
        if found.distance.within(settings.tolerance) && supposed.within(settings.tolerance) {
            let whole = measured(faces, &x, target);
            if whole.within(settings.tolerance) {
                best = (steps.len(), found.distance);
                break End::Done;
            }
            ratio = whole.both() / found.distance.both().max(f64::MIN_POSITIVE);
        }
        if steps.len() >= settings.steps_max {
            break End::Steps;
        }
        if !monitor.should_continue(steps.len(), &found.distance, settings) {
            break End::Cancelled;
        }
        // The springs vanish over the first four fifths of the steps.
        let part = (steps.len() as f64 / (0.8 * settings.steps_max as f64)).min(1.0);
        let springs = settings.springs.0 * libm::pow(settings.springs.1 / settings.springs.0, part);
        let (point_to_plane, damping) = (settings.point_to_plane, settings.damping);
        let weights = Weights { surface_to_target: 1.0, point_to_plane, springs, damping };
        let cost = found.cost(truss, &x, &weights);
        // A Gauss-Newton step, shortened until one is found.
        let attempt = |displacement_max: f64, warm_start: &mut WarmStart| {
            let (pinned, centre_of_mass) = (&[], &[]);
            let problem = StepProblem {
                truss,
                x: &x,
                cost: &cost,
                pinned,
                centre_of_mass,
                ground: false,
                displacement_max,
                thorough: false,
            };
            step(&problem, warm_start)
        };
        let caps = (0..ATTEMPTS).map(|i| settings.displacement_max * truss.unit / (1 << (2 * i)) as f64);
        let mut stuck = None;
        let next = caps.into_iter().find_map(|cap| match attempt(cap, &mut warm_start) {
            Ok(y) => Some(y),
            Err(why) => {
                warm_start.active.clear();
                stuck.get_or_insert(why);
                None
            }
        });
        let Some(next) = next else { break End::Stuck(stuck.expect("an attempt was made")) };
        x = next;
        steps.push(x.clone());
        found = fit(faces, &x, target, &mut guesses);
        if found.distance.both() < best.1.both() {
            best = (steps.len(), found.distance);
        }
    };
    steps.truncate(best.0);
    let none = Distance::default();
    Descent {
        steps,
        start: first,
        distance: best.1,
        start_measured: none,
        measured: none,
        target: Pose::identity(),
        end,
    }
}

/// Returns rotations that are spread evenly over all, on a super-Fibonacci spiral (Alexa 2022); for a seed other than 0,
/// each after one random rotation.
fn evenly_spread(count: usize, seed: u64) -> impl Iterator<Item = UnitQuaternion<f64>> {
    // The positive root of x⁴ = x + 4, and the square root of 2.
    const PSI: f64 = 1.533_751_168_755_204_3;
    const PHI: f64 = std::f64::consts::SQRT_2;
    let mut rng = SplitMix64(seed);
    let first = if seed == 0 { UnitQuaternion::identity() } else { random_rotation(&mut rng) };
    (0..count).map(move |i| {
        let s = i as f64 + 0.5;
        let ((sa, ca), (sb, cb)) = (libm::sincos(TAU * s / PHI), libm::sincos(TAU * s / PSI));
        let (low, high) = ((s / count as f64).sqrt(), (1.0 - s / count as f64).sqrt());
        let turn = nalgebra::Quaternion::new(high * cb, low * sa, low * ca, high * sb);
        UnitQuaternion::new_normalize(turn) * first
    })
}

/// Returns a uniformly random rotation (Shoemake, "Uniform random rotations", Graphics Gems III).
fn random_rotation(rng: &mut SplitMix64) -> UnitQuaternion<f64> {
    let (u, v, w) = (rng.next_f64(), TAU * rng.next_f64(), TAU * rng.next_f64());
    let ((sv, cv), (sw, cw)) = (libm::sincos(v), libm::sincos(w));
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    UnitQuaternion::new_normalize(nalgebra::Quaternion::new(b * cw, a * sv, a * cv, b * sw))
}
