//! The symmetries of a module: the rigid displacements after which it is the same again, with the permutations of
//! links, joints and ports that they make.
//!
//! A RoFI module has no front: turned end for end, alpha and beta are exchanged and nothing else is.

use super::library::{Joint, JointKind, ModuleType, Port};
use crate::geometry::{Pose, Shape, Vec3};

/// Threshold: the difference below which lengths (m), directions (no unit), masses (kg) and moments of inertia (kg·m²)
/// are the same: rounding.
const TOL_SAME: f64 = 1e-9;

/// A symmetry of a module, by the images of its parts: each list has, for every part in the order of the module type,
/// the index of its image among the parts of its sort.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symmetry {
    /// The image of each link: the index of the link whose pose the link takes.
    pub links: Vec<usize>,
    /// The image of each joint: the index of the joint whose axis the joint takes.
    pub joints: Vec<usize>,
    /// The image of each port: the index of the port whose frame the port takes.
    pub ports: Vec<usize>,
}

impl Symmetry {
    /// Returns the symmetry that every module has: each part is its own image.
    pub fn identity(kind: &ModuleType) -> Symmetry {
        let all = |count: usize| (0..count).collect();
        Symmetry {
            links: all(kind.links.len()),
            joints: all(kind.joints.len()),
            ports: all(kind.ports.len()),
        }
    }
}

/// Returns the symmetries of a module under which equal joint positions stay equal joint positions, the identity
/// first. Left out are those that leave the first port in place, and all but the identity for modules with motors.
/// Positions agree to `TOL_SAME`, directions to `TOL_SAME_ANGLE`.
pub fn symmetries(kind: &ModuleType) -> Vec<Symmetry> {
    let mut all = vec![Symmetry::identity(kind)];
    if let Some(first) = kind.ports.first().filter(|_| kind.motors.is_empty()) {
        for port in &kind.ports[1..] {
            if port.connector == first.connector {
                let image = port.pose * first.pose.inverse();
                all.extend(Search::new(kind).from(first.link, port.link, image));
            }
        }
    }
    all
}

struct Search<'a> {
    kind: &'a ModuleType,
    /// The image of each link, and the map of its frame into the frame of that link.
    links: Vec<Option<(usize, Pose)>>,
    joints: Vec<Option<usize>>,
}

impl<'a> Search<'a> {
    fn new(kind: &'a ModuleType) -> Search<'a> {
        Search { kind, links: vec![None; kind.links.len()], joints: vec![None; kind.joints.len()] }
    }

    /// Returns the symmetry that takes a link to another with this motion; `None` if there is none.
    fn from(mut self, link: usize, to: usize, map: Pose) -> Option<Symmetry> {
        self.links[link] = Some((to, map));
        let mut open = vec![link];
        while let Some(link) = open.pop() {
            for joint in 0..self.kind.joints.len() {
                if self.joints[joint].is_none()
                    && let Some(other) = other_end(&self.kind.joints[joint], link)
                {
                    self.step(link, joint, other)?;
                    open.push(other);
                }
            }
        }
        self.finish()
    }

    /// Finds the image of a joint of `link` and of the `other` link at it; `None` if there is none.
    fn step(&mut self, link: usize, joint: usize, other: usize) -> Option<()> {
        let (to, map) = self.links[link]?;
        let axis = Axis::of(self.kind, joint, link);
        let taken = |candidate: &usize| self.joints.contains(&Some(*candidate));
        let image = (0..self.kind.joints.len()).filter(|candidate| !taken(candidate)).find(|&candidate| {
            other_end(&self.kind.joints[candidate], to).is_some()
                && alike(&self.kind.joints[joint], &self.kind.joints[candidate])
                && axis.mapped(&map).is(&Axis::of(self.kind, candidate, to))
        })?;
        let behind = other_end(&self.kind.joints[image], to)?;
        let pose = |link: usize| self.kind.links[link].pose;
        let X_LK = pose(link).inverse() * pose(other);
        let X_to = pose(to).inverse() * pose(behind);
        self.joints[joint] = Some(image);
        self.links[other] = Some((behind, X_to.inverse() * map * X_LK));
        Some(())
    }

    /// Returns the symmetry if bodies, ports and touching pairs are the same, too; `None` otherwise.
    fn finish(self) -> Option<Symmetry> {
        let kind = self.kind;
        let links: Vec<(usize, Pose)> = self.links.into_iter().collect::<Option<_>>()?;
        let joints: Vec<usize> = self.joints.into_iter().collect::<Option<_>>()?;
        for (link, (to, map)) in links.iter().enumerate() {
            same_body(kind, link, *to, map).then_some(())?;
        }
        let image = |port: &Port| {
            let (to, map) = &links[port.link];
            let pose = map * port.pose;
            kind.ports.iter().position(|candidate| {
                candidate.link == *to && candidate.connector == port.connector && near(&candidate.pose, &pose)
            })
        };
        let ports: Vec<usize> = kind.ports.iter().map(image).collect::<Option<_>>()?;
        let touching = kind.touching.iter().all(|&(a, b)| {
            let (a, b) = (links[a].0, links[b].0);
            kind.touching.contains(&(a, b)) || kind.touching.contains(&(b, a))
        });
        touching.then(|| Symmetry { links: links.iter().map(|(to, _)| *to).collect(), joints, ports })
    }
}

/// A joint's axis in the frame of one of its links: as the position grows, the other link turns about it by the
/// right-hand rule, or shifts along it.
struct Axis {
    revolute: bool,
    direction: Vec3,
    point: Vec3,
}

impl Axis {
    fn of(kind: &ModuleType, joint: usize, link: usize) -> Axis {
        let declared = &kind.joints[joint];
        let X_LJ = kind.links[link].pose.inverse() * declared.pose;
        let sign = if declared.parent == link { 1.0 } else { -1.0 };
        Axis {
            revolute: declared.kind == JointKind::Revolute,
            direction: X_LJ.rotation * declared.axis * sign,
            point: X_LJ.translation.vector,
        }
    }

