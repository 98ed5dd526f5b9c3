//! Couplings of bodies besides the joints of the trees: bonds that close loops or dock on the way, and joints that follow
//! others.
//!
//! Each is some rows, a row a spring and a damper with the force at the end of the step, `f = f₀ - C ẋ`. The response of
//! the trees to a unit force in every row makes a dense system (compare Featherstone, *Rigid Body Dynamics Algorithms*,
//! 2008, ch. 8), which is symmetric and positive definite.

use super::link_contact::LinkContacts;
use super::model::Model;
use super::parameters::PARAMETERS;
use crate::geometry::pose::turned;
use crate::geometry::{Mat3, Pose, Vec3};
use crate::robot::articulated_bodies::{ArticulatedBodies, Load, Response};
use crate::robot::spatial::SpatialVector;
use crate::robot::{Assembly, mate};
use nalgebra::{DMatrix, DVector};

/// A bond that is in no tree.
#[derive(Clone, Debug)]
pub(crate) struct LooseBond {
    /// The index of the bond in the assembly.
    pub bond: usize,
    /// True while it holds.
    pub holds: bool,
    /// The bodies of its two ports, and the ports in the frames of their links.
    ends: [(usize, Pose); 2],
    /// The pose of the second port in the frame of the first in a perfect mate, the hinge at 0.
    mate: Pose,
    /// True if the ports are drawn together as they dock; the error is kept otherwise.
    snaps: bool,
    /// The axis of its hinge in the frame of the first port, and the number of its joint.
    hinge: Option<(Vec3, usize)>,
    /// The stiffness and damping of the hinge's servo.
    servo: (f64, f64),
    /// The time since which it holds, s, and what was off then, m and rad; `None` before it is known.
    docked: Option<(f64, [Vec3; 2])>,
    /// The force (N) and moment (N·m) on the second port, in the world, of the last step.
    pub wrench: [Vec3; 2],
}

/// The rows of a step.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// The couple of bodies, or the follower, that the row acts on.
    pub kind: RowKind,
    /// The force per velocity at the end of the step, N·s/m or N·m·s/rad.
    pub resistance: f64,
    /// The force at no velocity, N or N·m.
    pub offset: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum RowKind {
    /// A wrench on the second body, and its opposite on the first; velocities are those of the second against the first.
    Wrench { first: usize, second: usize, unit: SpatialVector },
    /// The follower of this index.
    Follower(usize),
}

/// All that couples bodies, with the memory that it is solved in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Couplings {
    /// The bonds that are in no tree.
    pub bonds: Vec<LooseBond>,
    /// The contacts between links; `None` if links pass through each other.
    pub links: Option<LinkContacts>,
    /// The rows of followers and bonds, and after them those of contacts.
    rows: Vec<Row>,
    /// The number of rows of followers and bonds.
    lasting: usize,
    loads: Vec<Load>,
    response: Response,
    /// The forces of the rows, N or N·m.
    forces: Vec<f64>,
}

/// The moment of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant<'a> {
    /// The time, s.
    pub time: f64,
    /// The time step, s.
    pub step: f64,
    /// The world poses of the bodies.
    pub poses: &'a [Pose],
    /// Their rotations as matrices.
    pub turns: &'a [Mat3],
    /// The point that spatial vectors are about, m.
    pub origin: Vec3,
    /// The coordinates of the joints of the bodies.
    pub coordinates: &'a [f64],
}

impl Couplings {
    /// Returns the couplings of a robot. `holds`: for each of its bonds, true if it holds at the start.
    pub(crate) fn new(
        model: &Model,
        robot: &Assembly,
        holds: &[bool],
        links: Option<LinkContacts>,
    ) -> Couplings {
        let mut hinges = vec![None; robot.bonds.len()];
        for (id, owner) in robot.joints().enumerate() {
            if let crate::robot::JointOwner::Bond(bond) = owner {
                let stiffness = robot.servo_stiffness(owner);
                hinges[bond] = Some((id, (stiffness, robot.servo(owner).damping_with(stiffness))));
            }
        }
        let bond = |&bond: &usize| LooseBond {
            bond,
            holds: holds[bond],
            ends: [robot.bonds[bond].a, robot.bonds[bond].b].map(|port| model.port(robot, port)),
            mate: mate(robot, bond),
            snaps: robot.snaps(bond),
            hinge: robot.hinge(bond).zip(hinges[bond]).map(|(hinge, (id, _))| (hinge.axis, id)),
            servo: hinges[bond].map_or((0.0, 0.0), |(_, servo)| servo),
            docked: None,
            wrench: [Vec3::zeros(); 2],
        };
        let bonds = model.constraints.iter().map(bond).collect();
        let mut couplings = Couplings { bonds, links, ..Couplings::default() };
        couplings.update_bonded();
        couplings
    }

