//! The choice of bonds that contradict each other. Files of tangled robots state loops that do not close; which bonds of
//! such a loop are left out decides where the modules are, and with it which of them overlap.
//!
//! A spanning tree of the bonds is a choice: it places the modules, and the bonds outside the tree whose docks do not
//! meet then are left out. The first choice is the tree of a breadth-first search. If balls overlap, the bonds between
//! them in the tree can't all hold in a choice without overlap; so the search leaves out one of them in turn
//! (conflict-directed backtracking). Only bonds of a block with an open loop come into question: without another bond the
//! modules are where they are. (A block is a greatest set of bonds any two of which share a cycle.) So a search that ends
//! within its budget is a proof.

use super::refusal::InvalidStart;
use super::robot::{Robot, mate};
use super::tolerances::TOLERANCES;
use super::tree::Tree;
use super::validation::{Overlap, loose, overlaps};

/// Greatest number of choices that are tried, of one forward kinematics each: a second or two of a processor for two
/// hundred modules.
pub const CHOICES_MAX: usize = 5_000;

/// A bond that is left out, for its docks do not meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenBond {
    /// The index of the bond in [`Robot::bonds`].
    pub bond: usize,
    /// The distance of its two docks, in pitches; 0 if they differ by a turn alone.
    pub gap: f64,
}

/// The reason why no choice of bonds makes a configuration a valid start.
#[derive(Clone, Debug, PartialEq)]
pub struct Unrepairable {
    /// The overlap that stays, with the bonds that force it, or the module that is not connected. Of overlaps it is
    /// one that every choice has, if there is one; else the first one of that choice which has the fewest.
    pub reason: InvalidStart,
    /// The number of choices that were tried.
    pub tried: usize,
    /// True if no choice is left untried that could be without overlap.
    pub complete: bool,
    /// True if the bonds of [`Unrepairable::reason`] are in every choice.
    pub forced: bool,
}

/// Opens the closed bonds whose docks do not meet, and returns them, ascending by their indices. Of bonds
/// that contradict each other those in the tree of a breadth-first search from module 0 count, unless only others leave
/// no overlap; at most [`CHOICES_MAX`] choices are tried.
///
/// # Errors
/// [`Unrepairable`]: the robot is not connected, or modules overlap in all choices that were tried; then nothing is
/// opened.
pub fn repair(robot: &mut Robot) -> Result<Vec<OpenBond>, Unrepairable> {
    let mut search = Search {
        robot: robot.clone(),
        avoided: Vec::new(),
        kept: vec![false; robot.bonds.len()],
        tried: 0,
        nearest: None,
    };
    let open = search.run()?;
    open.iter().for_each(|open| robot.undock(open.bond));
    Ok(open)
}

/// The state of the search for a choice without overlap.
struct Search {
    /// The configuration without the bonds that are avoided.
    robot: Robot,
    /// The bonds that are left out on purpose, in the order of the decisions.
    avoided: Vec<usize>,
    /// The flag of each bond: true if the choices without it were tried, so that it is to be kept.
    kept: Vec<bool>,
    tried: usize,
    /// The overlap of the choice with the fewest, and their number; `None` before the first.
    nearest: Option<(usize, InvalidStart)>,
}

/// A decision: one of these bonds is left out.
struct Decision {
    candidates: Vec<usize>,
    /// The number of candidates whose turn has come.
    next: usize,
}

/// The result of one choice.
enum Tried {
    /// No balls overlap; the bonds that do not meet, apart from those avoided.
    Free(Vec<usize>),
    /// Balls overlap; one of these bonds has to be left out, none of them if nothing helps.
    Blocked(Vec<usize>),
}

impl Search {
    /// Searches depth first, and returns the bonds to open.
    fn run(&mut self) -> Result<Vec<OpenBond>, Unrepairable> {
        let mut decisions: Vec<Decision> = Vec::new();
        loop {
            match self.choice()? {
                Tried::Free(mut open) => {
                    open.extend(&self.avoided);
                    open.sort_unstable();
                    return Ok(self.still_open(open));
                }
                Tried::Blocked(candidates) if candidates.is_empty() && decisions.is_empty() => {
                    return Err(self.gives_up(true, true));
                }
                Tried::Blocked(candidates) => decisions.push(Decision { candidates, next: 0 }),
            }
            if self.tried >= CHOICES_MAX {
                return Err(self.gives_up(false, false));
            }
            if !self.advance(&mut decisions) {
                return Err(self.gives_up(true, false));
            }
        }
    }

