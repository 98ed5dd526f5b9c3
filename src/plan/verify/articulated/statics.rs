//! Quasi-static loads of joints, motors and bonds, by the method of sections: the efforts `Jᵀ F` of the
//! (transposed) Jacobian, computed link by link.
//!
//! Cut the tree of links at a joint or bond: the forces on the far side (its weight, the ground's wrenches) have a
//! force and a moment about a point there, and the cut holds these. Every load that has a limit is a sum of such
//! cuts, linear in the forces.
//!
//! Level axes are those of the stance's heading: z up, and x and y turned from those of the world about the vertical by
//! the heading.

use super::model::Model;
use super::stance::Stance;
use crate::geometry::Mat3;
use crate::geometry::{Pose, Vec3};
use crate::robot::{JointId, Motion, PortRef, Step, motor_efforts};

/// The loads of a robot that have a limit, with the cuts of its tree of links from which they follow; compiled once
/// for the bonds that hold, for all postures.
pub(super) struct Structure {
    /// All loads that have a limit; lists of loads elsewhere are in this order.
    pub loads: Vec<Load>,
    /// True if efforts of motors that state limits are not checked: those of a module whose motors are not as many as
    /// the joints that they drive, or depend on each other, do not follow from the efforts of the joints.
    pub motors_open: bool,
    /// One cut for each step that a joint moves, in their order, then those at bonds.
    cuts: Vec<Cut>,
    /// The place of each link, by its number, in depth-first preorder of the tree, and the last place among the links
    /// beyond it; `usize::MAX` twice for links that are not connected with the base.
    span: Vec<(usize, usize)>,
    /// The bonds that close loops, each as (index of the bond, number of the link with its port `a`, number of the
    /// link with its port `b`).
    pub closing: Vec<(usize, usize, usize)>,
}

/// A load of a joint, motor or bond that states a limit.
#[derive(Clone, Debug)]
pub(super) struct Load {
    /// The name of the joint, motor or bond, as reports show it.
    pub name: String,
    /// The kind of load, which says how its terms combine.
    pub kind: LoadKind,
    /// The limit, N·m or N; positive.
    pub limit: f64,
    /// The cuts whose forces (N) or moments (N·m) make the load, each as (index of the cut as in
    /// [`Structure::sections`], factor).
    pub terms: Vec<(usize, f64)>,
    /// The hinge of a bond that closes a loop, whose load is a part of what the bond transmits: it has no terms.
    pub closing: Option<ClosingHinge>,
}

/// The hinge of a bond that closes a loop.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClosingHinge {
    /// The index of the bond in [`Structure::closing`].
    pub index: usize,
    /// The number of the link with port `a` of the bond.
    link: usize,
    /// The unit axis in the frame of that link.
    axis: Vec3,
}

impl ClosingHinge {
    /// Returns the unit axis in level axes.
    pub(super) fn axis(&self, stance: &Stance) -> Vec3 {
        stance.R * stance.posture.R[self.link] * self.axis
    }
}

/// The kind of a load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LoadKind {
    /// The torque (N·m) or force (N) of a joint, or the torque of a motor. `joint`: the joint, or the first one that
    /// the motor drives, by the number in its `JointId`; `turns`: true for a torque.
    Joint { joint: usize, turns: bool },
    /// The force along the outward normal of a bond's near port, N: positive where it pulls the ports apart.
    Pull,
    /// The magnitude of the moment about the origin of a bond's near port, N·m; the terms are its components along the
    /// axes of the port.
    Moment,
}

/// A cut of the tree, and the component of force or moment that it holds.
#[derive(Clone, Copy, Debug)]
enum Cut {
    /// A cut at a step, with the component along its motion. `link`, `parent`: the numbers of the step's links;
    /// `offset`: the position of the link's origin from the axis, in the link's frame, m.
    Step { link: usize, motion: Motion, offset: Vec3, parent: usize },
    /// A cut at a bond, with the moment about an axis of its near port, or the force along it. `link`, `near`: the
    /// numbers of the far and the near port's links; `origin` (m) and `axis`: of the near port, in the frame of `near`.
    Bond { link: usize, near: usize, origin: Vec3, axis: Vec3, moment: bool },
}

/// A cut in a posture. The wrenches on `link` and the links beyond it, each a force `f` at `p` with a moment `m`, load
/// it with the sum of `dir·f`, or for a moment of `dir·((p - at) × f + m)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// The number of the first link beyond the cut.
    pub link: usize,
    /// The position of a point of the cut from the centre of mass, in level axes, m.
    pub at: Vec3,
    /// The unit direction of the component, in level axes.
    pub dir: Vec3,
    /// True for the moment about the line along `dir` through `at`, false for the force along `dir`.
    pub moment: bool,
}

