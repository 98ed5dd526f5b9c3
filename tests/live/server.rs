//! The server of the page: who is answered, what is written, and what it does with files and requests that are none.

use super::served::{Answer, Served};
use serde_json::{Value, json};
use std::collections::BTreeSet;

const TEXT: &str = "\
use std.smores.Smores

config Pair(bend: Angle = 30deg) {
  part a: Smores
  part b: Smores
  connect a.bottom -- b.top
  set a.tilt = 10deg
  set b.tilt = bend
}
";

fn tilt(degrees: f64) -> Value {
    json!({ "edit": "joint", "robot": "Pair", "joint": "a.tilt", "value": degrees.to_radians() })
}

fn nothing(status: u16) -> Option<Answer> {
    Some(Answer { status, body: String::new() })
}

#[test]
fn another_origin_or_a_wrong_token_gets_nothing() {
    let served = Served::new(TEXT.as_bytes());
    let (own, token, port) = (served.own(), &served.token, served.port);
    let page = served.request("GET", &format!("/{token}/"), &own, "").expect("its own page is served");
    assert_eq!(page.status, 200);
    assert!(page.body.starts_with("<!doctype html>"));
    // The page is served as an address that is typed, without an origin, too.
    let typed = format!("Host: localhost:{port}\r\nSec-Fetch-Site: none\r\n");
    assert_eq!(served.request("GET", &format!("/{token}/"), &typed, "").map(|a| a.status), Some(200));

    let wrong: String = token.chars().map(|c| if c == '0' { '1' } else { '0' }).collect();
    for path in
        ["/".to_owned(), "/state?since=0".to_owned(), format!("/{wrong}/"), format!("/{wrong}/state?since=0")]
    {
        assert_eq!(served.request("GET", &path, &own, ""), nothing(404), "{path}");
    }
    for path in [&token[..31], &format!("{token}0"), "", "..", "%2e%2e"] {
        assert_eq!(
            served.request("GET", &format!("/{path}/state?since=0"), &own, ""),
            nothing(404),
            "{path}"
        );
    }

    let host = format!("Host: 127.0.0.1:{port}\r\n");
    let others = [
        "Host: example.org\r\n".to_owned(),
        format!("Host: example.org:{port}\r\n"),
        "Host: 127.0.0.1\r\n".to_owned(),
        String::new(),
        format!("{host}{host}"),
        format!("{host}Origin: http://example.org\r\n"),
        format!("{host}Origin: http://127.0.0.1:{}\r\n", port ^ 1),
        format!("{host}Origin: https://127.0.0.1:{port}\r\n"),
        format!("{host}Origin: null\r\n"),
        format!("{host}Sec-Fetch-Site: cross-site\r\n"),
        format!("{host}Sec-Fetch-Site: same-site\r\n"),
    ];
    for headers in others {
        for (method, what) in [("GET", ""), ("GET", "state?since=0"), ("POST", "edit"), ("POST", "undo")] {
            let headers = format!("{headers}Content-Type: application/json\r\n");
            let body = json!({ "version": 1, "edit": tilt(5.0) }).to_string();
            let found = served.request(method, &format!("/{token}/{what}"), &headers, &body);
            assert_eq!(found, nothing(403), "{headers}");
        }
    }
    assert_eq!(served.text(), TEXT);
    // Two servers have two tokens.
    let tokens: BTreeSet<String> = (0..3).map(|_| Served::new(b"").token.clone()).collect();
    assert_eq!(tokens.len(), 3);
    assert!(tokens.iter().all(|token| token.len() == 32));
}

