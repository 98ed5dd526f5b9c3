//! The folder of a study: shards, each a file that is there whole or not at all.
//!
//! A shard holds rows that follow each other: a header, a line for each row, and the SHA-256 of all that before it.

use super::identity::{FORM, Identity, Recorder, digest};
use crate::cli::output;
use crate::interpret::WriteError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::PathBuf;

/// The ending of the names of shards.
const ENDING: &str = ".rows";
/// The first word of the last line of a shard.
const SEAL: &str = "sha256 ";
/// The greatest size of a shard, in bytes; a larger file is none.
const SHARD_BYTES_MAX: u64 = 1 << 30;

/// A row as a shard holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Line {
    /// The line of the table in CSV, without its end.
    pub csv: String,
    /// The code of the error for which the row has no values; empty if it has.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub code: String,
    /// The objective of a search, in SI units.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sought: Option<f64>,
}

/// The first line of a shard.
#[derive(Debug, Serialize, Deserialize)]
struct Header {
    modl_study: u32,
    study: String,
    hash: String,
    start: u64,
    end: u64,
    /// The SHA-256 of each file that the rows read, by its path.
    files: BTreeMap<String, String>,
}

/// A sound shard of the folder.
#[derive(Clone, Debug)]
pub(super) struct Shard {
    /// The rows that it holds.
    pub rows: Range<u64>,
    name: String,
}

/// The shards of a folder, and the files that pretend to be some.
#[derive(Debug, Default)]
pub(super) struct Listing {
    /// The sound shards, by their first row, of equal ones the longest first.
    pub shards: Vec<Shard>,
    /// The files with the names of shards that are none of this study, each with the reason.
    pub strangers: Vec<(String, String)>,
}

/// The folder of a study's shards.
#[derive(Clone, Debug)]
pub(super) struct Store {
    /// The folder.
    pub folder: PathBuf,
    study: String,
    hash: String,
}

impl Store {
    /// Returns the folder of a study below the output folder, which is made when something is written.
    pub(super) fn new(out: &std::path::Path, identity: &Identity) -> Store {
        let short: String = identity.hash.chars().take(12).collect();
        let folder = out.join(format!("{}-{short}", identity.study));
        Store { folder, study: identity.study.clone(), hash: identity.hash.clone() }
    }

    /// Writes the rows from `start` on as a shard. `files`: the digests of the files that they read.
    ///
    /// # Errors
    /// A [`WriteError`] if the system refuses; there is no shard then.
    pub(super) fn write(
        &self,
        start: u64,
        lines: &[Line],
        files: BTreeMap<String, String>,
    ) -> Result<(), WriteError> {
        let end = start + lines.len() as u64;
        let (study, hash) = (self.study.clone(), self.hash.clone());
        let header = Header { modl_study: FORM, study, hash, start, end, files };
        let mut text = json(&header);
        for line in lines {
            text.push('\n');
            text.push_str(&json(line));
        }
        text.push('\n');
        let seal = digest(text.as_bytes());
        text.push_str(&format!("{SEAL}{seal}\n"));
        let name = format!("{start:010}-{end:010}{ENDING}");
        output::write(&self.folder, &name, text.as_bytes()).map(drop)
    }

    /// Returns the shards of the folder, each read and checked; `files` says if the files that they read have changed.
    pub(super) fn list(&self, files: &Recorder) -> Listing {
        self.listed(files, |_| true)
    }

    /// Lists the shards whose names say that they hold rows that `wanted` accepts.
    fn listed(&self, files: &Recorder, wanted: impl Fn(Range<u64>) -> bool) -> Listing {
        let mut listing = Listing::default();
        let Ok(entries) = fs::read_dir(&self.folder) else { return listing };
        let mut names: Vec<String> =
            entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
        names.sort();
        for name in names.into_iter().filter(|name| name.ends_with(ENDING)) {
            if named_rows(&name).is_some_and(|rows| !wanted(rows)) {
                continue;
            }
            match self.read_checked(&name) {
                Ok((header, _)) if !files.are_as(&header.files) => {
                    listing.strangers.push((name, "a file that its rows read has changed since".to_owned()));
                }
                Ok((header, _)) => listing.shards.push(Shard { rows: header.start..header.end, name }),
                Err(why) => listing.strangers.push((name, why)),
            }
        }
        listing.shards.sort_by_key(|shard| (shard.rows.start, std::cmp::Reverse(shard.rows.end)));
        listing
    }

