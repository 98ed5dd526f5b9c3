//! The target: a triangle mesh that was checked, with the hinges between its faces.

use super::tolerances::TOLERANCES;
use super::unfoldable::Unfoldable;
use crate::geometry::Vec3;
use crate::geometry::soundness::EXTENT_MAX;
use std::collections::BTreeMap;

/// The greatest number of faces of a target: its layouts are counted by elimination, cubic in the faces.
pub const FACES_MAX: usize = 400;

/// A mesh that can be folded: manifold, oriented, connected, without degenerate faces. It may have a
/// boundary.
#[derive(Clone, Debug)]
pub struct Target {
    /// The positions of the corners of all faces in the frame of the target, m.
    pub vertices: Vec<Vec3>,
    /// The corners of each face as indices in `vertices`, counterclockwise seen from outside. The index of a face
    /// here, from 0, names it in the whole planner.
    pub faces: Vec<[usize; 3]>,
    /// The hinges, which are the edges of the dual graph, ascending by their first face's index, then by its side. The
    /// index of a hinge here, from 0, names it in the whole planner.
    pub hinges: Vec<Hinge>,
    /// The index in `hinges` of the hinge at each side of each face; side `k` (0 to 2) runs from corner `k` to the
    /// next. `None` at the boundary of the mesh, and between faces of which neither has motors.
    pub sides: Vec<[Option<usize>; 3]>,
}

/// A hinge of the target: a common edge of two faces, at which they can fold.
#[derive(Clone, Copy, Debug)]
pub struct Hinge {
    /// The indices of the two faces in [`Target::faces`].
    pub faces: [usize; 2],
    /// The side (0 to 2) of each of the two faces at which the hinge lies.
    pub sides: [usize; 2],
    /// The signed fold angle, rad: 0 where the faces are level, positive where the edge is convex. It is π less the
    /// interior dihedral angle.
    pub angle: f64,
    /// A point of the edge in the frame of the target, m.
    pub point: Vec3,
    /// The unit vector along the edge in the frame of the target, in the direction in which the first face runs along
    /// it. The rotation of the second face about it by `angle` folds it from level to its pose in the target; for the
    /// first face, seen from the second, the direction is the opposite ([`Hinge::axis_from`]).
    pub axis: Vec3,
}

impl Hinge {
    /// Returns the face (an index in [`Target::faces`]) across the hinge from `face`, which must be one of its two
    /// faces; of any other index, the first.
    #[inline]
    pub fn other(&self, face: usize) -> usize {
        if self.faces[0] == face { self.faces[1] } else { self.faces[0] }
    }

    /// Returns the side (0 to 2) of `face` at which the hinge lies; `face` must be one of its two faces.
    #[inline]
    pub fn side_of(&self, face: usize) -> usize {
        self.sides[usize::from(self.faces[1] == face)]
    }

    /// Returns the unit axis about which a positive turn folds the face across from `parent`, which must be one of its
    /// two faces.
    pub fn axis_from(&self, parent: usize) -> Vec3 {
        if self.faces[0] == parent { self.axis } else { -self.axis }
    }
}

impl Target {
    /// Returns the target that a mesh makes, checked and with its hinges. `vertices`: in m; `faces`: the corners of
    /// each face as indices in `vertices`, counterclockwise seen from outside.
    ///
    /// # Errors
    /// The first reason found why the mesh is not a target; [`Unfoldable::Undriven`] and [`Unfoldable::UnequalSides`]
    /// are not among them.
    pub fn new(vertices: Vec<Vec3>, faces: &[Vec<usize>]) -> Result<Target, Unfoldable> {
        if faces.is_empty() {
            return Err(Unfoldable::Empty);
        }
        if faces.len() > FACES_MAX {
            return Err(Unfoldable::TooLarge { faces: faces.len(), limit: FACES_MAX });
        }
        let mut triangles = Vec::with_capacity(faces.len());
        for (face, corners) in faces.iter().enumerate() {
            let triangle = <[usize; 3]>::try_from(corners.as_slice())
                .map_err(|_| Unfoldable::NotTriangle { face, corners: corners.len() })?;
            let far = |v: &usize| vertices.get(*v).is_some_and(|p| p.iter().any(|x| x.abs() > EXTENT_MAX));
            if triangle.iter().any(far) {
                return Err(Unfoldable::TooFar { face });
            }
            if degenerate(&vertices, triangle) {
                return Err(Unfoldable::Degenerate { face });
            }
            triangles.push(triangle);
        }
        let (hinges, sides) = hinges(&vertices, &triangles)?;
        let target = Target { vertices, faces: triangles, hinges, sides };
        target.connected()?;
        Ok(target)
    }

