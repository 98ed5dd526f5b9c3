//! Lattice plans for the tests and the benches: ways in the paper's units, as plans for the judge.
#![allow(dead_code)]

use modl::plan::verify::verify;
use modl::plan::{
    Body, Cause, CauseId, CellLimits, Law, Model, Plan, Provenance, Ratio, Run, Settings, Stage, StageEnd,
    Stages, Verdict, World, WorldFrom,
};
use modl::planners::squeeze::{Motion, PlanHeader, PlanLimits, Profile};
use modl::robot::{Cell, Library};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Limits of 1 in units of 1.
pub const UNIT: CellLimits = CellLimits { smallest: Ratio(1, 2), speed_squared: Ratio::ONE };
pub const TERMS: PlanLimits =
    PlanLimits { cell: UNIT, profile: Profile::BangBang, euclidean: false, anchored: false, slides: true };
pub const BALANCED: Model = Model { balanced: true, contact_force: None, euclidean: false };
pub const PAPER: Model = Model { balanced: false, contact_force: None, euclidean: false };

pub fn unit_cell() -> Cell {
    Cell { name: "Unit".into(), size: 1.0, shrinks_to: 0.5, mass: 1.0, force: 1.0, speed: 1.0, slides: true }
}

/// Returns a cell of 0.1 m, 1 kg, 10 N and 0.1 m/s that shrinks to half.
pub fn small_cell() -> Cell {
    Cell { name: "Cube".into(), size: 0.1, shrinks_to: 0.05, force: 10.0, speed: 0.1, ..unit_cell() }
}

/// A cell in the plane: centre and size along x and y; its size along z is 1.
pub type Flat = [Ratio; 4];

fn runs(cells: &[Flat]) -> Vec<Run> {
    let run = |(i, [x, y, w, h]): (usize, &Flat)| Run {
        first: i as u64,
        counters: vec![],
        center: [*x, *y, Ratio::ZERO],
        size: [*w, *h, Ratio::ONE],
    };
    cells.iter().enumerate().map(run).collect()
}

/// Returns stages made by hand; `ends`: the law, the square of the time and the cells at the end of each.
pub fn stages_by_hand(start: &[Flat], ends: &[(Law, Ratio, Vec<Flat>)], model: Model) -> Stages {
    let stage = |(law, time_squared, end): &(Law, Ratio, Vec<Flat>)| Stage {
        name: "by hand".into(),
        time_squared: *time_squared,
        law: *law,
        end: runs(end).into(),
        cause: CauseId(0),
    };
    Stages {
        cell: 0,
        count: start.len() as u64,
        time_unit: 1.0,
        limits: UNIT,
        model,
        anchor: None,
        start: runs(start),
        stages: ends.iter().map(stage).collect(),
    }
}

/// Returns the runs that a stage states.
pub fn runs_of(stage: &mut Stage) -> &mut Vec<Run> {
    match &mut stage.end {
        StageEnd::Runs(runs) => runs,
        StageEnd::Moves(_) => panic!("the stage states moves"),
    }
}

pub fn stages_of(motion: Motion, model: Model) -> Stages {
    motion.into_stages(PlanHeader { cell: 0, time_unit: 1.0, limits: UNIT, model })
}

pub fn plan_of(stages: Stages) -> Plan {
    let cause = Cause {
        file: "test.mod".into(),
        line: 1,
        column: 1,
        text: "squeeze(...)".into(),
        instance: String::new(),
        caller: None,
    };
    Plan {
        provenance: Provenance { planner: "squeeze".into(), ..Provenance::default() },
        worlds: vec![WorldFrom { from: 0.0, world: World::FREE }],
        settings: Settings::default(),
        library: Arc::new(Library { cells: vec![unit_cell()], ..Library::default() }),
        body: Body::Stages(stages),
        program: None,
        nominal: false,
        causes: vec![cause],
        exemptions: vec![],
        paths: vec![],
        verdict: None,
    }
}

pub fn judged_plan(plan: &Plan) -> Verdict {
    verify(plan)
}

pub fn judged(motion: Motion, model: Model) -> Verdict {
    verify(&plan_of(stages_of(motion, model)))
}

/// Returns the block of cells of these sides.
pub fn block(sides: [i64; 3]) -> Vec<[i64; 3]> {
    let [a, b, c] = sides;
    (0..a).flat_map(|x| (0..b).flat_map(move |y| (0..c).map(move |z| [x, y, z]))).collect()
}

/// Returns a block with one cell taken from one place and put to another.
pub fn moved(mut cells: Vec<[i64; 3]>, from: [i64; 3], to: [i64; 3]) -> Vec<[i64; 3]> {
    cells.retain(|cell| *cell != from);
    cells.push(to);
    cells
}

/// Linear congruential numbers (Knuth, MMIX): the tests' own.
fn next(seed: &mut u64, limit: usize) -> usize {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    ((*seed >> 33) as usize) % limit
}

/// Returns a random connected set of cells. With `branches`, new cells rather touch one cell only, so that there are
/// arms, and holes between them.
pub fn random_shape(dimensions: usize, branches: bool, seed: &mut u64, count: usize) -> Vec<[i64; 3]> {
    let mut cells: Vec<[i64; 3]> = vec![[0; 3]];
    let mut set: BTreeSet<[i64; 3]> = cells.iter().copied().collect();
    let neighbour = |cell: [i64; 3], k: usize| {
        let mut other = cell;
        other[k / 2] += if k.is_multiple_of(2) { 1 } else { -1 };
        other
    };
    while cells.len() < count {
        let cell = neighbour(cells[next(seed, cells.len())], next(seed, 2 * dimensions));
        let touches = (0..2 * dimensions).filter(|&k| set.contains(&neighbour(cell, k))).count();
        if (!branches || touches == 1 || next(seed, 8) == 0) && set.insert(cell) {
            cells.push(cell);
        }
    }
    cells
}

/// Returns the stages of a plan of a lattice.
pub fn stages(plan: &Plan) -> &Stages {
    let Body::Stages(stages) = &plan.body else { panic!("it is a lattice") };
    stages
}

/// Returns sites in ascending order, translated so that the least coordinates are 0.
pub fn normal(sites: &[[i64; 3]]) -> Vec<[i64; 3]> {
    let low = [0, 1, 2].map(|axis| sites.iter().map(|site| site[axis]).min().unwrap_or(0));
    let mut sites: Vec<[i64; 3]> =
        sites.iter().map(|site| [0, 1, 2].map(|axis| site[axis] - low[axis])).collect();
    sites.sort_unstable();
    sites
}
