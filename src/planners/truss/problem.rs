//! The part of a problem that `morph` and `locomote` share: a truss, the positions of its nodes, its limits, and
//! its surroundings.

use super::constraint::Constraint;
use super::step::StepError;
use super::structure::{Limits, Structure};
use super::surroundings::Surroundings;
use super::tolerances::Tolerances;
use crate::geometry::soundness::{EXTENT_MAX, check_placed, in_reach};
use crate::geometry::{HeightField, Placed, Solid, Unsound, Vec3};
use crate::plan::World;
use crate::robot::Strut;
use crate::robot::truss_statics::{FRICTION, ForceModel};
use crate::units::{Dimension, quantity};
use std::f64::consts::FRAC_PI_3;
use std::fmt;

/// The least angle between struts is limited below this, rad: three struts that make a triangle can't all
/// be farther apart in angle.
const ANGLE_LIMIT_MAX: f64 = FRAC_PI_3;
/// The greatest number of constraints that are named in the reason why a search ended.
const CONSTRAINTS_REPORTED_MAX: usize = 4;

/// A truss of struts of one kind to be planned for, with its surroundings, in the world's frame.
#[derive(Clone, Debug)]
pub struct TrussProblem {
    /// The kind of all struts: range of length, speed, clearance.
    pub strut: Strut,
    /// A name for each node, for messages and the plan, in the order of `nodes` and as many.
    pub node_names: Vec<String>,
    /// The position of each node at the start, m, in the world's frame; the index of a node here, from 0, names it in
    /// the whole planner.
    pub nodes: Vec<Vec3>,
    /// The two nodes of each strut, as indices in `nodes`; the index of a strut here, from 0, names it in the whole
    /// planner.
    pub struts: Vec<(usize, usize)>,
    /// The limits of the shape of the truss beside those of the struts.
    pub limits: Limits,
    /// The solids that struts keep their clearance from, each a union of shapes, in the world's frame.
    pub obstacles: Vec<Vec<Placed>>,
    /// The ground; `None` for flat ground at height 0.
    pub terrain: Option<HeightField>,
    /// The factor on the friction of nodes on the ground, as that of a world, without unit; 1 for the usual.
    pub friction: f64,
}

/// The reason why a truss can't be planned for. Indices count from 0: struts as in [`TrussProblem::struts`],
/// obstacles as in [`TrussProblem::obstacles`].
#[derive(Clone, Debug, PartialEq)]
pub enum InvalidTruss {
    /// There are not as many names as nodes, or no struts.
    Incomplete,
    /// A strut joins a node to itself, to an index that is not a node, or to a node at the same position.
    Degenerate {
        /// The index of the strut in [`TrussProblem::struts`].
        strut: usize,
    },
    /// A coordinate of a node is farther than [`EXTENT_MAX`] from 0, or not finite.
    TooFar {
        /// The name of the node, as the problem states it.
        node: String,
    },
    /// A shape of an obstacle is not sound, or at a pose that is not.
    NotSolid {
        /// The index of the obstacle in [`TrussProblem::obstacles`].
        obstacle: usize,
        /// The fault of the obstacle's shapes.
        why: Unsound,
    },
    /// The limit of the angle between struts is not in [0, π/3) rad.
    AngleLimit,
    /// The limit of the singular values is negative or not a number.
    RigidityLimit,
    /// A loop has fewer than two struts.
    ShortLoop,
    /// A strut is nearer to an obstacle at the start than the clearance that it has to keep.
    NearObstacle {
        /// The name of the strut, from the names of its nodes: `a -- b`.
        strut: String,
        /// The index of the obstacle in [`TrussProblem::obstacles`].
        obstacle: usize,
        /// The clearance that the strut has to keep, m.
        clearance: f64,
    },
    /// A strut is deeper in uneven ground than `depth_max` at the start.
    BelowGround {
        /// The name of the strut, from the names of its nodes: `a -- b`.
        strut: String,
        /// The greatest depth of the strut below the ground, m.
        depth: f64,
        /// The greatest depth that is allowed, m.
        depth_max: f64,
    },
    /// A node is inside an obstacle at the start.
    InsideObstacle {
        /// The index of the obstacle in [`TrussProblem::obstacles`].
        obstacle: usize,
    },
}

