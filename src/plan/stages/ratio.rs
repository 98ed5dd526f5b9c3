//! Rational numbers of plans of lattices: exact, with numerator and denominator of 64 bits.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::cmp::Ordering;

/// A rational number, numerator and denominator; the denominator must be positive, and the two need not be in lowest
/// terms. In a file a whole number may stand alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ratio(pub i64, pub i64);

impl Ratio {
    /// The number 0 as a fraction.
    pub const ZERO: Ratio = Ratio(0, 1);
    /// The number 1 as a fraction.
    pub const ONE: Ratio = Ratio(1, 1);

    /// Returns `numerator / denominator` in lowest terms with a positive denominator; `None` if 64 bits do not hold
    /// it, or if the denominator is 0.
    pub fn new(numerator: i128, denominator: i128) -> Option<Ratio> {
        if denominator == 0 {
            return None;
        }
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs());
        let sign = if denominator < 0 { -1 } else { 1 };
        let reduced = |n: i128| i64::try_from(n / i128::try_from(divisor).ok()? * sign).ok();
        Some(Ratio(reduced(numerator)?, reduced(denominator)?))
    }

    /// Returns the simplest rational number from `low` to `high`, or from as near to them as the next floating-point numbers:
    /// that of the least denominator. `None` unless 1e-15 < low <= high < 1e15, or if 64 bits hold none.
    pub fn simplest(low: f64, high: f64) -> Option<Ratio> {
        if !(low * 1e15 > 1.0 && low <= high && high < 1e15) {
            return None;
        }
        let (above, below) = simplest_between(exact(low.next_down()), exact(high.next_up()));
        Ratio::new(i128::try_from(above).ok()?, i128::try_from(below).ok()?)
    }

    /// Returns the quotient as a floating-point number: the nearest one if numerator and denominator are at most 2⁵³.
    pub fn to_f64(self) -> f64 {
        self.0 as f64 / self.1 as f64
    }

    /// Compares two numbers exactly, which need not be in lowest terms; their denominators must be positive.
    pub fn order(self, other: Ratio) -> Ordering {
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        product(self.0, other.1).cmp(&product(other.0, self.1))
    }

    /// Returns `self · other` in lowest terms, or `None` if 64 bits do not hold it.
    pub fn times(self, other: Ratio) -> Option<Ratio> {
        Ratio::new(i128::from(self.0) * i128::from(other.0), i128::from(self.1) * i128::from(other.1))
    }
}

/// Returns numerator and denominator of a number from 1e-15 to 1e15: each of these is a multiple of 2⁻¹⁰².
fn exact(x: f64) -> (u128, u128) {
    let bits = x.to_bits();
    let mantissa = u128::from(bits & ((1 << 52) - 1) | 1 << 52);
    // The number is mantissa / 2^places.
    let places = 1075 - (bits >> 52) as u32;
    (mantissa, 1 << places)
}

/// Returns numerator and denominator of the simplest fraction between two that are positive.
fn simplest_between(low: (u128, u128), high: (u128, u128)) -> (u128, u128) {
    // Down the tree of Stern and Brocot, a run of turns to one side at a time: the continued fraction of a
    // number between.
    let whole = low.0 / low.1;
    let rest = low.0 % low.1;
    if rest == 0 {
        return (whole, 1);
    }
    if high.0 / high.1 > whole {
        return (whole + 1, 1);
    }
    let (above, below) = simplest_between((high.1, high.0 % high.1), (low.1, rest));
    (whole * above + below, above)
}

/// Returns the greatest common divisor; of 0 and `b` it is `b`, of 0 and 0 it is 1.
fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a.max(1)
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum RatioText {
    Whole(i64),
    Pair(i64, i64),
}

impl Serialize for Ratio {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Ratio(numerator, denominator) = *self;
        let text = if denominator == 1 {
            RatioText::Whole(numerator)
        } else {
            RatioText::Pair(numerator, denominator)
        };
        text.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Ratio {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Ratio, D::Error> {
        Ok(match RatioText::deserialize(deserializer)? {
            RatioText::Whole(numerator) => Ratio(numerator, 1),
            RatioText::Pair(numerator, denominator) => Ratio(numerator, denominator),
        })
    }
}

impl JsonSchema for Ratio {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Ratio".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        RatioText::json_schema(generator)
    }
}
