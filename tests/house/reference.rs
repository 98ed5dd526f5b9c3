//! The pages of `docs/reference/`, made from the declarations in `stdlib/`. The test compares them;
//! `UPDATE_DOCS=1 cargo test --release reference` writes them.

use crate::support::fences::files;
use modl::source::FileId;
use modl::syntax::ast::{
    CommentKind, Config, ConfigClauseKind, ExternFn, ExternType, File, ItemKind, Module, ModuleClauseKind,
};
use modl::syntax::parse;
use std::fmt::Write;
use std::path::Path;

/// A library file with its tree.
struct Source<'a> {
    name: &'a str,
    text: &'a str,
    file: File,
}

impl Source<'_> {
    /// The text of a declaration without its documentation and, where it has one, its body.
    fn head(&self, start: usize, end: usize) -> String {
        let mut text = &self.text[start..end];
        while let Some((line, rest)) = text.split_once('\n') {
            if !line.trim_start().starts_with("///") {
                break;
            }
            text = rest;
        }
        text.trim().to_owned()
    }

    /// What stands on the line that begins with the keyword of a declaration, up to its brace.
    fn first_line(&self, start: usize, end: usize) -> String {
        let head = self.head(start, end);
        let open = head.find(" {").unwrap_or(head.len());
        head[..open].to_owned()
    }
}

fn page(source: &Source) -> String {
    let title =
        if source.name == "prelude" { "The prelude".to_owned() } else { format!("std.{}", source.name) };
    let mut page = format!("# {title}\n\n");
    page.push_str(
        "<!-- Made from the declarations; `UPDATE_DOCS=1 cargo test --release reference` writes this page. -->\n\n",
    );
    if let Some(doc) = &source.file.doc {
        page.push_str(&format!("{}\n\n", doc.trim()));
    }
    let mut sections = sections(source).into_iter().peekable();
    for item in &source.file.items {
        while let Some((_, heading)) = sections.next_if(|(at, _)| *at < item.span.start as usize) {
            page.push_str(&heading);
        }
        let doc = item.doc.as_deref().unwrap_or("").trim();
        let (start, end) = (item.span.start as usize, item.span.end as usize);
        match &item.kind {
            ItemKind::ExternFn(f) if shown(f.name.text.as_str()) => {
                entry(&mut page, f.name.text.as_str(), &source.head(start, end), doc);
            }
            ItemKind::Fn(f) if shown(f.name.text.as_str()) => {
                let head = source.head(start, f.body.span.start as usize);
                entry(&mut page, f.name.text.as_str(), head.trim_end_matches(['=', ' ', '\n']), doc);
            }
            ItemKind::Let(l) if shown(l.name.text.as_str()) => {
                entry(&mut page, l.name.text.as_str(), &source.head(start, end), doc);
            }
            ItemKind::ExternType(t) => extern_type(&mut page, source, t, doc),
            ItemKind::Connector(c) => entry(&mut page, c.name.text.as_str(), &source.head(start, end), doc),
            ItemKind::Facts(f) => {
                entry(&mut page, f.name.text.as_str(), &source.head(start, end), doc);
            }
            ItemKind::Module(m) => {
                entry(&mut page, m.name.text.as_str(), &source.first_line(start, end), doc);
                module(&mut page, m);
            }
            ItemKind::Config(c) => {
                entry(&mut page, c.name.text.as_str(), &source.first_line(start, end), doc);
                config(&mut page, source, c);
            }
            _ => {}
        }
    }
    page
}

/// Names that are private to their file are not shown.
fn shown(name: &str) -> bool {
    !name.starts_with('_')
}

/// Comments that stand alone between blank lines head what follows: `// Numbers.`
fn sections(source: &Source) -> Vec<(usize, String)> {
    let inside = |at: usize| source.file.items.iter().any(|i| i.span.range().contains(&at));
    let mut found: Vec<(usize, String)> = Vec::new();
    let comments = source.file.comments.iter().filter(|c| c.kind == CommentKind::Line);
    let mut paragraph: Vec<&str> = Vec::new();
    for comment in comments.filter(|c| !inside(c.span.start as usize)) {
        paragraph.push(source.text[comment.span.range()].trim_start_matches('/').trim());
        let rest = &source.text[comment.span.end as usize..];
        if rest.starts_with("\n\n") {
            let text = paragraph.join(" ");
            let (title, more) = text.split_once(". ").unwrap_or((text.trim_end_matches('.'), ""));
            let more = if more.is_empty() { String::new() } else { format!("{more}\n\n") };
            found.push((comment.span.start as usize, format!("## {title}\n\n{more}")));
        }
        if !rest.starts_with("\n//") {
            paragraph.clear();
        }
    }
    found
}

