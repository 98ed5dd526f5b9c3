//! Steps of trusses: `locomote` along the S of the paper, `morph` to its two targets, and both on octet
//! trusses of growing size; milliseconds a step, and what came of it.
//!
//! Beside it, the paper's method in Python: `benches/peers/truss.py` says how to run it.
//!
//! `cargo bench --bench truss`; with a number behind `--`, octets of up to so many divisions, with `forces` only the walks
//! along the S as programs have them, with `around` only walks with and without looking ahead: on flat ground, through gates,
//! over hills; with `orientations`, morphs to targets in many orientations; with `decomposition`, only decompositions of stiffness
//! matrices of octets.

#[path = "../tests/support/trusses.rs"]
#[allow(dead_code)]
mod trusses;

use modl::geometry::pose::shifted;
use modl::geometry::{HeightField, Placed, Shape, Solid, Vec3};
use modl::optimize::SymbolicFactor;
use modl::optimize::cholesky::PivotRule;
use modl::optimize::cuthill_mckee::neighbours;
use modl::optimize::random::SplitMix64;
use modl::optimize::sparse_cholesky::SparseMatrix;
use modl::planners::locomote::{self, End, Objective, Report, Settings, Travel, follow_path};
use modl::planners::morph::{self, Descent, Target, descend};
use modl::planners::truss::roll::settled;
use modl::planners::truss::{Limits, Structure, Surroundings, rigidity_kept};
use modl::planners::{NoProgress, Progress};
use std::sync::Arc;
use std::time::{Duration, Instant};
use trusses::{cube, ell, octet, reels, robot, stepping, tee};

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const DIVISIONS: [i64; 6] = [4, 6, 8, 10, 13, 16];

/// The number of runs on an octet, of which the fastest counts: ten steps are so short that the memory that the
/// process touches for the first time, or again after the allocator gave it back, may double their time.
const OCTET_RUNS: usize = 2;
/// The number of steps of such a run.
const OCTET_STEPS: usize = 100;
/// The mass of a strut of an octet that walks with forces, kg.
const LIGHT: f64 = 0.1;

fn each(time: Duration, steps: usize) -> f64 {
    time.as_secs_f64() * 1e3 / steps.max(1) as f64
}

fn main() {
    if std::env::args().any(|arg| arg == "around") {
        return around();
    }
    if std::env::args().any(|arg| arg == "orientations") {
        return orientations();
    }
    if std::env::args().any(|arg| arg == "decomposition") {
        return decomposition();
    }
    let most = std::env::args().filter_map(|a| a.parse().ok()).next().unwrap_or(16);
    let (truss, start) = robot();
    println!("| 34 nodes, 108 struts | steps | ms a step | rolls, or distances there and back |");
    println!("|---|---|---|---|");
    if std::env::args().any(|arg| arg == "forces") {
        return carried(&truss, &start);
    }
    for (limits, robot) in [("", truss.clone()), (", rigid", rigid(&truss, &start))] {
        for aim in [
            Objective::Springs,
            Objective::Lengths { damping: 1.0 },
            Objective::Restoring { damping: 1.0 },
            Objective::Fewest { damping: 1e-3 },
        ] {
            let (travel, time) = travelled(&robot, &start, &S, aim, usize::MAX);
            let Travel { steps, rolls, slip, .. } = travel;
            let each = each(time, steps);
            println!("| S, {aim:?}{limits} | {steps} | {each:.2} | {rolls} rolls, {slip:.2} slid |");
        }
        for (name, goal, steps) in [("cube", cube(), 150), ("cube", cube(), 300), ("L", ell(), 300)] {
            let (found, made, time) = morphed(&robot, &start, &goal, steps);
            let (there, back) = (found.distance.target_to_surface, found.distance.surface_to_target);
            println!("| {name}{limits} | {made} | {:.2} | {there:.5}, {back:.5} |", each(time, made));
        }
    }
    carried(&truss, &start);
    println!();
    println!("| octet | nodes | struts | locomote, ms a step | with forces | morph, ms a step |");
    println!("|---|---|---|---|---|---|");
    for divisions in DIVISIONS.into_iter().filter(|d| *d <= most) {
        let (loose, start) = octet(divisions);
        let truss = rigid(&loose, &start);
        let usual = Objective::usual(truss.nodes);
        let rollout = fastest(|| {
            let (travel, time) = travelled(&truss, &start, &[[50.0, 0.0]], usual, OCTET_STEPS);
            each(time, travel.steps)
        });
        // As programs have it, of struts so light that the largest bears itself.
        let mut problem = reels(&loose, &start, &[[50.0, 0.0]]);
        problem.truss.strut.mass = LIGHT;
        let settings =
            Settings { objective: usual, steps_max: OCTET_STEPS, slip_max: 1.0, ..Settings::default() };
        let carried = fastest(|| {
            let clock = Instant::now();
            let solution = locomote::plan(&problem, &settings, &mut NoProgress).expect("it bears itself");
            each(clock.elapsed(), solution.report.steps)
        });
        let target = cube().moved(|p| p * (divisions as f64 / 4.0));
        let morph = fastest(|| {
            let (_, made, time) = morphed(&truss, &start, &target, OCTET_STEPS);
            each(time, made)
        });
        let (nodes, struts) = (truss.nodes, truss.struts.len());
        println!("| {divisions} | {nodes} | {struts} | {rollout:.2} | {carried:.2} | {morph:.2} |");
    }
}