impl fmt::Display for InvalidTruss {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            InvalidTruss::Incomplete => f.write_str("a truss has struts, and a name for each node"),
            InvalidTruss::Degenerate { strut } => write!(f, "strut {strut} joins no two nodes"),
            InvalidTruss::TooFar { node } => write!(f, "the node {node} is farther than {EXTENT_MAX} m away"),
            InvalidTruss::NotSolid { obstacle, why } => {
                write!(f, "obstacle {} is no solid: {why}", obstacle + 1)
            }
            InvalidTruss::AngleLimit => {
                f.write_str("an angle between struts is at least 0 and less than 60deg")
            }
            InvalidTruss::RigidityLimit => f.write_str("a singular value is not negative"),
            InvalidTruss::ShortLoop => f.write_str("a perimeter has at least two struts"),
            InvalidTruss::NearObstacle { strut, obstacle, .. } => {
                write!(f, "the strut {strut} is too near to obstacle {} where the truss begins", obstacle + 1)
            }
            InvalidTruss::BelowGround { strut, depth, .. } => {
                let depth = quantity(*depth, Dimension::LENGTH);
                write!(f, "the strut {strut} is {depth} in the ground where the truss begins")
            }
            InvalidTruss::InsideObstacle { obstacle } => {
                write!(f, "the truss begins inside obstacle {}", obstacle + 1)
            }
        }
    }
}

impl std::error::Error for InvalidTruss {}

impl TrussProblem {
    /// Returns the name of a strut, given by its index in [`TrussProblem::struts`], from the names of its nodes: `a --
    /// b`. Panics if there is no such strut.
    pub fn strut_name(&self, strut: usize) -> String {
        let (a, b) = self.struts[strut];
        format!("{} -- {}", self.node_names[a], self.node_names[b])
    }

    /// Returns the truss with its limits and surroundings. Struts may be half their clearance below uneven ground:
    /// nodes are taken to be thicker by that much. Panics if a limit names a strut that is not there and nothing else
    /// is wrong.
    ///
    /// # Errors
    /// [`InvalidTruss`] of any kind but [`NearObstacle`](InvalidTruss::NearObstacle),
    /// [`BelowGround`](InvalidTruss::BelowGround) and [`InsideObstacle`](InvalidTruss::InsideObstacle), which
    /// [`TrussProblem::check_start`] finds.
    pub fn structure(&self, tolerances: Tolerances) -> Result<Structure, InvalidTruss> {
        self.check()?;
        let mut solids = Vec::with_capacity(self.obstacles.len());
        for (obstacle, shapes) in self.obstacles.iter().enumerate() {
            let sound = shapes.iter().try_for_each(check_placed);
            sound.map_err(|why| InvalidTruss::NotSolid { obstacle, why })?;
            solids.push(Solid::new(shapes).map_err(|why| InvalidTruss::NotSolid { obstacle, why })?);
        }
        let surroundings = Surroundings::new(&solids, self.terrain.clone(), self.strut.clearance / 2.0);
        let truss = Structure::new(&self.strut, &self.nodes, &self.struts);
        let truss = Structure { tolerances, ..truss };
        Ok(truss.with_limits(&self.nodes, self.limits.clone()).with_surroundings(surroundings))
    }

    /// Returns the weights of the nodes, their own and half of each of their struts, and what struts and ground bear, in a
    /// world with the gravity of the earth.
    pub fn weight(&self) -> ForceModel {
        let masses = self.strut.node_masses(self.nodes.len(), &self.struts);
        let weight = |mass: f64| Vec3::new(0.0, 0.0, -mass * World::default().gravity);
        let loads = masses.into_iter().map(weight).collect();
        let friction = FRICTION * self.friction;
        ForceModel { loads, friction, force_max: self.strut.force, buckling: self.strut.euler() }
    }

    /// Checks graph, positions and limits.
    fn check(&self) -> Result<(), InvalidTruss> {
        if self.node_names.len() != self.nodes.len() || self.struts.is_empty() {
            return Err(InvalidTruss::Incomplete);
        }
        if let Some(node) = self.nodes.iter().position(|node| !in_reach(node.as_slice())) {
            return Err(InvalidTruss::TooFar { node: self.node_names[node].clone() });
        }
        let place = |node: usize| self.nodes.get(node);
        let joins = |&(a, b): &(usize, usize)| place(a).zip(place(b)).is_some_and(|(p, q)| p != q);
        if let Some(strut) = self.struts.iter().position(|ends| !joins(ends)) {
            return Err(InvalidTruss::Degenerate { strut });
        }
        let Limits { angle, rigidity, loops, .. } = &self.limits;
        if !(0.0..ANGLE_LIMIT_MAX).contains(angle) {
            return Err(InvalidTruss::AngleLimit);
        }
        if rigidity.is_nan() || *rigidity < 0.0 {
            return Err(InvalidTruss::RigidityLimit);
        }
        if loops.iter().any(|struts| struts.len() < 2) {
            return Err(InvalidTruss::ShortLoop);
        }
        Ok(())
    }

