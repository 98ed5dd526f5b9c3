//! Parts of a verdict: the status and the failures of one check.

use modl::plan::{CheckKind, Failure, Status, Verdict};

/// Returns the status of a check, which must have been made.
#[track_caller]
pub fn status(verdict: &Verdict, kind: CheckKind) -> Status {
    verdict.checks.iter().find(|check| check.kind == kind).expect("the check was made").status.clone()
}

/// Returns the failures of a check.
pub fn failures_of(kind: CheckKind, verdict: &Verdict) -> Vec<Failure> {
    verdict.failures.iter().filter(|failure| failure.kind == kind).cloned().collect()
}
