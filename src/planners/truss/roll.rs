//! Rolls: when the centre of mass leaves the support polygon over an edge, the truss topples over that edge
//! as one rigid body until other nodes meet the ground.

use super::constraint::Constraint;
use super::rotation::{self, Axis};
use super::structure::Structure;
use super::support_polygon::{self, contacts};
use crate::geometry::Vec3;
use std::f64::consts::TAU;

/// The number of rolls in a row after which a truss that still topples counts as one that never rests.
pub(in crate::planners) const ROLLS_MAX: usize = 50;

/// A roll of a truss: a rigid rotation about the line through two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roll {
    /// The indices of the two nodes on the axis, which keep their positions; the axis points from the first to the
    /// second.
    pub edge: (usize, usize),
    /// The angle of the roll by the right-hand rule about the axis, rad.
    pub angle: f64,
}

/// Returns the roll outwards over an edge of the support polygon (two nodes, the inside on their left) by the least
/// angle that brings another node to the ground; `None` if none gets there. `x`: the positions of the nodes, m.
pub(in crate::planners) fn over(truss: &Structure, x: &[Vec3], edge: (usize, usize)) -> Option<Roll> {
    let axis = axis(x, edge);
    // Over terrain by conservative advancement, over flat ground in closed form.
    if truss.surroundings.terrain.is_some() {
        let angle = x.iter().filter_map(|p| rotation::touchdown(truss, &axis, *p)).min_by(f64::total_cmp)?;
        return Some(Roll { edge, angle });
    }
    let Axis { origin, along } = axis;
    // Rotated by t, a node is at the height `middle + level cos t + ahead sin t`.
    let touchdown = |p: &Vec3| {
        let arm = p - origin;
        let across = arm - along * along.dot(&arm);
        let (level, ahead) = (across.z, along.cross(&arm).z);
        let middle = p.z - level;
        let reach = libm::hypot(level, ahead);
        if across.norm() <= truss.tolerances.on_axis * truss.unit || middle.abs() >= reach {
            return None;
        }
        let angle = libm::atan2(ahead, level) + libm::acos(-middle / reach);
        Some(if angle > truss.tolerances.rotation_min { angle } else { angle + TAU })
    };
    let angle = x.iter().filter_map(touchdown).min_by(f64::total_cmp)?;
    Some(Roll { edge, angle })
}

/// Returns the axis of a roll over an edge.
fn axis(x: &[Vec3], edge: (usize, usize)) -> Axis {
    Axis { origin: x[edge.0], along: (x[edge.1] - x[edge.0]).normalize() }
}

/// Returns a constraint that a roll would violate: a strut would meet an obstacle, or the ground before its ends do.
/// `None` if the roll is free. `x`: the positions of the nodes, m.
pub(in crate::planners) fn blocked(truss: &Structure, x: &[Vec3], roll: Roll) -> Option<Constraint> {
    rotation::blocked(truss, x, &axis(x, roll.edge), roll.angle)
}

/// The static equilibrium of a truss on the ground: stable, toppling over an edge, or on one node.
pub(in crate::planners) enum Equilibrium {
    /// The centre of mass is inside the support polygon.
    Stable,
    /// The truss topples by this roll.
    Topples(Roll),
    /// The truss stands on the node of this index alone.
    OnOneNode(usize),
}

/// Returns the static equilibrium of a truss with its nodes at `x` (m) on the ground: stable if the centre of mass is
/// inside the support polygon by more than the tolerance `stability_margin`. `None` if it has no contact, or topples
/// over an edge beyond which nothing meets the ground.
pub(in crate::planners) fn equilibrium(truss: &Structure, x: &[Vec3]) -> Option<Equilibrium> {
    let contacts = contacts(truss, x);
    match support_polygon::stability_margin(truss, x, &contacts) {
        Some((inside, _)) if inside > truss.tolerances.stability_margin * truss.unit => {
            Some(Equilibrium::Stable)
        }
        Some((_, edge)) => over(truss, x, edge).map(Equilibrium::Topples),
        None => contacts.first().map(|node| Equilibrium::OnOneNode(*node)),
    }
}

/// Returns true if the truss does not topple with its nodes at `x`, m.
pub(in crate::planners) fn is_stable(truss: &Structure, x: &[Vec3]) -> bool {
    matches!(equilibrium(truss, x), Some(Equilibrium::Stable))
}

/// Returns the positions of the nodes, m, once the truss has come to rest from `x`, m: it is put down with its lowest
/// nodes on the ground, then rolls over edges of its support polygon until it is statically stable (McGhee and Frank
/// 1968). Quasi-static, without inertia; obstacles do not count. `None` if it does not rest after `ROLLS_MAX` rolls,
/// or nothing of it meets the ground any more.
pub fn settled(truss: &Structure, x: &[Vec3]) -> Option<Vec<Vec3>> {
    let mut x = x.to_vec();
    for _ in 0..ROLLS_MAX {
        let lowest = x.iter().map(|p| truss.surroundings.height(*p)).fold(f64::INFINITY, f64::min);
        x.iter_mut().for_each(|p| p.z -= lowest);
        x = match equilibrium(truss, &x)? {
            Equilibrium::Stable => return Some(x),
            Equilibrium::Topples(roll) => rolled(&x, roll),
            Equilibrium::OnOneNode(node) => toppled_over_node(truss, &x, node)?,
        };
    }
    None
}

/// Returns the positions after toppling over one node, in the direction of the centre of mass: a roll about
/// a horizontal axis through the node; `None` if no other node comes down.
fn toppled_over_node(truss: &Structure, x: &[Vec3], node: usize) -> Option<Vec<Vec3>> {
    let arm = truss.centre_of_mass(x) - x[node];
    let aside = Vec3::new(-arm.y, arm.x, 0.0);
    let along = aside.try_normalize(truss.tolerances.on_axis * truss.unit).unwrap_or_else(Vec3::y);
    // The axis becomes an edge to an auxiliary node; by the right-hand rule, nodes ahead of it come down.
    let mut with_axis = x.to_vec();
    with_axis.push(x[node] + along * truss.unit);
    let roll = over(truss, &with_axis, (node, x.len()))?;
    let mut found = rolled(&with_axis, roll);
    found.pop();
    Some(found)
}

/// Returns the positions of the nodes after a roll from `x`, both in m and in the order of the nodes.
pub fn rolled(x: &[Vec3], roll: Roll) -> Vec<Vec3> {
    let axis = axis(x, roll.edge);
    let rotate = axis.rotation(roll.angle);
    x.iter().map(|p| rotate(*p)).collect()
}
