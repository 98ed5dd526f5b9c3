//! The JSON of a plan file: what stands in it, in order, and how it becomes a plan and back.
//!
//! It differs from [`Plan`] in two places: the library stands once, beside the body, and a program is
//! a table of nodes whose children come before them, so that what is shared stays shared and nothing
//! nests deeply.

use super::program::ProgramJson;
use crate::plan::body::BodyJson;
use crate::plan::cause::Cause;
use crate::plan::fault::PlanFault;
use crate::plan::motion_plan::Plan;
use crate::plan::provenance::Provenance;
use crate::plan::verdict::Verdict;
use crate::plan::world::{Exemption, Settings, WorldFrom};
use crate::robot::Library;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// What the first field of every plan file says.
pub(super) const FORMAT: &str = "modl plan";
/// The version of the form that is written, and the only one that is read.
pub(super) const VERSION: u32 = 2;

/// A verified motion of a modular robot. SI units throughout: m, rad, s, kg, N, N·m; poses are a
/// position and a unit quaternion. Every reference is an index, from 0, into a list of this file.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Plan", deny_unknown_fields)]
pub(super) struct PlanJson<'a> {
    /// Always `modl plan`.
    format: Cow<'a, str>,
    /// Always 2.
    version: u32,
    provenance: Cow<'a, Provenance>,
    worlds: Cow<'a, [WorldFrom]>,
    settings: Settings,
    /// Whether times depend on what sensors would say: then they hold for the undisturbed run.
    nominal: bool,
    library: Arc<Library>,
    body: BodyJson<'a>,
    program: Option<ProgramJson<'a>>,
    causes: Cow<'a, [Cause]>,
    exemptions: Cow<'a, [Exemption]>,
    verdict: Option<Cow<'a, Verdict>>,
}

/// Only what tells the versions apart.
#[derive(Deserialize)]
pub(super) struct Header {
    pub(super) format: Option<String>,
    pub(super) version: Option<u32>,
}

impl<'a> PlanJson<'a> {
    /// The form of a plan; it borrows what is large.
    pub(super) fn of(plan: &'a Plan) -> PlanJson<'a> {
        PlanJson {
            format: Cow::Borrowed(FORMAT),
            version: VERSION,
            provenance: Cow::Borrowed(&plan.provenance),
            worlds: Cow::Borrowed(&plan.worlds),
            settings: plan.settings,
            nominal: plan.nominal,
            library: plan.library.clone(),
            body: BodyJson::of(&plan.body),
            program: plan.program.as_ref().map(ProgramJson::of),
            causes: Cow::Borrowed(&plan.causes),
            exemptions: Cow::Borrowed(&plan.exemptions),
            verdict: plan.verdict.as_ref().map(Cow::Borrowed),
        }
    }

    /// The plan, or what is wrong with the table of its program.
    pub(super) fn into_plan(self) -> Result<Plan, PlanFault> {
        let program = self.program.map(ProgramJson::into_program).transpose()?;
        let body = self.body.into_body(&self.library);
        Ok(Plan {
            provenance: self.provenance.into_owned(),
            worlds: self.worlds.into_owned(),
            settings: self.settings,
            nominal: self.nominal,
            library: self.library,
            body,
            program,
            causes: self.causes.into_owned(),
            exemptions: self.exemptions.into_owned(),
            verdict: self.verdict.map(Cow::into_owned),
        })
    }
}
