//! Contacts of links with the ground: where they touch it.
//!
//! On ground that is not level it is the points of links that meet the ground: a peak of it that is thinner than a link, so
//! that it comes between them, is not felt.

use super::contact::{Contact, Spring};
use super::model::Model;
use crate::geometry::broad_phase::Aabb;
use crate::geometry::ground_features::{CIRCLE_POINTS, CirclePlane, Feature, tread};
use crate::geometry::{HeightField, Mat3, Pose, Vec3};
use crate::robot::articulated_bodies::ArticulatedBodies;
use crate::robot::spatial::{SpatialInertia, SpatialVector};
use std::sync::Arc;

/// A point of a link that touches the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundContact {
    /// The index of the body, and that of the body that it is a part of.
    pub body: usize,
    whole: usize,
    /// The number of the point among those of all bodies.
    point_number: usize,
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

/// A point of a body below the ground: its number among those of the body, its position in the world (m), what the step adds to
/// its velocity as the centre of its feature turns with the body (m/s), and the ground's normal there and the depth along it, m.
#[derive(Clone, Copy, Debug)]
struct Touch {
    point: usize,
    at: Vec3,
    turning: Vec3,
    normal: Vec3,
    depth: f64,
}

/// The ground under a robot: level, at height 0, or a height field.
#[derive(Clone, Debug)]
pub(crate) struct GroundContacts {
    /// The springs of the points that touched in the step before, by their numbers, ascending: those of other points are at
    /// rest.
    springs: Vec<(usize, Spring)>,
    /// The bodies that have features, each with the number of its first point, and the box around its features; parts of one body
    /// follow each other.
    order: Vec<(usize, usize, Aabb)>,
    /// The points that touch now.
    pub contacts: Vec<GroundContact>,
    /// The memory in which the points of one feature, and of one body, are found.
    points: Vec<(u8, Vec3)>,
    touches: Vec<Touch>,
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
    pub(crate) fn new(model: &Model, terrain: Option<&Arc<HeightField>>, step: f64) -> GroundContacts {
        let with_features = model.bodies.iter().enumerate().filter(|(_, body)| !body.features.is_empty());
        let mut order: Vec<(usize, usize, Aabb)> =
            with_features.map(|(index, body)| (index, 0, body.bounds)).collect();
        order.sort_by_key(|(index, ..)| model.bodies[*index].whole);
        let mut points = 0;
        for (index, first, _) in &mut order {
            *first = points;
            points += model.bodies[*index].features.len() * FEATURE_POINTS;
        }
        GroundContacts {
            springs: Vec::new(),
            order,
            contacts: Vec::new(),
            points: Vec::new(),
            touches: Vec::new(),
            touched: vec![0; model.bodies.len()],
            slid: vec![0.0; model.bodies.len()],
            terrain: terrain.map(|field| (field.clone(), field.highest())),
            step,
        }
    }

