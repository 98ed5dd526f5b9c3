//! The pages about codes: each example raises just its code, and each mended one is fine.
//!
//! A page holds fences of Modl. The first is the example, checked, or run where its fence says
//! `modl run`; one that says `modl parts.mod` is a further file of that project; one that says
//! `modl fine` must be without any diagnostic. A page whose mistake is no program's holds none.

use crate::desk::cli::{Sandbox, json};
use modl::source::{Code, code};
use std::fs;
use std::path::Path;

/// Codes that need more than a program text; the tests of the command line raise them.
const NOT_BY_TEXT: &[Code] = &[
    code::NOT_UTF8,
    code::TOO_LARGE,
    code::PENETRATION,
    code::FALLS_APART,
    code::UNSTABLE,
    code::NOT_VERIFIED,
    code::OFF_PATH,
    code::LOST_VALUE,
    code::NO_MEMORY,
    code::MEMORY_LIMIT,
    code::CANNOT_WRITE,
    code::CANNOT_READ,
    code::BAD_PLAN_FILE,
    code::NOT_EXPORTED,
    code::BAD_ROBOT_MAP,
    code::NOT_IMPORTED,
    code::NOTHING_SHOWN,
];

struct Fence {
    /// After the word `modl`.
    info: String,
    text: String,
}

fn fences(page: &str) -> Vec<Fence> {
    let mut fences: Vec<Fence> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        if let Some(info) = line.strip_prefix("```modl") {
            inside = true;
            fences.push(Fence { info: info.trim().to_owned(), text: String::new() });
        } else if line.starts_with("```") {
            inside = false;
        } else if inside {
            let fence = fences.last_mut().expect("inside of one");
            fence.text.push_str(line);
            fence.text.push('\n');
        }
    }
    fences
}

/// The codes of the errors that the command reports for `main.mod`, or of everything it reports.
fn reported(task: &str, files: &[(&str, &[u8])], errors_only: bool) -> Vec<String> {
    let sandbox = Sandbox::new(files);
    let object = json(&sandbox.run(&[task, "--json", "main.mod"]));
    let diagnostics = object["diagnostics"].as_array().expect("a list").iter();
    let chosen = diagnostics.filter(|d| !errors_only || d["severity"] == "error");
    let mut codes: Vec<String> = chosen.map(|d| d["code"].as_str().expect("a code").to_owned()).collect();
    codes.sort();
    codes.dedup();
    codes
}

/// What is wrong with a page, if anything.
fn fault(code: Code, page: &str) -> Option<String> {
    let fences = fences(page);
    let (fine, rest): (Vec<&Fence>, Vec<&Fence>) = fences.iter().partition(|fence| fence.info == "fine");
    for fence in fine {
        let codes = reported("check", &[("main.mod", fence.text.as_bytes())], false);
        if !codes.is_empty() {
            return Some(format!("{code}: the mended example raises {codes:?}"));
        }
    }
    let Some((example, others)) = rest.split_first() else {
        return (!NOT_BY_TEXT.contains(&code)).then(|| format!("{code}: the page has no example"));
    };
    let mut files = vec![("main.mod", example.text.as_bytes())];
    files.extend(others.iter().map(|fence| (fence.info.as_str(), fence.text.as_bytes())));
    let task = if example.info == "run" { "run" } else { "check" };
    let is_error = code.0.starts_with('E');
    let codes = reported(task, &files, is_error);
    (codes != [code.0]).then(|| format!("{code}: the example raises {codes:?}"))
}

#[test]
fn each_page_shows_its_code_and_how_to_mend_it() {
    let mut faults = Vec::new();
    for (code, _) in code::ALL.iter() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/errors/{code}.md"));
        let page = fs::read_to_string(path).expect("every code has a page");
        faults.extend(fault(*code, &page));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
