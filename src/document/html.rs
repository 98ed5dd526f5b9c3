//! The pages of the site: plain HTML that works from a file.

use super::manual::ManualPage;
use super::markdown::{Converted, coloured};
use super::outline::{Page, PageEntry};
use crate::check::summary::{Group, Inside};
use std::fmt::Write as _;

/// The files that all pages share, as (name, text): the style sheet (CSS), and the scripts (JavaScript) of the search and of
/// light and dark.
pub(super) const SHARED: [(&str, &str); 3] = [
    ("site.css", include_str!("site.css")),
    ("search.js", include_str!("search.js")),
    ("theme.js", include_str!("theme.js")),
];

/// A function that converts a piece of documentation from Markdown to HTML.
pub(super) type Doc<'d> = &'d mut dyn FnMut(&str) -> String;

/// Returns text escaped for HTML, also for attributes in double quotes.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The pages of a site, as each page leads to them.
pub(super) struct Shell<'s> {
    /// The pages of programs, and of the library.
    pub pages: &'s [Page],
    /// The groups of pages of the manual, each with its title.
    pub manual: &'s [(&'static str, Vec<ManualPage>)],
}

impl Shell<'_> {
    /// Returns a whole page around its body. `contents`: the places on the page as (level, anchor, words), of which level 3
    /// is indented.
    pub(super) fn frame(&self, title: &str, contents: &[(usize, String, String)], body: &str) -> String {
        let mut nav =
            list_of("", [("index.html", "Start"), ("guide.html", "Guide to the robots")].into_iter());
        let pages = |library: bool| {
            let of = self.pages.iter().filter(move |page| page.is_of_library() == library);
            of.map(|page| (page.file.as_str(), page.title.as_str()))
        };
        nav.push_str(&list_of("Programs", pages(false)));
        nav.push_str(&list_of("Library", pages(true)));
        for (group, pages) in self.manual {
            nav.push_str(&list_of(group, pages.iter().map(|page| (page.file.as_str(), page.title.as_str()))));
        }
        let contents = if contents.len() > 1 { contents_of(contents) } else { String::new() };
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
             <link rel=\"stylesheet\" href=\"site.css\">\n<script src=\"theme.js\"></script>\n</head>\n<body>\n<nav>\n\
             <div class=\"tools\"><input id=\"search\" type=\"search\" placeholder=\"Search ( / )\" \
             aria-label=\"Search\"><button id=\"theme\" type=\"button\" title=\"Light or dark\" \
             aria-label=\"Light or dark\">◐</button></div>\n\
             <ol id=\"found\"></ol>\n<details open id=\"pages\"><summary>Pages</summary>\n{nav}</details>\n</nav>\n\
             <main>\n{body}</main>\n{contents}\
             <script src=\"index.js\"></script>\n<script src=\"search.js\"></script>\n</body>\n</html>\n",
            title = escaped(title),
        )
    }
}

/// Returns a list of links as HTML under a title, empty for an empty list.
fn list_of<'l>(title: &str, links: impl Iterator<Item = (&'l str, &'l str)>) -> String {
    let links: String =
        links.map(|(to, words)| format!("<li><a href=\"{to}\">{}</a></li>\n", escaped(words))).collect();
    match (title, links.is_empty()) {
        (_, true) => String::new(),
        ("", false) => format!("<ul>\n{links}</ul>\n"),
        (title, false) => format!("<h2>{}</h2>\n<ul>\n{links}</ul>\n", escaped(title)),
    }
}

/// Returns the contents of a page as HTML.
fn contents_of(places: &[(usize, String, String)]) -> String {
    let line = |(level, anchor, words): &(usize, String, String)| {
        let class = if *level > 2 { " class=\"below\"" } else { "" };
        format!("<li{class}><a href=\"#{}\">{}</a></li>\n", escaped(anchor), escaped(words))
    };
    let lines: String = places.iter().map(line).collect();
    format!("<aside><details open><summary>On this page</summary>\n<ul>\n{lines}</ul>\n</details></aside>\n")
}

