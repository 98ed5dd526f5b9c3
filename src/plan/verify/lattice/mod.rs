//! The judgement of lattices, whose plans are stages, in exact integers: nothing is rounded or sampled.
//!
//! In a stage all cells move on straight lines under one time scaling, so the configurations at its two ends
//! determine it. The arithmetic is that of [`crate::plan::lattice`]; here its results are held against the
//! limits of the plan and of the cell. The checks, by the names of `docs/planners/squeeze.md`, are made for
//! each stage in this order: K7 rest at both ends of the plan and continuous velocities between stages, K1
//! sizes, K4 accelerations, K6 rates of sizes, F1 the centre of mass stays, or the fixed cells do, F3 no angular
//! momentum (balanced plans), K2 no overlap of cells with each other and with obstacles, K5 speeds in contact, K3
//! connectedness over faces at all but finitely many instants, F2 contact forces that explain the motion, F4 their
//! limit. Cells that do not slide hold each other where the middles of two faces meet: K3, K5 and F2 take only such
//! contacts of them, which last whole stages.

mod checks;
mod judgement;
mod sequence;
mod tolerances;

use super::ledger::Ledger;
use crate::plan::{CheckKind, Failure, Plan, Stages, Status, Verdict};
use judgement::Judgement;

/// Returns the verdict on a lattice plan, whose body is `stages`. A plan outside of what is judged, such as one with
/// gravity, gets a failure of the check of form and no other checks.
pub(super) fn judge(plan: &Plan, stages: &Stages) -> Verdict {
    let mut ledger = Ledger::new(&plan.exemptions, stages.duration());
    let mut judgement = Judgement { stages, cell: &plan.library.cells[stages.cell], obstacles: vec![] };
    if let Err(reason) = judgement.assumptions(plan).and_then(|()| judgement.stages(&mut ledger)) {
        ledger.fail(Failure { message: reason.to_string(), ..judgement.failure(CheckKind::Form, 0.0, None) });
        ledger.check(CheckKind::Form, Status::Proved);
        return ledger.finish();
    }
    let proved = [
        CheckKind::Form,
        CheckKind::Collision,
        CheckKind::JointRange,
        CheckKind::Speed,
        CheckKind::Acceleration,
        CheckKind::Connectedness,
        CheckKind::Momentum,
        CheckKind::Rest,
    ];
    proved.into_iter().for_each(|kind| ledger.check(kind, Status::Proved));
    let bounded = stages.model.contact_force.is_some();
    ledger.check(CheckKind::BondLoad, if bounded { Status::Proved } else { Status::NoLimit });
    ledger.finish()
}
