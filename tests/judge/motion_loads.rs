//! Loads and travel of random robots in motion, beside the model that [`dense_model`](crate::support::dense_model) writes down
//! once more.

use crate::support::dense_model::{Machine, WINDOW, compared, recorded, travelled};
use crate::support::desk::run;
use crate::support::properties::whole;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use modl::optimize::random::SplitMix64;
use modl::plan::Plan;
use modl::plan::verify::articulated::{Detail, base_at, instants};
use std::fmt::Write as _;

/// The kinds of supports of a random robot.
#[derive(Clone, Copy, PartialEq)]
enum Support {
    /// A ball that turns about a level axle.
    Wheel,
    /// A foot that a hip with a vertical axis takes along the ground.
    Hip,
    /// A foot that slides along a level axis.
    Slide,
    /// A foot at the end of a beam, which a knee with a level axis holds, and yields.
    Beam,
}

/// Returns the program of a random robot on these supports, with swinging arms, which moves for two seconds.
fn program(seed: u64, supports: &[Support], world: &str) -> String {
    let mut rng = SplitMix64(seed);
    let mut links = "link body = box(160mm, 120mm, 40mm, mass: 4kg) at [0mm, 0mm, 150mm]\n".to_owned();
    let mut names: Vec<String> = ["body", "upper", "bob", "rear", "tail"].map(str::to_owned).into();
    let (mut moves, mut beam): (Vec<String>, Option<usize>) = (Vec::new(), None);
    let servo = |rng: &mut SplitMix64| {
        format!(
            "stiffness: {}N*m/rad, armature: {}kg*m^2",
            50.0 + 200.0 * rng.next_f64(),
            0.01 * rng.next_f64()
        )
    };
    for (i, kind) in supports.iter().enumerate() {
        let turn = std::f64::consts::TAU * (i as f64 + 0.4 * rng.next_f64()) / supports.len() as f64;
        let away = 130.0 + 60.0 * rng.next_f64();
        let (s, c) = libm::sincos(turn);
        let (x, y) = (away * c, away * s);
        // What yields may hang farther above the ground than what does not.
        let yields = *kind == Support::Beam && supports.iter().filter(|s| **s != Support::Beam).count() > 2;
        let higher = if yields { 1.5 } else { 0.1 } * rng.next_f64();
        let (friction, mass) = (0.5 + 0.5 * rng.next_f64(), 100.0 + 200.0 * rng.next_f64());
        let (b, a) = libm::sincos(3.0 * rng.next_signed());
        let radius = if *kind == Support::Wheel { 40.0 } else { 15.0 };
        let ball = format!("s{i}_ball{radius}");
        let z = radius + higher;
        let far = if *kind == Support::Beam { 1.6 } else { 1.0 };
        writeln!(
            links,
            "link {ball} = sphere({radius}mm, mass: {mass}g, friction: {friction}) at [{}mm, {}mm, {z}mm]",
            far * x,
            far * y
        )
        .expect("text");
        names.push(ball.clone());
        let joint = match kind {
            Support::Wheel => {
                format!("revolute(axis: {a} * X + {b} * Y, {}) at [{x}mm, {y}mm, {z}mm]", servo(&mut rng))
            }
            Support::Hip => {
                format!(
                    "revolute(axis: Z, {}) at [{}mm, {}mm, 100mm]",
                    servo(&mut rng),
                    x - 60.0 * a,
                    y - 60.0 * b
                )
            }
            Support::Slide => format!(
                "prismatic(axis: {a} * X + {b} * Y, stiffness: {}N/m, armature: 0.3kg) at [{x}mm, {y}mm, 60mm]",
                5000.0 + 5000.0 * rng.next_f64()
            ),
            Support::Beam if beam.is_some() => {
                format!("revolute(axis: {} * X + {c} * Y) at [{x}mm, {y}mm, 60mm]", -s)
            }
            Support::Beam => {
                format!("revolute(axis: {} * X + {c} * Y, {}) at [{x}mm, {y}mm, 60mm]", -s, servo(&mut rng))
            }
        };
        writeln!(links, "joint j{i} : body -> {ball} = {joint}").expect("text");
        // All beams follow the first.
        if *kind == Support::Beam {
            if let Some(first) = beam {
                writeln!(links, "joint j{i} = 0.8 * j{first}").expect("text");
                continue;
            }
            beam = Some(i);
        }
        let by = 0.5 + rng.next_f64();
        match kind {
            Support::Wheel => moves.push(format!("move(robot.j{i}, by: {}rad, in: 2s)", 3.0 * by)),
            Support::Hip => moves.push(format!("move(robot.j{i}, by: {by}rad, in: 2s)")),
            Support::Slide => moves.push(format!("move(robot.j{i}, by: {}mm, in: 2s)", 60.0 * by)),
            // On three supports it may tilt the robot; on more, it would rock.
            Support::Beam if supports.len() == 3 => {
                moves.push(format!("move(robot.j{i}, by: {}rad, in: 2s)", 0.3 * by))
            }
            Support::Beam => {}
        }
    }
    // Two arms: one that turns and carries a slide, one whose end follows its shoulder.
    let mut axis = || {
        let [x, y, z] = [(); 3].map(|()| rng.next_signed());
        format!("{x} * X + {y} * Y + {z} * Z")
    };
    let axes = [axis(), axis(), axis()];
    // The arms begin at stops, and leave them.
    let (range, away) =
        if seed.is_multiple_of(2) { ("-0.001rad..1.5rad", 0.9) } else { ("-1.5rad..0.001rad", -0.9) };
    let ahead = if seed % 4 < 2 { "-0.001rad..1.5rad" } else { "-3rad..1.101rad" };
    let [k0, k1] = [(); 2].map(|()| servo(&mut rng));
    writeln!(
        links,
        "link upper = box(30mm, 30mm, 200mm, mass: 400g, com: [4mm, 2mm, 10mm]) at [40mm, 20mm, 270mm]
         link bob = box(60mm, 40mm, 40mm, mass: 500g) at [80mm, 20mm, 380mm]
         link rear = box(200mm, 30mm, 30mm, mass: 300g) at [-20mm, -30mm, 330mm]
         link tail = box(120mm, 30mm, 20mm, mass: 250g) at [-180mm, -30mm, 330mm]
         joint shoulder : body -> upper = revolute(axis: {}, range: {ahead}, {k0}) at [40mm, 20mm, 170mm]
         joint reach : upper -> bob = prismatic(axis: X + 0.3 * Z, stiffness: 4000N/m, armature: 0.2kg) at [50mm, 20mm, 380mm]
         joint root : body -> rear = revolute(axis: {}, range: {range}, {k1}) at [40mm, -30mm, 320mm]
         joint follow : rear -> tail = revolute(axis: {}) at [-120mm, -30mm, 330mm]
         joint follow = -0.7 * root",
        axes[0], axes[1], axes[2]
    )
    .expect("text");
    moves.push("move(robot.shoulder, by: 1.1rad, in: 2s)".to_owned());
    moves.push("move(robot.reach, by: 120mm, in: 2s)".to_owned());
    moves.push(format!("move(robot.root, by: {away}rad, in: 2s)"));
    // They may meet: loads alone are compared.
    for (i, a) in names.iter().enumerate() {
        names[..i].iter().for_each(|b| writeln!(links, "touching {a} {b}").expect("text"));
    }
    format!(
        "module M {{\n{links}}}\nlet robot = M()\nemit(plan(Pc({}), world: world({world})), \"p.json\")\n",
        moves.join(", ")
    )
}

