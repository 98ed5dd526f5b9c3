//! The conventions of `fold`, as its options state them.

use super::fold_panel::Panel;
use crate::behavior::law;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3};
use crate::interpret::call::Call;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::plan::{Ground, Profile, World};
use crate::planners::fold::Target;
use crate::planners::fold::ground_faces::{Protrusion, below};
use crate::planners::fold::inertia::Inertia;
use crate::planners::fold::objective::{Conventions, Minimise};
use crate::planners::fold::pattern::has_equal_sides;
use crate::planners::fold::simulation::Count;
use crate::planners::fold::thickness;
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};

/// Where the arguments of `fold` stand.
pub const TARGET: usize = 0;
pub const MODULE: usize = 1;
pub const ROOT: usize = 2;
pub const METHOD: usize = 3;
pub const STEP: usize = 4;
pub const SEED: usize = 5;
pub const BUDGET: usize = 6;
pub const MINIMISE: usize = 7;
pub const INERTIA: usize = 8;
pub const GRAVITY: usize = 9;
pub const COUNT: usize = 10;
pub const SEQUENCE: usize = 11;
pub const PASSIVE: usize = 12;
pub const PASSIVE_MODULE: usize = 13;
pub const HINGE_RADIUS: usize = 14;
pub const HINGES: usize = 15;
pub const ARGUMENTS: usize = 16;

/// Steps are as long as the fastest hinge needs, up to a multiple of this, s.
const STEP_GRAIN: f64 = 0.01;

/// How long a step takes where no hinge has a limit, s.
const STEP_FREE: f64 = 1.0;

/// In which order hinges fold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sequence {
    LeavesFirst,
    RootFirst,
    LeastWork,
    LeastEnergy,
}

/// What is asked of a folding beside its shape.
pub struct Options {
    pub root: Option<usize>,
    /// Faces that may be the root: those on which the shape can lie.
    pub roots: Vec<usize>,
    pub seed: u64,
    pub budget: u64,
    pub minimise: Minimise,
    pub conventions: Conventions,
    pub sequence: Sequence,
    /// The least angle between two panels, rad.
    pub opening: Option<f64>,
}

impl Options {
    pub fn of(call: &Call, panel: &Panel, target: &Target) -> Eval<Options> {
        let faces = target.faces.len();
        let root = match call.arg(ROOT) {
            Value::Word(_) => None,
            _ => Some(call.count(ROOT, "a face")?),
        };
        if root.is_some_and(|root| root >= faces) {
            return Err(call.refuse(ROOT, format!("there is no such face: there are {faces}")));
        }
        let step = match call.arg(STEP) {
            Value::Word(_) => shortest_step(target, panel),
            _ => call.positive(STEP, "the time of a step")?,
        };
        let inertia = match call.word(INERTIA) {
            Some("prism") => Inertia::Prism(panel.thickness),
            Some("point") => Inertia::Point,
            _ => Inertia::Lamina,
        };
        let gravity = if call.word(GRAVITY) == Some("on") { World::default().gravity } else { 0.0 };
        let count = if call.word(COUNT) == Some("all") { Count::All } else { Count::Moving };
        let radius = call.positive_if(HINGE_RADIUS, "the radius of the hinges")?;
        let gravitates = gravity != 0.0;
        let depth = if gravitates { panel.thickness } else { f64::INFINITY };
        let options = Options {
            root,
            roots: roots(call, target, root, depth)?,
            seed: call.count(SEED, "a seed")? as u64,
            budget: call.count(BUDGET, "a budget")? as u64,
            minimise: match call.word(MINIMISE) {
                Some("peak_torque") => Minimise::PeakTorque,
                Some("steps") => Minimise::Steps,
                _ => Minimise::Energy,
            },
            conventions: Conventions { inertia, count, gravity, step },
            sequence: match call.word(SEQUENCE) {
                Some("root_first") => Sequence::RootFirst,
                Some("least_work") => Sequence::LeastWork,
                Some("least_energy") => Sequence::LeastEnergy,
                _ => Sequence::LeavesFirst,
            },
            opening: radius.map(|radius| thickness::least_opening(panel.thickness, radius)),
        };
        options.check(call, target)?;
        Ok(options)
    }

