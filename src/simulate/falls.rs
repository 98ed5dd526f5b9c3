//! Falls of robots: each is watched by itself, so that a small one is found, and one of several.
//!
//! A robot is all that hangs together: the trees of bodies that bonds hold together or that press on each other, so that what
//! a gripper carries is a part of the gripper. One that a fixture holds does not fall. Another one falls where it
//! - drops: sinks fast while neither ground nor obstacle carries it,
//! - topples: all its bodies turn the same way about the horizontal, while its centre of mass comes down. A robot that stands,
//!   rolls on wheels or moves its limbs has a body that does not turn so, or bodies that turn in other directions,
//! - or collapses: its base comes down while a joint is far behind what is commanded.
//!
//! None of these asks for the attitude that the plan has, which is not known of programs that sense, on other ground, nor
//! after the judge has found a fall itself.

use super::commands::Commands;
use crate::geometry::{Pose, Vec3};
use crate::plan::forward_dynamics::{Model, Stepper};
use crate::robot::Assembly;
use crate::robot::articulated_bodies::Attachment;
use nalgebra::UnitQuaternion;
use std::f64::consts::{PI, TAU};

/// The time between two looks at the robots, s: a step where that is longer.
const LOOKS: f64 = 2e-3;

/// The time in which turns and descents are forgotten, s: half a metre topples in less.
const MEMORY: f64 = 1.0;

/// The speed at which a robot sinks that drops, m/s: after 13 mm of free fall.
const DROP_SPEED: f64 = 0.5;

/// The time for which it is in the air by then, s: what is let down so quickly that it lifts off for a moment does not drop.
const DROP_TIME: f64 = 0.05;

/// The angle by which all bodies of a robot turn that topples, rad: 30°.
const TOPPLE_ANGLE: f64 = PI / 6.0;

/// The descent of the centre of mass of a robot that topples, as a part of its size. A robot that rolls on a level stays at
/// its height, and a long bar that rolls over an edge onto its next side comes down by less: a square one of seven times its
/// width by a fifth of that width, 10 % of its size.
const TOPPLE_DESCENT: f64 = 0.15;

/// The descent of the base of a robot that collapses, as a part of its size.
const COLLAPSE_DESCENT: f64 = 0.25;

/// The angle by which a joint of a robot that collapses is behind, rad: 30°.
const COLLAPSE_LAG: f64 = PI / 6.0;

/// The number of horizontal directions along which turns are compared: that which all have in common is too small by 2 % at
/// most.
const DIRECTIONS: usize = 16;

/// The watch on all robots of a simulation.
pub(super) struct Falls<'a> {
    model: &'a Model,
    /// The normal of the ground, or of the plane that lies best through it.
    up: Vec3,
    /// The horizontal directions along which turns are compared.
    directions: [Vec3; DIRECTIONS],
    /// The number of steps from one look to the next, and those left to it.
    every: u64,
    left: u64,
    step: f64,
    /// The number of the tree of each body; `None` of what stands fast.
    tree_of: Vec<Option<usize>>,
    trees: Vec<Tree>,
    /// The trees of the two ports of each bond that is in no tree, in the order of the couplings.
    bonded: Vec<[Option<usize>; 2]>,
    /// The rotations of the bodies when they were looked at last; none before the first look.
    rotations: Vec<UnitQuaternion<f64>>,
}

/// A tree of bodies.
#[derive(Clone, Debug)]
struct Tree {
    /// The body that it hangs on.
    root: usize,
    /// True if a fixture holds its root.
    held: bool,
    mass: f64,
    /// Its radius of gyration at the start, m.
    size: f64,
    /// The heights of its centre of mass and its root when it was looked at last, m.
    height: f64,
    root_height: f64,
    /// The tree with the least number among those of its robot.
    robot: usize,
    /// The time since which nothing carries its robot, s.
    flight: f64,
    /// The turn that its robot's bodies have in common, as a vector along the axis, rad; of late.
    turn: Vec3,
    /// The descents of its robot's centre of mass and of its root, m; of late.
    descent: f64,
    root_descent: f64,
}

/// A robot at a look.
#[derive(Clone, Copy, Debug, Default)]
struct Robot {
    held: bool,
    /// True if the ground or an obstacle pushes it.
    carried: bool,
    mass: f64,
    /// The descent of its centre of mass since the look before, times its mass.
    sunk: f64,
}

