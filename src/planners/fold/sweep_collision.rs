//! Sampled sweep collision check of panels in motion: it spares the judge plans that it would reject. Panels
//! are polygons without thickness (separating axes of the triangles of their fans), or solids. A layout that passes is
//! not proved.

use super::kinematics::poses_at;
use super::layout::Layout;
use super::polygon;
use super::simulation::quintic;
use super::target::Target;
use super::tolerances::TOLERANCES;
use crate::geometry::distance::signed_distance_within;
use crate::geometry::pose::shifted;
use crate::geometry::{Part, Pose, Vec3};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

/// The number of states of each step that are sampled.
const SAMPLES: usize = 24;

type Triangle = [Vec3; 3];

/// A collision of two panels in a step of folding, as a sample shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Collision {
    /// The index of the first step in which they collide, from 0.
    pub step: usize,
    /// The two faces, as indices in [`Target::faces`], the lesser first.
    pub faces: [usize; 2],
}

/// Returns the first collision of panels without thickness in the samples of a layout that folds in steps, each a
/// list of faces (indices in [`Target::faces`]) whose hinges fold at the same time; `None` if no sample shows one.
/// `shrunk`: the part, 0 to 1, by which faces are shrunk towards their centroids, so that neighbours do not
/// collide. `target`: the surface that the layout is of.
pub fn first_collision(
    target: &Target,
    layout: &Layout,
    steps: &[Vec<usize>],
    shrunk: f64,
) -> Option<Collision> {
    let check = SweepCheck::thin(target, layout, shrunk);
    let mut folded = vec![false; target.faces.len()];
    steps.iter().enumerate().find_map(|(step, moving)| {
        let found = check.pair_during(&folded, moving).map(|faces| Collision { step, faces });
        moving.iter().for_each(|face| folded[*face] = true);
        found
    })
}

/// The panels of a target with thickness, by face: convex parts in the panel frame, whose origin is the centroid of the
/// face, with x towards the middle of its side 0 and z along its outward normal.
#[derive(Clone, Debug)]
pub struct Solids {
    /// The convex parts of each face's panel, in the order of the target's faces, in the panel frame.
    pub parts: Vec<Vec<Part>>,
    /// The depth to which two panels may enter each other without a collision, m.
    pub touch: f64,
}

/// Returns the pairs of panels (indices in [`Target::faces`], the lesser first) that penetrate each other by more
/// than `touch` in the target itself, neighbours included; ordered by the greater face, then by the lesser. `solids`:
/// the panels.
pub fn target_collisions(target: &Target, solids: &Solids) -> Vec<[usize; 2]> {
    let parts = placed(target, solids);
    let reach = reach(target, &parts);
    let solids = Solids { parts, touch: solids.touch };
    let faces = 0..target.faces.len();
    let middles: Vec<Vec3> = faces.clone().map(|face| target.centroid(face)).collect();
    let near = |[a, b]: &[usize; 2]| (middles[*a] - middles[*b]).norm() < reach[*a] + reach[*b];
    let pairs = faces.flat_map(|b| (0..b).map(move |a| [a, b])).filter(near);
    pairs.filter(|pair| solids.meet(*pair, &Pose::identity())).collect()
}

/// Returns the parts of all panels in their poses in the target.
fn placed(target: &Target, solids: &Solids) -> Vec<Vec<Part>> {
    let of_face = |(face, parts): (usize, &Vec<Part>)| -> Vec<Part> {
        let place = place(target, face);
        parts.iter().map(|part| part.moved(&place)).collect()
    };
    solids.parts.iter().enumerate().map(of_face).collect()
}

/// Returns the greatest distance of each face's parts from its middle, m.
fn reach(target: &Target, parts: &[Vec<Part>]) -> Vec<f64> {
    let of_face = |(face, parts): (usize, &Vec<Part>)| {
        let middle = target.centroid(face);
        parts.iter().map(|part| (part.centre - middle).norm() + part.radius).fold(0.0, f64::max)
    };
    parts.iter().enumerate().map(of_face).collect()
}

/// The collision check of one layout, for samples of the steps in which it folds.
pub struct SweepCheck<'t> {
    target: &'t Target,
    layout: &'t Layout,
    form: Form,
    /// The radius of each face's bounding sphere about the centroid, m.
    reach: Vec<f64>,
}

