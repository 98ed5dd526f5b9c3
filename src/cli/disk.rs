//! The project on disk: access to the files below one folder, and nothing else.

use super::CallError;
use super::watched::Watched;
use crate::source::files::join;
use crate::source::{Files, ReadError, library};
use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// The greatest size of a project file, in bytes: 64 MiB. A larger one is refused.
pub(super) const FILE_BYTES_MAX: usize = 64 << 20;

/// The most files of a folder that are offered for completion.
const LISTED_MAX: usize = 10_000;

/// The name of a program from standard input.
pub(super) const STDIN_NAME: &str = "<stdin>";

/// A project folder with the program named on the command line.
#[derive(Debug)]
pub(super) struct Project {
    /// The root: absolute, without links.
    root: PathBuf,
    /// The folder that replaces the embedded library, absolute, without links; `None` for the embedded one.
    stdlib: Option<PathBuf>,
    /// The program's name relative to the root; empty without a program.
    pub name: String,
    bytes: Vec<u8>,
    /// The root folder as the user would name it; empty for the working folder.
    pub folder: String,
    /// The record of files that are read or searched, for `modl watch`; `None` for other commands.
    pub watched: Option<Arc<Watched>>,
}

impl Project {
    /// Returns a folder as a project without a program; the working folder for `None`.
    ///
    /// # Errors
    /// A message if there is no such folder, or `stdlib` is none.
    pub(super) fn of_folder(root: Option<&Path>, stdlib: Option<&Path>) -> Result<Project, CallError> {
        let root = root.unwrap_or(Path::new("."));
        Ok(Project {
            root: folder(root)?,
            stdlib: stdlib.map(folder).transpose()?,
            name: String::new(),
            bytes: Vec::new(),
            folder: shown_folder(root),
            watched: None,
        })
    }

    /// Returns the root of the project: absolute, without links.
    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// Returns the path of an existing folder or file relative to the project's root; `None` if it is not below the
    /// root.
    pub(super) fn path_below(&self, path: &Path) -> Option<String> {
        relative_name(fs::canonicalize(path).ok()?.strip_prefix(&self.root).ok()?)
    }

    /// Returns the same project without the text of its program, so that its file is read again when needed.
    pub(super) fn unread(self) -> Project {
        Project { name: String::new(), bytes: Vec::new(), ..self }
    }

    /// Opens the project of `file` and reads that file; `-` reads standard input. The root is the folder of the file
    /// (after links), or `root`.
    ///
    /// # Errors
    /// A message if the file can't be read, is too large, is a folder or is outside of the root, or if `root` or
    /// `stdlib` is not a folder.
    pub(super) fn open(
        file: &Path,
        root: Option<&Path>,
        stdlib: Option<&Path>,
    ) -> Result<Project, CallError> {
        let stdlib = stdlib.map(folder).transpose()?;
        if file == Path::new("-") {
            let root = root.unwrap_or(Path::new("."));
            let bytes = read_at_most(io::stdin().lock(), FILE_BYTES_MAX)
                .map_err(|e| CallError(format!("standard input {e}")))?;
            let name = STDIN_NAME.to_owned();
            return Ok(Project {
                root: folder(root)?,
                stdlib,
                name,
                bytes,
                folder: shown_folder(root),
                watched: None,
            });
        }
        let cannot = |e: ReadFault| CallError(format!("the file `{}` {e}", file.display()));
        let path = fs::canonicalize(file).map_err(|e| cannot(e.into()))?;
        if path.is_dir() {
            return Err(CallError(format!("`{}` is a folder; name one of its programs", file.display())));
        }
        let bytes = read_regular(&path, FILE_BYTES_MAX).map_err(cannot)?;
        let own = path.parent().ok_or_else(|| CallError(format!("`{}` is a folder", file.display())))?;
        let shown = root.or(file.parent()).unwrap_or(Path::new(""));
        let root = root.map_or_else(|| Ok(own.to_owned()), folder)?;
        let inside = path.strip_prefix(&root).map_err(|_| {
            CallError(format!("the file `{}` lies outside the project `{}`", file.display(), root.display()))
        })?;
        let name = relative_name(inside)
            .ok_or_else(|| CallError(format!("the path of `{}` is not UTF-8", file.display())))?;
        // If a link leads elsewhere, only the real folder shows the user where the file is.
        let there = fs::canonicalize(if shown == Path::new("") { Path::new(".") } else { shown });
        let folder = if there.is_ok_and(|there| there == root) { shown } else { &root };
        Ok(Project { folder: shown_folder(folder), root, stdlib, name, bytes, watched: None })
    }
}

impl Files for Project {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        if path == self.name {
            return Ok(self.bytes.clone());
        }
        if let Some(watched) = &self.watched {
            watched.note(&self.root.join(path));
        }
        read_below(&self.root, path)
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        let Some(folder) = &self.stdlib else {
            return library::text(path).map(Cow::Borrowed);
        };
        if let Some(watched) = &self.watched {
            watched.note(&folder.join(path));
        }
        let bytes = read_below(folder, path).ok()?;
        String::from_utf8(bytes).ok().map(Cow::Owned)
    }

    fn list(&self, path: &str) -> Vec<String> {
        let Some(folder) = join("", path).map(|path| self.root.join(path)) else { return Vec::new() };
        let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
        let named = entries.flatten().filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let is_folder = entry.file_type().ok()?.is_dir();
            let shown = if is_folder { format!("{name}/") } else { name };
            (!shown.starts_with('.') && (is_folder || shown.contains('.'))).then_some(shown)
        });
        let mut names: Vec<String> = named.take(LISTED_MAX).collect();
        names.sort();
        names
    }
}

