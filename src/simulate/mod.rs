//! Simulation of plans of articulated robots: rigid bodies whose servos follow the plan, with contact and friction.
//!
//! It answers what a verdict leaves open: what a robot really does when a plan is played on it, also where motors are too
//! weak, feet slip or it falls. It decides nothing for the judge, who finds loads by its own method, and shares only the
//! steps of `plan::forward_dynamics`, for the travel of robots whose contacts scrub.
//!
//! In reading order: what the plan or its program commands (`commands`) and what sensors tell it (`sensing`), ground that need
//! not be level (`terrain`), what falls (`falls`), what is measured (`outcome`) and kept of the motion (`recording`,
//! `measured`), many runs of one plan (`robustness`), and what is said of all that (`words`, `notes`). The method is that of
//! `plan::forward_dynamics`.
#![allow(non_snake_case)]

mod commands;
mod falls;
mod measured;
mod notes;
mod outcome;
mod recording;
mod refusal;
mod robustness;
mod sensing;
mod terrain;
mod words;

use crate::behavior::unfaithful;
use crate::geometry::{Placed, Vec3};
use crate::interrupt;
use crate::plan::forward_dynamics::{Couplings, GroundContacts, LinkContacts, Model, PARAMETERS, Stepper};
pub use crate::plan::forward_dynamics::{ServoGains, Settings};
use crate::plan::verify::articulated::start_poses;
use crate::plan::{DockingKind, Ground, Plan, Tracks, World, validation};
use crate::robot::Assembly;
use commands::Commands;
use falls::Falls;
pub use measured::MeasuredLinks;
pub use notes::{Played, is_judged};
use outcome::Recorder;
pub use outcome::{BondEvent, BondEventKind, Extreme, Simulation};
pub use recording::{ContactForce, Drive, Moment};
pub use refusal::Refusal;
pub use robustness::{Factors, FailureCounts, Run, Spread, study};
use std::sync::Arc;
pub use terrain::Terrain;

/// Plays a plan: the robot stands for 0.3 s, moves as its servos follow the plan, and stands for 0.3 s again. The program of
/// a plan that depends on sensors or timeouts is executed, with conditions on what is simulated.
///
/// # Errors
/// A [`Refusal`] for plans of lattices and trusses, those that are not valid or whose program makes another motion,
/// settings out of range, and robots without inertia.
pub fn simulate(plan: &Plan, settings: &Settings) -> Result<Simulation, Refusal> {
    let duration = plan.body.tracks().map_or(0.0, |tracks| tracks.duration);
    play(plan, settings, &|time| format!("{:.1} of {duration:.1} s", time.max(0.0)))
}

/// Plays a plan as [`simulate`] does; `progress` says in words how far the work is at a time (s) of the simulation.
///
/// # Errors
/// Those of [`simulate`].
fn play(plan: &Plan, settings: &Settings, progress: &dyn Fn(f64) -> String) -> Result<Simulation, Refusal> {
    let tracks = plan.body.tracks().ok_or(Refusal::Family)?;
    validation::check(plan).map_err(Refusal::Invalid)?;
    if !(Settings::STEP_MIN..=Settings::STEP_MAX).contains(&settings.step) {
        return Err(Refusal::Step);
    }
    if let Some(setting) = settings.unsound() {
        return Err(Refusal::Setting(setting));
    }
    if let Some(field) = &settings.terrain {
        let world = plan.worlds.first().map_or(World::FREE, |first| first.world);
        let fault = match (world.has_floor(), world.is_sloped()) {
            (false, _) => Some("the plan's world has no ground that could be uneven"),
            (true, true) => Some("the plan's world has a slope of its own"),
            (true, false) => field.fault(),
        };
        fault.map_or(Ok(()), |fault| Err(Refusal::Terrain(fault)))?;
    }
    if plan.nominal
        && let Some(failure) = unfaithful(plan)
    {
        return Err(Refusal::Unfaithful(failure.message));
    }
    let mut apart = Vec::new();
    // A bond of a tree that breaks, or is undocked, is a constraint from the start on, in the next run.
    loop {
        match run(plan, tracks, settings, &apart, progress)? {
            Ok(simulation) => return Ok(simulation),
            Err(bond) => apart.push(bond),
        }
    }
}

/// Plays a plan with a time step and with half of it, at once where there are two threads: [`simulate`]'s result, and in
/// words what the half step changes in it.
///
/// # Errors
/// Those of [`simulate`] with the whole step.
pub fn simulate_halving(plan: &Plan, settings: &Settings) -> Result<(Simulation, String), Refusal> {
    let robot = &plan.body.tracks().ok_or(Refusal::Family)?.robot;
    let halved = Settings { step: settings.step / 2.0, ..settings.clone() };
    let (outcome, finer) = interrupt::join(|| simulate(plan, settings), || simulate(plan, &halved));
    let outcome = outcome?;
    let words = match finer {
        Ok(finer) => outcome.halving(&finer, robot),
        Err(refusal) => format!("at half the step: {refusal}"),
    };
    Ok((outcome, words))
}

