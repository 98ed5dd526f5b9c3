//! Models of MuJoCo with what drives them along a plan: the commands of the actuators, and the constraints that docking
//! switches.

use super::export::{Export, ExportFile};
use super::refusal::Refusal;
use super::series::{csv, quantity, sampled};
use crate::formats::mjcf::{self, Drives};
use crate::formats::{RecordCell, RecordColumn, RecordTable};
use crate::plan::{DockingKind, Tracks};

/// Returns the model of a plan's robot; of a plan that moves also `STEM.controls.csv`, the command of each actuator over
/// time, and `STEM.docking.csv`, when each constraint is switched.
///
/// # Errors
/// [`Refusal::Mjcf`] where there is no model, [`Refusal::TooMany`] for a plan that is too long.
pub(super) fn write(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let model = mjcf::write(export.plan).map_err(Refusal::Mjcf)?;
    let mut files = vec![ExportFile::text(format!("{}.{}", export.stem, mjcf::ENDING), model)];
    let Some(tracks) = export.plan.body.tracks() else { return Ok(files) };
    if tracks.duration == 0.0 {
        return Ok(files);
    }
    let drives = mjcf::drives(export.plan).map_err(Refusal::Mjcf)?;
    let times = sampled(export.plan)?;
    let named = |end: &str| format!("{}.{end}.csv", export.stem);
    files.push(ExportFile::text(named("controls"), csv(&controls(tracks, &drives, &times))));
    if !tracks.events.is_empty() {
        files.push(ExportFile::text(named("docking"), csv(&docking(tracks, &drives))));
    }
    Ok(files)
}

/// Returns the command of each actuator at some times (s), a column each.
fn controls(tracks: &Tracks, drives: &Drives, times: &[f64]) -> RecordTable {
    let states: Vec<Vec<f64>> = times.iter().map(|t| tracks.state(*t).joints).collect();
    let mut columns = vec![quantity("time", "s", times.to_vec())];
    for (name, terms) in &drives.actuators {
        let command = |joints: &Vec<f64>| terms.iter().map(|(joint, factor)| factor * joints[*joint]).sum();
        columns.push(quantity(name, "1", states.iter().map(command).collect()));
    }
    RecordTable { columns, rows: times.len() }
}

/// Returns the changes of the model's constraints in order of time: time, name, and 1 from when on it is active, 0 from
/// when on it is not.
fn docking(tracks: &Tracks, drives: &Drives) -> RecordTable {
    let (mut times, mut names, mut active) = (Vec::new(), Vec::new(), Vec::new());
    for event in &tracks.events {
        for (_, name) in drives.constraints.iter().filter(|(bond, _)| *bond == event.bond) {
            times.push(event.time);
            names.push(RecordCell::Text(name.clone()));
            active.push(RecordCell::Whole(i64::from(event.kind == DockingKind::Dock)));
        }
    }
    let rows = times.len();
    let plain = |name: &str, cells| RecordColumn { name: name.to_owned(), unit: None, quantity: None, cells };
    let columns = vec![quantity("time", "s", times), plain("constraint", names), plain("active", active)];
    RecordTable { columns, rows }
}
