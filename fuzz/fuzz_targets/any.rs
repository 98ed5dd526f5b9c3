//! Any target under a fuzzer that follows coverage: its bytes are the choices of the generator. The name of the program is
//! that of the target.
#![no_main]

#[path = "../mod.rs"]
mod fuzz;

use fuzz::targets::Target;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    Target::named(env!("CARGO_BIN_NAME")).expect("each program has the name of a target").check_bytes(bytes);
});
