//! The identity of a study: a digest of all that its rows depend on.

use crate::check::Checked;
use crate::cli::arguments::Globals;
use crate::cli::program;
use crate::source::{Files, ReadError};
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// The version of the form of shards and of the digest.
pub(super) const FORM: u32 = 1;

/// All that the rows of a study depend on, but for the files that they read.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Identity {
    /// The SHA-256 of the other fields, in hexadecimal digits.
    pub hash: String,
    /// The name of the study.
    pub study: String,
    /// The version of modl.
    pub modl: &'static str,
    /// The SHA-256 of each source text, by its path.
    pub sources: BTreeMap<String, String>,
    /// The settings of the command line on which rows depend, by name.
    pub settings: BTreeMap<&'static str, u64>,
}

impl Identity {
    /// Returns the identity of a study of a checked program.
    pub(super) fn of(checked: &Checked, study: &str, globals: &Globals) -> Identity {
        let sources = checked.sources.files();
        let sources: BTreeMap<String, String> =
            sources.map(|(_, file)| (file.name.to_string(), digest(file.text.as_bytes()))).collect();
        let limits = program::limits(globals);
        let settings = BTreeMap::from([
            ("seed", globals.seed),
            ("max_steps", limits.steps),
            ("max_modules", limits.modules as u64),
            ("max_samples", limits.samples as u64),
        ]);
        let modl = env!("CARGO_PKG_VERSION");
        let mut text = format!("modl study {FORM}\n{modl}\n{study}\n");
        for (path, hash) in &sources {
            text.push_str(&format!("{path:?} {hash}\n"));
        }
        for (name, value) in &settings {
            text.push_str(&format!("{name} {value}\n"));
        }
        Identity { hash: digest(text.as_bytes()), study: study.to_owned(), modl, sources, settings }
    }
}

/// Returns the SHA-256 of some bytes in hexadecimal digits.
pub(super) fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The files of a project, with a record of those that were read: rows depend on them, too.
pub(super) struct Recorder<'f> {
    files: &'f (dyn Files + Sync),
    read: Mutex<BTreeMap<String, String>>,
}

impl<'f> Recorder<'f> {
    pub(super) fn new(files: &'f (dyn Files + Sync)) -> Recorder<'f> {
        Recorder { files, read: Mutex::default() }
    }

    /// Returns the SHA-256 of each file that was read so far, by its path.
    pub(super) fn read_so_far(&self) -> BTreeMap<String, String> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Returns true if the files have these digests now.
    pub(super) fn are_as(&self, digests: &BTreeMap<String, String>) -> bool {
        digests.iter().all(|(path, known)| digest_of(&self.files.read(path)) == *known)
    }
}

/// Returns the digest of what reading a file gave; a file that can't be read has one, too.
fn digest_of(read: &Result<Vec<u8>, ReadError>) -> String {
    read.as_ref().map_or_else(|_| "none".to_owned(), |bytes| digest(bytes))
}

impl Files for Recorder<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        let read = self.files.read(path);
        let digest = digest_of(&read);
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned(), digest);
        read
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        self.files.library(path)
    }
}
