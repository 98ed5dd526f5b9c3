//! Trusses: nodes and struts of one kind, rigid in their start pose.

use super::config::Deferred;
use super::tolerances::TOLERANCES;
use crate::check::typed::{DefId, NodeRef, TrussBody, TrussClause, TrussDef};
use crate::geometry::Vec3;
use crate::geometry::broad_phase::{Aabb, near_boxes};
use crate::geometry::closest_points::segment_segment_distance;
use crate::geometry::soundness::{EXTENT_MAX, in_reach};
use crate::interpret::design::{Design, DesignKind, Instance, Node, TrussDesign};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::interrupt;
use crate::robot::Strut;
use crate::robot::truss;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// The greatest number of nodes: more make the rigidity matrix too large to decompose in a few seconds.
const NODES_MAX: usize = 1000;
/// The greatest number of faults of one truss that are reported.
const FAULTS_REPORTED_MAX: usize = 8;
/// The greatest number of nodes whose rigidity is examined without a notice: of more nodes this takes a
/// while.
const NODES_WITHOUT_NOTICE: usize = 100;
/// The greatest number of free motions of a truss that are reported.
const MOTIONS_REPORTED_MAX: usize = 6;

/// A truss while its body is read: its nodes, and its struts as (node, node, span).
#[derive(Default)]
struct Draft {
    nodes: Vec<Node>,
    struts: Vec<(usize, usize, Span)>,
}

