//! Contacts between links: which of them meet, and the forces with which they push each other apart.

use super::contact::{Contact, Spring};
use super::coupling::{Instant, Row, RowKind};
use super::model::Model;
use super::parameters::PARAMETERS;
use crate::geometry::broad_phase::{Aabb, near_boxes};
use crate::geometry::distance::signed_distance_within;
use crate::geometry::pose::length;
use crate::geometry::{Part, Placed, Pose, Solid, Unsound, Vec3, contact_point};
use crate::robot::articulated_bodies::{ArticulatedBodies, Attachment};
use crate::robot::spatial::SpatialVector;
use crate::robot::{Assembly, Bond};
use nalgebra::UnitQuaternion;
use std::collections::BTreeSet;

/// A convex part of a link, in the frame of the link.
#[derive(Clone, Debug)]
struct Shape {
    body: usize,
    part: Part,
    /// The depth to which others may be inside of it without a contact, m.
    touch: f64,
}

/// Two shapes that are near each other, ordered by their wholes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct NearPair {
    /// The wholes of their bodies, by their indices.
    wholes: (usize, usize),
    /// The indices of the shapes, in the order of the wholes.
    first: usize,
    second: usize,
}

/// Two shapes that are near each other, with what is kept of them from step to step.
#[derive(Clone, Debug)]
struct Pair {
    shapes: NearPair,
    /// The direction of their distance when it was last computed, in the frame of the first.
    normal: Option<Vec3>,
    /// The spring across the contact.
    spring: Spring,
}

/// The distance of two shapes that are near each other, as far as it is known.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// The bodies of the shapes.
    bodies: (u32, u32),
    /// Their distance when it was last computed, or a lower bound on it, m; negative before, and where they touch.
    gap: f64,
    /// The centre of the sphere around the second shape in the frame of the first body, m, and the rotation of the second
    /// body's frame in it, then.
    centre: Vec3,
    rotation: UnitQuaternion<f64>,
    /// The centre in the frame of the second body, and the radius of the sphere, m.
    around: (Vec3, f64),
}

/// The pairs of shapes of the same two wholes.
#[derive(Clone, Copy, Debug)]
struct Group {
    /// The wholes, by their indices.
    bodies: (usize, usize),
    /// The least length of both their paths together up to which no pair of the group can meet, m.
    until: f64,
    /// The place of its first pair in `pairs`; those of the next group follow its last.
    begins: usize,
}

impl Group {
    /// Returns the length of the paths of both wholes together, m; `gone`: that of the path of each body.
    #[inline(always)]
    fn gone(&self, gone: &[f64]) -> f64 {
        gone[self.bodies.0] + gone[self.bodies.1]
    }

    /// Returns the length that is left of their paths until a pair may meet, m.
    #[inline(always)]
    fn left(&self, gone: &[f64]) -> f64 {
        self.until - self.gone(gone)
    }
}

/// A sphere that goes with a body.
#[derive(Clone, Copy, Debug)]
struct Sphere {
    body: usize,
    /// The centre in the frame of the body, and the radius, m.
    centre: Vec3,
    radius: f64,
}

/// A contact of two links.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkContact {
    /// The place of its pair in `pairs`.
    pair: usize,
    /// The first body, by its index.
    pub first: usize,
    /// The second body, by its index.
    pub second: usize,
    /// The point, from that which spatial vectors are about, m.
    pub point: Vec3,
    /// The contact of the second body with the first, as deep as is beyond what counts as touching.
    pub contact: Contact,
}

/// The reason why the shapes of a robot and of obstacles can't push each other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ShapeFault {
    /// The shape of a link is not sound.
    Shape(Unsound),
    /// The obstacle of this number, from 1, can't be there, for this reason in words.
    Obstacle(usize, String),
}

