//! Verdicts beside the text: what the judge says about a behaviour, or about the plans of a program, on a thread that the next
//! change cancels.

use super::analysis::Analysis;
use crate::check::typed::{DefId, DefKind};
use crate::interpret::{Judgement, Mode, Options, SilentHost};
use crate::interrupt::CancelState;
use crate::source::{Diagnostic, Span};

/// The command of the server by which an editor asks for a verdict: with the URI of a document, and a behaviour or nothing.
pub(super) const VERIFY: &str = "modl.verify";

/// The words where nothing was planned.
const NOTHING: &str = "not verified: nothing is planned here";

/// A thing in a document that is verified.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target {
    /// All plans of the program that it asks a verdict for.
    Program,
    /// A behaviour of a configuration of the document, both by name, with the defaults of their parameters.
    Behavior {
        /// The configuration.
        config: String,
        /// The behaviour.
        name: String,
    },
}

impl Target {
    /// Returns the target that an argument of the command names: `Pair.nod`, or the program without one. `None` for another
    /// text.
    pub(super) fn of(argument: Option<&str>) -> Option<Target> {
        let Some(argument) = argument else { return Some(Target::Program) };
        let (config, name) = argument.split_once('.')?;
        Some(Target::Behavior { config: config.to_owned(), name: name.to_owned() })
    }

    /// Returns the argument of the command that names the target; `None` for the program.
    pub(super) fn argument(&self) -> Option<String> {
        match self {
            Target::Program => None,
            Target::Behavior { config, name } => Some(format!("{config}.{name}")),
        }
    }
}

/// The findings of a verification.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    /// The verdicts by the calls, or the behaviours, that they are about.
    pub verdicts: Vec<(Span, Judgement)>,
    /// The failures, and other faults of the program.
    pub diagnostics: Vec<Diagnostic>,
}

impl Judged {
    /// Returns all verdicts in words, each on a line; without one the first error, or that there is nothing to judge.
    pub(super) fn in_words(&self) -> String {
        let lines: Vec<String> = self.verdicts.iter().map(|(_, judgement)| words(judgement)).collect();
        if !lines.is_empty() {
            return lines.join("\n");
        }
        let error = self.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
        error.map_or_else(|| NOTHING.to_owned(), |error| format!("✗ not verified: {}", error.message))
    }

    /// Returns the words about a place of the document; `begin`: that of the file and the offset at which it begins.
    pub(super) fn words_at(&self, begin: Span) -> String {
        let here = |span: &Span| span.file == begin.file && span.start == begin.start;
        match self.verdicts.iter().find(|(span, _)| here(span)) {
            Some((_, judgement)) => words(judgement),
            None if self.diagnostics.iter().any(Diagnostic::is_error) => {
                "✗ not verified: there are errors before it".to_owned()
            }
            None => NOTHING.to_owned(),
        }
    }
}

/// Returns a verdict as a lens shows it.
pub(super) fn words(judgement: &Judgement) -> String {
    format!("{} {}", if judgement.ok { "✓" } else { "✗" }, judgement.words)
}

impl Analysis {
    /// Returns the behaviours of the document's configurations that can be verified by themselves, because all parameters have
    /// defaults: each with the place of its name.
    pub(super) fn verifiable(&self) -> Vec<(Target, Span)> {
        let program = &self.checked.program;
        let mut found = Vec::new();
        for def in program.own.iter().map(|id| program.def(*id)).filter(|def| def.span.file == self.file) {
            let DefKind::Config(config) = &def.kind else { continue };
            if config.params.iter().any(|param| param.default.is_none()) {
                continue;
            }
            for behavior in &config.behaviors {
                if behavior.params.iter().all(|param| param.default.is_some() || param.variadic) {
                    let (config, name) = (def.name.to_string(), behavior.name.to_string());
                    found.push((Target::Behavior { config, name }, behavior.span));
                }
            }
        }
        found
    }

    /// Returns the declaration and the index of a behaviour of the document; `None` if there is none of these names.
    fn behavior(&self, config: &str, name: &str) -> Option<(DefId, usize)> {
        let program = &self.checked.program;
        let declared = |id: &&DefId| {
            let def = program.def(**id);
            def.span.file == self.file && def.name == config
        };
        let id = *program.own.iter().find(declared)?;
        let DefKind::Config(config) = &program.def(id).kind else { return None };
        Some((id, config.behaviors.iter().position(|behavior| behavior.name == name)?))
    }

    /// Plans and judges what `target` names; `None` if it was cancelled, or there is no such behaviour. Nothing is printed or
    /// written.
    pub(super) fn judge(&self, target: &Target, cancel: &CancelState) -> Option<Judged> {
        let (mut host, options) = (SilentHost(cancel.clone()), Options::default());
        let outcome = match target {
            Target::Program => {
                crate::execute::run(&self.checked, Mode::Run, &*self.files, &mut host, &options)
            }
            Target::Behavior { config, name } => {
                let behavior = self.behavior(config, name)?;
                crate::execute::judge(&self.checked, behavior, &*self.files, &mut host, &options)
            }
        };
        let judged = Judged { verdicts: outcome.judgements, diagnostics: outcome.diagnostics };
        (!cancel.is_cancelled()).then_some(judged)
    }
}
