//! The programs of the repository: the library, the examples and the cases of the suites, to be damaged and joined.

use super::damage::{damaged, spliced};
use super::dice::Dice;
use super::{forms, programs};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Calls that plan or simulate, for which no number of evaluation steps is a bound.
const PLANNING: &[&str] = &[
    "fold(",
    "refold(",
    "squeeze(",
    "tosnake(",
    "reconfigure(",
    "morph(",
    "locomote(",
    "fastest(",
    "simulate(",
    "reach(",
    "line(",
    "avoid(",
    "study ",
    "what(",
    "show(",
    "save(",
];

/// Returns the root of the repository: the folder of its package, or above that of the package of the fuzzer.
pub fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    if own.join("fuzz_targets").is_dir() { own.join("..") } else { own.to_owned() }
}

/// Returns the texts of the files in a folder with an ending, in order of their names.
fn texts(folder: &str, ending: &str) -> Vec<String> {
    let entries = std::fs::read_dir(root().join(folder)).expect("the folder is there");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("it can be read").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == ending));
    paths.sort();
    paths.iter().map(|path| std::fs::read_to_string(path).expect("it is text")).collect()
}

/// Returns the cases of a folder of the suites.
fn cases(folder: &str) -> Vec<String> {
    let cases = |text: String| -> Vec<String> {
        let text = format!("\n{text}");
        let cases = text.split("\n--- ").skip(1).filter_map(|case| case.split_once('\n'));
        cases.map(|(_, body)| format!("{body}\n")).collect()
    };
    texts(&format!("tests/suite/{folder}"), "mod").into_iter().flat_map(cases).collect()
}

/// The programs of the repository.
pub struct Corpus {
    /// The cases of all suites.
    pub cases: Vec<String>,
    /// The cases that plan nothing.
    pub quick: Vec<String>,
    /// The files of the library, and the examples.
    pub files: Vec<String>,
    /// The entries that are typed in the sessions of the suites.
    pub entries: Vec<String>,
}

/// The programs of the repository, read once.
pub static CORPUS: LazyLock<Corpus> = LazyLock::new(|| {
    let folders = ["syntax", "check", "elaborate", "run"];
    let cases: Vec<String> = folders.iter().flat_map(|folder| cases(folder)).collect();
    let is_quick = |text: &&String| !PLANNING.iter().any(|call| text.contains(call));
    let quick = cases.iter().filter(is_quick).cloned().collect();
    let mut files: Vec<String> =
        modl::source::library::FILES.iter().map(|(_, text)| (*text).to_owned()).collect();
    files.extend(texts("examples", "mod"));
    let typed = texts("tests/suite/repl", "txt");
    let typed = typed.iter().flat_map(|text| text.lines().filter_map(|line| line.strip_prefix("modl> ")));
    Corpus { cases, quick, files, entries: typed.map(str::to_owned).collect() }
});

/// Returns a program for the readers: of every form of the grammar, one that means something, a case, a file, token soup, or
/// two of these joined; half of them damaged.
pub fn text(dice: &mut Dice) -> String {
    let one = |dice: &mut Dice| match dice.below(16) {
        0..5 => forms::program(dice),
        5..7 => programs::program(dice),
        7..14 => case(dice),
        14 => soup(dice),
        _ => CORPUS.files[dice.below(CORPUS.files.len())].clone(),
    };
    let whole = one(dice);
    match dice.below(8) {
        0..3 => whole,
        3..7 => damaged(dice, &whole),
        _ => {
            let other = one(dice);
            spliced(dice, &whole, &other)
        }
    }
}

/// Returns a case of the suites.
pub fn case(dice: &mut Dice) -> String {
    CORPUS.cases[dice.below(CORPUS.cases.len())].clone()
}

/// Returns a program that may mean something, and that plans nothing: one that is right, or a case; most are damaged.
pub fn quick(dice: &mut Dice) -> String {
    let one = |dice: &mut Dice| match dice.below(3) {
        0 => programs::program(dice),
        _ => CORPUS.quick[dice.below(CORPUS.quick.len())].clone(),
    };
    let whole = one(dice);
    match dice.below(8) {
        0 => whole,
        1..7 => damaged(dice, &whole),
        _ => {
            let other = one(dice);
            spliced(dice, &whole, &other)
        }
    }
}

/// Returns tokens in any order.
fn soup(dice: &mut Dice) -> String {
    let many = dice.below(60);
    let token = |dice: &mut Dice| format!("{}{}", dice.of(super::damage::TOKENS), dice.of(&["", " "]));
    (0..many).map(|_| token(dice)).collect()
}

/// Returns true for a program that plans nothing, so that its evaluation steps bound it.
pub fn is_quick(text: &str) -> bool {
    !PLANNING.iter().any(|call| text.contains(call))
}
