//! The whole site: its pages, its files, and broken links.

use super::front;
use super::html::{self, Shell};
use super::manual::{self, Manual, ManualPage};
use super::markdown::{Converted, Heading, Targets, to_html};
use super::outline::{Page, PageEntry, page};
use super::pictures::{Drawing, draw};
use super::search::search_index;
use crate::check::{self, Checked, Entry};
use crate::interrupt::CancelState;
use crate::source::{Diagnostic, FileId, Files, library};
use crate::syntax;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// The input of [`site`]: a project, with the choice of what to document.
pub struct Request<'r> {
    /// The access to the files of the project.
    pub files: &'r dyn Files,
    /// The paths of the project's programs, from its root, in the order of the pages.
    pub programs: &'r [String],
    /// The manual of modl, where it and the standard library are part of the site.
    pub manual: Option<&'r Manual>,
    /// The state by which the user cancels the drawing of pictures.
    pub cancel_state: CancelState,
    /// The drawings of an earlier site, by the program that made them; those whose files are as they were are not
    /// made anew.
    pub known: &'r BTreeMap<String, Drawing>,
}

/// The site that [`site`] made, as files that are not written yet, with the mistakes found on the way.
pub struct Site {
    /// The files as (name in the site, contents).
    pub files: Vec<(String, Vec<u8>)>,
    /// The broken links in documentation, page by page.
    pub faults: Vec<LinkFault>,
    /// The programs that are left out because of errors, as (checked program, its errors).
    pub wrong: Vec<(Checked, Vec<Diagnostic>)>,
    /// The drawings on the site's pages by the program that made them, for the next site.
    pub drawings: BTreeMap<String, Drawing>,
}

/// A link in documentation whose target the site does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkFault {
    /// The title of the page that contains the link: `std.smores`, or the path of a program.
    pub file: String,
    /// The declaration whose documentation contains the link; empty for the documentation of a file.
    pub entry: String,
    /// The target of the link as it is written.
    pub link: String,
}

/// Returns the documentation site of a project, as files that work without a server: a page for each program and
/// library file, an index, a guide and a search. Mistakes in programs and links are part of the result. Nothing is
/// written.
pub fn site(request: &Request) -> Site {
    let mut site =
        Site { files: Vec::new(), faults: Vec::new(), wrong: Vec::new(), drawings: BTreeMap::new() };
    let mut pages = Vec::new();
    for path in request.programs {
        // Private names are left out.
        let checked = check::check(request.files, path);
        let errors: Vec<Diagnostic> = checked.diagnostics.iter().filter(|d| d.is_error()).cloned().collect();
        let file = checked.sources.files().find(|(_, f)| &*f.name == path.as_str()).map(|(id, _)| id);
        match file {
            Some(file) if errors.is_empty() => pages.extend(page_of(&checked, file)),
            _ => site.wrong.push((checked, errors)),
        }
    }
    if request.manual.is_some() {
        pages.extend(library_pages(request.files));
    }
    for page in &mut pages {
        draw(page, request, &mut site.drawings);
    }
    site.files.extend(site.drawings.values().filter_map(|drawing| drawing.picture.clone()));
    write(&pages, request, &mut site);
    site
}

fn page_of(checked: &Checked, file: FileId) -> Option<Page> {
    let doc = syntax::parse(file, &checked.sources.file(file).text).file.doc;
    page(checked, file, doc)
}

/// Returns the page of every file of the standard library; the prelude last, since it is the longest.
fn library_pages(files: &dyn Files) -> Vec<Page> {
    let names = library::FILES.iter().filter_map(|(name, _)| name.strip_suffix(".mod"));
    let uses: Vec<String> = names.filter(|n| *n != "prelude").map(|n| format!("use std.{n}\n")).collect();
    let text = uses.concat();
    let cell = Entry { name: "<documentation>".into(), text, first_line: 1, value: None, last: None };
    let checked = check::check_session(files, &[cell]);
    let library: Vec<FileId> = checked.sources.files().filter(|(_, f)| f.library).map(|(id, _)| id).collect();
    let mut pages: Vec<Page> = library.into_iter().filter_map(|file| page_of(&checked, file)).collect();
    pages.sort_by_key(|page| (page.title == "prelude", page.title.clone()));
    pages
}

