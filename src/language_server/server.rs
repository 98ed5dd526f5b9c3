//! The loop of the server: messages in, answers and diagnostics out.

use super::analysis::Analysis;
use super::documents::{Document, Documents, Workspace};
use super::places::{Encoding, offset, path_of, uri_of};
use super::{answers, assistance, elaboration, names, wire};
use crate::interrupt::CancelState;
use crate::session::complete::{complete, signature};
use crate::source::{Diagnostic, Span};
use crate::syntax::classes;
use gen_lsp_types as lsp;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, Response};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// The server of one editor.
struct Server<'a> {
    workspace: &'a dyn Workspace,
    encoding: Encoding,
    documents: Documents,
    publisher: Arc<Publisher>,
}

/// The way of diagnostics to the editor.
struct Publisher {
    connection: Sender,
    /// The cancellation of the elaboration of each document, by its URI: that of the newest text.
    elaborations: Mutex<BTreeMap<String, CancelState>>,
    encoding: Encoding,
}

/// The function by which messages go out.
type Sender = Box<dyn Fn(Message) + Send + Sync>;

/// The refusal of a request, in words for the user.
struct Refused(String);

/// Serves an editor until it says goodbye. Returns false if it went without that.
///
/// # Errors
/// The protocol's words where the editor does not begin as it must.
pub fn serve(connection: &Connection, workspace: &dyn Workspace) -> Result<bool, String> {
    let silent = "it is for an editor, which speaks the Language Server Protocol with it over standard input and output; the input \
                  ended before an editor had said `initialize`";
    let (id, params) = connection.initialize_start().map_err(|error| {
        if error.channel_is_disconnected() { silent.to_owned() } else { error.to_string() }
    })?;
    let params: lsp::InitializeParams = serde_json::from_value(params).map_err(|error| error.to_string())?;
    let offered = params.capabilities.general.and_then(|general| general.position_encodings);
    let utf8 = offered.is_some_and(|offered| offered.contains(&lsp::PositionEncodingKind::UTF8));
    let encoding = if utf8 { Encoding::Utf8 } else { Encoding::Utf16 };
    let about = json!({
        "capabilities": wire::capabilities(encoding),
        "serverInfo": { "name": "modl", "version": env!("CARGO_PKG_VERSION") },
    });
    connection.initialize_finish(id, about).map_err(|error| error.to_string())?;
    let sender = connection.sender.clone();
    let publisher = Publisher {
        // An editor that has gone hears nothing.
        connection: Box::new(move |message| drop(sender.send(message))),
        elaborations: Mutex::default(),
        encoding,
    };
    let mut server =
        Server { workspace, encoding, documents: Documents::default(), publisher: Arc::new(publisher) };
    let mut said_goodbye = false;
    for message in &connection.receiver {
        match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request).map_err(|error| error.to_string())? {
                    said_goodbye = true;
                    break;
                }
                let response = server.answer(request);
                (server.publisher.connection)(Message::Response(response));
            }
            Message::Notification(notification) => server.notice(notification),
            Message::Response(_) => {}
        }
    }
    server.publisher.cancel_all();
    Ok(said_goodbye)
}

/// Reads the parameters of a message.
fn read<T: DeserializeOwned>(params: Value) -> Result<T, Refused> {
    serde_json::from_value(params).map_err(|error| Refused(error.to_string()))
}

/// Returns an answer as it goes over the wire; `null` for none.
fn written(answer: Option<impl serde::Serialize>) -> Value {
    serde_json::to_value(answer).unwrap_or(Value::Null)
}

