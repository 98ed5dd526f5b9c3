//! The index of the site's search.

use super::manual::ManualPage;
use super::markdown::Heading;
use super::outline::Page;
use crate::source::floor_char_boundary;

/// The most bytes of a text in the index.
const WORDS_MAX: usize = 4000;

/// A row of the index: name, kind and page, address, and words that are searched, too.
type Row = [String; 4];

/// Returns the search index as the text of a script, with a row for each declaration and member, and for each section of
/// the manual.
pub(super) fn search_index(pages: &[Page], manual: &[(&ManualPage, &[Heading])]) -> String {
    let mut rows: Vec<Row> = Vec::new();
    for page in pages {
        for entry in &page.entries {
            let address = format!("{}#{}", page.file, entry.name);
            let place = format!("{} · {}", entry.word, page.title);
            rows.push([entry.name.clone(), place, address, plain(entry.doc.as_deref())]);
            for i in &entry.inside {
                let name = format!("{}.{}", entry.name, i.name);
                let address = format!("{}#{name}", page.file);
                rows.push([
                    name,
                    format!("{} · {}", i.group.word(), page.title),
                    address,
                    plain(i.doc.as_deref()),
                ]);
            }
        }
    }
    for (page, headings) in manual {
        for heading in *headings {
            let address = format!("{}#{}", page.file, heading.anchor);
            rows.push([heading.title.clone(), page.title.clone(), address, cut(&one_line(&heading.words))]);
        }
    }
    let json = serde_json::to_string(&rows).expect("texts are plain data");
    // No text in it can end the script element.
    format!("const INDEX = {};\n", json.replace('<', "\\u003c"))
}

/// Returns a piece of documentation in one line, without the programs in it and without quotes of code.
fn plain(doc: Option<&str>) -> String {
    let pieces = doc.unwrap_or_default().split("```").step_by(2);
    cut(&one_line(&pieces.collect::<Vec<_>>().join(" ").replace('`', "")))
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns the beginning of a text that is too long.
fn cut(text: &str) -> String {
    text[..floor_char_boundary(text, text.len().min(WORDS_MAX))].to_owned()
}
