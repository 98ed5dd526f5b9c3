//! Completion: the candidates at an offset of a text being typed.
//!
//! It works on a copy of the session's state, so that it can run on another thread with a time limit.

use super::command::COMMANDS;
use super::dependencies::meant;
use super::kept::FileSnapshot;
use super::locals::{LocalName, Origin, locals};
pub(crate) use super::members::Named;
use super::members::{about, members, params_of_member};
use super::path_type::{type_of_let, type_of_path};
use super::state::{Session, is_given, value_type};
use crate::check::summary::{param_text, params_of, type_params, with_default};
use crate::check::typed::{DefId, Param};
use crate::check::{self, Checked, Entry, Meaning, Type};
use crate::source::{FileId, Files, Symbol, library};
use crate::syntax::{self, CONFIG, ITEMS, MODULE, Outline, RESERVED, STATEMENTS, TRUSS, TokenKind, ast};
use crate::units::UNITS;
use std::sync::Arc;

/// The data of a session that completion needs: its files and its checked program. Clones share them.
#[derive(Clone)]
pub struct Knowledge {
    files: Arc<FileSnapshot>,
    entries: Vec<Entry>,
    checked: Arc<Checked>,
    last: Option<Symbol>,
}

impl Knowledge {
    /// Returns what completion needs to know of a program in a file, whose text is given.
    pub(crate) fn of_program(files: Arc<FileSnapshot>, checked: Arc<Checked>, text: &str) -> Knowledge {
        let entry =
            Entry { name: "<program>".into(), text: text.to_owned(), first_line: 1, value: None, last: None };
        Knowledge { files, entries: vec![entry], checked, last: None }
    }

    /// Returns the declaration of the type of the expression that ends a text: of an instance or a record. `None` for a value of
    /// another type, and where no expression ends.
    pub(crate) fn declaration_before(&self, text: &str) -> Option<DefId> {
        let (_, ty) = type_of(self, &substituted(receiver(text)?, text));
        match ty? {
            Type::Instance(id) | Type::Record(id) => Some(id),
            _ => None,
        }
    }
}

/// The parameters of a call that is being typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Signature {
    /// The function, as it was written.
    pub callee: String,
    /// The parameters as they are written: `n: Int = 1`.
    pub parameters: Vec<String>,
    /// The index of the parameter that the argument being typed is for.
    pub active: usize,
}

/// Returns the parameters of the call in which a text ends; `None` outside of a call, and for an unknown function.
pub(crate) fn signature(knowledge: &Knowledge, before: &str) -> Option<Signature> {
    let open = open_call(before)?;
    let callee = receiver(&before[..open])?.to_owned();
    let (checked, params, inside) = call_at(knowledge, before)?;
    let given = arguments(inside);
    let last = given.last().map_or("", |argument| argument.trim_start());
    let by_name = params.iter().position(|param| {
        last.strip_prefix(param.name.as_str()).is_some_and(|rest| rest.trim_start().starts_with(':'))
    });
    let by_place = given.len().saturating_sub(1).min(params.len().saturating_sub(1));
    let parameters = params.iter().map(|param| with_default(&checked, &[], param)).collect();
    Some(Signature { callee, parameters, active: by_name.unwrap_or(by_place) })
}

/// The candidates for completing a text at an offset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Completion {
    /// The offset in bytes at which the text to be replaced begins.
    pub start: usize,
    /// The candidates for completion, those that begin with the typed text, sorted by name, each once.
    pub candidates: Vec<Named>,
}

impl Session {
    /// Returns a snapshot of the session's data that completion needs; it does not change with the session.
    pub fn knowledge(&self) -> Knowledge {
        Knowledge {
            files: self.files.clone(),
            entries: self.entries.clone(),
            checked: self.checked.clone(),
            last: self.last,
        }
    }
}

/// The greatest length of a hint in characters; it is shown on the line being typed.
const HINT_MAX: usize = 60;

/// Returns the candidates at the offset `at`, in bytes of `text`: those that begin with what is typed, sorted by name,
/// each once. Panics if `at` is within a character or beyond the text.
pub(crate) fn complete(knowledge: &Knowledge, text: &str, at: usize) -> Completion {
    let before = &text[..at];
    let mut completion = candidates(knowledge, before);
    let typed = before[completion.start..].to_owned();
    completion.candidates.retain(|c| c.name.starts_with(&typed));
    completion.candidates.sort_by(|a, b| a.name.cmp(&b.name));
    completion.candidates.dedup_by(|a, b| a.name == b.name);
    completion
}

