//! The velocity profile of a step of a truss: from rest to rest, as a trapezoid.

use super::fault::NodePathsFault;
use super::motion::Interpolation;
use crate::plan::fault::{PlanFault, need, need_finite};
use crate::plan::tolerances::TOLERANCES;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A trapezoidal velocity profile, or a piece of one: the rate of progress rises evenly from rest, stays, and falls evenly
/// to rest. In a whole step `before` and `after` are 0; in a step that was cut they are what was cut off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramps {
    /// The time in which the rate of progress rises from zero to what it is in the middle, s; 0: it begins with that.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub up: f64,
    /// The time in which the rate of progress falls to zero again, s; 0: it ends with what it is in the middle.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub down: f64,
    /// The part of `up` that was over when the step begins, s.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub before: f64,
    /// The part of `down` that is left when the step ends, s.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub after: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The progress of a step as a function of time. Progress goes from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    ramps: Ramps,
    /// The duration of the step, s.
    duration: f64,
    /// The ends of the rise and of the constant rate, s from the start of the step.
    knots: [f64; 2],
    /// The integral of the rate over the step, where the rate in the middle is 1, s.
    whole: f64,
}

impl Ramps {
    /// The profile of a step that progresses at a constant rate.
    pub const NONE: Ramps = Ramps { up: 0.0, down: 0.0, before: 0.0, after: 0.0 };

    /// Returns true if the rate of progress is constant.
    pub fn is_none(&self) -> bool {
        *self == Ramps::NONE
    }

    /// Returns the ramps of the same motion run backwards.
    pub(super) fn reversed(self) -> Ramps {
        Ramps { up: self.down, down: self.up, before: self.after, after: self.before }
    }

    /// Returns the ramps of the piece between two times (s from the start of the step) of a step of a duration (s).
    pub(super) fn sliced(self, duration: f64, from: f64, to: f64) -> Ramps {
        let mut piece = Ramps { before: self.before + from, after: self.after + (duration - to), ..self };
        if piece.before >= piece.up {
            (piece.up, piece.before) = (0.0, 0.0);
        }
        if piece.after >= piece.down {
            (piece.down, piece.after) = (0.0, 0.0);
        }
        piece
    }

    /// Checks the ramps of the step that ends at `time` and lasts `duration` (s): that no time is negative or more than the
    /// ramp that it is a part of, that the ramps do not overlap, and that rolls have none.
    ///
    /// # Errors
    /// The [`PlanFault`] of the ramps.
    pub(super) fn check(
        self,
        interpolation: Interpolation,
        time: f64,
        duration: f64,
    ) -> Result<(), PlanFault> {
        if self.is_none() {
            return Ok(());
        }
        need_finite("the ramps", &self)?;
        let Ramps { up, down, before, after } = self;
        let within = |part: f64, whole: f64| part == 0.0 || 0.0 < part && part < whole;
        // A piece of one ramp has nothing of the other.
        let alone = up == 0.0 || down == 0.0;
        let fits = alone || up + down <= (duration + before + after) * (1.0 + TOLERANCES.ramp_overlap);
        let sound = up >= 0.0 && down >= 0.0 && within(before, up) && within(after, down) && fits;
        need(sound && interpolation == Interpolation::Linear, || NodePathsFault::Ramps { time })
    }

    /// Returns the progress of a step of this duration, s, positive.
    pub fn progress(self, duration: f64) -> Progress {
        let risen = (self.up - self.before).clamp(0.0, duration);
        let falls = (duration + self.after - self.down).clamp(risen, duration);
        let mut progress = Progress { ramps: self, duration, knots: [risen, falls], whole: 1.0 };
        progress.whole = progress.integral(duration);
        progress
    }
}

impl Progress {
    /// Returns the integral of the rate from the start of the step to a time (s), s.
    fn integral(&self, t: f64) -> f64 {
        let Ramps { up, down, before, after } = self.ramps;
        let [risen, falls] = self.knots;
        let rise = if up > 0.0 {
            let t = t.min(risen);
            t * (t + 2.0 * before) / (2.0 * up)
        } else {
            0.0
        };
        let fall = if down > 0.0 && t > falls {
            let (first, last) = (self.duration - falls + after, self.duration - t + after);
            (first - last) * (first + last) / (2.0 * down)
        } else {
            0.0
        };
        rise + (t.min(falls) - risen).max(0.0) + fall
    }

    /// Returns the progress at a time (s from the start of the step), 0 to 1.
    pub fn at(&self, t: f64) -> f64 {
        self.integral(t) / self.whole
    }

    /// Returns the time (s from the start of the step) at which the step has progressed by a part, 0 to 1.
    pub fn time(&self, part: f64) -> f64 {
        if part == 0.0 || part == 1.0 {
            return part * self.duration;
        }
        let Ramps { up, down, before, after } = self.ramps;
        let [risen, falls] = self.knots;
        let integral = part * self.whole;
        let rise = self.integral(risen);
        let time = if integral <= rise {
            (before * before + 2.0 * up * integral).sqrt() - before
        } else if integral <= rise + falls - risen {
            risen + integral - rise
        } else {
            let (first, over) = (self.duration - falls + after, integral - rise - (falls - risen));
            self.duration + after - (first * first - 2.0 * down * over).max(0.0).sqrt()
        };
        time.clamp(0.0, self.duration)
    }

    /// Returns the rate of progress at a time (s from the start of the step), 1/s.
    pub fn rate(&self, t: f64) -> f64 {
        let Ramps { up, down, before, after } = self.ramps;
        let rising = if up > 0.0 { (t + before) / up } else { 1.0 };
        let falling = if down > 0.0 { (self.duration - t + after) / down } else { 1.0 };
        rising.min(falling).min(1.0) / self.whole
    }

    /// Returns the greatest rate of progress, 1/s.
    pub fn peak(&self) -> f64 {
        self.rate(self.knots[0]).max(self.rate(self.knots[1]))
    }

    /// Returns the acceleration of progress while its rate rises, and while it falls, 1/s²; both positive, and 0 where it
    /// does not.
    pub fn accelerations(&self) -> [f64; 2] {
        let Ramps { up, down, .. } = self.ramps;
        let [risen, falls] = self.knots;
        let of = |ramp: f64, there: bool| if there { 1.0 / (ramp * self.whole) } else { 0.0 };
        [of(up, up > 0.0 && risen > 0.0), of(down, down > 0.0 && falls < self.duration)]
    }

    /// Returns true if the rate of progress is constant for some time.
    pub fn coasts(&self) -> bool {
        self.knots[1] - self.knots[0] > TOLERANCES.ramp_overlap * self.duration
    }
}