    /// Goes on to the next candidate of the last decision that has one; returns false if none has.
    fn advance(&mut self, decisions: &mut Vec<Decision>) -> bool {
        while let Some(decision) = decisions.last_mut() {
            if decision.next > 0 {
                // The candidate before had its turn: from now on it is kept.
                let before = decision.candidates[decision.next - 1];
                self.avoided.pop();
                self.robot.holds[before] = true;
                self.kept[before] = true;
            }
            if let Some(&bond) = decision.candidates.get(decision.next) {
                decision.next += 1;
                self.avoided.push(bond);
                self.robot.undock(bond);
                return true;
            }
            decision.candidates.iter().for_each(|&bond| self.kept[bond] = false);
            decisions.pop();
        }
        false
    }

    /// Tries the choice of the breadth-first tree without the bonds that are avoided.
    fn choice(&mut self) -> Result<Tried, Unrepairable> {
        crate::interrupt::checkpoint();
        self.tried += 1;
        let Some(tree) = Tree::grow(&self.robot, 0) else {
            let reason = InvalidStart::Disconnected(loose(&self.robot));
            return Err(Unrepairable { reason, tried: 1, complete: true, forced: true });
        };
        let mut poses = Vec::new();
        tree.poses(&self.robot.joints, &mut poses);
        let is_open = |bond: &usize| tree.residual(&self.robot, *bond, &poses) > TOLERANCES.closure;
        let open: Vec<usize> = tree.closing.iter().copied().filter(is_open).collect();
        // Docks that do not meet hold no balls at the distance of touching.
        let mut meeting = self.robot.clone();
        open.iter().for_each(|&bond| meeting.undock(bond));
        let overlaps = overlaps(&meeting, &tree, &poses);
        let Some(first) = overlaps.first() else { return Ok(Tried::Free(open)) };
        let questionable = questionable(&self.robot, &tree, &open);
        let candidates = |overlap: &Overlap| {
            let bonds = overlap.bonds(&tree).into_iter();
            bonds.filter(|&bond| questionable[bond] && !self.kept[bond]).collect::<Vec<usize>>()
        };
        // The overlap that leaves the least choice comes first.
        let mut narrowest = (candidates(first), first);
        for overlap in &overlaps[1..] {
            let own = candidates(overlap);
            if own.len() < narrowest.0.len() {
                narrowest = (own, overlap);
            }
        }
        if self.nearest.as_ref().is_none_or(|(fewest, _)| overlaps.len() < *fewest) {
            self.nearest = Some((overlaps.len(), narrowest.1.refusal(&tree)));
        }
        Ok(Tried::Blocked(narrowest.0))
    }

    /// Returns those bonds of a list that do not meet in the present choice; one that was avoided may meet after all.
    fn still_open(&self, bonds: Vec<usize>) -> Vec<OpenBond> {
        let tree = Tree::grow(&self.robot, 0).expect("the choice was tried");
        let mut poses = Vec::new();
        tree.poses(&self.robot.joints, &mut poses);
        let open = |bond: usize| {
            let ends = self.robot.bonds[bond];
            let [a, b] = [ends.a, ends.b].map(|dock| &poses[tree.index[dock.shoe()]]);
            let wanted = a.then(&mate(ends.a.face(), ends.turn, ends.b.face()));
            let is_open = tree.residual(&self.robot, bond, &poses) > TOLERANCES.closure;
            is_open.then(|| OpenBond { bond, gap: (wanted.translation - b.translation).norm() })
        };
        bonds.into_iter().filter_map(open).collect()
    }

    fn gives_up(&self, complete: bool, forced: bool) -> Unrepairable {
        let (_, reason) = self.nearest.clone().expect("the first choice has an overlap");
        Unrepairable { reason, tried: self.tried, complete, forced }
    }
}

/// Returns the flag of each bond: true if it is of a block with a bond of `open`, so that other bonds can take its place
/// with other poses.
fn questionable(robot: &Robot, tree: &Tree, open: &[usize]) -> Vec<bool> {
    // Disjoint-set forest over the bonds: those of one fundamental cycle are of one block.
    let mut block: Vec<usize> = (0..robot.bonds.len()).collect();
    fn root(block: &mut [usize], mut bond: usize) -> usize {
        while block[bond] != bond {
            block[bond] = block[block[bond]];
            bond = block[bond];
        }
        bond
    }
    for &closing in &tree.closing {
        let ends = robot.bonds[closing];
        let path = tree.path(tree.index[ends.a.shoe()], tree.index[ends.b.shoe()]);
        for step in path.indices.windows(2) {
            if let Some(bond) = tree.bond(step[0].max(step[1])) {
                let (a, b) = (root(&mut block, bond), root(&mut block, closing));
                block[a] = b;
            }
        }
    }
    let mut of_open = vec![false; block.len()];
    open.iter().for_each(|&bond| of_open[root(&mut block, bond)] = true);
    (0..block.len()).map(|bond| of_open[root(&mut block, bond)]).collect()
}
