//! A robot as it is declared, with the places in the text that its modules, bonds and positions come from.

use super::joint::{Joint, joints};
use super::parameter::{Parameter, parameters};
use super::ports::{FreePort, Offer, ports};
use crate::check::Checked;
use crate::check::typed::{DefId, DefKind, Program};
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::robot::Robot as Assembled;
use crate::interpret::stop::Eval;
use crate::natives;
use crate::plan::Plan;
use crate::robot::JointOwner;
use crate::source::{SourceFile, Span};
use crate::syntax::ast::{Config, ConfigClause, ConfigClauseKind, File, Item, ItemKind};
use crate::view::{self, RenderInput};
use serde::Serialize;
use serde_json::Value;
use std::rc::Rc;

/// The declaration that is shown, with its default arguments.
#[derive(Clone, Debug, Serialize)]
pub struct Robot {
    /// The name of the declaration.
    pub name: String,
    /// The place of its name in the text.
    pub place: Place,
    /// The data of the picture, as the scripts of a page read it.
    pub picture: Value,
    /// The modules in the order of the picture; none of a lattice or a truss.
    pub modules: Vec<Module>,
    /// The modules that lines of the text are about beside those of their parts: connections and start positions.
    pub marks: Vec<Mark>,
    /// The parameters that are numbers or truth values, with their defaults.
    pub parameters: Vec<Parameter>,
    /// The joints that have start positions.
    pub joints: Vec<Joint>,
    /// The ports with nothing docked to them.
    pub ports: Vec<FreePort>,
    /// The ports that can be docked there.
    pub offers: Vec<Offer>,
}

/// A place in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Place {
    /// The line, from 1.
    pub line: usize,
    /// The last line, from 1.
    pub last: usize,
    /// The offset of the first byte, from 0.
    pub start: usize,
    /// The offset after the last byte.
    pub end: usize,
}

/// A module of the robot.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Module {
    /// The path name of the module.
    pub name: String,
    /// The clauses `part` of the text that the module comes from, the outermost first: that of the shown configuration, then those
    /// of configurations in it that stand in the same text.
    pub parts: Vec<Place>,
}

/// A clause of the text with the modules that it is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mark {
    /// The place of the clause.
    pub place: Place,
    /// The modules, by their numbers.
    pub modules: Vec<usize>,
}

/// The text of a program with what was found in it.
pub(super) struct Read<'a> {
    /// The checked program.
    pub checked: &'a Checked,
    /// The file that is shown.
    pub file: &'a SourceFile,
    /// Its tree.
    pub tree: &'a File,
}

/// Returns a declaration of the shown file as a robot; `None` where it is broken.
///
/// # Errors
/// A fault of a declaration that the robot needs, or `Stop::Halt` if a limit is reached or the user cancels.
pub(super) fn robot(interpreter: &mut Interpreter, read: &Read, def: DefId) -> Eval<Option<Robot>> {
    let declared = read.checked.program.def(def);
    let Some(design) = interpreter.default_design(def)?.filter(|design| !design.broken.get()) else {
        return Ok(None);
    };
    let Some(plan) = natives::as_declared(interpreter, &design, declared.span)? else { return Ok(None) };
    let mut robot = bare(read, &plan, declared.name.as_str(), declared.span);
    let named = |item: &&Item| item.kind.name().is_some_and(|name| name.span == declared.span);
    if let Some(item) = read.tree.items.iter().find(named) {
        robot.parameters = parameters(&item.kind, &declared.kind, read.file);
    }
    let Some(config) = config_of(read.tree, declared.span) else { return Ok(Some(robot)) };
    let assembled = interpreter.robot_of(&design, declared.span)?;
    if let Some(assembled) = assembled {
        robot.modules = modules(read, &design, &assembled);
        robot.marks = marks(read, &design);
        robot.joints = joints(&design, &assembled, &config.clauses, read.file);
        if !config.scene {
            (robot.ports, robot.offers) = ports(interpreter, read.checked, &design, &assembled)?;
        }
    }
    Ok(Some(robot))
}

