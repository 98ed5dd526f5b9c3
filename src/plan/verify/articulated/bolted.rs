//! Torques of a robot that is held fast, at every instant and not only at samples.
//!
//! In the middle of a stretch every torque is known; by how much it differs until the ends follows from
//! how far joints can turn in it. Seen from the piece before a joint, what hangs on it changes by each turn
//! beyond the joint no more than the angle times the arm; and the piece before turns against gravity by no
//! more than all angles before it. Stretches are halved until that is enough.

use super::model::{Model, Posture};
use super::sample;
use super::statics::{LoadKind, Structure, moves};
use super::swing::{Stretch, Swings};
use super::walk::{Course, bonds_at, world_at};
use crate::geometry::Vec3;
use crate::interrupt;
use crate::plan::{ExemptionKind, Ground};
use crate::robot::step::Motion;

/// What was found about the stretches between samples.
#[derive(Clone, Debug, PartialEq)]
pub enum Between {
    /// No load is ever over its limit.
    Proved,
    /// Not looked at, or not decided.
    Open,
    /// At this instant one is.
    Over { time: f64, load: usize, ratio: f64 },
}

/// Stretches are halved down to this length, s.
const SHORTEST: f64 = 1e-5;

/// What rounding may add to a load, in parts of its limit.
const ROUNDING: f64 = 1e-9;

/// Judges the whole plan, if its base is held fast all the time and no loop leaves open who carries what.
pub fn between(course: &Course) -> Between {
    let held = |world: &crate::plan::World| world.ground == Ground::Held;
    let excused = |e: &crate::plan::Exemption| matches!(e.kind, ExemptionKind::Overload(_));
    if !course.worlds.iter().all(|w| held(&w.world)) || course.exemptions.iter().any(excused) {
        return Between::Open;
    }
    let swings = Swings::new(course.tracks);
    let instants = sample::instants(course.tracks, course.worlds, course.exemptions);
    let mut bonds = bonds_at(course.tracks, 0.0);
    let mut scales = Scales::new(course, &bonds);
    let mut stretch = Stretch::default();
    for ends in instants.windows(2) {
        let now = bonds_at(course.tracks, ends[0]);
        if now != bonds {
            bonds = now;
            scales = Scales::new(course, &bonds);
        }
        if !scales.decides() {
            return Between::Open;
        }
        let gravity = world_at(course.worlds, ends[0]).gravity;
        let mut open = vec![(ends[0], ends[1])];
        while let Some((from, to)) = open.pop() {
            interrupt::checkpoint();
            swings.over(from, to, &mut stretch);
            match scales.weigh(&stretch, gravity) {
                Weighed::Within => {}
                Weighed::Over { load, ratio } => {
                    return Between::Over { time: stretch.middle, load, ratio };
                }
                Weighed::Near if to - from < SHORTEST => return Between::Open,
                Weighed::Near => open.extend([(stretch.middle, to), (from, stretch.middle)]),
            }
        }
    }
    Between::Proved
}

/// Everything that is needed to weigh one posture after the other.
struct Scales<'a> {
    model: Model<'a>,
    structure: Structure,
    /// Downwards in the frame of the base's body, of length 1.
    down: Vec3,
    /// By link: the step of the kinematics that leads to it.
    step_of: Vec<Option<usize>>,
    /// The steps that move, in the order of the structure's cuts.
    moving: Vec<usize>,
    poses: Vec<crate::geometry::Pose>,
}

enum Weighed {
    Within,
    Near,
    Over { load: usize, ratio: f64 },
}

/// Of a step: what hangs on it.
#[derive(Clone, Copy, Default)]
struct Hanging {
    /// N
    weight: f64,
    /// Sum of weights times places, N·m.
    moment: Vec3,
    /// Sum of weights times distances from the step's axis' point, N·m.
    arms: f64,
    /// The joint's angle (or way) at most, and by how much all beyond, weighed, moves at most.
    turn: f64,
    shift: f64,
    /// All angles before it.
    before: f64,
}

