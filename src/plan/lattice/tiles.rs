//! A spatial index of the cross-sections of lanes.
//!
//! The plane across the moving axis is tiled by squares of a cell's size. If there are about as many tiles as
//! cells, a dense table holds them; otherwise an ordered map does.

use super::grid::Cube;
use std::collections::BTreeMap;

/// A cross-section: lower and upper face along the two axes across the motion, in grid lines.
pub(super) type Section = [(i64, i64); 2];

/// A tile of the plane across the motion, a square of a full-sized cell's edge: its coordinates in tiles, from 0,
/// along the second axis and the first.
pub(super) type Tile = (i64, i64);

/// The greatest number of tiles in the dense table, for each cell.
const TABLE_MAX: usize = 4;
/// The index of no lane.
const NONE: u32 = u32::MAX;

/// A spatial index of lanes, the rows of cells of one cross-section, by the tile in which the lower corner of that
/// lies.
pub(super) struct Tiles {
    lines: i64,
    origin: (i64, i64),
    /// The number of tiles along the first axis.
    width: usize,
    /// The first lane of each tile, if there is a table.
    table: Option<Vec<u32>>,
    map: BTreeMap<Tile, u32>,
    /// The cross-section of each lane (the cells with one cross-section), by the number of the lane, in grid lines.
    pub sections: Vec<Section>,
    /// The next lane of the same tile, for each lane.
    next: Vec<u32>,
}

impl Tiles {
    /// Returns an index without lanes for the cross-sections of these cells along the axes `b` and `c` (0 to 2);
    /// `lines`: the number of grid lines to a cell, which is the side of a tile.
    pub(super) fn over(cubes: &[Cube], (b, c): (usize, usize), lines: i64) -> Tiles {
        let low = |axis: usize| cubes.iter().map(|cube| cube.lo[axis]).min().unwrap_or(0);
        let high = |axis: usize| cubes.iter().map(|cube| cube.lo[axis]).max().unwrap_or(0);
        let side = |axis: usize, low: i64| ((high(axis) - low) / lines + 1) as usize;
        let origin = (low(b), low(c));
        let (width, height) = (side(b, origin.0), side(c, origin.1));
        let most = TABLE_MAX.saturating_mul(cubes.len());
        let table = width.checked_mul(height).filter(|area| *area <= most).map(|area| vec![NONE; area]);
        Tiles { lines, origin, width, table, map: BTreeMap::new(), sections: vec![], next: vec![] }
    }

    fn tile(&self, section: &Section) -> Tile {
        let tile = |low: i64, origin: i64| (low - origin) / self.lines;
        (tile(section[1].0, self.origin.1), tile(section[0].0, self.origin.0))
    }

    /// Returns the number, from 0, of the lane with a cross-section, a new one if there is none yet. Each comparison
    /// takes one from the budget `left`; `None` once it is used up.
    pub(super) fn lane(&mut self, section: Section, left: &mut usize) -> Option<u32> {
        let tile = self.tile(&section);
        let first = match &mut self.table {
            Some(table) => &mut table[tile.0 as usize * self.width + tile.1 as usize],
            None => self.map.entry(tile).or_insert(NONE),
        };
        let mut at = *first;
        while at != NONE {
            if self.sections[at as usize] == section {
                return Some(at);
            }
            *left = left.checked_sub(1)?;
            at = self.next[at as usize];
        }
        let new = self.sections.len() as u32;
        self.sections.push(section);
        self.next.push(std::mem::replace(first, new));
        Some(new)
    }

    /// Returns all lanes as (tile, number of the lane), ascending by tile.
    pub(super) fn order(&self) -> Vec<(Tile, u32)> {
        let mut order = Vec::with_capacity(self.sections.len());
        let mut add = |first: u32| {
            let mut at = first;
            while at != NONE {
                order.push((self.tile(&self.sections[at as usize]), at));
                at = self.next[at as usize];
            }
        };
        match &self.table {
            Some(table) => table.iter().for_each(|&first| add(first)),
            None => self.map.values().for_each(|&first| add(first)),
        }
        order
    }
}
