//! Forward kinematics of a layout: the poses of the faces by the angles of the hinges.

use super::layout::Layout;
use super::target::Target;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3};

/// Returns the displacement of every face from its pose in the target, in the frame of the target, in the order of
/// [`Target::faces`], when the hinges of the faces for which `folded(face)` is true have folded and the others are
/// level. That of the root is the identity; a face at its pose in the target has it, too. `layout`: the tree of the
/// target's hinges that fold.
///
/// A child's displacement is its parent's after a rotation about the line of the hinge in the target by the difference
/// between the hinge's angle and its fold angle.
pub fn poses(target: &Target, layout: &Layout, folded: impl Fn(usize) -> bool) -> Vec<Pose> {
    poses_at(target, layout, |face| {
        let hinge = layout.hinge[face].expect("only the root has none");
        if folded(face) { target.hinges[hinge].angle } else { 0.0 }
    })
}

/// Returns the displacement of every face from its pose in the target, in the frame of the target, in the order of
/// [`Target::faces`], when the hinge between each face but the root and its parent is at `angle(face)`, rad: 0 is
/// level, [`Hinge::angle`](super::target::Hinge::angle) is folded. That of the root is the identity. `layout`: the
/// tree of the target's hinges that fold.
pub fn poses_at(target: &Target, layout: &Layout, angle: impl Fn(usize) -> f64) -> Vec<Pose> {
    let mut poses = vec![Pose::identity(); target.faces.len()];
    for &face in &layout.order[1..] {
        let hinge = &target.hinges[layout.hinge[face].expect("only the root has none")];
        let missing = angle(face) - hinge.angle;
        let parent = layout.parent[face];
        let turn = about(&hinge.point, hinge.axis_from(parent), missing);
        poses[face] = if missing == 0.0 { poses[parent] } else { poses[parent] * turn };
    }
    poses
}

/// Returns the rotation about the line through a point (m) along a unit axis by an angle (rad, by the right-hand
/// rule), as a displacement in the frame of point and axis.
pub fn about(point: &Vec3, axis: Vec3, angle: f64) -> Pose {
    shifted(*point) * turned(axis, angle) * shifted(-point)
}
