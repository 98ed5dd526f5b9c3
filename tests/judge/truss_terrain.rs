//! Trusses on uneven ground: what goes into it, what stands on it, and what slides.

use super::truss_plans::*;
use modl::geometry::{HeightField, Vec3};
use modl::plan::{CheckKind, Failure, Plan, Status, World};

/// A ground without weight: nothing needs to stand.
const WEIGHTLESS: World = World { gravity: 0.0, ..STANDING };
const CLEARANCE: f64 = 0.1;

fn on(plan: Plan, terrain: &HeightField) -> Plan {
    with(plan, |paths| paths.surroundings.terrain = Some(terrain.clone()))
}

/// Returns the failures of the ground, without those of rolls that nothing makes roll.
fn sunk(plan: &Plan) -> Vec<Failure> {
    let mut found = of(CheckKind::Ground, &judged(plan));
    found.retain(|failure| !failure.message.contains("makes it roll"));
    found
}

/// Returns a square ground about the origin.
fn square(spacing: f64, columns: usize, mut height: impl FnMut(usize, usize) -> f64) -> HeightField {
    let half = spacing * (columns - 1) as f64 / 2.0;
    let heights = (0..columns * columns).map(|k| height(k % columns, k / columns)).collect();
    HeightField { corner: [-half, -half], spacing, columns, heights }
}

/// Returns the depth of a node, or of the lowest of many points of a strut.
fn depth(terrain: &HeightField, ends: &[Place]) -> f64 {
    let below = |p: Place| -terrain.above(Vec3::from(p));
    match *ends {
        [p] => below(p),
        [p, q] => (0..=100).map(|k| below(between(p, q, f64::from(k) / 100.0))).fold(f64::MIN, f64::max),
        _ => unreachable!("a node or a strut"),
    }
}

/// Asserts that what a plan of one strut is told of the ground is what many moments say. `at`: the ends at a part of the
/// step. Returns true if it goes in, false if not, and nothing near the limit.
fn compared(plan: &Plan, terrain: &HeightField, at: &dyn Fn(f64) -> [Place; 2], what: &str) -> Option<bool> {
    let found = sunk(plan);
    let (mut node, mut strut) = (f64::MIN, f64::MIN);
    for k in 0..=400 {
        let ends = at(f64::from(k) / 400.0);
        node = node.max(depth(terrain, &ends[..1])).max(depth(terrain, &ends[1..]));
        strut = strut.max(depth(terrain, &ends));
    }
    let sink = CLEARANCE / 2.0;
    if let [failure] = &found[..] {
        assert!((0.0..=1.0).contains(&failure.time), "{what}: {failure:?}");
        let ends = at(failure.time);
        let there = match failure.at.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            ["n0"] => depth(terrain, &ends[..1]),
            ["n1"] => depth(terrain, &ends[1..]),
            _ => depth(terrain, &ends),
        };
        assert!((failure.value - there).abs() < 0.02, "{what}: {failure:?} {there}");
        let allowed = if failure.at.len() == 1 { 0.0 } else { sink };
        assert!(failure.value > allowed, "{what}: {failure:?}");
        assert!(failure.value <= node.max(strut) + 0.02, "{what}: {failure:?}");
    }
    if node > 1e-3 || strut > sink + 1e-3 {
        assert_eq!(found.len(), 1, "{what}: {node} {strut}");
        return Some(true);
    }
    if node < -0.01 && strut < sink - 0.01 {
        assert_eq!(found, vec![], "{what}: {node} {strut}");
        return Some(false);
    }
    None
}

#[test]
fn what_goes_straight_goes_as_deep_as_many_moments_say() {
    let mut number = dice(67);
    let mut sunk_in = Tally::default();
    for round in 0..60 {
        let terrain = square(0.5, 6, |_, _| number(0.0, 0.5));
        // High enough that many go over it, and low enough that many don't.
        let lift = if round % 2 == 0 { 0.2 } else { 0.45 };
        let mut place = || -> Place { [number(-1.4, 1.4), number(-1.4, 1.4), number(lift, 1.0)] };
        let (from, to) = ([place(), place()], [place(), place()]);
        let to = if round % 6 == 0 { from } else { to };
        let plan = plan(WEIGHTLESS, &[(0, 1)], vec![straight(0.0, &from), straight(1.0, &to)]);
        let at = |part: f64| [0, 1].map(|k| between(from[k], to[k], part));
        sunk_in.count(compared(&on(plan, &terrain), &terrain, &at, &format!("round {round}")));
    }
    let Tally { yes: wet, no: dry } = sunk_in;
    assert!(dry > 10 && wet > 10, "{dry} dry, {wet} wet");
}

