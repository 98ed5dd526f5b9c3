//! Sine and cosine, the same to the bit on every platform, and quick: forward kinematics does little
//! else.

use std::f64::consts::FRAC_2_PI;

/// π/2 in two parts, the first of 33 bits, so that its product with a count of quarter turns is exact.
const QUARTER: (f64, f64) = (1.570_796_326_734_125_6, 6.077_100_506_506_192e-11);

/// The greatest angle, rad, whose count of quarter turns fits the free bits of the first part.
const ANGLE_MAX: f64 = 1e5;

/// Adding and subtracting this rounds to the nearest whole number.
const ROUNDING: f64 = 1.5 * (1u64 << 52) as f64;

/// Returns (sine, cosine) of an angle in radians, to about one unit in the last place and to the same bit on every
/// platform: by argument reduction after Cody and Waite and a Taylor series. NaN for an angle that is not finite.
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    if is_far(angle) { libm::sincos(angle) } else { of_near(angle) }
}

/// Finds sine and cosine of many angles (rad) as [`sin_cos`] does, several at once where the caller is compiled for wider
/// registers. The three slices have one length.
#[inline(always)]
pub fn sin_cos_of_all(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    for ((angle, sine), cosine) in angles.iter().zip(sines.iter_mut()).zip(cosines.iter_mut()) {
        (*sine, *cosine) = of_near(*angle);
    }
    for ((angle, sine), cosine) in
        angles.iter().zip(sines).zip(cosines).filter(|((angle, _), _)| is_far(**angle))
    {
        (*sine, *cosine) = libm::sincos(*angle);
    }
}

/// Returns true if the quarter turns of an angle are too many to be counted, or it is not a number.
#[inline(always)]
fn is_far(angle: f64) -> bool {
    angle.is_nan() || angle.abs() > ANGLE_MAX
}

/// Returns (sine, cosine) of an angle that is not [far](is_far).
#[inline(always)]
fn of_near(angle: f64) -> (f64, f64) {
    let rounded = angle * FRAC_2_PI + ROUNDING;
    let turns = rounded - ROUNDING;
    let rest = (angle - turns * QUARTER.0) - turns * QUARTER.1;
    let (s, c) = near_zero(rest);
    // The last bits of the rounded number are those of the count; without jumps, which would often be guessed wrong.
    let quarter = rounded.to_bits();
    let (s, c) = if quarter & 1 == 0 { (s, c) } else { (c, s) };
    let negated = |x: f64, quarter: u64| f64::from_bits(x.to_bits() ^ ((quarter & 2) << 62));
    (negated(s, quarter), negated(c, quarter.wrapping_add(1)))
}

/// Returns sine and cosine by the series of Taylor, which within an eighth of a turn are exact to 1e-17 after
/// eight terms.
#[inline(always)]
fn near_zero(x: f64) -> (f64, f64) {
    const fn inverse_factorial(n: u64) -> f64 {
        let (mut product, mut i) = (1u64, 2);
        while i <= n {
            product *= i;
            i += 1;
        }
        1.0 / product as f64
    }
    const S: [f64; 8] = [
        -inverse_factorial(3),
        inverse_factorial(5),
        -inverse_factorial(7),
        inverse_factorial(9),
        -inverse_factorial(11),
        inverse_factorial(13),
        -inverse_factorial(15),
        inverse_factorial(17),
    ];
    const C: [f64; 7] = [
        inverse_factorial(4),
        -inverse_factorial(6),
        inverse_factorial(8),
        -inverse_factorial(10),
        inverse_factorial(12),
        -inverse_factorial(14),
        inverse_factorial(16),
    ];
    let x2 = x * x;
    let x4 = x2 * x2;
    let x8 = x4 * x4;
    // In pairs of pairs, so that the processor need not wait for one product after the other.
    let s =
        ((S[0] + S[1] * x2) + (S[2] + S[3] * x2) * x4) + ((S[4] + S[5] * x2) + (S[6] + S[7] * x2) * x4) * x8;
    let c = ((C[0] + C[1] * x2) + (C[2] + C[3] * x2) * x4) + ((C[4] + C[5] * x2) + C[6] * x4) * x8;
    (x + x * x2 * s, 1.0 - (0.5 * x2 - x4 * c))
}
