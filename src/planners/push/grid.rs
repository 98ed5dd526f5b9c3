//! The lattice sites around two shapes, as a bounded grid whose sites have indices.

/// The margin of empty sites on every side of the shapes, in cells: cells may pass outside.
const MARGIN: i64 = 4;

/// The greatest number of sites of a grid.
const SITES_MAX: i64 = 4_000_000;

/// A direction along an axis: 0 and 1 for x forwards and backwards, 2 and 3 for y, 4 and 5 for z.
pub(super) type Direction = u8;

/// All directions.
pub(super) const DIRECTIONS: [Direction; 6] = [0, 1, 2, 3, 4, 5];

/// Returns the axis of a direction, 0 to 2.
pub(super) fn axis_of(direction: Direction) -> u8 {
    direction / 2
}

/// Returns the opposite direction.
pub(super) fn opposite(direction: Direction) -> Direction {
    direction ^ 1
}

/// A bounded grid of lattice sites, numbered from 0.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    low: [i64; 3],
    sides: [i64; 3],
}

impl Grid {
    /// Returns the grid around these sites with a margin; `None` if it has too many sites, or there is none.
    pub(super) fn around<'a>(places: impl Iterator<Item = &'a [i64; 3]> + Clone) -> Option<Grid> {
        let least = |axis: usize| places.clone().map(|p| p[axis]).min();
        let most = |axis: usize| places.clone().map(|p| p[axis]).max();
        let low = [least(0)? - MARGIN, least(1)? - MARGIN, least(2)? - MARGIN];
        let high = [most(0)? + MARGIN, most(1)? + MARGIN, most(2)? + MARGIN];
        let sides = [0, 1, 2].map(|axis| high[axis] - low[axis] + 1);
        let volume = sides.iter().try_fold(1_i64, |volume, side| volume.checked_mul(*side))?;
        (volume <= SITES_MAX).then_some(Grid { low, sides })
    }

    /// Returns the number of sites.
    pub(super) fn len(&self) -> usize {
        self.sides.iter().product::<i64>() as usize
    }

    /// Returns the number of a site of the grid by its coordinates, in cells.
    pub(super) fn site(&self, place: [i64; 3]) -> usize {
        let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - self.low[axis]);
        (x + self.sides[0] * (y + self.sides[1] * z)) as usize
    }

    /// Returns the numbers of those sites, given by coordinates in cells, that lie in the grid.
    pub(super) fn sites_within<'a>(&'a self, places: &'a [[i64; 3]]) -> impl Iterator<Item = usize> + 'a {
        let inside = move |place: &&[i64; 3]| {
            (0..3).all(|axis| (0..self.sides[axis]).contains(&(place[axis] - self.low[axis])))
        };
        places.iter().filter(inside).map(move |place| self.site(*place))
    }

    /// Returns the coordinates of a site, in cells.
    pub(super) fn place(&self, site: usize) -> [i64; 3] {
        let site = site as i64;
        let row = site / self.sides[0];
        let inside = [site % self.sides[0], row % self.sides[1], row / self.sides[1]];
        [0, 1, 2].map(|axis| self.low[axis] + inside[axis])
    }

    /// Returns the increment of a site's number in a direction.
    pub(super) fn stride(&self, direction: Direction) -> isize {
        let along =
            [1, self.sides[0], self.sides[0] * self.sides[1]][usize::from(axis_of(direction))] as isize;
        if direction.is_multiple_of(2) { along } else { -along }
    }

    /// Returns the neighbour of a site in a direction; the site must not be at the border of the grid.
    pub(super) fn next(&self, site: usize, direction: Direction) -> usize {
        (site as isize + self.stride(direction)) as usize
    }

    /// Returns true if a site is so near the border that a cell there could leave the grid.
    pub(super) fn is_marginal(&self, site: usize) -> bool {
        let place = self.place(site);
        (0..3).any(|axis| {
            let inside = place[axis] - self.low[axis];
            inside < 2 || inside + 2 >= self.sides[axis]
        })
    }
}
