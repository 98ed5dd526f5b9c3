//! Solids: shapes compiled into convex parts.

use super::closest_points;
use super::distance::signed_distance;
use super::hull;
use super::part::Part;
use super::pose::{Pose, Vec3};
use super::shape::{Placed, Shape};
use super::soundness::{self, Unsound};

/// Threshold: corners of a mesh may be this far inside its convex hull for the mesh to count as convex, m: rounding.
const TOL_CONVEX: f64 = 1e-9;

/// Hulls of more points than this are reduced to their corners.
const CORNERS_KEPT: usize = 200;

/// A solid compiled for distances: convex parts in the link's frame.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// The convex parts; together they are the solid, except that a mesh that is not convex is here only as its
    /// triangles.
    pub parts: Vec<Part>,
    /// Closed surfaces whose triangles are among the parts. Only the surface of a mesh that is not
    /// convex is made of parts: what is wholly inside of it is found by [`Solid::encloses`].
    shells: Vec<Vec<[Vec3; 3]>>,
    /// A point inside each convex part and inside each connected surface of a mesh, m: where no surfaces cross, some
    /// of these points are inside another solid if anything of this one is.
    probes: Vec<Vec3>,
    /// The centre of a ball around the whole solid, m, in the link's frame.
    pub centre: Vec3,
    /// The radius of the ball about [`Solid::centre`] that holds the solid, m; 0 for an empty solid.
    pub radius: f64,
    /// The least and the greatest corner of the axis-aligned box around the whole solid, m, in the link's frame; both
    /// 0 for an empty solid.
    pub bounds: (Vec3, Vec3),
}

impl Solid {
    /// Compiles placed shapes, in metres in the link's frame, into convex parts; no shapes give an empty solid. Poses
    /// must be rigid, which [`soundness::check_placed`] checks.
    ///
    /// # Errors
    /// The first [`Unsound`] fault of a shape: too thin, not finite or larger than
    /// [`EXTENT_MAX`](soundness::EXTENT_MAX), flat, or not closed.
    pub fn new(shapes: &[Placed]) -> Result<Solid, Unsound> {
        let mut solid = Solid::default();
        shapes.iter().try_for_each(|placed| solid.add(placed, &Pose::identity()))?;
        debug_assert!(solid.probes.is_empty() == solid.parts.is_empty());
        let reach =
            |n: Vec3| solid.parts.iter().map(|p| n.dot(&p.centre) + p.reach(&n)).fold(f64::MIN, f64::max);
        if !solid.parts.is_empty() {
            let high = Vec3::new(reach(Vec3::x()), reach(Vec3::y()), reach(Vec3::z()));
            let low = -Vec3::new(reach(-Vec3::x()), reach(-Vec3::y()), reach(-Vec3::z()));
            solid.centre = (low + high) / 2.0;
            let reach = |p: &Part| (p.centre - solid.centre).norm() + p.radius;
            solid.radius = solid.parts.iter().map(reach).fold(0.0, f64::max).min((high - low).norm() / 2.0);
            solid.bounds = (low, high);
        }
        Ok(solid)
    }

    /// Returns true if a point (m, in the link's frame) is inside a mesh that is not convex: convex parts do not
    /// count.
    pub fn encloses(&self, point: &Vec3) -> bool {
        self.shells.iter().any(|shell| is_inside(shell, point))
    }

    /// Returns true if the solid has a mesh that is not convex, which may enclose other solids without a contact.
    pub fn has_shells(&self) -> bool {
        !self.shells.is_empty()
    }

