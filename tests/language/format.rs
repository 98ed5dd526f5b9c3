//! The formatter: the library and the examples are in its style, and it changes how a program looks,
//! never what it means.

use crate::desk::cli::Sandbox;
use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::forms;
use crate::fuzz::inputs::programs::program;
use crate::support::fences::fences;
use crate::support::properties::seeds;
use modl::format::format;
use modl::source::FileId;
use modl::syntax::{TokenKind, skeleton};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Generated programs that are formatted, a quarter of them in the gate.
const GENERATED: u64 = 10_000;

fn formatted(text: &str) -> String {
    format(FileId(0), text).expect("the meaning stays").text
}

/// All programs below a folder of the repository, by name.
fn programs(folder: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("the folder can be read") {
            let path = entry.expect("the folder can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "mod") {
                let text = fs::read_to_string(&path).expect("programs are UTF-8");
                found.insert(path.to_string_lossy().into_owned(), text);
            }
        }
    }
    assert!(!found.is_empty());
    found
}

#[test]
fn the_library_and_the_examples_are_in_style() {
    let mut all = programs("stdlib");
    all.extend(programs("examples"));
    all.extend(programs("src"));
    let page = include_str!("../../docs/style.md");
    let listing = page.split("```modl check\n").nth(1).and_then(|rest| rest.split("```").next());
    all.insert("docs/style.md".to_owned(), listing.expect("the page shows a program").to_owned());
    // Listings of the tour are what `modl fmt` leaves as it is; more at the end of a file is one too.
    for fence in fences(include_str!("../../docs/tour.md"), "docs/tour.md") {
        if fence.modl().is_some() {
            all.insert(fence.place.clone(), fence.code.clone());
        }
    }
    let other: Vec<&String> =
        all.iter().filter(|(_, text)| formatted(text) != **text).map(|(n, _)| n).collect();
    assert!(other.is_empty(), "`modl fmt` would change {other:?}");
}

/// The cases of the suites, each a program of its own.
fn cases() -> Vec<String> {
    let texts = programs("tests").into_values();
    let bodies = |text: String| -> Vec<String> {
        let cases = format!("\n{text}");
        // The first line of each names the case.
        let cases = cases.split("\n--- ").skip(1).filter_map(|case| case.split_once('\n'));
        cases.map(|(_, body)| format!("{body}\n")).collect()
    };
    texts.flat_map(bodies).collect()
}

#[test]
fn whatever_can_be_read_keeps_its_meaning_and_stays_as_it_is_then() {
    let mut sound = 0;
    for case in cases() {
        let once = formatted(&case);
        assert_eq!(once, formatted(&once), "the second time is another:\n{case}");
        if let Some(meaning) = skeleton(&case) {
            sound += 1;
            assert!(Some(meaning) == skeleton(&once), "another program:\n{case}");
        }
    }
    assert!(sound > 100, "only {sound} cases can be read");
}

/// The same program with other spaces, indentation and blank lines.
fn respaced(text: &str, dice: &mut Dice) -> String {
    let mut out = String::new();
    // Nothing is changed within texts and comments, and nothing at the margin becomes so or ceases to.
    let tokens = modl::syntax::Outline::of(text).expect("short").tokens;
    let mut at = 0;
    for token in tokens {
        let gap = &text[at..token.start];
        let first = at == 0 || text.as_bytes()[at - 1] == b'\n';
        if gap.is_empty() && !first {
        } else if first && token.kind == TokenKind::LineComment {
            out.push_str(gap);
        } else {
            let least = usize::from(!first);
            out.push_str(&" ".repeat(least + dice.below(4)));
        }
        out.push_str(&text[token.start..token.end]);
        // A second blank line is one too many.
        if token.kind == TokenKind::LineBreak && out.ends_with("\n\n") && dice.below(2) == 0 {
            out.push('\n');
        }
        at = token.end;
    }
    out
}

#[test]
fn how_a_program_was_spaced_does_not_matter() {
    let mut dice = Dice::new(5);
    let mut all = programs("stdlib");
    all.extend(programs("examples"));
    for (name, text) in &all {
        for _ in 0..4 {
            let other = respaced(text, &mut dice);
            assert_eq!(formatted(&other), *text, "{name}");
        }
    }
}

/// The text with a comment at some of the places where white space stands, or at one of them.
fn commented(text: &str, dice: &mut Dice, one_in: usize) -> String {
    let tokens = modl::syntax::Outline::of(text).expect("short").tokens;
    let mut out = String::new();
    let mut at = 0;
    for token in tokens {
        let gap = &text[at..token.start];
        out.push_str(gap);
        let (here, line) = (dice.below(one_in) == 0, token.kind == TokenKind::LineBreak);
        match dice.below(3) {
            _ if !here => {}
            0 if line => out.push_str(" // why"),
            1 if line => out.push_str("\n// alone"),
            // Beside `/` it would be another comment.
            _ if line => out.push_str(" /* so */"),
            _ if !gap.is_empty() => out.push_str("/* so */ "),
            _ => {}
        }
        out.push_str(&text[token.start..token.end]);
        at = token.end;
    }
    out
}

