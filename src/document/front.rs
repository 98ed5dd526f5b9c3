//! The front page of the site, and the guide to the robots.

use super::html::{Doc, Shell, escaped};
use super::markdown::{anchor, coloured};
use super::outline::{Page, PageEntry};
use crate::check::summary::{Group, Inside};
use std::fmt::Write as _;

/// Returns the front page as HTML: pictures of the robots, those of the project first, and all declarations, page by page.
pub(super) fn index(shell: &Shell, doc: Doc) -> String {
    let mut body = String::from("<h1>Documentation</h1>\n");
    if let Some((_, pages)) = shell.manual.first() {
        let links =
            pages.iter().map(|page| format!("<a href=\"{}\">{}</a>", page.file, escaped(&page.title)));
        let _ = writeln!(body, "<p class=\"first\">{}</p>", links.collect::<Vec<_>>().join(" · "));
    }
    for (title, library) in [("Robots of these programs", false), ("Robots of the library", true)] {
        let pages = shell.pages.iter().filter(|page| page.is_of_library() == library);
        let cards: String = pages
            .flat_map(|page| page.entries.iter().map(move |entry| (page, entry)))
            .filter_map(|(page, entry)| card(page, entry, doc))
            .collect();
        if !cards.is_empty() {
            let _ = writeln!(body, "<h2>{title}</h2>\n<div class=\"cards\">\n{cards}</div>");
        }
    }
    for page in shell.pages {
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
    shell.frame("Documentation", &[], &body)
}

/// Returns the card of a declaration: its picture, its name, and the first sentence about it; `None` without a picture.
fn card(page: &Page, entry: &PageEntry, doc: Doc) -> Option<String> {
    let picture = entry.picture.as_ref()?;
    let name = escaped(&entry.name);
    let about = doc(first_sentence(entry.doc.as_deref().unwrap_or_default()));
    Some(format!(
        "<div class=\"card\"><a href=\"{}#{name}\"><img src=\"{picture}\" alt=\"\" loading=\"lazy\"><b>{name}</b></a>\n{about}</div>\n",
        page.file
    ))
}

/// Returns the first sentence of a text in Markdown, or its first paragraph where none ends in it.
fn first_sentence(text: &str) -> &str {
    let paragraph = text.trim().split("\n\n").next().unwrap_or_default();
    paragraph.find(". ").or_else(|| paragraph.find(".\n")).map_or(paragraph, |end| &paragraph[..=end])
}

/// Returns the guide as HTML: all configurations with their behaviours, by ascending order (depth of composition);
/// those without a default instance last.
pub(super) fn guide(shell: &Shell, doc: Doc) -> String {
    let mut body = String::from(
        "<h1>Guide to the robots</h1>\n<p>A configuration of order 1 is made of modules; one of order 2, of \
         configurations of order 1 and modules; and so on.</p>\n",
    );
    let pages = shell.pages;
    let all = pages.iter().flat_map(|page| page.entries.iter().map(move |entry| (page, entry)));
    let mut configs: Vec<(u32, &Page, &PageEntry)> =
        all.filter_map(|(page, entry)| Some((entry.order?, page, entry))).collect();
    configs.sort_by_key(|(order, _, _)| *order);
    // A configuration without a default instance has no known order.
    let sized = |(_, entry): &(&Page, &PageEntry)| entry.word == "config" && entry.order.is_none();
    let all = pages.iter().flat_map(|page| page.entries.iter().map(move |entry| (page, entry)));
    let open = all.filter(sized).map(|(page, entry)| (None, page, entry));
    let mut last = None;
    let mut places = Vec::new();
    for (order, page, entry) in configs.into_iter().map(|(order, p, e)| (Some(order), p, e)).chain(open) {
        if last != Some(order) {
            let title = order.map_or_else(|| "Of a size to be given".to_owned(), |n| format!("Order {n}"));
            let anchor = anchor(&title);
            let _ = writeln!(body, "<h2 id=\"{anchor}\">{title}</h2>");
            places.push((2, anchor, title));
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
            let shown = behaviors.iter().map(|b| format!("<code>{}</code>", coloured(&b.head)));
            let _ = writeln!(body, "<p>{}</p>", shown.collect::<Vec<_>>().join(" "));
        }
        body.push_str("</section>\n");
    }
    shell.frame("Guide to the robots", &places, &body)
}