impl Section {
    /// Returns the component, N or N·m, that a force `f` (N) at `p` (m) with a moment `m` (N·m) contributes, all in
    /// level axes from the centre of mass.
    pub(super) fn of(&self, p: &Vec3, f: &Vec3, m: &Vec3) -> f64 {
        if self.moment { self.dir.dot(&((p - self.at).cross(f) + m)) } else { self.dir.dot(f) }
    }
}

/// A wrench that acts on a link, in level axes from the robot's centre of mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wrench {
    /// The number of the link that it acts on.
    pub link: usize,
    /// The point of application, from the centre of mass, m.
    pub p: Vec3,
    /// The force, N.
    pub f: Vec3,
    /// The moment in addition to that of the force at `p`, N·m.
    pub m: Vec3,
}

impl Structure {
    /// Compiles the loads of a model: those of joints, motors and bonds that state a limit.
    pub(super) fn new(model: &Model) -> Structure {
        let mut structure = Structure {
            loads: vec![],
            motors_open: false,
            cuts: vec![],
            span: spans(model),
            closing: closing(model),
        };
        let cuts = structure.cut_steps(model);
        structure.joints(model, &cuts);
        structure.motors(model, &cuts);
        structure.bonds(model);
        structure
    }

    /// Returns true if `link` is the link `at`, or lies beyond it as seen from the base; both are numbers of links.
    pub(super) fn beyond(&self, at: usize, link: usize) -> bool {
        let ((first, last), (number, _)) = (self.span[at], self.span[link]);
        first <= number && number <= last
    }

    /// Returns the positions of some links, given by their numbers, in the depth-first order of the tree, ascending;
    /// a link that occurs twice is there twice.
    pub(super) fn in_tree_order(&self, links: impl Iterator<Item = usize>) -> Vec<usize> {
        let mut numbers: Vec<usize> = links.map(|link| self.span[link].0).collect();
        numbers.sort_unstable();
        numbers
    }

    /// Returns how many of some links are the link `at` or lie beyond it as seen from the base; `numbers`: their
    /// positions as [`in_tree_order`](Self::in_tree_order) returns them.
    pub(super) fn count_beyond(&self, at: usize, numbers: &[usize]) -> usize {
        let (first, last) = self.span[at];
        numbers
            .partition_point(|number| *number <= last)
            .saturating_sub(numbers.partition_point(|n| *n < first))
    }

    /// Returns the number of the first link beyond a cut, as seen from the base; `cut`: its index as in
    /// [`sections`](Self::sections).
    pub(super) fn cut_link(&self, cut: usize) -> usize {
        match self.cuts[cut] {
            Cut::Step { link, .. } | Cut::Bond { link, .. } => link,
        }
    }

    /// Returns all cuts in a stance, in level axes from the centre of mass. The index of a cut is its index in this
    /// list.
    pub(super) fn sections(&self, stance: &Stance) -> Vec<Section> {
        let R = |link: usize| stance.R * stance.posture.R[link];
        let p = |link: usize| stance.R * (stance.posture.p[link] - stance.posture.centre);
        self.sections_in(&R, &p)
    }

    /// Returns all cuts as [`sections`](Self::sections) does; `poses`: those of the links, by number, in level axes
    /// from the centre of mass.
    pub(super) fn sections_at(&self, poses: &[Pose]) -> Vec<Section> {
        let R = |link: usize| *poses[link].rotation.to_rotation_matrix().matrix();
        let p = |link: usize| poses[link].translation.vector;
        self.sections_in(&R, &p)
    }

    fn sections_in(&self, R: &dyn Fn(usize) -> Mat3, p: &dyn Fn(usize) -> Vec3) -> Vec<Section> {
        self.cuts
            .iter()
            .map(|cut| match *cut {
                Cut::Step { link, motion, offset, parent } => match motion {
                    Motion::Along(direction) => {
                        Section { link, at: p(link), dir: R(parent) * direction, moment: false }
                    }
                    _ => {
                        let axis = motion.axis().unwrap_or_else(Vec3::zeros);
                        let at = p(link) - R(link) * offset;
                        Section { link, at, dir: R(link) * axis, moment: true }
                    }
                },
                Cut::Bond { link, near, origin, axis, moment } => {
                    Section { link, at: p(near) + R(near) * origin, dir: R(near) * axis, moment }
                }
            })
            .collect()
    }

