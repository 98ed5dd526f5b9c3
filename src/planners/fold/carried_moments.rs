//! Mean torques of hinges for any order of folding, without gravity: what a hinge carries is one rigid body whose
//! form depends on which of the hinges below it have folded before.
//!
//! In the frame of the target a folded hinge changes nothing between its two faces, and a level one turns what is
//! below it about one fixed line. Instead of the faces, the line of the hinge that moves is carried down the tree:
//! it is turned back at every level hinge, and each face tells its moment of inertia about the line that arrives.

use super::inertia::{Body, Inertia};
use super::kinematics::about;
use super::layout::Layout;
use super::target::Target;
use super::weights::QUINTIC;
use crate::geometry::Vec3;
use nalgebra::Matrix3;

/// A line of a hinge: a point of it, m, and its unit vector.
#[derive(Clone, Copy)]
struct Line {
    point: Vec3,
    axis: Vec3,
}

/// The faces of a target as rigid bodies, and its hinges as lines, for the moments that hinges carry.
pub(super) struct CarriedMoments<'t> {
    /// The surface that folds.
    pub(super) target: &'t Target,
    /// The centre (m), mass (kg) and inertia about the centre (kg·m²) of every face, in the frame of the target.
    bodies: Vec<Body>,
    /// The line of every hinge in the target.
    lines: Vec<Line>,
    /// The displacement that folds each hinge, of what is below it while it is level; by hinge, and by which of its
    /// two faces is above.
    closing: Vec<[(Matrix3<f64>, Vec3); 2]>,
    /// The mean torque of each hinge by the moment of inertia that it carries, 1/s² for steps of one second.
    factors: Vec<f64>,
}

impl<'t> CarriedMoments<'t> {
    /// Returns the bodies and lines of a target; `masses`: by face, kg; `inertia`: how the mass of a panel is spread.
    pub(super) fn new(target: &'t Target, masses: &[f64], inertia: Inertia) -> CarriedMoments<'t> {
        let line = |hinge: &super::target::Hinge| Line { point: hinge.point, axis: hinge.axis };
        let closing = |hinge: &super::target::Hinge| {
            [0, 1].map(|above| {
                let pose = about(&hinge.point, hinge.axis_from(hinge.faces[above]), hinge.angle);
                (pose.rotation.to_rotation_matrix().into_inner(), pose.translation.vector)
            })
        };
        CarriedMoments {
            target,
            bodies: Body::of_target(target, masses, inertia),
            lines: target.hinges.iter().map(line).collect(),
            closing: target.hinges.iter().map(closing).collect(),
            factors: target.hinges.iter().map(|hinge| QUINTIC * hinge.angle.abs()).collect(),
        }
    }

    /// Returns the moment of inertia of a face about a line in the frame of the target, kg·m².
    fn moment(&self, face: usize, line: &Line) -> f64 {
        let body = &self.bodies[face];
        let arm = body.centre - line.point;
        let along = arm.dot(&line.axis);
        line.axis.dot(&(body.inertia * line.axis)) + body.mass * (arm.norm_squared() - along * along)
    }

    /// Returns the mean torque of the hinge of a face that folds after those faces of which `folded` is true, N·m for
    /// steps of one second. `children`: the children of every face in the layout. `visited` counts the faces carried.
    /// Panics for the root.
    pub(super) fn mean(
        &self,
        layout: &Layout,
        children: &[Vec<usize>],
        face: usize,
        folded: impl Fn(usize) -> bool,
        visited: &mut u64,
    ) -> f64 {
        let hinge = layout.hinge[face].expect("the root does not fold");
        if self.factors[hinge] == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        let mut waiting = vec![(face, self.lines[hinge])];
        while let Some((at, line)) = waiting.pop() {
            *visited += 1;
            sum += self.moment(at, &line);
            for &child in &children[at] {
                let line = if folded(child) { line } else { self.closed(layout, child, &line) };
                waiting.push((child, line));
            }
        }
        self.factors[hinge] * sum
    }

    /// Returns a line seen from below the hinge of a face that is level: turned as that hinge turns when it folds.
    fn closed(&self, layout: &Layout, face: usize, line: &Line) -> Line {
        let hinge = layout.hinge[face].expect("the root is carried by none");
        let above = usize::from(self.target.hinges[hinge].faces[1] == layout.parent[face]);
        let (rotation, shift) = &self.closing[hinge][above];
        Line { point: rotation * line.point + shift, axis: rotation * line.axis }
    }

    /// Returns the energy of a layout in an order, N·m for steps of one second: `rank` is the place of each face in
    /// it, and that of the root has no meaning. `visited` counts the faces carried.
    pub(super) fn energy(&self, layout: &Layout, rank: &[usize], visited: &mut u64) -> f64 {
        let children = layout.children();
        let mean = |&face: &usize| self.mean(layout, &children, face, |b| rank[b] < rank[face], visited);
        layout.order[1..].iter().map(mean).sum()
    }
}
