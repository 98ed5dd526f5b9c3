//! Stands in for rooms that are not built yet.

use crate::check::{Checked, Program};
use crate::interpret::{Host, Mode, Options, Outcome};
use crate::plan::{Plan, Verdict};
use crate::source::{Diagnostic, Files, Sources, Span, code};

pub fn check(files: &dyn Files, root: &str) -> Checked {
    let mut sources = Sources::default();
    let bytes = files.read(root).unwrap_or_default();
    let (text, diagnostic) = match std::str::from_utf8(&bytes) {
        Ok(text) => (text.to_owned(), None),
        Err(e) => {
            let offset = e.valid_up_to();
            let text = String::from_utf8_lossy(&bytes).into_owned();
            (text, Some((offset, format!("the file is not UTF-8 text: byte {offset} begins no character"))))
        }
    };
    let id = sources.add(root, &text, false);
    let diagnostics = diagnostic.map(|(offset, message)| {
        Diagnostic::error(code::NOT_UTF8, message).label(Span::new(id, offset, offset + 1), "here")
    });
    Checked { sources, program: Program::default(), diagnostics: diagnostics.into_iter().collect() }
}

pub fn run(_: &Checked, _: Mode, _: &dyn Files, _: &mut dyn Host, _: &Options) -> Outcome {
    Outcome::default()
}

pub fn read_plan(_: &[u8]) -> Result<Plan, String> {
    Err("plan files can't be read yet".to_owned())
}

pub fn verify(_: &Plan) -> Verdict {
    Verdict::default()
}
