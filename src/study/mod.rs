//! Designs of experiments: which points a study evaluates. Numbers in, numbers out; no language, no robots.
//!
//! A [`Design`] has axes and a [`Sampler`]. The rows of the study's table are numbered from 0, and the number of a row
//! gives its point ([`Design::point`]): so rows can be computed anywhere, in any order. A search ([`Search`]) is the
//! exception: its points follow from the values of the rows before them.

mod search;
mod sobol;

pub use search::{Goal, Search};
pub use sobol::{COORDINATES_MAX, POINTS_MAX, sobol};

use crate::optimize::random::SplitMix64;

/// The greatest number of rows of a study.
pub const ROWS_MAX: u64 = 1 << 32;

/// The values that an axis of a study may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// A number of values, one for each index from 0.
    Values(u64),
    /// All numbers from the first to the second, both included, in SI units.
    Range(f64, f64),
}

/// The value of an axis at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinate {
    /// The value of this index, of an axis of [`Domain::Values`].
    Index(u64),
    /// A number in SI units, on an axis of [`Domain::Range`].
    Number(f64),
}

/// The rule by which the points of a study are chosen.
#[derive(Clone, Debug, PartialEq)]
pub enum Sampler {
    /// All combinations of the values of the axes, the last axis fastest. For each axis the number of its values,
    /// evenly spaced on a range with both ends, the middle for one.
    Grid(Vec<u64>),
    /// The first points of the Sobol sequence, as many as stated.
    Sobol(u64),
    /// As many independent points as stated, evenly distributed.
    Random(u64),
    /// A search of as many points as stated.
    Search(u64),
}

/// The axes of a study with its sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The axes whose values the sampler chooses, in order.
    pub axes: Vec<Domain>,
    /// For each further axis, the number of its values: every point is evaluated for all their combinations.
    pub each: Vec<u64>,
    /// The rule by which the points are chosen.
    pub sampler: Sampler,
    /// The seed of random points, and of a search.
    pub seed: u64,
}

impl Design {
    /// Returns the number of points; `None` beyond `u64`.
    fn points(&self) -> Option<u64> {
        match &self.sampler {
            Sampler::Grid(counts) => counts.iter().try_fold(1u64, |all, count| all.checked_mul(*count)),
            Sampler::Sobol(count) | Sampler::Random(count) | Sampler::Search(count) => Some(*count),
        }
    }

    /// Returns the number of rows of each point; `None` beyond `u64`.
    fn repetitions(&self) -> Option<u64> {
        self.each.iter().try_fold(1u64, |all, count| all.checked_mul(*count))
    }

    /// Returns the number of rows of the table: points times the combinations of the further axes. `None` beyond
    /// [`ROWS_MAX`].
    ///
    /// ```
    /// use modl::study::{Coordinate, Design, Domain, Sampler};
    /// let axes = vec![Domain::Values(3), Domain::Range(0.0, 1.0)];
    /// let design = Design { axes, each: vec![2], sampler: Sampler::Grid(vec![3, 5]), seed: 0 };
    /// assert_eq!(design.rows(), Some(30));
    /// assert_eq!(design.point(1), Some(vec![Coordinate::Index(0), Coordinate::Number(0.25)]));
    /// assert_eq!(design.each_of(3), [1]);
    /// ```
    pub fn rows(&self) -> Option<u64> {
        self.points()?.checked_mul(self.repetitions()?).filter(|rows| *rows <= ROWS_MAX)
    }

    /// Returns the number of rows of one point, which follow each other. Panics if [`rows`](Self::rows) has no number.
    pub fn rows_of_point(&self) -> u64 {
        self.repetitions().expect("the study has a number of rows")
    }

    /// Returns the indices of the values of the further axes in a row, the last axis fastest.
    pub fn each_of(&self, row: u64) -> Vec<u64> {
        mixed_radix(row % self.rows_of_point().max(1), &self.each)
    }

    /// Returns a point, by its number from 0; `None` for a search, whose points depend on the rows before them.
    pub fn point(&self, point: u64) -> Option<Vec<Coordinate>> {
        let axes = self.axes.iter().enumerate();
        Some(match &self.sampler {
            Sampler::Grid(counts) => {
                let indices = mixed_radix(point, counts);
                let at = |((axis, domain), index): ((usize, &Domain), u64)| match domain {
                    Domain::Values(_) => Coordinate::Index(index),
                    Domain::Range(from, to) => Coordinate::Number(evenly(*from, *to, index, counts[axis])),
                };
                axes.zip(indices).map(at).collect()
            }
            Sampler::Sobol(_) => axes.map(|(axis, domain)| domain.at(sobol(point, axis))).collect(),
            Sampler::Random(_) => {
                // Two rounds of the generator keep neighbouring seeds and points apart.
                let mut random = SplitMix64(SplitMix64(self.seed).next_u64() ^ point);
                let mut random = SplitMix64(random.next_u64());
                self.axes.iter().map(|domain| domain.at(random.next_f64())).collect()
            }
            Sampler::Search(_) => return None,
        })
    }
}

impl Domain {
    /// Returns the value at a part of the axis in [0, 1]. Values of a list take equal parts of it.
    pub fn at(&self, part: f64) -> Coordinate {
        match self {
            Domain::Values(count) => {
                Coordinate::Index(((part * *count as f64) as u64).min(count.saturating_sub(1)))
            }
            Domain::Range(from, to) => {
                let x = from + (to - from) * part;
                Coordinate::Number(x.clamp(from.min(*to), from.max(*to)))
            }
        }
    }
}

/// Returns one of `count` values evenly spaced from `from` to `to`, both included; the middle if there is one.
fn evenly(from: f64, to: f64, index: u64, count: u64) -> f64 {
    match count {
        0 | 1 => (from + to) / 2.0,
        _ if index + 1 == count => to,
        _ => from + (to - from) * (index as f64 / (count - 1) as f64),
    }
}

/// Returns the digits of a number in a system of mixed radices, the last one the fastest.
fn mixed_radix(mut number: u64, radices: &[u64]) -> Vec<u64> {
    let mut digits = vec![0; radices.len()];
    for (digit, radix) in digits.iter_mut().zip(radices).rev() {
        *digit = number % (*radix).max(1);
        number /= (*radix).max(1);
    }
    digits
}
