//! The shape of a set of cells.

/// A set of lattice cells as their sites in ascending order, translated so that the least coordinate along each axis is
/// 0 unless it must stand where it is.
pub(super) struct Shape {
    /// The lattice sites of the cells, in cell sizes, in ascending order of x, then y, then z.
    pub positions: Vec<[i64; 3]>,
    /// The sides of the bounding box along x, y, z, in cells.
    pub sides: [u64; 3],
}

impl Shape {
    /// Returns the shape of the cells at these lattice sites, in whole cells.
    pub(super) fn of(positions: &[[i64; 3]]) -> Shape {
        let low = [0, 1, 2].map(|axis| positions.iter().map(|p| p[axis]).min().unwrap_or(0));
        let mut positions: Vec<[i64; 3]> =
            positions.iter().map(|p| [p[0] - low[0], p[1] - low[1], p[2] - low[2]]).collect();
        positions.sort_unstable();
        let sides = [0, 1, 2].map(|axis| positions.iter().map(|p| p[axis] as u64 + 1).max().unwrap_or(0));
        Shape { positions, sides }
    }

    /// Returns the shape of the cells at these lattice sites, in whole cells, where it stands: without a translation.
    pub(super) fn standing(positions: &[[i64; 3]]) -> Shape {
        let mut standing = positions.to_vec();
        standing.sort_unstable();
        Shape { positions: standing, ..Shape::of(positions) }
    }

    /// Returns the number of cells.
    pub(super) fn count(&self) -> u64 {
        self.positions.len() as u64
    }

    /// Returns true if the cells fill their bounding box without gaps.
    pub(super) fn is_box(&self) -> bool {
        let volume = self.sides.iter().try_fold(1_u64, |volume, side| volume.checked_mul(*side));
        volume == Some(self.count())
    }

    /// Returns true if the cells are a straight row along an axis (0 to 2); a lone cell is so along every axis.
    pub(super) fn is_row_along(&self, axis: usize) -> bool {
        self.sides[axis] == self.count()
    }

    /// Returns true if all cells are in one plane across an axis (0 to 2).
    pub(super) fn is_flat_across(&self, axis: usize) -> bool {
        self.sides[axis] == 1
    }
}
