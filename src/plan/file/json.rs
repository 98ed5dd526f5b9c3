//! The JSON of a plan file: its fields in order, and the conversion to a plan and back.
//!
//! It differs from [`Plan`] in three respects: the library is written once, beside the body; a program is a
//! table of nodes whose children come before them, so that what is shared stays shared and nothing nests
//! deeply; and beside the indices stand the names of what they stand for, which say nothing new and are
//! compared with the indices when a file is read.
//!
//! Versions from 2 on only add fields. A field that a later version adds is optional here, so that files of
//! every version since 2 are read.

use super::library::LibraryNamesJson;
use super::program::{ProgramJson, of_exemption};
use crate::plan::body::BodyJson;
use crate::plan::cause::{Cause, CauseId};
use crate::plan::fault::PlanFault;
use crate::plan::motion_plan::Plan;
use crate::plan::provenance::Provenance;
use crate::plan::stated::Stated;
use crate::plan::stated_path::StatedPath;
use crate::plan::tracks::RobotNames;
use crate::plan::validation::validate;
use crate::plan::verdict::Verdict;
use crate::plan::world::{
    DynamicsModel, Exemption, ExemptionKind, Ground, Settings, World, WorldFrom, is_level,
};
use crate::robot::Library;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// The text of the first field of every plan file.
pub(super) const FORMAT: &str = "modl plan";
/// The version of the schema: 4 added nodes of trusses that merge and split. A plan without any is written as one of an
/// earlier version, which earlier tools read.
pub(super) const VERSION: u32 = 4;
/// The version that added moves and anchors of lattices.
const VERSION_OF_MOVES: u32 = 3;
/// The oldest version of the schema that is read.
pub(super) const VERSION_MIN: u32 = 2;

/// The motion of a modular robot with all that it takes to judge it. SI units throughout: m, rad, s, kg, N, N·m;
/// poses are a position and a unit quaternion. Every reference is an index, from 0, into a list of this file, with
/// the name of what it stands for beside it.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Plan", deny_unknown_fields)]
pub(super) struct PlanJson<'a> {
    /// The format, always `modl plan`.
    format: Cow<'a, str>,
    /// 2, 3 if a lattice has an `anchor` or states `moves`, or 4 if nodes of a truss merge or split. Later versions only add fields.
    version: u32,
    provenance: Cow<'a, Provenance>,
    /// The worlds, in order of time.
    worlds: Vec<WorldFromJson>,
    settings: Settings,
    /// `true` where times depend on what sensors would say: then they hold for the undisturbed run.
    nominal: bool,
    library: Arc<Library>,
    /// The names of what the indices inside the library stand for.
    names: LibraryNamesJson,
    body: BodyJson<'a>,
    program: Option<ProgramJson<'a>>,
    causes: Cow<'a, [Cause]>,
    exemptions: Vec<ExemptionJson>,
    /// The paths in space that ports keep to; absent without any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    paths: Vec<PathJson>,
    verdict: Option<Cow<'a, Verdict>>,
}

/// A world and the time from which it holds; the first begins at 0.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "WorldFrom", deny_unknown_fields)]
struct WorldFromJson {
    /// The beginning, s.
    from: f64,
    /// The world from then on.
    world: WorldJson,
}

/// The assumptions about the surroundings, and about the relation of forces and motion.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "World", deny_unknown_fields)]
struct WorldJson {
    /// The gravity, m/s², downwards; 0 is weightless.
    gravity: f64,
    ground: Ground,
    /// Factor on the friction of every link.
    friction: f64,
    /// The law of forces and motion that the verdict rests on.
    dynamics: DynamicsModel,
    /// The rise of the ground along x and along y, m per m; absent for level ground.
    #[serde(default, skip_serializing_if = "is_level")]
    slope: [f64; 2],
}

/// An interval of the plan that is excused from a check. The end of the whole plan never is.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Exemption", deny_unknown_fields)]
struct ExemptionJson {
    kind: ExemptionKind,
    /// The names of the modules or of the joint that it is about.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    on: Vec<String>,
    /// The beginning, s.
    from: f64,
    /// The end, s.
    to: f64,
    cause: CauseId,
}

/// A path that a port keeps to, in the frame of the body of a module.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "StatedPath", deny_unknown_fields)]
struct PathJson {
    /// The port and the module, by index.
    stated: StatedPath,
    /// The names of the port and of the module.
    on: Vec<String>,
}

/// The part of a plan file by which its format and version are recognised before the rest is read.
#[derive(Deserialize)]
pub(super) struct Header {
    /// The text of the field `format`; `None` if there is none.
    pub(super) format: Option<String>,
    /// The number of the field `version`; `None` if there is none.
    pub(super) version: Option<u32>,
}

