//! Randomised search for sheets that unfold from one shape and fold into another with few changes of connections,
//! and the lower bound on these changes.
//!
//! Two layouts share a sheet where their patterns cover the same cells of the triangular lattice:
//! then no panel moves while connections change. The sheet grows cell by cell. A new cell is joined to
//! a neighbour across which both shapes go on, which is a connection that both layouts have; or, where
//! there is none, to one neighbour in the first shape and to another in the second, which is one
//! change. If growth is stuck, the rest of either shape is laid around what they have in common, and panels
//! go from the one sheet to the other. Growth begins anew with other choices among equals as long as the
//! budget lasts.

use super::face_groups::groups;
use super::lattice_sheet::{Corners, LatticeSheet, Point as Cell, Stroke, across, cell};
use super::rearrangement::{Goal, PanelSolids, rearranged};
use super::sheet_pairs::{Pair, spread};
use super::walks::walked;
use crate::optimize::random::SplitMix64;
use crate::planners::fold::Layout;
use crate::planners::fold::Observer;
use crate::planners::fold::Target;
use crate::planners::fold::sweep_collision::Solids;
use std::collections::{BTreeMap, BTreeSet};

/// The number of times that growth which is stuck takes panels away before it starts again.
const RETREATS: usize = 200;

/// The greatest number of pairs of sheets that are tried, those first that have the most in common.
const TRIED: usize = 24;

/// The greatest number of states that the search for one rearrangement expands.
const STEPS_MAX: usize = 400;
/// The greatest number of such states in all, times the number of panels.
const STEPS_IN_ALL_MAX: usize = 100_000;

/// The number of cells that walks of single panels examine in all: some seconds.
const WALKED_CELLS_MAX: usize = 20_000_000;

/// A refolding: two layouts, and the strokes by which the flat sheet of the first becomes that of the second.
#[derive(Clone, Debug)]
pub struct Refolding {
    /// The layout of the first shape. Panels are numbered as its faces; both layouts are rooted at one panel.
    pub from: Layout,
    /// The layout of the second shape, numbered as its own faces.
    pub to: Layout,
    /// The face of the second shape that each panel becomes, as an index, in the order of the first shape's faces.
    pub becomes: Vec<usize>,
    /// The turn (0 to 2) of each panel, in the order of the first shape's faces: its side k becomes side (k + turn) mod
    /// 3 of the face that it becomes.
    pub turns: Vec<usize>,
    /// The strokes in order; each makes a connection and undoes one.
    pub strokes: Vec<Stroke>,
}

impl Refolding {
    /// Returns the same sheets and strokes with both layouts rooted at another panel, given by its index in the first
    /// shape's faces; `from` and `to`: the two shapes. Panics if there is no such panel.
    pub fn rerooted(&self, from: &Target, to: &Target, panel: usize) -> Refolding {
        Refolding {
            from: self.from.rerooted(from, panel),
            to: self.to.rerooted(to, self.becomes[panel]),
            ..self.clone()
        }
    }

    /// Returns the side of a panel (0 to 2) that becomes `side` of its face of the second shape. Panics without such a
    /// panel.
    pub fn side(&self, panel: usize, side: usize) -> usize {
        (side + 3 - self.turns[panel]) % 3
    }
}

/// The result of [`sheets`]: the best refoldings found, with a lower bound on the changes.
#[derive(Clone, Debug)]
pub struct Found {
    /// The sheets found, at least one, all different: the fewest changes first, then the least cost.
    pub best: Vec<Refolding>,
    /// The lower bound on the number of connections that have to be made by any motion between the shapes.
    pub bound: usize,
}

/// The settings of [`sheets`].
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The greatest number of sides of panels examined for a next panel: one half for sheets, one for the bound.
    pub budget: u64,
    /// The seed of random choices among equals.
    pub seed: u64,
    /// The greatest number of sheets that are kept.
    pub kept: usize,
}

/// The reason why [`sheets`] found no refolding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRefolding {
    /// The shapes have different numbers of faces.
    Counts,
    /// No series of strokes between sheets of the two shapes was found within the budget, or before the observer ended
    /// the search.
    Budget {
        /// The number of lattice cells and connections that only one of the two nearest sheets has; `None` without two.
        apart: Option<usize>,
        /// The lower bound on the number of connections that any motion makes.
        bound: usize,
    },
}

