//! Calls of the operating system that fail, one at a time, and kills at each: every file is the old one or the new one, the
//! command says so, and nothing else is left behind. `strace` lets the calls fail.
#![cfg(target_os = "linux")]

use super::{Files, PARTS, files};
use crate::desk::cli::Sandbox;
use crate::support::properties::whole;
use std::path::Path;
use std::process::{Command, Stdio};

const PROGRAM: &str = "use \"parts.mod\".{Pair}
let p = plan(Pair().turn(), world: world(ground: off, gravity: off))
print(p.duration)
emit(p, \"turn.plan.json\")
show(p, \"turn.html\")
";
const UNTIDY: &str = "let   a=1\nlet b =   2\n";
const ROBOT: &str = "<robot name=\"r\"><link name=\"a\"><visual><geometry><box size=\"1 1 1\"/></geometry></visual></link></robot>\n";

/// Calls with the errors that they may return.
const FAULTS: &[(&str, &[&str])] = &[
    ("write,pwrite64", &["ENOSPC", "EIO", "EINTR"]),
    ("openat", &["EACCES", "ENOSPC", "EMFILE", "EINTR"]),
    ("fsync", &["EIO", "ENOSPC"]),
    ("rename,renameat,renameat2", &["EACCES", "ENOSPC"]),
    ("mkdir,mkdirat", &["EACCES", "ENOSPC"]),
    ("unlink,unlinkat", &["EACCES"]),
    ("fchmod,flock", &["EPERM"]),
    ("statx,newfstatat", &["EACCES"]),
    ("read", &["EIO", "EINTR"]),
    ("getdents64", &["EIO"]),
    ("clone,clone3", &["EAGAIN"]),
];

/// Calls at which the process is killed.
const KILLS: &str =
    "write,pwrite64,openat,fsync,rename,renameat,renameat2,mkdir,mkdirat,unlink,unlinkat,fchmod,close";

/// Puts files in the place of all below a folder.
fn restore(folder: &Path, wanted: &Files) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        let removed = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
        removed.expect("it can be removed");
    }
    for (name, bytes) in wanted {
        let path = folder.join(name);
        match bytes {
            None => std::fs::create_dir_all(path).expect("a folder"),
            Some(bytes) => {
                std::fs::create_dir_all(path.parent().expect("below the folder")).expect("a folder");
                std::fs::write(path, bytes).expect("a file");
            }
        }
    }
}

/// What becomes of a command of which one call fails.
struct Traced {
    code: Option<i32>,
    /// True if the call was reached.
    injected: bool,
    said: String,
}

/// Runs a command with an injection of `strace`; `None` where `strace` is missing or may not trace.
fn traced(sandbox: &Sandbox, trace: &Path, inject: &str, arguments: &[&str]) -> Option<Traced> {
    let calls = inject.split(':').next().expect("the calls");
    let mut command = Command::new("strace");
    command.args(["-f", "-qq", "--seccomp-bpf", "-o"]).arg(trace);
    command.args(["-e", &format!("trace={calls}"), "-e", &format!("inject={inject}")]);
    command.arg(env!("CARGO_BIN_EXE_modl")).args(arguments).current_dir(sandbox.path(""));
    let output = command.stdin(Stdio::null()).output().ok()?;
    let told = std::fs::read_to_string(trace).ok()?;
    let injected = told.contains("(INJECTED)") || told.contains("killed by SIGKILL");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    Some(Traced { code: output.status.code(), injected, said })
}

/// Differences of files from both of two states, as a text.
fn strange(found: &Files, old: &Files, new: &Files) -> Vec<String> {
    let odd = |(name, bytes): &(&String, &Option<Vec<u8>>)| {
        old.get(*name) != Some(*bytes) && new.get(*name) != Some(*bytes)
    };
    let gone = |name: &&String| !found.contains_key(*name) && new.contains_key(*name);
    let odd = found.iter().filter(odd).map(|(name, _)| format!("{name} is neither old nor new"));
    odd.chain(old.keys().filter(gone).map(|name| format!("{name} is gone"))).collect()
}

