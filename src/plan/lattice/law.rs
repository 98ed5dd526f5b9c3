//! The kinematics of one stage: sums and extremes of the displacements of its cells, and its time scaling,
//! compared with limits in exact arithmetic.

use super::grid::Cube;
use super::window::Window;
use crate::plan::stages::motion::Stage;
use crate::plan::stages::ratio::Ratio;
use num_bigint::BigInt;
use std::cmp::Ordering;

/// The sums and extremes of the displacements of all cells over a stage. Displacements are counted twice, in grid
/// lines: they are those of the sum of a cell's two faces. The default is that of a stage without cells.
#[derive(Clone, Debug, Default)]
pub struct Change {
    /// The axes of motion: for x, y and z, true if some face moves along that axis.
    pub axes: [bool; 3],
    /// The greatest absolute displacement along an axis, in grid lines and counted twice, with the number of its cell.
    pub farthest: (i64, u32),
    /// The sum of the displacements along x, y and z, in grid lines, each counted twice: zero if the centre of mass
    /// stays.
    pub drift: [i128; 3],
    /// The greatest absolute change of an edge length, in grid lines (counted once), with the number of its cell.
    pub resized: (i64, u32),
    /// The smallest edge length at the end, in grid lines, with the number of its cell.
    pub smallest: (i64, u32),
    /// The largest edge length at the end, in grid lines, with the number of its cell.
    pub largest: (i64, u32),
    /// Four times the sum of the cross products of position and displacement, x, y and z, in squared grid lines: zero
    /// without angular momentum.
    pub turning: [i128; 3],
    /// The sum of the squared norms of the displacements, in squared grid lines, each displacement counted twice.
    pub squares: i128,
    /// The greatest squared norm of a displacement, in squared grid lines, the displacement counted twice.
    pub square: i128,
}

impl Change {
    /// Returns the sums and extremes for the cells `before` and `after` a stage, by number, in one pass.
    pub fn of(before: &[Cube], after: &[Cube]) -> Change {
        let mut change = Change { smallest: (i64::MAX, 0), ..Change::default() };
        for (cell, (old, new)) in before.iter().zip(after).enumerate() {
            let cell = cell as u32;
            // Displacements of the centre and changes of the edges, axis by axis.
            let mut moved = [0_i128; 3];
            for (axis, moved) in moved.iter_mut().enumerate() {
                let displacement = new.middle(axis) - old.middle(axis);
                let size = new.size(axis);
                let resized = (size - old.size(axis)).abs();
                if displacement != 0 {
                    *moved = i128::from(displacement);
                    change.drift[axis] += *moved;
                    change.axes[axis] = true;
                    keep(&mut change.farthest, displacement.abs(), cell);
                }
                if resized != 0 {
                    change.axes[axis] = true;
                    keep(&mut change.resized, resized, cell);
                }
                keep(&mut change.largest, size, cell);
                if size < change.smallest.0 {
                    change.smallest = (size, cell);
                }
            }
            if moved == [0; 3] {
                continue;
            }
            // Sums over cells that move: squares, and the angular momentum.
            let square = moved.iter().map(|d| d * d).sum();
            change.squares += square;
            change.square = change.square.max(square);
            for axis in 0..3 {
                let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                if moved[b] != 0 || moved[c] != 0 {
                    let (y, z) = (i128::from(old.middle(b)), i128::from(old.middle(c)));
                    change.turning[axis] += y * moved[c] - z * moved[b];
                }
            }
        }
        change
    }

    /// Returns true if no face of any cell moves.
    pub fn is_none(&self) -> bool {
        self.axes == [false; 3]
    }
}

/// Keeps the greater value with its cell; of equal ones the first.
fn keep(worst: &mut (i64, u32), value: i64, cell: u32) {
    if value > worst.0 {
        *worst = (value, cell);
    }
}

