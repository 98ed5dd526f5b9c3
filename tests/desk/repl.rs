//! A session at a real terminal: several lines, completion, history, mistakes, Ctrl-C, saving.
#![cfg(unix)]

use crate::desk::cli::Sandbox;
use crate::desk::transcripts::HINGE;
use crate::support::terminal::{PROMPT, Terminal};
use rexpect::session::{PtySession, spawn_command};
use std::time::{Duration, Instant};

/// How long a session may take to say what it is to say, ms: machines are loaded.
const PATIENCE: u64 = 60_000;

/// A session at a terminal.
struct Talk(PtySession);

impl Talk {
    fn begin(sandbox: &Sandbox, arguments: &[&str]) -> Talk {
        let mut command = sandbox.command(arguments);
        command.env("TERM", "xterm").env("MODL_HISTORY", sandbox.path("history"));
        // What is typed comes back as it was typed.
        command.env("NO_COLOR", "1");
        // Nothing is opened.
        command.env("PATH", sandbox.path(""));
        let mut talk = Talk(spawn_command(command, Some(PATIENCE)).expect("a terminal can be had"));
        talk.sees("`:help`");
        talk
    }

    fn sees(&mut self, words: &str) {
        if let Err(why) = self.0.exp_string(words) {
            panic!("waited for `{words}`: {why}");
        }
    }

    fn types(&mut self, keys: &str) {
        self.sees(PROMPT);
        self.presses(keys);
    }

    /// Keys without waiting for the prompt.
    fn presses(&mut self, keys: &str) {
        self.0.send(keys).and_then(|_| self.0.flush()).expect("the session takes keys");
    }

    /// Types an entry and sees what comes of it.
    fn asks(&mut self, entry: &str, answer: &str) {
        self.types(&format!("{entry}\r"));
        self.sees(answer);
    }

    fn ends(mut self) {
        self.types(":quit\r");
        self.0.exp_eof().expect("the session ends");
    }
}

#[test]
fn an_entry_goes_on_over_lines_as_long_as_it_is_open() {
    let sandbox = Sandbox::new(&[]);
    let mut talk = Talk::begin(&sandbox, &["repl"]);
    talk.asks("use std.smores.Smores", "");
    talk.types("config Pair {\r  part m[2]: Smores\r  connect m[0].top -- m[1].bottom\r}\r");
    talk.sees("config Pair: order 1, 2 modules");
    talk.types("let x =\r  3 +\r  4\r");
    talk.sees("x: Int");
    talk.asks("x", "7: Int");
    // An empty line says that no more will follow.
    talk.types("let y =\r\r");
    talk.sees("E0001");
    talk.ends();
}

#[test]
fn tab_completes_with_types() {
    let sandbox = Sandbox::new(&[("hinge.mod", HINGE.as_bytes())]);
    let mut talk = Talk::begin(&sandbox, &["repl", "hinge.mod"]);
    talk.sees("loaded hinge.mod: Face, Hinge");
    talk.types("let h = Hin\t(leng\t50mm)\r");
    // The terminal writes anew only what changes.
    talk.sees("Hinge(length: ");
    talk.sees("h: Hinge");
    talk.types("h.be\t\r");
    talk.sees("h.bend");
    talk.sees("Joint<Angle>");
    talk.types("h.\t");
    for word in ["back  Port", "bend  Joint<Angle>", "front  Port", "length  Length"] {
        talk.sees(word);
    }
    // Below the list stands again what was typed so far.
    talk.types("\x03");
    talk.types("90d\t\r");
    talk.sees("90deg: Angle");
    talk.types(":doc Hin\t\r");
    talk.sees("A single hinge.");
    talk.ends();
}

/// Fields behind a dot, in the call that builds a record, and where one is changed.
#[test]
fn tab_knows_the_fields_of_records() {
    let sandbox = Sandbox::new(&[]);
    let mut command = sandbox.command(&["repl"]);
    command.env("MODL_HISTORY", sandbox.path("history"));
    let mut terminal = Terminal::begin(command);
    terminal.sees(PROMPT);
    terminal.types("record Design { bend: Angle = 30deg, size: Length }\r");
    terminal.sees("record Design { bend: Angle, size: Length }");
    terminal.types("let d = Design(size: 1m)\r");
    terminal.sees("d: Design");
    offered(&mut terminal, "d.", &["bend  Angle", "size  Length"]);
    offered(&mut terminal, "Design(", &["bend:  Angle", "size:  Length"]);
    offered(&mut terminal, "Design(bend: 3deg, ", &["size: "]);
    offered(&mut terminal, "d with { ", &["bend:  Angle", "size:  Length"]);
    offered(&mut terminal, "d with { bend: 3deg, ", &["size: "]);
    offered(&mut terminal, "fn f(x: Design) -> Length = (x with { ", &["bend:  Angle", "size:  Length"]);
}

