//! Legendre series of functions on an interval, by Gauss-Legendre quadrature: mean and peak of their absolute
//! value. Torques follow analytic laws of motion, for which few terms reach the last digits.

use std::f64::consts::PI;

/// The number of terms of a Legendre series, and of the points at which a function is sampled for it.
pub(super) const TERMS: usize = 20;

/// The number of points at which signs are compared: more changes between two of them are missed.
const SIGN_SAMPLES: usize = 48;

/// Bisections and ternary sections of an interval: to the last digits.
const SECTIONS: usize = 50;

/// The rule of Gauss-Legendre quadrature on -1..1 with [`TERMS`] points: it turns samples of a function there into a
/// Legendre series.
pub(super) struct Rule {
    /// The points of the quadrature in -1..1, the roots of the Legendre polynomial of degree [`TERMS`].
    pub points: [f64; TERMS],
    /// The contribution of a value at a point to a term, by term, then by point.
    terms: [[f64; TERMS]; TERMS],
}

impl Default for Rule {
    fn default() -> Rule {
        let mut rule = Rule { points: [0.0; TERMS], terms: [[0.0; TERMS]; TERMS] };
        for i in 0..TERMS {
            // Newton's steps from the well-known estimate of a root.
            let mut x = libm::cos(PI * (TERMS as f64 - i as f64 - 0.25) / (TERMS as f64 + 0.5));
            let mut slope = 1.0;
            for _ in 0..10 {
                let p = polynomials::<{ TERMS + 1 }>(x);
                slope = TERMS as f64 * (x * p[TERMS] - p[TERMS - 1]) / (x * x - 1.0);
                x -= p[TERMS] / slope;
            }
            let weight = 2.0 / ((1.0 - x * x) * slope * slope);
            let p = polynomials::<TERMS>(x);
            rule.points[i] = x;
            for (k, term) in rule.terms.iter_mut().enumerate() {
                term[i] = weight * p[k] * (k as f64 + 0.5);
            }
        }
        rule
    }
}

/// A function on -1..1 as a sum of Legendre polynomials; coefficient k is that of degree k, in the function's unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Series([f64; TERMS]);

impl Rule {
    /// Returns the Legendre series, to degree [`TERMS`] - 1, of the function with these values at [`Rule::points`], in
    /// their order; in the unit of the values.
    pub(super) fn series(&self, values: &[f64; TERMS]) -> Series {
        Series(self.terms.map(|term| term.iter().zip(values).map(|(t, v)| t * v).sum()))
    }
}

impl Series {
    /// Returns the value of the series at a point in -1..1, in the function's unit.
    pub(super) fn at(&self, x: f64) -> f64 {
        let p = polynomials::<TERMS>(x);
        self.0.iter().zip(&p).map(|(c, p)| c * p).sum()
    }

    /// Returns the integral from -1 to x.
    fn integral(&self, x: f64) -> f64 {
        let p = polynomials::<{ TERMS + 1 }>(x);
        // The integral of P_k is (P_{k+1} - P_{k-1}) / (2k + 1), which is zero at -1.
        let higher = (1..TERMS).map(|k| self.0[k] * (p[k + 1] - p[k - 1]) / (2 * k + 1) as f64);
        self.0[0] * (x + 1.0) + higher.sum::<f64>()
    }

    /// Returns the mean and the peak of the absolute value over -1..1; the mean is exact between the changes of sign
    /// found. Two changes of sign nearer to each other than 2/`SIGN_SAMPLES` may be missed.
    pub(super) fn size(&self) -> Size {
        let place = |i: usize| 2.0 * i as f64 / SIGN_SAMPLES as f64 - 1.0;
        let values: [f64; SIGN_SAMPLES + 1] = std::array::from_fn(|i| self.at(place(i)));
        let (mut sum, mut from) = (0.0, 0.0);
        let mut peak = 0.0_f64;
        for i in 0..=SIGN_SAMPLES {
            peak = peak.max(values[i].abs());
            if i < SIGN_SAMPLES && values[i] * values[i + 1] < 0.0 {
                let to = self.integral(self.root(place(i), place(i + 1)));
                sum += (to - from).abs();
                from = to;
            }
        }
        sum += (self.integral(1.0) - from).abs();
        for i in 1..SIGN_SAMPLES {
            let [before, here, after] = [values[i - 1], values[i], values[i + 1]].map(f64::abs);
            // Only where the top may be higher than what was seen.
            let rise = (here - before).max(here - after);
            if here >= before && here >= after && here + rise > peak {
                peak = peak.max(self.top(place(i - 1), place(i + 1)));
            }
        }
        Size { mean: sum / 2.0, peak }
    }

    /// Returns the root between two points with values of opposite signs, by bisection.
    fn root(&self, mut low: f64, mut high: f64) -> f64 {
        let sign = self.at(low);
        for _ in 0..SECTIONS {
            let middle = (low + high) / 2.0;
            if self.at(middle) * sign > 0.0 { low = middle } else { high = middle }
        }
        low
    }

    /// Returns the greatest absolute value between two points around one top, by ternary search.
    fn top(&self, mut low: f64, mut high: f64) -> f64 {
        let size = |x: f64| self.at(x).abs();
        for _ in 0..SECTIONS {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if size(a) < size(b) { low = a } else { high = b }
        }
        size((low + high) / 2.0)
    }
}

/// The mean over an interval and the peak in it of the absolute value of a function, in the function's unit. For
/// torques, in N·m, the interval is the time of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Size {
    /// The mean of the absolute value, in the unit of the function.
    pub mean: f64,
    /// The greatest absolute value, in the unit of the function.
    pub peak: f64,
}

/// Returns the first N Legendre polynomials at a point.
fn polynomials<const N: usize>(x: f64) -> [f64; N] {
    let mut p = [1.0; N];
    p[1] = x;
    for k in 1..N - 1 {
        p[k + 1] = ((2 * k + 1) as f64 * x * p[k] - k as f64 * p[k - 1]) / (k + 1) as f64;
    }
    p
}
