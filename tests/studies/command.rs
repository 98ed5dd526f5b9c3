//! `modl study`: the same bytes however the rows are cut, killed and computed again.

use crate::desk::cli::{Sandbox, json};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A study whose rows are known: `area` is `scale * a * b`, but where the product is above 5 m².
const AREAS: &str = r#"record Row { area: Area, word: Text, at: Vec3<Length>, k: Int }
let scale = 2
study areas(a in [1m, 2m], b in 1m..3m) by grid(b: 5) each k in 0..2 = {
  require a * b < 5m^2, "too large, \"really\""
  Row(area: scale * a * b, word: if k == 0 { "one, two" } else { "x" }, at: [a, b, 0m], k: k)
}
"#;

/// Rows that take a while: each sums so many numbers.
const SLOW: &str = r#"record Row { sum: Number, part: Number }
study slow(n in [1, 2, 3], x in 0.0..1) by sobol(40) each seed in 0..3 = {
  require seed < 2 or n < 3, "no such case"
  Row(sum: sum([(i * n + seed) % 7 for i in 0..6000]), part: x / n)
}
study search(x in -3.0..3, y in -3.0..3, n in 0..4) by cmaes(minimise: sum, budget: 60) =
  Row(sum: sum([(i % 2) for i in 0..4000]) * 0 + (x - 1) ^ 2 + (y + 1) ^ 2 + (n - 2) ^ 2, part: x)
"#;

fn sandbox() -> Sandbox {
    Sandbox::new(&[("areas.mod", AREAS.as_bytes()), ("slow.mod", SLOW.as_bytes())])
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The table of the study `slow` with its description, as one text.
fn table(sandbox: &Sandbox, out: &str, study: &str) -> String {
    let part = |ending| read(&sandbox.path(&format!("{out}/{study}.{ending}")));
    part("csv") + &part("json")
}

/// The folder of a study's shards.
fn folder(sandbox: &Sandbox, out: &str, study: &str) -> PathBuf {
    let entries = fs::read_dir(sandbox.path(out)).expect("an output folder").flatten();
    let mut found = entries.map(|e| e.path()).filter(|path| {
        path.is_dir()
            && path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(&format!("{study}-")))
    });
    found.next().expect("a folder of the study")
}

/// The names of the shards of a folder.
fn shards(folder: &Path) -> BTreeSet<String> {
    let names = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = names.map(|e| e.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".rows")).collect()
}

fn fine(sandbox: &Sandbox, arguments: &[&str]) -> String {
    let ran = sandbox.run(arguments);
    assert_eq!(ran.code, 0, "{arguments:?}: {}{}", ran.out, ran.err);
    ran.out
}

#[test]
fn a_table_holds_every_row_in_si_units_with_its_error() {
    let s = sandbox();
    let said = fine(&s, &["study", "areas.mod", "-o", "out"]);
    assert_eq!(said, "areas: 20 of 20 rows computed; without values: 4 with E0507\n");
    let mut wanted =
        "row,a [m],b [m],k,area [m^2],word,at.x [m],at.y [m],at.z [m],code,message\r\n".to_owned();
    let mut row = 0;
    for a in [1.0, 2.0] {
        for b in [1.0, 1.5, 2.0, 2.5, 3.0] {
            for k in 0..2 {
                let word = if k == 0 { "\"one, two\"" } else { "x" };
                wanted += &if a * b < 5.0 {
                    format!("{row},{a},{b},{k},{},{word},{a},{b},0,,\r\n", 2.0 * a * b)
                } else {
                    let message = "\"too large, \"\"really\"\": `a * b < 5m^2` does not hold\"";
                    format!("{row},{a},{b},{k},,,,,,E0507,{message}\r\n")
                };
                row += 1;
            }
        }
    }
    assert_eq!(read(&s.path("out/areas.csv")), wanted);
    let about: Value = serde_json::from_str(&read(&s.path("out/areas.json"))).expect("JSON");
    assert_eq!(about["rows"], 20);
    assert_eq!(about["failed"]["E0507"], 4);
    assert_eq!(about["sampler"], "grid(b: 5)");
    assert_eq!(
        about["columns"][1],
        serde_json::json!({"name": "b", "type": "Length", "unit": "m", "axis": true})
    );
    let named = |name: &str| about["sources"][name].as_str().map(str::len);
    assert_eq!((named("areas.mod"), named("std/prelude.mod")), (Some(64), Some(64)));
}

