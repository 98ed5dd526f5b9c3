//! Moves of all cells over a stage, in classes: cells of one class move by the same displacement and grow alike.
//!
//! Positions in irregular shapes are no arithmetic runs, but few displacements occur: a stage that swaps
//! pairs of ten thousand cells has three. So the classes and the class of each cell state it in a few bytes a cell.

use super::ratio::Ratio;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::cmp::Reverse;
use std::sync::Arc;

/// The moves of all cells from the configuration before to the one after.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Moves {
    /// The classes of moves, numbered from 0.
    pub classes: Vec<CellMove>,
    /// The class of every cell: spans of cells in the order of their numbers, each of which begins where the one before
    /// ends; the first begins with cell 0, and the counts add up to the number of cells.
    pub cells: Arc<[CellSpan]>,
}

/// A move of a class of cells, in cell sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellMove {
    /// The displacement of the centre along x, y, z.
    pub displacement: [Ratio; 3],
    /// The growth of the size along x, y, z; negative where a cell contracts.
    pub growth: [Ratio; 3],
}

/// A span of cells of one class, with numbers that follow each other. In a file a span of one cell is the class
/// alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellSpan {
    /// The index of the class in [`Moves::classes`].
    pub class: u32,
    /// The number of cells, at least 1.
    pub count: u32,
}

impl CellMove {
    /// Returns the move back.
    fn reversed(self) -> CellMove {
        let back = |ratios: [Ratio; 3]| ratios.map(|Ratio(above, below)| Ratio(above.wrapping_neg(), below));
        CellMove { displacement: back(self.displacement), growth: back(self.growth) }
    }

    /// Returns all numbers of the move: the displacements, then the growths.
    pub fn ratios(&self) -> impl Iterator<Item = Ratio> {
        self.displacement.into_iter().chain(self.growth)
    }
}

impl Moves {
    /// Returns the moves of cells whose classes are `of_cells`, in the order of their numbers, by index in `classes`.
    /// Classes are sorted by the number of their spans, the most first, so that the class of most spans has the
    /// shortest number; those of no cell are left out. Panics for an index that is not in `classes`.
    pub fn new(classes: &[CellMove], of_cells: impl Iterator<Item = u32>) -> Moves {
        let mut spans: Vec<CellSpan> = Vec::new();
        for class in of_cells {
            match spans.last_mut() {
                Some(last) if last.class == class && last.count < u32::MAX => last.count += 1,
                _ => spans.push(CellSpan { class, count: 1 }),
            }
        }
        let mut used = vec![0_u32; classes.len()];
        spans.iter().for_each(|span| used[span.class as usize] += 1);
        let mut order: Vec<usize> = (0..classes.len()).filter(|&class| used[class] > 0).collect();
        order.sort_by_key(|&class| Reverse(used[class]));
        let mut new = vec![0; classes.len()];
        order.iter().zip(0..).for_each(|(&class, number)| new[class] = number);
        spans.iter_mut().for_each(|span| span.class = new[span.class as usize]);
        Moves { classes: order.into_iter().map(|class| classes[class]).collect(), cells: spans.into() }
    }

    /// Returns the moves back: opposite displacements and growths of the same cells.
    pub fn reversed(&self) -> Moves {
        let classes = self.classes.iter().map(|class| class.reversed()).collect();
        Moves { classes, cells: self.cells.clone() }
    }

    /// Returns the index of each cell's class, in the order of the cells' numbers.
    pub fn of_cells(&self) -> impl Iterator<Item = u32> + '_ {
        self.cells.iter().flat_map(|span| std::iter::repeat_n(span.class, span.count as usize))
    }

    /// Returns the number of cells whose moves are stated.
    pub fn count(&self) -> u64 {
        self.cells.iter().map(|span| u64::from(span.count)).sum()
    }
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum CellSpanText {
    /// The class of one cell.
    Cell(u32),
    /// The class of several cells, and how many they are.
    Cells(u32, u32),
}

impl Serialize for CellSpan {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let CellSpan { class, count } = *self;
        let text = if count == 1 { CellSpanText::Cell(class) } else { CellSpanText::Cells(class, count) };
        text.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for CellSpan {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<CellSpan, D::Error> {
        Ok(match CellSpanText::deserialize(deserializer)? {
            CellSpanText::Cell(class) => CellSpan { class, count: 1 },
            CellSpanText::Cells(class, count) => CellSpan { class, count },
        })
    }
}

impl JsonSchema for CellSpan {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "CellSpan".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        CellSpanText::json_schema(generator)
    }
}
