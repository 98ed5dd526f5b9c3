//! What a step of locomotion makes small: equations (14) and (17) of the paper, and (14) as it has to be
//! weighed to arrive.

use super::step::Objective;
use super::structure::Structure;
use crate::geometry::Vec3;

/// How much the motion of nodes weighs beside that of lengths: below 1 runs were seen to get stuck.
const STILL: f64 = 1.0;
/// The same where few struts are to move: enough that there is one best step.
const STILL_FEWEST: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// (17): every node goes where its struts, as springs of their first length, pull it.
    Springs,
    /// (14): the struts change as little as possible. `still` weighs the motion of the nodes beside it:
    /// without it, motion that hardly changes lengths costs nothing, and the robot throws itself flat.
    Lengths { still: f64 },
    /// (14) towards the first lengths: rates as of springs, with the same weight.
    Restoring { still: f64 },
    /// The rates' sizes add up to as little as possible, so that few struts move; `still` as before.
    Fewest { still: f64 },
}

impl Aim {
    pub const LENGTHS: Aim = Aim::Lengths { still: STILL };
    pub const RESTORING: Aim = Aim::Restoring { still: STILL };
    pub const FEWEST: Aim = Aim::Fewest { still: STILL_FEWEST };
}

/// For a step in which a speed of one unit a second means `pace` seconds.
pub fn objective(aim: Aim, truss: &Structure, x: &[Vec3], pace: f64) -> Objective {
    match aim {
        Aim::Springs => springs(truss, x, pace),
        Aim::Fewest { still } => fewest(truss, x, still),
        Aim::Lengths { still } => lengths(truss, x, still, |_| 0.0),
        Aim::Restoring { still } => lengths(truss, x, still, |length| (truss.unit - length) * pace),
    }
}

/// `½ |u - pace v|²`, v by (15).
fn springs(truss: &Structure, x: &[Vec3], pace: f64) -> Objective {
    let mut pull = vec![Vec3::zeros(); truss.nodes];
    for &(a, b) in &truss.struts {
        let d = x[b] - x[a];
        let along = d * ((d.norm() - truss.unit) / d.norm());
        pull[a] += along;
        pull[b] -= along;
    }
    Objective {
        hessian: (0..3 * truss.nodes).map(|i| (i, i, 1.0)).collect(),
        linear: pull.iter().flat_map(|v| (0..3).map(move |k| -pace * v[k])).collect(),
        sizes: Vec::new(),
    }
}

/// `½ |R u - w|² + ½ still |u|²`, R the rigidity matrix of unit rows, w by strut's length.
fn lengths(truss: &Structure, x: &[Vec3], still: f64, wanted: impl Fn(f64) -> f64) -> Objective {
    let mut hessian: Vec<(usize, usize, f64)> = (0..3 * truss.nodes).map(|i| (i, i, still)).collect();
    let mut linear = vec![0.0; 3 * truss.nodes];
    for &(a, b) in &truss.struts {
        let d = x[a] - x[b];
        let (along, length) = (d.normalize(), d.norm());
        let row = row((a, b), along);
        for &(i, p) in &row {
            linear[i] -= p * wanted(length);
            for &(j, q) in row.iter().filter(|(j, _)| *j >= i) {
                hessian.push((i, j, p * q));
            }
        }
    }
    Objective { hessian, linear, sizes: Vec::new() }
}

/// `Σ |rate| + ½ still |u|²`.
fn fewest(truss: &Structure, x: &[Vec3], still: f64) -> Objective {
    let sizes = truss.struts.iter().map(|&(a, b)| row((a, b), (x[a] - x[b]).normalize()));
    Objective {
        hessian: (0..3 * truss.nodes).map(|i| (i, i, still)).filter(|(_, _, v)| *v > 0.0).collect(),
        linear: vec![0.0; 3 * truss.nodes],
        sizes: sizes.collect(),
    }
}

/// A row of the rigidity matrix: what a strut's length changes by.
fn row((a, b): (usize, usize), along: Vec3) -> Vec<(usize, f64)> {
    let end = |(node, sign): (usize, f64)| (0..3).map(move |k| (3 * node + k, sign * along[k]));
    [(a, 1.0), (b, -1.0)].into_iter().flat_map(end).collect()
}
