//! Inverse kinematics of an arm of seven joints at random poses: how often it reaches them to a micrometre and a microradian,
//! and how long that takes.
//!
//! `cargo bench --bench goals`.

#[allow(dead_code)]
#[path = "../tests/support"]
mod support {
    pub mod arms;
    pub mod robots;
}

use modl::geometry::Vec3;
use modl::geometry::pose::shifted;
use modl::optimize::random::SplitMix64;
use modl::robot::Kinematics;
use modl::robot::chain::{Chain, DescentSettings, Orientation, Target};
use modl::robot::jacobian::LinkFrame;
use std::time::Instant;
use support::arms::{LENGTHS, RANGES, seven_joints};

/// The number of poses.
const POSES: u64 = 10_000;

fn main() {
    let robot = seven_joints();
    let kinematics = Kinematics::new(&robot, &[], 0);
    let frame = LinkFrame { link: 7, X_LF: shifted(Vec3::z() * LENGTHS[7]) };
    let chain = Chain::new(&robot, &kinematics, 0, &frame).expect("the links are connected");
    let mut numbers = SplitMix64(1);
    let (mut times, mut starts, mut reached) = (Vec::new(), 0, 0);
    for pose in 0..POSES {
        let q: Vec<f64> = RANGES.iter().map(|range| range * numbers.next_signed()).collect();
        let goal = chain.pose(&q);
        let target =
            Target { position: goal.translation.vector, orientation: Orientation::Full(goal.rotation) };
        let mut found = vec![0.0; 7];
        let begin = Instant::now();
        let (error, used) =
            chain.reach(&target, &mut found, (20, &mut SplitMix64(pose)), &DescentSettings::default());
        times.push(begin.elapsed().as_secs_f64());
        starts += used;
        reached += u64::from(error.distance < 1e-6 && error.angle < 1e-6);
    }
    times.sort_by(f64::total_cmp);
    let [median, high] = [POSES / 2, POSES * 99 / 100].map(|i| times[i as usize] * 1e6);
    println!("{reached} of {POSES} poses reached, {:.2} starts each", starts as f64 / POSES as f64);
    println!("median {median:.1} us, 99 % below {high:.1} us");
}
