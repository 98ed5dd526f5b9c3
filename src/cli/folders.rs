//! The programs in folders that are named on the command line.

use super::CallError;
use super::disk::system_words;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The greatest depth of folders that are searched.
const DEPTH_MAX: usize = 64;

/// A program named on the command line, or found in a folder that is.
#[derive(Debug, Clone)]
pub(super) struct Found {
    /// The path of the file; `-` is standard input.
    pub file: PathBuf,
    /// The folder in which the file was found; `None` for a file that was named itself.
    pub folder: Option<PathBuf>,
}

/// Returns the programs that arguments name, in the order of the arguments: files as they are, and of folders all
/// `.mod` files below them in order of their paths. Hidden folders and files are left out, and links are not followed.
///
/// # Errors
/// A message if a folder can't be read or holds no program.
pub(super) fn programs(arguments: &[PathBuf]) -> Result<Vec<Found>, CallError> {
    let mut found = Vec::new();
    for argument in arguments {
        if argument == Path::new("-") || !argument.is_dir() {
            found.push(Found { file: argument.clone(), folder: None });
            continue;
        }
        let before = found.len();
        collect(argument, argument, 0, &mut found)?;
        if found.len() == before {
            return Err(CallError(format!("the folder `{}` holds no program (`.mod`)", argument.display())));
        }
    }
    Ok(found)
}

/// Collects the programs below `folder`, a folder within `root`.
///
/// # Errors
/// A message if a folder can't be read.
fn collect(root: &Path, folder: &Path, depth: usize, found: &mut Vec<Found>) -> Result<(), CallError> {
    let cannot = |e: io::Error| {
        CallError(format!("the folder `{}` can't be read: {}", folder.display(), system_words(&e)))
    };
    let entries = fs::read_dir(folder).map_err(cannot)?;
    let mut paths =
        entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(cannot)?;
    paths.sort();
    for path in paths {
        match kind(&path) {
            Some(Kind::Folder) if depth < DEPTH_MAX => collect(root, &path, depth + 1, found)?,
            Some(Kind::Program) => {
                // `./a.mod` is `a.mod` to the user.
                let file = path.strip_prefix(".").map(Path::to_owned).unwrap_or(path);
                found.push(Found { file, folder: Some(root.to_owned()) });
            }
            _ => {}
        }
    }
    Ok(())
}

/// A path in a folder that the search goes on with.
enum Kind {
    Folder,
    Program,
}

/// Returns what a path in a folder is; `None` if it is hidden, a link, or anything else.
fn kind(path: &Path) -> Option<Kind> {
    let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    let found = fs::symlink_metadata(path).ok()?.file_type();
    match () {
        () if hidden => None,
        () if found.is_dir() => Some(Kind::Folder),
        () if found.is_file() && path.extension().is_some_and(|e| e == "mod") => Some(Kind::Program),
        () => None,
    }
}
