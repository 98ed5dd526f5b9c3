//! The loop of the server: messages in, answers and diagnostics out.

use super::analysis::Analysis;
use super::documents::{Awaited, Document, Documents, Task, Workspace};
use super::places::{Encoding, offset, path_of, uri_of};
use super::publisher::{Abilities, Publisher, location};
use super::verdicts::{Judged, Target, VERIFY};
use super::{answers, assistance, elaboration, names, symbols, wire};
use crate::document::page_of_code;
use crate::interrupt::{self, CancelState};
use crate::session::complete::{complete, signature};
use crate::source::Span;
use crate::syntax::classes;
use gen_lsp_types as lsp;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// The stack of a thread that checks a program, bytes; most of it is never touched.
const STACK_BYTES: usize = 32 << 20;

/// The server of one editor.
struct Server<'a> {
    workspace: &'a dyn Workspace,
    encoding: Encoding,
    documents: Documents,
    publisher: Arc<Publisher>,
    /// The targets that were verified of each document, by its URI: a save verifies them again.
    verified: BTreeMap<String, BTreeSet<Target>>,
    /// The cancellations of commands that are carried out.
    commands: Arc<Mutex<HashMap<RequestId, CancelState>>>,
}

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
    let abilities = abilities(&params.capabilities);
    let offered = params.capabilities.general.and_then(|general| general.position_encodings);
    let utf8 = offered.is_some_and(|offered| offered.contains(&lsp::PositionEncodingKind::UTF8));
    let encoding = if utf8 { Encoding::Utf8 } else { Encoding::Utf16 };
    let about = json!({
        "capabilities": wire::capabilities(encoding),
        "serverInfo": { "name": "modl", "version": env!("CARGO_PKG_VERSION") },
    });
    connection.initialize_finish(id, about).map_err(|error| error.to_string())?;
    let sender = connection.sender.clone();
    // An editor that has gone hears nothing.
    let out = Box::new(move |message| drop(sender.send(message)));
    let mut server = Server {
        workspace,
        encoding,
        documents: Documents::default(),
        publisher: Arc::new(Publisher::new(out, encoding, abilities)),
        verified: BTreeMap::new(),
        commands: Arc::default(),
    };
    let mut said_goodbye = false;
    for message in &connection.receiver {
        match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request).map_err(|error| error.to_string())? {
                    said_goodbye = true;
                    break;
                }
                if let Some(response) = server.answer(request) {
                    server.publisher.send(Message::Response(response));
                }
            }
            Message::Notification(notification) => server.notice(notification),
            Message::Response(_) => {}
        }
    }
    server.publisher.cancel_all();
    Ok(said_goodbye)
}

