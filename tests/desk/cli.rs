//! The command as its users meet it: exit codes, pipes, terminals, files that are odd or hostile.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A folder of its own, and the command run in it.
pub struct Sandbox(TempDir);

pub struct Ran {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Sandbox {
    pub fn new(files: &[(&str, &[u8])]) -> Sandbox {
        let sandbox = Sandbox(TempDir::new().expect("a temporary folder"));
        for (name, bytes) in files {
            let path = sandbox.path(name);
            fs::create_dir_all(path.parent().expect("below the folder")).expect("a folder can be made");
            fs::write(path, bytes).expect("a file can be written");
        }
        sandbox
    }

    pub fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.path().join(name)
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_modl"));
        command.args(arguments).current_dir(self.0.path());
        command.env_remove("NO_COLOR").env_remove("COLUMNS");
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Ran {
        ran(self.command(arguments).stdin(Stdio::null()).output().expect("the command runs"))
    }

    /// What is printed to standard output and standard error, as a terminal would show it.
    pub fn run_together(&self, arguments: &[&str], input: &[u8]) -> String {
        let (mut printed, output) = std::io::pipe().expect("a pipe");
        let mut command = self.command(arguments);
        command.stdin(Stdio::piped()).stdout(output.try_clone().expect("a pipe")).stderr(output);
        let mut child = command.spawn().expect("the command runs");
        // What is left of the pipe's writing end is in the command.
        drop(command);
        child.stdin.take().expect("piped").write_all(input).expect("the command reads all of it");
        let mut text = String::new();
        std::io::Read::read_to_string(&mut printed, &mut text).expect("the command prints UTF-8");
        child.wait().expect("the command ends");
        text
    }

