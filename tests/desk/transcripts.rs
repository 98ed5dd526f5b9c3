//! Sessions written down: what is typed behind `modl> `, and what comes of it.
//!
//! An entry goes on over the lines behind it as long as it is incomplete; six blanks at their beginning
//! stand below the prompt. Everything else up to the next prompt is what is printed. Blank lines mean
//! nothing.

use crate::desk::cli::Sandbox;
use crate::support::fences::{fences, files};
use modl::session::entry::{goes_on, is_incomplete};

const PROMPT: &str = "modl> ";

/// What stands below the prompt.
const BELOW: &str = "      ";

/// What is typed and what is printed.
pub struct Transcript {
    pub typed: String,
    pub printed: String,
}

impl Transcript {
    pub fn of(text: &str) -> Transcript {
        let (mut typed, mut printed) = (String::new(), String::new());
        let mut lines = text.lines().peekable();
        while let Some(line) = lines.next() {
            let Some(first) = line.strip_prefix(PROMPT) else {
                printed.push_str(&format!("{line}\n"));
                continue;
            };
            let mut entry = first.to_owned();
            let more = |next: &str| next.starts_with(BELOW) && goes_on(next);
            while !first.starts_with([':', '?'])
                && (is_incomplete(&entry) || lines.peek().is_some_and(|next| more(next)))
            {
                let next = lines.next().expect("an entry is completed");
                entry.push_str(&format!("\n{}", next.strip_prefix(BELOW).unwrap_or(next)));
            }
            typed.push_str(&format!("{entry}\n"));
        }
        Transcript { typed, printed }
    }

    /// Panics where a session that is piped in prints something else.
    pub fn judge(&self, sandbox: &Sandbox, arguments: &[&str], place: &str) {
        let printed = sandbox.run_together(arguments, self.typed.as_bytes());
        let lines = |text: &str| -> Vec<String> {
            text.lines().map(str::trim_end).filter(|line| !line.is_empty()).map(str::to_owned).collect()
        };
        assert_eq!(lines(&printed).join("\n"), lines(&self.printed).join("\n"), "{place}");
    }
}

/// The sessions among the fences of a page: those that begin with `$ modl repl`.
pub fn judge_page(name: &str, text: &str, sandbox: &Sandbox) -> usize {
    let mut judged = 0;
    for fence in fences(text, name) {
        let Some((command, rest)) = fence.code.strip_prefix("$ modl repl").and_then(|c| c.split_once('\n'))
        else {
            continue;
        };
        let arguments: Vec<&str> = std::iter::once("repl").chain(command.split_whitespace()).collect();
        Transcript::of(rest).judge(sandbox, &arguments, &fence.place);
        judged += 1;
    }
    judged
}

#[test]
fn sessions_of_the_suite_print_what_is_written_down() {
    for (name, text) in files("tests/suite/repl", "txt") {
        let sandbox = Sandbox::new(&[("hinge.mod", HINGE.as_bytes())]);
        Transcript::of(&text).judge(&sandbox, &["repl"], &name);
    }
}

#[test]
fn sessions_in_the_documentation_print_what_is_written_down() {
    let sandbox = Sandbox::new(&[
        ("walkbot.mod", include_bytes!("../../examples/walkbot.mod")),
        ("hinge.mod", HINGE.as_bytes()),
    ]);
    // The tour has a test of its own.
    let pages = files("docs", "md").into_iter().filter(|(name, _)| !name.ends_with("/tour.md"));
    let judged: usize = pages.map(|(name, text)| judge_page(&name, &text, &sandbox)).sum();
    assert!(judged >= 3, "only {judged} sessions");
}

/// A file to load.
pub const HINGE: &str = "\
/// A single hinge.
module Hinge(length: Length = 40mm) {
  mass 150g
  link base = box(length, 40mm, 40mm)
  link tip = box(length, 40mm, 40mm) at [length + 20mm, 0mm, 0mm]
  joint bend: base -> tip = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 2N*m) at [length / 2 + 10mm, 0mm, 0mm]
  touching base tip
  port back: Face on base at [-length / 2, 0mm, 0mm] facing -X up +Z
  port front: Face on tip at [length / 2, 0mm, 0mm] facing +X up +Z
}

connector Face { mates Face, turns 4 }
";

