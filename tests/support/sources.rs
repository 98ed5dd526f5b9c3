//! The sources of the repository as the tests of the house read them: files, lines of code, and which file
//! imports which.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every file of the repository with its path from the root, in order.
pub fn files() -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root().to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("the repository can be read") {
            let path: PathBuf = entry.expect("the repository can be read").path();
            let name =
                path.strip_prefix(root()).expect("below the root").to_string_lossy().replace('\\', "/");
            const MADE: &[&str] = &[".git", "target", "out", "fuzz/target", "fuzz/found", "fuzz/artifacts"];
            if MADE.contains(&name.as_str()) {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if path.is_file() {
                found.insert(name, fs::read(&path).expect("the file can be read"));
            }
        }
    }
    found
}

/// The Rust files below a folder, as text.
pub fn rust(folder: &str) -> BTreeMap<String, String> {
    let prefix = format!("{folder}/");
    let chosen = files().into_iter().filter(|(name, _)| name.starts_with(&prefix) && name.ends_with(".rs"));
    chosen.map(|(name, bytes)| (name, String::from_utf8(bytes).expect("Rust is UTF-8"))).collect()
}

/// The lines that are no comments, with their numbers.
pub fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line))
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
}

/// The imports between the files of `src`: each file with the files whose items it names, by `use` or by a
/// path in the code. A name that a `mod.rs` re-exports counts as an import of the file that defines it, and a
/// re-export itself is no import.
pub fn imports() -> BTreeMap<String, BTreeSet<String>> {
    let sources = rust("src");
    let exports: BTreeMap<&String, Vec<(Vec<String>, String)>> =
        sources.iter().map(|(file, text)| (file, re_exports(file, text))).collect();
    let mut graph = BTreeMap::new();
    for (file, text) in &sources {
        let mut found = BTreeSet::new();
        for path in paths(file, text) {
            found.extend(resolve(&path, &sources, &exports, 0).filter(|other| other != file));
        }
        graph.insert(file.clone(), found);
    }
    graph
}

/// Groups of files that import each other, directly or by others: the strongly connected components of
/// [`imports`] that have more than one file, largest first.
pub fn knots() -> Vec<Vec<String>> {
    let graph = imports();
    let reach: BTreeMap<&String, BTreeSet<&String>> =
        graph.keys().map(|file| (file, reached(file, &graph))).collect();
    let mut knots: Vec<Vec<String>> = Vec::new();
    let mut seen = BTreeSet::new();
    for file in graph.keys() {
        if seen.contains(file) {
            continue;
        }
        let knot: Vec<String> =
            reach[file].iter().filter(|o| reach[**o].contains(file)).map(|o| (*o).clone()).collect();
        seen.extend(knot.iter().cloned());
        if knot.len() > 1 {
            knots.push(knot);
        }
    }
    knots.sort_by_key(|knot| std::cmp::Reverse(knot.len()));
    knots
}

/// All files that a file imports, directly or by others.
fn reached<'g>(file: &String, graph: &'g BTreeMap<String, BTreeSet<String>>) -> BTreeSet<&'g String> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&String> = graph[file].iter().collect();
    while let Some(next) = open.pop() {
        if found.insert(next) {
            open.extend(&graph[next]);
        }
    }
    found
}

/// The module path of a file, from the crate's root: `["plan", "verify"]` for `src/plan/verify/mod.rs`.
fn module_of(file: &str) -> Vec<String> {
    let inner = file.trim_start_matches("src/").trim_end_matches(".rs");
    let mut parts: Vec<String> = inner.split('/').map(str::to_owned).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        parts.pop();
    }
    parts
}

/// The file of a module path, if there is one.
fn file_of(module: &[String], sources: &BTreeMap<String, String>) -> Option<String> {
    let joined = module.join("/");
    let names = [format!("src/{joined}.rs"), format!("src/{joined}/mod.rs")];
    names.into_iter().find(|name| sources.contains_key(name))
}

/// The file that defines what a path names: that of its longest prefix that is a module, or, where that is a
/// `mod.rs` that re-exports the next name, the file where it comes from.
fn resolve(
    path: &[String],
    sources: &BTreeMap<String, String>,
    exports: &BTreeMap<&String, Vec<(Vec<String>, String)>>,
    depth: usize,
) -> Option<String> {
    let longest = (1..=path.len()).rev().find(|&n| file_of(&path[..n], sources).is_some())?;
    let file = file_of(&path[..longest], sources)?;
    if let (Some(name), true) = (path.get(longest), depth < 8)
        && let Some((origin, _)) = exports[&file].iter().find(|(_, exported)| exported == name)
    {
        return resolve(origin, sources, exports, depth + 1).or(Some(file));
    }
    Some(file)
}

