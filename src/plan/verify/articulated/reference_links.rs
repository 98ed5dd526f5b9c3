//! Reference links: for each pair of modules the link relative to which their motion is bounded, by a centroid
//! decomposition of the tree of modules.
//!
//! The deviation of a link from uniform motion is bounded by a sum over the joints between it and the frame
//! that it is seen from; from the far end of a long snake that sum is too loose. A centroid splits the tree
//! of modules into halves at most; pairs on different sides of it are seen from it, and each side is split
//! again. So every pair has one frame on the path between its two modules, its sums run over that path alone, and
//! there are only log₂ n frames for each link.

use crate::robot::{Assembly, Kinematics};

/// The index of no module and no link.
const NOWHERE: u32 = u32::MAX;

/// The centroid decomposition of the tree of modules, which gives each pair of modules its reference link.
#[derive(Clone, Debug)]
pub(super) struct ReferenceLinks {
    /// The levels of the decomposition, coarsest first.
    pub levels: Vec<ReferenceLevel>,
    /// The centroid whose body link is the reference of each module, for each level.
    centroids: Vec<Vec<u32>>,
    /// The centroids of the pieces into which the part of each module, given by its index in the assembly, falls
    /// without the module.
    pub pieces: Vec<Vec<u32>>,
}

/// A level of the decomposition: the tree falls into parts, and every link of a part is seen from the body link of
/// the part's centroid. Modules that were centroids at coarser levels are left out.
#[derive(Clone, Debug, Default)]
pub(super) struct ReferenceLevel {
    /// For each link, by its number in the kinematics, the step that leads to it from its reference link, by its index
    /// in `hops`; meaningless for links that no step leads to.
    hop_to: Vec<u32>,
    /// The steps from links already reached to their neighbours, in an order in which each begins at a link reached.
    hops: Vec<LinkStep>,
    /// The reference link of each link, both by their numbers in the kinematics.
    pub origin_of: Vec<u32>,
}

/// A step from a link to its neighbour in the tree of links, away from the reference link.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkStep {
    /// The number of the neighbour from which the step leads, in the kinematics.
    pub from: u32,
    /// The number, in the kinematics, of the one of the two links that is the child of the other, to which the step
    /// between them belongs.
    pub child: u32,
    /// The distance of the origin of `from` from the axis of the joint between the two links, m.
    pub out: f64,
    /// The distance of the origin of the link that the step leads to from the axis of the joint, m.
    pub back: f64,
}

impl ReferenceLinks {
    /// Decomposes the tree of the modules of `robot` that `kinematics` reaches.
    pub(super) fn new(robot: &Assembly, kinematics: &Kinematics) -> ReferenceLinks {
        let modules = robot.modules.len();
        let neighbours = neighbours(robot, kinematics);
        let mut centroids: Vec<Vec<u32>> = Vec::new();
        let mut pieces: Vec<Vec<u32>> = vec![Vec::new(); modules];
        let mut taken = vec![false; modules];
        let mut parts = vec![(kinematics.tree.order[0].0, None)];
        while !parts.is_empty() {
            let mut seen_from = vec![NOWHERE; modules];
            let mut next = Vec::new();
            for &(start, above) in &parts {
                let part = reach(&neighbours, &taken, start);
                let centroid = centroid(&part);
                above.into_iter().for_each(|above: usize| pieces[above].push(centroid as u32));
                part.iter().for_each(|(module, _)| seen_from[*module] = centroid as u32);
                taken[centroid] = true;
                let around = neighbours[centroid].iter().filter(|m| !taken[**m]);
                next.extend(around.map(|m| (*m, Some(centroid))));
            }
            centroids.push(seen_from);
            parts = next;
        }
        let joined = joined(kinematics);
        let level = |seen_from: &Vec<u32>| ReferenceLevel::new(kinematics, &joined, seen_from);
        let levels = centroids.iter().map(level).collect();
        ReferenceLinks { levels, centroids, pieces }
    }

    /// Returns the finest level (index in `levels`) at which two modules belong to one part: its centroid lies on the
    /// path between them, or is one of them. For one module given twice it is the level at which it is the centroid
    /// itself. `a`, `b`: their indices in the assembly; both must be modules that the decomposition reaches.
    pub(super) fn between(&self, a: usize, b: usize) -> usize {
        let same = |level: &&Vec<u32>| level[a] == level[b] && level[a] != NOWHERE;
        self.centroids.iter().take_while(same).count() - 1
    }

