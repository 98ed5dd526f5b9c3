//! Time in plans is counted in ticks of 2⁻³⁶ s (15 ps), so that adding and subtracting times up to
//! [`DURATION_MAX`] is exact in floating point: a plan reversed twice is the plan, to the bit, and
//! the parts of a plan fit together without gaps.

/// The duration of a tick, the unit of time of plans, s: 2⁻³⁶, a power of two, so that sums of times are exact.
pub const TICK: f64 = 1.0 / (1u64 << 36) as f64;

/// The greatest duration of a plan, s: 36 h, less than 2⁵³ ticks, so that double precision holds every tick.
pub const DURATION_MAX: f64 = 129_600.0;

/// Returns the first tick (a whole number of [`TICK`]s) that is not before the time `t`, both in s. Infinite times
/// stay as they are.
pub fn tick_after(t: f64) -> f64 {
    libm::ceil(t / TICK) * TICK
}

/// Returns the tick (a whole number of [`TICK`]s) nearest to the time `t`, both in s; halfway the one farther from 0.
/// Infinite times stay as they are.
pub fn tick_near(t: f64) -> f64 {
    libm::round(t / TICK) * TICK
}