/// The panels in their poses in the target.
enum Form {
    /// The fan of each face, shrunk.
    Fans(Vec<Vec<Triangle>>),
    Solids(Solids),
}

impl<'t> SweepCheck<'t> {
    /// Returns the check for panels without thickness: faces shrunk towards their centroids by the fraction
    /// `shrunk` (0 to 1), so that neighbours do not collide. `target` and `layout`: the surface and how it is
    /// unfolded.
    pub fn thin(target: &'t Target, layout: &'t Layout, shrunk: f64) -> SweepCheck<'t> {
        let smaller = |face: usize| {
            let middle = target.centroid(face);
            let smaller = |corner: Vec3| middle + (corner - middle) * (1.0 - shrunk);
            polygon::fan(target.corners(face)).map(|triangle| triangle.map(smaller)).collect()
        };
        let small: Vec<Vec<Triangle>> = (0..target.faces.len()).map(smaller).collect();
        let reach = |(face, fan): (usize, &Vec<Triangle>)| {
            let corners = fan.iter().flatten();
            corners.map(|p| (p - target.centroid(face)).norm()).fold(0.0, f64::max)
        };
        let reach = small.iter().enumerate().map(reach).collect();
        SweepCheck { target, layout, form: Form::Fans(small), reach }
    }

    /// Returns the check for panels with thickness; panels that a hinge of the layout joins are built to touch, and
    /// are not checked against each other. `target` and `layout`: the surface and how it is unfolded; `solids`: the
    /// panels.
    pub fn thick(target: &'t Target, layout: &'t Layout, solids: &Solids) -> SweepCheck<'t> {
        let parts = placed(target, solids);
        let reach = reach(target, &parts);
        SweepCheck { target, layout, form: Form::Solids(Solids { parts, touch: solids.touch }), reach }
    }

    /// Returns two faces (indices in [`Target::faces`], the lesser first) that collide in a sample of a step in which
    /// the hinges of the faces `moving` fold at the same time; `None` if no sample shows any. No face of `moving` may
    /// be above another; `folded`: for each face, true if its hinge has folded before.
    pub fn pair_during(&self, folded: &[bool], moving: &[usize]) -> Option<[usize; 2]> {
        let against = moving_against(self.layout, moving);
        (1..=SAMPLES).find_map(|sample| {
            let state = self.step_state(folded, moving, sample as f64 / SAMPLES as f64);
            against.iter().find(|pair| self.meet(&state, **pair)).copied()
        })
    }

    /// Returns the pairs of faces (indices in [`Target::faces`], the lesser first) that collide in the samples of a
    /// layout that folds in steps, ascending and each once; once more than `most` were met, counted anew in each step,
    /// no others are searched for.
    /// `samples`: the number of states sampled of each step, at least 1.
    pub fn collisions(&self, steps: &[Vec<usize>], samples: usize, most: usize) -> Vec<[usize; 2]> {
        let mut folded = vec![false; self.reach.len()];
        let mut met: Vec<[usize; 2]> = Vec::new();
        for moving in steps {
            let mut against = moving_against(self.layout, moving);
            for sample in 1..=samples {
                let state = self.step_state(&folded, moving, sample as f64 / samples as f64);
                against.retain(|pair| {
                    let meet = met.len() <= most && self.meet(&state, *pair);
                    met.extend(meet.then_some(*pair));
                    !meet
                });
            }
            moving.iter().for_each(|face| folded[*face] = true);
        }
        met.sort_unstable();
        met.dedup();
        met
    }

    /// Returns the state when a part of the time of a step is over.
    fn step_state(&self, folded: &[bool], moving: &[usize], time: f64) -> State {
        let full = |face: usize| self.layout.angle(self.target, face);
        let part = quintic(time, 1.0).angle;
        self.state(|face| match folded[face] {
            true => full(face),
            false if moving.contains(&face) => full(face) * part,
            false => 0.0,
        })
    }

    /// Returns the state in which the hinge between each face but the root and its parent is at `angle(face)`, rad.
    pub(super) fn state(&self, angle: impl Fn(usize) -> f64) -> State {
        crate::interrupt::checkpoint();
        let poses = poses_at(self.target, self.layout, angle);
        let placed = |face: usize| poses[face].transform_point(&self.target.centroid(face).into()).coords;
        let middles = (0..self.reach.len()).map(placed).collect();
        State { poses, middles }
    }

    /// Returns true if two faces (indices in [`Target::faces`]) collide in a state.
    pub(super) fn meet(&self, State { poses, middles }: &State, [a, b]: [usize; 2]) -> bool {
        let away = self.reach[a] + self.reach[b];
        if (middles[a] - middles[b]).norm_squared() >= away * away {
            return false;
        }
        match &self.form {
            Form::Fans(small) => {
                let placed = |face: usize, triangle: &Triangle| {
                    triangle.map(|p| poses[face].transform_point(&p.into()).coords)
                };
                small[a].iter().any(|p| {
                    let p = placed(a, p);
                    small[b].iter().any(|q| !separated(&p, &placed(b, q)))
                })
            }
            // Those on a common hinge are built to touch.
            Form::Solids(solids) => {
                let on_hinge = self.layout.parent[a] == b || self.layout.parent[b] == a;
                !on_hinge && solids.meet([a, b], &(poses[a].inverse() * poses[b]))
            }
        }
    }
}

