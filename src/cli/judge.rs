//! `modl verify`: judges plan files again, from nothing but the files.

use super::arguments::Globals;
use super::disk::{read_at_most, read_regular};
use super::report::{self, JsonPlan, Report};
use super::terminal::{cancelled, listen_for_cancel, print};
use super::{CallError, Ending};
use super::{stubs, verdict};
use crate::plan::Plan;
use crate::source::{Diagnostic, Sources, code};
use std::io;
use std::path::{Path, PathBuf};

/// No plan file larger than this is read, bytes.
const PLAN_BYTES_MAX: usize = 1 << 30;

pub fn run(files: &[PathBuf], globals: &Globals) -> Result<Ending, CallError> {
    // All files are read first: a call that is wrong does nothing.
    let texts = files.iter().map(|file| read(file)).collect::<Result<Vec<_>, CallError>>()?;
    listen_for_cancel();
    let mut report = Report::default();
    report.plans = Some(Vec::new());
    let mut ok = true;
    for (file, bytes) in files.iter().zip(texts) {
        let name = file.to_string_lossy().into_owned();
        match stubs::read_plan(&bytes) {
            Ok(plan) => ok &= judge(&name, &plan, &mut report, globals),
            Err(fault) => {
                let diagnostic = Diagnostic::error(
                    code::BAD_PLAN_FILE,
                    format!("`{name}` is no sound plan file: {fault}"),
                )
                .hint("a plan file is written by `modl run`; what changed it since?");
                report.add(&Sources::default(), &[diagnostic], &report::style(globals, ""), globals);
                ok = false;
            }
        }
        if cancelled() {
            report.finish(false, globals);
            return Ok(Ending::Cancelled);
        }
    }
    report.finish(ok, globals);
    Ok(if ok { Ending::Fine } else { Ending::Wrong })
}

fn judge(name: &str, plan: &Plan, report: &mut Report, globals: &Globals) -> bool {
    let verdict = stubs::verify(plan);
    if !globals.json {
        print(&verdict::text(name, plan, &verdict));
    }
    let ok = verdict.ok();
    report.plans.get_or_insert_default().push(JsonPlan { file: name.to_owned(), ok, verdict });
    ok
}

fn read(file: &Path) -> Result<Vec<u8>, CallError> {
    let bytes = if file == Path::new("-") {
        read_at_most(io::stdin().lock(), PLAN_BYTES_MAX)
    } else {
        read_regular(file, PLAN_BYTES_MAX)
    };
    bytes.map_err(|fault| CallError(format!("the file `{}` {fault}", file.display())))
}