/// Returns the truss with the rigidity that planners keep.
fn rigid(truss: &Structure, start: &[Vec3]) -> Structure {
    let rigidity = rigidity_kept(start, &truss.struts);
    truss.clone().with_limits(start, Limits { rigidity, ..Limits::default() })
}

/// The corners of the S of the paper, strut lengths from its start.
const S: [[f64; 2]; 5] = [[8.0, 0.0], [8.0, 6.0], [0.0, 6.0], [0.0, 12.0], [8.0, 12.0]];

/// Returns the S in a direction, degrees.
fn turned_s(direction: f64) -> [[f64; 2]; 5] {
    let (sin, cos) = libm::sincos(direction.to_radians());
    S.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y])
}

/// The number of directions, evenly spread, in which the S is walked as programs have it: what the arithmetic rounds decides at
/// which places a walk has to look for forces, so that the mean of a few says little.
const DIRECTIONS: u32 = 72;

/// Walks along the S in some directions as programs plan them, with the forces of struts under weight and without; the mean of
/// each figure, with the median and the greatest of the times.
fn carried(truss: &Structure, start: &[Vec3]) {
    for (what, forces) in [("as programs have it", true), ("the same, forces: false", false)] {
        let (mut steps, mut rolls, mut slip, mut time) = (0, 0, 0.0, Duration::ZERO);
        let mut times = Vec::new();
        for index in 0..DIRECTIONS {
            let direction = f64::from(index) * 360.0 / f64::from(DIRECTIONS);
            let problem = reels(truss, start, &turned_s(direction));
            let settings = Settings { forces, slip_max: 1.0, ..Settings::default() };
            let clock = Instant::now();
            let solution = locomote::plan(&problem, &settings, &mut NoProgress).expect("it stands");
            let taken = clock.elapsed();
            let Report { end, steps: made, rolls: rolled, slip: slid, .. } = solution.report;
            assert_eq!(end, End::Arrived, "{direction} degrees");
            (steps, rolls, slip, time) = (steps + made, rolls + rolled, slip + slid, time + taken);
            times.push(each(taken, made));
        }
        times.sort_by(f64::total_cmp);
        let count = times.len();
        let (median, slowest) = (times[count / 2], times[count - 1]);
        let (each, mean) = (each(time, steps), slip / f64::from(DIRECTIONS));
        let (steps, rolls) = (steps / count, rolls / count);
        println!(
            "| S, {what}, {count} directions | {steps} | {each:.2}, median {median:.2}, at most {slowest:.2} | {rolls} rolls, {mean:.2} slid |"
        );
    }
}

