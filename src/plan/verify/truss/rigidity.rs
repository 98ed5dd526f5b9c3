//! The rigidity that is left: the least singular value of the rigidity matrix, at the ends and in the middle of every step, and
//! a bound on it between these: no singular value changes by more than the norm of the change of the matrix (Weyl 1912).

use super::judgement::{Judgement, Step};
use super::loads::looked_at;
use crate::geometry::Vec3;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Failure, Interpolation, Status};
use crate::robot::truss_statics::Modes;
use crate::units::number;

/// The part of the limit that the least singular value keeps between the ends and the middle of a step.
const DIP: f64 = 0.5;
/// The part of a step below which no more moments are looked at.
const PARTS_LEAST: f64 = 1.0 / 256.0;

/// The monitor of the rigidity of a truss from step to step.
#[derive(Default)]
pub(super) struct RigidityMonitor {
    modes: Modes,
    /// The instants looked at.
    samples: usize,
    /// The least singular value at the end of the step before, without unit; `None` if it is not known.
    last: Option<f64>,
}

impl RigidityMonitor {
    /// Forgets the positions looked at last, as the topology is another from now on.
    pub(super) fn begin(&mut self) {
        (self.modes, self.last) = (Modes::default(), None);
    }

    /// Checks the least singular value of a truss at rest, with the nodes at `x` (m), at a time (s).
    pub(super) fn rest(&mut self, judgement: &Judgement, x: &[Vec3], time: f64, ledger: &mut Ledger) {
        if judgement.rigidity > 0.0 {
            let value = self.instant(judgement, x, (time, judgement.rigidity), ledger);
            self.last = Some(value);
        }
    }

    /// Checks the least singular value during the step to the keyframe of this index; a rigid roll does not change it.
    pub(super) fn step(&mut self, judgement: &Judgement, step: &Step, keyframe: usize, ledger: &mut Ledger) {
        if step.interpolation != Interpolation::Linear
            || judgement.rigidity == 0.0
            || !looked_at(judgement, keyframe)
        {
            return;
        }
        let limit = judgement.rigidity;
        let failures = ledger.verdict.failures.len();
        let mut found = [self.last.unwrap_or_default(), 0.0, 0.0];
        for (part, value) in [0.0, 0.5, 1.0].into_iter().zip(&mut found) {
            // The start of a step is the end of the one before.
            if part > 0.0 || self.last.is_none() {
                *value = self.instant(judgement, &step.at(part), (step.time(part), limit), ledger);
            }
        }
        self.last = looked_at(judgement, keyframe + 1).then_some(found[2]);
        // One failure of a step is enough.
        if ledger.verdict.failures.len() == failures {
            let [start, middle, end] = found;
            let first = self.between(judgement, step, ((0.0, start), (0.5, middle)), ledger);
            if first {
                self.between(judgement, step, ((0.5, middle), (1.0, end)), ledger);
            }
        }
    }

    /// Checks that the least singular value stays above a part of its limit between two moments of a step, each as (progress,
    /// singular value): by what it may change by, or at more moments between. Returns false if that failed.
    fn between(
        &mut self,
        judgement: &Judgement,
        step: &Step,
        (a, b): ((f64, f64), (f64, f64)),
        ledger: &mut Ledger,
    ) -> bool {
        let floor = DIP * judgement.rigidity;
        let middle = (a.0 + b.0) / 2.0;
        let x = step.at(middle);
        let reaches =
            [a, b].map(|(part, value)| value - change(&judgement.struts, &step.at(part), &x) >= floor);
        if reaches == [true, true] {
            return true;
        }
        let failures = ledger.verdict.failures.len();
        let value = self.instant(judgement, &x, (step.time(middle), floor), ledger);
        if ledger.verdict.failures.len() > failures {
            return false;
        }
        if b.0 - a.0 < PARTS_LEAST {
            let message = format!("it is not proved that the truss stays as rigid as {}", number(floor));
            let failure = judgement.failure(CheckKind::Rigidity, step.time(middle), Vec::new(), message);
            ledger.fail(Failure { value, limit: floor, ..failure });
            return false;
        }
        self.between(judgement, step, (a, (middle, value)), ledger)
            && self.between(judgement, step, ((middle, value), b), ledger)
    }

    /// Checks the least singular value of the rigidity matrix at an instant against a limit, and returns it.
    fn instant(
        &mut self,
        judgement: &Judgement,
        x: &[Vec3],
        (time, limit): (f64, f64),
        ledger: &mut Ledger,
    ) -> f64 {
        let (weakest, at) = weakest(judgement, x, &mut self.modes);
        let names = || at.iter().map(|&node| judgement.node_name(node)).collect();
        self.samples += 1;
        keep_least(&mut ledger.verdict.rigidity, weakest, time, names);
        if weakest < limit - judgement.tolerances.rigidity {
            let message = format!(
                "the truss is near to losing its rigidity at the node {}: a singular value of {}; it keeps {}",
                names().join(" and "),
                number(weakest),
                number(limit)
            );
            let failure = judgement.failure(CheckKind::Rigidity, time, names(), message);
            ledger.fail(Failure { value: weakest, limit, ..failure });
        }
        weakest
    }

    /// Returns the status of the check.
    pub(super) fn status(&self, judgement: &Judgement) -> Status {
        match judgement.rigidity {
            0.0 => Status::NotChecked("it is not rigid where it begins".into()),
            _ if self.samples == 0 => Status::NotChecked("nothing changes its shape".into()),
            _ => Status::Sampled(self.samples),
        }
    }
}

/// Returns the least singular value of the rigidity matrix that does not belong to one of the six rigid motions of the
/// whole truss, without unit, and the node that moves farthest in its right singular vector; 0 if the truss is not
/// rigid. `x`: the positions of the nodes, m. Rows are unit vectors along the struts. `modes`: those found last.
pub(super) fn weakest(judgement: &Judgement, x: &[Vec3], modes: &mut Modes) -> (f64, Option<usize>) {
    match modes.weakest(&judgement.layout, x, &judgement.struts, 1).first() {
        Some(mode) => {
            let farthest =
                (0..x.len()).max_by(|&a, &b| mode.nodes[a].norm().total_cmp(&mode.nodes[b].norm()));
            (mode.value, farthest)
        }
        None => (0.0, None),
    }
}

/// Returns an upper bound on what any singular value changes by on the way between two positions of the nodes, m: the
/// norm of the change E of the matrix. The square of that is at most the greatest sum of the squares of the changes of
/// the directions of struts, over the two nodes of a strut (Anderson and Morley 1985, for the Laplacian EᵀE). On straight
/// lines a direction turns one way, so that no moment between has changed more.
fn change(struts: &[(usize, usize)], x: &[Vec3], y: &[Vec3]) -> f64 {
    let along = |x: &[Vec3], a: usize, b: usize| (x[b] - x[a]).normalize();
    let mut sums = vec![0.0; x.len()];
    for &(a, b) in struts {
        let square = (along(y, a, b) - along(x, a, b)).norm_squared();
        sums[a] += square;
        sums[b] += square;
    }
    struts.iter().map(|&(a, b)| sums[a] + sums[b]).fold(0.0, f64::max).sqrt()
}
