//! `modl export`: what it writes, and what it refuses.

use crate::desk::cli::{Sandbox, json};
use std::fs;

const PROGRAM: &[u8] = b"use std.smores.Driver1\nemit(Driver1().drive(t: 300ms), \"drive.plan.json\")\n";

/// A folder with a plan file.
fn with_plan() -> Sandbox {
    let sandbox = Sandbox::new(&[("main.mod", PROGRAM)]);
    assert_eq!(sandbox.run(&["run", "main.mod"]).code, 0);
    sandbox
}

/// The words of a diagnostic, however its lines are broken.
fn words(text: &str) -> String {
    text.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

fn listed(folder: std::path::PathBuf) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there").flatten();
    let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_bundle_is_one_folder_whole_or_not_there() {
    let sandbox = with_plan();
    let ran = sandbox.run(&["export", "out/drive.plan.json", "--to", "bundle", "-o", "ex"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, "wrote ex/drive\n"));
    let files = listed(sandbox.path("ex/drive"));
    let wanted = ["README.md", "drive.controls.csv", "drive.csv", "drive.gif", "drive.glb", "drive.mcap"];
    let more = ["drive.mjcf.xml", "drive.trajectory.yaml", "drive.urdf"];
    assert_eq!(files, wanted.into_iter().chain(more).collect::<Vec<_>>());
    let page = fs::read_to_string(sandbox.path("ex/drive/README.md")).expect("it is text");
    for command in [
        "mujoco.viewer --mjcf=drive.mjcf.xml",
        "yourdfpy drive.urdf",
        "rerun drive.mcap",
        "filepath='drive.glb'",
    ] {
        assert!(page.contains(command), "{page}");
    }
    // A former bundle is replaced as a whole: what is no longer written is gone.
    fs::write(sandbox.path("ex/drive/old.urdf"), "old").expect("a file can be written");
    assert_eq!(sandbox.run(&["export", "out/drive.plan.json", "--to", "bundle", "-o", "ex"]).code, 0);
    assert_eq!(listed(sandbox.path("ex/drive")), files);
    assert_eq!(listed(sandbox.path("ex")), ["drive"], "nothing else is left");
    // A file that someone else put there stays.
    fs::remove_file(sandbox.path("ex/drive/README.md")).expect("it is there");
    let ran = sandbox.run(&["export", "out/drive.plan.json", "--to", "bundle", "-o", "ex"]);
    assert_eq!(ran.code, 1);
    assert!(words(&ran.err).contains("a folder of this name holds other files"), "{}", ran.err);
    assert_eq!(listed(sandbox.path("ex/drive")), &files[1..]);
    assert_eq!(listed(sandbox.path("ex")), ["drive"]);
}

#[test]
fn the_same_plan_gives_the_same_bytes_in_every_format() {
    let sandbox = with_plan();
    for folder in ["a", "b"] {
        assert_eq!(sandbox.run(&["export", "out/drive.plan.json", "--to", "bundle", "-o", folder]).code, 0);
    }
    for name in listed(sandbox.path("a/drive")) {
        let read = |folder: &str| fs::read(sandbox.path(&format!("{folder}/drive/{name}"))).ok();
        assert!(read("a").is_some() && read("a") == read("b"), "{name}");
    }
}

#[test]
fn programs_export_what_they_emit_and_save_the_same() {
    let sandbox = Sandbox::new(&[("main.mod", PROGRAM)]);
    let ran = sandbox.run(&["export", "main.mod", "--to", "urdf", "--json"]);
    assert_eq!(json(&ran)["written"], serde_json::json!(["out/drive.urdf"]));
    let program = b"use std.smores.Driver1\nsave(Driver1().drive(t: 300ms), \"to/drive.urdf\")\n";
    let other = Sandbox::new(&[("main.mod", program)]);
    let ran = other.run(&["run", "main.mod"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, "wrote out/to/drive.urdf\n"));
    let text = |path: std::path::PathBuf| fs::read_to_string(path).expect("it is text");
    assert_eq!(text(other.path("out/to/drive.urdf")), text(sandbox.path("out/drive.urdf")));
}

#[test]
fn a_motion_that_fails_the_judge_is_not_written() {
    let sandbox = with_plan();
    let file = sandbox.path("out/drive.plan.json");
    let text = fs::read_to_string(&file).expect("it is text");
    let fast = text.replace("\"speed\": 2.4086", "\"speed\": 0.24086");
    assert_ne!(fast, text, "the limits stand in the file");
    fs::write(&file, fast).expect("a file can be written");
    for to in ["trajectory", "csv", "mcap", "bundle"] {
        let ran = sandbox.run(&["export", "out/drive.plan.json", "--to", to]);
        assert_eq!(ran.code, 1, "{to}");
        assert!(words(&ran.err).contains("fails the judge, and its motion is not written"), "{}", ran.err);
    }
    assert_eq!(sandbox.run(&["export", "out/drive.plan.json", "--to", "urdf"]).code, 0);
    assert_eq!(listed(sandbox.path("out")), ["drive.plan.json", "drive.urdf"]);
}

#[test]
fn wrong_calls_say_what_there_is() {
    let sandbox = with_plan();
    let ran = sandbox.run(&["export", "out/drive.plan.json", "--to", "sdf"]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("urdf") && ran.err.contains("bundle"), "{}", ran.err);
    let ran = sandbox.run(&["export", "main.mod", "out/drive.plan.json", "--to", "urdf"]);
    assert_eq!((ran.code, ran.err.as_str()), (2, "modl: `modl export` takes one program, or plan files\n"));
}
