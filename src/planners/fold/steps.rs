//! Steps of a folding: hinges that fold at the same time.

use super::layout::Layout;

/// Returns the leaves-first order (Alg. 2 of [Yao et al.](super)): the hinges of the leaves fold first, then those of
/// the faces that are leaves without them. The result has one list of faces (indices in the target) for each step,
/// each ascending; there are as many steps as the tree is high.
pub fn leaves_first(layout: &Layout) -> Vec<Vec<usize>> {
    let heights = layout.heights();
    layered(layout, |face| heights[face])
}

/// Returns true if every hinge folds after all hinges that it carries. `steps`: the faces but the root, by indices in the target, in
/// the steps in which their hinges fold.
pub(super) fn are_leaves_first(layout: &Layout, steps: &[Vec<usize>]) -> bool {
    let mut step_of = vec![usize::MAX; layout.parent.len()];
    for (step, faces) in steps.iter().enumerate() {
        faces.iter().for_each(|face| step_of[*face] = step);
    }
    (0..layout.parent.len())
        .filter(|face| *face != layout.root)
        .all(|face| step_of[face] < step_of[layout.parent[face]])
}

/// Returns the root-first order: the hinges of the root's children fold first, then those of their children. The
/// result has one list of faces (indices in the target) for each step, each ascending; there are as many steps as the
/// tree is high.
pub fn root_first(layout: &Layout) -> Vec<Vec<usize>> {
    let depths = layout.depths();
    layered(layout, |face| depths[face] - 1)
}

/// Returns the faces but the root by their layer, which counts steps from 0.
fn layered(layout: &Layout, layer: impl Fn(usize) -> usize) -> Vec<Vec<usize>> {
    let mut steps: Vec<Vec<usize>> = Vec::new();
    for face in (0..layout.parent.len()).filter(|face| *face != layout.root) {
        let layer = layer(face);
        if steps.len() <= layer {
            steps.resize(layer + 1, Vec::new());
        }
        steps[layer].push(face);
    }
    steps
}

/// Lays an order of faces into the fewest steps in which each face folds after every face that precedes it in the
/// order and is above or below it in the tree: one step after the last of these. `order`: indices of faces in the
/// target, each at most once, without the root. The result has one list of faces for each step, each ascending.
/// `layout`: the tree. Panics if `order` names a face that is not in the tree.
///
/// This is the purpose of Alg. 3 of [Yao et al.](super), which as printed puts all faces into one step, loses the last,
/// and may let a face overtake another on its path.
pub fn of_order(layout: &Layout, order: &[usize]) -> Vec<Vec<usize>> {
    let mut step = vec![0; layout.parent.len()];
    let mut steps: Vec<Vec<usize>> = Vec::new();
    for (i, &face) in order.iter().enumerate() {
        let earlier = order[..i].iter().filter(|other| layout.comparable(face, **other));
        step[face] = earlier.map(|other| step[*other] + 1).max().unwrap_or(0);
        if steps.len() <= step[face] {
            steps.resize(step[face] + 1, Vec::new());
        }
        steps[step[face]].push(face);
    }
    steps.iter_mut().for_each(|faces| faces.sort_unstable());
    steps
}
