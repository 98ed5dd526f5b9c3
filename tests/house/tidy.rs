//! The rules of the house, as far as a test can see them. What a rule is for: `docs/architecture.md`.

use crate::support::sources::{code_lines, files, root, rust};
use std::collections::BTreeSet;
use std::path::Path;

/// A file longer than this has a second subject.
const LINES_MAX: usize = 600;

/// Files that may be longer, each with its reason.
const LONG_FILES: &[(&str, &str)] =
    &[("src/syntax/ast.rs", "one type for each form of the grammar, and nothing else")];

/// A room with the rooms that it is built on. It may know those, and those that they may know, but for `not`.
struct Room {
    name: &'static str,
    on: &'static [&'static str],
    not: &'static [&'static str],
}

const fn room(name: &'static str, on: &'static [&'static str], not: &'static [&'static str]) -> Room {
    Room { name, on, not }
}

/// The rooms from the ground up: each is built on rooms before it.
const ROOMS: &[Room] = &[
    room("interrupt", &[], &[]),
    room("source", &[], &[]),
    room("units", &[], &[]),
    room("syntax", &["source", "interrupt"], &[]),
    room("format", &["syntax"], &[]),
    room("check", &["units", "syntax"], &[]),
    room("geometry", &["units"], &[]),
    room("optimize", &["interrupt"], &[]),
    room("robot", &["geometry", "optimize"], &[]),
    room("plan", &["robot"], &[]),
    room("behavior", &["plan"], &["optimize"]),
    room("simulate", &["behavior", "optimize"], &[]),
    room("planners", &["behavior", "optimize"], &[]),
    room("view", &["simulate"], &["interrupt", "optimize"]),
    room("study", &["optimize"], &["interrupt"]),
    room("interpret", &["check", "planners", "study"], &["optimize"]),
    room("formats", &["plan"], &["interrupt", "units", "optimize"]),
    room("exchange", &["formats", "view"], &["behavior", "simulate"]),
    room("elaborate", &["interpret"], &["syntax", "plan", "behavior", "planners"]),
    room("natives", &["interpret", "elaborate", "simulate", "view", "exchange"], &[]),
    room("display", &["natives"], &["interrupt", "syntax", "behavior", "view", "formats", "exchange"]),
    room("execute", &["display", "interrupt"], &["units", "geometry", "plan", "planners"]),
    room("document", &["execute", "syntax"], &["elaborate", "natives", "display"]),
    room("session", &["execute", "format", "units"], &["interrupt", "elaborate", "natives", "display"]),
    room("language_server", &["interrupt", "session", "document"], &["units"]),
    room("live", &["execute", "session", "syntax", "units", "view"], &["optimize"]),
    room(
        "cli",
        &["language_server", "live", "session", "document", "simulate", "view", "behavior", "exchange"],
        &["syntax", "geometry", "robot"],
    ),
];

/// Returns the rooms that a room may know.
fn known(name: &str) -> BTreeSet<&'static str> {
    let room = ROOMS.iter().find(|room| room.name == name).expect("rooms are built on rooms of the list");
    let mut all: BTreeSet<&str> = room.on.iter().flat_map(|below| known(below)).collect();
    all.extend(room.on);
    all.retain(|below| !room.not.contains(below));
    all
}

#[test]
fn rooms_are_built_on_rooms_before_them() {
    let mut before = BTreeSet::new();
    for room in ROOMS {
        assert!(room.on.iter().all(|below| before.contains(below)), "`{}` stands too early", room.name);
        let below: BTreeSet<&str> = room.on.iter().flat_map(|below| known(below)).collect();
        assert!(
            room.not.iter().all(|not| below.contains(not)),
            "`{}` excludes what it can't know",
            room.name
        );
        before.insert(room.name);
    }
}

/// Rooms whose tolerances stand in a file `tolerances.rs`, one for each family or planner: those that decide what
/// passes. In `geometry`, `optimize`, `robot` and `units` a threshold belongs to one algorithm and stands beside
/// it; other rooms read, print or write, and have a handful each.
const ROOMS_OF_TOLERANCES: &[&str] = &["plan", "behavior", "planners", "elaborate", "view"];

/// A number below this is taken for a tolerance.
const SMALL: f64 = 0.01;

/// Lines with small numbers that are no tolerances, each with its reason.
const SMALL_NUMBERS: &[(&str, &str)] = &[
    ("const DAMPING_FEWEST: f64", "a weight within an objective"),
    ("const SLACKS: [f64; 4]", "the values that a search tries in turn"),
    ("pub const STEP_", "the default and the range of a setting of simulations"),
    ("let (text, pen)", "the width of a pen, as a part of the drawing"),
    ("Side::Top => Vec3::new", "a camera that is not quite above, so that up is up"),
];

/// Crates and parts of the standard library that belong to one room, or to a few.
const OWNERS: &[(&str, &[&str])] = &[
    ("parry3d_f64", &["geometry"]),
    ("glamx", &["geometry"]),
    ("clarabel", &["optimize"]),
    ("robust", &["planners"]),
    ("ply_rs_bw", &["formats"]),
    ("tobj", &["formats"]),
    ("mcap", &["exchange"]),
    ("gif", &["exchange"]),
    ("roxmltree", &["formats", "exchange"]),
    ("pest", &["syntax"]),
    ("pest_derive", &["syntax"]),
    ("miette", &["source"]),
    ("strsim", &["source"]),
    ("pulldown_cmark", &["document"]),
    ("rustyline", &["cli"]),
    ("gen_lsp_types", &["language_server"]),
    ("lsp_server", &["language_server", "cli"]),
    (
        "serde_json",
        &[
            "source",
            "formats",
            "robot",
            "plan",
            "view",
            "exchange",
            "document",
            "language_server",
            "live",
            "cli",
        ],
    ),
    ("httparse", &["cli"]),
    ("getrandom", &["cli"]),
    ("clap", &["cli"]),
    ("clap_complete", &["cli"]),
    ("ctrlc", &["cli"]),
    ("tempfile", &["cli"]),
    ("terminal_size", &["cli"]),
    ("std::env", &["cli"]),
    ("std::fs", &["cli"]),
    ("std::io", &["plan", "exchange", "cli"]),
    ("std::net", &["cli"]),
    ("std::process", &["cli"]),
    ("std::thread", &["interrupt", "planners", "interpret", "language_server", "cli"]),
    ("std::time", &["cli"]),
];

fn fail_if_any(what: &str, faults: Vec<String>) {
    assert!(faults.is_empty(), "{what}:\n  {}", faults.join("\n  "));
}

/// The names that follow `path::` in a line, also in `path::{a, b::c}`.
fn names_after<'a>(line: &'a str, path: &str) -> Vec<&'a str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let first_name = |text: &'a str| text.split(|c| !is_name(c)).next().unwrap_or("");
    let mut names = Vec::new();
    for (at, _) in line.match_indices(path) {
        if line[..at].ends_with(|c: char| is_name(c) || c == ':') {
            continue;
        }
        let rest = &line[at + path.len()..];
        match rest.strip_prefix('{') {
            Some(list) => names.extend(list.split(',').map(|item| first_name(item.trim()))),
            None => names.push(first_name(rest)),
        }
    }
    names
}

