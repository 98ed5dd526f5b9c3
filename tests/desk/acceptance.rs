//! Whole programs, run as a user runs them.
//!
//! Each file of `tests/acceptance/` is wrong in one way. Its first line says which command finds it
//! and with which code: `// check E0301`. Marks `^^^^` in a comment stand under what must be
//! labelled; the words behind them are for readers. Nothing may be written.
//!
//! The files of `examples/` are right: they run, what they write is verified from the files alone,
//! and their tests pass.

use crate::desk::cli::{Sandbox, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Line, first column, column after the last; from 1.
type Place = (u64, u64, u64);

fn programs(folder: &str) -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let paths =
        fs::read_dir(folder).expect("the folder is there").map(|entry| entry.expect("readable").path());
    let programs = paths.filter(|path| path.extension().is_some_and(|e| e == "mod"));
    let named = programs.map(|path| {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        (name, fs::read_to_string(path).expect("programs are UTF-8"))
    });
    named.collect()
}

/// The other files of a folder, such as meshes that its programs load.
fn others(folder: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let paths = fs::read_dir(folder).expect("the folder is there").map(|e| e.expect("readable").path());
    let others = paths.filter(|path| path.is_file() && path.extension().is_none_or(|e| e != "mod"));
    let named = others.map(|path| {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        (name, fs::read(&path).expect("the file can be read"))
    });
    named.collect()
}

/// An example with the files that it may load.
fn sandbox_of_example(name: &str, text: &str) -> Sandbox {
    let others = others("examples");
    let mut files: Vec<(&str, &[u8])> = others.iter().map(|(n, b)| (n.as_str(), b.as_slice())).collect();
    files.push((name, text.as_bytes()));
    let programs = programs("examples");
    let imported = programs.iter().filter(|(other, _)| text.contains(&format!("use \"{other}\"")));
    files.extend(imported.map(|(name, text)| (name.as_str(), text.as_bytes())));
    Sandbox::new(&files)
}

/// The marked places; marks belong to the last line above them that holds none.
fn marked(text: &str) -> BTreeSet<Place> {
    let mut places = BTreeSet::new();
    let mut subject = 0;
    for (i, line) in text.lines().enumerate() {
        let is_marks =
            line.trim_start().strip_prefix("//").is_some_and(|rest| rest.trim_start().starts_with('^'));
        if !is_marks {
            subject = i as u64 + 1;
            continue;
        }
        let mut column = 1;
        for run in line.chars().collect::<Vec<char>>().chunk_by(|a, b| a == b) {
            let end = column + run.len() as u64;
            if run[0] == '^' {
                places.insert((subject, column, end));
            }
            column = end;
        }
    }
    places
}

fn place(label: &serde_json::Value) -> Place {
    let number = |name: &str| label[name].as_u64().expect("a number");
    (number("line"), number("column"), number("end_column"))
}

/// What differs from what the program's comments say.
fn faults(name: &str, text: &str, files: &[(&str, &[u8])]) -> Vec<String> {
    let mut words = text.lines().next().unwrap_or("").trim_start_matches("//").split_whitespace();
    let (Some(task), Some(code)) = (words.next(), words.next()) else {
        return vec![format!("{name}: the first line says `// check CODE` or `// run CODE`")];
    };
    let sandbox = Sandbox::new(files);
    let ran = sandbox.run(&[task, "--json", name]);
    let mut faults = Vec::new();
    let mut labelled = BTreeSet::new();
    let expected = marked(text);
    let report = json(&ran);
    let errors =
        report["diagnostics"].as_array().expect("a list").iter().filter(|d| d["severity"] == "error");
    for (index, error) in errors.enumerate() {
        let labels = error["labels"].as_array().expect("a list");
        let own = labels.iter().filter(|label| label["file"] == name);
        labelled.extend(own.map(place));
        // A joint may also be overloaded before links meet: that is another fault.
        if index == 0 && error["code"] != code {
            faults.push(format!("{name}: {} where {code} is expected", error["code"]));
        }
        let primary = labels.first().map(place);
        if !primary.is_some_and(|primary| expected.is_empty() || expected.contains(&primary)) {
            faults.push(format!("{name}: an error at {primary:?}: {}", error["message"]));
        }
    }
    let missing: Vec<&Place> = expected.difference(&labelled).collect();
    if !missing.is_empty() {
        faults.push(format!("{name}: nothing at {missing:?}; labelled are {labelled:?}"));
    }
    if ran.code != 1 {
        faults.push(format!("{name}: ends with {}", ran.code));
    }
    if sandbox.path("out").exists() {
        faults.push(format!("{name}: something was written"));
    }
    faults
}

#[test]
fn each_wrong_program_fails_where_its_marks_say() {
    let programs = programs("tests/acceptance");
    let files: Vec<(&str, &[u8])> =
        programs.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
    let faults: Vec<String> = programs.iter().flat_map(|(name, text)| faults(name, text, &files)).collect();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn each_example_runs_twice_alike_and_what_it_writes_is_verified_again() {
    for (name, text) in programs("examples") {
        let sandbox = sandbox_of_example(&name, &text);
        let ran = sandbox.run(&["run", "--json", &name]);
        let report = json(&ran);
        let codes: Vec<&str> = report["diagnostics"]
            .as_array()
            .expect("a list")
            .iter()
            .filter(|d| d["severity"] == "error")
            .map(|d| d["code"].as_str().expect("a code"))
            .collect();
        assert!(codes.is_empty(), "{name}: {}", ran.out);
        let written = report["written"].as_array().expect("a list");
        assert_eq!(written.is_empty(), !text.contains("emit(") && !text.contains("show("), "{name}");
        let plans = written.iter().map(|path| path.as_str().expect("a path"));
        for plan in plans.filter(|path| path.ends_with(".plan.json")) {
            let verified = sandbox.run(&["verify", plan]);
            assert_eq!(verified.code, 0, "{name}: {}{}", verified.out, verified.err);
        }
        let tested = sandbox.run(&["test", &name]);
        assert_eq!(tested.code, 0, "{name}: {}{}", tested.out, tested.err);
        sandbox.run(&["run", "--out", "again", &name]);
        for path in written.iter().map(|path| path.as_str().expect("a path")) {
            let again = path.replacen("out/", "again/", 1);
            let bytes = |path: &str| fs::read(sandbox.path(path)).expect("a file that was written");
            assert!(path != again && bytes(path) == bytes(&again), "{name}: {again} differs from {path}");
        }
    }
}