/// Returns the remaining parameters of the call in which a text ends, as text to be shown after it: `n: Int)`. `None`
/// outside of a call, for an unknown function, after a dot, within an argument, and if no parameter remains.
pub(crate) fn hint(knowledge: &Knowledge, text: &str) -> Option<String> {
    let open = open_call(text)?;
    let callee = receiver(&text[..open])?;
    let inside = &text[open + 1..];
    // After a dot the type would have to be inferred, which is too slow for every key.
    if callee.contains('.') || !(inside.trim().is_empty() || inside.trim_end().ends_with(',')) {
        return None;
    }
    let id = *meant(&knowledge.checked).get(&Symbol::new(callee))?;
    let program = &knowledge.checked.program;
    let params = params_of(program, id);
    let given = arguments(inside).len().saturating_sub(1);
    let names = type_params(&program.def(id).kind);
    let rest: Vec<String> = params.iter().skip(given).map(|p| param_text(program, names, p)).collect();
    let whole = format!("{})", rest.join(", "));
    let short = match whole.char_indices().nth(HINT_MAX) {
        Some((end, _)) => format!("{}...", &whole[..whole[..end].rfind(", ").map_or(end, |at| at + 2)]),
        None => whole,
    };
    (!rest.is_empty()).then_some(short)
}

/// Returns the candidates at the end of a text, before they are filtered by what is typed.
fn candidates(knowledge: &Knowledge, before: &str) -> Completion {
    let word = word_start(before);
    let done = |start, candidates| Completion { start, candidates };
    if let Some(completion) = command(knowledge, before) {
        return completion;
    }
    if let Some(start) = open_text(before) {
        return done(start, paths(knowledge, &before[start..]));
    }
    if let Some(rest) = before[line_start(before)..].trim_start().strip_prefix("use ") {
        return done(word, imports(knowledge, rest));
    }
    if let Some(start) = unit_start(before) {
        return done(start, UNITS.iter().map(|unit| Named::new(unit.name, "unit")).collect());
    }
    if before[..word].ends_with('.') && !before[..word].ends_with("..") {
        return done(word, behind_dot(knowledge, &before[..word - 1]));
    }
    if let Some(words) = words_of_argument(knowledge, &before[..word]) {
        return done(word, words);
    }
    let mut found = named_arguments(knowledge, &before[..word]);
    if word == before.len() && !found.is_empty() {
        // With nothing typed yet, the library's names would bury the arguments of the call.
        found.extend(project_names(knowledge));
        return done(word, found);
    }
    found.extend(names(knowledge, before, word));
    done(word, found)
}

/// Returns the offset of the word that ends a text.
fn word_start(text: &str) -> usize {
    text.rfind(|c: char| !c.is_alphanumeric() && c != '_').map_or(0, |at| at + last_char(text, at))
}

fn last_char(text: &str, at: usize) -> usize {
    text[at..].chars().next().map_or(0, char::len_utf8)
}

fn line_start(text: &str) -> usize {
    text.rfind('\n').map_or(0, |at| at + 1)
}

/// Returns the candidates of a command line; `None` if the text is none.
fn command(knowledge: &Knowledge, before: &str) -> Option<Completion> {
    let line = before.trim_start();
    let indent = before.len() - line.len();
    if let Some(name) = line.strip_prefix('?') {
        return Some(Completion { start: before.len() - name.len(), candidates: global_names(knowledge) });
    }
    let rest = line.strip_prefix(':')?;
    match rest.split_once(' ') {
        None => {
            let commands = COMMANDS.iter().map(|(name, _, does)| Named::new(*name, *does));
            Some(Completion { start: indent + 1, candidates: commands.collect() })
        }
        Some(("load" | "save", path)) => {
            Some(Completion { start: before.len() - path.len(), candidates: paths(knowledge, path) })
        }
        // An expression follows.
        Some((_, rest)) => {
            let start = before.len() - rest.len();
            let inner = candidates(knowledge, rest);
            Some(Completion { start: start + inner.start, candidates: inner.candidates })
        }
    }
}

/// Returns the offset of the contents of a text literal that is still open; `None` if none is.
fn open_text(before: &str) -> Option<usize> {
    let tokens = Outline::tokens_of(before)?;
    let last = tokens.last()?;
    (last.kind == TokenKind::UnclosedText).then_some(last.start + 1)
}

