//! Connectedness of cells by contacts, and the contact forces of a spanning forest.
//!
//! Contacts that last a whole stage are joined to trees by union and find. In a tree the contact forces are
//! statically determinate: a contact carries the force that accelerates the cells on its far side. That is the force
//! certificate: summed over the contacts of a cell it gives the cell's own acceleration, exactly, because it is made
//! of the same integers.

use super::grid::Cube;

/// A spanning forest of the contact graph of cells, kept by union and find (Tarjan 1975).
#[derive(Clone)]
pub struct ContactForest {
    /// The union-find parent of each cell.
    above: Vec<u32>,
    /// The edges of the forest, as pairs of numbers of cells: contacts that joined two trees.
    pub links: Vec<(u32, u32)>,
    /// Twice the greatest relative displacement of two cells in contact along an axis, in grid lines.
    pub relative: i64,
    /// The numbers of the two cells in contact with the greatest relative displacement, the one that
    /// [`ContactForest::relative`] states; (0, 0) if nothing moves.
    pub fastest: (u32, u32),
    /// True if only docked contacts count: those in which the middles of two faces meet and stay together, where the
    /// connectors of cells that do not slide are.
    docked: bool,
}

/// A cell while forces are passed on from the leaves.
#[derive(Clone, Copy)]
struct ForceNode {
    /// Twice the sum of the displacements of the cell and of the leaves that were removed at it, in grid lines.
    behind: i128,
    /// Number of edges that are not removed yet.
    degree: u32,
    /// Exclusive or of the numbers of its neighbours: for a leaf the number of its only neighbour.
    neighbours: u32,
}

impl ContactForest {
    /// Returns the forest of `count` cells, numbered from 0, without contacts.
    pub fn new(count: usize) -> ContactForest {
        ContactForest {
            above: (0..count as u32).collect(),
            links: Vec::with_capacity(count.saturating_sub(1)),
            relative: 0,
            fastest: (0, 0),
            docked: false,
        }
    }

    /// Returns the forest of `count` cells without contacts, of which it takes all if the cells `slide`, else the docked
    /// ones: those over the middles of two faces, which stay together.
    pub fn of_cells(count: usize, slide: bool) -> ContactForest {
        ContactForest { docked: !slide, ..ContactForest::new(count) }
    }

    /// Adds a contact over faces that lasts the stage if it is one of those that count; `before` and `after` are the
    /// cells by number at its ends, and `relative` is that of [`touch`](Self::touch).
    pub fn join(&mut self, (before, after): (&[Cube], &[Cube]), (a, b): (u32, u32), relative: i64) {
        if !self.docked || is_docked(before, a, b) && is_docked(after, a, b) {
            self.touch(a, b, relative);
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

    /// Adds a contact of the cells of numbers `a` and `b` that lasts the stage. `relative` is twice the greatest
    /// relative displacement of the two along an axis, in grid lines.
    pub fn touch(&mut self, a: u32, b: u32, relative: i64) {
        if relative > self.relative {
            (self.relative, self.fastest) = (relative, (a, b));
        }
        let (p, q) = (self.root(a), self.root(b));
        if p != q {
            // The lower number leads, so that long chains stay flat.
            self.above[p.max(q) as usize] = p.min(q);
            self.links.push((a, b));
        }
    }

    /// Returns each connected component as (number of its cells, lowest number of a cell of it), largest first; of
    /// equal ones that of the lower cell first.
    pub fn components(&mut self) -> Vec<(usize, u32)> {
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

    /// Returns true if all cells are in one connected component.
    pub fn is_connected(&self) -> bool {
        self.links.len() + 1 >= self.above.len()
    }

    /// Returns (force, edge): the greatest force along an axis (0 to 2) that an edge of the forest carries, with that
    /// edge as two numbers of cells; 0 and (0, 0) if no edge carries any. `before` and `after` are the cells by number
    /// at the ends of the stage. The force is given as twice the absolute sum of the displacements of the cells on one
    /// side of the edge, in grid lines; its factor follows from the time scaling of the stage.
    ///
    /// # Errors
    /// The sum that is left over at a root, if the displacements of a component do not add up to zero: then an
    /// external force would be needed.
    pub fn forces(&self, before: &[Cube], after: &[Cube], axis: usize) -> Result<(i128, (u32, u32)), i128> {
        self.forces_from(None, before, after, axis)
    }

    /// Returns (force, edge) as [`forces`](Self::forces) does, where the cell of the number `anchor`, if there is one,
    /// is held by something outside: it takes what the displacements of its component do not add up to.
    ///
    /// # Errors
    /// As [`forces`](Self::forces), of components without that cell.
    pub fn forces_from(
        &self,
        anchor: Option<u32>,
        before: &[Cube],
        after: &[Cube],
        axis: usize,
    ) -> Result<(i128, (u32, u32)), i128> {
        let moved = |(old, new): (&Cube, &Cube)| ForceNode {
            behind: i128::from(new.middle(axis) - old.middle(axis)),
            degree: 0,
            neighbours: 0,
        };
        let mut nodes: Vec<ForceNode> = before.iter().zip(after).map(moved).collect();
        for &(a, b) in &self.links {
            let [p, q] = [a, b].map(|cell| cell as usize);
            nodes[p].degree += 1;
            nodes[p].neighbours ^= b;
            nodes[q].degree += 1;
            nodes[q].neighbours ^= a;
        }
        // The anchor is the root of its tree: it is never a leaf, for a part of it hangs on nothing else.
        if let Some(anchor) = anchor {
            nodes[anchor as usize].degree += 2;
        }
        // Leaves are removed one by one; each passes its force on to its only neighbour.
        let mut worst = (0, (0, 0));
        for leaf in 0..nodes.len() {
            let mut at = leaf;
            while nodes[at].degree == 1 {
                let ForceNode { behind: force, neighbours: next, .. } = nodes[at];
                if force.abs() > worst.0 {
                    worst = (force.abs(), (at as u32, next));
                }
                nodes[at] = ForceNode { behind: 0, degree: 0, neighbours: 0 };
                let next = next as usize;
                nodes[next].behind += force;
                nodes[next].degree -= 1;
                nodes[next].neighbours ^= at as u32;
                at = next;
            }
        }
        // Force that was not passed on is left at the roots.
        let is_anchor = |cell: usize| anchor.is_some_and(|anchor| anchor as usize == cell);
        match nodes.iter().enumerate().find(|(cell, node)| node.behind != 0 && !is_anchor(*cell)) {
            Some((_, node)) => Err(node.behind),
            None => Ok(worst),
        }
    }
}

/// Returns true if the middles of two faces meet of cells that are in contact over a face: along two axes the cells have
/// the same middle.
fn is_docked(cubes: &[Cube], a: u32, b: u32) -> bool {
    let (a, b) = (&cubes[a as usize], &cubes[b as usize]);
    (0..3).filter(|&axis| a.middle(axis) == b.middle(axis)).count() >= 2
}
