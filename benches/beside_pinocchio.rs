//! The fixtures of the benches that stand beside pinocchio: robots, their URDF, and the fastest of several runs.

#[path = "../tests/support"]
pub mod support {
    #[allow(dead_code)]
    pub mod numbers;
    pub mod robots;
}
#[allow(dead_code, unused_imports)]
#[path = "../tests/robots/urdf.rs"]
pub mod urdf;

use std::time::Instant;

/// Runs of which the fastest counts: the machine is shared.
pub const RUNS: usize = 9;

/// Returns the least time of one evaluation, s. `evaluations`: their number in each run.
pub fn fastest(evaluations: usize, mut evaluate: impl FnMut()) -> f64 {
    let once = |_| {
        let begin = Instant::now();
        (0..evaluations).for_each(|_| evaluate());
        begin.elapsed().as_secs_f64() / evaluations as f64
    };
    (0..RUNS).map(once).fold(f64::INFINITY, f64::min)
}
