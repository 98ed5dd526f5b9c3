//! An adversary of the judge: an evolution strategy looks for behaviours of two to four modules that the judge passes and that
//! are as deep in each other, as heavily loaded or as near to falling over as it can find. The tests measure them by kinematics
//! and statics of their own (`support::recount`): nothing that passes may be beyond what the judge states. The few cases of the
//! gate are the first of the many of `MODL_WHOLE=1`.
#![allow(non_snake_case)]

use crate::support::motions::{Motion, STATICS};
use crate::support::numbers::Numbers;
use crate::support::properties::whole;
use crate::support::recount::{Poses, Robot};
use crate::support::robots::{self, Design, FRONT, TILT};
use modl::geometry::distance::distance_of_solids;
use modl::geometry::{Placed, Pose, Shape, Solid, Vec3};
use modl::plan::verify::articulated::{Precision, history};
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Ground, Plan, World};
use modl::robot::{Assembly, Library};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Behaviours that a search tries: in the gate and with `MODL_WHOLE=1`, where all three together try 100,000.
struct Tries(usize, usize);

const IN_COLLISION: Tries = Tries(360, 60_000);
const UNDER_LOAD: Tries = Tries(900, 35_000);
/// The ground takes the judge a hundred times as long.
const ON_GROUND: Tries = Tries(12, 5_000);

impl Tries {
    fn count(&self) -> usize {
        if whole() { self.1 } else { self.0 }
    }
}

/// Behaviours from one start until the search begins anew.
const CLIMB: usize = 60;

/// The duration of a behaviour, s.
const DURATION: f64 = 2.0;

/// Instants at which a behaviour is measured, and those about the worst of them, by which it is measured again.
const COARSE: usize = 32;
const FINE: usize = 16;

/// A robot, and a behaviour by numbers from -1 to 1: for tilt and front of each module the positions at the start, in the
/// middle and at the end.
struct Candidate {
    robot: Assembly,
    genes: Vec<f64>,
}

/// Joints that the search moves, of each module, with the positions that 1 stands for, rad.
const MOVED: [(usize, f64); 2] = [(TILT, FRAC_PI_2), (FRONT, PI)];

impl Candidate {
    /// Returns two to four modules that are bonded at random to a tree, and a random behaviour of them.
    fn random(n: &mut Numbers, library: &Arc<Library>) -> Candidate {
        let count = 2 + n.below(3);
        let mut design = Design::new("Random", library.clone());
        let mut free: Vec<(usize, usize)> = Vec::new();
        for module in 0..count {
            design.add(&format!("m{module}"));
            let mut own: Vec<(usize, usize)> = (0..4).map(|port| (module, port)).collect();
            if module > 0 {
                let to = free.swap_remove(n.below(free.len()));
                let from = own.swap_remove(n.below(4));
                design.connect(to, from, n.below(4) as u32);
            }
            free.extend(own);
        }
        let genes = (0..count * MOVED.len() * 3).map(|_| n.between(-1.0, 1.0)).collect();
        Candidate { robot: design.based("m0"), genes }
    }

    /// Returns a neighbour: some numbers moved by up to `step`.
    fn moved(&self, n: &mut Numbers, step: f64) -> Candidate {
        let mut genes = self.genes.clone();
        let share = [0.1, 0.3, 1.0][n.below(3)];
        let chosen = n.below(genes.len());
        for (at, gene) in genes.iter_mut().enumerate() {
            if at == chosen || n.next() < share {
                *gene = (*gene + n.between(-step, step)).clamp(-1.0, 1.0);
            }
        }
        Candidate { robot: self.robot.clone(), genes }
    }

    fn plan(&self, world: World) -> Plan {
        let mut motion = Motion::new(self.robot.clone());
        for (at, q) in self.genes.chunks(3).enumerate() {
            let (joint, most) = MOVED[at % MOVED.len()];
            let joint = 4 * (at / MOVED.len()) + joint;
            let q: Vec<f64> = q.iter().map(|gene| gene * most).collect();
            motion.tracks.start.joints[joint] = q[0];
            for (from, to, start) in [(q[0], q[1], 0.0), (q[1], q[2], DURATION / 2.0)] {
                let control = vec![from, from, from, to, to, to];
                motion = motion.segment(joint, start, start + DURATION / 2.0, control);
            }
        }
        motion.plan(world)
    }
}

