//! The robot as a tree of rigid links with elastic joints: the small displacements at which the springs of joints,
//! contacts, stops and closing bonds are in equilibrium with loads.
//!
//! The potential is convex and quadratic by pieces, as contacts and stops only push: its minimum is found by Newton's
//! method with an exact line search (Qi and Sun 1993, *A nonsmooth version of Newton's method*), from the guess which
//! of them push. With those given the springs are linear, and one pass up the tree and one down give the displacements:
//! the recursion of the articulated-body algorithm with stiffness in the place of inertia (Featherstone, *Rigid Body
//! Dynamics Algorithms*, 2008, ch. 7), in time linear in the links. Bonds that close loops, and joints that drive
//! several steps, cross the tree: a small dense system joins them to it.
//!
//! Displacements of links are `[translation; rotation]` of the body at the centre of mass, in level axes, m and rad;
//! loads on links are `[force; moment]` about it, N and N·m.

use super::posed::Situation;
use super::tolerances::PARAMETERS;
use crate::geometry::Vec3;
use nalgebra::{Cholesky, Const, DMatrix, DVector, Matrix3, Matrix6, Vector3, Vector6};

/// The components in which the ground bears the base: height, roll and pitch.
const BEARING: [usize; 3] = [2, 3, 4];

/// The active set of the method: the contacts and stops that push, and the motors that are at their limits.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Pushing {
    /// A flag for each candidate.
    pub contacts: Vec<bool>,
    /// A flag for each stop.
    pub stops: Vec<bool>,
    /// Two flags for each motor with a limit ([`ElasticTree::limited`]): true if it is at its limit upwards, and
    /// downwards.
    pub limits: Vec<bool>,
}

/// A motor that bears no more than its limit: beyond the deflection at which its effort reaches that, it yields.
#[derive(Clone, Copy, Debug)]
pub(super) struct LimitedMotor {
    /// Its joint, by [`crate::robot::JointId`].
    pub joint: usize,
    /// The deflection at which it bears its limit, rad or m.
    pub deflection: f64,
}

/// The small displacements of a robot's links and joints under loads.
#[derive(Clone, Debug)]
pub(super) struct Displaced {
    /// The displacement of each link, by its number; zero for loose ones.
    links: Vec<Vector6<f64>>,
    /// The deflection of each joint from its position, by [`crate::robot::JointId`], rad or m.
    pub joints: Vec<f64>,
}

impl Displaced {
    /// Returns the displacements interpolated linearly between these, at `part` 0, and others, at 1.
    fn toward(&self, other: &Displaced, part: f64) -> Displaced {
        let links = self.links.iter().zip(&other.links).map(|(a, b)| a + (b - a) * part);
        let joints = self.joints.iter().zip(&other.joints).map(|(a, b)| a + (b - a) * part);
        Displaced { links: links.collect(), joints: joints.collect() }
    }

    /// Returns the angle by which a link, by its number, leans away from where it is placed, rad; of a great one only that it
    /// is great, since displacements are linear.
    pub(super) fn lean(&self, link: usize) -> f64 {
        libm::hypot(self.links[link][3], self.links[link][4])
    }

    /// Returns the change from other displacements to these.
    fn since(&self, other: &Displaced) -> Displaced {
        let links = self.links.iter().zip(&other.links).map(|(a, b)| a - b);
        let joints = self.joints.iter().zip(&other.joints).map(|(a, b)| a - b);
        Displaced { links: links.collect(), joints: joints.collect() }
    }
}

/// The joint that alone drives a step, which it alone drives.
#[derive(Clone, Copy, Debug)]
struct Driver {
    /// The joint, by [`crate::robot::JointId`].
    joint: usize,
    /// The motion of the step for a unit of the joint's motion; not 0.
    factor: f64,
}

/// A joint that drives several steps, or one together with other joints.
#[derive(Clone, Debug)]
struct Coupled {
    /// The joint, by [`crate::robot::JointId`].
    joint: usize,
    /// The steps that it drives, by their index, with the factors of their motion.
    steps: Vec<(usize, f64)>,
}

