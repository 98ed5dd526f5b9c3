//! Which struts are near each other: a grid over their boxes, and of what is near what may come too near
//! in a step. Of a truss of n struts few of the n² pairs are, and few of those; what is known of their
//! distances lasts for several steps.

use super::segment;
use super::structure::Structure;
use crate::geometry::Vec3;
use std::collections::HashMap;

/// Pairs are looked for again when a node has moved this far, in units.
const SKIN: f64 = 0.2;

/// Pairs of struts without a common node, each with a distance that it keeps at least: all that may come
/// nearer to each other than the clearance while no node is farther than `skin` from where it was.
#[derive(Clone, Debug)]
pub struct Nearby {
    pairs: Vec<(usize, usize, f64)>,
    skin: f64,
    /// Where the nodes were when it was made, and where they are.
    first: Vec<Vec3>,
    now: Vec<Vec3>,
}

impl Nearby {
    /// For nodes that go a way of `wanted`, m, at least.
    fn new(truss: &Structure, x: &[Vec3], wanted: f64) -> Nearby {
        let skin = wanted.max(SKIN * truss.unit);
        let pairs = pairs(truss, x, truss.clearance + 2.0 * skin);
        Nearby { pairs, skin, first: x.to_vec(), now: x.to_vec() }
    }

    /// Pairs that may come nearer than the clearance and some more when the nodes go straight from x to y. In
    /// order.
    pub fn candidates(
        known: &mut Option<Nearby>,
        truss: &Structure,
        (x, y): (&[Vec3], &[Vec3]),
        more: f64,
    ) -> Vec<(usize, usize)> {
        let still =
            known.take().filter(|known| known.now == x && farthest(&known.first, y) + more <= known.skin);
        let nearby = known.insert(still.unwrap_or_else(|| Nearby::new(truss, x, farthest(x, y) + more)));
        let reach = reach(truss, x, y);
        let mut found = Vec::new();
        for (i, j, apart) in &mut nearby.pairs {
            let limit = truss.clearance + more + reach[*i] + reach[*j];
            if *apart < limit {
                *apart = segment::nearest(truss.segment(x, *i), truss.segment(x, *j)).distance;
                if *apart < limit {
                    found.push((*i, *j));
                }
            }
        }
        found
    }

    /// The nodes went straight on to y.
    pub fn moved(&mut self, truss: &Structure, y: &[Vec3]) {
        let reach = reach(truss, &self.now, y);
        self.pairs.iter_mut().for_each(|(i, j, apart)| *apart -= reach[*i] + reach[*j]);
        self.now.copy_from_slice(y);
    }
}

/// How far each strut's points go at most.
fn reach(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<f64> {
    let moved: Vec<f64> = x.iter().zip(y).map(|(p, q)| (q - p).norm()).collect();
    truss.struts.iter().map(|&(a, b)| moved[a].max(moved[b])).collect()
}

fn farthest(x: &[Vec3], y: &[Vec3]) -> f64 {
    x.iter().zip(y).map(|(p, q)| (q - p).norm()).fold(0.0, f64::max)
}

/// Pairs of struts without a common node whose boxes come within `reach` (m) of each other, with the
/// distance of the boxes. In order.
fn pairs(truss: &Structure, x: &[Vec3], reach: f64) -> Vec<(usize, usize, f64)> {
    let boxes: Vec<(Vec3, Vec3)> = (0..truss.struts.len())
        .map(|strut| {
            let (a, b) = truss.segment(x, strut);
            (a.inf(&b), a.sup(&b))
        })
        .collect();
    let size = truss.unit.max(reach);
    let margin = Vec3::repeat(reach / 2.0);
    let cell = |p: Vec3| [p.x, p.y, p.z].map(|v| libm::floor(v / size) as i64);
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut found = Vec::new();
    for (j, (low_j, high_j)) in boxes.iter().enumerate() {
        let (from, to) = (cell(low_j - margin), cell(high_j + margin));
        for a in from[0]..=to[0] {
            for b in from[1]..=to[1] {
                for c in from[2]..=to[2] {
                    let members = grid.entry([a, b, c]).or_default();
                    for &i in members.iter() {
                        let (low_i, high_i) = &boxes[i];
                        let gap = (low_i - high_j).sup(&(low_j - high_i)).sup(&Vec3::zeros());
                        let apart = gap.norm_squared();
                        // Of the cells that both are in, the first speaks for the pair.
                        if apart < reach * reach
                            && !truss.share_node(i, j)
                            && cell(low_i.sup(low_j) - margin) == [a, b, c]
                        {
                            found.push((i, j, apart.sqrt()));
                        }
                    }
                    members.push(j);
                }
            }
        }
    }
    found.sort_unstable_by_key(|&(i, j, _)| (i, j));
    found
}
