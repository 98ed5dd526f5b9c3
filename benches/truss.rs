//! Steps of trusses: `locomote` along the S of the paper, `morph` to its two targets, and both on octet
//! trusses of growing size; milliseconds a step, and what came of it.
//!
//! Beside it, the paper's method in Python: `benches/peers/truss.py` says how to run it.
//!
//! `cargo bench --bench truss`; with a number behind `--`, octets of up to so many divisions.

#[path = "../tests/trusses.rs"]
#[allow(dead_code)]
mod trusses;

use modl::geometry::Vec3;
use modl::planners::truss::Structure;
use modl::planners::truss::goal::Goal;
use modl::planners::truss::locomote::{Hold, Travel, Wish, locomote};
use modl::planners::truss::locomotion::Aim;
use modl::planners::truss::morph::{self, morph};
use std::time::{Duration, Instant};
use trusses::{actuator, cube, ell, robot};

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const DIVISIONS: [i64; 6] = [4, 6, 8, 10, 13, 16];

fn each(time: Duration, steps: usize) -> f64 {
    time.as_secs_f64() * 1e3 / steps.max(1) as f64
}

fn main() {
    let most = std::env::args().filter_map(|a| a.parse().ok()).next().unwrap_or(16);
    let (truss, start) = robot();
    println!("| 34 nodes, 108 struts | steps | ms a step | rolls, or distances there and back |");
    println!("|---|---|---|---|");
    let corners = [[8.0, 0.0], [8.0, 6.0], [0.0, 6.0], [0.0, 12.0], [8.0, 12.0]];
    for aim in [
        Aim::Springs,
        Aim::Lengths { still: 1.0 },
        Aim::Restoring { still: 1.0 },
        Aim::Fewest { still: 1e-3 },
    ] {
        let (travel, time) = travelled(&truss, &start, &corners, aim, usize::MAX);
        println!(
            "| S, {aim:?} | {} | {:.2} | {} rolls |",
            travel.steps,
            each(time, travel.steps),
            travel.rolls
        );
    }
    for (name, goal, steps) in [("cube", cube(), 150), ("cube", cube(), 300), ("L", ell(), 300)] {
        let (found, made, time) = morphed(&truss, &start, &goal, steps);
        let (there, back) = (found.distance.there, found.distance.back);
        println!("| {name} | {steps} | {:.2} | {there:.5}, {back:.5} |", each(time, made));
    }
    println!();
    println!("| octet | nodes | struts | locomote, ms a step | morph, ms a step |");
    println!("|---|---|---|---|---|");
    for divisions in DIVISIONS.into_iter().filter(|d| *d <= most) {
        let (truss, start) = octet(divisions);
        let (travel, time) = travelled(&truss, &start, &[[50.0, 0.0]], Aim::Springs, 10);
        let walk = each(time, travel.steps);
        let target = cube().moved(|p| p * (divisions as f64 / 4.0));
        let (_, made, time) = morphed(&truss, &start, &target, 10);
        let (nodes, struts) = (truss.nodes, truss.struts.len());
        println!("| {divisions} | {nodes} | {struts} | {walk:.1} | {:.1} |", each(time, made));
    }
}

fn travelled(
    truss: &Structure,
    start: &[Vec3],
    corners: &[[f64; 2]],
    aim: Aim,
    steps_max: usize,
) -> (Travel, Duration) {
    let from = truss.centre(start);
    let path = corners.iter().map(|[x, y]| [from.x + x, from.y + y]).collect();
    let wish = Wish {
        path,
        near: 0.25,
        stride: 0.05,
        aim,
        hold: Hold::Three,
        ladder: true,
        impact: true,
        steps_max,
    };
    let clock = Instant::now();
    let travel = locomote(truss, start, &wish, &|_| true);
    (travel, clock.elapsed())
}

fn morphed(truss: &Structure, start: &[Vec3], goal: &Goal, steps: usize) -> (morph::Morph, usize, Duration) {
    let wish = morph::Wish { steps_max: steps, tolerance: 0.0, orientations: 0, seed: 0 };
    let made = std::cell::Cell::new(0);
    let clock = Instant::now();
    let going = |step: usize, _: &_| {
        made.set(step + 1);
        true
    };
    let found = morph(truss, start, goal, &wish, &going).expect("it has a surface");
    (found, made.get(), clock.elapsed())
}

/// The boundary of a tetrahedron of so many divisions with what is inside, edges of 1.
fn octet(divisions: i64) -> (Structure, Vec<Vec3>) {
    let high = libm::sqrt(3.0) / 2.0;
    let mut places = Vec::new();
    for k in 0..=divisions {
        for j in 0..=divisions - k {
            for i in 0..=divisions - k - j {
                let (i, j, k) = (i as f64, j as f64, k as f64);
                let up = libm::sqrt(2.0 / 3.0) * k;
                places.push(Vec3::new(i + j / 2.0 + k / 2.0, high * j + high / 3.0 * k, up));
            }
        }
    }
    let near = |a: usize, b: usize| (places[a] - places[b]).norm() < 1.01;
    let pairs = (0..places.len()).flat_map(|a| (a + 1..places.len()).map(move |b| (a, b)));
    let struts: Vec<(usize, usize)> = pairs.filter(|&(a, b)| near(a, b)).collect();
    (Structure::new(&actuator(), &places, &struts), places)
}
