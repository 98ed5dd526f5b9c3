//! The output folder: whole files are written below it, and nothing else.

use super::disk::system_words;
use crate::interpret::WriteError;
use crate::source::files::join;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::{NamedTempFile, TempDir};

/// The prefix of temporary files.
const PREFIX: &str = ".modl-tmp-";

/// Writes `bytes` to `path`, relative to `folder` and with forward slashes, making folders as needed, and returns the
/// path to show. The file appears whole or not at all: it is written under a temporary name in the same folder, then
/// moved.
///
/// # Errors
/// A [`WriteError`] if the path leads out of the folder, or the operating system refuses.
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

/// Writes `bytes` to `path` below `folder` as [`write`] does, unless a file with these bytes is there already. Returns
/// true if it was written.
///
/// # Errors
/// A [`WriteError`] if the path leads out of the folder, or the operating system refuses.
pub(super) fn write_changed(folder: &Path, path: &str, bytes: &[u8]) -> Result<bool, WriteError> {
    let there = folder.join(path);
    let found = fs::symlink_metadata(&there);
    if found.is_ok_and(|found| found.is_file() && found.len() == bytes.len() as u64)
        && fs::read(&there).is_ok_and(|found| found == bytes)
    {
        return Ok(false);
    }
    write(folder, path, bytes).map(|_| true)
}

/// The outcome of removing a file.
pub(super) enum Removed {
    /// It is gone.
    Yes,
    /// It is not as it was written, or no regular file below the folder, and was left.
    Left,
    /// There was none.
    Absent,
}

/// Removes the file `path` below `folder` if `as_written` returns true for its bytes, and then the folders that this
/// leaves empty. Links are not followed.
///
/// # Errors
/// A [`WriteError`] if the operating system refuses.
pub(super) fn remove(
    folder: &Path,
    path: &str,
    as_written: impl Fn(&[u8]) -> bool,
) -> Result<Removed, WriteError> {
    let Ok(root) = fs::canonicalize(folder) else { return Ok(Removed::Absent) };
    let target = root.join(path);
    match fs::symlink_metadata(&target) {
        Err(_) => return Ok(Removed::Absent),
        Ok(found) if !found.is_file() => return Ok(Removed::Left),
        Ok(_) => {}
    }
    let parent = target.parent().unwrap_or(&root);
    let direct = fs::canonicalize(parent).is_ok_and(|real| real == parent) && parent.starts_with(&root);
    if !direct || !fs::read(&target).is_ok_and(|bytes| as_written(&bytes)) {
        return Ok(Removed::Left);
    }
    fs::remove_file(&target).map_err(failed)?;
    let within = parent.ancestors().take_while(|folder| *folder != root);
    // A folder that is not empty is not removed.
    let _ = within.map(fs::remove_dir).take_while(Result::is_ok).count();
    Ok(Removed::Yes)
}

/// Replaces the contents of an existing file, following links; whole or not at all. Its permissions are kept.
///
/// # Errors
/// The operating system's error; a missing permission for a read-only file.
pub(super) fn replace(file: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = fs::canonicalize(file)?;
    let found = fs::metadata(&target)?;
    if found.permissions().readonly() {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    let parent = target.parent().unwrap_or(Path::new("."));
    let mut file = begun(parent)?;
    file.as_file().set_permissions(found.permissions())?;
    file.write_all(bytes)?;
    persisted(file, &target)
}

/// Writes files into the folder `name` below `folder`, which appears with all of them or not at all: they are written into
/// a temporary folder beside it, which is then renamed. A folder of that name is replaced if `is_former` returns true for
/// it, or if it is empty. Returns the path of the folder to show. `files`: names relative to the folder with forward
/// slashes, and contents.
///
/// # Errors
/// A [`WriteError`] if the name is no name of a folder, a file would lie outside of it, other files are there, or the
/// operating system refuses.
pub(super) fn write_folder<'f>(
    folder: &Path,
    name: &str,
    files: impl Iterator<Item = (&'f str, &'f [u8])>,
    is_former: impl Fn(&Path) -> bool,
) -> Result<String, WriteError> {
    if join("", name).is_none_or(|path| path != name || name.contains('/') || name.is_empty()) {
        return Err(WriteError::Outside);
    }
    fs::create_dir_all(folder).map_err(failed)?;
    let root = fs::canonicalize(folder).map_err(failed)?;
    let target = root.join(name);
    let there = match fs::symlink_metadata(&target) {
        Err(_) => false,
        Ok(found) if !found.is_dir() => {
            return Err(WriteError::Failed("a file has this name".to_owned()));
        }
        Ok(_) => {
            let empty = fs::read_dir(&target).map_err(failed)?.next().is_none();
            if !empty && !is_former(&target) {
                return Err(WriteError::Failed("a folder of this name holds other files".to_owned()));
            }
            true
        }
    };
    sweep(&root);
    let (made, _lock) = begun_folder(&root).map_err(failed)?;
    for (path, bytes) in files {
        write(made.path(), path, bytes)?;
    }
    if there {
        // Nobody sees a mixture: the former folder, none for an instant, or the new one.
        let (old, _lock) = begun_folder(&root).map_err(failed)?;
        let aside = old.path().join(name);
        fs::rename(&target, &aside).map_err(failed)?;
        if let Err(e) = fs::rename(made.path(), &target) {
            fs::rename(&aside, &target).map_err(failed)?;
            return Err(failed(e));
        }
    } else {
        fs::rename(made.path(), &target).map_err(failed)?;
    }
    // It has its name now, and must not be removed.
    let _ = made.keep();
    sync_folder(&root).map_err(failed)?;
    Ok(folder.join(name).to_string_lossy().into_owned())
}

