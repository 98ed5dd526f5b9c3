//! The manual of modl in the site: the pages of `docs/` that its users read, and those about diagnostic codes, which are
//! embedded here.

use super::markdown::{Converted, Targets, anchor, to_html};
use super::outline::Page;

/// A page of the manual.
pub(super) struct ManualPage {
    /// The path of its text below `docs/`; `errors/` for the page of all diagnostic codes.
    pub path: &'static str,
    /// The name of its file in the site.
    pub file: String,
    /// Its first heading, without markup.
    pub title: String,
    /// Its text, Markdown, with the first heading.
    pub text: String,
}

/// The manual as its texts, each paired with its path.
#[derive(Clone, Copy, Debug)]
pub struct Manual {
    /// The groups of pages in their order, each with its title; the texts (Markdown) by path below `docs/`. The page of all
    /// diagnostic codes is added to the first.
    pub groups: &'static [(&'static str, &'static [(&'static str, &'static str)])],
    /// The files that pages lead to, by path from the root of the repository.
    pub files: &'static [(&'static str, &'static str)],
}

/// The path of the page of all diagnostic codes.
const ERRORS: &str = "errors/";

/// Pairs names of files below `docs/errors/` with their texts.
macro_rules! embed {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../docs/errors/", $name)))),*]
    };
}

/// The file and page of each diagnostic code, by code.
const CODES: &[(&str, &str)] = embed![
    "E0001.md", "E0002.md", "E0003.md", "E0004.md", "E0005.md", "E0006.md", "E0007.md", "E0008.md",
    "E0009.md", "E0010.md", "E0101.md", "E0102.md", "E0103.md", "E0104.md", "E0105.md", "E0106.md",
    "E0107.md", "E0108.md", "E0201.md", "E0202.md", "E0203.md", "E0204.md", "E0205.md", "E0206.md",
    "E0207.md", "E0208.md", "E0209.md", "E0210.md", "E0211.md", "E0301.md", "E0302.md", "E0303.md",
    "E0304.md", "E0305.md", "E0306.md", "E0307.md", "E0308.md", "E0309.md", "E0310.md", "E0311.md",
    "E0312.md", "E0313.md", "E0314.md", "E0315.md", "E0316.md", "E0317.md", "E0318.md", "E0319.md",
    "E0320.md", "E0401.md", "E0402.md", "E0403.md", "E0404.md", "E0405.md", "E0406.md", "E0407.md",
    "E0408.md", "E0409.md", "E0410.md", "E0411.md", "E0501.md", "E0502.md", "E0503.md", "E0504.md",
    "E0505.md", "E0506.md", "E0507.md", "E0508.md", "E0509.md", "E0510.md", "E0511.md", "E0601.md",
    "E0602.md", "E0603.md", "E0604.md", "E0605.md", "E0606.md", "E0607.md", "E0608.md", "E0609.md",
    "E0610.md", "E0611.md", "E0612.md", "E0613.md", "E0614.md", "E0615.md", "E0701.md", "E0702.md",
    "E0703.md", "E0704.md", "E0705.md", "E0706.md", "E0707.md", "E0801.md", "E0802.md", "E0803.md",
    "E0804.md", "E0805.md", "E0806.md", "E0807.md", "W0001.md", "W0002.md", "W0003.md", "W0004.md",
    "W0005.md", "W0006.md", "W0007.md", "W0008.md", "W0009.md", "W0010.md", "N0001.md",
];

/// Returns the page of explanation of a diagnostic code, such as `E0301`, Markdown; `None` if there is no such code.
pub fn page_of_code(code: &str) -> Option<&'static str> {
    CODES.iter().find(|(known, _)| known.strip_suffix(".md") == Some(code)).map(|(_, page)| *page)
}

impl Manual {
    /// Returns the groups of pages in their order, each with its title.
    pub(super) fn pages(&self) -> Vec<(&'static str, Vec<ManualPage>)> {
        let page = |&(path, text): &(&'static str, &str)| ManualPage {
            path,
            file: file_of(path),
            title: text.lines().next().unwrap_or_default().trim_start_matches("# ").replace('`', ""),
            text: text.to_owned(),
        };
        let mut groups: Vec<_> = self
            .groups
            .iter()
            .map(|(title, pages)| (*title, pages.iter().map(page).collect::<Vec<_>>()))
            .collect();
        if let Some((_, pages)) = groups.first_mut() {
            pages.push(errors());
        }
        groups
    }