/// Returns a robot of which nothing but the picture is known.
fn bare(read: &Read, plan: &Plan, name: &str, span: Span) -> Robot {
    let picture = view::still_data(&RenderInput { title: name, plan, texts: &[], command: "" });
    Robot {
        name: name.to_owned(),
        place: place(read.file, span),
        picture,
        modules: Vec::new(),
        marks: Vec::new(),
        parameters: Vec::new(),
        joints: Vec::new(),
        ports: Vec::new(),
        offers: Vec::new(),
    }
}

/// Returns the configuration of a tree whose name stands at a place.
pub(super) fn config_of(tree: &File, name: Span) -> Option<&Config> {
    tree.items.iter().find_map(|item| match &item.kind {
        ItemKind::Config(config) if config.name.span == name => Some(config),
        _ => None,
    })
}

/// Returns a span of the shown file as a place.
pub(super) fn place(file: &SourceFile, span: Span) -> Place {
    let range = span.range();
    let last = file.line_column(range.end.max(range.start + 1) - 1);
    Place { line: file.line_column(range.start).line, last: last.line, start: range.start, end: range.end }
}

/// Returns the modules of a robot with the clauses that they come from.
fn modules(read: &Read, design: &Rc<Design>, robot: &Assembled) -> Vec<Module> {
    let clauses = part_clauses(read.tree);
    let each = robot.assembly.modules.iter().enumerate().map(|(index, module)| {
        let mut names = Vec::new();
        chain(&read.checked.program, design, index, &mut names);
        let own = names.iter().filter(|name| name.file == read.tree.id);
        let clause = |name: &Span| clauses.iter().find(|(known, _)| known == name).map(|(_, clause)| *clause);
        let parts = own.filter_map(clause).map(|clause| place(read.file, clause)).collect();
        Module { name: module.name.clone(), parts }
    });
    each.collect()
}

/// Returns the clauses `part` of a file: the span of the name, and that of the clause.
fn part_clauses(tree: &File) -> Vec<(Span, Span)> {
    let configs = tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Config(config) => Some(&config.clauses),
        _ => None,
    });
    let part = |clause: &ConfigClause| match &clause.kind {
        ConfigClauseKind::Part(part) => Some((part.name.span, clause.span)),
        _ => None,
    };
    configs.flatten().filter_map(part).collect()
}

/// Adds the spans of the names of the parts that a module belongs to, the outermost first.
fn chain(program: &Program, design: &Rc<Design>, module: usize, names: &mut Vec<Span>) {
    let DefKind::Config(def) = &program.def(design.def).kind else { return };
    let Some(groups) = design.config().and_then(|config| config.parts.get()) else { return };
    for (part, group) in def.parts.iter().zip(groups) {
        let holds = |offset: usize, count: usize| (offset..offset + count).contains(&module);
        let found = group.elements.iter().find(|e| holds(e.offset, e.design.module_count()));
        if let Some(element) = found {
            names.push(part.span);
            return chain(program, &element.design, module - element.offset, names);
        }
    }
}

/// Returns the clauses `connect` and `set` of the file with the modules that they are about, in the order of the text.
fn marks(read: &Read, design: &Rc<Design>) -> Vec<Mark> {
    let bonds = design.bonds();
    let connected = bonds.iter().map(|bond| (bond.span, vec![bond.a.0, bond.b.0]));
    let set = design.sets().into_iter().map(|set| {
        let modules = match set.joint {
            JointOwner::Module { module, .. } => vec![module],
            JointOwner::Bond(bond) => vec![bonds[bond].a.0, bonds[bond].b.0],
        };
        (set.span, modules)
    });
    let mut all: std::collections::BTreeMap<(u32, u32), Vec<usize>> = Default::default();
    for (span, modules) in connected.chain(set).filter(|(span, _)| span.file == read.tree.id) {
        all.entry((span.start, span.end)).or_default().extend(modules);
    }
    let mark = |((start, end), mut modules): ((u32, u32), Vec<usize>)| {
        modules.sort_unstable();
        modules.dedup();
        Mark { place: place(read.file, Span { file: read.tree.id, start, end }), modules }
    };
    all.into_iter().map(mark).collect()
}
