//! How long a person waits for a session: `cargo bench --bench session`. From process creation to the
//! prompt at a real terminal; `:reload` of a file of 1,000 lines of which one changed; Tab in a session
//! with that file; Ctrl-C until the prompt is back.

mod generate;

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
    use rexpect::process::PtyProcess;
    use std::fs::File;
    use std::io::{Read, Write};
    use std::path::Path;
    use std::process::Command;
    use std::time::{Duration, Instant};

    const RUNS: usize = 30;
    const LINES: usize = 1_000;
    const PROMPT: &str = "modl> ";

    pub fn main() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("long.mod");
        let text = generate::program(LINES);
        std::fs::write(&file, &text).expect("a file can be written");
        report("start to prompt", &mut || {
            let begin = Instant::now();
            let mut session = start(folder.path(), &[]);
            prompt(&mut session);
            begin.elapsed()
        });
        let mut session = start(folder.path(), &["long.mod"]);
        prompt(&mut session);
        let mut turn = 0;
        report(":reload of 1,000 lines", &mut || {
            turn += 1;
            std::fs::write(&file, format!("{text}\nlet changed_{turn} = {turn}\n"))
                .expect("a file can be written");
            ask(&mut session, ":reload", "changed_")
        });
        report("an entry", &mut || ask(&mut session, "1 + 1", "2: Int"));
        report("Tab", &mut || {
            session.types("clam");
            session.sees("clam");
            let begin = Instant::now();
            session.types("\t");
            session.sees("clamp");
            let took = begin.elapsed();
            session.types("\x03");
            prompt(&mut session);
            took
        });
        report("Ctrl-C of a loop", &mut || stop(&mut session, "for i in 0..1000000000 { let x = i }"));
        ask(&mut session, "use std.shapes.icosahedron", "");
        ask(&mut session, "use std.mori.Mori", "");
        let fold = "fold(icosahedron(edge: 80mm), Mori, method: enumerate, budget: 100000000000)";
        report("Ctrl-C of a planner", &mut || stop(&mut session, fold));
    }

    /// A session at a terminal; reading waits for the next byte, and no longer.
    struct Session {
        _process: PtyProcess,
        terminal: File,
        seen: String,
    }

    impl Session {
        fn types(&mut self, keys: &str) {
            self.terminal.write_all(keys.as_bytes()).expect("the session takes keys");
        }

        /// Reads on until the words have come.
        fn sees(&mut self, words: &str) {
            let mut bytes = [0; 4096];
            loop {
                if let Some(at) = self.seen.find(words) {
                    self.seen.drain(..at + words.len());
                    return;
                }
                let count = self.terminal.read(&mut bytes).expect("the session is there");
                self.seen.push_str(&String::from_utf8_lossy(&bytes[..count]));
            }
        }
    }

    fn start(folder: &Path, arguments: &[&str]) -> Session {
        let mut command = Command::new(env!("CARGO_BIN_EXE_modl"));
        command.arg("repl").args(arguments).current_dir(folder);
        command.env("TERM", "xterm").env("NO_COLOR", "1").env("MODL_HISTORY", folder.join("history"));
        let process = PtyProcess::new(command).expect("a terminal can be had");
        let terminal = process.get_file_handle().expect("a terminal can be read");
        Session { _process: process, terminal, seen: String::new() }
    }

    fn prompt(session: &mut Session) {
        session.sees(PROMPT);
    }

    /// From the key that ends an entry to the next prompt.
    fn ask(session: &mut Session, entry: &str, answer: &str) -> Duration {
        session.types(entry);
        session.sees(entry.get(entry.len().saturating_sub(3)..).unwrap_or_default());
        let begin = Instant::now();
        session.types("\r");
        session.sees(answer);
        prompt(session);
        begin.elapsed()
    }

    fn stop(session: &mut Session, entry: &str) -> Duration {
        session.types(&format!("{entry}\r"));
        std::thread::park_timeout(Duration::from_millis(300));
        let begin = Instant::now();
        session.types("\x03");
        session.sees("interrupted");
        prompt(session);
        begin.elapsed()
    }

    fn report(what: &str, run: &mut dyn FnMut() -> Duration) {
        let mut times: Vec<Duration> = (0..RUNS).map(|_| run()).collect();
        times.sort();
        let [least, median, high] = [0, RUNS / 2, RUNS * 9 / 10].map(|i| times[i].as_secs_f64() * 1e3);
        println!("{what:<24} median {median:6.2} ms   least {least:6.2} ms   90 % below {high:6.2} ms");
    }
}
