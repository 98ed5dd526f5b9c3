//! The rigidity that is left: the least singular value of the rigidity matrix, sampled at the ends and in the middle of
//! every step.

use super::judgement::{Judgement, Step};
use super::loads::looked_at;
use crate::geometry::Vec3;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Failure, Interpolation, NodePaths, Status};
use crate::robot::truss_statics::{Layout, Modes};
use crate::units::number;

/// The monitor of the rigidity of a truss from step to step.
pub(super) struct RigidityMonitor<'a> {
    judgement: &'a Judgement<'a>,
    modes: Modes,
    /// The instants looked at.
    samples: usize,
}

impl<'a> RigidityMonitor<'a> {
    /// Returns a monitor before the first step.
    pub(super) fn new(judgement: &'a Judgement<'a>) -> RigidityMonitor<'a> {
        RigidityMonitor { judgement, modes: Modes::default(), samples: 0 }
    }

    /// Checks the least singular value during the step to the keyframe of this index; a rigid roll does not change it.
    pub(super) fn step(&mut self, step: &Step, keyframe: usize, ledger: &mut Ledger) {
        if step.interpolation != Interpolation::Linear
            || self.judgement.rigidity == 0.0
            || !looked_at(self.judgement, keyframe)
        {
            return;
        }
        for part in [0.0, 0.5, 1.0] {
            // The start of a step is the end of the one before.
            if part > 0.0 || keyframe <= 1 {
                let x: Vec<Vec3> = step.from.iter().zip(&step.to).map(|(p, q)| p + (q - p) * part).collect();
                self.instant(&x, step.time(part), ledger);
            }
        }
    }

    /// Checks the least singular value of the rigidity matrix at an instant.
    fn instant(&mut self, x: &[Vec3], time: f64, ledger: &mut Ledger) {
        let Judgement { paths, layout, rigidity: limit, .. } = self.judgement;
        let (weakest, at) = weakest(paths, layout, x, &mut self.modes);
        let names = || at.iter().map(|&node| paths.node_names[node].clone()).collect();
        self.samples += 1;
        keep_least(&mut ledger.verdict.rigidity, weakest, time, names);
        if weakest < limit - self.judgement.tolerances.rigidity {
            let message = format!(
                "the truss is near to losing its rigidity at the node {}: a singular value of {}; it keeps {}",
                names().join(" and "),
                number(weakest),
                number(*limit)
            );
            let failure = self.judgement.failure(CheckKind::Rigidity, time, names(), message);
            ledger.fail(Failure { value: weakest, limit: *limit, ..failure });
        }
    }

    /// Returns the status of the check.
    pub(super) fn status(&self) -> Status {
        match self.judgement.rigidity {
            0.0 => Status::NotChecked("it is not rigid where it begins".into()),
            _ if self.samples == 0 => Status::NotChecked("nothing changes its shape".into()),
            _ => Status::Sampled(self.samples),
        }
    }
}

/// Returns the least singular value of the rigidity matrix that does not belong to one of the six rigid motions of the
/// whole truss, without unit, and the node that moves farthest in its right singular vector; 0 if the truss is not
/// rigid. `x`: the positions of the nodes, m. Rows are unit vectors along the struts. `modes`: those found last.
pub(super) fn weakest(
    paths: &NodePaths,
    layout: &Layout,
    x: &[Vec3],
    modes: &mut Modes,
) -> (f64, Option<usize>) {
    match modes.weakest(layout, x, &paths.struts, 1).first() {
        Some(mode) => {
            let farthest =
                (0..x.len()).max_by(|&a, &b| mode.nodes[a].norm().total_cmp(&mode.nodes[b].norm()));
            (mode.value, farthest)
        }
        None => (0.0, None),
    }
}