/// Returns refoldings: sheets that unfold from `from` and fold into `to`, with the strokes between them. `cost` orders
/// those with equally many changes, least first; `solids`: by panel. All sides of both shapes must have one length.
///
/// # Errors
/// [`NoRefolding::Counts`] if the shapes differ in their number of faces, [`NoRefolding::Budget`] if none was found.
pub fn sheets(
    from: &Target,
    to: &Target,
    solids: &Solids,
    settings: &Settings,
    cost: impl Fn(&Refolding) -> f64,
    observer: &Observer,
) -> Result<Found, NoRefolding> {
    let n = from.faces.len();
    if n != to.faces.len() {
        return Err(NoRefolding::Counts);
    }
    // Random growth: pairs of sheets that have the most in common.
    let mut left = (settings.budget / 2).max(super::SIDES_MIN * n as u64);
    let mut random = Random(SplitMix64(settings.seed));
    let mut pairs: Vec<(usize, Pair)> = Vec::new();
    while left > 0 && observer.should_continue() {
        crate::interrupt::checkpoint();
        let mut sheet = Sheet::new(from, to);
        sheet.begin(random.below(n), random.below(n), random.below(3));
        let bias = random.below(3);
        let peak = sheet.grow(&mut random, bias, &mut left);
        let Some(found) = peak.pair(&mut random) else { continue };
        let apart = found.apart(from, to);
        if pairs.last().is_some_and(|last| pairs.len() == TRIED && last.0 <= apart) {
            continue;
        }
        if !pairs.iter().any(|(_, other)| *other == found) {
            let place = pairs.partition_point(|other| other.0 <= apart);
            pairs.insert(place, (apart, found));
            pairs.truncate(TRIED);
        }
    }
    // Strokes between the sheets of each pair, by best-first search.
    let (a, b) = (from.corners(0)[0], from.corners(0)[1]);
    let panels = PanelSolids { solids, side: (b - a).norm() };
    let mut best: Vec<(usize, f64, Refolding)> = Vec::new();
    let tried = (STEPS_IN_ALL_MAX / (STEPS_MAX * n)).max(1);
    for (_, pair) in pairs.iter().take(tried) {
        // One that is as good may cost less.
        let most = best.iter().map(|other| other.0 + 1).min().unwrap_or(usize::MAX);
        let series = |start: &LatticeSheet, goal: &Goal| rearranged(start, goal, panels, most, STEPS_MAX);
        if let Some(found) = pair.refolding(from, to, series) {
            best.push((found.strokes.len(), cost(&found), found));
        }
    }
    // Panels walk one by one, between all pairs, if none is found so.
    let mut cells_left = WALKED_CELLS_MAX;
    let walking = if best.is_empty() { &pairs[..] } else { &[] };
    for (_, pair) in walking.iter().filter(|_| observer.should_continue()) {
        let most = best.iter().map(|other| other.0 + 1).min().unwrap_or(usize::MAX);
        let left = &mut cells_left;
        if let Some(found) = pair.refolding(from, to, |start, goal| walked(start, goal, panels, most, left)) {
            best.push((found.strokes.len(), cost(&found), found));
        }
    }
    best.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    best.truncate(settings.kept);
    // The lower bound, with the other half of the budget.
    let least = best.first().map(|found| found.0);
    let bound = bound(from, to, least.unwrap_or(n), settings.budget / 2);
    if least.is_none() {
        return Err(NoRefolding::Budget { apart: pairs.first().map(|pair| pair.0), bound });
    }
    Ok(Found { best: best.into_iter().map(|(_, _, found)| found).collect(), bound })
}

/// A panel on the sheet.
#[derive(Clone, Copy)]
struct Placed {
    becomes: usize,
    turn: usize,
    /// The corners, in the order of the first shape's face.
    corners: Corners,
    /// The number in the order of placing.
    number: usize,
}

/// A sheet that grows.
#[derive(Clone)]
pub(super) struct Sheet<'t> {
    from: &'t Target,
    to: &'t Target,
    /// The placed panel of each face of the first shape.
    placed: Vec<Option<Placed>>,
    taken: Vec<bool>,
    cells: BTreeMap<Cell, usize>,
    /// All but the first panel, in the order of placing.
    grown: Vec<Choice>,
    first: usize,
}

