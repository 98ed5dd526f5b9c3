//! The room `interpret` through its door: programs with what they print, and what is said of them.

use crate::support::suite::{MapFiles, Observed};
use modl::check::typed::DefKind;
use modl::check::{Choice, Program, Type};
use modl::interpret::argument::Kind;
use modl::interpret::native::Call;
use modl::interpret::routines::Routines;
use modl::interpret::stop::Eval;
use modl::interpret::value::Value;
use modl::interpret::{Host, Mode, Options, Outcome, WriteError};
use modl::natives::Native;
use modl::source::{FileId, Sources};
use std::collections::{BTreeMap, BTreeSet};

/// A host that keeps what it is given.
#[derive(Default)]
pub struct Buffer {
    pub printed: Vec<String>,
    pub written: BTreeMap<String, Vec<u8>>,
    pub progress: Vec<String>,
}

impl Host for Buffer {
    fn print(&mut self, line: &str) {
        self.printed.push(line.to_string());
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        self.written.insert(path.to_string(), bytes.to_vec());
        Ok(path.to_string())
    }

    fn progress(&mut self, line: &str) {
        self.progress.push(line.to_string());
    }
}

/// What came of a program: what `check` says, and what running it says where that was no error.
pub struct Ran {
    pub sources: Sources,
    pub file: Option<FileId>,
    pub outcome: Outcome,
    pub host: Buffer,
}

pub fn ran(files: &MapFiles, main: &str, mode: Mode, options: &Options) -> Ran {
    let checked = modl::check::check(files, main);
    let mut host = Buffer::default();
    let mut outcome = Outcome::default();
    if !checked.has_errors() {
        outcome = modl::execute::run(&checked, mode, files, &mut host, options);
    }
    outcome.diagnostics.splice(0..0, checked.diagnostics.iter().cloned());
    let file = checked.sources.files().find(|(_, f)| &*f.name == main).map(|(id, _)| id);
    Ran { sources: checked.sources, file, outcome, host }
}

pub fn run_text(text: &str, mode: Mode) -> Ran {
    ran(&MapFiles::of(text), "main.mod", mode, &Options::default())
}

fn observe(text: &str, mode: Mode) -> Observed {
    let Ran { sources, file, outcome, host } = run_text(text, mode);
    Observed { sources, file, diagnostics: outcome.diagnostics, printed: host.printed }
}

#[test]
fn programs_do_what_they_say() {
    crate::support::suite::run("run", |text| observe(text, Mode::Run));
}

#[test]
fn declarations_are_judged_as_they_say() {
    crate::support::suite::run("elaborate", |text| observe(text, Mode::Check));
}

/// The stack bears fewer levels in a build without optimisation, so the place differs, but never the outcome.
#[test]
fn calls_that_need_much_stack_end_with_a_diagnostic() {
    let text = "fn f(n: Int) -> Int = 1 + (2 * (3 + (4 * (5 + (6 * (7 + f(n + 1)))))))\nprint(f(0))\n";
    let observed = observe(text, Mode::Run);
    let [only] = observed.diagnostics.as_slice() else { panic!("{:?}", observed.diagnostics) };
    assert_eq!(only.code.0, "E0503");
    assert!(only.hints.iter().any(|hint| hint.contains("calls are nested here")), "{:?}", only.hints);
}

/// A record of another file is built, changed and compared, under its own name or another.
#[test]
fn records_of_other_files_are_the_same_records() {
    let mut files = MapFiles::of(
        "use \"lib.mod\".{Design as Plan2, fast}\nuse \"lib.mod\".{Design}\n\
         print(fast with { bend: 2deg }, Plan2(bend: 1deg) == fast, Design(bend: 2deg).bend)\n",
    );
    let lib = "record Design { bend: Angle, _hidden: Int = 3 }\nlet fast = Design(bend: 1deg)\n";
    files.0.insert("lib.mod".into(), lib.as_bytes().to_vec());
    let ran = ran(&files, "main.mod", Mode::Run, &Options::default());
    assert!(ran.outcome.diagnostics.is_empty(), "{:?}", ran.outcome.diagnostics);
    assert_eq!(ran.host.printed, ["Design(bend: 2deg, _hidden: 3) true 2deg"]);
}

