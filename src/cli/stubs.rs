//! Stands in for rooms that are not built yet.

use crate::plan::{Plan, Verdict};

pub fn read_plan(_: &[u8]) -> Result<Plan, String> {
    Err("plan files can't be read yet".to_owned())
}

pub fn verify(_: &Plan) -> Verdict {
    Verdict::default()
}