/// What a session that is piped in ends with.
fn piped(sandbox: &Sandbox, input: &str) -> crate::desk::cli::Ran {
    sandbox.run_with_input(&["repl"], input.as_bytes())
}

/// Values that begin with a sign which could continue the line before them are saved as a program all the same.
#[test]
fn what_begins_with_a_sign_is_saved_as_it_was_meant() {
    let sandbox = Sandbox::new(&[]);
    let fine = piped(&sandbox, "let a = 2\n[1, 2] ++ [3]\n-a\n(a + 1) * 2\n:save saved.mod\n");
    assert_eq!(fine.code, 0, "{}", fine.err);
    let ran = sandbox.run(&["check", "saved.mod"]);
    let saved = std::fs::read_to_string(sandbox.path("saved.mod")).expect("it was saved");
    assert_eq!(ran.code, 0, "{}\n{saved}", ran.err);
    assert!(
        saved.contains("[1, 2] ++ [3]") && saved.contains("-a") && saved.contains("(a + 1) * 2"),
        "{saved}"
    );
}

#[test]
fn pipes_get_no_colours_and_the_exit_code_tells() {
    let sandbox = Sandbox::new(&[]);
    let fine = piped(&sandbox, "let a = 2\na + 1\n");
    assert_eq!((fine.code, fine.out.as_str(), fine.err.as_str()), (0, "a: Int\n3: Int\n", ""));
    // What stands behind a mistake is entered all the same.
    let wrong = piped(&sandbox, "let a = 2\n\nlet b = a + 1m\na\n:quit\n1 / \"\"\n");
    assert_eq!((wrong.code, wrong.out.as_str()), (1, "a: Int\n2: Int\n"));
    assert!(wrong.err.contains("<stdin>:3:") && !wrong.err.contains('\x1b'), "{}", wrong.err);
    for command in
        [":nonsense", ":undo", ":doc nothing_of_this_name", ":type", ":save ../out.mod", ":type 1 +"]
    {
        let ran = piped(&sandbox, command);
        assert!(ran.code == 1 && !ran.err.is_empty(), "{command}: {}", ran.err);
    }
}

#[test]
fn an_expression_of_the_command_line_is_evaluated() {
    let sandbox = Sandbox::new(&[]);
    let ran = sandbox.run(&["-e", "4 * 90deg"]);
    assert_eq!((ran.code, ran.out.as_str(), ran.err.as_str()), (0, "360deg\n", ""));
    let ran = sandbox.run(&["-e", "use std.smores.Smores", "-e", "mass(Smores())"]);
    assert_eq!((ran.code, ran.out.as_str()), (0, "557.2924g\n"), "{}", ran.err);
    let ran = sandbox.run(&["-e", "4 * mm"]);
    assert_eq!((ran.code, ran.out.as_str()), (1, ""));
    assert!(ran.err.contains("<-e>:1:5"), "{}", ran.err);
    assert_eq!(sandbox.run(&[]).code, 2);
}

#[test]
fn what_depended_on_a_name_says_so_and_follows() {
    let sandbox = Sandbox::new(&[]);
    let ran = piped(&sandbox, "let a = 1\nlet b = a + 1\nlet c = [10]\nlet a = 5\nb\n:undo\n:undo\nb\n");
    assert_eq!(ran.code, 0, "{}", ran.err);
    let said = "a: Int\nb: Int\nc: List<Int>\na: Int\n`b` depends on `a`: it is worked out again when needed\n6: Int\n\
                took back: b\ntook back: let a = 5\n2: Int\n";
    assert_eq!(ran.out, said);
    // What no longer fits is told, and what needs it is refused until it is mended.
    let ran = piped(
        &sandbox,
        "let a = 1\nfn f(x: Int) = x + a\nlet a = \"text\"\nf(1)\na\nfn f(x: Int) = x\nf(1)\n",
    );
    assert!(
        ran.out.contains("what was declared before does not fit any more") && ran.code == 1,
        "{}",
        ran.out
    );
    assert!(ran.out.ends_with("\"text\": Text\nfn f(x: Int) -> Int\n1: Int\n"), "{}", ran.out);
    assert_eq!(
        ran.err.matches("E0207 (").count(),
        2,
        "told when it breaks and when it is asked:\n{}",
        ran.err
    );
}

