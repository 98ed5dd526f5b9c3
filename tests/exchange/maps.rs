//! Maps of robots, samples of plans, and the executors of docs/executing.md on a bus that writes down what it is told.

use crate::desk::cli::{Sandbox, json};
use crate::support::sources::files;
use modl::exchange::mapping::RobotMap;
use modl::plan::{Plan, file};
use std::io::Write as _;
use std::process::{Command, Stdio};

const PROGRAM: &[u8] = b"use std.smores.Driver1\nemit(Driver1().drive(t: 300ms), \"drive.plan.json\")\n";

/// The greatest distance of what is sent from what the plan says.
const TOL: f64 = 1e-9;

/// The blocks of a language in docs/executing.md.
fn blocks(language: &str) -> Vec<String> {
    let page = files().remove("docs/executing.md").expect("the page is there");
    let page = String::from_utf8(page).expect("it is text");
    let starts = page.split(&format!("```{language}\n")).skip(1).map(str::to_owned).collect::<Vec<_>>();
    starts.iter().map(|rest| rest.split("```").next().expect("a block ends").to_owned()).collect()
}

/// A folder with a plan and the map of the page.
fn sandbox() -> (Sandbox, Plan) {
    let map = blocks("json").remove(0);
    let sandbox = Sandbox::new(&[("main.mod", PROGRAM), ("robot.json", map.as_bytes())]);
    assert_eq!(sandbox.run(&["run", "main.mod"]).code, 0);
    let text = std::fs::read_to_string(sandbox.path("out/drive.plan.json")).expect("it is written");
    (sandbox, file::read(&text).expect("a plan that was written is read"))
}

/// The command to a motor at a time by the page's map: the joint's position in the plan, turned and moved by hand.
fn expected(plan: &Plan, channel: usize, t: f64) -> f64 {
    let tracks = plan.body.tracks().expect("it has joints");
    let (joint, sign, zero) =
        [("m.left", 1.0, 0.0), ("m.right", -1.0, 0.0), ("m.tilt", 1.0, 0.12), ("m.front", 1.0, 0.0)][channel];
    let id = tracks.robot.joints().position(|owner| tracks.robot.joint_name(owner) == joint);
    sign * tracks.state(t).joints[id.expect("it is there")] + zero
}

/// Checks lines `time bus channel target`.
fn check_sent(plan: &Plan, sent: &str) {
    let duration = plan.body.tracks().expect("it has joints").duration;
    let mut farthest = 0.0_f64;
    let lines: Vec<Vec<f64>> = sent
        .lines()
        .map(|line| line.split(' ').map(|word| word.parse().expect("a number")).collect())
        .collect();
    let steps = (duration * 100.0).ceil() as usize + 1;
    assert_eq!(lines.len(), 4 * steps, "{duration}");
    for (index, line) in lines.iter().enumerate() {
        let time = (index / 4) as f64 / 100.0;
        assert_eq!((line[0], line[1]), (time.min(duration), 17.0));
        let wanted = expected(plan, line[2] as usize, line[0]);
        assert!((line[3] - wanted).abs() < TOL, "{line:?}, not {wanted}");
        farthest = farthest.max(wanted.abs());
    }
    assert!(farthest > 0.2, "the wheels turn: {farthest}");
}

fn ran(command: &mut Command, input: &str) -> String {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
    child.stdin.take().expect("piped").write_all(input.as_bytes()).expect("it reads all");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success());
    String::from_utf8(output.stdout).expect("it is text")
}

fn is_there(program: &str) -> bool {
    let found = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    found.is_ok_and(|status| status.success())
}

#[test]
fn the_executor_in_python_sends_what_the_plan_says() {
    if !is_there("python3") {
        writeln!(std::io::stderr(), "skipped: the executor in Python: no python3").expect("stderr is open");
        return;
    }
    let (sandbox, plan) = sandbox();
    let script = blocks("python").remove(0);
    assert!(script.lines().count() <= 50);
    let mut command = Command::new("python3");
    command.args(["-c", &script]).arg(sandbox.path("out/drive.plan.json")).arg(sandbox.path("robot.json"));
    let sent = ran(&mut command, "");
    // The page's script goes joint by joint, and the check by channel.
    let mut lines: Vec<&str> = sent.lines().collect();
    lines.chunks_mut(4).for_each(|step| step.sort_by_key(|line| line.split(' ').nth(2).map(str::to_owned)));
    check_sent(&plan, &lines.join("\n"));
}