impl Server<'_> {
    /// Answers a request.
    fn answer(&mut self, request: Request) -> Response {
        let Request { id, method, params } = request;
        let answered = match method.as_str() {
            "textDocument/hover" => {
                self.at(params, |_, analysis, at| written(answers::hover(analysis, at).map(wire::hover)))
            }
            "textDocument/definition" => self.at(params, |server, analysis, at| {
                written(
                    answers::definition(analysis, at)
                        .and_then(|span| location(analysis, span, server.encoding)),
                )
            }),
            "textDocument/references" => self.at(params, |server, analysis, at| {
                let places = match analysis.named_at(at) {
                    Some(named) => Some(match named.member {
                        None => analysis.places_of(named.def),
                        Some(member) => analysis.places_of_member(named.def, &member),
                    }),
                    None => None,
                };
                let location = |(file, range): &(_, std::ops::Range<usize>)| {
                    location(analysis, Span::new(*file, range.start, range.end), server.encoding)
                };
                written(places.map(|places| places.iter().filter_map(location).collect::<Vec<_>>()))
            }),
            "textDocument/completion" => self.at(params, |server, analysis, at| {
                let text = analysis.text(analysis.file);
                let found = complete(&analysis.knowledge(), text, at);
                written(Some(wire::completion(text, at, &found, server.encoding)))
            }),
            "textDocument/signatureHelp" => self.at(params, |_, analysis, at| {
                let text = &analysis.text(analysis.file)[..at];
                written(signature(&analysis.knowledge(), text).as_ref().map(wire::signature))
            }),
            "textDocument/rename" => self.rename(params),
            "textDocument/documentSymbol" => self.of(params, |server, analysis| {
                let text = analysis.text(analysis.file);
                written(Some(wire::symbols(text, &answers::symbols(analysis), server.encoding)))
            }),
            "textDocument/formatting" => self.of(params, |server, analysis| {
                let text = analysis.text(analysis.file);
                let edit = answers::formatted(text).map(|new_text| lsp::TextEdit {
                    range: wire::range(text, &(0..text.len()), server.encoding),
                    new_text,
                });
                written(Some(edit.into_iter().collect::<Vec<_>>()))
            }),
            "textDocument/foldingRange" => self.of(params, |server, analysis| {
                let text = analysis.text(analysis.file);
                written(Some(wire::folds(text, &answers::folds(text), server.encoding)))
            }),
            "textDocument/semanticTokens/full" => self.of(params, |server, analysis| {
                let text = analysis.text(analysis.file);
                written(Some(wire::tokens(text, &classes(text), server.encoding)))
            }),
            "textDocument/inlayHint" => self.within(params, |server, analysis, range| {
                let text = analysis.text(analysis.file);
                written(Some(wire::inlays(
                    text,
                    &assistance::parameter_hints(analysis, range),
                    server.encoding,
                )))
            }),
            "textDocument/codeAction" => self.mends(params),
            "textDocument/codeLens" => self.lenses(params),
            _ => {
                let unknown = format!("modl does not know `{method}`");
                return Response::new_err(id, ErrorCode::MethodNotFound as i32, unknown);
            }
        };
        match answered {
            Ok(answer) => Response::new_ok(id, answer),
            Err(Refused(words)) => Response::new_err(id, ErrorCode::InvalidParams as i32, words),
        }
    }

    /// Takes a notification; those that say nothing to the server are left.
    fn notice(&mut self, notification: Notification) {
        // A notification has no answer, so one that is not sound is left.
        drop(self.noticed(notification));
    }

    fn noticed(&mut self, notification: Notification) -> Result<(), Refused> {
        let Notification { method, params } = notification;
        match method.as_str() {
            "textDocument/didOpen" => {
                let lsp::DidOpenTextDocumentParams { text_document: opened } = read(params)?;
                let uri = opened.uri.0;
                let path = PathBuf::from(path_of(&uri).ok_or_else(|| Refused("no file".to_owned()))?);
                let project = self.workspace.open(&path);
                let document = Document {
                    path: project.as_ref().map_or(path, |project| project.root.join(&project.name)),
                    project,
                    version: opened.version,
                    text: opened.text.into(),
                    analysis: None,
                };
                self.documents.insert(&uri, document);
            }
            "textDocument/didChange" => {
                let params: lsp::DidChangeTextDocumentParams = read(params)?;
                let document = params.text_document;
                let uri = document.text_document_identifier.uri.0;
                let encoding = self.encoding;
                self.documents.change(&uri, document.version, |text| {
                    wire::changed(text, &params.content_changes, encoding)
                });
            }
            "textDocument/didClose" => {
                let params: lsp::DidCloseTextDocumentParams = read(params)?;
                let uri = params.text_document.uri.0;
                self.documents.close(&uri);
                self.publisher.forget(&uri);
            }
            "textDocument/didSave" | "workspace/didChangeWatchedFiles" => {}
            _ => return Ok(()),
        }
        for uri in self.documents.uris() {
            self.diagnose(&uri);
        }
        Ok(())
    }

    /// Sends the diagnostics of a document: those of its types at once, those that depend on values when they are found.
    fn diagnose(&mut self, uri: &str) {
        let Some(analysis) = self.documents.analysis(uri) else { return };
        let version = self.documents.get(uri).map_or(0, |document| document.version);
        let cancel = self.publisher.begin(uri);
        let own = analysis.checked.diagnostics.clone();
        self.publisher.publish((uri, version), &analysis, &own, &cancel);
        if analysis.checked.has_errors() {
            return;
        }
        let (publisher, uri) = (self.publisher.clone(), uri.to_owned());
        let work = move || {
            if let Some(found) = elaboration::diagnostics(&analysis, &cancel)
                && !found.is_empty()
            {
                publisher.publish((&uri, version), &analysis, &[own, found].concat(), &cancel);
            }
        };
        // Without memory for a thread those diagnostics are not found.
        drop(std::thread::Builder::new().name("elaboration".to_owned()).spawn(work));
    }

    /// Answers a question about a place in a document.
    fn at(
        &mut self,
        params: Value,
        answer: impl Fn(&Self, &Analysis, usize) -> Value,
    ) -> Result<Value, Refused> {
        let params: lsp::TextDocumentPositionParams = read(params)?;
        let Some(analysis) = self.documents.analysis(&params.text_document.uri.0) else {
            return Ok(Value::Null);
        };
        let at = offset(analysis.text(analysis.file), wire::place_of(params.position), self.encoding);
        Ok(answer(self, &analysis, at))
    }

    /// Answers a question about a document.
    fn of(&mut self, params: Value, answer: impl Fn(&Self, &Analysis) -> Value) -> Result<Value, Refused> {
        let uri = params["textDocument"]["uri"].as_str().unwrap_or_default().to_owned();
        let analysis = self.documents.analysis(&uri);
        Ok(analysis.map_or(Value::Null, |analysis| answer(self, &analysis)))
    }

    /// Answers a question about a range of a document, bytes.
    fn within(
        &mut self,
        params: Value,
        answer: impl Fn(&Self, &Analysis, &std::ops::Range<usize>) -> Value,
    ) -> Result<Value, Refused> {
        let range: lsp::Range = read(params["range"].clone())?;
        self.of(params, |server, analysis| {
            let at = |place| offset(analysis.text(analysis.file), wire::place_of(place), server.encoding);
            answer(server, analysis, &(at(range.start)..at(range.end)))
        })
    }

    /// Answers with the mends that diagnostics in a range of a document hint at.
    fn mends(&mut self, params: Value) -> Result<Value, Refused> {
        let uri = params["textDocument"]["uri"].as_str().unwrap_or_default().to_owned();
        self.within(params, |server, analysis, range| {
            let text = analysis.text(analysis.file);
            let action = |mend: &assistance::Mend| wire::mend(&uri, text, mend, server.encoding);
            written(Some(assistance::mends(analysis, range).iter().map(action).collect::<Vec<_>>()))
        })
    }

    /// Answers with the commands that are offered in a document.
    fn lenses(&mut self, params: Value) -> Result<Value, Refused> {
        let uri = params["textDocument"]["uri"].as_str().unwrap_or_default().to_owned();
        self.of(params, |server, analysis| {
            let text = analysis.text(analysis.file);
            let lens = |lens: &assistance::Lens| wire::lens(&uri, text, lens, server.encoding);
            written(Some(assistance::lenses(analysis).iter().map(lens).collect::<Vec<_>>()))
        })
    }

    /// Renames a declaration of the project at all its places; refused where the program would have errors after it that it has
    /// not now.
    fn rename(&mut self, params: Value) -> Result<Value, Refused> {
        let params: lsp::RenameParams = read(params)?;
        let place = params.text_document_position_params;
        let Some(analysis) = self.documents.analysis(&place.text_document.uri.0) else {
            return Ok(Value::Null);
        };
        let text = analysis.text(analysis.file);
        let at = offset(text, wire::place_of(place.position), self.encoding);
        let new = params.new_name;
        let sound = names::word_at(&new, 0).is_some_and(|word| word == (0..new.len()));
        if !sound {
            return Err(Refused(format!("`{new}` is no name")));
        }
        let Some(def) = analysis.declaration_at(at).filter(|def| analysis.is_own(*def)) else {
            return Err(Refused("only declarations of the project are renamed".to_owned()));
        };
        let places = analysis.places_of(def);
        if !analysis.stays_sound(&places, &new) {
            return Err(Refused(format!("the program would have other errors with the name `{new}`")));
        }
        let mut changes: HashMap<lsp::Uri, Vec<lsp::TextEdit>> = HashMap::new();
        for (file, bytes) in places {
            let Some(path) = analysis.path(file) else { continue };
            let range = wire::range(analysis.text(file), &bytes, self.encoding);
            let edit = lsp::TextEdit { range, new_text: new.clone() };
            changes.entry(lsp::Uri(uri_of(&path))).or_default().push(edit);
        }
        Ok(written(Some(lsp::WorkspaceEdit { changes: Some(changes), ..Default::default() })))
    }
}