/// All shapes of a robot, and those that touch.
#[derive(Clone, Debug, Default)]
pub(crate) struct LinkContacts {
    shapes: Vec<Shape>,
    /// The number of shapes that stand fast, which come before those of links.
    standing: usize,
    /// The spheres around the shapes of all bodies with their parts.
    spheres: Vec<Sphere>,
    /// The pairs of bodies that never push each other, the lesser index first.
    excluded: BTreeSet<(usize, usize)>,
    /// The pairs of bodies that bonds in no tree hold together now, likewise.
    bonded: BTreeSet<(usize, usize)>,
    /// The pairs that are near each other, ascending by their wholes and then by their shapes.
    pairs: Vec<Pair>,
    /// Their distances as far as they are known, in that order.
    known: Vec<Known>,
    /// The length of the paths of both bodies of each pair together, in that order, up to which its shapes can't meet, m.
    asleep: Vec<f64>,
    /// All three as they were before the last listing; only their memory is used.
    pairs_before: Vec<Pair>,
    known_before: Vec<Known>,
    asleep_before: Vec<f64>,
    /// The groups of the pairs of the same two wholes.
    groups: Vec<Group>,
    /// The places in `groups` of those that may wake before `gone_most` is `alert_until`, ascending.
    alert: Vec<u32>,
    alert_until: f64,
    /// The places in `groups` of those that do not sleep in this step, and then others.
    awake: Vec<u32>,
    /// The sum of the longest paths of any body in each step since the start, m.
    gone_most: f64,
    /// The length of the path of each body since the start, m, with [`TURNING`]: no point of its shapes has gone farther. Those
    /// of parts are those of the wholes, and stand there.
    gone: Vec<f64>,
    /// The lengths of the paths when the pairs were listed, m; -∞ where they must be listed anew.
    gone_listed: Vec<f64>,
    /// The contacts of this step.
    pub contacts: Vec<LinkContact>,
}

/// The factor on the length of paths for what turns in a step, so that speeds change on the way.
const TURNING: f64 = 1.1;

/// The steps, as long as the last one, after which it is found anew which pairs may wake soon.
const ALERT_STEPS: f64 = 8.0;

/// The part of that way that is gone until then: the sum of lengths is rounded.
const ALERT_PART: f64 = 0.999;

/// The distance within which pairs are listed, m.
const NEAR: f64 = 0.04;