    pub fn run_with_input(&self, arguments: &[&str], input: &[u8]) -> Ran {
        let mut command = self.command(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the command runs");
        child.stdin.take().expect("piped").write_all(input).expect("the command reads all of it");
        ran(child.wait_with_output().expect("the command ends"))
    }
}

pub fn ran(output: std::process::Output) -> Ran {
    let text = |bytes| String::from_utf8(bytes).expect("the command prints UTF-8");
    Ran { code: output.status.code().unwrap_or(-1), out: text(output.stdout), err: text(output.stderr) }
}

pub fn json(ran: &Ran) -> serde_json::Value {
    serde_json::from_str(&ran.out).unwrap_or_else(|e| panic!("{e} in\n{}", ran.out))
}

const FINE: &[u8] = b"let a = 1\n";

#[test]
fn a_wrong_call_ends_with_2_and_says_why() {
    let s = Sandbox::new(&[("a.mod", FINE), ("sub/b.mod", FINE)]);
    for (arguments, words) in [
        (&["frobnicate"][..], "no command `frobnicate`; `modl --help` lists the commands"),
        (&["rnu", "a.mod"], "no command `rnu`; did you mean `modl run`?"),
        (&["a.mod"], "no command `a.mod`; `modl run a.mod` runs a program"),
        (&["check"], "FILE"),
        (&["check", "nothing.mod"], "`nothing.mod` does not exist"),
        (&["check", "a.mod", "nothing.mod"], "`nothing.mod` does not exist"),
        (&["run", "sub"], "`sub` is a folder; name one of its programs"),
        (&["check", "a.mod", "--root", "sub"], "outside the project"),
        (&["check", "a.mod", "--root", "a.mod"], "no folder"),
        (&["check", "a.mod", "--stdlib", "nowhere"], "`nowhere` does not exist"),
        (&["run", "a.mod", "--seed", "many"], "many"),
        (&["run", "a.mod", "--max-steps", "0"], "0"),
        (&["verify", "nothing.json"], "`nothing.json` does not exist"),
        (&["explain", "E03o1"], "did you mean E0301?"),
        (&["completions", "dos"], "dos"),
    ] {
        let ran = s.run(arguments);
        assert_eq!(ran.code, 2, "{arguments:?}: {}", ran.err);
        assert!(ran.err.contains(words), "{arguments:?}: {}", ran.err);
    }
    let ran = s.run(&["check", "nothing.mod", "--json"]);
    assert_eq!((ran.code, json(&ran)["ok"].as_bool()), (2, Some(false)));
}

#[test]
fn planners_take_the_seed_of_the_command_line_unless_they_are_given_one() {
    let program = |seed: &str| {
        let plan = format!("let p = tosnake(tangle(6, 60, seed: 3){seed})");
        format!("use std.rofi.tangle\n{plan}\nprint(p.steps, p.duration)\nemit(p, \"a.plan.json\")\n")
    };
    let (open, stated) = (program(""), program(", seed: 5"));
    let s = Sandbox::new(&[("open.mod", open.as_bytes()), ("stated.mod", stated.as_bytes())]);
    let planned = |arguments: &[&str]| {
        let printed = s.run(arguments).out;
        let plan: serde_json::Value =
            serde_json::from_slice(&fs::read(s.path("out/a.plan.json")).expect("a plan")).expect("JSON");
        (printed, plan["provenance"]["seed"].as_u64())
    };
    let with_five = planned(&["run", "open.mod", "--seed", "5"]);
    assert_eq!(with_five.1, Some(5));
    assert_eq!(planned(&["run", "stated.mod", "--seed", "7"]), with_five);
    let without = planned(&["run", "open.mod"]);
    assert_eq!(without.1, Some(0));
    assert_ne!(without.0, with_five.0, "other seeds find other ways");
}

#[test]
fn a_fine_program_ends_with_0_and_a_wrong_one_with_1() {
    let s = Sandbox::new(&[("a.mod", FINE), ("bad.mod", b"let a = \xff\n")]);
    assert_eq!(s.run(&["check", "a.mod"]).code, 0);
    assert_eq!(s.run(&["check", "a.mod"]).err, "");
    assert_eq!(s.run(&["run", "a.mod"]).code, 0);
    assert_eq!(s.run(&["test", "a.mod"]).code, 0);
    assert_eq!(s.run(&["check", "a.mod", "bad.mod"]).code, 1);
    assert_eq!(s.run(&["run", "bad.mod"]).code, 1);
    assert_eq!(s.run(&["test", "bad.mod"]).code, 1);
}

#[test]
fn help_shows_examples_and_every_command_has_its_own() {
    let s = Sandbox::new(&[]);
    let help = s.run(&["--help"]);
    assert_eq!(help.code, 0);
    assert!(help.out.contains("Examples:") && help.out.contains("Exit codes:"), "{}", help.out);
    for command in ["run", "check", "test", "verify", "new", "explain", "completions"] {
        let own = s.run(&[command, "--help"]);
        assert!(own.code == 0 && own.out.contains("modl "), "{command}: {}", own.out);
    }
}

#[test]
fn bytes_that_are_no_text_are_pointed_at() {
    let s = Sandbox::new(&[("a.mod", b"let a = 1\nlet b = \"\xe4\"\n")]);
    let ran = s.run(&["check", "a.mod"]);
    assert!(ran.code == 1 && ran.err.contains("E0002") && ran.err.contains("a.mod:2:10"), "{}", ran.err);
    let label = &json(&s.run(&["check", "a.mod", "--json"]))["diagnostics"][0]["labels"][0];
    assert_eq!(label["offset"], 19);
}

#[test]
fn byte_order_marks_and_windows_line_ends_are_no_mistakes() {
    let s = Sandbox::new(&[("a.mod", b"\xef\xbb\xbflet a = 1\r\nlet b = a\r\n"), ("empty.mod", b"")]);
    let ran = s.run(&["check", "a.mod", "empty.mod"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
}

#[test]
fn characters_that_hide_are_refused_and_never_reach_the_terminal() {
    let odd = "let a = 1 \0\nlet b = 2 \u{202e}\nlet c\u{200b} = \u{1b}[31m\n";
    let s = Sandbox::new(&[("a.mod", odd.as_bytes())]);
    let ran = s.run(&["check", "a.mod"]);
    assert_eq!(ran.code, 1);
    assert!(ran.err.matches("E0003").count() >= 3, "{}", ran.err);
    assert!(!ran.err.contains(['\0', '\u{202e}', '\u{200b}', '\u{1b}']), "{:?}", ran.err);
}

#[test]
fn imports_stay_in_the_project() {
    let s = Sandbox::new(&[
        ("outside.mod", FINE),
        ("project/a.mod", b"use \"../outside.mod\".{a}\n"),
        ("project/b.mod", b"use \"/etc/passwd\".{a}\n"),
        ("project/sub/c.mod", b"use \"../fine.mod\".{a}\nlet b = a\n"),
        ("project/fine.mod", FINE),
    ]);
    for file in ["project/a.mod", "project/b.mod", "project/sub/c.mod"] {
        let ran = s.run(&["check", file]);
        assert!(ran.code == 1 && ran.err.contains("E0105"), "{file}: {}", ran.err);
    }
    for (file, root) in [("project/a.mod", "."), ("project/sub/c.mod", "project")] {
        let ran = s.run(&["check", file, "--root", root]);
        assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{file} in {root}");
    }
}

#[test]
fn a_huge_file_is_refused_without_being_read() {
    let s = Sandbox::new(&[("huge.mod", b"")]);
    let file = fs::File::create(s.path("huge.mod")).expect("a file can be made");
    file.set_len(1 << 40).expect("a file may have a hole");
    let ran = s.run(&["check", "huge.mod"]);
    assert!(ran.code == 2 && ran.err.contains("larger than 64 MiB"), "{}", ran.err);
}

#[test]
fn standard_input_is_a_program_too() {
    let s = Sandbox::new(&[]);
    assert_eq!(s.run_with_input(&["check", "-"], FINE).code, 0);
    let ran = s.run_with_input(&["check", "-"], b"let \xff\n");
    assert!(ran.code == 1 && ran.err.contains("<stdin>:1:5"), "{}", ran.err);
}

#[test]
fn diagnostics_name_files_as_the_user_would() {
    let s = Sandbox::new(&[("robots/parts/a.mod", b"let \xff\n")]);
    for (arguments, name) in [
        (&["check", "robots/parts/a.mod"][..], "[robots/parts/a.mod:1:5]"),
        (&["check", "./robots/parts/a.mod"], "[./robots/parts/a.mod:1:5]"),
        (&["check", "robots/parts/a.mod", "--root", "."], "[robots/parts/a.mod:1:5]"),
        (&["check", "robots/parts/a.mod", "--root", "robots"], "[robots/parts/a.mod:1:5]"),
    ] {
        let ran = s.run(arguments);
        assert!(ran.err.contains(name), "{arguments:?}: {}", ran.err);
    }
}

#[test]
fn json_is_one_object_on_standard_output() {
    let s = Sandbox::new(&[("a.mod", b"let \xff\n"), ("b.mod", b"let \xff\n")]);
    let ran = s.run(&["check", "--json", "a.mod", "b.mod"]);
    assert_eq!((ran.code, ran.err.as_str()), (1, ""));
    let object = json(&ran);
    assert_eq!(object["ok"], false);
    assert_eq!(object["errors"], 2);
    let files: Vec<_> =
        object["diagnostics"].as_array().expect("a list").iter().map(|d| &d["labels"][0]["file"]).collect();
    assert_eq!(files, ["a.mod", "b.mod"]);
}

#[test]
fn colour_is_for_terminals_and_for_those_who_ask() {
    let s = Sandbox::new(&[("a.mod", b"let \xff\n")]);
    let colored = |arguments: &[&str]| s.run(arguments).err.contains('\u{1b}');
    assert!(!colored(&["check", "a.mod"]), "no terminal, no colour");
    assert!(colored(&["check", "a.mod", "--color", "always"]));
    assert!(!colored(&["check", "a.mod", "--color", "never"]));
    let links = s.run(&["check", "a.mod", "--color", "always"]).err;
    assert!(!links.contains("\u{1b}]8"), "no terminal links");
}

#[test]
fn a_narrow_terminal_is_kept_to() {
    let s = Sandbox::new(&[("a.mod", &[b"let a = ".as_slice(), &b"1 + ".repeat(100), b"\xff\n"].concat())]);
    for columns in ["30", "40", "60"] {
        let output =
            s.command(&["check", "a.mod"]).env("COLUMNS", columns).output().expect("the command runs");
        let ran = ran(output);
        let widest = ran.err.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        assert!(widest <= columns.parse().expect("a number"), "{widest} > {columns}\n{}", ran.err);
    }
}

#[test]
fn a_reader_that_goes_away_is_no_mistake() {
    let s = Sandbox::new(&[]);
    let mut child =
        s.command(&["explain"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("runs");
    drop(child.stdout.take());
    let ran = ran(child.wait_with_output().expect("the command ends"));
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
}

#[test]
fn every_code_is_explained() {
    let s = Sandbox::new(&[]);
    let list = s.run(&["explain"]).out;
    for (code, title) in modl::source::code::ALL {
        assert!(list.contains(&format!("{code}  {title}\n")), "{code}");
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/errors/{code}.md"));
        let page = fs::read_to_string(page).expect("every code has a page");
        assert_eq!(s.run(&["explain", code.0]).out, page, "src/document/manual.rs lists every page");
        assert!(page.starts_with(&format!("# {code}: {title}\n")), "{code}: the page has the code's title");
    }
    assert_eq!(s.run(&["explain", "e0301"]).code, 0);
    assert_eq!(json(&s.run(&["explain", "E0301", "--json"]))["code"], "E0301");
}

#[test]
fn completions_know_the_commands() {
    let s = Sandbox::new(&[]);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ran = s.run(&["completions", shell]);
        assert!(ran.code == 0 && ran.out.contains("verify") && ran.out.contains("max-steps"), "{shell}");
    }
}

#[test]
fn new_overwrites_nothing() {
    let s = Sandbox::new(&[("taken/keep.txt", b"mine")]);
    assert_eq!(s.run(&["new", "taken"]).code, 2);
    assert_eq!(fs::read_dir(s.path("taken")).expect("still there").count(), 1);
    assert_eq!(s.run(&["new", "robots/rover"]).code, 0);
    assert!(s.path("robots/rover/main.mod").exists());
    let again = s.run(&["new", "robots/rover"]);
    assert!(again.code == 2 && again.err.contains("exists"), "{}", again.err);
}

#[test]
fn a_new_project_runs_is_verified_and_passes_its_test() {
    let s = Sandbox::new(&[]);
    assert_eq!(s.run(&["new", "rover"]).code, 0);
    let ran = s.run(&["run", "rover/main.mod"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("wrote out/drive.plan.json"), "{}", ran.err);
    let verified = s.run(&["verify", "out/drive.plan.json"]);
    assert!(verified.code == 0 && verified.out.contains("verified"), "{}{}", verified.out, verified.err);
    let tested = s.run(&["test", "rover/main.mod"]);
    assert!(tested.code == 0 && tested.out.contains("1 passed, 0 failed"), "{}{}", tested.out, tested.err);
}

/// The facts of the modules that a verdict rests on, and where they are not those of the library that has their name.
#[test]
fn the_facts_of_a_plan_file_are_told_with_their_differences_from_the_library() {
    let s = Sandbox::new(&[(
        "m.mod",
        b"use std.smores.Driver1\nemit(plan(Driver1().drive(t: 1s)), \"p.plan.json\")\n",
    )]);
    assert_eq!(s.run(&["run", "m.mod"]).code, 0);
    let plan = s.path("out/p.plan.json");
    let verified = s.run(&["verify", "out/p.plan.json"]);
    assert!(verified.out.contains("rests on module Smores, as std.smores.Smores ("), "{}", verified.out);
    let mut file: serde_json::Value =
        serde_json::from_slice(&fs::read(&plan).expect("it was written")).expect("it is JSON");
    let module = &mut file["library"]["modules"][0];
    module["touch"] = 0.004.into();
    module["joints"][0]["limits"]["effort"] = serde_json::Value::Null;
    module["links"][0]["mass"] = 0.2.into();
    fs::write(&plan, file.to_string()).expect("it can be written");
    let altered = s.run(&["verify", "out/p.plan.json"]);
    for difference in [
        "touch is 0.004, there 0.0001",
        "joints.tilt.limits.effort is not stated, there 2.3",
        "links.holder.mass is 0.2, there 0.127498",
    ] {
        let told = format!("differs from std.smores.Smores: {difference}");
        assert!(altered.out.contains(&told), "{told}: {}", altered.out);
    }
    let report = json(&s.run(&["verify", "--json", "out/p.plan.json"]));
    let facts = &report["plans"][0]["rests_on"][0];
    assert_eq!(facts["standard"], "std.smores.Smores");
    assert_eq!(facts["differences"].as_array().map(Vec::len), Some(3));
}

const TESTS: &[u8] =
    b"print(1)\ntest \"one is one\" { expect 1 == 1 }\ntest \"one is two\" { expect 1 == 2 }\n";

#[test]
fn tests_are_counted_and_filtered_and_statements_are_not_run() {
    let s = Sandbox::new(&[("t.mod", TESTS)]);
    let all = s.run(&["test", "t.mod"]);
    assert_eq!(all.code, 1);
    assert!(all.out.ends_with("1 passed, 1 failed\n") && !all.out.starts_with('1'), "{}", all.out);
    assert!(all.err.contains("E0507"), "{}", all.err);
    let one = s.run(&["test", "t.mod", "--filter", "is one"]);
    assert!(one.code == 0 && one.out.ends_with("1 passed, 0 failed\n"), "{}", one.out);
    let object = json(&s.run(&["test", "--json", "t.mod"]));
    assert_eq!(
        object["tests"][1],
        serde_json::json!({ "file": "t.mod", "name": "one is two", "passed": false })
    );
}

#[test]
fn limits_can_be_set() {
    let s = Sandbox::new(&[("a.mod", b"print(sum([i for i in 0..1000]))\n")]);
    let ran = s.run(&["run", "a.mod", "--max-steps", "100"]);
    assert!(ran.code == 1 && ran.err.contains("E0504"), "{}", ran.err);
    assert_eq!(s.run(&["run", "a.mod"]).out, "499500\n");
    assert_eq!(json(&s.run(&["run", "a.mod", "--json"]))["printed"], serde_json::json!(["499500"]));
}

/// A program that writes a small plan to a path.
fn writing_to(path: &str) -> Vec<u8> {
    let robot = "use std.smores.Smores\nconfig C {\n  part m: Smores\n  behavior b = spin(m.left, 1rad/s, for: 1s)\n}\n";
    format!("{robot}emit(C().b(), \"{path}\")\n").into_bytes()
}

#[test]
fn output_stays_in_its_folder() {
    for path in ["../x.json", "a/../../x.json", "/tmp/modl-x.json", "", ".", "a/.."] {
        let s = Sandbox::new(&[("project/a.mod", &writing_to(path))]);
        let ran = s.run(&["run", "project/a.mod", "--out", "project/out"]);
        assert_eq!(ran.code, 1, "{path}: {}", ran.err);
        assert!(ran.err.contains("E0701") || ran.err.contains("E0702"), "{path}: {}", ran.err);
        let left: Vec<_> =
            fs::read_dir(s.path("project")).expect("there").map(|e| e.expect("readable").path()).collect();
        assert!(!s.path("x.json").exists() && left.len() <= 2, "{path}: {left:?}");
    }
    let s = Sandbox::new(&[("a.mod", &writing_to("./deep/er/x.json"))]);
    let ran = s.run(&["run", "a.mod"]);
    assert!(ran.code == 0 && s.path("out/deep/er/x.json").exists(), "{}", ran.err);
    assert_eq!(fs::read_dir(s.path("out/deep/er")).expect("there").count(), 1, "nothing is left beside it");
}

#[test]
fn what_cannot_be_written_is_told() {
    let s = Sandbox::new(&[("a.mod", &writing_to("taken")), ("out/taken/x", b""), ("file", b"")]);
    for out in ["out", "file"] {
        let ran = s.run(&["run", "a.mod", "--out", out]);
        assert!(ran.code == 1 && ran.err.contains("E0702"), "{out}: {}", ran.err);
    }
}

#[test]
fn what_is_no_plan_file_is_told_so() {
    let s = Sandbox::new(&[("no.json", b"{\"plan\": 1}"), ("bytes.json", b"\xff\x00")]);
    for file in ["no.json", "bytes.json"] {
        let ran = s.run(&["verify", file]);
        assert!(ran.code == 1 && ran.err.contains("E0704"), "{}", ran.err);
    }
    assert_eq!(json(&s.run(&["verify", "--json", "no.json"]))["diagnostics"][0]["code"], "E0704");
}

#[test]
fn a_program_with_nothing_to_show_says_so() {
    let s = Sandbox::new(&[
        ("a.mod", b"let x = 1\n"),
        ("b.mod", b"config Empty {}\nexpect verify(Empty()).ok\n"),
    ]);
    let ran = s.run(&["show", "a.mod"]);
    assert!(ran.code == 0 && ran.err.contains("W0010") && ran.err.contains("emits no plan"), "{}", ran.err);
    assert!(s.run(&["run", "a.mod"]).err.is_empty());
    // The error is told, and not that nothing came of it.
    let ran = s.run(&["show", "b.mod"]);
    assert!(ran.code == 1 && ran.err.contains("E0316") && !ran.err.contains("W0010"), "{}", ran.err);
    let checked = s.run(&["check", "b.mod"]);
    assert!(checked.code == 1 && checked.err.contains("E0316"), "{}", checked.err);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn pipes_and_devices_are_not_waited_for() {
        let s = Sandbox::new(&[]);
        let made = Command::new("mkfifo").arg(s.path("pipe.mod")).status();
        if !made.is_ok_and(|status| status.success()) {
            println!("skipped: there is no mkfifo");
            return;
        }
        for (file, words) in
            [("pipe.mod", "no regular file"), ("/dev/zero", "no regular file"), (".", "holds no program")]
        {
            let ran = s.run(&["check", file]);
            assert!(ran.code == 2 && ran.err.contains(words), "{file}: {}", ran.err);
        }
        assert_eq!(s.run(&["verify", "pipe.mod"]).code, 2);
    }

    #[test]
    fn links_do_not_lead_out_of_the_project() {
        let s = Sandbox::new(&[
            ("outside/a.mod", FINE),
            ("project/b.mod", b"use \"link.mod\".{a}\n"),
            ("project/c.mod", b"use \"folder/a.mod\".{a}\n"),
            ("project/d.mod", b"use \"inside.mod\".{a}\n"),
            ("project/e.mod", b"use \"pipe.mod\".{a}\n"),
            ("project/real.mod", FINE),
        ]);
        symlink("../outside/a.mod", s.path("project/link.mod")).expect("a link");
        symlink("../outside", s.path("project/folder")).expect("a link");
        symlink("real.mod", s.path("project/inside.mod")).expect("a link");
        symlink("/dev/zero", s.path("project/pipe.mod")).expect("a link");
        for file in ["project/b.mod", "project/c.mod", "project/e.mod"] {
            let ran = s.run(&["check", file]);
            assert!(ran.code == 1 && ran.err.contains("E0105"), "{file}: {}", ran.err);
        }
        assert_eq!(s.run(&["check", "project/d.mod"]).err, "", "a link inside is fine");
    }

    #[test]
    fn links_do_not_lead_out_of_the_output_folder() {
        let s = Sandbox::new(&[
            ("a.mod", &writing_to("away/x.json")),
            ("b.mod", &writing_to("x.json")),
            ("there/y", b""),
        ]);
        fs::create_dir(s.path("out")).expect("a folder");
        symlink("../there", s.path("out/away")).expect("a link");
        symlink("../there/x.json", s.path("out/x.json")).expect("a link to nothing");
        for file in ["a.mod", "b.mod"] {
            let ran = s.run(&["run", file]);
            assert!(ran.code == 1 && ran.err.contains("E0701"), "{file}: {}", ran.err);
        }
        assert_eq!(fs::read_dir(s.path("there")).expect("there").count(), 1);
    }

    #[test]
    fn an_interrupted_run_ends_soon_and_leaves_nothing() {
        let endless: &[u8] =
            b"fn f(n: Int) -> Int = if n < 1 { 1 } else { f(n - 1) + f(n - 1) }\nprint(f(60))\n";
        let s = Sandbox::new(&[("a.mod", endless)]);
        let mut command = s.command(&["run", "a.mod", "--max-steps", "1000000000000"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("runs");
        // It listens once it has begun; until then the signal ends it as any process.
        let status = loop {
            let sent =
                Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status();
            sent.expect("there is a kill");
            if let Some(status) = child.try_wait().expect("it can be asked") {
                break status;
            }
        };
        assert!(status.code().is_none_or(|code| code == 130), "{status}");
        assert!(!s.path("out").exists());
    }

    #[test]
    fn an_import_that_is_a_pipe_is_not_waited_for() {
        let s = Sandbox::new(&[("a.mod", b"use \"pipe.mod\".{b}\n")]);
        if !Command::new("mkfifo").arg(s.path("pipe.mod")).status().is_ok_and(|status| status.success()) {
            println!("skipped: there is no mkfifo");
            return;
        }
        let ran = s.run(&["check", "a.mod"]);
        assert!(ran.code == 1 && ran.err.contains("E0703"), "{}", ran.err);
    }

    #[test]
    fn a_project_named_by_a_link_is_where_the_file_is() {
        let s = Sandbox::new(&[("real/a.mod", FINE), ("project/b.mod", FINE)]);
        symlink(s.path("real/a.mod"), s.path("project/link.mod")).expect("a link");
        assert_eq!(s.run(&["check", "project/link.mod"]).code, 0);
        let ran = s.run(&["check", "project/link.mod", "--root", "project"]);
        assert!(ran.code == 2 && ran.err.contains("outside the project"), "{}", ran.err);
    }
}

/// A watch that says nothing for so long is broken, on any machine.
const SILENCE_MAX: std::time::Duration = std::time::Duration::from_secs(120);

#[test]
fn watch_checks_again_when_a_file_changes_that_was_read_or_missed() {
    let sandbox = Sandbox::new(&[("main.mod", b"use \"part.mod\".{a}\nlet b = a + 1mm\n")]);
    let mut command = sandbox.command(&["watch", "main.mod"]);
    let mut child = command.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().expect("the command runs");
    let stderr = child.stderr.take().expect("it is piped");
    let mut lines = BufReader::new(stderr).lines().map(|line| line.expect("diagnostics are UTF-8"));
    // Whatever the machine's load, each step waits for what it wants to see. A watch that stays silent
    // is ended.
    let (done, ended) = std::sync::mpsc::channel::<()>();
    let id = child.id().to_string();
    let limit = std::thread::spawn(move || {
        if ended.recv_timeout(SILENCE_MAX) == Err(std::sync::mpsc::RecvTimeoutError::Timeout) {
            drop(Command::new("kill").arg(id).status());
        }
    });
    let mut seen = |wanted: &str| assert!(lines.any(|line| line.contains(wanted)), "{wanted} never came");
    seen("E0103");
    fs::write(sandbox.path("part.mod"), "let a = 1s\n").expect("a file can be written");
    seen("--- changed");
    seen("E0201");
    fs::write(sandbox.path("part.mod"), "let a = 1mm\n").expect("a file can be written");
    seen("--- changed");
    seen("nothing is wrong; watching 2 files");
    fs::write(sandbox.path("main.mod"), "let b = (\n").expect("a file can be written");
    seen("E0004");
    child.kill().expect("it runs");
    drop(done);
    limit.join().expect("it only waits");
    child.wait().expect("it ended");
}
