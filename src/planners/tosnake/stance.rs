//! Quasi-static rest on a level floor: the direction of gravity in the robot's own frame, the balls that touch the
//! floor, and the loads of joints that bear on it.
//!
//! A robot of balls rests where its centre of mass is lowest among the attitudes near by: where the least distance of a
//! plane below all balls from the centre of mass, as a function of the plane's normal, has a local minimum (the support
//! function of the hull about the centre of mass). Then the vertical through the centre of mass meets the support
//! polygon.

use super::gravity::{GravityModel, JointLoad};
use super::state::State;
use super::tolerances::TOLERANCES;
use super::tree::Tree;
use crate::geometry::pose::perpendicular;
use crate::geometry::{RigidTransform, Vec3, monotone_chain};
use nalgebra::{Matrix3, Vector2};
use std::sync::{Arc, Mutex};

/// A point of the floor, or a vector along it, in pitches.
pub type Point = Vector2<f64>;

/// Greatest number of attitudes through which a robot rolls until it rests, and of changes of contacts in each.
const ATTITUDES_MAX: usize = 60;
const ROLLS_MAX: usize = 60;
/// Greatest number of touches that a robot gets where it is balanced, and the angle of each, rad.
const TOUCHES_MAX: usize = 6;
const TOUCH: f64 = 0.01;
/// The greatest slope of the floor against that at the beginning of a roll, before it is looked at anew.
const SLOPE_MAX: f64 = 1.0;

/// A rest on the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// The unit vector of gravity, in the frame of the poses.
    pub down: Vec3,
    /// The balls that touch the floor: their indices in the tree's order, ascending.
    pub contacts: Vec<usize>,
    /// The distance of the centre of mass from the edge of the support polygon, along the floor, in pitches; 0 where
    /// the contacts span no area.
    pub margin: f64,
}

impl Rest {
    /// No rest on a floor.
    pub(super) const NONE: Rest = Rest { down: Vec3::new(0.0, 0.0, 0.0), contacts: Vec::new(), margin: 0.0 };
}

/// The hindrances for which motions of a robot on the floor were not made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hindrances {
    /// The number of motions on which the robot would have fallen over.
    pub falls: u64,
    /// The number of motions on which a joint would have been overloaded.
    pub overloads: u64,
    /// The smallest overload of these; `None` without any. Of each overloaded motion the load at the first overload
    /// counts.
    pub least_overload: Option<JointLoad>,
}

/// The stance of a robot on the floor.
#[derive(Clone, Debug)]
pub struct Stance {
    /// The weights of the shoes, and the torque limits of the joints; who is held is of no account.
    pub model: Arc<GravityModel>,
    /// A shoe, by its number.
    pub shoe: usize,
    /// The unit vector of gravity in the frame of that shoe.
    pub down: Vec3,
    /// The hindrances so far.
    pub hindrances: Arc<Mutex<Hindrances>>,
}

impl Stance {
    /// Returns the stance of a robot at the start of a search; `down`: the unit vector of gravity in the frame of
    /// `shoe`.
    pub fn new(model: Arc<GravityModel>, shoe: usize, down: Vec3) -> Stance {
        Stance { model, shoe, down, hindrances: Arc::default() }
    }

    /// Returns the unit vector of gravity in the frame of the tree's root; `poses`: of the shoes, in the tree's order.
    pub(super) fn down_in_root(&self, tree: &Tree, poses: &[RigidTransform]) -> Vec3 {
        poses[tree.index[self.shoe]].rotation * self.down
    }

    /// Returns the unit vector of gravity in the frame of any shoe, given by its number. `state`: the robot in the
    /// posture of the stance. Panics if there is no such shoe.
    pub fn down_at(&self, state: &State, shoe: usize) -> Vec3 {
        let down = self.down_in_root(&state.tree, &state.poses);
        state.poses[state.tree.index[shoe]].rotation.transpose() * down
    }

    /// Returns the same stance with another direction of gravity, given in the frame of the tree's root.
    pub(crate) fn turned(&self, tree: &Tree, poses: &[RigidTransform], down: Vec3) -> Stance {
        Stance { down: poses[tree.index[self.shoe]].rotation.transpose() * down, ..self.clone() }
    }