fn entry(page: &mut String, name: &str, head: &str, doc: &str) {
    write!(page, "### `{name}`\n\n```text\n{head}\n```\n\n").expect("a text takes all");
    if !doc.is_empty() {
        page.push_str(&format!("{doc}\n\n"));
    }
}

fn extern_type(page: &mut String, source: &Source, t: &ExternType, doc: &str) {
    let is = t.is.map(|is| format!(" is {}", is.text.as_str())).unwrap_or_default();
    entry(page, t.name.text.as_str(), &format!("type {}{is}", t.name.text.as_str()), doc);
    for field in &t.fields {
        let ty = &source.text[field.ty.span.range()];
        bullet(page, &format!("{}: {ty}", field.name.text.as_str()), field.doc.as_deref());
    }
    for (doc, method) in &t.methods {
        bullet(page, &signature(source, method), doc.as_deref());
    }
    page.push('\n');
}

fn signature(source: &Source, f: &ExternFn) -> String {
    let params: Vec<String> = f
        .params
        .iter()
        .map(|p| format!("{}: {}", p.name.text.as_str(), &source.text[p.ty.span.range()]))
        .collect();
    let result =
        f.result.as_ref().map(|r| format!(" -> {}", &source.text[r.span.range()])).unwrap_or_default();
    format!("{}({}){result}", f.name.text.as_str(), params.join(", "))
}

fn module(page: &mut String, m: &Module) {
    let (mut joints, mut ports) = (Vec::new(), Vec::new());
    for clause in &m.clauses {
        match &clause.kind {
            ModuleClauseKind::Joint { name, .. } | ModuleClauseKind::Mimic { name, .. } => {
                joints.push(name.text.as_str().to_owned());
            }
            ModuleClauseKind::Alias { name, target } => {
                joints.push(format!("{} (the same as {})", name.text.as_str(), target.text.as_str()));
            }
            ModuleClauseKind::Port(port) => ports.push(port.name.text.as_str().to_owned()),
            ModuleClauseKind::For { body, .. } => ports.extend(body.iter().filter_map(|c| match &c.kind {
                ModuleClauseKind::Port(port) => Some(format!("{}[...]", port.name.text.as_str())),
                _ => None,
            })),
            _ => {}
        }
    }
    listed(page, "Joints", &joints);
    listed(page, "Ports", &ports);
    page.push('\n');
}

fn config(page: &mut String, source: &Source, c: &Config) {
    let (mut parts, mut ports) = (Vec::new(), Vec::new());
    for clause in &c.clauses {
        match &clause.kind {
            ConfigClauseKind::Part(part) => {
                let text = source.head(clause.span.start as usize, clause.span.end as usize);
                let words: Vec<&str> = text.trim_start_matches("part").split_whitespace().collect();
                let _ = part;
                parts.push(words.join(" ").replace(" :", ":"));
            }
            ConfigClauseKind::Port { name, count, .. } => {
                let count = count.as_ref().map(|n| format!("[{}]", &source.text[n.span.range()]));
                ports.push(format!("{}{}", name.text.as_str(), count.unwrap_or_default()));
            }
            _ => {}
        }
    }
    listed(page, "Parts", &parts);
    listed(page, "Ports", &ports);
    for clause in &c.clauses {
        let ConfigClauseKind::Behavior(behavior) = &clause.kind else { continue };
        let head = source.head(clause.span.start as usize, behavior.body.span.start as usize);
        let head = head.trim_start_matches("behavior").trim_end_matches(['=', ' ', '\n']);
        let head: Vec<&str> = head.split_whitespace().collect();
        bullet(page, &head.join(" ").replace("( ", "(").replace(", )", ")"), clause.doc.as_deref());
    }
    page.push('\n');
}

fn listed(page: &mut String, what: &str, names: &[String]) {
    if !names.is_empty() {
        let names: Vec<String> = names.iter().map(|n| format!("`{n}`")).collect();
        page.push_str(&format!("- {what}: {}\n", names.join(", ")));
    }
}

/// A field, a method or a behaviour with the text of its documentation in one paragraph.
fn bullet(page: &mut String, head: &str, doc: Option<&str>) {
    let doc: Vec<&str> = doc.unwrap_or("").split_whitespace().collect();
    page.push_str(&format!("- `{head}`: {}\n", doc.join(" ")));
}

