//! The target: a mesh of convex polygons that was checked, with the hinges between its faces.

use super::polygon;
use super::tolerances::TOLERANCES;
use super::unfoldable::Unfoldable;
use crate::geometry::Vec3;
use crate::geometry::soundness::EXTENT_MAX;
use std::collections::BTreeMap;

/// The greatest number of faces of a target: its layouts are counted by elimination, cubic in the faces.
pub const FACES_MAX: usize = 400;

/// The greatest number of sides of a face: a set of its sides is held in the bits of a 32-bit word.
pub const SIDES_MAX: usize = 32;

/// A mesh that can be folded: manifold, oriented, connected, its faces flat, convex and not degenerate. It may have a
/// boundary.
#[derive(Clone, Debug)]
pub struct Target {
    /// The positions of the corners of all faces in the frame of the target, m.
    pub vertices: Vec<Vec3>,
    /// The corners of each face as indices in `vertices`, counterclockwise seen from outside. The index of a face
    /// here, from 0, names it in the whole planner.
    pub faces: Vec<Vec<usize>>,
    /// The hinges, which are the edges of the dual graph, ascending by their first face's index, then by its side. The
    /// index of a hinge here, from 0, names it in the whole planner.
    pub hinges: Vec<Hinge>,
    /// The index in `hinges` of the hinge at each side of each face; side `k`, from 0, runs from corner `k` to the
    /// next. `None` at the boundary of the mesh, and between faces of which neither has motors.
    pub sides: Vec<Vec<Option<usize>>>,
    /// The positions of the corners of each face, m.
    outlines: Vec<Vec<Vec3>>,
    /// The centroid (m) and the outward unit normal of each face.
    middles: Vec<(Vec3, Vec3)>,
    /// The number of sides of all faces before each face; at the end, that of all.
    first_arc: Vec<usize>,
    /// The face of each arc.
    arc_faces: Vec<u32>,
}

/// An arc into a face across one of its sides: the number of the side among those of all faces, face after face.
pub type Arc = u32;

/// A hinge of the target: a common edge of two faces, at which they can fold.
#[derive(Clone, Copy, Debug)]
pub struct Hinge {
    /// The indices of the two faces in [`Target::faces`].
    pub faces: [usize; 2],
    /// The side, from 0, of each of the two faces at which the hinge lies.
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