#[test]
fn one_row_alone_is_that_of_the_table() {
    let s = sandbox();
    let ran = s.run(&["study", "areas.mod", "--row", "3", "--json"]);
    let row = json(&ran)["study"]["row"].clone();
    assert_eq!(
        (ran.code, &row["cells"]["area"], &row["cells"]["k"]),
        (0, &Value::from(3.0), &Value::from(1))
    );
    let ran = s.run(&["study", "areas.mod", "--row", "19"]);
    assert_eq!(ran.code, 1);
    assert!(ran.err.contains("E0507") && ran.err.contains("too large"), "{}", ran.err);
    let text = "use std.smores.Chain3\nrecord Row { ok: Bool }\nstudy arms(b in 10deg..20deg) by grid(b: 2) = {\n  \
                let c = Chain3()\n  Row(ok: verify(move(c.m[1].tilt, to: b)).ok)\n}\n";
    let s = Sandbox::new(&[("arms.mod", text.as_bytes())]);
    let ran = s.run(&["study", "arms.mod", "arms", "--row", "1", "--show", "-o", "out"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(read(&s.path("out/arms-1.html")).contains("<html"), "a page is drawn");
}

#[test]
fn threads_and_cuts_and_orders_give_the_same_bytes() {
    let s = sandbox();
    fine(&s, &["study", "slow.mod", "slow", "-o", "one", "--threads", "1"]);
    let wanted = table(&s, "one", "slow");
    assert_eq!(
        wanted.lines().filter(|line| line.contains("E0507")).count(),
        13 + 1,
        "13 of 40 points have n = 3"
    );
    fine(&s, &["study", "slow.mod", "slow", "-o", "two", "--threads", "2"]);
    assert_eq!(table(&s, "two", "slow"), wanted);
    for shard in [4, 1, 6, 2, 5, 3] {
        fine(&s, &["study", "slow.mod", "slow", "-o", "six", "--shard", &format!("{shard}/6")]);
        let there = s.path("six/slow.csv").exists();
        assert_eq!(there, shard == 3, "the last shard writes the table");
    }
    assert_eq!(table(&s, "six", "slow"), wanted);
    // Cuts that do not fit together: what is there is not computed again.
    fine(&s, &["study", "slow.mod", "slow", "-o", "mixed", "--shard", "2/3"]);
    fine(&s, &["study", "slow.mod", "slow", "-o", "mixed", "--shard", "4/7"]);
    let before = shards(&folder(&s, "mixed", "slow"));
    fine(&s, &["study", "slow.mod", "slow", "-o", "mixed"]);
    assert!(shards(&folder(&s, "mixed", "slow")).is_superset(&before));
    assert_eq!(table(&s, "mixed", "slow"), wanted);
    // The table alone is lost.
    fs::remove_file(s.path("mixed/slow.csv")).expect("it was written");
    fine(&s, &["study", "slow.mod", "slow", "-o", "mixed", "--merge"]);
    assert_eq!(table(&s, "mixed", "slow"), wanted);
}

fn begin(sandbox: &Sandbox, arguments: &[&str]) -> Child {
    let mut command = sandbox.command(arguments);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("the command runs")
}

/// Kills a driver once the folder has more than so many shards; true if it still ran.
fn killed_after(sandbox: &Sandbox, arguments: &[&str], out: &str, study: &str, more: usize) -> bool {
    let count = || {
        let folder = fs::read_dir(sandbox.path(out)).is_ok_and(|mut entries| entries.next().is_some());
        if folder { shards(&self::folder(sandbox, out, study)).len() } else { 0 }
    };
    let (before, begun) = (count(), Instant::now());
    let mut child = begin(sandbox, arguments);
    while count() < before + more && begun.elapsed() < Duration::from_secs(60) {
        if child.try_wait().expect("it can be asked").is_some() {
            return false;
        }
        std::thread::park_timeout(Duration::from_millis(2));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    true
}

#[test]
fn kills_cost_what_was_not_written_and_nothing_else() {
    let s = sandbox();
    fine(&s, &["study", "slow.mod", "slow", "-o", "whole"]);
    let wanted = table(&s, "whole", "slow");
    let shard = |i: u32| format!("{i}/4");
    let mut kills = 0;
    for (i, more) in [(1, 1), (2, 3)] {
        let arguments = ["study", "slow.mod", "slow", "-o", "out", "--shard", &shard(i)];
        kills += u32::from(killed_after(&s, &arguments, "out", "slow", more));
    }
    assert!(kills > 0, "no driver was killed at work");
    // What a kill between writing and renaming leaves behind: a whole shard under a temporary name, or half of one.
    let folder = folder(&s, "out", "slow");
    let kept = shards(&folder);
    let one = read(&folder.join(kept.first().expect("a shard was written")));
    fs::write(folder.join(".modl-tmp-abcdef"), &one).expect("a file can be written");
    fs::write(folder.join(".modl-tmp-ghijkl"), &one[..one.len() / 2]).expect("a file can be written");
    for i in [4, 3, 2, 1] {
        fine(&s, &["study", "slow.mod", "slow", "-o", "out", "--shard", &shard(i)]);
    }
    assert!(shards(&folder).is_superset(&kept), "what was written stays");
    assert!(!folder.join(".modl-tmp-abcdef").exists() && !folder.join(".modl-tmp-ghijkl").exists());
    assert_eq!(table(&s, "out", "slow"), wanted);
}

#[test]
fn two_drivers_share_a_folder() {
    let s = sandbox();
    fine(&s, &["study", "slow.mod", "slow", "-o", "whole"]);
    let arguments = ["study", "slow.mod", "slow", "-o", "out", "--threads", "1"];
    let drivers = [begin(&s, &arguments), begin(&s, &arguments)];
    for mut driver in drivers {
        assert!(driver.wait().expect("it ends").success());
    }
    assert_eq!(table(&s, "out", "slow"), table(&s, "whole", "slow"));
    // They divided the rows between them, but for the few that one began while the other wrote them.
    let rows: u64 = shards(&folder(&s, "out", "slow"))
        .iter()
        .map(|name| {
            let (start, end) = name.trim_end_matches(".rows").split_once('-').expect("two numbers");
            end.parse::<u64>().expect("a number") - start.parse::<u64>().expect("a number")
        })
        .sum();
    assert!(rows <= 120 + 8, "{rows} rows were written");
}

#[test]
fn what_is_no_shard_of_the_study_is_left_out_and_told() {
    let s = sandbox();
    fine(&s, &["study", "slow.mod", "slow", "-o", "out"]);
    let wanted = table(&s, "out", "slow");
    let own = folder(&s, "out", "slow");
    let names: Vec<String> = shards(&own).into_iter().collect();
    let [first, second, third, ..] = names.as_slice() else { panic!("there are many shards") };
    let text = read(&own.join(first));
    fs::write(own.join(first), &text[..text.len() - 30]).expect("a file can be written");
    let changed = read(&own.join(second)).replace("\"csv\":\"", "\"csv\":\"9");
    fs::write(own.join(second), changed).expect("a file can be written");
    // A shard of the same study with another seed.
    fine(&s, &["study", "slow.mod", "slow", "-o", "other", "--seed", "1"]);
    let other = folder(&s, "other", "slow");
    assert_ne!(other.file_name(), own.file_name(), "the seed is a part of the identity");
    let foreign = shards(&other).into_iter().next().expect("a shard");
    fs::copy(other.join(foreign), own.join(third)).expect("a file can be copied");
    let status = json(&s.run(&["study", "slow.mod", "slow", "-o", "out", "--status", "--json"]));
    let strangers = status["study"]["strangers"].as_array().expect("a list");
    let why: Vec<&str> = strangers.iter().map(|stranger| stranger[1].as_str().expect("a reason")).collect();
    assert_eq!(
        why,
        [
            "it is cut off, or was changed",
            "it is cut off, or was changed",
            "it belongs to another study, or to other sources or settings"
        ]
    );
    let ran = s.run(&["study", "slow.mod", "slow", "-o", "out", "--merge"]);
    assert_eq!(ran.code, 1);
    assert!(ran.err.contains("E0510") && ran.err.contains("the first is row 0"), "{}", ran.err);
    fine(&s, &["study", "slow.mod", "slow", "-o", "out"]);
    assert_eq!(table(&s, "out", "slow"), wanted);
}

#[test]
fn a_search_goes_on_where_it_was_and_gives_the_best_of_the_program() {
    let s = sandbox();
    fine(&s, &["study", "slow.mod", "search", "-o", "whole", "--threads", "1"]);
    let wanted = table(&s, "whole", "search");
    killed_after(&s, &["study", "slow.mod", "search", "-o", "out"], "out", "search", 2);
    fine(&s, &["study", "slow.mod", "search", "-o", "out", "--threads", "2"]);
    assert_eq!(table(&s, "out", "search"), wanted);
    let about = json(&s.run(&["study", "slow.mod", "search", "-o", "out", "--json"]));
    let best = about["study"]["best"].as_u64().expect("a search has a best row");
    // The best by the table itself.
    let csv = read(&s.path("out/search.csv"));
    let sums: Vec<f64> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(4).expect("a column").parse().expect("a sum"))
        .collect();
    let least = sums.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!((sums.len(), sums[best as usize]), (60, least));
    let program = format!("{SLOW}print(best(search).sum)\n");
    fs::write(s.path("best.mod"), program).expect("a file can be written");
    let said = json(&s.run(&["run", "best.mod", "--json"]));
    assert_eq!(said["values"][0]["value"]["number"].as_f64(), Some(least));
    let row = json(&s.run(&["study", "slow.mod", "search", "--row", "40", "--json", "-o", "elsewhere"]));
    assert_eq!(row["study"]["row"]["cells"]["sum"].as_f64(), Some(sums[40]));
    let ran = s.run(&["study", "slow.mod", "search", "--shard", "1/2"]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("is a search"), "{}", ran.err);
}

#[test]
fn files_that_rows_read_belong_to_them() {
    let text = "use std.mori.Mori\nrecord Row { n: Int }\nstudy faces(k in 0..2) by grid() = Row(n: fold(load_mesh(\"a.off\", scale: 80mm), module: Mori).layouts + k)\n";
    let h = 0.125f64.sqrt();
    let tetra = format!(
        "OFF\n4 4 6\n{h} {h} {h}\n{h} -{h} -{h}\n-{h} {h} -{h}\n-{h} -{h} {h}\n3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n"
    );
    let s = Sandbox::new(&[("a.mod", text.as_bytes()), ("a.off", tetra.as_bytes())]);
    let ran = s.run(&["study", "a.mod", "-o", "out"]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    let first = read(&s.path("out/faces.json"));
    assert!(first.contains("\"a.off\""), "{first}");
    fs::write(s.path("a.off"), tetra.replacen("0.3", "0.4", 1)).expect("a file can be written");
    let status = json(&s.run(&["study", "a.mod", "-o", "out", "--status", "--json"]));
    assert_eq!(status["study"]["computed"], 0, "its rows are not those of the new file");
    fine(&s, &["study", "a.mod", "-o", "out"]);
    assert_ne!(read(&s.path("out/faces.json")), first);
}

#[test]
fn wrong_calls_are_told() {
    let s = Sandbox::new(&[
        ("slow.mod", SLOW.as_bytes()),
        ("none.mod", b"let a = 1\n"),
        ("bad.mod", b"record R { x: Int }\nstudy s(i in 3..3) by grid() = R(x: i)\n"),
    ]);
    for (arguments, code, words) in [
        (&["study", "none.mod"][..], 2, "declares no study"),
        (&["study", "slow.mod"], 2, "several studies; name one: `slow`, `search`"),
        (&["study", "slow.mod", "slwo"], 2, "has no study `slwo`; there is `slow`, `search`"),
        (&["study", "slow.mod", "slow", "--shard", "0/4"], 2, "a part is written 17/64"),
        (&["study", "slow.mod", "slow", "--shard", "5/4"], 2, "a part is written 17/64"),
        (&["study", "slow.mod", "slow", "--row", "120"], 2, "the rows 0 to 119"),
        (&["study", "slow.mod", "slow", "--show"], 2, "--row"),
        (&["study", "bad.mod"], 1, "E0506"),
    ] {
        let ran = s.run(arguments);
        assert_eq!(ran.code, code, "{arguments:?}: {}", ran.err);
        assert!(ran.err.contains(words), "{arguments:?}: {}", ran.err);
    }
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::process::Command;

    fn shell(sandbox: &Sandbox, script: &str) -> std::process::Output {
        let mut command = Command::new("bash");
        command.args(["-c", script]).current_dir(sandbox.path("")).stdin(Stdio::null());
        command.env("MODL", env!("CARGO_BIN_EXE_modl")).output().expect("bash runs")
    }

    /// A kill at the very call that would give a shard its name, by strace.
    #[test]
    fn a_kill_between_writing_and_renaming_costs_that_shard() {
        let s = sandbox();
        if !shell(&s, "strace -V").status.success() {
            println!("skipped: no strace");
            return;
        }
        fine(&s, &["study", "slow.mod", "slow", "-o", "whole"]);
        // The driver that begins again may first note, under a name of its own, at which row the killed one was.
        for (when, kept) in [(2, [1, 1]), (4, [3, 4])] {
            let traced = "strace -f -qq -o trace -e trace=rename,renameat,renameat2 -e \
                          inject=rename,renameat,renameat2:signal=KILL";
            let ran =
                shell(&s, &format!("{traced}:when={when} \"$MODL\" study slow.mod slow -o out --threads 1"));
            if when == 2 && !read(&s.path("trace")).contains("killed by SIGKILL") {
                println!("skipped: strace may not trace here");
                return;
            }
            assert!(!ran.status.success());
            let folder = folder(&s, "out", "slow");
            let names = fs::read_dir(&folder).expect("a folder").flatten().map(|e| e.file_name());
            assert!(
                names.into_iter().any(|name| name.to_string_lossy().starts_with(".modl-tmp-")),
                "it was written"
            );
            assert!(kept.contains(&shards(&folder).len()), "{} of {kept:?}", shards(&folder).len());
        }
        for i in [3, 1, 2] {
            fine(&s, &["study", "slow.mod", "slow", "-o", "out", "--shard", &format!("{i}/3")]);
        }
        assert_eq!(table(&s, "out", "slow"), table(&s, "whole", "slow"));
    }

    /// A disk that takes no more: files beyond a size can't be written.
    #[test]
    fn a_full_disk_is_told_and_what_was_written_stays() {
        let s = Sandbox::new(&[(
            "big.mod",
            b"record Row { text: Text }\nstudy big(i in 0..200) by grid() = Row(text: join([\"abcdefgh\" for k in 0..i * 2], with: \"\"))\n",
        )]);
        let full = shell(&s, "trap '' XFSZ; ulimit -f 4; exec \"$MODL\" study big.mod -o out");
        let told = String::from_utf8_lossy(&full.stderr).into_owned();
        assert_eq!(full.status.code(), Some(1), "{told}");
        assert!(told.contains("E0702") && told.contains("the same command goes on"), "{told}");
        let kept = shards(&folder(&s, "out", "big"));
        assert!(!kept.is_empty(), "small shards were written");
        fine(&s, &["study", "big.mod", "-o", "out"]);
        assert!(shards(&folder(&s, "out", "big")).is_superset(&kept));
        fine(&s, &["study", "big.mod", "-o", "whole"]);
        assert_eq!(table(&s, "out", "big"), table(&s, "whole", "big"));
    }

    /// A row that takes more memory than there is ends its driver, three times; then the others have their rows.
    #[test]
    fn a_row_that_ends_its_driver_is_set_aside() {
        let text = "record Row { n: Int }\nstudy eats(i in 0..6) by grid() = {\n  let long = if i == 3 { join([\"abcdefghij\" for k \
                    in 0..1000000], with: \"\") } else { \"\" }\n  let many = [\"{long}{j}\" for j in 0..300]\n  Row(n: i * \
                    len(many))\n}\n";
        let s = Sandbox::new(&[("eats.mod", text.as_bytes())]);
        let call = "ulimit -v 2000000; ulimit -c 0; exec \"$MODL\" study eats.mod -o out --threads 1";
        let mut ended = Vec::new();
        for _ in 0..6 {
            let ran = shell(&s, call);
            ended.push(ran.status.success());
            if ran.status.success() {
                let told = String::from_utf8_lossy(&ran.stderr).into_owned();
                assert!(
                    told.contains("set aside") && told.contains("modl study eats.mod eats --row N"),
                    "{told}"
                );
                break;
            }
        }
        assert_eq!(ended, [false, false, false, true]);
        let csv = read(&s.path("out/eats.csv"));
        let rows: Vec<&str> = csv.lines().skip(1).collect();
        assert!(rows[3].starts_with("3,3,,E0510,"), "{}", rows[3]);
        assert_eq!([rows[0], rows[5]], ["0,0,0,,", "5,5,1500,,"]);
    }

    /// A stand-in for Slurm: indices in another order, a fifth of them killed and queued again.
    #[test]
    fn the_script_for_slurm_bears_kills_and_requeues() {
        let s = sandbox();
        fine(&s, &["study", "slow.mod", "slow", "-o", "whole"]);
        let script =
            fine(&s, &["study", "slow.mod", "slow", "-o", "out", "--emit", "slurm", "--shards", "10"]);
        assert!(script.starts_with("#!/bin/bash\n#SBATCH") && script.contains("--array=1-10"), "{script}");
        fs::write(s.path("job.sh"), script).expect("a file can be written");
        let program = Path::new(env!("CARGO_BIN_EXE_modl")).parent().expect("a folder").display().to_string();
        let queue = "export PATH=\"$BIN:$PATH\"; for i in 7 2 9 4 10 1 8 3 6 5; do export SLURM_ARRAY_TASK_ID=$i \
                     SLURM_CPUS_PER_TASK=1; if [ $((i % 5)) = 2 ]; then timeout -s KILL 0.06 bash job.sh; fi; bash job.sh || exit 1; done";
        let ran = shell(&s, &format!("BIN='{program}'; {queue}"));
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
        assert_eq!(table(&s, "out", "slow"), table(&s, "whole", "slow"));
    }
}

/// The front of a cloud that is known: of the points (x, 1 - x) all, of (x, x) the corner.
#[test]
fn tables_are_drawn() {
    let text = "record Row { up: Number, down: Number, angle: Angle, word: Text }\nstudy cloud(x in 0.0..1) by grid(x: 5) = Row(up: x, \
                down: 1 - x, angle: x * 1rad, word: \"w\")\n";
    let s = Sandbox::new(&[("cloud.mod", text.as_bytes())]);
    let plots = [
        "--plot",
        "front:up,down",
        "--plot",
        "front:up,x",
        "--plot",
        "parallel",
        "--plot",
        "histogram:angle",
    ];
    fine(&s, &[&["study", "cloud.mod", "-o", "out"][..], &plots].concat());
    let svg = |name: &str| read(&s.path(&format!("out/cloud-{name}.svg")));
    // Squares are the marks of the front, circles those of the rows; one of each is in the legend.
    let count = |text: &str, mark: &str| text.matches(mark).count();
    assert_eq!(count(&svg("up-down"), "<circle"), 5 + 1);
    assert_eq!(count(&svg("up-down"), "<polygon"), 5 + 1);
    assert_eq!(count(&svg("up-x"), "<polygon"), 1 + 1);
    assert!(svg("angle").contains("angle") && count(&svg("angle"), "<polygon") >= 2);
    // x, up, down and angle are numbers, `word` is not; each of the five rows is a line across the four axes.
    let parallel = svg("parallel");
    let lines: Vec<&str> = parallel.lines().filter(|line| line.contains("stroke-width=\"1.2\"")).collect();
    assert_eq!(lines.len(), 5, "{parallel}");
    assert!(lines.iter().all(|line| count(line, ",") == 4), "{lines:?}");
    assert_eq!(count(&parallel, "stroke-width=\"1.25\""), 4, "{parallel}");
    for (plot, code, words) in [
        ("histogram:word", 1, "no column of numbers `word`; there is x, up, down, angle"),
        ("pie:up", 2, "a plot is written"),
        ("front:up", 2, "a front is of two columns"),
    ] {
        let ran = s.run(&["study", "cloud.mod", "-o", "out", "--plot", plot]);
        assert_eq!(ran.code, code, "{plot}: {}", ran.err);
        assert!(ran.err.contains(words), "{plot}: {}", ran.err);
    }
}