/// Returns the files of a folder of the project.
fn paths(knowledge: &Knowledge, typed: &str) -> Vec<Named> {
    let folder = typed.rsplit_once('/').map_or("", |(folder, _)| folder);
    let inside = |name: String| if folder.is_empty() { name } else { format!("{folder}/{name}") };
    let found = knowledge.files.list(folder).into_iter();
    found.map(|name| Named::new(inside(name), "file")).collect()
}

/// Returns the candidates after `use`: libraries, their items, and those of files.
fn imports(knowledge: &Knowledge, rest: &str) -> Vec<Named> {
    let source = rest.split_once(['{', ',']).map_or(rest, |(source, _)| source).trim_end_matches('.');
    if let Some(path) = source.trim().strip_prefix('"') {
        let bytes = knowledge.files.read(path.trim_end_matches('"')).unwrap_or_default();
        return declared(&String::from_utf8_lossy(&bytes));
    }
    let path = rest.split('{').next().unwrap_or(rest);
    let words: Vec<&str> = path.split('.').map(str::trim).collect();
    match words[..] {
        ["std", file, _] => {
            let text = knowledge.files.library(&format!("{file}.mod"));
            text.map_or_else(Vec::new, |text| declared(&text))
        }
        ["std", _] => {
            let files = library::FILES.iter().filter_map(|(name, _)| name.strip_suffix(".mod"));
            files.filter(|name| *name != "prelude").map(|name| Named::new(name, "library")).collect()
        }
        _ => vec![Named::new("std", "the standard library")],
    }
}

/// Returns the public names that the text of a file declares.
fn declared(text: &str) -> Vec<Named> {
    use ast::ItemKind as K;
    let file = syntax::parse(FileId(0), text).file;
    let named = file.items.iter().filter_map(|item| {
        let (name, what) = match &item.kind {
            K::Let(x) => (x.name, "value"),
            K::Fn(x) => (x.name, "function"),
            K::Record(x) => (x.name, "record"),
            K::Study(x) => (x.name, "study"),
            K::Connector(x) => (x.name, "connector"),
            K::Module(x) => (x.name, "module"),
            K::Facts(x) => (x.name, x.family.word()),
            K::Config(x) => (x.name, if x.scene { "scene" } else { "config" }),
            K::Lattice(x) => (x.name, "lattice"),
            K::Truss(x) => (x.name, "truss"),
            _ => return None,
        };
        (!name.text.as_str().starts_with('_')).then(|| Named::new(name.text.as_str(), what))
    });
    named.collect()
}

/// Returns the offset of the unit, or of its last factor, attached to a number at the end of a text: `90d`,
/// `6rad/`; `None` if the text does not end so.
fn unit_start(before: &str) -> Option<usize> {
    let glued = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '/' | '*' | '^' | '_');
    let start = before.rfind(|c| !glued(c)).map_or(0, |at| at + last_char(before, at));
    let number = &before[start..];
    if !number.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let suffix = number.find(|c: char| c.is_ascii_alphabetic())?;
    if number[..suffix].contains(['/', '*', '^']) || number[..suffix].contains("..") {
        return None;
    }
    let last = number.rfind(['/', '*']).map_or(suffix, |at| at + 1).max(suffix);
    Some(start + last)
}

/// Returns the expression of names, calls and indices that ends a text; `None` if there is none.
fn receiver(text: &str) -> Option<&str> {
    let bytes = text.as_bytes();
    let mut at = text.len();
    let mut closed = Vec::new();
    while at > 0 {
        let c = bytes[at - 1];
        match c {
            b')' | b']' => closed.push(c),
            b'(' if closed.last() == Some(&b')') => drop(closed.pop()),
            b'[' if closed.last() == Some(&b']') => drop(closed.pop()),
            b'(' | b'[' | b'{' | b'}' if closed.is_empty() => break,
            _ if !closed.is_empty() => {}
            b'.' | b'_' => {}
            c if c.is_ascii_alphanumeric() => {}
            _ => break,
        }
        at -= 1;
    }
    let found = text[at..].trim();
    (!found.is_empty() && closed.is_empty()).then_some(found)
}

/// Returns the members of the expression before the dot.
fn behind_dot(knowledge: &Knowledge, before: &str) -> Vec<Named> {
    let Some(receiver) = receiver(before) else { return Vec::new() };
    if let Some((_, Meaning::File(items))) =
        knowledge.checked.names.iter().find(|(name, _)| name.as_str() == receiver)
    {
        let program = &knowledge.checked.program;
        return items.iter().map(|(name, id)| Named::new(name.as_str(), about(program, *id))).collect();
    }
    let (checked, ty) = type_of(knowledge, &substituted(receiver, before));
    ty.map_or_else(Vec::new, |ty| members(&checked, &ty))
}

