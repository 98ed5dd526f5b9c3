//! Simulations at the limits of what may be asked: the same result wherever they run, and never a value that is no
//! number, nor a panic.

use super::fixtures::{LEVEL, PENDULUM, close, plan, play};
use modl::plan::{Body, Ground, Plan, World};
use modl::robot::Link;
use modl::simulate::{Refusal, ServoGains, Settings, Simulation, Spread, simulate, study};
use std::sync::Arc;
use std::thread;

/// Robots of the library: wheels, feet that are set down, and a ring that opens and closes.
const PROGRAMS: &[&str] = &[
    "use std.smores.Driver1\nlet b = Driver1().turn()\n",
    "use std.smores.Climber4\nlet b = Climber4().step()\n",
    "use std.smores.Ring12\nlet ring = Ring12()
let b = Sc(undock(ring.m[11].bottom), wait(200ms), dock(ring.m[11].bottom, ring.m[0].top), wait(200ms))\n",
];

fn plans() -> Vec<Plan> {
    PROGRAMS.iter().map(|program| plan(program, LEVEL)).collect()
}

#[test]
fn a_simulation_is_the_same_on_every_thread() {
    let plans = plans();
    let digest = |plan: &Plan| format!("{:?}", play(plan, &Settings::default()));
    let alone: Vec<String> = plans.iter().map(digest).collect();
    thread::scope(|scope| {
        // Each thread begins with another plan.
        let of = |first: usize| {
            let order: Vec<usize> = (0..plans.len()).map(|k| (first + k) % plans.len()).collect();
            let plans = &plans;
            scope.spawn(move || order.iter().map(|at| (*at, digest(&plans[*at]))).collect::<Vec<_>>())
        };
        let threads: Vec<_> = (0..4).map(of).collect();
        for thread in threads {
            for (at, digest) in thread.join().expect("no thread panics") {
                assert!(digest == alone[at], "plan {at} differs");
            }
        }
    });
}

/// Returns true if all that was measured is a number, and the robot has not flown away.
fn is_sound(simulation: &Simulation) -> bool {
    let extremes = [
        simulation.lag,
        simulation.lag_length,
        simulation.effort,
        simulation.saturated,
        simulation.bond_load,
    ];
    let values =
        [simulation.heading, simulation.lean, simulation.lean_max, simulation.impact, simulation.work];
    let mut all = extremes
        .iter()
        .flatten()
        .map(|extreme| extreme.value)
        .chain(values)
        .chain(simulation.travel.iter().copied());
    let moments = simulation.motion.iter().all(|moment| {
        let joints = moment.joints.iter().all(|q| q.is_finite());
        joints
            && moment.base.translation.vector.norm() < 10.0
            && moment.base.rotation.coords.iter().all(|x| x.is_finite())
    });
    all.all(f64::is_finite) && moments && !simulation.motion.is_empty()
}