    /// What does not go together.
    fn check(&self, call: &Call, target: &Target) -> Eval<()> {
        let separate = self.conventions.separate();
        if call.word(METHOD) == Some("heuristic") && !(separate && self.minimise == Minimise::Energy) {
            let message = "the heuristic estimates energies of moving joints without gravity, nothing else";
            return Err(call.refuse(METHOD, message));
        }
        if call.word(METHOD) == Some("heuristic") && !call.list(PASSIVE)?.is_empty() {
            return Err(call.refuse(METHOD, "the heuristic takes all panels for equally heavy"));
        }
        if call.word(METHOD) == Some("heuristic") && !has_equal_sides(target) {
            return Err(call.refuse(METHOD, "the heuristic takes all panels for equal"));
        }
        if self.sequence == Sequence::LeastEnergy && !separate {
            let message =
                "this order is found for moving joints without gravity only; `least_work` knows gravity";
            return Err(call.refuse(SEQUENCE, message));
        }
        Ok(())
    }

    /// Weightless, or with the root held on the ground.
    pub fn world(&self) -> World {
        if self.conventions.gravity == 0.0 {
            return World::FREE;
        }
        World { gravity: self.conventions.gravity, ground: Ground::Fixed, friction: 1.0 }
    }

    /// Where the root's panel, of a thickness in m, lies: on the ground with its outside down, if there is one.
    pub fn base(&self, thickness: f64) -> Pose {
        if self.conventions.gravity == 0.0 {
            return Pose::identity();
        }
        shifted(Vec3::new(0.0, 0.0, thickness / 2.0)) * turned(Vec3::x(), std::f64::consts::PI)
    }
}

/// The faces that may be the root: if one is given, that; else all below which nothing of the shape reaches
/// farther than `depth`, m.
fn roots(call: &Call, target: &Target, root: Option<usize>, depth: f64) -> Eval<Vec<usize>> {
    let asked: Vec<usize> = root.map_or_else(|| (0..target.faces.len()).collect(), |root| vec![root]);
    let lies = |root: &usize| below(target, *root, depth).is_none();
    let roots: Vec<usize> = asked.iter().copied().filter(lies).collect();
    let (true, Some(&first)) = (roots.is_empty(), asked.first()) else { return Ok(roots) };
    let Some(Protrusion { face, depth }) = below(target, first, depth) else { return Ok(roots) };
    let depth = quantity(depth, Dimension::LENGTH);
    let (at, message) = match root {
        Some(_) => {
            (ROOT, format!("face {face} reaches {depth} below face {first}, which would lie on the ground"))
        }
        None => {
            let which = "whichever face lies on the ground, others reach below it";
            (TARGET, format!("{which}: below face {first} face {face} does by {depth}"))
        }
    };
    Err(Diagnostic::error(code::NO_WAY, message)
        .label(call.at(at), "can't lie on the ground so")
        .hint("`gravity: off` folds where there is no ground")
        .into())
}

/// What every hinge can do, s: the same for all layouts, or they could not be compared.
pub fn shortest_step(target: &Target, panel: &Panel) -> f64 {
    step_of(target.hinges.iter().map(|hinge| hinge.angle.abs()).fold(0.0, f64::max), panel)
}

/// A step in argument `index` takes less than the slowest hinge needs, s.
pub fn too_fast(call: &Call, index: usize, least: f64) -> Stop {
    let least = quantity(least, Dimension::TIME);
    Diagnostic::error(code::BAD_VALUE, "the hinges can't fold as fast as that")
        .label(call.at(index), "too short for the widest angle")
        .hint(format!("steps of {least} are long enough; without `step` they are as short as they can be"))
        .into()
}

/// How long a hinge takes to turn by an angle, s.
pub fn step_of(angle: f64, panel: &Panel) -> f64 {
    match law::least(Profile::Smooth, angle, panel.able) {
        Some(least) if least > 0.0 => (least / STEP_GRAIN).ceil() * STEP_GRAIN,
        _ => STEP_FREE,
    }
}