    /// Returns the load at every cut, N or N·m, in the order of `sections`: the component there of the sum of
    /// `wrenches` on the links beyond the cut, by one pass from the leaves to the base.
    pub(super) fn held(&self, model: &Model, sections: &[Section], wrenches: &[Wrench]) -> Vec<f64> {
        let mut force = vec![Vec3::zeros(); model.bodies.len()];
        let mut moment = vec![Vec3::zeros(); model.bodies.len()];
        for push in wrenches {
            force[push.link] += push.f;
            moment[push.link] += push.p.cross(&push.f) + push.m;
        }
        for step in model.kinematics.steps.iter().rev() {
            let (f, m) = (force[step.link], moment[step.link]);
            force[step.parent] += f;
            moment[step.parent] += m;
        }
        let zero = Vec3::zeros();
        sections.iter().map(|s| s.of(&zero, &force[s.link], &moment[s.link])).collect()
    }

    /// Returns the value of a load, N·m or N; `held`: the loads at all cuts ([`Structure::held`]). A pull is signed,
    /// positive where it separates the ports; the others are magnitudes.
    pub(super) fn size(&self, load: &Load, held: &[f64]) -> f64 {
        let term = |&(cut, factor): &(usize, f64)| factor * held[cut];
        match load.kind {
            LoadKind::Joint { .. } => load.terms.iter().map(term).sum::<f64>().abs(),
            LoadKind::Pull => load.terms.iter().map(term).sum::<f64>(),
            LoadKind::Moment => libm::sqrt(load.terms.iter().map(|t| term(t) * term(t)).sum()),
        }
    }

    /// Returns the generalised force (N or N·m) that a motor must supply at a joint to hold it, by virtual work.
    /// `joint`: the number in its `JointId`; `held`: the loads at all cuts; `effects`: as [`effects`] returns them.
    pub(super) fn joint_effort(&self, joint: usize, held: &[f64], effects: &[Vec<(usize, f64)>]) -> f64 {
        -effects[joint].iter().map(|&(cut, factor)| factor * held[cut]).sum::<f64>()
    }

    /// Makes a cut for every step that a joint moves, and returns the [`effects`] of the joints.
    fn cut_steps(&mut self, model: &Model) -> Vec<Vec<(usize, f64)>> {
        let effects = effects(model);
        self.cuts = model
            .kinematics
            .steps
            .iter()
            .filter(|step| moves(step))
            .map(|s| Cut::Step { link: s.link, motion: s.motion, offset: s.offset, parent: s.parent })
            .collect();
        effects
    }

    /// Adds the loads of the joints that state an effort limit and move a step or close a loop; passive joints and mimics
    /// have none.
    fn joints(&mut self, model: &Model, effects: &[Vec<(usize, f64)>]) {
        for (joint, owner) in model.robot.joints().enumerate() {
            let effort = model.robot.effort_limit(owner);
            let turns = !model.robot.slides(owner);
            let closing = self.closing_hinge(model, joint);
            let Some(limit) = effort.filter(|_| !effects[joint].is_empty() || closing.is_some()) else {
                continue;
            };
            self.loads.push(Load {
                name: model.robot.joint_name(owner),
                kind: LoadKind::Joint { joint, turns },
                limit,
                terms: effects[joint].clone(),
                closing,
            });
        }
    }

    /// Returns the hinge of the bond that closes a loop and turns by a joint, given by the number in its `JointId`; `None`
    /// for other joints.
    fn closing_hinge(&self, model: &Model, joint: usize) -> Option<ClosingHinge> {
        let of_joint = |(bond, ..): &(usize, usize, usize)| model.kinematics.hinge(*bond) == Some(joint);
        let index = self.closing.iter().position(of_joint)?;
        let (bond, link, _) = self.closing[index];
        let a = model.robot.bonds[bond].a;
        let port = &model.robot.module_type(a.module).ports[a.port];
        let axis = port.pose.rotation * model.robot.hinge(bond)?.axis;
        Some(ClosingHinge { index, link, axis })
    }

    /// Returns true if the load of a joint, given by the number in its `JointId`, is a part of what a bond that closes a
    /// loop transmits.
    pub(super) fn closes_by(&self, joint: usize) -> bool {
        let is = |load: &Load| matches!(load.kind, LoadKind::Joint { joint: own, .. } if own == joint);
        self.loads.iter().any(|load| load.closing.is_some() && is(load))
    }

    /// Adds the loads of motors. With `motor = Σ factor · joint` the joints' torques are `Fᵀ` times the motors': if
    /// F has an inverse, the motors' follow; where it has none, `motors_open` is set.
    fn motors(&mut self, model: &Model, effects: &[Vec<(usize, f64)>]) {
        for &(module, _) in &model.kinematics.tree.order {
            let motors = &model.robot.module_type(module).motors;
            if motors.iter().all(|m| m.limits.effort.is_none()) {
                continue;
            }
            let Some(efforts) = motor_efforts(model.robot.module_type(module)) else {
                self.motors_open = true;
                continue;
            };
            for (motor, shares) in motors.iter().zip(efforts) {
                let Some(limit) = motor.limits.effort else { continue };
                let mut terms = Vec::new();
                for (joint, share) in shares {
                    let cuts = &effects[model.kinematics.joint(module, joint)];
                    terms.extend(cuts.iter().map(|&(cut, factor)| (cut, share * factor)));
                }
                let first = model.kinematics.joint(module, motor.joints.first().map_or(0, |j| j.0));
                self.loads.push(Load {
                    name: format!("{}.{}", model.robot.modules[module].name, motor.name),
                    kind: LoadKind::Joint { joint: first, turns: true },
                    limit,
                    terms,
                    closing: None,
                });
            }
        }
    }

