//! Enumeration of every layout (spanning tree), one after the other; none is stored.
//!
//! Hinges are taken in order: one is kept, then left out where the faces are still connected without it. So
//! every branch ends in a layout. Energies of a layout for all its roots come from one of them: when the root
//! crosses a hinge, the faces that it leaves are carried by the hinge from then on, and the others no longer are.

use super::layout::Layout;
use super::observer::Observer;
use super::progress_text;
use super::spanning_trees;
use super::spectrum::Spectrum;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::weights::Weights;

/// The greatest number of faces of a target that is enumerated: a set of faces is held in the bits of a 64-bit word.
pub const FACES_MAX: usize = 64;

/// The number of faces whose sums are read from a table at a time.
const CHUNK: usize = 8;

/// The result of an enumeration: the layouts of a target with their energies.
#[derive(Clone, Debug)]
pub struct Enumeration {
    /// The number of layouts that were visited.
    pub layouts: u64,
    /// True if the layouts visited are all layouts of the target; false if the budget ended the enumeration.
    pub complete: bool,
    /// The first layout found of least energy, rooted at that of the roots asked for with which it has that energy.
    pub best: Layout,
    /// The least energy, N·m for steps of one second.
    pub least: f64,
    /// The greatest energy, N·m for steps of one second.
    pub greatest: f64,
    /// The number of pairs of a layout and a root asked for whose energy is the least up to `TOLERANCES.tie`.
    pub ties: u64,
    /// The least energy with each root, by face of the target, N·m for steps of one second; infinite for roots that
    /// were not asked for.
    pub by_root: Vec<f64>,
    /// The energies that occur (N·m for steps of one second); `None` if they were not asked for.
    pub spectrum: Option<Spectrum>,
}

/// The options of [`enumerate_energies`]: which layouts are visited, and what is counted.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The only root that is considered, an index in [`Target::faces`]; `None`: every face.
    pub root: Option<usize>,
    /// True if the multiplicity of each energy is counted.
    pub spectrum: bool,
    /// The greatest number of layouts that are visited; 0 counts as 1.
    pub budget: u64,
}

/// The reason why a target is not enumerated: it has more than [`FACES_MAX`] faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooManyFaces;

/// Computes the energy of every layout (spanning tree) with every root asked for, with the leaves folded first, within
/// the budget. `observer` receives progress and may end the enumeration. `target`: the surface; `weights`: the costs
/// of its hinges for the faces that they carry. Panics if the settings name a root that is not a face.
///
/// # Errors
/// [`TooManyFaces`] for targets of more than [`FACES_MAX`] faces.
pub fn enumerate_energies(
    target: &Target,
    weights: &Weights,
    settings: &Settings,
    observer: &Observer,
) -> Result<Enumeration, TooManyFaces> {
    let sums = Sums::new(target, weights);
    let n = target.faces.len();
    let mut energies = vec![0.0; n];
    let mut best: Option<(f64, Vec<usize>, usize)> = None;
    let (mut greatest, mut ties) = (0.0, 0);
    let mut by_root = vec![f64::INFINITY; n];
    let mut spectrum: Option<Spectrum> = None;
    let mut tree = Tree::new(target);
    let (mut visited, all) = (0u64, spanning_trees::layouts(target));
    let walked = each(target, settings.budget, |hinges| {
        visited += 1;
        let least = best.as_ref().map(|(least, ..)| *least);
        observer.report(|| progress_text::counted(visited, &all, "layouts", least));
        // Energies of the layout with every root, from one of them.
        tree.root_at_first(hinges);
        tree.energies(&sums, &mut energies);
        for (root, &energy) in energies.iter().enumerate() {
            if settings.root.is_some_and(|asked| asked != root) {
                continue;
            }
            by_root[root] = by_root[root].min(energy);
            greatest = f64::max(greatest, energy);
            // The incumbent and its ties.
            match &mut best {
                Some((least, ..)) if energy > *least * (1.0 + TOLERANCES.tie) => {}
                Some((least, ..)) if energy >= *least * (1.0 - TOLERANCES.tie) => ties += 1,
                _ => {
                    best = Some((energy, hinges.to_vec(), root));
                    ties = 1;
                }
            }
            if settings.spectrum {
                let unit = if energy > 0.0 { energy } else { 1.0 };
                spectrum.get_or_insert_with(|| Spectrum::new(unit)).add(energy);
            }
        }
    })?;
    let (least, hinges, root) = best.expect("a connected target has a layout");
    let layout = Layout::of_hinges(target, &hinges, root).expect("only trees are enumerated");
    Ok(Enumeration {
        layouts: walked.layouts,
        complete: walked.complete,
        best: layout,
        least,
        greatest,
        ties,
        by_root,
        spectrum,
    })
}

