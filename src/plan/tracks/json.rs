//! Tracks as they stand in a plan file. The library stands once, beside the body.

use super::motion::{Dock, Track, Tracks};
use crate::plan::cause::CauseId;
use crate::robot::{Assembly, Bond, JointId, Library, ModuleInstance, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// Joint motions over time, and which bonds hold.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Tracks", deny_unknown_fields)]
pub(in crate::plan) struct TracksJson<'a> {
    robot: RobotJson<'a>,
    start: Cow<'a, State>,
    /// Seconds.
    duration: f64,
    /// At most one a joint, in order of joint. A joint without a track keeps its start position.
    tracks: Cow<'a, [Track]>,
    /// In order of time.
    docks: Cow<'a, [Dock]>,
    /// Who set which joint of the start pose.
    start_causes: Cow<'a, [(JointId, CauseId)]>,
    /// Who connected which bond.
    bond_causes: Cow<'a, [(usize, CauseId)]>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Robot", deny_unknown_fields)]
struct RobotJson<'a> {
    name: Cow<'a, str>,
    modules: Cow<'a, [ModuleInstance]>,
    /// Every bond that exists at some time.
    bonds: Cow<'a, [Bond]>,
    /// The module whose body frame is drawn upright at the start, and whose pose is reported.
    base: usize,
    /// Whether the connections may close loops.
    closed: bool,
}

impl<'a> TracksJson<'a> {
    pub(in crate::plan) fn of(tracks: &'a Tracks) -> TracksJson<'a> {
        let robot = &tracks.robot;
        TracksJson {
            robot: RobotJson {
                name: Cow::Borrowed(&robot.name),
                modules: Cow::Borrowed(&robot.modules),
                bonds: Cow::Borrowed(&robot.bonds),
                base: robot.base,
                closed: robot.closed,
            },
            start: Cow::Borrowed(&tracks.start),
            duration: tracks.duration,
            tracks: Cow::Borrowed(&tracks.tracks),
            docks: Cow::Borrowed(&tracks.docks),
            start_causes: Cow::Borrowed(&tracks.start_causes),
            bond_causes: Cow::Borrowed(&tracks.bond_causes),
        }
    }

    pub(in crate::plan) fn into_tracks(self, library: &Arc<Library>) -> Tracks {
        let robot = Assembly {
            name: self.robot.name.into_owned(),
            library: library.clone(),
            modules: self.robot.modules.into_owned(),
            bonds: self.robot.bonds.into_owned(),
            base: self.robot.base,
            closed: self.robot.closed,
        };
        Tracks {
            robot,
            start: self.start.into_owned(),
            tracks: self.tracks.into_owned(),
            docks: self.docks.into_owned(),
            duration: self.duration,
            start_causes: self.start_causes.into_owned(),
            bond_causes: self.bond_causes.into_owned(),
        }
    }
}
