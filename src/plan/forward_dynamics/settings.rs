//! The settings of a simulation.

use crate::geometry::{HeightField, Placed};
use std::sync::Arc;

/// The servos where they are not those of the modules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoGains {
    /// The stiffness of joints that turn, N·m/rad; those that slide have it at a lever of 0.1 m. `None`: as the modules
    /// state.
    pub stiffness: Option<f64>,
    /// The damping of a servo of unit stiffness, s; `None`: as the modules state, or
    /// [`DAMPING_DEFAULT`](crate::robot::Servo::DAMPING_DEFAULT) where they do not, or where `stiffness` is given.
    pub damping: Option<f64>,
    /// The factor on the stiffness, without unit.
    pub factor: f64,
    /// The factor on the greatest efforts, without unit.
    pub effort: f64,
    /// The most by which the zeros of joints that turn are off, rad, and the seed by which each is drawn.
    pub zero_error: (f64, u64),
    /// True if motors have no limits of effort, so that the effort that is needed shows.
    pub unlimited: bool,
}

impl Default for ServoGains {
    fn default() -> ServoGains {
        ServoGains {
            stiffness: None,
            damping: None,
            factor: 1.0,
            effort: 1.0,
            zero_error: (0.0, 0),
            unlimited: false,
        }
    }
}

/// The settings of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The time step, s.
    pub step: f64,
    /// The factor on all coefficients of friction, besides that of the world.
    pub friction: f64,
    /// The factor on all masses, with their moments of inertia.
    pub mass: f64,
    /// The servos.
    pub servo: ServoGains,
    /// True if links push each other apart where they meet; false if they pass through each other, and through obstacles.
    pub link_contacts: bool,
    /// The ground in place of level one, where the world has a floor; a [sound](HeightField::fault) height field.
    pub terrain: Option<Arc<HeightField>>,
    /// Solids in the world that stand fast, each of shapes placed in the world. Their friction is
    /// [`Link::FRICTION_DEFAULT`](crate::robot::Link::FRICTION_DEFAULT), or that of a rougher link on them.
    pub obstacles: Arc<[Vec<Placed>]>,
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
    pub(crate) fn unsound(&self) -> Option<&'static str> {
        let ServoGains { stiffness, damping, factor, effort, zero_error, .. } = self.servo;
        let sound = |x: f64| x.is_finite() && x >= 0.0;
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let all = [
            ("friction", sound(self.friction)),
            ("mass", positive(self.mass)),
            ("stiffness", stiffness.is_none_or(positive)),
            ("damping", damping.is_none_or(sound)),
            ("factor on the stiffness", positive(factor)),
            ("factor on the efforts", sound(effort)),
            ("error of zeros", sound(zero_error.0)),
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
            terrain: None,
            obstacles: Arc::default(),
        }
    }
}