/// Many records in a row, and one that all of them hold, are checked in a moment.
#[test]
fn many_records_in_a_row_are_checked_quickly() {
    let row = (0..3_000).map(|i| format!("record R{i} {{ next: R{}, other: R3000 }}\n", i + 1));
    let text: String = row.chain(["record R3000 {}\n".to_owned()]).collect();
    let checked = modl::check::check(&MapFiles::of(&text), "main.mod");
    assert!(checked.diagnostics.is_empty(), "{:?}", checked.diagnostics.first());
}

/// Every built-in that is declared has a body, or says that it is not yet available; every body is
/// declared, with parameters of the same names and types, of which the same may be missing.
#[test]
fn declarations_and_bodies_of_built_ins_agree() {
    // The prelude is always there; of the rest, only RoFI's file declares a built-in.
    let checked = modl::check::check(&MapFiles::of("use std.rofi\n"), "main.mod");
    let bodies: BTreeMap<&str, &Native> = modl::natives::all().map(|n| (n.key, n)).collect();
    let mut declared = BTreeSet::new();
    for def in &checked.program.defs {
        let DefKind::Native(native) = &def.kind else { continue };
        let key = native.key.as_str();
        declared.insert(key);
        let body = bodies.get(key).unwrap_or_else(|| panic!("`{key}` has a body"));
        assert_eq!(body.parameters.len(), native.params.len(), "the parameters of `{key}`");
        for param in &native.params {
            let name = param.name.as_str();
            let read = body.parameters.iter().find(|parameter| parameter.name == name);
            let read = read.unwrap_or_else(|| panic!("the body of `{key}` reads `{name}`"));
            let fits = match param.variadic {
                true => matches!(read.kind, Kind::List),
                false => reads(&checked.program, read.kind, &param.ty),
            };
            assert!(fits, "`{key}` reads `{name}`, a {:?}, as {:?}", param.ty, read.kind);
            // What is always there has a default where it may be left out.
            assert!(param.default.is_none() || !matches!(read.kind, Kind::Optional(_)), "`{key}`: `{name}`");
        }
    }
    let undeclared: Vec<_> = bodies.keys().filter(|key| !declared.contains(*key)).collect();
    assert!(undeclared.is_empty(), "bodies without a declaration: {undeclared:?}");
    assert!(declared.len() > 80, "the prelude was read");
}

/// Whether a native that reads `kind` can be given every value of a declared type.
fn reads(program: &Program, kind: Kind, ty: &Type) -> bool {
    let words = |choice: &Choice| choice.words.iter().map(|word| word.as_str()).collect::<Vec<_>>();
    match (kind, ty) {
        (Kind::Optional(kind), Type::Optional(inner)) => reads(program, *kind, inner),
        (Kind::Optional(_), _) | (_, Type::Optional(_)) => false,
        (Kind::Choice(known), Type::Choice(choice)) => choice.types.is_empty() && known() == words(choice),
        (Kind::WordOr(known, Kind::Choice(others)), Type::Choice(choice)) => {
            choice.types.is_empty() && [known(), others()].concat() == words(choice)
        }
        (Kind::WordOr(known, other), Type::Choice(choice)) => {
            known() == words(choice) && choice.types.iter().all(|ty| reads(program, *other, ty))
        }
        (kind, Type::Choice(choice)) => {
            choice.words.is_empty() && choice.types.iter().all(|ty| reads(program, kind, ty))
        }
        (Kind::Value, _) => true,
        (Kind::Bool, Type::Bool)
        | (Kind::Int, Type::Int)
        | (Kind::Number, Type::Quantity(_) | Type::QuantityParam { .. } | Type::Int)
        | (Kind::Text, Type::Text)
        | (Kind::List, Type::List(_))
        | (Kind::Vec3, Type::Vec3(_))
        | (Kind::Range, Type::Range(_))
        | (Kind::Pose, Type::Pose)
        | (Kind::Fn, Type::Fn(_))
        | (Kind::Instance, Type::AnyOf(_) | Type::Instance(_) | Type::Param(_))
        | (Kind::Joint, Type::Joint(_))
        | (Kind::Port, Type::Port)
        | (Kind::Behavior, Type::Behavior)
        | (Kind::Condition, Type::Condition)
        | (Kind::Shape, Type::Shape)
        | (Kind::Mesh, Type::Mesh)
        | (Kind::Cells, Type::Cells)
        | (Kind::Terrain, Type::Terrain) => true,
        (Kind::Record(name), Type::Record(def)) => program.def(*def).name.as_str() == name,
        _ => false,
    }
}

