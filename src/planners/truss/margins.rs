//! Margins of a configuration: the distances of its values from their limits.

use super::broad_phase::NeighbourList;
use super::constraint::Constraint;
use super::motion::Findings;
use super::rigidity;
use super::structure::Structure;
use super::support_polygon;
use crate::geometry::Vec3;
use crate::plan::Margins;
use crate::robot::truss_statics::Modes;

/// Returns the least margin of each kind of limit at the positions `x` of the nodes, m, in the unit that [`Margins`]
/// gives. A margin is `None` for a kind of limit that the truss does not have, and a distance to struts or obstacles
/// also if none is at most twice the clearance. `stands`: true if the truss stands on the ground, so that its static
/// stability margin counts; that is `None` where it does not, as between two rolls.
pub fn margins(truss: &Structure, x: &[Vec3], stands: bool) -> Margins {
    margins_near(truss, x, stands, Findings::default(), &mut Nearby::default())
}

/// The data that the margins of one configuration hand on to those of the next of the same truss, so that they take less time;
/// the default for the first.
#[derive(Clone, Debug, Default)]
pub(super) struct Nearby {
    /// The modes of the least singular values.
    modes: Modes,
    /// The pairs of struts that may come near; `None` before the first configuration.
    neighbours: Option<NeighbourList>,
}

/// Returns the margins as [`margins`] does. `findings`: what is known of the positions; `nearby`: what is known of nearby ones, which
/// becomes that of these.
pub(super) fn margins_near(
    truss: &Structure,
    x: &[Vec3],
    stands: bool,
    findings: Findings,
    nearby: &mut Nearby,
) -> Margins {
    let value = |constraint: Constraint| constraint.value(truss, x);
    let least = |values: &mut dyn Iterator<Item = f64>| values.reduce(f64::min);
    let struts = 0..truss.struts.len();
    let both_ends = |strut: usize| [Constraint::LengthMin(strut), Constraint::LengthMax(strut)];
    let lengths = struts.clone().flat_map(both_ends);
    // Distances to other struts and to obstacles, where they are near.
    let near = |margin: &f64| *margin <= truss.clearance;
    let found = || NeighbourList::least_distance(&mut nearby.neighbours, truss, x);
    let clearance = findings.distance.unwrap_or_else(found) - truss.clearance;
    let obstacles = struts.flat_map(|strut| {
        let segment = truss.segment(x, strut);
        let parts = 0..truss.surroundings.parts.len();
        let may = move |part: &usize| truss.surroundings.may_collide(segment, *part, 2.0 * truss.clearance);
        parts.filter(may).map(move |part| {
            truss.surroundings.signed_distance(segment, part, f64::MAX).distance - truss.clearance
        })
    });
    // Sums of lengths: of loops, and of single struts that are locked.
    let locked = truss.limits.locked.iter().flat_map(|&strut| both_ends(strut));
    let sums = (0..truss.limits.loops.len())
        .flat_map(|index| [Constraint::LoopMin(index), Constraint::LoopMax(index)])
        .chain(locked);
    let contacts = if stands { support_polygon::contacts(truss, x) } else { Vec::new() };
    let inside = support_polygon::stability_margin(truss, x, &contacts);
    let mut found = || findings.least.or_else(|| rigidity::least(truss, x, &mut nearby.modes));
    let weakest = if truss.limits.rigidity > 0.0 { found() } else { None };
    Margins {
        length: least(&mut lengths.map(value)),
        clearance: Some(clearance).filter(near),
        obstacle: least(&mut obstacles.filter(near)),
        support: inside.map(|(inside, _)| inside).filter(|inside| *inside >= 0.0),
        angle: least(&mut truss.corners.iter().map(|&(i, j)| value(Constraint::Angle(i, j)) / truss.unit)),
        rigidity: weakest.map(|value| value - truss.limits.rigidity),
        sum: least(&mut sums.map(value)),
    }
}