    /// Returns true if a robot that rests on the floor in these poses is on no brink and all joints hold their loads;
    /// notes otherwise why not.
    pub(super) fn bears(&self, tree: &Tree, poses: &[RigidTransform], rest: &Rest) -> bool {
        if rest.margin < TOLERANCES.stability {
            self.note_fall();
            return false;
        }
        match self.model.greatest_at_rest(tree, poses, rest) {
            Some(load) if load.ratio <= 1.0 - TOLERANCES.load_spare => true,
            load => {
                load.into_iter().for_each(|load| self.note_overload(load));
                false
            }
        }
    }

    /// Returns the smallest overload that was noted; `None` without any.
    pub(super) fn least_overload(&self) -> Option<JointLoad> {
        self.hindrances.lock().expect("no thread panics while it notes").least_overload
    }

    /// Notes that a motion is not made, for the robot would fall over.
    pub(super) fn note_fall(&self) {
        self.hindrances.lock().expect("no thread panics while it notes").falls += 1;
    }

    /// Notes that a motion is not made, for a joint would be overloaded.
    fn note_overload(&self, load: JointLoad) {
        let mut hindrances = self.hindrances.lock().expect("no thread panics while it notes");
        hindrances.overloads += 1;
        if hindrances.least_overload.is_none_or(|known| load.ratio < known.ratio) {
            hindrances.least_overload = Some(load);
        }
    }
}

impl GravityModel {
    /// Returns the rest into which a robot rolls from an attitude with gravity along the unit vector `down`, in the
    /// frame of the poses (of the shoes, in the tree's order, in pitches); `None` if it finds none. A robot that is
    /// balanced on one ball, or on balls in a line, stays so, with no margin.
    pub fn rest(&self, tree: &Tree, poses: &[RigidTransform], down: Vec3) -> Option<Rest> {
        rest(&self.arms(tree, poses), down)
    }

    /// Returns the rest into which a robot rolls as [`GravityModel::rest`] has it, but from where it is balanced it
    /// goes on to either side, as any touch would have it.
    pub fn settled(&self, tree: &Tree, poses: &[RigidTransform], down: Vec3) -> Option<Rest> {
        settled(&self.arms(tree, poses), down)
    }

    /// Returns the rests that [`rests`] does, of a robot in these poses.
    pub fn rests(&self, tree: &Tree, poses: &[RigidTransform], down: Vec3) -> Vec<Rest> {
        rests(&self.arms(tree, poses), down)
    }

    /// Returns the centres of all balls from the centre of mass.
    fn arms(&self, tree: &Tree, poses: &[RigidTransform]) -> Vec<Vec3> {
        let mut centre = Vec3::zeros();
        let mut weight = 0.0;
        for (index, pose) in poses.iter().enumerate() {
            let own = self.shoes[tree.shoe[index]];
            centre += pose.translation * own;
            weight += own;
        }
        let centre = centre / weight;
        poses.iter().map(|pose| pose.translation - centre).collect()
    }

    /// Returns the greatest load of a joint of a robot at rest on the floor, with the forces of the floor that have the
    /// least sum of squares; `None` if these do not balance the weight.
    pub fn greatest_at_rest(&self, tree: &Tree, poses: &[RigidTransform], rest: &Rest) -> Option<JointLoad> {
        let mut weights: Vec<f64> = tree.shoe.iter().map(|&shoe| self.shoes[shoe]).collect();
        let total: f64 = weights.iter().sum();
        let arms = self.arms(tree, poses);
        let parts = balanced_parts(&along_floor(&arms, &rest.contacts, &rest.down))?;
        for (index, part) in rest.contacts.iter().zip(parts) {
            weights[*index] -= part * total;
        }
        let loads = self.loads_of(tree, poses, rest.down, &weights);
        Some(loads.into_iter().fold(JointLoad::NONE, JointLoad::greater))
    }
}

/// Returns two unit vectors that are orthogonal to a unit vector and to each other.
fn across(down: &Vec3) -> (Vec3, Vec3) {
    let x = -perpendicular(down);
    (x, down.cross(&x))
}