#[test]
fn requests_that_are_none_are_not_answered_and_end_nothing() {
    let served = Served::new(TEXT.as_bytes());
    let (own, token) = (served.own(), &served.token);
    let long = |n: usize| "x".repeat(n);
    let junk: [Vec<u8>; 9] = [
        b"\x16\x03\x01\x02\x00\x01\x00\xff\xfe\x00".to_vec(),
        (0..=255).collect(),
        b"GET\r\n\r\n".to_vec(),
        format!("GET /{token}/{} HTTP/1.1\r\n{own}\r\n", long(20_000)).into_bytes(),
        format!("GET /{token}/ HTTP/1.1\r\n{own}X: {}\r\n\r\n", long(20_000)).into_bytes(),
        format!("GET /{token}/ HTTP/1.1\r\n{own}{}\r\n", "X: y\r\n".repeat(100)).into_bytes(),
        format!("POST /{token}/edit HTTP/1.1\r\n{own}Content-Length: 99999999\r\n\r\n").into_bytes(),
        format!("POST /{token}/edit HTTP/1.1\r\n{own}Content-Length: -1\r\n\r\n").into_bytes(),
        format!("POST /{token}/edit HTTP/1.1\r\n{own}Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n")
            .into_bytes(),
    ];
    for bytes in junk {
        assert_eq!(served.raw(&bytes), b"", "{:?}", String::from_utf8_lossy(&bytes));
    }
    let json = own.clone() + "Content-Type: application/json\r\n";
    let edit = |headers: &str, body: &str| served.request("POST", &format!("/{token}/edit"), headers, body);
    for body in [
        "",
        "{",
        "null",
        "[]",
        "{\"version\":1}",
        "{\"version\":-1,\"edit\":null}",
        "\u{1F916}",
        &"[".repeat(60_000),
    ] {
        assert_eq!(edit(&json, body), nothing(400), "{body}");
    }
    let strange = json!({ "version": 1, "edit": { "edit": "delete", "robot": "Pair" } }).to_string();
    assert_eq!(edit(&json, &strange), nothing(400));
    assert_eq!(edit(&own, &json!({ "version": 1, "edit": tilt(5.0) }).to_string()), nothing(415));
    assert_eq!(served.request("DELETE", &format!("/{token}/"), &own, ""), nothing(404));
    assert_eq!(served.request("GET", &format!("/{token}/main.mod"), &own, ""), nothing(404));
    assert_eq!(served.request("GET", &format!("/{token}/edit"), &own, ""), nothing(404));
    // It still serves, and wrote nothing.
    assert_eq!(served.state(0)["text"], TEXT);
    assert_eq!(served.text(), TEXT);
}

#[test]
fn a_change_is_written_and_undone_to_the_byte() {
    let served = Served::new(TEXT.as_bytes());
    let first = served.state(0);
    assert_eq!(first["model"]["robot"]["name"], "Pair");
    let version = first["version"].as_u64().expect("a number");
    let (status, foreseen) = served.ask("preview", version, Some(tilt(-20.0)));
    assert_eq!(status, 200);
    assert_eq!(foreseen["robot"]["modules"].as_array().map(Vec::len), Some(2));
    assert_eq!(served.text(), TEXT, "a preview writes nothing");
    let (status, answer) = served.ask("edit", version, Some(tilt(-20.0)));
    assert_eq!((status, &answer["refused"]), (200, &Value::Null));
    assert_eq!(served.text(), TEXT.replace("10deg", "-20deg"));
    let shown = served.state(version);
    assert_eq!(shown["version"], answer["version"]);
    assert_eq!((&shown["undo"], &shown["redo"]), (&json!(true), &json!(false)));
    let now = answer["version"].as_u64().expect("a number");
    let (_, undone) = served.ask("undo", now, None);
    assert_eq!(served.text(), TEXT);
    let (_, again) = served.ask("redo", undone["version"].as_u64().expect("a number"), None);
    assert_eq!(served.text(), TEXT.replace("10deg", "-20deg"));
    let (status, _) = served.ask("undo", again["version"].as_u64().expect("a number"), None);
    assert_eq!((status, served.text().as_str()), (200, TEXT));
    let refused =
        served.ask("edit", served.state(0)["version"].as_u64().expect("a number"), Some(tilt(175.0)));
    assert!(refused.1["refused"].as_str().is_some_and(|why| why.contains("a.tilt")), "{refused:?}");
    assert_eq!(served.text(), TEXT);
}

#[test]
fn what_changed_under_the_hand_is_not_overwritten() {
    let served = Served::new(TEXT.as_bytes());
    let version = served.state(0)["version"].as_u64().expect("a number");
    let typed = TEXT.replace("30deg", "35deg");
    served.write(&typed);
    // The page's version is an old one, also if the server has not seen the change by now.
    let (status, answer) = served.ask("edit", version, Some(tilt(-20.0)));
    assert_eq!(status, 409, "{answer}");
    assert_eq!(served.text(), typed);
    let now = served.until(|state| state["text"] == typed);
    assert!(now["version"].as_u64() > Some(version));
    let (status, _) = served.ask("edit", version, Some(tilt(-20.0)));
    assert_eq!((status, served.text()), (409, typed));
    assert_eq!(served.ask("preview", version, Some(tilt(-20.0))), (200, Value::Null));
}