/// A robot with elastic joints under loads on its links, whose displacements in equilibrium are sought.
pub(super) struct ElasticTree<'a> {
    situation: &'a Situation<'a>,
    /// The displacement of what each step carries by a unit of its motion; zero where it is fixed.
    axes: Vec<Vector6<f64>>,
    /// The driver of each step that has its own.
    drivers: Vec<Option<Driver>>,
    /// The other joints that move steps.
    coupled: Vec<Coupled>,
    /// The motors that bear no more than their limits.
    motors: Vec<LimitedMotor>,
    /// The load on each link, by its number.
    loads: Vec<Vector6<f64>>,
}

/// The springs with some contacts and stops pushing, factored by the pass from the leaves to the base.
struct Factored {
    /// The articulated stiffness of each link, by its number: that of the contacts on it and on all that it carries,
    /// with the joints beyond it in between.
    stiffness: Vec<Matrix6<f64>>,
    /// The articulated stiffness of what each step carries, times the step's axis.
    pushed: Vec<Vector6<f64>>,
    /// The stiffness along each step that has a driver, that of its joint included, for a unit of the step's motion.
    pivots: Vec<f64>,
    /// The stiffness of the base in height, roll and pitch; `None` for a base that is held.
    base: Option<Cholesky<f64, Const<3>>>,
}

/// The response of the tree to loads.
struct Response {
    /// The displacement of each link, by its number.
    links: Vec<Vector6<f64>>,
    /// The motion of each step that has a driver, rad or m; 0 for others.
    steps: Vec<f64>,
    /// The articulated load of each link, by its number: that of all that it carries, without what its own displacement
    /// adds.
    carried: Vec<Vector6<f64>>,
}

