//! Programs between the lines of documentation: fences in Markdown and in the comments of programs.

use std::path::{Path, PathBuf};

/// A fenced block. Its tag is what stands behind the three backquotes: `modl`, `modl run`, `text`.
#[derive(Clone, Debug)]
pub struct Fence {
    pub tag: String,
    pub code: String,
    /// File and line of the fence, for messages.
    pub place: String,
}

impl Fence {
    /// What stands behind `modl`; `None` for a fence of something else.
    pub fn modl(&self) -> Option<&str> {
        let rest = self.tag.strip_prefix("modl")?;
        (rest.is_empty() || rest.starts_with(' ')).then(|| rest.trim())
    }
}

/// The fences of a text, in order. `place` names the text.
pub fn fences(text: &str, place: &str) -> Vec<Fence> {
    let mut found: Vec<Fence> = Vec::new();
    let mut open = false;
    for (number, line) in text.lines().enumerate() {
        match line.trim_end().strip_prefix("```") {
            Some(tag) if !open => {
                let place = format!("{place}:{}", number + 1);
                found.push(Fence { tag: tag.to_owned(), code: String::new(), place });
                open = true;
            }
            Some("") => open = false,
            _ if open => {
                let code = &mut found.last_mut().expect("a fence was opened").code;
                code.push_str(line);
                code.push('\n');
            }
            _ => {}
        }
    }
    assert!(!open, "{place}: a fence that is never closed");
    found
}

/// The documentation of a program without its marks, one line for each of the program's.
pub fn documentation(program: &str) -> String {
    let lines = program.lines().map(|line| {
        let line = line.trim_start();
        let text = line.strip_prefix("///").or_else(|| line.strip_prefix("//!")).unwrap_or("");
        text.strip_prefix(' ').unwrap_or(text)
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Name and text of every file in a folder of the repository that ends so, in order of name.
pub fn files(folder: &str, extension: &str) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(&root).unwrap_or_else(|e| panic!("{}: {e}", root.display()));
    let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("a readable folder").path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == extension));
    paths.sort();
    let read = |path: PathBuf| {
        let name = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        (format!("{folder}/{name}"), text)
    };
    paths.into_iter().map(read).collect()
}
