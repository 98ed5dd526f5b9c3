//! Inputs made by seeded generators that know the grammars, and the properties that must hold for each.
//!
//! The test program runs these targets (`tests/fuzzing`), and so does `cargo fuzz` (`fuzz/fuzz_targets`): there the bytes
//! of the fuzzer are the choices of the generators. `docs/fuzzing.md` tells what is tried.

pub mod inputs;
pub mod targets;
