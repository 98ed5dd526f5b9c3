//! Comparison of the margins that a plan states at its keyframes with those found there.

use super::judgement::{Judgement, Step};
use super::support::StabilityMonitor;
use super::{rigidity, strut_distance};
use crate::geometry::Vec3;
use crate::plan::verify::support_polygon;
use crate::plan::{CheckKind, Failure, Margins};
use crate::robot::truss_statics::Modes;
use crate::units::number;

impl Judgement<'_> {
    /// Compares the margins that the plan states at a keyframe with those found there. Returns the failure of the
    /// first that differs by more than the tolerance `stated_margin`; `None` if there is none. `x`: the positions of
    /// the nodes at the keyframe, m; `time`: its time, s.
    pub(super) fn margins(
        &self,
        stated: &Margins,
        x: &[Vec3],
        time: f64,
        standing: &StabilityMonitor,
    ) -> Option<Failure> {
        let Margins { length, clearance, obstacle, support, angle, rigidity: stiff, sum } = *stated;
        let found = |stated: Option<f64>, found: &dyn Fn() -> Option<f64>, what: &'static str| {
            let stated = stated?;
            let found = found().unwrap_or(f64::INFINITY);
            ((stated - found).abs() > self.tolerances.stated_margin).then_some((what, stated, found))
        };
        // The margins as they are found at the keyframe, each computed only where one is stated.
        let lengths = || {
            let (low, high) = self.strut.length;
            let failed = |strut: &usize| {
                self.paths.limits.sums.iter().find(|sum| sum.struts == [*strut]).map(|sum| sum.range)
            };
            let one = |strut: usize| {
                let (low, high) = failed(&strut).unwrap_or((low, high));
                (self.length(x, strut) - low).min(high - self.length(x, strut))
            };
            (0..self.struts.len()).map(one).reduce(f64::min)
        };
        let apart = || {
            let step = Step::still(x, time);
            let limits = (self.strut.clearance, self.tolerances.strut_distance);
            let near = strut_distance::nearest(self, &step, limits, false);
            near.iter().map(|near| near.distance - self.strut.clearance).reduce(f64::min)
        };
        let beside = || self.nearest_obstacle(x).map(|distance| distance - self.strut.clearance);
        let inside = || {
            let feet =
                x.iter().filter(|p| standing.touches(self, **p)).map(|p| [p.x, p.y]).collect::<Vec<_>>();
            let middle = self.centre(x);
            support_polygon::margin(&feet, [middle.x, middle.y]).map(|margin| margin.distance)
        };
        let angles = || {
            let angles = self.corners.iter().map(|corner| corner.angle(x) - self.paths.limits.angle);
            angles.reduce(f64::min)
        };
        let weakest = || {
            let (least, _) = rigidity::weakest(self, x, &mut Modes::default());
            Some(least - self.paths.limits.rigidity)
        };
        let sums = || {
            let one = |sum: &crate::plan::LengthSum| {
                let length: f64 = sum.struts.iter().map(|&strut| self.length(x, strut)).sum();
                (length - sum.range.0).min(sum.range.1 - length)
            };
            self.paths.limits.sums.iter().map(one).reduce(f64::min)
        };
        // The first stated margin that is not the one found.
        let (what, stated, found) = found(length, &lengths, "of lengths")
            .or_else(|| found(clearance, &apart, "between struts"))
            .or_else(|| found(obstacle, &beside, "beside obstacles"))
            .or_else(|| found(support, &inside, "of the support"))
            .or_else(|| found(angle, &angles, "of angles"))
            .or_else(|| found(stiff, &weakest, "of rigidity"))
            .or_else(|| found(sum, &sums, "of sums of lengths"))?;
        let message =
            format!("the plan states a margin {what} of {}; it is {}", number(stated), number(found));
        Some(Failure { value: stated, limit: found, ..self.failure(CheckKind::Form, time, vec![], message) })
    }

    fn length(&self, x: &[Vec3], strut: usize) -> f64 {
        let (a, b) = self.struts[strut];
        (x[a] - x[b]).norm()
    }
}
