//! Contacts of links with the ground: where they touch it.
//!
//! On ground that is not level it is the points of links that meet the ground: a peak of it that is thinner than a link, so
//! that it comes between them, is not felt.

use super::contact::{Contact, Spring};
use super::model::{Model, Surface};
use crate::geometry::ground_features::{CIRCLE_POINTS, CirclePlane, Feature, tread};
use crate::geometry::{HeightField, Pose, Vec3};
use crate::robot::articulated_bodies::ArticulatedBodies;
use crate::robot::spatial::{SpatialInertia, SpatialVector};
use std::sync::Arc;

/// A point of a link that touches the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundContact {
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

/// A point of a body below the ground: its number among those of the body, its position in the world (m), the centre of its
/// feature there (m), and the ground's normal there and the depth along it, m.
#[derive(Clone, Copy, Debug)]
struct Touch {
    point: usize,
    at: Vec3,
    centre: Vec3,
    normal: Vec3,
    depth: f64,
}

/// The ground under a robot: level, at height 0, or a height field.
#[derive(Clone, Debug)]
pub(crate) struct GroundContacts {
    /// The springs of all points of all ground features, in the order of the bodies.
    springs: Vec<Spring>,
    /// The points that touch now.
    pub contacts: Vec<GroundContact>,
    /// The number of the last step in which each body touched the ground; 0: none.
    touched: Vec<u64>,
    /// The memory in which the points of one feature, and of one body, are found.
    points: Vec<(u8, Vec3)>,
    touches: Vec<Touch>,
    /// The height field with its greatest height, m; `None`: the ground is level.
    terrain: Option<(Arc<HeightField>, f64)>,
    /// The way that each body has slid over the ground since the start, m: of its points that slide, the fastest counts.
    pub slid: Vec<f64>,
    /// The time step, s.
    step: f64,
}

impl GroundContacts {
    /// Returns the ground under a robot that touches it nowhere, level if there is no height field; `step`: the time step, s.
    pub(crate) fn new(model: &Model, terrain: Option<&Arc<HeightField>>, step: f64) -> GroundContacts {
        let points = |features: &Vec<_>| features.len() * FEATURE_POINTS;
        let springs = model.bodies.iter().map(|body| points(&body.features)).sum();
        GroundContacts {
            springs: vec![Spring::default(); springs],
            contacts: Vec::new(),
            points: Vec::new(),
            touches: Vec::new(),
            touched: vec![0; model.bodies.len()],
            slid: vec![0.0; model.bodies.len()],
            terrain: terrain.map(|field| (field.clone(), field.highest())),
            step,
        }
    }