/// Plays a plan, with some bonds that are not in the trees although they hold all the time; gives the first other bond
/// that breaks or is undocked.
fn run(
    plan: &Plan,
    tracks: &Tracks,
    settings: &Settings,
    apart: &[usize],
    progress: &dyn Fn(f64) -> String,
) -> Result<Result<Simulation, usize>, Refusal> {
    let robot = &tracks.robot;
    let (X_WB, clusters) = start_poses(plan, tracks);
    let world = plan.worlds.first().map_or(World::FREE, |first| first.world);
    let mut model = Model::new(tracks, (&X_WB, &clusters), &world, settings, apart);
    let slope = world.terrain().map(Terrain::of_plan);
    let normal = slope.as_ref().map(|slope| slope.field.normal(0.0, 0.0));
    let terrain = settings.terrain.as_ref().map(|field| Terrain::under(&model, field)).or(slope);
    let up =
        normal.or(terrain.as_ref().map(|terrain| terrain.X_WP.rotation * Vec3::z())).unwrap_or(Vec3::z());
    if let Some(terrain) = &terrain {
        model.start.iter_mut().for_each(|pose| *pose = terrain.X_WP * *pose);
    }
    let of_plan = tracks.obstacles.iter().map(|obstacle| obstacle.shapes.clone());
    let obstacles: Arc<[Vec<Placed>]> = of_plan.chain(settings.obstacles.iter().cloned()).collect();
    if !obstacles.is_empty() {
        model.stand_fast(world.friction * settings.friction);
    }
    let links = match settings.link_contacts {
        true => Some(LinkContacts::new(&model, robot, &obstacles)?),
        false => None,
    };
    let couplings = Couplings::new(&model, robot, &tracks.start.bonds, links);
    let gravity = if world.ground == Ground::Off { 0.0 } else { world.gravity };
    let h = settings.step;
    let ground = world
        .has_floor()
        .then(|| GroundContacts::new(&model, terrain.as_ref().map(|terrain| &terrain.field), h));
    let mut stepper = Stepper::new(&model, couplings, &tracks.start.joints, gravity, ground, h);
    let mut commands = Commands::new(tracks, plan.program.as_ref().filter(|_| plan.nominal));
    let mut recorder = Recorder::new(&model, Falls::new(&model, robot, up, h), apart, h);
    let steps = |time: f64| libm::ceil(time / h - 1e-9) as i64;
    let mut number = -steps(PARAMETERS.settle);
    while commands.end().is_none_or(|end| number < steps(end + PARAMETERS.rest)) {
        let time = number as f64 * h;
        interrupt::progress_checkpoint(|| progress(time));
        number += 1;
        let events = commands.bonds(time, robot, &stepper);
        commands.advance(time + h);
        for event in events {
            if !model.constraints.contains(&event.bond) {
                return Ok(Err(event.bond));
            }
            let docks = event.kind == DockingKind::Dock;
            let off = stepper.hold(event.bond, docks, &commands.joints);
            if !docks {
                recorder.bond(BondEvent { bond: event.bond, time, kind: BondEventKind::Undocks });
            }
            if let Some((distance, angle)) = off.filter(|_| docks) {
                let captured = captures(robot, event.bond, distance, angle);
                if !captured {
                    stepper.hold(event.bond, false, &commands.joints);
                    commands.set_bond(event.bond, false);
                }
                let kind = match captured {
                    true => BondEventKind::Docks(distance, angle),
                    false => BondEventKind::Misses(distance, angle),
                };
                recorder.bond(BondEvent { bond: event.bond, time, kind });
            }
        }
        if let Some(reason) = commands.stopped() {
            recorder.stop(time, reason);
        }
        stepper.take(&commands.joints, time).map_err(|_| Refusal::NoInertia { time })?;
        for (bond, load, loose) in stepper.bond_loads(robot) {
            // Swings of the first moment, as loads set in, are not those of the plan.
            if time < 0.0 {
                continue;
            }
            recorder.load(bond, load, time);
            if load > 1.0 {
                if !loose {
                    return Ok(Err(bond));
                }
                stepper.hold(bond, false, &commands.joints);
                commands.set_bond(bond, false);
                recorder.bond(BondEvent { bond, time, kind: BondEventKind::Breaks(load) });
            }
        }
        recorder.see(&stepper, &commands, time + h);
    }
    let outcome = recorder.end(&stepper, commands.end().unwrap_or(tracks.duration));
    Ok(Ok(Simulation { terrain, obstacles, ..outcome }))
}

/// Returns true if two ports that are so far from a perfect mate (m, rad) dock; where the connector of a bond states no
/// capture, they always do.
fn captures(robot: &Assembly, bond: usize, distance: f64, angle: f64) -> bool {
    let capture = robot.connector(robot.bonds[bond].a).capture;
    capture.is_none_or(|capture| distance <= capture.distance && angle <= capture.angle)
}
