//! Plans as text and back: JSON that stands alone and loses nothing. Writing, reading and writing
//! again gives the same bytes.

mod json;
mod layout;
mod library;
mod program;

use self::json::{FORMAT, Header, PlanJson, VERSION, VERSION_MIN};
use self::layout::laid_out;
use super::motion_plan::Plan;
use super::validation::check_serialisable;
use sha2::{Digest, Sha256};

/// The greatest length of a text that [`read`] accepts, bytes.
pub const TEXT_MAX: usize = 1 << 31;

/// The reason why a plan cannot be written or read, with its position in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// The line of the fault, from 1; 0 where it has no position in the text.
    pub line: usize,
    /// The column of the fault, from 1, in bytes; 0 where it has no position in the text.
    pub column: usize,
    /// The reason in words, as a message.
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

/// Returns a plan as the text of its JSON file, of the version that [`schema`] describes.
///
/// # Errors
/// A [`FileError`] without position for a number that is not finite, which JSON cannot hold, and for nesting deeper
/// than readers take.
pub fn write(plan: &Plan) -> Result<String, FileError> {
    let json = PlanJson::of(plan);
    check_serialisable(&json).map_err(|fault| FileError::whole(fault.to_string()))?;
    Ok(laid_out(&serde_json::to_string(&json)?))
}

/// Returns the plan that a text holds, its indices, orders and names checked. Its own verdict is read and not
/// believed: that is for the judge.
///
/// Files of version 2 and of later versions are read, as versions only add fields; a later version's
/// file is refused where it uses what was added.
///
/// # Errors
/// A [`FileError`] for a text that is too long, that is no JSON of a plan, or is one of a version before 2, and for
/// a plan with a [`PlanFault`](super::PlanFault); it has a position for errors of the JSON.
pub fn read(text: &str) -> Result<Plan, FileError> {
    if text.len() > TEXT_MAX {
        return Err(FileError::whole(format!("the file is longer than {TEXT_MAX} bytes")));
    }
    let header: Header = serde_json::from_str(text)?;
    if header.format.as_deref() != Some(FORMAT) {
        return Err(FileError::whole(format!("this is no plan file: its `format` is not \"{FORMAT}\"")));
    }
    let Some(version) = header.version else {
        return Err(FileError::whole("the file does not say its `version`"));
    };
    if version < VERSION_MIN {
        return Err(FileError::whole(format!(
            "the file's version is {version}, older than {VERSION_MIN}, the oldest that is read: plan again \
             with this tool (`knots` are now `keyframes`, a `way` is an `interpolation`, `docks` are \
             `events`, and names stand beside the indices)"
        )));
    }
    let json: PlanJson = serde_json::from_str(text).map_err(|error| newer(version, error.into()))?;
    json.into_valid_plan().map_err(|fault| newer(version, FileError::whole(fault.to_string())))
}

/// Returns an error that mentions the version, where the file's is later than ours: the error may come from
/// what that version added.
fn newer(version: u32, error: FileError) -> FileError {
    if version <= VERSION {
        return error;
    }
    let message = format!(
        "{}; the file's version is {version}, and this tool knows up to version {VERSION}: read it with a \
         newer modl",
        error.message
    );
    FileError { message, ..error }
}

/// Returns the SHA-256 of a text as 64 hexadecimal digits, by which plans and their pages name sources and plans.
pub fn digest(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|b| format!("{b:02x}")).collect()
}

/// Returns the JSON Schema of plan files, of the version that [`write()`] writes; its descriptions are the comments
/// of the types.
pub fn schema() -> serde_json::Value {
    let mut schema = schemars::schema_for!(PlanJson<'static>).to_value();
    if let Some(object) = schema.as_object_mut() {
        object.insert("title".into(), format!("modl plan, version {VERSION}").into());
    }
    schema
}