/// A panel that may come next.
#[derive(Clone, Copy)]
struct Choice {
    face: usize,
    becomes: usize,
    turn: usize,
    corners: Corners,
    hinges: [usize; 2],
    changes: usize,
    /// The number of the neighbour in the order of placing.
    after: usize,
}

impl<'t> Sheet<'t> {
    fn new(from: &'t Target, to: &'t Target) -> Sheet<'t> {
        let n = from.faces.len();
        Sheet {
            from,
            to,
            placed: vec![None; n],
            taken: vec![false; n],
            cells: BTreeMap::new(),
            grown: Vec::new(),
            first: 0,
        }
    }

    /// Puts the first panel on the sheet.
    fn begin(&mut self, face: usize, becomes: usize, turn: usize) {
        self.first = face;
        self.put(face, Placed { becomes, turn, corners: [[0, 0], [1, 0], [0, 1]], number: 0 });
    }

    /// Puts the panel of a face of the first shape on the sheet.
    fn put(&mut self, face: usize, panel: Placed) {
        self.cells.insert(cell(&panel.corners), face);
        self.taken[panel.becomes] = true;
        self.placed[face] = Some(panel);
    }

    /// Returns the panel of a face of the first shape, which must be on the sheet.
    fn panel(&self, face: usize) -> Placed {
        self.placed[face].expect("only panels on the sheet are asked for")
    }

    /// Returns the face across a side in a shape, its side and the hinge; `None` at the boundary, and if the face is
    /// `gone`, on the sheet already.
    pub(super) fn beyond(
        target: &Target,
        face: usize,
        side: usize,
        gone: impl Fn(usize) -> bool,
    ) -> Option<[usize; 3]> {
        let index = target.sides[face][side]?;
        let hinge = &target.hinges[index];
        let end = usize::from(hinge.faces[0] == face && hinge.sides[0] == side);
        let other = hinge.faces[end];
        (!gone(other)).then_some([other, hinge.sides[end], index])
    }

    /// Returns the face across a side in the first shape, or `None`, as [`Sheet::beyond`] does.
    fn next_from(&self, face: usize, side: usize) -> Option<[usize; 3]> {
        Self::beyond(self.from, face, side, |other| self.placed[other].is_some())
    }

    /// Returns the face across a side of a panel in the second shape, or `None`, as [`Sheet::beyond`] does.
    fn next_to(&self, face: usize, side: usize) -> Option<[usize; 3]> {
        let panel = self.panel(face);
        Self::beyond(self.to, panel.becomes, (side + panel.turn) % 3, |other| self.taken[other])
    }

    /// Adds panels until all are on the sheet; when none fits, it takes some of the last away, at most [`RETREATS`]
    /// times. Returns the sheet with the most panels. `bias`: among equals the panel at the neighbour that was placed
    /// first (0), or last (1), or any of them is added.
    fn grow(&mut self, random: &mut Random, bias: usize, left: &mut u64) -> Sheet<'t> {
        let mut retreats = RETREATS;
        let mut peak = self.clone();
        while self.grown.len() + 1 < self.placed.len() {
            crate::interrupt::checkpoint();
            let choices = self.choices(left);
            let key = |choice: &Choice| match bias {
                0 => choice.after,
                1 => usize::MAX - choice.after,
                _ => 0,
            };
            let Some(least) = choices.iter().map(|c| (c.changes, key(c))).min() else {
                if self.grown.len() > peak.grown.len() {
                    peak = self.clone();
                }
                if retreats == 0 || *left == 0 || self.grown.is_empty() {
                    return peak;
                }
                retreats -= 1;
                for _ in 0..=random.below(self.grown.len()) {
                    self.take_back();
                }
                continue;
            };
            let equal: Vec<&Choice> = choices.iter().filter(|c| (c.changes, key(c)) == least).collect();
            let choice = *equal[random.below(equal.len())];
            let Choice { face, becomes, turn, corners, .. } = choice;
            self.put(face, Placed { becomes, turn, corners, number: self.grown.len() + 1 });
            self.grown.push(choice);
        }
        self.clone()
    }

    /// Takes the last panel away.
    fn take_back(&mut self) {
        if let Some(Choice { face, becomes, corners, .. }) = self.grown.pop() {
            self.lift(face, becomes, &corners);
        }
    }

    /// Takes a panel off the sheet.
    fn lift(&mut self, face: usize, becomes: usize, corners: &Corners) {
        self.placed[face] = None;
        self.taken[becomes] = false;
        self.cells.remove(&cell(corners));
    }

    /// Returns the panels that may come next.
    fn choices(&self, left: &mut u64) -> Vec<Choice> {
        let mut found = Vec::new();
        let panels: Vec<usize> = self.cells.values().copied().collect();
        for &face in &panels {
            for side in 0..3 {
                *left = left.saturating_sub(1);
                let ahead = across(&self.panel(face).corners, side);
                if self.cells.contains_key(&cell(&ahead)) {
                    continue;
                }
                let Some(next) = self.next_from(face, side) else { continue };
                let common = self.joined(face, next, ahead, face, side, 0);
                match common.filter(|c| c.changes == 0) {
                    Some(choice) => found.push(choice),
                    None => found.extend(self.changed(face, next, ahead)),
                }
            }
        }
        found
    }

    /// Returns the panel across a side in the first shape, on the cell ahead, joined in the second shape to another
    /// neighbour of that cell.
    fn changed(&self, face: usize, next: [usize; 3], ahead: Corners) -> Vec<Choice> {
        let mut found = Vec::new();
        for shift in 1..3 {
            let neighbour = cell(&across(&ahead, shift));
            let Some(&other) = self.cells.get(&neighbour) else { continue };
            let corners = self.panel(other).corners;
            let towards = (0..3).find(|k| cell(&across(&corners, *k)) == cell(&ahead));
            let side = towards.expect("neighbours have a common side");
            found.extend(self.joined(face, next, ahead, other, side, shift));
        }
        found
    }

    /// Returns the panel across a side of `face` in the first shape, on the cell ahead, which in the second shape is
    /// the face across `side` of `other`; `None` if that is on the sheet. `shift` is the cell's side towards `other`.
    fn joined(
        &self,
        face: usize,
        next: [usize; 3],
        ahead: Corners,
        other: usize,
        side: usize,
        shift: usize,
    ) -> Option<Choice> {
        let [new, own, hinge] = next;
        let [becomes, there, second] = self.next_to(other, side)?;
        // The panel's side `own` is the cell's side 0; its side towards `other` becomes `there`.
        let turn = (there + 6 - own - shift) % 3;
        let corners = [0, 1, 2].map(|k| ahead[(k + 3 - own) % 3]);
        let after = self.panel(face).number;
        let changes = usize::from(shift > 0);
        Some(Choice { face: new, becomes, turn, corners, hinges: [hinge, second], changes, after })
    }

    /// Returns the sheets of both shapes, each laid out around the common panels; `None` if one can't be.
    fn pair(&self, random: &mut Random) -> Option<Pair> {
        let n = self.placed.len();
        let mut first = vec![None; n];
        let mut second = vec![None; n];
        for (face, panel) in self.placed.iter().enumerate() {
            let Some(Placed { becomes, turn, corners, .. }) = panel else { continue };
            first[face] = Some(*corners);
            second[*becomes] = Some([0, 1, 2].map(|k| corners[(k + 3 - turn) % 3]));
        }
        let [from, to] = [0, 1].map(|shape| self.grown.iter().map(|c| c.hinges[shape]).collect::<Vec<_>>());
        let from = spread(self.from, first, from, &BTreeSet::new(), random)?;
        let to = spread(self.to, second, to, &from.cells(), random)?;
        Some(Pair { from, to })
    }
}

