//! What a plan's robot is like on its way: the walk that the judge takes, told to whoever draws or
//! measures it. Nothing is judged here.

use super::collision;
use super::footprint::hull;
use super::torque::Gauge;
use super::walk::{Course, Sample, walk};
use super::{Precision, Tolerances, contact};
use crate::geometry::{Pose, Vec3};
use crate::plan::{Body, Plan, Tracks, sound};

/// Moments of one history; of a longer walk every second, fourth, ... is kept.
pub const MOMENTS_MAX: usize = 4096;

/// Of so many moments one tells the loads of the joints, which take longer to find.
const LOADS_EACH: usize = 8;

/// Pairs of modules that are looked at for one curve of clearances, at most.
const PAIRS_MAX: usize = 60_000;

/// The robot at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Seconds.
    pub time: f64,
    /// World pose of the base module's body (`X_WB`).
    pub base: Pose,
    /// Centre of mass of what hangs on the base, in the world, m.
    pub centre: Vec3,
    /// Corners of the hull of what touches the ground, counter-clockwise from above, world, m; fewer
    /// than three where the contacts span no area, none without a ground.
    pub support: Vec<[f64; 2]>,
    /// Distance of the centre of mass inside that hull, negative outside, m; `None` where it spans no
    /// area.
    pub margin: Option<f64>,
    /// Whether the support was lost and the base is held for the time that `unstable_for` allows.
    pub held: bool,
    /// Load by limit of each joint that states one, with the ground's forces spread evenly: (joint,
    /// ratio). The judge may know better forces. Empty at most moments.
    pub loads: Vec<(usize, f64)>,
}

/// The moments of an articulated robot's plan, in order of time, from the start to `until` (s).
/// Empty for plans of other families, and for plans that mean nothing.
pub fn history(plan: &Plan, until: f64) -> Vec<Moment> {
    let Body::Tracks(tracks) = &plan.body else { return vec![] };
    if !sound::faults(plan).is_empty() {
        return vec![];
    }
    let course = Course {
        tracks,
        worlds: &plan.worlds,
        exemptions: &plan.exemptions,
        settings: &plan.settings,
        tolerances: &Tolerances::default(),
        held: None,
    };
    let mut kept = Kept { moments: vec![], stride: 1, seen: 0, last: None };
    let mut gauge = Gauge::default();
    walk(course, None, until.min(tracks.duration), &mut |sample, _| {
        let loads = || gauge.read(sample, course.tolerances);
        kept.see(sample, loads);
        true
    });
    kept.moments.extend(kept.last);
    kept.moments
}

/// Moments at even numbers of samples, however many there are, and the last.
struct Kept {
    moments: Vec<Moment>,
    /// One in so many samples is kept.
    stride: usize,
    seen: usize,
    /// The latest, where it was not kept.
    last: Option<Moment>,
}

impl Kept {
    fn see(&mut self, sample: &Sample, loads: impl FnOnce() -> Vec<(usize, f64)>) {
        let turn = self.seen.is_multiple_of(self.stride);
        let weighed = self.seen.is_multiple_of(self.stride * LOADS_EACH);
        self.seen += 1;
        if !turn {
            self.last = Some(moment(sample));
            return;
        }
        if self.moments.len() == MOMENTS_MAX {
            let mut odd = false;
            self.moments.retain(|_| {
                odd = !odd;
                odd
            });
            self.stride *= 2;
        }
        let loads = if weighed { loads() } else { vec![] };
        self.moments.push(Moment { loads, ..moment(sample) });
        self.last = None;
    }
}

fn moment(sample: &Sample) -> Moment {
    let stance = sample.stance;
    let place = stance.place;
    let grounded = sample.world.gravity > 0.0;
    let (s, c) = libm::sincos(place.yaw);
    let touching = stance.touches.iter().filter(|touch| contact::counts(sample.model, touch));
    let points: Vec<[f64; 2]> = touching
        .filter(|_| grounded)
        .map(|t| [place.x + c * t.p.x - s * t.p.y, place.y + s * t.p.x + c * t.p.y])
        .collect();
    let margin = if grounded { stance.margin(sample.model).map(|m| m.distance) } else { None };
    Moment {
        time: sample.time,
        base: stance.base_pose(sample.model),
        centre: Vec3::new(place.x, place.y, stance.height),
        support: hull(&points).into_iter().map(|i| points[i]).collect(),
        margin,
        held: stance.held,
        loads: vec![],
    }
}

/// Least signed distance of links that may not touch, m, at evenly spaced times: (time, distance).
/// At most `count` of them, fewer for robots of many modules, none where that would take long or the
/// robot has no two such links.
pub fn clearances(plan: &Plan, until: f64, count: usize) -> Vec<(f64, f64)> {
    let Body::Tracks(tracks) = &plan.body else { return vec![] };
    let modules = tracks.robot.modules.len();
    let count = count.min(PAIRS_MAX / (modules * modules).max(1));
    if count < 2 || until <= 0.0 || !sound::faults(plan).is_empty() {
        return vec![];
    }
    let at = |i: usize| {
        let time = until * i as f64 / count as f64;
        // A plan of one instant: what the judge measures of it is its clearance there.
        let instant = Tracks {
            start: tracks.state(time),
            tracks: vec![],
            docks: vec![],
            duration: 0.0,
            ..tracks.clone()
        };
        let found = collision::judge(&instant, &plan.settings, &[], &Precision::default()).ok()?;
        Some((time, found.clearance?.value))
    };
    (0..=count).filter_map(at).collect()
}
