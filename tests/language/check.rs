//! The room `check` through its door: programs with what is said of them.

use crate::support::suite::{MapFiles, Observed};
use modl::source::{FileId, Sources};

fn observe(files: &MapFiles) -> Observed {
    let checked = modl::check::check(files, "main.mod");
    let file = main_file(&checked.sources);
    Observed { sources: checked.sources, file, diagnostics: checked.diagnostics, printed: Vec::new() }
}

fn main_file(sources: &Sources) -> Option<FileId> {
    sources.files().find(|(_, f)| &*f.name == "main.mod").map(|(id, _)| id)
}

#[test]
fn programs_are_judged_as_they_say() {
    crate::support::suite::run("check", |text| observe(&MapFiles::of(text)));
}

#[test]
fn an_import_cycle_names_every_file_on_it() {
    let mut files = MapFiles::of("use \"a.mod\".{a}\nlet x = a\n");
    files.0.insert("a.mod".into(), b"use \"b.mod\".{b}\nlet a = b\n".to_vec());
    files.0.insert("b.mod".into(), b"use \"a.mod\".{a}\nlet b = 1\n".to_vec());
    let observed = observe(&files);
    let codes: Vec<&str> = observed.diagnostics.iter().map(|d| d.code.0).collect();
    assert_eq!(codes, ["E0104"], "the cycle, and nothing that follows from it");
    let cycle = &observed.diagnostics[0];
    assert!(cycle.message.contains("a.mod, b.mod, a.mod"), "{}", cycle.message);
    assert_eq!(cycle.labels.len(), 2);
}

#[test]
fn a_path_out_of_the_project_is_refused() {
    for path in ["../x.mod", "a/../../x.mod", "/etc/passwd", "c:/x.mod"] {
        let observed = observe(&MapFiles::of(&format!("use \"{path}\".{{x}}\nlet y = x\n")));
        let codes: Vec<&str> = observed.diagnostics.iter().map(|d| d.code.0).collect();
        assert_eq!(codes, ["E0105"], "{path}");
    }
}

#[test]
fn private_names_stay_in_their_file() {
    let mut files = MapFiles::of("use \"a.mod\".{_hidden, shown}\nlet x = _hidden + shown\n");
    files.0.insert("a.mod".into(), b"let _hidden = 1\nlet shown = _hidden\n".to_vec());
    let observed = observe(&files);
    let codes: Vec<&str> = observed.diagnostics.iter().map(|d| d.code.0).collect();
    assert_eq!(codes, ["E0106"]);
}

#[test]
fn text_that_is_not_utf8_is_said_once() {
    let mut files = MapFiles::default();
    files.0.insert("main.mod".into(), b"let a = 1\n// caf\xe9\nlet b = oops\n".to_vec());
    let observed = observe(&files);
    let codes: Vec<&str> = observed.diagnostics.iter().map(|d| d.code.0).collect();
    assert_eq!(codes, ["E0002"]);
    let at = observed.sources.line_column(observed.diagnostics[0].span().expect("a place"));
    assert_eq!((at.line, at.column), (2, 7));
}

#[test]
fn declarations_may_need_each_other_in_a_long_row() {
    let row = |n: usize| {
        let mut text = String::new();
        for i in 0..n {
            text.push_str(&format!("let a{i} = a{}\n", i + 1));
        }
        text + &format!("let a{n} = 1\n")
    };
    assert_eq!(observe(&MapFiles::of(&row(900))).diagnostics, []);
    let observed = observe(&MapFiles::of(&row(20_000)));
    let codes: Vec<&str> = observed.diagnostics.iter().map(|d| d.code.0).collect();
    assert!(!codes.is_empty() && codes.iter().all(|c| *c == "E0005"), "{codes:?}");
}

#[test]
fn the_standard_library_has_no_mistakes() {
    let mut uses = String::new();
    for (name, _) in modl::source::library::FILES {
        let file = name.trim_end_matches(".mod").replace('/', ".");
        if file != "prelude" {
            uses.push_str(&format!("use std.{file}\n"));
        }
    }
    let observed = observe(&MapFiles::of(&uses));
    let said: Vec<String> = observed
        .diagnostics
        .iter()
        .map(|d| {
            let place =
                d.span().map(|s| (&observed.sources.file(s.file).name, observed.sources.line_column(s)));
            format!("{place:?} {} {}", d.code, d.message)
        })
        .collect();
    assert!(said.is_empty(), "{said:#?}");
}

#[test]
fn a_file_of_the_project_is_a_name_before_its_names() {
    let mut files = MapFiles::of(
        "use \"parts/claw.mod\"\nconfig C { part c: claw.Claw }\nprint(claw.twice(2), claw._own, claw.thrice(1))\nprint(claw)\n",
    );
    let claw = b"use std.smores.Smores\nconfig Claw { part m: Smores }\nfn twice(x: Int) -> Int = 2 * x\nlet _own = 1\n";
    files.0.insert("parts/claw.mod".into(), claw.to_vec());
    let told: Vec<String> = observe(&files).diagnostics.into_iter().map(|d| d.message).collect();
    assert_eq!(told, ["`claw` has no `_own`", "`claw` has no `thrice`", "`claw` is a file, no value"]);
}

#[test]
fn a_file_whose_name_is_none_of_the_language_is_imported_name_by_name() {
    let mut files = MapFiles::of("use \"my-claw.mod\"\nuse \"for.mod\"\nuse \"my-claw.mod\".{a}\nprint(a)\n");
    files.0.insert("my-claw.mod".into(), b"let a = 1\n".to_vec());
    files.0.insert("for.mod".into(), b"let a = 1\n".to_vec());
    let told = observe(&files).diagnostics;
    assert_eq!(told.len(), 2);
    assert!(told.iter().all(|d| d.message == "this file's name is no name of the language"));
    assert!(told[0].hints[0].contains("`use \"my-claw.mod\".{Name}`"), "{:?}", told[0].hints);
}

#[test]
fn an_import_that_fails_leaves_no_other_message_behind() {
    let told = observe(&MapFiles::of("use \"claw.mod\"\nprint(claw.a)\n")).diagnostics;
    assert_eq!(
        told.iter().map(|d| d.message.as_str()).collect::<Vec<_>>(),
        ["can't read `claw.mod`: there is no such file"]
    );
}
