//! Exact fractions of 128 bits for positions that no common grid holds.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A fraction in lowest terms with a positive denominator, or the mark of a number that does not fit: denominator 0,
/// which all that is computed from it has as well.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Fraction {
    above: i128,
    below: i128,
}

impl Fraction {
    /// The number 0.
    pub(super) const ZERO: Fraction = Fraction { above: 0, below: 1 };
    /// The number 1.
    pub(super) const ONE: Fraction = Fraction { above: 1, below: 1 };
    /// The mark of a number that does not fit.
    const OVERFLOW: Fraction = Fraction { above: 0, below: 0 };

    /// Returns `above / below` in lowest terms; the mark of overflow for a denominator of 0.
    pub(super) fn new(above: i128, below: i128) -> Fraction {
        // Most numbers are whole.
        if below == 1 {
            return Fraction { above, below };
        }
        let divisor = gcd(above.unsigned_abs(), below.unsigned_abs());
        let Ok(divisor) = i128::try_from(divisor) else { return Fraction::OVERFLOW };
        if below == 0 || divisor == 0 {
            return Fraction::OVERFLOW;
        }
        let sign = below.signum();
        Fraction { above: above / divisor * sign, below: below / divisor * sign }
    }

    /// Returns a whole number as a fraction.
    pub(super) fn whole(number: i64) -> Fraction {
        Fraction { above: number.into(), below: 1 }
    }

    /// Returns true if the number fits.
    pub(super) fn fits(self) -> bool {
        self.below > 0
    }

    /// Returns true for 0.
    pub(super) fn is_zero(self) -> bool {
        self == Fraction::ZERO
    }

    /// Returns the sign of the number: -1, 0 or 1.
    pub(super) fn sign(self) -> i64 {
        self.above.signum() as i64
    }

    /// Returns the absolute value.
    pub(super) fn abs(self) -> Fraction {
        Fraction { above: self.above.abs(), ..self }
    }

    /// Compares two numbers; numbers that do not fit are equal to all others.
    pub(super) fn order(self, other: Fraction) -> Ordering {
        (self - other).sign().cmp(&0)
    }

    /// Returns the smaller one of two numbers.
    pub(super) fn least(self, other: Fraction) -> Fraction {
        if self.order(other).is_gt() { other } else { self }
    }

    /// Returns the greatest whole number that is not above this one.
    pub(super) fn floor(self) -> i128 {
        if self.fits() { self.above.div_euclid(self.below) } else { 0 }
    }

    /// Returns the denominator.
    pub(super) fn denominator(self) -> i128 {
        self.below
    }

    /// Returns the multiple `lines` of the number, of whose denominator `lines` must be a multiple; `None` if it does not fit
    /// 64 bits.
    pub(super) fn on_grid(self, lines: i128) -> Option<i64> {
        let lines = if self.below == 1 { lines } else { lines / self.below };
        i64::try_from(lines.checked_mul(self.above)?).ok()
    }
}

/// Returns the greatest common divisor; of 0 and `b` it is `b`.
fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        // Most numbers are short, and short division is fast.
        if let (Ok(x), Ok(y)) = (u64::try_from(a), u64::try_from(b)) {
            let (mut x, mut y) = (x, y);
            while y != 0 {
                (x, y) = (y, x % y);
            }
            return x.into();
        }
        (a, b) = (b, a % b);
    }
    a
}

/// Returns the least common multiple of two positive numbers; `None` if it does not fit.
pub(super) fn common_multiple(a: i128, b: i128) -> Option<i128> {
    let divisor = gcd(a.unsigned_abs(), b.unsigned_abs()) as i128;
    if divisor == 0 { None } else { (a / divisor).checked_mul(b) }
}

impl Add for Fraction {
    type Output = Fraction;
    fn add(self, other: Fraction) -> Fraction {
        let sum = || {
            let left = self.above.checked_mul(other.below)?;
            let right = other.above.checked_mul(self.below)?;
            Some(Fraction::new(left.checked_add(right)?, self.below.checked_mul(other.below)?))
        };
        if self.below == other.below && self.below > 0 {
            let added = self.above.checked_add(other.above);
            return added.map_or(Fraction::OVERFLOW, |above| Fraction::new(above, self.below));
        }
        sum().unwrap_or(Fraction::OVERFLOW)
    }
}

impl Neg for Fraction {
    type Output = Fraction;
    fn neg(self) -> Fraction {
        Fraction { above: -self.above, ..self }
    }
}

impl Sub for Fraction {
    type Output = Fraction;
    fn sub(self, other: Fraction) -> Fraction {
        self + -other
    }
}

impl Mul for Fraction {
    type Output = Fraction;
    fn mul(self, other: Fraction) -> Fraction {
        let product = || {
            Some(Fraction::new(self.above.checked_mul(other.above)?, self.below.checked_mul(other.below)?))
        };
        product().unwrap_or(Fraction::OVERFLOW)
    }
}

impl Div for Fraction {
    type Output = Fraction;
    fn div(self, other: Fraction) -> Fraction {
        if !other.fits() {
            return Fraction::OVERFLOW;
        }
        self * Fraction::new(other.below, other.above)
    }
}