    /// Returns the side, from 0, of `face` at which the hinge lies; `face` must be one of its two faces.
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
        for (face, corners) in faces.iter().enumerate() {
            let places = places(&vertices, face, corners)?;
            polygon::check(&places).map_err(|fault| Unfoldable::of_outline(face, fault))?;
        }
        let outlines: Vec<Vec<Vec3>> =
            faces.iter().map(|corners| corners.iter().map(|corner| vertices[*corner]).collect()).collect();
        let middles: Vec<(Vec3, Vec3)> =
            outlines.iter().map(|outline| (polygon::centroid(outline), polygon::normal(outline))).collect();
        let hinges = hinges(&vertices, faces, &middles)?;
        let mut first_arc = vec![0];
        let mut arc_faces = Vec::new();
        for (face, corners) in faces.iter().enumerate() {
            arc_faces.extend(std::iter::repeat_n(face as u32, corners.len()));
            first_arc.push(arc_faces.len());
        }
        let mut target = Target {
            vertices,
            faces: faces.to_vec(),
            hinges,
            sides: Vec::new(),
            outlines,
            middles,
            first_arc,
            arc_faces,
        };
        target.sides = target.hinges_by_side();
        target.connected()?;
        Ok(target)
    }

    /// Returns the number of sides of a face (an index in [`Target::faces`]), which is that of its corners. Panics if
    /// there is no such face.
    #[inline]
    pub fn side_count(&self, face: usize) -> usize {
        self.arcs(face).len()
    }

    /// Returns the number of arcs: of the sides of all faces together.
    #[inline]
    pub fn arc_count(&self) -> usize {
        self.arc_faces.len()
    }

    /// Returns the arcs into a face (an index in [`Target::faces`]), in the order of its sides. Panics if there is no
    /// such face.
    #[inline]
    pub fn arcs(&self, face: usize) -> std::ops::Range<usize> {
        self.first_arc[face]..self.first_arc[face + 1]
    }

    /// Returns the index in [`Target::hinges`] of the hinge that an arc crosses; `None` where its side has none. Panics
    /// if there is no such arc.
    #[inline]
    pub fn hinge_at(&self, arc: Arc) -> Option<usize> {
        let (face, side) = self.head(arc);
        self.sides[face][side]
    }

    /// Returns the arc into a face (an index in [`Target::faces`]) across one of its sides, from 0.
    #[inline]
    pub fn arc(&self, face: usize, side: usize) -> Arc {
        (self.first_arc[face] + side) as Arc
    }

    /// Returns the face (an index in [`Target::faces`]) that an arc enters. Panics if there is no such arc.
    #[inline]
    pub fn entered(&self, arc: Arc) -> usize {
        self.arc_faces[arc as usize] as usize
    }

    /// Returns (face, side): the face (an index in [`Target::faces`]) that an arc enters, and the side, from 0, of that
    /// face. Panics if there is no such arc.
    #[inline]
    pub fn head(&self, arc: Arc) -> (usize, usize) {
        let face = self.entered(arc);
        (face, arc as usize - self.first_arc[face])
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

    /// Checks that a face is congruent with a regular panel of these [`measures`](polygon::measures) (m), whose lengths may
    /// differ by the fraction `tol`.
    ///
    /// # Errors
    /// [`Unfoldable::UnequalCorners`], [`Unfoldable::UnequalSides`] or [`Unfoldable::UnequalAngles`].
    pub fn check_panel(&self, face: usize, panel: &[f64], tol: f64) -> Result<(), Unfoldable> {
        let measures = self.measures(face);
        let sides = self.side_count(face);
        if measures.len() != panel.len() {
            let wanted = if panel.len() > 3 { panel.len() / 2 } else { panel.len() };
            return Err(Unfoldable::UnequalCorners { face, sides, wanted });
        }
        self.check_sides_of(face, panel[0], tol * panel[0])?;
        let differ = |at: &usize| (measures[*at] - panel[*at]).abs() > tol * panel[*at];
        match (sides..measures.len()).find(differ) {
            Some(at) => Err(Unfoldable::UnequalAngles { face, diagonal: measures[at], wanted: panel[at] }),
            None => Ok(()),
        }
    }

    /// Returns the [`measures`](polygon::measures) of a face (an index in [`Target::faces`]), m. Panics if there is no such
    /// face.
    pub fn measures(&self, face: usize) -> Vec<f64> {
        polygon::measures(self.corners(face))
    }

    /// Returns the corners of a face (an index in [`Target::faces`]) as they lie flat about its centroid, in the plane
    /// z = 0 with the first side along x, m; counterclockwise seen from z. Panics if there is no such face.
    pub fn outline(&self, face: usize) -> Vec<Vec3> {
        let (corners, z) = (self.corners(face), self.normal(face));
        let along = corners[1] - corners[0];
        let x = (along - z * z.dot(&along)).normalize();
        let y = z.cross(&x);
        let flat = |corner: &Vec3| {
            let away = corner - self.centroid(face);
            Vec3::new(x.dot(&away), y.dot(&away), 0.0)
        };
        corners.iter().map(flat).collect()
    }

    /// Returns the lengths of the sides of a face (an index in [`Target::faces`]), m; entry k is that of side k, from
    /// corner k to the next. Panics if there is no such face.
    pub fn side_lengths(&self, face: usize) -> Vec<f64> {
        polygon::sides(self.corners(face))
    }

    /// Returns the target without the hinges between two faces of which neither has motors. `driven`: for each face,
    /// in the order of [`Target::faces`], true if it has motors. Panics if it has fewer entries than there are faces.
    ///
    /// # Errors
    /// [`Unfoldable::Undriven`] if the other hinges do not connect all faces.
    pub fn driven(mut self, driven: &[bool]) -> Result<Target, Unfoldable> {
        self.hinges.retain(|hinge| hinge.faces.iter().any(|face| driven[*face]));
        self.sides = self.hinges_by_side();
        self.connected().map_err(|why| match why {
            Unfoldable::Disconnected { faces } => Unfoldable::Undriven { faces },
            other => other,
        })?;
        Ok(self)
    }

    /// Returns the corners of a face (an index in [`Target::faces`]) in the frame of the target, m, counterclockwise
    /// seen from outside. Panics if there is no such face.
    #[inline]
    pub fn corners(&self, face: usize) -> &[Vec3] {
        &self.outlines[face]
    }

    /// Returns the centroid of a face (an index in [`Target::faces`]) in the frame of the target, m. Panics if there
    /// is no such face.
    #[inline]
    pub fn centroid(&self, face: usize) -> Vec3 {
        self.middles[face].0
    }

    /// Returns the outward unit normal of a face (an index in [`Target::faces`]) in the frame of the target. Panics
    /// if there is no such face.
    #[inline]
    pub fn normal(&self, face: usize) -> Vec3 {
        self.middles[face].1
    }

    /// Returns the hinges of a face (an index in [`Target::faces`]) in order of its sides, each as (index in
    /// [`Target::hinges`], index of the face across it); sides without a hinge are left out. Panics if there is no
    /// such face.
    #[inline]
    pub fn around(&self, face: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.sides[face].iter().flatten().map(move |&hinge| (hinge, self.hinges[hinge].other(face)))
    }

    /// Returns the index in [`Target::hinges`] of the hinge between two faces, given by index; of several that at the
    /// first side of `a`; `None` if there is none.
    pub fn hinge_between(&self, a: usize, b: usize) -> Option<usize> {
        self.around(a).find(|(_, other)| *other == b).map(|(hinge, _)| hinge)
    }

    /// Returns the hinge at each side of each face.
    fn hinges_by_side(&self) -> Vec<Vec<Option<usize>>> {
        let mut sides: Vec<Vec<Option<usize>>> =
            self.faces.iter().map(|face| vec![None; face.len()]).collect();
        for (index, hinge) in self.hinges.iter().enumerate() {
            for end in 0..2 {
                sides[hinge.faces[end]][hinge.sides[end]] = Some(index);
            }
        }
        sides
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

/// Returns the positions of the corners of a face.
///
/// # Errors
/// [`Unfoldable`] where there are too few corners or too many, a corner names no vertex, or one is named twice, or is
/// too far away.
fn places(vertices: &[Vec3], face: usize, corners: &[usize]) -> Result<Vec<Vec3>, Unfoldable> {
    if corners.len() < 3 || corners.len() > SIDES_MAX {
        return Err(Unfoldable::Corners { face, corners: corners.len(), limit: SIDES_MAX });
    }
    let places: Option<Vec<Vec3>> = corners.iter().map(|corner| vertices.get(*corner).copied()).collect();
    let places = places.ok_or(Unfoldable::Degenerate { face })?;
    if places.iter().any(|place| place.iter().any(|x| x.abs() > EXTENT_MAX)) {
        return Err(Unfoldable::TooFar { face });
    }
    let twice = (1..corners.len()).any(|at| corners[..at].contains(&corners[at]));
    if twice { Err(Unfoldable::Degenerate { face }) } else { Ok(places) }
}

/// Finds the hinges of a mesh. `middles`: the centroid and the normal of each face.
fn hinges(
    vertices: &[Vec3],
    faces: &[Vec<usize>],
    middles: &[(Vec3, Vec3)],
) -> Result<Vec<Hinge>, Unfoldable> {
    let mut edges: BTreeMap<(usize, usize), Vec<(usize, usize)>> = BTreeMap::new();
    for (face, corners) in faces.iter().enumerate() {
        for k in 0..corners.len() {
            let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
            edges.entry((a.min(b), a.max(b))).or_default().push((face, k));
        }
    }
    let mut found = Vec::new();
    for users in edges.values() {
        match users[..] {
            [_] => {}
            [p, c] => found.push(hinge(vertices, faces, middles, p, c)?),
            _ => return Err(Unfoldable::NonManifold { faces: users.iter().map(|u| u.0).collect() }),
        }
    }
    found.sort_by_key(|hinge| (hinge.faces[0], hinge.sides[0]));
    Ok(found)
}

/// A face and one of its sides, from 0.
type Side = (usize, usize);

/// Returns the hinge between side `p` and side `c`, with the first's face as its first.
fn hinge(
    vertices: &[Vec3],
    faces: &[Vec<usize>],
    middles: &[(Vec3, Vec3)],
    p: Side,
    c: Side,
) -> Result<Hinge, Unfoldable> {
    let both = [p.0, c.0];
    let (start, next) = (faces[p.0][p.1], faces[p.0][(p.1 + 1) % faces[p.0].len()]);
    if faces[c.0][c.1] == start {
        return Err(Unfoldable::Orientation { faces: both });
    }
    let point = vertices[start];
    let axis = (vertices[next] - point).normalize();
    let (n_p, n_c) = (middles[p.0].1, middles[c.0].1);
    let angle = libm::atan2(axis.dot(&n_p.cross(&n_c)), n_p.dot(&n_c));
    if angle.abs() > std::f64::consts::PI - TOLERANCES.back_to_back {
        return Err(Unfoldable::FoldedFlat { faces: both });
    }
    Ok(Hinge { faces: both, sides: [p.1, c.1], angle, point, axis })
}