impl Interpreter<'_> {
    /// Returns the design of a truss; `None` where it is unknown, has a fault, or is not rigid, which has been
    /// reported.
    ///
    /// # Errors
    /// A fault of the kind of struts, or `Stop::Halt` if a limit is reached or the user cancels; faults of the truss
    /// itself are reported.
    pub(super) fn elaborate_truss(
        &mut self,
        def: &TrussDef,
        id: DefId,
        this: &Rc<Instance>,
    ) -> Eval<Option<DesignKind>> {
        let mark = self.reported.errors;
        let of = self.default_design(def.of)?.filter(|design| !design.broken.get());
        let name = self.shared.program.def(id).span;
        let mut frame = Frame::new(def.frame, Some(this.clone()));
        let mut draft = Draft::default();
        match &def.body {
            TrussBody::Value(value) => {
                let built = self.eval(value, &mut frame)?;
                let Some((nodes, struts)) = crate::interpret::record::frame_parts(&built) else {
                    return Ok(None);
                };
                draft.nodes = numbered(nodes, value.span);
                draft.struts = struts.into_iter().map(|(a, b)| (a, b, value.span)).collect();
            }
            TrussBody::Clauses(clauses) => {
                let mut requirements = Vec::new();
                self.truss_clauses(clauses, def, &mut draft, &mut frame, &mut requirements)?;
                self.check_requirements(requirements)?;
            }
        }
        if self.failed_since(mark) {
            return Ok(None);
        }
        let Some(of) = of else { return Ok(None) };
        self.check_truss(&draft, &of, name)?;
        if self.failed_since(mark) {
            return Ok(None);
        }
        let positions: Vec<Vec3> = draft.nodes.iter().map(|n| n.position).collect();
        let struts: Vec<(usize, usize)> = draft.struts.iter().map(|(a, b, _)| (*a, *b)).collect();
        if positions.len() > NODES_WITHOUT_NOTICE {
            interrupt::start_task(format!("finding out how {} nodes hold each other", positions.len()));
        }
        let rigidity = truss::rigidity(&positions, &struts);
        let design = TrussDesign { of, nodes: draft.nodes, struts, rigidity };
        if !design.rigidity.rigid() {
            self.report(not_rigid(&design, name));
            return Ok(None);
        }
        Ok(Some(DesignKind::Truss(design)))
    }

    fn truss_clauses<'d>(
        &mut self,
        clauses: &'d [TrussClause],
        def: &TrussDef,
        draft: &mut Draft,
        frame: &mut Frame,
        requirements: &mut Vec<Deferred<'d>>,
    ) -> Eval<()> {
        for clause in clauses {
            self.attempt(|this| this.truss_clause(clause, def, draft, frame, requirements))?;
        }
        Ok(())
    }

    /// Runs a clause: adds its node or strut, binds its local, or collects its requirement.
    fn truss_clause<'d>(
        &mut self,
        clause: &'d TrussClause,
        def: &TrussDef,
        draft: &mut Draft,
        frame: &mut Frame,
        requirements: &mut Vec<Deferred<'d>>,
    ) -> Eval<()> {
        match clause {
            TrussClause::Node { member, index, value, span } => {
                let group = def.members[member.0 as usize].name;
                let index = self.eval_optional(index.as_ref(), frame)?;
                let Value::Vec3(position, _) = self.eval(value, frame)? else { return Ok(()) };
                self.add_node(draft, group, index, position, *span)
            }
            TrussClause::Strut { a, b, span } => {
                let (a, b) = (self.find_node(a, def, draft, frame)?, self.find_node(b, def, draft, frame)?);
                if let (Some(a), Some(b)) = (a, b) {
                    draft.struts.push((a, b, *span));
                }
                Ok(())
            }
            TrussClause::Let { local, value } => {
                let value = self.eval(value, frame)?;
                frame.set(*local, value);
                Ok(())
            }
            TrussClause::Require(require) => {
                requirements.push(Deferred { require, frame: frame.clone() });
                Ok(())
            }
            TrussClause::If { condition, then, otherwise } => match self.eval(condition, frame)? {
                Value::Bool(true) => self.truss_clauses(then, def, draft, frame, requirements),
                Value::Bool(false) => self.truss_clauses(otherwise, def, draft, frame, requirements),
                _ => Ok(()),
            },
            TrussClause::For { binder, iterable, body } => {
                let values = self.eval(iterable, frame)?;
                self.for_each(&values, *binder, iterable.span, frame, |this, frame| {
                    this.truss_clauses(body, def, draft, frame, requirements)
                })?;
                Ok(())
            }
        }
    }

    /// Adds a node; with an index it is one of an array, `group[index]`.
    ///
    /// # Errors
    /// A fault where the node is there already, and `Stop::Halt` beyond the greatest number of nodes.
    fn add_node(
        &mut self,
        draft: &mut Draft,
        group: Symbol,
        index: Option<Value>,
        position: Vec3,
        span: Span,
    ) -> Eval<()> {
        let name = match index {
            None => group.to_string(),
            Some(index) => format!("{group}[{}]", self.show(&index)),
        };
        let count = draft.nodes.len() + 1;
        if count > NODES_MAX {
            let message = format!("a truss of more than {NODES_MAX} nodes is not allowed");
            return self.halt(Diagnostic::error(code::SIZE_LIMIT, message).label(span, "one too many"));
        }
        if let Some(twin) = draft.nodes.iter().find(|node| node.name == name) {
            let message = format!("the node `{name}` is declared twice");
            return Err(Diagnostic::error(code::BAD_TRUSS, message)
                .label(span, "declared again")
                .label(twin.span, "declared here")
                .into());
        }
        draft.nodes.push(Node { name, group: Some(group), position, span });
        Ok(())
    }

    /// Returns the index of a node of the draft; `None` where it is unknown.
    ///
    /// # Errors
    /// A fault where an array has no node of this index.
    fn find_node(
        &mut self,
        node: &NodeRef,
        def: &TrussDef,
        draft: &Draft,
        frame: &mut Frame,
    ) -> Eval<Option<usize>> {
        let group = def.members[node.member.0 as usize].name;
        let name = match self.eval_optional(node.index.as_ref(), frame)? {
            None => group.to_string(),
            Some(Value::Unknown) => return Ok(None),
            Some(index) => format!("{group}[{}]", self.show(&index)),
        };
        match draft.nodes.iter().position(|n| n.name == name) {
            Some(index) => Ok(Some(index)),
            None if node.index.is_some() => {
                let count = draft.nodes.iter().filter(|n| n.group == Some(group)).count();
                let message = format!("there is no node `{name}`: `{group}` has {count}");
                Err(fault(code::INDEX, node.span, message, "no such node"))
            }
            // Declared in a branch that did not run, or with a position that was not known.
            None => Ok(None),
        }
    }

    /// Reports the faults of a truss, up to a number of them, and one for each span in the text.
    fn check_truss(&mut self, draft: &Draft, of: &Rc<Design>, name: Span) -> Eval<()> {
        let DesignKind::Strut(kind) = &of.kind else { return Ok(()) };
        let mut faults: Vec<(Span, Stop)> = Vec::new();
        if draft.struts.is_empty() {
            faults.push((name, fault(code::BAD_TRUSS, name, "the truss has no struts", "no struts")));
        }
        for node in draft.nodes.iter().filter(|node| !in_reach(node.position.as_slice())) {
            let far = quantity(EXTENT_MAX, Dimension::LENGTH);
            let message = format!("the node {} is farther than {far} away", node.name);
            faults.push((node.span, fault(code::BAD_TRUSS, node.span, message, "too far")));
        }
        let twins = twins(&draft.nodes);
        for &(a, b) in &twins {
            let (a, b) = (&draft.nodes[a], &draft.nodes[b]);
            let message = format!("the nodes {} and {} are at one place", b.name, a.name);
            let diagnostic = Diagnostic::error(code::BAD_TRUSS, message);
            faults.push((a.span, diagnostic.label(a.span, "here").label(b.span, "and here").into()));
        }
        // Faults of struts of nodes at one position, or too far away, follow from that.
        let far = |node: usize| !in_reach(draft.nodes[node].position.as_slice());
        let sound = |&(a, b, _): &(usize, usize, Span)| {
            !far(a) && !far(b) && !twins.iter().any(|&(twin, _)| twin == a || twin == b)
        };
        let struts: Vec<&(usize, usize, Span)> = draft.struts.iter().filter(|strut| sound(strut)).collect();
        for (strut, before) in struts.iter().zip(nearby_before(&draft.nodes, &struts, kind)) {
            if let Err(stop) = self.check_strut(draft, strut, &before, kind) {
                faults.push((strut.2, stop));
            }
        }
        let held = |node: &usize| draft.struts.iter().any(|(a, b, _)| a == node || b == node);
        let loose = (0..draft.nodes.len()).filter(|node| !draft.struts.is_empty() && !held(node));
        for node in loose.map(|node| &draft.nodes[node]) {
            let message = format!("no strut holds the node {}", node.name);
            faults.push((node.span, fault(code::BAD_TRUSS, node.span, message, "no strut ends here")));
        }
        let mut reported: Vec<Span> = Vec::new();
        for (span, stop) in faults {
            if reported.len() < FAULTS_REPORTED_MAX && !reported.contains(&span) {
                reported.push(span);
                self.attempt(|_| Err::<(), Stop>(stop))?;
            }
        }
        Ok(())
    }

    /// Refuses a strut without length, one of a length out of range, one that is there already, and one that is
    /// nearer than its clearance to one of the struts `before` it that shares no node with it.
    ///
    /// # Errors
    /// A fault at the strut.
    fn check_strut(
        &mut self,
        draft: &Draft,
        &(a, b, span): &(usize, usize, Span),
        before: &[&(usize, usize, Span)],
        kind: &Strut,
    ) -> Eval<()> {
        let name = |a: usize, b: usize| format!("{} -- {}", draft.nodes[a].name, draft.nodes[b].name);
        let metres = |x: f64| quantity(x, Dimension::LENGTH);
        if a == b {
            let message = format!("the strut {} begins and ends at one node", name(a, b));
            return Err(fault(code::BAD_TRUSS, span, message, "no length"));
        }
        let length = (draft.nodes[a].position - draft.nodes[b].position).norm();
        let (low, high) = kind.length;
        if !(low - TOLERANCES.strut_length..=high + TOLERANCES.strut_length).contains(&length) {
            let message = format!(
                "the strut {} is {} long; a {} reaches from {} to {}",
                name(a, b),
                metres(length),
                kind.name,
                metres(low),
                metres(high)
            );
            return Err(fault(code::BAD_TRUSS, span, message, format!("{} long", metres(length))));
        }
        let ends = |a: usize, b: usize| (draft.nodes[a].position, draft.nodes[b].position);
        for &&(c, d, other) in before {
            if (a, b) == (c, d) || (a, b) == (d, c) {
                let message = format!("the strut {} is there twice", name(a, b));
                return Err(Diagnostic::error(code::BAD_TRUSS, message)
                    .label(span, "again")
                    .label(other, "first here")
                    .into());
            }
            if [c, d].contains(&a) || [c, d].contains(&b) {
                continue;
            }
            let distance = segment_segment_distance(ends(a, b), ends(c, d));
            if distance < kind.clearance.max(TOLERANCES.node_distance) {
                let message = format!(
                    "the struts {} and {} are {} apart; a {} keeps {}",
                    name(a, b),
                    name(c, d),
                    metres(distance),
                    kind.name,
                    metres(kind.clearance)
                );
                return Err(Diagnostic::error(code::BAD_TRUSS, message)
                    .label(span, "too near")
                    .label(other, "to this one")
                    .into());
            }
        }
        Ok(())
    }
}

