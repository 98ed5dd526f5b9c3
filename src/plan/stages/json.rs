//! Stages as they stand in a plan file.

use super::fault::StagesFault;
use super::motion::{Anchor, CellLimits, Law, Model, Run, Stage, StageEnd, Stages};
use super::moves::Moves;
use super::ratio::Ratio;
use crate::plan::cause::CauseId;
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
    /// The cells that stand fast, and the obstacles around them; absent for a lattice that floats by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    anchor: Option<Cow<'a, Anchor>>,
    /// The position of every cell at the start. Of two runs that name a cell the later holds.
    start: Cow<'a, [Run]>,
    stages: Vec<StageJson<'a>>,
}

/// One stage: from the configuration in which the one before ended to the one that either `end` or `moves` states.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Stage", deny_unknown_fields)]
struct StageJson<'a> {
    /// The name of the motion, in the planner's words, such as `x-squeeze`.
    name: Cow<'a, str>,
    /// The square of the duration in squared units of time: a rational number, where the duration is its root.
    time_squared: Ratio,
    /// The time law that all cells share.
    law: Law,
    /// The positions of cells at the end of the stage. Cells that no run names stay; if two runs name a cell, the
    /// later holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    end: Option<Cow<'a, [Run]>>,
    /// The moves of all cells over the stage, where it states no positions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    moves: Option<Cow<'a, Moves>>,
    /// The index in the plan's causes of the source command that this stage comes from.
    cause: CauseId,
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
            anchor: stages.anchor.as_ref().map(Cow::Borrowed),
            start: Cow::Borrowed(&stages.start),
            stages: stages.stages.iter().map(StageJson::of).collect(),
        }
    }

    /// Adds the names that the file states beside indices to `stated`, in the order of the file.
    pub(in crate::plan) fn names(&self, stated: &mut Stated) {
        stated.add("cell type", &self.cell_name);
    }

    /// Returns the stages that stand in a file; nothing else is checked.
    ///
    /// # Errors
    /// [`StagesFault::StageEnd`] for a stage with both `end` and `moves`, or with neither.
    pub(in crate::plan) fn into_stages(self) -> Result<Stages, StagesFault> {
        Ok(Stages {
            cell: self.cell,
            count: self.count,
            time_unit: self.time_unit,
            limits: self.limits,
            model: self.model,
            anchor: self.anchor.map(Cow::into_owned),
            start: self.start.into_owned(),
            stages: self.stages.into_iter().map(StageJson::into_stage).collect::<Result<_, _>>()?,
        })
    }
}

impl<'a> StageJson<'a> {
    fn of(stage: &'a Stage) -> StageJson<'a> {
        let (end, moves) = match &stage.end {
            StageEnd::Runs(runs) => (Some(Cow::Borrowed(runs.as_slice())), None),
            StageEnd::Moves(moves) => (None, Some(Cow::Borrowed(moves))),
        };
        StageJson {
            name: Cow::Borrowed(&stage.name),
            time_squared: stage.time_squared,
            law: stage.law,
            end,
            moves,
            cause: stage.cause,
        }
    }

    fn into_stage(self) -> Result<Stage, StagesFault> {
        let name = self.name.into_owned();
        let end = match (self.end, self.moves) {
            (Some(runs), None) => StageEnd::Runs(runs.into_owned()),
            (None, Some(moves)) => StageEnd::Moves(moves.into_owned()),
            (Some(_), Some(_)) | (None, None) => return Err(StagesFault::StageEnd { stage: name }),
        };
        Ok(Stage { name, time_squared: self.time_squared, law: self.law, end, cause: self.cause })
    }
}