#[test]
fn rooms_know_only_the_rooms_above_them() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        let parts: Vec<&str> = file.split('/').collect();
        let [_, room, _, ..] = parts[..] else { continue };
        if !ROOMS.iter().any(|known| known.name == room) {
            faults.push(format!("{file}: the room `{room}` is not on the list"));
            continue;
        }
        let known = known(room);
        for (number, line) in code_lines(&text) {
            for other in names_after(line, "crate::") {
                let is_room = ROOMS.iter().any(|room| room.name == other);
                if is_room && other != room && !known.contains(other) {
                    faults.push(format!("{file}:{number}: `{room}` may not know `{other}`"));
                }
            }
        }
    }
    fail_if_any("rooms that know too much", faults);
}

#[test]
fn crates_and_the_outside_stay_in_their_rooms() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        let room = file.split('/').nth(1).expect("below src");
        for (number, line) in code_lines(&text) {
            for (owned, rooms) in OWNERS {
                let used = line.match_indices(owned).any(|(at, _)| {
                    let after = line[at + owned.len()..].chars().next();
                    let is_path = matches!(after, Some(':' | ';'));
                    is_path && !line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':')
                });
                if used && !rooms.contains(&room) && room != "main.rs" {
                    faults.push(format!("{file}:{number}: `{owned}` is for {rooms:?}"));
                }
            }
        }
    }
    fail_if_any("outside of their rooms", faults);
}

#[test]
fn tolerances_stand_in_their_files() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        let room = file.split('/').nth(1).expect("below src");
        if !ROOMS_OF_TOLERANCES.contains(&room) || file.ends_with("/tolerances.rs") {
            continue;
        }
        for (number, line) in code_lines(&text) {
            if has_bare_small_number(line) && !SMALL_NUMBERS.iter().any(|(start, _)| line.contains(start)) {
                faults.push(format!("{file}:{number}: {}", line.trim()));
            }
        }
    }
    fail_if_any("tolerances outside of `tolerances.rs` (a named field of settings may have one)", faults);
}

