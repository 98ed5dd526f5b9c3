//! The report of a command, as text or as one JSON object (`docs/json.md`).

use super::arguments::{Color, Globals};
use super::study::answer::JsonStudy;
use super::terminal::{JsonValue, print_error, print_json, print_styled};
use super::what::JsonRobot;
use crate::plan::facts::Facts;
use crate::plan::{DynamicsModel, Verdict};
use crate::source::json::{JsonDiagnostic, to_json};
use crate::source::render::{Style, render_one, sorted};
use crate::source::{Diagnostic, Severity, Sources};
use crate::units::counted;
use serde::Serialize;
use std::collections::HashSet;
use std::io::{IsTerminal, stderr};

/// The width in columns if the terminal does not report one.
const WIDTH_DEFAULT: usize = 100;

/// The most diagnostics in one JSON object; the rest are counted.
const JSON_DIAGNOSTICS_MAX: usize = 10_000;

/// The report of a command. Its fields are those of the JSON object that `--json` prints.
#[derive(Debug, Default, Serialize)]
pub(super) struct Report {
    /// True if the exit code is 0.
    pub ok: bool,
    /// The diagnostics, at most 10,000; empty if they are printed as text.
    pub diagnostics: Vec<JsonDiagnostic>,
    /// The number of diagnostics that are left out because there were too many.
    pub omitted: usize,
    /// The number of errors, those left out included.
    pub errors: usize,
    /// The number of warnings, those left out included.
    pub warnings: usize,
    /// The lines that the program printed; `None` for commands that print none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub printed: Option<Vec<String>>,
    /// The values that were printed; `None` for commands that run no program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub values: Option<Vec<JsonValue>>,
    /// The paths of the files written; `None` for commands that write none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub written: Option<Vec<String>>,
    /// The results of tests; `None` for commands that run none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tests: Option<Vec<JsonTest>>,
    /// The verdicts on plan files; `None` for commands that judge none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plans: Option<Vec<JsonPlan>>,
    /// The simulations of plan files; `None` for commands that play none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulations: Option<Vec<JsonSimulation>>,
    /// The study that was worked on; `None` for other commands, and where it is wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub study: Option<JsonStudy>,
    /// The robot that was asked about, with what embeds in it; `None` for other commands, and where it is wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<JsonRobot>,
    /// The links of documentation that lead nowhere; `None` for commands that write none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub broken_links: Option<Vec<JsonLink>>,
    /// The number of programs of folders that were checked; `None` if no folder was named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub programs: Option<usize>,
    #[serde(skip)]
    seen: HashSet<String>,
}

/// The result of a test, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct JsonTest {
    /// The file that contains the test.
    pub file: String,
    /// The name of the test.
    pub name: String,
    /// True if the test passed.
    pub passed: bool,
}

/// A broken link in documentation, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct JsonLink {
    /// The title of the page that contains the link: `std.smores`, or the path of a program.
    pub page: String,
    /// The declaration whose documentation contains the link; empty for the file itself.
    pub entry: String,
    /// The target of the link as it is written.
    pub link: String,
}

/// The verdict on a plan file, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct JsonPlan {
    /// The plan file, as it was named on the command line.
    pub file: String,
    /// True if nothing failed in the verdict.
    pub ok: bool,
    /// The dynamics that the plan is judged under.
    pub dynamics: DynamicsModel,
    /// The verdict of the judge on the plan.
    pub verdict: Verdict,
    /// The declarations of the file that the verdict rests on, in the order of the file's library.
    pub rests_on: Vec<Declaration>,
}

/// The simulation of a plan file, as JSON, in SI units and radians.
#[derive(Debug, Serialize)]
pub(super) struct JsonSimulation {
    /// The plan file, as it was named on the command line.
    pub file: String,
    /// True if it does not fall, no bond breaks, all ports dock, and no program is aborted, in none of the runs either.
    pub ok: bool,
    /// The time step, s.
    pub step: f64,
    /// The duration of the plan, s.
    pub duration: f64,
    /// The displacement of the base, m.
    pub travel: [f64; 3],
    /// The turn of the base about the vertical, rad; whole turns count.
    pub heading: f64,
    /// The angle by which the base leans at the end, rad.
    pub lean: f64,
    /// The greatest such angle, rad.
    pub lean_max: f64,
    /// The time at which a robot falls, s; `None`: none does.
    pub fall: Option<f64>,
    /// The farthest that a joint that turns is behind the plan, rad.
    pub lag: Option<JsonExtreme>,
    /// The farthest that a joint that slides is behind the plan, m.
    pub slide_lag: Option<JsonExtreme>,
    /// The greatest effort of a motor as a mean over 50 ms, in parts of its limit.
    pub torque: Option<JsonExtreme>,
    /// The longest time that a motor is at its limit, s.
    pub saturated: Option<JsonExtreme>,
    /// The greatest load of a bond, in parts of what it holds.
    pub bond_load: Option<JsonExtreme>,
    /// The greatest distance of two ports that dock, or miss each other, m; `None`: none are to dock.
    pub dock_error: Option<JsonExtreme>,
    /// The greatest angle of two such ports from a perfect mate, rad.
    pub dock_angle: Option<JsonExtreme>,
    /// The farthest that a link slides over the ground in all while it presses on it, m.
    pub slip: f64,
    /// The greatest speed at which a link comes down on the ground, m/s.
    pub impact: f64,
    /// The mechanical work of the motors, J.
    pub energy: f64,
    /// The fall, bonds that broke and ports that did not dock, in words.
    pub failures: Vec<String>,
    /// The change that half the time step makes, and where the verdict says otherwise, in words.
    pub notes: Vec<String>,
    /// The further runs; `None` where there are none.
    pub runs: Option<JsonRuns>,
}

