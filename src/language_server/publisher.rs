//! The findings about open documents, and their way to the editor.

use super::analysis::Analysis;
use super::elaboration::Findings;
use super::places::{Encoding, uri_of};
use super::verdicts::{Judged, Target};
use super::{answers, wire};
use crate::interrupt::CancelState;
use crate::source::{Diagnostic, Span};
use gen_lsp_types as lsp;
use lsp_server::{Message, Notification, Request, RequestId};
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Mutex, PoisonError};

/// The function by which messages go out.
pub(super) type Sender = Box<dyn Fn(Message) + Send + Sync>;

/// The abilities of an editor, as far as they matter here.
#[derive(Clone, Copy, Default)]
pub(super) struct Abilities {
    /// True if it asks for code lenses again when it is told to.
    pub lenses: bool,
    /// True if it asks for inlay hints again when it is told to.
    pub hints: bool,
    /// True if it shows where a diagnostic's code is explained.
    pub pages: bool,
}

/// The findings about the present text of a document.
struct Told {
    version: i32,
    /// The cancellation of all work on this text.
    cancel: CancelState,
    /// The checked program; `None` as long as it is not.
    analysis: Option<Analysis>,
    /// The diagnostics that depend on values.
    values: Vec<Diagnostic>,
    /// The values of `let`s, by the places of their expressions.
    constants: Vec<(Span, String)>,
    /// The verifications of it; `None` for one that runs.
    verdicts: BTreeMap<Target, Option<Judged>>,
}

/// The findings about all open documents, and the way to the editor.
pub(super) struct Publisher {
    connection: Sender,
    encoding: Encoding,
    abilities: Abilities,
    told: Mutex<BTreeMap<String, Told>>,
    /// The number of requests that were sent.
    requests: AtomicI32,
}

impl Publisher {
    /// Returns a publisher that knows of no document. `connection`: the way out.
    pub(super) fn new(connection: Sender, encoding: Encoding, abilities: Abilities) -> Publisher {
        Publisher { connection, encoding, abilities, told: Mutex::default(), requests: AtomicI32::default() }
    }

    /// Sends a message.
    pub(super) fn send(&self, message: Message) {
        (self.connection)(message);
    }

    /// Cancels all work on a document's older text, and returns the cancellation of that on the new one.
    pub(super) fn begin(&self, uri: &str, version: i32) -> CancelState {
        let cancel = CancelState::default();
        let told = Told {
            version,
            cancel: cancel.clone(),
            analysis: None,
            values: Vec::new(),
            constants: Vec::new(),
            verdicts: BTreeMap::new(),
        };
        let mut all = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(before) = all.insert(uri.to_owned(), told) {
            before.cancel.cancel();
        }
        cancel
    }

    /// Cancels all work on a document that is closed, and takes its diagnostics away.
    pub(super) fn forget(&self, uri: &str) {
        let mut all = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(before) = all.remove(uri) {
            before.cancel.cancel();
        }
        self.publish(&lsp::Uri(uri.to_owned()), None, vec![]);
    }

    /// Cancels all work.
    pub(super) fn cancel_all(&self) {
        let all = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        all.values().for_each(|told| told.cancel.cancel());
    }

    /// Tells the diagnostics of a checked program.
    pub(super) fn checked(&self, uri: &str, cancel: &CancelState, analysis: &Analysis) {
        self.update(uri, cancel, |told| {
            told.analysis = Some(analysis.clone());
            true
        });
    }

    /// Tells what elaboration found: diagnostics, and the values of `let`s.
    pub(super) fn elaborated(&self, uri: &str, cancel: &CancelState, found: Findings) {
        let shown = !found.constants.is_empty();
        let told = self.update(uri, cancel, |told| {
            (told.values, told.constants) = (found.diagnostics, found.constants);
            !told.values.is_empty()
        });
        if told && shown && self.abilities.hints {
            self.ask("workspace/inlayHint/refresh");
        }
    }

