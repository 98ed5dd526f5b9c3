//! Connected groups of faces of a shape, by flood fill across the sides of faces.

use crate::planners::fold::Target;

/// Returns the number of connected components (across sides of faces) of the faces for which `gone` is false and that
/// are not connected with any of the faces `first`; faces are indices in [`Target::faces`]. Panics if one of `first`
/// is not a face.
pub(super) fn groups(
    target: &Target,
    gone: impl Fn(usize) -> bool,
    first: impl Iterator<Item = usize>,
) -> usize {
    let mut seen: Vec<bool> = (0..target.faces.len()).map(gone).collect();
    let flood = |seen: &mut Vec<bool>, mut stack: Vec<usize>| {
        while let Some(face) = stack.pop() {
            for (_, other) in target.around(face) {
                if !std::mem::replace(&mut seen[other], true) {
                    stack.push(other);
                }
            }
        }
    };
    let first: Vec<usize> = first.collect();
    first.iter().for_each(|face| seen[*face] = true);
    flood(&mut seen, first);
    let mut groups = 0;
    for face in 0..seen.len() {
        if !std::mem::replace(&mut seen[face], true) {
            groups += 1;
            flood(&mut seen, vec![face]);
        }
    }
    groups
}
