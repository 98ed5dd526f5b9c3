//! An editor for tests: opens and changes documents of a project in memory, and asks.

use crate::support::suite::MapFiles;
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use modl::language_server::{Opened, Workspace, serve};
use modl::source::{Files, ReadError};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// The time after which a message is missing.
const PATIENCE: Duration = Duration::from_secs(60);

/// The folder of all documents.
const ROOT: &str = "/p";

/// The files on disk, which a test may change.
struct Disk(Mutex<MapFiles>);

impl Files for Disk {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.0.lock().expect("no writer fails").read(path)
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        modl::source::library::text(path).map(Cow::Borrowed)
    }

    fn list(&self, folder: &str) -> Vec<String> {
        let files = self.0.lock().expect("no writer fails");
        let inside = |path: &String| {
            let below = path.strip_prefix(folder)?.trim_start_matches('/');
            Some(below.split_once('/').map_or(below.to_owned(), |(folder, _)| format!("{folder}/")))
        };
        let mut names: Vec<String> = files.0.keys().filter_map(inside).collect();
        names.dedup();
        names
    }
}

struct Folder(Arc<Disk>);

impl Workspace for Folder {
    fn open(&self, path: &Path) -> Option<Opened> {
        let name = path.strip_prefix(ROOT).ok()?.to_str()?.to_owned();
        Some(Opened { files: self.0.clone(), root: PathBuf::from(ROOT), name })
    }
}

/// An editor with its server.
pub struct Client {
    disk: Arc<Disk>,
    connection: Connection,
    server: Option<std::thread::JoinHandle<Result<bool, String>>>,
    next: i32,
    versions: BTreeMap<String, i64>,
    /// The capabilities that the server stated.
    pub capabilities: Value,
    /// The requests of the server that came while something else was awaited.
    requests: Vec<String>,
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
        let disk = Arc::new(Disk(Mutex::new(MapFiles(bytes.collect()))));
        let (server, connection) = Connection::memory();
        let folder = Folder(disk.clone());
        let thread = std::thread::spawn(move || serve(&server, &folder));
        let mut client = Client {
            disk,
            connection,
            server: Some(thread),
            next: 0,
            versions: BTreeMap::new(),
            capabilities: Value::Null,
            requests: Vec::new(),
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
        let id = self.begin(method, params);
        self.answer(id)
    }

    /// Asks, and returns the number of the question.
    pub fn begin(&mut self, method: &str, params: Value) -> i32 {
        self.next += 1;
        let request = Request { id: RequestId::from(self.next), method: method.to_owned(), params };
        self.connection.sender.send(Message::Request(request)).expect("the server listens");
        self.next
    }

    /// Returns the answer to a question, or the words of a refusal; what is published meanwhile is left.
    pub fn answer(&mut self, id: i32) -> Result<Value, String> {
        loop {
            match self.received("the server answers") {
                Message::Response(response) if response.id == RequestId::from(id) => {
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

    /// Waits for a request of the server, which may have come before; what is published meanwhile is left.
    pub fn awaits(&mut self, method: &str) {
        while !self.requests.iter().any(|asked| asked == method) {
            self.received(method);
        }
        self.requests.retain(|asked| asked != method);
    }

    /// Returns the next message.
    fn received(&mut self, wanted: &str) -> Message {
        let message = self.connection.receiver.recv_timeout(PATIENCE).expect(wanted);
        if let Message::Request(request) = &message {
            self.requests.push(request.method.clone());
        }
        message
    }

    /// Writes a file behind the editor's back.
    pub fn writes(&self, name: &str, text: &str) {
        let mut files = self.disk.0.lock().expect("no writer fails");
        files.0.insert(name.to_owned(), text.as_bytes().to_vec());
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
            let message = self.received("diagnostics come");
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