/// Returns whether a line has a small number that is not the value of a named field.
fn has_bare_small_number(line: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let is_field = |before: &str| {
        let name = before.trim_end().strip_suffix(':').unwrap_or("");
        name.ends_with(|c: char| c.is_alphanumeric() || c == '_')
    };
    if line.split_once(": ").is_some_and(|(name, _)| name.trim_start().chars().all(is_part)) {
        return false;
    }
    let joined = line.replace("e-", "e_");
    let mut at = 0;
    for word in joined.split(|c| !is_part(c)) {
        let value = word.trim_end_matches("_f64").replace("e_", "e-").parse::<f64>();
        if value.is_ok_and(|x| x > 0.0 && x < SMALL) && !is_field(&joined[..at]) {
            return true;
        }
        at += word.len() + joined[at + word.len()..].chars().next().map_or(0, char::len_utf8);
    }
    false
}

#[test]
fn small_numbers_are_found() {
    let bare = ["const A: f64 = 1e-9;", "if x < 0.001 {", "y.max(2.5e-3)", "1.0 - 6e-4", "&[0.5, 0.002]"];
    let fine =
        ["tol: 1e-9,", "    springs: (3e-2, 1e-6),", "Plate { gap: 1e-4, motors: 0.018 }", "x * 0.5 + 0.0"];
    let found: Vec<&str> = bare.into_iter().chain(fine).filter(|line| has_bare_small_number(line)).collect();
    assert_eq!(found, bare);
}

#[test]
fn files_have_one_subject_and_say_it_first() {
    let mut faults = Vec::new();
    for (file, text) in ["src", "tests", "benches", "fuzz"].into_iter().flat_map(rust) {
        if !text.starts_with("//!") {
            faults.push(format!("{file}: begins without `//!`"));
        }
        let lines = text.lines().count();
        if lines > LINES_MAX && !LONG_FILES.iter().any(|(name, _)| *name == file) {
            faults.push(format!("{file}: {lines} lines; what is its second subject?"));
        }
    }
    fail_if_any("files", faults);
    let long = |file: &str| rust("src").get(file).is_some_and(|text| text.lines().count() > LINES_MAX);
    let stale: Vec<String> =
        LONG_FILES.iter().filter(|(f, _)| !long(f)).map(|(f, _)| (*f).to_owned()).collect();
    fail_if_any("no longer long; take them off the list", stale);
}

#[test]
fn folders_are_one_level_deep_and_have_names_that_say_something() {
    let empty_names = ["util", "utils", "common", "misc", "core", "helper", "helpers", "prelude"];
    let mut faults = Vec::new();
    for file in rust("src").keys() {
        let parts: Vec<&str> = file.split('/').collect();
        // Each planner and each family of plans has a room of its own; the judge has one for each family, and one for the
        // dynamics of articulated robots. Plots show values, and not plans as all other pictures do. A model of MuJoCo is
        // more than one subject, and so are the files of the SMORES tools, the command that computes studies, the one that
        // serves a page, and drawings that are read.
        let deep = match file.as_str() {
            file if file.starts_with("src/plan/verify/articulated/dynamics/") => 6,
            file if file.starts_with("src/plan/verify/") => 5,
            file if file.starts_with("src/plan/") || file.starts_with("src/planners/") => 4,
            file if file.starts_with("src/view/plot/") || file.starts_with("src/formats/mjcf/") => 4,
            file if file.starts_with("src/exchange/smores/") || file.starts_with("src/cli/study/") => 4,
            file if file.starts_with("src/cli/live/") || file.starts_with("src/formats/svg/") => 4,
            _ => 3,
        };
        if parts.len() > deep {
            faults.push(format!("{file}: too deep"));
        }
        if parts.iter().any(|part| empty_names.contains(&part.trim_end_matches(".rs"))) {
            faults.push(format!("{file}: a name that says nothing"));
        }
    }
    fail_if_any("folders and names", faults);
}

