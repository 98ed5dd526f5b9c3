//! The validation of plans: the conditions under which the judge, and everyone else, may index without asking.
//!
//! [`validate`] checks what a reader must know: every index is within its list, times are in order, joints do not
//! jump. [`check`] checks in addition that all numbers are finite and in their ranges: then a plan can be judged.
//! The quality of the motion is for the judge. Rules of one family of bodies stand in that family's folder, through
//! [`Body`](super::Body).

mod program;
mod serialisable;

pub use serialisable::Unwritable;
pub(super) use serialisable::check_serialisable;

use super::fault::{PlanFault, need, need_ascending, need_bounded, need_finite, need_index};
use super::motion_plan::Plan;
use super::slope::SLOPE_RISE_MAX;
use super::time::DURATION_MAX;
use super::visit::Graph;
use super::world::{Ground, World};
use crate::robot::validation::{QUANTITY_MAX, check_library};

/// Checks that a plan is well formed: that its indices are within their lists and its times in order, that the body
/// keeps the rules of its family, that bound and value of the provenance make sense, and that the library is as sound
/// as one that a program declares. A reader of plan files makes the same checks. That numbers are finite and in their
/// ranges is left to [`check`].
///
/// # Errors
/// The first [`PlanFault`] that was found.
pub fn validate(plan: &Plan) -> Result<(), PlanFault> {
    check_library(&plan.library).map_err(PlanFault::Library)?;
    plan.provenance.check()?;
    let duration = plan.body.duration();
    let in_range = duration.is_finite() && (0.0..=DURATION_MAX).contains(&duration);
    need(in_range, || PlanFault::Duration { duration })?;
    let causes = plan.causes.len();
    plan.body.validate(&plan.library, causes)?;
    if let Some(tracks) = plan.body.tracks() {
        let names = program::Names::of(&tracks.robot, causes);
        plan.exemptions.iter().try_for_each(|exemption| names.exemption(&exemption.kind))?;
        plan.paths.iter().try_for_each(|path| names.path(path))?;
        if let Some(program) = &plan.program {
            names.nodes(&Graph::of(&program.root))?;
        }
    }
    for exemption in &plan.exemptions {
        need_index(exemption.cause.0 as usize, causes, "cause")?;
        need(exemption.from <= exemption.to, || PlanFault::ExemptionOrder)?;
    }
    need(plan.paths.is_empty() || plan.body.tracks().is_some(), || PlanFault::PathFamily)?;
    let starts: Vec<f64> = plan.worlds.iter().map(|w| w.from).collect();
    need(starts.first() == Some(&0.0), || PlanFault::FirstWorld)?;
    need_ascending(&starts, "the worlds")
}

/// Checks that a plan can be judged: all that [`validate`] checks, and that every number is finite and in its range,
/// those of the settings and worlds included.
///
/// # Errors
/// The first [`PlanFault`] that was found.
pub fn check(plan: &Plan) -> Result<(), PlanFault> {
    // Each check may rely on those before it.
    numbers(plan)?;
    validate(plan)?;
    options(plan)?;
    plan.body.check_ranges(&plan.library)
}

/// Refuses numbers that are not finite.
fn numbers(plan: &Plan) -> Result<(), PlanFault> {
    need_finite("the library", &*plan.library)?;
    need_finite("the settings", &plan.settings)?;
    need_finite("the worlds", &plan.worlds)?;
    need_finite("the exemptions", &plan.exemptions)?;
    need_finite("the paths", &plan.paths)?;
    plan.body.check_numbers()
}

/// Checks the slope of the ground in a world; `has_base`: true for a robot of modules.
fn slope(world: &World, has_base: bool) -> Result<(), PlanFault> {
    if !world.is_sloped() {
        return Ok(());
    }
    let rise = world.rise();
    need(rise <= SLOPE_RISE_MAX, || PlanFault::SlopeTooSteep { rise })?;
    let settles = world.ground == Ground::Settle && world.gravity > 0.0;
    need(has_base && settles, || PlanFault::SlopeUnsettled)
}

/// Checks the settings of the judge, and the worlds.
fn options(plan: &Plan) -> Result<(), PlanFault> {
    let settings = &plan.settings;
    need(settings.sample > 0.0, || PlanFault::SampleInterval { interval: settings.sample })?;
    need(settings.unstable_for >= 0.0, || PlanFault::UnstableFor)?;
    need((0.0..=1.0).contains(&settings.reserve), || PlanFault::Reserve { reserve: settings.reserve })?;
    need(settings.slip_max.is_none_or(|slip| slip >= 0.0), || PlanFault::SlipMax)?;
    need((0.0..=1.0).contains(&settings.slip), || PlanFault::Slip { slip: settings.slip })?;
    need(settings.samples_max >= 1, || PlanFault::NoSamples)?;
    need_bounded(settings.sample, DURATION_MAX, "the time between samples")?;
    need_bounded(settings.unstable_for, DURATION_MAX, "`unstable_for`")?;
    let has_base = plan.body.tracks().is_some();
    plan.worlds.iter().try_for_each(|w| {
        need(has_base || w.world.ground != Ground::Held, || PlanFault::NoBaseToHold)?;
        need(w.world.gravity >= 0.0, || PlanFault::Gravity)?;
        need_bounded(w.world.gravity, QUANTITY_MAX, "gravity")?;
        need(w.world.friction >= 0.0, || PlanFault::Friction)?;
        need_bounded(w.world.friction, QUANTITY_MAX, "friction")?;
        slope(&w.world, has_base)
    })?;
    let same = plan.worlds.windows(2).all(|pair| pair[0].world.slope == pair[1].world.slope);
    need(same, || PlanFault::SlopeChanges)
}
