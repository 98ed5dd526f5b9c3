//! The judge's time for scenes of 1, 2, 4, 8 and 16 cars that all drive: how it grows with the number of clusters.
//!
//! `cargo bench --bench scenes` prints for each number of cars the least of five times of one verdict, in milliseconds, and
//! that time by the number of cars.

use modl::plan::{Plan, file, verify::verify};
use std::process::Command;
use std::time::Instant;

const SCENE: &str = "use std.smores.Tank7
scene Cars(n: Int) {
  part car[i in 0..n]: Tank7 at [0m, i * 700mm, 0m]
  behavior drive = Pc([c.drive(t: 3s) for c in car])
}
";

fn plan(cars: usize) -> Plan {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let program = format!("{SCENE}emit(Cars({cars}).drive(), \"p.json\")\n");
    std::fs::write(folder.path().join("main.mod"), program).expect("the program is written");
    let run = Command::new(env!("CARGO_BIN_EXE_modl"))
        .args(["run", "main.mod"])
        .current_dir(folder.path())
        .output()
        .expect("modl runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = std::fs::read_to_string(folder.path().join("out/p.json")).expect("the plan is there");
    file::read(&text).expect("a plan that was written is read")
}

fn main() {
    println!("{:>5} {:>10} {:>12}", "cars", "ms", "ms a car");
    for cars in [1, 2, 4, 8, 16] {
        let plan = plan(cars);
        let time = || {
            let begun = Instant::now();
            assert!(verify(&plan).ok());
            begun.elapsed().as_secs_f64() * 1e3
        };
        let least = (0..5).map(|_| time()).fold(f64::INFINITY, f64::min);
        println!("{cars:>5} {least:>10.0} {:>12.1}", least / cars as f64);
    }
}