    /// Finds the points below the ground. `bodies`: the bodies with their velocities; `poses`: their world poses;
    /// `origin`: the point that spatial vectors are about; `now`: the number of the step, from 1.
    #[inline(always)]
    pub(crate) fn find(
        &mut self,
        model: &Model,
        bodies: &ArticulatedBodies,
        poses: &[Pose],
        origin: &Vec3,
        now: u64,
    ) {
        self.contacts.clear();
        let terrain = self.terrain.take();
        let (mut points, mut touches) = (std::mem::take(&mut self.points), std::mem::take(&mut self.touches));
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
            touches.clear();
            match &terrain {
                None => level(&body.features, pose, &own_up, &mut points, &mut touches),
                Some((field, _)) => uneven(&body.features, pose, field, &mut touches),
            }
            for touch in &touches {
                let spring = own + touch.point;
                self.contacts.push(self.contact((index, spring), touch, bodies, &body.surface, origin, now));
            }
            if self.contacts.last().is_some_and(|contact| contact.body == index) {
                self.touched[index] = now;
            }
        }
        (self.terrain, self.points, self.touches) = (terrain, points, touches);
    }

    /// Returns the contact of a point of a body with a spring, both by their indices.
    #[inline(always)]
    fn contact(
        &self,
        (body, spring): (usize, usize),
        touch: &Touch,
        bodies: &ArticulatedBodies,
        surface: &Surface,
        origin: &Vec3,
        now: u64,
    ) -> GroundContact {
        let twist = bodies.velocity(body);
        // The touching point of a round feature goes with its centre, not with the material.
        let turning = twist.angular.cross(&twist.at(&(touch.centre - origin))) * self.step;
        let point = touch.at - origin;
        GroundContact {
            body,
            spring,
            point,
            coasting: twist.at(&point) + turning,
            velocity: Vec3::zeros(),
            is_new: self.touched[body] == 0 || self.touched[body] + 1 < now,
            contact: Contact::new(
                touch.normal,
                touch.depth,
                surface,
                (&self.springs[spring], now),
                self.step,
            ),
        }
    }

    /// Iterates over the bodies that the ground pushes; one for each point.
    pub(crate) fn touching(&self) -> impl Iterator<Item = usize> + '_ {
        self.contacts.iter().filter(|contact| contact.contact.pushes).map(|contact| contact.body)
    }

    /// Returns the greatest speed at which a point comes down that did not touch the ground before, m/s.
    pub(crate) fn impact(&self) -> f64 {
        let coming = self.contacts.iter().filter(|contact| contact.is_new);
        coming.map(|contact| -contact.contact.normal.dot(&contact.coasting)).fold(0.0, f64::max)
    }

    /// Adds the contacts to their bodies: each counts as an inertia `h C` besides its force. In rounds after the first one
    /// (`again`) only the bodies are set anew of which a contact changed: `restore` takes back what was added to a body.
    #[inline(always)]
    pub(crate) fn add_to(
        &self,
        bodies: &mut ArticulatedBodies,
        again: bool,
        restore: impl Fn(&mut ArticulatedBodies, usize),
    ) {
        for of_body in self.contacts.chunk_by(|a, b| a.body == b.body) {
            if again {
                if !of_body.iter().any(|contact| contact.contact.changed) {
                    continue;
                }
                restore(bodies, of_body[0].body);
            }
            for contact in of_body {
                contact.add_to(bodies, self.step);
            }
        }
    }

    /// Finds the forces of the contacts for the accelerations of a round, and how they go on. Returns the greatest change
    /// of a force that comes of it, N.
    #[inline(always)]
    pub(crate) fn update(&mut self, bodies: &ArticulatedBodies) -> f64 {
        let mut greatest: f64 = 0.0;
        for contact in &mut self.contacts {
            contact.velocity =
                contact.coasting + bodies.acceleration(contact.body).at(&contact.point) * self.step;
            greatest = greatest.max(contact.contact.update(&contact.velocity));
        }
        greatest.sqrt()
    }

    /// Keeps the springs for the next step, when the rounds have ended; `now`: the number of this one.
    #[inline(always)]
    pub(crate) fn keep(&mut self, now: u64) {
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

/// Adds the points of a body's features below level ground to `out`. `up`: the vertical in the frame of the link; `points`:
/// memory.
#[inline(always)]
fn level(features: &[Feature], pose: &Pose, up: &Vec3, points: &mut Vec<(u8, Vec3)>, out: &mut Vec<Touch>) {
    let height = pose.translation.vector.z;
    let mut plane = None;
    for (number, feature) in features.iter().enumerate() {
        points.clear();
        if feature.points_below(up, -height, &mut plane, points)
            && let Some(between) = between_rims(features, number, up, &mut plane)
        {
            points.push(between);
        }
        if points.is_empty() {
            continue;
        }
        let centre = pose.transform_point(&feature.centre.into()).coords;
        for (k, p) in points.iter() {
            let at = pose.transform_point(&(*p).into()).coords;
            if at.z < 0.0 {
                let point = number * FEATURE_POINTS + usize::from(*k);
                out.push(Touch { point, at, centre, normal: Vec3::z(), depth: -at.z });
            }
        }
    }
}

/// Adds the points of a body's features below uneven ground to `out`. Round features touch it where they are lowest along
/// the ground's normal under their centre.
fn uneven(features: &[Feature], pose: &Pose, field: &HeightField, out: &mut Vec<Touch>) {
    for (number, feature) in features.iter().enumerate() {
        let centre = pose.transform_point(&feature.centre.into()).coords;
        let up = pose.rotation.inverse_transform_vector(&field.normal(centre.x, centre.y));
        let points = (0..feature.points()).map(|k| (k, feature.point(k, &up)));
        for (k, p) in points.chain(between_rims(features, number, &up, &mut None)) {
            let at = pose.transform_point(&p.into()).coords;
            let above = field.above(at);
            if above < 0.0 {
                let normal = field.normal(at.x, at.y);
                let point = number * FEATURE_POINTS + usize::from(k);
                out.push(Touch { point, at, centre, normal, depth: -above * normal.z });
            }
        }
    }
}

/// Returns the point between a rim and the one before it, with its number in the feature, if both are of one cylinder.
#[inline(always)]
fn between_rims(
    features: &[Feature],
    number: usize,
    up: &Vec3,
    plane: &mut Option<CirclePlane>,
) -> Option<(u8, Vec3)> {
    let before = number.checked_sub(1)?;
    tread(&features[before], &features[number], up, plane).map(|p| (CIRCLE_POINTS, p))
}

impl GroundContact {
    /// Adds the contact to its body.
    #[inline(always)]
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
