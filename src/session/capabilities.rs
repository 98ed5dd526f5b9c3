//! The question what the standard library can do with a robot: `:what`.

use super::state::{Input, Reply, Session};
use crate::check::Checked;
use crate::check::summary::{self, Group};
use crate::interpret::Host;
use crate::interpret::capability::{Capabilities, Capability};
use crate::interpret::session::Shown;
use crate::source::{Diagnostic, FileId, Files, code, library};
use crate::syntax;
use crate::syntax::ast::ItemKind;
use std::collections::BTreeSet;

/// A robot with the configurations that embed in it, in the words of signatures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Repertoire {
    /// The name of the robot's design, with the arguments that differ from its defaults: `Walker14(bend: 5deg)`.
    pub robot: String,
    /// The number of modules of the robot.
    pub modules: usize,
    /// The configurations that embed in the robot: first its own, then those of the library, by file and in the order of
    /// their declarations.
    pub configurations: Vec<EmbeddedConfiguration>,
}

/// A configuration that embeds in a robot, with the behaviours that the robot can therefore execute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EmbeddedConfiguration {
    /// The name: of a configuration of the library its path `std.smores.Grasper7`, of the robot's own with the arguments
    /// that differ from its defaults.
    pub name: String,
    /// The number of embeddings, at least 1.
    pub embeddings: usize,
    /// The signatures of its public behaviours, in the order of their declarations: `walk(steps: Int = 2)`.
    pub behaviors: Vec<String>,
}

impl Session {
    /// Finds what the standard library can do with the robot that an expression gives. Returns (reply, repertoire): the
    /// outcome of evaluating the expression, and the answer, `None` where the outcome is not fine. The session stays as
    /// it was. `host` gets what the evaluation prints and writes. Panics if abandoned work has not been waited for.
    pub fn repertoire(&mut self, text: &str, host: &mut dyn Host) -> (Reply, Option<Repertoire>) {
        // Imports stand behind the expression, so that its diagnostics show it where it was typed, and only it; behind one
        // that is not closed they would be taken for its rest.
        let closed =
            syntax::parse(FileId(0), text).diagnostics.iter().all(|diagnostic| !diagnostic.is_error());
        let imports = if closed { self.library_imports() } else { String::new() };
        let entry = format!("{text}\n\n\n\n{imports}");
        let shown = Shown::Capabilities;
        let input = Input { text: &entry, name: "<command>", first_line: 1, shown, keep: false };
        let mut reply = self.enter(&input, host);
        let found = reply.capabilities.take().filter(|_| reply.ok);
        if reply.ok && found.is_none() {
            let message = format!("`{}` is no expression that gives a robot", text.trim());
            reply.diagnostics.push(Diagnostic::error(code::TYPE_MISMATCH, message));
            reply.ok = false;
        }
        let repertoire = found.map(|found| repertoire(&reply.checked, found));
        (reply, repertoire)
    }

    /// Returns imports of the library files that declare robots, on one line: a file is then part of the program with all
    /// that it declares. The modules and configurations that the session does not hide are known by their names.
    fn library_imports(&self) -> String {
        let mut known = BTreeSet::new();
        let mut imports = Vec::new();
        for (file, _) in library::FILES {
            let Some(text) = self.files.library(file) else { continue };
            let items = syntax::parse(FileId(0), &text).file.items;
            let robots = items.into_iter().filter_map(|item| match item.kind {
                ItemKind::Config(config) if !config.scene => Some(config.name.text.as_str()),
                ItemKind::Module(module) => Some(module.name.text.as_str()),
                _ => None,
            });
            let public: Vec<&str> = robots.filter(|name| !name.starts_with('_')).collect();
            let Some(first) = public.first() else { continue };
            let stem = file.trim_end_matches(".mod");
            // The private name is there even if all others are hidden.
            imports.push(format!("use std.{stem}.{{{first} as _Of_{stem}}}"));
            let visible = public.into_iter().filter(|name| !self.declares(name) && known.insert(*name));
            let visible = visible.collect::<Vec<_>>().join(", ");
            if !visible.is_empty() {
                imports.push(format!("use std.{stem}.{{{visible}}}"));
            }
        }
        imports.join(" ")
    }
}

fn repertoire(checked: &Checked, found: Capabilities) -> Repertoire {
    let configuration = |capability: Capability| {
        let def = checked.program.def(capability.def);
        let file = checked.sources.file(def.file);
        let library = file.name.strip_prefix("std/").and_then(|name| name.strip_suffix(".mod"));
        let inside = summary::inside(checked, def).into_iter();
        let behaviors = inside
            .filter(|inside| inside.group == Group::Behavior && !inside.name.as_str().starts_with('_'))
            .map(|inside| inside.head);
        EmbeddedConfiguration {
            name: match library.filter(|_| file.library && !def.name.as_str().starts_with('_')) {
                Some(library) => format!("std.{library}.{}", capability.name),
                None => capability.name,
            },
            embeddings: capability.embeddings,
            behaviors: behaviors.collect(),
        }
    };
    let Capabilities { robot, modules, configurations } = found;
    Repertoire { robot, modules, configurations: configurations.into_iter().map(configuration).collect() }
}
