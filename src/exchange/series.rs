//! Quantities of a plan over time, as tables.

use super::export::{Export, ExportFile};
use super::names::Names;
use super::refusal::Refusal;
use crate::formats::{ExportFormat, RecordCell, RecordColumn, RecordTable, TABLE_FORMATS};
use crate::plan::Plan;
use crate::plan::verify::articulated::LinkPaths;
use crate::robot::JointOwner;

/// The rate at which files are sampled, Hz.
pub const RATE_DEFAULT: f64 = 100.0;

/// The greatest number of times of a table.
pub const SAMPLES_MAX: usize = 10_000_000;

/// A quantity of a plan over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Series {
    /// The positions of all joints that can be commanded, rad or m.
    Joints,
    /// Their speeds, rad/s or m/s.
    Speeds,
    /// The world pose of the base module's body: position in m, orientation as a unit quaternion.
    Base,
    /// The bonds, each true while it holds.
    Bonds,
}

impl Series {
    /// The words for series, with their meaning.
    pub const WORDS: &'static [(&'static str, Series)] = &[
        ("joints", Series::Joints),
        ("speeds", Series::Speeds),
        ("base", Series::Base),
        ("bonds", Series::Bonds),
    ];
}

/// Returns the times k / `rate` (s, for k = 0, 1, …) of a plan of this duration (s), and its end; `None` where there are
/// more than [`SAMPLES_MAX`]. `rate`: samples a second, positive.
pub fn times(duration: f64, rate: f64) -> Option<Vec<f64>> {
    let count = duration * rate;
    if count.is_nan() || count >= SAMPLES_MAX as f64 {
        return None;
    }
    let inside = (0..=count as usize).map(|k| k as f64 / rate).filter(|t| *t < duration);
    Some(inside.chain([duration]).collect())
}

/// Returns a series of a plan at some times (s), as a table with a column `time`; the columns of joints and bonds have
/// their names.
///
/// # Errors
/// [`Refusal::NoJoints`] for lattices and trusses.
pub fn table(plan: &Plan, series: Series, times: &[f64]) -> Result<RecordTable, Refusal> {
    let tracks = plan.body.tracks().ok_or(Refusal::NoJoints { format: "a series of joints" })?;
    let mut columns = vec![quantity("time", "s", times.to_vec())];
    match series {
        Series::Joints | Series::Speeds => {
            let names = Names::of(&tracks.robot);
            for (id, owner) in tracks.robot.joints().enumerate() {
                if !can_be_commanded(plan, owner) {
                    continue;
                }
                let joint = crate::robot::JointId(id as u32);
                let (track, start) = (tracks.track(joint), tracks.start.joints[id]);
                let value = |t: &f64| match series {
                    Series::Speeds => track.map_or(0.0, |track| track.velocity(*t)),
                    _ => track.map_or(start, |track| track.position(start, *t)),
                };
                let unit = match (tracks.robot.slides(owner), series) {
                    (true, Series::Speeds) => "m/s",
                    (true, _) => "m",
                    (false, Series::Speeds) => "rad/s",
                    (false, _) => "rad",
                };
                columns.push(quantity(&names.joints[id], unit, times.iter().map(value).collect()));
            }
        }
        Series::Base => {
            let paths = LinkPaths::of(plan).ok_or(Refusal::NoJoints { format: "a base pose" })?;
            let modules = &tracks.robot.modules[..tracks.robot.base];
            let link: usize = modules.iter().map(|m| tracks.robot.library.modules[m.kind].links.len()).sum();
            let poses: Vec<_> = times.iter().map(|t| paths.at(*t)[link]).collect();
            let of = |i: usize| {
                let value = |X: &crate::geometry::Pose| match i {
                    0..3 => X.translation.vector[i],
                    3 => X.rotation.w,
                    _ => X.rotation.coords[i - 4],
                };
                poses.iter().map(value).collect()
            };
            for (i, name) in ["x", "y", "z", "qw", "qx", "qy", "qz"].into_iter().enumerate() {
                columns.push(quantity(name, if i < 3 { "m" } else { "1" }, of(i)));
            }
        }
        Series::Bonds => {
            let states: Vec<Vec<bool>> = times.iter().map(|t| tracks.bonds(*t)).collect();
            for bond in 0..tracks.robot.bonds.len() {
                let cells = states.iter().map(|state| RecordCell::Bool(state[bond])).collect();
                let name = tracks.robot.bond_name(bond);
                columns.push(RecordColumn { name, unit: None, quantity: None, cells });
            }
        }
    }
    Ok(RecordTable { columns, rows: times.len() })
}

/// Returns true if a joint can be commanded: it has a motor of its own.
pub(super) fn can_be_commanded(plan: &Plan, owner: JointOwner) -> bool {
    let Some(tracks) = plan.body.tracks() else { return false };
    tracks.robot.takes_commands(owner)
}

/// Returns a column of quantities in SI units.
pub(super) fn quantity(name: &str, unit: &str, values: Vec<f64>) -> RecordColumn {
    let cells = values.into_iter().map(|x| RecordCell::Quantity { shown: x + 0.0, si: x + 0.0 }).collect();
    let unit = (unit != "1").then(|| unit.to_owned());
    RecordColumn { name: name.to_owned(), unit, quantity: None, cells }
}

/// Returns a table as CSV.
pub fn csv(table: &RecordTable) -> String {
    let format = ExportFormat::of_ending(TABLE_FORMATS, "csv").expect("tables are written as CSV");
    (format.write)(table)
}

/// Returns the positions of the joints of a plan as a file of CSV.
///
/// # Errors
/// [`Refusal::NoJoints`] for lattices and trusses; [`Refusal::TooMany`] for a plan that is too long.
pub(super) fn write(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let times = sampled(export.plan)?;
    let table = table(export.plan, Series::Joints, &times)?;
    Ok(vec![ExportFile::text(format!("{}.csv", export.stem), csv(&table))])
}

/// Returns the times at which files are sampled.
///
/// # Errors
/// [`Refusal::TooMany`] for a plan that is too long.
pub(super) fn sampled(plan: &Plan) -> Result<Vec<f64>, Refusal> {
    let duration = plan.body.duration();
    let count = (duration * RATE_DEFAULT) as usize;
    times(duration, RATE_DEFAULT).ok_or(Refusal::TooMany { what: "samples", count, most: SAMPLES_MAX })
}
