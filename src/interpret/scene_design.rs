//! The designs of scenes: their robots, and their obstacles as values.

use super::design::{Design, Instance, PartElement};
use super::scene::{ObstacleRecord, SceneDesign};
use super::stop::{Eval, fault};
use super::value::{Solid, Value};
use crate::plan::Obstacle;
use crate::source::{Span, Symbol, code};
use std::rc::Rc;
use std::sync::Arc;

impl Design {
    /// Returns the scene that the design is; `None` for other designs.
    pub fn scene(&self) -> Option<&SceneDesign> {
        self.config().and_then(|config| config.scene.as_ref())
    }

    /// Returns the obstacles of a scene in the order of the clauses, in the world's frame; none for other designs.
    pub fn obstacles(&self) -> Arc<[Obstacle]> {
        let Some(scene) = self.scene() else { return Arc::default() };
        let obstacle =
            |record: &ObstacleRecord| Obstacle { name: record.name.clone(), shapes: record.shapes.clone() };
        scene.obstacles.borrow().iter().map(obstacle).collect()
    }

    /// Returns the robots of a scene: for each component of its connections the parts that it is made of, in the order
    /// of their first parts. Parts without modules are left out. One component for a configuration, and none for other
    /// designs. At most `most` and one more are told apart.
    pub fn robots(&self, most: usize) -> Vec<Vec<&PartElement>> {
        let Some(config) = self.config() else { return Vec::new() };
        let elements = config.parts.get().into_iter().flatten().flat_map(|group| &group.elements);
        let mut found: Vec<Vec<&PartElement>> = Vec::new();
        let mut groups = config.groups.borrow_mut();
        for part in elements.filter(|part| part.design.module_count() > 0) {
            match found.iter().position(|robot| groups.together(robot[0].offset, part.offset)) {
                Some(robot) => found[robot].push(part),
                None if found.len() > most => break,
                None => found.push(vec![part]),
            }
        }
        found
    }
}

/// Returns an obstacle of a scene as a shape in the world's frame, or the list of those of an array by index. `name`:
/// that of the obstacle or array; `array`: true for an array.
///
/// # Errors
/// A fault at `span` where the obstacle does not stand yet, or its clause was not run.
pub(super) fn obstacle_value(instance: &Instance, name: Symbol, array: bool, span: Span) -> Eval<Value> {
    let design = &instance.design;
    let Some((config, scene)) = design.config().zip(design.scene()) else { return Ok(Value::Unknown) };
    let mut of_name: Vec<ObstacleRecord> =
        scene.obstacles.borrow().iter().filter(|obstacle| obstacle.group == name).cloned().collect();
    of_name.sort_by_key(|obstacle| obstacle.index);
    let shape =
        |record: ObstacleRecord| Value::Shape(Rc::new(Solid { parts: record.shapes, ..Solid::default() }));
    if array {
        return Ok(Value::list(of_name.into_iter().map(shape).collect()));
    }
    if design.broken.get() {
        return Ok(Value::Unknown);
    }
    of_name.pop().map(shape).ok_or_else(|| {
        if config.complete.get() {
            let message = format!("`{name}` does not stand in `{}`: its clause was not run", design.name);
            return fault(code::BAD_VALUE, span, message, "no obstacle here");
        }
        let message = format!("the obstacle `{name}` is needed before it stands");
        fault(code::DECLARATION_CYCLE, span, message, "write it below the obstacle")
    })
}
