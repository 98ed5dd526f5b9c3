//! Time laws: trajectories of one joint from rest to rest, and those that take up and give up speed, as
//! polynomials in Bernstein form. Least durations follow from the greatest speed and acceleration.

use crate::plan::Profile;
use crate::plan::time::{tick_after, tick_near};

/// A piece of a trajectory: a polynomial over its duration whose control points are positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The duration of the piece, s.
    pub duration: f64,
    /// The control points in Bernstein form, spread over the duration, rad or m; one more than the degree.
    pub control: Vec<f64>,
}

/// The limits of the speed and acceleration of a joint, both positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionLimits {
    /// The greatest speed, rad/s or m/s; `None`: no limit.
    pub speed: Option<f64>,
    /// The greatest acceleration, rad/s² or m/s²; `None`: no limit.
    pub acceleration: Option<f64>,
}

/// The peak speed of the quintic law ([`Profile::Smooth`]) over 1 rad in 1 s, rad/s: 15/8.
pub const SMOOTH_SPEED: f64 = 1.875;
/// The peak acceleration of the quintic law ([`Profile::Smooth`]) over 1 rad in 1 s, rad/s²: 10/√3.
pub const SMOOTH_ACCELERATION: f64 = 5.773_502_691_896_258;
/// The part of a trapezoid's duration that each ramp takes if no acceleration limit determines it, without unit.
pub const RAMP: f64 = 0.25;

/// Returns the least duration, s, of a move by `distance` (rad or m, either sign) from rest to rest under the limits
/// `able`; 0 for no distance, `None` if no limit bounds it. [`Profile::Linear`] knows no acceleration limit.
/// `profile`: the time law of the move.
pub fn least_duration(profile: Profile, distance: f64, able: MotionLimits) -> Option<f64> {
    let distance = distance.abs();
    if distance == 0.0 {
        return Some(0.0);
    }
    match profile {
        Profile::Smooth => {
            let by_speed = able.speed.map(|v| SMOOTH_SPEED * distance / v);
            let by_acceleration = able.acceleration.map(|a| libm::sqrt(SMOOTH_ACCELERATION * distance / a));
            longer(by_speed, by_acceleration)
        }
        Profile::Trapezoid => match (able.speed, able.acceleration) {
            (Some(v), Some(a)) if distance * a > v * v => Some(distance / v + v / a),
            (_, Some(a)) => Some(2.0 * libm::sqrt(distance / a)),
            (Some(v), None) => Some(distance / (v * (1.0 - RAMP))),
            (None, None) => None,
        },
        Profile::Linear => able.speed.map(|v| distance / v),
    }
}

/// Returns the greater of two durations; `None` is none.
fn longer(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b)),
        _ => a.or(b),
    }
}

/// Returns the motion from rest at `from` to rest at `to` (rad or m) in `duration` seconds, which must be a whole
/// number of ticks, as pieces in order of time. The ramps of a trapezoid are as short as the acceleration in `able`
/// allows, and [`RAMP`] of the duration each without a limit; other profiles do not depend on `able`. Limits are not
/// checked: see [`least_duration`]. `profile`: the time law of the move; `able`: the limits of the joint.
pub fn rest_to_rest(profile: Profile, from: f64, to: f64, duration: f64, able: MotionLimits) -> Vec<Piece> {
    match profile {
        Profile::Smooth => vec![Piece { duration, control: vec![from, from, from, to, to, to] }],
        Profile::Linear => vec![Piece { duration, control: vec![from, to] }],
        Profile::Trapezoid => trapezoid(from, to, duration, able),
    }
}

