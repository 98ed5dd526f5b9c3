//! Plans of trusses for the tests of their judge: made by hand, of struts that are long, fast and strong.

pub use crate::support::verdicts::{failures_of as of, status};
use modl::optimize::random::SplitMix64;
use modl::plan::{
    Body, Cause, CauseId, Ground, Interpolation, Keyframe, Margins, NodePaths, Plan, Ramps, Settings,
    Surroundings, TrussLimits, Verdict, World, verify,
};
use modl::robot::{Library, Strut};
use std::sync::Arc;

pub type Place = [f64; 3];

/// Root of three quarters.
pub const HIGH: f64 = 0.866_025_403_784_438_6;
/// The corners of an equilateral triangle of side 1 on the ground.
pub const BASE: [Place; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, HIGH, 0.0]];
pub const TETRA: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
pub const GRAVITY: f64 = 9.80665;
pub const FREE: World = World::FREE;
pub const STANDING: World = World { gravity: GRAVITY, ground: Ground::Settle, ..World::FREE };

/// The rounds of a random test that end in the one way or in the other.
#[derive(Default)]
pub struct Tally {
    pub yes: usize,
    pub no: usize,
}

impl Tally {
    /// Counts a round; one whose end is too near to tell is `None`.
    pub fn count(&mut self, end: Option<bool>) {
        self.yes += usize::from(end == Some(true));
        self.no += usize::from(end == Some(false));
    }
}

/// Returns the tetrahedron on [`BASE`] whose fourth node is there.
pub fn tetra(top: Place) -> Vec<Place> {
    [&BASE[..], &[top]].concat()
}

/// Returns the keyframe at a time, in s, to which all nodes go straight, with ramps up and down.
pub fn ramped(time: f64, (up, down): (f64, f64), nodes: &[Place]) -> Keyframe {
    let ramps = Ramps { up, down, ..Ramps::NONE };
    let (interpolation, margins) = (Interpolation::Linear, Margins::default());
    Keyframe { time, interpolation, ramps, nodes: nodes.to_vec(), cause: CauseId(0), margins }
}

/// Returns the same at a constant rate.
pub fn straight(time: f64, nodes: &[Place]) -> Keyframe {
    ramped(time, (0.0, 0.0), nodes)
}

/// Returns the keyframe to which the truss rolls over an edge.
pub fn roll(time: f64, edge: (usize, usize), angle: f64, nodes: &[Place]) -> Keyframe {
    Keyframe { interpolation: Interpolation::RigidRoll { edge, angle }, ..straight(time, nodes) }
}

/// Returns a plan in one world; the cause of each keyframe has the keyframe's index.
pub fn plan(world: World, struts: &[(usize, usize)], mut keyframes: Vec<Keyframe>) -> Plan {
    let causes = vec![Cause::planner_call(); keyframes.len()];
    keyframes.iter_mut().zip(0..).for_each(|(keyframe, index)| keyframe.cause = CauseId(index));
    let node_names = (0..keyframes[0].nodes.len()).map(|i| format!("n{i}")).collect();
    let body = Body::NodePaths(NodePaths {
        strut: 0,
        node_names,
        struts: struts.to_vec(),
        merged: Vec::new(),
        keyframes,
        events: Vec::new(),
        limits: TrussLimits::default(),
        surroundings: Surroundings::default(),
    });
    let kind = Strut {
        name: "Reel".into(),
        length: (0.01, 100.0),
        speed: 100.0,
        acceleration: None,
        force: 1e4,
        mass: 1.0,
        clearance: 0.1,
        buckling: None,
        node_mass: None,
    };
    let library = Arc::new(Library { struts: vec![kind], ..Library::default() });
    Plan { causes, ..Plan::bare(library, body, world, Settings::default()) }
}

/// Returns the plan with another kind of strut.
pub fn of_strut(mut plan: Plan, change: impl Fn(&mut Strut)) -> Plan {
    let mut library = Library::clone(&plan.library);
    change(&mut library.struts[0]);
    plan.library = Arc::new(library);
    plan
}

/// Returns the plan with other paths.
pub fn with(mut plan: Plan, change: impl Fn(&mut NodePaths)) -> Plan {
    let Body::NodePaths(paths) = &mut plan.body else { unreachable!("a truss's plan") };
    change(paths);
    plan
}

/// Returns the verdict on a plan that is well formed.
pub fn judged(plan: &Plan) -> Verdict {
    let verdict = verify::verify(plan);
    let sound = modl::plan::validation::check(plan);
    assert!(sound.is_ok(), "{:?}", sound.map_err(|fault| fault.to_string()));
    verdict
}

/// Returns random numbers between two.
pub fn dice(seed: u64) -> impl FnMut(f64, f64) -> f64 {
    let mut random = SplitMix64(seed);
    move |low, high| low + (high - low) * random.next_f64()
}

pub fn minus(a: Place, b: Place) -> Place {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Returns the point on the way from one to another.
pub fn between(a: Place, b: Place, part: f64) -> Place {
    std::array::from_fn(|k| a[k] * (1.0 - part) + b[k] * part)
}

pub fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: Place) -> f64 {
    dot(a, a).sqrt()
}

/// Returns the point turned about the line from `origin` along `axis` by an angle (Rodrigues).
pub fn turned(p: Place, (origin, axis): (Place, Place), angle: f64) -> Place {
    let long = norm(axis);
    let k = axis.map(|x| x / long);
    let v = minus(p, origin);
    let (sine, cosine) = libm::sincos(angle);
    let cross = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]];
    std::array::from_fn(|i| origin[i] + v[i] * cosine + cross[i] * sine + k[i] * dot(k, v) * (1.0 - cosine))
}
