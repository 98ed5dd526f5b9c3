//! The chains of a robot: modules that bonds between ends join.

use super::ends::Ends;
use crate::planners::tosnake::fewest_changes;
use crate::robot::{Assembly, Bond, PortRef};
use std::collections::{BTreeSet, VecDeque};

/// The bonds of a robot at some time, seen as chains of modules.
pub(super) struct Chains<'a> {
    robot: &'a Assembly,
    holds: &'a [bool],
    ends: &'a Ends,
    /// True if only bonds without a turn count that join the first end of a module with the second one of another, so that all
    /// modules of a snake lie alike.
    alike: bool,
    /// The chain of each module, by the least index of a module in it.
    of: Vec<usize>,
}

impl<'a> Chains<'a> {
    /// Returns the chains of the bonds that hold. `ends`: the ends of each module; `alike`: true if modules are to lie in the snake
    /// all the same way.
    pub(super) fn new(robot: &'a Assembly, holds: &'a [bool], ends: &'a Ends, alike: bool) -> Chains<'a> {
        let mut chains = Chains { robot, holds, ends, alike, of: (0..robot.modules.len()).collect() };
        for bond in chains.holding().filter(|bond| chains.is_of_snake(*bond)).collect::<Vec<_>>() {
            let Bond { a, b, .. } = robot.bonds[bond];
            let (low, high) =
                (chains.of[a.module].min(chains.of[b.module]), chains.of[a.module].max(chains.of[b.module]));
            chains.of.iter_mut().filter(|chain| **chain == high).for_each(|chain| *chain = low);
        }
        chains
    }

    /// Iterates over the indices of the bonds that hold.
    fn holding(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.holds.len()).filter(|bond| self.holds[*bond])
    }

    /// Returns true if a bond joins ends of two modules as they are to be joined in the snake.
    fn is_of_snake(&self, bond: usize) -> bool {
        let Bond { a, b, turn } = self.robot.bonds[bond];
        let joins = a.module != b.module && [a, b].iter().all(|port| self.is_end(*port));
        joins && (!self.alike || turn == 0 && self.is_in_line([a, b]))
    }

    fn is_end(&self, port: PortRef) -> bool {
        self.ends[port.module].contains(&port.port)
    }

    /// Returns the number of bonds of the snake that hold.
    pub(super) fn made(&self) -> usize {
        self.holding().filter(|bond| self.is_of_snake(*bond)).count()
    }

    /// Returns the least number of bonds that have to be docked or undocked so that there is one chain.
    pub(super) fn fewest_changes(&self) -> usize {
        let bonds = self.holding().map(|bond| {
            let Bond { a, b, .. } = self.robot.bonds[bond];
            ([a.module, b.module], self.is_of_snake(bond))
        });
        fewest_changes(self.robot.modules.len(), bonds)
    }

    /// Returns the bonds to let go so that those that hold have no loop: of a loop, if possible, none between ends.
    pub(super) fn loops(&self) -> Vec<usize> {
        let mut bonds: Vec<usize> = self.holding().collect();
        bonds.sort_by_key(|bond| !self.is_of_snake(*bond));
        let mut piece: Vec<usize> = (0..self.robot.modules.len()).collect();
        bonds.retain(|bond| {
            let Bond { a, b, .. } = self.robot.bonds[*bond];
            let [p, q] = [a, b].map(|port| piece[port.module]);
            piece.iter_mut().filter(|other| **other == q).for_each(|other| *other = p);
            p == q
        });
        bonds
    }

    /// Returns the first module that no bonds join to module 0.
    pub(super) fn apart(&self) -> Option<usize> {
        (0..self.robot.modules.len()).find(|module| self.path(0, *module).is_none())
    }

    /// Returns all pairs of free ends of two chains that may be joined in the snake.
    pub(super) fn pairs(&self) -> Vec<[PortRef; 2]> {
        let ends =
            (0..self.ends.len()).flat_map(|module| self.ends[module].map(|port| PortRef { module, port }));
        let pairs = self.free_pairs(ends.collect());
        pairs.into_iter().filter(|pair| !self.alike || self.is_in_line(*pair)).collect()
    }

    /// Returns all pairs of free docks of two chains that mate: docks that mate with their like.
    pub(super) fn other_pairs(&self) -> Vec<[PortRef; 2]> {
        let mates = |a: PortRef, b: PortRef| {
            let [a, b] = [a, b].map(|port| self.robot.module_type(port.module).ports[port.port].connector);
            self.robot.library.connectors[a].mates.contains(&b)
        };
        let ports = (0..self.robot.modules.len()).flat_map(|module| {
            let count = self.robot.module_type(module).ports.len();
            (0..count).map(move |port| PortRef { module, port })
        });
        let docks = ports.filter(|port| mates(*port, *port) && self.robot.connector(*port).hinge.is_none());
        self.free_pairs(docks.collect()).into_iter().filter(|[a, b]| mates(*a, *b)).collect()
    }

    /// Returns the pairs of free ports of two chains.
    fn free_pairs(&self, ports: Vec<PortRef>) -> Vec<[PortRef; 2]> {
        let taken: BTreeSet<PortRef> =
            self.holding().flat_map(|bond| [self.robot.bonds[bond].a, self.robot.bonds[bond].b]).collect();
        let free: Vec<PortRef> = ports.into_iter().filter(|port| !taken.contains(port)).collect();
        let mut pairs = Vec::new();
        for (index, a) in free.iter().enumerate() {
            let others = free[index + 1..].iter().filter(|b| self.of[a.module] != self.of[b.module]);
            pairs.extend(others.map(|b| [*a, *b]));
        }
        pairs
    }

    /// Returns true if two ends are the first one of a module and the second one of another.
    fn is_in_line(&self, pair: [PortRef; 2]) -> bool {
        let [a, b] = pair.map(|port| self.ends[port.module][0] == port.port);
        a != b
    }

    /// Returns the bonds that may be let go when a new one joins the modules of two chains: those between the two that are none of
    /// the snake, the ones that free the most ends first.
    pub(super) fn replaced(&self, bond: Bond) -> Vec<usize> {
        let path = self.path(bond.a.module, bond.b.module).unwrap_or_default();
        let frees = |bond: &usize| {
            let Bond { a, b, .. } = self.robot.bonds[*bond];
            [a, b].iter().filter(|port| self.is_end(**port)).count()
        };
        let mut bonds: Vec<usize> = path.into_iter().filter(|bond| !self.is_of_snake(*bond)).collect();
        bonds.sort_by_key(|bond| (2 - frees(bond), *bond));
        bonds
    }

    /// Returns the bonds on a way from a module to another; `None` where there is none.
    fn path(&self, from: usize, to: usize) -> Option<Vec<usize>> {
        let mut came: Vec<Option<(usize, usize)>> = vec![None; self.robot.modules.len()];
        let mut open = VecDeque::from([from]);
        while let Some(module) = open.pop_front() {
            if module == to {
                let (mut at, mut path) = (to, Vec::new());
                while at != from {
                    let (before, bond) = came[at].expect("it was reached");
                    path.push(bond);
                    at = before;
                }
                return Some(path);
            }
            for bond in self.holding() {
                let Bond { a, b, .. } = self.robot.bonds[bond];
                for (here, there) in [(a.module, b.module), (b.module, a.module)] {
                    if here == module && there != from && came[there].is_none() {
                        came[there] = Some((module, bond));
                        open.push_back(there);
                    }
                }
            }
        }
        None
    }
}
