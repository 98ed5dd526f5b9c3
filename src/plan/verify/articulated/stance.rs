//! The stance of a robot on the ground, and its change with a small change of posture.

use super::alignment::{height_keeping_turn, mass_alignment};
use super::contact::{self, ContactPatch, ContactPoint};
use super::minimum_power::{PlanarPose, along_ground, displacement};
use super::model::{Model, Posture};
use super::settle::{SettledAttitude, height, settle_on_slope};
use super::tolerances::Tolerances;
use crate::geometry::Mat3;
use crate::geometry::ground_features::Feature;
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::support_polygon::Margin;
use crate::plan::{Ground, World};
use nalgebra::{Rotation3, UnitQuaternion};

/// The state of a robot on the ground (or held over it) at a sample, with all that the next sample needs.
#[derive(Clone, Debug)]
pub struct Stance {
    /// The poses of the links in the frame of the base module's body.
    pub posture: Posture,
    /// The orientation of that frame in level axes: those of the ground, turned about its normal by the yaw of the planar
    /// pose. The frame of level ground is that of the world.
    pub R: Mat3,
    /// The height of the centre of mass above the plane z = 0 of the ground's frame, m.
    pub height: f64,
    /// The position of the centre of mass along the ground, m, and the heading, rad, in the ground's frame.
    pub planar_pose: PlanarPose,
    /// The features with the centre of mass at the origin, in level axes, in the order of [`Model::features`]; without
    /// a floor there may be none.
    pub features: Vec<Feature>,
    /// The points near the ground, with their normal forces; none without a floor.
    pub contact_points: Vec<ContactPoint>,
    /// The loaded contact points gathered by link.
    pub patches: Vec<ContactPatch>,
    /// True if the base is held because the support was lost.
    pub held: bool,
    /// The world that the robot is in: its floor, if any, how that slopes, and if it carries the weight of the robot, as
    /// the contact points have normal forces only then.
    world: World,
    /// The contact points before the base was held, each with the same load; empty otherwise.
    anchors: Vec<ContactPoint>,
}

/// The motion that a change of posture would cause, before it is decided if the robot tips over.
pub struct SettleAttempt {
    posture: Posture,
    /// The orientation of the base in level axes before the robot settles.
    R: Mat3,
    /// The features with that orientation, as in [`Stance::features`].
    features: Vec<Feature>,
    /// The height of the centre of mass with that orientation, the lowest point at the ground, m.
    height: f64,
    /// The attitude to which the robot settles from that orientation.
    rest: SettledAttitude,
    /// An upper bound on the motion of any point about the centre of mass, from the motion of the joints only, m.
    pub motion: f64,
    /// The fall of the centre of mass as the robot settles with the joints held, m.
    pub fall: f64,
}

/// The outcome of an attempt to follow a change of posture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepOutcome {
    /// The fall is within the tolerance `fall_floor`.
    Steady,
    /// The robot tips over: the fall is more than the motion can explain.
    TipOver,
    /// The fall is beyond the tolerance, but the motion can explain it: a shorter step has to decide.
    Undecided,
}

impl Placement {
    /// Returns the placement at the start of a robot that does not settle: lowered, unless its base is fixed in the world, or it
    /// is to stay as it is placed where there is no ground.
    pub(super) fn unsettled(world: &World, as_placed: bool) -> Placement {
        let stays = world.ground == Ground::Held || (as_placed && !world.has_floor());
        if stays { Placement::Fixed } else { Placement::Lowered }
    }
}

