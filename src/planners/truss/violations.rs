//! The constraints that a step of a truss violates at its end or on the way, each with its shortfall: lengths, distances, heights and
//! angles first; where these hold rigidity and forces, which take long.

use super::advancement;
use super::broad_phase::NeighbourList;
use super::constraint::Constraint;
use super::environment;
use super::forces;
use super::positions::{halfway, towards};
use super::rigidity;
use super::step::StepProblem;
use super::structure::Structure;
use super::support_polygon;
use super::threads;
use crate::geometry::Vec3;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// The singular values and forces known from positions nearby.
#[derive(Default)]
pub(super) struct Search {
    pub rigidity: rigidity::Known,
    pub forces: forces::Known,
}

/// Returns the constraints that are violated at y or before, each with its shortfall, m.
pub(super) fn violated(
    problem: &StepProblem,
    y: &[Vec3],
    neighbours: &mut Option<NeighbourList>,
    search: &RefCell<Search>,
) -> Vec<(Constraint, f64)> {
    let StepProblem { truss, x, .. } = *problem;
    let margin = truss.tolerances.clearance_margin * truss.unit;
    // Broad phase: pairs of struts that may come too near during the step.
    let pairs = NeighbourList::candidates(neighbours, truss, (x, y), margin);
    // Values at y.
    let lengths = (0..truss.struts.len())
        .flat_map(|strut| [Constraint::LengthMin(strut), Constraint::LengthMax(strut)]);
    let heights = (0..truss.nodes).filter(|_| problem.ground).map(Constraint::NodeHeight);
    let angles = truss.corners.iter().map(|&(i, j)| Constraint::Angle(i, j));
    let loops = (0..truss.limits.loops.len())
        .flat_map(|index| [Constraint::LoopMin(index), Constraint::LoopMax(index)]);
    let mut violated: BTreeMap<Constraint, f64> = BTreeMap::new();
    let mut check = |constraint: Constraint, value: f64| {
        if is_violated(truss, value) {
            add(&mut violated, constraint, -value);
        }
    };
    for pair in &pairs {
        let (i, j) = pair.struts;
        check(Constraint::Clearance(i, j), pair.end - truss.clearance);
    }
    for constraint in lengths.chain(heights).chain(angles).chain(loops) {
        check(constraint, constraint.value(truss, y));
    }
    // Conservative advancement during the step. Uneven ground comes last, once all else holds: of a long
    // step, before its rows are known, its certificate takes long.
    let between = advancement::violations(truss, x, y, &pairs, margin);
    let obstacles = environment::obstacle_violations(truss, x, y, margin);
    let ground = if problem.ground && violated.is_empty() {
        environment::ground_violations(truss, x, y)
    } else {
        Vec::new()
    };
    for (constraint, shortfall) in between.into_iter().chain(obstacles).chain(ground) {
        add(&mut violated, constraint, shortfall);
    }
    // Checks that take long come once all else holds.
    if violated.is_empty() {
        violated.extend(global_violations(problem, y, &mut search.borrow_mut()));
    }
    violated.into_iter().collect()
}

/// Returns true if a constraint of the given value, m, counts as violated.
fn is_violated(truss: &Structure, value: f64) -> bool {
    value < -truss.tolerances.rounding * truss.unit
}

/// Adds a violated constraint with its shortfall, m; the greater where it is known already.
fn add(violated: &mut BTreeMap<Constraint, f64>, constraint: Constraint, shortfall: f64) {
    violated.entry(constraint).and_modify(|known| *known = known.max(shortfall)).or_insert(shortfall);
}