/// Returns the page of a file as HTML.
pub(super) fn page(page: &Page, shell: &Shell, doc: Doc) -> String {
    let mut body = format!("<h1>{}</h1>\n", escaped(&page.title));
    if let Some(text) = &page.doc {
        body.push_str(&doc(text));
    }
    for entry in &page.entries {
        body.push_str(&section(entry, doc));
    }
    let places = page.entries.iter().map(|entry| (2, entry.name.clone(), entry.name.clone()));
    shell.frame(&page.title, &places.collect::<Vec<_>>(), &body)
}

/// Returns a page of the manual as HTML, from its text.
pub(super) fn manual_page(page: &ManualPage, shell: &Shell, text: &Converted) -> String {
    let places = text.headings.iter().filter(|heading| heading.level <= 3);
    let places = places.map(|heading| (heading.level, heading.anchor.clone(), heading.title.clone()));
    shell.frame(&page.title, &places.collect::<Vec<_>>(), &text.html)
}

/// Returns the section of a declaration.
fn section(entry: &PageEntry, doc: Doc) -> String {
    let mut out = format!(
        "<section id=\"{name}\">\n<h2><a href=\"#{name}\">{name}</a> <small>{}</small></h2>\n\
         <pre class=\"signature\">{}</pre>\n",
        entry.word,
        coloured(&wrapped(&entry.signature)),
        name = escaped(&entry.name),
    );
    if let Some(picture) = &entry.picture {
        let _ = writeln!(out, "<img src=\"{picture}\" alt=\"{}\" loading=\"lazy\">", escaped(&entry.name));
    }
    if !entry.facts.is_empty() {
        let _ = writeln!(out, "<p class=\"facts\">{}</p>", escaped(&entry.facts.join(" · ")));
    }
    if let Some(text) = &entry.doc {
        out.push_str(&doc(text));
    }
    let groups = [
        Group::Parameter,
        Group::Joint,
        Group::Port,
        Group::Part,
        Group::Let,
        Group::Behavior,
        Group::Field,
        Group::Method,
    ];
    for group in groups {
        let inside: Vec<&Inside> = entry.inside.iter().filter(|i| i.group == group).collect();
        if !inside.is_empty() {
            out.push_str(&list(entry, group, &inside, doc));
        }
    }
    out + "</section>\n"
}

/// Returns the list of a group of members.
fn list(entry: &PageEntry, group: Group, inside: &[&Inside], doc: Doc) -> String {
    let heading = if group == Group::Let { "value" } else { group.word() };
    let mut out = format!("<h3>{heading}s</h3>\n<dl>\n");
    for i in inside {
        let id = format!("{}.{}", entry.name, i.name);
        let _ = writeln!(out, "<dt id=\"{id}\"><code>{}</code></dt>", coloured(&i.head), id = escaped(&id));
        for clause in &i.contracts {
            let _ = writeln!(out, "<dd><code>{}</code></dd>", coloured(clause));
        }
        if let Some(text) = &i.doc {
            let _ = writeln!(out, "<dd>{}</dd>", doc(text));
        }
    }
    out + "</dl>\n"
}

/// Returns a signature, with each parameter on a line if it is long.
fn wrapped(signature: &str) -> String {
    const WIDTH: usize = 90;
    if signature.len() <= WIDTH {
        return signature.to_owned();
    }
    let mut depth = 0usize;
    let mut out = String::new();
    for c in signature.chars() {
        match c {
            '(' | '[' | '<' | '{' => depth += 1,
            ')' | ']' | '>' | '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        match c {
            '(' if depth == 1 => out.push_str("(\n  "),
            ',' if depth == 1 => out.push_str(",\n  "),
            ' ' if out.ends_with("\n  ") => {}
            ')' if depth == 0 => out.push_str("\n)"),
            c => out.push(c),
        }
    }
    out
}