/// Returns the lower bound on the number of connections that have to be made, at most `most`. Those that both shapes
/// have join panels to pieces, each a part of a layout of either; the other connections of the second shape are made.
/// The search for so few pieces is exhaustive, as far as the steps reach.
fn bound(from: &Target, to: &Target, most: usize, budget: u64) -> usize {
    let mut left = budget;
    (0..most).find(|more| can_do_with(from, to, more + 1, &mut left)).unwrap_or(most)
}

/// Returns true if so many pieces suffice, and if the budget ends before that is known.
fn can_do_with(from: &Target, to: &Target, pieces: usize, left: &mut u64) -> bool {
    let n = to.faces.len();
    let mut search = PieceSearch { sheet: Sheet::new(from, to), closed: vec![[false; 3]; n], left };
    search.begun(n, pieces)
}

/// The search for pieces that both shapes have in common.
struct PieceSearch<'t, 'l> {
    sheet: Sheet<'t>,
    /// Sides of faces of the first shape across which no piece goes on.
    closed: Vec<[bool; 3]>,
    left: &'l mut u64,
}

impl PieceSearch<'_, '_> {
    /// Begins a piece with the first face that is in none; returns true if all faces get into pieces. The recursion is
    /// as deep as there are sides.
    fn begun(&mut self, missing: usize, pieces: usize) -> bool {
        if missing == 0 || *self.left == 0 {
            return true;
        }
        let Some(face) = self.sheet.placed.iter().position(Option::is_none).filter(|_| pieces > 0) else {
            return false;
        };
        // No piece reaches the next.
        let away = 4 * (missing * self.closed.len()) as i64;
        let corners = [[away, 0], [away + 1, 0], [away, 1]];
        for becomes in 0..self.closed.len() {
            if self.sheet.taken[becomes] {
                continue;
            }
            for turn in 0..3 {
                self.sheet.put(face, Placed { becomes, turn, corners, number: 0 });
                let found = self.grown(missing - 1, pieces - 1);
                self.sheet.lift(face, becomes, &corners);
                if found {
                    return true;
                }
            }
        }
        false
    }

