//! The ways in which `fold` looks for layouts.

use super::fold_options::{HINGES, METHOD, Options, TARGET};
use super::fold_panel::Panel;
use crate::interpret::call::Call;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::planners::fold::branch_and_bound::{self, NoLayout};
use crate::planners::fold::enumerate::{self, TooManyFaces};
use crate::planners::fold::heuristic::{self, Measure};
use crate::planners::fold::local_search::{self, Survey};
use crate::planners::fold::objective::{Minimise, Objective};
use crate::planners::fold::peak_torque;
use crate::planners::fold::{Layout, Proof, Target};
use crate::source::{Diagnostic, code};

/// Layouts that are kept to be judged, where each was measured.
const KEPT: usize = 4096;

/// The search for the next best layout has the budget by this.
const NEXT_BEST: u64 = 4;

/// Layouts that may be what is wanted, with what is known about them.
pub struct Found {
    /// The best first; none that was passed over is better than those that follow.
    pub layouts: Vec<Layout>,
    /// How the next best can be sought.
    pub next: Option<branch_and_bound::Settings>,
    /// No layout has a lower peak torque where that is to be small, else spends less energy, with the
    /// leaves first; N·m.
    pub bound: f64,
    /// The least of any layout, also of those whose patterns overlap.
    pub least: f64,
    /// Whether none that lies flat is better than the first.
    pub proved: bool,
    /// Whether none that lies flat is left out of the list before the last of it.
    pub listed: bool,
    /// Roots that are equally good.
    pub ties: Vec<usize>,
    /// How many pairs of a layout and a root are known to be equally good.
    pub tied: u64,
}

impl Found {
    /// How the next best is sought, in a part of the budget: where none of the first is let through, other
    /// ways are tried as well.
    pub fn next_best(&self) -> Option<branch_and_bound::Settings> {
        self.next.map(|next| branch_and_bound::Settings { budget: next.budget / NEXT_BEST, ..next })
    }
}

/// What is asked.
pub struct Question<'q> {
    pub call: &'q Call<'q>,
    pub target: &'q Target,
    pub objective: &'q Objective<'q>,
    pub options: &'q Options,
    pub panel: &'q Panel,
}