/// Returns those of the constraints on rigidity and forces that are violated at y or on the way to it, with the shortfall
/// of each, m.
fn global_violations(problem: &StepProblem, y: &[Vec3], search: &mut Search) -> BTreeMap<Constraint, f64> {
    let StepProblem { truss, x, ground, .. } = *problem;
    // A step over the edge of the support ends there.
    let end = if ground { support_polygon::standing(truss, x, y) } else { y.to_vec() };
    let Search { rigidity, forces } = search;
    let (rigid, carries) = (truss.limits.rigidity > 0.0, truss.limits.forces.is_some() && ground);
    let mut of_rigidity = || {
        let values = rigidity_values(truss, x, (y, &end), rigidity);
        // A step that is made needs this bound; until forces are found it costs no time.
        if carries && threads::serve(truss) && values.is_empty() {
            rigidity.prepare(truss, &end);
        }
        values
    };
    let mut of_forces = || force_values(truss, x, (y, &end), forces);
    let (some, others) = match (carries, rigid) {
        (true, true) if threads::serve(truss) => threads::both(truss, of_forces, of_rigidity),
        // One after the other; those of forces seldom add to violations of rigidity.
        (true, true) => {
            let values = of_rigidity();
            if values.is_empty() { (of_forces(), values) } else { (Vec::new(), values) }
        }
        (true, false) => (of_forces(), Vec::new()),
        (false, true) => (Vec::new(), of_rigidity()),
        (false, false) => Default::default(),
    };
    let mut violated: BTreeMap<Constraint, f64> = BTreeMap::new();
    for (constraint, value) in others.into_iter().chain(some) {
        if is_violated(truss, value) {
            add(&mut violated, constraint, -value);
        }
    }
    violated
}

/// Returns the values of the constraints on rigidity, m, where one is violated on a step from `x` to `y` that may end before that
/// (m).
fn rigidity_values(
    truss: &Structure,
    x: &[Vec3],
    (y, end): (&[Vec3], &[Vec3]),
    known: &mut rigidity::Known,
) -> Vec<(Constraint, f64)> {
    let shorter = (end != y).then(|| known.violated(truss, x, end));
    let low: Vec<Vec<Vec3>> =
        known.violated(truss, x, y).into_iter().chain(shorter.into_iter().flatten()).collect();
    let mut values = Vec::new();
    for z in &low {
        // Modes of nearby positions may not lead to the least where the shape changes quickly.
        let mut modes = known.weakest(truss, z);
        if modes.iter().all(|mode| mode.spare(truss) >= 0.0) {
            modes = known.weakest_anew(truss, z);
        }
        let spares = modes.iter().map(|mode| mode.spare(truss)).enumerate();
        values.extend(spares.map(|(i, spare)| (Constraint::Rigidity(i, i), spare)));
    }
    // A way on which no value is below the limit is not proved: more is asked for.
    if !low.is_empty() && !values.iter().any(|(_, spare)| is_violated(truss, *spare)) {
        values.push((
            Constraint::Rigidity(0, 0),
            -truss.tolerances.unproved_part * truss.limits.rigidity * truss.unit,
        ));
    }
    values
}

/// Returns the values of the constraint on forces, m, with the feet that stay on a step from `x` to `y` that may end before that
/// (m).
fn force_values(
    truss: &Structure,
    x: &[Vec3],
    (y, end): (&[Vec3], &[Vec3]),
    known: &mut forces::Known,
) -> Vec<(Constraint, f64)> {
    let mut values = Vec::new();
    let feet = support_polygon::staying(truss, x, end);
    let mut look = |known: &mut forces::Known, z: &[Vec3]| {
        values.push((Constraint::Force, forces::spare(truss, &known.at(truss, z, &feet))));
    };
    // Those that stay bear the weight from the start of the step on.
    if feet != support_polygon::contacts(truss, x) {
        look(known, x);
    }
    // Right above an edge of the support only its two nodes bear the truss, on which nothing holds it upright.
    let part = 1.0 - truss.tolerances.edge_part;
    let near = if end == y { y.to_vec() } else { towards(x, end, part) };
    if !known.leave_much() {
        look(known, &halfway(x, end));
    }
    look(known, &near);
    values
}
