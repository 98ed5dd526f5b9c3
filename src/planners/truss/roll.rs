//! Rolling: when the centre of mass comes over an edge of the support, the truss falls over it as one
//! rigid body until other nodes meet the ground.

use super::bound::Bound;
use super::structure::Structure;
use super::support;
use super::turning::{self, Line, ON_LINE};
use crate::geometry::Vec3;
use std::f64::consts::TAU;

/// Falls from edge to edge until it rests: a truss that still falls is a wheel.
pub const FALLS_MAX: usize = 50;
/// It rests if its centre of mass is farther inside its support than this part of the unit.
const RESTS: f64 = 1e-9;
/// Turns smaller than this are none, rad.
const TURN_MIN: f64 = 1e-9;

/// A turn about the line from the first node to the second, by the right-hand rule, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roll {
    pub edge: (usize, usize),
    pub angle: f64,
}

/// The roll over an edge of the support (its inside on the left) to the outside, by the least angle that
/// brings a node to the ground.
pub fn over(truss: &Structure, x: &[Vec3], edge: (usize, usize)) -> Option<Roll> {
    let line = line(x, edge);
    if truss.around.terrain.is_some() {
        let angle = x.iter().filter_map(|p| turning::landing(truss, &line, *p)).min_by(f64::total_cmp)?;
        return Some(Roll { edge, angle });
    }
    let Line { origin, along } = line;
    // Turned by t, a node is at the height `middle + level cos t + ahead sin t`.
    let landing = |p: &Vec3| {
        let arm = p - origin;
        let across = arm - along * along.dot(&arm);
        let (level, ahead) = (across.z, along.cross(&arm).z);
        let middle = p.z - level;
        let reach = libm::hypot(level, ahead);
        if across.norm() <= ON_LINE * truss.unit || middle.abs() >= reach {
            return None;
        }
        let angle = libm::atan2(ahead, level) + libm::acos(-middle / reach);
        Some(if angle > TURN_MIN { angle } else { angle + TAU })
    };
    let angle = x.iter().filter_map(landing).min_by(f64::total_cmp)?;
    Some(Roll { edge, angle })
}

fn line(x: &[Vec3], edge: (usize, usize)) -> Line {
    Line { origin: x[edge.0], along: (x[edge.1] - x[edge.0]).normalize() }
}

/// What is in the way of a roll.
pub fn blocked(truss: &Structure, x: &[Vec3], roll: Roll) -> Option<Bound> {
    turning::blocked(truss, x, &line(x, roll.edge), roll.angle)
}

/// What a truss on the ground does by itself.
pub enum Fate {
    Rests,
    Rolls(Roll),
    /// It stands on one node, this one.
    Tips(usize),
}

/// `None` if it rolls over an edge beyond which nothing meets the ground.
pub fn fate(truss: &Structure, x: &[Vec3]) -> Option<Fate> {
    let contacts = support::contacts(truss, x);
    match standing(truss, x, &contacts) {
        Some((inside, _)) if inside > RESTS * truss.unit => Some(Fate::Rests),
        Some((_, edge)) => over(truss, x, edge).map(Fate::Rolls),
        None => contacts.first().map(|node| Fate::Tips(*node)),
    }
}

/// The truss as it comes to rest on the ground when it is let go with its lowest nodes there. Where it falls
/// on from is the one that is nearest to the centre of mass; `None` if it never rests.
pub fn rested(truss: &Structure, x: &[Vec3]) -> Option<Vec<Vec3>> {
    let mut x = x.to_vec();
    for _ in 0..FALLS_MAX {
        let lowest = x.iter().map(|p| truss.around.above(*p)).fold(f64::INFINITY, f64::min);
        x.iter_mut().for_each(|p| p.z -= lowest);
        x = match fate(truss, &x)? {
            Fate::Rests => return Some(x),
            Fate::Rolls(roll) => rolled(&x, roll),
            Fate::Tips(node) => tipped(truss, &x, node)?,
        };
    }
    None
}

/// Over one node, towards where the centre of mass is.
fn tipped(truss: &Structure, x: &[Vec3], node: usize) -> Option<Vec<Vec3>> {
    let arm = truss.centre(x) - x[node];
    let aside = Vec3::new(-arm.y, arm.x, 0.0);
    let along = aside.try_normalize(ON_LINE * truss.unit).unwrap_or_else(Vec3::y);
    let mut with_axis = x.to_vec();
    with_axis.push(x[node] + along * truss.unit);
    // Turned about the axis by the right hand, what is ahead comes down.
    let roll = over(truss, &with_axis, (node, x.len()))?;
    let mut found = rolled(&with_axis, roll);
    found.pop();
    Some(found)
}

pub fn rolled(x: &[Vec3], roll: Roll) -> Vec<Vec3> {
    let line = line(x, roll.edge);
    let turn = line.turn(roll.angle);
    x.iter().map(|p| turn(*p)).collect()
}

/// How far the centre of mass is inside the hull of some nodes (m, negative outside), and the edge that it
/// is nearest to.
pub fn standing(truss: &Structure, x: &[Vec3], feet: &[usize]) -> Option<(f64, (usize, usize))> {
    support::margin(x, &support::hull(x, feet), truss.centre(x))
}