#[test]
fn fields_of_records_are_those_that_are_declared() {
    let checked = modl::check::check(&MapFiles::of(""), "main.mod");
    let mut compared = 0;
    for def in &checked.program.defs {
        let DefKind::Record(record) = &def.kind else { continue };
        let Some(fields) = modl::natives::fields_of(def.name.as_str()) else { continue };
        let declared: Vec<&str> = record.fields.iter().map(|f| f.name.as_str()).collect();
        assert_eq!(declared, fields, "fields of `{}`", def.name);
        compared += 1;
    }
    assert_eq!(compared, 21);
}

#[test]
fn a_limit_on_steps_ends_the_run() {
    let mut options = Options::default();
    options.limits.steps = 10_000;
    let ran = ran(&MapFiles::of("print(sum([i for i in 0..1_000_000]))\n"), "main.mod", Mode::Run, &options);
    let codes: Vec<_> = ran.outcome.diagnostics.iter().map(|d| d.code.0).collect();
    assert_eq!(codes, ["E0504"]);
    assert!(ran.host.printed.is_empty());
}

#[test]
fn a_test_fails_where_what_it_depends_on_failed_before() {
    let program = "let a = 1 / (1 - 1)\n\
                   test \"one\" {\n  expect a > 0\n}\n\
                   test \"two\" {\n  expect a > 0\n}\n\
                   test \"three\" {\n  expect 1 + 1 == 2\n}\n";
    let ran = run_text(program, Mode::Test);
    let passed: Vec<bool> = ran.outcome.tests.iter().map(|t| t.passed).collect();
    assert_eq!(passed, [false, false, true]);
    let codes: Vec<_> = ran.outcome.diagnostics.iter().map(|d| d.code.0).collect();
    assert_eq!(codes, ["E0502"], "one finding, told once");
}

#[test]
fn a_program_writes_the_same_bytes_every_time() {
    let program = "use std.smores.Smores\n\
                   config C { part m: Smores\n  behavior b = move(m.tilt, to: 10deg)\n}\n\
                   emit(C().b(), \"b.plan.json\")\n";
    let (first, second) = (run_text(program, Mode::Run), run_text(program, Mode::Run));
    assert_eq!(first.outcome.written, ["b.plan.json"], "{:?}", first.outcome.diagnostics);
    assert_eq!(first.host.written, second.host.written);
}

#[test]
fn what_is_verified_and_then_written_is_judged_once() {
    let program = "use std.smores.Smores\n\
                   config C { part m: Smores\n  behavior b = move(m.tilt, to: 10deg)\n}\n\
                   print(verify(C().b()).ok)\nemit(C().b(), \"b.plan.json\")\n";
    let ran = run_text(program, Mode::Run);
    assert_eq!(ran.host.printed, ["true"], "{:?}", ran.outcome.diagnostics);
    assert_eq!(ran.host.progress, ["verifying C"]);
}

/// The length of a line's last word, in millimetres.
fn last_length(line: &str) -> f64 {
    let word = line.rsplit(' ').next().expect("a line has words");
    word.trim_end_matches("mm").parse().expect("a length in millimetres")
}

#[test]
fn the_square_comes_back_to_where_it_began() {
    let text = include_str!("../../examples/square.mod");
    let ran = run_text(text, Mode::Run);
    assert_eq!(ran.host.printed[0], "order 1 modules 1 mass 557.2924g");
    let line = &ran.host.printed[1];
    // 45.3 mm of wheel radius at 2 rad/s for 5 s, less two ramps of 2 rad/s at 12 rad/s², and what the wheels creep.
    let side = line.split(" once").next().expect("a line has a beginning");
    let rolled = 45.3 * 2.0 * (5.0 - 2.0 / 12.0);
    assert!((last_length(side) - rolled).abs() < 0.005 * rolled, "{line}");
    assert!(last_length(line) < 20.0, "{line}");
}