/// Returns the bytes of a file below `root`. Links may lead anywhere inside of the root.
///
/// # Errors
/// The reason why it can't be read.
fn read_below(root: &Path, path: &str) -> Result<Vec<u8>, ReadError> {
    let relative = Path::new(path);
    if !relative.components().all(|c| matches!(c, Component::Normal(_))) {
        return Err(ReadError::Outside);
    }
    let real = fs::canonicalize(root.join(relative)).map_err(|e| read_error(e.into()))?;
    if !real.starts_with(root) {
        return Err(ReadError::Outside);
    }
    read_regular(&real, FILE_BYTES_MAX).map_err(read_error)
}

fn read_error(fault: ReadFault) -> ReadError {
    match fault {
        ReadFault::TooLarge(limit) => ReadError::TooLarge(limit),
        ReadFault::Irregular => ReadError::Failed("it is no regular file".to_owned()),
        ReadFault::System(e) if e.kind() == io::ErrorKind::NotFound => ReadError::NotFound,
        ReadFault::System(e) => ReadError::Failed(system_words(&e)),
    }
}

/// The reason why bytes can't be read; as text it continues the message "the file `x` ...".
#[derive(Debug)]
pub(super) enum ReadFault {
    /// Larger than this many bytes.
    TooLarge(usize),
    /// A folder, pipe or device.
    Irregular,
    /// A failure of the system.
    System(io::Error),
}

impl From<io::Error> for ReadFault {
    fn from(e: io::Error) -> ReadFault {
        ReadFault::System(e)
    }
}

impl std::fmt::Display for ReadFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            ReadFault::TooLarge(limit) => write!(f, "is larger than {} MiB", limit >> 20),
            ReadFault::Irregular => {
                f.write_str("is no regular file; to read a pipe, use `-` and redirect it")
            }
            ReadFault::System(e) if e.kind() == io::ErrorKind::NotFound => f.write_str("does not exist"),
            ReadFault::System(e) => write!(f, "cannot be read: {}", system_words(e)),
        }
    }
}

/// Returns the bytes of a regular file. Others are not opened: opening a pipe would wait for a writer.
///
/// # Errors
/// The reason why it can't be read.
fn read_regular(path: &Path, bytes_max: usize) -> Result<Vec<u8>, ReadFault> {
    let found = fs::metadata(path)?;
    if !found.is_file() {
        return Err(ReadFault::Irregular);
    }
    if found.len() > bytes_max as u64 {
        return Err(ReadFault::TooLarge(bytes_max));
    }
    read_at_most(File::open(path)?, bytes_max)
}

/// Returns the bytes of a file named by the user, at most `bytes_max` of them; `-` is standard input.
///
/// # Errors
/// A message if the file can't be read or is larger.
pub(super) fn read(file: &Path, bytes_max: usize) -> Result<Vec<u8>, CallError> {
    let bytes = if file == Path::new("-") {
        read_at_most(io::stdin().lock(), bytes_max)
    } else {
        read_regular(file, bytes_max)
    };
    bytes.map_err(|fault| CallError(format!("the file `{}` {fault}", file.display())))
}

/// Returns the bytes of a stream, at most `bytes_max`. A file may be longer than its stated size.
///
/// # Errors
/// The reason why it can't be read.
fn read_at_most(stream: impl Read, bytes_max: usize) -> Result<Vec<u8>, ReadFault> {
    let mut bytes = Vec::new();
    stream.take(bytes_max as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > bytes_max { Err(ReadFault::TooLarge(bytes_max)) } else { Ok(bytes) }
}

/// Returns the system's message without the error number that Rust appends.
pub(super) fn system_words(e: &io::Error) -> String {
    let text = e.to_string();
    text.split(" (os error").next().unwrap_or(&text).to_owned()
}

/// Returns the real path of a folder named by the user, without links.
///
/// # Errors
/// A message if there is no such folder.
fn folder(path: &Path) -> Result<PathBuf, CallError> {
    let real = fs::canonicalize(path).map_err(|e| ReadFault::from(e).to_string());
    let real = real.map_err(|e| CallError(format!("the folder `{}` {e}", path.display())))?;
    if real.is_dir() { Ok(real) } else { Err(CallError(format!("`{}` is no folder", path.display()))) }
}

/// Returns a relative path with forward slashes; `None` if it is not UTF-8.
fn relative_name(path: &Path) -> Option<String> {
    let parts: Option<Vec<&str>> = path.components().map(|c| c.as_os_str().to_str()).collect();
    parts.map(|parts| parts.join("/"))
}

/// Returns a folder as the user would name it; empty for the working folder.
fn shown_folder(path: &Path) -> String {
    let shown = path.to_string_lossy().into_owned();
    if shown == "." { String::new() } else { shown }
}