#[test]
fn programs_with_comments_anywhere_keep_their_meaning() {
    for seed in seeds(GENERATED) {
        let mut dice = Dice::new(seed);
        // Programs that mean something, and those that have every form of the grammar.
        let plain = if seed % 2 == 0 { program(&mut dice) } else { forms::program(&mut dice) };
        let text = commented(&plain, &mut dice, 1 + (seed % 40) as usize);
        let once = formatted(&text);
        assert_eq!(once, formatted(&once), "the second time is another:\n{text}");
        assert!(skeleton(&plain) == skeleton(&once), "another program:\n{text}");
        let comments = |text: &str| text.matches("/* so */").count() + text.matches("//").count();
        assert_eq!(comments(&text), comments(&once), "a comment is lost:\n{text}");
    }
}

#[test]
fn what_cannot_be_read_stays_as_it_is() {
    let text = "let a   =  1\nlet b = (1 +\n  2 ]]\nlet c   =  3\n";
    let found = format(FileId(0), text).expect("no meaning to change");
    assert!(found.text.starts_with("let a = 1\n"), "{}", found.text);
    assert!(found.text.contains("let b = (1 +\n  2 ]]\n"), "{}", found.text);
    assert!(!found.diagnostics.is_empty());
}

/// Blank lines at the beginning of a file that can't be read are left out at the first time.
#[test]
fn blank_lines_before_what_cannot_be_read_are_left_out() {
    let once = formatted("    \n\n   ^ no\n");
    assert_eq!((once.as_str(), formatted(&once).as_str()), ("   ^ no\n", "   ^ no\n"));
}

/// By hand: what each rule of the style does.
#[test]
fn the_style_is_as_the_documentation_says() {
    let text = "\
use std.smores.{ Smores ,Walk4 }


config  C( a:Angle=30deg ,n :Int= 2){
part m[ n ]:Smores   part x : Smores
    connect m[0] .top--x.bottom   turn 90deg

  behavior b=Sc( move(m[0].tilt,to:- a),
wait( 2s ) ,
  ) // the end
  behavior long = Pc(m) // another
}
let y = [x^2
 for x in 0 .. 4] ++[ - -1 ]
let z=2m ^ 2 / 3s
test \"t\" {   expect not(true)   }
";
    let wanted = "\
use std.smores.{Smores, Walk4}

config C(a: Angle = 30deg, n: Int = 2) {
  part m[n]: Smores  part x: Smores
  connect m[0].top -- x.bottom turn 90deg

  behavior b = Sc(move(m[0].tilt, to: -a),
    wait(2s),
  )                      // the end
  behavior long = Pc(m)  // another
}
let y = [x^2
  for x in 0..4] ++ [- -1]
let z = 2m ^ 2 / 3s
test \"t\" { expect not (true) }
";
    assert_eq!(formatted(text), wanted);
}

/// Short records stand on one line, long ones have a line for each field.
#[test]
fn records_keep_their_lines() {
    let text = "\
record  S{a:Int,b:Int=3}
/// Long.
record Long {

    /// The first.
  a :Int
 b: Length=3m ,   c: List<Long>=[ ],

    d: fn(Int)->Angle
}
let d = S( a:1 )with{b:4}
let e = Long(a: 1,
b: 2m) with {
a: 2
  b: 3m,
 }.a
";
    let wanted = "\
record S { a: Int, b: Int = 3 }
/// Long.
record Long {
  /// The first.
  a: Int
  b: Length = 3m, c: List<Long> = [],

  d: fn(Int) -> Angle
}
let d = S(a: 1) with { b: 4 }
let e = Long(a: 1,
  b: 2m) with {
    a: 2
    b: 3m,
  }.a
";
    assert_eq!(formatted(text), wanted);
}

/// The greatest width of a line, as the page on style says.
const WIDTH: usize = 120;