impl LinkContacts {
    /// Compiles the shapes of all links; those that joints or bonds of trees join, that are declared as touching, or that
    /// begin inside each other, never push each other. `obstacles`: solids placed in the world, on the body that stands fast.
    ///
    /// # Errors
    /// A [`ShapeFault`] for the first shape that is not sound, and for an obstacle in which a link begins.
    pub(crate) fn new(
        model: &Model,
        robot: &Assembly,
        obstacles: &[Vec<Placed>],
    ) -> Result<LinkContacts, ShapeFault> {
        let mut all = LinkContacts::default();
        // The shapes of the obstacles come first, so that they are the first ones of pairs.
        let mut obstacle_of = Vec::new();
        if let Some(body) = model.fixture {
            for (number, shapes) in (1..).zip(obstacles) {
                let refused = |fault: Unsound| ShapeFault::Obstacle(number, format!("is not sound: {fault}"));
                for part in Solid::new(shapes).map_err(refused)?.parts {
                    obstacle_of.push(number);
                    all.shapes.push(Shape { body, part, touch: 0.0 });
                }
            }
        }
        all.standing = all.shapes.len();
        let pair = |a: usize, b: usize| (a.min(b), a.max(b));
        for module in 0..robot.modules.len() {
            let kind = robot.module_type(module);
            for (own, link) in kind.links.iter().enumerate() {
                let body = model.body(module, own);
                let parts = Solid::new(&link.collides).map_err(ShapeFault::Shape)?.parts;
                all.shapes.extend(parts.into_iter().map(|part| Shape { body, part, touch: kind.touch }));
            }
            let joined = kind.joints.iter().map(|joint| (joint.parent, joint.child));
            all.excluded.extend(
                joined
                    .chain(kind.touching.iter().copied())
                    .map(|(a, b)| pair(model.body(module, a), model.body(module, b))),
            );
        }
        all.gone = vec![0.0; model.bodies.len()];
        all.gone_listed = vec![f64::NEG_INFINITY; model.bodies.len()];
        all.spheres = all.spheres_around(model);
        let bodies = |bond: &Bond| pair(model.port(robot, bond.a).0, model.port(robot, bond.b).0);
        let lasting = robot.bonds.iter().enumerate().filter(|(bond, _)| !model.constraints.contains(bond));
        all.excluded.extend(lasting.map(|(_, bond)| bodies(bond)));
        // Links that hang together are one body.
        let mut whole: Vec<usize> = (0..model.bodies.len()).collect();
        for (at, body) in model.bodies.iter().enumerate() {
            if let Attachment::Fixed(parent) | Attachment::Part(parent) = body.attachment {
                whole[at] = whole[parent];
            }
        }
        for NearPair { first: a, second: b, .. } in all.near(model, &model.start) {
            let (first, second) = (&all.shapes[a], &all.shapes[b]);
            let bodies = pair(first.body, second.body);
            let X_AB = model.start[first.body].inv_mul(&model.start[second.body]);
            let distance = signed_distance_within(&first.part, &second.part, &X_AB, None, NEAR).distance;
            if let Some(number) = obstacle_of.get(a)
                && distance < -PARAMETERS.inside_depth
            {
                let why = "stands where the robot is as the plan begins".to_owned();
                return Err(ShapeFault::Obstacle(*number, why));
            }
            if whole[first.body] == whole[second.body]
                || distance < -first.touch.min(second.touch) - PARAMETERS.inside_depth
            {
                all.excluded.insert(bodies);
            }
        }
        Ok(all)
    }

    /// Returns the spheres around the shapes of all bodies that may move.
    fn spheres_around(&self, model: &Model) -> Vec<Sphere> {
        // The spheres around the shapes of each whole, in its frame.
        let mut of: Vec<Vec<(Vec3, f64)>> = vec![Vec::new(); model.bodies.len()];
        for shape in &self.shapes[self.standing..] {
            let whole = model.bodies[shape.body].whole;
            let X_HB = model.start[whole].inv_mul(&model.start[shape.body]);
            of[whole].push((X_HB.transform_point(&shape.part.centre.into()).coords, shape.part.radius));
        }
        let around = |(body, shapes): (usize, &Vec<(Vec3, f64)>)| {
            let corners = shapes.iter().flat_map(|(c, r)| [c.add_scalar(-r), c.add_scalar(*r)]);
            let all = Aabb::around(corners);
            let centre = (all.low + all.high) / 2.0;
            let radius = shapes.iter().map(|(c, r)| (c - centre).norm() + r).fold(0.0, f64::max);
            (!shapes.is_empty()).then_some(Sphere { body, centre, radius })
        };
        of.iter().enumerate().filter_map(around).collect()
    }

