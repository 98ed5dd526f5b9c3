//! Contacts of links with the ground: where they touch it.
//!
//! On ground that is not level it is the points of links that meet the ground: a peak of it that is thinner than a link, so
//! that it comes between them, is not felt.

use super::contact::{Contact, Spring};
use super::model::{Model, Surface};
use crate::geometry::ground_features::{CIRCLE_POINTS, Feature, tread};
use crate::geometry::{HeightField, Pose, Vec3};
use crate::robot::articulated_bodies::ArticulatedBodies;
use crate::robot::spatial::{SpatialInertia, SpatialVector};
use std::sync::Arc;

/// A point of a link that touches the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroundContact {
    /// The index of the body.
    pub body: usize,
    /// The index of the contact's spring.
    spring: usize,
    /// The position from the point that spatial vectors are about, m.
    pub point: Vec3,
    /// The velocity of the body's point after the step if nothing accelerates, and for the accelerations found last, m/s.
    coasting: Vec3,
    velocity: Vec3,
    /// True if the body did not touch the ground in the step before.
    is_new: bool,
    /// The contact itself.
    pub contact: Contact,
}

/// The greatest number of points of a feature: those of a circle, and one between two rims.
const FEATURE_POINTS: usize = CIRCLE_POINTS as usize + 1;

/// A point of a body below the ground: its spring, its position in the world (m), the centre of its feature there (m), and
/// the ground's normal there and the depth along it, m.
#[derive(Clone, Copy, Debug)]
struct Touch {
    body: usize,
    spring: usize,
    at: Vec3,
    centre: Vec3,
    normal: Vec3,
    depth: f64,
}

/// The ground under a robot: level, at height 0, or a height field.
#[derive(Clone, Debug)]
pub(super) struct GroundContacts {
    /// The springs of all points of all ground features, in the order of the bodies.
    springs: Vec<Spring>,
    /// The points that touch now.
    pub contacts: Vec<GroundContact>,
    /// The number of the last step in which each body touched the ground; 0: none.
    touched: Vec<u64>,
    /// The height field with its greatest height, m; `None`: the ground is level.
    terrain: Option<(Arc<HeightField>, f64)>,
    /// The way that each body has slid over the ground since the start, m: of its points that slide, the fastest counts.
    pub slid: Vec<f64>,
    /// The time step, s.
    step: f64,
}

impl GroundContacts {
    /// Returns the ground under a robot that touches it nowhere, level if there is no height field; `step`: the time step, s.
    pub(super) fn new(model: &Model, terrain: Option<&Arc<HeightField>>, step: f64) -> GroundContacts {
        let points = |features: &Vec<_>| features.len() * FEATURE_POINTS;
        let springs = model.bodies.iter().map(|body| points(&body.features)).sum();
        GroundContacts {
            springs: vec![Spring::default(); springs],
            contacts: Vec::new(),
            touched: vec![0; model.bodies.len()],
            slid: vec![0.0; model.bodies.len()],
            terrain: terrain.map(|field| (field.clone(), field.highest())),
            step,
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
        self.contacts.clear();
        let terrain = self.terrain.take();
        let mut first = 0;
        for (index, body) in model.bodies.iter().enumerate() {
            let own = first;
            first += body.features.len() * FEATURE_POINTS;
            let pose = &poses[index];
            let highest = terrain.as_ref().map_or(0.0, |(_, highest)| *highest);
            let own_up = pose.rotation.inverse_transform_vector(&Vec3::z());
            let height = pose.translation.vector.z;
            if body.features.is_empty() || height + body.bounds.lowest(&own_up) >= highest {
                continue;
            }
            let found = |(number, k), at, centre, normal, depth| {
                let spring = own + number * FEATURE_POINTS + usize::from(k);
                let touch = Touch { body: index, spring, at, centre, normal, depth };
                self.contacts.push(self.contact(touch, bodies, &body.surface, origin, now));
            };
            match &terrain {
                None => level(&body.features, pose, &own_up, found),
                Some((field, _)) => uneven(&body.features, pose, field, found),
            }
            if self.contacts.last().is_some_and(|contact| contact.body == index) {
                self.touched[index] = now;
            }
        }
        self.terrain = terrain;
    }

    /// Returns the contact of a point.
    fn contact(
        &self,
        touch: Touch,
        bodies: &ArticulatedBodies,
        surface: &Surface,
        origin: &Vec3,
        now: u64,
    ) -> GroundContact {
        let twist = bodies.velocity(touch.body);
        // The touching point of a round feature goes with its centre, not with the material.
        let turning = twist.angular.cross(&twist.at(&(touch.centre - origin))) * self.step;
        let point = touch.at - origin;
        GroundContact {
            body: touch.body,
            spring: touch.spring,
            point,
            coasting: twist.at(&point) + turning,
            velocity: Vec3::zeros(),
            is_new: self.touched[touch.body] == 0 || self.touched[touch.body] + 1 < now,
            contact: Contact::new(
                touch.normal,
                touch.depth,
                surface,
                (&self.springs[touch.spring], now),
                self.step,
            ),
        }
    }

    /// Iterates over the bodies that the ground pushes; one for each point.
    pub(super) fn touching(&self) -> impl Iterator<Item = usize> + '_ {
        self.contacts.iter().filter(|contact| contact.contact.pushes).map(|contact| contact.body)
    }

