//! How near a truss is to each of its limits where it is.

use super::bound::Bound;
use super::nearby;
use super::roll;
use super::stiffness;
use super::structure::Structure;
use super::support;
use crate::geometry::Vec3;
use crate::plan::Margins;

/// Of the nodes' places. `stands`: whether it stands on the ground.
pub fn margins(truss: &Structure, x: &[Vec3], stands: bool) -> Margins {
    let value = |bound: Bound| bound.value(truss, x);
    let least = |values: &mut dyn Iterator<Item = f64>| values.reduce(f64::min);
    let struts = 0..truss.struts.len();
    let lengths = struts.clone().flat_map(|strut| [Bound::Shortest(strut), Bound::Longest(strut)]);
    let near = |margin: &f64| *margin <= truss.clearance;
    let pairs = nearby::pairs(truss, x, 2.0 * truss.clearance);
    let obstacles = struts.flat_map(|strut| {
        let segment = truss.segment(x, strut);
        let parts = 0..truss.around.parts.len();
        let may = move |part: &usize| truss.around.may_meet(segment, *part, 2.0 * truss.clearance);
        parts
            .filter(may)
            .map(move |part| truss.around.nearness(segment, part, f64::MAX).distance - truss.clearance)
    });
    let sums = 0..truss.limits.loops.len();
    let still = truss.limits.still.iter().flat_map(|&strut| [Bound::Shortest(strut), Bound::Longest(strut)]);
    let sums = sums.flat_map(|index| [Bound::Least(index), Bound::Most(index)]).chain(still);
    let feet = if stands { support::contacts(truss, x) } else { Vec::new() };
    let rigid = (truss.limits.rigidity > 0.0).then(|| stiffness::weakest(truss, x, 1));
    Margins {
        length: least(&mut lengths.map(value)),
        clearance: least(&mut pairs.iter().map(|&(i, j, _)| value(Bound::Apart(i, j))).filter(near)),
        obstacle: least(&mut obstacles.filter(near)),
        support: roll::standing(truss, x, &feet).map(|(inside, _)| inside),
        angle: least(&mut truss.corners.iter().map(|&(i, j)| value(Bound::Angle(i, j)) / truss.unit)),
        rigidity: rigid.and_then(|modes| modes.first().map(|mode| mode.value - truss.limits.rigidity)),
        sum: least(&mut sums.map(value)),
    }
}
