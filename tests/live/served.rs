//! `modl watch --page`, started, and asked over plain sockets.

use crate::desk::cli::Sandbox;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::Duration;

/// A server that says nothing for so long is broken, on any machine.
const SILENCE_MAX: Duration = Duration::from_secs(60);

/// A page that is served.
pub struct Served {
    pub sandbox: Sandbox,
    pub child: Child,
    pub address: String,
    pub port: u16,
    pub token: String,
}

/// An answer: its status, and its body.
#[derive(Debug, PartialEq)]
pub struct Answer {
    pub status: u16,
    pub body: String,
}

impl Served {
    /// The page of a file `main.mod` with this text.
    pub fn new(text: &[u8]) -> Served {
        let sandbox = Sandbox::new(&[("main.mod", text)]);
        let mut command = sandbox.command(&["watch", "--page", "main.mod"]);
        let mut child =
            command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the command runs");
        let mut address = String::new();
        let stdout = child.stdout.take().expect("it is piped");
        BufReader::new(stdout).read_line(&mut address).expect("it prints its address");
        let address = address.trim().to_owned();
        let rest = address.strip_prefix("http://127.0.0.1:").expect("it listens on this machine alone");
        let (port, token) = rest.split_once('/').expect("the token follows");
        let (port, token) = (port.parse().expect("a port"), token.trim_end_matches('/').to_owned());
        Served { sandbox, child, address, port, token }
    }

    pub fn file(&self) -> PathBuf {
        self.sandbox.path("main.mod")
    }

    pub fn text(&self) -> String {
        std::fs::read_to_string(self.file()).expect("the file is there")
    }

    pub fn write(&self, text: &str) {
        std::fs::write(self.file(), text).expect("the file can be written");
    }

    /// Sends bytes, and returns all that is answered; empty where the connection is closed without an answer.
    pub fn raw(&self, bytes: &[u8]) -> Vec<u8> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        stream.set_read_timeout(Some(SILENCE_MAX)).expect("a time limit");
        // The server may have closed the connection already, which is an answer, too.
        drop(stream.write_all(bytes));
        let mut answer = Vec::new();
        drop(stream.read_to_end(&mut answer));
        answer
    }

    /// Sends a request with these headers, each with its line end.
    pub fn request(&self, method: &str, target: &str, headers: &str, body: &str) -> Option<Answer> {
        let length = body.len();
        let head = format!("{method} {target} HTTP/1.1\r\n{headers}Content-Length: {length}\r\n\r\n{body}");
        let answer = String::from_utf8(self.raw(head.as_bytes())).expect("answers are text");
        let (head, body) = answer.split_once("\r\n\r\n")?;
        let status = head.split(' ').nth(1)?.parse().ok()?;
        Some(Answer { status, body: body.to_owned() })
    }

    /// The headers of the page itself.
    pub fn own(&self) -> String {
        format!("Host: 127.0.0.1:{0}\r\nOrigin: http://127.0.0.1:{0}\r\n", self.port)
    }

    /// The state that the page shows once it has another version than `since`.
    pub fn state(&self, since: u64) -> Value {
        let target = format!("/{}/state?since={since}&robot=", self.token);
        let answer = self.request("GET", &target, &self.own(), "").expect("it answers");
        assert_eq!(answer.status, 200);
        serde_json::from_str(&answer.body).expect("the state is JSON")
    }

    /// The state once `is` holds of it.
    pub fn until(&self, is: impl Fn(&Value) -> bool) -> Value {
        let mut since = 0;
        for _ in 0..100 {
            let state = self.state(since);
            if !state.is_null() && is(&state) {
                return state;
            }
            since = state["version"].as_u64().unwrap_or(since);
        }
        panic!("the page never shows it");
    }

    /// Asks for a change; returns the status, and the answer if it is JSON.
    pub fn ask(&self, what: &str, version: u64, edit: Option<Value>) -> (u16, Value) {
        let headers = self.own() + "Content-Type: application/json\r\n";
        let body = match edit {
            Some(edit) => json!({ "version": version, "edit": edit }),
            None => json!({ "version": version }),
        };
        let target = format!("/{}/{what}", self.token);
        let answer = self.request("POST", &target, &headers, &body.to_string()).expect("it answers");
        (answer.status, serde_json::from_str(&answer.body).unwrap_or(Value::Null))
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