/// The time scaling `σ(t)` of a stage, which takes the path parameter from 0 to 1, with exact comparisons of the
/// speeds and accelerations that follow from it.
pub struct TimeScaling {
    time_squared: Ratio,
    /// Peak of `σ'` times the duration, as a fraction.
    speed: (i64, i64),
    /// The fractions of the duration in which the stage speeds up and slows down.
    ramps: (Ratio, Ratio),
    /// The shorter ramp's fraction of the duration; a ramp of none is left out.
    ramp: Ratio,
}

impl TimeScaling {
    /// Returns the time scaling of a stage from its law and duration. The duration must not be zero if speeds or
    /// accelerations are asked for.
    pub fn of(stage: &Stage) -> TimeScaling {
        let (first, last) = stage.law.ramps();
        // 2 / (2 - first - last)
        let denominator = first.1 as i128 * last.1 as i128;
        let rest = 2 * denominator - first.0 as i128 * last.1 as i128 - last.0 as i128 * first.1 as i128;
        let speed = Ratio::new(2 * denominator, rest).unwrap_or(Ratio(i64::MAX, 1));
        let ramp = match (first.0, last.0) {
            (0, _) => last,
            (_, 0) => first,
            _ if first.order(last).is_le() => first,
            _ => last,
        };
        TimeScaling {
            time_squared: stage.time_squared,
            speed: (speed.0, speed.1),
            ramps: (first, last),
            ramp,
        }
    }

    /// Compares the peak acceleration (or force, per mass of a cell) of a thing that moves by `distance / lines` cells
    /// over the stage with a limit in cells per squared time unit: `Greater` if it exceeds the limit.
    pub fn compare_acceleration(&self, distance: i128, lines: i128, limit: Ratio) -> Ordering {
        // distance · speed / (ramp · T²) against the limit
        let product = |factors: &[i128]| factors.iter().map(|&f| BigInt::from(f)).product::<BigInt>();
        let big = i128::from;
        let (t, ramp) = (self.time_squared, self.ramp);
        let left = product(&[distance, big(self.speed.0), big(ramp.1), big(t.1), big(limit.1)]);
        let right = product(&[lines, big(self.speed.1), big(ramp.0), big(t.0), big(limit.0)]);
        left.cmp(&right)
    }

    /// Compares the squared peak acceleration, in cells per squared time unit, with 1, for a thing that moves by a
    /// distance with this square in squared grid lines, `lines` to a cell: `Greater` if it exceeds 1.
    pub fn compare_acceleration_squared(&self, square: i128, lines: i128) -> Ordering {
        let product = |factors: [i128; 3]| factors.iter().map(|&f| BigInt::from(f)).product::<BigInt>();
        let big = i128::from;
        let (t, ramp) = (self.time_squared, self.ramp);
        let left = product([big(self.speed.0), big(ramp.1), big(t.1)]);
        let right = product([lines * big(self.speed.1), big(ramp.0), big(t.0)]);
        (BigInt::from(square) * &left * &left).cmp(&(&right * &right))
    }

    /// Compares the squared peak speed of a thing that moves by `distance / lines` cells over the stage with a limit
    /// in squared cells per squared time unit: `Greater` if it exceeds the limit.
    pub fn compare_speed_squared(&self, distance: i64, lines: i64, limit: Ratio) -> Ordering {
        let product = |factors: &[i64]| factors.iter().map(|&f| BigInt::from(f)).product::<BigInt>();
        let (t, (up, down)) = (self.time_squared, self.speed);
        let left = product(&[distance, distance, up, up, t.1, limit.1]);
        let right = product(&[lines, lines, down, down, t.0, limit.0]);
        left.cmp(&right)
    }