/// Returns the dynamics that a world assumes of articulated robots, of those that a file states: other families have
/// their own.
fn articulated(stated: DynamicsModel) -> DynamicsModel {
    match stated {
        DynamicsModel::Full => DynamicsModel::Full,
        DynamicsModel::Statics | DynamicsModel::Kinodynamic => DynamicsModel::Statics,
    }
}

impl<'a> PlanJson<'a> {
    /// Returns a plan as it stands in a file; long lists are borrowed.
    pub(super) fn of(plan: &'a Plan) -> PlanJson<'a> {
        let names = plan.body.tracks().map(|tracks| RobotNames::of(&tracks.robot));
        let world = |w: &WorldFrom| WorldFromJson {
            from: w.from,
            world: WorldJson {
                gravity: w.world.gravity,
                ground: w.world.ground,
                friction: w.world.friction,
                dynamics: plan.body.dynamics(&w.world),
                slope: w.world.slope,
            },
        };
        let exemption = |e: &Exemption| ExemptionJson {
            kind: e.kind.clone(),
            on: names.as_ref().map_or_else(Vec::new, |names| of_exemption(&e.kind, names)),
            from: e.from,
            to: e.to,
            cause: e.cause,
        };
        let path = |path: &StatedPath| PathJson {
            stated: path.clone(),
            on: names
                .as_ref()
                .map_or_else(Vec::new, |names| vec![names.port(path.port), names.module(path.module)]),
        };
        PlanJson {
            format: Cow::Borrowed(FORMAT),
            version: match (plan.body.needs_version_4(), plan.body.needs_version_3()) {
                (true, _) => VERSION,
                (false, true) => VERSION_OF_MOVES,
                (false, false) => VERSION_MIN,
            },
            provenance: Cow::Borrowed(&plan.provenance),
            worlds: plan.worlds.iter().map(world).collect(),
            settings: plan.settings,
            nominal: plan.nominal,
            library: plan.library.clone(),
            names: LibraryNamesJson::of(&plan.library),
            body: BodyJson::of(&plan.body, &plan.library),
            program: plan.program.as_ref().map(|p| ProgramJson::of(p, names.as_ref())),
            causes: Cow::Borrowed(&plan.causes),
            exemptions: plan.exemptions.iter().map(exemption).collect(),
            paths: plan.paths.iter().map(path).collect(),
            verdict: plan.verdict.as_ref().map(Cow::Borrowed),
        }
    }

    /// Returns the names that the file states beside indices, in its order.
    fn names(&self) -> Stated {
        let mut stated = Stated::default();
        self.names.names(&mut stated);
        self.body.names(&mut stated);
        if let Some(program) = &self.program {
            program.names(&mut stated);
        }
        self.exemptions.iter().for_each(|e| stated.add_all("exemption subject", &e.on));
        self.paths.iter().for_each(|path| stated.add_all("path subject", &path.on));
        stated
    }

    /// Returns the plan that stands in a file, after [`validate`](crate::plan::validation::validate) and a comparison
    /// of the stated names with those that the indices stand for.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(super) fn into_valid_plan(self) -> Result<Plan, PlanFault> {
        let names = self.names();
        let dynamics: Vec<DynamicsModel> = self.worlds.iter().map(|w| w.world.dynamics).collect();
        let plan = self.into_plan()?;
        validate(&plan)?;
        names.check(&PlanJson::of(&plan).names())?;
        let judged = |world: &World| plan.body.dynamics(world);
        let worlds = plan.worlds.iter().map(|from| judged(&from.world));
        match dynamics.into_iter().zip(worlds).find(|(stated, judged)| stated != judged) {
            Some((stated, judged)) => Err(PlanFault::Dynamics { stated, judged }),
            None => Ok(plan),
        }
    }

    fn into_plan(self) -> Result<Plan, PlanFault> {
        let world = |w: WorldFromJson| WorldFrom {
            from: w.from,
            world: World {
                gravity: w.world.gravity,
                ground: w.world.ground,
                friction: w.world.friction,
                dynamics: articulated(w.world.dynamics),
                slope: w.world.slope,
            },
        };
        let exemption = |e: ExemptionJson| Exemption { kind: e.kind, from: e.from, to: e.to, cause: e.cause };
        let program = self.program.map(ProgramJson::into_program).transpose()?;
        let body = self.body.into_body(&self.library)?;
        Ok(Plan {
            provenance: self.provenance.into_owned(),
            worlds: self.worlds.into_iter().map(world).collect(),
            settings: self.settings,
            nominal: self.nominal,
            library: self.library,
            body,
            program,
            causes: self.causes.into_owned(),
            exemptions: self.exemptions.into_iter().map(exemption).collect(),
            paths: self.paths.into_iter().map(|path| path.stated).collect(),
            verdict: self.verdict.map(Cow::into_owned),
        })
    }
}