impl<'a> Falls<'a> {
    /// Returns the watch on robots that have not moved. `robot`: all their modules; `up`: the normal of the ground; `step`: the
    /// time step, s.
    pub(super) fn new(model: &'a Model, robot: &Assembly, up: Vec3, step: f64) -> Falls<'a> {
        let mut tree_of: Vec<Option<usize>> = Vec::with_capacity(model.bodies.len());
        let mut trees: Vec<Tree> = Vec::new();
        for (at, body) in model.bodies.iter().enumerate() {
            let tree = match body.attachment {
                Attachment::Joint(parent) | Attachment::Fixed(parent) | Attachment::Part(parent) => {
                    tree_of[parent]
                }
                _ if model.fixture == Some(at) => None,
                Attachment::Floating | Attachment::Held => {
                    let held = body.attachment == Attachment::Held;
                    trees.push(Tree::new(at, held, trees.len()));
                    Some(trees.len() - 1)
                }
            };
            tree_of.push(tree);
        }
        let of_port = |port| tree_of[model.port(robot, port).0];
        let bonded = model.constraints.iter().map(|bond| {
            let bond = &robot.bonds[*bond];
            [of_port(bond.a), of_port(bond.b)]
        });
        let bonded = bonded.collect();
        let across = if up.x.abs() < 0.5 { Vec3::x() } else { Vec3::y() };
        let first = (across - up * up.dot(&across)).normalize();
        let second = up.cross(&first);
        let directions = std::array::from_fn(|k| {
            let (sin, cos) = libm::sincos(TAU * k as f64 / DIRECTIONS as f64);
            first * cos + second * sin
        });
        let every = (libm::round(LOOKS / step) as u64).max(1);
        let mut falls = Falls {
            model,
            up,
            directions,
            every,
            left: 0,
            step,
            tree_of,
            trees,
            bonded,
            rotations: Vec::new(),
        };
        falls.measure();
        falls
    }

    /// Iterates over the bodies of trees, each with its number, that of its tree, and its centre of mass (m) where the bodies
    /// are at these poses. Parts of bodies are left out.
    fn centres<'b>(&'b self, poses: &'b [Pose]) -> impl Iterator<Item = (usize, usize, Vec3)> + 'b {
        (0..poses.len()).filter_map(|at| {
            let body = &self.model.bodies[at];
            let tree = self.tree_of[at].filter(|_| body.whole == at)?;
            Some((at, tree, poses[at].transform_point(&body.rigid.com.into()).coords))
        })
    }

    /// Finds the masses and sizes of the trees at the start.
    fn measure(&mut self) {
        let count = self.trees.len();
        let (mut masses, mut moments, mut spreads) =
            (vec![0.0; count], vec![Vec3::zeros(); count], vec![0.0; count]);
        for (at, tree, centre) in self.centres(&self.model.start) {
            masses[tree] += self.model.bodies[at].rigid.mass;
            moments[tree] += centre * self.model.bodies[at].rigid.mass;
        }
        for (at, tree, centre) in self.centres(&self.model.start) {
            let rigid = &self.model.bodies[at].rigid;
            let off: Vec3 = centre - moments[tree] / masses[tree];
            // The trace of a body's inertia is twice its moment about its centre of mass.
            spreads[tree] += rigid.mass * off.norm_squared() + rigid.inertia.trace() / 2.0;
        }
        for (number, tree) in self.trees.iter_mut().enumerate().filter(|(number, _)| masses[*number] > 0.0) {
            tree.mass = masses[number];
            tree.size = (spreads[number] / masses[number]).sqrt();
        }
    }

    /// Looks at the robots after a step, if it is time for that; returns the module, by its index, that a robot hangs on
    /// which is found to fall. Nothing is known of them at the first look.
    pub(super) fn look(&mut self, stepper: &Stepper, commands: &Commands) -> Option<usize> {
        if self.left > 0 {
            self.left -= 1;
            return None;
        }
        self.left = self.every - 1;
        let is_first = self.rotations.is_empty();
        let mut robots = self.join(stepper);
        self.sink(stepper, &mut robots);
        self.turn(stepper, &robots);
        let time = self.every as f64 * self.step;
        if is_first {
            return None;
        }
        let falling = self.trees.iter().enumerate().find(|(number, tree)| {
            let robot = &robots[tree.robot];
            let drops = tree.flight > DROP_TIME && robot.sunk > DROP_SPEED * time * robot.mass;
            let topples = tree.turn.norm() > TOPPLE_ANGLE && tree.descent > TOPPLE_DESCENT * tree.size;
            let collapses = tree.root_descent > COLLAPSE_DESCENT * tree.size
                && self.gives_way(*number, stepper, commands);
            !robot.held && robot.mass > 0.0 && (drops || topples || collapses)
        });
        falling.map(|(_, tree)| self.model.module_of[self.trees[tree.robot].root])
    }

    /// Finds which trees are one robot now, and returns the robots by their first trees.
    fn join(&mut self, stepper: &Stepper) -> Vec<Robot> {
        let mut robots = vec![Robot::default(); self.trees.len()];
        self.trees.iter_mut().enumerate().for_each(|(number, tree)| tree.robot = number);
        let bonds = stepper.couplings.bonds.iter().zip(&self.bonded);
        let held = bonds.filter(|(bond, _)| bond.holds).map(|(_, ends)| *ends);
        let links = stepper.couplings.links.iter().flat_map(|links| links.touching());
        let pushed = links.map(|(a, b)| [self.tree_of[a], self.tree_of[b]]);
        let mut carried: Vec<usize> = stepper
            .ground
            .iter()
            .flat_map(|ground| ground.touching())
            .filter_map(|at| self.tree_of[at])
            .collect();
        for pair in held.chain(pushed) {
            match pair {
                [Some(a), Some(b)] if self.trees[a].robot != self.trees[b].robot => {
                    let (a, b) = (self.trees[a].robot, self.trees[b].robot);
                    let joined = self.trees.iter_mut().filter(|tree| tree.robot == a.max(b));
                    joined.for_each(|tree| tree.robot = a.min(b));
                }
                [Some(tree), None] | [None, Some(tree)] => carried.push(tree),
                _ => {}
            }
        }
        for tree in &self.trees {
            let robot = &mut robots[tree.robot];
            robot.held |= tree.held;
            robot.mass += tree.mass;
        }
        carried.into_iter().for_each(|tree| robots[self.trees[tree].robot].carried = true);
        robots
    }

    /// Finds how far the robots and the roots of the trees have come down since the look before.
    fn sink(&mut self, stepper: &Stepper, robots: &mut [Robot]) {
        let mut moments = vec![0.0; self.trees.len()];
        for (at, tree, centre) in self.centres(stepper.poses()) {
            moments[tree] += self.model.bodies[at].rigid.mass * self.up.dot(&centre);
        }
        for (tree, moment) in self.trees.iter_mut().zip(&moments) {
            let height = if tree.mass > 0.0 { moment / tree.mass } else { 0.0 };
            robots[tree.robot].sunk += tree.mass * (tree.height - height);
            tree.height = height;
        }
        let is_first = self.rotations.is_empty();
        for tree in &mut self.trees {
            let root_height = self.up.dot(&stepper.poses()[tree.root].translation.vector);
            let robot = &robots[tree.robot];
            let sunk = if robot.mass > 0.0 { robot.sunk / robot.mass } else { 0.0 };
            let flies = !robot.carried && !robot.held;
            tree.flight = if flies { tree.flight + self.every as f64 * self.step } else { 0.0 };
            if !is_first {
                tree.descent += sunk;
                tree.root_descent += tree.root_height - root_height;
            }
            tree.root_height = root_height;
        }
    }

    /// Finds the turn that the bodies of each robot have in common since the look before, and forgets a part of what was.
    ///
    /// It is the point of the convex hull of all turns, which are horizontal vectors, that is nearest to the origin:
    /// `max min wᵢ · d` over the directions d.
    fn turn(&mut self, stepper: &Stepper, robots: &[Robot]) {
        let mut common = vec![[f64::INFINITY; DIRECTIONS]; self.trees.len()];
        for (at, before) in self.rotations.iter().enumerate() {
            let Some(tree) = self.tree_of[at].filter(|_| self.model.bodies[at].whole == at) else { continue };
            let change = stepper.poses()[at].rotation * before.inverse();
            // Twice the sine of half the angle is the angle where it is small; the sign is that of the shorter way.
            let turn = change.imag() * (2.0 * change.w.signum());
            for (least, direction) in common[self.trees[tree].robot].iter_mut().zip(&self.directions) {
                *least = least.min(turn.dot(direction));
            }
        }
        let kept = libm::exp(-(self.every as f64) * self.step / MEMORY);
        for tree in &mut self.trees {
            let greatest = common[tree.robot].iter().zip(&self.directions).max_by(|a, b| a.0.total_cmp(b.0));
            let turned = greatest.filter(|(least, _)| **least > 0.0 && least.is_finite());
            let turned = turned.map_or(Vec3::zeros(), |(least, direction)| direction * *least);
            tree.turn = (tree.turn + turned) * kept;
            tree.descent = (tree.descent * kept).max(0.0);
            tree.root_descent = (tree.root_descent * kept).max(0.0);
            if robots[tree.robot].held {
                (tree.turn, tree.descent, tree.root_descent) = (Vec3::zeros(), 0.0, 0.0);
            }
        }
        self.rotations.clear();
        self.rotations.extend(stepper.poses().iter().map(|pose| pose.rotation));
    }

    /// Returns true if a driven joint of a tree that turns is far behind what is commanded.
    fn gives_way(&self, tree: usize, stepper: &Stepper, commands: &Commands) -> bool {
        let bodies = self.model.bodies.iter().enumerate().filter(|(at, _)| self.tree_of[*at] == Some(tree));
        bodies.filter_map(|(at, body)| Some((at, body.joint.as_ref()?))).any(|(at, joint)| {
            let lag = stepper.coordinates[at] - commands.joints[joint.id].0 * joint.factor;
            joint.servo.is_some() && !joint.slides && lag.abs() > COLLAPSE_LAG
        })
    }
}

impl Tree {
    /// Returns a tree of which nothing is known yet.
    fn new(root: usize, held: bool, number: usize) -> Tree {
        Tree {
            root,
            held,
            mass: 0.0,
            size: 0.0,
            height: 0.0,
            root_height: 0.0,
            robot: number,
            flight: 0.0,
            turn: Vec3::zeros(),
            descent: 0.0,
            root_descent: 0.0,
        }
    }
}
