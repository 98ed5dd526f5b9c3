//! Shapes as triangle meshes with sharp edges, for pictures that are rendered here and not in a browser.
#![allow(non_snake_case)]

use super::primitives::{Primitive, primitives};
use crate::geometry::{Placed, Pose, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// The number of facets of a full circle.
const ROUND: usize = 40;
/// The least number of them in a small picture.
const ROUND_MIN: usize = 12;
/// The width of a picture in pixels from which a full circle has [`ROUND`] facets; below, as many fewer.
const WIDTH_ROUND: usize = 320;

/// Adjacent faces whose normals have a greater cosine than this are shaded smoothly: 32 degrees.
const SMOOTH: f64 = 0.848;

/// The radius of the edges of boxes and cylinders in pictures, as a part of their least side.
const ROUNDING: f64 = 0.085;

/// A triangle mesh with its sharp edges; lengths in metres.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    /// The triangles as (corners in metres, counter-clockwise as seen from outside; normals at them, of length 1,
    /// outwards), in the frame of the mesh.
    pub triangles: Vec<([Vec3; 3], [Vec3; 3])>,
    /// The sharp edges by their ends, in metres, in the frame of the mesh; they are drawn as lines.
    pub edges: Vec<[Vec3; 2]>,
    /// The number of facets of a full circle of what is added, an even number.
    round: usize,
}

impl Mesh {
    /// Returns an empty mesh for a picture of a width in pixels: round bodies have fewer facets in a small one, which hardly
    /// shows a difference.
    pub(super) fn for_width(width: usize) -> Mesh {
        let round = (ROUND * width / WIDTH_ROUND / 2 * 2).clamp(ROUND_MIN, ROUND);
        Mesh { triangles: Vec::new(), edges: Vec::new(), round }
    }

    /// Returns the mesh of the shapes of a link, in the link's frame.
    pub(super) fn of(shapes: &[Placed]) -> Mesh {
        let mut mesh = Mesh::for_width(WIDTH_ROUND);
        primitives(shapes, &mut |X, piece| match piece {
            Primitive::Box { size } => mesh.add_box(X, &size),
            Primitive::Tube { radius, length } => mesh.tube(X, radius, length),
            Primitive::Ball { radius } => mesh.ball(X, radius),
            Primitive::Surface { points, triangles } => mesh.surface(X, points, triangles),
        });
        mesh
    }

    /// Returns the mesh of the shapes of a link, in the link's frame, as pictures show it: the edges of boxes and cylinders
    /// are rounded. `width`: the width of the picture in pixels.
    pub(super) fn rounded(shapes: &[Placed], width: usize) -> Mesh {
        let mut mesh = Mesh::for_width(width);
        primitives(shapes, &mut |X, piece| match piece {
            Primitive::Box { size } => mesh.rounded_box(X, &size),
            Primitive::Tube { radius, length } => mesh.rounded_tube(X, radius, length),
            Primitive::Ball { radius } => mesh.ball(X, radius),
            Primitive::Surface { points, triangles } => mesh.surface(X, points, triangles),
        });
        mesh
    }