#[test]
fn the_executor_in_cpp_sends_what_the_plan_says() {
    if !is_there("g++") {
        writeln!(std::io::stderr(), "skipped: the executor in C++: no g++").expect("stderr is open");
        return;
    }
    let (sandbox, plan) = sandbox();
    let source = sandbox.path("executor.cpp");
    std::fs::write(&source, blocks("cpp").remove(0)).expect("a file can be written");
    let program = sandbox.path("executor");
    let built = Command::new("g++")
        .args(["-std=c++17", "-Wall", "-Werror", "-o"])
        .arg(&program)
        .arg(&source)
        .status();
    assert!(built.expect("g++ runs, it has before").success());
    let targets = sandbox.run(&[
        "plan",
        "out/drive.plan.json",
        "--series",
        "joints",
        "--rate",
        "100Hz",
        "--map",
        "robot.json",
    ]);
    assert_eq!((targets.code, targets.err.as_str()), (0, ""));
    let sent = ran(&mut Command::new(&program), &targets.out);
    let mut lines: Vec<&str> = sent.lines().collect();
    lines.chunks_mut(4).for_each(|step| step.sort_by_key(|line| line.split(' ').nth(2).map(str::to_owned)));
    check_sent(&plan, &lines.join("\n"));
}

#[test]
fn a_map_that_fits_is_told_and_one_that_does_not_by_all_that_is_wrong() {
    let (sandbox, _) = sandbox();
    let ran = sandbox.run(&["plan", "out/drive.plan.json", "--map", "robot.json"]);
    assert_eq!((ran.code, ran.out.as_str()), (0, "the map fits: 4 motors\n"));
    let told = |map: &str| {
        std::fs::write(sandbox.path("other.json"), map).expect("a file can be written");
        let ran = sandbox.run(&["plan", "out/drive.plan.json", "--map", "other.json", "--json"]);
        assert_eq!(ran.code, 1, "{map}");
        let said = json(&ran)["diagnostics"][0].clone();
        assert_eq!(said["code"], "E0706");
        let hints = said["hints"].as_array().cloned().unwrap_or_default();
        let all = std::iter::once(said["message"].clone()).chain(hints);
        all.map(|text| text.as_str().expect("a text").to_owned()).collect::<Vec<_>>().join("\n")
    };
    let map = |joints: &str| {
        format!("{{\"modules\": [{{\"module\": \"m\", \"bus\": 1, \"joints\": [{joints}]}}]}}")
    };
    let joint = |name: &str, motor: &str| format!("{{\"joint\": \"{name}\", \"motor\": {{{motor}}}}}");
    let right = joint("right", "\"channel\": 1");
    let cases = [
        (map(&right), "the plan moves `m.left`, which has no motor in the map"),
        (
            map(&format!("{right}, {}", joint("left", "\"channel\": 1"))),
            "motor 1 on bus 1 is that of `m.right` and of `m.left`",
        ),
        (
            map(&format!("{right}, {}", joint("left", "\"channel\": 0, \"sign\": 2"))),
            "the motor of `m.left` makes no sense",
        ),
        (
            map(&format!("{right}, {}", joint("left", "\"channel\": 0, \"speed\": 0.5"))),
            "drives `m.left` to a speed of ",
        ),
        (
            map(&format!("{right}, {}", joint("left", "\"channel\": 0, \"range\": [-0.1, 0.1]"))),
            "drives `m.left` to a target of ",
        ),
        (
            map(&format!("{right}, {}", joint("wheel", "\"channel\": 0"))),
            "no joint `m.wheel`; there are `tilt`, `front`",
        ),
        (map(&format!("{right}, {right}")), "`m.right` is in the map twice"),
        (map(&right).replace("\"m\"", "\"n\""), "the plan has no module `n`; there are `m`"),
        (map(&right).replace("bus", "buss"), "is no robot map: unknown field `buss`"),
        ("{".to_owned(), "is no robot map: EOF"),
    ];
    for (map, wanted) in cases {
        let told = told(&map);
        assert!(told.contains(wanted), "{told}\nin\n{map}");
    }
}