    /// Checks that the truss with its nodes at `x`, m, is free of obstacles and its struts are not below uneven
    /// ground; flat ground is not checked. `truss`: as [`TrussProblem::structure`] returned it.
    ///
    /// # Errors
    /// [`InvalidTruss::NearObstacle`], [`InvalidTruss::BelowGround`] or [`InvalidTruss::InsideObstacle`];
    /// [`InvalidTruss::NotSolid`] for a truss that `structure` did not check.
    pub fn check_start(&self, truss: &Structure, x: &[Vec3]) -> Result<(), InvalidTruss> {
        let around = &truss.surroundings;
        for index in 0..truss.struts.len() {
            let (strut, ends) = (|| self.strut_name(index), truss.segment(x, index));
            for (part, (obstacle, _)) in around.parts.iter().enumerate() {
                let near = around.may_collide(ends, part, truss.clearance);
                if near && around.signed_distance(ends, part, truss.clearance).distance < truss.clearance {
                    let (obstacle, clearance) = (*obstacle, truss.clearance);
                    return Err(InvalidTruss::NearObstacle { strut: strut(), obstacle, clearance });
                }
            }
            let depth = around.terrain.as_ref().map_or(0.0, |field| -field.lowest(ends.0, ends.1).1);
            if depth > around.sink_depth {
                let depth_max = around.sink_depth;
                return Err(InvalidTruss::BelowGround { strut: strut(), depth, depth_max });
            }
        }
        // A node may be inside a solid and yet far from its surface.
        for (obstacle, shapes) in self.obstacles.iter().enumerate() {
            let solid = Solid::new(shapes).map_err(|why| InvalidTruss::NotSolid { obstacle, why })?;
            if x.iter().any(|p| solid.encloses(p)) {
                return Err(InvalidTruss::InsideObstacle { obstacle });
            }
        }
        Ok(())
    }

    /// Returns the reason why there was no step in words for a message, such as `no step keeps all limits: a -- b is
    /// near c -- d and 2 more`. It names up to `CONSTRAINTS_REPORTED_MAX` constraints that blocked the step, each
    /// once, in the order of the error, those of obstacles and uneven ground first: a truss's own struts are often at
    /// some limit. Struts go by the names of their nodes, obstacles and loops by numbers from 1. `truss`: the
    /// structure that the error came from, made of this problem; a panic if it was made of another.
    pub fn explain(&self, truss: &Structure, error: &StepError) -> String {
        let (why, constraints) = match error {
            StepError::Infeasible(constraints) => ("no step keeps all limits", constraints),
            StepError::NotConverged(constraints) => ("no step was found that keeps all limits", constraints),
        };
        let mut reasons: Vec<String> = Vec::new();
        let outer = |constraint: &&Constraint| {
            matches!(constraint, Constraint::ObstacleClearance(..) | Constraint::StrutHeight(..))
        };
        let own = constraints.iter().filter(|constraint| !outer(constraint));
        for constraint in constraints.iter().filter(outer).chain(own) {
            let words = self.explain_constraint(truss, *constraint);
            if !reasons.contains(&words) {
                reasons.push(words);
            }
        }
        let more = reasons.len().saturating_sub(CONSTRAINTS_REPORTED_MAX);
        reasons.truncate(CONSTRAINTS_REPORTED_MAX);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        if reasons.is_empty() { why.to_string() } else { format!("{why}: {}{more}", reasons.join(", ")) }
    }

    /// Returns an active constraint of `truss` in words for a message, such as `a -- b is at its least length`.
    /// Obstacles and loops are numbered from 1. Panics if the constraint names a strut or node that is not in this
    /// problem.
    pub fn explain_constraint(&self, truss: &Structure, constraint: Constraint) -> String {
        let strut = |k: usize| self.strut_name(k);
        match constraint {
            Constraint::LengthMin(k) => format!("{} is at its least length", strut(k)),
            Constraint::LengthMax(k) => format!("{} is at its greatest length", strut(k)),
            Constraint::Clearance(i, j) | Constraint::EndClearance(i, _, j) => {
                format!("{} is near {}", strut(i), strut(j))
            }
            Constraint::NodeHeight(node) => format!("{} is on the ground", self.node_names[node]),
            Constraint::StrutHeight(k, _) => format!("{} is on the ground", strut(k)),
            Constraint::ObstacleClearance(k, part, _) => {
                let obstacle = truss.surroundings.parts[part].0 + 1;
                format!("{} is near obstacle {obstacle}", strut(k))
            }
            Constraint::Angle(i, j) => format!("{} is near {} in angle", strut(i), strut(j)),
            Constraint::LoopMin(k) | Constraint::LoopMax(k) => {
                format!("the sum of perimeter {} changes", k + 1)
            }
            Constraint::Rigidity(..) => "its rigidity is at its least".to_string(),
            Constraint::Force => "the forces of its struts are at their greatest".to_string(),
        }
    }
}