/// The poses of the panels in one state of folding.
pub(super) struct State {
    /// The displacement of each face from its pose in the target.
    pub(super) poses: Vec<Pose>,
    /// The centroid of each face, m.
    middles: Vec<Vec3>,
}

impl Solids {
    /// Returns true if the panels of two faces (indices in `parts`) penetrate each other by more than `touch`; `X_AB`:
    /// the pose of the frame of the second's parts in that of the first's.
    pub fn meet(&self, [a, b]: [usize; 2], X_AB: &Pose) -> bool {
        let meet =
            |p: &Part, q: &Part| signed_distance_within(p, q, X_AB, None, -self.touch).distance < -self.touch;
        self.parts[a].iter().any(|p| self.parts[b].iter().any(|q| meet(p, q)))
    }
}

/// Returns the frame of a panel at a face of the target.
fn place(target: &Target, face: usize) -> Pose {
    panel_pose(target.corners(face), &target.normal(face))
}

/// Returns the pose of the panel frame ([`Solids`]) of a face with these corners (m), at least three, and this
/// outward unit normal, in the frame of the corners. `z`: the normal.
pub fn panel_pose(corners: &[Vec3], z: &Vec3) -> Pose {
    let middle = polygon::centroid(corners);
    let x = ((corners[0] + corners[1]) / 2.0 - middle).normalize();
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), *z]));
    let turn = Pose::from_parts(Vec3::zeros().into(), UnitQuaternion::from_rotation_matrix(&turn));
    shifted(middle) * turn
}

/// Returns the pairs of faces, the lesser first, with a moving hinge between them.
fn moving_against(layout: &Layout, moving: &[usize]) -> Vec<[usize; 2]> {
    let faces = layout.parent.len();
    let mut carried = vec![0usize; faces];
    // For each face: a number for the set of moving hinges above it.
    for &face in &layout.order[1..] {
        let above = carried[layout.parent[face]];
        carried[face] = if moving.contains(&face) { face + 1 } else { above };
    }
    // No two hinges of one path move in the same step, so one hinge determines the set.
    let pairs = (0..faces).flat_map(|b| (0..b).map(move |a| [a, b]));
    pairs.filter(|&[a, b]| carried[a] != carried[b]).collect()
}

/// Returns true if a plane across some axis separates two triangles (separating axis test).
fn separated(a: &Triangle, b: &Triangle) -> bool {
    let edges = |t: &Triangle| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (of_a, of_b) = (edges(a), edges(b));
    let (normal_a, normal_b) = (of_a[0].cross(&of_a[1]), of_b[0].cross(&of_b[1]));
    let parts = |axis: Vec3, scale: f64| {
        let range = |t: &Triangle| {
            let d = t.map(|p| axis.dot(&p));
            (d[0].min(d[1]).min(d[2]), d[0].max(d[1]).max(d[2]))
        };
        let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
        axis.norm() > TOLERANCES.axis * scale && (high_a < low_b || high_b < low_a)
    };
    let area = normal_a.norm().max(normal_b.norm());
    // Those of triangles in one plane as well.
    parts(normal_a, area)
        || parts(normal_b, area)
        || of_a.iter().any(|u| of_b.iter().any(|v| parts(u.cross(v), area)))
        || of_a.iter().any(|u| parts(normal_a.cross(u), area * u.norm()))
        || of_b.iter().any(|u| parts(normal_b.cross(u), area * u.norm()))
}
