//! Each limit of `docs/limits.md` holds: below it and at it all is well, above it comes its code.

use crate::language::interpret::ran;
use crate::support::suite::MapFiles;
use modl::interpret::{Limits, Mode, Options};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A row of the table.
struct Limit {
    what: String,
    value: Option<u64>,
    flag: String,
    codes: Vec<String>,
    constant: String,
}

/// The rows of the tables in `docs/limits.md`.
fn table() -> Vec<Limit> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/limits.md");
    let text = std::fs::read_to_string(path).expect("the page is there");
    let plain = |cell: &str| cell.trim().replace('`', "");
    let row = |line: &str| {
        let cells: Vec<String> = line.trim_matches('|').split('|').map(plain).collect();
        let [what, value, flag, code, constant] = &cells[..] else { panic!("five cells: {line}") };
        let digits: String = value.chars().filter(char::is_ascii_digit).collect();
        Limit {
            what: what.clone(),
            value: digits.parse().ok(),
            flag: flag.clone(),
            codes: code.split(", ").map(str::to_owned).collect(),
            constant: constant.clone(),
        }
    };
    let is_row = |line: &&str| line.starts_with("| ") && !line.starts_with("| what");
    text.lines().filter(is_row).map(row).collect()
}

/// The codes of errors with which a program of a size ends.
fn codes(files: &MapFiles, mode: Mode, limits: &Limits) -> BTreeSet<&'static str> {
    let options = Options { limits: limits.clone(), ..Options::default() };
    let ran = ran(files, "main.mod", mode, &options);
    ran.outcome.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code.0).collect()
}

/// How a limit is met: the program that reaches a size, and the limits under which it runs.
type Probe = fn(u64) -> (MapFiles, Mode);

fn text(main: &str) -> (MapFiles, Mode) {
    (MapFiles::of(main), Mode::Run)
}

fn checked(main: &str) -> (MapFiles, Mode) {
    (MapFiles::of(main), Mode::Check)
}

fn nested(n: u64) -> (MapFiles, Mode) {
    let n = n as usize;
    checked(&format!("let a = {}1{}\n", "[".repeat(n), "]".repeat(n)))
}

/// Each sum has the one before it below it: n levels with the number at the end.
fn high(n: u64) -> (MapFiles, Mode) {
    checked(&format!("let a = {}1\n", "1 + ".repeat(n as usize - 1)))
}

fn chain(n: u64) -> (MapFiles, Mode) {
    let file = |i: u64| {
        let name = if i == 0 { "main.mod".to_owned() } else { format!("f{i}.mod") };
        let text = if i + 1 < n { format!("use \"f{}.mod\"\n", i + 1) } else { "let a = 1\n".to_owned() };
        (name, text.into_bytes())
    };
    (MapFiles((0..n).map(file).collect()), Mode::Check)
}

fn long(n: u64) -> (MapFiles, Mode) {
    checked(&format!("let a = 1{}", " ".repeat(n as usize - 9)))
}

fn elements(n: u64) -> (MapFiles, Mode) {
    text(&format!("let a = [i for i in 0..{n}]\n"))
}

fn bytes(n: u64) -> (MapFiles, Mode) {
    text(&format!("let a = pad(\"\", {n})\n"))
}

fn digits(n: u64) -> (MapFiles, Mode) {
    text(&format!("let a = {}\n", "9".repeat(n as usize)))
}

fn calls(n: u64) -> (MapFiles, Mode) {
    text(&format!("fn f(n: Int) -> Int = if n < 2 {{ 0 }} else {{ f(n - 1) }}\nprint(f({n}))\n"))
}

fn carried(n: u64) -> (MapFiles, Mode) {
    text(&format!(
        "record N {{ next: N? }}\nlet a = reduce([i for i in 0..{}], (n, i) => N(next: n), from: N())\n",
        n - 1
    ))
}

fn modules(n: u64) -> (MapFiles, Mode) {
    text(&format!(
        "use std.smores.Smores\nconfig C {{ part m[{n}]: Smores for i in 0..{} {{ connect m[i].top -- m[i + 1].bottom }} }}\nprint(count(C()))\n",
        n - 1
    ))
}