    /// Returns the files that pages lead to, as (name in the site, contents).
    pub(super) fn site_files(&self) -> impl Iterator<Item = (String, Vec<u8>)> {
        self.files.iter().map(|(path, text)| (site_file(path), text.as_bytes().to_vec()))
    }
}

/// Returns the page of all diagnostic codes.
fn errors() -> ManualPage {
    // The titles of their pages are headings of its sections.
    let codes = CODES.iter().map(|(_, text)| text.replacen("# ", "## ", 1));
    ManualPage {
        path: ERRORS,
        file: file_of(ERRORS),
        title: "Errors, warnings and notes".to_owned(),
        text: format!("# Errors, warnings and notes\n\n{}", codes.collect::<Vec<_>>().join("\n\n")),
    }
}

/// Returns the name in the site of the page of a text below `docs/`.
fn file_of(path: &str) -> String {
    format!("manual-{}.html", path.trim_end_matches(".md").trim_end_matches('/').replace(['/', '_'], "-"))
}

/// Returns a page of a manual as HTML. `pages`: the pages about programs and the library.
pub(super) fn converted(manual: &Manual, page: &ManualPage, pages: &[Page]) -> Converted {
    to_html(&page.text, &ManualTargets { manual, path: page.path, pages }, true)
}

/// The targets of links in a page of the manual.
struct ManualTargets<'m> {
    manual: &'m Manual,
    /// The path of the page's text below `docs/`.
    path: &'m str,
    /// The pages about programs and the library.
    pages: &'m [Page],
}

impl Targets for ManualTargets<'_> {
    fn name(&self, _: &str) -> Option<String> {
        // Brackets in the manual are no links by name.
        None
    }

    fn link(&self, to: &str) -> Option<String> {
        let (path, place) = to.split_once('#').map_or((to, None), |(path, place)| (path, Some(place)));
        let with_place = |file: String| place.map_or_else(|| file.clone(), |place| format!("{file}#{place}"));
        if path.is_empty() {
            return Some(to.to_owned());
        }
        let path = joined(self.path, path)?;
        if let Some(below) = path.strip_prefix("docs/") {
            if let Some(code) = below.strip_prefix(ERRORS) {
                let file = file_of(ERRORS);
                if code.is_empty() {
                    return Some(file);
                }
                let heading = page_of_code(code.trim_end_matches(".md"))?.lines().next()?;
                return Some(format!("{file}#{}", anchor(heading.trim_start_matches("# "))));
            }
            if let Some(name) = below.strip_prefix("reference/").and_then(|name| name.strip_suffix(".md")) {
                let title = if name == "prelude" { name.to_owned() } else { format!("std.{name}") };
                return self
                    .pages
                    .iter()
                    .find(|page| page.title == title)
                    .map(|page| with_place(page.file.clone()));
            }
            if below == "library.md" {
                return Some("guide.html".to_owned());
            }
            if self.manual.groups.iter().any(|(_, pages)| pages.iter().any(|(known, _)| *known == below)) {
                return Some(with_place(file_of(below)));
            }
        }
        self.manual.files.iter().any(|(known, _)| *known == path).then(|| site_file(&path))
    }

    fn is_lenient(&self) -> bool {
        // Files that lie in the repository alone, such as tests, are named and not led to.
        true
    }
}

fn site_file(path: &str) -> String {
    format!("modl/{path}")
}

/// Returns the path from the root of the repository of a link in the text `from` below `docs/`; `None` if it leads out of
/// the repository.
fn joined(from: &str, to: &str) -> Option<String> {
    let mut parts = vec!["docs"];
    parts.extend(from.split('/'));
    parts.pop();
    let is_folder = to.ends_with('/');
    for part in to.trim_end_matches('/').split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()?),
            part => parts.push(part),
        }
    }
    Some(parts.join("/") + if is_folder { "/" } else { "" })
}
