//! Layouts: rooted spanning trees of a target's faces.

use super::target::Target;
use super::weights::Weights;

/// A layout: a spanning tree of the faces of a target, rooted at a face. Its edges are the hinges that fold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The face that keeps its pose, as an index in [`Target::faces`].
    pub root: usize,
    /// The hinge to the parent of each face, in the order of [`Target::faces`], as an index in [`Target::hinges`];
    /// `None` for the root.
    pub hinge: Vec<Option<usize>>,
    /// The parent of each face, in the order of [`Target::faces`], as an index there; the root's is its own.
    pub parent: Vec<usize>,
    /// The indices in [`Target::faces`] of all faces in breadth-first order: the root first, parents before their
    /// children.
    pub order: Vec<usize>,
}

/// The sides at which a face and its parent are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Across {
    /// The index in [`Target::faces`] of the parent of the face.
    pub parent: usize,
    /// The parent's side at the hinge, from 0.
    pub parent_side: usize,
    /// The face's side at the hinge, from 0.
    pub side: usize,
}

impl Layout {
    /// Builds a layout from the indices in [`Target::hinges`] of the hinges that fold, in any order, and its root, an
    /// index in [`Target::faces`]; `None` if they are not a spanning tree of the faces. Panics if an index is none of
    /// the target, but not if there are too many or too few hinges.
    pub fn of_hinges(target: &Target, hinges: &[usize], root: usize) -> Option<Layout> {
        let n = target.faces.len();
        if hinges.len() + 1 != n {
            return None;
        }
        let mut kept = vec![false; target.hinges.len()];
        hinges.iter().for_each(|&h| kept[h] = true);
        let mut layout =
            Layout { root, hinge: vec![None; n], parent: vec![usize::MAX; n], order: Vec::with_capacity(n) };
        layout.parent[root] = root;
        layout.order.push(root);
        let mut next = 0;
        while let Some(&face) = layout.order.get(next) {
            next += 1;
            for (hinge, other) in target.around(face) {
                if kept[hinge] && layout.parent[other] == usize::MAX {
                    layout.parent[other] = face;
                    layout.hinge[other] = Some(hinge);
                    layout.order.push(other);
                }
            }
        }
        (layout.order.len() == n).then_some(layout)
    }

    /// Builds a layout from the pairs of faces (indices in [`Target::faces`]) whose hinges fold, in any order; `None`
    /// if a pair shares no hinge or the hinges are not a spanning tree of the faces. Panics if the first face of a pair
    /// or the root is none of the target and nothing else is wrong.
    pub fn of_pairs(target: &Target, pairs: &[[usize; 2]], root: usize) -> Option<Layout> {
        let hinges: Option<Vec<usize>> = pairs.iter().map(|&[a, b]| target.hinge_between(a, b)).collect();
        Layout::of_hinges(target, &hinges?, root)
    }

    /// Returns the sides at which a face and its parent are joined. `target`: the surface that the layout is of.
    /// Panics for the root.
    pub fn across(&self, target: &Target, face: usize) -> Across {
        let hinge = &target.hinges[self.hinge[face].expect("only the root has none")];
        let parent = self.parent[face];
        Across { parent, parent_side: hinge.side_of(parent), side: hinge.side_of(face) }
    }

    /// Returns the fold angle of the hinge to a face's parent, rad, positive where the edge is convex; 0 for the
    /// root. `target`: the surface that the layout is of. Panics if there is no such face.
    pub fn angle(&self, target: &Target, face: usize) -> f64 {
        self.hinge[face].map_or(0.0, |hinge| target.hinges[hinge].angle)
    }

    /// Returns the indices in [`Target::hinges`] of the hinges that fold, in ascending order.
    pub fn hinges(&self) -> Vec<usize> {
        let mut hinges: Vec<usize> = self.hinge.iter().copied().flatten().collect();
        hinges.sort_unstable();
        hinges
    }

    /// Returns the layout with the hinge `added` instead of `dropped` (indices in [`Target::hinges`]), with the same
    /// root. `target`: the surface that the layout is of. Panics if `added` does not join the two parts into which
    /// the layout falls without `dropped`.
    pub fn exchanged(&self, target: &Target, dropped: usize, added: usize) -> Layout {
        let hinges: Vec<usize> =
            self.hinges().into_iter().map(|hinge| if hinge == dropped { added } else { hinge }).collect();
        Layout::of_hinges(target, &hinges, self.root).expect("it joins the two parts")
    }

    /// Returns the same tree of hinges rooted at another face (an index in [`Target::faces`]). Panics if the target
    /// has no such face.
    pub fn rerooted(&self, target: &Target, root: usize) -> Layout {
        Layout::of_hinges(target, &self.hinges(), root).expect("a tree is one from every root")
    }

    /// Returns [Yao et al.](super)'s energy (Eq. 5 of [Yao et al.](super)) with the leaves folded first, N·m for
    /// steps of one second: the sum over all faces of what the hinges between them and the root cost for them.
    pub fn energy(&self, weights: &Weights) -> f64 {
        let mut sum = 0.0;
        for &face in &self.order {
            let mut at = face;
            while let Some(hinge) = self.hinge[at] {
                sum += weights.at(hinge, face);
                at = self.parent[at];
            }
        }
        sum
    }

    /// Returns the depth of every face, in the order of [`Target::faces`]: the number of hinges between it and the
    /// root.
    pub fn depths(&self) -> Vec<usize> {
        let mut depths = vec![0; self.parent.len()];
        for &face in &self.order[1..] {
            depths[face] = depths[self.parent[face]] + 1;
        }
        depths
    }

    /// Returns the height of every face, in the order of [`Target::faces`]: the number of hinges between it and the
    /// farthest leaf below it; 0 for a leaf. That of the root is the height of the tree.
    pub fn heights(&self) -> Vec<usize> {
        let mut heights = vec![0; self.parent.len()];
        for &face in self.order[1..].iter().rev() {
            let parent = self.parent[face];
            heights[parent] = heights[parent].max(heights[face] + 1);
        }
        heights
    }

    /// Returns true if one of two faces (indices in [`Target::faces`]) is on the path from the root to the other, or
    /// they are the same face.
    pub fn comparable(&self, a: usize, b: usize) -> bool {
        self.is_above(a, b) || self.is_above(b, a)
    }

    /// Returns true if the face `a` is on the path from the root to the face `b` (indices in [`Target::faces`]), ends
    /// included.
    pub fn is_above(&self, a: usize, b: usize) -> bool {
        let mut at = b;
        loop {
            if at == a {
                return true;
            }
            if at == self.root {
                return false;
            }
            at = self.parent[at];
        }
    }

    /// Returns the children of every face, in the order of [`Target::faces`], each list in ascending order; empty for
    /// a leaf.
    pub fn children(&self) -> Vec<Vec<usize>> {
        let mut children = vec![Vec::new(); self.parent.len()];
        for (face, &parent) in self.parent.iter().enumerate() {
            if face != self.root {
                children[parent].push(face);
            }
        }
        children
    }
}
