//! Ways of joints from one posture to another on which nothing meets: RRT-Connect (Kuffner and LaValle 2000, *RRT-Connect:
//! An efficient approach to single-query path planning*), and shortcutting of what it finds.
//!
//! Two trees of postures, rooted at either end, grow towards random postures and each other by straight motions in joint
//! space, which are examined with bounds on the motion ([`FreeSpace::is_way_free`]). Distances are those that the farthest
//! points of the robot would go.

use super::free_space::{FreeSpace, Meeting};
use crate::optimize::random::SplitMix64;
use crate::planners::Progress;
use crate::units::{Dimension, quantity};
use std::error::Error;
use std::f64::consts::PI;
use std::fmt;

/// Two postures between which a way is looked for.
pub struct Problem<'a> {
    /// The positions of all joints at the start, rad or m.
    pub from: &'a [f64],
    /// The positions of all joints at the goal, rad or m: they differ from those at the start only in joints that move.
    pub to: &'a [f64],
    /// The ranges of all joints, rad or m, infinite for those that turn for ever.
    pub limits: &'a [(f64, f64)],
}

/// The settings of [`plan`](plan()).
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The greatest number of postures that are examined. Default 200,000.
    pub budget: u64,
    /// The seed of the random postures. Default 0.
    pub seed: u64,
    /// The greatest motion of a point of the robot from one node of a tree to the next, m. Default 0.03: ways
    /// through gaps of a few millimetres are found 20 times as fast as with 0.15.
    pub step: f64,
    /// The number of shortcuts that are tried. Default 200.
    pub shortcuts: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { budget: 200_000, seed: 0, step: 0.03, shortcuts: 200 }
    }
}

/// A free way.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The postures (all joints, rad or m) between which joints go straight, from the start to the goal, both included.
    pub postures: Vec<Vec<f64>>,
    /// The number of postures that were examined.
    pub work: u64,
}

/// The reason why there is no way.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// Bodies meet at the start.
    Start(Meeting),
    /// Bodies meet at the goal.
    Goal(Meeting),
    /// The search ended without a way.
    Budget {
        /// The number of postures that were examined.
        work: u64,
        /// The part of the way that is left between the nearest two postures of the trees, 0 to 1.
        left: f64,
        /// The first two bodies that meet on the straight way between these; `None` if bodies only come too near.
        between: Option<Meeting>,
    },
    /// The observer ended the search.
    Stopped,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let meet = |meeting: &Meeting| {
            let [a, b] = &meeting.bodies;
            if meeting.distance < 0.0 {
                format!("`{a}` and `{b}` meet, {} deep", quantity(-meeting.distance, Dimension::LENGTH))
            } else {
                format!("`{a}` and `{b}` are {} apart", quantity(meeting.distance, Dimension::LENGTH))
            }
        };
        match self {
            Refusal::Start(meeting) => write!(f, "{} where the way begins", meet(meeting)),
            Refusal::Goal(meeting) => write!(f, "{} where the way ends", meet(meeting)),
            Refusal::Budget { work, left, between } => {
                write!(f, "no way was found in {work} postures, with {:.0} % of it left", 100.0 * left)?;
                between.as_ref().map_or(Ok(()), |meeting| write!(f, "; straight on, {}", meet(meeting)))
            }
            Refusal::Stopped => write!(f, "the search was stopped"),
        }
    }
}

impl Error for Refusal {}

/// A posture of the joints that move, with the index of its parent; the root is its own.
type Node = (Vec<f64>, usize);

/// The search in the space of the joints that move, in metres of the farthest point.
struct Search<'a, 'b> {
    space: &'a mut FreeSpace<'b>,
    /// The joints that move, with their levers.
    joints: Vec<(usize, f64)>,
    all: Vec<f64>,
    limits: Vec<(f64, f64)>,
    step: f64,
}

