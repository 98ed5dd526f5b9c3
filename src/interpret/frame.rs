//! The variables of a body under evaluation.

use super::design::Instance;
use super::value::{ContractValue, Value};
use crate::check::typed::Local;
use std::rc::Rc;

/// The frame of a body under evaluation: its variables, and the instance whose body it is.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// The values of the variables, by the slot of the variable, from 0; `Value::Unknown` where none was put yet.
    pub slots: Vec<Value>,
    /// The instance whose body is evaluated; `None` outside of declarations with instances.
    pub this: Option<Rc<Instance>>,
    /// The contracts that were stated in the body, in order.
    pub contracts: Vec<ContractValue>,
}

impl Frame {
    /// Returns a frame of `size` slots with unknown values, for a body of `this`; `None` outside of declarations with
    /// instances.
    pub fn new(size: usize, this: Option<Rc<Instance>>) -> Frame {
        Frame { slots: vec![Value::Unknown; size], this, contracts: Vec::new() }
    }

    /// Puts a value into the slot of a variable.
    pub fn set(&mut self, local: Local, value: Value) {
        self.set_slot(local.0 as usize, value);
    }

    /// Puts a value into a slot, counted from 0; a frame that is too small is enlarged.
    pub fn set_slot(&mut self, slot: usize, value: Value) {
        if slot >= self.slots.len() {
            self.slots.resize(slot + 1, Value::Unknown);
        }
        self.slots[slot] = value;
    }

    /// Returns the value of a variable; `Value::Unknown` if none was put into its slot.
    pub fn get(&self, local: Local) -> Value {
        self.slots.get(local.0 as usize).cloned().unwrap_or(Value::Unknown)
    }
}
