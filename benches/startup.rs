//! How long a whole `modl check examples/square.mod` takes, from process creation to its end.
//!
//! `cargo bench --bench startup`. Beside it stand a process that only prints its version, and the
//! system's `true`, so that what the machine itself takes can be told apart.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const RUNS: usize = 300;

fn main() {
    let modl = env!("CARGO_BIN_EXE_modl");
    let square = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/square.mod");
    let square = square.to_str().expect("the path is UTF-8");
    for (name, command) in [
        ("true", &["true"][..]),
        ("modl --version", &[modl, "--version"]),
        ("modl check square.mod", &[modl, "check", square]),
    ] {
        let mut times: Vec<Duration> = (0..RUNS).map(|_| once(command)).collect();
        times.sort();
        let [least, median, high] = [0, RUNS / 2, RUNS * 9 / 10].map(|i| times[i].as_secs_f64() * 1e3);
        println!("{name:<24} median {median:6.2} ms   least {least:6.2} ms   90 % below {high:6.2} ms");
    }
}

fn once(command: &[&str]) -> Duration {
    let begin = Instant::now();
    let mut process = Command::new(command[0]);
    process.args(&command[1..]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let status = process.status().expect("the command runs");
    assert!(status.success(), "{command:?} fails");
    begin.elapsed()
}
