//! The panels that the faces of a shape are made of: all alike, or made to measure.

use super::fold_surface::unfoldable;
use crate::interpret::design::{ConfigDesign, Design, DesignKind, FlatModule, Instance};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::routines::Args;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::plan::listed;
use crate::planners::fold::{Panel, Panels, TOLERANCES, Target, Unfoldable, polygon};
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

/// The parameter that states the sides of a panel that is a triangle.
const SIDES: &str = "sides";

/// The advice to have panels made to measure.
const MADE: &str =
    "`fold` makes `Panel` of `std.mori` to measure for each triangle, and `Polygon` for any face";

/// The parameter that states the corners of a panel.
const CORNERS: &str = "corners";

/// A parameter by which panels are made to measure.
#[derive(Clone, Copy)]
struct Measure {
    /// The index of the parameter.
    index: usize,
    /// The name of the parameter: [`SIDES`] or [`CORNERS`].
    name: &'static str,
}

/// A module design that is a panel, with its geometry in numbers.
#[derive(Clone)]
pub(super) struct PanelDesign {
    /// The design of the module of which the panels are made.
    pub design: Rc<Design>,
    /// The geometry, mass and hinges of the panel, as the planner knows them.
    pub panel: Panel,
}

/// The source of panels: the modules in an argument, and the panels that were made of them so far.
pub(super) struct Supply<'c> {
    call: &'c Call<'c>,
    /// The argument.
    module: &'static str,
    kinds: Vec<PanelKind>,
}

/// A module of which panels are made.
struct PanelKind {
    design: Rc<Design>,
    /// The parameter that states what a face measures; `None` where all panels are alike.
    measure: Option<Measure>,
    made: Vec<Rc<PanelDesign>>,
}

