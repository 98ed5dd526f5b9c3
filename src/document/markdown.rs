//! Markdown to HTML. The name of a declaration in brackets is a link to it; programs are coloured.

use crate::syntax::{Class, classes};
use pulldown_cmark::{
    BrokenLink, CodeBlockKind, CowStr, Event, HeadingLevel, LinkType, Options, Parser, Tag, TagEnd, html,
};
use std::collections::BTreeSet;

/// The declarations and files that links in documentation can lead to.
pub(super) trait Targets {
    /// Returns the address of a declaration, or of a member after a dot, relative to the current page; `None`
    /// if there is none.
    fn name(&self, name: &str) -> Option<String>;

    /// Returns the address in the site of the target of a link as it is written; `None` if there is none.
    fn link(&self, to: &str) -> Option<String>;

    /// Returns true if a link that leads nowhere is shown as its words, and is not an error.
    fn is_lenient(&self) -> bool {
        false
    }
}

/// A text that was converted to HTML.
#[derive(Debug, Default)]
pub(super) struct Converted {
    /// The text as HTML.
    pub html: String,
    /// The targets of its broken links, as they are written.
    pub lost: Vec<String>,
    /// Its headings below the first level with their places in the text, in order.
    pub headings: Vec<Heading>,
}

/// A heading, and what stands below it up to the next.
#[derive(Debug)]
pub(super) struct Heading {
    /// Its level, 2 for those below the title.
    pub level: usize,
    /// Its words, without markup.
    pub title: String,
    /// The identifier of its element in the page.
    pub anchor: String,
    /// The words below it, without markup and without blocks of code.
    pub words: String,
}

/// Converts a Markdown text to HTML. HTML in the text is shown as text, comments are left out. `anchored`: true to give
/// headings an identifier each.
pub(super) fn to_html(text: &str, targets: &dyn Targets, anchored: bool) -> Converted {
    let mut converted = Converted::default();
    let mut lost_names = Vec::new();
    let mut resolve = |link: BrokenLink| {
        let name = bare(&link.reference);
        let is_name = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '.');
        let found = is_name.then(|| targets.name(name)).flatten();
        if found.is_none() && is_name && link.reference.starts_with('`') && !targets.is_lenient() {
            lost_names.push(link.reference.to_string());
        }
        found.map(|address| (CowStr::from(address), CowStr::from("")))
    };
    let parser = Parser::new_with_broken_link_callback(text, Options::ENABLE_TABLES, Some(&mut resolve));
    let mut events: Vec<Event> = Vec::new();
    // The links that are open: true for one that is shown as its words alone.
    let mut bare_links = Vec::new();
    let mut code: Option<(bool, String)> = None;
    for event in parser {
        match event {
            Event::Start(Tag::CodeBlock(kind)) => {
                let program = matches!(&kind, CodeBlockKind::Fenced(words) if is_program(words));
                code = Some((program, String::new()));
            }
            Event::End(TagEnd::CodeBlock) => {
                let (program, text) = code.take().unwrap_or_default();
                let shown = if program { coloured(&text) } else { super::html::escaped(&text) };
                events.push(Event::Html(format!("<pre><code>{shown}</code></pre>\n").into()));
            }
            Event::Text(text) if code.is_some() => {
                if let Some((_, all)) = &mut code {
                    all.push_str(&text);
                }
            }
            Event::End(TagEnd::Link) => {
                if !bare_links.pop().unwrap_or(false) {
                    events.push(event);
                }
            }
            Event::Start(Tag::Link { .. }) => {
                let event = followed(event, targets, &mut converted.lost);
                bare_links.push(event.is_none());
                events.extend(event);
            }
            Event::Html(text) | Event::InlineHtml(text) if is_comment(&text) => {}
            // Markup in the documentation is shown as text.
            Event::Html(text) | Event::InlineHtml(text) => events.push(Event::Text(text)),
            event => events.extend(followed(event, targets, &mut converted.lost)),
        }
    }
    if anchored {
        converted.headings = anchor_headings(&mut events);
    }
    html::push_html(&mut converted.html, events.into_iter());
    converted.lost.extend(lost_names);
    converted
}