#[test]
fn lines_that_are_too_wide_are_broken() {
    let text = "\
let a = fold(octahedron(edge: 80mm), module: Mori, objective: \"energy\", gravity: true, seed: 7, budget: 100000, checks: true)
let b = first_of_the_long_names * second_of_the_long_names + third_of_the_long_names * fourth_of_the_long_names - the_last_of_them
let c = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31]
behave(Pc([move(module.the_first_joint, to: 30deg, in: 500ms, profile: linear) for module in all_of_the_modules_in_order]))
let h = [[one_of_the_numbers(k, n), another_of_the_numbers(k, n), the_last_of_the_numbers(k, n)] for another_index in 0..count]
let i = if one_condition(of: several) == another_one(of: several) { the_first_of_the_branches } else { the_second_of_the_branches(k) }
config C { part first: AModuleWithALongName  part second: AModuleWithALongName  connect first.top -- second.bottom  base first }
let d = [[radius * cos(360deg * i / number_of_points), radius * sin(360deg * i / number_of_points), height * k / layers],
  [0mm, 0mm, 0mm]]
let e = \"a text is never broken, however long it is, since its line breaks would be part of what it says, word by word by word\"
let f = 3  // neither is a comment behind short code, however long it is, since nothing of the code before it is too wide
";
    let wanted = "\
let a = fold(
  octahedron(edge: 80mm),
  module: Mori,
  objective: \"energy\",
  gravity: true,
  seed: 7,
  budget: 100000,
  checks: true
)
let b = first_of_the_long_names * second_of_the_long_names + third_of_the_long_names * fourth_of_the_long_names -
  the_last_of_them
let c = [
  1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31
]
behave(
  Pc([move(module.the_first_joint, to: 30deg, in: 500ms, profile: linear) for module in all_of_the_modules_in_order])
)
let h = [
  [one_of_the_numbers(k, n), another_of_the_numbers(k, n), the_last_of_the_numbers(k, n)]
  for another_index in 0..count
]
let i = if one_condition(of: several) == another_one(of: several) {
  the_first_of_the_branches
} else {
  the_second_of_the_branches(k)
}
config C {
  part first: AModuleWithALongName
  part second: AModuleWithALongName
  connect first.top -- second.bottom
  base first
}
let d = [
  [radius * cos(360deg * i / number_of_points), radius * sin(360deg * i / number_of_points), height * k / layers],
  [0mm, 0mm, 0mm]]
let e = \"a text is never broken, however long it is, since its line breaks would be part of what it says, word by word by word\"
let f = 3  // neither is a comment behind short code, however long it is, since nothing of the code before it is too wide
";
    assert_eq!(formatted(text), wanted);
    assert_eq!(formatted(wanted), wanted);
    assert!(skeleton(text).is_some() && skeleton(text) == skeleton(wanted));
}

#[test]
fn records_that_are_too_wide_have_a_line_for_each_field() {
    let text = "\
record Design { the_first_of_the_fields: Angle = 30deg, the_second_of_the_fields: Speed = 20mm/s, others: List<Length> = [] }  // all
let d = Design(the_first_of_the_fields: 30deg + another_angle, the_second_of_the_fields: 20mm/s, others: [1mm, 2mm, 3mm, 4mm])
let e = d with { the_first_of_the_fields: 30deg + another_angle, the_second_of_the_fields: 20mm/s, others: [1mm, 2mm, 3mm] }
let f = [Design(the_first_of_the_fields: 30deg, the_second_of_the_fields: 20mm/s), d with { the_first_of_the_fields: 10deg }]
let g = best(d with { the_first_of_the_fields: bend, the_second_of_the_fields: 20mm/s, others: lengths }, among: all_designs)
fn changed(d: Design) -> Design = d with { the_first_of_the_fields: 30deg } with { the_second_of_the_fields: 20mm/s, others: [] }
fn chosen(d: Design) -> Design = if d.the_first_of_the_fields > 30deg { d with { others: [] } } else { Design(others: [1mm, 2mm]) }
config C { part a: Arm(design: Design(the_first_of_the_fields: 30deg, the_second_of_the_fields: 20mm/s, others: the_lengths(of: 4))) }
";
    let wanted = "\
record Design {
  the_first_of_the_fields: Angle = 30deg,
  the_second_of_the_fields: Speed = 20mm/s,
  others: List<Length> = []
}  // all
let d = Design(
  the_first_of_the_fields: 30deg + another_angle,
  the_second_of_the_fields: 20mm/s,
  others: [1mm, 2mm, 3mm, 4mm]
)
let e = d with {
  the_first_of_the_fields: 30deg + another_angle,
  the_second_of_the_fields: 20mm/s,
  others: [1mm, 2mm, 3mm]
}
let f = [
  Design(the_first_of_the_fields: 30deg, the_second_of_the_fields: 20mm/s),
  d with { the_first_of_the_fields: 10deg }
]
let g = best(
  d with { the_first_of_the_fields: bend, the_second_of_the_fields: 20mm/s, others: lengths },
  among: all_designs
)
fn changed(d: Design) -> Design = d with { the_first_of_the_fields: 30deg } with {
  the_second_of_the_fields: 20mm/s,
  others: []
}
fn chosen(d: Design) -> Design = if d.the_first_of_the_fields > 30deg {
  d with { others: [] }
} else {
  Design(others: [1mm, 2mm])
}
config C {
  part a: Arm(
    design: Design(the_first_of_the_fields: 30deg, the_second_of_the_fields: 20mm/s, others: the_lengths(of: 4))
  )
}
";
    assert_eq!(formatted(text), wanted);
    assert_eq!(formatted(wanted), wanted);
    assert!(text.lines().all(|line| line.chars().count() > WIDTH), "each line is too wide");
    assert!(skeleton(text).is_some() && skeleton(text) == skeleton(wanted));
}

