//! Embeddings of one robot in another: induced subgraph isomorphism of graphs whose edges have ports.
//!
//! A port has one bond at most, so the image of one module fixes the image of each neighbour, and of all modules of a
//! robot that is connected. A backtracking search (Ullmann 1976) has therefore one choice only, the image of the first
//! module. Cordella et al. 2004 (VF2) call the rule for further bonds that of induced subgraphs.

use super::assembly::{Assembly, PortRef};
use super::matching::same_kind;
use crate::geometry::Vec3;
use crate::interrupt;
use std::collections::{BTreeMap, VecDeque};

/// The attempt to embed a pattern with one image of its first module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EmbeddingAttempt {
    /// The index of the robot's module for each module of the pattern; `None` if there is no embedding with this image.
    pub images: Option<Vec<usize>>,
    /// The number of modules of the pattern that were compared with their images, at least 1.
    pub comparisons: usize,
}

/// Finds all embeddings of `pattern` in `robot`: maps of its modules to as many of the robot's that keep the type of
/// each module, and both ports and the turn of each bond; the two ports of a bond may be in either order, unless it has
/// a hinge whose angle would count the other way round. A further bond between two images is no embedding; bonds to other
/// modules of the robot are. All bonds count as closed, and no joint positions are compared. Embeddings that differ by
/// a symmetry of the pattern are all found. `None` if bonds do not connect the modules of the pattern, or it has none:
/// then one image does not fix the others.
///
/// The attempts are made when they are asked for, one for each module of the robot, in their order, as the image of the
/// pattern's first module. Breadth-first search along bonds finds the other images in time linear in the ports of the
/// pattern, with a logarithmic factor: all attempts take the product of the two numbers of modules at worst, also for
/// robots that are symmetrical.
pub fn embeddings(pattern: &Assembly, robot: &Assembly) -> Option<impl Iterator<Item = EmbeddingAttempt>> {
    let search = Search::new(pattern, robot);
    let order = search.breadth_first()?;
    Some((0..robot.modules.len()).map(move |first| {
        interrupt::checkpoint();
        search.attempt(&order, first)
    }))
}

/// The port that is docked at a port, with the turn of the bond.
#[derive(Clone, Copy, PartialEq)]
struct Docked {
    to: PortRef,
    turn: u32,
    /// True if this port is the first of the bond; kept only where that matters, in hinges that are not symmetric.
    leads: Option<bool>,
}

/// The port docked at each port of a robot, by module and port.
type Docks = Vec<Vec<Option<Docked>>>;

/// The bond of the pattern by which the search reaches a module: from a port of a module that was reached before.
struct Reached {
    module: usize,
    from: Option<PortRef>,
}

struct Search {
    pattern: Docks,
    robot: Docks,
    /// The type of each module of the pattern and of the robot.
    kinds: [Vec<usize>; 2],
    /// True where a module type of the pattern, by row, is one of the robot, by column.
    same: Vec<Vec<bool>>,
}

impl Search {
    fn new(pattern: &Assembly, robot: &Assembly) -> Search {
        let alike = |p: usize| {
            let types = 0..robot.library.modules.len();
            types.map(|r| same_kind((&robot.library, r), (&pattern.library, p))).collect()
        };
        Search {
            pattern: docks(pattern),
            robot: docks(robot),
            kinds: [pattern, robot].map(|of| of.modules.iter().map(|module| module.kind).collect()),
            same: (0..pattern.library.modules.len()).map(alike).collect(),
        }
    }

    /// Returns the modules of the pattern in the order of breadth-first search from the first, each with the port that
    /// leads to it; `None` if bonds do not connect them, or there are none.
    fn breadth_first(&self) -> Option<Vec<Reached>> {
        let mut known = vec![false; self.pattern.len()];
        *known.first_mut()? = true;
        let mut order = vec![Reached { module: 0, from: None }];
        let mut queue = VecDeque::from([0]);
        while let Some(module) = queue.pop_front() {
            for (port, docked) in self.pattern[module].iter().enumerate() {
                let Some(docked) = docked.filter(|docked| !known[docked.to.module]) else { continue };
                known[docked.to.module] = true;
                order.push(Reached { module: docked.to.module, from: Some(PortRef { module, port }) });
                queue.push_back(docked.to.module);
            }
        }
        (order.len() == known.len()).then_some(order)
    }

    /// Tries `first` as the image of the pattern's first module.
    fn attempt(&self, order: &[Reached], first: usize) -> EmbeddingAttempt {
        let mut comparisons = 0;
        let images = self.extend(order, first, &mut comparisons);
        EmbeddingAttempt { images, comparisons }
    }

    /// Returns the embedding that maps the pattern's first module to `first`; `None` if there is none. Adds the number of
    /// modules that it compares to `comparisons`.
    fn extend(&self, order: &[Reached], first: usize, comparisons: &mut usize) -> Option<Vec<usize>> {
        // Most attempts end early: neither table is as long as the pattern or the robot before it has to be.
        let mut images: BTreeMap<usize, usize> = BTreeMap::new();
        let mut sources: BTreeMap<usize, usize> = BTreeMap::new();
        for Reached { module, from } in order {
            *comparisons += 1;
            let image = match from {
                None => first,
                // The image of the module behind a port is the one behind the image of that port.
                Some(port) => self.robot[*images.get(&port.module)?][port.port]?.to.module,
            };
            let known = sources.insert(image, *module).is_some();
            if known || !self.same[self.kinds[0][*module]][self.kinds[1][image]] {
                return None;
            }
            images.insert(*module, image);
        }
        let images: Vec<usize> = images.into_values().collect();
        // Every bond of the pattern has its image, and bonds between images are images.
        let kept = |(module, image): (usize, &usize)| {
            self.pattern[module].iter().zip(&self.robot[*image]).all(|(here, there)| {
                let there = there.and_then(|docked| {
                    let to = PortRef { module: *sources.get(&docked.to.module)?, port: docked.to.port };
                    Some(Docked { to, ..docked })
                });
                *here == there
            })
        };
        images.iter().enumerate().all(kept).then_some(images)
    }
}

/// Returns the port docked at each port of a robot.
fn docks(robot: &Assembly) -> Docks {
    let ports = |module| vec![None; robot.module_type(module).ports.len()];
    let mut docks: Docks = (0..robot.modules.len()).map(ports).collect();
    for (index, bond) in robot.bonds.iter().enumerate() {
        for (here, to, leads) in [(bond.a, bond.b, true), (bond.b, bond.a, false)] {
            // With `X_PQ = Rot(axis, q) · Rz(180°) · Rx(turn)`, `X_QP` is that of the same angle q if `Rz(180°) · Rx(turn)`
            // reverses the axis.
            let symmetric = |axis: Vec3| axis.z == 0.0 && (axis.y == 0.0 || bond.turn == 0);
            let leads = robot.hinge(index).filter(|hinge| !symmetric(hinge.axis)).map(|_| leads);
            docks[here.module][here.port] = Some(Docked { to, turn: bond.turn, leads });
        }
    }
    docks
}