/// Returns the type of an expression, and a program that has it; `None` if it has no value. Any but a plain path is checked as
/// the next entry, with all that is before it.
fn type_of(knowledge: &Knowledge, text: &str) -> (Arc<Checked>, Option<Type>) {
    if let Some(ty) = type_of_path(&knowledge.checked, text) {
        return (knowledge.checked.clone(), Some(ty));
    }
    let mut entries = knowledge.entries.clone();
    entries.push(Entry {
        name: "<completion>".into(),
        text: text.into(),
        first_line: 1,
        value: None,
        last: knowledge.last,
    });
    let checked = check::check_session(&*knowledge.files, &entries);
    let ty = checked.entries.last().and_then(|file| value_type(&checked, *file));
    (Arc::new(checked), ty)
}

/// The most substitutions of local names in an expression.
const SUBSTITUTIONS_MAX: usize = 8;

/// Returns an expression in which names that the unfinished text declares are substituted by known ones:
/// `leg[0].m` by an instance of the type of `leg`, a part of a body being typed.
fn substituted(expr: &str, before: &str) -> String {
    let locals = locals(before);
    let mut expr = expr.to_owned();
    for _ in 0..SUBSTITUTIONS_MAX {
        let end = expr.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(expr.len());
        let (head, rest) = expr.split_at(end);
        let Some(local) = locals.iter().rev().find(|local| local.name == head) else { break };
        expr = match &local.origin {
            Origin::Typed(ty) => format!("{ty}(){rest}"),
            Origin::Listed(ty) => format!("[{ty}()]{rest}"),
            Origin::Value(value) if !value.starts_with(head) => format!("{}{rest}", value.trim()),
            // One of the elements; all have the same type.
            Origin::Each(list) if !list.starts_with(head) && !list.contains("..") => {
                format!("{list}[0]{rest}")
            }
            _ => break,
        };
    }
    expr
}

/// Returns the offset of the innermost open bracket, if it is a parenthesis; otherwise `None`.
fn open_call(text: &str) -> Option<usize> {
    open_bracket(text).filter(|at| text[*at..].starts_with('('))
}

/// Returns the offset of the innermost open bracket; `None` outside of all brackets.
fn open_bracket(text: &str) -> Option<usize> {
    let mut open = Vec::new();
    for token in Outline::tokens_of(text)? {
        match token.kind {
            TokenKind::Open => open.push(token.start),
            TokenKind::Close => drop(open.pop()),
            _ => {}
        }
    }
    open.pop()
}

/// Returns the record whose fields a text is about to change: `d` in `d with {`; `None` if it changes none.
fn changed_record(before_brace: &str) -> Option<&str> {
    let object = before_brace.trim_end().strip_suffix("with")?;
    object.ends_with(char::is_whitespace).then(|| receiver(object.trim_end()))?
}

