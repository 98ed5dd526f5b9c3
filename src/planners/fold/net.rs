//! The cut net of a layout: one sheet in the plane whose edges are hinges or outline.
//!
//! Along a cut the corners of both faces are kept apart, so the net is a disk even where faces of it
//! touch.

use super::kinematics::poses_at;
use super::layout::{Across, Layout};
use super::pattern::{Pattern, Point};
use super::target::Target;
use crate::geometry::{Pose, Vec3};

/// A cut net of a layout in the plane: a topological disk of polygons, each a face of the target.
#[derive(Clone, Debug)]
pub struct Net {
    /// The positions of the vertices in the plane, m; the root's first corner is the origin, its first side goes
    /// along x.
    pub vertices: Vec<Point>,
    /// A face with which each vertex moves, and the face's corner that it is.
    owners: Vec<(usize, usize)>,
    /// The corners of each face of the target, in the order of [`Target::faces`], as indices in `vertices`.
    pub faces: Vec<Vec<usize>>,
    /// The edges: first the hinges that fold, in the order of the layout's faces without the root, then the outline,
    /// face by face.
    pub edges: Vec<Edge>,
}

/// An edge of a net: a hinge of the layout, or an edge of the outline.
#[derive(Clone, Debug)]
pub struct Edge {
    /// The indices of the edge's ends in [`Net::vertices`], in the direction in which its first face runs along it.
    pub vertices: [usize; 2],
    /// The indices in [`Target::faces`] of the faces at the edge: the one on its left, which for a hinge is the
    /// parent; for a hinge then the child, on its right.
    pub faces: Vec<usize>,
    /// The fold angle of a hinge of the layout in the target, rad; `None` for an edge of the outline.
    pub angle: Option<f64>,
    /// The index in [`Net::edges`] of the edge of the outline that coincides with this one in the target; `None` for a
    /// hinge of the layout and at the boundary of the target.
    pub glued: Option<usize>,
}

impl Net {
    /// Returns the cut net of a layout of a target; its faces may overlap in the plane.
    pub fn of(target: &Target, layout: &Layout) -> Net {
        let pattern = Pattern::of(target, layout);
        let n = target.faces.len();
        let mut net = Net {
            vertices: pattern.corners[layout.root].clone(),
            owners: (0..target.side_count(layout.root)).map(|corner| (layout.root, corner)).collect(),
            faces: vec![Vec::new(); n],
            edges: Vec::new(),
        };
        net.faces[layout.root] = (0..target.side_count(layout.root)).collect();
        for &face in &layout.order[1..] {
            let Across { parent, parent_side: k, side: m } = layout.across(target, face);
            let (from, to) = (net.faces[parent][k], net.faces[parent][(k + 1) % net.faces[parent].len()]);
            let sides = target.side_count(face);
            let mut corners = vec![0; sides];
            (corners[m], corners[(m + 1) % sides]) = (to, from);
            for free in (2..sides).map(|k| (m + k) % sides) {
                corners[free] = net.vertices.len();
                net.vertices.push(pattern.corners[face][free]);
                net.owners.push((face, free));
            }
            net.faces[face] = corners;
            let hinge = layout.hinge[face].expect("only the root has none");
            let angle = Some(target.hinges[hinge].angle);
            net.edges.push(Edge { vertices: [from, to], faces: vec![parent, face], angle, glued: None });
        }
        net.outline(target, layout);
        net
    }

    /// Adds the edges of the outline.
    fn outline(&mut self, target: &Target, layout: &Layout) {
        let mut first: Vec<Option<usize>> = vec![None; target.hinges.len()];
        for face in 0..target.faces.len() {
            for side in 0..target.side_count(face) {
                let hinge = target.sides[face][side];
                let folds =
                    |hinge: usize| target.hinges[hinge].faces.iter().any(|f| layout.hinge[*f] == Some(hinge));
                if hinge.is_some_and(folds) {
                    continue;
                }
                let number = self.edges.len();
                let corners = &self.faces[face];
                let glued = hinge.and_then(|hinge| first[hinge].replace(number));
                if let Some(other) = glued {
                    self.edges[other].glued = Some(number);
                }
                let vertices = [corners[side], corners[(side + 1) % corners.len()]];
                self.edges.push(Edge { vertices, faces: vec![face], angle: None, glued });
            }
        }
    }

    /// Returns the positions (m) of all vertices, in the order of [`Net::vertices`], with the hinge of each face but
    /// the root at `angle(face)` (rad, 0 is level), in the frame of the flat net: the root stays in the plane z = 0,
    /// its outside up. `target` and `layout`: those that the net was cut from.
    pub fn vertices_at(&self, target: &Target, layout: &Layout, angle: impl Fn(usize) -> f64) -> Vec<Vec3> {
        let X_TF = poses_at(target, layout, angle);
        let (a, b) = (target.corners(layout.root)[0], target.corners(layout.root)[1]);
        let z = target.normal(layout.root);
        let x = (b - a).normalize();
        let axes = nalgebra::Matrix3::from_columns(&[x, z.cross(&x), z]);
        let turn = nalgebra::Rotation3::from_matrix_unchecked(axes).into();
        let X_TN = Pose::from_parts(a.into(), turn);
        let place = |&(face, corner): &(usize, usize)| {
            let target_collisions = X_TF[face].transform_point(&target.corners(face)[corner].into());
            X_TN.inverse_transform_point(&target_collisions).coords
        };
        self.owners.iter().map(place).collect()
    }
}