/// The extent of an enumeration by [`each`].
#[derive(Clone, Copy, Debug)]
pub struct Traversal {
    /// The number of layouts that were visited.
    pub layouts: u64,
    /// True if the layouts visited are all layouts of the target; false if the budget ended the enumeration.
    pub complete: bool,
}

/// Calls `visit` with every layout, given by the indices in [`Target::hinges`] of its hinges in ascending order,
/// until `budget` layouts were visited (at least one). The order of the visits is the lexicographic one of their
/// hinges. `target`: the surface whose hinges are chosen.
///
/// # Errors
/// [`TooManyFaces`] for targets of more than [`FACES_MAX`] faces; nothing is visited then.
pub fn each(target: &Target, budget: u64, visit: impl FnMut(&[usize])) -> Result<Traversal, TooManyFaces> {
    let n = target.faces.len();
    if n > FACES_MAX {
        return Err(TooManyFaces);
    }
    let mut suffix = vec![[0u64; FACES_MAX]; target.hinges.len() + 1];
    for (index, hinge) in target.hinges.iter().enumerate().rev() {
        let [a, b] = hinge.faces;
        suffix[index] = suffix[index + 1];
        suffix[index][a] |= 1 << b;
        suffix[index][b] |= 1 << a;
    }
    let mut groups = [0u64; FACES_MAX];
    groups.iter_mut().enumerate().take(n).for_each(|(face, group)| *group = 1 << face);
    let mut walk =
        Walk { target, suffix, kept: Vec::with_capacity(n), visit, left: budget.max(1), layouts: 0 };
    walk.from(0, groups);
    // A layout that was left shows only when it is the next.
    Ok(Traversal { layouts: walk.layouts, complete: walk.left > 0 })
}

struct Walk<'t, V> {
    target: &'t Target,
    /// The neighbours of every face across each hinge and later ones.
    suffix: Vec<[u64; FACES_MAX]>,
    kept: Vec<usize>,
    visit: V,
    /// Layouts that may be seen, and one more.
    left: u64,
    layouts: u64,
}

impl<V: FnMut(&[usize])> Walk<'_, V> {
    /// Goes on with the hinges from `next`; `groups` holds for every face those that are connected with it.
    /// As deep as there are hinges.
    fn from(&mut self, next: usize, mut groups: [u64; FACES_MAX]) {
        crate::interrupt::checkpoint();
        let n = self.target.faces.len();
        if self.kept.len() + 1 == n {
            if self.layouts == self.left {
                self.left = 0;
            } else {
                self.layouts += 1;
                (self.visit)(&self.kept);
            }
            return;
        }
        let mut at = next;
        let mark = self.kept.len();
        loop {
            let [a, b] = self.target.hinges[at].faces;
            if groups[a] & (1 << b) != 0 {
                at += 1;
                continue;
            }
            // The hinge joins two components; it is needed where no later hinge does.
            let joined = groups[a] | groups[b];
            let needed = !self.reaches(at + 1, a, b, &groups);
            let mut together = groups;
            let mut rest = joined;
            while rest != 0 {
                together[rest.trailing_zeros() as usize] = joined;
                rest &= rest - 1;
            }
            // Branch with the hinge, then go on without it.
            self.kept.push(at);
            if needed && self.kept.len() + 1 < n {
                // Without a choice there is no need to go deeper.
                groups = together;
                at += 1;
                continue;
            }
            self.from(at + 1, together);
            self.kept.truncate(self.kept.len() - 1);
            if needed || self.left == 0 {
                break;
            }
            at += 1;
        }
        self.kept.truncate(mark);
    }

    /// Returns true if hinges from `next` on join two groups.
    fn reaches(&self, next: usize, a: usize, b: usize, groups: &[u64; FACES_MAX]) -> bool {
        let neighbours = &self.suffix[next];
        let (mut seen, mut fresh) = (groups[a], groups[a]);
        while fresh != 0 {
            let mut found = 0;
            while fresh != 0 {
                found |= neighbours[fresh.trailing_zeros() as usize];
                fresh &= fresh - 1;
            }
            found &= !seen;
            while found != 0 {
                let group = groups[found.trailing_zeros() as usize];
                fresh |= group;
                found &= !group;
            }
            seen |= fresh;
            if seen & (1 << b) != 0 {
                return true;
            }
        }
        false
    }
}

/// Sums of a hinge's weights over sets of faces, by table.
struct Sums {
    chunks: usize,
    /// The sums by hinge, chunk, bits of the chunk.
    table: Vec<f64>,
}