/// The program on as few lines as may be, so that lines are long.
fn unbroken(text: &str) -> String {
    let tokens = modl::syntax::Outline::of(text).expect("short").tokens;
    let (mut out, mut depth, mut at) = (String::new(), 0, 0);
    for (i, token) in tokens.iter().enumerate() {
        let word = &text[token.start..token.end];
        let before = i.checked_sub(1).map_or("", |before| &text[tokens[before].start..tokens[before].end]);
        out.push_str(&text[at..token.start]);
        // Within round and square brackets lines do not matter behind a comma and an opening bracket.
        match word {
            "\n" if depth > 0 && matches!(before, "," | "(" | "[") => out.push(' '),
            _ => out.push_str(word),
        }
        depth += i32::from(matches!(word, "(" | "[")) - i32::from(matches!(word, ")" | "]"));
        at = token.end;
    }
    out
}

#[test]
fn wide_programs_keep_their_meaning_and_fit_where_they_can() {
    let (mut broken, mut wide) = (0, 0);
    for seed in seeds(GENERATED / 5) {
        let mut dice = Dice::new(seed);
        let forms = forms::program(&mut dice);
        // Long names make wide lines.
        let text = unbroken(&forms)
            .replace("Int", "IntIntIntIntIntIntIntIntIntInt")
            .replace(" b1", " b1_and_more_of_it_and_more");
        let once = formatted(&text);
        assert_eq!(once, formatted(&once), "the second time is another:\n{text}");
        assert!(skeleton(&text) == skeleton(&once), "another program:\n{text}");
        broken += usize::from(once.lines().count() > text.lines().count());
        wide += once.lines().filter(|line| line.chars().count() > WIDTH).count();
    }
    assert!(broken > 100, "only {broken} programs have wide lines");
    assert!(wide < broken, "{wide} lines are wider than they may be");
}

#[test]
fn files_are_formatted_in_place_or_only_looked_at() {
    let sandbox =
        Sandbox::new(&[("a.mod", b"let a  = 1\n"), ("b/c.mod", b"let a = 1\n"), ("d.mod", b"let a = (\n")]);
    let looked = sandbox.run(&["fmt", "--check", "a.mod", "b"]);
    assert_eq!((looked.code, looked.out.as_str()), (1, "a.mod:1\n"));
    let wrote = sandbox.run(&["fmt", "a.mod", "b"]);
    assert_eq!((wrote.code, wrote.err.as_str()), (0, "formatted a.mod\n"));
    assert_eq!(fs::read_to_string(sandbox.path("a.mod")).expect("it is there"), "let a = 1\n");
    assert_eq!(sandbox.run(&["fmt", "--check", "a.mod", "b"]).code, 0);
    let faulty = sandbox.run(&["fmt", "d.mod"]);
    assert!(faulty.code == 1 && faulty.err.contains("E0004"), "{}", faulty.err);
    assert_eq!(fs::read_to_string(sandbox.path("d.mod")).expect("it is there"), "let a = (\n");
    assert_eq!(sandbox.run(&["fmt", "missing.mod"]).code, 2);
}

#[test]
fn scenes_are_laid_out_as_configurations_are() {
    let wild = "scene  Yard ( gap:Length=600mm ) {\n part a:Tank7\n part b :Tank7 at[gap,0m,0m]turned ( Z,180deg )\n \
                obstacle wall=box(20mm,1m,200mm)at [300mm,0m,0m]\n for i in 0..3{obstacle post [i]=sphere(10mm)}\n \
                world (friction:0.8)\n}\n";
    let tidy = "scene Yard(gap: Length = 600mm) {\n  part a: Tank7\n  part b: Tank7 at [gap, 0m, 0m] turned(Z, 180deg)\n  \
                obstacle wall = box(20mm, 1m, 200mm) at [300mm, 0m, 0m]\n  for i in 0..3 { obstacle post[i] = \
                sphere(10mm) }\n  world(friction: 0.8)\n}\n";
    assert_eq!(formatted(wild), tidy);
}