#[test]
fn no_file_is_left_out_of_the_build() {
    let mut faults = Vec::new();
    let (src, tests) = (rust("src"), rust("tests"));
    for file in src.keys().chain(tests.keys()) {
        let (folder, name) = file.rsplit_once('/').expect("in a folder");
        let stem = name.trim_end_matches(".rs");
        let (parent, module) = match (folder, stem) {
            ("src", "lib" | "main") | ("tests", "all") => continue,
            ("src", _) => ("src/lib.rs".to_owned(), stem),
            ("tests", _) => ("tests/all.rs".to_owned(), stem),
            (_, "mod") => match folder.rsplit_once('/').expect("below src or tests") {
                ("src", module) => ("src/lib.rs".to_owned(), module),
                ("tests", module) => ("tests/all.rs".to_owned(), module),
                (above, module) => (format!("{above}/mod.rs"), module),
            },
            _ => (format!("{folder}/mod.rs"), stem),
        };
        let text = src.get(&parent).or(tests.get(&parent)).map_or("", String::as_str);
        if !text.lines().any(|line| line.trim_end().ends_with(&format!("mod {module};"))) {
            faults.push(format!("{file}: {parent} does not say `mod {module};`"));
        }
    }
    fail_if_any("dead files", faults);
}

#[test]
fn words_that_do_not_stay() {
    let in_src = [".unwr~ap()", "to~do!", "unimpl~emented!", "db~g!", "print~ln!", "eprint~ln!"];
    let in_rust = ["#[ign~ore", "#[should_pa~nic", "thread::sle~ep"];
    let anywhere = ["TO~DO", "FIX~ME", "XX~X", "/ho~me/", "/ro~ot/", "/wo~rk/", "/Us~ers/"];
    let mut faults = Vec::new();
    for (file, bytes) in files() {
        let Ok(text) = String::from_utf8(bytes) else { continue };
        let mut banned: Vec<&str> = anywhere.to_vec();
        if file.ends_with(".rs") {
            banned.extend(in_rust);
        }
        if file.starts_with("src/") {
            banned.extend(in_src);
        }
        // The words are written in two halves, or this file would find itself.
        for word in banned.iter().map(|word| word.replace('~', "")) {
            for (i, _) in text.lines().enumerate().filter(|(_, line)| line.contains(&word)) {
                faults.push(format!("{file}:{}: `{word}`", i + 1));
            }
        }
    }
    fail_if_any("words that do not stay", faults);
}

#[test]
fn every_code_has_its_page_and_every_page_its_code() {
    let codes: BTreeSet<String> = modl::source::code::ALL.iter().map(|(code, _)| code.to_string()).collect();
    let pages = files().into_keys().filter_map(|name| {
        Some(name.strip_prefix("docs/errors/")?.strip_suffix(".md")?.to_owned())
            .filter(|name| name != "README")
    });
    let pages: BTreeSet<String> = pages.collect();
    fail_if_any("codes without a page in docs/errors", codes.difference(&pages).cloned().collect());
    fail_if_any("pages in docs/errors without a code", pages.difference(&codes).cloned().collect());
}

#[test]
fn codes_are_in_order() {
    let codes: Vec<&str> = modl::source::code::ALL.iter().map(|(code, _)| code.0).collect();
    let group = |code: &&str| ["E", "W", "N"].iter().position(|c| code.starts_with(c));
    let mut sorted = codes.clone();
    sorted.sort_by_key(|code| (group(code), code.to_string()));
    sorted.dedup();
    assert_eq!(codes, sorted);
}

#[test]
fn the_binary_holds_every_file_of_the_library() {
    let on_disk: Vec<(String, String)> = files()
        .into_iter()
        .filter_map(|(name, bytes)| {
            let text = String::from_utf8(bytes).ok()?;
            Some((name.strip_prefix("stdlib/")?.to_owned(), text))
        })
        .collect();
    let embedded: Vec<(String, String)> =
        modl::source::library::FILES.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
    let names = |files: &[(String, String)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(
        names(&embedded),
        names(&on_disk),
        "src/source/library.rs lists every file of stdlib/, in order"
    );
    assert!(embedded == on_disk, "the texts are the same");
}

#[test]
fn links_between_pages_lead_somewhere() {
    let all = files();
    let mut faults = Vec::new();
    for (file, bytes) in all.iter().filter(|(name, _)| name.ends_with(".md")) {
        let text = String::from_utf8_lossy(bytes);
        let folder = Path::new(file).parent().expect("a file has a folder");
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let target = target.split('#').next().unwrap_or("");
            let outside = target.is_empty() || target.contains("://") || target.contains(' ');
            if !outside && !root().join(folder).join(target).exists() {
                faults.push(format!("{file}: {target}"));
            }
        }
    }
    fail_if_any("links that lead nowhere", faults);
}
