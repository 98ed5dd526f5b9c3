//! Lattices that change in place: what is planned for seeded random shapes and for shapes that differ by a few cells,
//! before the judge and before an arithmetic of the tests' own.

use crate::support::lattices::{block, judged_plan, moved, plan_of, random_shape, unit_cell};
use crate::support::properties::whole;
use modl::plan::{Body, Stages};
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, Problem, Settings, plan};
use modl::robot::Cell;

type Place = [i64; 3];

struct Found {
    method: Method,
    stages: Stages,
    lower_bound: f64,
}

fn found(cell: Cell, from: &[Place], to: &[Place], settings: &Settings) -> Found {
    let problem = Problem::floating(cell, from.to_vec(), to.to_vec());
    let solution = plan(&problem, settings, &mut NoProgress).expect("there is a way");
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    Found { method: solution.report.method, stages, lower_bound: solution.report.lower_bound }
}

/// Plans, lets the judge and the arithmetic below check the plan, and returns it.
fn check(from: &[Place], to: &[Place], settings: &Settings) -> Found {
    let found = found(unit_cell(), from, to, settings);
    let verdict = judged_plan(&plan_of(found.stages.clone()));
    assert!(verdict.ok(), "{from:?} to {to:?}: {:?}", verdict.failures);
    sampled(&found.stages, from, to);
    found
}

/// Checks ten moments of every stage in floating point: no two cells overlap, and all hang together over faces. The
/// shapes at both ends are those asked for, up to a translation.
fn sampled(stages: &Stages, from: &[Place], to: &[Place]) {
    let normal = |cells: &mut Vec<[f64; 3]>| {
        let low = [0, 1, 2].map(|axis| cells.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min));
        let mut rounded: Vec<Place> =
            cells.iter().map(|c| [0, 1, 2].map(|axis| (c[axis] - low[axis]).round() as i64)).collect();
        rounded.sort_unstable();
        rounded
    };
    let asked = |cells: &[Place]| normal(&mut cells.iter().map(|c| c.map(|x| x as f64)).collect());
    let mut before = 0.0;
    for (index, stage) in stages.stages.iter().enumerate() {
        let duration = stage.duration();
        for part in 0..10 {
            let time = before + duration * (f64::from(part) + 0.5) / 10.0;
            let boxes: Vec<([f64; 3], [f64; 3])> =
                stages.state(time).into_iter().map(|cell| (cell.center, cell.size)).collect();
            assert!(is_sound(&boxes), "stage {index}, moment {part}: {from:?} to {to:?}");
        }
        before += duration;
    }
    let at = |time: f64| -> Vec<[f64; 3]> {
        let cells = stages.state(time);
        assert!(cells.iter().all(|cell| cell.size.iter().all(|s| (s - 1.0).abs() < 1e-9)));
        cells.into_iter().map(|cell| cell.center).collect()
    };
    assert_eq!(normal(&mut at(0.0)), asked(from));
    assert_eq!(normal(&mut at(before)), asked(to));
}

/// Returns true if no two boxes, each a centre and sides, overlap, and all hang together over faces.
fn is_sound(boxes: &[([f64; 3], [f64; 3])]) -> bool {
    let mut piece: Vec<usize> = (0..boxes.len()).collect();
    for i in 0..boxes.len() {
        for j in 0..i {
            let apart = [0, 1, 2].map(|axis| {
                let sides = (boxes[i].1[axis] + boxes[j].1[axis]) / 2.0;
                (boxes[i].0[axis] - boxes[j].0[axis]).abs() - sides
            });
            let touching = apart.iter().filter(|gap| gap.abs() < 1e-9).count();
            let inside = apart.iter().filter(|gap| **gap < -1e-9).count();
            if inside == 3 {
                return false;
            }
            if touching == 1 && inside == 2 {
                let (old, new) = (piece[i], piece[j]);
                piece.iter_mut().filter(|p| **p == old).for_each(|p| *p = new);
            }
        }
    }
    piece.iter().all(|p| *p == piece[0])
}

#[test]
fn one_cell_of_a_block_moves_in_a_few_pushes() {
    // A run beside the block, a run through it, and one beside it on the other side: 2 units each.
    let square = block([6, 6, 1]);
    for to in [[6, 5, 0], [5, 6, 0], [6, 2, 0], [2, -1, 0], [-1, 3, 0], [6, 0, 0]] {
        let found = check(&square, &moved(square.clone(), [0, 0, 0], to), &Settings::default());
        assert_eq!(found.method, Method::Push);
        assert!(found.stages.duration() <= 6.0 + 1e-9, "{to:?}: {}", found.stages.duration());
    }
    let cube = block([3, 3, 3]);
    for to in [[3, 2, 2], [2, 2, 3], [1, -1, 2], [3, 0, 1]] {
        let found = check(&cube, &moved(cube.clone(), [0, 0, 0], to), &Settings::default());
        assert!(found.stages.duration() <= 8.0 + 1e-9, "{to:?}: {}", found.stages.duration());
    }
}

#[test]
fn random_shapes_change_in_place() {
    let rounds = if whole() { 200 } else { 6 };
    let mut seed = 5;
    let mut ratios = vec![];
    for round in 0..rounds {
        for (dimensions, branches) in [(2, false), (2, true), (3, false), (3, true)] {
            let count = 4 + (round * 13 + dimensions) % 45;
            let mut shape = || random_shape(dimensions, branches, &mut seed, count);
            let (from, to) = (shape(), shape());
            let found = check(&from, &to, &Settings::default());
            if dimensions == 2 && found.lower_bound > 0.0 {
                ratios.push(found.stages.duration() / found.lower_bound);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[ratios.len() / 2] <= 8.0, "{ratios:?}");
}

#[test]
fn rows_are_piled_up_and_pushed_into_shape() {
    let rounds = if whole() { 40 } else { 3 };
    let mut seed = 3;
    for (round, count) in (0..rounds).zip([17, 31, 64].into_iter().cycle()) {
        let row: Vec<Place> = (0..count as i64).map(|x| [x, 0, 0]).collect();
        let shape = random_shape(3, false, &mut seed, count);
        let found = check(&row, &shape, &Settings::default());
        assert_eq!(found.method, Method::Push, "{round}");
        check(&shape, &row, &Settings::default());
    }
}

#[test]
fn cells_that_keep_their_size_are_pushed_too() {
    let cell = Cell { shrinks_to: 1.0, ..unit_cell() };
    let square = block([5, 5, 1]);
    let corner = moved(square.clone(), [0, 0, 0], [5, 3, 0]);
    let found = found(cell, &square, &corner, &Settings::default());
    sampled(&found.stages, &square, &corner);
    let instants = found.stages.instants();
    assert!(instants.iter().all(|&t| found.stages.state(t).iter().all(|cell| cell.size == [1.0; 3])));
    assert_eq!(found.method, Method::Push);
}
