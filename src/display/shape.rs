//! Cells and flat patterns in characters.

use crate::interpret::cells::Cells;
use crate::planners::fold::Report;
use crate::planners::fold::pattern::Pattern;
use crate::units::counted;

/// The greatest number of columns of a picture; of larger lattices only the size is shown.
const COLUMNS_MAX: i64 = 120;
/// The greatest number of rows of a picture, over all layers.
const ROWS_MAX: i64 = 60;

/// Returns an arrangement of cells as text, layer by layer from the highest, in the form that the built-in `cells`
/// reads: y up, x to the right.
pub(super) fn cells(cells: &Cells) -> String {
    let count = counted(cells.positions.len(), "cell");
    let ends = |axis: usize| {
        let along = cells.positions.iter().map(|place| place[axis]);
        (along.clone().min().unwrap_or(0), along.max().unwrap_or(0))
    };
    let [(x0, x1), (y0, y1), (z0, z1)] = [ends(0), ends(1), ends(2)];
    let rows = (y1 - y0 + 1).saturating_mul(z1 - z0 + 1);
    if cells.positions.is_empty() || x1 - x0 >= COLUMNS_MAX || rows > ROWS_MAX {
        let size = [x1 - x0 + 1, y1 - y0 + 1, z1 - z0 + 1].map(|n| n.to_string()).join(" x ");
        return format!("{count} in {size}");
    }
    let taken: std::collections::BTreeSet<[i64; 3]> = cells.positions.iter().copied().collect();
    let mut lines = vec![count];
    for z in (z0..=z1).rev() {
        if z1 > z0 {
            lines.push(format!("layer {}", z - z0));
        }
        for y in (y0..=y1).rev() {
            let row = (x0..=x1).map(|x| if taken.contains(&[x, y, z]) { '#' } else { '.' });
            lines.push(format!("  {}", row.collect::<String>()));
        }
    }
    lines.join("\n")
}

/// The number of columns between the middles of two triangles side by side, half a side apart.
const PITCH: usize = 4;

/// Returns the flat pattern of a folding as a picture of characters: equal triangles, each with the number of its face;
/// only its size if the triangles differ or the picture would be too large.
pub(super) fn pattern(pattern: &Report) -> String {
    let count = counted(pattern.target.faces.len(), "panel");
    let flat = Pattern::of(&pattern.target, &pattern.layout);
    let Some(places) = flat.cells else {
        return format!("a flat pattern of {count} of unequal sides");
    };
    let triangles: Vec<Triangle> =
        places.iter().enumerate().map(|(face, sum)| triangle(face, *sum)).collect();
    let (left, right) = (triangles.iter().map(|t| t.column).min(), triangles.iter().map(|t| t.column).max());
    let (low, high) = (triangles.iter().map(|t| t.row).min(), triangles.iter().map(|t| t.row).max());
    let (Some(left), Some(right), Some(low), Some(high)) = (left, right, low, high) else { return count };
    if (right - left) * PITCH as i64 > COLUMNS_MAX || high - low > ROWS_MAX {
        return format!("a flat pattern of {count}");
    }
    let mut lines = vec![format!("a flat pattern of {count}; {} is the root", pattern.layout.root)];
    for row in (low..=high).rev() {
        let width = (right - left) as usize * PITCH + PITCH + 1;
        let mut line = vec![' '; width];
        for t in triangles.iter().filter(|t| t.row == row) {
            let begin = (t.column - left) as usize * PITCH;
            let (open, close) = if t.up { ('/', '\\') } else { ('\\', '/') };
            (line[begin], line[begin + PITCH]) = (open, close);
            let number = t.face.to_string();
            let middle = begin + 1 + (PITCH - 1).saturating_sub(number.len()) / 2;
            line[middle..].iter_mut().zip(number.chars()).for_each(|(place, digit)| *place = digit);
        }
        lines.push(format!("  {}", line.into_iter().collect::<String>().trim_end()));
    }
    lines.join("\n")
}

struct Triangle {
    face: usize,
    row: i64,
    /// The column of its left end, in half sides.
    column: i64,
    /// True if its tip is up.
    up: bool,
}

/// Returns the triangle of a face by the sum of its corners in the two steps of the lattice, of which the
/// second leans to the right by half a side.
fn triangle(face: usize, [a, b]: [i64; 2]) -> Triangle {
    let up = a.rem_euclid(3) == 1;
    let (u, v) = (a.div_euclid(3), b.div_euclid(3));
    Triangle { face, row: v, column: 2 * u + v + i64::from(!up), up }
}