/// Further runs of a plan, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct JsonRuns {
    /// The number of runs.
    pub count: usize,
    /// The number of those in which anything fails.
    pub fails: usize,
    /// The number of those in which a robot falls.
    pub falls: usize,
    /// The number of those in which a bond breaks.
    pub breaks: usize,
    /// The number of those in which ports that are to dock miss each other.
    pub misses: usize,
    /// The number of those in which the program is stopped before its end.
    pub stops: usize,
    /// The displacement of the base in each, m.
    pub travels: Vec<[f64; 3]>,
}

/// The greatest value of a quantity, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct JsonExtreme {
    /// The value.
    pub value: f64,
    /// The path name of the joint, or the bond's name.
    pub at: String,
    /// The time from the start of the plan, s.
    pub time: f64,
}

/// A declaration of a plan file's library, which a verdict rests on.
#[derive(Debug, Serialize)]
pub(super) struct Declaration {
    /// The facts of the declaration: kind, name, limits, digest.
    #[serde(flatten)]
    pub facts: Facts,
    /// The path of the declaration of the same name in the standard library, `std.smores.Smores`; `None` if there is
    /// none.
    pub standard: Option<String>,
    /// The differences from the declaration of the standard library, in words; empty if there are none.
    pub differences: Vec<String>,
}

impl Report {
    /// Adds diagnostics, whose spans are in `sources`: keeps them for the JSON object, or prints them at once. A
    /// diagnostic already reported for another file of the same call, such as a shared import, is not repeated.
    pub(super) fn add(
        &mut self,
        sources: &Sources,
        diagnostics: &[Diagnostic],
        style: &Style,
        globals: &Globals,
    ) {
        let mut hidden = 0;
        for diagnostic in sorted(diagnostics) {
            let json = to_json(sources, std::slice::from_ref(diagnostic), style).remove(0);
            if !self.seen.insert(format!("{json:?}")) {
                continue;
            }
            match diagnostic.severity {
                Severity::Error => self.errors += 1,
                Severity::Warning => self.warnings += 1,
                Severity::Note => {}
            }
            if globals.json {
                if self.diagnostics.len() < JSON_DIAGNOSTICS_MAX {
                    self.diagnostics.push(json);
                } else {
                    self.omitted += 1;
                }
            } else if self.seen.len() <= style.shown_max {
                print_styled(&format!("{}\n", render_one(sources, diagnostic, style)));
            } else {
                hidden += 1;
            }
        }
        if hidden > 0 {
            print_error(&format!("... and {hidden} more; `--json` lists them all\n\n"));
        }
    }

    /// Ends the report: prints the JSON object, or the numbers of errors and warnings. `ok` is true if the exit code
    /// is 0.
    pub(super) fn finish(&mut self, ok: bool, globals: &Globals) {
        self.ok = ok;
        if globals.json {
            let text = serde_json::to_string_pretty(self).expect("a report is plain data");
            print_json(&text);
            return;
        }
        let parts = [(self.errors, "error"), (self.warnings, "warning")].map(|(n, word)| some(n, word));
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        let found = if parts.is_empty() { "nothing is wrong".to_owned() } else { parts.join(", ") };
        match self.programs.and_then(|n| some(n, "program")) {
            Some(programs) => print_error(&format!("{programs}: {found}\n")),
            None if parts.is_empty() => {}
            None => print_error(&format!("{found}\n")),
        }
    }
}

/// Returns "2 errors"; `None` for none.
fn some(n: usize, word: &str) -> Option<String> {
    (n > 0).then(|| counted(n, word))
}

/// Reports a wrong call of a command, as text or, if `globals` say so, as a JSON object.
pub(super) fn call_error(globals: &Globals, message: &str) {
    if globals.json {
        json_call_error(message);
    } else {
        print_error(&format!("modl: {message}\n"));
    }
}

/// Reports a wrong call of a command as a JSON object on standard output.
pub(super) fn json_call_error(message: &str) {
    let object = serde_json::json!({ "ok": false, "call_error": message });
    print_json(&format!("{object:#}"));
}

/// Returns the style of diagnostics on this terminal; `folder` is put before the names of the project's files.
pub(super) fn style(globals: &Globals, folder: &str) -> Style {
    Style { width: width(), color: color(globals.color), folder: folder.to_owned(), ..Style::default() }
}

/// Returns the width of the terminal in columns: that of standard error, else `COLUMNS`, else 100.
pub(super) fn width() -> usize {
    let columns = || std::env::var("COLUMNS").ok()?.parse().ok();
    match terminal_size::terminal_size_of(stderr()) {
        Some((terminal_size::Width(columns), _)) => columns.into(),
        None => columns().unwrap_or(WIDTH_DEFAULT),
    }
}

/// Returns true if text on standard error is coloured: by default on a terminal that is not `dumb`, unless
/// `NO_COLOR` is set.
pub(super) fn color(choice: Color) -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    match choice {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => {
            let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
            stderr().is_terminal() && !set("NO_COLOR") && !dumb
        }
    }
}