fn random_program(seed: u64, world: &str) -> String {
    use Support::{Beam, Hip, Slide, Wheel};
    let mut rng = SplitMix64(seed ^ 0xABCD);
    let count = 3 + rng.below(3);
    let supports: Vec<Support> = (0..count).map(|_| [Wheel, Hip, Slide, Beam][rng.below(4)]).collect();
    program(seed, &supports, world)
}

/// Level ground, and a slope.
const LEVEL: &str = "dynamics: full";
const SLOPED: &str = "dynamics: full, terrain: slope(9deg, along: [3, -1, 0])";

/// Returns the plan that a program writes; `None` if the judge refuses it, as it may for a random robot.
fn plan(program: &str) -> Option<Plan> {
    let (observed, desk, _) = run(&MapFiles::of(program), Mode::Run);
    let said: Vec<_> = observed.diagnostics.iter().map(|d| (d.code.to_string(), &d.message)).collect();
    let codes = ["E0601", "E0602", "E0603", "E0612"];
    let refused = said.iter().all(|(code, _)| codes.contains(&code.as_str()));
    assert!(refused, "{said:?} in\n{program}");
    said.is_empty().then(|| desk.plan("p.json"))
}

/// Returns how many random robots are tried: ten times as many with `MODL_WHOLE`.
fn robots(count: u64) -> u64 {
    if whole() { 10 * count } else { count }
}