/// Returns what an editor says that it can do.
fn abilities(of: &lsp::ClientCapabilities) -> Abilities {
    let workspace = of.workspace.as_ref();
    let diagnostics = of.text_document.as_ref().and_then(|of| of.publish_diagnostics.as_ref());
    let lenses = workspace.and_then(|of| of.code_lens.as_ref()).and_then(|of| of.refresh_support);
    let hints = workspace.and_then(|of| of.inlay_hint.as_ref()).and_then(|of| of.refresh_support);
    let pages = diagnostics.and_then(|of| of.diagnostics_capabilities.code_description_support);
    Abilities {
        lenses: lenses.unwrap_or(false),
        hints: hints.unwrap_or(false),
        pages: pages.unwrap_or(false),
    }
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
    /// Answers a request; `None` for one that is answered when its work is done.
    fn answer(&mut self, request: Request) -> Option<Response> {
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
            "textDocument/completion" => self.typed(params, |server, analysis, text, at| {
                let found = complete(&analysis.knowledge_with(text), text, at);
                written(Some(wire::completion(text, at, &found, server.encoding)))
            }),
            "textDocument/signatureHelp" => self.typed(params, |_, analysis, text, at| {
                let found = signature(&analysis.knowledge_with(text), &text[..at]);
                written(found.as_ref().map(wire::signature))
            }),
            "textDocument/rename" => self.rename(params),
            "textDocument/documentSymbol" => self.of(params, |server, analysis| {
                let text = analysis.text(analysis.file);
                written(Some(wire::symbols(text, &answers::symbols(analysis), server.encoding)))
            }),
            "textDocument/formatting" => self.text(&params, |server, text| {
                let edit = answers::formatted(text).map(|new_text| lsp::TextEdit {
                    range: wire::range(text, &(0..text.len()), server.encoding),
                    new_text,
                });
                written(Some(edit.into_iter().collect::<Vec<_>>()))
            }),
            "textDocument/foldingRange" => self.text(&params, |server, text| {
                written(Some(wire::folds(text, &answers::folds(text), server.encoding)))
            }),
            "textDocument/semanticTokens/full" => self.text(&params, |server, text| {
                written(Some(wire::tokens(text, &classes(text), server.encoding)))
            }),
            "textDocument/inlayHint" => self.hints(params),
            "textDocument/codeAction" => self.mends(params),
            "textDocument/codeLens" => self.lenses(&params),
            "workspace/symbol" => self.symbols(&params),
            "workspace/textDocumentContent" => page(&params),
            "workspace/executeCommand" => match self.command(&id, &params) {
                Ok(()) => return None,
                Err(refused) => Err(refused),
            },
            _ => {
                let unknown = format!("modl does not know `{method}`");
                return Some(Response::new_err(id, ErrorCode::MethodNotFound as i32, unknown));
            }
        };
        Some(match answered {
            Ok(answer) => Response::new_ok(id, answer),
            Err(Refused(words)) => Response::new_err(id, ErrorCode::InvalidParams as i32, words),
        })
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
                let path = project.as_ref().map_or(path, |project| project.root.join(&project.name));
                let document = Document::new(path, opened.version, opened.text.into(), project);
                self.documents.insert(&uri, document);
                self.diagnose(&uri);
            }
            "textDocument/didChange" => {
                let params: lsp::DidChangeTextDocumentParams = read(params)?;
                let document = params.text_document;
                let uri = document.text_document_identifier.uri.0;
                let encoding = self.encoding;
                self.documents.change(&uri, document.version, |text| {
                    wire::changed(text, &params.content_changes, encoding)
                });
                self.diagnose(&uri);
            }
            "textDocument/didClose" => {
                let params: lsp::DidCloseTextDocumentParams = read(params)?;
                let uri = params.text_document.uri.0;
                self.documents.close(&uri);
                self.publisher.forget(&uri);
                self.verified.remove(&uri);
                self.diagnose(&uri);
            }
            "textDocument/didSave" => {
                let params: lsp::DidSaveTextDocumentParams = read(params)?;
                self.verify_again(&params.text_document.uri.0);
            }
            "workspace/didChangeWatchedFiles" => {
                let params: lsp::DidChangeWatchedFilesParams = read(params)?;
                // Those that are open stand for their files.
                let path = |change: &lsp::FileEvent| path_of(&change.uri.0).map(PathBuf::from);
                let elsewhere = params.changes.iter().filter_map(path).any(|path| !self.documents.has(&path));
                if elsewhere {
                    self.documents.forget();
                    self.diagnose("");
                }
            }
            "$/cancelRequest" => {
                let id: RequestId = read(params["id"].clone())?;
                let commands = self.commands.lock().unwrap_or_else(PoisonError::into_inner);
                commands.get(&id).into_iter().for_each(CancelState::cancel);
            }
            _ => {}
        }
        Ok(())
    }

    /// Checks all documents that are to be checked on threads of their own, the one that has changed first.
    fn diagnose(&mut self, changed: &str) {
        for task in self.documents.tasks(changed) {
            let cancel = self.publisher.begin(&task.uri, task.version);
            let publisher = self.publisher.clone();
            let work = move || diagnose(task, &publisher, &cancel);
            // Without memory for a thread there are no diagnostics, and whoever waits for the program is told that there is none.
            let thread = std::thread::Builder::new().name("check".to_owned()).stack_size(STACK_BYTES);
            drop(thread.spawn(work));
        }
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

    /// Answers a question about a place in a text that is being typed, without waiting for the text to be checked: the program
    /// is the newest that is known.
    fn typed(
        &mut self,
        params: Value,
        answer: impl Fn(&Self, &Analysis, &str, usize) -> Value,
    ) -> Result<Value, Refused> {
        let params: lsp::TextDocumentPositionParams = read(params)?;
        let uri = params.text_document.uri.0;
        let Some(analysis) = self.documents.newest(&uri) else { return Ok(Value::Null) };
        let Some(text) = self.documents.get(&uri).map(|document| document.text.clone()) else {
            return Ok(Value::Null);
        };
        let at = offset(&text, wire::place_of(params.position), self.encoding);
        Ok(answer(self, &analysis, &text, at))
    }

    /// Answers a question about nothing but the text of a document.
    fn text(&self, params: &Value, answer: impl Fn(&Self, &str) -> Value) -> Result<Value, Refused> {
        let document = self.documents.get(&uri_in(params));
        Ok(document.map_or(Value::Null, |document| answer(self, &document.text)))
    }

    /// Answers a question about a document.
    fn of(&mut self, params: Value, answer: impl Fn(&Self, &Analysis) -> Value) -> Result<Value, Refused> {
        let uri = uri_in(&params);
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
        let uri = uri_in(&params);
        self.within(params, |server, analysis, range| {
            let text = analysis.text(analysis.file);
            let action = |mend: &assistance::Mend| wire::mend(&uri, text, mend, server.encoding);
            written(Some(assistance::mends(analysis, range).iter().map(action).collect::<Vec<_>>()))
        })
    }

    /// Answers with the commands that are offered in a document.
    fn lenses(&mut self, params: &Value) -> Result<Value, Refused> {
        let uri = uri_in(params);
        let Some(analysis) = self.documents.analysis(&uri) else { return Ok(Value::Null) };
        let text = analysis.text(analysis.file);
        let lens = |lens: &assistance::Lens| wire::lens(&uri, text, lens, self.encoding);
        let found = assistance::lenses(&analysis, &self.publisher.verdicts(&uri));
        Ok(written(Some(found.iter().map(lens).collect::<Vec<_>>())))
    }

    /// Answers with what is shown between the words of a document.
    fn hints(&mut self, params: Value) -> Result<Value, Refused> {
        let constants = self.publisher.constants(&uri_in(&params));
        self.within(params, |server, analysis, range| {
            let found = assistance::hints(analysis, &constants, range);
            written(Some(wire::inlays(analysis.text(analysis.file), &found, server.encoding)))
        })
    }

    /// Answers with the declarations of all projects whose documents are open that have a text in their names.
    fn symbols(&mut self, params: &Value) -> Result<Value, Refused> {
        let wanted = params["query"].as_str().unwrap_or_default();
        let found = symbols::of_projects(&self.documents, wanted);
        let one = |symbol: &symbols::Found| wire::workspace_symbol(symbol, self.encoding);
        Ok(written(Some(found.iter().map(one).collect::<Vec<_>>())))
    }

    /// Carries out a command: a verification, whose request is answered with its words when it is done, and with nothing where
    /// it is cancelled.
    fn command(&mut self, id: &RequestId, params: &Value) -> Result<(), Refused> {
        let name = params["command"].as_str().unwrap_or_default();
        if name != VERIFY {
            return Err(Refused(format!("modl has no command `{name}`")));
        }
        let uri = params["arguments"][0].as_str().unwrap_or_default().to_owned();
        let Some(target) = Target::of(params["arguments"][1].as_str()) else {
            return Err(Refused(
                "a behaviour is named by its configuration and its own name: `Walker.walk`".to_owned(),
            ));
        };
        self.verify(&uri, target.clone(), Some(id.clone()))?;
        self.verified.entry(uri).or_default().insert(target);
        Ok(())
    }

    /// Verifies again what was verified of a document that is saved, as far as its text has changed since.
    fn verify_again(&mut self, uri: &str) {
        let known = self.publisher.verdicts(uri);
        let wanted = self.verified.get(uri).cloned().unwrap_or_default();
        for target in wanted.into_iter().filter(|target| !known.contains_key(target)) {
            // Errors of the program are told already.
            drop(self.verify(uri, target, None));
        }
    }

    /// Begins a verification. `id`: the request that is answered when it is done; `None` if nobody asked.
    fn verify(&mut self, uri: &str, target: Target, id: Option<RequestId>) -> Result<(), Refused> {
        let Some(analysis) = self.documents.analysis(uri) else {
            return Err(Refused("the document is not open".to_owned()));
        };
        if analysis.checked.has_errors() {
            return Err(Refused("a program with errors can't be verified".to_owned()));
        }
        let Some(text) = self.publisher.work_on(uri) else { return Ok(()) };
        let (cancel, commands) = (text.child(), self.commands.clone());
        if let Some(id) = id.clone() {
            commands.lock().unwrap_or_else(PoisonError::into_inner).insert(id, cancel.clone());
        }
        let (publisher, uri) = (self.publisher.clone(), uri.to_owned());
        let work = move || {
            let begins = publisher.judging(&uri, &text, &target);
            let found = begins.then(|| analysis.judge(&target, &cancel)).flatten();
            let words = found.as_ref().map(Judged::in_words);
            if begins {
                publisher.judged(&uri, &text, &target, found);
            }
            if let Some(id) = id {
                commands.lock().unwrap_or_else(PoisonError::into_inner).remove(&id);
                publisher.send(Message::Response(Response::new_ok(id, words)));
            }
        };
        let thread = std::thread::Builder::new().name("verification".to_owned());
        thread.spawn(work).map(drop).map_err(|error| Refused(format!("there is no thread for it: {error}")))
    }

    /// Renames a declaration of the project, or a member of one, at all its places; refused where the program would have errors after it that it has
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
        let named = analysis.named_at(at).filter(|named| analysis.is_own(named.def));
        let Some(names::Named { def, member }) = named else {
            return Err(Refused("only declarations of the project are renamed".to_owned()));
        };
        let places = match &member {
            None => analysis.places_of(def),
            Some(name) => analysis.places_of_member(def, name),
        };
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

/// Returns the URI of the document that parameters are about; empty where they name none.
fn uri_in(params: &Value) -> String {
    params["textDocument"]["uri"].as_str().unwrap_or_default().to_owned()
}

/// Answers with the page that explains a diagnostic's code, by its URI.
fn page(params: &Value) -> Result<Value, Refused> {
    let uri = params["uri"].as_str().unwrap_or_default();
    let text = wire::code_of_page(uri).and_then(page_of_code);
    text.map(|text| json!({ "text": text })).ok_or_else(|| Refused(format!("there is no page `{uri}`")))
}

/// Tells its waiters that there is no program, unless they were told one before.
struct TellsOnDrop(Arc<Awaited>);

impl Drop for TellsOnDrop {
    fn drop(&mut self) {
        self.0.tell(None);
    }
}

/// Checks a document, and tells what was found: the diagnostics of its types at once, those that depend on values when they are
/// found.
fn diagnose(task: Task, publisher: &Publisher, cancel: &CancelState) {
    let (uri, awaited) = (task.uri.clone(), TellsOnDrop(task.awaited.clone()));
    let checked = interrupt::catch(cancel, |_| {}, || task.check());
    let Some(analysis) = checked.ok().flatten() else { return };
    awaited.0.tell(Some(analysis.clone()));
    publisher.checked(&uri, cancel, &analysis);
    if analysis.checked.has_errors() {
        return;
    }
    if let Some(found) = elaboration::findings(&analysis, cancel) {
        publisher.elaborated(&uri, cancel, found);
    }
}
