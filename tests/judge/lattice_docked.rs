//! The judge of cells that do not slide: they hold each other where the middles of two faces meet, and only there.

use crate::planners::squeeze::to_halves;
use crate::support::lattices::{
    Flat, PAPER, TERMS, judged_plan, plan_of, stages_by_hand, stages_of, unit_cell,
};
use modl::plan::{CheckKind, Law, Model, Ratio, Stages, Verdict};
use modl::planners::squeeze::{Motion, accordion, fold, melt, shear, to_row};
use modl::robot::{Cell, Library};
use std::sync::Arc;

fn verdict(stages: Stages, slides: bool) -> Verdict {
    let cell = Cell { slides, ..unit_cell() };
    let mut plan = plan_of(stages);
    plan.library = Arc::new(Library { cells: vec![cell], ..Library::default() });
    judged_plan(&plan)
}

/// Returns the kinds of checks that fail of cells that slide, and of cells that do not.
fn kinds(stages: &Stages) -> [Vec<CheckKind>; 2] {
    [true, false].map(|slides| {
        let mut kinds: Vec<CheckKind> =
            verdict(stages.clone(), slides).failures.iter().map(|failure| failure.kind).collect();
        kinds.dedup();
        kinds
    })
}

/// Returns cells in the plane of a centre and sides in quarters.
fn cells<const N: usize>(quarters: [[i64; 4]; N]) -> Vec<Flat> {
    quarters.iter().map(|cell| cell.map(|x| Ratio::new(x.into(), 4).expect("small"))).collect()
}

fn at_rest(cells: &[Flat]) -> [Vec<CheckKind>; 2] {
    kinds(&stages_by_hand(cells, &[], PAPER))
}

fn moved(start: &[Flat], end: Vec<Flat>, time_squared: Ratio) -> Stages {
    stages_by_hand(start, &[(Law::BangBang, time_squared, end)], PAPER)
}

#[test]
fn cells_at_rest_hold_middle_on_middle() {
    let apart = [CheckKind::Connectedness];
    // One above the other; a quarter beside it, as in a wall of bricks; half as wide, in the middle and at the edge.
    assert_eq!(at_rest(&cells([[0, 0, 4, 4], [0, 4, 4, 4]])), [vec![], vec![]]);
    assert_eq!(at_rest(&cells([[0, 0, 4, 4], [1, 4, 4, 4]])), [vec![], apart.to_vec()]);
    assert_eq!(at_rest(&cells([[0, 0, 4, 4], [0, 4, 2, 4]])), [vec![], vec![]]);
    assert_eq!(at_rest(&cells([[0, 0, 4, 4], [1, 4, 2, 4]])), [vec![], apart.to_vec()]);
    // Two edges that meet are no face.
    assert_eq!(at_rest(&cells([[0, 0, 4, 4], [4, 4, 4, 4]])), [apart.to_vec(), apart.to_vec()]);
}

#[test]
fn plans_of_cells_that_slide_are_refused_of_cells_that_do_not() {
    let ways: Vec<Motion> = vec![
        accordion(TERMS, 16).expect("small"),
        fold(TERMS, 16).expect("small"),
        shear(TERMS, 16).expect("small"),
        to_row(TERMS, &[[0, 0], [1, 0], [1, 1], [2, 1]], |i| i).expect("small"),
        melt(TERMS, &[[0, 0, 0], [1, 0, 0], [1, 1, 0]], |i| i).expect("small"),
    ];
    for way in ways {
        let [sliding, docked] = kinds(&stages_of(way, PAPER));
        assert_eq!(sliding, []);
        assert!(docked.contains(&CheckKind::Connectedness), "{docked:?}");
    }
    // The failure says what such cells are.
    let found = verdict(stages_of(accordion(TERMS, 4).expect("small"), PAPER), false);
    assert!(found.failures[0].message.contains("where the middles of their faces meet"), "{found:?}");
    // No plan is refused in which nothing slides: a row becomes half as long in the time of Lemma 2.
    assert_eq!(kinds(&to_halves(8, Ratio(7, 1))), [vec![], vec![]]);
}

