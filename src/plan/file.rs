//! Plans as text and back: JSON that stands alone and loses nothing. Writing, reading and writing
//! again gives the same bytes.

use super::form::{FORMAT, Header, PlanForm, VERSION};
use super::{Plan, finite, validate};
use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};
use std::io::{self, Write};

/// Longest text that is read, bytes.
pub const TEXT_MAX: usize = 1 << 31;

/// Why a plan can't be written or read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// From 1; 0 where the fault has no place in the text.
    pub line: usize,
    /// From 1, in bytes; 0 where the fault has no place in the text.
    pub column: usize,
    pub message: String,
}

impl FileError {
    fn whole(message: impl Into<String>) -> FileError {
        FileError { line: 0, column: 0, message: message.into() }
    }
}

impl std::fmt::Display for FileError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.line == 0 {
            return f.write_str(&self.message);
        }
        write!(f, "line {}, column {}: {}", self.line, self.column, self.message)
    }
}

impl From<serde_json::Error> for FileError {
    fn from(error: serde_json::Error) -> FileError {
        let place = format!(" at line {} column {}", error.line(), error.column());
        let message = error.to_string().replace(&place, "");
        FileError { line: error.line(), column: error.column(), message }
    }
}

/// A plan as text. Refused are numbers that are not finite.
pub fn write(plan: &Plan) -> Result<String, FileError> {
    let form = PlanForm::of(plan);
    finite::check(&form).map_err(|fault| FileError::whole(fault.to_string()))?;
    let mut bytes = Vec::new();
    let mut to = Serializer::with_formatter(&mut bytes, Lines { depth: 0, empty: true });
    form.serialize(&mut to)?;
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(|_| FileError::whole("the plan holds text that is not UTF-8"))
}

/// A plan from text, its indices and orders checked. What it says of its own verdict is not believed:
/// that is for the judge.
pub fn read(text: &str) -> Result<Plan, FileError> {
    if text.len() > TEXT_MAX {
        return Err(FileError::whole(format!("the file is longer than {TEXT_MAX} bytes")));
    }
    let header: Header = serde_json::from_str(text)?;
    if header.format.as_deref() != Some(FORMAT) {
        return Err(FileError::whole(format!("this is no plan file: its `format` is not \"{FORMAT}\"")));
    }
    if header.version != Some(VERSION) {
        let version = header.version.map_or("none".into(), |v| v.to_string());
        let message = format!("the file's version is {version}; this tool reads version {VERSION}");
        return Err(FileError::whole(message));
    }
    let form: PlanForm = serde_json::from_str(text)?;
    let plan = form.plan().map_err(FileError::whole)?;
    validate::validate(&plan).map_err(FileError::whole)?;
    Ok(plan)
}

/// The JSON Schema of plan files.
pub fn schema() -> serde_json::Value {
    let mut schema = schemars::schema_for!(PlanForm<'static>).to_value();
    if let Some(object) = schema.as_object_mut() {
        object.insert("title".into(), format!("modl plan, version {VERSION}").into());
    }
    schema
}

/// Lays out JSON: a line for each item of the outer containers, so that a person finds their way and
/// two plans can be compared, and inner containers on the line where they stand.
struct Lines {
    depth: usize,
    /// Whether the container just opened is empty so far.
    empty: bool,
}

/// Containers deeper than this stay on one line: a segment of a track is one.
const LINES_DEPTH: usize = 5;

impl Lines {
    fn open<W: Write + ?Sized>(&mut self, to: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        self.empty = true;
        to.write_all(bracket)
    }

    fn close<W: Write + ?Sized>(&mut self, to: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth -= 1;
        if !self.empty && self.depth < LINES_DEPTH {
            self.line(to)?;
        }
        self.empty = false;
        to.write_all(bracket)
    }

    fn item<W: Write + ?Sized>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.empty = false;
        if !first {
            to.write_all(b",")?;
        }
        if self.depth <= LINES_DEPTH {
            self.line(to)
        } else if first {
            Ok(())
        } else {
            to.write_all(b" ")
        }
    }

    fn line<W: Write + ?Sized>(&self, to: &mut W) -> io::Result<()> {
        to.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| to.write_all(b" "))
    }
}

impl Formatter for Lines {
    fn begin_array<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.open(to, b"[")
    }
    fn end_array<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.close(to, b"]")
    }
    fn begin_array_value<W: Write + ?Sized>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.item(to, first)
    }
    fn begin_object<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.open(to, b"{")
    }
    fn end_object<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.close(to, b"}")
    }
    fn begin_object_key<W: Write + ?Sized>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.item(to, first)
    }
    fn begin_object_value<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        to.write_all(b": ")
    }
}
