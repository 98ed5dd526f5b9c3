//! Durations: the least time in which joints that move together keep the limits of all joints and motors.

use crate::behavior::law::{MotionLimits, cubic_pieces, least_duration};
use crate::plan::Profile;
use crate::plan::time::tick_after;
use crate::robot::{Assembly, Drive, drives};

/// The part of the least time of a line that is added: its cubics change their acceleration at the postures.
const LINE_SPARE: f64 = 0.02;

/// Returns the least time, s, in which all joints come from rest in one posture to rest in another together; `None` if no
/// limit bounds it. `from`, `to`: the positions of all joints, rad or m.
pub(in crate::planners) fn together(
    robot: &Assembly,
    from: &[f64],
    to: &[f64],
    profile: Profile,
) -> Option<f64> {
    let mut longest = None;
    let mut moves = false;
    for drive in drives(robot) {
        let change: f64 = drive.terms.iter().map(|&(joint, factor)| factor * (to[joint] - from[joint])).sum();
        moves |= change != 0.0;
        let least = least_duration(profile, change, limits(&drive));
        longest = [longest, least.filter(|_| change != 0.0)].into_iter().flatten().reduce(f64::max);
    }
    if moves { longest.map(tick_after) } else { Some(0.0) }
}

/// Returns the least time, s, in which joints follow positions with their slopes over a unit of time, at even times; `None`
/// if no limit bounds it. `joints`: the number of each joint in its `JointId`, with its positions.
pub(super) fn along(robot: &Assembly, joints: &[(usize, &[[f64; 2]])]) -> Option<f64> {
    let mut longest: Option<f64> = None;
    for drive in drives(robot) {
        let pieces = joints.first().map_or(0, |(_, keys)| keys.len());
        let mut sum = vec![[0.0; 3]; pieces];
        for (key, sum) in sum.iter_mut().enumerate() {
            sum[0] = key as f64 / (pieces - 1) as f64;
            for &(joint, factor) in &drive.terms {
                if let Some((_, keys)) = joints.iter().find(|(known, _)| *known == joint) {
                    sum[1] += factor * keys[key][0];
                    sum[2] += factor * keys[key][1];
                }
            }
        }
        let (mut speed, mut acceleration) = (0.0, 0.0);
        for piece in cubic_pieces(&sum) {
            let (c, h) = (&piece.control, piece.duration);
            let rates = [c[1] - c[0], c[2] - c[1], c[3] - c[2]].map(|d| 3.0 * d / h);
            speed = rates.iter().fold(speed, |most: f64, rate| most.max(rate.abs()));
            acceleration = [rates[1] - rates[0], rates[2] - rates[1]]
                .iter()
                .fold(acceleration, |most: f64, d| most.max((2.0 * d / h).abs()));
        }
        let MotionLimits { speed: v, acceleration: a } = limits(&drive);
        let by_speed = v.filter(|_| speed > 0.0).map(|v| speed / v);
        let by_acceleration = a.filter(|_| acceleration > 0.0).map(|a| libm::sqrt(acceleration / a));
        longest = [longest, by_speed, by_acceleration].into_iter().flatten().reduce(f64::max);
    }
    longest.map(|time| tick_after(time * (1.0 + LINE_SPARE)))
}

fn limits(drive: &Drive) -> MotionLimits {
    MotionLimits { speed: drive.limits.speed, acceleration: drive.limits.acceleration }
}
