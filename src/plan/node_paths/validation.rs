//! The validation of node paths: references, orders and ranges.

use super::fault::NodePathsFault;
use super::motion::{Interpolation, NodePaths};
use crate::geometry::HeightField;
use crate::geometry::soundness::{EXTENT_MAX, check_placed};
use crate::plan::fault::{PlanFault, need, need_ascending, need_bounded, need_finite, need_index};
use crate::plan::time::TICK;
use crate::robot::Library;
use crate::robot::validation::POSITION_MAX;

impl NodePaths {
    /// Checks that the node paths are well formed: that every index is within its list, that keyframes begin at 0 s,
    /// are in order of time and place every node, and that a roll is about two different nodes. `library`: that of the
    /// plan; `causes`: the number of causes of the plan.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(in crate::plan) fn validate(&self, library: &Library, causes: usize) -> Result<(), PlanFault> {
        need_index(self.strut, library.struts.len(), "strut type")?;
        let count = self.node_names.len();
        let node = |i| need_index(i, count, "node");
        self.struts.iter().try_for_each(|&(a, b)| node(a).and(node(b)))?;
        let strut = |i: &usize| need_index(*i, self.struts.len(), "strut");
        self.limits.sums.iter().flat_map(|sum| &sum.struts).try_for_each(strut)?;
        let times: Vec<f64> = self.keyframes.iter().map(|k| k.time).collect();
        need(times.first() == Some(&0.0), || NodePathsFault::FirstKeyframe)?;
        need_ascending(&times, "the keyframes")?;
        let short = times.windows(2).find(|ends| ends[1] - ends[0] < TICK);
        short.map_or(Ok(()), |ends| Err(NodePathsFault::ShortStep { time: ends[1] }))?;
        self.validate_events(causes)?;
        let mut before = 0.0;
        for keyframe in &self.keyframes {
            let time = keyframe.time;
            need_index(keyframe.cause.0 as usize, causes, "cause")?;
            let duration = time - std::mem::replace(&mut before, time);
            keyframe.ramps.check(keyframe.interpolation, time, duration)?;
            let complete = keyframe.nodes.len() == count;
            need(complete, || NodePathsFault::KeyframeNodes { time, nodes: count })?;
            if let Interpolation::RigidRoll { edge: (a, b), .. } = keyframe.interpolation {
                node(a).and(node(b))?;
                need(a != b, || NodePathsFault::RollEdge { time })?;
            }
        }
        Ok(())
    }

    /// Checks that numbers are finite, coordinates of nodes and angles of rolls in their ranges, obstacles solids and
    /// the terrain sound, that struts and rolls have a length, and that nodes meet where they merge.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(in crate::plan) fn check_ranges(&self) -> Result<(), PlanFault> {
        need_finite("the keyframes", &self.keyframes)?;
        need_finite("the limits", &self.limits)?;
        need_finite("the surroundings", &self.surroundings)?;
        for placed in self.surroundings.obstacles.iter().flatten() {
            check_placed(placed).map_err(NodePathsFault::Obstacle)?;
        }
        if let Some(fault) = self.surroundings.terrain.as_ref().and_then(HeightField::fault) {
            return Err(NodePathsFault::Terrain(fault).into());
        }
        let coordinates = self.keyframes.iter().flat_map(|keyframe| keyframe.nodes.iter().flatten());
        coordinates.into_iter().try_for_each(|&c| need_bounded(c, EXTENT_MAX, "the coordinate of a node"))?;
        need(self.struts.iter().all(|(a, b)| a != b), || NodePathsFault::StrutEnds)?;
        self.check_meetings()?;
        self.keyframes.iter().try_for_each(|keyframe| match keyframe.interpolation {
            Interpolation::RigidRoll { edge: (a, b), angle } => {
                need_bounded(angle, POSITION_MAX, "the angle of a roll")?;
                let long = keyframe.nodes[a] != keyframe.nodes[b];
                need(long, || NodePathsFault::RollLength { time: keyframe.time })
            }
            Interpolation::Linear => Ok(()),
        })
    }
}