/// Two columns of two cells, of which one gets shorter while the lower cells hold each other, or while they do not.
#[test]
fn cells_let_go_to_pass_while_others_hold() {
    let start = cells([[0, 0, 4, 4], [0, 4, 4, 4], [4, 0, 4, 4], [4, 4, 4, 4]]);
    let sixteenths = |y: [i64; 4]| -> Vec<Flat> {
        let at = |i: usize, x: i64, height: i64| {
            [Ratio(x, 1), Ratio::new(y[i].into(), 16).expect("small"), Ratio::ONE, Ratio(1, height)]
        };
        vec![at(0, 0, 1), at(1, 0, 1), at(2, 1, 2), at(3, 1, 1)]
    };
    // The centre of mass stays: all four move by a sixteenth up, and the last goes down by a quarter.
    let held = moved(&start, sixteenths([1, 17, 1, 13]), Ratio::ONE);
    assert_eq!(kinds(&held), [vec![], vec![]]);
    // The lower of the right column contracts downwards, and so slides along the left one by a quarter.
    let slid = moved(&start, sixteenths([3, 19, -1, 11]), Ratio(5, 4));
    assert_eq!(kinds(&slid), [vec![], vec![CheckKind::Connectedness]]);
}

/// Under a limit of contact forces the moment of a row, n (n²-1) / 24 before and a quarter of that after it has shrunk to half,
/// changes by n (n²-1) / 32 over n-1 contacts at most.
#[test]
fn the_lower_bound_knows_that_docked_cells_pull_in_chains() {
    for n in [2_i64, 3, 8, 64] {
        for (above, below) in [(1_i64, 1_i64), (1, 4), (5, 1)] {
            let force = Ratio(above, below);
            // The least time there is under this limit: floor(n²/4) units of force at 1.
            let least = Ratio::new(i128::from((n * n / 4).max(n - 1) * below), above.into()).expect("small");
            let mut stages = to_halves(n as u64, least);
            if least.order(Ratio(n - 1, 1)).is_lt() {
                stages = to_halves(n as u64, Ratio(n - 1, 1));
            }
            stages.model.contact_force = Some(force);
            let found = verdict(stages, false);
            assert!(found.ok(), "{:?}", found.failures);
            let (n, kappa) = (n as f64, force.to_f64());
            let expected = (n * (n + 1.0) / 16.0 / kappa).max(n - 1.0).sqrt();
            let bound = found.dynamics.expect("a lattice has them").lower_bound;
            assert!((bound - expected).abs() < 1e-9 * expected, "{n} {kappa}: {bound} {expected}");
            assert!(bound <= found.duration);
        }
    }
}

/// Columns of three cells side by side, one of which contracts about the middle of its lowest while the other expands: their
/// upper cells pass each other by two sizes, and the lowest hold each other.
#[test]
fn cells_that_have_let_go_pass_at_any_speed_and_the_others_carry_the_forces() {
    let whole = [[0, 0, 4, 4], [0, 4, 4, 4], [0, 8, 4, 4]];
    let half = [[0, 0, 4, 2], [0, 2, 4, 2], [0, 4, 4, 2]];
    let beside = |cells: [[i64; 4]; 3]| cells.map(|[x, y, w, h]| [x + 4, y, w, h]);
    let all = |a: [[i64; 4]; 3], b: [[i64; 4]; 3]| {
        let [p, q, r] = a;
        let [s, t, u] = beside(b);
        cells([p, q, r, s, t, u])
    };
    let mut stages = moved(&all(whole, half), all(half, whole), Ratio(4, 1));
    // In 2 units the uppermost go by 1: at an acceleration of 1. In line two cells go apart by 1/2, at 1/2 at most; side by
    // side the second ones go past each other by 1, at 1.
    stages.limits.speed_squared = Ratio(1, 4);
    assert_eq!(kinds(&stages), [vec![CheckKind::Speed], vec![]]);
    stages.limits.speed_squared = Ratio(6, 25);
    assert_eq!(kinds(&stages)[1], [CheckKind::Speed]);
    // The lowest hold what accelerates the others by 1/2 and by 1.
    stages.limits.speed_squared = Ratio(1, 1);
    for (limit, enough) in [(Ratio(3, 2), true), (Ratio(149, 100), false)] {
        stages.model = Model { contact_force: Some(limit), ..PAPER };
        let found = verdict(stages.clone(), false);
        assert_eq!(found.ok(), enough, "{:?}", found.failures);
        let peak = found.dynamics.expect("a lattice has them").peak_force;
        assert!((peak - 1.5).abs() < 1e-12, "{peak}");
    }
}
