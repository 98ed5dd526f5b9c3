//! The scope of an expression: locals in frames, and captures of lambdas.

use super::checker::TypeParam;
use super::typed::{DefId, Local};
use super::types::Type;
use crate::source::Symbol;

/// The scope of an expression: its file, its locals, and the declaration whose instance `this` is.
pub(super) struct Scope {
    /// The file in which names are resolved, as an index into the loaded files.
    pub file: usize,
    /// The declaration with instances in whose body the expression is; `None` elsewhere.
    pub this: Option<DefId>,
    /// The type parameters of the function being checked, in order; empty elsewhere.
    pub type_params: Vec<TypeParam>,
    /// True in the body of the function that has the type parameters, where they are types of which nothing is known.
    pub in_body: bool,
    /// True in the statements of a behaviour's own block, where contracts stand.
    pub contracts: bool,
    /// True in the body of a behaviour.
    pub in_behavior: bool,
    /// True once a state or a report that only contracts know was named since it was last set to false.
    pub states_named: bool,
    frame: Frame,
    /// Frames around a lambda, innermost last.
    outer: Vec<Frame>,
}

/// The locals of one body. A lambda has a frame of its own.
#[derive(Default)]
struct Frame {
    /// The own locals in scope, innermost last.
    locals: Vec<Binding>,
    /// The captured locals: copies of locals of the frame outside, each with that local.
    captured: Vec<(Binding, Local)>,
    /// The next free slot.
    next: u32,
    /// The number of slots in use at most.
    size: u32,
}

#[derive(Clone)]
struct Binding {
    name: Symbol,
    local: Local,
    ty: Type,
    /// True for a state or a report that only contracts know.
    of_contract: bool,
}

impl Frame {
    /// Reserves the next slot.
    fn slot(&mut self) -> Local {
        let local = Local(self.next);
        self.next += 1;
        self.size = self.size.max(self.next);
        local
    }

    /// Returns the innermost local of a name, captures included; `None` if there is none.
    fn find(&self, name: Symbol) -> Option<&Binding> {
        let own = self.locals.iter().rev().find(|b| b.name == name);
        own.or_else(|| self.captured.iter().map(|(b, _)| b).find(|b| b.name == name))
    }
}

impl Scope {
    /// Returns a scope without locals in a file (an index into the loaded files), in the body of `this`.
    pub(super) fn new(file: usize, this: Option<DefId>) -> Scope {
        Scope {
            file,
            this,
            type_params: Vec::new(),
            in_body: false,
            contracts: false,
            in_behavior: false,
            states_named: false,
            frame: Frame::default(),
            outer: Vec::new(),
        }
    }

    /// Adds a local to the innermost scope, and returns its slot.
    pub(super) fn bind(&mut self, name: Symbol, ty: Type) -> Local {
        let local = self.frame.slot();
        self.frame.locals.push(Binding { name, local, ty, of_contract: false });
        local
    }

    /// Adds a state or a report that only contracts know to the innermost scope, and returns its slot.
    pub(super) fn bind_of_contract(&mut self, name: Symbol, ty: Type) -> Local {
        let local = self.bind(name, ty);
        self.frame.locals.iter_mut().rev().take(1).for_each(|bound| bound.of_contract = true);
        local
    }

    /// Opens an inner scope, and returns the mark (locals, slot) with which [`Scope::close`] closes it: the number of
    /// locals, and the next free slot.
    pub(super) fn open(&self) -> (usize, u32) {
        (self.frame.locals.len(), self.frame.next)
    }

    /// Closes the inner scope that was opened at the mark: its locals end, and their slots are free again.
    pub(super) fn close(&mut self, mark: (usize, u32)) {
        self.frame.locals.truncate(mark.0);
        // In a lambda, captures made since may lie above the mark: their slots stay taken.
        if self.outer.is_empty() {
            self.frame.next = mark.1;
        }
    }

    /// Returns the number of slots for locals that the body needs.
    pub(super) fn frame(&self) -> usize {
        self.frame.size as usize
    }

    /// Returns true if a local of this name was added since the mark.
    pub(super) fn bound_since(&self, mark: (usize, u32), name: Symbol) -> bool {
        self.frame.locals[mark.0..].iter().any(|b| b.name == name)
    }

    /// Starts the frame of a lambda: locals added from here on belong to it, and those outside are captured when used.
    pub(super) fn enter_lambda(&mut self) {
        self.outer.push(std::mem::take(&mut self.frame));
    }

    /// Ends the frame of a lambda, and returns its size in slots and its captures as (outer local, inner local).
    /// Panics if no lambda was entered.
    pub(super) fn leave_lambda(&mut self) -> (usize, Vec<(Local, Local)>) {
        let outer = self.outer.pop().expect("a lambda was entered");
        let frame = std::mem::replace(&mut self.frame, outer);
        let captures = frame.captured.iter().map(|(b, from)| (*from, b.local)).collect();
        (frame.size as usize, captures)
    }

    /// Returns (local, type) of the local of this name, captured from an outer frame if need be; `None` if there is
    /// none.
    pub(super) fn local(&mut self, name: Symbol) -> Option<(Local, Type)> {
        let found = self.local_at(name, self.outer.len())?;
        self.states_named |= found.of_contract;
        Some((found.local, found.ty))
    }

    /// Returns a local as seen from the frame at this depth, captured from the frames outside if need be.
    fn local_at(&mut self, name: Symbol, depth: usize) -> Option<Binding> {
        if let Some(binding) = self.frame_at(depth).find(name) {
            return Some(binding.clone());
        }
        let outside = self.local_at(name, depth.checked_sub(1)?)?;
        let frame = self.frame_at(depth);
        let inside = Binding { local: frame.slot(), ..outside.clone() };
        frame.captured.push((inside.clone(), outside.local));
        Some(inside)
    }

    /// Returns the frame at a depth; the innermost has the number of outer frames.
    fn frame_at(&mut self, depth: usize) -> &mut Frame {
        if depth == self.outer.len() { &mut self.frame } else { &mut self.outer[depth] }
    }

    /// Returns the type of a local, without capturing it; `None` if there is none.
    pub(super) fn local_type(&self, name: Symbol) -> Option<&Type> {
        let frames = std::iter::once(&self.frame).chain(self.outer.iter().rev());
        frames.filter_map(|f| f.find(name)).map(|b| &b.ty).next()
    }

    /// Returns true if there is a local of this name.
    pub(super) fn has_local(&self, name: Symbol) -> bool {
        self.local_type(name).is_some()
    }

    /// Returns the names of all locals in scope, those around a lambda included; a name that is shadowed comes twice.
    pub(super) fn local_names(&self) -> impl Iterator<Item = &'static str> + '_ {
        let frames = std::iter::once(&self.frame).chain(&self.outer);
        frames.flat_map(|frame| &frame.locals).map(|b| b.name.as_str())
    }
}