    /// Returns the pairs of shapes of different wholes that are near each other, by their spheres, ascending by the wholes and
    /// then by the shapes.
    fn near(&self, model: &Model, poses: &[Pose]) -> Vec<NearPair> {
        let of_shape = |shape: &Shape| (shape.body, shape.part.centre, shape.part.radius);
        let placed = |(body, centre, radius): (usize, Vec3, f64)| {
            (poses[body].transform_point(&centre.into()).coords, radius)
        };
        let shapes: Vec<(Vec3, f64)> = self.shapes.iter().map(|shape| placed(of_shape(shape))).collect();
        let spheres: Vec<(Vec3, f64)> =
            self.spheres.iter().map(|sphere| placed((sphere.body, sphere.centre, sphere.radius))).collect();
        let meet = |(p, r): &(Vec3, f64), (q, s): &(Vec3, f64)| length(&(p - q)) - (r + s) < NEAR;
        // The shapes of each sphere follow each other in this list.
        let mut order: Vec<(usize, usize)> = (self.standing..self.shapes.len())
            .map(|shape| (model.bodies[self.shapes[shape].body].whole, shape))
            .collect();
        order.sort_unstable();
        let of = |body: usize| {
            let begins = order.partition_point(|(whole, _)| *whole < body);
            order[begins..].iter().take_while(move |(whole, _)| *whole == body).map(|(_, shape)| *shape)
        };
        let mut found = Vec::new();
        // Obstacles may be so large that all would be near them.
        for (fixture, sphere) in
            model.fixture.iter().flat_map(|body| self.spheres.iter().map(move |s| (*body, s)))
        {
            for first in 0..self.standing {
                let near = of(sphere.body).filter(|second| meet(&shapes[first], &shapes[*second]));
                found.extend(near.map(|second| NearPair { wholes: (fixture, sphere.body), first, second }));
            }
        }
        let around = |(centre, radius): &(Vec3, f64)| Aabb {
            low: centre.add_scalar(-radius),
            high: centre.add_scalar(*radius),
        };
        let boxes: Vec<Aabb> = spheres.iter().map(around).collect();
        let size = spheres.iter().map(|(_, radius)| 2.0 * radius).fold(NEAR, f64::max);
        let mut wholes = Vec::new();
        near_boxes(&boxes, NEAR, size, |a, b| {
            if meet(&spheres[a], &spheres[b]) {
                wholes.push((self.spheres[a].body, self.spheres[b].body));
            }
        });
        wholes.sort_unstable();
        for wholes in wholes {
            for first in of(wholes.0) {
                for second in of(wholes.1).filter(|second| meet(&shapes[first], &shapes[*second])) {
                    let bodies = (self.shapes[first].body, self.shapes[second].body);
                    let bodies = (bodies.0.min(bodies.1), bodies.0.max(bodies.1));
                    if !self.excluded.contains(&bodies) && !self.bonded.contains(&bodies) {
                        found.push(NearPair { wholes, first, second });
                    }
                }
            }
        }
        found
    }

    /// Sets the pairs of bodies that bonds in no tree hold together from now on: they do not push each other.
    pub(crate) fn set_bonded(&mut self, pairs: impl Iterator<Item = (usize, usize)>) {
        self.bonded = pairs.map(|(a, b)| (a.min(b), a.max(b))).collect();
        // The next step lists the pairs anew.
        self.gone_listed.fill(f64::NEG_INFINITY);
    }

    /// Finds the links that meet in step `now`. `bodies`: the bodies with their velocities.
    #[inline(always)]
    pub(crate) fn find(&mut self, model: &Model, bodies: &ArticulatedBodies, at: &Instant, now: u64) {
        self.contacts.clear();
        let (mut farthest, mut most): (f64, f64) = (0.0, 0.0);
        for &Sphere { body, centre, radius } in &self.spheres {
            let centre = at.poses[body].translation.vector + at.turns[body] * centre - at.origin;
            let twist = bodies.velocity(body);
            let speed = length(&twist.at(&centre)) + length(&twist.angular) * radius;
            let path = TURNING * speed * at.step;
            self.gone[body] += path;
            most = most.max(path);
            farthest = farthest.max(self.gone[body] - self.gone_listed[body]);
        }
        self.gone_most += most;
        if 2.0 * farthest >= NEAR {
            self.list(model, at);
        }
        if self.gone_most >= self.alert_until {
            self.find_alert(ALERT_STEPS * most);
        }
        // Without a jump for each group, which would often be guessed wrong.
        self.awake.resize(self.alert.len(), 0);
        let mut count = 0;
        for number in &self.alert {
            self.awake[count] = *number;
            count += usize::from(self.groups[*number as usize].left(&self.gone) <= 0.0);
        }
        for awake in 0..count {
            let group = self.awake[awake] as usize;
            let gone = self.groups[group].gone(&self.gone);
            let end = self.groups.get(group + 1).map_or(self.pairs.len(), |next| next.begins);
            let mut until = f64::INFINITY;
            for number in self.groups[group].begins..end {
                if self.asleep[number] <= gone {
                    self.asleep[number] = gone + self.check(number, model, at, now);
                }
                until = until.min(self.asleep[number]);
            }
            self.groups[group].until = until;
        }
    }

