//! The time law of a way: as fast as every hinge can follow.

use super::path::{Path, between};
use super::tolerances::TOLERANCES;
use crate::behavior::law::MotionLimits;
use nalgebra::DVector;

/// The number of pieces of a motion; in each, every hinge moves by a cubic.
const PIECES: usize = 160;

/// The granularity of durations, s.
const GRAIN: f64 = 0.01;

/// The duration where no limit is stated, s.
const UNLIMITED: f64 = 1.0;

/// The motion of all creases: for each, its keyframes as (time in s, angle in rad, speed in rad/s).
pub type Keyframes = Vec<Vec<[f64; 3]>>;

/// The angles at equal times of a motion of one second from rest to rest.
struct Law {
    /// The angles at the ends of the pieces, rad.
    angles: Vec<DVector<f64>>,
    /// The speeds there, rad/s.
    speeds: Vec<DVector<f64>>,
}

/// Returns the least duration (s) in which every crease can go the way within its limits, rounded up to 10 ms.
pub fn least_duration(path: &Path, limits: MotionLimits) -> f64 {
    let law = law(path);
    let width = 1.0 / PIECES as f64;
    let (mut speed, mut acceleration) = (0.0_f64, 0.0_f64);
    for piece in 0..PIECES {
        for crease in 0..law.angles[0].len() {
            let (from, to) = (law.speeds[piece][crease], law.speeds[piece + 1][crease]);
            let mean = (law.angles[piece + 1][crease] - law.angles[piece][crease]) / width;
            // The speed is a parabola, the acceleration a line.
            let middle = 1.5 * mean - (from + to) / 4.0;
            let ends =
                [(6.0 * mean - 4.0 * from - 2.0 * to) / width, (2.0 * from + 4.0 * to - 6.0 * mean) / width];
            // The vertex of the parabola is no farther out than this.
            speed = speed
                .max(from.abs())
                .max(to.abs())
                .max(middle.abs() + ends[0].abs().max(ends[1].abs()) * width / 4.0);
            acceleration = acceleration.max(ends[0].abs()).max(ends[1].abs());
        }
    }
    let by_speed = limits.speed.map(|limit| speed / limit);
    let by_acceleration = limits.acceleration.map(|limit| libm::sqrt(acceleration / limit));
    let least = by_speed.into_iter().chain(by_acceleration).reduce(f64::max);
    match least {
        Some(least) if least > 0.0 => (least * (1.0 + TOLERANCES.limits) / GRAIN).ceil() * GRAIN,
        Some(_) | None => UNLIMITED,
    }
}

/// Returns the motion along the way in a duration, s.
pub fn keyframes(path: &Path, duration: f64) -> Keyframes {
    let law = law(path);
    let creases = law.angles[0].len();
    let at = |crease: usize, end: usize| {
        let time = duration * end as f64 / PIECES as f64;
        [time, law.angles[end][crease], law.speeds[end][crease] / duration]
    };
    (0..creases).map(|crease| (0..=PIECES).map(|end| at(crease, end)).collect()).collect()
}

/// Returns the motion of one second, by the quintic law of the part of the way.
fn law(path: &Path) -> Law {
    let mut law = Law { angles: Vec::with_capacity(PIECES + 1), speeds: Vec::with_capacity(PIECES + 1) };
    let places = &path.places;
    for end in 0..=PIECES {
        let x = end as f64 / PIECES as f64;
        let part = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
        let rate = 30.0 * x * x * (1.0 - x) * (1.0 - x);
        let next = places.partition_point(|place| place.part < part).clamp(1, places.len() - 1);
        let (from, to) = (&places[next - 1], &places[next]);
        let (angles, slopes) = between(from, to, (part - from.part) / (to.part - from.part));
        law.angles.push(angles);
        law.speeds.push(slopes * rate);
    }
    law
}
