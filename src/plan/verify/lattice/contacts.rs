//! Which cells hang together, and what their contacts carry.
//!
//! Contacts that last a whole stage are joined to trees. In a tree the forces are unique: over a
//! contact goes what accelerates the cells behind it. That is the force certificate: summed over the
//! contacts of a cell it gives the cell's own acceleration, exactly, for it is made of the same whole
//! numbers.

use super::grid::Cube;

/// Cells joined by contacts; a forest, with union and find.
#[derive(Clone)]
pub struct Forest {
    above: Vec<u32>,
    /// The contacts that joined two trees.
    pub links: Vec<(u32, u32)>,
    /// Greatest difference of a displacement along an axis over a contact, twice, in lines.
    pub parting: i64,
    /// The contact with that difference.
    pub parted: (u32, u32),
}

/// A cell while forces are handed on from the leaves.
#[derive(Clone, Copy)]
struct Knot {
    /// Twice the sum of the displacements of the cell and of those behind it, in lines.
    behind: i128,
    /// How many links it still has.
    degree: u32,
    /// The numbers of those that it is linked to in one: of a leaf it is the neighbour.
    neighbours: u32,
}

impl Forest {
    pub fn new(count: usize) -> Forest {
        Forest {
            above: (0..count as u32).collect(),
            links: Vec::with_capacity(count.saturating_sub(1)),
            parting: 0,
            parted: (0, 0),
        }
    }

    fn root(&mut self, cell: u32) -> u32 {
        let mut at = cell as usize;
        while self.above[at] as usize != at {
            self.above[at] = self.above[self.above[at] as usize];
            at = self.above[at] as usize;
        }
        at as u32
    }

    /// Records a contact that lasts the stage. Its cells move against each other by `parting`, twice, at
    /// most along an axis.
    pub fn touch(&mut self, a: u32, b: u32, parting: i64) {
        if parting > self.parting {
            (self.parting, self.parted) = (parting, (a, b));
        }
        let (p, q) = (self.root(a), self.root(b));
        if p != q {
            // The lower number leads, so that long chains stay flat.
            self.above[p.max(q) as usize] = p.min(q);
            self.links.push((a, b));
        }
    }

    /// Sizes of the pieces, largest first, each with its first cell.
    pub fn pieces(&mut self) -> Vec<(usize, u32)> {
        let mut sizes = vec![0_usize; self.above.len()];
        for cell in 0..self.above.len() as u32 {
            let root = self.root(cell);
            sizes[root as usize] += 1;
        }
        let mut pieces: Vec<(usize, u32)> = sizes
            .iter()
            .enumerate()
            .filter(|(_, size)| **size > 0)
            .map(|(i, size)| (*size, i as u32))
            .collect();
        pieces.sort_by_key(|&(size, cell)| (std::cmp::Reverse(size), cell));
        pieces
    }

    pub fn is_whole(&self) -> bool {
        self.links.len() + 1 >= self.above.len()
    }

    /// The greatest force along an axis that a link of the forest carries, with that link: twice the
    /// sum of displacements, in lines, of the cells behind it. An error names the sum that is left
    /// over at a root: then something outside would have to push.
    pub fn forces(&self, before: &[Cube], after: &[Cube], axis: usize) -> Result<(i128, (u32, u32)), i128> {
        let moved = |(old, new): (&Cube, &Cube)| Knot {
            behind: i128::from(new.middle(axis) - old.middle(axis)),
            degree: 0,
            neighbours: 0,
        };
        let mut knots: Vec<Knot> = before.iter().zip(after).map(moved).collect();
        for &(a, b) in &self.links {
            let [p, q] = [a, b].map(|cell| cell as usize);
            knots[p].degree += 1;
            knots[p].neighbours ^= b;
            knots[q].degree += 1;
            knots[q].neighbours ^= a;
        }
        let mut worst = (0, (0, 0));
        for leaf in 0..knots.len() {
            let mut at = leaf;
            while knots[at].degree == 1 {
                let Knot { behind: force, neighbours: next, .. } = knots[at];
                if force.abs() > worst.0 {
                    worst = (force.abs(), (at as u32, next));
                }
                knots[at] = Knot { behind: 0, degree: 0, neighbours: 0 };
                let next = next as usize;
                knots[next].behind += force;
                knots[next].degree -= 1;
                knots[next].neighbours ^= at as u32;
                at = next;
            }
        }
        // What was not handed on is left at the roots.
        match knots.iter().find(|knot| knot.behind != 0) {
            Some(knot) => Err(knot.behind),
            None => Ok(worst),
        }
    }
}