/// Adds the files of a site to `site`: a page for each of `pages`, the manual, the guide, the index, and what they link to;
/// and the broken links of the pages.
fn write(pages: &[Page], request: &Request, site: &mut Site) {
    let addresses = addresses(pages);
    let taken = RefCell::default();
    let groups = request.manual.map_or_else(Vec::new, Manual::pages);
    let shell = Shell { pages, manual: &groups };
    let mut add = |name: &str, text: String| site.files.push((name.to_owned(), text.into_bytes()));
    let mut faults = Vec::new();
    let mut texts = Vec::new();
    for page in pages {
        let links = Links { addresses: &addresses, page, files: request.files, taken: &taken };
        let mut doc = |text: &str| {
            let Converted { html, lost, .. } = to_html(text, &links, false);
            let entry = page.entries.iter().find(|entry| stands_in(entry, text));
            let entry = entry.map_or_else(String::new, |entry| entry.name.clone());
            faults.extend(lost.into_iter().map(|link| LinkFault {
                file: page.title.clone(),
                entry: entry.clone(),
                link,
            }));
            html
        };
        texts.push((page.file.clone(), html::page(page, &shell, &mut doc)));
    }
    for (name, text) in texts {
        add(&name, text);
    }
    let mut converted: Vec<(&ManualPage, Converted)> = Vec::new();
    if let Some(manual) = request.manual {
        let all = groups.iter().flat_map(|(_, pages)| pages);
        converted.extend(all.map(|page| (page, manual::converted(manual, page, pages))));
    }
    for (page, text) in &converted {
        add(&page.file, html::manual_page(page, &shell, text));
    }
    let home = Page { title: String::new(), file: String::new(), doc: None, entries: Vec::new() };
    let links = Links { addresses: &addresses, page: &home, files: request.files, taken: &taken };
    // Broken links in it have been recorded with their declarations.
    let mut doc = |text: &str| to_html(text, &links, false).html;
    add("guide.html", front::guide(&shell, &mut doc));
    add("index.html", front::index(&shell, &mut doc));
    let sections: Vec<(&ManualPage, &[Heading])> =
        converted.iter().map(|(page, text)| (*page, text.headings.as_slice())).collect();
    add("index.js", search_index(pages, &sections));
    for (name, text) in html::SHARED {
        add(name, text.to_owned());
    }
    site.files.extend(taken.into_inner());
    site.files.extend(request.manual.into_iter().flat_map(Manual::site_files));
    site.faults = faults;
}

fn stands_in(entry: &PageEntry, text: &str) -> bool {
    entry.doc.as_deref() == Some(text) || entry.inside.iter().any(|i| i.doc.as_deref() == Some(text))
}

/// Returns the addresses of names, by name: of a declaration, or a member after a dot, each with the title of
/// its page.
fn addresses(pages: &[Page]) -> BTreeMap<String, Vec<(String, String)>> {
    let mut found: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    for page in pages {
        for entry in &page.entries {
            let inside = entry.inside.iter().map(|i| format!("{}.{}", entry.name, i.name));
            for name in std::iter::once(entry.name.clone()).chain(inside) {
                let address = format!("{}#{name}", page.file);
                found.entry(name).or_default().push((page.title.clone(), address));
            }
        }
    }
    found
}

struct Links<'l> {
    addresses: &'l BTreeMap<String, Vec<(String, String)>>,
    page: &'l Page,
    files: &'l dyn Files,
    /// Files of the project that pages lead to, by their names in the site.
    taken: &'l RefCell<BTreeMap<String, Vec<u8>>>,
}

impl Links<'_> {
    /// Returns the address of a file of the project, and takes it along into the site; `None` if it can't be read.
    fn file(&self, path: &str) -> Option<String> {
        if path.is_empty() || path.split('/').any(|part| part == "..") {
            return None;
        }
        let bytes = self.files.read(path).ok()?;
        let name = format!("files/{path}");
        self.taken.borrow_mut().insert(name.clone(), bytes);
        Some(name)
    }
}

impl Targets for Links<'_> {
    /// Prefers a declaration of the page itself.
    fn name(&self, name: &str) -> Option<String> {
        let found = self.addresses.get(name)?;
        let own = found.iter().find(|(page, _)| *page == self.page.title);
        own.or(found.first()).map(|(_, address)| address.clone())
    }

    /// Returns the address of a declaration or of a file.
    fn link(&self, to: &str) -> Option<String> {
        if let Some(address) = self.name(to.trim_start_matches('#').trim_matches('`')) {
            return Some(address);
        }
        let (path, place) = to.split_once('#').map_or((to, None), |(path, place)| (path, Some(place)));
        let file = self.file(path)?;
        Some(place.map_or_else(|| file.clone(), |place| format!("{file}#{place}")))
    }
}
