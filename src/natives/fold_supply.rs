//! What the faces of a shape are made of: panels that are all alike, or panels made to measure.

use super::fold_panel::{Panel, TOL_SIDE, alike, unfoldable};
use crate::elaborate::instance::params_of;
use crate::interpret::call::{Args, Call};
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::planners::fold::Target;
use crate::planners::fold::sweep_collision::Solids;
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// The parameter that says a panel's sides.
const SIDES: &str = "sides";

/// Faces whose sides differ by less than this part of the longest get the same panel: rounding.
const TOL_ALIKE: f64 = 1e-9;

/// The module in an argument, and the panels that were made of it.
pub struct Supply<'c> {
    call: &'c Call<'c>,
    /// Which argument it is.
    module: usize,
    design: Rc<Design>,
    /// Which parameter its sides are; `None` where all panels are alike.
    sides: Option<usize>,
    made: Vec<Rc<Panel>>,
}

impl<'c> Supply<'c> {
    /// The module in argument `index`. One with a parameter `sides` is made to measure.
    pub fn of(interpreter: &mut Interpreter, call: &'c Call, index: usize) -> Eval<Supply<'c>> {
        let design = call.instance(index)?.design.clone();
        let panel = Panel::of(interpreter, call, index, &design)?;
        let params = params_of(&interpreter.program.def(design.def).kind).unwrap_or_default();
        let sides = params.iter().position(|param| param.name.as_str() == SIDES);
        let mut supply = Supply { call, module: index, design, sides, made: Vec::new() };
        match sides {
            Some(sides) => supply.check_unstated(interpreter, sides)?,
            None if panel.is_equilateral() => supply.made.push(Rc::new(panel)),
            None => {
                let why = "no triangular panel: its edges are of unequal lengths, and it has no parameter \
                           `sides` that says them";
                return Err(call.refuse(index, why));
            }
        }
        Ok(supply)
    }

    /// Sides that a panel gets from its face are not stated.
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

    /// The panel of a face of the shape in argument `shape`.
    pub fn panel(
        &mut self,
        interpreter: &mut Interpreter,
        shape: usize,
        target: &Target,
        face: usize,
    ) -> Eval<Rc<Panel>> {
        let Some(sides) = self.sides else {
            let panel = self.made[0].clone();
            self.check_side(shape, target, face, &panel)?;
            return Ok(panel);
        };
        let wanted = target.side_lengths(face);
        if let Some(panel) = self.made.iter().find(|panel| alike(panel.sides, wanted, TOL_ALIKE)) {
            return Ok(panel.clone());
        }
        let panel = Rc::new(self.to_measure(interpreter, shape, sides, face, wanted)?);
        self.made.push(panel.clone());
        Ok(panel)
    }

    /// A face as panels of one size have it.
    pub fn check_side(&self, shape: usize, target: &Target, face: usize, panel: &Panel) -> Eval<()> {
        let wanted = panel.sides[0];
        target.check_sides_of(face, wanted, TOL_SIDE * wanted).map_err(|why| {
            let said = unfoldable(self.call, shape, &why).label(self.call.at(self.module), "these panels");
            let other = match self.sides {
                None => "`fold` makes `Panel` of `std.mori` to measure for each face",
                Some(_) => "panels change places on a lattice of equal triangles: all sides of both shapes have to be equal",
            };
            said.hint(other).into()
        })
    }

    /// The module with the sides of a face.
    fn to_measure(
        &self,
        interpreter: &mut Interpreter,
        shape: usize,
        sides: usize,
        face: usize,
        wanted: [f64; 3],
    ) -> Eval<Panel> {
        let mut values: Vec<Option<Value>> = self.design.args.iter().cloned().map(Some).collect();
        let lengths = wanted.map(|side| Value::Quantity(side, Dimension::LENGTH));
        values[sides] = Some(Value::list(lengths.to_vec()));
        let args = Args { values, spans: Vec::new() };
        let call = self.call;
        let (made, found) = interpreter
            .aside(|interpreter| interpreter.design_of(self.design.def, args, call.at(self.module)));
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
            // Asked for again, it says again what is wrong.
            Ok(Some(design)) => {
                interpreter.designs[design.def.0 as usize].retain(|known| !Rc::ptr_eq(known, &design));
                return Err(refuse(said(found)));
            }
            Ok(None) | Err(Stop::Fault(_)) => return Err(refuse(said(found))),
            Err(halt) => return Err(halt),
        };
        let panel = Panel::of(interpreter, call, self.module, &design)?;
        if !alike(panel.sides, wanted, TOL_SIDE) {
            return Err(refuse("the module does not keep to its parameter `sides`".into()));
        }
        Ok(panel)
    }
}

/// What each face is made of.
pub struct Panels {
    /// By face.
    pub designs: Vec<Rc<Design>>,
    /// By face, kg.
    pub masses: Vec<f64>,
    /// By face, m.
    pub thickness: Vec<f64>,
    pub solids: Solids,
    /// What holds of every panel: the least that hinges can do, the greatest thickness.
    pub weakest: Panel,
}

impl Panels {
    /// By face.
    pub fn of(panels: &[Rc<Panel>]) -> Panels {
        Panels {
            designs: panels.iter().map(|panel| panel.design.clone()).collect(),
            masses: panels.iter().map(|panel| panel.mass).collect(),
            thickness: panels.iter().map(|panel| panel.thickness).collect(),
            solids: Solids {
                parts: panels.iter().map(|panel| panel.parts.clone()).collect(),
                touch: panels.iter().map(|panel| panel.touch).fold(0.0, f64::max),
            },
            weakest: panels.iter().fold((*panels[0]).clone(), |weakest, panel| weakest.weaker(panel)),
        }
    }
}

/// What the faces of the shape in argument `shape` are made of: those listed in argument `listed` of the
/// module in argument `passive`, which has no motors, so that the hinge between two of them is none.
pub fn panels(
    interpreter: &mut Interpreter,
    supply: &mut Supply,
    [shape, listed, passive]: [usize; 3],
    target: Target,
) -> Eval<(Panels, Target)> {
    let call = supply.call;
    let faces = 0..target.faces.len();
    let mut panels =
        faces.map(|face| supply.panel(interpreter, shape, &target, face)).collect::<Eval<Vec<_>>>()?;
    let list = call.list(listed)?.clone();
    if list.is_empty() {
        return Ok((Panels::of(&panels), target));
    }
    if call.is_missing(passive) {
        return Err(call.refuse(listed, "of what are they? `passive_module` says it"));
    }
    let mut light = Supply::of(interpreter, call, passive)?;
    let mut driven = vec![true; panels.len()];
    for value in list.iter() {
        let Value::Int(face) = value else { continue };
        let Some(face) = usize::try_from(*face).ok().filter(|face| *face < panels.len()) else {
            return Err(call.refuse(listed, format!("there is no face {face}: there are {}", panels.len())));
        };
        driven[face] = false;
        panels[face] = light.panel(interpreter, shape, &target, face)?;
    }
    let target = target.driven(&driven).map_err(|why| -> Stop { unfoldable(call, listed, &why).into() })?;
    Ok((Panels::of(&panels), target))
}