    /// Checks that the length of every side differs from `wanted` by at most `tol`, both in m.
    ///
    /// # Errors
    /// [`Unfoldable::UnequalSides`] for the first side whose length does not.
    pub fn check_sides(&self, wanted: f64, tol: f64) -> Result<(), Unfoldable> {
        (0..self.faces.len()).try_for_each(|face| self.check_sides_of(face, wanted, tol))
    }

    /// Checks that the lengths of the sides of one face differ from `wanted` by at most `tol`, both in m.
    ///
    /// # Errors
    /// [`Unfoldable::UnequalSides`] for the first side whose length does not.
    pub fn check_sides_of(&self, face: usize, wanted: f64, tol: f64) -> Result<(), Unfoldable> {
        match self.side_lengths(face).into_iter().find(|side| (side - wanted).abs() > tol) {
            Some(side) => Err(Unfoldable::UnequalSides { face, side, wanted }),
            None => Ok(()),
        }
    }

    /// Returns the lengths of the sides of a face (an index in [`Target::faces`]), m; entry k is that of side k, from
    /// corner k to the next. Panics if there is no such face.
    pub fn side_lengths(&self, face: usize) -> [f64; 3] {
        let corners = self.corners(face);
        [0, 1, 2].map(|k| (corners[(k + 1) % 3] - corners[k]).norm())
    }

    /// Returns the target without the hinges between two faces of which neither has motors. `driven`: for each face,
    /// in the order of [`Target::faces`], true if it has motors. Panics if it has fewer entries than there are faces.
    ///
    /// # Errors
    /// [`Unfoldable::Undriven`] if the other hinges do not connect all faces.
    pub fn driven(mut self, driven: &[bool]) -> Result<Target, Unfoldable> {
        self.hinges.retain(|hinge| hinge.faces.iter().any(|face| driven[*face]));
        self.sides = sides(&self.hinges, self.faces.len());
        self.connected().map_err(|why| match why {
            Unfoldable::Disconnected { faces } => Unfoldable::Undriven { faces },
            other => other,
        })?;
        Ok(self)
    }

    /// Returns the corners of a face (an index in [`Target::faces`]) in the frame of the target, m, counterclockwise
    /// seen from outside. Panics if there is no such face.
    pub fn corners(&self, face: usize) -> [Vec3; 3] {
        self.faces[face].map(|v| self.vertices[v])
    }

    /// Returns the centroid of a face (an index in [`Target::faces`]) in the frame of the target, m. Panics if there
    /// is no such face.
    pub fn centroid(&self, face: usize) -> Vec3 {
        let [a, b, c] = self.corners(face);
        (a + b + c) / 3.0
    }

    /// Returns the outward unit normal of a face (an index in [`Target::faces`]) in the frame of the target. Panics
    /// if there is no such face.
    pub fn normal(&self, face: usize) -> Vec3 {
        let [a, b, c] = self.corners(face);
        (b - a).cross(&(c - a)).normalize()
    }

    /// Returns the hinges of a face (an index in [`Target::faces`]) in order of its sides, each as (index in
    /// [`Target::hinges`], index of the face across it); sides without a hinge are left out. Panics if there is no
    /// such face.
    #[inline]
    pub fn around(&self, face: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.sides[face].into_iter().flatten().map(move |hinge| (hinge, self.hinges[hinge].other(face)))
    }

