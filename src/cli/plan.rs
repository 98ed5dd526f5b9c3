//! `modl plan`: what a plan file holds, its series over time, and whether the map of a robot fits it.

use super::arguments::Globals;
use super::disk;
use super::judge::{self, PlanFileFault};
use super::report::Report;
use super::terminal::{print, print_bytes, print_exact};
use super::{CallError, Ending};
use crate::exchange::mapping::{self, Driven, RobotMap};
use crate::exchange::series::{self, SAMPLES_MAX, Series};
use crate::formats::{RecordTable, npy};
use crate::plan::{Body, Plan};
use crate::source::{Diagnostic, Sources, Span, code};
use crate::units::counted;
use std::path::Path;

/// The greatest size of a map file, in bytes.
const MAP_BYTES_MAX: usize = 16 << 20;

/// A series of a plan that is asked for.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'w> {
    /// The name of the series.
    pub series: &'w str,
    /// The samples a second, Hz.
    pub rate: f64,
    /// True if it is to be a file of NumPy instead of CSV.
    pub npy: bool,
}

/// Runs the command `modl plan`. `wanted`: a series; `map`: a map file. Without both it says what the plan holds.
///
/// # Errors
/// A message if a file can't be read or is too large.
pub(super) fn run(
    file: &Path,
    wanted: Option<Wanted>,
    map: Option<&Path>,
    globals: &Globals,
) -> Result<Ending, CallError> {
    let map = match map {
        Some(path) => Some((path.to_string_lossy().into_owned(), disk::read(path, MAP_BYTES_MAX)?)),
        None => None,
    };
    let mut report = Report::default();
    report.printed = globals.json.then(Vec::new);
    judge::each_plan(&[file.to_owned()], report, globals, |name, plan, report| {
        let driven = map.as_ref().map(|(path, bytes)| fitted(path, bytes, plan)).transpose()?;
        let text = match wanted {
            Some(wanted) => {
                let table = sampled(name, plan, wanted, driven.as_deref())?;
                if wanted.npy {
                    print_bytes(&npy(&table));
                    return Ok(true);
                }
                series::csv(&table)
            }
            None => match &driven {
                Some(driven) => fits(plan, driven),
                None => format!("{name}: {}\n", holds(plan)),
            },
        };
        match &mut report.printed {
            Some(printed) => printed.extend(text.lines().map(str::to_owned)),
            None if wanted.is_some() => print_exact(&text),
            None => print(&text),
        }
        Ok(true)
    })
}

/// Returns what a plan holds, in words.
fn holds(plan: &Plan) -> String {
    let (units, unit) = plan.body.units();
    let mut parts = vec![counted(units, unit)];
    if let Body::Tracks(tracks) = &plan.body {
        parts.insert(0, tracks.robot.name.clone());
        parts.push(format!("{} that move", counted(tracks.tracks.len(), "joint")));
        parts.push(counted(tracks.events.len(), "docking event"));
    }
    parts.push(format!("{} s", plan.body.duration()));
    parts.join(", ")
}

/// Returns the words for a map that fits.
fn fits(plan: &Plan, driven: &[Driven]) -> String {
    let mut text = format!("the map fits: {}\n", counted(driven.len(), "motor"));
    let without = mapping::without_motor(plan, driven);
    if let Some(first) = without.first() {
        let all = counted(without.len(), "joint");
        text.push_str(&format!("note: {all} that the plan does not move, `{first}` first, not in the map\n"));
    }
    text
}

/// Returns a series of a plan; with motors the targets of these.
///
/// # Errors
/// The fault of a plan without joints, or one that is too long for the rate.
fn sampled(
    name: &str,
    plan: &Plan,
    Wanted { series, rate, .. }: Wanted,
    driven: Option<&[Driven]>,
) -> Result<RecordTable, PlanFileFault> {
    let fault =
        |message: String| Box::new((Sources::default(), Diagnostic::error(code::NOT_EXPORTED, message)));
    let times = series::times(plan.body.duration(), rate)
        .ok_or_else(|| fault(format!("`{name}` would have more than {SAMPLES_MAX} samples at {rate} Hz")))?;
    let kind =
        Series::WORDS.iter().find(|(word, _)| *word == series).map_or(Series::Joints, |(_, kind)| *kind);
    if let (Some(driven), Some(tracks), Series::Joints) = (driven, plan.body.tracks(), kind) {
        return Ok(mapping::targets(tracks, driven, &times));
    }
    series::table(plan, kind, &times).map_err(|refusal| fault(format!("`{name}`: {refusal}")))
}

/// Returns the motors of a plan's joints by a map file.
///
/// # Errors
/// The fault of a file that is no map, or of a map that does not fit the plan.
fn fitted(path: &str, bytes: &[u8], plan: &Plan) -> Result<Vec<Driven>, PlanFileFault> {
    let mut sources = Sources::default();
    let Ok(text) = std::str::from_utf8(bytes) else {
        let message = format!("`{path}` is not UTF-8 text");
        return Err(Box::new((sources, Diagnostic::error(code::BAD_ROBOT_MAP, message))));
    };
    let map = RobotMap::read(text).map_err(|(why, line, column)| {
        let message = format!("`{path}` is no robot map: {why}");
        let mut diagnostic = Diagnostic::error(code::BAD_ROBOT_MAP, message)
            .hint("docs/robot-map.schema.json describes map files");
        let mut sources = Sources::default();
        if line > 0 {
            let id = sources.add(path, text, false);
            let file = sources.file(id);
            let at = file.line_start(line) + column.saturating_sub(1).min(file.line(line).len());
            diagnostic = diagnostic.label(Span::new(id, at, at), "");
        }
        Box::new((sources, diagnostic))
    })?;
    map.checked(plan).map_err(|faults| {
        let id = sources.add(path, text, false);
        let count = faults.len();
        let message = format!("`{path}` does not fit the plan: {}", faults[0]);
        let mut diagnostic = Diagnostic::error(code::BAD_ROBOT_MAP, message);
        // The place at which the map names what is wrong.
        let named = faults[0].name().and_then(|name| text.find(&format!("\"{name}\"")).map(|at| (at, name)));
        if let Some((at, name)) = named {
            diagnostic = diagnostic.label(Span::new(id, at, at + name.len() + 2), "");
        }
        for fault in faults.iter().skip(1).take(FAULTS_SHOWN - 1) {
            diagnostic = diagnostic.hint(fault.to_string());
        }
        if count > FAULTS_SHOWN {
            diagnostic = diagnostic.hint(format!("and {} more", count - FAULTS_SHOWN));
        }
        Box::new((std::mem::take(&mut sources), diagnostic))
    })
}

/// The number of faults of a map that are told at once.
const FAULTS_SHOWN: usize = 8;
