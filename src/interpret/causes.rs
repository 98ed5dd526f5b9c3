//! The causes of commands: spans on the side of the language, numbered causes on the side of plans.

use crate::behavior::Part;
use crate::plan::{Action, Cause, CauseId, Node, Otherwise};
use crate::source::{Sources, Span};
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// The record of a cause: the span of a command in the source, and the call that led there.
#[derive(Clone, Debug)]
pub struct CauseRecord {
    /// The span of the expression that gives the command.
    pub span: Span,
    /// The arguments of an action as (the part of the action that the argument states, span of the argument); empty
    /// for other commands.
    pub args: Vec<(Part, Span)>,
    /// The instance and the loop variables: `leg[2].m[0].tilt (i = 3)`; may be empty.
    pub instance: Rc<str>,
    /// The call in the user's own files, where `span` is in the library; otherwise `None`.
    pub caller: Option<Span>,
}

impl CauseRecord {
    /// Returns the span that a message shows first: the user's own line.
    pub fn primary(&self) -> Span {
        self.caller.unwrap_or(self.span)
    }

    /// Returns the span of an argument of the action; that of the whole action where the argument was left out.
    pub fn argument(&self, part: Part) -> Span {
        self.args.iter().find(|(p, _)| *p == part).map_or(self.span, |(_, span)| *span)
    }
}

/// The causes of a run, each once, so that the same call gives the same behaviour. A plan gets a table of its own, of
/// those that it names.
#[derive(Clone, Default)]
pub struct Causes {
    records: Vec<CauseRecord>,
    /// The number of each cause, by span, instance and caller; the arguments lie within the span.
    known: HashMap<(Span, Rc<str>, Option<Span>), CauseId>,
}

impl Causes {
    /// Adds a cause and returns its number in the run, from 0; one with the same span, instance and caller keeps its
    /// number.
    pub fn add(&mut self, record: CauseRecord) -> CauseId {
        let id = CauseId(u32::try_from(self.records.len()).expect("causes are counted in 32 bits"));
        let key = (record.span, record.instance.clone(), record.caller);
        let known = *self.known.entry(key).or_insert(id);
        if known == id {
            self.records.push(record);
        }
        known
    }

    /// Returns the record of a cause, given by its number in the run. Panics if there is no cause of this number.
    pub fn get(&self, id: CauseId) -> &CauseRecord {
        &self.records[id.0 as usize]
    }
}

/// The causes of one plan, in order of first mention.
#[derive(Default)]
pub struct PlanCauses {
    /// The number in the run of each cause of the plan; the index here, from 0, is the plan's number.
    pub ids: Vec<CauseId>,
    known: HashMap<CauseId, CauseId>,
}

impl PlanCauses {
    /// Returns the number of a cause in the plan, from 0; a new one where the plan does not name it yet.
    pub fn number(&mut self, cause: CauseId) -> CauseId {
        *self.known.entry(cause).or_insert_with(|| {
            self.ids.push(cause);
            CauseId(u32::try_from(self.ids.len() - 1).expect("causes are counted in 32 bits"))
        })
    }

    /// Returns the action graph with the plan's own numbers of causes. Shared nodes stay shared.
    pub fn renumber(&mut self, node: &Arc<Node>) -> Arc<Node> {
        self.renumber_shared(node, &mut HashMap::new())
    }

    /// Returns a node with the plan's own numbers; `done`: the nodes that have been renumbered, by address.
    fn renumber_shared(&mut self, node: &Arc<Node>, done: &mut HashMap<*const Node, Arc<Node>>) -> Arc<Node> {
        if let Some(known) = done.get(&Arc::as_ptr(node)) {
            return known.clone();
        }
        let mut all = |nodes: &[Arc<Node>]| nodes.iter().map(|n| self.renumber_shared(n, done)).collect();
        let new = match &**node {
            Node::Series(nodes) => Node::Series(all(nodes)),
            Node::Parallel(nodes) => Node::Parallel(all(nodes)),
            Node::Action(action) => Node::Action(self.renumber_action(action, done)),
            Node::Repeat { body, times, until } => {
                let body = self.renumber_shared(body, done);
                Node::Repeat { body, times: *times, until: until.clone() }
            }
            Node::Phase { body, shift, cause } => {
                let body = self.renumber_shared(body, done);
                Node::Phase { body, shift: *shift, cause: self.number(*cause) }
            }
            Node::Approach { body, shift, cause } => {
                let body = self.renumber_shared(body, done);
                Node::Approach { body, shift: *shift, cause: self.number(*cause) }
            }
            Node::Stretch { body, duration, cause } => {
                let body = self.renumber_shared(body, done);
                Node::Stretch { body, duration: *duration, cause: self.number(*cause) }
            }
            Node::Exempt { body, kind, cause } => {
                let body = self.renumber_shared(body, done);
                Node::Exempt { body, kind: kind.clone(), cause: self.number(*cause) }
            }
            Node::Contract { body, number, cause } => {
                let body = self.renumber_shared(body, done);
                Node::Contract { body, number: *number, cause: self.number(*cause) }
            }
            Node::Goal(goal) => {
                let body = goal.body().map(|body| self.renumber_shared(body, done));
                let mut goal = goal.with_body(|old| body.clone().unwrap_or_else(|| old.clone()));
                goal.cause = self.number(goal.cause);
                goal.stand_ins.iter_mut().for_each(|action| action.cause = goal.cause);
                Node::Goal(Box::new(goal))
            }
        };
        let new = Arc::new(new);
        done.insert(Arc::as_ptr(node), new.clone());
        new
    }

    fn renumber_action(&mut self, action: &Action, done: &mut HashMap<*const Node, Arc<Node>>) -> Action {
        let mut action = action.clone();
        action.cause = self.number(action.cause);
        if let Otherwise::Node(node) = &action.otherwise {
            action.otherwise = Otherwise::Node(self.renumber_shared(node, done));
        }
        action
    }

    /// Returns the table of causes that goes into the plan: each as file, line and text, in the order of the plan's
    /// numbers. `causes`: the causes of the run; `sources`: the texts that their spans are of.
    pub fn table(&self, causes: &Causes, sources: &Sources) -> Vec<Cause> {
        self.ids.iter().map(|id| described(causes.get(*id), sources)).collect()
    }
}

fn described(record: &CauseRecord, sources: &Sources) -> Cause {
    let caller = record.caller.map(|span| Box::new(place(span, "", sources)));
    Cause { caller, ..place(record.span, &record.instance, sources) }
}

fn place(span: Span, instance: &str, sources: &Sources) -> Cause {
    let file = sources.file(span.file);
    let at = file.line_column(span.start as usize);
    Cause {
        file: file.name.to_string(),
        line: at.line,
        column: at.column,
        text: file.line(at.line).trim().to_string(),
        instance: instance.to_string(),
        caller: None,
    }
}
