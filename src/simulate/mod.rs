//! Simulation of plans of articulated robots: rigid bodies whose servos follow the plan, with contact and friction.
//!
//! It answers what a verdict leaves open: what a robot really does when a plan is played on it, also where motors are too
//! weak, feet slip or it falls. It decides nothing for the judge, whose verdict rests on its own methods.
//!
//! In reading order: the robot as trees of bodies with servos (`model`), what the plan commands (`commands`), the
//! time steps (`stepper`), contacts with the ground (`contact`) and between links (`link_contact`), what couples bodies
//! besides joints (`coupling`), what is measured (`outcome`), and many runs of one plan (`robustness`). The method is that of articulated bodies
//! ([`crate::robot::articulated_bodies`]) with all springs and dampers at the end of the step.
#![allow(non_snake_case)]

mod commands;
mod contact;
mod coupling;
mod link_contact;
mod model;
mod outcome;
mod parameters;
mod refusal;
mod robustness;
mod stepper;
mod words;

use crate::interrupt;
use crate::plan::verify::articulated::base_at;
use crate::plan::{DockingKind, Ground, Plan, Tracks, World, validation};
use crate::robot::Assembly;
use commands::Commands;
use coupling::Couplings;
use link_contact::LinkContacts;
use model::Model;
use outcome::Recorder;
pub use outcome::{BondEvent, BondEventKind, Extreme, Moment, Simulation};
use parameters::PARAMETERS;
pub use refusal::Refusal;
pub use robustness::{Factors, Run, Spread, study};
use stepper::Stepper;

/// The servos where they are not those of the modules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoGains {
    /// The stiffness of joints that turn, N·m/rad; those that slide have it at a lever of 0.1 m. `None`: as the modules
    /// state.
    pub stiffness: Option<f64>,
    /// The damping of a servo of unit stiffness, s; `None`:
    /// [`DAMPING_DEFAULT`](crate::robot::Servo::DAMPING_DEFAULT).
    pub damping: Option<f64>,
    /// The factor on the stiffness, without unit.
    pub factor: f64,
    /// The factor on the greatest efforts, without unit.
    pub effort: f64,
    /// True if motors have no limits of effort, so that the effort that is needed shows.
    pub unlimited: bool,
}

impl Default for ServoGains {
    fn default() -> ServoGains {
        ServoGains { stiffness: None, damping: None, factor: 1.0, effort: 1.0, unlimited: false }
    }
}

/// The settings of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The time step, s.
    pub step: f64,
    /// The factor on all coefficients of friction, besides that of the world.
    pub friction: f64,
    /// The factor on all masses, with their moments of inertia.
    pub mass: f64,
    /// The servos.
    pub servo: ServoGains,
    /// True if links push each other apart where they meet; false if they pass through each other.
    pub link_contacts: bool,
}

impl Settings {
    /// The time step where none is stated, s: 0.5 ms. Half of it changes the travel of the library's walkers by less than
    /// 1 %.
    pub const STEP_DEFAULT: f64 = 5e-4;
    /// The longest time step, s: beyond, robots on stiff contacts are no longer followed.
    pub const STEP_MAX: f64 = 5e-3;
    /// The shortest time step, s.
    pub const STEP_MIN: f64 = 1e-6;

    /// Returns the name of a setting that is negative or not finite, or zero where it must be positive; `None` if all are
    /// sound. The time step is not among them.
    fn unsound(&self) -> Option<&'static str> {
        let ServoGains { stiffness, damping, factor, effort, .. } = self.servo;
        let sound = |x: f64| x.is_finite() && x >= 0.0;
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let all = [
            ("friction", sound(self.friction)),
            ("mass", positive(self.mass)),
            ("stiffness", stiffness.is_none_or(positive)),
            ("damping", damping.is_none_or(sound)),
            ("factor on the stiffness", positive(factor)),
            ("factor on the efforts", sound(effort)),
        ];
        all.into_iter().find(|(_, sound)| !sound).map(|(name, _)| name)
    }
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            step: Settings::STEP_DEFAULT,
            friction: 1.0,
            mass: 1.0,
            servo: ServoGains::default(),
            link_contacts: true,
        }
    }
}

