//! The spanning tree of a robot's modules over the bonds that hold, breadth first.

use super::assembly::Assembly;

/// A spanning tree over the modules that bonds connect with the root, and the bonds that close loops over it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// Reached modules (indices in the assembly), parents before children, the root first; each with the index of the
    /// bond that leads to it, `None` for the root.
    pub order: Vec<(usize, Option<usize>)>,
    /// Indices of the bonds between reached modules that hold and close a loop, ascending.
    pub closing: Vec<usize>,
    /// Indices of the modules that no bond that holds connects with the root, ascending.
    pub loose: Vec<usize>,
}

/// Returns the breadth-first tree from the module of index `root` over the bonds for which `holds`, by the index of
/// the bond, is true. Neighbours are visited in order of bond, so that the tree depends on nothing but the assembly.
/// Panics if there is no such module or `holds` is too short.
pub(super) fn grow(robot: &Assembly, holds: &[bool], root: usize) -> Tree {
    let mut bonds_of = vec![Vec::new(); robot.modules.len()];
    for (index, bond) in robot.bonds.iter().enumerate().filter(|(index, _)| holds[*index]) {
        bonds_of[bond.a.module].push(index);
        bonds_of[bond.b.module].push(index);
    }
    let mut reached = vec![false; robot.modules.len()];
    let mut used = vec![false; robot.bonds.len()];
    let mut order = vec![(root, None)];
    reached[root] = true;
    let mut next = 0;
    while next < order.len() {
        let module = order[next].0;
        for &index in &bonds_of[module] {
            let bond = &robot.bonds[index];
            let other = if bond.a.module == module { bond.b.module } else { bond.a.module };
            if !reached[other] {
                reached[other] = true;
                used[index] = true;
                order.push((other, Some(index)));
            }
        }
        next += 1;
    }
    let closing = (0..robot.bonds.len())
        .filter(|&b| holds[b] && !used[b] && reached[robot.bonds[b].a.module])
        .collect();
    let loose = (0..robot.modules.len()).filter(|&m| !reached[m]).collect();
    Tree { order, closing, loose }
}
