//! Plans for the tests, built by plain Rust from joint motions.
#![allow(dead_code)]

use crate::support::robots;
use modl::plan::{
    Body, CauseId, Ground, Plan, Provenance, Segment, Settings, Track, Tracks, World, WorldFrom,
};
use modl::robot::{Assembly, JointId};

/// Level ground on which every instant is judged at rest.
pub const STATICS: World = World { gravity: 9.80665, ground: Ground::Settle, ..World::FREE };

/// Position of a joint id by module name and the joint's index in a SMORES module.
pub fn joint(robot: &Assembly, module: &str, joint: usize) -> usize {
    let index = robot.modules.iter().position(|m| m.name == module).expect("the design has this module");
    4 * index + joint
}

/// A plan to be: a robot at rest, to be given motions.
#[derive(Clone)]
pub struct Motion {
    pub tracks: Tracks,
}

impl Motion {
    pub fn new(robot: Assembly) -> Motion {
        let start = robots::at_rest(&robot);
        Motion { tracks: Tracks::at_rest(robot, start) }
    }

    pub fn joint(&self, module: &str, joint: usize) -> usize {
        self::joint(&self.tracks.robot, module, joint)
    }

    /// Sets a joint's start position, degrees.
    pub fn set(mut self, module: &str, joint: usize, degrees: f64) -> Motion {
        let joint = self.joint(module, joint);
        self.tracks.start.joints[joint] = degrees.to_radians();
        self
    }

    /// Adds a segment by its control points, in the joint's unit.
    pub fn segment(mut self, joint: usize, start: f64, end: f64, control: Vec<f64>) -> Motion {
        let cause = CauseId(self.tracks.tracks.iter().map(|t| t.segments.len() as u32).sum());
        let id = JointId(joint as u32);
        let at = match self.tracks.tracks.binary_search_by_key(&id, |t| t.joint) {
            Ok(at) => at,
            Err(at) => {
                self.tracks.tracks.insert(at, Track { joint: id, segments: vec![] });
                at
            }
        };
        self.tracks.tracks[at].segments.push(Segment { start, end, control, cause });
        self.tracks.duration = self.tracks.duration.max(end);
        self
    }

    /// Where a joint is after the motions so far.
    fn last(&self, joint: usize) -> f64 {
        let track = self.tracks.track(JointId(joint as u32));
        track.and_then(|t| t.segments.last()).map_or(self.tracks.start.joints[joint], Segment::last)
    }

    /// Turns a joint to a position at an even rate; degrees.
    pub fn linear(self, module: &str, joint: usize, degrees: f64, start: f64, end: f64) -> Motion {
        let joint = self.joint(module, joint);
        let from = self.last(joint);
        self.segment(joint, start, end, vec![from, degrees.to_radians()])
    }

    /// Turns a joint at a rate in rad/s.
    pub fn spin(self, module: &str, joint: usize, rate: f64, start: f64, end: f64) -> Motion {
        let joint = self.joint(module, joint);
        let from = self.last(joint);
        self.segment(joint, start, end, vec![from, from + rate * (end - start)])
    }

    /// Turns a joint to a position, at rest at both ends (the quintic); degrees.
    pub fn smooth(self, module: &str, joint: usize, degrees: f64, start: f64, end: f64) -> Motion {
        let joint = self.joint(module, joint);
        let (from, to) = (self.last(joint), degrees.to_radians());
        self.segment(joint, start, end, vec![from, from, from, to, to, to])
    }

    /// The same motion followed by its reverse.
    pub fn there_and_back(mut self) -> Motion {
        let end = self.tracks.duration;
        for track in &mut self.tracks.tracks {
            let back: Vec<Segment> = track
                .segments
                .iter()
                .rev()
                .map(|s| Segment {
                    start: 2.0 * end - s.end,
                    end: 2.0 * end - s.start,
                    control: s.control.iter().rev().copied().collect(),
                    cause: s.cause,
                })
                .collect();
            track.segments.extend(back);
        }
        self.tracks.duration = 2.0 * end;
        self
    }

    pub fn plan(self, world: World) -> Plan {
        let library = self.tracks.robot.library.clone();
        let causes = self.tracks.tracks.iter().map(|t| t.segments.len()).sum();
        Plan {
            provenance: Provenance::default(),
            worlds: vec![WorldFrom { from: 0.0, world }],
            settings: Settings::default(),
            library,
            body: Body::Tracks(self.tracks),
            program: None,
            nominal: false,
            causes: (0..causes).map(cause).collect(),
            exemptions: vec![],
            paths: vec![],
            verdict: None,
        }
    }
}

pub fn cause(n: usize) -> modl::plan::Cause {
    modl::plan::Cause {
        file: "test.mod".into(),
        line: n + 1,
        column: 1,
        text: String::new(),
        instance: String::new(),
        caller: None,
    }
}