    /// Returns the index in [`Target::hinges`] of the hinge between two faces, given by index; of several that at the
    /// first side of `a`; `None` if there is none.
    pub fn hinge_between(&self, a: usize, b: usize) -> Option<usize> {
        self.around(a).find(|(_, other)| *other == b).map(|(hinge, _)| hinge)
    }

    /// Checks that hinges connect all faces.
    fn connected(&self) -> Result<(), Unfoldable> {
        let mut seen = vec![false; self.faces.len()];
        seen[0] = true;
        let mut waiting = vec![0];
        while let Some(face) = waiting.pop() {
            for (_, other) in self.around(face) {
                if !std::mem::replace(&mut seen[other], true) {
                    waiting.push(other);
                }
            }
        }
        match seen.iter().position(|s| !s) {
            None => Ok(()),
            Some(face) => Err(Unfoldable::Disconnected { faces: [0, face] }),
        }
    }
}

/// Returns true if a triangle names no vertex, has no area, or a coordinate that is not finite.
fn degenerate(vertices: &[Vec3], triangle: [usize; 3]) -> bool {
    let [Some(a), Some(b), Some(c)] = triangle.map(|v| vertices.get(v)) else { return true };
    let longest = [b - a, c - b, a - c].iter().map(Vec3::norm).fold(0.0, f64::max);
    let area = (b - a).cross(&(c - a)).norm();
    // Written so that a number that is none fails, too.
    !(area > TOLERANCES.flat_face * longest * longest && longest.is_finite())
}

type Hinges = (Vec<Hinge>, Vec<[Option<usize>; 3]>);

/// Finds the hinges of a mesh, and the hinge at each side of each face.
fn hinges(vertices: &[Vec3], faces: &[[usize; 3]]) -> Result<Hinges, Unfoldable> {
    let mut edges: BTreeMap<(usize, usize), Vec<(usize, usize)>> = BTreeMap::new();
    for (face, corners) in faces.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            edges.entry((a.min(b), a.max(b))).or_default().push((face, k));
        }
    }
    let mut found = Vec::new();
    for users in edges.values() {
        match users[..] {
            [_] => {}
            [p, c] => found.push(hinge(vertices, faces, p, c)?),
            _ => return Err(Unfoldable::NonManifold { faces: users.iter().map(|u| u.0).collect() }),
        }
    }
    found.sort_by_key(|hinge| (hinge.faces[0], hinge.sides[0]));
    let sides = sides(&found, faces.len());
    Ok((found, sides))
}

/// Returns the hinge at each side of each face.
fn sides(hinges: &[Hinge], faces: usize) -> Vec<[Option<usize>; 3]> {
    let mut sides = vec![[None; 3]; faces];
    for (index, hinge) in hinges.iter().enumerate() {
        for end in 0..2 {
            sides[hinge.faces[end]][hinge.sides[end]] = Some(index);
        }
    }
    sides
}

/// A face and one of its sides (0 to 2).
type Side = (usize, usize);

/// Returns the hinge between side `p` and side `c`, with the first's face as its first.
fn hinge(vertices: &[Vec3], faces: &[[usize; 3]], p: Side, c: Side) -> Result<Hinge, Unfoldable> {
    let both = [p.0, c.0];
    let (start, next) = (faces[p.0][p.1], faces[p.0][(p.1 + 1) % 3]);
    if faces[c.0][c.1] == start {
        return Err(Unfoldable::Orientation { faces: both });
    }
    let normal = |face: usize| {
        let [a, b, c] = faces[face].map(|v| vertices[v]);
        (b - a).cross(&(c - a)).normalize()
    };
    let point = vertices[start];
    let axis = (vertices[next] - point).normalize();
    let (n_p, n_c) = (normal(p.0), normal(c.0));
    let angle = libm::atan2(axis.dot(&n_p.cross(&n_c)), n_p.dot(&n_c));
    if angle.abs() > std::f64::consts::PI - TOLERANCES.back_to_back {
        return Err(Unfoldable::FoldedFlat { faces: both });
    }
    Ok(Hinge { faces: both, sides: [p.1, c.1], angle, point, axis })
}
