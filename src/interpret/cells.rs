//! Arrangements of cells: rows, blocks, and layers drawn as text.

use std::collections::{BTreeMap, VecDeque};

/// An arrangement of cells on the integer grid: x to the right, y up (in a text the first line is the top), z up.
/// Each cell is there once, in the order in which the cells are numbered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cells {
    /// The whole coordinates x, y, z of each cell, in cell sizes; the index here, from 0, is the number of the cell.
    pub positions: Vec<[i64; 3]>,
}

/// The first character of a text of cells that is neither cell nor gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BadCell {
    /// The character that is neither cell nor gap.
    pub character: char,
    /// The line of the character, from 0.
    pub line: usize,
    /// The offset of the character in its line, in bytes.
    pub offset: usize,
}

/// Returns the cells of one layer, x, y and the height `z` in cell sizes, from text: `#` is a cell, `.` and a blank
/// are not. The last line is at y = 0, the first character of a line at x = 0; the cells are in the order of the
/// text.
///
/// # Errors
/// [`BadCell`] for the first character that is none of these.
pub fn layer(text: &str, z: i64) -> Result<Vec<[i64; 3]>, BadCell> {
    let lines: Vec<&str> = text.lines().collect();
    let mut positions = Vec::new();
    for (row, line) in lines.iter().enumerate() {
        for (x, (offset, character)) in line.char_indices().enumerate() {
            match character {
                '#' => positions.push([x as i64, (lines.len() - 1 - row) as i64, z]),
                '.' | ' ' => {}
                character => return Err(BadCell { character, line: row, offset }),
            }
        }
    }
    Ok(positions)
}

impl Cells {
    /// Returns a block of cells, `size` cells along x, y and z, whose lowest cell is at the origin; they are numbered
    /// along x first, then y, then z.
    pub fn block(size: [usize; 3]) -> Cells {
        let mut positions = Vec::with_capacity(size.iter().product());
        for z in 0..size[2] {
            for y in 0..size[1] {
                positions.extend((0..size[0]).map(|x| [x as i64, y as i64, z as i64]));
            }
        }
        Cells { positions }
    }

    /// Returns the arrangement with a cube of `by` cells along each axis in place of every cell, and as many times as far
    /// from the origin; the cells of a cube come together, numbered along x first, then y, then z.
    pub fn enlarged(&self, by: usize) -> Cells {
        let cube = Cells::block([by; 3]).positions;
        let within = |cell: &[i64; 3]| {
            let corner = cell.map(|x| x.saturating_mul(by as i64));
            cube.iter().map(move |place| [0, 1, 2].map(|axis| corner[axis].saturating_add(place[axis])))
        };
        Cells { positions: self.positions.iter().flat_map(within).collect() }
    }

    /// Returns the number of cells of each connected component (over faces), in the order of their first cells; one
    /// entry for a connected arrangement.
    pub fn pieces(&self) -> Vec<usize> {
        let index: BTreeMap<[i64; 3], usize> =
            self.positions.iter().enumerate().map(|(i, place)| (*place, i)).collect();
        let mut reached = vec![false; self.positions.len()];
        let mut sizes = Vec::new();
        for start in 0..self.positions.len() {
            if reached[start] {
                continue;
            }
            reached[start] = true;
            let mut frontier = VecDeque::from([start]);
            let mut size = 0;
            while let Some(cell) = frontier.pop_front() {
                crate::interrupt::checkpoint();
                size += 1;
                for place in neighbours(self.positions[cell]) {
                    if let Some(&next) = index.get(&place)
                        && !reached[next]
                    {
                        reached[next] = true;
                        frontier.push_back(next);
                    }
                }
            }
            sizes.push(size);
        }
        sizes
    }
}

fn neighbours(place: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..3).flat_map(move |axis| {
        [-1, 1].map(|step| {
            let mut next = place;
            next[axis] += step;
            next
        })
    })
}