/// Returns the arguments of a call between its commas; the last one is being typed.
fn arguments(inside: &str) -> Vec<&str> {
    let mut depth = 0usize;
    let mut start = 0;
    let mut found = Vec::new();
    for (at, c) in inside.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                found.push(&inside[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    found.push(&inside[start..]);
    found
}

/// Returns the checked program, the parameters of the call, or the fields of the changed record, in which a text
/// ends, and the text of its arguments; `None` outside of both, and for an unknown function.
fn call_at<'t>(knowledge: &Knowledge, before: &'t str) -> Option<(Arc<Checked>, Vec<Param>, &'t str)> {
    let open = open_bracket(before)?;
    let inside = &before[open + 1..];
    if before[open..].starts_with('{') {
        let record = changed_record(&before[..open])?;
        let (checked, ty) = type_of(knowledge, &substituted(record, before));
        let Some(Type::Record(id)) = ty else { return None };
        let fields = params_of(&checked.program, id).to_vec();
        return Some((checked, fields, inside));
    }
    let open = open_call(before)?;
    let callee = receiver(&before[..open])?;
    let Some((object, name)) = callee.rsplit_once('.') else {
        let id = *meant(&knowledge.checked).get(&Symbol::new(callee))?;
        let params = params_of(&knowledge.checked.program, id).to_vec();
        return Some((knowledge.checked.clone(), params, inside));
    };
    let (checked, ty) = type_of(knowledge, &substituted(object, before));
    let params = params_of_member(&checked, &ty?, Symbol::new(name));
    Some((checked, params, inside))
}

/// Returns the names of the parameters that are not given yet, as `name: `, where an argument begins.
fn named_arguments(knowledge: &Knowledge, before: &str) -> Vec<Named> {
    if !before.trim_end().ends_with(['(', '{', ',']) {
        return Vec::new();
    }
    let Some((checked, params, inside)) = call_at(knowledge, before) else { return Vec::new() };
    let given = arguments(inside);
    let is_given = |(i, param): (usize, &Param)| {
        let by_name = |argument: &&str| {
            argument
                .trim_start()
                .strip_prefix(param.name.as_str())
                .is_some_and(|rest| rest.trim_start().starts_with(':'))
        };
        given.iter().any(by_name) || (i + 1 < given.len() && !given[i].contains(':'))
    };
    let open = params.iter().enumerate().filter(|(i, param)| !is_given((*i, param)));
    open.map(|(_, p)| Named::new(format!("{}: ", p.name), checked.program.type_name(&p.ty))).collect()
}

/// Returns the words of a choice after the name of its parameter, `profile: `; `None` elsewhere.
fn words_of_argument(knowledge: &Knowledge, before: &str) -> Option<Vec<Named>> {
    let name = before.trim_end().strip_suffix(':')?;
    let name = &name[word_start(name)..];
    let (_, params, _) = call_at(knowledge, before)?;
    let param = params.into_iter().find(|param| param.name.as_str() == name)?;
    let mut ty = &param.ty;
    while let Type::Optional(inner) = ty {
        ty = inner;
    }
    let Type::Choice(choice) = ty else { return None };
    Some(choice.words.iter().map(|word| Named::new(word.as_str(), "choice")).collect())
}

/// Returns the names visible at the top of the session.
fn global_names(knowledge: &Knowledge) -> Vec<Named> {
    let program = &knowledge.checked.program;
    let named = knowledge.checked.names.iter().filter(|(name, _)| is_given(*name));
    named
        .map(|(name, meaning)| match meaning {
            Meaning::Def(id) => Named::new(name.as_str(), about(program, *id)),
            Meaning::File(_) => Named::new(name.as_str(), "library"),
        })
        .collect()
}

/// Returns the names that the project and the session declare.
fn project_names(knowledge: &Knowledge) -> Vec<Named> {
    let (program, sources) = (&knowledge.checked.program, &knowledge.checked.sources);
    let own = meant(&knowledge.checked)
        .into_iter()
        .filter(|(name, id)| is_given(*name) && !sources.file(program.def(*id).file).library);
    own.map(|(name, id)| Named::new(name.as_str(), about(program, id))).collect()
}

/// Returns the visible names, those that the text itself declares, and keywords.
fn names(knowledge: &Knowledge, before: &str, word: usize) -> Vec<Named> {
    let mut found = global_names(knowledge);
    let typed = &before[word..];
    let own = locals(&before[..word]).into_iter().filter(|local| local.name.starts_with(typed));
    let own: Vec<LocalName> = own.collect();
    let few = own.len() <= INFERRED_MAX;
    found.splice(0..0, own.into_iter().map(|local| own_name(knowledge, &before[..word], local, few)));
    let begins = before[line_start(before)..word].trim().is_empty();
    let clauses = if begins { &[ITEMS, STATEMENTS, MODULE, CONFIG, TRUSS][..] } else { &[] };
    let words = clauses.iter().copied().flatten().chain(RESERVED);
    found.extend(words.filter(|word| word.len() > 1).map(|word| Named::new(*word, "")));
    found
}

/// The most names of an unfinished text whose types are worked out by checks of their own.
const INFERRED_MAX: usize = 4;

/// Returns a name that the text declares above, with its type. `infers`: true if that may be worked out anew.
fn own_name(knowledge: &Knowledge, before: &str, local: LocalName, infers: bool) -> Named {
    let inferred = || {
        if let Some(ty) = type_of_let(&knowledge.checked, &local.name) {
            return knowledge.checked.program.type_name(&ty);
        }
        let (checked, ty) = match infers {
            true => type_of(knowledge, &substituted(&local.name, before)),
            false => (knowledge.checked.clone(), None),
        };
        ty.map_or_else(|| "declared above".to_owned(), |ty| checked.program.type_name(&ty))
    };
    let about = match &local.origin {
        Origin::Typed(ty) => ty.clone(),
        Origin::Listed(ty) => format!("List<{ty}>"),
        Origin::Each(list) if list.contains("..") => "Int".to_owned(),
        Origin::Value(_) | Origin::Each(_) => inferred(),
        Origin::Word(word) => word.clone(),
    };
    Named::new(local.name, about)
}
