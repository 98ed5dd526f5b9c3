//! On which faces a shape can lie while it is folded: the root lies on the ground with its outside down, and
//! nothing may reach below it.

use super::target::Target;

/// A face that reaches below another, and how far, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Protrusion {
    pub face: usize,
    pub depth: f64,
}

/// What of the target reaches deepest below the plane of a face, if it is deeper than `depth`, m.
pub fn below(target: &Target, root: usize, depth: f64) -> Option<Protrusion> {
    let (down, ground) = (target.normal(root), target.centroid(root));
    let of = |face: usize| {
        let depth =
            target.corners(face).iter().map(|corner| down.dot(&(corner - ground))).fold(0.0, f64::max);
        Protrusion { face, depth }
    };
    let faces = (0..target.faces.len()).filter(|face| *face != root).map(of);
    faces.filter(|below| below.depth > depth).max_by(|a, b| a.depth.total_cmp(&b.depth))
}
