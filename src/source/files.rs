//! Where texts come from. The only window through which a program reads: `main` opens it onto a
//! project folder, tests onto a map.

use std::borrow::Cow;

/// Why a file can't be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReadError {
    NotFound,
    /// The path, or a link on it, leads out of the project.
    Outside,
    /// Larger than this many bytes.
    TooLarge(usize),
    /// Anything else, in the system's words.
    Failed(String),
}

/// Texts by name.
pub trait Files {
    /// The bytes of a project file. `path` is relative to the project root, has forward slashes and
    /// no `.` or `..` (see [`join`]).
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError>;

    /// A file of the standard library, such as `smores.mod` for `std.smores`.
    fn library(&self, path: &str) -> Option<Cow<'static, str>>;

    /// What lies in a folder of the project, for those who look for a name: files, and folders with a
    /// slash at the end. In order.
    fn list(&self, _folder: &str) -> Vec<String> {
        Vec::new()
    }
}

/// `path` as written in the file `from`, relative to the project root; `None` when it leads out of
/// the root or is absolute.
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
