//! The command and the system that it runs on: devices that are full, terminals that obey, little memory.

use super::cli::{Ran, Sandbox, ran};
use std::fs;
use std::process::{Command, Stdio};

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_takes_nothing_is_an_error() {
    let s = Sandbox::new(&[("a.mod", b"print(1)\n")]);
    for arguments in
        [&["run", "a.mod"][..], &["check", "--json", "a.mod"], &["--help"], &["-e", "1"], &["explain"]]
    {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("a device that is full");
        let ran = ran(s.command(arguments).stdout(full).stderr(Stdio::piped()).output().expect("it runs"));
        assert_eq!(ran.code, 2, "{arguments:?}: {}", ran.err);
        assert!(ran.err.contains("standard output can't be written: No space left"), "{}", ran.err);
        // Who closes a pipe has read enough.
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let ran = self::ran(s.command(arguments).stdout(writer).output().expect("it runs"));
        assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.err);
    }
}

/// A plan file whose module has a name that colours the terminal and reverses the reading.
const HOSTILE: &str = "use std.smores.Smores
config C { part m: Smores
  behavior b = move(m.tilt, to: 10deg) }
emit(C().b(), \"c.plan.json\")
";

#[test]
fn names_of_others_do_not_command_the_terminal() {
    let s = Sandbox::new(&[("c.mod", HOSTILE.as_bytes())]);
    assert_eq!(s.run(&["run", "c.mod"]).code, 0);
    let path = s.path("out/c.plan.json");
    let name = "\"\\u001b[31mm\\u009b2J\\u202e";
    let plan = fs::read_to_string(&path).expect("a plan");
    let plan = plan.replace("\"m\"", &format!("{name}\"")).replace("\"m.", &format!("{name}."));
    fs::write(&path, plan).expect("it can be written");
    let said = s.run(&["verify", "out/c.plan.json"]);
    assert_eq!(said.code, 0, "{}{}", said.out, said.err);
    let json = s.run(&["verify", "--json", "out/c.plan.json"]);
    for (text, escape) in
        [(&said.out, "\\u{1b}[31mm\\u{9b}2J\\u{202e}"), (&json.out, "\\u001b[31mm\\u009b2J\\u202e")]
    {
        assert!(text.contains(escape), "{text}");
        assert!(!text.contains(['\u{1b}', '\u{9b}', '\u{202e}']), "{text}");
    }
    // The same holds for what a program prints.
    let printed = s.run(&["-e", "print(\"\\u{1b}[2J\\tdone\")"]);
    assert_eq!(printed.out, "\\u{1b}[2J\tdone\n");
}

/// Runs the command with a limit of the shell's `ulimit`.
#[cfg(unix)]
fn limited(s: &Sandbox, limit: &str, arguments: &str) -> Ran {
    let line = format!("ulimit {limit} && exec {} {arguments}", env!("CARGO_BIN_EXE_modl"));
    let mut command = Command::new("sh");
    command.args(["-c", &line]).current_dir(s.path("")).stdin(Stdio::null());
    ran(command.output().expect("a shell"))
}

#[cfg(unix)]
#[test]
fn little_memory_and_a_small_stack_suffice() {
    let powers = format!("let a = {}2\n", "2^".repeat(100_000));
    let deep = "fn f(n: Int) -> Int = if n == 0 { 0 } else { 1 + f(n - 1) }\nprint(f(150))\n";
    let s = Sandbox::new(&[("powers.mod", powers.as_bytes()), ("deep.mod", deep.as_bytes())]);
    let limited = |limit: &str, arguments: &str| limited(&s, limit, arguments);
    for limit in ["-v 2000000", "-v 400000", "-s 512"] {
        let run = limited(limit, "run deep.mod");
        assert_eq!((run.code, run.out.as_str()), (0, "150\n"), "{limit}: {}", run.err);
        let session = limited(limit, "-e 'print(2 + 2)'");
        assert_eq!((session.code, session.out.as_str()), (0, "4\n"), "{limit}: {}", session.err);
        let run = limited(limit, "check powers.mod");
        assert!(run.code == 1 && run.err.contains("E0005"), "{limit}: {}", run.err);
    }
}

/// Between too little memory for the command and enough for the evaluator lie the 20 MiB of its smallest stack. The
/// limit at which they begin depends on the system, so it is searched for in smaller steps.
#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_for_the_evaluator_is_told() {
    const STEP_KILOBYTES: usize = 4 << 10;
    let s = Sandbox::new(&[("a.mod", b"print(1 + 1)\n")]);
    let mut limits = (8..128).map(|steps| format!("-v {}", steps * STEP_KILOBYTES));
    let told = limits.find_map(|limit| {
        let run = limited(&s, &limit, "run a.mod");
        run.err.contains("E0509").then_some(run)
    });
    let run = told.expect("of these limits one leaves too little for the evaluator alone");
    assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
    let words = ["gives no memory to evaluate the program", "end other programs, or raise the limit"];
    assert!(words.iter().all(|words| run.err.contains(words)), "{}", run.err);
    assert_eq!(s.run(&["run", "a.mod"]).out, "2\n");
}
