//! The server of the page: it listens on this machine only, and answers nobody who does not know its token.

use super::super::CallError;
use super::super::disk::system_words;
use super::answers::{answer, nothing};
use super::http::{self, Request, Response};
use super::program::Program;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// The most connections at a time: pages wait for changes with one each.
const CONNECTIONS_MAX: usize = 48;

/// The time between two looks for a connection.
const ACCEPT_INTERVAL: Duration = Duration::from_millis(2);

/// The stack of a connection's thread: programs that are checked nest.
const STACK_BYTES: usize = 32 << 20;

/// The bytes of the token, which nobody guesses.
const TOKEN_BYTES: usize = 16;

/// A server that listens.
pub(super) struct Server {
    listener: TcpListener,
    port: u16,
    token: String,
    program: Arc<Program>,
}

impl Server {
    /// Returns a server of a program's page, which listens on a port of the loopback interface; a free one for `None`.
    ///
    /// # Errors
    /// A message if the port is taken, or the system has no random numbers.
    pub(super) fn bind(program: Arc<Program>, port: Option<u16>) -> Result<Server, CallError> {
        let cannot = |e: std::io::Error| {
            let port = port.map_or_else(String::new, |port| format!(" on port {port}"));
            CallError(format!("the page can't be served{port}: {}", system_words(&e)))
        };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port.unwrap_or(0))).map_err(cannot)?;
        listener.set_nonblocking(true).map_err(cannot)?;
        let port = listener.local_addr().map_err(cannot)?.port();
        let mut bytes = [0; TOKEN_BYTES];
        getrandom::fill(&mut bytes)
            .map_err(|e| CallError(format!("the system has no random numbers: {e}")))?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Server { listener, port, token, program })
    }

    /// Returns the address of the page, with its token.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Answers requests, each on a thread of its own, until `is_over` returns true.
    pub(super) fn serve(&self, is_over: &(dyn Fn() -> bool + Sync)) {
        let open = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            while !is_over() {
                let Ok((stream, _)) = self.listener.accept() else {
                    std::thread::park_timeout(ACCEPT_INTERVAL);
                    continue;
                };
                if open.fetch_add(1, Ordering::Relaxed) >= CONNECTIONS_MAX {
                    open.fetch_sub(1, Ordering::Relaxed);
                    continue;
                }
                let open = Open(&open);
                let one = move || {
                    let _open = open;
                    self.one(stream);
                };
                // Without a thread the connection is closed.
                drop(std::thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, one));
            }
        });
    }

    /// Answers the request of a connection, and nothing that is no request.
    fn one(&self, mut stream: TcpStream) {
        if stream.set_nonblocking(false).is_err() {
            return;
        }
        let Some(request) = http::read(&mut stream) else { return };
        let response = self.response(&request);
        // Whoever asked may be gone.
        drop(http::write(&mut stream, &response));
    }

    /// Returns the answer to a request: nothing but a status for another host or origin, or without the token.
    fn response(&self, request: &Request) -> Response {
        if !self.is_own(request) {
            return nothing("403 Forbidden");
        }
        let (path, query) = request.target.split_once('?').unwrap_or((&request.target, ""));
        let Some((token, path)) = path.strip_prefix('/').and_then(|path| path.split_once('/')) else {
            return nothing("404 Not Found");
        };
        if !same(token, &self.token) {
            return nothing("404 Not Found");
        }
        answer(&self.program, request, path, query)
    }

    /// Returns true if a request is for this server and comes from its own page, or from no page. A page of another origin
    /// may have a name of its own stand for this machine: then the host is another one.
    fn is_own(&self, request: &Request) -> bool {
        let hosts = ["127.0.0.1", "localhost"].map(|host| format!("{host}:{}", self.port));
        let host = request.header("host").is_some_and(|host| hosts.iter().any(|own| own == host));
        let origin = match request.header("origin") {
            Some(origin) => hosts.iter().any(|own| origin.strip_prefix("http://") == Some(own)),
            None => !request.has("origin"),
        };
        let site = match request.header("sec-fetch-site") {
            Some(site) => matches!(site, "same-origin" | "none"),
            None => !request.has("sec-fetch-site"),
        };
        host && origin && site
    }
}

/// A connection that is open, among those that are counted.
struct Open<'a>(&'a AtomicUsize);

impl Drop for Open<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Returns true if two texts are the same, in a time that does not tell where they differ.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |all, (x, y)| all | (x ^ y)) == 0
}
