//! Scenes: places of parts, obstacles, the world, and the robots that connections make of the parts.

use super::tolerances::TOLERANCES;
use crate::check::typed::{ConfigDef, Obstacle, PartDef};
use crate::geometry::{Pose, soundness};
use crate::interpret::design::{ConfigDesign, Design, PartElement, shorten};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::record::Record;
use crate::interpret::scene::{ObstacleRecord, Place};
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::Value;
use crate::robot::{Assembly, ClusterPose, Kinematics, State};
use crate::source::{Diagnostic, Span, code};
use std::rc::Rc;

impl Interpreter<'_> {
    /// Returns the place of a part; `None` where none is written.
    ///
    /// # Errors
    /// A fault of its expressions.
    pub(super) fn part_place(&mut self, part: &PartDef, frame: &mut Frame) -> Eval<Option<Place>> {
        let Some(at) = &part.at else { return Ok(None) };
        Ok(Some(Place { pose: self.placement(Some(at), frame)?, span: at.span }))
    }

    /// Adds the obstacle of a clause to the scene; none where its solid or its index is unknown.
    ///
    /// # Errors
    /// A fault where it is no solid, its index is negative, or its name is that of another obstacle or of a module.
    pub(super) fn obstacle(
        &mut self,
        obstacle: &Obstacle,
        config: &ConfigDesign,
        frame: &mut Frame,
    ) -> Eval<()> {
        let Some(scene) = &config.scene else { return Ok(()) };
        let index = match self.eval_optional(obstacle.index.as_ref(), frame)? {
            None => None,
            Some(Value::Int(index)) => Some(index),
            Some(_) => return Ok(()),
        };
        let Value::Shape(shape) = self.eval(&obstacle.value, frame)? else { return Ok(()) };
        let pose = self.placement(obstacle.at.as_ref(), frame)?;
        let mut parts = shape.parts.clone();
        parts.iter_mut().for_each(|part| part.pose = pose * part.pose);
        let unsound = parts.iter().find_map(|part| soundness::check_placed(part).err());
        if parts.is_empty() || unsound.is_some() {
            let why = unsound.map_or("it has no shape".to_owned(), |unsound| unsound.to_string());
            let message = format!("the obstacle `{}` is no solid: {why}", obstacle.name);
            return Err(fault(code::BAD_SHAPE, obstacle.value.span, message, "this is no solid"));
        }
        let name = match index {
            Some(index) => format!("{}[{index}]", obstacle.name),
            None => obstacle.name.to_string(),
        };
        if let Some(first) = scene.obstacles.borrow().iter().find(|other| other.name == name) {
            let mut diagnostic =
                Diagnostic::error(code::DECLARED_TWICE, format!("the obstacle `{name}` stands already"))
                    .label(obstacle.span, "declared again");
            if first.span != obstacle.span {
                diagnostic = diagnostic.label(first.span, "declared here first");
            }
            return Err(diagnostic.hint("in a loop each has an index: `obstacle post[i] = ...`").into());
        }
        scene.obstacles.borrow_mut().push(ObstacleRecord {
            name,
            shapes: parts,
            group: obstacle.name,
            index: index.unwrap_or(0),
            span: obstacle.span,
        });
        Ok(())
    }

    /// Evaluates the line `world(...)` of a scene.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels; faults are reported.
    pub(super) fn elaborate_world(
        &mut self,
        def: &ConfigDef,
        config: &ConfigDesign,
        frame: &mut Frame,
    ) -> Eval<()> {
        let (Some(world), Some(scene)) = (&def.world, &config.scene) else { return Ok(()) };
        if let Some(Value::Record(record)) = self.attempt(|this| this.eval(world, frame))?
            && let Record::World(world) = &*record
        {
            scene.world.set(Some(*world));
        }
        Ok(())
    }

    /// Checks the robots of a scene: how many they are, and that no robot is placed twice.
    ///
    /// # Errors
    /// `Stop::Halt` where there are more than the limit; other faults are reported.
    pub(super) fn check_scene(&mut self, def: &ConfigDef, design: &Rc<Design>) -> Eval<()> {
        let most = self.limits().robots;
        let robots = design.robots(most);
        if robots.len() > most {
            let last = robots[most][0];
            let message = format!("a scene of more than {most} robots is not allowed");
            let span = part_span(def, design, last);
            return self.halt(Diagnostic::error(code::SIZE_LIMIT, message).label(span, "too many robots"));
        }
        for robot in robots {
            let placed: Vec<(&PartElement, Span)> =
                robot.iter().filter_map(|part| Some((*part, part.place.as_ref()?.span))).collect();
            let [(first, at), rest @ ..] = placed.as_slice() else { continue };
            if rest.is_empty() {
                continue;
            }
            let names: Vec<String> = placed.iter().map(|(part, _)| part.name.to_string()).collect();
            let message = format!("{} are one robot, which is placed twice", shorten(&names));
            let mut diagnostic = Diagnostic::error(code::PLACED_TWICE, message)
                .label(*at, format!("this places {}", first.name));
            if let Some((part, again)) = rest.iter().find(|(_, again)| again != at) {
                diagnostic = diagnostic.label(*again, format!("and this {}", part.name));
            }
            self.report(
                diagnostic.hint("connections place the other parts of a robot: leave out all but one `at`"),
            );
        }
        Ok(())
    }

    /// Reports robots of a scene whose base modules are at one place.
    ///
    /// # Errors
    /// A fault or `Stop::Halt` while the robots are assembled.
    pub(super) fn check_places(&mut self, def: &ConfigDef, design: &Rc<Design>) -> Eval<()> {
        if !def.scene || design.broken.get() || design.module_count() == 0 {
            return Ok(());
        }
        let span = self.shared.program.def(design.def).span;
        let Some(scene) = self.robot_of(design, span)? else { return Ok(()) };
        let robots = design.robots(self.limits().robots);
        let mut at = Vec::new();
        for robot in &robots {
            let base = self.part_base(robot[0], span)?;
            at.push(scene.kinematics.module_pose(base, &scene.poses).translation.vector);
        }
        let near = |a: usize, b: usize| (at[a] - at[b]).norm() <= TOLERANCES.one_place;
        for first in 0..robots.len() {
            if (0..first).any(|before| near(before, first)) {
                continue;
            }
            let same: Vec<&PartElement> =
                (first + 1..robots.len()).filter(|other| near(first, *other)).map(|r| robots[r][0]).collect();
            let Some(second) = same.first() else { continue };
            let first = robots[first][0];
            let names: Vec<String> =
                std::iter::once(&first).chain(&same).map(|part| part.name.to_string()).collect();
            let message = format!("{} begin at one place", shorten(&names));
            let (here, there) = (part_span(def, design, first), part_span(def, design, second));
            let mut diagnostic = Diagnostic::error(code::ONE_PLACE, message);
            if there != here {
                diagnostic = diagnostic.label(here, format!("{} is here", first.name));
            }
            let label = if there == here { "these robots" } else { "and this robot, too" };
            let hint = "nothing connects them, so they are robots of their own: place one with `at`, as in \
                        `part b: Car at [600mm, 0m, 0m]`";
            self.report(diagnostic.label(there, label).hint(hint));
        }
        Ok(())
    }

    /// Returns the base of a part, as an index of a module of the whole. `span`: the code that asks for the robot.
    fn part_base(&mut self, part: &PartElement, span: Span) -> Eval<usize> {
        let robot = self.assemble_robot(&part.design, span)?;
        Ok(part.offset + robot.map_or(0, |robot| robot.assembly.base))
    }

    /// Returns (state, poses) of a scene at its start: the state with the pose of each robot, and the world poses of all
    /// links, by their numbers. Sets the base of the assembly: that of the first robot, or the one that is named.
    ///
    /// # Errors
    /// A fault of a declaration that a part needs, or `Stop::Halt` if a limit is reached or the user cancels.
    pub(super) fn place_robots(
        &mut self,
        design: &Rc<Design>,
        assembly: &mut Assembly,
        joints: Vec<f64>,
    ) -> Eval<(State, Vec<Pose>)> {
        let span = self.shared.program.def(design.def).span;
        let named = design.config().and_then(|config| config.base.get());
        let bonds = vec![true; assembly.bonds.len()];
        let mut poses = Vec::new();
        let mut clusters = Vec::new();
        for robot in design.robots(self.limits().robots) {
            let placed = robot.iter().find(|part| part.place.is_some()).unwrap_or(&robot[0]);
            let place = placed.place.as_ref().map_or(Pose::identity(), |place| place.pose);
            let kinematics = Kinematics::new(assembly, &bonds, self.part_base(placed, span)?);
            poses.resize(kinematics.link_count(), Pose::identity());
            kinematics.link_poses(&joints, &place, &mut poses);
            let own = named.filter(|base| kinematics.tree.order.iter().any(|(module, _)| module == base));
            let reference = match own {
                Some(base) => base,
                None => self.part_base(robot[0], span)?,
            };
            clusters.push(ClusterPose { reference, pose: kinematics.module_pose(reference, &poses) });
        }
        let base = named.and_then(|base| clusters.iter().position(|cluster| cluster.reference == base));
        let base = clusters.remove(base.unwrap_or(0));
        clusters.sort_by_key(|cluster| cluster.reference);
        assembly.base = base.reference;
        Ok((State { joints, bonds, base: base.pose, clusters, misalignments: vec![] }, poses))
    }
}

/// Returns the span of the name of a part of a scene.
fn part_span(def: &ConfigDef, design: &Design, part: &PartElement) -> Span {
    let groups = design.config().and_then(|config| config.parts.get());
    let mut declared = def.parts.iter().zip(groups.into_iter().flatten());
    let found = declared.find(|(_, group)| group.elements.iter().any(|element| element.name == part.name));
    found.map_or(def.parts[0].span, |(part, _)| part.span)
}
