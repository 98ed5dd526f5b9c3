//! Contacts with the ground: where links touch it, and the force of a touching point.
//!
//! A contact is a spring and a damper along the normal, which only pushes, and a spring and a damper across it that slips
//! where its force would leave the cone of friction (Cundall and Strack 1979): at rest it sticks, and does not creep. Its
//! force is that at the end of the step, so that stiff contacts need no short steps: within a round it is linear in the
//! velocity there, `f = f₀ - C v`, and counts as an inertia `h C` of the link.

use super::model::Model;
use super::parameters::PARAMETERS;
use crate::geometry::ground_features::{CIRCLE_POINTS, tread};
use crate::geometry::{Mat3, Pose, Vec3};
use crate::robot::articulated_bodies::ArticulatedBodies;
use crate::robot::spatial::{SpatialInertia, SpatialVector};

/// The spring across a contact, from one step to the next.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spring {
    /// The number of the step in which the point touched last; 0: never.
    touched: u64,
    /// The displacement across the normal, in the world, m.
    shift: Vec3,
    /// The part of the spring's force that friction bore last, 0 to 1.
    share: f64,
}

/// A point of a link that touches the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// The index of the body.
    pub body: usize,
    /// The index of the contact's spring.
    spring: usize,
    /// The position from the point that spatial vectors are about, m.
    pub point: Vec3,
    /// The unit normal, out of the ground.
    normal: Vec3,
    /// The depth below the ground, m.
    depth: f64,
    /// The coefficient of friction.
    friction: f64,
    /// The velocity of the body's point after the step if nothing accelerates, m/s.
    coasting: Vec3,
    /// The displacement of its spring at the start of the step, m.
    shift: Vec3,
    /// True if the body did not touch the ground in the step before.
    is_new: bool,
    /// True if the contact pushes.
    pushes: bool,
    /// The part of the spring's force across the normal that friction bears.
    share: f64,
    /// The force on the body, N: that of the last round, for the velocity that the round found.
    pub force: Vec3,
}

/// The stiffness and damping of contacts over a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impedance {
    /// The stiffness, N/m.
    stiffness: f64,
    /// The force per velocity at the end of the step, N·s/m: of damping, and of the way in the step.
    resistance: f64,
    /// The step, s.
    step: f64,
}

impl Impedance {
    /// Returns that of every contact for a time step (s).
    pub(super) fn new(step: f64) -> Impedance {
        let stiffness = PARAMETERS.contact_stiffness;
        Impedance { stiffness, resistance: (step + PARAMETERS.contact_damping) * stiffness, step }
    }
}

/// The greatest number of points of a feature: those of a circle, and one between two rims.
const FEATURE_POINTS: usize = CIRCLE_POINTS as usize + 1;

/// A point of a body below the ground: its spring, its position in the world (m), and the centre of its feature from the
/// point that spatial vectors are about (m).
#[derive(Clone, Copy, Debug)]
struct Touch {
    body: usize,
    spring: usize,
    at: Vec3,
    centre: Vec3,
}

/// The ground under a robot: level, at height 0.
#[derive(Clone, Debug)]
pub(super) struct GroundContacts {
    /// The springs of all points of all ground features, in the order of the bodies.
    springs: Vec<Spring>,
    /// The points that touch now.
    pub contacts: Vec<Contact>,
    /// The bodies that touched in the step before, ascending.
    touching: Vec<usize>,
    impedance: Impedance,
}

impl GroundContacts {
    /// Returns the ground under a robot that touches it nowhere; `step`: the time step, s.
    pub(super) fn new(model: &Model, step: f64) -> GroundContacts {
        let points = |features: &Vec<_>| features.len() * FEATURE_POINTS;
        let springs = model.bodies.iter().map(|body| points(&body.features)).sum();
        GroundContacts {
            springs: vec![Spring::default(); springs],
            contacts: Vec::new(),
            touching: Vec::new(),
            impedance: Impedance::new(step),
        }
    }

    /// Finds the points below the ground. `bodies`: the bodies with their velocities; `poses`: their world poses;
    /// `origin`: the point that spatial vectors are about; `now`: the number of the step, from 1.
    pub(super) fn find(
        &mut self,
        model: &Model,
        bodies: &ArticulatedBodies,
        poses: &[Pose],
        origin: &Vec3,
        now: u64,
    ) {
        self.touching.clear();
        self.touching.extend(self.contacts.iter().map(|contact| contact.body));
        self.contacts.clear();
        let up = Vec3::z();
        let mut first = 0;
        for (index, body) in model.bodies.iter().enumerate() {
            let own = first;
            first += body.features.len() * FEATURE_POINTS;
            let pose = &poses[index];
            let height = pose.translation.vector.z;
            if height > body.reach {
                continue;
            }
            let own_up = pose.rotation.inverse_transform_vector(&up);
            for (number, feature) in body.features.iter().enumerate() {
                if height + feature.lowest(&own_up) >= 0.0 {
                    continue;
                }
                let rims =
                    number.checked_sub(1).and_then(|before| tread(&body.features[before], feature, &own_up));
                let points = (0..feature.points()).map(|k| feature.point(k, &own_up)).chain(rims);
                for (k, p) in points.enumerate() {
                    let at = pose.transform_point(&p.into()).coords;
                    if at.z < 0.0 {
                        // The touching point of a round feature goes with its centre, not with the material.
                        let centre = pose.transform_point(&feature.centre.into()).coords - origin;
                        let spring = own + number * FEATURE_POINTS + k;
                        let touch = Touch { body: index, spring, at, centre };
                        self.contacts.push(self.contact(touch, bodies, body.friction, origin, now));
                    }
                }
            }
        }
    }

