//! Pairs of sheets, one of either shape, on the same lattice: how far they are apart, and the refolding between them.

use super::lattice_sheet::{Corners, LatticeSheet, Point as Cell, Stroke, across, bond, cell};
use super::rearrangement::{Goal, pair};
use super::sheets::{Random, Refolding, Sheet};
use crate::planners::fold::{Layout, Target};
use std::collections::{BTreeMap, BTreeSet};

/// A sheet of either shape on the same lattice.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) from: Laid,
    pub(super) to: Laid,
}

/// A shape laid out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Laid {
    /// The corners of each face.
    corners: Vec<Corners>,
    /// The hinges that fold, in order of number.
    hinges: Vec<usize>,
}

impl Laid {
    /// Returns the cells that the sheet covers.
    pub(super) fn cells(&self) -> BTreeSet<Cell> {
        self.corners.iter().map(cell).collect()
    }

    /// Returns the pairs of cells that are joined.
    fn joined<'l>(&'l self, target: &'l Target) -> impl Iterator<Item = [Cell; 2]> + 'l {
        self.hinges.iter().map(|hinge| {
            let [a, b] = target.hinges[*hinge].faces.map(|face| cell(&self.corners[face]));
            pair(a, b)
        })
    }
}

impl Pair {
    /// Returns the distance of the two sheets: cells that only one covers, and connections that only one has.
    pub(super) fn apart(&self, from: &Target, to: &Target) -> usize {
        let cells = self.to.cells();
        let stray = self.from.corners.iter().filter(|corners| !cells.contains(&cell(corners))).count();
        let joined: BTreeSet<[Cell; 2]> = self.from.joined(from).collect();
        stray + self.to.joined(to).filter(|pair| !joined.contains(pair)).count()
    }

    /// Returns the refolding by the strokes that `series` gives from the one sheet to the other; `None` if it gives none.
    pub(super) fn refolding(
        &self,
        from: &Target,
        to: &Target,
        series: impl FnOnce(&LatticeSheet, &Goal) -> Option<(Vec<Stroke>, LatticeSheet)>,
    ) -> Option<Refolding> {
        let bonds = self.from.hinges.iter().map(|hinge| {
            let hinge = &from.hinges[*hinge];
            let [a, b] = [0, 1].map(|end| (hinge.faces[end], hinge.sides[end]));
            bond(a, b)
        });
        let start = LatticeSheet::new(self.from.corners.clone(), bonds.collect());
        let goal = Goal { cells: self.to.cells(), bonds: self.to.joined(to).collect() };
        let (strokes, end) = series(&start, &goal)?;
        let faces: BTreeMap<Cell, usize> =
            self.to.corners.iter().enumerate().map(|(face, corners)| (cell(corners), face)).collect();
        let becomes: Vec<usize> = end.corners.iter().map(|corners| faces[&cell(corners)]).collect();
        let turn = |(panel, face): (usize, &usize)| {
            let there = self.to.corners[*face];
            (0..3)
                .find(|turn| there[*turn] == end.corners[panel][0])
                .expect("one cell has one set of corners")
        };
        let turns = becomes.iter().enumerate().map(turn).collect();
        Some(Refolding {
            from: Layout::of_hinges(from, &self.from.hinges, 0).expect("laid out as a tree"),
            to: Layout::of_hinges(to, &self.to.hinges, becomes[0]).expect("laid out as a tree"),
            becomes,
            turns,
            strokes,
        })
    }
}

/// Lays the rest of a shape around the faces that are laid out, on cells of the other's sheet if possible. `None` if
/// some face has no free cell.
pub(super) fn spread(
    target: &Target,
    mut corners: Vec<Option<Corners>>,
    mut hinges: Vec<usize>,
    wanted: &BTreeSet<Cell>,
    random: &mut Random,
) -> Option<Laid> {
    let mut cells: BTreeSet<Cell> = corners.iter().flatten().map(cell).collect();
    while hinges.len() + 1 < corners.len() {
        let mut choices: Vec<(bool, usize, usize, Corners)> = Vec::new();
        for (face, laid) in corners.iter().enumerate() {
            let Some(laid) = laid else { continue };
            for side in 0..3 {
                let ahead = across(laid, side);
                let next = Sheet::beyond(target, face, side, |other| corners[other].is_some());
                if let Some([other, own, hinge]) = next.filter(|_| !cells.contains(&cell(&ahead))) {
                    let ahead = [0, 1, 2].map(|k| ahead[(k + 3 - own) % 3]);
                    choices.push((wanted.contains(&cell(&ahead)), other, hinge, ahead));
                }
            }
        }
        let are_wanted = choices.iter().any(|choice| choice.0);
        choices.retain(|choice| choice.0 == are_wanted);
        if choices.is_empty() {
            return None;
        }
        let (_, face, hinge, ahead) = choices[random.below(choices.len())];
        cells.insert(cell(&ahead));
        corners[face] = Some(ahead);
        hinges.push(hinge);
    }
    hinges.sort_unstable();
    Some(Laid { corners: corners.into_iter().flatten().collect(), hinges })
}