    /// Returns the number of the reference link of a link at a level; `level`: an index in `levels`; `link`: the
    /// number of the link ([`Kinematics::link`]), which must belong to the level.
    pub(super) fn origin(&self, level: usize, link: usize) -> usize {
        self.levels[level].origin_of[link] as usize
    }
}

/// Returns the index in the assembly of the centroid of the modules that `kinematics` reaches: the module whose
/// removal leaves the smallest greatest piece.
pub(super) fn middle(robot: &Assembly, kinematics: &Kinematics) -> usize {
    let taken = vec![false; robot.modules.len()];
    let neighbours = neighbours(robot, kinematics);
    centroid(&reach(&neighbours, &taken, kinematics.root))
}

fn neighbours(robot: &Assembly, kinematics: &Kinematics) -> Vec<Vec<usize>> {
    let mut neighbours = vec![Vec::new(); robot.modules.len()];
    for &(module, bond) in &kinematics.tree.order {
        let Some(bond) = bond.map(|b| &robot.bonds[b]) else { continue };
        let other = if bond.a.module == module { bond.b.module } else { bond.a.module };
        neighbours[module].push(other);
        neighbours[other].push(module);
    }
    neighbours
}

impl ReferenceLevel {
    /// Returns the last step on the way to a link from its reference link; `None` for a reference link itself.
    /// `link`: its number ([`Kinematics::link`]), which must belong to the level.
    pub(super) fn hop_to(&self, link: usize) -> Option<&LinkStep> {
        (self.origin_of[link] as usize != link).then(|| &self.hops[self.hop_to[link] as usize])
    }

    fn new(kinematics: &Kinematics, joined: &[Vec<(usize, usize)>], seen_from: &[u32]) -> ReferenceLevel {
        let nowhere = || vec![NOWHERE; kinematics.link_count()];
        let mut level = ReferenceLevel { origin_of: nowhere(), hop_to: nowhere(), hops: Vec::new() };
        let mut centroids: Vec<u32> = seen_from.iter().copied().filter(|c| *c != NOWHERE).collect();
        centroids.sort_unstable();
        centroids.dedup();
        for centroid in centroids {
            let origin = kinematics.link(centroid as usize, 0);
            level.origin_of[origin] = origin as u32;
            let mut frontier = vec![origin];
            while let Some(from) = frontier.pop() {
                for &(index, to) in &joined[from] {
                    let beyond = seen_from[kinematics.module_of(to)] != centroid;
                    if beyond || level.origin_of[to] != NOWHERE {
                        continue;
                    }
                    level.origin_of[to] = origin as u32;
                    frontier.push(to);
                    let step = &kinematics.steps[index];
                    let (near, far) = (step.shift.norm(), step.offset.norm());
                    let (out, back) = if step.parent == from { (near, far) } else { (far, near) };
                    level.hop_to[to] = level.hops.len() as u32;
                    level.hops.push(LinkStep { from: from as u32, child: step.link as u32, out, back });
                }
            }
        }
        level
    }
}

/// Returns for each link, by its number in the kinematics, its neighbours with the index of the step between them.
fn joined(kinematics: &Kinematics) -> Vec<Vec<(usize, usize)>> {
    let mut joined = vec![Vec::new(); kinematics.link_count()];
    for (index, step) in kinematics.steps.iter().enumerate() {
        joined[step.parent].push((index, step.link));
        joined[step.link].push((index, step.parent));
    }
    joined
}

/// Returns the modules connected with `start`, each with the index of its predecessor in the list.
fn reach(neighbours: &[Vec<usize>], taken: &[bool], start: usize) -> Vec<(usize, usize)> {
    let mut part = vec![(start, 0)];
    let mut next = 0;
    while next < part.len() {
        let (module, before) = part[next];
        let back = part[before].0;
        for &other in &neighbours[module] {
            if !taken[other] && other != back {
                part.push((other, next));
            }
        }
        next += 1;
    }
    part
}

/// Returns the module whose removal leaves the smallest greatest piece; the first in the list of equals.
fn centroid(part: &[(usize, usize)]) -> usize {
    let mut below = vec![1usize; part.len()];
    let mut greatest = vec![0usize; part.len()];
    for index in (1..part.len()).rev() {
        let before = part[index].1;
        below[before] += below[index];
        greatest[before] = greatest[before].max(below[index]);
    }
    let remains = |index: usize| greatest[index].max(part.len() - below[index]);
    let best = (0..part.len()).min_by_key(|index| remains(*index)).expect("a part has a module");
    part[best].0
}
