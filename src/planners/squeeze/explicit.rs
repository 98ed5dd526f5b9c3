//! Ways of cells that are listed one by one, told in runs where they can be.

use super::Refusal;
use super::domain::{Domain, Spot};
use super::way::{Builder, Terms, Way};
use crate::plan::lattice::{Cube, greatest_relative_displacement};
use crate::plan::{ArithmeticRun, arithmetic_runs};

/// Configurations of listed cells, one after another.
pub struct Listed {
    start: Vec<Spot>,
    stages: Vec<(&'static str, Vec<Spot>)>,
}

impl Listed {
    pub fn new(start: Vec<Spot>) -> Listed {
        Listed { start, stages: vec![] }
    }

    pub fn last(&self) -> &[Spot] {
        self.stages.last().map_or(&self.start, |(_, spots)| spots)
    }

    /// A stage in which each cell goes where `change` puts it.
    pub fn stage(&mut self, name: &'static str, mut change: impl FnMut(usize, &mut Spot)) {
        crate::interrupt::checkpoint();
        let mut spots = self.last().to_vec();
        spots.iter_mut().enumerate().for_each(|(i, spot)| change(i, spot));
        self.stages.push((name, spots));
    }

    /// The way, its cells numbered by `number`.
    pub fn way(self, terms: Terms, number: &[u64]) -> Result<Way, Refusal> {
        let renumbered = |spots: Vec<Spot>| {
            let mut new = spots.clone();
            number.iter().zip(spots).for_each(|(&to, spot)| new[to as usize] = spot);
            new
        };
        let count = number.len() as u64;
        let start = renumbered(self.start);
        let first = start.clone();
        let mut last = start.clone();
        let mut builder = Builder::new(terms, count, &runs(&start, &start), move |i| first[i as usize])?;
        for (name, spots) in self.stages {
            let spots = renumbered(spots);
            if spots == last {
                continue;
            }
            let parting = greatest_relative_displacement(&cubes(&last), &cubes(&spots), LINES)
                .ok_or(Refusal::TooLarge)?;
            let domains = runs(&last, &spots);
            last.clone_from(&spots);
            // Of distances, what is held is the difference; it comes in lines of the judge's grid.
            builder.stage(name, parting / 4, &domains, move |i| spots[i as usize])?;
        }
        Ok(builder.way())
    }
}

/// Lines of the judge's grid to a cell: eighths hold half of three quarters.
const LINES: i64 = 8;

fn cubes(spots: &[Spot]) -> Vec<Cube> {
    let cube = |spot: &Spot| Cube {
        lo: [0, 1, 2].map(|axis| 2 * spot.center[axis] - spot.size[axis]),
        hi: [0, 1, 2].map(|axis| 2 * spot.center[axis] + spot.size[axis]),
    };
    spots.iter().map(cube).collect()
}

/// Domains of neighbouring numbers on which both configurations are affine: runs, and runs of equal
/// runs.
fn runs(before: &[Spot], after: &[Spot]) -> Vec<Domain> {
    let step = |from: usize, to: usize| {
        let between = |spots: &[Spot]| {
            let (a, b) = (spots[from], spots[to]);
            (a.size == b.size).then(|| [0, 1, 2].map(|axis| b.center[axis] - a.center[axis]))
        };
        Some((between(before)?, between(after)?))
    };
    let domain = |s: ArithmeticRun| {
        let counters = [(s.times as u64, s.length as i64), (s.length as u64, 1)];
        Domain::new(s.first as u64, &counters)
    };
    arithmetic_runs(before.len(), step).into_iter().filter_map(domain).collect()
}
