//! Commands over folders: which programs they take, and what they say of all of them.

use super::cli::Sandbox;

const WRONG: &[u8] = b"let a = 1mm + 1s\n";

/// A project with two programs below each other, one that is hidden, and a file that is no program.
fn project() -> Sandbox {
    Sandbox::new(&[
        ("lib.mod", b"fn f(a: Int) -> Int = 2 * a\ntest \"double\" { expect f(1) == 2 }\n"),
        ("deep/er/main.mod", b"use \"../../lib.mod\".{f}\ntest \"four\" { expect f(2) == 4 }\nprint(f(2))\n"),
        (".hidden/wrong.mod", WRONG),
        ("deep/.wrong.mod", WRONG),
        ("notes.txt", b"no program"),
    ])
}

#[test]
fn a_folder_is_checked_with_all_that_it_holds() {
    let s = project();
    let fine = s.run(&["check", "."]);
    assert_eq!((fine.code, fine.err.as_str()), (0, "2 programs: nothing is wrong\n"));
    let tested = s.run(&["test", "."]);
    assert_eq!(tested.code, 0, "{}", tested.err);
    let expected = "deep/er/main.mod:\ntest \"four\" ... ok\nlib.mod:\ntest \"double\" ... ok\n\
                    2 passed, 0 failed in 2 programs\n";
    assert_eq!(tested.out, expected);
}

#[test]
fn all_errors_of_a_folder_are_told_at_once() {
    let s = project();
    for name in ["a.mod", "deep/b.mod"] {
        std::fs::write(s.path(name), WRONG).expect("a file can be written");
    }
    let ran = s.run(&["check", "."]);
    assert_eq!(ran.code, 1);
    let places: Vec<&str> = ran.err.lines().filter(|line| line.contains(".mod:")).collect();
    assert!(
        matches!(places.as_slice(), [a, b] if a.contains("[a.mod:1:") && b.contains("[deep/b.mod:1:")),
        "{}",
        ran.err
    );
    assert!(ran.err.ends_with("4 programs: 2 errors\n"), "{}", ran.err);
    let tested = s.run(&["test", "."]);
    assert_eq!(tested.code, 1);
    assert!(tested.out.ends_with("2 passed, 0 failed in 4 programs\n"), "{}", tested.out);
}

#[test]
fn a_folder_without_programs_says_so() {
    let s = project();
    std::fs::create_dir(s.path("empty")).expect("a folder can be made");
    for command in ["check", "test", "fmt"] {
        let ran = s.run(&[command, "empty"]);
        assert_eq!((ran.code, ran.err.as_str()), (2, "modl: the folder `empty` holds no program (`.mod`)\n"));
    }
}

#[cfg(unix)]
#[test]
fn links_in_a_folder_are_not_followed() {
    let s = project();
    let elsewhere = Sandbox::new(&[("wrong.mod", WRONG)]);
    std::os::unix::fs::symlink(elsewhere.path("wrong.mod"), s.path("link.mod")).expect("a link can be made");
    std::os::unix::fs::symlink(elsewhere.path("."), s.path("deep/link")).expect("a link can be made");
    std::os::unix::fs::symlink(s.path("."), s.path("deep/round")).expect("a link can be made");
    let ran = s.run(&["check", "."]);
    assert_eq!((ran.code, ran.err.as_str()), (0, "2 programs: nothing is wrong\n"));
}
