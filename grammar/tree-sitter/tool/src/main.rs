//! Generates the tree-sitter parser of modl, and says which programs it parses.
//!
//! `generate` writes `src/parser.c` and what belongs to it, from `grammar.js`, by Node.js. `parse FOLDER` parses every `.mod`
//! file of a folder and prints a line for each: `name ok`, or `name LINE:COLUMN` of its first error; lines and columns from 1.
//! `classes FOLDER` prints instead what the queries make of each: a line `name FROM TO CAPTURE` for each capture, in bytes.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use tree_sitter_generate::{OptLevel, generate_parser_in_directory};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["generate"] => generate(),
        ["parse", folder] => each(Path::new(folder), parse::errors),
        ["classes", folder] => each(Path::new(folder), parse::classes),
        _ => Err("one of: generate, parse FOLDER, classes FOLDER".to_owned()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// The folder of the grammar.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn generate() -> Result<(), String> {
    let (root, mut found) = (root(), Vec::new());
    let grammar = Some(root.join("grammar.js"));
    let made = generate_parser_in_directory(
        root,
        None::<PathBuf>,
        grammar,
        tree_sitter::LANGUAGE_VERSION,
        None,
        Some("node"),
        true,
        OptLevel::default(),
        &mut found,
    );
    found.iter().for_each(|said| eprintln!("{said:?}"));
    made.map_err(|why| format!("{why}"))
}

/// Prints what is found of every program of a folder, in order of name.
fn each(folder: &Path, found: fn(&str) -> Vec<String>) -> Result<(), String> {
    let failed = |why: std::io::Error| format!("{}: {why}", folder.display());
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).map_err(failed)?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "mod"));
    files.sort();
    let mut said = String::new();
    for file in files {
        let text = std::fs::read_to_string(&file).map_err(failed)?;
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        for line in found(&text) {
            said += &format!("{name} {line}\n");
        }
    }
    print!("{said}");
    Ok(())
}

#[cfg(parser)]
mod parse {
    use tree_sitter::{Language, Node, Parser, Query, QueryCursor, StreamingIterator as _, Tree};

    unsafe extern "C" {
        fn tree_sitter_modl() -> *const ();
    }

    const HIGHLIGHTS: &str = include_str!("../../queries/highlights.scm");

    fn language() -> Language {
        // SAFETY: the parser that `generate` wrote has this function.
        unsafe { tree_sitter_language::LanguageFn::from_raw(tree_sitter_modl) }.into()
    }

    fn tree(text: &str) -> Tree {
        let mut parser = Parser::new();
        parser.set_language(&language()).expect("the parser is of this version");
        parser.parse(text, None).expect("a language is set")
    }

    /// Returns `ok`, or the place of the first error.
    pub(super) fn errors(text: &str) -> Vec<String> {
        let tree = tree(text);
        let first = first_error(tree.root_node());
        let place = |node: Node| format!("{}:{}", node.start_position().row + 1, node.start_position().column + 1);
        vec![first.map_or_else(|| "ok".to_owned(), place)]
    }

    fn first_error(node: Node) -> Option<Node> {
        if node.is_error() || node.is_missing() {
            return Some(node);
        }
        let mut cursor = node.walk();
        let children: Vec<Node> = node.children(&mut cursor).filter(Node::has_error).collect();
        children.into_iter().find_map(first_error)
    }

    /// Returns `FROM TO CAPTURE` of each capture of the queries; of those of one node the last.
    pub(super) fn classes(text: &str) -> Vec<String> {
        let tree = tree(text);
        let query = Query::new(&language(), HIGHLIGHTS).expect("the queries are of this grammar");
        let mut cursor = QueryCursor::new();
        let mut captures = cursor.captures(&query, tree.root_node(), text.as_bytes());
        let mut found: Vec<(usize, usize, String)> = Vec::new();
        while let Some((matched, index)) = captures.next() {
            let capture = matched.captures[*index];
            let name = query.capture_names()[capture.index as usize].to_owned();
            let (from, to) = (capture.node.start_byte(), capture.node.end_byte());
            found.retain(|(other, end, _)| (*other, *end) != (from, to));
            found.push((from, to, name));
        }
        found.into_iter().map(|(from, to, name)| format!("{from} {to} {name}")).collect()
    }
}

#[cfg(not(parser))]
mod parse {
    pub(super) fn errors(_: &str) -> Vec<String> {
        vec!["no parser: `generate` writes it".to_owned()]
    }

    pub(super) fn classes(text: &str) -> Vec<String> {
        errors(text)
    }
}