/// The planner is not there yet; what is wrong with its argument is told all the same.
#[test]
fn a_lattice_in_two_pieces_is_refused_where_it_is_made() {
    let program = "use std.crystal.ExpandingCube\n\
                   lattice Row of ExpandingCube = row(9)\n\
                   lattice Split of ExpandingCube = cells(\"##.##\")\n\
                   let p = squeeze(Row(), Split())\n";
    let ran = run_text(program, Mode::Run);
    let [diagnostic] = &ran.outcome.diagnostics[..] else { panic!("{:?}", ran.outcome.diagnostics) };
    assert_eq!(diagnostic.code.0, "E0313");
    let span = diagnostic.span().expect("a place");
    assert_eq!(ran.sources.text(span), "Split()");
}

#[test]
fn a_snake_of_three_hundred_modules_is_elaborated_at_once() {
    // Steps stand in for time: they do not depend on the machine.
    let program = "use std.smores.Chain3\n\
                   config Snake(n: Int) {\n  part seg[n]: Chain3\n  \
                   for i in 0..n - 1 { connect seg[i].head -- seg[i + 1].tail }\n}\n\
                   print(count(Snake(100)), order(Snake(100)))\n";
    let mut options = Options::default();
    options.limits.steps = 20_000;
    let ran = ran(&MapFiles::of(program), "main.mod", Mode::Run, &options);
    assert_eq!(ran.host.printed, ["300 2"], "{:?}", ran.outcome.diagnostics);
}

/// A built-in that forgets to say what is wrong.
fn silent(_: &mut modl::interpret::interpreter::Interpreter, _: &Call) -> Eval<Value> {
    Ok(Value::Unknown)
}

#[test]
fn a_value_that_is_lost_without_a_word_is_reported() {
    static SILENT: Native = Native::pure("len", &[], silent);
    let routines = Routines {
        native: |key| if key.as_str() == "len" { Some(&SILENT) } else { modl::natives::find(key) },
        instantiate: modl::elaborate::instantiate,
        robot_of: modl::elaborate::robot_of,
        hinge_of: modl::elaborate::hinge_of,
        check_declaration: modl::elaborate::check_declaration,
        show: modl::display::show,
        typed: modl::display::typed,
        display: modl::display::display,
        describe_declaration: modl::display::describe_declaration,
        capabilities: modl::natives::capabilities,
        draw_declared: modl::natives::draw_declared,
    };
    let ended = |text: &str| {
        let files = MapFiles::of(text);
        let checked = modl::check::check(&files, "main.mod");
        assert!(!checked.has_errors(), "{:?}", checked.diagnostics);
        let options = Options::default();
        let outcome =
            modl::interpret::run(&routines, &checked, Mode::Run, &files, &mut Buffer::default(), &options);
        let found =
            outcome.diagnostics.iter().map(|d| (d.code.0, checked.sources.text(d.span().expect("a place"))));
        found.map(|(code, text)| (code, text.to_string())).collect::<Vec<_>>()
    };
    assert_eq!(ended("let n = len([1])\nprint(n + 1)\n"), [("E0508", "len([1])".to_string())]);
    // An error that was told is reason enough.
    assert_eq!(ended("let n = [1][1]\nprint(len([n]))\n"), [("E0501", "[1][1]".to_string())]);
}

#[test]
fn many_warnings_leave_no_error_unsaid() {
    let twice = "Pc(move(m.tilt, to: 1deg), move(m.tilt, to: 1deg))";
    let bodies: String = (0..210).map(|i| format!("  behavior b{i} = {twice}\n")).collect();
    let plans: String = (0..210).map(|i| format!("print(plan(C().b{i}()).duration > 0s)\n")).collect();
    let text =
        format!("use std.smores.Smores\nconfig C {{\n  part m: Smores\n{bodies}}}\n{plans}print([1][1])\n");
    let found: Vec<&str> = run_text(&text, Mode::Run).outcome.diagnostics.iter().map(|d| d.code.0).collect();
    assert!(found.len() > 200 && found.contains(&"E0501"), "{found:?}");
}

