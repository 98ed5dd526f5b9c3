//! Ctrl-C at a real terminal, while something works that would take minutes: the prompt is back at once, and
//! the session as it was. Before, the work says how far it is.
#![cfg(unix)]

use crate::desk::cli::Sandbox;
use crate::support::terminal::{PROMPT, Terminal};
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What a person does not notice.
const AT_ONCE: Duration = Duration::from_millis(100);

const WORM: &str = "\
use std.smores.Chain3
config Worm(n: Int) {
  part seg[n]: Chain3
  for i in 0..n - 1 { connect seg[i].tail -- seg[i + 1].head }
  behavior bend(to: Angle) = Pc([move(m.tilt, to: to) for s in seg for m in s.m])
  behavior crawl(times: Int = 100) = repeat(Sc(bend(1deg), bend(-1deg)), times)
}
let kept = 2
";

fn begin(sandbox: &Sandbox) -> Terminal {
    let mut command = sandbox.command(&["repl", "worm.mod"]);
    command.env("MODL_HISTORY", sandbox.path("history"));
    let mut terminal = Terminal::begin(command);
    terminal.sees(PROMPT);
    terminal
}

const LOOP: &str = "truss Loop(n: Int = 3) of PneumaticReel { let r = n * 0.16m  for i in 0..n { node p[i] = \
    [r * cos(i / n * 1turn), r * sin(i / n * 1turn), 0m] }  for i in 0..n { strut p[i] -- p[(i + 1) % n] } }";

/// The quickest of five, for a machine that does much else.
fn stops(terminal: &mut Terminal, entry: &str, at: &str) {
    let quickest = (0..5).map(|_| terminal.stop(entry, at)).min().expect("there are five");
    assert!(quickest < AT_ONCE, "{entry}: {quickest:?}");
    terminal.ask("kept + 1", "3: Int");
}

#[test]
fn ctrl_c_ends_whatever_takes_long() {
    let sandbox = Sandbox::new(&[("worm.mod", WORM.as_bytes())]);
    let mut terminal = begin(&sandbox);
    terminal.ask("use std.mori.Mori", "");
    terminal.ask("use std.shapes.icosahedron", "");
    // A plain loop, a planner, the judge.
    stops(&mut terminal, "for i in 0..40000000 { let x = i }", "evaluating: ");
    let fold = "fold(icosahedron(edge: 80mm), Mori, method: enumerate, budget: 1000000000)";
    stops(&mut terminal, fold, "of 5184000 layouts, ");
    stops(&mut terminal, "verify(Worm(60).crawl())", "walked ");
}

#[test]
fn a_solver_that_does_not_listen_is_not_waited_for() {
    let sandbox = Sandbox::new(&[("worm.mod", WORM.as_bytes())]);
    let mut terminal = begin(&sandbox);
    terminal.ask("use std.truss.PneumaticReel", "");
    // Of three struts it is rigid, of more it is not, and which motions are free is found by one
    // decomposition of a matrix of 1,200 columns.
    terminal.ask(LOOP, "truss Loop");
    stops(&mut terminal, "rigidity(Loop(400))", "hold each other");
}

#[test]
fn what_is_typed_meanwhile_is_not_lost() {
    let sandbox = Sandbox::new(&[("worm.mod", WORM.as_bytes())]);
    let mut terminal = begin(&sandbox);
    terminal.types("for i in 0..200000 { let x = i }\r1 + 10\r1 + 20\r1 + 30\r");
    for answer in ["11: Int", "21: Int", "31: Int"] {
        terminal.sees(answer);
    }
}

#[test]
fn who_reads_no_terminal_hears_nothing_of_progress() {
    let sandbox = Sandbox::new(&[("worm.mod", WORM.as_bytes())]);
    let ran = sandbox.run(&["-e", "use \"worm.mod\".{Worm}", "-e", "verify(Worm(1).crawl(2)).ok"]);
    assert_eq!((ran.code, ran.out.as_str(), ran.err.as_str()), (0, "true\n", ""));
}

