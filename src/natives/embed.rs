//! The built-in `embed`, and what the standard library can do with a robot.

use super::Native;
use crate::check::typed::{DefId, DefKind};
use crate::interpret::argument::parameters;
use crate::interpret::capability::{Capabilities, Capability};
use crate::interpret::design::{Design, Instance};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::module_map::ModuleMap;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::Value;
use crate::robot::{EmbeddingAttempt, embeddings};
use crate::source::{Span, code};
use std::rc::Rc;

/// The built-in `embed`: its key with its parameters and its Rust function.
pub(super) const TABLE: &[Native] =
    &[Native::pure("embed", parameters![pattern: &Rc<Instance>, in: &Rc<Instance>], embed)];

/// The greatest number of modules that the embeddings of one call have together. Those of a ring of n modules in itself
/// have n².
const MODULES_MAX: usize = 1_000_000;

/// Runs `embed(pattern, in: robot)`: an instance of the pattern for each of its embeddings.
///
/// # Errors
/// A fault where the pattern is in pieces, or the embeddings have more than [`MODULES_MAX`] modules; `Stop::Halt` if a
/// limit is reached or the user cancels.
fn embed(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (pattern, robot) = (call.get::<&Rc<Instance>>("pattern")?, call.get::<&Rc<Instance>>("in")?);
    let mut found = Vec::new();
    let spans = (call.at("pattern"), call.at("in"));
    let complete = search(interpreter, &pattern.design, &robot.design, spans, |images| {
        if (found.len() + 1) * images.len() > MODULES_MAX {
            let name = &pattern.design.name;
            let message = format!(
                "the embeddings of `{name}` in `{}` have more than {MODULES_MAX} modules together",
                robot.title()
            );
            return Err(fault(code::SIZE_LIMIT, call.span, message, "too many embeddings"));
        }
        let images = images.into_iter().map(|module| robot.modules.index(module)).collect();
        let modules = ModuleMap::embedding(images);
        found.push(Value::Instance(Instance::embedded(pattern.design.clone(), robot.robot.clone(), modules)));
        Ok(())
    })?;
    Ok(if complete { Value::list(found) } else { Value::Unknown })
}

/// Hands each embedding of one design in another to `each`, in the order of the robot's modules; each comparison of two
/// modules counts as an evaluation step. Returns false where one of the robots can't be assembled, which has been
/// reported. `spans`: those of the pattern and of the robot.
///
/// # Errors
/// A fault where the pattern is in pieces, or that of `each`; `Stop::Halt` if a limit is reached or the user cancels.
fn search(
    interpreter: &mut Interpreter,
    pattern: &Rc<Design>,
    robot: &Rc<Design>,
    spans: (Span, Span),
    mut each: impl FnMut(Vec<usize>) -> Eval<()>,
) -> Eval<bool> {
    let pattern_robot = interpreter.robot_at(pattern, spans.0)?;
    let robot = interpreter.robot_at(robot, spans.1)?;
    let (Some(pattern_robot), Some(robot)) = (pattern_robot, robot) else { return Ok(false) };
    let Some(attempts) = embeddings(&pattern_robot.assembly, &robot.assembly) else {
        let message = format!("`{}` is not in one piece", pattern.name);
        return Err(fault(
            code::BAD_VALUE,
            spans.0,
            message,
            "connections do not lead to all of its modules",
        ));
    };
    for EmbeddingAttempt { images, comparisons } in attempts {
        interpreter.stack.steps += comparisons as u64 - 1;
        interpreter.step(spans.0)?;
        if let Some(images) = images {
            each(images)?;
        }
    }
    Ok(true)
}

/// Returns what the standard library can do with a robot: the configurations of its files that the program imports and
/// that embed, with their defaults, and the robot's own. Those that need arguments, or whose names begin with `_`, are
/// left out. `None` where the robot can't be assembled, which has been reported. `at`: the span of the robot.
///
/// # Errors
/// A fault of a declaration, or `Stop::Halt` if a limit is reached or the user cancels.
pub fn capabilities(
    interpreter: &mut Interpreter,
    robot: &Rc<Instance>,
    at: Span,
) -> Eval<Option<Capabilities>> {
    let own = &robot.design;
    let mut patterns = Vec::new();
    // A robot that a planner put together has the declaration of its modules, which has no behaviours.
    // A scene is no robot that others could hold.
    let kind = &interpreter.shared.program.def(own.def).kind;
    if matches!(kind, DefKind::Config(_)) && !kind.is_scene() {
        patterns.push(own.clone());
    }
    for def in library_configurations(interpreter) {
        let design = interpreter.default_design(def)?.filter(|design| !design.broken.get());
        patterns.extend(design.filter(|design| design.module_count() > 0 && design.def != own.def));
    }
    let mut configurations = Vec::new();
    for pattern in patterns {
        let mut found = 0;
        let count = |_| {
            found += 1;
            Ok(())
        };
        if !search(interpreter, &pattern, own, (at, at), count)? {
            return Ok(None);
        }
        if found > 0 {
            let (def, name) = (pattern.def, pattern.name.clone());
            configurations.push(Capability { def, name, embeddings: found });
        }
    }
    Ok(Some(Capabilities { robot: own.name.clone(), modules: own.module_count(), configurations }))
}

/// Returns the public configurations of the library's files, by file and in the order of their declarations.
fn library_configurations(interpreter: &Interpreter) -> Vec<DefId> {
    let shared = &interpreter.shared;
    let public = shared.program.identified().filter(|(_, def)| {
        matches!(def.kind, DefKind::Config(_))
            && !def.kind.is_scene()
            && shared.sources.file(def.file).library
            && !def.name.as_str().starts_with('_')
    });
    let mut found: Vec<_> =
        public.map(|(id, def)| (&shared.sources.file(def.file).name, def.span.start, id)).collect();
    found.sort_unstable();
    found.into_iter().map(|(.., id)| id).collect()
}
