//! Loading: reads the file to check and everything that it imports, and finds import cycles.

use crate::source::files::join;
use crate::source::library;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, FileId, Files, ReadError, Sources, Span, Symbol, code};
use crate::syntax::{self, ast};
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

/// A parsed file with its imports.
pub(super) struct LoadedFile {
    /// The syntax tree of the file.
    pub ast: Arc<ast::File>,
    /// The names that the file imports, in the order of the text.
    pub imports: Vec<Import>,
    /// True if the file is an entry of a session: all entries have one scope.
    pub entry: bool,
    /// The name of the declaration that `_` stands for in an entry: the value of the last expression before it. `None`
    /// in files, and if there is no such value.
    pub last: Option<Symbol>,
}

/// A name that a `use` brings into a file.
#[derive(Clone, Copy)]
pub(super) struct Import {
    /// The name that the import gets in the importing file.
    pub name: Symbol,
    /// The span of the name in the `use` clause.
    pub span: Span,
    /// The file or the declaration that the import stands for.
    pub target: ImportTarget,
}

/// The target of an import: a file, or one item of a file.
#[derive(Clone, Copy)]
pub(super) enum ImportTarget {
    /// Everything in a file, by `name.item`: an index into [`Loaded::files`].
    File(usize),
    /// One item of a file, as in `use gaits.{wave}`.
    Item {
        /// The file that declares the item, as an index into [`Loaded::files`].
        file: usize,
        /// The name of the item in that file.
        item: Symbol,
        /// The span of the item's name in the `use` clause.
        span: Span,
    },
    /// A failed import that has been reported.
    Error,
}

/// Calls of built-in functions whose results are made of what a file of the library declares, with that file.
const NEEDED: &[(&str, &str)] = &[("load(", "rofi.mod")];

/// The greatest number of files that import each other in a chain, the program included; loading follows the chain by
/// recursion.
pub const IMPORT_DEPTH_MAX: usize = 100;

/// A syntax tree with the diagnostics of its text.
type Tree = (Arc<ast::File>, Vec<Diagnostic>);

/// The trees of texts that stay in memory, which are those of the library: every program needs the prelude, and a program
/// that is edited is checked again and again. Keys are the identity of the
/// file, which stands in the tree, and the place and length of the text.
static TREES: Mutex<BTreeMap<(u32, usize, usize), Tree>> = Mutex::new(BTreeMap::new());

/// The files whose trees are kept are the first of a program, so that those kept are few.
const KEPT_FILES: u32 = 8;

/// Returns the syntax tree of a text, and what is wrong in it. `stays`: true if the text stays where it is in memory.
fn tree(id: FileId, text: &str, stays: bool) -> Tree {
    let parse = || {
        let parsed = syntax::parse(id, text);
        (Arc::new(parsed.file), parsed.diagnostics)
    };
    if !stays || id.0 >= KEPT_FILES || text.is_empty() {
        return parse();
    }
    let mut trees = TREES.lock().unwrap_or_else(PoisonError::into_inner);
    trees.entry((id.0, text.as_ptr().addr(), text.len())).or_insert_with(parse).clone()
}

/// All files of a program. The prelude is at 0 and the file to run at 1, if they could be read. In a
/// session the file to run is the newest entry, and an entry never changes the indices of those before it.
#[derive(Default)]
pub(super) struct Loaded {
    /// The files read so far; the index of a file here, from 0, stands for it elsewhere.
    pub files: Vec<LoadedFile>,
    /// The index of the file to run; `None` if it could not be read.
    pub root: Option<usize>,
    /// The index of the prelude; `None` if it could not be read.
    pub prelude: Option<usize>,
}

/// An entry of a session: the text entered at one time.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The name of the entry in diagnostics.
    pub name: String,
    /// The text of the entry, as the user typed it.
    pub text: String,
    /// The line, from 1, of a longer input at which the entry begins; 1 if it is the whole input.
    pub first_line: usize,
    /// The name under which the value of the entry's last expression is declared; `None` if the value is not
    /// declared.
    pub value: Option<Symbol>,
    /// The name of the declaration that `_` stands for in the entry; `None` if there is no value before the entry.
    pub last: Option<Symbol>,
}

