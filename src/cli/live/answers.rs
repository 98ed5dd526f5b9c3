//! The requests of the page, and their answers.

use super::http::{Request, Response};
use super::program::{Program, Shown};
use crate::live::{Edit, Model, Refusal};
use crate::source::percent;
use crate::view;
use serde::Deserialize;
use serde_json::{Value, json};
use std::time::Duration;

/// The time that an answer waits for a change before it says that there is none.
const WAIT: Duration = Duration::from_secs(10);

/// A change that a page asks for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    /// The version of the text that the page shows.
    version: u64,
    /// The change; `None` to undo one or to make one again.
    edit: Option<Edit>,
}

/// Returns the answer to a request. `path`: what follows the token, without the query; `query`: what follows that.
pub(super) fn answer(program: &Program, request: &Request, path: &str, query: &str) -> Response {
    match (request.method.as_str(), path) {
        ("GET", "") => Response {
            status: "200 OK",
            kind: "text/html; charset=utf-8",
            body: view::live_page().into_bytes(),
        },
        ("GET", "state") => {
            let since = value_of(query, "since").and_then(|since| since.parse().ok()).unwrap_or(0);
            let wanted = value_of(query, "robot").unwrap_or_default();
            match program.shown(since, &wanted, WAIT) {
                Some(shown) => json_of("200 OK", &state(&shown)),
                None => json_of("200 OK", &Value::Null),
            }
        }
        ("POST", "edit" | "preview" | "undo" | "redo") => changed(program, request, path),
        _ => nothing("404 Not Found"),
    }
}

/// Returns an answer without words.
pub(super) fn nothing(status: &'static str) -> Response {
    Response { status, kind: "text/plain; charset=utf-8", body: Vec::new() }
}

fn json_of(status: &'static str, value: &Value) -> Response {
    Response { status, kind: "application/json", body: value.to_string().into_bytes() }
}

/// Makes a change, or says why not.
fn changed(program: &Program, request: &Request, path: &str) -> Response {
    let kind = request.header("content-type").unwrap_or_default();
    if kind.split(';').next().is_none_or(|kind| !kind.trim().eq_ignore_ascii_case("application/json")) {
        return nothing("415 Unsupported Media Type");
    }
    let Ok(asked) = serde_json::from_slice::<Asked>(&request.body) else {
        return nothing("400 Bad Request");
    };
    let done = match (path, &asked.edit) {
        ("edit", Some(edit)) => {
            program.edit(asked.version, edit).map(|version| json!({ "version": version }))
        }
        ("preview", Some(edit)) => program.preview(asked.version, edit).map(|model| of_model(&model)),
        ("undo", None) => program.step(asked.version, false).map(|version| json!({ "version": version })),
        ("redo", None) => program.step(asked.version, true).map(|version| json!({ "version": version })),
        _ => return nothing("400 Bad Request"),
    };
    match done {
        Ok(value) => json_of("200 OK", &value),
        // A preview of an older text is of no interest any more.
        Err(Refusal::Outdated) if path == "preview" => json_of("200 OK", &Value::Null),
        Err(Refusal::Outdated) => json_of(
            "409 Conflict",
            &json!({ "refused": "the text has changed meanwhile; look, and try again" }),
        ),
        Err(Refusal::Refused(why)) => json_of("200 OK", &json!({ "refused": why })),
    }
}

fn of_model(model: &Model) -> Value {
    serde_json::to_value(model).unwrap_or(Value::Null)
}

fn state(shown: &Shown) -> Value {
    json!({
        "version": shown.version,
        "text": shown.text,
        "gone": shown.gone,
        "undo": shown.can.0,
        "redo": shown.can.1,
        "model": of_model(&shown.model),
    })
}

/// Returns a value of a query, `name=value&...`, of which percent signs stand for bytes.
fn value_of(query: &str, name: &str) -> Option<String> {
    let (_, value) =
        query.split('&').filter_map(|pair| pair.split_once('=')).find(|(known, _)| *known == name)?;
    percent::decoded(value)
}
