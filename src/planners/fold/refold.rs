//! From one shape to another through a flat sheet that unfolds from the first and folds into the
//! second, with as few changes of connections in the plane as are found.
//!
//! Two layouts share a sheet where their patterns cover the same cells of the triangular lattice:
//! then no panel moves while connections change. The sheet grows cell by cell. A new cell is joined to
//! a neighbour across which both shapes go on, which is a connection that both layouts have; or, where
//! there is none, to one neighbour in the first shape and to another in the second, which is one
//! change. Growth begins anew with other choices among equals as long as the budget lasts. Whether it
//! can do without any change is also searched exhaustively.

use super::layout::Layout;
use super::target::Target;
use std::collections::BTreeMap;

/// How often growth that is stuck takes panels away before it begins anew.
const RETREATS: usize = 200;

/// Two layouts on one sheet.
#[derive(Clone, Debug)]
pub struct Refolding {
    /// Panels are numbered as the faces of the first shape. Both hang at the same panel.
    pub from: Layout,
    pub to: Layout,
    /// By panel: the face of the second shape that it becomes.
    pub becomes: Vec<usize>,
    /// By panel: its side k becomes the second shape's side (k + turn) mod 3.
    pub turns: Vec<usize>,
    /// How many connections are undone, and as many made.
    pub changes: usize,
}

impl Refolding {
    /// Both layouts hung up at another panel.
    pub fn rerooted(&self, from: &Target, to: &Target, panel: usize) -> Refolding {
        Refolding {
            from: self.from.rerooted(from, panel),
            to: self.to.rerooted(to, self.becomes[panel]),
            ..self.clone()
        }
    }

    /// The side of a panel that becomes a side of its face of the second shape.
    pub fn side(&self, panel: usize, side: usize) -> usize {
        (side + 3 - self.turns[panel]) % 3
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The fewest changes first, then what the order says that was asked for; all different.
    pub best: Vec<Refolding>,
    /// No sheet needs fewer changes.
    pub bound: usize,
}

/// How long to search.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Cells weighed in all; half of it goes into the proof that a change is needed.
    pub budget: u64,
    pub seed: u64,
    /// Sheets that are kept.
    pub kept: usize,
}

/// Why nothing was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRefolding {
    /// The shapes have different numbers of faces.
    Counts,
    /// No sheet was found that both shapes unfold into.
    Budget,
}

/// Sheets that unfold from `from` and fold into `to`. `cost` orders those with equally many changes.
pub fn sheets(
    from: &Target,
    to: &Target,
    settings: &Settings,
    cost: impl Fn(&Refolding) -> f64,
) -> Result<Found, NoRefolding> {
    let n = from.faces.len();
    if n != to.faces.len() {
        return Err(NoRefolding::Counts);
    }
    let mut left = settings.budget / 2;
    let mut random = Random(settings.seed);
    let mut best: Vec<(usize, f64, Refolding)> = Vec::new();
    while left > 0 {
        crate::interrupt::checkpoint();
        let mut sheet = Sheet::new(from, to);
        sheet.begin(random.below(n), random.below(n), random.below(3));
        let bias = random.below(3);
        if !sheet.grow(&mut random, bias, &mut left) {
            continue;
        }
        let found = sheet.finish();
        if best.last().is_some_and(|last| best.len() == settings.kept && last.0 < found.changes) {
            continue;
        }
        let price = cost(&found);
        let known = |other: &(usize, f64, Refolding)| {
            other.2.from.hinges() == found.from.hinges() && other.2.becomes == found.becomes
        };
        if !best.iter().any(known) {
            best.push((found.changes, price, found));
            best.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            best.truncate(settings.kept);
        }
    }
    let least = best.first().ok_or(NoRefolding::Budget)?.0;
    let bound = usize::from(least > 0 && !can_do_without(from, to, settings.budget / 2));
    Ok(Found { best: best.into_iter().map(|(_, _, found)| found).collect(), bound })
}

type Cell = [i64; 2];
type Corners = [Cell; 3];

/// The sum of the corners is a name for the cell.
fn cell(corners: &Corners) -> Cell {
    [0, 1].map(|k| corners.iter().map(|c| c[k]).sum())
}

/// The cell across side `k`, its first side the common one.
fn across(corners: &Corners, k: usize) -> Corners {
    let (a, b, c) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
    [b, a, [a[0] + b[0] - c[0], a[1] + b[1] - c[1]]]
}

/// A panel on the sheet.
#[derive(Clone, Copy)]
struct Placed {
    becomes: usize,
    turn: usize,
    /// In the order of the first shape's face.
    corners: Corners,
    /// In the order of placing.
    number: usize,
}