    /// Returns the panel across a side of a panel in both shapes; `None` if they do not both go on there.
    fn choice(&self, face: usize, side: usize) -> Option<Choice> {
        let ahead = across(&self.sheet.panel(face).corners, side);
        if self.closed[face][side] || self.sheet.cells.contains_key(&cell(&ahead)) {
            return None;
        }
        let next = self.sheet.next_from(face, side)?;
        self.sheet.joined(face, next, ahead, face, side, 0)
    }

    /// Returns true if the faces that no panel can be continued to are no more groups than pieces are left, in either
    /// shape.
    fn can_reach(&self, pieces: usize) -> bool {
        let Sheet { from, to, placed, taken, .. } = &self.sheet;
        let sides = (0..placed.len()).flat_map(|face| (0..3).map(move |side| (face, side)));
        let ahead: Vec<Choice> = sides
            .filter(|(face, _)| placed[*face].is_some())
            .filter_map(|(f, s)| self.choice(f, s))
            .collect();
        let first = groups(from, |face| placed[face].is_some(), ahead.iter().map(|choice| choice.face));
        let second = groups(to, |face| taken[face], ahead.iter().map(|choice| choice.becomes));
        first.max(second) <= pieces
    }

    /// Goes on with the first hinge that both shapes have, over it or never over it; returns true if all faces get into
    /// pieces.
    fn grown(&mut self, missing: usize, pieces: usize) -> bool {
        crate::interrupt::checkpoint();
        if !self.can_reach(pieces) {
            return false;
        }
        for face in 0..self.closed.len() {
            if self.sheet.placed[face].is_none() {
                continue;
            }
            for side in 0..3 {
                *self.left = self.left.saturating_sub(1);
                let Some(choice) = self.choice(face, side) else { continue };
                let Choice { face: new, becomes, turn, corners, .. } = choice;
                self.sheet.put(new, Placed { becomes, turn, corners, number: 0 });
                let found = missing == 1 || *self.left == 0 || self.grown(missing - 1, pieces);
                self.sheet.lift(new, becomes, &corners);
                if found {
                    return true;
                }
                self.closed[face][side] = true;
                let found = self.grown(missing, pieces);
                self.closed[face][side] = false;
                return found;
            }
        }
        self.begun(missing, pieces)
    }
}

/// Random choices among few, by the remainder, whose bias is negligible for so few.
pub(super) struct Random(SplitMix64);

impl Random {
    /// Returns a number below a limit.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        (self.0.next_u64() % limit as u64) as usize
    }
}
