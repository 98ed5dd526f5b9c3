//! Facts that only an instance has (order, modules, mass), and its picture. They are found by running a
//! small program.

use super::outline::{Page, PageEntry};
use crate::check::{self, Entry};
use crate::interpret::{Host, Mode, Options, WriteError};
use crate::interrupt::CancelState;
use crate::source::Files;

/// Width and height of a picture in pixels.
const SIZE: (usize, usize) = (480, 300);

/// The host of that program: collects what it prints and writes.
struct Answers {
    lines: Vec<String>,
    picture: Option<Vec<u8>>,
    cancel_state: CancelState,
}

impl Host for Answers {
    fn print(&mut self, line: &str) {
        self.lines.push(line.to_owned());
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        self.picture = Some(bytes.to_vec());
        Ok(path.to_owned())
    }

    fn progress(&mut self, _: &str) {}

    fn cancel_state(&self) -> CancelState {
        self.cancel_state.clone()
    }
}

/// Fills in the facts of every entry of a page with a default instance, and returns its pictures as (name in the site,
/// bytes of a PNG file).
pub(super) fn drawn(
    page: &mut Page,
    files: &dyn Files,
    cancel_state: &CancelState,
) -> Vec<(String, Vec<u8>)> {
    let import = match page.title.strip_prefix("std.") {
        Some(_) => page.title.clone(),
        None => format!("\"{}\"", page.title),
    };
    let stem = page.file.trim_end_matches(".html").to_owned();
    let mut pictures = Vec::new();
    for entry in page.entries.iter_mut().filter(|entry| entry.has_default) {
        let Some(answers) = asked(entry, &import, files, cancel_state) else { continue };
        if let Some(bytes) = answers.picture {
            let name = format!("pictures/{stem}-{}.png", entry.name);
            entry.picture = Some(name.clone());
            pictures.push((name, bytes));
        }
        let mut facts = answers.lines.iter();
        entry.order = facts.next().and_then(|order| order.parse().ok()).filter(|_| entry.word == "config");
        if let Some(order) = entry.order {
            entry.facts.push(format!("order {order}"));
        }
        entry.facts.extend(facts.cloned());
    }
    pictures
}

/// Runs the program for one entry; `None` if the program has an error.
fn asked(entry: &PageEntry, import: &str, files: &dyn Files, cancel_state: &CancelState) -> Option<Answers> {
    let name = &entry.name;
    let facts = match entry.word {
        "config" => {
            format!("print(order({name}()))\nprint(count({name}()), \"modules\")\nprint(mass({name}()))\n")
        }
        "module" => format!("print(0)\nprint(mass({name}()))\n"),
        "lattice" => format!("print(0)\nprint(count({name}()), \"cells\")\n"),
        _ => String::new(),
    };
    let text = format!("use {import}.{{{name}}}\n{facts}show({name}(), \"picture.png\")\n");
    let cell = Entry { name: "<documentation>".into(), text, first_line: 1, value: None, last: None };
    let checked = check::check_session(files, &[cell]);
    if checked.has_errors() {
        return None;
    }
    let mut answers = Answers { lines: Vec::new(), picture: None, cancel_state: cancel_state.clone() };
    // A robot that falls is drawn, too: no verdict is claimed.
    let options = Options { picture: Some(SIZE), ..Options::default() };
    crate::execute::run(&checked, Mode::Run, files, &mut answers, &options);
    Some(answers)
}
