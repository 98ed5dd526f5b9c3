//! Dynamics of articulated robots along a plan: travel by the friction of loaded contacts, and the loads of joints,
//! bonds and contacts with inertia.
//!
//! The attitude of the robot from sample to sample is that of settling. Servos are the soft part of a robot and
//! contacts the stiff one: the loads of its contacts are those at which yielding servos and contacts are in equilibrium
//! with weight, inertia and friction ([`loads`], by way of [`elastic_tree`]); friction follows from the slip of the
//! contacts under the twist that friction balances ([`twist`]); loads and friction that belong together are the fixed
//! point of the two ([`equilibrium`]). [`traction`] follows the base with its planar momentum, and decides the travel;
//! [`rollout_loads`] judges the loads in motion, as means over 50 ms, or over less beside motions that are shorter than
//! 200 ms.
//!
//! [`in_time`] plays robots whose contacts scrub by rigid bodies: loads in motion decide where these go.
//!
//! Level axes are those of the stance's heading: z along the normal of the ground, and x and y turned about it from
//! those of the ground by the heading. On a slope gravity leans in them, and friction bears a part of the weight
//! ([`slide`]). A twist "at the centre of mass" has the velocity of the point of a link, extended as a rigid body, that
//! coincides with the robot's centre of mass, which itself may move against the link.

mod balance;
mod base_motions;
mod bursts;
mod deflection;
mod elastic_tree;
mod equilibrium;
mod in_time;
mod loads;
mod motors;
mod overload;
mod posed;
mod recorder;
mod rollout_loads;
mod slide;
mod slip_spread;
mod tolerances;
mod traction;
mod twist;
mod unrested;

pub(super) use deflection::DeflectedMotion;
pub(super) use in_time::{PlacedBase, bound_travel, judge_in_time};
pub(super) use recorder::Recorder;
pub(super) use rollout_loads::RolloutLoads;
pub(super) use slide::{failure as slide_failure, free_joint};
pub(super) use slip_spread::SlipSpread;
pub(super) use traction::{GroundStep, Traction, TravelSummary, soft_servos};
pub(super) use unrested::UnrestedSlip;