    /// Adds the pull and the moment of every bond in the tree whose connectors limit them, with cuts at the bond.
    fn bonds(&mut self, model: &Model) {
        for &(module, bond) in &model.kinematics.tree.order {
            let Some(bond) = bond else { continue };
            let declared = &model.robot.bonds[bond];
            let (near, far) = match declared.b.module == module {
                true => (declared.a, declared.b),
                false => (declared.b, declared.a),
            };
            let name = model.robot.bond_name(bond);
            let (force, moment) = model.robot.bond_strength(bond);
            let link = |port: PortRef| model.kinematics.port_link(model.robot, port);
            let pose = model.robot.module_type(near.module).ports[near.port].pose;
            let cut = |axis: Vec3, moment| Cut::Bond {
                link: link(far),
                near: link(near),
                origin: pose.translation.vector,
                axis: pose.rotation * axis,
                moment,
            };
            let mut add = |kind, limit, axes: &[Vec3]| {
                let first = self.cuts.len();
                self.cuts.extend(axes.iter().map(|axis| cut(*axis, kind == LoadKind::Moment)));
                let terms = (first..self.cuts.len()).map(|cut| (cut, 1.0)).collect();
                self.loads.push(Load { name: name.clone(), kind, limit, terms, closing: None });
            };
            if let Some(limit) = force {
                add(LoadKind::Pull, limit, &[Vec3::x()]);
            }
            if let Some(limit) = moment {
                add(LoadKind::Moment, limit, &[Vec3::x(), Vec3::y(), Vec3::z()]);
            }
        }
    }

    /// Returns the position of a bond that closes a loop: that of its port `a`, from the centre of mass in level
    /// axes, m. `bond`: its index in the assembly.
    pub(super) fn closing_place(&self, model: &Model, stance: &Stance, bond: usize) -> Vec3 {
        let a = model.robot.bonds[bond].a;
        let port = &model.robot.module_type(a.module).ports[a.port];
        let link = model.kinematics.port_link(model.robot, a);
        let posture = &stance.posture;
        stance.R * (posture.R[link] * port.pose.translation.vector + posture.p[link] - posture.centre)
    }
}

/// Returns true if a step of the kinematics is moved by at least one joint.
pub(super) fn moves(step: &Step) -> bool {
    step.motion != Motion::Fixed && !step.terms().is_empty()
}

/// Returns for each joint, by the number in its `JointId`, the cuts at the steps that it moves, each as (index of the
/// cut, motion of the step for a unit of the joint's motion).
pub(super) fn effects(model: &Model) -> Vec<Vec<(usize, f64)>> {
    let count = model.robot.joints().count();
    let mut effects = vec![Vec::new(); count];
    for (cut, step) in model.kinematics.steps.iter().filter(|step| moves(step)).enumerate() {
        for &(joint, factor) in step.terms() {
            effects[JointId(joint as u32).0 as usize].push((cut, factor));
        }
    }
    effects
}

/// Returns [`Structure::span`]: for each link its place in preorder, and the last one of the links beyond it.
fn spans(model: &Model) -> Vec<(usize, usize)> {
    let links = model.bodies.len();
    let mut size = vec![1usize; links];
    for step in model.kinematics.steps.iter().rev() {
        size[step.parent] += size[step.link];
    }
    // Links that are not connected with the base have a span beyond all others.
    let mut first = vec![usize::MAX; links];
    first[model.base_link()] = 0;
    let mut next: Vec<usize> = first.iter().map(|f| f.wrapping_add(1)).collect();
    for step in &model.kinematics.steps {
        let number = next[step.parent];
        next[step.parent] += size[step.link];
        (first[step.link], next[step.link]) = (number, number + 1);
    }
    (0..links).map(|l| (first[l], first[l].saturating_add(size[l] - 1))).collect()
}

/// Returns [`Structure::closing`]: the bonds that close loops, with the links of their ports.
fn closing(model: &Model) -> Vec<(usize, usize, usize)> {
    let link = |port: PortRef| model.kinematics.port_link(model.robot, port);
    let bond = |&b: &usize| (b, link(model.robot.bonds[b].a), link(model.robot.bonds[b].b));
    model.kinematics.tree.closing.iter().map(bond).collect()
}
