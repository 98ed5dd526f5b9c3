//! How long a person waits for a session: `cargo bench --bench session`. From process creation to the
//! prompt at a real terminal; `:reload` of a file of 1,000 lines of which one changed; Tab in a session
//! with that file; Ctrl-C until the prompt is back.

mod generate;
#[cfg(unix)]
#[path = "../tests/support/terminal.rs"]
mod terminal;

#[cfg(unix)]
fn main() {
    unix::main();
}

#[cfg(not(unix))]
fn main() {
    println!("there are no terminals to measure with here");
}

#[cfg(unix)]
mod unix {
    use super::generate;
    use super::terminal::{PROMPT, Terminal};
    use std::path::Path;
    use std::process::Command;
    use std::time::{Duration, Instant};

    const RUNS: usize = 30;
    const LINES: usize = 1_000;

    const WORM: &str = "config Worm(n: Int) { part seg[n]: Chain3  for i in 0..n - 1 { connect seg[i].tail -- \
        seg[i + 1].head }  behavior bend(to: Angle) = Pc([move(m.tilt, to: to) for s in seg for m in s.m])  behavior crawl = \
        repeat(Sc(bend(1deg), bend(-1deg)), 100) }";

    /// Not rigid for more than three struts: one decomposition of a large matrix finds how.
    const LOOP: &str = "truss Loop(n: Int = 3) of PneumaticReel { let r = n * 0.16m  for i in 0..n { node p[i] = \
        [r * cos(i / n * 1turn), r * sin(i / n * 1turn), 0m] }  for i in 0..n { strut p[i] -- p[(i + 1) % n] } }";

    pub fn main() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("long.mod");
        let text = generate::program(LINES);
        std::fs::write(&file, &text).expect("a file can be written");
        report("start to prompt", &mut || {
            let begin = Instant::now();
            let mut session = start(folder.path(), &[]);
            session.sees(PROMPT);
            begin.elapsed()
        });
        let mut session = start(folder.path(), &["long.mod"]);
        session.sees(PROMPT);
        let mut turn = 0;
        report(":reload of 1,000 lines", &mut || {
            turn += 1;
            std::fs::write(&file, format!("{text}\nlet changed_{turn} = {turn}\n"))
                .expect("a file can be written");
            session.ask(":reload", "changed_")
        });
        report("an entry", &mut || session.ask("1 + 1", "2: Int"));
        report("Tab", &mut || {
            session.types("clam");
            session.sees("clam");
            let begin = Instant::now();
            session.types("\t");
            session.sees("clamp");
            let took = begin.elapsed();
            session.types("\x03");
            session.sees(PROMPT);
            took
        });
        report("Tab behind a dot", &mut || {
            session.types("Arm0().cu");
            session.sees("cu");
            let begin = Instant::now();
            session.types("\t");
            session.sees("rl");
            let took = begin.elapsed();
            session.types("\x03");
            session.sees(PROMPT);
            took
        });
        let endless = "for i in 0..40000000 { let x = i }";
        report("Ctrl-C of a loop", &mut || session.stop(endless, "evaluating: "));
        session.ask("use std.shapes.icosahedron", "");
        session.ask("use std.mori.Mori", "");
        let fold = "fold(icosahedron(edge: 80mm), Mori, method: enumerate, budget: 100000000000)";
        report("Ctrl-C of a planner", &mut || session.stop(fold, "layouts, "));
        session.ask("use std.smores.Chain3", "");
        session.ask(WORM, "config Worm");
        let judge = "verify(Worm(60).crawl())";
        report("Ctrl-C of the judge", &mut || session.stop(judge, "walked "));
        session.ask("use std.truss.PneumaticReel", "");
        session.ask(LOOP, "truss Loop");
        watch(folder.path(), &file, &text);
        report("Ctrl-C of a solver", &mut || session.stop("Loop(150)", "hold each other"));
    }

    /// `modl watch` of the long file: from a save to the report.
    fn watch(folder: &Path, file: &Path, text: &str) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_modl"));
        command.args(["watch", "long.mod"]).current_dir(folder);
        let mut terminal = Terminal::begin(command);
        terminal.sees("watching 1 file");
        let mut turn = 0;
        report("watch: save to report", &mut || {
            turn += 1;
            let text = format!("{text}\nlet changed_{turn} = {turn}\n");
            let begin = Instant::now();
            std::fs::write(file, text).expect("a file can be written");
            terminal.sees("watching 1 file");
            begin.elapsed()
        });
    }

    fn start(folder: &Path, arguments: &[&str]) -> Terminal {
        let mut command = Command::new(env!("CARGO_BIN_EXE_modl"));
        command.arg("repl").args(arguments).current_dir(folder).env("MODL_HISTORY", folder.join("history"));
        Terminal::begin(command)
    }

    fn report(what: &str, run: &mut dyn FnMut() -> Duration) {
        let mut times: Vec<Duration> = (0..RUNS).map(|_| run()).collect();
        times.sort();
        let [least, median, high] = [0, RUNS / 2, RUNS * 9 / 10].map(|i| times[i].as_secs_f64() * 1e3);
        println!("{what:<24} median {median:6.2} ms   least {least:6.2} ms   90 % below {high:6.2} ms");
    }
}
