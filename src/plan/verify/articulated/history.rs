//! The rollout of a plan for those who draw or measure it. Nothing is judged here.

use super::base_path::BasePath;
use super::contact;
use super::decimated::Decimated;
use super::parted;
use super::rollout::roll_out;
use super::rollout_input::Rollout;
use super::sample::Sample;
use super::sampling;
use super::succession;
use super::tolerances::Tolerances;
use super::torque::LoadGauge;
use crate::geometry::pose::lean;
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::support_polygon::hull;
use crate::plan::{Body, Ground, Plan, Settings, validation};

/// The greatest number of moments of a history besides the last: of a rollout with more samples only every second,
/// fourth, ... is kept.
pub const MOMENTS_MAX: usize = 4096;

/// The stride of moments that have the loads of the joints, which take longer to compute.
const LOADS_EACH: usize = 8;

/// The greatest number of contact points that a moment holds: of more only every second, third, ... is kept.
pub const CONTACTS_MAX: usize = 128;

/// The robot at an instant of a rollout.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// The time from the start of the plan, s.
    pub time: f64,
    /// The world pose of the base module's body (`X_WB`), in metres.
    pub base: Pose,
    /// The centre of mass of the links connected with the base, in the world, m.
    pub centre: Vec3,
    /// The support polygon in the world, m: corners (x, y) of the convex hull of the contact points,
    /// counter-clockwise from above; fewer than three if the contacts span no area, none without weight and for a
    /// base that is held fixed.
    pub support: Vec<[f64; 2]>,
    /// The contact points, x and y in the world, m: at most [`CONTACTS_MAX`] of them.
    pub contacts: Vec<[f64; 2]>,
    /// The static stability margin, m: the distance of the centre of mass inside the support polygon (McGhee and
    /// Frank 1968), negative outside; `None` if the polygon has no area.
    pub margin: Option<f64>,
    /// True if the robot has lost its support and the base is held for the time that `unstable_for` of the settings
    /// allows.
    pub held: bool,
    /// The ratio of load to limit of each joint that states one, with the ground's forces spread evenly, as (number of
    /// the joint as in its `JointId`, ratio). The judge may find better forces. Empty at most moments.
    pub loads: Vec<(usize, f64)>,
}

/// Returns the moments of an articulated robot's plan, in order of time, from the start to `until` (s) or the end of
/// the plan: at samples of the judge, thinned out evenly to at most [`MOMENTS_MAX`], and the last. Empty for plans of
/// other families, and for plans that are not valid.
pub fn history(plan: &Plan, until: f64) -> Vec<Moment> {
    let tolerances = Tolerances::default();
    let mut moments = Decimated::new(MOMENTS_MAX);
    // The latest, where it was not kept.
    let mut last = None;
    let mut gauge = LoadGauge::default();
    visit(plan, until, &tolerances, &mut |sample, base| {
        let weighed = base.whole && moments.seen().is_multiple_of(moments.stride() * LOADS_EACH);
        if moments.next_is_kept() {
            let loads = if weighed { gauge.read(sample, &tolerances) } else { vec![] };
            moments.keep(Moment { loads, ..moment(sample, base.pose) });
            last = None;
        } else {
            last = Some(moment(sample, base.pose));
        }
    });
    let mut moments = moments.into_kept();
    moments.extend(last);
    moments
}

/// Returns the world pose of the base module's body (`X_WB`) at the last sample up to a time (s), as settling, travel
/// and tip-overs of the rollout have brought it there. `None` for plans of other families, and for plans that are not
/// valid.
pub fn base_at(plan: &Plan, time: f64) -> Option<Pose> {
    let mut base = None;
    visit(plan, time, &Tolerances::default(), &mut |_, now| base = Some(now.pose));
    base
}

