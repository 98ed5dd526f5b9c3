//! The README: what it says that the tool prints, the tool prints.

use crate::desk::cli::Sandbox;
use crate::desk::transcripts::Transcript;

const README: &str = include_str!("../../README.md");
const WALKBOT: &str = include_str!("../../examples/walkbot.mod");
const PAIR: &str = "\
use std.smores.Smores
config Pair {
  part m[3]: Smores
  connect m[0].top -- m[1].bottom
  connect m[0].top -- m[2].bottom
}
";

/// The fences of a language, in order.
fn fences(language: &str) -> Vec<&'static str> {
    let open = format!("```{language}\n");
    README.split(&open).skip(1).map(|rest| rest.split("```").next().expect("a fence ends")).collect()
}

#[test]
fn the_transcripts_are_what_the_tool_prints() {
    let files = [("examples/walkbot.mod", WALKBOT.as_bytes()), ("pair.mod", PAIR.as_bytes())];
    let sandbox = Sandbox::new(&files);
    let mut runs = 0;
    for fence in fences("text") {
        let Some((command, wanted)) = fence.strip_prefix("$ modl ").and_then(|rest| rest.split_once('\n'))
        else {
            continue;
        };
        runs += 1;
        if command.starts_with("repl ") {
            let arguments: Vec<&str> = command.split(' ').collect();
            Transcript::of(wanted).judge(&sandbox, &arguments, command);
            continue;
        }
        let ran = sandbox.run(&command.split(' ').collect::<Vec<_>>());
        let printed = format!("{}{}", ran.out, ran.err);
        assert_eq!(printed.trim(), wanted.trim(), "modl {command}");
    }
    assert!(runs >= 3, "only {runs} transcripts");
}

#[test]
fn the_program_shown_is_the_example_but_for_what_it_leaves_out() {
    let mut lines = WALKBOT.lines();
    for line in fences("modl")[0].lines() {
        assert!(lines.any(|l| l == line), "examples/walkbot.mod has no line `{line}` there");
    }
}