impl<'c> Supply<'c> {
    /// Returns the source of panels for the modules in the argument `module`: an instance, or a list of such. A module
    /// with a parameter `sides` or `corners` is made to measure for each face; any other must be a regular polygon.
    ///
    /// # Errors
    /// A fault where a module is no such panel, or states what it measures, or there is none.
    pub(super) fn of(
        interpreter: &mut Interpreter,
        call: &'c Call<'c>,
        module: &'static str,
        modules: &Value,
    ) -> Eval<Supply<'c>> {
        let listed = match modules {
            Value::List(listed) => &listed[..],
            one => std::slice::from_ref(one),
        };
        let mut supply = Supply { call, module, kinds: Vec::new() };
        for value in listed {
            let Value::Instance(instance) = value else { continue };
            let kind = supply.kind(interpreter, instance)?;
            supply.kinds.push(kind);
        }
        if supply.kinds.is_empty() {
            return Err(call.refuse(module, "no panel: at least one module is wanted"));
        }
        Ok(supply)
    }

    /// Returns the kind of panels that are made of a module.
    fn kind(&self, interpreter: &mut Interpreter, instance: &Instance) -> Eval<PanelKind> {
        let (call, module) = (self.call, self.module);
        let design = instance.design.clone();
        let panel = panel_of(interpreter, call, module, &design)?;
        let params = interpreter
            .shared
            .program
            .def(design.def)
            .kind
            .instantiable()
            .map_or(&[][..], |body| body.params);
        let measure = [SIDES, CORNERS].into_iter().find_map(|name| {
            let index = params.iter().position(|param| param.name.as_str() == name)?;
            Some(Measure { index, name })
        });
        match measure {
            Some(measure) => {
                self.check_unstated(interpreter, &design, measure)?;
                Ok(PanelKind { design, measure: Some(measure), made: Vec::new() })
            }
            None if panel.panel.is_regular() => {
                Ok(PanelKind { design, measure: None, made: vec![Rc::new(panel)] })
            }
            None => {
                let why = "no panel for any face: its edges or angles are unequal, and it has no parameter \
                           `corners`, or `sides` of a triangle, that says them";
                Err(call.refuse(module, why))
            }
        }
    }

    /// Refuses stated measures: a panel gets those of its face.
    fn check_unstated(
        &self,
        interpreter: &mut Interpreter,
        design: &Design,
        Measure { index, name }: Measure,
    ) -> Eval<()> {
        let usual = interpreter.default_design(design.def)?;
        let stated = usual.is_some_and(|usual| usual.args[index].same(&design.args[index]) != Some(true));
        if !stated {
            return Ok(());
        }
        let why = format!("a panel gets the {name} of its face: `{name}` can't be stated here");
        Err(self.call.refuse(self.module, why))
    }

    /// Returns the panel of the face of this index of the target, the shape in argument `shape`: of the first module that
    /// is congruent with the face, else of the first that is made to measure. Congruent faces share one.
    ///
    /// # Errors
    /// A fault where no module is as the face, and none can be made so.
    pub(super) fn panel(
        &mut self,
        interpreter: &mut Interpreter,
        shape: &'static str,
        target: &Target,
        face: usize,
    ) -> Eval<Rc<PanelDesign>> {
        let alike = self.kinds.iter().filter(|kind| kind.measure.is_none()).map(|kind| &kind.made[0]);
        let mut alike =
            alike.filter(|made| target.check_panel(face, &made.panel.measures, TOLERANCES.side).is_ok());
        if let Some(panel) = alike.next() {
            return Ok(panel.clone());
        }
        drop(alike);
        let Some(at) = self.kinds.iter().position(|kind| kind.measure.is_some()) else {
            return Err(self.misfit(shape, target, face));
        };
        let wanted = target.measures(face);
        let same =
            |made: &&Rc<PanelDesign>| polygon::equal(&made.panel.measures, &wanted, TOLERANCES.same_panel);
        if let Some(made) = self.kinds[at].made.iter().find(same) {
            return Ok(made.clone());
        }
        let panel = Rc::new(self.to_measure(interpreter, shape, &self.kinds[at], target, face)?);
        self.kinds[at].made.push(panel.clone());
        Ok(panel)
    }

    /// Returns the fault for a face with which no module is congruent.
    fn misfit(&self, shape: &'static str, target: &Target, face: usize) -> Stop {
        if let [kind] = &self.kinds[..]
            && let Err(fault) = self.check_face(shape, target, face, &kind.made[0].panel)
        {
            return fault;
        }
        let why = Unfoldable::NoPanel { face, sides: target.side_lengths(face) };
        unfoldable(self.call, shape, &why).label(self.call.at(self.module), "these panels").hint(MADE).into()
    }

    /// Checks that a face (an index in the target's faces) is congruent with `panel`, which is a regular polygon.
    /// `shape`: the argument with the target.
    ///
    /// # Errors
    /// A fault where they differ.
    pub(super) fn check_face(
        &self,
        shape: &'static str,
        target: &Target,
        face: usize,
        panel: &Panel,
    ) -> Eval<()> {
        target.check_panel(face, &panel.measures, TOLERANCES.side).map_err(|why| {
            let said = unfoldable(self.call, shape, &why).label(self.call.at(self.module), "these panels");
            let other = match self.kinds.iter().all(|kind| kind.measure.is_none()) {
                true => MADE,
                false => "panels change places on a lattice of equal triangles: all sides of both shapes have to be equal",
            };
            said.hint(other).into()
        })
    }

    /// Returns the module made to measure for a face (an index in the target's faces).
    ///
    /// # Errors
    /// A fault where the module refuses these measures, or has others in the end.
    fn to_measure(
        &self,
        interpreter: &mut Interpreter,
        shape: &'static str,
        kind: &PanelKind,
        target: &Target,
        face: usize,
    ) -> Eval<PanelDesign> {
        let measure = kind.measure.expect("it is made to measure");
        let sides = target.side_lengths(face);
        let mut values: Vec<Option<Value>> = kind.design.args.iter().cloned().map(Some).collect();
        let stated = match measure.name {
            SIDES if sides.len() == 3 => {
                sides.iter().map(|side| Value::Quantity(*side, Dimension::LENGTH)).collect()
            }
            SIDES => return Err(self.no_triangle(shape, face, sides.len())),
            _ => target.outline(face).into_iter().map(|at| Value::Vec3(at, Dimension::LENGTH)).collect(),
        };
        values[measure.index] = Some(Value::list(stated));
        let args = Args { values, spans: Vec::new() };
        let call = self.call;
        let (made, found) = interpreter.capture_diagnostics(|interpreter| {
            interpreter.design_of(kind.design.def, args, call.at(self.module))
        });
        let refuse = |why: String| -> Stop {
            let lengths: Vec<String> = sides.iter().map(|side| quantity(*side, Dimension::LENGTH)).collect();
            let message = format!("face {face}, with sides of {}, can't be made: {why}", listed(&lengths));
            Diagnostic::error(code::UNFOLDABLE, message)
                .label(call.at(shape), "does not fold")
                .label(call.at(self.module), "made to measure of this")
                .hint(
                    "thinner panels take smaller faces; leave out, or move the corners of, what is a sliver",
                )
                .into()
        };
        let said = |found: Vec<Diagnostic>| match found.into_iter().next() {
            Some(said) => said.message,
            None => format!("the module refuses these {}", measure.name),
        };
        let design = match made {
            Ok(Some(design)) if !design.broken.get() && found.is_empty() => design,
            // Forgotten, so that it says again what is wrong when it is asked for again.
            Ok(Some(design)) => {
                interpreter.memory.designs[design.def.0 as usize].remove(&design);
                return Err(refuse(said(found)));
            }
            Ok(None) | Err(Stop::Fault(_)) => return Err(refuse(said(found))),
            Err(halt) => return Err(halt),
        };
        let panel = panel_of(interpreter, call, self.module, &design)?;
        if !polygon::equal(&panel.panel.measures, &target.measures(face), TOLERANCES.side) {
            return Err(refuse(format!("the module does not keep to its parameter `{}`", measure.name)));
        }
        Ok(panel)
    }

    /// Returns the fault for a face that is no triangle where the module has the parameter `sides`.
    fn no_triangle(&self, shape: &'static str, face: usize, sides: usize) -> Stop {
        let message =
            format!("face {face} has {sides} sides, and sides alone give only triangles their form");
        Diagnostic::error(code::UNFOLDABLE, message)
            .label(self.call.at(shape), "does not fold")
            .label(self.call.at(self.module), "made to measure by `sides`")
            .hint("`Polygon` of `std.mori` is made to measure by its `corners`; or cut such faces into triangles")
            .into()
    }
}