#[test]
fn two_pages_see_the_same_and_one_change_wins() {
    let served = &Served::new(TEXT.as_bytes());
    let version = served.state(0)["version"].as_u64().expect("a number");
    let found: Vec<(u16, Value)> = std::thread::scope(|scope| {
        let waiting: Vec<_> = (0..2).map(|_| scope.spawn(move || served.state(version))).collect();
        let edits = [20.0, 25.0].map(|x| scope.spawn(move || served.ask("edit", version, Some(tilt(x)))));
        let found: Vec<(u16, Value)> = edits.map(|thread| thread.join().expect("it ends")).into();
        for page in waiting {
            let seen = page.join().expect("it ends");
            assert_ne!(seen["text"], TEXT);
        }
        found
    });
    let mut statuses: Vec<u16> = found.iter().map(|(status, _)| *status).collect();
    statuses.sort_unstable();
    assert_eq!(statuses, [200, 409]);
    let written = served.text();
    assert!([20, 25].iter().any(|x| written == TEXT.replace("10deg", &format!("{x}deg"))), "{written}");
}

#[test]
fn a_file_that_is_gone_or_no_text_is_told_about() {
    let served = Served::new(TEXT.as_bytes());
    let first = served.state(0);
    std::fs::remove_file(served.file()).expect("the file is there");
    let gone = served.until(|state| !state["gone"].is_null());
    assert!(gone["gone"].as_str().is_some_and(|why| why.contains("does not exist")), "{}", gone["gone"]);
    assert_eq!(gone["text"], first["text"]);
    let (_, answer) = served.ask("edit", gone["version"].as_u64().expect("a number"), Some(tilt(5.0)));
    assert!(answer["refused"].as_str().is_some_and(|why| why.contains("does not exist")), "{answer}");
    assert!(!served.file().exists());
    std::fs::write(served.file(), b"\xff\xfe\x00let").expect("the file can be written");
    served.until(|state| state["gone"].as_str().is_some_and(|why| why.contains("not UTF-8")));
    served.write("config {");
    let wrong = served.until(|state| state["text"] == "config {" && state["gone"].is_null());
    assert!(!wrong["model"]["findings"].as_array().expect("a list").is_empty());
    assert!(wrong["model"]["robot"].is_null());
    served.write(TEXT);
    let mended = served.until(|state| state["text"] == TEXT);
    assert_eq!(mended["model"]["robot"]["name"], "Pair");
}

#[test]
fn what_is_imported_is_watched_too() {
    let served = Served::new(b"use \"part.mod\".{angle}\nuse std.smores.Smores\nconfig One { part m: Smores  set m.tilt = angle }\n");
    std::fs::write(served.sandbox.path("part.mod"), "let angle = 12deg\n").expect("the file can be written");
    let tilt = |state: &Value| {
        state["model"]["robot"]["joints"][0]["value"].as_f64().map(|x| x.to_degrees().round())
    };
    served.until(|state| tilt(state) == Some(12.0));
    std::fs::write(served.sandbox.path("part.mod"), "let angle = 34deg\n").expect("the file can be written");
    served.until(|state| tilt(state) == Some(34.0));
}

#[test]
fn calls_that_are_wrong_end_with_2() {
    let served = Served::new(TEXT.as_bytes());
    let sandbox = &served.sandbox;
    for arguments in [
        &["watch", "--page", "-"][..],
        &["watch", "--page", "main.mod", "main.mod"],
        &["watch", "--page", "nothing.mod"],
        &["watch", "--page", "--json", "main.mod"],
        &["watch", "--page", "--run", "main.mod"],
        &["watch", "--port", "1", "main.mod"],
        &["watch", "--page", "--port", &served.port.to_string(), "main.mod"],
    ] {
        let ran = sandbox.run(arguments);
        assert_eq!(ran.code, 2, "{arguments:?}: {}{}", ran.out, ran.err);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_page_while_somebody_waits() {
    let mut served = Served::new(TEXT.as_bytes());
    let version = served.state(0)["version"].as_u64().expect("a number");
    let id = served.child.id().to_string();
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| {
            served.raw(
                format!(
                    "GET /{}/state?since={version}&robot= HTTP/1.1\r\n{}\r\n",
                    served.token,
                    served.own()
                )
                .as_bytes(),
            )
        });
        drop(std::process::Command::new("kill").args(["-INT", &id]).status());
        // It is answered that there is nothing new, or the connection is closed.
        drop(waiting.join().expect("it ends"));
    });
    assert_eq!(served.child.wait().expect("it ends").code(), Some(130));
}