/// Returns the least of the times that so many runs take, milliseconds a step.
fn fastest(run: impl Fn() -> f64) -> f64 {
    (0..OCTET_RUNS).map(|_| run()).fold(f64::INFINITY, f64::min)
}

fn travelled(
    truss: &Structure,
    start: &[Vec3],
    corners: &[[f64; 2]],
    aim: Objective,
    steps_max: usize,
) -> (Travel, Duration) {
    let from = truss.centre_of_mass(start);
    let path: Vec<[f64; 2]> = corners.iter().map(|[x, y]| [from.x + x, from.y + y]).collect();
    let settings = stepping(aim, steps_max);
    let clock = Instant::now();
    let travel = follow_path(truss, start, &path, &settings, &mut NoProgress);
    (travel, clock.elapsed())
}

/// Counts the steps begun.
struct Counted(usize);

impl Progress for Counted {
    fn report(&mut self, _how_far: &dyn Fn() -> String) {}

    fn should_continue(&mut self) -> bool {
        self.0 += 1;
        true
    }
}

fn morphed(truss: &Structure, start: &[Vec3], goal: &Target, steps: usize) -> (Descent, usize, Duration) {
    let settings =
        morph::Settings { steps_max: steps, tolerance: 0.0, orientations: 0, ..morph::Settings::default() };
    let mut made = Counted(0);
    let clock = Instant::now();
    let found = descend(truss, start, goal, &settings, &mut made).expect("it has a surface");
    (found, made.0, clock.elapsed())
}

/// The number of decompositions of a matrix, of which the fastest counts.
const DECOMPOSITION_RUNS: usize = 40;

/// Decomposes the stiffness matrices of octets, held a little everywhere.
fn decomposition() {
    println!("| octet | nodes | entries of the factor | multiplications | indefinite, ms | Cholesky, ms |");
    println!("|---|---|---|---|---|---|");
    for divisions in DIVISIONS {
        let (truss, x) = octet(divisions);
        let symbolic =
            Arc::new(SymbolicFactor::new(3, &neighbours(truss.nodes, truss.struts.iter().copied())));
        let mut matrix = SparseMatrix::new(&symbolic);
        for &(a, b) in &truss.struts {
            let along = (x[b] - x[a]).normalize();
            let block = along * along.transpose();
            [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0)].iter().for_each(|&(row, column, sign)| {
                matrix.add_block(symbolic.slot(row, column), &(block * sign));
            });
        }
        (0..3 * truss.nodes).for_each(|row| matrix.add(row, row, 0.01));
        let least = |decompose: &dyn Fn(SparseMatrix) -> bool| {
            let time = || {
                let matrix = matrix.clone();
                let clock = Instant::now();
                assert!(decompose(matrix));
                clock.elapsed().as_secs_f64() * 1e3
            };
            (0..DECOMPOSITION_RUNS).map(|_| time()).fold(f64::INFINITY, f64::min)
        };
        let indefinite = least(&|matrix| matrix.indefinite().is_some());
        let cholesky = least(&|matrix| matrix.cholesky(PivotRule::Refuse(1e-11)).is_some());
        let (entries, work) = (symbolic.entries(), symbolic.work());
        println!("| {divisions} | {} | {entries} | {work} | {indefinite:.2} | {cholesky:.2} |", truss.nodes);
    }
}

/// The number of random orientations of each target.
const ORIENTATIONS: usize = 15;