/// Returns a way from one posture to another on which all bodies keep the clearance of the free space, shortened.
///
/// # Errors
/// A [`Refusal`] where bodies meet at one of the ends, or no way was found within the budget.
pub fn plan(
    problem: &Problem,
    space: &mut FreeSpace,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Path, Refusal> {
    if let Some(meeting) = space.meeting(problem.from) {
        return Err(Refusal::Start(meeting));
    }
    if let Some(meeting) = space.meeting(problem.to) {
        return Err(Refusal::Goal(meeting));
    }
    space.allow(problem.to);
    let joints = space.joints().to_vec();
    let begun = space.work;
    let mut search = Search {
        limits: joints.iter().map(|&(joint, lever)| search_range(problem, joint, lever)).collect(),
        space,
        joints,
        all: problem.from.to_vec(),
        step: settings.step,
    };
    let (from, to) = (search.read(problem.from), search.read(problem.to));
    let mut rng = SplitMix64(settings.seed);
    let path = if search.is_free(&from, &to) {
        vec![from, to]
    } else {
        let found = search.connect(&from, &to, (settings.budget, begun), &mut rng, progress)?;
        search.shortened(found, settings.shortcuts, &mut rng)
    };
    let mut postures: Vec<Vec<f64>> = path.iter().map(|node| search.write(node)).collect();
    // Exactly the ends that were asked for.
    let last = postures.len() - 1;
    (postures[0], postures[last]) = (problem.from.to_vec(), problem.to.to_vec());
    Ok(Path { postures, work: search.space.work - begun })
}

/// Returns the range in which a joint is sampled, times its lever: a joint that turns for ever, within half a turn beyond
/// either end.
fn search_range(problem: &Problem, joint: usize, lever: f64) -> (f64, f64) {
    let (a, b) = (problem.from[joint], problem.to[joint]);
    let (low, high) = problem.limits[joint];
    let low = if low.is_finite() { low.min(a).min(b) } else { a.min(b) - PI };
    let high = if high.is_finite() { high.max(a).max(b) } else { a.max(b) + PI };
    (low * lever, high * lever)
}

impl Search<'_, '_> {
    /// Returns the coordinates of a posture of all joints.
    fn read(&self, all: &[f64]) -> Vec<f64> {
        self.joints.iter().map(|&(joint, lever)| all[joint] * lever).collect()
    }

    /// Returns the posture of all joints at some coordinates.
    fn write(&self, node: &[f64]) -> Vec<f64> {
        let mut all = self.all.clone();
        for (&(joint, lever), x) in self.joints.iter().zip(node) {
            all[joint] = x / lever;
        }
        all
    }

    fn is_free(&mut self, from: &[f64], to: &[f64]) -> bool {
        let (from, to) = (self.write(from), self.write(to));
        self.space.is_way_free(&from, &to)
    }

    /// Grows two trees until they meet; returns the way through both.
    fn connect(
        &mut self,
        from: &[f64],
        to: &[f64],
        (budget, begun): (u64, u64),
        rng: &mut SplitMix64,
        progress: &mut dyn Progress,
    ) -> Result<Vec<Vec<f64>>, Refusal> {
        let mut trees: [Vec<Node>; 2] = [vec![(from.to_vec(), 0)], vec![(to.to_vec(), 0)]];
        let whole = distance(from, to);
        let mut nearest = (whole, from.to_vec(), to.to_vec());
        let mut round = 0;
        while self.space.work - begun < budget {
            let (growing, other) = (round % 2, 1 - round % 2);
            round += 1;
            progress.report(&|| format!("{} postures in two trees", trees[0].len() + trees[1].len()));
            if !progress.should_continue() {
                return Err(Refusal::Stopped);
            }
            let sample: Vec<f64> =
                self.limits.iter().map(|(low, high)| low + rng.next_f64() * (high - low)).collect();
            let near = nearest_node(&trees[growing], &sample);
            let Some(grown) = self.extend(&mut trees[growing], near, &sample) else { continue };
            // The other tree comes as near to the new node as it can.
            let goal = trees[growing][grown].0.clone();
            let mut at = nearest_node(&trees[other], &goal);
            while let Some(next) = self.extend(&mut trees[other], at, &goal) {
                at = next;
                if trees[other][at].0 == goal {
                    let ends = if growing == 0 { [grown, at] } else { [at, grown] };
                    return Ok(joined(&trees, ends));
                }
                if self.space.work - begun >= budget {
                    break;
                }
            }
            let apart = distance(&trees[other][at].0, &goal);
            if apart < nearest.0 {
                nearest = (apart, trees[other][at].0.clone(), goal);
            }
        }
        let (apart, a, b) = nearest;
        let between = self.blocking(&a, &b);
        Err(Refusal::Budget { work: self.space.work - begun, left: (apart / whole).min(1.0), between })
    }

    /// Extends a tree from a node towards a goal by one step; returns the new node, or `None` if the motion is not free.
    fn extend(&mut self, tree: &mut Vec<Node>, near: usize, goal: &[f64]) -> Option<usize> {
        let from = &tree[near].0;
        let apart = distance(from, goal);
        if apart == 0.0 {
            return None;
        }
        let part = (self.step / apart).min(1.0);
        let next: Vec<f64> = if part < 1.0 {
            from.iter().zip(goal).map(|(a, b)| a + part * (b - a)).collect()
        } else {
            goal.to_vec()
        };
        let from = from.clone();
        if !self.is_free(&from, &next) {
            return None;
        }
        tree.push((next, near));
        Some(tree.len() - 1)
    }

    /// Returns the first two bodies that meet on the straight way between two postures.
    fn blocking(&mut self, from: &[f64], to: &[f64]) -> Option<Meeting> {
        const LOOKS: usize = 64;
        (1..LOOKS).find_map(|look| {
            let part = look as f64 / LOOKS as f64;
            let node: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + part * (b - a)).collect();
            let all = self.write(&node);
            self.space.meeting(&all)
        })
    }

    /// Shortens a way: straight motions between random places on it take the place of what is between, where they are free;
    /// then postures are left out that are not needed.
    fn shortened(&mut self, mut path: Vec<Vec<f64>>, tries: usize, rng: &mut SplitMix64) -> Vec<Vec<f64>> {
        path = self.pruned(path);
        for _ in 0..tries {
            if path.len() < 3 {
                break;
            }
            let last = (path.len() - 1) as f64;
            let (a, b) = (rng.next_f64() * last, rng.next_f64() * last);
            let (a, b) = (a.min(b), a.max(b));
            let (i, j) = (a as usize, b as usize);
            if i == j {
                continue;
            }
            let (p, q) = (between(&path, a), between(&path, b));
            let along: f64 = distance(&p, &path[i + 1])
                + path[i + 1..=j].windows(2).map(|w| distance(&w[0], &w[1])).sum::<f64>()
                + distance(&path[j], &q);
            if distance(&p, &q) < along && self.is_free(&p, &q) {
                path.splice(i + 1..=j, [p, q]);
            }
        }
        self.pruned(path)
    }

    /// Leaves out postures between which joints may as well go straight.
    fn pruned(&mut self, path: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let mut kept = vec![path[0].clone()];
        let mut at = 0;
        while at + 1 < path.len() {
            let mut next = at + 1;
            for further in (at + 2..path.len()).rev() {
                if self.is_free(&path[at], &path[further]) {
                    next = further;
                    break;
                }
            }
            at = next;
            kept.push(path[at].clone());
        }
        kept
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    libm::sqrt(a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum())
}

fn nearest_node(tree: &[Node], to: &[f64]) -> usize {
    let far = |node: &Node| node.0.iter().zip(to).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
    let mut best = (f64::INFINITY, 0);
    for (index, node) in tree.iter().enumerate() {
        let far = far(node);
        if far < best.0 {
            best = (far, index);
        }
    }
    best.1
}

/// Returns the place on a way at a number of postures from its beginning.
fn between(path: &[Vec<f64>], at: f64) -> Vec<f64> {
    let index = (at as usize).min(path.len() - 2);
    let part = at - index as f64;
    path[index].iter().zip(&path[index + 1]).map(|(a, b)| a + part * (b - a)).collect()
}

/// Returns the way through both trees, through one node of each that have the same posture.
fn joined(trees: &[Vec<Node>; 2], ends: [usize; 2]) -> Vec<Vec<f64>> {
    let to_root = |tree: &[Node], mut at: usize| {
        let mut nodes = vec![tree[at].0.clone()];
        while at != 0 {
            at = tree[at].1;
            nodes.push(tree[at].0.clone());
        }
        nodes
    };
    let mut path = to_root(&trees[0], ends[0]);
    path.reverse();
    path.extend(to_root(&trees[1], ends[1]).into_iter().skip(1));
    path
}