/// Climbs from random starts with modules of a library. `worth` returns how bad a behaviour is that the judge passes, and `None` for others. Returns the
/// worst, and the number of behaviours that passed.
fn climb(
    seed: u64,
    tries: &Tries,
    library: &Arc<Library>,
    worth: impl Fn(&Candidate) -> Option<f64>,
) -> (f64, usize) {
    let mut n = Numbers(seed);
    let (mut worst, mut passed, mut tried) = (f64::NEG_INFINITY, 0, 0);
    while tried < tries.count() {
        let (mut best, mut value, mut step) = (Candidate::random(&mut n, library), f64::NEG_INFINITY, 0.5);
        for _ in 0..CLIMB.min(tries.count() - tried) {
            let next =
                if value.is_finite() { best.moved(&mut n, step) } else { Candidate::random(&mut n, library) };
            tried += 1;
            let found = worth(&next);
            passed += usize::from(found.is_some());
            // The rule of one success in five, by factors that keep the step there.
            if found.is_some_and(|found| found >= value) {
                (best, value) = (next, found.expect("it passed"));
                step = (step * 1.5_f64).min(1.0);
            } else {
                step = (step * 0.9_f64).max(1e-9);
            }
        }
        worst = worst.max(value);
    }
    (worst, passed)
}

/// Returns the greatest value over a behaviour: over even instants, and again about the greatest.
fn greatest(value: impl Fn(f64) -> f64) -> f64 {
    let (mut at, mut found) = (0.0, f64::NEG_INFINITY);
    let mut look = |t: f64, at: &mut f64| {
        let here = value(t);
        if here > found {
            (*at, found) = (t, here);
        }
    };
    (0..=COARSE).for_each(|k| look(DURATION * k as f64 / COARSE as f64, &mut at));
    let mut half = DURATION / COARSE as f64;
    for _ in 0..2 {
        let middle = at;
        for k in 0..=FINE {
            let t = middle - half + 2.0 * half * k as f64 / FINE as f64;
            look(t.clamp(0.0, DURATION), &mut at);
        }
        half *= 2.0 / FINE as f64;
    }
    found
}

/// Returns true if the judge finds none of a kind.
fn passes(plan: &Plan, kinds: &[CheckKind]) -> bool {
    verify(plan).failures.iter().all(|failure| !kinds.contains(&failure.kind))
}

fn robot(plan: &Plan) -> Robot<'_> {
    let Body::Tracks(tracks) = &plan.body else { unreachable!("a plan of modules") };
    Robot::new(plan, tracks)
}

fn assembly(plan: &Plan) -> &Assembly {
    let Body::Tracks(tracks) = &plan.body else { unreachable!("a plan of modules") };
    &tracks.robot
}

/// Returns the greatest depth of links of different modules in each other, m; negative where all are apart. Links that a bond
/// joins are left out: they touch.
fn depth(robot: &Assembly, solids: &[Solid], poses: &Poses) -> f64 {
    let link =
        |port: modl::robot::PortRef| (port.module, robot.module_type(port.module).ports[port.port].link);
    let joined = |a, b| {
        robot.bonds.iter().any(|bond| {
            let ends = (link(bond.a), link(bond.b));
            ends == (a, b) || ends == (b, a)
        })
    };
    let mut deepest = f64::NEG_INFINITY;
    for a in 0..robot.modules.len() {
        for b in a + 1..robot.modules.len() {
            for (i, p) in solids.iter().enumerate() {
                for (j, q) in solids.iter().enumerate().filter(|(j, _)| !joined((a, i), (b, *j))) {
                    let (X, Y) = (poses[a][i].expect("placed"), poses[b][j].expect("placed"));
                    let centres =
                        (X * nalgebra::Point3::from(p.centre)) - (Y * nalgebra::Point3::from(q.centre));
                    if centres.norm() - p.radius - q.radius < -deepest {
                        deepest = deepest.max(-distance_of_solids(p, &X, q, &Y));
                    }
                }
            }
        }
    }
    deepest
}

#[test]
fn no_behaviour_that_passes_is_deeper_in_itself_than_is_allowed() {
    let solids: Vec<Solid> =
        robots::smores().links.iter().map(|link| Solid::new(&link.collides).expect("sound")).collect();
    let (worst, passed) = climb(1, &IN_COLLISION, &robots::smores_library(), |candidate| {
        let plan = candidate.plan(World::FREE);
        passes(&plan, &[CheckKind::Collision, CheckKind::Form]).then(|| {
            let robot = robot(&plan);
            greatest(|t| depth(assembly(&plan), &solids, &robot.poses(t).0))
        })
    });
    println!("{passed} behaviours pass; the deepest by {:.3} µm", worst * 1e6);
    // What a module states as touching, and what the judge doesn't exclude beyond it.
    let allowed = robots::smores().touch + Precision::default().tol_depth;
    assert!(worst < allowed + 1e-9, "a behaviour passes that is {worst} m deep");
    assert!(passed > IN_COLLISION.count() / 20, "only {passed} behaviours pass");
    assert!(worst > -1e-3, "the search finds nothing near the limit: {worst}");
}

/// The modules with motors of a third of their torque, so that few of them are too heavy.
fn weak_library() -> Arc<Library> {
    let mut library = (*robots::smores_library()).clone();
    for joint in &mut library.modules[0].joints {
        joint.limits.effort = joint.limits.effort.map(|effort| effort / 3.0);
    }
    Arc::new(library)
}