/// A sheet that grows.
struct Sheet<'t> {
    from: &'t Target,
    to: &'t Target,
    /// By face of the first shape.
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
    /// When the neighbour was placed.
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

    fn begin(&mut self, face: usize, becomes: usize, turn: usize) {
        self.first = face;
        self.put(face, Placed { becomes, turn, corners: [[0, 0], [1, 0], [0, 1]], number: 0 });
    }

    fn put(&mut self, face: usize, panel: Placed) {
        self.cells.insert(cell(&panel.corners), face);
        self.taken[panel.becomes] = true;
        self.placed[face] = Some(panel);
    }

    fn panel(&self, face: usize) -> Placed {
        self.placed[face].expect("only panels on the sheet are asked for")
    }

    /// What lies across a side in a shape, if it is not on the sheet: the face, its side, the hinge.
    fn beyond(target: &Target, face: usize, side: usize, gone: impl Fn(usize) -> bool) -> Option<[usize; 3]> {
        let index = target.sides[face][side]?;
        let hinge = &target.hinges[index];
        let end = usize::from(hinge.faces[0] == face && hinge.sides[0] == side);
        let other = hinge.faces[end];
        (!gone(other)).then_some([other, hinge.sides[end], index])
    }

    fn next_from(&self, face: usize, side: usize) -> Option<[usize; 3]> {
        Self::beyond(self.from, face, side, |other| self.placed[other].is_some())
    }

    fn next_to(&self, face: usize, side: usize) -> Option<[usize; 3]> {
        let panel = self.panel(face);
        Self::beyond(self.to, panel.becomes, (side + panel.turn) % 3, |other| self.taken[other])
    }

    /// Adds panels until all are on the sheet; where it gets stuck it takes some of the last away, a
    /// few times. `bias`: among equals the first placed neighbour (0), the last (1), or any.
    fn grow(&mut self, random: &mut Random, bias: usize, left: &mut u64) -> bool {
        let mut retreats = RETREATS;
        while self.grown.len() + 1 < self.placed.len() {
            crate::interrupt::checkpoint();
            let choices = self.choices(left);
            let key = |choice: &Choice| match bias {
                0 => choice.after,
                1 => usize::MAX - choice.after,
                _ => 0,
            };
            let Some(least) = choices.iter().map(|c| (c.changes, key(c))).min() else {
                if retreats == 0 || *left == 0 || self.grown.is_empty() {
                    return false;
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
        true
    }

    fn take_back(&mut self) {
        if let Some(Choice { face, becomes, corners, .. }) = self.grown.pop() {
            self.lift(face, becomes, &corners);
        }
    }

    fn lift(&mut self, face: usize, becomes: usize, corners: &Corners) {
        self.placed[face] = None;
        self.taken[becomes] = false;
        self.cells.remove(&cell(corners));
    }

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

    /// The panel across a side in the first shape, on the cell ahead, joined in the second shape to
    /// another neighbour of that cell.
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

    /// The panel across a side of `face` in the first shape, on the cell ahead, which in the second
    /// shape is what lies across `side` of `other`; `shift` is the cell's side towards that.
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

    fn finish(self) -> Refolding {
        let panel = |face: usize| self.placed[face].expect("all are on the sheet");
        let n = self.placed.len();
        let becomes: Vec<usize> = (0..n).map(|face| panel(face).becomes).collect();
        let [from, to] = [0, 1].map(|shape| self.grown.iter().map(|c| c.hinges[shape]).collect::<Vec<_>>());
        let tree = "a sheet grows as a tree";
        Refolding {
            from: Layout::of_hinges(self.from, &from, self.first).expect(tree),
            to: Layout::of_hinges(self.to, &to, becomes[self.first]).expect(tree),
            turns: (0..n).map(|face| panel(face).turn).collect(),
            becomes,
            changes: self.grown.iter().map(|c| c.changes).sum(),
        }
    }
}

/// Whether both shapes have a layout in common, as far as the steps reach: `true` also where they do
/// not suffice.
fn can_do_without(from: &Target, to: &Target, mut left: u64) -> bool {
    let n = to.faces.len();
    (0..n).any(|face| {
        (0..3).any(|turn| {
            let mut sheet = Sheet::new(from, to);
            sheet.begin(0, face, turn);
            let mut closed = vec![[false; 3]; n];
            common(&mut sheet, &mut closed, n - 1, &mut left)
        })
    })
}

/// Goes on with the first hinge that both shapes have: over it, or never over it. As deep as there are
/// sides.
fn common(sheet: &mut Sheet, closed: &mut [[bool; 3]], missing: usize, left: &mut u64) -> bool {
    if missing == 0 || *left == 0 {
        return true;
    }
    for face in 0..closed.len() {
        let Some(panel) = sheet.placed[face] else { continue };
        for side in 0..3 {
            *left = left.saturating_sub(1);
            let ahead = across(&panel.corners, side);
            if closed[face][side] || sheet.cells.contains_key(&cell(&ahead)) {
                continue;
            }
            let Some(next) = sheet.next_from(face, side) else { continue };
            let Some(choice) = sheet.joined(face, next, ahead, face, side, 0) else { continue };
            let Choice { face: new, becomes, turn, corners, .. } = choice;
            sheet.put(new, Placed { becomes, turn, corners, number: 0 });
            if common(sheet, closed, missing - 1, left) {
                return true;
            }
            sheet.lift(new, becomes, &corners);
            closed[face][side] = true;
            let found = common(sheet, closed, missing, left);
            closed[face][side] = false;
            return found;
        }
    }
    false
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((x ^ (x >> 31)) % limit as u64) as usize
    }
}