    /// Returns the greatest speed at which a point comes down that did not touch the ground before, m/s.
    pub(super) fn impact(&self) -> f64 {
        let coming = self.contacts.iter().filter(|contact| contact.is_new);
        coming.map(|contact| -contact.contact.normal.dot(&contact.coasting)).fold(0.0, f64::max)
    }

    /// Adds the contacts to their bodies: each counts as an inertia `h C` besides its force. In rounds after the first one
    /// (`again`) only the bodies are set anew of which a contact changed. `owns`: the bodies that touch, in the order of
    /// their contacts, each with its own inertia and bias force.
    pub(super) fn add_to(
        &self,
        bodies: &mut ArticulatedBodies,
        owns: &[(usize, (SpatialInertia, SpatialVector))],
        again: bool,
    ) {
        for (of_body, (body, own)) in self.contacts.chunk_by(|a, b| a.body == b.body).zip(owns) {
            if again {
                if !of_body.iter().any(|contact| contact.contact.changed) {
                    continue;
                }
                bodies.restore(*body, own);
            }
            of_body.iter().for_each(|contact| contact.add_to(bodies, self.step));
        }
    }

    /// Finds the forces of the contacts for the accelerations of a round, and how they go on. Returns the greatest change
    /// of a force that comes of it, N.
    pub(super) fn update(&mut self, bodies: &ArticulatedBodies) -> f64 {
        let mut greatest: f64 = 0.0;
        for contact in &mut self.contacts {
            contact.velocity =
                contact.coasting + bodies.acceleration(contact.body).at(&contact.point) * self.step;
            greatest = greatest.max(contact.contact.update(&contact.velocity));
        }
        greatest
    }

    /// Keeps the springs for the next step, when the rounds have ended; `now`: the number of this one.
    pub(super) fn keep(&mut self, now: u64) {
        // The contacts of a body follow each other.
        for of_body in self.contacts.chunk_by(|a, b| a.body == b.body) {
            let mut fastest: f64 = 0.0;
            for contact in of_body {
                self.springs[contact.spring] = contact.contact.kept(&contact.velocity, self.step, now);
                fastest = fastest.max(contact.contact.slip(&contact.velocity));
            }
            self.slid[of_body[0].body] += fastest * self.step;
        }
    }
}

/// Finds the points of a body's features below level ground. Calls `found` with the number of the feature and that of the
/// point in it, the point and the centre of its feature in the world (m), the ground's normal, and the depth, m. `up`: the
/// vertical in the frame of the link.
fn level(
    features: &[Feature],
    pose: &Pose,
    up: &Vec3,
    mut found: impl FnMut((usize, u8), Vec3, Vec3, Vec3, f64),
) {
    let height = pose.translation.vector.z;
    for (number, feature) in features.iter().enumerate() {
        if height + feature.lowest(up) >= 0.0 {
            continue;
        }
        let centre = pose.transform_point(&feature.centre.into()).coords;
        let mut touches = |k, p: Vec3| {
            let at = pose.transform_point(&p.into()).coords;
            if at.z < 0.0 {
                found((number, k), at, centre, Vec3::z(), -at.z);
            }
        };
        feature.points_below(up, -height, &mut touches);
        if let Some((k, p)) = between_rims(features, number, up) {
            touches(k, p);
        }
    }
}

/// Finds the points of a body's features below uneven ground, as [`level`] does on level one. Round features touch it
/// where they are lowest along the ground's normal under their centre.
fn uneven(
    features: &[Feature],
    pose: &Pose,
    field: &HeightField,
    mut found: impl FnMut((usize, u8), Vec3, Vec3, Vec3, f64),
) {
    for (number, feature) in features.iter().enumerate() {
        let centre = pose.transform_point(&feature.centre.into()).coords;
        let up = pose.rotation.inverse_transform_vector(&field.normal(centre.x, centre.y));
        let points = (0..feature.points()).map(|k| (k, feature.point(k, &up)));
        for (k, p) in points.chain(between_rims(features, number, &up)) {
            let at = pose.transform_point(&p.into()).coords;
            let above = field.above(at);
            if above < 0.0 {
                let normal = field.normal(at.x, at.y);
                found((number, k), at, centre, normal, -above * normal.z);
            }
        }
    }
}

/// Returns the point between a rim and the one before it, with its number in the feature, if both are of one cylinder.
fn between_rims(features: &[Feature], number: usize, up: &Vec3) -> Option<(u8, Vec3)> {
    let before = number.checked_sub(1)?;
    tread(&features[before], &features[number], up).map(|p| (CIRCLE_POINTS, p))
}

impl GroundContact {
    /// Adds the contact to its body.
    fn add_to(&self, bodies: &mut ArticulatedBodies, step: f64) {
        let Contact { normal, depth, stiffness, resistance, shift, pushes, share, .. } = self.contact;
        if !pushes {
            return;
        }
        let across = share * resistance;
        let along = resistance - across;
        let offset = normal * (stiffness * depth) - shift * (share * stiffness);
        let resisted = self.coasting * across + normal * (along * normal.dot(&self.coasting));
        bodies.add(
            self.body,
            &SpatialInertia::at_point(across * step, along * step, &normal, &self.point),
            &SpatialVector::of_force(offset - resisted, &self.point),
        );
    }
}
