//! Which struts are near each other: a grid over their boxes. Of a truss of n struts few of the n²
//! pairs are.

use super::structure::Structure;
use crate::geometry::Vec3;
use std::collections::BTreeMap;

/// Pairs of struts without a common node that come within `reach` (m) of each other, or may: on the way
/// from x to y their boxes are no farther apart. In order.
pub fn pairs(truss: &Structure, x: &[Vec3], y: &[Vec3], reach: f64) -> Vec<(usize, usize)> {
    let boxes: Vec<(Vec3, Vec3)> = (0..truss.struts.len())
        .map(|strut| {
            let ((a, b), (c, d)) = (truss.segment(x, strut), truss.segment(y, strut));
            let margin = Vec3::repeat(reach / 2.0);
            (a.inf(&b).inf(&c).inf(&d) - margin, a.sup(&b).sup(&c).sup(&d) + margin)
        })
        .collect();
    let size = truss.unit.max(reach);
    let cell = |v: f64| libm::floor(v / size) as i64;
    let mut grid: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (strut, (low, high)) in boxes.iter().enumerate() {
        for i in cell(low.x)..=cell(high.x) {
            for j in cell(low.y)..=cell(high.y) {
                for k in cell(low.z)..=cell(high.z) {
                    grid.entry([i, j, k]).or_default().push(strut);
                }
            }
        }
    }
    let mut found = Vec::new();
    for (place, members) in &grid {
        for (at, &i) in members.iter().enumerate() {
            for &j in &members[at + 1..] {
                let ((low_i, high_i), (low_j, high_j)) = (boxes[i], boxes[j]);
                let meet = (0..3).all(|k| low_i[k] <= high_j[k] && low_j[k] <= high_i[k]);
                if !meet || truss.share_node(i, j) {
                    continue;
                }
                // Of the cells that both are in, the first speaks for the pair.
                let first = low_i.sup(&low_j);
                if [cell(first.x), cell(first.y), cell(first.z)] == *place {
                    found.push((i.min(j), i.max(j)));
                }
            }
        }
    }
    found.sort_unstable();
    found
}