/// Returns a design as a panel; `key`: the argument that it came from.
///
/// # Errors
/// A fault where it is not a module, or not a panel.
fn panel_of(
    interpreter: &mut Interpreter,
    call: &Call,
    key: &'static str,
    design: &Rc<Design>,
) -> Eval<PanelDesign> {
    let no_panel = |why: &str| call.refuse(key, format!("no panel: {why}"));
    if design.module().is_none() {
        return Err(no_panel("a module is wanted"));
    }
    let Some(robot) = interpreter.robot_of(design, call.at(key))? else {
        return Err(no_panel("its module is not sound"));
    };
    let panel = Panel::of(&robot.assembly.library, 0).map_err(|why| no_panel(&why.to_string()))?;
    Ok(PanelDesign { design: design.clone(), panel })
}

/// The panels of all faces of a target, as designs of the language and as data of the planner.
pub(super) struct Sheet {
    /// The designs of the panels: entry k is that of the panel for face k of the target.
    pub designs: Vec<Rc<Design>>,
    /// The panels as data of the planner, in the order of the target's faces.
    pub panels: Panels,
}

impl Sheet {
    /// Returns the panels of a target from their designs, by face in the order of the target's; `key`: the argument
    /// that they came from.
    ///
    /// # Errors
    /// A fault where a module is broken, or the planner refuses the panels.
    pub(super) fn of(
        interpreter: &mut Interpreter,
        call: &Call,
        key: &'static str,
        designs: Vec<Rc<Design>>,
    ) -> Eval<Sheet> {
        let no_panel = |why: &str| call.refuse(key, format!("no panel: {why}"));
        let all = unjoined(&designs);
        let Some((library, kinds)) = interpreter.library_of(&all)? else {
            return Err(no_panel("its module is not sound"));
        };
        let panels = Panels::new(Arc::new(library), kinds).map_err(|why| no_panel(&why.to_string()))?;
        Ok(Sheet { designs, panels })
    }
}

/// Returns the configuration of panels, by face, without bonds and without a base.
fn unjoined(designs: &[Rc<Design>]) -> Rc<Design> {
    let name = |face: usize| -> Rc<str> { format!("panel[{face}]").into() };
    let panels = designs.iter().enumerate();
    let modules = panels.map(|(face, panel)| FlatModule { name: name(face), design: panel.clone() });
    Rc::new(Design {
        def: designs[0].def,
        name: format!("{}[{}]", designs[0].name, designs.len()),
        args: Vec::new(),
        kind: DesignKind::Config(ConfigDesign::of_modules(modules.collect())),
        broken: Cell::new(false),
    })
}

/// The faces that are made of a module without motors, so that two of them share no hinge.
pub(super) struct Passive<'c> {
    /// The indices of the faces, from 0: the argument `passive`.
    pub(super) faces: &'c [Value],
    /// The module, the argument `passive_module`; `None` if it is left out.
    pub(super) module: Option<&'c Rc<Instance>>,
}

/// Returns (panels, shape): the panels of the shape in argument `target`, and that shape with the hinges that its
/// passive faces leave.
///
/// # Errors
/// A fault where a face has no panel, or a passive face is wrong.
pub(super) fn panels(
    interpreter: &mut Interpreter,
    supply: &mut Supply,
    passive: &Passive,
    target: Target,
) -> Eval<(Sheet, Target)> {
    const SHAPE: &str = "target";
    const LISTED: &str = "passive";
    let call = supply.call;
    let faces = 0..target.faces.len();
    let mut panels =
        faces.map(|face| supply.panel(interpreter, SHAPE, &target, face)).collect::<Eval<Vec<_>>>()?;
    let mut target = target;
    if !passive.faces.is_empty() {
        let Some(module) = passive.module else {
            return Err(call.refuse(LISTED, "of what are they? `passive_module` says it"));
        };
        let module = Value::Instance(module.clone());
        let mut light = Supply::of(interpreter, call, "passive_module", &module)?;
        let mut driven = vec![true; panels.len()];
        for value in passive.faces {
            let Value::Int(face) = value else { continue };
            let Some(face) = usize::try_from(*face).ok().filter(|face| *face < panels.len()) else {
                return Err(
                    call.refuse(LISTED, format!("there is no face {face}: there are {}", panels.len()))
                );
            };
            driven[face] = false;
            panels[face] = light.panel(interpreter, SHAPE, &target, face)?;
        }
        target = target.driven(&driven).map_err(|why| -> Stop { unfoldable(call, LISTED, &why).into() })?;
    }
    let designs = panels.iter().map(|panel| panel.design.clone()).collect();
    Ok((Sheet::of(interpreter, call, supply.module, designs)?, target))
}
