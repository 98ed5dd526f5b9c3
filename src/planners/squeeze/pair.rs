//! Pairs of cells that spin in one lattice site: reaction wheels of a robot that floats.
//!
//! Two cells of half a size fill a site as well as one. They can turn about each other in it without end, by the swaps of
//! Lemma 3, always in one sense: then their angular momentum about their own middle is that of two point masses, wherever
//! the robot's centre of mass is, and the site looks the same again after half a turn. The phase of a pair counts
//! stages of the swap: at 0 the cells are split along x, at 1 they have a corner in common, at 2 they are
//! split along y, and at 4 they have changed places.

use super::fraction::Fraction;

/// A site of the lattice in the plane, or a direction along an axis.
pub(super) type Site = [i64; 2];

/// The place of a cell in the plane: centre and sides, in cell sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct CellPlace {
    pub(super) center: [Fraction; 2],
    pub(super) size: [Fraction; 2],
}

impl CellPlace {
    /// Returns the place of a whole cell that fills a site.
    pub(super) fn whole(site: Site) -> CellPlace {
        CellPlace { center: site.map(Fraction::whole), size: [Fraction::ONE; 2] }
    }

    /// Returns the place whose centre is moved by `by`.
    pub(super) fn moved(self, by: [Fraction; 2]) -> CellPlace {
        CellPlace { center: [self.center[0] + by[0], self.center[1] + by[1]], ..self }
    }

    /// Returns the place at `part` of the way to another, with centre and sides in proportion.
    pub(super) fn toward(self, to: CellPlace, part: Fraction) -> CellPlace {
        let between = |a: [Fraction; 2], b: [Fraction; 2]| [0, 1].map(|k| a[k] + (b[k] - a[k]) * part);
        CellPlace { center: between(self.center, to.center), size: between(self.size, to.size) }
    }
}

/// A pair of cells in one site.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub(super) site: Site,
    /// The middle of the pair, which is off its site only while rows are slid against each other.
    pub(super) center: [Fraction; 2],
    /// The cells: at phase 0 the first is at the lower half along x.
    pub(super) cells: [usize; 2],
    pub(super) phase: Fraction,
}

/// The angular momentum of a pair that spins by one stage, in cell masses and squared cell sizes: 1/8.
pub(super) const STAGES_PER_MOMENT: i64 = 8;
/// The number of stages of half a turn, after which a pair fills its site as before.
pub(super) const HALF_TURN: i64 = 4;

impl Pair {
    /// Returns the places of the two cells at a phase and a middle.
    pub(super) fn places(phase: Fraction, center: [Fraction; 2]) -> [CellPlace; 2] {
        let (quarter, half) = (Fraction::new(1, 4), Fraction::new(1, 2));
        let stage = phase.floor();
        let part = phase - Fraction::new(stage, 1);
        let rest = Fraction::ONE - part;
        let (offset, size) = match stage.rem_euclid(HALF_TURN.into()) {
            0 => ([quarter, part * quarter], [half, Fraction::ONE - part * half]),
            1 => ([rest * quarter, quarter], [half + part * half, half]),
            2 => ([-(part * quarter), quarter], [Fraction::ONE - part * half, half]),
            _ => ([-quarter, rest * quarter], [half, half + part * half]),
        };
        let turned = stage.rem_euclid(2 * i128::from(HALF_TURN)) >= HALF_TURN.into();
        let offset = if turned { offset.map(|x| -x) } else { offset };
        let place = CellPlace { center, size };
        [place.moved(offset.map(|x| -x)), place.moved(offset)]
    }

    /// Returns the phase of a pair whose second cell is ahead of the first in this direction.
    pub(super) fn split_along(direction: Site) -> Fraction {
        Fraction::whole(match direction {
            [1, _] => 0,
            [_, 1] => 2,
            [-1, _] => 4,
            _ => 6,
        })
    }

    /// Returns the cells in the order in which they stand along a direction, along which the pair must be split.
    pub(super) fn along(&self, direction: Site) -> [usize; 2] {
        let [first, second] = Pair::places(self.phase, self.center);
        let ahead = |k: usize| Fraction::whole(direction[k]) * (second.center[k] - first.center[k]);
        if (ahead(0) + ahead(1)).sign() > 0 { self.cells } else { [self.cells[1], self.cells[0]] }
    }

    /// Returns the number of stages (not above 1, and above 0) by which the pair spins in this sense to the next phase at
    /// which it turns a corner.
    pub(super) fn room(&self, sense: i64) -> Fraction {
        let done = self.phase - Fraction::new(self.phase.floor(), 1);
        if sense > 0 {
            Fraction::ONE - done
        } else if done.is_zero() {
            Fraction::ONE
        } else {
            done
        }
    }

    /// Returns true for a phase at which the cells have a corner in common only.
    pub(super) fn is_corner(phase: Fraction) -> bool {
        phase.denominator() == 1 && phase.floor().rem_euclid(2) == 1
    }

    /// Returns the least spins, in stages, up and down, the lesser first, after which the pair is split along an axis.
    pub(super) fn spins_to(&self, axis: usize) -> [Fraction; 2] {
        let up = remainder(Fraction::whole(2 * axis as i64) - self.phase);
        let down = if up.is_zero() { up } else { up - Fraction::whole(HALF_TURN) };
        if up.order(down.abs()).is_gt() { [down, up] } else { [up, down] }
    }
}

/// Returns what is left of a number of stages after whole half turns: at least 0, less than [`HALF_TURN`].
pub(super) fn remainder(stages: Fraction) -> Fraction {
    let turns = (stages / Fraction::whole(HALF_TURN)).floor();
    stages - Fraction::new(turns, 1) * Fraction::whole(HALF_TURN)
}
