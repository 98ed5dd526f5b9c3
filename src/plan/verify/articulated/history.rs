//! The rollout of a plan for those who draw or measure it. Nothing is judged here.

use super::contact;
use super::decimated::Decimated;
use super::rollout::{Rollout, Sample, roll_out};
use super::tolerances::Tolerances;
use super::torque::LoadGauge;
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::support_polygon::hull;
use crate::plan::{Body, Ground, Plan, validation};

/// The greatest number of moments of a history; of a longer rollout every second, fourth, ... is kept.
pub const MOMENTS_MAX: usize = 4096;

/// The stride of moments that have the loads of the joints, which take longer to find.
const LOADS_EACH: usize = 8;

/// The greatest number of contact points of a moment; of more every second, third, ... is kept.
pub const CONTACTS_MAX: usize = 128;

/// The robot at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// The time, s.
    pub time: f64,
    /// World pose of the base module's body (`X_WB`).
    pub base: Pose,
    /// The centre of mass of the links connected with the base, in the world, m.
    pub centre: Vec3,
    /// Corners of the hull of what touches the ground, counter-clockwise from above, world, m; fewer
    /// than three where the contacts span no area, none without a ground.
    pub support: Vec<[f64; 2]>,
    /// Points that touch the ground, world, m: at most [`CONTACTS_MAX`] of them.
    pub contacts: Vec<[f64; 2]>,
    /// Distance of the centre of mass inside that hull, negative outside, m; `None` where it spans no
    /// area.
    pub margin: Option<f64>,
    /// True if the support was lost and the base is held for the time that `unstable_for` allows.
    pub held: bool,
    /// Load by limit of each joint that states one, with the ground's forces spread evenly: (joint,
    /// ratio). The judge may know better forces. Empty at most moments.
    pub loads: Vec<(usize, f64)>,
}

/// Returns the moments of an articulated robot's plan, in order of time, from the start to `until` (s).
/// Empty for plans of other families, and for plans that mean nothing.
pub fn history(plan: &Plan, until: f64) -> Vec<Moment> {
    let tolerances = Tolerances::default();
    let mut moments = Decimated::new(MOMENTS_MAX);
    // The latest, where it was not kept.
    let mut last = None;
    let mut gauge = LoadGauge::default();
    visit(plan, until, &tolerances, &mut |sample| {
        let weighed = moments.seen().is_multiple_of(moments.stride() * LOADS_EACH);
        if moments.next_is_kept() {
            let loads = if weighed { gauge.read(sample, &tolerances) } else { vec![] };
            moments.keep(Moment { loads, ..moment(sample) });
            last = None;
        } else {
            last = Some(moment(sample));
        }
    });
    let mut moments = moments.into_kept();
    moments.extend(last);
    moments
}

/// Returns the world pose of the base module's body (`X_WB`) at a time (s): where standing, rolling and tipping have
/// brought it by then. `None` for plans that have no such body, or that mean nothing.
pub fn base_at(plan: &Plan, time: f64) -> Option<Pose> {
    let mut base = None;
    visit(plan, time, &Tolerances::default(), &mut |sample| {
        base = Some(sample.stance.base_pose(sample.model));
    });
    base
}

/// Rolls out a valid plan of an articulated robot.
fn visit(plan: &Plan, until: f64, tolerances: &Tolerances, see: &mut dyn FnMut(&Sample)) {
    let Body::Tracks(tracks) = &plan.body else { return };
    if validation::check(plan).is_err() {
        return;
    }
    let rollout = Rollout {
        tracks,
        worlds: &plan.worlds,
        exemptions: &plan.exemptions,
        settings: &plan.settings,
        tolerances,
        held: None,
    };
    roll_out(rollout, None, until.min(tracks.duration), &mut |sample, _| {
        see(sample);
        true
    });
}

fn moment(sample: &Sample) -> Moment {
    let stance = sample.stance;
    let place = stance.place;
    let grounded = sample.world.gravity > 0.0 && sample.world.ground != Ground::Held;
    let (s, c) = libm::sincos(place.yaw);
    let touching =
        stance.contact_points.iter().filter(|contact_point| contact::counts(sample.model, contact_point));
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
        contacts: points.iter().step_by(points.len().div_ceil(CONTACTS_MAX).max(1)).copied().collect(),
        margin,
        held: stance.held,
        loads: vec![],
    }
}