#[test]
fn what_rolls_goes_as_deep_as_many_moments_say() {
    let mut number = dice(71);
    let mut sunk_in = Tally::default();
    for round in 0..60 {
        let terrain = square(0.5, 6, |_, _| number(0.0, 0.4));
        let mut nodes: Vec<Place> =
            (0..4).map(|_| [number(-1.0, 1.0), number(-1.0, 1.0), number(0.5, 1.0)]).collect();
        // The edge is level, above the ground, and ends nothing.
        (nodes[1][2], nodes[3][2]) = (0.9, 0.9);
        let edge = (nodes[1], minus(nodes[3], nodes[1]));
        let angle = number(-3.0, 3.0);
        let after: Vec<Place> = nodes.iter().map(|p| turned(*p, edge, angle)).collect();
        let keyframes = vec![straight(0.0, &nodes), roll(1.0, (1, 3), angle, &after)];
        let plan = on(plan(WEIGHTLESS, &[(0, 2)], keyframes), &terrain);
        let at = |part: f64| [0, 2].map(|k| turned(nodes[k], edge, angle * part));
        let named = |what: &str| format!("{what} {round}");
        // The nodes of the strut are the first and the third.
        let found = sunk(&plan);
        if found.iter().any(|failure| failure.at == ["n2"]) {
            let ends = at(found[0].time);
            assert!((found[0].value - depth(&terrain, &ends[1..])).abs() < 0.02, "{found:?}");
            sunk_in.count(Some(true));
            continue;
        }
        sunk_in.count(compared(&plan, &terrain, &at, &named("round")));
    }
    let Tally { yes: wet, no: dry } = sunk_in;
    assert!(dry > 5 && wet > 10, "{dry} dry, {wet} wet");
}

/// A strut goes over a spike between its nodes, which may be half a clearance and a micrometre deep in it. It goes as the
/// spike's side is steepest, so that the ground comes up as fast as any can.
#[test]
fn a_spike_may_be_half_a_clearance_deep_in_a_strut_and_no_deeper() {
    let spacing = 0.01;
    let terrain = square(spacing, 3, |column, row| if (column, row) == (1, 1) { 1.0 } else { 0.0 });
    for (excess, passes) in [(-1e-6, true), (0.5e-6, true), (2.2e-6, false), (3e-6, false), (1e-4, false)] {
        for begins in [0.03, 0.05, 0.0712] {
            let height = 1.0 - CLEARANCE / 2.0 - excess;
            let ends = |away: f64| -> [Place; 2] {
                [[-0.5 - away, -0.5 + away, height], [0.5 - away, 0.5 + away, height]]
            };
            let keyframes = vec![straight(0.0, &ends(begins)), straight(1.0, &ends(-0.04))];
            let found = sunk(&on(plan(WEIGHTLESS, &[(0, 1)], keyframes), &terrain));
            assert_eq!(found.is_empty(), passes, "{excess} {begins}: {found:?}");
        }
    }
}

/// A foot slides over even ground, or over a pit, where it does not carry.
#[test]
fn a_foot_that_passes_over_a_pit_carries_nothing() {
    let (from, mut to) = (tetra([0.5, HIGH / 3.0, 0.8]), tetra([0.5, HIGH / 3.0, 0.8]));
    to[2][0] += 0.5;
    for deep in [0.0, 0.2] {
        // The pit is in the middle of the foot's way.
        let mut terrain = square(0.25, 17, |column, row| if (column, row) == (8, 8) { -deep } else { 0.0 });
        terrain.corner = [0.75 - 2.0, HIGH - 2.0];
        let plan = plan(STANDING, &TETRA, vec![straight(0.0, &from), straight(1.0, &to)]);
        let verdict = judged(&on(plan, &terrain));
        let lost = of(CheckKind::Stability, &verdict);
        assert_eq!(lost.len(), usize::from(deep > 0.0), "{deep}: {lost:?}");
        assert!(lost.iter().all(|failure| failure.message.contains("three nodes")), "{lost:?}");
        assert!((verdict.slip.expect("told").value - if deep > 0.0 { 0.0 } else { 0.5 }).abs() < 1e-12);
    }
}

/// The verdict on a plan that does not limit sliding tells the friction that the steepest ground under a foot takes.
#[test]
fn the_friction_that_slopes_take_is_told() {
    let told = |rise: f64| {
        let terrain = HeightField::plane([0.6, 0.8], rise);
        let nodes: Vec<Place> = tetra([0.5, HIGH / 3.0, 0.8])
            .iter()
            .map(|p| [p[0], p[1], p[2] + rise * (0.6 * p[0] + 0.8 * p[1])])
            .collect();
        let verdict = judged(&on(plan(STANDING, &TETRA, vec![straight(0.0, &nodes)]), &terrain));
        assert_eq!(verdict.failures, vec![]);
        match status(&verdict, CheckKind::Slip) {
            Status::NotChecked(words) => words,
            status => panic!("{status:?}"),
        }
    };
    assert_eq!(told(0.0), "nodes may slide on the ground");
    let steep = told(0.25);
    assert!(steep.contains("which takes friction of 0.25"), "{steep}");
    assert!(steep.contains("slopes of up to 14.036"), "{steep}");
}
