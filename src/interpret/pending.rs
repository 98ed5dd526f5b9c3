//! pending right wing
use crate::geometry::Vec3;
use crate::plan::{Plan, Verdict};
use crate::robot::{Assembly, State};
pub fn verify(plan: &Plan) -> Verdict {
    Verdict { duration: plan.body.duration(), ..Verdict::default() }
}
pub fn footprint_of(_: &Assembly, _: &State) -> Vec<Vec3> {
    Vec::new()
}
