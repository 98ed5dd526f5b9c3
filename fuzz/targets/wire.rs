//! The language server, talked to.

use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::project::Project;
use crate::fuzz::inputs::{sessions, wire};
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use modl::language_server::{Opened, Workspace, serve};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The folder of all documents.
const ROOT: &str = "/p";

struct Folder(Arc<Project>);

impl Workspace for Folder {
    fn open(&self, path: &Path) -> Option<Opened> {
        let name = path.strip_prefix(ROOT).ok()?.to_str()?.to_owned();
        Some(Opened { files: self.0.clone(), root: PathBuf::from(ROOT), name })
    }
}

/// Returns a conversation.
pub fn input(dice: &mut Dice) -> Vec<u8> {
    wire::conversation(dice)
}

/// Talks to a server: each request has one answer, and the server says goodbye.
pub fn check(input: &[u8]) {
    let mut project = Project::default();
    project.0.insert("hinge.mod".to_owned(), sessions::HINGE.as_bytes().to_vec());
    let folder = Folder(Arc::new(project));
    let (server, editor) = Connection::memory();
    let thread = std::thread::spawn(move || serve(&server, &folder));
    let say = |message: Message| editor.sender.send(message).expect("the server listens");
    let ask = |id: i32, method: &str, params: Value| {
        say(Message::Request(Request { id: RequestId::from(id), method: method.to_owned(), params }));
    };
    let encodings = if input.len().is_multiple_of(2) { json!(["utf-8"]) } else { json!(["utf-16"]) };
    let capabilities = json!({ "general": { "positionEncodings": encodings } });
    ask(-1, "initialize", json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
    say(Message::Notification(Notification { method: "initialized".to_owned(), params: json!({}) }));
    // Numbers of our own, since those of the input may be missing or the same.
    let mut asked = 0;
    for line in String::from_utf8_lossy(input).lines() {
        let Ok(message) = serde_json::from_str::<Value>(line) else { continue };
        let method = message["method"].as_str().unwrap_or("").to_owned();
        let params = message["params"].clone();
        if ["shutdown", "exit", "initialize"].contains(&method.as_str()) {
            continue;
        }
        if message["id"].is_null() {
            say(Message::Notification(Notification { method, params }));
        } else {
            ask(asked, &method, params);
            asked += 1;
        }
    }
    ask(-2, "shutdown", Value::Null);
    say(Message::Notification(Notification { method: "exit".to_owned(), params: Value::Null }));
    let mut answers = BTreeMap::new();
    for message in &editor.receiver {
        let Message::Response(response) = message else { continue };
        let id = response.id.clone();
        *answers.entry(id.clone()).or_insert(0) += 1;
        if id == RequestId::from(-2) {
            break;
        }
    }
    let told = thread.join().expect("the server does not panic");
    assert_eq!(told, Ok(true), "the server says goodbye");
    let ids = (0..asked).chain([-1, -2]).map(RequestId::from);
    let missing: Vec<RequestId> = ids.filter(|id| answers.get(id) != Some(&1)).collect();
    assert!(missing.is_empty(), "not answered once: {missing:?}");
}