#[test]
fn values_are_not_worked_out_again() {
    // The limit of steps is for one entry, and the value alone takes most of it: an entry that needs it
    // many times over can only be had if it is there.
    let sandbox = Sandbox::new(&[]);
    let input =
        "fn work() = len([i for i in 0..30000])\nlet slow = work()\n[slow, slow, slow]\n[work(), work()]\n";
    let ran = sandbox.run_with_input(&["repl", "--max-steps", "100000"], input.as_bytes());
    assert!(ran.out.ends_with("[30000, 30000, 30000]: List<Int>\n"), "{}{}", ran.out, ran.err);
    assert!(ran.code == 1 && ran.err.contains("100000 evaluation steps"), "{}", ran.err);
}

#[test]
fn words_of_other_sessions_are_commands_unless_the_program_declares_them() {
    let sandbox = Sandbox::new(&[]);
    for leave in ["quit", "exit", "quit()", " exit ( )"] {
        let ran = piped(&sandbox, &format!("1\n{leave}\n2\n"));
        assert_eq!((ran.code, ran.out.as_str(), ran.err.as_str()), (0, "1: Int\n", ""), "{leave}");
    }
    let help = piped(&sandbox, ":help\n").out;
    for ask in ["help", "help()"] {
        assert_eq!(piped(&sandbox, ask).out, help);
    }
    assert_eq!(piped(&sandbox, "help sqrt\n").out, piped(&sandbox, ":doc sqrt\n").out);
    let own = piped(&sandbox, "let quit = 3\nfn exit(a: Int) -> Int = a + 1\nquit\nexit(1)\n");
    assert_eq!((own.code, own.out.as_str()), (0, "quit: Int\nfn exit(a: Int) -> Int\n3: Int\n2: Int\n"));
}

/// A library beside which sessions are saved.
const LIBRARY: &[u8] = b"use std.smores.Smores\n\
    config Pair {\n  part m[2]: Smores\n  connect m[0].top -- m[1].bottom\n}\n\
    fn twice(x: Int) -> Int = 2 * x\n";

#[test]
fn what_is_saved_is_loaded_with_the_values_that_it_had() {
    let sandbox = Sandbox::new(&[("lib.mod", LIBRARY)]);
    let entered = [
        "use \"lib.mod\".{Pair, twice as double}",
        "use \"lib.mod\"",
        "let a = double(3)",
        "a + 1",
        // The value before is named where the line begins with it, and where it does not.
        "_ * 2",
        "_ + 1",
        "let b = _",
        "lib.twice(a)",
        "let c = [_, a]",
        "fn f(x: Int) -> Int = x + a",
        "config Nod {\n  part p: Pair\n  behavior nod(to: Angle = 30deg) = move(p.m[1].tilt, to: to)\n}",
        "let robot = Nod()",
        // Declared again: what depends on it follows.
        "let a = 5",
        "print(\"a statement, which loading does not run\")",
    ];
    let asked = "f(1)\nb\nc\nmass(robot)\nrobot.nod().duration\n";
    let first = piped(&sandbox, &format!("{}\n{asked}:save saved.mod\n", entered.join("\n")));
    assert_eq!(first.err, "");
    let again = piped(&sandbox, &format!(":load saved.mod\n{asked}"));
    assert_eq!((again.code, again.err.as_str()), (0, ""));
    let (loaded, values) = again.out.split_once('\n').expect("several lines");
    assert_eq!(loaded, "loaded saved.mod: Nod, a, b, c, f, robot");
    assert_eq!(values.lines().count(), 5, "{values}");
    assert!(first.out.contains(values), "{}\n{values}", first.out);
    let known = ["6: Int", "13: Int", "[10, 5]: List<Int>"];
    assert!(known.iter().zip(values.lines()).all(|(known, value)| *known == value), "{values}");
    let run = sandbox.run(&["run", "saved.mod"]);
    assert_eq!((run.code, run.out.lines().last()), (0, Some("a statement, which loading does not run")));
}

#[test]
fn a_file_is_listed_with_its_names_however_often_it_is_loaded() {
    let sandbox = Sandbox::new(&[("lib.mod", LIBRARY)]);
    let ran = piped(&sandbox, "use \"lib.mod\".{twice}\n:load lib.mod\n:load lib.mod\n");
    assert_eq!(ran.out, "loaded lib.mod: Pair, twice\n".repeat(2), "{}", ran.err);
}
