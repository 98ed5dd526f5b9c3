//! Stages run backwards.

use super::motion::{Stage, Stages};

impl Stages {
    /// Returns the stages in reverse, from end to start: each ends where it began, and its time law is reversed.
    pub fn reversed(&self) -> Stages {
        let stage =
            |(i, s): (usize, &Stage)| Stage { end: self.before(i), law: s.law.reversed(), ..s.clone() };
        Stages {
            start: self.before(self.stages.len()),
            stages: self.stages.iter().enumerate().rev().map(stage).collect(),
            ..self.clone()
        }
    }
}
