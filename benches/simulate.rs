//! Simulations of plans of the library, as real-time factors, beside MuJoCo on the exported models in the same run.
//!
//! `cargo bench --bench simulate`. MuJoCo is used if `MODL_PYTHON` or `target/python/bin/python` has it (`.ci/run` makes
//! that environment).

#[allow(dead_code)]
#[path = "../tests/support"]
mod support {
    pub mod desk;
    pub mod numbers;
    pub mod robots;
    pub mod suite;
}
#[allow(dead_code, unused_imports)]
#[path = "../tests/robots/urdf.rs"]
mod urdf;

use modl::formats::mjcf;
use modl::plan::{Plan, file};
use modl::simulate::{Settings, Spread, simulate, study};
use serde_json::json;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Runs of which the fastest counts: the machine is shared.
const RUNS: usize = 3;

/// The time that a simulation stands before and after a plan, s.
const STANDING: f64 = 0.6;

/// Time steps, s.
const STEPS: [f64; 2] = [5e-4, 1e-3];

/// MuJoCo's time for a plan with servos that follow it, as seconds and the steps in them.
const THEIRS: &str = r#"
import json, sys, time
task = json.load(sys.stdin)
sys.path.insert(0, task["folder"])
import mujoco, numpy
from mujoco_runner import Tracks, load
out = []
for plan, text, step in task["cases"]:
    tracks = Tracks(plan)
    model, data = load(text, step=step)
    steps = min(round(tracks.duration / step), 4000 if model.nv < 200 else 400)
    times = numpy.arange(steps) * step
    command = numpy.array([tracks.at(model.actuator(a).name, times)[0] for a in range(model.nu)]).T.copy()
    begin = time.perf_counter()
    for row in command:
        data.ctrl[:] = row
        mujoco.mj_step(model, data)
    out.append(steps * step / (time.perf_counter() - begin))
json.dump(out, sys.stdout)
"#;

/// Simulations of one plan with other friction, masses and motors.
const MANY: usize = 40;

/// A snake of segments of three modules, as in `examples/snake.mod`.
const SNAKE: &str = "use std.smores.Chain3
config Snake(n: Int = 6) {
  part seg[n]: Chain3
  for i in 0..n - 1 { connect seg[i].head -- seg[i + 1].tail }
  behavior slither(amplitude: Angle = 30deg, period: Time = 2s, cycles: Int = 3) =
    repeat(Pc([
      if i % 2 == 0 { Sc(seg[i].half_wave(amplitude, period / 2), seg[i].half_wave(-amplitude, period / 2)) }
      else { Sc(seg[i].half_wave(-amplitude, period / 2), seg[i].half_wave(amplitude, period / 2)) }
      for i in 0..n
    ]), cycles)
}
";

fn main() {
    let snake = |segments: usize| format!("{SNAKE}let b = Snake({segments}).slither(cycles: 1)");
    let (snake99, snake300) = (snake(33), snake(100));
    let programs = [
        ("Walkbot17.walk", "use std.smores.Walkbot17\nlet b = Walkbot17().walk()"),
        ("Walk4.walk", "use std.smores.Walk4\nlet w = Walk4()\nlet b = Sc(w.stand(), w.walk())"),
        ("snake of 18", "use std.smores.Snake18\nlet b = Snake18().slither(cycles: 1)"),
        ("snake of 99", &snake99),
        ("snake of 300", &snake300),
    ];
    let mut cases = Vec::new();
    for (name, program) in programs {
        // Under full dynamics the judge refuses the long snakes.
        let world = "world: world(dynamics: statics)";
        let written = support::desk::run_clean(&format!("{program}\nemit(plan(b, {world}), \"p.json\")\n"));
        let plan = file::read(written.text("p.json")).expect("a plan that was written is read");
        for step in STEPS {
            println!("{name:<16} {:4.1} ms  modl     {:6.1} x real time", step * 1e3, ours(&plan, step));
            let value: serde_json::Value = serde_json::from_str(written.text("p.json")).expect("JSON");
            cases.push((name, step, value, mjcf::write(&plan).expect("the robot has joints")));
        }
        if name == "Walk4.walk" {
            many(&plan);
        }
    }
    let Some(theirs) = mujoco(&cases) else {
        println!("no Python with mujoco: nothing to stand beside");
        return;
    };
    for ((name, step, ..), factor) in cases.iter().zip(theirs.as_array().expect("a list")) {
        let factor = factor.as_f64().expect("a number");
        println!("{name:<16} {:4.1} ms  MuJoCo   {factor:6.1} x real time", step * 1e3);
    }
}

/// Returns simulated seconds in a second of the processor.
fn ours(plan: &Plan, step: f64) -> f64 {
    let settings = Settings { step, ..Settings::default() };
    let mut least = f64::INFINITY;
    let mut duration = 0.0;
    for _ in 0..RUNS {
        let begin = Instant::now();
        duration = simulate(plan, &settings).expect("the plan is sound").duration;
        least = least.min(begin.elapsed().as_secs_f64());
    }
    (duration + STANDING) / least
}

/// Prints the time that many simulations with other friction take on two threads.
fn many(plan: &Plan) {
    let settings = Settings { step: 1e-3, ..Settings::default() };
    let spread = Spread { friction: 0.3, mass: 0.1, effort: 0.1, stiffness: 0.2, zero: 0.0 };
    let begin = Instant::now();
    let runs = study(plan, &settings, &spread, MANY, 1).expect("the plan is sound");
    let (time, duration) = (begin.elapsed().as_secs_f64(), runs[0].outcome.duration);
    println!("{MANY} simulations of {duration:.1} s of Walk4 at 1 ms, two threads: {time:.1} s");
}

/// Returns MuJoCo's factors; `None` without it.
fn mujoco(cases: &[(&str, f64, serde_json::Value, String)]) -> Option<serde_json::Value> {
    let python = urdf::python()?;
    let has = Command::new(&python).args(["-c", "import mujoco"]).stderr(Stdio::null()).status();
    if !has.is_ok_and(|status| status.success()) {
        return None;
    }
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/dynamics");
    let list: Vec<_> = cases.iter().map(|(_, step, plan, model)| json!([plan, model, step])).collect();
    Some(urdf::run(&python, THEIRS, &json!({ "folder": folder, "cases": list })))
}