impl Question<'_> {
    pub fn answer(&self) -> Eval<Found> {
        if !self.call.is_missing(HINGES) {
            return self.given();
        }
        match self.call.word(METHOD) {
            Some("enumerate") => self.enumerated(),
            Some("heuristic") => self.preferred(),
            _ if self.objective.adds_up() => self.proved(),
            _ => Ok(self.surveyed()?.0),
        }
    }

    /// From energies for steps of one second.
    fn scaled(&self, energy: f64) -> f64 {
        energy / (self.options.conventions.step * self.options.conventions.step)
    }

    fn proved(&self) -> Eval<Found> {
        let Options { root, budget, seed, minimise, .. } = *self.options;
        let (target, weights) = (self.target, &self.objective.weights);
        let plain = branch_and_bound::Settings { root, flat: true, height: None, budget, seed };
        let fewest = self.objective.fewest_steps(root);
        let mut settings = plain;
        let found = match minimise {
            Minimise::Steps => (fewest..target.faces.len()).find_map(|height| {
                settings = branch_and_bound::Settings { height: Some(height), ..plain };
                match branch_and_bound::optimum(target, weights, &settings) {
                    Err(NoLayout::AllOverlap) => None,
                    found => Some(found),
                }
            }),
            _ => Some(branch_and_bound::optimum(target, weights, &plain)),
        };
        let found = found.unwrap_or(Err(NoLayout::AllOverlap)).map_err(|why| self.no_layout(why))?;
        let least = match minimise {
            Minimise::Steps => fewest as f64,
            _ => {
                let free = branch_and_bound::Settings { flat: false, ..plain };
                let free =
                    branch_and_bound::optimum(target, weights, &free).map_err(|why| self.no_layout(why))?;
                self.scaled(free.energy.min(found.energy))
            }
        };
        Ok(Found {
            bound: self.scaled(found.bound),
            least,
            proved: found.proof == Proof::Optimal,
            listed: false,
            next: Some(settings),
            tied: found.roots.len() as u64,
            ties: found.roots,
            layouts: vec![found.layout],
        })
    }

    fn no_layout(&self, why: NoLayout) -> Stop {
        match why {
            NoLayout::AllOverlap => self.all_overlap(),
            NoLayout::Budget => fault(
                code::NOT_COVERED,
                self.call.span,
                "the budget ended before any pattern was found that does not overlap",
                "a greater `budget` may find one",
            ),
        }
    }

    fn all_overlap(&self) -> Stop {
        Diagnostic::error(code::NO_WAY, "every flat pattern of this shape overlaps itself")
            .label(self.call.at(TARGET), "can't lie flat in one piece")
            .into()
    }

    fn too_many(&self, limit: String) -> Stop {
        let message = format!("shapes of more than {limit} have too many layouts to look at each");
        Diagnostic::error(code::NOT_COVERED, message)
            .label(self.call.at(TARGET), "too many layouts")
            .hint("`method: exact` proves its answer without looking at every layout, where it can")
            .into()
    }

    fn too_many_faces(&self) -> impl Fn(TooManyFaces) -> Stop + '_ {
        |TooManyFaces| self.too_many(format!("{} faces", enumerate::FACES_MAX))
    }

    fn enumerated(&self) -> Eval<Found> {
        if !self.objective.adds_up() || self.options.minimise == Minimise::Steps {
            let (found, limit) = self.surveyed()?;
            return if found.proved {
                Ok(found)
            } else {
                Err(self.too_many(format!("{limit} layouts with roots")))
            };
        }
        let Options { root, budget, .. } = *self.options;
        let asked = enumerate::Settings { root, spectrum: false, budget };
        let all =
            enumerate::census(self.target, &self.objective.weights, &asked).map_err(self.too_many_faces())?;
        let tie = all.least * (1.0 + branch_and_bound::TOL_TIE);
        let ties = (0..all.by_root.len()).filter(|root| all.by_root[*root] <= tie).collect();
        let least = self.scaled(all.least);
        if !all.complete {
            return Ok(self.unproved(vec![all.best], least, ties, all.ties));
        }
        // It may overlap: the best that lies flat costs no less.
        let flat = self.proved()?;
        Ok(Found { least, ties, tied: all.ties, ..flat })
    }

    /// The layout of the pairs of faces that are listed, with its best root.
    fn given(&self) -> Eval<Found> {
        let refuse = |message: String| self.call.refuse(HINGES, message);
        let mut hinges = Vec::new();
        for pair in self.call.list(HINGES)?.iter() {
            let Value::List(pair) = pair else { continue };
            let index = |value: &Value| match value {
                Value::Int(face) => usize::try_from(*face).ok(),
                _ => None,
            };
            let faces: Vec<usize> = pair.iter().filter_map(index).collect();
            let [a, b] = faces[..] else { return Err(refuse("a hinge is a pair of faces".into())) };
            let known = a.max(b) < self.target.faces.len();
            let hinge = known.then(|| self.target.hinge_between(a, b)).flatten();
            hinges.push(hinge.ok_or_else(|| refuse(format!("faces {a} and {b} share no hinge")))?);
        }
        let of_root = |root: usize| Layout::of_hinges(self.target, &hinges, root);
        let layouts: Option<Vec<Layout>> = self.options.roots.iter().copied().map(of_root).collect();
        let Some(layouts) = layouts else {
            let faces = self.target.faces.len();
            return Err(refuse(format!("{} hinges that join not all {faces} faces", hinges.len())));
        };
        let values: Vec<f64> = layouts.iter().map(|layout| self.objective.value(layout)[0]).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let reaches = |(layout, value): (&Layout, &f64)| {
            (*value <= least * (1.0 + local_search::TOL_TIE)).then_some(layout.root)
        };
        let ties: Vec<usize> = layouts.iter().zip(&values).filter_map(reaches).collect();
        let best = layouts.into_iter().filter(|layout| ties.contains(&layout.root)).collect();
        let tied = ties.len() as u64;
        Ok(self.unproved(best, least, ties, tied))
    }

    /// Every layout measured, or as many as may be; with how many that are.
    fn surveyed(&self) -> Eval<(Found, u64)> {
        let budget = self.options.budget.min(self.objective.measures_max());
        let prefilter = self.objective.prefilter(self.options.budget);
        let roots = self.options.roots.clone();
        let settings = local_search::Settings { roots, flat: true, budget, keep: KEPT, prefilter };
        let budget = prefilter.map_or(budget, |prefilter| prefilter.budget);
        let weights = &self.objective.weights;
        let found =
            local_search::survey(self.target, weights, &settings, &mut |layout| self.objective.value(layout));
        let Survey { best, ties, roots, least, complete } = found;
        let Some((_, first)) = best.first() else {
            let why = if complete { NoLayout::AllOverlap } else { NoLayout::Budget };
            return Err(self.no_layout(why));
        };
        let is_measured = complete && self.options.minimise != Minimise::Steps;
        let bound = if is_measured { first[0] } else { self.objective.lower_bound(&self.options.roots) };
        let first = first[0];
        let layouts = best.into_iter().map(|(layout, _)| layout).collect();
        let (proved, listed) = (complete, complete);
        let found = Found { layouts, next: None, bound, least, proved, listed, ties: roots, tied: ties };
        let by_parts = self.objective.peaks_add_up();
        Ok((if by_parts && !complete { self.of_least_peak(found, first) } else { found }, budget))
    }

    /// With a proof of the least peak torque, as far as the budget reaches: `first` is that of the first
    /// layout.
    fn of_least_peak(&self, mut found: Found, first: f64) -> Found {
        let scale = self.objective.peak_by_mean();
        let (target, weights) = (self.target, &self.objective.weights);
        let (mut left, mut best, mut bound) = (self.options.budget, first / scale, f64::INFINITY);
        for &root in &self.options.roots {
            let least = peak_torque::least(target, weights, root, best, &mut left);
            bound = bound.min(least.bound);
            if let Some((layout, reached)) = least.layout.filter(|(_, reached)| *reached < best) {
                best = reached;
                found.ties = vec![root];
                found.tied = 1;
                found.layouts.insert(0, layout);
            }
        }
        found.least = found.least.min(best * scale);
        found.bound = (bound * scale).max(found.bound).min(best * scale);
        found.proved = bound >= best * (1.0 - branch_and_bound::TOL_TIE);
        found
    }

    fn preferred(&self) -> Eval<Found> {
        let Options { root, budget, .. } = *self.options;
        let measure = Measure::of_panels(self.panel.mass, self.panel.sides[0]);
        let found =
            heuristic::preferred(self.target, &measure, root, budget).map_err(self.too_many_faces())?;
        let least = self.objective.value(&found.layout)[0];
        let ties = vec![found.layout.root];
        Ok(self.unproved(vec![found.layout], least, ties, found.ties))
    }

    /// Layouts of which nothing is proved but what no layout undercuts.
    fn unproved(&self, layouts: Vec<Layout>, least: f64, ties: Vec<usize>, tied: u64) -> Found {
        let bound = self.objective.lower_bound(&self.options.roots);
        Found { layouts, next: None, bound, least, proved: false, listed: false, ties, tied }
    }
}