    /// Returns the probe point of another solid that is deepest inside the meshes of this one that are not convex, as
    /// (distance, point): its distance from their surface, m, and the point in this solid's frame, m. `None` if no
    /// probe point is inside, as in a hollow. `X_AB`: the pose of the other solid's frame (B) in this one's (A).
    ///
    /// Only a few points are tried: one inside each convex part of the other solid and one inside each connected
    /// surface of its meshes. So the distance is a lower bound on the depth to which the other solid is inside. A
    /// solid that is wholly inside is found if no surfaces cross.
    pub fn enclosed_point(&self, other: &Solid, X_AB: &Pose) -> Option<(f64, Vec3)> {
        let (low, high) = self.bounds;
        let found = |probe: &Vec3| {
            let point = X_AB.transform_point(&(*probe).into()).coords;
            let within = (0..3).all(|i| low[i] < point[i] && point[i] < high[i]);
            let around = self.shells.iter().filter(|shell| within && is_inside(shell, &point));
            let from = |t: &[Vec3; 3]| (closest_points::point_triangle(point, *t) - point).norm();
            let depth = around.map(|shell| shell.iter().map(from).fold(f64::INFINITY, f64::min));
            (depth.fold(0.0, f64::max), point)
        };
        if !self.has_shells() {
            return None;
        }
        let deepest = other.probes.iter().map(found).max_by(|x, y| x.0.total_cmp(&y.0));
        deepest.filter(|(depth, _)| *depth > 0.0)
    }

    /// Returns the penetration depth of a point (in the link's frame, m) in the convex parts, m: that in the part in
    /// which it is deepest, a lower bound on its depth in their union. 0 outside of all parts, and inside a mesh that
    /// is not convex, of which only the surface consists of parts.
    pub fn depth_of(&self, point: &Vec3) -> f64 {
        let point = Part::sphere(*point, 0.0);
        let depth = |part: &Part| -signed_distance(part, &point, &Pose::identity()).distance;
        self.parts.iter().map(depth).fold(0.0, f64::max)
    }

    /// Returns true if a point (m, in the link's frame) is on the surface of one of the parts, within `tol` (m), though
    /// it may be inside of another, such as of a pin that stands on the surface.
    pub fn has_on_surface(&self, point: &Vec3, tol: f64) -> bool {
        let point = Part::sphere(*point, 0.0);
        let distance = |part: &Part| signed_distance(part, &point, &Pose::identity()).distance;
        self.parts.iter().any(|part| distance(part).abs() <= tol)
    }

    fn add(&mut self, placed: &Placed, X_LS: &Pose) -> Result<(), Unsound> {
        soundness::check(&placed.shape)?;
        let X = X_LS * placed.pose;
        let (p, R) = (X.translation.vector, X.rotation);
        let parts_before = self.parts.len();
        let along = |axis: &Vec3, length: f64| R * axis.normalize() * (length / 2.0);
        match &placed.shape {
            Shape::Box { size } => {
                let edge = |i: usize| R * (Vec3::ith(i, size[i] / 2.0));
                self.parts.push(Part::boxed(p, [edge(0), edge(1), edge(2)]));
            }
            Shape::Cylinder { radius, length, axis } => {
                self.parts.push(Part::cylinder(p, along(axis, *length), *radius));
            }
            Shape::Sphere { radius } => self.parts.push(Part::sphere(p, *radius)),
            Shape::Capsule { radius, length, axis } => {
                self.parts.push(Part::capsule(p, along(axis, *length), *radius));
            }
            Shape::Hull { points } => self.parts.push(corners(&moved(points, &X))?),
            Shape::Mesh { vertices, triangles, .. } => return self.add_mesh(&moved(vertices, &X), triangles),
            Shape::Union { parts } => return parts.iter().try_for_each(|part| self.add(part, &X)),
        }
        self.probes.extend(self.parts[parts_before..].iter().map(Part::inner_point));
        Ok(())
    }

    /// Adds a mesh: a convex one is the hull of its vertices; any other is its triangles.
    fn add_mesh(&mut self, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), Unsound> {
        let shell: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|i| vertices[i as usize])).collect();
        if is_convex(&shell, vertices) {
            let hull = corners(vertices)?;
            self.probes.push(hull.inner_point());
            self.parts.push(hull);
        } else {
            let largest = largest_triangles(&shell, triangles, vertices.len());
            self.probes.extend(largest.into_iter().map(|triangle| beneath(&shell, triangle)));
            self.parts.extend(shell.iter().map(|triangle| Part::points(triangle)));
            self.shells.push(shell);
        }
        Ok(())
    }
}

fn moved(points: &[Vec3], X: &Pose) -> Vec<Vec3> {
    points.iter().map(|p| X.transform_point(&(*p).into()).coords).collect()
}

