//! The faces on which a shape can lie while it is folded: the root lies on the ground with its outside down, and
//! nothing may reach below it.

use super::target::Target;

/// The face that reaches the deepest below the plane of the root, which is the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Protrusion {
    /// The index of the face in [`Target::faces`].
    pub face: usize,
    /// The depth of the face's lowest corner below the plane of the root, m.
    pub depth: f64,
}

/// Returns the face that reaches the deepest below the plane of the face `root` (an index in [`Target::faces`]), on the
/// side of its outward normal; `None` if none reaches deeper than `depth`, m. Panics if there is no such root.
pub(super) fn deepest_protrusion(target: &Target, root: usize, depth: f64) -> Option<Protrusion> {
    let (down, ground) = (target.normal(root), target.centroid(root));
    let of = |face: usize| {
        let depth =
            target.corners(face).iter().map(|corner| down.dot(&(corner - ground))).fold(0.0, f64::max);
        Protrusion { face, depth }
    };
    let faces = (0..target.faces.len()).filter(|face| *face != root).map(of);
    faces.filter(|below| below.depth > depth).max_by(|a, b| a.depth.total_cmp(&b.depth))
}
