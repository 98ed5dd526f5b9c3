//! Simulations of plans of the library, as real-time factors, beside MuJoCo on the exported models in the same run.
//!
//! `cargo bench --bench simulate`. MuJoCo is used if `MODL_PYTHON` or `target/python/bin/python` has it (`.ci/run` makes
//! that environment).

#[allow(dead_code)]
#[path = "../tests/support"]
mod support {
    pub mod desk;
    pub mod suite;
}

use modl::formats::mjcf;
use modl::plan::{Plan, file};
use modl::simulate::{Settings, simulate};
use serde_json::json;
use std::io::Write;
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
    steps = min(round(tracks.duration / step), 4000)
    times = numpy.arange(steps) * step
    command = numpy.array([tracks.at(model.actuator(a).name, times)[0] for a in range(model.nu)]).T.copy()
    begin = time.perf_counter()
    for row in command:
        data.ctrl[:] = row
        mujoco.mj_step(model, data)
    out.append(steps * step / (time.perf_counter() - begin))
json.dump(out, sys.stdout)
"#;

fn main() {
    let programs = [
        ("Walkbot17.walk", "use std.smores.Walkbot17\nlet p = plan(Walkbot17().walk())"),
        ("Walk4.walk", "use std.smores.Walk4\nlet w = Walk4()\nlet p = plan(Sc(w.stand(), w.walk()))"),
        ("snake of 18", "use std.smores.Snake18\nlet p = plan(Snake18().slither(cycles: 1))"),
    ];
    let mut cases = Vec::new();
    for (name, program) in programs {
        let written = support::desk::run_clean(&format!("{program}\nemit(p, \"p.json\")\n"));
        let plan = file::read(written.text("p.json")).expect("a plan that was written is read");
        for step in STEPS {
            println!("{name:<16} {:4.1} ms  modl     {:6.1} x real time", step * 1e3, ours(&plan, step));
            let value: serde_json::Value = serde_json::from_str(written.text("p.json")).expect("JSON");
            cases.push((name, step, value, mjcf::write(&plan).expect("the robot has joints")));
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

/// Returns MuJoCo's factors; `None` without it.
fn mujoco(cases: &[(&str, f64, serde_json::Value, String)]) -> Option<serde_json::Value> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let python = std::env::var_os("MODL_PYTHON").map_or(root.join("target/python/bin/python"), PathBuf::from);
    let has = Command::new(&python).args(["-c", "import mujoco"]).stderr(Stdio::null()).status();
    if !has.is_ok_and(|status| status.success()) {
        return None;
    }
    let list: Vec<_> = cases.iter().map(|(_, step, plan, model)| json!([plan, model, step])).collect();
    let task = json!({ "folder": root.join("tests/dynamics"), "cases": list });
    let mut child = Command::new(&python)
        .args(["-c", THEIRS])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("Python starts");
    let mut stdin = child.stdin.take().expect("it is piped");
    stdin.write_all(task.to_string().as_bytes()).expect("Python reads");
    drop(stdin);
    let output = child.wait_with_output().expect("Python ends");
    serde_json::from_slice(&output.stdout).ok()
}