/// What is offered behind a text that is being typed, in a session with `HINGE`.
fn offered(terminal: &mut Terminal, text: &str, wanted: &[&str]) {
    terminal.types(text);
    terminal.types("\t");
    for words in wanted {
        terminal.sees(words);
    }
    terminal.types("\x03");
    // The line is left; what is typed before that goes with it.
    terminal.sees("\x1b[?2004l");
    terminal.sees(PROMPT);
}

#[test]
fn tab_knows_what_an_unfinished_body_declares() {
    let sandbox = Sandbox::new(&[("hinge.mod", HINGE.as_bytes())]);
    let mut command = sandbox.command(&["repl", "hinge.mod"]);
    command.env("MODL_HISTORY", sandbox.path("history"));
    let mut terminal = Terminal::begin(command);
    terminal.sees(PROMPT);
    let body = "config Q(size: Length = 4mm) { part a[2]: Hinge  let b = a[1]  behavior go(to: Angle) = ";
    let offered = |terminal: &mut Terminal, end: &str, wanted: &[&str]| {
        offered(terminal, &format!("{body}{end}"), wanted);
    };
    offered(&mut terminal, "move(a[0].be", &["a[0].bend"]);
    offered(&mut terminal, "move(b.be", &["b.bend"]);
    offered(&mut terminal, "s", &["size  Length", "sqrt  "]);
    // The binder of a loop stands before its body.
    offered(&mut terminal, "1 for h in a { move(h.be", &["h.bend"]);
    offered_elsewhere(&mut terminal);
}

/// Of functions, modules, and at the top.
fn offered_elsewhere(terminal: &mut Terminal) {
    offered(terminal, "fn f(hinge: Hinge, n: Int) = hin", &["fn f(hinge: Hinge, n: Int) = hinge"]);
    offered(terminal, "fn f(hinge: Hinge, n: Int) = hinge.be", &["hinge.bend"]);
    offered(
        terminal,
        "module M { link foot = box(1mm, 1mm, 1mm)  link food = box(1mm, 1mm, 1mm)  joint j: fo",
        &["food  link", "foot  link"],
    );
    offered(terminal, "fn g() = { let far = 2 * 30mm\rfa", &["far"]);
}

#[test]
fn reload_keeps_what_does_not_depend_on_the_change() {
    let sandbox = Sandbox::new(&[("main.mod", b"let side = 80mm\nlet other = 1\n")]);
    let mut command = sandbox.command(&["repl", "main.mod"]);
    command.env("MODL_HISTORY", sandbox.path("history"));
    let mut terminal = Terminal::begin(command);
    terminal.sees(PROMPT);
    terminal.ask("use std.mori.Mori", "");
    terminal.ask("use std.shapes.octahedron", "");
    terminal.ask("let p = fold(octahedron(edge: 80mm), Mori)", "p: Folding");
    terminal.ask("let q = fold(octahedron(edge: side), Mori)", "q: Folding");
    std::fs::write(sandbox.path("main.mod"), "let side = 0.08m\nlet other = 1\nlet third = 3\n")
        .expect("a file can be written");
    terminal.types(":reload\r");
    terminal.sees("main.mod: side is changed; needed by q");
    terminal.sees(PROMPT);
    // A planner at work says so.
    let mut planned_again = |name: &str| {
        terminal.types(&format!("[1, {name}.layouts][0]\r"));
        terminal.sees("1: Int").contains("folding 8 panels")
    };
    assert!(!planned_again("p") && planned_again("q"));
}

#[test]
fn what_was_typed_is_remembered_in_the_next_session() {
    let sandbox = Sandbox::new(&[]);
    let mut talk = Talk::begin(&sandbox, &["repl"]);
    talk.asks("1 + 2", "3: Int");
    talk.asks("20 * 2", "40: Int");
    // Up twice.
    talk.types("\x1b[A\x1b[A\r");
    talk.sees("3: Int");
    talk.ends();
    let mut talk = Talk::begin(&sandbox, &["repl"]);
    // Ctrl-R searches backwards.
    talk.types("\x12* 2");
    talk.sees("20 * 2");
    talk.presses("\r");
    talk.sees("40: Int");
    talk.ends();
}

#[test]
fn a_mistake_leaves_the_session_as_it_was() {
    let sandbox = Sandbox::new(&[]);
    let mut talk = Talk::begin(&sandbox, &["repl"]);
    talk.asks("let a = 2", "a: Int");
    talk.asks("let a = 3 + b", "`b` is not known here");
    talk.asks("a", "2: Int");
    talk.asks("[1, 2][a]", "index 2 is outside");
    talk.asks("_", "2: Int");
    talk.ends();
}

