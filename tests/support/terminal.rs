//! A program at a pseudo-terminal, as fast as it answers: what it writes is read as it comes.
#![cfg(unix)]

use rexpect::process::PtyProcess;
use std::fs::File;
use std::io::{Read, Write};
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// How long a program may take to say what it is to say: machines are loaded.
const PATIENCE: Duration = Duration::from_secs(60);

pub const PROMPT: &str = "modl> ";

pub struct Terminal {
    _process: PtyProcess,
    keys: File,
    written: Receiver<Vec<u8>>,
    /// What was written, and not yet waited for.
    seen: String,
}

impl Terminal {
    pub fn begin(mut command: Command) -> Terminal {
        command.env("TERM", "xterm").env("NO_COLOR", "1");
        let process = PtyProcess::new(command).expect("a terminal can be had");
        let file = || process.get_file_handle().expect("a terminal can be read");
        let (mut screen, keys) = (file(), file());
        let (sender, written) = channel();
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = screen.read(&mut bytes) {
                if sender.send(bytes[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        Terminal { _process: process, keys, written, seen: String::new() }
    }

    pub fn types(&mut self, keys: &str) {
        self.types_bytes(keys.as_bytes());
    }

    pub fn types_bytes(&mut self, keys: &[u8]) {
        self.keys.write_all(keys).expect("the session takes keys");
    }

    /// Reads on until the words have come; gives what came before them.
    pub fn sees(&mut self, words: &str) -> String {
        let begin = Instant::now();
        loop {
            if let Some(at) = self.seen.find(words) {
                return self.seen.drain(..at + words.len()).take(at).collect();
            }
            let left = PATIENCE.saturating_sub(begin.elapsed());
            match self.written.recv_timeout(left) {
                Ok(bytes) => self.seen.push_str(&String::from_utf8_lossy(&bytes)),
                Err(why) => panic!("waited for `{words}`, {why}: {}", self.seen),
            }
        }
    }

    /// From the key that ends an entry to the next prompt.
    pub fn ask(&mut self, entry: &str, answer: &str) -> Duration {
        self.types(entry);
        // It comes back as it is typed, piece by piece.
        self.sees(entry.get(entry.len().saturating_sub(2)..).unwrap_or_default());
        let begin = Instant::now();
        self.types("\r");
        self.sees(answer);
        self.sees(PROMPT);
        begin.elapsed()
    }

    /// Begins an entry that would take minutes, waits until it has come to where it says `at`, and ends it:
    /// from Ctrl-C to the next prompt.
    pub fn stop(&mut self, entry: &str, at: &str) -> Duration {
        self.types(&format!("{entry}\r"));
        self.sees(at);
        let begin = Instant::now();
        self.types("\x03");
        self.sees("interrupted");
        self.sees(PROMPT);
        begin.elapsed()
    }
}
