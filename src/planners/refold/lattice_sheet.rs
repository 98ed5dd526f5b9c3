//! A sheet of panels on the triangular lattice, joined as a tree, and its moves: fans about a point that close on
//! one side and open on another.
//!
//! Three to five panels that follow each other about a point close to a regular corner when all hinges
//! between them fold by the same angle: those of the tetrahedron, the octahedron, the icosahedron. Then the
//! free sides of the first and the last meet. They are joined, some other two let go of each other, and the
//! fan opens there: the panels attached to the one have gone to the other end. Six panels close without
//! folding: then only a connection changes. Either is a [`Stroke`]: one connection made, one undone.

use crate::geometry::{Pose, Vec3};
use crate::planners::fold::kinematics::about;
use crate::planners::fold::sweep_collision::{Solids, panel_pose};
use std::collections::{BTreeMap, BTreeSet};

/// A point of the triangular lattice, in whole numbers of its two steps, which have the length of a panel's side and
/// enclose 60°.
pub type Point = [i64; 2];

/// The corners of a panel on the lattice, counterclockwise: its side k runs from corner k to the next.
pub type Corners = [Point; 3];

/// A side of a panel: the index of the panel, from 0, and the number of the side, 0 to 2.
pub type Side = (usize, usize);

/// The number of states of a stroke that are sampled in each direction.
const SAMPLES: usize = 12;

/// The numbers of panels of a fan: fewer do not close, and more need not fold.
const FAN: [usize; 3] = [3, 4, 5];

/// A stroke of a flat sheet: it makes one connection between two sides of panels and undoes another, and folds a fan of
/// panels for it where the two sides do not lie at each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// The connections that fold from level to `angle` before the change, and open again after it; the one that is
    /// undone does not open, and the one that is made does. Empty if nothing folds.
    pub fold: Vec<[Side; 2]>,
    /// The fold angle of those connections, rad, positive or negative for the side to which the fan folds; 0 if
    /// nothing folds.
    pub angle: f64,
    /// The connection that the stroke makes.
    pub make: [Side; 2],
    /// The connection that the stroke undoes.
    pub cut: [Side; 2],
    /// The panels, by index, that lie elsewhere after the stroke, with their corners there.
    pub moved: Vec<(usize, Corners)>,
}

/// Returns the name of the lattice cell that a panel with these corners covers: the sum of the corners, which no two
/// cells share.
pub fn cell(corners: &Corners) -> Point {
    [0, 1].map(|k| corners.iter().map(|c| c[k]).sum())
}

/// Returns the corners of the lattice cell across side `k` (0 to 2) of a panel with these corners, counterclockwise,
/// numbered so that its side 0 is the common one. Panics for a side above 2.
pub fn across(corners: &Corners, k: usize) -> Corners {
    let (a, b, c) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
    [b, a, [a[0] + b[0] - c[0], a[1] + b[1] - c[1]]]
}

/// Returns a point turned about a point of the lattice by sixths of a turn, counterclockwise.
pub fn turned(point: Point, about: Point, sixths: usize) -> Point {
    let away = [point[0] - about[0], point[1] - about[1]];
    let [i, j] = (0..sixths % 6).fold(away, |[i, j], _| [-j, i + j]);
    [about[0] + i, about[1] + j]
}

