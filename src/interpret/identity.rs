//! The names under which a program holds a robot.
//!
//! Configurations are values: two that are equal are one robot. A program that makes equal ones and gives them
//! two names means two robots, which one behaviour can't move. Names are told apart by where they are bound,
//! so that a function may bind an equal robot at each call.

use crate::source::Span;
use std::cell::RefCell;
use std::rc::Rc;

/// Most names that are remembered of one robot; a program that binds it more often means one.
const NAMES_MAX: usize = 64;

/// A name of a robot: the code that binds it (as a `let` does), and the index if it is bound as one of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    /// The span of the code that binds the name: the value of a `let`, the declaration of a parameter, or the list
    /// that a loop goes through.
    pub span: Span,
    /// The index of the robot in the list, from 0; `None` if it is bound alone.
    pub index: Option<usize>,
}

/// The identity of a robot that a program makes, with the names it is bound to. Copies are the same robot.
#[derive(Clone, Debug, Default)]
pub struct Identity(Rc<RefCell<Vec<Name>>>);

impl Identity {
    /// Adds a name to all copies of the robot. Of one robot `NAMES_MAX` names are kept; further ones are dropped.
    pub fn bind(&self, name: Name) {
        let mut names = self.0.borrow_mut();
        if names.len() < NAMES_MAX && !names.contains(&name) {
            names.push(name);
        }
    }

    /// Returns, for two robots that the program names differently, a name of each that the other lacks, this one's
    /// first. `None` where the program may mean one robot: for copies, and where all names of one are names of the
    /// other, as where it has none.
    pub fn apart(&self, other: &Identity) -> Option<(Name, Name)> {
        if Rc::ptr_eq(&self.0, &other.0) {
            return None;
        }
        let (ours, theirs) = (self.0.borrow(), other.0.borrow());
        let lacking = |of: &[Name], in_those: &[Name]| of.iter().find(|n| !in_those.contains(n)).copied();
        Some((lacking(&ours, &theirs)?, lacking(&theirs, &ours)?))
    }

    /// Returns, of two robots that may be one, the one with more names; of equally many, this one.
    pub fn better_known(self, other: &Identity) -> Identity {
        if other.0.borrow().len() > self.0.borrow().len() { other.clone() } else { self }
    }
}
