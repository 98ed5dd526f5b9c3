//! A plan to be exported, and the files that writers make of it.

use crate::plan::Plan;

/// A plan to be exported.
#[derive(Clone, Copy, Debug)]
pub struct Export<'a> {
    /// The plan; its verdict, if it has one, goes into recordings.
    pub plan: &'a Plan,
    /// The name of the robot.
    pub title: &'a str,
    /// The beginning of the names of the files, without folders.
    pub stem: &'a str,
    /// The width and height of pictures, pixels.
    pub picture_size: (u16, u16),
}

impl<'a> Export<'a> {
    /// Returns the export of a plan of the robot `title` to files whose names begin with `stem`, with pictures of 480 by 320
    /// pixels.
    pub fn new(plan: &'a Plan, title: &'a str, stem: &'a str) -> Export<'a> {
        Export { plan, title, stem, picture_size: (480, 320) }
    }
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportFile {
    /// The name of the file with forward slashes, relative to the folder in which all files of an export are.
    pub name: String,
    /// The contents of the file.
    pub bytes: Vec<u8>,
}

impl ExportFile {
    /// Returns a file of text.
    pub(super) fn text(name: String, text: String) -> ExportFile {
        ExportFile { name, bytes: text.into_bytes() }
    }
}