    /// Returns the contact of a point.
    fn contact(
        &self,
        touch: Touch,
        bodies: &ArticulatedBodies,
        friction: f64,
        origin: &Vec3,
        now: u64,
    ) -> Contact {
        let twist = bodies.velocity(touch.body);
        let turning = twist.angular.cross(&twist.at(&touch.centre)) * self.impedance.step;
        let point = touch.at - origin;
        let known = &self.springs[touch.spring];
        let lasts = known.touched > 0 && known.touched + 1 >= now;
        Contact {
            body: touch.body,
            spring: touch.spring,
            point,
            normal: Vec3::z(),
            depth: -touch.at.z,
            friction,
            coasting: twist.at(&point) + turning,
            shift: if lasts { known.shift } else { Vec3::zeros() },
            is_new: self.touching.binary_search(&touch.body).is_err(),
            pushes: true,
            share: if lasts { known.share } else { 1.0 },
            force: Vec3::zeros(),
        }
    }

    /// Returns the greatest speed at which a point comes down that did not touch the ground before, m/s.
    pub(super) fn impact(&self) -> f64 {
        let coming = self.contacts.iter().filter(|contact| contact.is_new);
        coming.map(|contact| -contact.normal.dot(&contact.coasting)).fold(0.0, f64::max)
    }

    /// Adds the contacts to their bodies.
    pub(super) fn add_to(&self, bodies: &mut ArticulatedBodies) {
        self.contacts.iter().for_each(|contact| contact.add_to(bodies, &self.impedance));
    }

    /// Finds the forces of the contacts for the accelerations of a round, and how they go on. Returns the greatest change
    /// of a force that comes of it, N.
    pub(super) fn update(&mut self, bodies: &ArticulatedBodies) -> f64 {
        let impedance = self.impedance;
        self.contacts.iter_mut().map(|contact| contact.update(bodies, &impedance)).fold(0.0, f64::max)
    }

    /// Keeps the springs for the next step, when the rounds have ended; `now`: the number of this one.
    pub(super) fn keep(&mut self, bodies: &ArticulatedBodies, now: u64) {
        for contact in &self.contacts {
            self.springs[contact.spring] = contact.kept(bodies, &self.impedance, now);
        }
    }
}

impl Contact {
    /// Returns the matrix C of the force `f₀ - C v`, N·s/m, and f₀, N.
    fn linear(&self, impedance: &Impedance) -> (Mat3, Vec3) {
        if !self.pushes {
            return (Mat3::zeros(), Vec3::zeros());
        }
        let across = self.share * impedance.resistance;
        let along = impedance.resistance - across;
        let matrix = Mat3::from_diagonal_element(across) + self.normal * self.normal.transpose() * along;
        let offset = self.normal * (impedance.stiffness * self.depth)
            - self.shift * (self.share * impedance.stiffness);
        (matrix, offset)
    }

    /// Adds the contact to its body.
    pub(super) fn add_to(&self, bodies: &mut ArticulatedBodies, impedance: &Impedance) {
        if !self.pushes {
            return;
        }
        let (matrix, offset) = self.linear(impedance);
        let force = offset - matrix * self.coasting;
        bodies.add(
            self.body,
            &SpatialInertia::at_point(&(matrix * impedance.step), &self.point),
            &SpatialVector::of_force(force, &self.point),
        );
    }

    /// Finds the force for the accelerations of the round, and how the contact goes on: whether it pushes, and which part
    /// of its spring's force friction bears. Returns how much the force would change, N.
    pub(super) fn update(&mut self, bodies: &ArticulatedBodies, impedance: &Impedance) -> f64 {
        let after = self.coasting + bodies.acceleration(self.body).at(&self.point) * impedance.step;
        let (matrix, offset) = self.linear(impedance);
        self.force = offset - matrix * after;
        let along = self.normal.dot(&after);
        let normal = impedance.stiffness * self.depth - impedance.resistance * along;
        self.pushes = normal > 0.0;
        let slip = after - self.normal * along;
        let tried = -self.shift * impedance.stiffness - slip * impedance.resistance;
        let bound = self.friction * normal.max(0.0);
        let size = tried.norm();
        self.share = if size <= bound { 1.0 } else { bound / size };
        let true_force = self.normal * normal.max(0.0) + tried * self.share;
        (true_force - self.force).norm()
    }

    /// Returns the spring as the next step, after that of number `now`, finds it.
    fn kept(&self, bodies: &ArticulatedBodies, impedance: &Impedance, now: u64) -> Spring {
        let after = self.coasting + bodies.acceleration(self.body).at(&self.point) * impedance.step;
        let across = |v: &Vec3| v - self.normal * self.normal.dot(v);
        // A spring that slips is as long as its force says.
        let shift = match self.share < 1.0 {
            true => -across(&self.force) / impedance.stiffness,
            false => self.shift + across(&after) * impedance.step,
        };
        Spring { touched: now, shift, share: self.share }
    }
}