/// Returns the connection of two sides of panels, the lesser side first.
pub fn bond(a: Side, b: Side) -> [Side; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// A flat sheet of equilateral panels on the triangular lattice, whose connections make a tree.
#[derive(Clone, Debug)]
pub struct LatticeSheet {
    /// The corners of each panel on the lattice, by its index.
    pub corners: Vec<Corners>,
    /// The index of the panel on each cell that is covered, by the cell's name ([`cell`]).
    pub cells: BTreeMap<Point, usize>,
    /// The connections of sides, as by [`bond`], which make a tree of the panels.
    pub bonds: BTreeSet<[Side; 2]>,
}

impl LatticeSheet {
    /// Returns the sheet of panels with these corners, by their index, which must be on different cells, joined by
    /// `bonds` (as by [`bond`]), which must be a tree of neighbours.
    pub fn new(corners: Vec<Corners>, bonds: BTreeSet<[Side; 2]>) -> LatticeSheet {
        let cells = corners.iter().enumerate().map(|(panel, corners)| (cell(corners), panel)).collect();
        LatticeSheet { corners, cells, bonds }
    }

    /// Returns the side of another panel that lies at a side of a panel, connected or not; `None` if the lattice cell
    /// there is free. Panics if there is no such panel or side.
    pub fn beside(&self, (panel, side): Side) -> Option<Side> {
        let ahead = across(&self.corners[panel], side);
        let other = *self.cells.get(&cell(&ahead))?;
        let side = (0..3).find(|k| self.corners[other][*k] == ahead[0]).expect("a common side");
        Some((other, side))
    }

    /// Returns the sides of a panel that are joined as (side, the side that it is joined to), ascending by the number
    /// of the side.
    pub fn joined(&self, panel: usize) -> impl Iterator<Item = (Side, Side)> + '_ {
        (0..3).filter_map(move |side| {
            let other = self.beside((panel, side))?;
            self.bonds.contains(&bond((panel, side), other)).then_some(((panel, side), other))
        })
    }

    /// Returns the connections on the path in the tree between two panels, that at `to` first; empty for the same
    /// panel. `from` and `to`: the indices of the panels. Panics if there is no such panel.
    pub fn path(&self, from: usize, to: usize) -> Vec<[Side; 2]> {
        let mut before: Vec<Option<(usize, [Side; 2])>> = vec![None; self.corners.len()];
        let mut queue = std::collections::VecDeque::from([from]);
        while let Some(panel) = queue.pop_front() {
            for (own, other) in self.joined(panel) {
                if other.0 != from && before[other.0].is_none() {
                    before[other.0] = Some((panel, bond(own, other)));
                    queue.push_back(other.0);
                }
            }
        }
        let mut path = Vec::new();
        let mut at = to;
        while let Some((panel, bond)) = before[at] {
            path.push(bond);
            at = panel;
        }
        path
    }

    /// Returns the panels that are joined one to the next about a corner of a panel, counterclockwise, itself
    /// first, each with the corner's number; five at most.
    fn fan(&self, panel: usize, corner: usize) -> Vec<(usize, usize)> {
        let mut fan = vec![(panel, corner)];
        while fan.len() < FAN[2] {
            let (last, corner) = fan[fan.len() - 1];
            let own = (last, onward(corner));
            let Some(next) = self.beside(own).filter(|next| self.bonds.contains(&bond(own, *next))) else {
                break;
            };
            // The common side begins with the corner, seen from the next.
            fan.push(next);
        }
        fan
    }

    /// Returns true if a side is joined to another.
    fn is_joined(&self, side: Side) -> bool {
        self.beside(side).is_some_and(|other| self.bonds.contains(&bond(side, other)))
    }

    /// Returns the panels that are connected with `from` without the connection `without`.
    pub fn part(&self, from: usize, without: &[Side; 2]) -> BTreeSet<usize> {
        let (mut part, mut stack) = (BTreeSet::from([from]), vec![from]);
        while let Some(panel) = stack.pop() {
            for (own, other) in self.joined(panel) {
                if bond(own, other) != *without && part.insert(other.0) {
                    stack.push(other.0);
                }
            }
        }
        part
    }

    /// Returns every stroke that closes a fan of three to five panels whose outer sides are not joined, undoes one of
    /// its connections, and leaves no two panels on one cell; since that divides the sheet, once for each part that
    /// may move. Collisions on the way are not checked: see [`LatticeSheet::is_free`].
    pub fn pivots(&self) -> Vec<Stroke> {
        let mut found = Vec::new();
        for panel in 0..self.corners.len() {
            for corner in 0..3 {
                let whole = self.fan(panel, corner);
                for count in FAN.into_iter().filter(|count| *count <= whole.len()) {
                    self.closed(&whole[..count], &mut found);
                }
            }
        }
        found
    }

    /// Returns the stroke that closes the fan of these panels, each with the number of the corner about which they follow each other
    /// counterclockwise, and in which the panel `leaf` alone goes to its other end; `None` if there is none.
    pub fn walk(&self, fan: &[(usize, usize)], leaf: usize) -> Option<Stroke> {
        let mut found = Vec::new();
        self.closed(fan, &mut found);
        found.into_iter().find(|stroke| matches!(stroke.moved[..], [(panel, _)] if panel == leaf))
    }

    /// Adds the strokes that close a fan.
    fn closed(&self, fan: &[(usize, usize)], found: &mut Vec<Stroke>) {
        let (first, corner) = fan[0];
        let (last, last_corner) = fan[fan.len() - 1];
        let ends = [(last, onward(last_corner)), (first, corner)];
        if ends.iter().any(|side| self.is_joined(*side)) {
            return;
        }
        let about = self.corners[first][corner];
        let fold: Vec<[Side; 2]> =
            fan.windows(2).map(|two| bond((two[0].0, onward(two[0].1)), two[1])).collect();
        for (i, cut) in fold.iter().enumerate() {
            // The part before the cut goes on around the point, or the part behind it goes back.
            for (end, sixths) in [(fan[i].0, fan.len()), (fan[i + 1].0, 6 - fan.len())] {
                let part = self.part(end, cut);
                let moved: Vec<(usize, Corners)> =
                    part.iter().map(|p| (*p, self.corners[*p].map(|c| turned(c, about, sixths)))).collect();
                let is_free = |c: &Corners| self.cells.get(&cell(c)).is_none_or(|other| part.contains(other));
                if moved.iter().all(|(_, corners)| is_free(corners)) {
                    let (angle, make) = (closing(fan.len()), bond(ends[0], ends[1]));
                    found.push(Stroke { fold: fold.clone(), angle, make, cut: *cut, moved });
                }
            }
        }
    }

    /// Returns the pairs of sides that lie at each other and are not joined, as by [`bond`], in ascending order.
    pub fn open(&self) -> Vec<[Side; 2]> {
        let sides = (0..self.corners.len()).flat_map(|panel| (0..3).map(move |side| (panel, side)));
        let pairs = sides.filter_map(|own| Some([own, self.beside(own)?]));
        pairs.filter(|[a, b]| a < b && !self.bonds.contains(&[*a, *b])).collect()
    }

    /// Returns the stroke without folding that joins two sides that lie at each other and undoes one of the connections
    /// of the cycle that this closes: that of least `worth`; of equal ones that nearest to `make[1]`. Panics for two
    /// sides of one panel.
    pub fn change(&self, make: [Side; 2], worth: impl Fn(&[Side; 2]) -> usize) -> Stroke {
        let ring = self.path(make[0].0, make[1].0);
        let cut = ring.into_iter().min_by_key(|bond| worth(bond)).expect("a tree joins any two");
        Stroke { fold: Vec::new(), angle: 0.0, make, cut, moved: Vec::new() }
    }

    /// Applies a stroke of this sheet: changes the connection, and puts the panels that move on their cells.
    pub fn apply(&mut self, stroke: &Stroke) {
        self.bonds.remove(&stroke.cut);
        self.bonds.insert(stroke.make);
        for (panel, _) in &stroke.moved {
            self.cells.remove(&cell(&self.corners[*panel]));
        }
        for (panel, corners) in &stroke.moved {
            self.cells.insert(cell(corners), *panel);
            self.corners[*panel] = *corners;
        }
    }

    /// Returns true if no sample of a stroke of this sheet shows a collision, while the fan closes and opens again.
    /// `solids`: the collision parts of the panels, by index; `side`: the length of the panels' sides, m. The panels
    /// that touch where the fan is closed may do so.
    pub fn is_free(&self, stroke: &Stroke, solids: &Solids, side: f64) -> bool {
        if stroke.fold.is_empty() {
            return true;
        }
        let mut after = self.clone();
        after.apply(stroke);
        let opening: Vec<[Side; 2]> = stroke.fold.iter().filter(|b| **b != stroke.cut).copied().collect();
        let opening = [opening, vec![stroke.make]].concat();
        [(self, &stroke.fold), (&after, &opening)].iter().all(|(plane, bonds)| {
            (1..=SAMPLES).all(|i| {
                crate::interrupt::checkpoint();
                let angle = stroke.angle * i as f64 / SAMPLES as f64;
                // If the fan is closed, its ends touch along the sides that meet.
                let ends = [stroke.make, stroke.cut].map(|b| b.map(|side| side.0));
                plane.is_apart(&plane.poses(bonds, angle, side), solids, side, &ends)
            })
        })
    }

    /// Returns the displacements of the panels with some hinges folded; the first panel stays.
    fn poses(&self, bonds: &[[Side; 2]], angle: f64, side: f64) -> Vec<Pose> {
        let mut poses = vec![Pose::identity(); self.corners.len()];
        let mut seen = vec![false; self.corners.len()];
        let mut stack = vec![0];
        seen[0] = true;
        while let Some(panel) = stack.pop() {
            for (own, other) in self.joined(panel) {
                if std::mem::replace(&mut seen[other.0], true) {
                    continue;
                }
                poses[other.0] = poses[panel];
                if bonds.contains(&bond(own, other)) {
                    let [a, b] = [own.1, (own.1 + 1) % 3].map(|k| metric(self.corners[panel][k], side));
                    poses[other.0] *= about(&a, (b - a).normalize(), angle);
                }
                stack.push(other.0);
            }
        }
        poses
    }

    /// Returns true if no two panels collide, of those that have moved; `touching`: pairs that may touch.
    fn is_apart(&self, poses: &[Pose], solids: &Solids, side: f64, touching: &[[usize; 2]]) -> bool {
        let places: Vec<Pose> = self
            .corners
            .iter()
            .zip(poses)
            .map(|(corners, pose)| pose * panel_pose(&corners.map(|p| metric(p, side)), &Vec3::z()))
            .collect();
        let allowed = |a: usize, b: usize| {
            touching.contains(&[a, b])
                || touching.contains(&[b, a])
                || self.joined(a).any(|(_, other)| other.0 == b)
        };
        let lies = |panel: usize| poses[panel] == Pose::identity();
        (0..places.len()).all(|b| {
            (0..b).all(|a| {
                let away = (places[a].translation.vector - places[b].translation.vector).norm();
                (lies(a) && lies(b))
                    || away > 1.2 * side
                    || allowed(a, b)
                    || !solids.meet([a, b], &(places[a].inverse() * places[b]))
            })
        })
    }
}

/// Returns the side of a panel that follows about a corner, counterclockwise.
fn onward(corner: usize) -> usize {
    (corner + 2) % 3
}

/// Returns the angle by which the hinges of a fan of panels fold until it is closed, rad: that of the tetrahedron,
/// the octahedron, the icosahedron.
fn closing(panels: usize) -> f64 {
    libm::acos(match panels {
        3 => -1.0 / 3.0,
        4 => 1.0 / 3.0,
        _ => libm::sqrt(5.0) / 3.0,
    })
}

/// Returns a point of the lattice in metres; `side`: the side of the panels, m.
fn metric([i, j]: Point, side: f64) -> Vec3 {
    Vec3::new(side * (i as f64 + 0.5 * j as f64), side * libm::sqrt(0.75) * j as f64, 0.0)
}