/// Morphs to targets in random orientations with the default settings: the medians of the distances over the whole of
/// surface and target.
fn orientations() {
    let (truss, start) = robot();
    println!("| target | rms, median (least to greatest) | back | worst | s |");
    println!("|---|---|---|---|---|");
    for (limits, truss) in [("", truss.clone()), (", rigid", rigid(&truss, &start))] {
        for (name, goal) in [("cube", cube()), ("L", ell()), ("T", tee())] {
            let mut random = SplitMix64(7);
            let mut found: [Vec<f64>; 4] = Default::default();
            for _ in 0..ORIENTATIONS {
                // Uniform over all rotations: a unit quaternion of any direction.
                let mut number = || (0..12).map(|_| random.next_f64()).sum::<f64>() - 6.0;
                let turn = nalgebra::Quaternion::new(number(), number(), number(), number());
                let turn = nalgebra::UnitQuaternion::new_normalize(turn);
                let goal = goal.moved(|p| turn * p);
                let clock = Instant::now();
                let settings = morph::Settings { tolerance: 0.0, ..morph::Settings::default() };
                let descent = descend(&truss, &start, &goal, &settings, &mut NoProgress).expect("a surface");
                let morph::Distance { target_to_surface, surface_to_target, worst } = descent.measured;
                let figures = [target_to_surface, surface_to_target, worst, clock.elapsed().as_secs_f64()];
                found.iter_mut().zip(figures).for_each(|(list, figure)| list.push(figure));
            }
            let words = found.map(|mut list| {
                list.sort_by(f64::total_cmp);
                format!("{:.4} ({:.4} to {:.4})", list[ORIENTATIONS / 2], list[0], list[ORIENTATIONS - 1])
            });
            println!("| {name}{limits} | {} |", words.join(" | "));
        }
    }
}

/// The robot with nothing around, before gates of some widths, and on hills of some heights.
fn around() {
    let (truss, start) = robot();
    let from = truss.centre_of_mass(&start);
    println!("| | ends | steps | rolls | nodes put down | slid, all nodes | plan, s | ms a step |");
    println!("|---|---|---|---|---|---|---|---|");
    for turned in [0.0f64, 25.0, 90.0, 200.0] {
        both(&format!("S at {turned} degrees"), &truss, &start, &turned_s(turned));
    }
    for gap in [4.0, 3.0, 2.0, 1.5] {
        let post = |side: f64| {
            let at = Vec3::new(from.x + 6.0, from.y + side * (gap / 2.0 + 4.0), 3.0);
            let shape = Shape::Box { size: Vec3::new(1.0, 8.0, 6.0) };
            Solid::new(&[Placed { pose: shifted(at), shape }]).expect("a solid")
        };
        let truss = truss.clone().with_surroundings(Surroundings::new(&[post(1.0), post(-1.0)], None, 0.05));
        both(&format!("gate of {gap}"), &truss, &start, &[[12.0, 0.0]]);
    }
    for high in [0.1, 0.2, 0.3] {
        let count = 80;
        let at = |i: usize| -10.0 + i as f64 * 0.5;
        let height = |x: f64, y: f64| {
            high * (libm::sin(0.9 * x) * libm::sin(0.9 * y) + 0.3 * libm::sin(2.3 * x + 1.7 * y))
        };
        let heights = (0..count * count).map(|i| height(at(i % count), at(i / count))).collect();
        let field = HeightField { corner: [-10.0; 2], spacing: 0.5, columns: count, heights };
        let steepest = libm::atan(field.steepest()).to_degrees();
        let truss = truss.clone().with_surroundings(Surroundings::new(&[], Some(field), 0.05));
        both(&format!("S, slopes of up to {steepest:.0} degrees"), &truss, &start, &S);
    }
}

fn both(name: &str, truss: &Structure, start: &[Vec3], path: &[[f64; 2]]) {
    let start = settled(truss, start).expect("it rests");
    let from = truss.centre_of_mass(&start);
    let path: Vec<[f64; 2]> = path.iter().map(|[x, y]| [from.x + x, from.y + y]).collect();
    for lookahead in [0, 40] {
        let settings = Settings { lookahead, ..stepping(Objective::RESTORING, 4000) };
        let clock = Instant::now();
        let travel = follow_path(truss, &start, &path, &settings, &mut NoProgress);
        let time = each(clock.elapsed(), travel.steps);
        let ends = if travel.end == End::Arrived { "arrived" } else { "stuck" };
        let Travel { steps, rolls, footholds, slip, duration, .. } = travel;
        println!(
            "| {name}, {lookahead} ahead | {ends} | {steps} | {rolls} | {footholds} | {slip:.1} | {duration:.1} | {time:.1} |"
        );
    }
}
