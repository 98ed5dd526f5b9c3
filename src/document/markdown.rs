//! Markdown to HTML. The name of a declaration in brackets is a link to it.

use pulldown_cmark::{BrokenLink, CowStr, Event, LinkType, Options, Parser, Tag, html};

/// The declarations and files that links in documentation can lead to.
pub(super) trait Targets {
    /// Returns the address of a declaration, or of a member after a dot, relative to the current page; `None`
    /// if there is none.
    fn address(&self, name: &str) -> Option<String>;

    /// Returns the address in the site of a file of the project; `None` if it can't be read.
    fn file(&self, path: &str) -> Option<String>;
}

/// Converts a Markdown text to HTML. Returns (HTML, targets): the text, and the targets of its broken links, as they
/// are written. HTML in the text is shown as text.
pub(super) fn to_html(text: &str, targets: &dyn Targets) -> (String, Vec<String>) {
    let mut lost = Vec::new();
    let mut lost_names = Vec::new();
    let mut resolve = |link: BrokenLink| {
        let name = bare(&link.reference);
        let is_name = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '.');
        let found = is_name.then(|| targets.address(name)).flatten();
        if found.is_none() && is_name && link.reference.starts_with('`') {
            lost_names.push(link.reference.to_string());
        }
        found.map(|address| (CowStr::from(address), CowStr::from("")))
    };
    let parser = Parser::new_with_broken_link_callback(text, Options::ENABLE_TABLES, Some(&mut resolve));
    let events: Vec<Event> = parser.map(|event| followed(event, targets, &mut lost)).collect();
    let mut out = String::new();
    html::push_html(&mut out, events.into_iter());
    lost.extend(lost_names);
    (out, lost)
}

fn bare(reference: &str) -> &str {
    reference.trim_matches('`')
}

/// Resolves a link, `[text](Name)`, `[text](file.md)`, `[text](https://...)`, or one by reference. Images are
/// files of the project.
fn followed<'e>(event: Event<'e>, targets: &dyn Targets, lost: &mut Vec<String>) -> Event<'e> {
    match event {
        Event::Start(Tag::Link { link_type, dest_url, title, id }) if !is_resolved(link_type) => {
            let address =
                if leads_out(&dest_url) { Some(dest_url.to_string()) } else { within(&dest_url, targets) };
            let dest_url = found(dest_url, address, lost);
            Event::Start(Tag::Link { link_type, dest_url, title, id })
        }
        Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
            let address = within(&dest_url, targets);
            let dest_url = found(dest_url, address, lost);
            Event::Start(Tag::Image { link_type, dest_url, title, id })
        }
        // Markup in the documentation is shown as text.
        Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
        other => other,
    }
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

/// Returns the address in the site of a declaration or a file; `None` if there is none.
fn within(to: &str, targets: &dyn Targets) -> Option<String> {
    if let Some(address) = targets.address(bare(to.trim_start_matches('#'))) {
        return Some(address);
    }
    let (path, place) = to.split_once('#').map_or((to, None), |(path, place)| (path, Some(place)));
    let file = targets.file(path)?;
    Some(place.map_or_else(|| file.clone(), |place| format!("{file}#{place}")))
}