/// A session whose process is known: it says its number first.
#[cfg(target_os = "linux")]
fn begin_known(sandbox: &Sandbox, arguments: &str) -> (Terminal, String) {
    let mut command = Command::new("sh");
    let line = format!("echo pid $$.; exec {} {arguments}", env!("CARGO_BIN_EXE_modl"));
    command.args(["-c", &line]).current_dir(sandbox.path(""));
    command.env("MODL_HISTORY", sandbox.path("history"));
    let mut terminal = Terminal::begin(command);
    terminal.sees("pid ");
    let process = terminal.sees(".");
    terminal.sees(PROMPT);
    (terminal, process)
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_to_terminate_ends_a_session_that_works() {
    let sandbox = Sandbox::new(&[("worm.mod", WORM.as_bytes())]);
    let (mut terminal, process) = begin_known(&sandbox, "repl worm.mod");
    terminal.types("for i in 0..40000000 { let x = i }\r");
    terminal.sees("evaluating: ");
    let sent = Command::new("kill").args(["-TERM", &process]).status().expect("a signal can be sent");
    assert!(sent.success());
    let begin = Instant::now();
    // Nobody waits for the process, so it may stay as a zombie.
    let lives = || {
        let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
        stat.rsplit_once(") ").is_some_and(|(_, rest)| !rest.starts_with(['Z', 'X']))
    };
    while lives() {
        assert!(begin.elapsed() < Duration::from_secs(5), "the session goes on");
        std::thread::yield_now();
    }
}

#[test]
fn a_signal_to_terminate_ends_a_command_and_leaves_no_half_file() {
    let worm: &[u8] = br#"use std.smores.Chain3
config Worm(n: Int) {
  part seg[n]: Chain3
  for i in 0..n - 1 { connect seg[i].tail -- seg[i + 1].head }
  behavior bend(to: Angle) = Pc([move(m.tilt, to: to) for s in seg for m in s.m])
  behavior crawl = repeat(Sc(bend(1deg), bend(-1deg)), 100)
}
emit(Worm(1).bend(1deg), "short.plan.json")
emit(Worm(60).crawl(), "long.plan.json")
"#;
    let sandbox = Sandbox::new(&[("a.mod", worm)]);
    let mut command = sandbox.command(&["run", "a.mod"]);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("runs");
    // The first plan is there, and the second is judged.
    let begin = Instant::now();
    while !sandbox.path("out/short.plan.json").exists() {
        assert!(begin.elapsed() < Duration::from_secs(60), "nothing is written");
        std::thread::yield_now();
    }
    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(sent.expect("there is a kill").success());
    let status = child.wait().expect("it ends");
    assert_eq!((status.code(), status.signal()), (None, Some(15)), "{status}");
    let left = std::fs::read_dir(sandbox.path("out")).expect("there").map(|e| e.expect("listed").file_name());
    assert_eq!(left.collect::<Vec<_>>(), ["short.plan.json"]);
    assert_eq!(sandbox.run(&["verify", "out/short.plan.json"]).code, 0);
}

#[test]
fn bytes_that_are_no_text_do_not_end_a_session() {
    let sandbox = Sandbox::new(&[("worm.mod", WORM.as_bytes())]);
    let mut terminal = begin(&sandbox);
    for bytes in [&b"1 + \xff\xfe"[..], b"\x1b[200~let a = \"\xc3\x28\"\x1b[201~", b"\xe4\xf6"] {
        terminal.types_bytes(bytes);
        terminal.sees("this is not UTF-8 text, and was discarded");
        terminal.sees(PROMPT);
        // The rest of the bytes is a line of its own.
        terminal.types("\x03");
        terminal.sees(PROMPT);
    }
    terminal.ask("kept + 1", "3: Int");
}

#[test]
fn a_long_line_is_not_drawn_again_at_each_key() {
    let sandbox = Sandbox::new(&[("worm.mod", WORM.as_bytes())]);
    let mut command = sandbox.command(&["repl", "worm.mod", "--color", "always"]);
    command.env("MODL_HISTORY", sandbox.path("history"));
    let mut terminal = Terminal::begin(command);
    terminal.sees(PROMPT);
    let long = format!("len([{}])", vec!["1"; 4000].join(","));
    // Keys that come together are taken as they come, not as one paste.
    terminal.types(&long);
    terminal.types("\r");
    let echoed = terminal.sees("4000").len();
    assert!(echoed < 25_000_000, "{echoed} bytes for {} keys", long.len());
}