/// Compares the loads of random robots in a world with those of the model.
fn compare(count: u64, world: &str) {
    let mut forces = Vec::new();
    for seed in 0..count {
        let Some(plan) = plan(&random_program(seed, world)) else { continue };
        let machine = Machine::new(&plan);
        let times = recorded(&plan);
        for part in [0.0, 0.21, 0.55, 0.87] {
            let t = times[(part * (times.len() - 1) as f64) as usize];
            let around = [(t - WINDOW / 2.0).max(0.0), t, (t + WINDOW / 2.0).min(2.0)];
            let found = instants(&plan, &around, Detail::Loads, None);
            let [force, effort] = compared(&machine, &found[1], [&found[0], &found[2]]);
            // Where a contact hardly slides, rounds of loads and friction end before they agree to the last.
            assert!(force < 0.05 && effort < 0.05, "robot {seed} at {t} s: {force} and {effort}");
            forces.push(force);
        }
    }
    assert!(forces.len() as u64 >= 3 * count, "most robots stand");
    forces.sort_by(f64::total_cmp);
    let (middle, worst) = (forces[forces.len() / 2], forces[forces.len() - 1]);
    println!("{} instants: half within {middle:.1e} of the weight, all within {worst:.3}", forces.len());
    assert!(middle < 2e-3, "half of them agree to parts of the weight: {middle}");
}

#[test]
fn loads_in_motion_are_those_of_a_model_written_down_again() {
    compare(robots(9), LEVEL);
}

#[test]
fn loads_on_a_slope_are_those_of_the_model_too() {
    compare(robots(4), SLOPED);
}