/// Returns for each of some struts those before it, in their order, that may be nearer to it than its clearance, those
/// with the same nodes among them.
fn nearby_before<'d>(
    nodes: &[Node],
    struts: &[&'d (usize, usize, Span)],
    kind: &Strut,
) -> Vec<Vec<&'d (usize, usize, Span)>> {
    let ends = |strut: &&(usize, usize, Span)| [nodes[strut.0].position, nodes[strut.1].position];
    let boxes: Vec<Aabb> = struts.iter().map(|strut| Aabb::around(ends(strut))).collect();
    let mut before = vec![Vec::new(); struts.len()];
    let reach = kind.clearance.max(TOLERANCES.node_distance);
    near_boxes(&boxes, reach, kind.length.0.max(reach), |i, j| before[j].push(i));
    let struts_of = |mut indices: Vec<usize>| {
        indices.sort_unstable();
        indices.into_iter().map(|i| struts[i]).collect()
    };
    before.into_iter().map(struts_of).collect()
}

/// Returns the pairs of a node and the first node before it at the same position, by the later one.
fn twins(nodes: &[Node]) -> Vec<(usize, usize)> {
    let near = |a: usize, b: usize| (nodes[a].position - nodes[b].position).norm() < TOLERANCES.node_distance;
    // Along x: those at one position stand together.
    let mut sorted: Vec<usize> = (0..nodes.len()).collect();
    sorted.sort_by(|&a, &b| nodes[a].position.x.total_cmp(&nodes[b].position.x));
    let mut first: Vec<Option<usize>> = vec![None; nodes.len()];
    for (at, &a) in sorted.iter().enumerate() {
        let next = sorted[at + 1..].iter();
        let apart = |b: &&usize| nodes[**b].position.x - nodes[a].position.x < TOLERANCES.node_distance;
        for &b in next.take_while(apart).filter(|&&b| near(a, b)) {
            let (low, high) = (a.min(b), a.max(b));
            first[high] = Some(first[high].map_or(low, |known| known.min(low)));
        }
    }
    first.into_iter().enumerate().filter_map(|(a, b)| Some((a, b?))).collect()
}

