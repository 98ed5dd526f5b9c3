//! Stages between two times.

use super::motion::Stages;
use crate::plan::operation_error::OperationError;
use crate::plan::tolerances::TOLERANCES;

impl Stages {
    /// Returns the stages between two times, s from the start of the plan, at which stages begin or end.
    ///
    /// # Errors
    /// [`OperationError::InsideStage`] for another time: within a stage the cells move. [`OperationError::Inexact`] for
    /// moves that lead to no exact positions.
    pub(in crate::plan) fn sliced(&self, from: f64, to: f64) -> Result<Stages, OperationError> {
        let instants = self.instants();
        let border = |t: f64| {
            let found = instants.iter().position(|i| (i - t).abs() <= TOLERANCES.stage_border * (1.0 + t));
            found.ok_or(OperationError::InsideStage { time: t })
        };
        let (first, last) = (border(from)?, border(to)?);
        let start = self.before(first).map_err(|_| OperationError::Inexact)?;
        Ok(Stages { start, stages: self.stages[first..last].to_vec(), ..self.clone() })
    }
}