    /// Finds whether the shapes of a pair, by its place in `pairs`, meet in step `now`. Returns the length of the path of both
    /// bodies together within which they can't meet, m; 0 if they do.
    #[inline(always)]
    fn check(&mut self, number: usize, model: &Model, at: &Instant, now: u64) -> f64 {
        let known = &mut self.known[number];
        let (first, second) = (known.bodies.0 as usize, known.bodies.1 as usize);
        let (X_WA, X_WB) = (&at.poses[first], &at.poses[second]);
        let rotation = X_WA.rotation.inverse() * X_WB.rotation;
        let shift = X_WB.translation.vector - X_WA.translation.vector;
        let centre = at.turns[first].tr_mul(&(shift + at.turns[second] * known.around.0));
        if known.gap > 0.0 {
            let left = known.gap - known.displacement(&centre, &rotation);
            if left > 0.0 {
                return left;
            }
        }
        let pair = &mut self.pairs[number];
        let (a, b) = (&self.shapes[pair.shapes.first], &self.shapes[pair.shapes.second]);
        let X_AB = X_WA.inv_mul(X_WB);
        let found = signed_distance_within(&a.part, &b.part, &X_AB, pair.normal, NEAR);
        let depth = -found.distance - a.touch.min(b.touch);
        if depth > 0.0 {
            let normal = X_WA.rotation * found.normal;
            let on_a = contact_point(&a.part, &b.part, &X_AB);
            let surface = model.bodies[a.body].surface.against(&model.bodies[b.body].surface);
            self.contacts.push(LinkContact {
                pair: number,
                first: a.body,
                second: b.body,
                point: X_WA.transform_point(&on_a.into()).coords - at.origin,
                contact: Contact::new(normal, depth, &surface, (&pair.spring, now), at.step),
            });
        }
        pair.normal = Some(found.normal);
        (known.gap, known.centre, known.rotation) = (-depth, centre, rotation);
        (-depth).max(0.0)
    }

    /// Finds the groups that may wake before any body has gone farther by a length, m.
    fn find_alert(&mut self, length: f64) {
        self.alert.resize(self.groups.len(), 0);
        let mut count = 0;
        for (group, number) in self.groups.iter().zip(0..) {
            self.alert[count] = number;
            // Neither of two bodies goes farther than the one that goes farthest.
            count += usize::from(group.left(&self.gone) <= 2.0 * length);
        }
        self.alert.truncate(count);
        self.alert_until = self.gone_most + ALERT_PART * length;
    }

    /// Lists the pairs that are near each other now; of those that were listed all that is known stays, and they sleep on.
    fn list(&mut self, model: &Model, at: &Instant) {
        let near = self.near(model, at.poses);
        std::mem::swap(&mut self.pairs, &mut self.pairs_before);
        std::mem::swap(&mut self.known, &mut self.known_before);
        std::mem::swap(&mut self.asleep, &mut self.asleep_before);
        self.pairs.clear();
        self.known.clear();
        self.asleep.clear();
        self.groups.clear();
        let mut before = self.pairs_before.iter().zip(&self.known_before).zip(&self.asleep_before).peekable();
        for own in near {
            let NearPair { wholes, first, second } = own;
            while before.next_if(|((pair, _), _)| pair.shapes < own).is_some() {}
            let listed = before.next_if(|((pair, _), _)| pair.shapes == own);
            let until = listed.map_or(0.0, |(_, until)| *until);
            match self.groups.last_mut().filter(|group| group.bodies == wholes) {
                Some(group) => group.until = group.until.min(until),
                None => self.groups.push(Group { bodies: wholes, until, begins: self.pairs.len() }),
            }
            self.asleep.push(until);
            if let Some(((pair, known), _)) = listed {
                self.pairs.push(pair.clone());
                self.known.push(*known);
                continue;
            }
            let part = &self.shapes[second].part;
            self.pairs.push(Pair { shapes: own, normal: None, spring: Spring::default() });
            let bodies = (self.shapes[first].body, self.shapes[second].body);
            self.known.push(Known {
                bodies: (bodies.0 as u32, bodies.1 as u32),
                gap: -1.0,
                centre: Vec3::zeros(),
                rotation: UnitQuaternion::identity(),
                around: (part.centre, part.radius),
            });
        }
        self.gone_listed.clone_from(&self.gone);
        self.alert_until = f64::NEG_INFINITY;
    }

