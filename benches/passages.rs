//! Narrow passages: a ball on two slides goes through gaps in walls that leave it a few millimetres. How often a way is found,
//! and how long that takes.
//!
//! `cargo bench --bench passages -- FILE` writes the passages and the results to a file, which `benches/peers/passages.py` reads
//! to run RRT-Connect of OMPL on the same passages.

#[allow(dead_code)]
#[path = "../tests/support"]
mod support {
    pub mod arms;
    pub mod robots;
}

use modl::geometry::{Pose, Vec3};
use modl::optimize::random::SplitMix64;
use modl::plan::Obstacle;
use modl::planners::NoProgress;
use modl::planners::goals::avoid::{Problem, Settings, plan};
use modl::planners::goals::{FreeSpace, Surroundings};
use modl::robot::{Kinematics, State};
use serde_json::{Value, json};
use std::time::Instant;
use support::arms::{BALL, gantry};
use support::robots::{at_rest, boxed};

/// The number of passages.
const PASSAGES: u64 = 100;
/// The number of seeds with which each is searched.
const SEEDS: u64 = 20;
/// The clearance that is kept, m.
const CLEARANCE: f64 = 1e-3;

/// A passage: walls as their least and greatest x and y, and the places between which a way is sought, m.
struct Passage {
    walls: Vec<[f64; 4]>,
    from: [f64; 2],
    to: [f64; 2],
}

/// Returns a passage of one to three walls with a gap each, which is 4 to 20 mm wider than the ball.
fn passage(number: u64) -> Passage {
    let mut rng = SplitMix64(number);
    let count = 1 + number % 3;
    let mut walls = Vec::new();
    for wall in 0..count {
        let middle = -0.7 + 1.4 * (wall as f64 + 0.5) / count as f64;
        let half = 0.05 + 0.1 * rng.next_f64();
        let gap = 2.0 * BALL + 4e-3 + 16e-3 * rng.next_f64();
        let at = 0.6 * rng.next_signed();
        walls.push([middle - half, middle + half, -1.5, at - gap / 2.0]);
        walls.push([middle - half, middle + half, at + gap / 2.0, 1.5]);
    }
    let y = |rng: &mut SplitMix64| 0.9 * rng.next_signed();
    let (from, to) = ([-0.9, y(&mut rng)], [0.9, y(&mut rng)]);
    Passage { walls, from, to }
}

/// Searches a way through a passage; returns the time that took, s, and the number of postures examined, `None` without a way.
fn search(passage: &Passage, seed: u64) -> (f64, Option<u64>) {
    let robot = gantry();
    let state = State { joints: passage.from.to_vec(), ..at_rest(&robot) };
    let kinematics = Kinematics::new(&robot, &[], 0);
    let mut poses = vec![Pose::identity(); 3];
    kinematics.link_poses(&state.joints, &Pose::identity(), &mut poses);
    let solid = |[a, b, c, d]: &[f64; 4]| boxed(Vec3::new(*a, *c, -0.5), Vec3::new(*b, *d, 0.5));
    let obstacles: Vec<Obstacle> = passage
        .walls
        .iter()
        .map(|wall| Obstacle { name: "wall".into(), shapes: vec![solid(wall)] })
        .collect();
    let begin = Instant::now();
    let around =
        Surroundings { robot: &robot, state: &state, poses: &poses, obstacles: &obstacles, floor: false };
    let mut space = FreeSpace::new(around, 0, &[0, 1], CLEARANCE).expect("the shapes are sound");
    let problem = Problem { from: &passage.from, to: &passage.to, limits: &[(-1.0, 1.0); 2] };
    let settings = Settings { seed, ..Settings::default() };
    let found = plan(&problem, &mut space, &settings, &mut NoProgress);
    (begin.elapsed().as_secs_f64(), found.ok().map(|path| path.work))
}

fn main() {
    let file = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let (mut times, mut work, mut solved) = (Vec::new(), Vec::new(), 0);
    let mut written: Vec<Value> = Vec::new();
    for number in 0..PASSAGES {
        let passage = passage(number);
        let results: Vec<(f64, Option<u64>)> = (0..SEEDS).map(|seed| search(&passage, seed)).collect();
        solved += results.iter().filter(|(_, found)| found.is_some()).count();
        times.extend(results.iter().map(|(time, _)| *time));
        work.extend(results.iter().filter_map(|(_, found)| *found));
        let times: Vec<f64> = results.iter().map(|(time, _)| *time).collect();
        let found: Vec<bool> = results.iter().map(|(_, found)| found.is_some()).collect();
        written.push(json!({
            "walls": passage.walls, "from": passage.from, "to": passage.to, "times": times, "solved": found,
        }));
    }
    times.sort_by(f64::total_cmp);
    work.sort_unstable();
    let [median, high] = [times.len() / 2, times.len() * 95 / 100].map(|i| times[i] * 1e3);
    println!("{solved} of {} searches found a way", PASSAGES * SEEDS);
    println!("median {median:.2} ms, 95 % below {high:.1} ms, median of {} postures", work[work.len() / 2]);
    if let Some(file) = file {
        let all = json!({ "ball": BALL, "clearance": CLEARANCE, "seeds": SEEDS, "passages": written });
        std::fs::write(&file, all.to_string()).expect("the file can be written");
    }
}