/// Returns the world pose of the base module's body (`X_WB`) at a time (s), as [`base_at`] does, of one robot that stands on the ground
/// and has tipped by then: its base leans by more than [`Tolerances::tipped`] from how it stood at the start. Put down with that attitude
/// again, it would lie otherwise than the plan has left it. `None` where it has not tipped.
pub fn tipped_base(plan: &Plan, time: f64) -> Option<Pose> {
    if time <= 0.0 || plan.worlds.iter().any(|from| from.world.ground != Ground::Settle) {
        return None;
    }
    let tolerances = Tolerances::default();
    let (mut start, mut now) = (None, None);
    visit(plan, time, &tolerances, &mut |_, base| {
        start.get_or_insert(base.pose.rotation);
        now = base.whole.then_some(base.pose);
    });
    let (start, now) = start.zip(now)?;
    (lean(&(now.rotation * start.inverse())) > tolerances.tipped).then_some(now)
}

/// The base of a plan at a sample.
struct PlacedBase {
    /// The world pose of the base module's body, m.
    pose: Pose,
    /// True if the sample is one of the whole robot, whose joints have the plan's numbers.
    whole: bool,
}

/// Returns the settings under which a plan is rolled out to be seen: its own, or those with fewer samples where the judge would
/// refuse it for their number.
pub(super) fn settings_to_see(rollout: &Rollout) -> Settings {
    let (settings, tracks) = (rollout.settings, rollout.tracks);
    let least = tracks.duration / MOMENTS_MAX as f64;
    match sampling::count(&rollout.instants(), tracks, settings, rollout.tolerances) > settings.samples_max {
        true => Settings { sample: settings.sample.max(least), ..*settings },
        false => *settings,
    }
}

/// Rolls out a valid plan of an articulated robot; of several, the clusters to which the plan's base belongs are seen.
fn visit(plan: &Plan, until: f64, tolerances: &Tolerances, see: &mut dyn FnMut(&Sample, PlacedBase)) {
    let Body::Tracks(tracks) = &plan.body else { return };
    if validation::check(plan).is_err() {
        return;
    }
    let mut rollout = Rollout::of(plan, tracks, tolerances);
    let settings = settings_to_see(&rollout);
    rollout.settings = &settings;
    let Some(mut clusters) = parted::several(&rollout) else {
        roll_out(rollout, None, until.min(tracks.duration), &mut |sample, _| {
            see(sample, PlacedBase { pose: sample.stance.base_pose(sample.model), whole: true });
            true
        });
        return;
    };
    succession::follow(&rollout, &mut clusters, until, &mut |begun| {
        let mut path = BasePath::default();
        let own = begun.cluster().modules.binary_search(&tracks.robot.base).ok();
        let part = begun.rollout(&rollout);
        roll_out(part, None, until.min(part.tracks.duration), &mut |sample, _| {
            path.poses.push((sample.time, sample.stance.base_pose(sample.model)));
            if let Some(module) = own {
                let link = sample.model.kinematics.link(module, 0);
                see(sample, PlacedBase { pose: sample.stance.link_pose(link), whole: false });
            }
            true
        });
        path
    });
}

fn moment(sample: &Sample, base: Pose) -> Moment {
    let stance = sample.stance;
    let planar_pose = stance.planar_pose;
    let grounded = sample.world.gravity > 0.0 && sample.world.ground != Ground::Held;
    let (s, c) = libm::sincos(planar_pose.yaw);
    let touching =
        stance.contact_points.iter().filter(|contact_point| contact::counts(sample.model, contact_point));
    let points: Vec<[f64; 2]> = touching
        .filter(|_| grounded)
        .map(|t| match sample.world.is_sloped() {
            true => stance.world_point(&t.p).xy().into(),
            false => [planar_pose.x + c * t.p.x - s * t.p.y, planar_pose.y + s * t.p.x + c * t.p.y],
        })
        .collect();
    let margin = if grounded { stance.margin(sample.model).map(|m| m.distance) } else { None };
    Moment {
        time: sample.time,
        base,
        centre: stance.world_point(&Vec3::zeros()),
        support: hull(&points).into_iter().map(|i| points[i]).collect(),
        contacts: points.iter().step_by(points.len().div_ceil(CONTACTS_MAX).max(1)).copied().collect(),
        margin,
        held: stance.held,
        loads: vec![],
    }
}
