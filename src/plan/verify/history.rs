//! What a plan's robot is like on its way: the walk that the judge takes, told to whoever draws or
//! measures it. Nothing is judged here.

use super::footprint::hull;
use super::walk::{Course, Sample, walk};
use super::{Tolerances, contact};
use crate::geometry::{Pose, Vec3};
use crate::plan::{Body, Plan, sound};

/// Moments of one history; of a longer walk every second, fourth, ... is kept.
pub const MOMENTS_MAX: usize = 4096;

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
    walk(course, None, until.min(tracks.duration), &mut |sample, _| {
        kept.see(sample);
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
    fn see(&mut self, sample: &Sample) {
        let turn = self.seen.is_multiple_of(self.stride);
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
        self.moments.push(moment(sample));
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
    }
}