/// A cart on four feet with two posts, and a bridge that is docked to both: a loop, in which the posts yield.
const LOOP: &str = "
connector Face { mates Face, turns 4 }
module Cart {
  link body = box(160mm, 120mm, 40mm, mass: 4kg) at [0mm, 0mm, 150mm]
  link a_ball15 = sphere(15mm, mass: 200g, friction: 0.8) at [120mm, 100mm, 15mm]
  link b_ball15 = sphere(15mm, mass: 200g, friction: 0.7) at [-120mm, 100mm, 15.05mm]
  link c_ball15 = sphere(15mm, mass: 200g, friction: 0.9) at [-130mm, -100mm, 15mm]
  link d_ball15 = sphere(15mm, mass: 200g, friction: 0.6) at [110mm, -110mm, 15.02mm]
  joint ja : body -> a_ball15 = revolute(axis: Z, stiffness: 90N*m/rad) at [80mm, 40mm, 100mm]
  joint jb : body -> b_ball15 = revolute(axis: 0.2 * X + Y, stiffness: 120N*m/rad) at [-80mm, 60mm, 100mm]
  joint jc : body -> c_ball15 = prismatic(axis: X - 0.5 * Y, stiffness: 6000N/m) at [-80mm, -60mm, 100mm]
  joint jd : body -> d_ball15 = revolute(axis: X + Y, stiffness: 80N*m/rad) at [80mm, -60mm, 100mm]
  link left = box(20mm, 20mm, 90mm, mass: 100g) at [-60mm, 10mm, 225mm]
  link right = box(20mm, 20mm, 90mm, mass: 150g) at [60mm, 0mm, 225mm]
  joint lean : body -> left = revolute(axis: X + 0.4 * Y, stiffness: 40N*m/rad) at [-60mm, 10mm, 180mm]
  joint rock : body -> right = revolute(axis: 0.3 * X + Y, stiffness: 60N*m/rad) at [60mm, 0mm, 180mm]
  port l : Face on left at [0mm, 0mm, 45mm] facing +Z up +X
  port r : Face on right at [0mm, 0mm, 45mm] facing +Z up +X
}
module Bridge {
  link beam = box(180mm, 40mm, 20mm, mass: 600g)
  link bob = box(40mm, 160mm, 30mm, mass: 700g) at [20mm, 60mm, 40mm]
  joint swing : beam -> bob = revolute(axis: Z + 0.5 * X, stiffness: 110N*m/rad, armature: 0.01kg*m^2) at [20mm, 0mm, 30mm]
  port l : Face on beam at [-60mm, 10mm, -10mm] facing -Z up +X
  port r : Face on beam at [60mm, 0mm, -10mm] facing -Z up +X
  touching beam bob
}
config C closed { part a: Cart  part b: Bridge  connect a.l -- b.l  connect a.r -- b.r  base a }
let robot = C()
emit(plan(Pc(move(robot.a.ja, by: 0.5rad, in: 2s), move(robot.a.jc, by: 40mm, in: 2s), move(robot.b.swing, by: -0.7rad, in: 2s)),
  world: world(dynamics: full)), \"p.json\")
";

#[test]
fn a_loop_shares_its_loads_as_springs_do() {
    let plan = plan(LOOP).expect("it stands");
    let machine = Machine::new(&plan);
    assert_eq!(machine.kinematics.tree.closing.len(), 1);
    for t in [0.0, 0.3, 0.9, 1.5] {
        let around = [(t - WINDOW / 2.0_f64).max(0.0), t, t + WINDOW / 2.0];
        let found = instants(&plan, &around, Detail::Loads, None);
        let worst = compared(&machine, &found[1], [&found[0], &found[2]]);
        assert!(worst.iter().all(|worst| *worst < 5e-3), "at {t} s: {worst:?}");
    }
}

#[test]
fn travel_is_that_of_momentum_and_friction_in_small_steps() {
    use Support::{Hip, Slide, Wheel};
    let (mut longest, mut farthest): (f64, f64) = (0.0, 0.0);
    for seed in 0..robots(8) {
        let mut rng = SplitMix64(seed ^ 0x1234);
        let supports: Vec<Support> =
            (0..3 + rng.below(2)).map(|_| [Wheel, Hip, Slide][rng.below(3)]).collect();
        let Some(plan) = plan(&program(seed, &supports, LEVEL)) else { continue };
        let machine = Machine::new(&plan);
        let [begin, end] = [0.0, 2.0].map(|t| base_at(&plan, t).expect("it stands"));
        let expected = travelled(&machine, &begin);
        let off = (end.translation.vector - expected.translation.vector).norm();
        let turned = end.rotation.angle_to(&expected.rotation);
        let way = (end.translation.vector - begin.translation.vector).norm();
        longest = longest.max(way);
        farthest = farthest.max(off);
        assert!(off < 2.5e-3 && turned < 0.01, "robot {seed} of {way} m: {off} m and {turned} rad apart");
    }
    println!("travel of up to {longest:.3} m: ends within {:.2} mm", 1e3 * farthest);
    assert!(longest > 0.05, "some robot gets on: {longest} m");
}