#[test]
fn ctrl_c_ends_a_planner_and_the_session_goes_on() {
    let sandbox = Sandbox::new(&[]);
    let mut talk = Talk::begin(&sandbox, &["repl"]);
    talk.asks("use std.mori.Mori", "");
    talk.asks("use std.shapes.{icosahedron, quadruped18, tube}", "");
    talk.asks("let a = 2", "a: Int");
    for long in LONG {
        let mut quickest = Duration::MAX;
        // Thrice: on a machine that does much else, one time may be unlucky.
        for wait in [300, 700, 1_100] {
            talk.types(&format!("{long}\r"));
            std::thread::park_timeout(Duration::from_millis(wait));
            let begin = Instant::now();
            talk.presses("\x03");
            talk.sees("interrupted");
            quickest = quickest.min(begin.elapsed());
        }
        // What waits for the words looks every 100 ms; `benches/session.rs` measures more finely.
        assert!(quickest < Duration::from_millis(250), "{long}: {quickest:?}");
    }
    talk.asks("a", "2: Int");
    talk.ends();
}

/// What would take long: layouts one after the other; sheets, bounds and ways between them; orders of folding.
const LONG: [&str; 3] = [
    "fold(icosahedron(edge: 80mm), Mori, method: enumerate, budget: 1000000000)",
    "refold(tube(8, 5, edge: 80mm), tube(10, 4, edge: 80mm), Mori, budget: 1000000000000)",
    "fold(quadruped18(edge: 80mm), Mori, gravity: on)",
];

#[test]
fn what_was_entered_is_saved_and_runs() {
    let sandbox = Sandbox::new(&[]);
    let mut talk = Talk::begin(&sandbox, &["repl"]);
    talk.asks("use std.smores.{Smores, Chain3}", "");
    talk.asks("let n = 3", "n: Int");
    talk.asks("config   Pair{part m:Smores}", "config Pair: order 1, 1 module");
    talk.asks("Pair().m", "m, a Smores");
    talk.asks("print(\"mass\", mass(_))", "mass ");
    talk.asks("let n = 4", "n: Int");
    talk.asks(":save pair.mod", "wrote pair.mod");
    talk.ends();
    let saved = std::fs::read_to_string(sandbox.path("pair.mod")).expect("it was saved");
    assert!(saved.contains("config Pair {") && saved.contains("let n = 4"), "{saved}");
    assert!(!saved.contains("let n = 3"), "{saved}");
    let ran = sandbox.run(&["run", "pair.mod"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.out.starts_with("mass "), "{}", ran.out);
    assert_eq!(sandbox.run(&["fmt", "--check", "pair.mod"]).code, 0, "it is in style");
}

#[test]
fn reload_says_what_changed_and_who_needs_it() {
    let sandbox = Sandbox::new(&[
        ("part.mod", b"let a = 1\nlet b = 2\n"),
        ("main.mod", b"use \"part.mod\".{a}\nlet c = a + 1\nlet gone = 0\n"),
    ]);
    let mut talk = Talk::begin(&sandbox, &["repl", "main.mod"]);
    talk.sees("loaded main.mod: c, gone");
    talk.asks("let d = c", "d: Int");
    talk.asks("use std.smores.Smores", "");
    talk.asks(":reload", "nothing changed");
    std::fs::write(sandbox.path("part.mod"), "let a = 10\nlet b = 2\n").expect("a file can be written");
    std::fs::write(sandbox.path("main.mod"), "use \"part.mod\".{a}\nlet c = a + 1\n")
        .expect("a file can be written");
    talk.types(":reload\r");
    talk.sees("part.mod: a is changed; needed by c, d");
    talk.sees("main.mod: gone is gone");
    talk.asks("d", "11: Int");
    // What does not depend on it stays: it is not worked out again.
    talk.asks("let kept = [i for i in 0..2]", "kept: List<Int>");
    talk.asks("let robot = Smores()", "robot: Smores");
    std::fs::write(sandbox.path("part.mod"), "let a = 20\nlet b = 2\nlet more = [i for i in 0..100]\n")
        .expect("a file can be written");
    talk.types(":reload\r");
    talk.sees("part.mod: a is changed; needed by c, d");
    talk.sees("part.mod: more is new");
    talk.asks("c + d + len(kept)", "44: Int");
    talk.asks("robot.tilt", "Smores.tilt");
    std::fs::write(sandbox.path("part.mod"), "let a = 10\nlet b = 2\n").expect("a file can be written");
    talk.types(":reload\r");
    talk.sees("part.mod: more is gone");
    // What is wrong now leaves all as it was.
    std::fs::write(sandbox.path("part.mod"), "let a = \n").expect("a file can be written");
    talk.asks(":reload", "E0001");
    talk.asks("c + d", "22: Int");
    talk.ends();
}

#[test]
fn a_page_of_anything_can_be_looked_at() {
    let sandbox = Sandbox::new(&[("hinge.mod", HINGE.as_bytes())]);
    let mut talk = Talk::begin(&sandbox, &["repl", "hinge.mod"]);
    talk.types(":view Hinge()\r");
    talk.sees("wrote out/view.html");
    talk.ends();
    assert!(sandbox.path("out/view.html").exists());
}