/// The state of loading: the files read so far, those being read, and the diagnostics.
pub(super) struct Loader<'a> {
    files: &'a dyn Files,
    /// The texts read so far, by which spans are resolved.
    pub sources: Sources,
    /// The diagnostics found so far, in order.
    pub diagnostics: Vec<Diagnostic>,
    loaded: Vec<Option<LoadedFile>>,
    by_name: HashMap<String, Option<usize>>,
    /// The files being read, outermost first. An import of one of them is a cycle.
    open: Vec<OpenFile>,
}

/// A file being read.
struct OpenFile {
    name: String,
    /// The import of this file that is being followed; `None` before the first.
    via: Option<Span>,
}

/// The location of a file: a path in the project or in the standard library.
#[derive(Clone)]
enum FilePlace {
    Project(String),
    Library(String),
}

impl FilePlace {
    /// Returns the name of the file in diagnostics and plans.
    fn shown(&self) -> String {
        match self {
            FilePlace::Project(path) => path.clone(),
            FilePlace::Library(path) => format!("std/{path}"),
        }
    }
}

/// Loads `root`, a path of the project, with all that it imports, and the prelude. Returns (files, texts,
/// diagnostics): the parsed files, the texts by which spans are resolved, and the mistakes found, such as files that
/// can't be read and imports in a cycle.
pub(super) fn load(files: &dyn Files, root: &str) -> (Loaded, Sources, Vec<Diagnostic>) {
    let mut loader = Loader::new(files);
    let prelude = loader.load(FilePlace::Library("prelude.mod".into())).ok();
    let root = match loader.load(FilePlace::Project(root.into())) {
        Ok(index) => Some(index),
        Err(error) => {
            loader.diagnostics.push(Diagnostic::error(code::CANNOT_READ, why_unreadable(root, &error)));
            None
        }
    };
    loader.finish(root, prelude)
}

/// Loads the entries of a session, in order, with all that they import, and the prelude. Returns (files, texts,
/// diagnostics), as [`load`] does.
pub(super) fn load_session(files: &dyn Files, entries: &[Entry]) -> (Loaded, Sources, Vec<Diagnostic>) {
    let mut loader = Loader::new(files);
    let prelude = loader.load(FilePlace::Library("prelude.mod".into())).ok();
    let root = entries.iter().map(|entry| loader.entry(entry)).last();
    loader.finish(root, prelude)
}

/// Returns the sentence that the file at `path` can't be read, with the reason `error`: ``can't read `a.mod`: ...``.
pub fn why_unreadable(path: &str, error: &ReadError) -> String {
    format!("can't read `{path}`: {}", describe(error))
}

/// Returns the reason of a failed read in words.
fn describe(error: &ReadError) -> String {
    match error {
        ReadError::NotFound => "there is no such file".into(),
        ReadError::Outside => "it leads out of the project".into(),
        ReadError::TooLarge(limit) => format!("it is larger than {limit} bytes"),
        ReadError::Failed(why) => why.clone(),
    }
}