/// Returns the places of some balls along the floor, from the centre of mass.
fn along_floor(arms: &[Vec3], balls: &[usize], down: &Vec3) -> Vec<Point> {
    let (x, y) = across(down);
    balls.iter().map(|&ball| Point::new(arms[ball].dot(&x), arms[ball].dot(&y))).collect()
}

/// Returns the rest into which balls of one size roll; `None` if they roll on and on. `arms`: their centres from the
/// centre of mass, in pitches; `down`: the unit vector of gravity at the start. Contacts are indices of balls.
pub fn rest(arms: &[Vec3], mut down: Vec3) -> Option<Rest> {
    for _ in 0..ATTITUDES_MAX {
        let (x, y) = across(&down);
        let at: Vec<Point> = arms.iter().map(|arm| Point::new(arm.dot(&x), arm.dot(&y))).collect();
        let lowest = arms.iter().map(|arm| -arm.dot(&down)).fold(f64::INFINITY, f64::min);
        let mut above: Vec<f64> = arms.iter().map(|arm| -arm.dot(&down) - lowest).collect();
        let slope = roll(&at, &mut above)?;
        if slope.norm() < TOLERANCES.level {
            let contacts = touching(&above);
            let polygon = hull(contacts.iter().map(|&index| at[index]).collect());
            return Some(Rest { down, margin: margin(&polygon), contacts });
        }
        down = (down + x * slope.x + y * slope.y).normalize();
    }
    None
}

/// Returns the rest that [`rest`] does, after a touch wherever the robot is balanced; with the same arguments.
pub fn settled(arms: &[Vec3], down: Vec3) -> Option<Rest> {
    let mut found = rest(arms, down)?;
    for _ in 0..TOUCHES_MAX {
        if found.margin > 0.0 {
            break;
        }
        let (x, y) = across(&found.down);
        let aside = brink(&hull(along_floor(arms, &found.contacts, &found.down)));
        found = rest(arms, (found.down + (x * aside.x + y * aside.y) * TOUCH).normalize())?;
    }
    Some(found)
}

/// Returns the rests that balls find from an attitude with gravity along the unit vector `down`, first, and from others
/// spread over all directions, without those on a brink; `arms` as by [`rest`].
pub fn rests(arms: &[Vec3], down: Vec3) -> Vec<Rest> {
    let around = (0..27).filter_map(|number| {
        let along = |axis: u32| f64::from(number / 3i32.pow(axis) % 3 - 1);
        Vec3::new(along(0), along(1), along(2)).try_normalize(TOLERANCES.coincident)
    });
    let mut found: Vec<Rest> = Vec::new();
    for down in std::iter::once(down).chain(around) {
        if let Some(rest) = settled(arms, down)
            && rest.margin >= TOLERANCES.stability
            && found.iter().all(|known| (known.down - rest.down).norm() > TOLERANCES.same_rest)
        {
            found.push(rest);
        }
    }
    found
}

/// Returns the balls that touch the floor, by their heights above it.
fn touching(above: &[f64]) -> Vec<usize> {
    (0..above.len()).filter(|&index| above[index] < TOLERANCES.contact).collect()
}

/// Turns the floor about what touches it until the vertical through the centre of mass meets the support polygon, or
/// until its slope is [`SLOPE_MAX`]; returns the slope. `at`: the places of balls along the floor, from the centre of
/// mass; `above`: their heights above the floor, which are replaced by those above the floor that was turned. The
/// vertical is that of the beginning.
fn roll(at: &[Point], above: &mut [f64]) -> Option<Point> {
    let mut slope = Point::zeros();
    for _ in 0..ROLLS_MAX {
        let contacts = touching(above);
        let nearest = nearest_point(&hull(contacts.iter().map(|&index| at[index]).collect()));
        let far = nearest.norm();
        if far < TOLERANCES.on_axis {
            return Some(slope);
        }
        // The floor rises towards the centre of mass about the line through the nearest point.
        let along = -nearest / far;
        let distance = |index: usize| (at[index] - nearest).dot(&along);
        let mut rise = SLOPE_MAX - slope.norm().min(SLOPE_MAX);
        let mut is_steep = true;
        for (index, &above) in above.iter().enumerate() {
            let reach = distance(index);
            if above >= TOLERANCES.contact && reach > TOLERANCES.on_axis && above < rise * reach {
                rise = above / reach;
                is_steep = false;
            }
        }
        for (index, above) in above.iter_mut().enumerate() {
            *above = f64::max(0.0, *above - rise * distance(index));
        }
        slope += along * rise;
        if is_steep {
            return Some(slope);
        }
    }
    None
}

