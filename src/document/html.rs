//! The pages of the site: plain HTML that works from a file.

use super::outline::{Page, PageEntry};
use crate::check::summary::{Group, Inside};
use std::fmt::Write as _;

/// The style sheet (CSS) of the documentation site.
pub(super) const STYLE: &str = include_str!("site.css");
/// The script (JavaScript) of the documentation site's search.
pub(super) const SCRIPT: &str = include_str!("search.js");

/// A function that converts a piece of documentation from Markdown to HTML.
pub(super) type Doc<'d> = &'d mut dyn FnMut(&str) -> String;

/// Returns text escaped for HTML, also for attributes in double quotes.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns a whole page around its body.
fn frame(title: &str, pages: &[Page], body: &str) -> String {
    let links: String = pages.iter().map(|page| link(&page.file, &page.title)).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
         <link rel=\"stylesheet\" href=\"site.css\">\n</head>\n<body>\n<nav>\n\
         <input id=\"search\" type=\"search\" placeholder=\"Search\" aria-label=\"Search\">\n\
         <ul id=\"found\"></ul>\n<ul>\n{}{}{links}</ul>\n</nav>\n<main>\n{body}</main>\n\
         <script src=\"index.js\"></script>\n<script src=\"search.js\"></script>\n</body>\n</html>\n",
        link("index.html", "All"),
        link("guide.html", "Guide to the robots"),
        title = escaped(title),
    )
}

fn link(to: &str, words: &str) -> String {
    format!("<li><a href=\"{to}\">{}</a></li>\n", escaped(words))
}

/// Returns the page of a file as HTML, with links to all `pages`.
pub(super) fn page(page: &Page, pages: &[Page], doc: Doc) -> String {
    let mut body = format!("<h1>{}</h1>\n", escaped(&page.title));
    if let Some(text) = &page.doc {
        body.push_str(&doc(text));
    }
    for entry in &page.entries {
        body.push_str(&section(entry, doc));
    }
    frame(&page.title, pages, &body)
}

/// Returns the section of a declaration.
fn section(entry: &PageEntry, doc: Doc) -> String {
    let mut out = format!(
        "<section id=\"{name}\">\n<h2><a href=\"#{name}\">{name}</a> <small>{}</small></h2>\n\
         <pre class=\"signature\">{}</pre>\n",
        entry.word,
        escaped(&wrapped(&entry.signature)),
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
        let _ = writeln!(out, "<dt id=\"{id}\"><code>{}</code></dt>", escaped(&i.head), id = escaped(&id));
        for clause in &i.contracts {
            let _ = writeln!(out, "<dd><code>{}</code></dd>", escaped(clause));
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

/// Returns the front page as HTML: all declarations, page by page.
pub(super) fn index(pages: &[Page]) -> String {
    let mut body = String::from("<h1>Documentation</h1>\n");
    for page in pages {
        let _ = writeln!(
            body,
            "<h2><a href=\"{}\">{}</a></h2>\n<ul class=\"names\">",
            page.file,
            escaped(&page.title)
        );
        for entry in &page.entries {
            let _ = writeln!(
                body,
                "<li><a href=\"{}#{name}\">{name}</a> <small>{}</small></li>",
                page.file,
                entry.word,
                name = escaped(&entry.name)
            );
        }
        body.push_str("</ul>\n");
    }
    frame("Documentation", pages, &body)
}

/// Returns the guide as HTML: all configurations with their behaviours, by ascending order (depth of composition);
/// those without a default instance last.
pub(super) fn guide(pages: &[Page], doc: Doc) -> String {
    let mut body = String::from(
        "<h1>Guide to the robots</h1>\n<p>A configuration of order 1 is made of modules; one of order 2, of \
         configurations of order 1 and modules; and so on.</p>\n",
    );
    let all = pages.iter().flat_map(|page| page.entries.iter().map(move |entry| (page, entry)));
    let mut configs: Vec<(u32, &Page, &PageEntry)> =
        all.filter_map(|(page, entry)| Some((entry.order?, page, entry))).collect();
    configs.sort_by_key(|(order, _, _)| *order);
    // A configuration without a default instance has no known order.
    let sized = |(_, entry): &(&Page, &PageEntry)| entry.word == "config" && entry.order.is_none();
    let all = pages.iter().flat_map(|page| page.entries.iter().map(move |entry| (page, entry)));
    let open = all.filter(sized).map(|(page, entry)| (None, page, entry));
    let mut last = None;
    for (order, page, entry) in configs.into_iter().map(|(order, p, e)| (Some(order), p, e)).chain(open) {
        if last != Some(order) {
            let title = order.map_or_else(|| "Of a size to be given".to_owned(), |n| format!("Order {n}"));
            let _ = writeln!(body, "<h2>{title}</h2>");
            last = Some(order);
        }
        let _ = writeln!(
            body,
            "<section>\n<h3><a href=\"{}#{name}\">{name}</a> <small>{} · {}</small></h3>",
            page.file,
            escaped(&page.title),
            escaped(&entry.facts.join(" · ")),
            name = escaped(&entry.name)
        );
        if let Some(picture) = &entry.picture {
            let _ =
                writeln!(body, "<img src=\"{picture}\" alt=\"{}\" loading=\"lazy\">", escaped(&entry.name));
        }
        if let Some(text) = &entry.doc {
            body.push_str(&doc(text.trim().split("\n\n").next().unwrap_or("")));
        }
        let behaviors: Vec<&Inside> = entry.inside.iter().filter(|i| i.group == Group::Behavior).collect();
        if !behaviors.is_empty() {
            let shown = behaviors.iter().map(|b| format!("<code>{}</code>", escaped(&b.head)));
            let _ = writeln!(body, "<p>{}</p>", shown.collect::<Vec<_>>().join(" "));
        }
        body.push_str("</section>\n");
    }
    frame("Guide to the robots", pages, &body)
}

/// Returns the search index as the text of a script, with [name, description, address] of each declaration and member.
pub(super) fn search_index(pages: &[Page]) -> String {
    let mut rows = Vec::new();
    for page in pages {
        for entry in &page.entries {
            let about = entry.doc.as_deref().unwrap_or("").lines().next().unwrap_or("");
            let address = format!("{}#{}", page.file, entry.name);
            rows.push([entry.name.clone(), format!("{} · {} · {about}", entry.word, page.title), address]);
            for i in &entry.inside {
                let name = format!("{}.{}", entry.name, i.name);
                let about = i.doc.as_deref().unwrap_or("").lines().next().unwrap_or("");
                let address = format!("{}#{name}", page.file);
                rows.push([name, format!("{} · {} · {about}", i.group.word(), page.title), address]);
            }
        }
    }
    let json = serde_json::to_string(&rows).expect("texts are plain data");
    // No text in it can end the script element.
    format!("const INDEX = {};\n", json.replace('<', "\\u003c"))
}