impl<'a> Loader<'a> {
    fn new(files: &'a dyn Files) -> Loader<'a> {
        Loader {
            files,
            sources: Sources::default(),
            diagnostics: Vec::new(),
            loaded: Vec::new(),
            by_name: HashMap::new(),
            open: Vec::new(),
        }
    }

    fn finish(self, root: Option<usize>, prelude: Option<usize>) -> (Loaded, Sources, Vec<Diagnostic>) {
        let files = self.loaded.into_iter().map(|f| f.expect("every opened file is closed")).collect();
        (Loaded { files, root, prelude }, self.sources, self.diagnostics)
    }

    /// Loads an entry of a session, and returns its index.
    fn entry(&mut self, entry: &Entry) -> usize {
        let id = self.sources.add_piece(&entry.name, &entry.text, false, entry.first_line);
        // Paths in an entry are relative to the project.
        let place = FilePlace::Project(String::new());
        let index = self.take(&place, id, &entry.text, false);
        let file = self.loaded[index].as_mut().expect("just closed");
        (file.entry, file.last) = (true, entry.last);
        if let Some(name) = entry.value
            && let Some(item) = Arc::make_mut(&mut file.ast).items.last_mut()
        {
            name_value(item, name);
        }
        index
    }

    /// Loads a file with all that it imports, once, and returns its index.
    ///
    /// # Errors
    /// The reason why it can't be read; on a later try always [`ReadError::NotFound`].
    fn load(&mut self, place: FilePlace) -> Result<usize, ReadError> {
        let shown = place.shown();
        if let Some(known) = self.by_name.get(&shown) {
            return known.ok_or(ReadError::NotFound);
        }
        self.by_name.insert(shown.clone(), None);
        let (id, text) = self.read(&place, &shown)?;
        self.by_name.insert(shown, Some(self.loaded.len()));
        let stays = matches!(text, Cow::Borrowed(_));
        Ok(self.take(&place, id, &text, stays))
    }

    /// Parses a text and loads all that it imports; returns its index. `stays`: true if the text stays where it is in memory.
    fn take(&mut self, place: &FilePlace, id: FileId, text: &str, stays: bool) -> usize {
        let (ast, diagnostics) = tree(id, text, stays);
        self.diagnostics.extend(diagnostics);
        let index = self.loaded.len();
        self.loaded.push(None);
        self.open.push(OpenFile { name: place.shown(), via: None });
        let mut imports = Vec::new();
        for item in &ast.items {
            if let ast::ItemKind::Use(u) = &item.kind {
                self.import(place, u, &mut imports);
            }
        }
        self.open.pop();
        if let FilePlace::Project(_) = place {
            self.load_needed(text);
        }
        self.loaded[index] = Some(LoadedFile { ast, imports, entry: false, last: None });
        index
    }

    /// Loads the files of the library that a text needs without importing them.
    fn load_needed(&mut self, text: &str) {
        for (call, file) in NEEDED {
            if text.contains(call) {
                // A library without the file is reported where the call is evaluated.
                drop(self.load(FilePlace::Library((*file).into())));
            }
        }
    }

    /// Reads a text and adds it to the sources; one that is not UTF-8, or longer than [`syntax::TEXT_MAX`], is reported and
    /// read as empty.
    ///
    /// # Errors
    /// The reason why it can't be read.
    fn read(&mut self, place: &FilePlace, shown: &str) -> Result<(FileId, Cow<'static, str>), ReadError> {
        let bytes = match place {
            FilePlace::Library(path) => {
                let text = self.files.library(path).ok_or(ReadError::NotFound)?;
                return Ok((self.sources.add(shown, &text, true), text));
            }
            FilePlace::Project(path) => self.files.read(path)?,
        };
        if bytes.len() > syntax::TEXT_MAX {
            // Only its name is needed: the text may be very long.
            let id = self.sources.add(shown, "", false);
            self.diagnostics.push(syntax::too_large(id, bytes.len()));
            return Ok((id, Cow::Borrowed("")));
        }
        match String::from_utf8(bytes) {
            Ok(text) => Ok((self.sources.add(shown, &text, false), Cow::Owned(text))),
            Err(error) => {
                let offset = error.utf8_error().valid_up_to();
                let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
                let id = self.sources.add(shown, &text, false);
                let replaced = '\u{FFFD}'.len_utf8();
                self.diagnostics.push(
                    Diagnostic::error(code::NOT_UTF8, format!("`{shown}` is not UTF-8 text"))
                        .label(
                            Span::new(id, offset, offset + replaced),
                            format!("byte {offset} is wrong here"),
                        )
                        .hint("save the file as UTF-8"),
                );
                // Errors in a text of another encoding mean nothing.
                Ok((id, Cow::Borrowed("")))
            }
        }
    }

    /// Loads the target of a `use`.
    fn import(&mut self, from: &FilePlace, u: &ast::Use, imports: &mut Vec<Import>) {
        match &u.source {
            ast::UseSource::File { path, span } => self.import_file(from, u, path, *span, imports),
            ast::UseSource::Path(path) => self.import_path(u, path, imports),
        }
    }

    /// Loads the target of a `use "path"`; reports a path that leads out of the project.
    fn import_file(
        &mut self,
        from: &FilePlace,
        u: &ast::Use,
        path: &str,
        span: Span,
        imports: &mut Vec<Import>,
    ) {
        let place = match from {
            FilePlace::Project(own) => join(own, path).map(FilePlace::Project),
            FilePlace::Library(own) => join(own, path).map(FilePlace::Library),
        };
        let Some(place) = place else {
            self.diagnostics.push(
                Diagnostic::error(code::OUTSIDE_PROJECT, format!("`{path}` leads out of the project"))
                    .label(span, "imports stay under the project's folder")
                    .hint("write a path relative to this file, with forward slashes; `--root DIR` names a larger project"),
            );
            return unknown_names(u, imports);
        };
        match self.open_import(place, path, span) {
            Some(file) => match &u.names {
                Some(names) => import_names(names, file, imports),
                None => match namespace(path) {
                    Some(name) => imports.push(Import { name, span, target: ImportTarget::File(file) }),
                    None => self.diagnostics.push(
                        Diagnostic::error(
                            code::UNKNOWN_IMPORT,
                            "this file's name is no name of the language",
                        )
                        .label(span, "so it can't stand before the names in it")
                        .hint(format!("say which are wanted: `use \"{path}\".{{Name}}`, or rename the file")),
                    ),
                },
            },
            None => unknown_names(u, imports),
        }
    }

    /// Loads the target of a `use std.name`.
    fn import_path(&mut self, u: &ast::Use, path: &[ast::Name], imports: &mut Vec<Import>) {
        let span = path[0].span.to(path[path.len() - 1].span);
        let words: Vec<&str> = path.iter().map(|n| n.text.as_str()).collect();
        if words[0] != "std" {
            self.diagnostics.push(
                Diagnostic::error(code::UNKNOWN_IMPORT, format!("there is no library `{}`", words[0]))
                    .label(path[0].span, "only `std` is a library")
                    .hint("a file of the project is imported by its path: `use \"parts/claw.mod\".{Claw}`"),
            );
            return unknown_names(u, imports);
        }
        let whole = format!("{}.mod", words[1..].join("/"));
        if words.len() > 1 && self.files.library(&whole).is_some() {
            let Some(file) = self.open_import(FilePlace::Library(whole), &words.join("."), span) else {
                return unknown_names(u, imports);
            };
            return match &u.names {
                Some(names) => import_names(names, file, imports),
                None => {
                    let last = path[path.len() - 1];
                    imports.push(Import {
                        name: last.text,
                        span: last.span,
                        target: ImportTarget::File(file),
                    });
                }
            };
        }
        let (last, rest) = (path[path.len() - 1], &words[1..words.len().max(2) - 1]);
        let file = format!("{}.mod", rest.join("/"));
        if u.names.is_none() && words.len() > 2 && self.files.library(&file).is_some() {
            let target = match self.open_import(FilePlace::Library(file), &words.join("."), span) {
                Some(file) => ImportTarget::Item { file, item: last.text, span: last.span },
                None => ImportTarget::Error,
            };
            imports.push(Import { name: last.text, span: last.span, target });
            return;
        }
        let names = library::FILES.iter().filter_map(|(name, _)| name.strip_suffix(".mod"));
        let known: Vec<&str> = names.filter(|name| *name != "prelude").collect();
        let mut diagnostic = Diagnostic::error(
            code::UNKNOWN_IMPORT,
            format!("the standard library has no `{}`", words.join(".")),
        )
        .label(span, "no such file of the library");
        if let Some(near) = suggest(words.get(1).unwrap_or(&""), known.iter().copied()) {
            diagnostic = diagnostic.hint(format!("`std.{near}`?"));
        } else {
            diagnostic = diagnostic.hint(format!("it has std.{}", known.join(", std.")));
        }
        self.diagnostics.push(diagnostic);
        unknown_names(u, imports);
    }

    /// Returns the index of an imported file; `None` (and a diagnostic) if it can't be read or closes a
    /// cycle.
    fn open_import(&mut self, place: FilePlace, written: &str, span: Span) -> Option<usize> {
        let shown = place.shown();
        if let Some(open) = self.open.last_mut() {
            open.via = Some(span);
        }
        if let Some(start) = self.open.iter().position(|open| open.name == shown) {
            self.cycle(start, &shown);
            return None;
        }
        if self.open.len() >= IMPORT_DEPTH_MAX {
            let message = format!("files import files {IMPORT_DEPTH_MAX} deep, which is the limit");
            self.diagnostics.push(
                Diagnostic::error(code::TOO_DEEP, message)
                    .label(span, "imported here")
                    .hint("import from one file what the files of a chain need"),
            );
            return None;
        }
        match self.load(place) {
            Ok(index) => Some(index),
            Err(ReadError::Outside) => {
                self.diagnostics.push(
                    Diagnostic::error(code::OUTSIDE_PROJECT, format!("`{written}` leads out of the project"))
                        .label(span, "imports stay under the project's folder"),
                );
                None
            }
            Err(error) => {
                let code =
                    if error == ReadError::NotFound { code::UNKNOWN_IMPORT } else { code::CANNOT_READ };
                let text = why_unreadable(written, &error);
                self.diagnostics.push(Diagnostic::error(code, text).label(span, "imported here"));
                None
            }
        }
    }

    /// Reports an import cycle at the import by which its first file enters it.
    fn cycle(&mut self, start: usize, shown: &str) {
        let mut names: Vec<&str> = self.open[start..].iter().map(|open| open.name.as_str()).collect();
        names.push(shown);
        let mut diagnostic =
            Diagnostic::error(code::IMPORT_CYCLE, format!("import cycle: {}", names.join(", ")))
                .hint("move what both files need into a third file that both import");
        for (i, open) in self.open[start..].iter().enumerate() {
            let via = open.via.expect("an open file is left through an import");
            diagnostic = diagnostic.label(via, format!("imports {}", names[i + 1]));
        }
        self.diagnostics.push(diagnostic);
    }
}

/// Adds the imported items of a file.
fn import_names(names: &[ast::UseName], file: usize, imports: &mut Vec<Import>) {
    for n in names {
        let shown = n.rename.unwrap_or(n.name);
        imports.push(Import {
            name: shown.text,
            span: shown.span,
            target: ImportTarget::Item { file, item: n.name.text, span: n.name.span },
        });
    }
}

/// Turns the expression that ends an entry into the declaration of a value.
fn name_value(item: &mut ast::Item, name: Symbol) {
    let ast::ItemKind::Statement(statement) = &item.kind else { return };
    if let Some(value) = value_of(statement) {
        let name = ast::Name { text: name, span: value.span };
        item.kind = ast::ItemKind::Let(ast::Let { name, ty: None, value });
    }
}

/// Returns a statement as an expression, also an `if` whose branches all end with one; `None` for others.
fn value_of(statement: &ast::Stmt) -> Option<ast::Expr> {
    let span = statement.span;
    match &statement.kind {
        ast::StmtKind::Expr(value) => Some(value.clone()),
        ast::StmtKind::If { condition, then, otherwise } => {
            let otherwise = match &otherwise[..] {
                [chained @ ast::Stmt { kind: ast::StmtKind::If { .. }, .. }] => value_of(chained)?,
                otherwise => block_of(span, otherwise)?,
            };
            let then = Box::new(block_of(span, then)?);
            let kind = ast::ExprKind::If {
                condition: Box::new(condition.clone()),
                then,
                otherwise: Some(Box::new(otherwise)),
            };
            Some(ast::Expr { span, kind })
        }
        _ => None,
    }
}

/// Returns statements as a block expression; `None` if the last one has no value.
fn block_of(span: Span, statements: &[ast::Stmt]) -> Option<ast::Expr> {
    let (last, before) = statements.split_last()?;
    let value = Some(Box::new(value_of(last)?));
    Some(ast::Expr { span, kind: ast::ExprKind::Block { statements: before.to_vec(), value } })
}

/// Returns the name under which `use "path"` brings in a file: that of the file without `.mod`; `None` if it is not a
/// name of the language.
fn namespace(path: &str) -> Option<Symbol> {
    let name = path.rsplit('/').next().unwrap_or(path).strip_suffix(".mod")?;
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let word = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    (begins && word && !syntax::RESERVED.contains(&name)).then(|| Symbol::new(name))
}

/// Adds the names of a failed import as erroneous entities.
fn unknown_names(u: &ast::Use, imports: &mut Vec<Import>) {
    let mut push = |name: ast::Name| {
        imports.push(Import { name: name.text, span: name.span, target: ImportTarget::Error });
    };
    match (&u.names, &u.source) {
        (Some(names), _) => names.iter().for_each(|n| push(n.rename.unwrap_or(n.name))),
        (None, ast::UseSource::Path(path)) => push(path[path.len() - 1]),
        (None, ast::UseSource::File { path, span }) => {
            imports.extend(namespace(path).map(|name| Import {
                name,
                span: *span,
                target: ImportTarget::Error,
            }));
        }
    }
}