impl<'a> ElasticTree<'a> {
    /// Returns the robot of a situation under `loads`: for each link, by its number, the gradient of the potential
    /// with respect to its displacement, which is the force (N) and moment (N·m) that it needs of its supports.
    pub(super) fn new(situation: &'a Situation<'a>, loads: Vec<Vector6<f64>>) -> ElasticTree<'a> {
        let posed = situation.posed;
        let steps = &posed.model.kinematics.steps;
        let zero = Vec3::zeros();
        let axis = |step: &crate::robot::Step| match step.joint_axis(&posed.poses) {
            None => Vector6::zeros(),
            Some(axis) => {
                let (linear, angular) = axis.velocity(&zero);
                joined(&linear, &angular)
            }
        };
        let mut driven: Vec<Vec<(usize, f64)>> = vec![Vec::new(); situation.stiffness.len()];
        let mut shared = vec![false; situation.stiffness.len()];
        for (index, step) in steps.iter().enumerate() {
            for &(joint, factor) in step.terms() {
                driven[joint].push((index, factor));
                shared[joint] |= step.terms().len() > 1 || driven[joint].len() > 1;
            }
        }
        let driver = |step: &crate::robot::Step| match *step.terms() {
            [(joint, factor)] if !shared[joint] && factor != 0.0 => Some(Driver { joint, factor }),
            _ => None,
        };
        let coupled = driven.iter().enumerate().filter(|(joint, _)| shared[*joint]);
        ElasticTree {
            situation,
            axes: steps.iter().map(axis).collect(),
            drivers: steps.iter().map(driver).collect(),
            coupled: coupled.map(|(joint, steps)| Coupled { joint, steps: steps.clone() }).collect(),
            motors: vec![],
            loads,
        }
    }

    /// Returns the tree with motors that yield at their limits: beyond them they keep only the part
    /// [`yielding_share`](super::tolerances::Parameters::yielding_share) of their stiffness.
    pub(super) fn limited(self, motors: Vec<LimitedMotor>) -> ElasticTree<'a> {
        ElasticTree { motors, ..self }
    }

    /// Returns the displacements in equilibrium, by Newton's method with an exact line search. `pushing` is the guess
    /// of the active set, and becomes that of the result. `None` if the rounds do not suffice, or a matrix is
    /// singular.
    pub(super) fn settle(&self, pushing: &mut Pushing) -> Option<Displaced> {
        let bears = pushing.contacts.iter().any(|pushes| *pushes);
        pushing.contacts.resize(self.situation.candidates.len(), true);
        pushing.stops.resize(self.situation.stops.len(), false);
        pushing.limits.resize(2 * self.motors.len(), false);
        if !bears {
            pushing.contacts.fill(true);
        }
        let mut displaced = self.linear(pushing)?;
        let mut gaps = self.gaps(&displaced);
        // If the guess is right, the minimum for its linear springs is that of the whole potential.
        if self.agree(&gaps, pushing) {
            return Some(displaced);
        }
        for _ in 0..PARAMETERS.contact_rounds_max {
            let mut flags = gaps.iter().map(|gap| *gap < 0.0);
            let contacts = flags.by_ref().take(self.situation.candidates.len()).collect();
            let stops = flags.by_ref().take(self.situation.stops.len()).collect();
            *pushing = Pushing { contacts, stops, limits: flags.collect() };
            let next = self.linear(pushing)?;
            let reached = self.gaps(&next);
            if self.agree(&reached, pushing) {
                return Some(next);
            }
            let part = self.line_search(&displaced, &next, &gaps, &reached);
            displaced = displaced.toward(&next, part);
            gaps = self.gaps(&displaced);
        }
        None
    }

    /// Returns the forces of contacts and stops under displacements, as (contact forces, stop efforts): the normal
    /// force of each contact, N, in the order of [`Situation::candidates`], and the magnitude of the effort of each
    /// stop, N·m or N, in the order of [`Situation::stops`]. None is negative; the direction of a stop's effort is
    /// that of the stop.
    pub(super) fn forces(&self, displaced: &Displaced) -> (Vec<f64>, Vec<f64>) {
        let gaps = self.gaps(displaced);
        let (contacts, others) = gaps.split_at(self.situation.candidates.len());
        let push = |gap: &f64, stiffness: f64| stiffness * (-gap).max(0.0);
        let stops = self.situation.stops.iter().zip(others).map(|(stop, gap)| push(gap, stop.stiffness));
        (contacts.iter().map(|gap| push(gap, PARAMETERS.contact_stiffness)).collect(), stops.collect())
    }

    /// Returns the wrench that each bond that closes a loop exerts on the link of its port `a`, about the bond, in
    /// level axes: force (N), then moment (N·m).
    pub(super) fn bonds(&self, displaced: &Displaced) -> Vec<[f64; 6]> {
        let wrench = |relative: Vector6<f64>| relative.component_mul(&-bond_stiffness()).into();
        (0..self.situation.loops.len()).map(|index| wrench(self.relative(index, &displaced.links))).collect()
    }

    /// Returns the gap of each contact, that of each stop, and two of each motor with a limit, upwards and downwards, m
    /// or rad; negative where it pushes, or where the motor is beyond its limit.
    fn gaps(&self, displaced: &Displaced) -> Vec<f64> {
        let Situation { candidates, stops, .. } = self.situation;
        let contact = candidates.iter().map(|c| c.gap + rise(&c.p).dot(&displaced.links[c.link]));
        let stop = stops.iter().map(|stop| stop.gap + stop.sign * displaced.joints[stop.joint]);
        let limit = |motor: &LimitedMotor| {
            let deflection = displaced.joints[motor.joint];
            [motor.deflection - deflection, motor.deflection + deflection]
        };
        contact.chain(stop).chain(self.motors.iter().flat_map(limit)).collect()
    }

    /// Returns what the spring of a gap, by its index, adds to the stiffness where it is negative, N/m or N·m/rad.
    fn gap_stiffness(&self, index: usize) -> f64 {
        let (contacts, stops) = (self.situation.candidates.len(), self.situation.stops.len());
        match index.checked_sub(contacts + stops) {
            Some(limit) => -self.stiffness_lost(&self.motors[limit / 2]),
            None if index < contacts => PARAMETERS.contact_stiffness,
            None => self.situation.stops[index - contacts].stiffness,
        }
    }

    /// Returns the stiffness that a motor loses beyond its limit, N·m/rad or N/m.
    fn stiffness_lost(&self, motor: &LimitedMotor) -> f64 {
        (1.0 - PARAMETERS.yielding_share) * self.situation.stiffness[motor.joint]
    }

    /// Returns true if contacts and stops push, and motors are at their limits, as these gaps say, but for those that
    /// just touch.
    fn agree(&self, gaps: &[f64], pushing: &Pushing) -> bool {
        let flags = pushing.contacts.iter().chain(&pushing.stops).chain(&pushing.limits);
        gaps.iter().zip(flags).all(|(gap, pushes)| (*gap < 0.0) == *pushes || gap.abs() < PARAMETERS.touching)
    }

    /// Returns the displacements in equilibrium with these contacts and stops as springs that push and pull, the others
    /// left out; `None` where a matrix is singular.
    fn linear(&self, pushing: &Pushing) -> Option<Displaced> {
        let springs = self.joint_springs(pushing);
        let factored = self.factored(pushing, &springs)?;
        let mut gradient = self.loads.clone();
        for (candidate, _) in self.situation.candidates.iter().zip(&pushing.contacts).filter(|(_, on)| **on) {
            gradient[candidate.link] += rise(&candidate.p) * (PARAMETERS.contact_stiffness * candidate.gap);
        }
        let still = vec![0.0; self.axes.len()];
        if self.coupled.is_empty() && self.situation.loops.is_empty() {
            return Some(self.displaced(self.response(&factored, gradient, &springs, &still, true), &[]));
        }
        let free = self.response(&factored, gradient.clone(), &springs, &still, true);
        let across = self.across(&factored, &springs, &free)?;
        let (imposed, wrenches) = self.effects(across.as_slice());
        wrenches.into_iter().for_each(|(link, wrench)| gradient[link] += wrench);
        let response = self.response(&factored, gradient, &springs, &imposed, true);
        Some(self.displaced(response, &across.as_slice()[..self.coupled.len()]))
    }

    /// Returns the displacements of a response; `coupled`: the deflections of the coupled joints, rad or m.
    fn displaced(&self, response: Response, coupled: &[f64]) -> Displaced {
        let mut joints = vec![0.0; self.situation.stiffness.len()];
        for (driver, motion) in self.drivers.iter().zip(&response.steps) {
            driver.iter().for_each(|driver| joints[driver.joint] = motion / driver.factor);
        }
        for (coupled, deflection) in self.coupled.iter().zip(coupled) {
            joints[coupled.joint] = *deflection;
        }
        Displaced { links: response.links, joints }
    }

    /// Returns the spring of each joint with those of its stops that push and its motor's limit, by
    /// [`crate::robot::JointId`]: its stiffness
    /// (N·m/rad or N/m) and the slope of its potential where it is not deflected (N·m or N).
    fn joint_springs(&self, pushing: &Pushing) -> Vec<(f64, f64)> {
        let mut springs: Vec<(f64, f64)> = self.situation.stiffness.iter().map(|k| (*k, 0.0)).collect();
        for (stop, _) in self.situation.stops.iter().zip(&pushing.stops).filter(|(_, on)| **on) {
            let spring = &mut springs[stop.joint];
            spring.0 += stop.stiffness;
            spring.1 += stop.stiffness * stop.sign * stop.gap;
        }
        for (index, _) in pushing.limits.iter().enumerate().filter(|(_, on)| **on) {
            let motor = &self.motors[index / 2];
            let lost = self.stiffness_lost(motor);
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            let spring = &mut springs[motor.joint];
            spring.0 -= lost;
            spring.1 += sign * lost * motor.deflection;
        }
        springs
    }

    /// Factors the springs with these contacts and stops pushing, from the leaves to the base; `springs`: those of the
    /// joints. `None` if the base's stiffness is not positive definite.
    fn factored(&self, pushing: &Pushing, springs: &[(f64, f64)]) -> Option<Factored> {
        let Situation { posed, candidates, support, size, .. } = self.situation;
        let kinematics = &posed.model.kinematics;
        let mut stiffness = vec![Matrix6::zeros(); kinematics.link_count()];
        let mut loaded = vec![false; kinematics.link_count()];
        for (candidate, _) in candidates.iter().zip(&pushing.contacts).filter(|(_, on)| **on) {
            let rise = rise(&candidate.p);
            stiffness[candidate.link].ger(PARAMETERS.contact_stiffness, &rise, &rise, 1.0);
            loaded[candidate.link] = true;
        }
        let mut pushed = vec![Vector6::zeros(); self.axes.len()];
        let mut pivots = vec![0.0; self.axes.len()];
        for (index, step) in kinematics.steps.iter().enumerate().rev() {
            let driver = self.drivers[index];
            if let Some(Driver { joint, factor }) = driver {
                pivots[index] = springs[joint].0 / (factor * factor);
            }
            if !loaded[step.link] {
                continue;
            }
            let mut passed_on = stiffness[step.link];
            if driver.is_some() {
                pushed[index] = passed_on * self.axes[index];
                pivots[index] += self.axes[index].dot(&pushed[index]);
                passed_on.ger(-1.0 / pivots[index], &pushed[index], &pushed[index], 1.0);
            }
            stiffness[step.parent] += passed_on;
            loaded[step.parent] = true;
        }
        let base = match support.rests() {
            false => None,
            true => {
                let root = &stiffness[kinematics.link(kinematics.root, 0)];
                let mut matrix = Matrix3::from_fn(|i, j| root[(BEARING[i], BEARING[j])]);
                matrix += Matrix3::from_diagonal(&base_stiffness(*size));
                Some(matrix.cholesky()?)
            }
        };
        Some(Factored { stiffness, pushed, pivots, base })
    }

    /// Returns the response to a load on each link, `gradient`, and to imposed motions of the steps without a driver
    /// (rad or m), by one pass up the tree and one down; with the slopes of the joints' springs if `sloped`, else
    /// without.
    fn response(
        &self,
        factored: &Factored,
        mut gradient: Vec<Vector6<f64>>,
        springs: &[(f64, f64)],
        imposed: &[f64],
        sloped: bool,
    ) -> Response {
        let kinematics = &self.situation.posed.model.kinematics;
        let mut steps = vec![0.0; self.axes.len()];
        for (index, step) in kinematics.steps.iter().enumerate().rev() {
            let mut passed_on = gradient[step.link];
            match self.drivers[index] {
                Some(Driver { joint, factor }) => {
                    let slope = if sloped { springs[joint].1 / factor } else { 0.0 };
                    steps[index] = (slope + self.axes[index].dot(&passed_on)) / factored.pivots[index];
                    passed_on -= factored.pushed[index] * steps[index];
                }
                None if imposed[index] != 0.0 => {
                    passed_on += factored.stiffness[step.link] * self.axes[index] * imposed[index];
                }
                None => {}
            }
            gradient[step.parent] += passed_on;
        }
        let root = kinematics.link(kinematics.root, 0);
        let mut links = vec![Vector6::zeros(); kinematics.link_count()];
        if let Some(base) = &factored.base {
            let moved = base.solve(&-Vector3::from(BEARING.map(|row| gradient[root][row])));
            BEARING.iter().zip(moved.iter()).for_each(|(row, value)| links[root][*row] = *value);
        }
        for (index, step) in kinematics.steps.iter().enumerate() {
            let parent = links[step.parent];
            if self.drivers[index].is_some() {
                steps[index] = -steps[index] - factored.pushed[index].dot(&parent) / factored.pivots[index];
                links[step.link] = parent + self.axes[index] * steps[index];
            } else {
                links[step.link] = parent + self.axes[index] * imposed[index];
            }
        }
        Response { links, steps, carried: gradient }
    }

    /// Returns the deflections of the coupled joints (rad or m), then the wrenches in the closing bonds (N and N·m), in
    /// equilibrium with the tree, as one vector: the solution of a dense linear system. `free`: the
    /// tree's response without them. `None` where the system is singular.
    fn across(&self, factored: &Factored, springs: &[(f64, f64)], free: &Response) -> Option<DVector<f64>> {
        let size = self.coupled.len() + 6 * self.situation.loops.len();
        let none = vec![Vector6::zeros(); free.links.len()];
        let mut matrix = DMatrix::zeros(size, size);
        for column in 0..size {
            let unit: Vec<f64> = (0..size).map(|i| f64::from(u8::from(i == column))).collect();
            let (imposed, wrenches) = self.effects(&unit);
            let mut gradient = none.clone();
            wrenches.into_iter().for_each(|(link, wrench)| gradient[link] += wrench);
            let response = self.response(factored, gradient, springs, &imposed, false);
            matrix.set_column(column, &self.mismatch(factored, &response));
        }
        let mut right = -self.mismatch(factored, free);
        for (i, coupled) in self.coupled.iter().enumerate() {
            let (stiffness, slope) = springs[coupled.joint];
            matrix[(i, i)] += stiffness;
            right[i] -= slope;
        }
        let compliance = bond_stiffness().map(f64::recip);
        for i in self.coupled.len()..size {
            matrix[(i, i)] += compliance[(i - self.coupled.len()) % 6];
        }
        matrix.lu().solve(&right)
    }

    /// Returns the motions of steps by deflections of the coupled joints, and the loads on links by wrenches in the
    /// closing bonds; `across` holds both.
    fn effects(&self, across: &[f64]) -> (Vec<f64>, Vec<(usize, Vector6<f64>)>) {
        let mut imposed = vec![0.0; self.axes.len()];
        for (coupled, deflection) in self.coupled.iter().zip(across) {
            coupled.steps.iter().for_each(|(step, factor)| imposed[*step] += factor * deflection);
        }
        let mut wrenches = Vec::new();
        for (closing, wrench) in self.situation.loops.iter().zip(across[self.coupled.len()..].chunks(6)) {
            let (force, moment) =
                (Vec3::from_column_slice(&wrench[..3]), Vec3::from_column_slice(&wrench[3..]));
            let at_centre = joined(&force, &(moment + closing.p.cross(&force)));
            // A wrench that supports a link lessens its load.
            wrenches.push((closing.sides[0], -at_centre));
            wrenches.push((closing.sides[1], at_centre));
        }
        (imposed, wrenches)
    }

    /// Returns the effort (N·m or N) that the tree puts on each coupled joint, then the displacement (m and rad) of the
    /// first side of each closing bond from its second, at the bond, as one vector.
    fn mismatch(&self, factored: &Factored, response: &Response) -> DVector<f64> {
        let steps = &self.situation.posed.model.kinematics.steps;
        let effort = |coupled: &Coupled| {
            let of = |&(index, factor): &(usize, f64)| {
                let link = steps[index].link;
                let load = factored.stiffness[link] * response.links[link] + response.carried[link];
                factor * self.axes[index].dot(&load)
            };
            coupled.steps.iter().map(of).sum::<f64>()
        };
        let mut values: Vec<f64> = self.coupled.iter().map(effort).collect();
        for index in 0..self.situation.loops.len() {
            values.extend_from_slice(self.relative(index, &response.links).as_slice());
        }
        DVector::from_vec(values)
    }

    /// Returns the displacement (m and rad) of the first side of the closing bond of an index from its second, at the
    /// bond.
    fn relative(&self, index: usize, links: &[Vector6<f64>]) -> Vector6<f64> {
        let closing = &self.situation.loops[index];
        let difference = links[closing.sides[0]] - links[closing.sides[1]];
        let (linear, angular): (Vec3, Vec3) =
            (difference.fixed_rows::<3>(0).into(), difference.fixed_rows::<3>(3).into());
        joined(&(linear + angular.cross(&closing.p)), &angular)
    }

    /// Returns the part of the way between displacements at which the potential is least, at most 1; `gaps` and
    /// `reached` are the gaps of both.
    fn line_search(&self, from: &Displaced, to: &Displaced, gaps: &[f64], reached: &[f64]) -> f64 {
        let change = to.since(from);
        let slopes = [self.slope(from, &change), self.slope(to, &change)];
        let rates: Vec<f64> = gaps.iter().zip(reached).map(|(a, b)| b - a).collect();
        let slope = |part: f64| {
            let push = |i: usize| self.gap_stiffness(i) * (gaps[i] + part * rates[i]).min(0.0) * rates[i];
            slopes[0] + part * (slopes[1] - slopes[0]) + (0..gaps.len()).map(push).sum::<f64>()
        };
        let end = slope(1.0);
        if end <= 0.0 {
            return 1.0;
        }
        // The slope grows, and is linear between the points at which contacts and stops begin or cease to push.
        let changes = gaps.iter().zip(&rates).map(|(gap, rate)| -gap / rate);
        let mut changes: Vec<f64> = changes.filter(|part| *part > 0.0 && *part < 1.0).collect();
        changes.sort_by(f64::total_cmp);
        let next = changes.partition_point(|part| slope(*part) <= 0.0);
        let a = if next == 0 { 0.0 } else { changes[next - 1] };
        let b = changes.get(next).copied().unwrap_or(1.0);
        let (low, high) = (slope(a), if b == 1.0 { end } else { slope(b) });
        if high > low { (a + (b - a) * (-low / (high - low)).clamp(0.0, 1.0)).min(1.0) } else { b }
    }

    /// Returns the slope of the potential of joints, base, loads and closing bonds along a change of displacements.
    fn slope(&self, displaced: &Displaced, change: &Displaced) -> f64 {
        let Situation { posed, stiffness, support, size, .. } = self.situation;
        let joints = stiffness.iter().zip(&displaced.joints).zip(&change.joints).map(|((k, a), b)| k * a * b);
        let loads = self.loads.iter().zip(&change.links).map(|(load, moved)| load.dot(moved));
        let mut slope = joints.sum::<f64>() + loads.sum::<f64>();
        if support.rests() {
            let root = posed.model.kinematics.link(posed.model.kinematics.root, 0);
            let base = base_stiffness(*size);
            for (row, stiffness) in BEARING.into_iter().zip(base.iter()) {
                slope += stiffness * displaced.links[root][row] * change.links[root][row];
            }
        }
        for index in 0..self.situation.loops.len() {
            let (at, moved) = (self.relative(index, &displaced.links), self.relative(index, &change.links));
            slope += at.component_mul(&bond_stiffness()).dot(&moved);
        }
        slope
    }
}

/// Returns the vector of six `[linear; angular]`.
pub(super) fn joined(linear: &Vec3, angular: &Vec3) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}

/// Returns the row of the Jacobian by which the displacement of a link lifts its point at `p`, m from the centre of
/// mass.
fn rise(p: &Vec3) -> Vector6<f64> {
    Vector6::new(0.0, 0.0, 1.0, p.y, -p.x, 0.0)
}

/// Returns the stiffness that penalizes an imbalance of a robot of a size (m) in height (N/m), roll and pitch
/// (N·m/rad): so small that only the contacts bear the robot.
fn base_stiffness(size: f64) -> Vector3<f64> {
    let stiffness = PARAMETERS.contact_stiffness / PARAMETERS.balance_weight;
    Vector3::new(1.0, size * size, size * size) * stiffness
}

/// Returns the stiffness of a bond for a shift (N/m) and a turn (N·m/rad) along each axis.
fn bond_stiffness() -> Vector6<f64> {
    let (shift, turn) = (PARAMETERS.bond_stiffness, PARAMETERS.bond_turn_stiffness);
    Vector6::new(shift, shift, shift, turn, turn, turn)
}
