//! Falls that a behaviour allows: how fast the judge says that a link comes down, against the simulation.

use crate::support::desk;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;

/// A post on a small foot leans over until it falls on its side.
const POST: &str = "\
module Post {
  link foot = box(60mm, 60mm, 20mm, mass: 100g, friction: 1)
  link arm = box(20mm, 20mm, HEIGHT, mass: 400g) at [0mm, 0mm, 20mm + HEIGHT / 2]
  joint hip : foot -> arm = revolute(
    axis: Y,
    range: -90deg..90deg,
    max_speed: 3rad/s,
    max_torque: 20N*m,
    max_accel: 40rad/s^2
  ) at [0mm, 0mm, 20mm]
  touching foot arm
}
config Falls {
  part post: Post
  base post
  behavior lean allows unstable, balance = move(post.hip, 50deg, in: 3s)
}
print(verify(Falls().lean()).impact / 1m/s)
print(simulate(Falls().lean()).impact / 1m/s)
";

#[test]
fn a_post_that_falls_comes_down_about_as_fast_as_simulated() {
    for height in [120, 200, 400] {
        let program = POST.replace("HEIGHT", &format!("{height}mm"));
        let (observed, _, _) = desk::run(&MapFiles::of(&program), Mode::Run);
        assert!(observed.diagnostics.is_empty(), "{:?}", observed.diagnostics);
        let printed: Vec<f64> = observed.printed.iter().map(|line| line.parse().expect("a number")).collect();
        let [judged, simulated] = printed[..] else { panic!("{printed:?}") };
        // A uniform rod ends at √(3gh). The foot of 0.1 kg at its lower end takes part of that, the more the shorter the rod.
        assert!((1.0..1.45).contains(&(judged / simulated)), "{height} mm: {judged} and {simulated} m/s");
    }
}
