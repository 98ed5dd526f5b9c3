//! The support polygon of a robot at rest.

use super::contact;
use super::rollout::roll_out;
use super::rollout_input::Rollout;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::plan::verify::support_polygon::hull;
use crate::plan::{Settings, Tracks, World, WorldFrom};
use crate::robot::{Assembly, State};

/// Returns the corners of the support polygon, the convex hull of the contact points (McGhee and Frank 1968), of a
/// robot that rests on level ground under standard gravity, counter-clockwise from above, in the frame of the base
/// module's body as it rests, m. Fewer than three if the contacts span no area. The state must be valid, or it
/// panics.
pub fn area(robot: &Assembly, state: &State) -> Vec<Vec3> {
    let tracks = Tracks::at_rest(robot.clone(), state.clone());
    let rollout = Rollout {
        tracks: &tracks,
        worlds: &[WorldFrom { from: 0.0, world: World::default() }],
        exemptions: &[],
        settings: &Settings::default(),
        tolerances: &Tolerances::default(),
        held: None,
        begin: None,
        end: 0.0,
        subject: "the robot",
        as_placed: false,
        floats: false,
    };
    let mut corners = Vec::new();
    roll_out(rollout, None, 0.0, &mut |sample, _| {
        let stance = sample.stance;
        let touching =
            stance.contact_points.iter().filter(|contact_point| contact::counts(sample.model, contact_point));
        // The heading is zero at the start, so the levelled frame is the world's but for its origin.
        let points: Vec<_> =
            touching.map(|t| [stance.planar_pose.x + t.p.x, stance.planar_pose.y + t.p.y]).collect();
        let X_BW = stance.base_pose(sample.model).inverse();
        let on_ground = |i: usize| X_BW.transform_point(&[points[i][0], points[i][1], 0.0].into()).coords;
        corners = hull(&points).into_iter().map(on_ground).collect();
        false
    });
    corners
}
