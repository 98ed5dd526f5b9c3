//! A lattice plan under judgement, one of its stages, and how failures of a stage are recorded.

use crate::plan::lattice::Cube;
use crate::plan::lattice::law::{Change, TimeScaling};
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, Failure, Stage, Stages};
use crate::robot::Cell;

/// A lattice plan under judgement.
pub(super) struct Judgement<'a> {
    /// The stages of the lattice plan, with its start.
    pub stages: &'a Stages,
    /// The type of cell that the lattice is made of.
    pub cell: &'a Cell,
    /// The obstacles, in grid lines.
    pub obstacles: Vec<Cube>,
}

/// A stage of a lattice plan with the configurations at its two ends.
pub(super) struct Step<'a> {
    /// The stage that is judged.
    pub stage: &'a Stage,
    /// The time at which the stage starts, s from the start of the plan.
    pub from: f64,
    /// The time at which the stage ends, s from the start of the plan.
    pub to: f64,
    /// The cells at the start of the stage, by number.
    pub before: &'a [Cube],
    /// The cells at the end of the stage, by number.
    pub after: &'a [Cube],
    /// The sums and extremes of the displacements of the cells over the stage.
    pub change: Change,
    /// The time scaling of the stage.
    pub scaling: TimeScaling,
    /// The number of grid lines to the edge of a full-sized cell.
    pub lines: i64,
}

impl Judgement<'_> {
    /// Records a failure of a check at `time` (s) that has no value, no limit and no cells to name; `stage`: the one
    /// to blame, `None` at the start of the plan.
    pub(super) fn fail(
        &self,
        kind: CheckKind,
        time: f64,
        stage: Option<&Stage>,
        message: String,
        ledger: &mut Ledger,
    ) {
        self.fail_at(kind, time, stage, (message, 0.0, 0.0), &[], ledger);
    }

    /// Records a failure of a check at `time` (s) as (message, value, limit), the numbers in the unit of the check,
    /// and the cells concerned by their numbers; `stage`: the one to blame, `None` at the start of the plan.
    pub(super) fn fail_at(
        &self,
        kind: CheckKind,
        time: f64,
        stage: Option<&Stage>,
        (message, value, limit): (String, f64, f64),
        cells: &[u32],
        ledger: &mut Ledger,
    ) {
        ledger.fail(Failure { message, value, limit, at: names(cells), ..self.failure(kind, time, stage) });
    }

    /// Returns a failure of a check at a time (s) without message, value and limit, blamed on the command that the
    /// stage comes from; on none if `stage` is `None`.
    pub(super) fn failure(&self, kind: CheckKind, time: f64, stage: Option<&Stage>) -> Failure {
        Failure {
            kind,
            time,
            until: None,
            at: vec![],
            message: String::new(),
            value: 0.0,
            limit: 0.0,
            blame: stage.map(|stage| stage.cause).into_iter().collect(),
            blames_start: false,
        }
    }
}

/// Returns the names that reports give to cells, such as `cell 3`, by their numbers from 0.
pub(super) fn names(cells: &[u32]) -> Vec<String> {
    cells.iter().map(|cell| format!("cell {cell}")).collect()
}