/// Lets every call of a command fail, or every `stride`-th one, and then kills it there. Returns the number of faults, and
/// of kills, that were reached.
fn try_all(
    arguments: &[&str],
    start: &[(&str, &[u8])],
    stride: usize,
    report: &mut Vec<String>,
) -> (usize, usize) {
    let (mut faults, mut kills) = (0, 0);
    let sandbox = Sandbox::new(start);
    let folder = sandbox.path("");
    let place = tempfile::TempDir::new().expect("a temporary folder");
    let trace = place.path().join("trace");
    let old = files(&folder);
    let ran = sandbox.run(arguments);
    assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.err);
    let new = files(&folder);
    assert!(old != new, "{arguments:?} writes something");
    for (calls, errors) in FAULTS {
        for (first, error) in errors.iter().enumerate() {
            for when in (1 + first % stride..).step_by(stride) {
                restore(&folder, &old);
                let inject = format!("{calls}:error={error}:when={when}");
                let Some(ended) = traced(&sandbox, &trace, &inject, arguments) else {
                    return (faults, kills);
                };
                let found = files(&folder);
                let mut wrong = strange(&found, &old, &new);
                if ended.code == Some(0) && found != new {
                    wrong.push("it says that all is well".to_owned());
                }
                if ended.code == Some(101) || ended.said.contains("panicked") {
                    wrong.push("it panics".to_owned());
                }
                if !wrong.is_empty() {
                    report.push(format!("{arguments:?} {inject}: {}\n{}", wrong.join(", "), ended.said));
                }
                faults += usize::from(ended.injected);
                if !ended.injected {
                    break;
                }
            }
        }
    }
    for call in KILLS.split(',') {
        for when in (1..).step_by(stride) {
            restore(&folder, &old);
            let inject = format!("{call}:signal=SIGKILL:when={when}");
            let Some(ended) = traced(&sandbox, &trace, &inject, arguments) else { return (faults, kills) };
            let mut found = files(&folder);
            found.retain(|name, _| !name.split('/').any(|part| part.starts_with(".modl-tmp-")));
            let wrong = strange(&found, &old, &new);
            // The next run leaves nothing of the one that was killed; one that overwrites nothing may have nothing to do.
            let done = files(&folder) == new;
            let again = sandbox.run(arguments);
            if !wrong.is_empty() || (again.code != 0 && !done) || files(&folder) != new {
                report.push(format!(
                    "{arguments:?} {inject}: {}; then {}\n{}",
                    wrong.join(", "),
                    again.code,
                    again.err
                ));
            }
            kills += usize::from(ended.injected);
            if !ended.injected {
                break;
            }
        }
    }
    (faults, kills)
}

#[test]
fn calls_that_fail_and_kills_leave_the_old_file_or_the_new_one() {
    let tried = Sandbox::new(&[]);
    let place = tempfile::TempDir::new().expect("a temporary folder");
    let probe =
        traced(&tried, &place.path().join("trace"), "openat:error=EACCES:when=9999", &["explain", "E0001"]);
    if probe.is_none_or(|probe| probe.code != Some(0)) {
        println!("skipped: strace is missing, or may not trace");
        return;
    }
    let stride = if whole() { 1 } else { 32 };
    let mut report = Vec::new();
    let old: &[u8] = b"old\n";
    let (mut faults, mut kills) = (0, 0);
    let mut add = |arguments: &[&str], start: &[(&str, &[u8])]| {
        let (failed, killed) = try_all(arguments, start, stride, &mut report);
        println!("{arguments:?}: {failed} faults, {killed} kills");
        (faults, kills) = (faults + failed, kills + killed);
    };
    let program = [("main.mod", PROGRAM.as_bytes()), ("parts.mod", PARTS.as_bytes())];
    add(&["run", "main.mod"], &[program[0], program[1], ("out/turn.plan.json", old), ("out/turn.html", old)]);
    add(&["run", "main.mod"], &program);
    add(&["fmt", "main.mod"], &[("main.mod", UNTIDY.as_bytes())]);
    add(&["import", "r.urdf", "-o", "robots"], &[("r.urdf", ROBOT.as_bytes()), ("robots/r.mod", old)]);
    add(&["new", "rover"], &[("a.txt", old)]);
    println!("{faults} calls failed, {kills} kills");
    assert!(faults > 40 && kills > 15, "{faults} calls failed, {kills} kills");
    assert!(report.is_empty(), "\n{}", report.join("\n"));
}