/// Returns the anchor of a heading, as GitHub makes it: words in lower case, joined by hyphens.
pub(super) fn anchor(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Returns a piece of a program as HTML, in colours.
pub(super) fn coloured(text: &str) -> String {
    let mut out = String::new();
    let mut at = 0;
    for (range, class) in classes(text) {
        out.push_str(&super::html::escaped(&text[at..range.start]));
        let class = match class {
            Class::Keyword => "k",
            Class::Type => "t",
            Class::Number => "n",
            Class::Text => "s",
            Class::Comment => "c",
        };
        let piece = super::html::escaped(&text[range.clone()]);
        out.push_str(&format!("<span class=\"{class}\">{piece}</span>"));
        at = range.end;
    }
    out + &super::html::escaped(&text[at..])
}

/// Returns true if a block of code with these words behind its fence is a program of modl.
fn is_program(words: &str) -> bool {
    words.split_whitespace().next() == Some("modl")
}

fn is_comment(html: &str) -> bool {
    let text = html.trim();
    text.starts_with("<!--") && text.ends_with("-->")
}

/// Gives headings identifiers, each its own, and returns those below the first level.
fn anchor_headings(events: &mut [Event]) -> Vec<Heading> {
    let mut headings: Vec<Heading> = Vec::new();
    let mut taken = BTreeSet::new();
    let mut open: Option<(usize, HeadingLevel, String)> = None;
    let mut identifiers: Vec<(usize, String)> = Vec::new();
    for (at, event) in events.iter().enumerate() {
        match (&mut open, event) {
            (_, Event::Start(Tag::Heading { level, .. })) => open = Some((at, *level, String::new())),
            (Some((start, level, title)), Event::End(TagEnd::Heading(_))) => {
                let first = anchor(title);
                let mut own = first.clone();
                let mut number = 0;
                while !taken.insert(own.clone()) {
                    number += 1;
                    own = format!("{first}-{number}");
                }
                identifiers.push((*start, own.clone()));
                if *level != HeadingLevel::H1 {
                    let (level, title) = (*level as usize, std::mem::take(title));
                    headings.push(Heading { level, title, anchor: own, words: String::new() });
                }
                open = None;
            }
            (Some((_, _, title)), Event::Text(text) | Event::Code(text)) => title.push_str(text),
            (None, Event::Text(text) | Event::Code(text)) => {
                if let Some(heading) = headings.last_mut() {
                    heading.words.push_str(text);
                }
            }
            (None, Event::SoftBreak | Event::End(_)) => {
                if let Some(heading) = headings.last_mut() {
                    heading.words.push(' ');
                }
            }
            _ => {}
        }
    }
    for (at, own) in identifiers {
        if let Event::Start(Tag::Heading { id, .. }) = &mut events[at] {
            *id = Some(own.into());
        }
    }
    headings
}

fn bare(reference: &str) -> &str {
    reference.trim_matches('`')
}

/// Resolves a link, `[text](Name)`, `[text](file.md)`, `[text](https://...)`, or one by reference. Images are
/// files of the project. `None` for a link that is shown as its words.
fn followed<'e>(event: Event<'e>, targets: &dyn Targets, lost: &mut Vec<String>) -> Option<Event<'e>> {
    Some(match event {
        Event::Start(Tag::Link { link_type, dest_url, title, id }) if !is_resolved(link_type) => {
            let address =
                if leads_out(&dest_url) { Some(dest_url.to_string()) } else { targets.link(&dest_url) };
            if address.is_none() && targets.is_lenient() {
                return None;
            }
            let dest_url = found(dest_url, address, lost);
            Event::Start(Tag::Link { link_type, dest_url, title, id })
        }
        Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
            let address = targets.link(&dest_url);
            let dest_url = found(dest_url, address, lost);
            Event::Start(Tag::Image { link_type, dest_url, title, id })
        }
        other => other,
    })
}

/// Returns true if a link leads to a declaration that was found, or to a mail address, which is no address of a
/// page.
fn is_resolved(link_type: LinkType) -> bool {
    matches!(
        link_type,
        LinkType::ReferenceUnknown | LinkType::CollapsedUnknown | LinkType::ShortcutUnknown | LinkType::Email
    )
}

/// Returns the address of a link. A broken one is recorded and leads nowhere: what is no address that is known
/// (`javascript:`, `data:`, `file:`, ...) does not get into the site.
fn found<'e>(to: CowStr<'e>, address: Option<String>, lost: &mut Vec<String>) -> CowStr<'e> {
    match address {
        Some(address) => CowStr::from(address),
        None => {
            lost.push(to.to_string());
            CowStr::from("#")
        }
    }
}

/// Returns true if a link leads out of the site in a way that it may.
fn leads_out(to: &str) -> bool {
    ["https://", "http://", "mailto:"].iter().any(|scheme| to.starts_with(scheme))
}