#[test]
fn reference_pages_are_those_of_the_declarations() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference");
    let update = std::env::var_os("UPDATE_DOCS").is_some();
    let mut stale = Vec::new();
    for (path, text) in files("stdlib", "mod") {
        let name = path.trim_start_matches("stdlib/").trim_end_matches(".mod");
        let parsed = parse(FileId(0), &text);
        let page = page(&Source { name, text: &text, file: parsed.file });
        let page = format!("{}\n", page.trim_end());
        let target = folder.join(format!("{name}.md"));
        if update {
            std::fs::create_dir_all(&folder).expect("docs can be written");
            std::fs::write(&target, &page).expect("docs can be written");
        } else if std::fs::read_to_string(&target).unwrap_or_default() != page {
            stale.push(format!("docs/reference/{name}.md"));
        }
    }
    assert!(stale.is_empty(), "stale pages; UPDATE_DOCS=1 writes them: {}", stale.join(", "));
}

/// Whatever others can use, with what is said of it: declarations, and what can be named inside them.
fn public(file: &File) -> Vec<(String, Option<&str>, bool)> {
    let mut found = Vec::new();
    for item in &file.items {
        let (name, exemplified) = match &item.kind {
            ItemKind::ExternFn(f) => (f.name, true),
            ItemKind::Fn(f) => (f.name, true),
            ItemKind::ExternType(t) => (t.name, false),
            ItemKind::Module(m) => (m.name, false),
            ItemKind::Connector(c) => (c.name, false),
            ItemKind::Facts(f) => (f.name, false),
            ItemKind::Config(c) => (c.name, false),
            ItemKind::Let(l) => (l.name, false),
            ItemKind::Lattice(l) => (l.name, false),
            ItemKind::Truss(t) => (t.name, false),
            _ => continue,
        };
        let name = name.text.as_str();
        if !shown(name) {
            continue;
        }
        found.push((name.to_owned(), item.doc.as_deref(), exemplified));
        let inside: Vec<(&str, Option<&str>)> = match &item.kind {
            ItemKind::ExternType(t) => {
                let fields = t.fields.iter().map(|f| (f.name.text.as_str(), f.doc.as_deref()));
                fields
                    .chain(t.methods.iter().map(|(doc, m)| (m.name.text.as_str(), doc.as_deref())))
                    .collect()
            }
            ItemKind::Config(c) => {
                let behaviors = c.clauses.iter().filter_map(|clause| match &clause.kind {
                    ConfigClauseKind::Behavior(b) => Some((b.name.text.as_str(), clause.doc.as_deref())),
                    _ => None,
                });
                behaviors.collect()
            }
            _ => Vec::new(),
        };
        let inside = inside.into_iter().filter(|(own, _)| shown(own));
        found.extend(inside.map(|(own, doc)| (format!("{name}.{own}"), doc, false)));
    }
    found
}

#[test]
fn every_declaration_of_the_library_is_documented_and_exemplified() {
    let mut wanting = Vec::new();
    for (path, text) in files("stdlib", "mod") {
        for (name, doc, exemplified) in public(&parse(FileId(0), &text).file) {
            let doc = doc.unwrap_or("");
            if doc.trim().is_empty() || exemplified && !doc.contains("Example:\n```") {
                wanting.push(format!("{path}: {name}"));
            }
        }
    }
    assert!(wanting.is_empty(), "without documentation or example:\n{}", wanting.join("\n"));
}

/// Types carry the unit of a quantity; in which frame a place stands, only words can say.
#[test]
fn places_and_poses_of_the_library_are_documented_with_their_frame() {
    let words = ["frame", "world", "base", "middle", "centre", "link", "module", "origin", "seen from"];
    let mut wanting = Vec::new();
    for (path, text) in files("stdlib", "mod") {
        let file = parse(FileId(0), &text).file;
        let mut judge = |name: String, written: &str, doc: Option<&str>| {
            let has_place = written.contains("Vec3<Length>") || written.contains("Pose");
            if has_place && shown(&name) && !words.iter().any(|word| doc.unwrap_or("").contains(word)) {
                wanting.push(format!("{path}: {name}"));
            }
        };
        for item in &file.items {
            let whole = &text[item.span.range()];
            match &item.kind {
                ItemKind::ExternFn(f) => judge(f.name.text.to_string(), whole, item.doc.as_deref()),
                ItemKind::Fn(f) => {
                    let head = &text[item.span.start as usize..f.body.span.start as usize];
                    judge(f.name.text.to_string(), head, item.doc.as_deref());
                }
                ItemKind::ExternType(t) => {
                    for field in &t.fields {
                        judge(
                            field.name.text.to_string(),
                            &text[field.ty.span.range()],
                            field.doc.as_deref(),
                        );
                    }
                }
                _ => {}
            }
        }
    }
    assert!(wanting.is_empty(), "in which frame?\n{}", wanting.join("\n"));
}
