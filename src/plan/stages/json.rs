//! Stages as they stand in a plan file.

use super::motion::{CellLimits, Model, Run, Stage, Stages};
use crate::plan::stated::Stated;
use crate::robot::Library;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A lattice in motion. Lengths are in cell sizes; times in `time_unit`.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Stages", deny_unknown_fields)]
pub(in crate::plan) struct StagesJson<'a> {
    /// Index in the library's `cells`.
    cell: usize,
    /// The name of that cell type.
    cell_name: String,
    /// The number of cells, which are numbered from 0.
    count: u64,
    /// The unit of time, s: that in which the greatest force brings a cell from rest to one cell size a unit
    /// of time.
    time_unit: f64,
    limits: CellLimits,
    /// The bounds on the cells' forces.
    model: Model,
    /// The position of every cell at the start. Of two runs that name a cell the later holds.
    start: Cow<'a, [Run]>,
    stages: Cow<'a, [Stage]>,
}

impl<'a> StagesJson<'a> {
    /// Returns stages as they stand in a plan file, with the cell's name out of `library`; long lists are borrowed.
    pub(in crate::plan) fn of(stages: &'a Stages, library: &Library) -> StagesJson<'a> {
        let cell = library.cells.get(stages.cell);
        StagesJson {
            cell: stages.cell,
            cell_name: cell.map_or_else(String::new, |cell| cell.name.clone()),
            count: stages.count,
            time_unit: stages.time_unit,
            limits: stages.limits,
            model: stages.model,
            start: Cow::Borrowed(&stages.start),
            stages: Cow::Borrowed(&stages.stages),
        }
    }

    /// Adds the names that the file states beside indices to `stated`, in the order of the file.
    pub(in crate::plan) fn names(&self, stated: &mut Stated) {
        stated.add("cell type", &self.cell_name);
    }

    /// Returns the stages that stand in a file; nothing is checked.
    pub(in crate::plan) fn into_stages(self) -> Stages {
        Stages {
            cell: self.cell,
            count: self.count,
            time_unit: self.time_unit,
            limits: self.limits,
            model: self.model,
            start: self.start.into_owned(),
            stages: self.stages.into_owned(),
        }
    }
}