    /// Lets a bond, by its index in the assembly, hold from now on or no longer. Returns the distance (m) and the angle
    /// (rad) of its ports from a perfect mate; `None` for bonds of the trees. `poses`: the world poses of the bodies;
    /// `commands`: position and velocity commanded of each joint.
    pub(crate) fn hold(
        &mut self,
        bond: usize,
        holds: bool,
        poses: &[Pose],
        commands: &[(f64, f64)],
    ) -> Option<(f64, f64)> {
        let known = self.bonds.iter_mut().find(|known| known.bond == bond)?;
        known.holds = holds;
        known.docked = None;
        let command = known.hinge.map_or(0.0, |(_, joint)| commands[joint].0);
        let [distance, angle] = known.error(poses, command).map(|error| error.norm());
        self.update_bonded();
        Some((distance, angle))
    }

    /// Returns true if a bond in no tree holds two modules, given by their indices, together now.
    pub(crate) fn docks(&self, model: &Model, a: usize, b: usize) -> bool {
        let of = |bond: &LooseBond| [0, 1].map(|end| model.module_of[bond.ends[end].0]);
        self.bonds.iter().any(|bond| bond.holds && (of(bond) == [a, b] || of(bond) == [b, a]))
    }

    /// Tells the contacts between links which bodies bonds hold together.
    fn update_bonded(&mut self) {
        if let Some(links) = &mut self.links {
            let holding = self.bonds.iter().filter(|bond| bond.holds);
            links.set_bonded(holding.map(|bond| (bond.ends[0].0, bond.ends[1].0)));
        }
    }

    /// Returns the loads of the bonds here that hold and state what they hold, as (index of the bond in the assembly,
    /// part of what it holds, true).
    pub(crate) fn loads(&self, robot: &Assembly, poses: &[Pose]) -> Vec<(usize, f64, bool)> {
        let holding =
            self.bonds.iter().filter(|bond| bond.holds && robot.bond_strength(bond.bond) != (None, None));
        let of = |bond: &LooseBond| {
            let (body, X_BP) = &bond.ends[0];
            (bond.bond, load(robot, bond.bond, &(poses[*body] * X_BP), bond.wrench), true)
        };
        holding.map(of).collect()
    }

    /// Finds the rows at an instant. `commands`: the commanded position and velocity of each joint by its id.
    /// `bodies`: the bodies with their velocities; `now`: the number of the step.
    #[inline(always)]
    pub(crate) fn find(
        &mut self,
        model: &Model,
        bodies: &ArticulatedBodies,
        at: &Instant,
        commands: &[(f64, f64)],
        now: u64,
    ) {
        self.rows.clear();
        for (index, follower) in model.followers.iter().enumerate() {
            let sum: f64 = follower.terms.iter().map(|(body, f)| f * at.coordinates[*body]).sum();
            let error = at.coordinates[follower.body] - sum;
            let stiffness = PARAMETERS.follower_stiffness;
            let resistance = (at.step + PARAMETERS.contact_damping) * stiffness;
            self.rows.push(Row { kind: RowKind::Follower(index), resistance, offset: -stiffness * error });
        }
        for bond in self.bonds.iter_mut().filter(|bond| bond.holds) {
            bond.add_rows(at, commands, &mut self.rows);
        }
        self.lasting = self.rows.len();
        if let Some(links) = &mut self.links {
            links.find(model, bodies, at, now);
        }
    }