    fn mapped(&self, map: &Pose) -> Axis {
        let point = map.transform_point(&self.point.into()).coords;
        Axis { revolute: self.revolute, direction: map.rotation * self.direction, point }
    }

    fn is(&self, other: &Axis) -> bool {
        let between = self.point - other.point;
        let across = between - self.direction * self.direction.dot(&between);
        (self.direction - other.direction).norm() < TOL_SAME && (!self.revolute || across.norm() < TOL_SAME)
    }
}

fn other_end(joint: &Joint, link: usize) -> Option<usize> {
    match (joint.parent == link, joint.child == link) {
        (true, _) => Some(joint.child),
        (_, true) => Some(joint.parent),
        _ => None,
    }
}

fn alike(a: &Joint, b: &Joint) -> bool {
    a.kind == b.kind
        && a.limits == b.limits
        && a.passive == b.passive
        && a.mimic.is_none()
        && b.mimic.is_none()
}

fn same_body(kind: &ModuleType, link: usize, to: usize, map: &Pose) -> bool {
    let (a, b) = (&kind.links[link], &kind.links[to]);
    let com = map.transform_point(&a.com.into()).coords;
    let R = map.rotation.to_rotation_matrix();
    let inertia = R * tensor(&a.inertia) * R.inverse();
    let same = (a.mass - b.mass).abs() < TOL_SAME
        && (com - b.com).norm() < TOL_SAME
        && (inertia - tensor(&b.inertia)).amax() < TOL_SAME
        && a.friction == b.friction
        && a.collides.len() == b.collides.len();
    same && a.collides.iter().all(|placed| {
        let pose = map * placed.pose;
        b.collides.iter().any(|other| {
            placed.shape == other.shape
                && match placed.shape {
                    // Every turn leaves a ball as it is.
                    Shape::Sphere { .. } => {
                        (pose.translation.vector - other.pose.translation.vector).norm() < TOL_SAME
                    }
                    _ => near(&pose, &other.pose),
                }
        })
    })
}

fn tensor(i: &[f64; 6]) -> nalgebra::Matrix3<f64> {
    nalgebra::Matrix3::new(i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2])
}

fn near(a: &Pose, b: &Pose) -> bool {
    let error = a.inverse() * b;
    error.translation.vector.norm() < TOL_SAME && error.rotation.angle() < TOL_SAME_ANGLE
}

/// Threshold: two orientations are the same if they differ by less than this angle, rad: more than [`TOL_SAME`], for
/// the angle of a small rotation has half as many correct digits as the entries of its matrix.
const TOL_SAME_ANGLE: f64 = 1e-7;
