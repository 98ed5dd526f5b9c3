//! The model of a text, which a page shows: the diagnostics, the declarations that can be shown, and one of them.

use super::robot::{Read, Robot, robot};
use crate::check::typed::{DefId, DefKind};
use crate::check::{self, Checked};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::{Mode, Options, SilentHost};
use crate::interrupt::CancelState;
use crate::session::Project;
use crate::source::json::{JsonDiagnostic, to_json};
use crate::source::render::Style;
use crate::source::{Replaced, Severity};
use crate::syntax::{self, ast};
use serde::Serialize;
use std::collections::BTreeMap;

/// The model of a text: what a page shows of it. It does not depend on anything but the text, what it imports, and the wish
/// which declaration is shown.
#[derive(Clone, Debug, Serialize)]
pub struct Model {
    /// The diagnostics, as `modl check` finds them.
    pub findings: Vec<JsonDiagnostic>,
    /// The names of the configurations, scenes, lattices and trusses of the text that need no arguments, in its order.
    pub robots: Vec<String>,
    /// The one that is shown; `None` if there is none, or the text has errors that concern it.
    pub robot: Option<Robot>,
    #[serde(skip)]
    pub(super) tree: Option<ast::File>,
}

impl Model {
    /// Returns what a program shows. `files`: its project; `program`: its path in the project; `text`: its text, which stands for
    /// that of the file; `wanted`: the name of the declaration to show, in place of the last configuration or, without one, the last declaration. Work
    /// ends early, without a robot, once `cancel` is cancelled.
    pub fn of(
        files: &Project,
        program: &str,
        text: &str,
        wanted: Option<&str>,
        cancel: &CancelState,
    ) -> Model {
        let texts = BTreeMap::from([(program.to_owned(), text.to_owned())]);
        let typed = Replaced { files: &**files, texts };
        let checked = check::check(&typed, program);
        let options = Options::default();
        let mut host = SilentHost(cancel.clone());
        let outcome = crate::execute::run(&checked, Mode::Check, &typed, &mut host, &options);
        let diagnostics = [checked.diagnostics.clone(), outcome.diagnostics].concat();
        let findings = to_json(&checked.sources, &diagnostics, &Style::default());
        let found = checked.sources.files().find(|(_, file)| !file.library && *file.name == *program);
        let Some((id, file)) = found else {
            return Model { findings, robots: Vec::new(), robot: None, tree: None };
        };
        let tree = syntax::parse(id, &file.text).file;
        let shown = shown(&checked, &tree);
        let name = |def: &DefId| checked.program.def(*def).name.to_string();
        let robots: Vec<String> = shown.iter().map(name).collect();
        let wished = wanted.and_then(|wanted| robots.iter().position(|robot| robot == wanted));
        let def = wished.map(|index| shown[index]).or_else(|| preferred(&checked, &shown));
        let robot = def.filter(|_| !checked.has_errors()).and_then(|def| {
            let read = Read { checked: &checked, file, tree: &tree };
            let work = |interpreter: &mut Interpreter| robot(interpreter, &read, def);
            crate::execute::with_interpreter(&checked, &typed, &mut host, &options, work).flatten()
        });
        Model { findings, robots, robot, tree: Some(tree) }
    }

    /// Returns the message of the first error; `None` if there is no error.
    pub fn error(&self) -> Option<&str> {
        let mut errors = self.findings.iter().filter(|found| found.severity == Severity::Error);
        errors.next().map(|found| found.message.as_str())
    }
}

/// Returns the declarations of a file that can be shown, in the order of the text.
fn shown(checked: &Checked, tree: &ast::File) -> Vec<DefId> {
    let program = &checked.program;
    let is_shown = |def: &DefId| {
        let declared = program.def(*def);
        let drawn = matches!(declared.kind, DefKind::Config(_) | DefKind::Lattice(_) | DefKind::Truss(_));
        let params = declared.kind.instantiable().map_or(&[][..], |declared| declared.params);
        drawn && declared.file == tree.id && params.iter().all(|param| param.default.is_some())
    };
    let mut found: Vec<DefId> = program.own.iter().copied().filter(is_shown).collect();
    found.sort_by_key(|def| program.def(*def).span.start);
    found
}

/// Returns the last configuration or scene, or else the last declaration.
fn preferred(checked: &Checked, shown: &[DefId]) -> Option<DefId> {
    let is_config = |def: &&DefId| matches!(checked.program.def(**def).kind, DefKind::Config(_));
    shown.iter().rev().find(is_config).or(shown.last()).copied()
}