    /// Adds to the accelerations of a round what the couplings change in them. `step`: the time step, s; `rates`: those of
    /// the joints at its start, by body. `None` where the system of the rows has no solution.
    #[must_use]
    pub(crate) fn solve(
        &mut self,
        model: &Model,
        bodies: &mut ArticulatedBodies,
        step: f64,
        rates: &[f64],
    ) -> Option<()> {
        self.rows.truncate(self.lasting);
        if let Some(links) = &self.links {
            links.add_rows(&mut self.rows);
        }
        let n = self.rows.len();
        if n == 0 {
            return Some(());
        }
        let mut matrix = DMatrix::zeros(n, n);
        let mut right = DVector::zeros(n);
        for (index, row) in self.rows.iter().enumerate() {
            self.loads.clear();
            row.loads(model, 1.0, &mut self.loads);
            bodies.respond(&self.loads, &mut self.response);
            for (other, reacting) in self.rows.iter().enumerate() {
                matrix[(other, index)] = step * reacting.rate(model, bodies, &self.response);
            }
            matrix[(index, index)] += 1.0 / row.resistance;
            right[index] = row.offset / row.resistance - row.free(model, bodies, step, rates);
        }
        let forces = matrix.cholesky()?.solve(&right);
        self.loads.clear();
        for (row, force) in self.rows.iter().zip(forces.iter()) {
            row.loads(model, *force, &mut self.loads);
        }
        bodies.respond(&self.loads, &mut self.response);
        bodies.add_response(&self.response);
        self.forces.clear();
        self.forces.extend(forces.iter());
        Some(())
    }

    /// Finds how contacts between links go on for the accelerations of a round. Returns the greatest change of a force
    /// that comes of it, N.
    pub(crate) fn update(&mut self, bodies: &ArticulatedBodies, step: f64) -> f64 {
        self.links.as_mut().map_or(0.0, |links| links.update(bodies, step))
    }

    /// Keeps the wrenches of the bonds and the springs of contacts, when the rounds of step `now` have ended.
    pub(crate) fn keep(&mut self, model: &Model, bodies: &ArticulatedBodies, step: f64, now: u64) {
        if let Some(links) = &mut self.links {
            links.keep(bodies, step, now);
        }
        let mut next = model.followers.len();
        for bond in &mut self.bonds {
            bond.wrench = [Vec3::zeros(); 2];
            if !bond.holds {
                continue;
            }
            for row in next..next + BOND_ROWS {
                if let RowKind::Wrench { unit, .. } = self.rows[row].kind {
                    let force = self.forces[row];
                    match row - next < 3 {
                        true => bond.wrench[0] += unit.linear * force,
                        false => bond.wrench[1] += unit.angular * force,
                    }
                }
            }
            next += BOND_ROWS;
        }
    }
}

/// The number of rows of a bond.
const BOND_ROWS: usize = 6;

impl LooseBond {
    /// Returns how far the second port is from a perfect mate with the first, in the world, with the hinge at `command`
    /// (rad): shift (m) and turn (rad).
    fn error(&self, poses: &[Pose], command: f64) -> [Vec3; 2] {
        let [(first, X_AP), (second, X_BQ)] = &self.ends;
        let open = self.hinge.map_or(Pose::identity(), |(axis, _)| turned(axis, command));
        let wanted = poses[*first] * X_AP * open * self.mate;
        let X_WQ = poses[*second] * X_BQ;
        [
            X_WQ.translation.vector - wanted.translation.vector,
            (X_WQ.rotation * wanted.rotation.inverse()).scaled_axis(),
        ]
    }

    fn add_rows(&mut self, at: &Instant, commands: &[(f64, f64)], rows: &mut Vec<Row>) {
        let [(first, X_AP), (second, X_BQ)] = &self.ends;
        let (command, rate) = self.hinge.map_or((0.0, 0.0), |(_, joint)| commands[joint]);
        let X_WP = at.poses[*first] * X_AP;
        let X_WQ = at.poses[*second] * X_BQ;
        let off = self.error(at.poses, command);
        let (since, at_first) = *self.docked.get_or_insert((at.time, off));
        // A connector that snaps draws the first error in.
        let (left, drawn) = match self.snaps {
            true => {
                let left = libm::exp(-(at.time - since) / PARAMETERS.docking_time);
                (left, left / PARAMETERS.docking_time)
            }
            false => (1.0, 0.0),
        };
        let axis = self.hinge.map(|(axis, _)| X_WP.rotation * axis);
        let point = X_WQ.translation.vector - at.origin;
        let axes = basis(axis);
        let mut add = |unit: SpatialVector, stiffness: f64, damping: f64, error: f64, target: f64| {
            let resistance = at.step * stiffness + damping;
            let kind = RowKind::Wrench { first: *first, second: *second, unit };
            rows.push(Row { kind, resistance, offset: -stiffness * error + resistance * target });
        };
        for (kind, stiffness) in
            [PARAMETERS.bond_stiffness, PARAMETERS.bond_turn_stiffness].into_iter().enumerate()
        {
            let error = off[kind] - at_first[kind] * left;
            let speed = -at_first[kind] * drawn;
            for (number, direction) in axes.iter().enumerate() {
                let unit = match kind {
                    0 => SpatialVector::of_force(*direction, &point),
                    _ => SpatialVector { angular: *direction, linear: Vec3::zeros() },
                };
                let driven = kind == 1 && number == 0 && axis.is_some();
                let (stiffness, damping, target) = match driven {
                    true => (self.servo.0, self.servo.1, speed.dot(direction) + rate),
                    false => (stiffness, stiffness * PARAMETERS.contact_damping, speed.dot(direction)),
                };
                add(unit, stiffness, damping, error.dot(direction), target);
            }
        }
    }
}

