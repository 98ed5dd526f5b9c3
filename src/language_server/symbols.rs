//! The declarations of whole projects, by their names.

use super::documents::{Documents, Opened};
use crate::source::FileId;
use crate::syntax::ast::{ConfigClauseKind, ItemKind};
use crate::syntax::parse;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The most programs of a project that are read.
const FILES_MAX: usize = 1_000;
/// The greatest depth of folders of a project that are looked into.
const DEPTH_MAX: usize = 8;
/// The most declarations that are listed.
const FOUND_MAX: usize = 500;

/// A declaration of a project.
pub(super) struct Found {
    /// The name that is declared.
    pub name: String,
    /// The keyword that declares it, as far as it matters for its kind: `fn`, `let`, `record`, `config`, `behavior`.
    pub word: &'static str,
    /// The declaration around it; `None` at the top of a file.
    pub around: Option<String>,
    /// The path of its file: absolute.
    pub path: PathBuf,
    /// The text of the file.
    pub text: Arc<str>,
    /// The range of the name, bytes.
    pub named: Range<usize>,
}

/// Returns the declarations of the projects of all open documents whose names contain the letters of `wanted` in their order,
/// in the order of projects and files. The texts are those of the documents, and of files for others.
pub(super) fn of_projects(documents: &Documents, wanted: &str) -> Vec<Found> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    let projects = documents.all().filter_map(|document| document.project.as_ref());
    for project in projects {
        let mut names = vec![project.name.clone()];
        programs(project, "", 0, &mut names);
        for name in names {
            let path = project.root.join(&name);
            if found.len() < FOUND_MAX && seen.insert(path.clone()) {
                let open = documents.all().find(|document| document.path == path);
                let read = || Some(Arc::from(String::from_utf8(project.files.read(&name).ok()?).ok()?));
                if let Some(text) = open.map(|document| document.text.clone()).or_else(read) {
                    declared(&path, &text, wanted, &mut found);
                }
            }
        }
    }
    found.truncate(FOUND_MAX);
    found
}

/// Adds the names of the programs in a folder of a project and in the folders below it.
fn programs(project: &Opened, folder: &str, depth: usize, names: &mut Vec<String>) {
    for entry in project.files.list(folder) {
        let path = if folder.is_empty() { entry } else { format!("{folder}/{entry}") };
        match path.strip_suffix('/') {
            Some(below) if depth < DEPTH_MAX => programs(project, below, depth + 1, names),
            None if path.ends_with(".mod") && names.len() < FILES_MAX => names.push(path),
            _ => {}
        }
    }
}

/// Adds the declarations of a file whose names fit, with the behaviours of its configurations.
fn declared(path: &Path, text: &Arc<str>, wanted: &str, found: &mut Vec<Found>) {
    let mut add = |name: crate::syntax::ast::Name, word: &'static str, around: Option<String>| {
        if fits(name.text.as_str(), wanted) {
            let (name, named) = (name.text.to_string(), name.span.range());
            found.push(Found { name, word, around, path: path.to_owned(), text: text.clone(), named });
        }
    };
    for item in &parse(FileId(0), text).file.items {
        let Some(name) = item.kind.name() else { continue };
        let word = match &item.kind {
            ItemKind::Fn(_) | ItemKind::ExternFn(_) => "fn",
            ItemKind::Let(_) => "let",
            ItemKind::Record(_) | ItemKind::ExternType(_) => "record",
            ItemKind::Connector(_) => "connector",
            _ => "config",
        };
        add(name, word, None);
        if let ItemKind::Config(config) = &item.kind {
            for clause in &config.clauses {
                if let ConfigClauseKind::Behavior(behavior) = &clause.kind {
                    add(behavior.name, "behavior", Some(name.text.to_string()));
                }
            }
        }
    }
}

/// Returns true if a name contains the letters of `wanted` in their order, in upper or lower case.
fn fits(name: &str, wanted: &str) -> bool {
    let mut letters = name.chars().flat_map(char::to_lowercase);
    wanted.chars().flat_map(char::to_lowercase).all(|letter| letters.any(|other| other == letter))
}