impl Stance {
    /// Returns (stance, fall, turn) of a robot placed in a world with the base at `X_WB`: kept there
    /// (`Placement::Fixed`), lowered to the ground with its orientation (`Placement::Lowered`), or lowered and then
    /// settled (`Placement::Settled`). The fall of the centre of mass in settling, m, and the angle of the turn, rad,
    /// are 0 unless it settles.
    pub fn start(
        model: &Model,
        posture: Posture,
        X_WB: &Pose,
        (world, placement): (&World, Placement),
        tolerances: &Tolerances,
    ) -> (Stance, f64, f64) {
        let X_GB = if world.is_sloped() { world.ground_pose().inverse() * X_WB } else { *X_WB };
        let R = *X_GB.rotation.to_rotation_matrix().matrix();
        let idle = placement == Placement::Fixed && !world.has_floor();
        let features = if idle { vec![] } else { model.placed(&posture, &R) };
        let up = height(&features, &Vec3::z());
        let c = X_GB.transform_point(&posture.centre.into());
        let planar_pose = PlanarPose { x: c.x, y: c.y, yaw: 0.0 };
        let level = match placement {
            Placement::Fixed => c.z,
            Placement::Settled | Placement::Lowered => up,
        };
        let mut stance = Stance {
            posture,
            R,
            height: level,
            planar_pose,
            features,
            contact_points: vec![],
            patches: vec![],
            held: false,
            world: *world,
            anchors: vec![],
        };
        if placement != Placement::Settled {
            stance.find_contacts(model, tolerances);
            return (stance, 0.0, 0.0);
        }
        // The attitude of rest near the drawn one.
        let rest = settle_on_slope(&stance.features, world.lean(0.0), tolerances);
        let turned =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rest.turn)).angle();
        stance.turn(&rest);
        // The base stays over the point where it was drawn, whatever the settling did.
        let drift = stance.pose_on_ground(model.base_link()).translation.vector - X_GB.translation.vector;
        stance.planar_pose.x -= drift.x;
        stance.planar_pose.y -= drift.y;
        stance.find_contacts(model, tolerances);
        (stance, rest.fall, turned)
    }

    /// Returns the effect of a change to `posture`: the robot is turned so that its masses move least
    /// (`mass_alignment`) and its loaded contacts keep their heights (`height_keeping_turn`), then settled with the
    /// joints held. While a robot is held, the contacts are those before it was. `model` must be that of this stance.
    pub fn attempt(&self, model: &Model, posture: Posture, tolerances: &Tolerances) -> SettleAttempt {
        let mut R = self.R * mass_alignment(model, &self.posture, &posture);
        let mut features = model.placed(&posture, &R);
        let contacts = if self.held { &self.anchors } else { &self.contact_points };
        let turn = height_keeping_turn(&features, contacts, tolerances);
        R = turn * R;
        features = features.iter().map(|f| f.placed(&turn, &Vec3::zeros())).collect();
        let moved = self.features.iter().zip(&features).map(|(a, b)| a.moved(b));
        // On a slope the place where the line of gravity meets the ground moves with the height, too.
        let spread = 1.0 + self.world.rise();
        let motion = moved.fold(0.0, f64::max) * (spread * spread);
        let up = height(&features, &Vec3::z());
        let rest = settle_on_slope(&features, self.world.lean(self.planar_pose.yaw), tolerances);
        SettleAttempt { posture, R, features, height: up, motion, fall: rest.fall, rest }
    }

    /// Returns the stance of the robot settled as attempted, at the same place.
    pub fn settled(&self, model: &Model, attempt: SettleAttempt, tolerances: &Tolerances) -> Stance {
        let rest = attempt.rest.clone();
        let mut next = self.lowered(attempt);
        next.held = false;
        next.anchors.clear();
        next.turn(&rest);
        next.find_contacts(model, tolerances);
        next
    }

    /// Returns (place, slips) of the robot once it is settled as `next`, by the minimum power principle (`displacement`): the
    /// place to which it moves, and for each loaded contact patch, those of this stance and of `next`, (number of its link,
    /// its slip in m, half for either stance, its load as a fraction of the weight).
    pub fn moved(&self, model: &Model, next: &Stance) -> (PlanarPose, Vec<(usize, f64, f64)>) {
        displacement(model, self, &next.posture, &next.R, next.height, &next.patches)
    }

    /// Returns the next stance after a loss of support: the robot in the posture and the unsettled attitude of
    /// `attempt`, not settled, at the same place, lowered so that its lowest point touches the ground, with `held` set.
    /// The contact points of this stance within the tolerance `gap_loaded` are kept, with equal loads, as those that
    /// later attempts follow; a robot already held keeps the ones from before.
    pub fn holding(&self, model: &Model, attempt: SettleAttempt, tolerances: &Tolerances) -> Stance {
        let mut next = self.lowered(attempt);
        if !self.held {
            // Loads say little where the centre of mass leaves the edge: all that stood there counts.
            let near = self.contact_points.iter().filter(|t| t.gap <= tolerances.gap_loaded);
            next.anchors = near.map(|t| ContactPoint { load: 1.0, ..*t }).collect();
        }
        next.held = true;
        next.find_contacts(model, tolerances);
        next
    }

    /// Returns the stance as it is, with `held` set: later attempts follow its contact points within the tolerance
    /// `gap_loaded`, with equal loads.
    pub fn held_here(self, tolerances: &Tolerances) -> Stance {
        let near = self.contact_points.iter().filter(|t| t.gap <= tolerances.gap_loaded);
        let anchors = near.map(|t| ContactPoint { load: 1.0, ..*t }).collect();
        Stance { held: true, anchors, ..self }
    }

    /// Changes the world under the robot, which stays as it is: with a floor its contact points are found, without one
    /// it has none.
    pub fn enter(&mut self, model: &Model, world: &World, tolerances: &Tolerances) {
        let before = std::mem::replace(&mut self.world, *world);
        if (world.has_floor(), world.floor_bears()) != (before.has_floor(), before.floor_bears()) {
            if world.has_floor() && !before.has_floor() {
                self.features = model.placed(&self.posture, &self.R);
            }
            self.find_contacts(model, tolerances);
        }
    }

    /// Returns the static stability margin in the support polygon of the contact points within the contact tolerances
    /// of their modules; `None` if these span no area.
    pub fn margin(&self, model: &Model) -> Option<Margin> {
        contact::margin(&self.contact_points, self.foot(), |contact_point| {
            contact::counts(model, contact_point)
        })
    }

    /// Returns the static stability margin in the support polygon of the contact points whose gap is at most the
    /// tolerance `gap_exact`; `None` if these span no area.
    pub fn margin_exact(&self, tolerances: &Tolerances) -> Option<Margin> {
        contact::margin(&self.contact_points, self.foot(), |contact_point| {
            contact_point.gap <= tolerances.gap_exact
        })
    }

    /// Returns the numbers of the links at the ends of the edge of support nearest to the centre of mass, one if they are the
    /// same; of all supporting links if the support has no area.
    pub fn edge(&self, tolerances: &Tolerances) -> Vec<usize> {
        let points = &self.contact_points;
        let near = |point: &ContactPoint| point.gap <= tolerances.gap_exact;
        let mut edge = match contact::margin(points, self.foot(), near) {
            Some(margin) => vec![points[margin.edge.0].link, points[margin.edge.1].link],
            None => points.iter().filter(|point| near(point)).map(|point| point.link).collect(),
        };
        edge.dedup();
        edge
    }

    /// Returns `X_WB`, the world pose of the base module's body, m.
    pub fn base_pose(&self, model: &Model) -> Pose {
        let link = model.base_link();
        self.link_pose(link)
    }

    /// Returns `X_WL`, the world pose of the link of this number, m. Panics if there is none.
    pub fn link_pose(&self, link: usize) -> Pose {
        let pose = self.pose_on_ground(link);
        if self.world.is_sloped() { self.world.ground_pose() * pose } else { pose }
    }

    /// Returns `X_GL`, the pose of the link of this number in the frame of the ground, m. Panics if there is none.
    pub fn pose_on_ground(&self, link: usize) -> Pose {
        let (s, c) = libm::sincos(self.planar_pose.yaw);
        let turned = Mat3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0) * self.R;
        let p = turned * (self.posture.p[link] - self.posture.centre)
            + Vec3::new(self.planar_pose.x, self.planar_pose.y, self.height);
        let R = turned * self.posture.R[link];
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(R));
        Pose::from_parts(p.into(), rotation)
    }

    /// Returns the stance of an attempt before it settles, at the same place, without contact points.
    fn lowered(&self, attempt: SettleAttempt) -> Stance {
        Stance {
            posture: attempt.posture,
            R: attempt.R,
            height: attempt.height,
            planar_pose: self.planar_pose,
            features: attempt.features,
            contact_points: vec![],
            patches: vec![],
            held: self.held,
            world: self.world,
            anchors: self.anchors.clone(),
        }
    }

    /// Turns the robot to the attitude to which it settled.
    fn turn(&mut self, rest: &SettledAttitude) {
        self.R = rest.turn * self.R;
        self.height = rest.height;
        for feature in &mut self.features {
            *feature = feature.placed(&rest.turn, &Vec3::zeros());
        }
    }

    /// Returns the position of the point at which the line of gravity through the centre of mass meets the ground, x and y
    /// from the centre of mass in level axes, m: zero on level ground.
    pub fn foot(&self) -> [f64; 2] {
        if self.world.is_sloped() {
            self.world.lean(self.planar_pose.yaw).map(|lean| lean * self.height)
        } else {
            [0.0, 0.0]
        }
    }

    /// Returns the unit vector along which gravity pulls, in level axes.
    pub fn down(&self) -> Vec3 {
        self.world.down(self.planar_pose.yaw)
    }

    /// Returns the unit vector against gravity, in level axes.
    pub fn up(&self) -> Vec3 {
        // Without negative zeros.
        Vec3::zeros() - self.down()
    }

    /// Returns the position in the world, m, of a point that is given from the centre of mass in level axes, m.
    pub fn world_point(&self, p: &Vec3) -> Vec3 {
        let pose = self.planar_pose;
        let point = along_ground(p, pose.yaw) + Vec3::new(pose.x, pose.y, self.height);
        if self.world.is_sloped() { self.world.ground_pose().rotation * point } else { point }
    }

    /// Returns in the world's axes a vector that is given in level axes.
    pub fn world_vector(&self, v: &Vec3) -> Vec3 {
        let turned = along_ground(v, self.planar_pose.yaw);
        if self.world.is_sloped() { self.world.ground_pose().rotation * turned } else { turned }
    }

    /// Finds contact points and patches anew; without a floor there are none.
    fn find_contacts(&mut self, model: &Model, tolerances: &Tolerances) {
        self.contact_points.clear();
        if self.world.has_floor() {
            let foot = self.world.floor_bears().then(|| self.foot());
            self.contact_points =
                contact::contact_points(model, &self.features, self.height, foot, tolerances);
        }
        self.patches = contact::patches(&self.contact_points);
    }
}

/// The way in which a robot is placed in a world at a given pose of its base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// The robot is lowered until it touches the ground, with its orientation, and settles.
    Settled,
    /// The robot is lowered until it touches the ground, with its orientation.
    Lowered,
    /// The base keeps the pose.
    Fixed,
}

impl SettleAttempt {
    /// Returns the outcome: steady, tipped over, or undecided, so that a shorter step must decide. If the points of
    /// the robot move by `motion`, following a minimum of the height lets the centre of mass fall by at most twice
    /// that: a greater fall shows that the minimum vanished.
    pub fn outcome(&self, tolerances: &Tolerances) -> StepOutcome {
        if self.fall <= tolerances.fall_floor {
            StepOutcome::Steady
        } else if self.fall > 2.0 * self.motion {
            StepOutcome::TipOver
        } else {
            StepOutcome::Undecided
        }
    }
}