fn corners(points: &[Vec3]) -> Result<Part, Unsound> {
    if points.len() <= CORNERS_KEPT {
        return Ok(Part::points(points));
    }
    let faces = hull::faces(points).ok_or(Unsound::Flat)?;
    Ok(Part::points(&faces.points))
}

/// Returns the index of the largest triangle of each connected surface, in ascending order of the least vertex that
/// the surface has.
fn largest_triangles(shell: &[[Vec3; 3]], triangles: &[[u32; 3]], vertices: usize) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..vertices).collect();
    for &[a, b, c] in triangles {
        for other in [b, c] {
            let (x, y) = (root(&mut parent, a as usize), root(&mut parent, other as usize));
            parent[x.max(y)] = x.min(y);
        }
    }
    let mut largest: Vec<Option<(f64, usize)>> = vec![None; vertices];
    for (index, ([a, b, c], corners)) in shell.iter().zip(triangles).enumerate() {
        let area = (b - a).cross(&(c - a)).norm();
        let known = &mut largest[root(&mut parent, corners[0] as usize)];
        if known.is_none_or(|(greatest, _)| area > greatest) {
            *known = Some((area, index));
        }
    }
    largest.into_iter().flatten().map(|(_, index)| index).collect()
}

/// Returns the least vertex that is connected with a vertex, and shortens the way to it.
fn root(parent: &mut [usize], mut vertex: usize) -> usize {
    while parent[vertex] != vertex {
        parent[vertex] = parent[parent[vertex]];
        vertex = parent[vertex];
    }
    vertex
}

/// Returns a point inside a closed surface beneath the middle of one of its triangles (m): halfway to the surface on
/// the other side; the middle itself where rounding hides the other side.
fn beneath(shell: &[[Vec3; 3]], index: usize) -> Vec3 {
    let [a, b, c] = shell[index];
    let middle = (a + b + c) / 3.0;
    let inwards = -(b - a).cross(&(c - a)).normalize();
    let others = shell.iter().enumerate().filter(|(other, _)| *other != index);
    let hits = others.filter_map(|(_, triangle)| hit(&middle, &inwards, triangle));
    let halfway = middle + inwards * (hits.fold(f64::INFINITY, f64::min) / 2.0);
    if halfway.iter().all(|x| x.is_finite()) && is_inside(shell, &halfway) { halfway } else { middle }
}

/// Returns the distance at which a ray from `start` (m) along a unit vector meets a triangle, m; `None` if it does not
/// (Möller and Trumbore 1997).
fn hit(start: &Vec3, along: &Vec3, [a, b, c]: &[Vec3; 3]) -> Option<f64> {
    let (u, v, from) = (b - a, c - a, start - a);
    let determinant = u.dot(&along.cross(&v));
    let (x, y) = (from.dot(&along.cross(&v)) / determinant, along.dot(&from.cross(&u)) / determinant);
    let distance = v.dot(&from.cross(&u)) / determinant;
    (x >= 0.0 && y >= 0.0 && x + y <= 1.0 && distance > 0.0).then_some(distance)
}

/// Returns true if a point is inside a closed surface (m): by its winding number, the sum of the solid angles of the
/// triangles over the whole sphere, which is 0 in a hollow.
fn is_inside(shell: &[[Vec3; 3]], point: &Vec3) -> bool {
    let angle: f64 = shell.iter().map(|t| solid_angle(&t.map(|corner| corner - point))).sum();
    angle > std::f64::consts::TAU
}

/// Returns true if no vertex is outside the plane of any triangle.
fn is_convex(shell: &[[Vec3; 3]], vertices: &[Vec3]) -> bool {
    shell.iter().all(|[a, b, c]| {
        let normal = (b - a).cross(&(c - a));
        let tol = TOL_CONVEX * normal.norm();
        vertices.iter().all(|v| normal.dot(&(v - a)) <= tol)
    })
}

/// Returns the solid angle of a triangle seen from the origin, signed: positive from behind (van Oosterom and
/// Strackee 1983).
fn solid_angle([a, b, c]: &[Vec3; 3]) -> f64 {
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let volume = a.dot(&b.cross(c));
    let rest = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    2.0 * libm::atan2(volume, rest)
}