    /// Adds a box with rounded edges: each corner is one of three faces, drawn in from the others, and strips and corners
    /// lie between them.
    pub(super) fn rounded_box(&mut self, X: &Pose, size: &Vec3) {
        let radius = ROUNDING * size.min();
        let corner = |signs: [f64; 3], face: usize| {
            let at = |k: usize| signs[k] * (size[k] / 2.0 - if k == face { 0.0 } else { radius });
            let mut normal = Vec3::zeros();
            normal[face] = signs[face];
            (Vec3::new(at(0), at(1), at(2)), normal)
        };
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let signs = |a: f64, b: f64, c: f64| {
                let mut signs = [0.0; 3];
                (signs[axis], signs[u], signs[v]) = (a, b, c);
                signs
            };
            for side in [-1.0, 1.0] {
                let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                self.fan(X, &ring.map(|(b, c)| corner(signs(side, b, c), axis)));
                for other in [-1.0, 1.0] {
                    let ends = [signs(-1.0, side, other), signs(1.0, side, other)];
                    let strip = [(0, u), (1, u), (1, v), (0, v)].map(|(end, face)| corner(ends[end], face));
                    self.fan(X, &strip);
                    let middle =
                        |a: usize, b: usize| X.transform_point(&((strip[a].0 + strip[b].0) / 2.0).into());
                    self.edges.push([middle(0, 3).coords, middle(1, 2).coords]);
                }
            }
        }
        for i in 0..8 {
            let signs = [0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 });
            self.fan(X, &[0, 1, 2].map(|face| corner(signs, face)));
        }
    }

    /// Adds a cylinder along z with rounded rims, centred at the origin of frame `X`; radius and length in metres.
    pub(super) fn rounded_tube(&mut self, X: &Pose, radius: f64, length: f64) {
        let drawn_in = ROUNDING * f64::min(2.0 * radius, length);
        let round = self.round;
        let out = |i: usize| {
            let (s, c) = libm::sincos(TAU * (i % round) as f64 / round as f64);
            Vec3::new(c, s, 0.0)
        };
        let side = |i: usize, z: f64| (out(i) * radius + Vec3::z() * (z * (length / 2.0 - drawn_in)), out(i));
        let lid =
            |i: usize, z: f64| (out(i) * (radius - drawn_in) + Vec3::z() * (z * length / 2.0), Vec3::z() * z);
        for i in 0..round {
            self.fan(X, &[side(i, -1.0), side(i + 1, -1.0), side(i + 1, 1.0), side(i, 1.0)]);
            for z in [-1.0, 1.0] {
                let rim = [side(i, z), side(i + 1, z), lid(i + 1, z), lid(i, z)];
                self.fan(X, &rim);
                self.fan(X, &[(Vec3::z() * (z * length / 2.0), Vec3::z() * z), lid(i, z), lid(i + 1, z)]);
                let middle = |a: usize, b: usize| X.transform_point(&((rim[a].0 + rim[b].0) / 2.0).into());
                self.edges.push([middle(0, 3).coords, middle(1, 2).coords]);
            }
        }
    }

    /// Adds a convex polygon, given by its corners and the normals there in frame `X`, turned so that it faces along them.
    fn fan(&mut self, X: &Pose, ring: &[(Vec3, Vec3)]) {
        let points: Vec<Vec3> = ring.iter().map(|(p, _)| X.transform_point(&(*p).into()).coords).collect();
        let normals: Vec<Vec3> = ring.iter().map(|(_, n)| X.rotation * n).collect();
        for i in 2..ring.len() {
            let [a, b, c] = [0, i - 1, i];
            let faces = (points[b] - points[a]).cross(&(points[c] - points[a]));
            let order =
                if faces.dot(&(normals[a] + normals[b] + normals[c])) < 0.0 { [a, c, b] } else { [a, b, c] };
            self.triangles.push((order.map(|k| points[k]), order.map(|k| normals[k])));
        }
    }

    /// Adds a box centred at the origin of frame `X`; `size` holds its edge lengths in metres.
    pub(super) fn add_box(&mut self, X: &Pose, size: &Vec3) {
        let corner = |i: usize| {
            let side = |axis: usize| if i >> axis & 1 == 1 { size[axis] / 2.0 } else { -size[axis] / 2.0 };
            Vec3::new(side(0), side(1), side(2))
        };
        let points: Vec<Vec3> = (0..8).map(corner).collect();
        const FACES: [[u32; 4]; 6] =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> =
            FACES.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        self.surface(X, &points, &triangles);
    }

    /// Adds a cylinder along z, centred at the origin of frame `X`; radius and length in metres.
    pub(super) fn tube(&mut self, X: &Pose, radius: f64, length: f64) {
        let round = self.round;
        let rim = |i: usize, z: f64| {
            let (s, c) = libm::sincos(TAU * i as f64 / round as f64);
            Vec3::new(radius * c, radius * s, z * length)
        };
        let out = |i: usize| X.rotation * rim(i, 0.0).normalize();
        let at = |p: Vec3| X.transform_point(&p.into()).coords;
        for i in 0..round {
            let [a, b, c, d] = [rim(i, -0.5), rim(i + 1, -0.5), rim(i + 1, 0.5), rim(i, 0.5)].map(at);
            let (n, m) = (out(i), out(i + 1));
            self.triangles.push(([a, b, c], [n, m, m]));
            self.triangles.push(([a, c, d], [n, m, n]));
            for (z, p, q) in [(-0.5, b, a), (0.5, d, c)] {
                let normal = X.rotation * Vec3::new(0.0, 0.0, 2.0 * z);
                self.triangles.push(([at(Vec3::new(0.0, 0.0, z * length)), p, q], [normal; 3]));
                self.edges.push([p, q]);
            }
        }
    }

    /// Adds a ball around the origin of frame `X`; radius in metres.
    pub(super) fn ball(&mut self, X: &Pose, radius: f64) {
        let (around, down) = (self.round, self.round / 2);
        let point = |i: usize, j: usize| {
            let (s, c) = libm::sincos(TAU * i as f64 / around as f64);
            let (sin, cos) = libm::sincos(PI * j as f64 / down as f64);
            X.rotation * Vec3::new(sin * c, sin * s, cos)
        };
        for (i, j) in (0..around).flat_map(|i| (0..down).map(move |j| (i, j))) {
            let n = [point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)];
            let p = n.map(|n| n * radius + X.translation.vector);
            self.triangles.push(([p[0], p[1], p[2]], [n[0], n[1], n[2]]));
            self.triangles.push(([p[0], p[2], p[3]], [n[0], n[2], n[3]]));
        }
    }

    /// Adds a surface and its sharp edges: a corner gets the mean normal of the faces around it that are nearly level
    /// with the face.
    fn surface(&mut self, X: &Pose, points: &[Vec3], triangles: &[[u32; 3]]) {
        let at = |i: u32| X.transform_point(&points[i as usize].into()).coords;
        let corners: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(at)).collect();
        let normal =
            |[a, b, c]: &[Vec3; 3]| (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vec3::z);
        let normals: Vec<Vec3> = corners.iter().map(normal).collect();
        let mut around: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        let mut sides: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        for (t, [a, b, c]) in triangles.iter().enumerate() {
            [a, b, c].into_iter().for_each(|i| around.entry(*i).or_default().push(t));
            for (i, j) in [(a, b), (b, c), (c, a)] {
                sides.entry((*i.min(j), *i.max(j))).or_default().push(t);
            }
        }
        for (t, triangle) in triangles.iter().enumerate() {
            let smooth = |i: u32| {
                let near = around[&i].iter().filter(|o| normals[**o].dot(&normals[t]) > SMOOTH);
                near.map(|o| normals[*o]).sum::<Vec3>().normalize()
            };
            self.triangles.push((corners[t], triangle.map(smooth)));
        }
        let sharp = sides.iter().filter(|(_, faces)| match faces[..] {
            [a, b] => normals[a].dot(&normals[b]) < SMOOTH,
            _ => true,
        });
        self.edges.extend(sharp.map(|((i, j), _)| [at(*i), at(*j)]));
    }

    /// Returns the mesh transformed by `X`: a mesh in frame B for `X_AB` becomes one in frame A.
    pub(super) fn moved(&self, X: &Pose) -> Mesh {
        let at = |p: Vec3| X.transform_point(&p.into()).coords;
        let triangles = self.triangles.iter().map(|(p, n)| (p.map(at), n.map(|n| X.rotation * n)));
        let edges = self.edges.iter().map(|e| e.map(at));
        Mesh { triangles: triangles.collect(), edges: edges.collect(), round: self.round }
    }
}