impl Sums {
    fn new(target: &Target, weights: &Weights) -> Sums {
        let chunks = target.faces.len().div_ceil(CHUNK);
        let mut table = Vec::with_capacity((target.hinges.len() * chunks) << CHUNK);
        for hinge in 0..target.hinges.len() {
            for chunk in weights.of_hinge(hinge).chunks(CHUNK) {
                for bits in 0..1usize << CHUNK {
                    table.push(
                        chunk.iter().enumerate().filter(|(i, _)| bits >> i & 1 == 1).map(|(_, w)| w).sum(),
                    );
                }
            }
        }
        Sums { chunks, table }
    }

    #[inline]
    fn over(&self, hinge: usize, set: u64) -> f64 {
        let first = (hinge * self.chunks) << CHUNK;
        let mut sum = 0.0;
        for chunk in 0..self.chunks {
            let bits = (set >> (chunk * CHUNK)) as usize & ((1 << CHUNK) - 1);
            sum += self.table[first + (chunk << CHUNK) + bits];
        }
        sum
    }
}

/// The greatest mean torque of layouts that fold with the leaves first, from sums of weights over sets of faces.
pub struct Peaks<'t> {
    sums: Sums,
    tree: Tree<'t>,
}

impl<'t> Peaks<'t> {
    /// Sets up the sums of weights; `None` if the target has more than [`FACES_MAX`] faces.
    pub fn new(target: &'t Target, weights: &Weights) -> Option<Peaks<'t>> {
        let few = target.faces.len() <= FACES_MAX;
        few.then(|| Peaks { sums: Sums::new(target, weights), tree: Tree::new(target) })
    }

    /// Sets the layout that [`greatest`](Self::greatest) is about, by the indices in [`Target::hinges`] of its hinges,
    /// which must be a spanning tree.
    pub fn set_layout(&mut self, hinges: &[usize]) {
        self.tree.root_at_first(hinges);
    }

    /// Returns the greatest mean torque of a hinge of the layout that was set last, rooted at the face `root`, N·m for
    /// steps of one second; 0 before any was set.
    pub fn greatest(&self, root: usize) -> f64 {
        let below = &self.tree.below;
        let carried = |&(face, _, hinge): &(usize, usize, usize)| {
            let turned = below[face] >> root & 1 == 1;
            self.sums.over(hinge, if turned { below[0] & !below[face] } else { below[face] })
        };
        self.tree.order[1..].iter().map(carried).fold(0.0, f64::max)
    }
}

/// A layout rooted at face 0, for reuse.
struct Tree<'t> {
    target: &'t Target,
    /// Faces, parents before children; with the parent and the hinge to it.
    order: Vec<(usize, usize, usize)>,
    /// The faces at and below each face.
    below: [u64; FACES_MAX],
    /// The kept hinges of each face and the faces across them: as many places for each face as it has sides.
    around: Vec<(u32, u32)>,
    degree: [usize; FACES_MAX],
}

impl<'t> Tree<'t> {
    fn new(target: &'t Target) -> Tree<'t> {
        Tree {
            target,
            order: Vec::with_capacity(FACES_MAX),
            below: [0; FACES_MAX],
            around: vec![(0, 0); target.arc_count()],
            degree: [0; FACES_MAX],
        }
    }

    /// Rebuilds the tree from its hinges.
    fn root_at_first(&mut self, hinges: &[usize]) {
        self.degree = [0; FACES_MAX];
        for &index in hinges {
            let [a, b] = self.target.hinges[index].faces;
            for (face, other) in [(a, b), (b, a)] {
                self.around[self.target.arcs(face).start + self.degree[face]] = (index as u32, other as u32);
                self.degree[face] += 1;
            }
        }
        self.order.clear();
        self.order.push((0, 0, usize::MAX));
        let mut next = 0;
        while next < self.order.len() {
            let (face, parent, _) = self.order[next];
            next += 1;
            self.below[face] = 1 << face;
            for &(hinge, other) in &self.around[self.target.arcs(face).start..][..self.degree[face]] {
                let (hinge, other) = (hinge as usize, other as usize);
                // Two faces may share two hinges, but a tree has only one of them.
                if other != parent || face == parent {
                    self.order.push((other, face, hinge));
                }
            }
        }
        for &(face, parent, _) in self.order[1..].iter().rev() {
            self.below[parent] |= self.below[face];
        }
    }

    /// Computes the energies by root.
    fn energies(&self, sums: &Sums, energies: &mut [f64]) {
        let all = self.below[0];
        let mut at_first = 0.0;
        for &(face, _, hinge) in &self.order[1..] {
            // For now, what crossing the hinge changes.
            let carried = sums.over(hinge, self.below[face]);
            at_first += carried;
            energies[face] = sums.over(hinge, all & !self.below[face]) - carried;
        }
        energies[0] = at_first;
        for &(face, parent, _) in &self.order[1..] {
            energies[face] += energies[parent];
        }
    }
}
