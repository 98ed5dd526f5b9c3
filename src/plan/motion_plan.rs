//! A plan as a whole: the trajectory of a robot with all that it takes to judge it.

use super::body::Body;
use super::cause::Cause;
use super::program::Program;
use super::provenance::Provenance;
use super::stated_path::StatedPath;
use super::verdict::Verdict;
use super::world::{Exemption, Settings, World, WorldFrom};
use crate::robot::Library;
use std::sync::Arc;

/// The motion of a robot, whatever made it, with all that it takes to judge it. Its fields may be changed freely:
/// [`validation::check`](super::validation::check) finds what makes no sense, before it is judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The origin of the plan: its planner and sources, and the changes since.
    pub provenance: Provenance,
    /// The worlds, in order of time, the first from 0 on; each part of a concatenation keeps the world it was
    /// planned for.
    pub worlds: Vec<WorldFrom>,
    /// The settings of the judge: sampling interval, rule of stability, reserve.
    pub settings: Settings,
    /// The module types, connectors, cells and struts that the body refers to by index.
    pub library: Arc<Library>,
    /// The motion itself, of one of three families of robots.
    pub body: Body,
    /// The program that a position-servo robot executes; `None` for planned bodies without one, and where a change
    /// of the plan dropped it.
    pub program: Option<Program>,
    /// True where times depend on what sensors would say: then they hold for the undisturbed run.
    pub nominal: bool,
    /// The commands of the source that move something, by [`CauseId`](super::CauseId).
    pub causes: Vec<Cause>,
    /// The parts of the plan that are excused from a check.
    pub exemptions: Vec<Exemption>,
    /// The paths in space that ports keep to; empty for plans of other families than articulated robots.
    pub paths: Vec<StatedPath>,
    /// The verdict of the last verification; `None` if there was none since the last change. It is recomputed
    /// whenever it matters.
    pub verdict: Option<Verdict>,
}

impl Plan {
    /// Returns the plan of a body in one world, and nothing more: without provenance, program, causes, exemptions and
    /// verdict. `library` must be the one that the body refers to. `settings`: the settings of the judge.
    pub fn bare(library: Arc<Library>, body: Body, world: World, settings: Settings) -> Plan {
        Plan {
            provenance: Provenance::default(),
            worlds: vec![WorldFrom { from: 0.0, world }],
            settings,
            library,
            body,
            program: None,
            nominal: false,
            causes: Vec::new(),
            exemptions: Vec::new(),
            paths: Vec::new(),
            verdict: None,
        }
    }
}