#[test]
fn extreme_settings_give_numbers_or_are_refused() {
    let soft = ServoGains { stiffness: Some(1e-3), ..ServoGains::default() };
    let stiff = ServoGains { stiffness: Some(1e6), ..ServoGains::default() };
    let strong = ServoGains { unlimited: true, ..stiff };
    let weak = ServoGains { effort: 0.0, ..ServoGains::default() };
    let undamped = ServoGains { damping: Some(0.0), ..ServoGains::default() };
    let plain = Settings::default();
    let settings = [
        Settings { step: Settings::STEP_MAX, ..plain.clone() },
        Settings { step: Settings::STEP_MAX, servo: strong, ..plain.clone() },
        Settings { servo: stiff, ..plain.clone() },
        Settings { servo: strong, ..plain.clone() },
        Settings { servo: soft, ..plain.clone() },
        Settings { servo: weak, ..plain.clone() },
        Settings { servo: undamped, ..plain.clone() },
        Settings { mass: 1e-3, ..plain.clone() },
        Settings { mass: 1e-3, servo: strong, step: Settings::STEP_MAX, ..plain.clone() },
        Settings { mass: 10.0, ..plain.clone() },
        Settings { friction: 0.0, ..plain.clone() },
        Settings { friction: 10.0, ..plain.clone() },
        Settings { friction: 10.0, step: Settings::STEP_MAX, servo: strong, ..plain.clone() },
        Settings { link_contacts: false, ..plain.clone() },
    ];
    let mut wrong = vec![];
    for (number, plan) in plans().iter().enumerate() {
        for settings in &settings {
            match simulate(plan, settings) {
                Ok(simulation) if is_sound(&simulation) => {}
                Ok(simulation) => {
                    wrong.push(format!("plan {number}, {settings:?}: {:?}", simulation.motion.last()))
                }
                Err(refusal) => wrong.push(format!("plan {number}, {settings:?}: {refusal}")),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn steps_and_factors_out_of_range_are_refused() {
    let plan = &plan(PROGRAMS[0], LEVEL);
    for step in [0.0, -1e-3, 0.9e-6, 5.1e-3, f64::NAN, f64::INFINITY] {
        let refusal = simulate(plan, &Settings { step, ..Settings::default() });
        assert_eq!(refusal.map(|_| ()), Err(Refusal::Step), "{step}");
    }
    let servo = |servo: ServoGains| Settings { servo, ..Settings::default() };
    let gains = ServoGains::default();
    for (name, settings) in [
        ("mass", Settings { mass: 0.0, ..Settings::default() }),
        ("mass", Settings { mass: f64::NAN, ..Settings::default() }),
        ("friction", Settings { friction: f64::NAN, ..Settings::default() }),
        ("friction", Settings { friction: -1.0, ..Settings::default() }),
        ("stiffness", servo(ServoGains { stiffness: Some(f64::NAN), ..gains })),
        ("stiffness", servo(ServoGains { stiffness: Some(-150.0), ..gains })),
        ("damping", servo(ServoGains { damping: Some(-1e-3), ..gains })),
        ("factor on the efforts", servo(ServoGains { effort: -1.0, ..gains })),
    ] {
        let refusal = simulate(plan, &settings);
        assert_eq!(refusal.map(|_| ()), Err(Refusal::Setting(name)), "{settings:?}");
    }
}

/// Takes the mass of some links away.
fn without_mass(plan: &mut Plan, links: impl Fn(&Link) -> bool) {
    let mut library = (*plan.library).clone();
    for link in library.modules.iter_mut().flat_map(|module| &mut module.links).filter(|link| links(link)) {
        (link.mass, link.inertia) = (0.0, [0.0; 6]);
    }
    plan.library = Arc::new(library);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
    tracks.robot.library = plan.library.clone();
}

#[test]
fn what_has_no_mass_is_refused_only_if_it_must_be_moved() {
    let no_inertia =
        |plan: &Plan| matches!(simulate(plan, &Settings::default()), Err(Refusal::NoInertia { .. }));
    let held = World { ground: Ground::Held, ..LEVEL };
    let program = format!("{PENDULUM}let x = Pendulum(30deg)\nlet b = x.rest(1s)\n");
    // A bob that swings freely needs mass; the post that is held does not.
    let mut bob = plan(&program, held);
    without_mass(&mut bob, |link| link.name == "bob");
    assert!(no_inertia(&bob));
    let mut post = plan(&program, held);
    without_mass(&mut post, |link| link.name == "post");
    assert!(!no_inertia(&post));
    // A robot must have some mass.
    let mut all = plan(PROGRAMS[0], World::FREE);
    without_mass(&mut all, |_| true);
    assert!(simulate(&all, &Settings::default()).is_err());
    // Wheels without mass are turned by their servos.
    let mut wheels = plan(PROGRAMS[0], LEVEL);
    without_mass(&mut wheels, |link| link.name.ends_with("_disc"));
    assert!(is_sound(&play(&wheels, &Settings::default())));
}

#[test]
fn joints_are_off_by_what_is_drawn_for_each() {
    let arms = "module Arms {
  link post = box(40mm, 40mm, 40mm, mass: 1kg)
  link left = box(40mm, 40mm, 200mm, mass: 100g) at [0mm, 100mm, 0mm]
  link right = box(40mm, 40mm, 200mm, mass: 100g) at [0mm, -100mm, 0mm]
  joint l : post -> left = revolute(axis: Y, stiffness: 100N*m/rad) at [0mm, 100mm, 0mm]
  joint r : post -> right = revolute(axis: Y, stiffness: 100N*m/rad) at [0mm, -100mm, 0mm]
}
config Two { part a: Arms
  base a
  behavior rest = wait(500ms)
}
let b = Two().rest()
";
    let plan = plan(arms, World { gravity: 0.0, ground: Ground::Held, ..LEVEL });
    let spread = Spread { friction: 0.0, mass: 0.0, effort: 0.0, stiffness: 0.0, zero: 0.05 };
    let off = |seed: u64| -> Vec<(f64, usize)> {
        let runs = study(&plan, &Settings::default(), &spread, 60, seed).expect("the plan can be simulated");
        let lag = |run: &modl::simulate::Run| run.outcome.lag.map_or((0.0, 9), |lag| (lag.value, lag.of));
        runs.iter().map(lag).collect()
    };
    let first = off(1);
    assert_eq!(first, off(1));
    assert_ne!(first, off(2));
    // The farther of two that are uniform is 2/3 of the most in the mean, with a deviation of 0.03 of it over 60 runs.
    let mean = first.iter().map(|(lag, _)| lag).sum::<f64>() / 60.0;
    close(mean, 0.05 * 2.0 / 3.0, 0.05 * 0.1);
    assert!(first.iter().all(|(lag, _)| *lag <= 0.05 + 1e-4));
    // Either arm is the farther one in about half of the runs.
    let left = first.iter().filter(|(_, joint)| *joint == 0).count();
    assert!((15..=45).contains(&left), "{left} of 60");
}
