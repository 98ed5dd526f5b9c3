//! What is around a truss in a call of `morph` or `locomote`: obstacles and terrain, for the planner and in
//! the plan.

use crate::elaborate::truss::TrussDesign;
use crate::geometry::{HeightField, Placed, Solid, Vec3};
use crate::interpret::call::Call;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::planners::truss::Structure;
use crate::robot::Strut;
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use crate::{plan, planners};

/// What a call names, in the world's frame.
pub struct Around {
    /// The parameters that name obstacles and terrain; there is terrain only where something stands.
    at: (usize, Option<usize>),
    pub shapes: Vec<Vec<Placed>>,
    pub solids: Vec<Solid>,
    pub terrain: Option<HeightField>,
}

impl Around {
    /// Of the parameters for obstacles and terrain.
    pub fn of(call: &Call, obstacles: usize, terrain: Option<usize>) -> Eval<Around> {
        let mut around =
            Around { at: (obstacles, terrain), shapes: Vec::new(), solids: Vec::new(), terrain: None };
        for (i, shape) in call.list(obstacles)?.iter().enumerate() {
            let Value::Shape(shape) = shape else { return Err(call.refuse(obstacles, "shapes are wanted")) };
            let solid = Solid::new(&shape.parts)
                .map_err(|why| call.refuse(obstacles, format!("obstacle {} is no solid: {why}", i + 1)))?;
            around.shapes.push(shape.parts.clone());
            around.solids.push(solid);
        }
        if let Some(index) = terrain.filter(|index| !call.is_missing(*index)) {
            let Value::Terrain(field) = call.arg(index) else {
                return Err(call.refuse(index, "a terrain is wanted"));
            };
            around.terrain = Some((**field).clone());
        }
        Ok(around)
    }

    pub fn planned(&self) -> plan::Surroundings {
        plan::Surroundings { obstacles: self.shapes.clone(), terrain: self.terrain.clone() }
    }

    /// For the planner.
    pub fn compiled(&self, strut: &Strut) -> planners::truss::Surroundings {
        planners::truss::Surroundings::new(&self.solids, self.terrain.clone(), strut.clearance / 2.0)
    }

    /// Refuses a truss that begins in what is around it.
    pub fn free(&self, call: &Call, design: &TrussDesign, truss: &Structure, x: &[Vec3]) -> Eval<()> {
        for strut in 0..truss.struts.len() {
            let ends = truss.segment(x, strut);
            for (part, (obstacle, _)) in truss.around.parts.iter().enumerate() {
                let near = truss.around.may_meet(ends, part, truss.clearance);
                if near && truss.around.nearness(ends, part, truss.clearance).distance < truss.clearance {
                    let what = format!("too near to obstacle {}", obstacle + 1);
                    return Err(met(call, self.at.0, &design.strut_name(strut), &what, truss.clearance));
                }
            }
            let depth = self.terrain.as_ref().map_or(0.0, |field| -field.lowest(ends.0, ends.1).1);
            if let Some(index) = self.at.1.filter(|_| depth > truss.around.sink) {
                let what = format!("{} in the ground", quantity(depth, Dimension::LENGTH));
                return Err(met(call, index, &design.strut_name(strut), &what, truss.around.sink));
            }
        }
        match self.solids.iter().position(|solid| x.iter().any(|p| solid.encloses(p))) {
            None => Ok(()),
            Some(obstacle) => {
                Err(call.refuse(self.at.0, format!("the truss begins inside obstacle {}", obstacle + 1)))
            }
        }
    }
}

fn met(call: &Call, index: usize, strut: &str, what: &str, limit: f64) -> Stop {
    let limit = quantity(limit, Dimension::LENGTH);
    Diagnostic::error(code::BAD_VALUE, format!("the strut {strut} is {what} where the truss begins"))
        .label(call.at(index), format!("{limit} is the limit"))
        .hint("declare the truss elsewhere, or move what is in its way")
        .into()
}