#[test]
fn no_behaviour_that_passes_asks_for_more_torque_than_there_is() {
    let (worst, passed) = climb(2, &UNDER_LOAD, &weak_library(), |candidate| {
        let plan = candidate.plan(World { ground: Ground::Held, ..STATICS });
        passes(&plan, &[CheckKind::Torque, CheckKind::Form]).then(|| {
            let robot = robot(&plan);
            greatest(|t| {
                let (poses, carried) = robot.poses(t);
                let held = robot.held(t, &poses, &carried);
                held.iter().map(|(_, moment, effort)| moment / effort).fold(f64::NEG_INFINITY, f64::max)
            })
        })
    });
    println!("{passed} behaviours pass; the heaviest load is {worst} of the limit");
    assert!(worst < 1.0 + 1e-8, "a behaviour passes whose load is {worst} of the limit");
    assert!(passed > UNDER_LOAD.count() / 20, "only {passed} behaviours pass");
    assert!(worst > 0.9, "the search finds nothing near the limit: {worst}");
}

/// The gap up to which a point bears weight, m: the judge's, which is the usual tolerance of contacts.
const GAP: f64 = 1e-3;

/// Points of a link that may be lowest: corners of boxes, and many of the rims of cylinders.
fn rims(shapes: &[Placed]) -> Vec<Vec3> {
    let mut points = Vec::new();
    for placed in shapes {
        let own: Vec<Vec3> = match &placed.shape {
            Shape::Box { size } => (0..8)
                .map(|i| Vec3::from_fn(|k, _| size[k] * if i >> k & 1 == 0 { -0.5 } else { 0.5 }))
                .collect(),
            Shape::Cylinder { radius, length, axis } => {
                let axis = axis.normalize();
                let u = axis.cross(&Vec3::new(axis.y, axis.z, axis.x)).normalize();
                let v = axis.cross(&u);
                let rim = |k: usize| {
                    let (s, c) = libm::sincos(TAU * k as f64 / 256.0);
                    (u * c + v * s) * *radius
                };
                (0..256).flat_map(|k| [0.5, -0.5].map(|side| rim(k) + axis * (*length * side))).collect()
            }
            other => unreachable!("no link has {other:?}"),
        };
        points.extend(own.iter().map(|p| placed.pose.transform_point(&(*p).into()).coords));
    }
    points
}

/// Returns the distance of the centre of mass within the hull of all points that bear weight, m, negative outside, and the
/// height of the lowest point, m.
fn support(robot: &Assembly, rims: &[Vec<Vec3>], poses: &Poses) -> (f64, f64) {
    let (mut points, mut centre, mut mass) = (Vec::new(), Vec3::zeros(), 0.0);
    for (module, links) in poses.iter().enumerate() {
        for (link, pose) in links.iter().enumerate() {
            let pose: &Pose = pose.as_ref().expect("placed");
            points.extend(rims[link].iter().map(|p| pose.transform_point(&(*p).into()).coords));
            let declared = &robot.module_type(module).links[link];
            centre += pose.transform_point(&declared.com.into()).coords * declared.mass;
            mass += declared.mass;
        }
    }
    centre /= mass;
    let lowest = points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    points.retain(|p| p.z < lowest + GAP);
    let beyond = |k: usize| {
        let (s, c) = libm::sincos(TAU * k as f64 / 720.0);
        points.iter().map(|p| c * (p.x - centre.x) + s * (p.y - centre.y)).fold(f64::NEG_INFINITY, f64::max)
    };
    ((0..720).map(beyond).fold(f64::INFINITY, f64::min), lowest)
}

#[test]
fn no_behaviour_that_passes_stands_beyond_its_support() {
    let rims: Vec<Vec<Vec3>> = robots::smores().links.iter().map(|link| rims(&link.shape)).collect();
    let sunk = std::cell::Cell::new(0.0_f64);
    let (worst, passed) = climb(3, &ON_GROUND, &robots::smores_library(), |candidate| {
        let plan = candidate.plan(STATICS);
        passes(&plan, &[CheckKind::Stability, CheckKind::Form]).then(|| {
            let robot = robot(&plan);
            let moments = history(&plan, DURATION);
            let margins = moments.iter().step_by(moments.len().div_ceil(COARSE)).map(|moment| {
                let (poses, _) = robot.poses_from(moment.time, moment.base);
                let (margin, lowest) = support(assembly(&plan), &rims, &poses);
                sunk.set(sunk.get().max(lowest.abs()));
                margin
            });
            -margins.fold(f64::INFINITY, f64::min)
        })
    });
    println!(
        "{passed} behaviours pass; the least margin is {} m, the ground is off by {} m",
        -worst,
        sunk.get()
    );
    // Points of rims are up to 4 µm within their circles.
    assert!(worst < 1e-5, "a behaviour passes whose centre of mass is {worst} m beyond its support");
    assert!(sunk.get() < 1e-5, "a behaviour passes that is {} m off the ground", sunk.get());
    assert!(passed > ON_GROUND.count() / 20, "only {passed} behaviours pass");
    assert!(worst > -0.02, "the search finds nothing near the limit: {worst}");
}
