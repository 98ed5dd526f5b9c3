//! Access to files. The only access by which a program reads: the command line opens it onto a project
//! folder, tests onto a map.

use std::borrow::Cow;
use std::collections::BTreeMap;

/// The reason why a file can't be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReadError {
    /// There is no file of that path.
    NotFound,
    /// The path, or a link on it, leads out of the project.
    Outside,
    /// The file is larger than this limit, in bytes.
    TooLarge(usize),
    /// Another failure, as a message in the words of the operating system.
    Failed(String),
}

/// Read access to the files of a project and of the standard library.
pub trait Files {
    /// Returns the bytes of a project file. `path` is relative to the project root, with forward slashes and without
    /// `.` and `..` (see [`join`]).
    ///
    /// # Errors
    /// The [`ReadError`] for which the file can't be read.
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError>;

    /// Returns the text of a file of the standard library, such as `smores.mod` for `std.smores`; `None` if
    /// there is none.
    fn library(&self, path: &str) -> Option<Cow<'static, str>>;

    /// Returns the names in a folder of the project, sorted, for completion: files, and folders with a slash at
    /// the end. `folder` is relative to the project root, empty for the root. Empty if the folder can't be
    /// read, and by default.
    fn list(&self, _folder: &str) -> Vec<String> {
        Vec::new()
    }
}

/// The files of a project, some with other texts, by their paths.
pub struct Replaced<'a> {
    /// The project.
    pub files: &'a dyn Files,
    /// The texts that stand for those of files.
    pub texts: BTreeMap<String, String>,
}

impl Files for Replaced<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.texts.get(path).map_or_else(|| self.files.read(path), |text| Ok(text.clone().into_bytes()))
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        self.files.library(path)
    }

    fn list(&self, folder: &str) -> Vec<String> {
        self.files.list(folder)
    }
}

/// Returns the path that `path`, as written in the file `from`, has relative to the project root, without `.`
/// and `..`; `None` if it leads out of the root, is absolute, or has a backslash, colon or NUL in it.
pub fn join(from: &str, path: &str) -> Option<String> {
    if path.starts_with('/') || path.contains(['\\', '\0', ':']) {
        return None;
    }
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = folder.split('/').filter(|p| !p.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}
