//! Processes that write into one folder at once, in which others were killed: nobody takes what another has begun for what was
//! left behind.
#![cfg(unix)]

use crate::desk::cli::Sandbox;
use std::fs;
use std::process::Stdio;

/// The processes at once.
const WRITERS: usize = 8;
/// The times that they start together.
const ROUNDS: usize = 24;

#[test]
fn processes_that_write_into_one_folder_at_once_leave_whole_files_and_no_others() {
    // Each writes a file that all write, a number of times, and one of its own.
    let programs: Vec<(String, String)> = (0..WRITERS)
        .map(|writer| {
            let mut text = format!("record Row {{ by: Int, line: Int }}\nlet rows = [Row(by: {writer}, line: k) for k in 0..500]\n");
            for time in 0..4 {
                text += &format!("save(rows, \"shared{time}.csv\")\n");
            }
            (format!("w{writer}.mod"), text + &format!("save(rows, \"own{writer}.csv\")\n"))
        })
        .collect();
    let files: Vec<(&str, &[u8])> =
        programs.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
    let sandbox = Sandbox::new(&files);
    let expected = |writer: usize| {
        let rows = (0..500).map(|line| format!("{writer},{line}\r\n"));
        "by,line\r\n".to_owned() + &rows.collect::<String>()
    };
    let whole: Vec<String> = (0..WRITERS).map(expected).collect();
    for round in 0..ROUNDS {
        // Files that processes left when they were killed: nobody has locked them.
        fs::create_dir_all(sandbox.path("out")).expect("a folder");
        for left in 0..20 {
            fs::write(sandbox.path(&format!("out/.modl-tmp-left{left}")), "half").expect("a file");
        }
        let start = |writer: usize| {
            let mut command = sandbox.command(&["run", &format!("w{writer}.mod")]);
            command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
            command.spawn().expect("the command runs")
        };
        let running: Vec<_> = (0..WRITERS).map(start).collect();
        for (writer, child) in running.into_iter().enumerate() {
            let ended = child.wait_with_output().expect("it ends");
            let said = String::from_utf8_lossy(&ended.stderr);
            assert!(ended.status.success(), "round {round}, writer {writer}: {said}");
        }
        let found = super::files(&sandbox.path("out"));
        for (name, bytes) in &found {
            let bytes = bytes.as_deref().expect("no folder");
            let own = name.strip_prefix("own").and_then(|rest| rest.strip_suffix(".csv"));
            let right = match own.map(|number| number.parse::<usize>().expect("a number")) {
                Some(writer) => bytes == whole[writer].as_bytes(),
                None => whole.iter().any(|whole| bytes == whole.as_bytes()),
            };
            assert!(right, "round {round}: {name} is not whole, or nobody's");
        }
        assert_eq!(found.len(), WRITERS + 4, "{:?}", found.keys());
    }
}