/// Plays a plan: the robot stands for 0.3 s, moves as its servos follow the plan, and stands for 0.3 s again.
///
/// # Errors
/// A [`Refusal`] for plans of lattices and trusses, those that are not valid, settings out of range, and robots without
/// inertia.
pub fn simulate(plan: &Plan, settings: &Settings) -> Result<Simulation, Refusal> {
    let tracks = plan.body.tracks().ok_or(Refusal::Family)?;
    validation::check(plan).map_err(Refusal::Invalid)?;
    if !(Settings::STEP_MIN..=Settings::STEP_MAX).contains(&settings.step) {
        return Err(Refusal::Step);
    }
    if let Some(setting) = settings.unsound() {
        return Err(Refusal::Setting(setting));
    }
    let mut apart = Vec::new();
    // A bond of a tree that breaks is a constraint from the start on, in the next run.
    loop {
        match run(plan, tracks, settings, &apart)? {
            Ok(simulation) => return Ok(simulation),
            Err(bond) => apart.push(bond),
        }
    }
}

/// Plays a plan, with some bonds that are not in the trees although they hold all the time; gives the first other bond
/// that breaks.
fn run(
    plan: &Plan,
    tracks: &Tracks,
    settings: &Settings,
    apart: &[usize],
) -> Result<Result<Simulation, usize>, Refusal> {
    let robot = &tracks.robot;
    let X_WB = base_at(plan, 0.0).unwrap_or(tracks.start.base);
    let world = plan.worlds.first().map_or(World::FREE, |first| first.world);
    let model = Model::new(tracks, &X_WB, &world, settings, apart);
    let links = match settings.link_contacts {
        true => Some(LinkContacts::new(&model, robot).map_err(Refusal::Shape)?),
        false => None,
    };
    let couplings = Couplings::new(&model, robot, &tracks.start.bonds, links);
    let gravity = if world.ground == Ground::Off { 0.0 } else { world.gravity };
    let h = settings.step;
    let mut stepper = Stepper::new(&model, couplings, &tracks.start.joints, gravity, world.has_floor(), h);
    let mut commands = Commands::new(tracks);
    let mut recorder = Recorder::new(tracks, &model, h);
    let steps = |time: f64| libm::ceil(time / h - 1e-9) as i64;
    let (first, last) = (-steps(PARAMETERS.settle), steps(tracks.duration + PARAMETERS.rest));
    let mut events = tracks.events.iter().peekable();
    for number in first..last {
        interrupt::progress_checkpoint(|| format!("{:.1} of {:.1} s", number as f64 * h, tracks.duration));
        let time = number as f64 * h;
        commands.advance(time + h);
        while let Some(event) = events.next_if(|event| event.time <= time) {
            let docks = event.kind == DockingKind::Dock;
            let off = stepper.hold(event.bond, docks, &commands);
            if let Some((distance, angle)) = off.filter(|_| docks) {
                let captured = captures(robot, event.bond, distance, angle);
                if !captured {
                    stepper.hold(event.bond, false, &commands);
                }
                let kind = match captured {
                    true => BondEventKind::Docks(distance, angle),
                    false => BondEventKind::Misses(distance, angle),
                };
                recorder.bond(BondEvent { bond: event.bond, time, kind });
            }
        }
        stepper.take(&commands, time).map_err(|_| Refusal::NoInertia { time })?;
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
                stepper.hold(bond, false, &commands);
                recorder.bond(BondEvent { bond, time, kind: BondEventKind::Breaks(load) });
            }
        }
        recorder.see(&stepper, &commands, time + h);
    }
    Ok(Ok(recorder.end(&stepper)))
}

/// Returns true if two ports that are so far from a perfect mate (m, rad) dock; where the connector of a bond states no
/// capture, they always do.
fn captures(robot: &Assembly, bond: usize, distance: f64, angle: f64) -> bool {
    let a = robot.bonds[bond].a;
    let connector = &robot.library.connectors[robot.module_type(a.module).ports[a.port].connector];
    connector.capture.is_none_or(|capture| distance <= capture.distance && angle <= capture.angle)
}