    /// Notes that a verification begins. Returns false where the text has changed, or it runs already.
    pub(super) fn judging(&self, uri: &str, cancel: &CancelState, target: &Target) -> bool {
        let mut begins = false;
        self.update(uri, cancel, |told| {
            begins = !matches!(told.verdicts.get(target), Some(None));
            told.verdicts.insert(target.clone(), None);
            false
        });
        if begins {
            self.refresh_lenses();
        }
        begins
    }

    /// Tells what a verification found; `None` where it was cancelled while the text stayed.
    pub(super) fn judged(&self, uri: &str, cancel: &CancelState, target: &Target, found: Option<Judged>) {
        let told = self.update(uri, cancel, |told| {
            let before = told.verdicts.remove(target).flatten();
            let tells = found.as_ref().is_some_and(|found| !found.diagnostics.is_empty());
            if let Some(found) = found {
                told.verdicts.insert(target.clone(), Some(found));
            }
            tells || before.is_some()
        });
        if told {
            self.refresh_lenses();
        }
    }

    /// Returns what was verified of the present text of a document, or is being verified (`None`).
    pub(super) fn verdicts(&self, uri: &str) -> BTreeMap<Target, Option<Judged>> {
        let all = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        all.get(uri).map(|told| told.verdicts.clone()).unwrap_or_default()
    }

    /// Returns the values of `let`s of the present text of a document, as far as they are known.
    pub(super) fn constants(&self, uri: &str) -> Vec<(Span, String)> {
        let all = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        all.get(uri).map(|told| told.constants.clone()).unwrap_or_default()
    }

    /// Returns the cancellation of the work on the present text of a document; `None` if it is not open.
    pub(super) fn work_on(&self, uri: &str) -> Option<CancelState> {
        let all = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        all.get(uri).map(|told| told.cancel.clone())
    }

    /// Changes what is known of a text unless a newer one has begun since, and publishes all its diagnostics where `change`
    /// says so. Returns false for an older text.
    fn update(&self, uri: &str, cancel: &CancelState, change: impl FnOnce(&mut Told) -> bool) -> bool {
        // Held while it is sent, so that older diagnostics do not come after newer ones.
        let mut all = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(told) = all.get_mut(uri).filter(|_| !cancel.is_cancelled()) else { return false };
        if !change(told) {
            return true;
        }
        let Some(analysis) = &told.analysis else { return true };
        let judged = told.verdicts.values().flatten().flat_map(|judged| &judged.diagnostics);
        let mut found: Vec<&Diagnostic> = Vec::new();
        for diagnostic in analysis.checked.diagnostics.iter().chain(&told.values).chain(judged) {
            // A verification runs the program, and finds again what elaboration has found.
            if !found.contains(&diagnostic) {
                found.push(diagnostic);
            }
        }
        let text = analysis.text(analysis.file);
        let at = |span| location(analysis, span, self.encoding);
        let shown = answers::shown(analysis, &found);
        let one = |shown| wire::diagnostic(text, shown, self.encoding, self.abilities.pages, at);
        let diagnostics = shown.iter().map(one).collect();
        self.publish(&lsp::Uri(uri.to_owned()), Some(told.version), diagnostics);
        true
    }

    fn publish(&self, uri: &lsp::Uri, version: Option<i32>, diagnostics: Vec<lsp::Diagnostic>) {
        let params = lsp::PublishDiagnosticsParams { uri: uri.clone(), version, diagnostics };
        let method = "textDocument/publishDiagnostics".to_owned();
        self.send(Message::Notification(Notification::new(method, params)));
    }

    fn refresh_lenses(&self) {
        if self.abilities.lenses {
            self.ask("workspace/codeLens/refresh");
        }
    }

    /// Sends a request without parameters, whose answer says nothing.
    fn ask(&self, method: &str) {
        let id = RequestId::from(self.requests.fetch_add(1, Ordering::Relaxed));
        self.send(Message::Request(Request::new(id, method.to_owned(), Value::Null)));
    }
}

/// Returns the location of a span; `None` for one in the library.
pub(super) fn location(analysis: &Analysis, span: Span, encoding: Encoding) -> Option<lsp::Location> {
    let uri = lsp::Uri(uri_of(&analysis.path(span.file)?));
    Some(lsp::Location { uri, range: wire::range(analysis.text(span.file), &span.range(), encoding) })
}
