//! The panels that the faces of a shape are made of: all alike, or made to measure.

use super::fold_surface::unfoldable;
use crate::interpret::design::{ConfigDesign, Design, DesignKind, FlatModule, Instance};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::routines::Args;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::planners::fold::{Panel, Panels, TOLERANCES, Target, equal_sides};
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

/// The parameter that states a panel's sides.
const SIDES: &str = "sides";

/// A module design that is a triangular panel, with its geometry in numbers.
#[derive(Clone)]
pub(super) struct PanelDesign {
    /// The design of the module of which the panels are made.
    pub design: Rc<Design>,
    /// The geometry, mass and hinges of the panel, as the planner knows them.
    pub panel: Panel,
}

/// The source of panels: the module in an argument, and the panels that were made of it so far.
pub(super) struct Supply<'c> {
    call: &'c Call<'c>,
    /// The argument.
    module: &'static str,
    design: Rc<Design>,
    /// The index of the parameter that states the sides; `None` where all panels are alike.
    sides: Option<usize>,
    made: Vec<Rc<PanelDesign>>,
}

impl<'c> Supply<'c> {
    /// Returns the source of panels for the module `instance`, given in the argument `module`. A module with a
    /// parameter `sides` is made for each face by its sides; any other must have three equal sides.
    ///
    /// # Errors
    /// A fault where the module is no such panel, or `sides` is stated.
    pub(super) fn of(
        interpreter: &mut Interpreter,
        call: &'c Call<'c>,
        module: &'static str,
        instance: &Instance,
    ) -> Eval<Supply<'c>> {
        let design = instance.design.clone();
        let panel = panel_of(interpreter, call, module, &design)?;
        let params = interpreter
            .shared
            .program
            .def(design.def)
            .kind
            .instantiable()
            .map_or(&[][..], |body| body.params);
        let sides = params.iter().position(|param| param.name.as_str() == SIDES);
        let mut supply = Supply { call, module, design, sides, made: Vec::new() };
        match sides {
            Some(sides) => supply.check_unstated(interpreter, sides)?,
            None if panel.panel.is_equilateral() => supply.made.push(Rc::new(panel)),
            None => {
                let why = "no triangular panel: its edges are of unequal lengths, and it has no parameter \
                           `sides` that says them";
                return Err(call.refuse(module, why));
            }
        }
        Ok(supply)
    }

    /// Refuses stated sides: a panel gets those of its face. `sides`: the index of the parameter.
    fn check_unstated(&self, interpreter: &mut Interpreter, sides: usize) -> Eval<()> {
        let usual = interpreter.default_design(self.design.def)?;
        let stated =
            usual.is_some_and(|usual| usual.args[sides].same(&self.design.args[sides]) != Some(true));
        if !stated {
            return Ok(());
        }
        let why = "a panel gets the sides of its face: `sides` can't be stated here";
        Err(self.call.refuse(self.module, why))
    }

    /// Returns the panel of the face of this index of the target, the shape in argument `shape`; faces of equal sides
    /// share one.
    ///
    /// # Errors
    /// A fault where the module can't be made with the sides of the face, or has other ones.
    pub(super) fn panel(
        &mut self,
        interpreter: &mut Interpreter,
        shape: &'static str,
        target: &Target,
        face: usize,
    ) -> Eval<Rc<PanelDesign>> {
        let Some(sides) = self.sides else {
            let panel = self.made[0].clone();
            self.check_side(shape, target, face, &panel.panel)?;
            return Ok(panel);
        };
        let wanted = target.side_lengths(face);
        let same = |made: &&Rc<PanelDesign>| equal_sides(made.panel.sides, wanted, TOLERANCES.same_panel);
        if let Some(made) = self.made.iter().find(same) {
            return Ok(made.clone());
        }
        let panel = Rc::new(self.to_measure(interpreter, shape, sides, face, wanted)?);
        self.made.push(panel.clone());
        Ok(panel)
    }

    /// Checks that the sides of a face (an index in the target's faces) are as long as those of `panel`, which are
    /// equal. `shape`: the argument with the target.
    ///
    /// # Errors
    /// A fault where they differ.
    pub(super) fn check_side(
        &self,
        shape: &'static str,
        target: &Target,
        face: usize,
        panel: &Panel,
    ) -> Eval<()> {
        let wanted = panel.sides[0];
        target.check_sides_of(face, wanted, TOLERANCES.side * wanted).map_err(|why| {
            let said = unfoldable(self.call, shape, &why).label(self.call.at(self.module), "these panels");
            let other = match self.sides {
                None => "`fold` makes `Panel` of `std.mori` to measure for each face",
                Some(_) => "panels change places on a lattice of equal triangles: all sides of both shapes have to be equal",
            };
            said.hint(other).into()
        })
    }

    /// Returns the module made with the sides `wanted` (m) of a face; `sides`: the index of the parameter.
    ///
    /// # Errors
    /// A fault where the module refuses these sides, or has others in the end.
    fn to_measure(
        &self,
        interpreter: &mut Interpreter,
        shape: &'static str,
        sides: usize,
        face: usize,
        wanted: [f64; 3],
    ) -> Eval<PanelDesign> {
        let mut values: Vec<Option<Value>> = self.design.args.iter().cloned().map(Some).collect();
        let lengths = wanted.map(|side| Value::Quantity(side, Dimension::LENGTH));
        values[sides] = Some(Value::list(lengths.to_vec()));
        let args = Args { values, spans: Vec::new() };
        let call = self.call;
        let (made, found) = interpreter.capture_diagnostics(|interpreter| {
            interpreter.design_of(self.design.def, args, call.at(self.module))
        });
        let refuse = |why: String| -> Stop {
            let [a, b, c] = wanted.map(|side| quantity(side, Dimension::LENGTH));
            let message = format!("face {face}, with sides of {a}, {b} and {c}, can't be made: {why}");
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
            None => "the module refuses these sides".into(),
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
        if !equal_sides(panel.panel.sides, wanted, TOLERANCES.side) {
            return Err(refuse("the module does not keep to its parameter `sides`".into()));
        }
        Ok(panel)
    }
}

/// Returns a design as a panel; `key`: the argument that it came from.
///
/// # Errors
/// A fault where it is not a module, or not a triangular panel.
fn panel_of(
    interpreter: &mut Interpreter,
    call: &Call,
    key: &'static str,
    design: &Rc<Design>,
) -> Eval<PanelDesign> {
    let no_panel = |why: &str| call.refuse(key, format!("no triangular panel: {why}"));
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
        let no_panel = |why: &str| call.refuse(key, format!("no triangular panel: {why}"));
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
        let mut light = Supply::of(interpreter, call, "passive_module", module)?;
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