/// Returns the real parent folder of a path below `root`, making missing folders.
///
/// # Errors
/// A link leads out of the root, or the system refuses.
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

/// Refuses a path that is a folder, or a link that leads out of `root`. The link would be replaced and not
/// followed, but someone has put it there on purpose.
///
/// # Errors
/// The reason of the refusal.
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

/// Writes a file under a temporary name in `parent`, and renames it to `target`.
///
/// # Errors
/// The failure of the system; the file is then as it was, or whole.
fn persist(parent: &Path, target: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = begun(parent)?;
    file.write_all(bytes)?;
    persisted(file, target)
}

/// Begins a file under a temporary name in a folder, to be written piece by piece and then [`persisted`].
///
/// # Errors
/// The failure of the system.
pub(super) fn begun(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    sweep(folder);
    made(|| builder.tempfile_in(folder), |file| is_kept(file.as_file(), file.path()))
}

/// Begins a folder under a temporary name in another one. Returns it with what holds the lock on it; `None` where the system
/// does not open folders.
///
/// # Errors
/// The failure of the system.
fn begun_folder(root: &Path) -> io::Result<(TempDir, Option<File>)> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    let make = || {
        let folder = builder.tempdir_in(root)?;
        let lock = File::open(folder.path()).ok();
        Ok((folder, lock))
    };
    made(make, |(folder, lock)| {
        lock.as_ref().map_or(folder.path().exists(), |lock| is_kept(lock, folder.path()))
    })
}

/// Makes something under a temporary name, anew until it is kept.
///
/// # Errors
/// The failure of the system.
fn made<T>(make: impl Fn() -> io::Result<T>, is_kept: impl Fn(&T) -> bool) -> io::Result<T> {
    let mut made = make()?;
    for _ in 0..BEGINNINGS_MAX {
        if is_kept(&made) {
            break;
        }
        made = make()?;
    }
    Ok(made)
}

/// The times that a file or folder is made anew because another process took it for one that was left behind.
const BEGINNINGS_MAX: usize = 8;

/// Locks what was just made under a temporary name. Returns false if another process, which found it before it was locked,
/// removes it. That can happen later, too, where there are no locks: it can then not be renamed.
fn is_kept(made: &File, path: &Path) -> bool {
    !matches!(made.try_lock(), Err(fs::TryLockError::WouldBlock)) && path.exists()
}

/// Returns a lock on a folder, which is freed when it is dropped; `None` where the system has none.
fn locked(folder: &Path) -> Option<File> {
    let folder = File::open(folder).ok()?;
    folder.try_lock().ok().map(|()| folder)
}

/// Removes temporary files and folders that processes left in a folder when they were killed: those that nobody has
/// locked. A failure is of no consequence but that they stay. A folder is looked at once in the life of a process.
fn sweep(folder: &Path) {
    static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    if !SWEPT.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
        return;
    }
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(PREFIX)) {
        let (path, Ok(kind)) = (entry.path(), entry.file_type()) else { continue };
        // Links and pipes are nothing that was begun here.
        if !kind.is_file() && !kind.is_dir() {
            continue;
        }
        // The lock is held until it is removed: whoever has just made it would otherwise lock it meanwhile, and keep it.
        let Some(_lock) = locked(&path) else { continue };
        drop(if kind.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) });
    }
}

/// Renames a file that was [`begun`]. Bytes and name are on the disk when it returns: after a failure of the machine the
/// file is whole, or as it was.
///
/// # Errors
/// The failure of the system.
pub(super) fn persisted(file: NamedTempFile, target: &Path) -> io::Result<()> {
    file.as_file().sync_all()?;
    file.persist(target).map_err(|e| e.error)?;
    sync_folder(target.parent().unwrap_or(Path::new(".")))
}

/// Waits until the entries of a folder are on the disk. File systems that know no such thing are not waited for.
///
/// # Errors
/// The failure of the system.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder)?.sync_all() {
        Err(e) if matches!(e.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
        synced => synced,
    }
}

/// Does nothing: elsewhere a folder can't be opened as a file.
#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

fn failed(e: io::Error) -> WriteError {
    WriteError::Failed(system_words(&e))
}