    /// Adds a row for the normal of each contact that pushes, and two across it where friction bears something.
    pub(crate) fn add_rows(&self, rows: &mut Vec<Row>) {
        for link_contact in self.contacts.iter().filter(|contact| contact.contact.pushes) {
            let LinkContact { first, second, point, contact, .. } = link_contact;
            let Contact { stiffness, resistance, .. } = *contact;
            let [normal, across @ ..] = super::coupling::basis(Some(contact.normal));
            let mut add = |axis: Vec3, share: f64, offset: f64| {
                let unit = SpatialVector::of_force(axis, point);
                let kind = RowKind::Wrench { first: *first, second: *second, unit };
                rows.push(Row { kind, resistance: share * resistance, offset });
            };
            add(normal, 1.0, stiffness * contact.depth);
            if contact.share > 0.0 {
                for axis in across {
                    add(axis, contact.share, -contact.share * stiffness * contact.shift.dot(&axis));
                }
            }
        }
    }

    /// Iterates over the pairs of bodies that push each other.
    pub(crate) fn touching(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let pushing = self.contacts.iter().filter(|contact| contact.contact.pushes);
        pushing.map(|contact| (contact.first, contact.second))
    }

    /// Finds how the contacts go on for the accelerations of a round. Returns the greatest change of a force that comes
    /// of it, N.
    pub(crate) fn update(&mut self, bodies: &ArticulatedBodies, step: f64) -> f64 {
        let mut greatest: f64 = 0.0;
        for contact in &mut self.contacts {
            let velocity = contact.velocity(bodies, step);
            greatest = greatest.max(contact.contact.update(&velocity));
        }
        greatest.sqrt()
    }

    /// Keeps the springs for the next step, when the rounds of step `now` have ended.
    pub(crate) fn keep(&mut self, bodies: &ArticulatedBodies, step: f64, now: u64) {
        for contact in &self.contacts {
            let velocity = contact.velocity(bodies, step);
            self.pairs[contact.pair].spring = contact.contact.kept(&velocity, step, now);
        }
    }
}

impl LinkContact {
    /// Returns the velocity of the second body against the first at the contact after the step, m/s.
    fn velocity(&self, bodies: &ArticulatedBodies, step: f64) -> Vec3 {
        let after = |body| bodies.velocity(body).plus(&bodies.acceleration(body), step);
        after(self.second).plus(&after(self.first), -1.0).at(&self.point)
    }
}

impl Known {
    /// Returns an upper bound on the distance (m) by which a point within the sphere has moved in the frame of the first body;
    /// `centre` (m) and `rotation`: those now.
    #[inline(always)]
    fn displacement(&self, centre: &Vec3, rotation: &UnitQuaternion<f64>) -> f64 {
        // A turn by θ moves a point at the distance r by 2 r sin(θ / 2), which is at most 4 r sin(θ / 4); quaternions that
        // are so far apart differ by 2 sin(θ / 4), and have either sign.
        let (q, p) = (rotation.coords, self.rotation.coords);
        let apart = (q - p).norm_squared().min((q + p).norm_squared());
        length(&(centre - self.centre)) + 2.0 * self.around.1 * apart.sqrt()
    }
}
