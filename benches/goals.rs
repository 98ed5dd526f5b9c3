//! Inverse kinematics of an arm of seven joints and of the library's arms at random poses: how often they are reached to a
//! micrometre and a microradian within the limits of joints and 20 starts, and how long that takes.
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
use modl::plan::{Body, file};
use modl::robot::chain::{Chain, DescentSettings, Orientation, Target};
use modl::robot::jacobian::LinkFrame;
use modl::robot::{Assembly, Kinematics, PortRef, State};
use std::process::Command;
use std::time::Instant;
use support::arms::{LENGTHS, seven_joints};

/// The number of poses of each arm.
const POSES: u64 = 10_000;
/// The angle to which joints that turn for ever are turned at most, rad.
const TURN_MAX: f64 = 3.0;

fn main() {
    println!(
        "{:<22} {:>7} {:>8} {:>8} {:>10} {:>12}",
        "arm", "joints", "reached", "starts", "median us", "99 % below us"
    );
    let robot = seven_joints();
    let kinematics = Kinematics::new(&robot, &[], 0);
    let frame = LinkFrame { link: 7, X_LF: shifted(Vec3::z() * LENGTHS[7]) };
    let chain = Chain::new(&robot, &kinematics, 0, &frame).expect("the links are connected");
    measure("seven joints", &chain, &[0.0; 7]);
    for (make, tip, port) in
        [("Puma4", "r.hand", "top"), ("Arm(n: 6)", "r.m[5]", "top"), ("MobManip8", "r.arm[3]", "bottom")]
    {
        let (robot, start) = of_library(make);
        let kinematics = Kinematics::new(&robot, &start.bonds, robot.base);
        let module = robot.modules.iter().position(|m| m.name == tip).expect("the tip is there");
        let ports = &robot.module_type(module).ports;
        let port = ports.iter().position(|p| p.name == port).expect("so is the port");
        let frame = LinkFrame::of_port(&robot, &kinematics, PortRef { module, port });
        let held = kinematics.link(robot.base, 0);
        let chain = Chain::new(&robot, &kinematics, held, &frame).expect("it is connected");
        measure(make, &chain, &start.joints);
    }
}

/// Prints how often an arm reaches poses of random joints, and how long that takes.
fn measure(name: &str, chain: &Chain, start: &[f64]) {
    let mut numbers = SplitMix64(1);
    let (mut times, mut starts, mut reached) = (Vec::new(), 0, 0);
    for pose in 0..POSES {
        let mut joints = start.to_vec();
        for joint in chain.joints() {
            let (low, high) = (joint.limits.0.max(-TURN_MAX), joint.limits.1.min(TURN_MAX));
            joints[joint.joint] = low + (high - low) * numbers.next_f64();
        }
        let goal = chain.pose(&joints);
        let target =
            Target { position: goal.translation.vector, orientation: Orientation::Full(goal.rotation) };
        let mut found = start.to_vec();
        let begin = Instant::now();
        let (_, used) =
            chain.reach(&target, &mut found, (20, &mut SplitMix64(pose)), &DescentSettings::default());
        times.push(begin.elapsed().as_secs_f64());
        starts += used;
        let within =
            chain.joints().iter().all(|j| j.limits.0 <= found[j.joint] && found[j.joint] <= j.limits.1);
        let error = Chain::error(&chain.pose(&found), &target).0;
        reached += u64::from(within && error.distance < 1e-6 && error.angle < 1e-6);
    }
    times.sort_by(f64::total_cmp);
    let [median, high] = [POSES / 2, POSES * 99 / 100].map(|i| times[i as usize] * 1e6);
    println!(
        "{name:<22} {:>7} {:>7.2}% {:>8.2} {median:>10.1} {high:>12.1}",
        chain.joints().len(),
        100.0 * reached as f64 / POSES as f64,
        starts as f64 / POSES as f64,
    );
}

/// Returns the robot of a library's configuration, with the state it begins in.
fn of_library(make: &str) -> (Assembly, State) {
    let program = format!(
        "use std.smores.{{Arm, MobManip8, Puma4, Smores}}\nconfig C {{ part r: {make} }}\nlet c = C()\n\
         emit(plan(move(modules(c, Smores)[0].left, by: 0deg), world: world(ground: held, gravity: off)), \"p.json\")\n"
    );
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("main.mod"), program).expect("the program is written");
    let run = Command::new(env!("CARGO_BIN_EXE_modl"))
        .args(["run", "main.mod"])
        .current_dir(folder.path())
        .output()
        .expect("modl runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = std::fs::read_to_string(folder.path().join("out/p.json")).expect("the plan is there");
    let Body::Tracks(tracks) = file::read(&text).expect("it can be read").body else {
        panic!("a plan of joints")
    };
    (tracks.robot, tracks.start)
}