/// The names that a file re-exports, each with the path that it has where it is defined.
fn re_exports(file: &str, text: &str) -> Vec<(Vec<String>, String)> {
    let uses = statements(text).into_iter().filter(|(public, _)| *public);
    let expanded = uses.flat_map(|(_, tree)| expand(&tree));
    let named = expanded.filter_map(|(path, name)| Some((absolute(file, &path)?, name)));
    named.collect()
}

/// All paths that a file names, from the crate's root; those of re-exports left out.
fn paths(file: &str, text: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for (public, tree) in statements(text) {
        if !public {
            found.extend(expand(&tree).into_iter().filter_map(|(path, _)| absolute(file, &path)));
        }
    }
    let mut in_use = false;
    for (_, line) in code_lines(text) {
        let begins = line
            .trim_start()
            .trim_start_matches("pub ")
            .trim_start_matches("pub(crate) ")
            .starts_with("use ");
        in_use = begins || in_use;
        if !in_use {
            found.extend(inline_paths(line).iter().filter_map(|path| absolute(file, path)));
        }
        in_use = in_use && !line.contains(';');
    }
    found
}

/// Paths within a line of code that begin with `crate`, `super` or `self`.
fn inline_paths(line: &str) -> Vec<Vec<String>> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let words = line.split(|c| !is_part(c));
    let rooted = words.filter(|w| ["crate::", "super::", "self::"].iter().any(|root| w.starts_with(root)));
    rooted.map(|w| w.split("::").map(str::to_owned).collect()).collect()
}

/// The `use` statements of a text, and whether they are public.
fn statements(text: &str) -> Vec<(bool, String)> {
    let code: String = code_lines(text).map(|(_, line)| format!("{line}\n")).collect();
    let mut found = Vec::new();
    let mut rest = code.as_str();
    while let Some(at) = rest.find("use ") {
        let before = rest[..at].rsplit('\n').next().unwrap_or("").trim();
        let after = &rest[at + 4..];
        let end = after.find(';').unwrap_or(after.len());
        if ["", "pub", "pub(crate)", "pub(super)"].contains(&before) {
            found.push((!before.is_empty(), after[..end].split_whitespace().collect::<Vec<_>>().join(" ")));
        }
        rest = &after[end..];
    }
    found
}

/// The paths of a tree of imports, each with the name that it has here.
fn expand(tree: &str) -> Vec<(Vec<String>, String)> {
    let tree = tree.trim();
    if let Some((head, group)) = tree.split_once('{') {
        let head: Vec<String> =
            head.split("::").filter(|p| !p.trim().is_empty()).map(|p| p.trim().to_owned()).collect();
        let inner = group.rsplit_once('}').map_or(group, |(inner, _)| inner);
        let items = split_outside_braces(inner);
        let joined = items.iter().flat_map(|item| expand(item)).map(|(path, name)| {
            let own = path.first().is_some_and(|p| p == "self") && path.len() == 1;
            let full = head.iter().cloned().chain(if own { Vec::new() } else { path }).collect::<Vec<_>>();
            let name = if own { head.last().cloned().unwrap_or_default() } else { name };
            (full, name)
        });
        return joined.collect();
    }
    let (path, alias) = tree.split_once(" as ").map_or((tree, None), |(p, a)| (p, Some(a)));
    let parts: Vec<String> =
        path.split("::").map(|p| p.trim().to_owned()).filter(|p| !p.is_empty()).collect();
    let name = alias.map(str::trim).map(str::to_owned).or(parts.last().cloned()).unwrap_or_default();
    vec![(parts, name)]
}

/// The items of a list between commas that stand in no inner braces.
fn split_outside_braces(list: &str) -> Vec<String> {
    let (mut depth, mut items, mut item) = (0, Vec::new(), String::new());
    for c in list.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            items.push(std::mem::take(&mut item));
        } else {
            item.push(c);
        }
    }
    items.push(item);
    items.into_iter().filter(|item| !item.trim().is_empty()).collect()
}

/// A path as seen from a file, from the crate's root; `None` for other crates.
fn absolute(file: &str, path: &[String]) -> Option<Vec<String>> {
    let mut module = module_of(file);
    let mut rest = path;
    match path.first()?.as_str() {
        "crate" => {
            module.clear();
            rest = &path[1..];
        }
        "super" => {
            while rest.first().is_some_and(|p| p == "super") {
                module.pop();
                rest = &rest[1..];
            }
        }
        "self" => rest = &path[1..],
        // A child of a `mod.rs`, named without `self`; the names of other crates lead to no file.
        _ => {}
    }
    module.extend(rest.iter().cloned());
    Some(module)
}