fn shapes(n: u64) -> (MapFiles, Mode) {
    text(&format!("let s = union([box(1mm, 1mm, 1mm) for i in 0..{n}])\n"))
}

fn axes(n: u64) -> (MapFiles, Mode) {
    let axes: Vec<String> = (0..n).map(|i| format!("a{i} in [1, 2]")).collect();
    checked(&format!("record Row {{ x: Int }}\nstudy s({}) by grid() = Row(x: 1)\n", axes.join(", ")))
}

/// The limit itself is excluded, so that a plan of a second less meets it.
fn seconds(n: u64) -> (MapFiles, Mode) {
    text(&format!(
        "use std.smores.Smores\nconfig C {{ part m: Smores }}\nlet c = C()\nlet p = plan(Sc(spin(c.m.left, 1rad/s, for: 1s), wait({}s)), world: world(ground: off, gravity: off))\n",
        n - 2
    ))
}

/// A border of four lines, which is drawn again as often as is left.
fn drawn(n: u64) -> (MapFiles, Mode) {
    let mut files = MapFiles::of("print(faces(load_creases(\"c.svg\")))");
    let again = "<line x2='9'/>".repeat(n as usize - 4);
    let svg = format!("<svg stroke='black'><rect width='9' height='9'/>{again}</svg>");
    files.0.insert("c.svg".to_owned(), svg.into_bytes());
    (files, Mode::Run)
}

/// The limits that a program reaches in a moment, by the constant that states them.
const PROBES: &[(&str, Probe)] = &[
    ("syntax::TEXT_MAX", long),
    ("syntax::NESTING_MAX", nested),
    ("syntax::HEIGHT_MAX", high),
    ("check::IMPORT_DEPTH_MAX", chain),
    ("Limits::recursion", calls),
    ("interpret::nesting::DEPTH_MAX", carried),
    ("Limits::list", elements),
    ("Limits::text", bytes),
    ("Limits::digits", digits),
    ("Limits::modules", modules),
    ("natives::shape::SHAPES_MAX", shapes),
    ("check::study::AXES_MAX", axes),
    ("plan::time::DURATION_MAX", seconds),
    ("formats::svg::LINES_MAX", drawn),
];

#[test]
fn every_limit_holds_below_at_and_above() {
    let table: BTreeMap<String, Limit> = table().into_iter().map(|row| (row.constant.clone(), row)).collect();
    for (constant, probe) in PROBES {
        let row = table.get(*constant).unwrap_or_else(|| panic!("{constant} is in docs/limits.md"));
        let value = row.value.unwrap_or_else(|| panic!("{constant} has a number"));
        // The depth of a value that is carried along is looked at each time that twice as many steps were made.
        let above = if *constant == "interpret::nesting::DEPTH_MAX" { 2 * value } else { value };
        for (size, beyond) in [(value - 1, false), (value, false), (above + 1, true)] {
            let (files, mode) = probe(size);
            let found = codes(&files, mode, &Limits::default());
            let wanted: BTreeSet<&str> = row.codes.iter().map(String::as_str).filter(|_| beyond).collect();
            assert_eq!(found, wanted, "{}: {size} of {value}", row.what);
        }
    }
}

/// Limits that the options of a run change, by programs that count exactly.
#[test]
fn limits_of_a_run_hold_where_they_are_set() {
    let met = |limits: &Limits, program: &str, code: &str| {
        let found = codes(&MapFiles::of(program), Mode::Run, limits);
        assert!(found.is_empty() || found == BTreeSet::from([code]), "{found:?}: {program}");
        !found.is_empty()
    };
    let counted = "print(sum([i for i in 0..100]))\n";
    let spun = "use std.smores.Smores\nconfig C { part m: Smores part n: Smores connect m.top -- n.bottom }\nlet c = C()\n\
                emit(plan(move(c.m.tilt, to: 40deg), world: world(ground: off, gravity: off)), \"a.plan.json\")\n";
    // The least limit at which a program runs: at it, and at any above, it does; below it, at none.
    let least = |limited: &dyn Fn(u64) -> Limits, program: &str, code: &str| {
        let (mut none, mut all) = (0, 1 << 20);
        while all - none > 1 {
            let middle = (none + all) / 2;
            if met(&limited(middle), program, code) { none = middle } else { all = middle }
        }
        assert!(none > 0, "{code}: the limit counts something");
        assert!(met(&limited(none / 2), program, code) && !met(&limited(all * 2), program, code), "{code}");
        all
    };
    let steps = |n| Limits { steps: n, ..Limits::default() };
    // A range of a hundred numbers takes a step for each, and a few besides.
    assert!((100..500).contains(&least(&steps, counted, "E0504")));
    let samples = |n| Limits { samples: n as usize, ..Limits::default() };
    assert!(least(&samples, spun, "E0611") > 1);
    let lists = |n| Limits { list: n as usize, ..Limits::default() };
    assert_eq!(least(&lists, counted, "E0505"), 100);
    let modules = |n| Limits { modules: n as usize, ..Limits::default() };
    assert_eq!(least(&modules, spun, "E0505"), 2);
}