    /// Compares a bound on the squared peak speed as [`TimeScaling::compare_speed_squared`] does, but only while the
    /// path parameter is in a window: the least of the peak of the stage and of the speeds that the ramps allow at
    /// the ends of the window. On a ramp the square of `σ'` is linear in `σ`. `distance` and `lines`: as for that
    /// function; `limit`: the greatest squared speed, in squared cells per squared time unit.
    pub fn compare_speed_squared_within(
        &self,
        window: Window,
        distance: i64,
        lines: i64,
        limit: Ratio,
    ) -> Ordering {
        let product = |factors: &[i128]| factors.iter().map(|&f| BigInt::from(f)).product::<BigInt>();
        let (t, (up, down)) = (self.time_squared, self.speed);
        let big = i128::from;
        let left = product(&[big(distance), big(distance), big(up), big(t.1), big(limit.1)]);
        let right = product(&[big(lines), big(lines), big(down), big(t.0), big(limit.0)]);
        // Up to `σ` the square of `σ' T` is at most twice the speed times `σ` by the ramp.
        let ramped = |ramp: Ratio, (above, below): (i128, i128)| {
            let left: BigInt = &left * 2 * ramp.1 * above;
            let right: BigInt = &right * ramp.0 * below;
            if ramp.0 == 0 { Ordering::Greater } else { left.cmp(&right) }
        };
        let rest = (window.from.1 - window.from.0, window.from.1);
        let (first, last) = (ramped(self.ramps.0, window.to), ramped(self.ramps.1, rest));
        self.compare_speed_squared(distance, lines, limit).min(first).min(last)
    }

    /// Returns the peak of `σ''` times the square of the duration as (numerator, denominator), not in lowest terms;
    /// without unit.
    pub fn acceleration_ratio(&self) -> (i64, i64) {
        (self.speed.0 * self.ramp.1, self.speed.1 * self.ramp.0)
    }

    /// Returns the peak of `σ'`, in 1 per unit of time of the plan
    /// ([`Stages::time_unit`](crate::plan::Stages::time_unit)).
    pub fn peak_speed(&self) -> f64 {
        self.speed.0 as f64 / self.speed.1 as f64 / libm::sqrt(self.time_squared.to_f64())
    }

    /// Returns the peak of `σ''`, in 1 per squared unit of time of the plan
    /// ([`Stages::time_unit`](crate::plan::Stages::time_unit)).
    pub fn peak_acceleration(&self) -> f64 {
        self.speed.0 as f64 / self.speed.1 as f64 / self.ramp.to_f64() / self.time_squared.to_f64()
    }
}

/// Returns true if a stage ends at rest and the next one begins at rest.
pub fn rests_between(stage: &Stage, next: &Stage) -> bool {
    stage.law.ramps().1.0 != 0 && next.law.ramps().0.0 != 0
}

/// Checks that velocities are continuous between two stages, if the first does not end at rest or the second does not
/// begin at rest. Each stage is given with the cells, by number, at its outer end; `between` are those at the instant
/// between the two.
///
/// # Errors
/// The number of the first cell whose velocity jumps.
pub fn velocities_continue(
    (stage, before): (&Stage, &[Cube]),
    between: &[Cube],
    (next, after): (&Stage, &[Cube]),
) -> Result<(), usize> {
    if rests_between(stage, next) {
        return Ok(());
    }
    let (_, out) = stage.law.ramps();
    let (into, _) = next.law.ramps();
    let (first, second) = (TimeScaling::of(stage), TimeScaling::of(next));
    // Velocities are displacement · speed / T; their squares and signs decide if they are equal.
    let factor = |scaling: &TimeScaling, moves: bool| {
        let t = scaling.time_squared;
        (
            BigInt::from(scaling.speed.0) * scaling.speed.0 * t.1 * i64::from(moves),
            BigInt::from(scaling.speed.1) * scaling.speed.1 * t.0,
        )
    };
    let (left, right) = (factor(&first, out.0 == 0), factor(&second, into.0 == 0));
    let (left, right) = (left.0 * right.1, right.0 * left.1);
    let same = |cell: usize, axis: usize| {
        let d = between[cell].middle(axis) - before[cell].middle(axis);
        let e = after[cell].middle(axis) - between[cell].middle(axis);
        let square = |d: i64, factor: &BigInt| factor * d * d * d.signum();
        square(d, &left) == square(e, &right)
    };
    match (0..between.len()).find(|&cell| !(0..3).all(|axis| same(cell, axis))) {
        Some(cell) => Err(cell),
        None => Ok(()),
    }
}
