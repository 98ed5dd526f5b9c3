//! Ports that run along wide arcs and through their centres, and that turn far: deviations in closed form that lie between the
//! times at which a port is always looked at.

use super::stated_paths::{self, SLIDE_X, SLIDE_Y, TURN_Z, carrier, stating};
use crate::support::motions::Motion;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Pose, Vec3};
use modl::plan::{CauseId, Failure, StatedPath, Status};
use modl::robot::{Assembly, PortRef};
use std::sync::Arc;

/// The duration of a plan, s: one for each part between the times that are always looked at.
const DURATION: f64 = 64.0;

/// Returns a robot whose port two slides, along x and y, and a turn about z through it carry.
fn plotter() -> Assembly {
    let mut robot = carrier(10.0);
    Arc::make_mut(&mut robot.library).modules[0].ports[0].pose = Pose::identity();
    robot
}

/// Returns the path of the pen over the whole plan, from one pose over a place to another, within a distance (m).
fn path(start: Pose, via: Option<Vec3>, end: Pose, within: f64) -> StatedPath {
    let port = PortRef { module: 0, port: 0 };
    let (via, cause) = (via.map(Into::into), CauseId(0));
    StatedPath {
        port,
        module: 0,
        from: 0.0,
        to: DURATION,
        start,
        end,
        via,
        within,
        turned_within: None,
        cause,
    }
}

/// Returns what the judge finds of a path that the plan of a motion states.
fn judged(motion: &Motion, path: StatedPath) -> (Status, Option<Failure>) {
    let mut motion = motion.clone();
    motion.tracks.duration = DURATION;
    let within = path.within;
    stated_paths::judged(&stating(motion, path), within)
}

/// Asserts that a pen leaves its path by `worst` (m) and no more.
fn assert_leaves_by(motion: &Motion, worst: f64, stated: impl Fn(f64) -> StatedPath) {
    for part in [0.5, 0.7, 0.9] {
        let (status, failure) = judged(motion, stated(part * worst));
        let failure = failure.unwrap_or_else(|| panic!("{part} of {worst} m are too little"));
        assert_eq!(status, Status::Failed);
        assert!(failure.value > part * worst && failure.value < worst + 1e-9, "{} {worst}", failure.value);
    }
    assert_eq!(judged(motion, stated(1.01 * worst)), (Status::Proved, None));
}

/// Returns the places on a circle about the origin, at these angles.
fn on_circle(radius: f64, angles: [f64; 3]) -> [Vec3; 3] {
    angles.map(|angle| {
        let (s, c) = libm::sincos(angle);
        Vec3::new(radius * c, radius * s, 0.0)
    })
}

/// The corners of the polygon are the places at which the pen is always looked at; between them it leaves the circle by the
/// sagitta of a side, which is metres long.
#[test]
fn sides_of_a_large_polygon_leave_the_circle_around_it_by_the_sagitta() {
    let (radius, step) = (9.5, 0.3);
    let mut motion = Motion::new(plotter());
    motion.tracks.start.joints[SLIDE_X] = radius;
    let mut from = Vec3::x() * radius;
    for k in 0..64 {
        let [_, to, _] = on_circle(radius, [0.0, step * f64::from(k + 1), 0.0]);
        let (start, end) = (f64::from(k), f64::from(k + 1));
        motion = motion.segment(SLIDE_X, start, end, vec![from.x, to.x]);
        motion = motion.segment(SLIDE_Y, start, end, vec![from.y, to.y]);
        from = to;
    }
    let [a, b, c] = on_circle(radius, [0.1, 1.1, 2.5]);
    let sagitta = radius * (1.0 - libm::cos(step / 2.0));
    assert_leaves_by(&motion, sagitta, |within| path(shifted(a), Some(b), shifted(c), within));
}

/// The pen rests on the circle, crosses it along a diameter between two looks, and rests on the other side.
#[test]
fn a_diameter_leaves_its_circle_by_the_radius() {
    let radius = 0.8;
    let mut motion = Motion::new(plotter()).segment(SLIDE_X, 10.0, 11.0, vec![radius, -radius]);
    motion.tracks.start.joints[SLIDE_X] = radius;
    let [a, b, c] = on_circle(radius, [0.1, 1.1, 2.5]);
    assert_leaves_by(&motion, radius, |within| path(shifted(a), Some(b), shifted(c), within));
}

/// The pen turns as far as the path does, which is nearly half a turn, to either side, and is at no angle from it.
#[test]
fn a_turn_of_nearly_half_a_circle_is_followed_to_its_end() {
    for whole in [2.6, -2.6, 3.0, -3.0] {
        let motion = Motion::new(plotter()).segment(TURN_Z, 0.0, DURATION, vec![0.0, whole]);
        let stated = |turn: f64| StatedPath {
            turned_within: Some(0.01),
            ..path(Pose::identity(), None, turned(Vec3::z(), turn), 1.0)
        };
        assert_eq!(judged(&motion, stated(whole)), (Status::Sampled(65), None));
        // Turned on beyond the last orientation.
        let failure = judged(&motion, stated(0.5 * whole)).1.expect("it turns on");
        assert!((failure.value - 0.5 * whole.abs()).abs() < 1e-6, "{} of {whole}", failure.value);
    }
}