/// Returns the location of a span; `None` for one in the library.
fn location(analysis: &Analysis, span: Span, encoding: Encoding) -> Option<lsp::Location> {
    let uri = lsp::Uri(uri_of(&analysis.path(span.file)?));
    Some(lsp::Location { uri, range: wire::range(analysis.text(span.file), &span.range(), encoding) })
}

impl Publisher {
    /// Cancels the elaboration of a document's older text, and returns the cancellation of the one that begins.
    fn begin(&self, uri: &str) -> CancelState {
        let cancel = CancelState::default();
        let mut known = self.elaborations.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(before) = known.insert(uri.to_owned(), cancel.clone()) {
            before.cancel();
        }
        cancel
    }

    /// Cancels the elaboration of a document that is closed, and takes its diagnostics away.
    fn forget(&self, uri: &str) {
        let mut known = self.elaborations.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(before) = known.remove(uri) {
            before.cancel();
        }
        self.send(&lsp::Uri(uri.to_owned()), None, vec![]);
    }

    fn cancel_all(&self) {
        let known = self.elaborations.lock().unwrap_or_else(PoisonError::into_inner);
        known.values().for_each(CancelState::cancel);
    }

    /// Sends the diagnostics of a version of a document, unless a newer text has begun since.
    fn publish(
        &self,
        (uri, version): (&str, i32),
        analysis: &Analysis,
        found: &[Diagnostic],
        cancel: &CancelState,
    ) {
        let text = analysis.text(analysis.file);
        let shown = answers::shown(analysis, found);
        let one = |shown| {
            wire::diagnostic(text, shown, self.encoding, |span| location(analysis, span, self.encoding))
        };
        let diagnostics: Vec<lsp::Diagnostic> = shown.iter().map(one).collect();
        // Held while it is sent, so that an older one does not come after a newer one.
        let _newest = self.elaborations.lock().unwrap_or_else(PoisonError::into_inner);
        if !cancel.is_cancelled() {
            self.send(&lsp::Uri(uri.to_owned()), Some(version), diagnostics);
        }
    }

    fn send(&self, uri: &lsp::Uri, version: Option<i32>, diagnostics: Vec<lsp::Diagnostic>) {
        let params = lsp::PublishDiagnosticsParams { uri: uri.clone(), version, diagnostics };
        let method = "textDocument/publishDiagnostics".to_owned();
        (self.connection)(Message::Notification(Notification::new(method, params)));
    }
}