/// Returns nodes that are named by their numbers, from 0.
fn numbered(positions: Vec<Vec3>, span: Span) -> Vec<Node> {
    let node = |(i, position)| Node { name: format!("{i}"), group: None, position, span };
    positions.into_iter().enumerate().map(node).collect()
}

/// Returns the error of a truss that is not rigid, with its free motions.
fn not_rigid(truss: &TrussDesign, name: Span) -> Diagnostic {
    let rigidity = &truss.rigidity;
    let message = format!("the truss is not rigid: rank {} of {}", rigidity.rank, rigidity.rank_rigid);
    let count = rigidity.free.len();
    let motions = if count == 1 { "1 free motion".to_string() } else { format!("{count} free motions") };
    let mut diagnostic = Diagnostic::error(code::NOT_RIGID, message).label(name, motions);
    for (index, motion) in truss.free_motions().into_iter().take(MOTIONS_REPORTED_MAX).enumerate() {
        diagnostic = diagnostic.hint(format!("free motion {}: {motion}", index + 1));
    }
    if count > MOTIONS_REPORTED_MAX {
        diagnostic = diagnostic.hint(format!("and {} more free motions", count - MOTIONS_REPORTED_MAX));
    }
    diagnostic.hint("add struts between nodes that move against each other")
}