/// Returns the trapezoid: a ramp, constant speed, and a ramp, rounded to ticks.
fn trapezoid(from: f64, to: f64, duration: f64, able: MotionLimits) -> Vec<Piece> {
    let ramp = tick_near(ramp((to - from).abs(), duration, able));
    let cruise = duration - 2.0 * ramp;
    // The speed that covers the distance with the ramps as they are after rounding to ticks.
    let half = (to - from) / (cruise + ramp) * ramp / 2.0;
    let (up, down) = (from + half, to - half);
    let mut pieces = vec![Piece { duration: ramp, control: vec![from, from, up] }];
    if cruise > 0.0 {
        pieces.push(Piece { duration: cruise, control: vec![up, down] });
    }
    pieces.push(Piece { duration: ramp, control: vec![down, to, to] });
    pieces
}

/// Returns the duration `r` of each ramp of a trapezoid of duration `T`, s, from `a·r·(T-r) = distance` with the
/// greatest acceleration `a`; without a limit a fixed part of `T`.
fn ramp(distance: f64, duration: f64, able: MotionLimits) -> f64 {
    let Some(a) = able.acceleration else { return duration * RAMP };
    let square = duration * duration - 4.0 * distance / a;
    // Below zero the duration is too short for the acceleration: ramps over the whole duration come nearest.
    (duration - libm::sqrt(square.max(0.0))) / 2.0
}

/// Returns the change from `speed` to `to_speed` (rad/s or m/s) at the greatest acceleration, from the position
/// `from` (rad or m); its duration is rounded up to a tick. `None` if the speeds are equal, and if no acceleration
/// limit is stated, so that the speed may jump. `able`: the limits of the joint, of which that of acceleration
/// counts.
pub fn changed_speed(from: f64, speed: f64, to_speed: f64, able: MotionLimits) -> Option<Piece> {
    let duration = tick_after((to_speed - speed).abs() / able.acceleration?);
    let middle = from + speed * duration / 2.0;
    (duration > 0.0)
        .then(|| Piece { duration, control: vec![from, middle, middle + to_speed * duration / 2.0] })
}

/// Returns a motion at `speed` (rad/s or m/s) for `duration` seconds, then rest, from the position `from` (rad or m).
/// If an acceleration limit is stated, it begins at the speed that the joint has, `at_speed`, with ramps within that
/// time, and a duration too short for the speed lowers it; otherwise the speed jumps. `able`: the limits of the
/// joint, of which that of acceleration counts.
pub fn spin(from: f64, at_speed: f64, speed: f64, duration: f64, able: MotionLimits) -> Vec<Piece> {
    let Some(a) = able.acceleration else {
        return vec![Piece { duration, control: vec![from, from + speed * duration] }];
    };
    // Too short to come up to speed: half the time up, half down.
    let speed = speed.signum() * speed.abs().min(a * duration / 2.0);
    let up = changed_speed(from, at_speed, speed, able);
    let down = tick_near(speed.abs() / a).min(duration / 2.0);
    let cruise = duration - down - up.as_ref().map_or(0.0, |p| p.duration);
    let mut pieces: Vec<Piece> = up.into_iter().collect();
    let mut at = pieces.last().map_or(from, |p| p.control[2]);
    if cruise > 0.0 {
        pieces.push(Piece { duration: cruise, control: vec![at, at + speed * cruise] });
        at += speed * cruise;
    }
    if down > 0.0 {
        let end = at + speed * down / 2.0;
        pieces.push(Piece { duration: down, control: vec![at, end, end] });
    }
    pieces
}

/// Returns the cubic Hermite interpolation of `keyframes`, each a time (s), a position (rad or m) and a speed (rad/s or
/// m/s), in order of time, as pieces in Bernstein form, one less than there are keyframes; times are rounded to ticks.
pub fn cubic_pieces(keyframes: &[[f64; 3]]) -> Vec<Piece> {
    let piece = |w: &[[f64; 3]]| {
        let duration = tick_near(w[1][0]) - tick_near(w[0][0]);
        let third = duration / 3.0;
        let control = vec![w[0][1], w[0][1] + w[0][2] * third, w[1][1] - w[1][2] * third, w[1][1]];
        Piece { duration, control }
    };
    keyframes.windows(2).map(piece).collect()
}