impl<'a> Scales<'a> {
    fn new(course: &Course<'a>, bonds: &[bool]) -> Scales<'a> {
        let model = Model::new(&course.tracks.robot, bonds);
        let structure = Structure::new(&model);
        let steps = &model.kinematics.steps;
        let mut step_of = vec![None; model.bodies.len()];
        steps.iter().enumerate().for_each(|(index, step)| step_of[step.link] = Some(index));
        let moving = (0..steps.len()).filter(|&index| moves(&steps[index])).collect();
        let down = course.tracks.start.base.rotation.inverse() * -Vec3::z();
        Scales { model, structure, down, step_of, moving, poses: Vec::new() }
    }

    /// Whether loads follow from the weights alone, and all are of joints that turn.
    fn decides(&self) -> bool {
        let turns = |kind| matches!(kind, LoadKind::Joint { turns: true, .. });
        self.structure.closing.is_empty()
            && !self.structure.motors_open
            && self.structure.loads.iter().all(|load| turns(load.kind))
    }

    fn weigh(&mut self, stretch: &Stretch, gravity: f64) -> Weighed {
        let posture = self.model.posture(&stretch.at, &mut self.poses);
        let hanging = self.hanging(&posture, stretch, gravity);
        let (mut over, mut near) = (None, false);
        for (index, load) in self.structure.loads.iter().enumerate() {
            let (mut size, mut stray) = (0.0, 0.0);
            for &(cut, factor) in &load.terms {
                let step = self.moving[cut];
                let own = &hanging[step];
                let arm = own.moment - self.point(&posture, step) * own.weight;
                size += factor * self.axis(&posture, step).dot(&arm.cross(&self.down));
                stray += factor.abs() * (own.shift + own.before * own.arms);
            }
            let ratio = size.abs() / load.limit;
            if ratio > 1.0 + ROUNDING && over.is_none_or(|(_, worst)| ratio > worst) {
                over = Some((index, ratio));
            }
            near |= ratio + stray / load.limit > 1.0 + ROUNDING;
        }
        match over {
            Some((load, ratio)) => Weighed::Over { load, ratio },
            None if near => Weighed::Near,
            None => Weighed::Within,
        }
    }

    fn hanging(&self, posture: &Posture, stretch: &Stretch, gravity: f64) -> Vec<Hanging> {
        let steps = &self.model.kinematics.steps;
        let mut hanging = vec![Hanging::default(); steps.len()];
        let points: Vec<Vec3> = (0..steps.len()).map(|step| self.point(posture, step)).collect();
        for (index, step) in steps.iter().enumerate() {
            let reach = |joint: usize| (stretch.rate[joint].abs() + stretch.stray[joint]) * stretch.half;
            let turn = step.terms().iter().map(|&(joint, factor)| factor.abs() * reach(joint)).sum();
            let parent =
                self.step_of[step.parent].map_or(0.0, |p| hanging[p].before + self.angle(p, &hanging));
            (hanging[index].turn, hanging[index].before) = (turn, parent);
        }
        for &link in &self.model.attached {
            let body = &self.model.bodies[link];
            let (weight, place) = (body.mass * gravity, posture.R[link] * body.com + posture.p[link]);
            let mut at = self.step_of[link];
            while let Some(step) = at {
                let own = &mut hanging[step];
                own.weight += weight;
                own.moment += place * weight;
                own.arms += weight * (place - points[step]).norm();
                at = self.step_of[steps[step].parent];
            }
        }
        for index in (0..steps.len()).rev() {
            let own = hanging[index];
            // Along a line all moves by the same; about an axis as far as its arm is long.
            let each = if self.angle(index, &hanging) > 0.0 { own.arms } else { own.weight };
            hanging[index].shift += own.turn * each;
            if let Some(parent) = self.step_of[steps[index].parent] {
                let shift = hanging[index].shift;
                hanging[parent].shift += shift;
            }
        }
        hanging
    }

    /// How far a step turns; nothing where it slides.
    fn angle(&self, step: usize, hanging: &[Hanging]) -> f64 {
        match self.model.kinematics.steps[step].motion {
            Motion::Along(_) => 0.0,
            _ => hanging[step].turn,
        }
    }

    /// A point on the axis of a step, in the frame of the base's body.
    fn point(&self, posture: &Posture, step: usize) -> Vec3 {
        let step = &self.model.kinematics.steps[step];
        posture.p[step.link] - posture.R[step.link] * step.offset
    }

    fn axis(&self, posture: &Posture, step: usize) -> Vec3 {
        let step = &self.model.kinematics.steps[step];
        posture.R[step.link] * step.motion.axis().unwrap_or_else(Vec3::zeros)
    }
}
