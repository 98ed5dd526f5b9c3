//! An editor for tests: opens and changes documents of a project in memory, and asks.

use crate::support::suite::MapFiles;
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use modl::language_server::{Opened, Workspace, serve};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// The time after which a message is missing.
const PATIENCE: Duration = Duration::from_secs(60);

/// The folder of all documents.
const ROOT: &str = "/p";

struct Folder(Arc<MapFiles>);

impl Workspace for Folder {
    fn open(&self, path: &Path) -> Option<Opened> {
        let name = path.strip_prefix(ROOT).ok()?.to_str()?.to_owned();
        Some(Opened { files: self.0.clone(), root: PathBuf::from(ROOT), name })
    }
}

/// An editor with its server.
pub struct Client {
    connection: Connection,
    server: Option<std::thread::JoinHandle<Result<bool, String>>>,
    next: i32,
    versions: BTreeMap<String, i64>,
    /// The capabilities that the server stated.
    pub capabilities: Value,
}

/// Returns the URI of a document by its name.
pub fn uri(name: &str) -> String {
    format!("file://{ROOT}/{name}")
}

impl Client {
    /// Starts a server whose project has these files on disk; columns count in UTF-16.
    pub fn new(files: &[(&str, &str)]) -> Client {
        Client::with(files, json!({}))
    }

    /// Starts a server for an editor with these capabilities.
    pub fn with(files: &[(&str, &str)], capabilities: Value) -> Client {
        let bytes = files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec()));
        let folder = Arc::new(MapFiles(bytes.collect()));
        let (server, connection) = Connection::memory();
        let thread = std::thread::spawn(move || serve(&server, &Folder(folder)));
        let mut client = Client {
            connection,
            server: Some(thread),
            next: 0,
            versions: BTreeMap::new(),
            capabilities: Value::Null,
        };
        let begun = client
            .ask("initialize", json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
        client.capabilities = begun["capabilities"].clone();
        client.tell("initialized", json!({}));
        client
    }

    /// Sends a notification.
    pub fn tell(&self, method: &str, params: Value) {
        let message = Notification { method: method.to_owned(), params };
        self.connection.sender.send(Message::Notification(message)).expect("the server listens");
    }

    /// Asks, and returns the answer; panics where the server refuses.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        self.try_to(method, params).unwrap_or_else(|refusal| panic!("{method}: {refusal}"))
    }

    /// Asks, and returns the answer or the words of a refusal; what is published meanwhile is left.
    pub fn try_to(&mut self, method: &str, params: Value) -> Result<Value, String> {
        self.next += 1;
        let id = RequestId::from(self.next);
        let request = Request { id: id.clone(), method: method.to_owned(), params };
        self.connection.sender.send(Message::Request(request)).expect("the server listens");
        loop {
            match self.connection.receiver.recv_timeout(PATIENCE).expect("the server answers") {
                Message::Response(response) if response.id == id => {
                    let value = serde_json::to_value(&response).expect("a message is JSON");
                    return match value.get("error") {
                        Some(error) => Err(error["message"].as_str().unwrap_or_default().to_owned()),
                        None => Ok(value["result"].clone()),
                    };
                }
                _ => {}
            }
        }
    }

    /// Opens a document.
    pub fn open(&mut self, name: &str, text: &str) {
        self.versions.insert(name.to_owned(), 1);
        let document = json!({ "uri": uri(name), "languageId": "modl", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Changes a document, as the protocol's change events say; returns its version.
    pub fn change(&mut self, name: &str, changes: Value) -> i64 {
        let version = self.versions.get_mut(name).expect("it is open");
        *version += 1;
        let version = *version;
        let document = json!({ "uri": uri(name), "version": version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
        version
    }

    /// Returns the diagnostics that are published next for a document and a version for which `wanted` holds.
    pub fn published(&mut self, name: &str, wanted: impl Fn(i64, &[Value]) -> bool) -> Vec<Value> {
        loop {
            let message = self.connection.receiver.recv_timeout(PATIENCE).expect("diagnostics come");
            let Message::Notification(Notification { method, params }) = message else { continue };
            if method != "textDocument/publishDiagnostics" || params["uri"] != uri(name) {
                continue;
            }
            let found = params["diagnostics"].as_array().cloned().unwrap_or_default();
            if wanted(params["version"].as_i64().unwrap_or(0), &found) {
                return found;
            }
        }
    }

    /// Asks about the place of `|` in a text that is opened without that mark as `main.mod`.
    pub fn ask_at(&mut self, method: &str, marked: &str, more: Value) -> Value {
        self.try_at(method, marked, more).unwrap_or_else(|refusal| panic!("{method}: {refusal}"))
    }

    /// Asks as [`ask_at`](Self::ask_at); the words of a refusal otherwise.
    pub fn try_at(&mut self, method: &str, marked: &str, more: Value) -> Result<Value, String> {
        let (before, after) = marked.split_once('|').expect("a mark");
        self.open("main.mod", &format!("{before}{after}"));
        let (line, column) = end_of(before);
        let mut params = json!({
            "textDocument": { "uri": uri("main.mod") },
            "position": { "line": line, "character": column },
        });
        for (key, value) in more.as_object().into_iter().flatten() {
            params[key] = value.clone();
        }
        self.try_to(method, params)
    }

    /// Says goodbye, and returns true if the server took it as one.
    pub fn end(mut self) -> bool {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        self.server.take().expect("it runs").join().expect("the server ends").expect("the protocol is kept")
    }
}

/// Returns the line and the column, in UTF-16, at the end of a text.
pub fn end_of(text: &str) -> (usize, usize) {
    let last = text.rsplit('\n').next().unwrap_or("");
    (text.matches('\n').count(), last.encode_utf16().count())
}

/// Returns the piece of a text that a range of the protocol, in UTF-16, marks.
pub fn piece<'t>(text: &'t str, range: &Value) -> &'t str {
    let at = |place: &Value| {
        let [line, column] = ["line", "character"].map(|key| place[key].as_u64().expect("a number") as usize);
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let units: Vec<u16> = text[start..].encode_utf16().take(column).collect();
        start + String::from_utf16(&units).expect("whole characters").len()
    };
    &text[at(&range["start"])..at(&range["end"])]
}