/// Returns the number of an expression of the code: a number, or one shifted to the left.
fn number(written: &str) -> u64 {
    let plain = written.trim_end_matches(';').trim_matches(['(', ')']).replace('_', "");
    let shifted =
        plain.split_once(" << ").map(|(n, by)| (n.trim_start_matches('(').to_owned(), by.to_owned()));
    let (n, by) = shifted.unwrap_or((plain, "0".to_owned()));
    let digits = |text: &str| text.chars().take_while(char::is_ascii_digit).collect::<String>();
    digits(&n).parse::<u64>().expect("a number") << digits(&by).parse::<u32>().expect("a number")
}

#[test]
fn the_table_of_limits_is_that_of_the_code() {
    let (defaults, scheduling) = (Limits::default(), modl::behavior::Settings::default());
    let stated: BTreeMap<&str, u64> = BTreeMap::from([
        ("Limits::steps", defaults.steps),
        ("Limits::recursion", defaults.recursion as u64),
        ("Limits::list", defaults.list as u64),
        ("Limits::text", defaults.text as u64),
        ("Limits::digits", defaults.digits as u64),
        ("Limits::modules", defaults.modules as u64),
        ("Limits::robots", defaults.robots as u64),
        ("Limits::samples", defaults.samples as u64),
        ("syntax::TEXT_MAX", modl::syntax::TEXT_MAX as u64),
        ("syntax::NESTING_MAX", modl::syntax::NESTING_MAX as u64),
        ("syntax::HEIGHT_MAX", modl::syntax::HEIGHT_MAX as u64),
        ("check::IMPORT_DEPTH_MAX", modl::check::IMPORT_DEPTH_MAX as u64),
        ("study::ROWS_MAX", modl::study::ROWS_MAX),
        ("behavior::Settings::actions_max", scheduling.actions_max),
        ("behavior::Settings::segments_max", scheduling.segments_max),
        ("behavior::Settings::steps_max", scheduling.steps_max),
        ("behavior::Settings::cycles_max", scheduling.cycles_max),
    ]);
    let sources = crate::support::sources::rust("src");
    for row in table() {
        if let Some(value) = stated.get(&*row.constant) {
            assert_eq!(row.value, Some(*value), "{}", row.what);
            continue;
        }
        assert!(row.flag == "–" || row.flag.starts_with("--max-"), "{}", row.flag);
        if row.value.is_none() {
            // It depends on the machine, and an option states it.
            assert_eq!(row.flag, "--max-memory");
            continue;
        }
        // A constant that is private stands in a file of its path under its name, with this value.
        let (folder, name) = row.constant.rsplit_once("::").expect("a path has a name");
        let folder = format!("src/{}", folder.replace("::", "/"));
        let declares = |text: &String| {
            text.lines().find_map(|line| {
                line.split_once(&format!("const {name}:"))?.1.split_once("= ").map(|x| x.1.to_owned())
            })
        };
        let of_path = sources.iter().filter(|(file, _)| file.starts_with(&folder));
        let written = of_path.filter_map(|(_, text)| declares(text)).next();
        let written = written.unwrap_or_else(|| panic!("{} is a constant of the code", row.constant));
        assert_eq!(row.value, Some(number(&written)), "{}: {written}", row.what);
    }
}
