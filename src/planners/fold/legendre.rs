//! Functions on an interval as sums of Legendre polynomials: the mean and the peak of their absolute
//! value. What is folded moves by analytic laws, for which few terms come to the last digits.

use std::f64::consts::PI;

/// Terms, and points at which a function is asked.
pub const TERMS: usize = 20;

/// Places at which signs are compared: more changes between two of them are missed.
const LOOKS: usize = 48;

/// Halvings and sections of an interval: to the last digits.
const SECTIONS: usize = 50;

/// Gauss's points and weights, with the polynomials there.
pub struct Rule {
    /// In -1..1.
    pub points: [f64; TERMS],
    /// By term, then by point: what a value contributes to the term.
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

/// A function on -1..1.
#[derive(Clone, Copy, Debug)]
pub struct Series([f64; TERMS]);

impl Rule {
    /// The function with these values at the points.
    pub fn series(&self, values: &[f64; TERMS]) -> Series {
        Series(self.terms.map(|term| term.iter().zip(values).map(|(t, v)| t * v).sum()))
    }
}

impl Series {
    pub fn at(&self, x: f64) -> f64 {
        let p = polynomials::<TERMS>(x);
        self.0.iter().zip(&p).map(|(c, p)| c * p).sum()
    }

    /// The integral from -1 to x.
    fn integral(&self, x: f64) -> f64 {
        let p = polynomials::<{ TERMS + 1 }>(x);
        // The integral of P_k is (P_{k+1} - P_{k-1}) / (2k + 1), which is zero at -1.
        let higher = (1..TERMS).map(|k| self.0[k] * (p[k + 1] - p[k - 1]) / (2 * k + 1) as f64);
        self.0[0] * (x + 1.0) + higher.sum::<f64>()
    }

    /// Mean and greatest of the absolute value.
    pub fn size(&self) -> Size {
        let place = |i: usize| 2.0 * i as f64 / LOOKS as f64 - 1.0;
        let values: [f64; LOOKS + 1] = std::array::from_fn(|i| self.at(place(i)));
        let (mut sum, mut from) = (0.0, 0.0);
        let mut peak = 0.0_f64;
        for i in 0..=LOOKS {
            peak = peak.max(values[i].abs());
            if i < LOOKS && values[i] * values[i + 1] < 0.0 {
                let to = self.integral(self.root(place(i), place(i + 1)));
                sum += (to - from).abs();
                from = to;
            }
        }
        sum += (self.integral(1.0) - from).abs();
        for i in 1..LOOKS {
            let [before, here, after] = [values[i - 1], values[i], values[i + 1]].map(f64::abs);
            // Only where the top may be higher than what was seen.
            let rise = (here - before).max(here - after);
            if here >= before && here >= after && here + rise > peak {
                peak = peak.max(self.top(place(i - 1), place(i + 1)));
            }
        }
        Size { mean: sum / 2.0, peak }
    }

    fn root(&self, mut low: f64, mut high: f64) -> f64 {
        let sign = self.at(low);
        for _ in 0..SECTIONS {
            let middle = (low + high) / 2.0;
            if self.at(middle) * sign > 0.0 { low = middle } else { high = middle }
        }
        low
    }

    fn top(&self, mut low: f64, mut high: f64) -> f64 {
        let size = |x: f64| self.at(x).abs();
        for _ in 0..SECTIONS {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if size(a) < size(b) { low = a } else { high = b }
        }
        size((low + high) / 2.0)
    }
}

/// Of the absolute value of a function.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Size {
    pub mean: f64,
    pub peak: f64,
}

/// The first N Legendre polynomials at a place.
fn polynomials<const N: usize>(x: f64) -> [f64; N] {
    let mut p = [1.0; N];
    p[1] = x;
    for k in 1..N - 1 {
        p[k + 1] = ((2 * k + 1) as f64 * x * p[k] - k as f64 * p[k - 1]) / (k + 1) as f64;
    }
    p
}