    /// Returns the parts of `rows` that the folder lacks, of which only the shards that may hold them are read.
    pub(super) fn lacks(&self, files: &Recorder, rows: &Range<u64>) -> Vec<Range<u64>> {
        self.listed(files, |held| held.start < rows.end && held.end > rows.start).missing(rows.clone())
    }

    /// Returns the rows of a shard, and the digests of the files that they read.
    ///
    /// # Errors
    /// The reason why the file is no sound shard any more.
    pub(super) fn read(&self, shard: &Shard) -> Result<(Vec<Line>, BTreeMap<String, String>), String> {
        let (header, text) = self.read_checked(&shard.name)?;
        let lines: Result<Vec<Line>, _> = text.lines().skip(1).map(serde_json::from_str).collect();
        let lines = lines.map_err(|e| format!("a row can't be read: {e}"))?;
        if lines.len() as u64 != header.end - header.start {
            return Err("it has not as many rows as it says".to_owned());
        }
        Ok((lines, header.files))
    }

    /// Calls `work` with the rows of a listing in order, from the first as far as they follow each other, each once, and returns
    /// the number of the next row, and the digests of the files that they read. Only one shard is in memory at a time.
    ///
    /// # Errors
    /// The reason why a shard is not sound any more, or a failure of `work`.
    pub(super) fn each_row(
        &self,
        listing: &Listing,
        mut work: impl FnMut(u64, Line) -> Result<(), String>,
    ) -> Result<(u64, BTreeMap<String, String>), String> {
        let (mut next, mut files) = (0, BTreeMap::new());
        for shard in &listing.shards {
            if shard.rows.end <= next {
                continue;
            }
            if shard.rows.start > next {
                break;
            }
            let (lines, read) = self.read(shard)?;
            files.extend(read);
            let known = usize::try_from(next - shard.rows.start).unwrap_or(usize::MAX);
            for line in lines.into_iter().skip(known) {
                work(next, line)?;
                next += 1;
            }
        }
        Ok((next, files))
    }

    /// Removes a shard.
    ///
    /// # Errors
    /// A message if the system refuses.
    pub(super) fn remove(&self, shard: &Shard) -> Result<(), String> {
        fs::remove_file(self.folder.join(&shard.name))
            .map_err(|e| format!("`{}` can't be removed: {e}", shard.name))
    }

    /// Returns the header and the sealed text of a file, if it is a shard of this study.
    fn read_checked(&self, name: &str) -> Result<(Header, String), String> {
        let path = self.folder.join(name);
        let size = fs::symlink_metadata(&path).map_err(|e| e.to_string())?;
        if !size.is_file() || size.len() > SHARD_BYTES_MAX {
            return Err("it is no regular file, or too large".to_owned());
        }
        let mut text = fs::read_to_string(path).map_err(|e| e.to_string())?;
        let sealed = text.trim_end_matches('\n').rfind('\n').map_or(0, |at| at + 1);
        let seal = text.split_off(sealed);
        if seal.strip_prefix(SEAL).map(str::trim_end) != Some(digest(text.as_bytes()).as_str()) {
            return Err("it is cut off, or was changed".to_owned());
        }
        let first = text.lines().next().unwrap_or_default();
        let header: Header =
            serde_json::from_str(first).map_err(|_| "it has no header of a shard".to_owned())?;
        if header.modl_study != FORM || header.study != self.study || header.hash != self.hash {
            return Err("it belongs to another study, or to other sources or settings".to_owned());
        }
        if header.start >= header.end {
            return Err("it has no rows".to_owned());
        }
        Ok((header, text))
    }
}

/// Returns the rows that a shard holds by its name; `None` for other names.
fn named_rows(name: &str) -> Option<Range<u64>> {
    let (start, end) = name.strip_suffix(ENDING)?.split_once('-')?;
    Some(start.parse().ok()?..end.parse().ok()?)
}

impl Listing {
    /// Returns the parts of `rows` that no shard holds, in order.
    pub(super) fn missing(&self, rows: Range<u64>) -> Vec<Range<u64>> {
        let mut missing = Vec::new();
        let mut next = rows.start;
        for shard in self.shards.iter().filter(|shard| shard.rows.end > rows.start) {
            if shard.rows.start >= rows.end {
                break;
            }
            if shard.rows.start > next {
                missing.push(next..shard.rows.start);
            }
            next = next.max(shard.rows.end);
        }
        if next < rows.end {
            missing.push(next..rows.end);
        }
        missing
    }
}

fn json(data: &impl Serialize) -> String {
    serde_json::to_string(data).expect("its keys are texts")
}
