//! The joints of a piece as controllers see them, and their exact motion between breakpoints.

use super::pieces::Piece;
use crate::plan::{Tracks, polynomial};
use crate::robot::{JointId, JointKind, JointOwner, Step};

/// A joint of a piece.
pub(super) struct JointMotion {
    /// The number of the joint in its `JointId`.
    pub(super) joint: usize,
    /// The link that it moves, by its number.
    pub(super) link: usize,
    /// The joints, by their numbers, and factors whose sum is its position.
    pub(super) terms: Vec<(usize, f64)>,
    /// True if it slides: positions in m; false for rad.
    pub(super) slides: bool,
    /// True if it has no motor.
    pub(super) passive: bool,
}

impl JointMotion {
    /// Returns (joint, factor) of the one other joint that it follows; `None` if it follows none or several.
    pub(super) fn follows(&self) -> Option<(usize, f64)> {
        match self.terms[..] {
            [(joint, factor)] if joint != self.joint => Some((joint, factor)),
            _ => None,
        }
    }

    /// Returns true if a controller commands it: it has a motor, and follows no single other joint.
    pub(super) fn is_commanded(&self) -> bool {
        !self.passive && self.follows().is_none()
    }

    /// Returns the position, rad or m, from the positions of all joints of the robot.
    pub(super) fn position(&self, joints: &[f64]) -> f64 {
        self.terms.iter().map(|(joint, factor)| factor * joints[*joint]).sum()
    }
}

/// Returns the joints of a piece that move, by the links that they move, in the order of its links.
pub(super) fn joints(tracks: &Tracks, piece: &Piece) -> Vec<JointMotion> {
    let robot = &tracks.robot;
    let kinematics = &piece.kinematics;
    let mut found = Vec::new();
    for &(module, bond) in &kinematics.tree.order {
        let hinge = bond.and_then(|bond| Some((bond, kinematics.hinge(bond)?)));
        if let Some((bond, joint)) = hinge {
            let declared = &robot.bonds[bond];
            let at = if declared.b.module == module { declared.b } else { declared.a };
            found.push((kinematics.port_link(robot, at), joint, false, false));
        }
        for (index, joint) in robot.module_type(module).joints.iter().enumerate() {
            if joint.kind == JointKind::Fixed {
                continue;
            }
            let [a, b] = [joint.parent, joint.child].map(|link| kinematics.link(module, link));
            let child =
                |link: usize, parent: usize| kinematics.step(link).is_some_and(|s| s.parent == parent);
            let link = if child(b, a) { b } else { a };
            let slides = joint.kind == JointKind::Prismatic;
            found.push((link, kinematics.joint(module, index), slides, joint.passive));
        }
    }
    let place: Vec<usize> = piece.links();
    let mut rank = vec![0; kinematics.link_count()];
    place.iter().enumerate().for_each(|(rank_of, link)| rank[*link] = rank_of);
    found.sort_by_key(|(link, ..)| rank[*link]);
    let of = |(link, joint, slides, passive): (usize, usize, bool, bool)| {
        let terms = kinematics.step(link).map_or(&[][..], Step::terms).to_vec();
        JointMotion { joint, link, terms, slides, passive }
    };
    found.into_iter().map(of).collect()
}

/// Returns the owner of a joint, by its number. Panics if there is none.
pub(super) fn owner(tracks: &Tracks, joint: usize) -> JointOwner {
    tracks.robot.joints().nth(joint).expect("joints are numbered as they are listed")
}

/// The motion of joints between two breakpoints: each is one polynomial.
pub(super) struct Stretch {
    /// The start and the end, s.
    pub(super) between: (f64, f64),
    /// For each joint the terms as (factor, polynomial).
    joints: Vec<Vec<(f64, Polynomial)>>,
}

/// A polynomial in Bernstein form over an interval of time, with its two derivatives; or a constant.
struct Polynomial {
    start: f64,
    length: f64,
    forms: [Vec<f64>; 3],
}

impl Polynomial {
    fn value(&self, order: usize, t: f64) -> f64 {
        let form = &self.forms[order];
        if form.is_empty() {
            return 0.0;
        }
        let scale = (0..order).fold(1.0, |scale, _| scale / self.length);
        polynomial::value(form, ((t - self.start) / self.length).clamp(0.0, 1.0)) * scale
    }
}

impl Stretch {
    /// Returns the stretches of a piece for some of its joints, in order of time; at least one, which lasts no time where
    /// the piece does.
    pub(super) fn all(tracks: &Tracks, piece: &Piece, joints: &[JointMotion]) -> Vec<Stretch> {
        let mut times = vec![piece.from, piece.to];
        let of = |joint: &usize| tracks.track(JointId(*joint as u32));
        for track in joints.iter().flat_map(|joint| &joint.terms).filter_map(|(joint, _)| of(joint)) {
            let ends = track.segments.iter().flat_map(|segment| [segment.start, segment.end]);
            times.extend(ends.filter(|t| piece.from < *t && *t < piece.to));
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        let mut pairs: Vec<(f64, f64)> = times.windows(2).map(|pair| (pair[0], pair[1])).collect();
        if pairs.is_empty() {
            pairs.push((piece.from, piece.to));
        }
        pairs.into_iter().map(|between| Stretch::new(tracks, joints, between)).collect()
    }

    fn new(tracks: &Tracks, joints: &[JointMotion], between: (f64, f64)) -> Stretch {
        let middle = between.0 + (between.1 - between.0) / 2.0;
        let of = |joint: usize| {
            let track = tracks.track(JointId(joint as u32));
            let segments = track.map_or(&[][..], |track| &track.segments);
            let next = segments.partition_point(|segment| segment.start <= middle);
            let last = next.checked_sub(1).map(|last| &segments[last]);
            match last {
                Some(segment) if middle < segment.end => {
                    let first = polynomial::derivative(&segment.control);
                    let second = if first.len() > 1 { polynomial::derivative(&first) } else { Vec::new() };
                    let length = segment.end - segment.start;
                    Polynomial {
                        start: segment.start,
                        length,
                        forms: [segment.control.clone(), first, second],
                    }
                }
                _ => {
                    let at = last.map_or(tracks.start.joints[joint], |segment| segment.last());
                    Polynomial { start: 0.0, length: 1.0, forms: [vec![at], Vec::new(), Vec::new()] }
                }
            }
        };
        let terms =
            |joint: &JointMotion| joint.terms.iter().map(|(joint, factor)| (*factor, of(*joint))).collect();
        Stretch { between, joints: joints.iter().map(terms).collect() }
    }

    /// Returns positions, velocities and accelerations of the joints at a time (s) within the stretch.
    pub(super) fn at(&self, t: f64) -> [Vec<f64>; 3] {
        let order = |order: usize| {
            let of = |terms: &Vec<(f64, Polynomial)>| {
                terms.iter().map(|(factor, polynomial)| factor * polynomial.value(order, t)).sum()
            };
            self.joints.iter().map(of).collect()
        };
        [order(0), order(1), order(2)]
    }

    /// Returns true if a polynomial of degree 5 may not be enough for one of the joints.
    pub(super) fn is_high(&self) -> bool {
        self.joints.iter().flatten().any(|(_, polynomial)| polynomial.forms[0].len() > 6)
    }
}
