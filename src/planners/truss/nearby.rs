//! Which struts are near each other: a grid over their boxes, and of what is near what may come too near
//! in a step. Of a truss of n struts few of the n² pairs are, and few of those; what is known of their
//! distances lasts for several steps.

use super::segment;
use super::structure::Structure;
use crate::geometry::Vec3;

/// Pairs are looked for again when a node has moved this far beside what all move, in units.
const SKIN: f64 = 0.3;
/// Cells of the grid, for each strut.
const CELLS_PER_STRUT: f64 = 8.0;

/// Pairs of struts without a common node, each with a distance that it keeps at least: all that may come
/// nearer to each other than the clearance while no node is farther than `skin` from where it was.
#[derive(Clone, Debug)]
pub struct Nearby {
    pairs: Vec<Pair>,
    skin: f64,
    /// Where the nodes were when it was made, and where they are.
    first: Vec<Vec3>,
    now: Vec<Vec3>,
}

#[derive(Clone, Debug)]
struct Pair {
    struts: (usize, usize),
    /// What it keeps at least, m, and whether that is its distance where the nodes are.
    apart: f64,
    exact: bool,
    /// From the second's nearest point to the first's, where the distance is exact.
    normal: Vec3,
}

impl Pair {
    /// Whether the two are apart by the clearance, seen along the direction in which they were nearest: then
    /// they are so all the way to y.
    fn stays_apart(&self, truss: &Structure, y: &[Vec3]) -> bool {
        let along = |(p, q): (Vec3, Vec3)| (p.dot(&self.normal), q.dot(&self.normal));
        let (first, second) =
            (along(truss.segment(y, self.struts.0)), along(truss.segment(y, self.struts.1)));
        self.apart >= truss.clearance && first.0.min(first.1) - second.0.max(second.1) >= truss.clearance
    }
}

impl Nearby {
    /// For nodes that go a way of `wanted`, m, at least.
    fn new(truss: &Structure, x: &[Vec3], wanted: f64) -> Nearby {
        let skin = wanted.max(SKIN * truss.unit);
        let pairs = pairs(truss, x, truss.clearance + 2.0 * skin);
        let pair = |(i, j, apart)| Pair { struts: (i, j), apart, exact: false, normal: Vec3::z() };
        let pairs = pairs.into_iter().map(pair).collect();
        Nearby { pairs, skin, first: x.to_vec(), now: x.to_vec() }
    }

    /// Pairs that may come nearer than the clearance and some more when the nodes go straight from x to y.
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
        for pair in &mut nearby.pairs {
            let (i, j) = pair.struts;
            let limit = truss.clearance + more + reach[i] + reach[j];
            if pair.apart < limit && !pair.exact {
                let nearest = segment::nearest(truss.segment(x, i), truss.segment(x, j));
                (pair.apart, pair.normal, pair.exact) = (nearest.distance, nearest.normal, true);
            }
            if pair.apart < limit && !pair.stays_apart(truss, y) {
                found.push((i, j));
            }
        }
        found
    }

    /// The nodes went straight on to y.
    pub fn moved(&mut self, truss: &Structure, y: &[Vec3]) {
        let reach = reach(truss, &self.now, y);
        for pair in &mut self.pairs {
            pair.apart -= reach[pair.struts.0] + reach[pair.struts.1];
            pair.exact = false;
        }
        self.now.copy_from_slice(y);
    }
}

/// How far each strut's points go at most beside what all do.
fn reach(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<f64> {
    let moved: Vec<f64> = moved(x, y).collect();
    truss.struts.iter().map(|&(a, b)| moved[a].max(moved[b])).collect()
}

fn farthest(x: &[Vec3], y: &[Vec3]) -> f64 {
    moved(x, y).fold(0.0, f64::max)
}

/// How far each node goes when the mean way of all is taken off, which brings no strut nearer to another.
fn moved(x: &[Vec3], y: &[Vec3]) -> impl Iterator<Item = f64> {
    let mean = x.iter().zip(y).map(|(p, q)| q - p).sum::<Vec3>() / x.len().max(1) as f64;
    x.iter().zip(y).map(move |(p, q)| (q - p - mean).norm())
}

/// Pairs of struts without a common node whose boxes come within `reach` (m) of each other, with the
/// distance of the boxes.
pub fn pairs(truss: &Structure, x: &[Vec3], reach: f64) -> Vec<(usize, usize, f64)> {
    let boxes: Vec<(Vec3, Vec3)> = (0..truss.struts.len())
        .map(|strut| {
            let (a, b) = truss.segment(x, strut);
            (a.inf(&b), a.sup(&b))
        })
        .collect();
    let margin = Vec3::repeat(reach / 2.0);
    let low = boxes.iter().fold(Vec3::repeat(f64::INFINITY), |low, (p, _)| low.inf(p)) - margin;
    let high = boxes.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, (_, q)| high.sup(q)) + margin;
    // No more cells than some for each strut, however far apart they are.
    let mut size = truss.unit.max(reach);
    let counts = |size: f64| (high - low).map(|length| libm::floor(length / size) + 1.0);
    while counts(size).product() > CELLS_PER_STRUT * boxes.len() as f64 + 1.0 {
        size *= 2.0;
    }
    let counts = counts(size).map(|count| count as usize);
    let cell = |p: Vec3| ((p - low) / size).map(|v| v.max(0.0) as usize);
    let mut grid: Vec<Vec<usize>> = vec![Vec::new(); counts.product()];
    let mut found = Vec::new();
    for (j, (low_j, high_j)) in boxes.iter().enumerate() {
        let (from, to) = (cell(low_j - margin), cell(high_j + margin));
        for a in from.x..=to.x.min(counts.x - 1) {
            for b in from.y..=to.y.min(counts.y - 1) {
                for c in from.z..=to.z.min(counts.z - 1) {
                    let members = &mut grid[(a * counts.y + b) * counts.z + c];
                    for &i in members.iter() {
                        let (low_i, high_i) = &boxes[i];
                        let gap = (low_i - high_j).sup(&(low_j - high_i)).sup(&Vec3::zeros());
                        let apart = gap.norm_squared();
                        // Of the cells that both are in, the first speaks for the pair.
                        if apart < reach * reach
                            && !truss.share_node(i, j)
                            && cell(low_i.sup(low_j) - margin) == nalgebra::Vector3::new(a, b, c)
                        {
                            found.push((i, j, apart.sqrt()));
                        }
                    }
                    members.push(j);
                }
            }
        }
    }
    found
}
