//! Tests of properties of random inputs.

use proptest::test_runner::{Config, RngSeed};

/// With `MODL_WHOLE=1`, every property is tested with so many times the cases.
const WHOLE: u32 = 10;

/// Returns true where all cases are to run, as in `.ci/full`, and not those of the gate: with `MODL_WHOLE=1`.
pub fn whole() -> bool {
    std::env::var_os("MODL_WHOLE").is_some()
}

/// Returns the settings for a property of so many random cases. The gate draws the same cases in every run, so that it
/// cannot fail on one machine and pass on another; `MODL_WHOLE=1` draws more, and others each time.
pub fn cases(cases: u32) -> Config {
    let rng_seed = if whole() { RngSeed::Random } else { RngSeed::Fixed(4) };
    let cases = if whole() { cases * WHOLE } else { cases };
    Config { cases, rng_seed, failure_persistence: None, ..Config::default() }
}

/// Returns the seeds of random cases that are as many in `.ci/full`, with `MODL_WHOLE=1`: the first quarter of them in the
/// gate, all there.
pub fn seeds(many: u64) -> std::ops::Range<u64> {
    0..if whole() { many } else { many / 4 }
}