/// Sixty lists, each of which holds the one before twice.
fn shared_lists(name: &str) -> String {
    let lists = (1..=60).map(|i| format!("let {name}{i} = [{name}{}, {name}{}]\n", i - 1, i - 1));
    format!("let {name}0 = [1]\n{}", lists.collect::<String>())
}

#[test]
fn lists_that_share_their_elements_are_compared_and_printed_within_limits() {
    let lists = shared_lists("x") + &shared_lists("y");
    let ran = run_text(
        &format!("{lists}print(x60 == y60, x60 == [y59, x59], contains([y60], x60))\nprint(x4)\n"),
        Mode::Run,
    );
    assert_eq!(ran.host.printed[0], "true true true", "{:?}", ran.outcome.diagnostics);
    for text in ["print(x60)", "print(\"{x60}\")", "let t = \"{[x60]}\"\nprint(t)"] {
        let ran = run_text(&format!("{lists}{text}\n"), Mode::Run);
        let codes: Vec<&str> = ran.outcome.diagnostics.iter().map(|d| d.code.0).collect();
        assert_eq!(codes, ["E0505"], "{text}");
    }
}

/// Behaviours of ten of the one before, level by level: as declared behaviours, and as values.
fn nested_behaviors(levels: usize) -> [String; 2] {
    let ten = |name: String| vec![name; 10].join(", ");
    let declared = |i: usize| format!("  behavior b{i} = Sc({})\n", ten(format!("b{}()", i - 1)));
    let valued = |i: usize| format!("let c{i} = Sc({})\n", ten(format!("c{}", i - 1)));
    let head = "use std.smores.Smores\nconfig C {\n  part m: Smores\n  behavior b0 = wait(1ms)\n";
    let first: String = (1..=levels).map(declared).collect();
    let second: String = (1..=levels).map(valued).collect();
    [
        format!("{head}{first}}}\nprint(C().b{levels}().duration)\n"),
        format!("{head}}}\nlet c0 = C().b0()\n{second}print(c{levels}.duration)\n"),
    ]
}

#[test]
fn actions_are_counted_before_anything_walks_them() {
    for text in nested_behaviors(3) {
        let ran = run_text(&text, Mode::Run);
        assert_eq!(ran.host.printed, ["1s"], "{:?}", ran.outcome.diagnostics);
    }
    // Of the deepest, all numbers of actions are beyond what a machine word holds.
    for levels in [7, 30] {
        for text in nested_behaviors(levels) {
            let found: Vec<&str> =
                run_text(&text, Mode::Run).outcome.diagnostics.iter().map(|d| d.code.0).collect();
            assert_eq!(found, ["E0505"], "{levels}");
        }
        let [declared, _] = nested_behaviors(levels);
        let checked = run_text(&declared, Mode::Check).outcome.diagnostics;
        assert!(
            checked.iter().any(|d| d.code.0 == "E0505" && d.message.contains("5000000 actions")),
            "{checked:?}"
        );
    }
    let often = "use std.smores.Smores\nconfig C {\n  part m: Smores\n  behavior b = repeat(repeat(wait(1ms), 5000000), 5000000)\n}\n";
    let checked = run_text(often, Mode::Check).outcome.diagnostics;
    assert!(matches!(checked.as_slice(), [d] if d.code.0 == "E0505"), "{checked:?}");
}

#[test]
fn a_behavior_that_prints_does_so_at_each_call() {
    let text = "use std.smores.Smores\nconfig C {\n  part m: Smores\n  behavior b = {\n    print(\"made\")\n    move(m.tilt, to: 1deg)\n  }\n}\nlet c = C()\nlet twice = Sc(c.b(), c.b())\nprint(twice.duration > 0s)\n";
    let ran = run_text(text, Mode::Run);
    assert_eq!(ran.host.printed, ["made", "made", "true"], "{:?}", ran.outcome.diagnostics);
}