    /// Finds the points below the ground. `bodies`: the bodies with their velocities; `poses`: their world poses, with the
    /// rotations as matrices; `origin`: the point that spatial vectors are about; `now`: the number of the step, from 1.
    #[inline(always)]
    pub(crate) fn find(
        &mut self,
        model: &Model,
        bodies: &ArticulatedBodies,
        (poses, turns): (&[Pose], &[Mat3]),
        origin: &Vec3,
        now: u64,
    ) {
        let GroundContacts { springs, order, contacts, touched, points, touches, terrain, step, .. } = self;
        contacts.clear();
        let mut springs = springs.iter().peekable();
        let highest = terrain.as_ref().map_or(0.0, |(_, highest)| *highest);
        for &(index, first, bounds) in &*order {
            let (p, turn) = (&poses[index].translation.vector, &turns[index]);
            let own_up = Vec3::new(turn[(2, 0)], turn[(2, 1)], turn[(2, 2)]);
            if p.z + bounds.lowest(&own_up) >= highest {
                continue;
            }
            let body = &model.bodies[index];
            let twist = bodies.velocity(index);
            // The touching point of a round feature goes with its centre, not with the material.
            let turning = |centre: &Vec3| twist.angular.cross(&twist.at(&(centre - origin))) * *step;
            touches.clear();
            match &terrain {
                None => level(&body.features, (p, turn), &own_up, turning, points, touches),
                Some((field, _)) => uneven(&body.features, (p, turn), field, turning, touches),
            }
            let is_new = touched[index] == 0 || touched[index] + 1 < now;
            for touch in touches.iter() {
                let (point_number, point) = (first + touch.point, touch.at - origin);
                while springs.next_if(|(number, _)| *number < point_number).is_some() {}
                let known = springs.next_if(|(number, _)| *number == point_number);
                let known = known.map_or(Spring::default(), |(_, spring)| *spring);
                contacts.push(GroundContact {
                    body: index,
                    whole: body.whole,
                    point_number,
                    point,
                    coasting: twist.at(&point) + touch.turning,
                    velocity: Vec3::zeros(),
                    is_new,
                    contact: Contact::new(touch.normal, touch.depth, &body.surface, (&known, now), *step),
                });
            }
            if !touches.is_empty() {
                touched[index] = now;
            }
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
        for of_body in self.contacts.chunk_by(|a, b| a.whole == b.whole) {
            if again {
                if !of_body.iter().any(|contact| contact.contact.changed) {
                    continue;
                }
                restore(bodies, of_body[0].whole);
            }
            let (mut inertia, mut wrench) = (SpatialInertia::default(), SpatialVector::default());
            for contact in of_body.iter().filter(|contact| contact.contact.pushes) {
                let (of_contact, force) = match self.terrain {
                    None => contact.impedance(SpatialInertia::at_point_of_level, self.step),
                    Some(_) => contact.impedance(
                        |across, along, point| {
                            SpatialInertia::at_point(across, along, &contact.contact.normal, point)
                        },
                        self.step,
                    ),
                };
                inertia.add(&of_contact);
                wrench = wrench.plus(&force, 1.0);
            }
            bodies.add(of_body[0].whole, &inertia, &wrench);
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
        self.springs.clear();
        // The contacts of a body follow each other.
        for of_body in self.contacts.chunk_by(|a, b| a.body == b.body) {
            let mut fastest: f64 = 0.0;
            for contact in of_body {
                let spring = contact.contact.kept(&contact.velocity, self.step, now);
                self.springs.push((contact.point_number, spring));
                fastest = fastest.max(contact.contact.slip(&contact.velocity));
            }
            self.slid[of_body[0].body] += fastest * self.step;
        }
    }
}

/// Adds the points of a body's features below level ground to `out`. `up`: the vertical in the frame of the link; `points`:
/// memory; `turning`: see [`Touch`], for the centre of a feature in the world.
#[inline(always)]
fn level(
    features: &[Feature],
    (p, R): (&Vec3, &Mat3),
    up: &Vec3,
    turning: impl Fn(&Vec3) -> Vec3,
    points: &mut Vec<(u8, Vec3)>,
    out: &mut Vec<Touch>,
) {
    let mut plane = None;
    for (number, feature) in features.iter().enumerate() {
        points.clear();
        if feature.points_below(up, -p.z, &mut plane, points)
            && let Some(between) = between_rims(features, number, up, &mut plane)
        {
            points.push(between);
        }
        if points.is_empty() {
            continue;
        }
        let turning = turning(&(p + R * feature.centre));
        for (k, own) in points.iter() {
            let at = p + R * own;
            if at.z < 0.0 {
                let point = number * FEATURE_POINTS + usize::from(*k);
                out.push(Touch { point, at, turning, normal: Vec3::z(), depth: -at.z });
            }
        }
    }
}

/// Adds the points of a body's features below uneven ground to `out`. Round features touch it where they are lowest along
/// the ground's normal under their centre. `turning`: see [`Touch`], for the centre of a feature in the world.
fn uneven(
    features: &[Feature],
    (p, R): (&Vec3, &Mat3),
    field: &HeightField,
    turning: impl Fn(&Vec3) -> Vec3,
    out: &mut Vec<Touch>,
) {
    for (number, feature) in features.iter().enumerate() {
        let centre = p + R * feature.centre;
        let up = R.tr_mul(&field.normal(centre.x, centre.y));
        let points = (0..feature.points()).map(|k| (k, feature.point(k, &up)));
        for (k, own) in points.chain(between_rims(features, number, &up, &mut None)) {
            let at = p + R * own;
            let above = field.above(at);
            if above < 0.0 {
                let normal = field.normal(at.x, at.y);
                let point = number * FEATURE_POINTS + usize::from(k);
                out.push(Touch { point, at, turning: turning(&centre), normal, depth: -above * normal.z });
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
    /// Returns the inertia as which the contact counts, and its wrench on the body besides. `at_point`: the inertia that a
    /// point makes which is as heavy as this across the normal, and by this heavier along it.
    #[inline(always)]
    fn impedance(
        &self,
        at_point: impl Fn(f64, f64, &Vec3) -> SpatialInertia,
        step: f64,
    ) -> (SpatialInertia, SpatialVector) {
        let Contact { normal, depth, stiffness, resistance, shift, share, .. } = self.contact;
        let across = share * resistance;
        let along = resistance - across;
        let offset = normal * (stiffness * depth) - shift * (share * stiffness);
        let resisted = self.coasting * across + normal * (along * normal.dot(&self.coasting));
        let inertia = at_point(across * step, along * step, &self.point);
        (inertia, SpatialVector::of_force(offset - resisted, &self.point))
    }
}
