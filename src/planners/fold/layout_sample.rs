//! The layouts of a target compared with each other: all of them, or random ones (Sec. 5.3.1, Tables 3, 4 and 7).

use super::enumerate;
use super::heuristic::Measure;
use super::layout::Layout;
use super::objective::Objective;
use super::observer::Observer;
use super::progress_text;
use super::report::Report;
use super::target::Target;
use super::tolerances::TOLERANCES;
use crate::optimize::random::SplitMix64;
use crate::planners::Progress;
use num_bigint::BigInt;

/// Layouts of a target with one root, and what each takes with the leaves folded first.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutSample {
    /// The hinges of each layout, as pairs of faces (indices in [`Target::faces`]), in the order of [`Target::hinges`].
    pub layouts: Vec<Vec<[usize; 2]>>,
    /// The energy of each layout, N·m.
    pub energies: Vec<f64>,
    /// The measure χ of each layout by which [Yao et al.](super) choose (their Method II), kg·m².
    pub measures: Vec<f64>,
    /// True if these are all layouts of the target, in the lexicographic order of their hinges.
    pub complete: bool,
    /// The energy of the layout of the folding with the leaves folded first, N·m.
    pub reference: f64,
}

impl LayoutSample {
    /// Returns the index of the first layout of least energy.
    pub fn best(&self) -> usize {
        first_least(&self.energies)
    }

    /// Returns the index of the first layout of the least measure.
    pub fn preferred(&self) -> usize {
        first_least(&self.measures)
    }

    /// Returns the median of the energies, N·m; of an even number the mean of the two in the middle.
    pub fn median(&self) -> f64 {
        let mut sorted = self.energies.clone();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        (sorted[(count - 1) / 2] + sorted[count / 2]) / 2.0
    }

    /// Returns the greatest energy, N·m.
    pub fn greatest(&self) -> f64 {
        self.energies.iter().copied().fold(0.0, f64::max)
    }

    /// Returns the place of an energy (N·m) among those of the layouts, from 1: one more than there are less ones, up to
    /// ties.
    pub fn rank(&self, energy: f64) -> usize {
        1 + self.energies.iter().filter(|other| **other < energy * (1.0 - TOLERANCES.tie)).count()
    }
}

/// Returns the index of the first least value, up to ties; 0 for none.
fn first_least(values: &[f64]) -> usize {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    values.iter().position(|value| *value <= least * (1.0 + TOLERANCES.tie)).unwrap_or(0)
}

impl Report {
    /// Compares layouts of the target with the root and under the conventions of the folding: all if there are at most
    /// `most`, else as many drawn at random, each spanning tree of the faces as likely as any other (Wilson 1996). The same
    /// `seed` draws the same; `progress` receives reports, but can't end it. `most` is at least 1.
    pub fn compare_layouts(&self, most: usize, seed: u64, progress: &mut dyn Progress) -> LayoutSample {
        let (target, root) = (&self.target, self.layout.root);
        let observer = Observer::new(progress);
        let mut found: Vec<Vec<usize>> = Vec::new();
        let few = self.layouts <= BigInt::from(most) && target.faces.len() <= enumerate::FACES_MAX;
        if few {
            enumerate::each(target, most as u64, |hinges| found.push(hinges.to_vec()))
                .expect("the faces were counted");
        } else {
            let mut rng = SplitMix64(seed);
            found.extend((0..most).map(|_| random_layout(target, &mut rng)));
        }
        let objective = Objective::new(target, self.masses.clone(), self.conventions, self.minimise);
        let side = target.side_lengths(0)[0];
        let measure = Measure::of_panels(self.masses[0], side);
        let mut sample = LayoutSample {
            layouts: Vec::with_capacity(found.len()),
            energies: Vec::with_capacity(found.len()),
            measures: Vec::with_capacity(found.len()),
            complete: few,
            reference: objective.leaves_first(&self.layout).energy,
        };
        let all = found.len() as u64;
        for (done, hinges) in found.iter().enumerate() {
            crate::interrupt::checkpoint();
            observer.report(|| progress_text::counted(done as u64, &all, "layouts", None));
            let layout = Layout::of_hinges(target, hinges, root).expect("only trees are compared");
            sample.layouts.push(hinges.iter().map(|&hinge| target.hinges[hinge].faces).collect());
            sample.energies.push(objective.leaves_first(&layout).energy);
            sample.measures.push(measure.of(target, &layout));
        }
        sample
    }
}

/// Returns the hinges of a random spanning tree of the faces, in ascending order, each as likely as any other: random walks
/// whose loops are erased (Wilson 1996).
fn random_layout(target: &Target, rng: &mut SplitMix64) -> Vec<usize> {
    let count = target.faces.len();
    let around: Vec<Vec<(usize, usize)>> = (0..count).map(|face| target.around(face).collect()).collect();
    let mut inside = vec![false; count];
    let mut next: Vec<(usize, usize)> = vec![(0, 0); count];
    let mut hinges = Vec::with_capacity(count - 1);
    inside[0] = true;
    for start in 1..count {
        // The last way out of a face is kept, so that loops are erased.
        let mut face = start;
        while !inside[face] {
            crate::interrupt::checkpoint();
            next[face] = around[face][rng.below(around[face].len())];
            face = next[face].1;
        }
        face = start;
        while !inside[face] {
            inside[face] = true;
            hinges.push(next[face].0);
            face = next[face].1;
        }
    }
    hinges.sort_unstable();
    hinges
}