/// Returns the corners of the convex hull of points, counter-clockwise: two if all are on a line, one if all are at one
/// place.
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup_by(|a, b| (*a - *b).norm() < TOLERANCES.coincident);
    if points.len() < 3 {
        return points;
    }
    monotone_chain(&points, |a, b, c| {
        let (ahead, aside) = (b - a, c - a);
        ahead.perp(&aside) > TOLERANCES.indifferent * (1.0 + aside.norm_squared())
    })
}

/// Returns the point of a convex polygon that is nearest to the origin, which is the origin if it is inside. Panics if
/// the polygon has no corner.
fn nearest_point(polygon: &[Point]) -> Point {
    if polygon.len() >= 3 && margin(polygon) > 0.0 {
        return Point::zeros();
    }
    let mut nearest = polygon[0];
    for (index, &a) in polygon.iter().enumerate() {
        let side = polygon[(index + 1) % polygon.len()] - a;
        let part = (-a.dot(&side) / side.norm_squared().max(TOLERANCES.divisor)).clamp(0.0, 1.0);
        let point = a + side * part;
        if point.norm_squared() < nearest.norm_squared() {
            nearest = point;
        }
    }
    nearest
}

/// Returns the distance of the origin from the edge of a convex polygon around it; 0 if it is not around it.
fn margin(polygon: &[Point]) -> f64 {
    if polygon.len() < 3 {
        return 0.0;
    }
    let inside = |(index, a): (usize, &Point)| {
        let side = polygon[(index + 1) % polygon.len()] - a;
        side.perp(&-a) / side.norm().max(TOLERANCES.divisor)
    };
    polygon.iter().enumerate().map(inside).fold(f64::INFINITY, f64::min).max(0.0)
}

/// Returns the unit vector in which a robot goes over whose weight, at the origin, acts on the edge of a convex
/// polygon: outwards, to either side where the polygon has no area. Panics if the polygon has no corner.
fn brink(polygon: &[Point]) -> Point {
    let sides = polygon.iter().enumerate().map(|(index, a)| (a, polygon[(index + 1) % polygon.len()] - a));
    let long = sides.filter(|(_, side)| side.norm() > TOLERANCES.coincident);
    let inside = |(a, side): &(&Point, Point)| side.perp(&-*a) / side.norm();
    match long.min_by(|p, q| inside(p).total_cmp(&inside(q))) {
        Some((_, side)) => Point::new(side.y, -side.x).normalize(),
        None => Point::x(),
    }
}

/// Returns parts of a unit weight at the origin that points of the floor bear: not negative, in equilibrium, and with
/// the least sum of squares among those of the points that bear some (active set). `None` if no parts are found.
pub fn balanced_parts(points: &[Point]) -> Option<Vec<f64>> {
    let mut bears = vec![true; points.len()];
    for _ in 0..=points.len() {
        // Least squares: each part is linear in the place of its point.
        let mut normal = Matrix3::zeros();
        let row = |point: &Point| Vec3::new(1.0, point.x, point.y);
        for point in points.iter().zip(&bears).filter_map(|(point, bears)| bears.then_some(point)) {
            normal += row(point) * row(point).transpose();
        }
        let svd = normal.svd(true, true);
        let multiplier = svd.solve(&Vec3::x(), TOLERANCES.indifferent * svd.singular_values.max()).ok()?;
        let parts: Vec<f64> = points
            .iter()
            .zip(&bears)
            .map(|(point, bears)| if *bears { row(point).dot(&multiplier) } else { 0.0 })
            .collect();
        let least = (0..points.len()).min_by(|&a, &b| parts[a].total_cmp(&parts[b]))?;
        if parts[least] >= 0.0 {
            let sum: Vec3 = points.iter().zip(&parts).map(|(point, part)| row(point) * *part).sum();
            return ((sum - Vec3::x()).amax() < TOLERANCES.balance).then_some(parts);
        }
        bears[least] = false;
    }
    None
}
