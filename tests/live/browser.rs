//! The page in a browser: headless Chromium uses it as a person would (`tests/browser/live.mjs`). Skipped, with a message, where
//! Node.js, playwright-core or Chromium is missing.

use super::served::Served;
use crate::desk::browser::tools;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

#[test]
fn the_page_is_used_in_a_browser() {
    let Some((playwright, chromium)) = tools() else {
        println!("skipped: Node.js, playwright-core or Chromium is missing (`.ci/run` installs them)");
        return;
    };
    let served = Served::new(include_bytes!("texts/walker.mod"));
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/live.mjs");
    let mut command = Command::new("node");
    command.args([&script, &playwright, &chromium]).arg(&served.address).arg(served.file());
    let output = command.output().expect("Node.js runs, it has before");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "the script fails: {told}");
    let found: Value = serde_json::from_slice(&output.stdout).expect("the script prints JSON");
    println!("from a save to the picture: {} ms", found["figures"]["seen"]);
    assert_eq!(found["faults"], serde_json::json!([]));
    assert_eq!(served.text(), include_str!("texts/walker.mod"));
}
