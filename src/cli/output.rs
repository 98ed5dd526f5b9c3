//! The output folder: whole files below it, and nothing else.

use super::disk::system_words;
use crate::interpret::WriteError;
use crate::source::files::join;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// How the names of files begin that are not whole yet.
const PREFIX: &str = ".modl-";

/// Writes `bytes` to `path` below `folder`, making folders as needed. The file appears whole or not
/// at all: it is written under another name beside its place, then moved. Gives the path to show.
pub(super) fn write(folder: &Path, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
    let path = join("", path).ok_or(WriteError::Outside)?;
    let relative = Path::new(&path);
    let Some(name) = relative.file_name() else {
        return Err(WriteError::Failed("the path names no file".to_owned()));
    };
    fs::create_dir_all(folder).map_err(failed)?;
    let root = fs::canonicalize(folder).map_err(failed)?;
    let parent = parent_below(&root, relative.parent().unwrap_or(Path::new("")))?;
    let target = parent.join(name);
    refuse_link_out(&root, &target)?;
    persist(&parent, &target, bytes).map_err(failed)?;
    Ok(folder.join(relative).to_string_lossy().into_owned())
}

/// Puts other bytes into a file that is there, wherever links lead; whole or not at all. Who may read
/// it stays as it was.
pub(super) fn replace(file: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = fs::canonicalize(file)?;
    let found = fs::metadata(&target)?;
    if found.permissions().readonly() {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    let parent = target.parent().unwrap_or(Path::new("."));
    let file = tempfile::Builder::new().prefix(PREFIX).tempfile_in(parent)?;
    file.as_file().set_permissions(found.permissions())?;
    filled(file, &target, bytes)
}

/// Steps down folder by folder, making the missing ones. A link may lead about, but not out.
fn parent_below(root: &Path, relative: &Path) -> Result<PathBuf, WriteError> {
    let mut parent = root.to_owned();
    for part in relative.components() {
        parent.push(part);
        match fs::create_dir(&parent) {
            Err(e) if e.kind() != io::ErrorKind::AlreadyExists => return Err(failed(e)),
            _ => {}
        }
        parent = fs::canonicalize(&parent).map_err(failed)?;
        if !parent.starts_with(root) {
            return Err(WriteError::Outside);
        }
    }
    Ok(parent)
}

/// A link at the file's own place would be replaced, not followed; one that leads out is refused
/// all the same, since someone meant something by it.
fn refuse_link_out(root: &Path, target: &Path) -> Result<(), WriteError> {
    match fs::symlink_metadata(target) {
        Ok(found) if found.is_dir() => Err(WriteError::Failed("a folder has this name".to_owned())),
        Ok(found) if found.is_symlink() => match fs::canonicalize(target) {
            Ok(real) if real.starts_with(root) => Ok(()),
            _ => Err(WriteError::Outside),
        },
        _ => Ok(()),
    }
}

fn persist(parent: &Path, target: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    filled(builder.tempfile_in(parent)?, target, bytes)
}

fn filled(mut file: NamedTempFile, target: &Path, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.persist(target).map(drop).map_err(|e| e.error)
}

fn failed(e: io::Error) -> WriteError {
    WriteError::Failed(system_words(&e))
}
