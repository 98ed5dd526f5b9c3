//! The velocity profile of a move: the least time from rest to rest under the speed and the acceleration of the struts, and
//! under the forces that they bear while the truss accelerates.

use super::forces::bearable_part;
use super::motion::{Move, TimeLaw};
use super::positions::halfway;
use super::structure::Structure;
use super::support_polygon::staying;
use crate::geometry::Vec3;
use crate::plan::Ramps;
use crate::robot::truss_statics::Weights;

/// The duration of a move and its velocity profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// The duration, s.
    pub duration: f64,
    /// The velocity profile; none for rolls, and for struts without a limit on their acceleration.
    pub ramps: Ramps,
}

impl TimeLaw {
    /// Returns the least duration of a move from positions `x` of the nodes (m), not rounded up to `step_duration_min`, with
    /// its profile: of a step that in which the speed and the acceleration of the struts suffice, of a roll its angle
    /// divided by `roll_speed`. `truss`: the truss with its limits; `step`: the move.
    pub fn timing(&self, truss: &Structure, x: &[Vec3], step: &Move) -> Timing {
        match step {
            Move::Linear(y, _) => least(truss, x, y, truss.acceleration),
            Move::Roll(roll) => Timing { duration: roll.angle.abs() / self.roll_speed, ramps: Ramps::NONE },
        }
    }

    /// Returns the timing of a move, at least `step_duration_min`. A truss that carries its weight accelerates no faster
    /// than its struts can bear at both ends of a step and in its middle, with the inertia of its nodes, if they bear the
    /// weight alone; one that rolls next may tip while it brakes. `next`: the move after; `weights`: those of a move before.
    pub(super) fn borne(
        &self,
        truss: &Structure,
        x: &[Vec3],
        (step, next): (&Move, Option<&Move>),
        weights: &mut Weights,
    ) -> Timing {
        let mut timing = self.lasting(self.timing(truss, x, step));
        let (Move::Linear(y, findings), Some(acceleration), true) =
            (step, truss.acceleration, truss.limits.forces.is_some())
        else {
            return timing;
        };
        let feet = staying(truss, x, y);
        let tips = matches!(next, Some(Move::Roll(_)));
        let mut part_at =
            |z: &[Vec3], rate: f64| bearable_part(truss, z, &feet, &accelerated(x, y, rate), weights);
        // Under a part of the limit a step accelerates by no more than that part. It is not less than the least part either where
        // its end and its middle both ask for that: forces at rest leave nothing there, and no slower step would help.
        let part_min = truss.tolerances.acceleration_part_min;
        let mut part = 1.0;
        let mut slowed = |more: f64, timing: Timing| {
            part = f64::max(part * more, part_min);
            if more < 1.0 { self.lasting(least(truss, x, y, Some(part * acceleration))) } else { timing }
        };
        let [up, down] = timing.ramps.progress(timing.duration).accelerations();
        // The step before braked at `x`: its matrix is mostly known.
        let rises = if findings.rises { 1.0 } else { part_at(x, up) };
        let brakes = if tips || findings.brakes { 1.0 } else { part_at(y, -down) };
        timing = slowed(rises.min(brakes), timing);
        // A step that never goes evenly accelerates and brakes in its middle, too.
        let progress = timing.ramps.progress(timing.duration);
        if !progress.coasts() {
            let ([up, down], middle) = (progress.accelerations(), halfway(x, y));
            let brakes = if tips { 1.0 } else { part_at(&middle, -down) };
            timing = slowed(part_at(&middle, up).min(brakes), timing);
        }
        timing
    }

    /// Returns the accelerations of the nodes, m/s², at the start and at the end of a step from `x` to `y` (m) under the limits of the
    /// struts alone; `None` where those have none, or forces do not count.
    pub(super) fn accelerations(&self, truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Option<[Vec<Vec3>; 2]> {
        truss.limits.forces.as_ref()?;
        let Timing { duration, ramps } = self.lasting(least(truss, x, y, Some(truss.acceleration?)));
        let [up, down] = ramps.progress(duration).accelerations();
        Some([accelerated(x, y, up), accelerated(x, y, -down)])
    }

    /// Returns a timing stretched to the least duration.
    fn lasting(&self, timing: Timing) -> Timing {
        let Timing { duration, ramps } = timing;
        if duration >= self.step_duration_min {
            return timing;
        }
        // A step that lasts no time has no ramps, either.
        let stretch = if duration > 0.0 { self.step_duration_min / duration } else { 0.0 };
        let ramps = Ramps { up: ramps.up * stretch, down: ramps.down * stretch, ..Ramps::NONE };
        Timing { duration: self.step_duration_min, ramps }
    }
}

/// Returns the acceleration of each node, m/s², at this rate, 1/s², times its way from `x` to `y`, m.
fn accelerated(x: &[Vec3], y: &[Vec3], rate: f64) -> Vec<Vec3> {
    x.iter().zip(y).map(|(p, q)| (q - p) * rate).collect()
}

/// Returns the timing of a step from `x` to `y` (m) from rest to rest, with an acceleration (m/s²) that no strut exceeds.
fn least(truss: &Structure, x: &[Vec3], y: &[Vec3], acceleration: Option<f64>) -> Timing {
    let fastest = truss.rates(x, y).fold(0.0, f64::max);
    let Some(acceleration) = acceleration else {
        return Timing { duration: fastest / truss.speed, ramps: Ramps::NONE };
    };
    if fastest == 0.0 {
        return Timing { duration: 0.0, ramps: Ramps::NONE };
    }
    // A length accelerates by L' s'' + L'' s'^2 (chain rule): half of the limit is left for the first term.
    let bends: Vec<f64> = truss.bends(x, y).collect();
    let bend = bends.iter().copied().fold(0.0, f64::max);
    let peak = (truss.speed / fastest).min((acceleration / (2.0 * bend)).sqrt());
    let rises = truss.rates(x, y).zip(&bends).filter(|(rate, _)| *rate > 0.0);
    let rise =
        rises.map(|(rate, bend)| (acceleration - bend * peak * peak) / rate).fold(f64::INFINITY, f64::min);
    let peak = peak.min(rise.sqrt());
    let ramp = peak / rise;
    Timing { duration: 1.0 / peak + ramp, ramps: Ramps { up: ramp, down: ramp, ..Ramps::NONE } }
}
