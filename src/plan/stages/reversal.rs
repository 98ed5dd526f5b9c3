//! Stages run backwards.

use super::motion::{Run, Stage, StageEnd, Stages};
use std::collections::BTreeMap;

impl Stages {
    /// Returns the stages in reverse, from end to start: each ends where it began, and its time law is reversed. Panics
    /// for moves that lead to no exact positions, which [`validate`](crate::plan::validation::validate) refuses.
    pub fn reversed(&self) -> Stages {
        // The configurations before stages that state positions, and at the end.
        let last = self.stages.len();
        let by_positions = |index: usize| self.stages.get(index).is_none_or(|stage| !stage.states_moves());
        let mut before: BTreeMap<usize, Vec<Run>> = BTreeMap::new();
        let added_up = self.for_configurations(by_positions, |index, runs| {
            before.insert(index, runs);
        });
        added_up.expect("the moves of a valid plan lead to exact positions");
        let start = before.remove(&last).unwrap_or_default();
        let stage = |(index, stage): (usize, &Stage)| Stage {
            name: stage.name.clone(),
            end: match &stage.end {
                StageEnd::Runs(_) => before.remove(&index).unwrap_or_default().into(),
                StageEnd::Moves(moves) => StageEnd::Moves(moves.reversed()),
            },
            law: stage.law.reversed(),
            time_squared: stage.time_squared,
            cause: stage.cause,
        };
        let stages = self.stages.iter().enumerate().rev().map(stage).collect();
        Stages { start, stages, anchor: self.anchor.clone(), ..*self }
    }
}
