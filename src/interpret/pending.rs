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
pub fn reverse(plan: &Plan) -> Plan {
    plan.clone()
}
pub fn slice(plan: &Plan, _: f64, _: f64) -> Result<Plan, String> {
    Ok(plan.clone())
}
pub fn write(_: &Plan) -> Vec<u8> {
    Vec::new()
}