/// Returns the load of a bond in parts of what it holds: its pull along the normal of the first port, whose world pose is
/// `X_WP`, and its moment, for the force (N) and the moment (N·m, about that port) on the second port.
pub(crate) fn load(robot: &Assembly, bond: usize, X_WP: &Pose, [force, moment]: [Vec3; 2]) -> f64 {
    let (greatest_pull, greatest_moment) = robot.bond_strength(bond);
    // A force that pulls the second port back to the first is a pull across the bond.
    let pull = -force.dot(&(X_WP.rotation * Vec3::x()));
    let of_force = greatest_pull.map_or(0.0, |holds| pull.max(0.0) / holds);
    let of_moment = greatest_moment.map_or(0.0, |holds| moment.norm() / holds);
    of_force.max(of_moment)
}

/// Returns three orthogonal unit vectors, the first along `axis` if there is one.
pub(crate) fn basis(axis: Option<Vec3>) -> [Vec3; 3] {
    let Some(axis) = axis else { return [Vec3::x(), Vec3::y(), Vec3::z()] };
    let across = if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let second = (across - axis * axis.dot(&across)).normalize();
    [axis, second, axis.cross(&second)]
}

impl Row {
    /// Adds the loads of this row's force.
    fn loads(&self, model: &Model, force: f64, loads: &mut Vec<Load>) {
        match self.kind {
            RowKind::Wrench { first, second, unit } => {
                let zero = SpatialVector::default();
                loads.push(Load::Wrench(second, zero.plus(&unit, force)));
                loads.push(Load::Wrench(first, zero.plus(&unit, -force)));
            }
            RowKind::Follower(index) => {
                let follower = &model.followers[index];
                loads.push(Load::Effort(follower.body, force));
                loads
                    .extend(follower.terms.iter().map(|(body, factor)| Load::Effort(*body, -factor * force)));
            }
        }
    }

    /// Returns the change of this row's acceleration that a response makes.
    fn rate(&self, model: &Model, bodies: &ArticulatedBodies, response: &Response) -> f64 {
        match self.kind {
            RowKind::Wrench { first, second, unit } => {
                let change = |body| bodies.change(response, body);
                unit.dot(&change(second).plus(change(first), -1.0))
            }
            RowKind::Follower(index) => {
                let follower = &model.followers[index];
                let change = |body: usize| bodies.joint_change(response, body);
                let sum: f64 = follower.terms.iter().map(|(body, factor)| factor * change(*body)).sum();
                change(follower.body) - sum
            }
        }
    }

    /// Returns the velocity of this row after the step without the forces of couplings.
    fn free(&self, model: &Model, bodies: &ArticulatedBodies, step: f64, rates: &[f64]) -> f64 {
        match self.kind {
            RowKind::Wrench { first, second, unit } => {
                let after = |body| bodies.velocity(body).plus(&bodies.acceleration(body), step);
                unit.dot(&after(second).plus(&after(first), -1.0))
            }
            RowKind::Follower(index) => {
                let follower = &model.followers[index];
                let after = |body: usize| rates[body] + bodies.joint_acceleration(body) * step;
                let sum: f64 = follower.terms.iter().map(|(body, factor)| factor * after(*body)).sum();
                after(follower.body) - sum
            }
        }
    }
}