#[test]
fn rates_and_series_that_are_none_are_wrong_calls() {
    let (sandbox, _) = sandbox();
    for arguments in [["--rate", "0Hz"], ["--rate", "fast"], ["--series", "colours"]] {
        let mut all = vec!["plan", "out/drive.plan.json"];
        all.extend(arguments);
        if arguments[0] == "--rate" {
            all.extend(["--series", "joints"]);
        }
        assert_eq!(sandbox.run(&all).code, 2, "{arguments:?}");
    }
    let ran = sandbox.run(&["plan", "out/drive.plan.json", "--series", "base", "--rate", "1kHz"]);
    assert!(ran.out.starts_with("time [s],x [m],y [m],z [m],qw,qx,qy,qz\r\n0,"), "{}", ran.out);
    let ran = sandbox.run(&["plan", "out/drive.plan.json"]);
    assert!(
        ran.out.starts_with("out/drive.plan.json: Driver1, 1 module, 2 joints that move, 0 docking events, "),
        "{}",
        ran.out
    );
}

#[test]
fn a_file_of_numpy_holds_the_numbers_of_the_table() {
    let (sandbox, _) = sandbox();
    let call = ["plan", "out/drive.plan.json", "--series", "joints", "--rate", "50Hz"];
    let table = sandbox.run(&call).out;
    let printed = sandbox.command(&[&call[..], &["--npy"]].concat()).output().expect("it runs");
    assert!(printed.status.success());
    let bytes = printed.stdout;
    // NEP 1: magic, version 3.0, the length of the head, the head, which ends where alignment wants it.
    assert_eq!(&bytes[..8], b"\x93NUMPY\x03\x00");
    let length = u32::from_le_bytes(bytes[8..12].try_into().expect("four bytes")) as usize;
    assert_eq!((12 + length) % 64, 0);
    let head = std::str::from_utf8(&bytes[12..12 + length]).expect("it is UTF-8");
    let mut lines = table.lines();
    let names: Vec<&str> = lines
        .next()
        .expect("a head")
        .split(',')
        .map(|name| name.split(" [").next().expect("a name"))
        .collect();
    let fields: String = names.iter().map(|name| format!("('{name}', '<f8'), ")).collect();
    let rows: Vec<f64> =
        lines.flat_map(|line| line.split(',').map(|x| x.parse::<f64>().expect("a number"))).collect();
    let shape = rows.len() / names.len();
    let wanted = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': ({shape},), }}");
    assert_eq!(head.trim_end_matches(' ').trim_end_matches('\n').trim_end(), wanted);
    assert!(head.ends_with('\n') && names.len() == 5 && shape > 10);
    let found: Vec<f64> = bytes[12 + length..]
        .chunks_exact(8)
        .map(|x| f64::from_le_bytes(x.try_into().expect("eight bytes")))
        .collect();
    assert_eq!(found, rows);
    assert_eq!(sandbox.run(&["plan", "out/drive.plan.json", "--npy"]).code, 2);
    assert_eq!(sandbox.run(&[&call[..], &["--npy", "--json"]].concat()).code, 2);
}

#[test]
fn the_published_schema_of_maps_is_up_to_date_and_takes_the_map_of_the_page() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/robot-map.schema.json");
    let text = format!("{}\n", serde_json::to_string_pretty(&RobotMap::schema()).expect("it can be written"));
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(path, &text).expect("the docs can be written");
    }
    let found = std::fs::read_to_string(path).unwrap_or_default();
    assert!(found == text, "docs/robot-map.schema.json is stale: run the tests with UPDATE_DOCS=1");
    let validator = jsonschema::validator_for(&RobotMap::schema()).expect("it is a schema");
    let map = serde_json::from_str(&blocks("json")[0]).expect("it is JSON");
    assert!(validator.is_valid(&map));
}
