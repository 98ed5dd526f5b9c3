//! Requests and answers of HTTP/1.1, one of each for a connection: what a page on the same machine needs, with limits for all that a
//! client sends.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// The most bytes of a request before its body.
const HEAD_MAX: usize = 16 << 10;

/// The most bytes of a body: a change that is asked for is short.
const BODY_MAX: usize = 64 << 10;

/// The most headers of a request.
const HEADERS_MAX: usize = 64;

/// The time in which a client has to send its request, and in which it has to take each piece of the answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// A request.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Request {
    /// The method, such as `GET`.
    pub method: String,
    /// The path with the query.
    pub target: String,
    /// The headers, with names in small letters, in order.
    pub headers: Vec<(String, String)>,
    /// The body; empty without one.
    pub body: Vec<u8>,
}

impl Request {
    /// Returns the value of a header, if there is exactly one of its name (in small letters).
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        let mut found = self.headers.iter().filter(|(known, _)| known == name);
        let first = found.next()?;
        found.next().is_none().then_some(first.1.as_str())
    }

    /// Returns true if there is a header of this name (in small letters).
    pub(super) fn has(&self, name: &str) -> bool {
        self.headers.iter().any(|(known, _)| known == name)
    }
}

/// Reads a request from a connection; `None` for what is no request, is too long, or takes too long.
pub(super) fn read(stream: &mut TcpStream) -> Option<Request> {
    let end = Instant::now() + PATIENCE;
    let mut bytes = Vec::new();
    loop {
        if let Some((mut request, body_at)) = head(&bytes).ok()? {
            let length = body_length(&request)?;
            while bytes.len() < body_at + length {
                more(stream, &mut bytes, end)?;
            }
            request.body = bytes[body_at..body_at + length].to_vec();
            return Some(request);
        }
        if bytes.len() > HEAD_MAX {
            return None;
        }
        more(stream, &mut bytes, end)?;
    }
}

/// Reads the next bytes; `None` at the end of the stream or of the time.
fn more(stream: &mut TcpStream, bytes: &mut Vec<u8>, end: Instant) -> Option<()> {
    let left = end.checked_duration_since(Instant::now()).filter(|left| !left.is_zero())?;
    stream.set_read_timeout(Some(left)).ok()?;
    let mut piece = [0; 4096];
    let count = stream.read(&mut piece).ok().filter(|count| *count > 0)?;
    bytes.extend_from_slice(&piece[..count]);
    Some(())
}

/// Bytes that are no request.
struct NoRequest;

/// Returns the request without its body, and the place at which that begins; `None` while bytes are missing.
///
/// # Errors
/// [`NoRequest`] for bytes that are none, or a head that is too long.
fn head(bytes: &[u8]) -> Result<Option<(Request, usize)>, NoRequest> {
    let mut headers = [httparse::EMPTY_HEADER; HEADERS_MAX];
    let mut parsed = httparse::Request::new(&mut headers);
    let body_at = match parsed.parse(bytes) {
        Ok(httparse::Status::Partial) => return Ok(None),
        Ok(httparse::Status::Complete(at)) if at <= HEAD_MAX => at,
        Ok(httparse::Status::Complete(_)) | Err(_) => return Err(NoRequest),
    };
    let header = |header: &httparse::Header<'_>| {
        let value = std::str::from_utf8(header.value).map_err(|_| NoRequest)?;
        Ok((header.name.to_ascii_lowercase(), value.trim().to_owned()))
    };
    let request = Request {
        method: parsed.method.ok_or(NoRequest)?.to_owned(),
        target: parsed.path.ok_or(NoRequest)?.to_owned(),
        headers: parsed.headers.iter().map(header).collect::<Result<_, _>>()?,
        body: Vec::new(),
    };
    Ok(Some((request, body_at)))
}

/// Returns the length of a body; `None` where it is not stated plainly, or is too long.
fn body_length(request: &Request) -> Option<usize> {
    if request.has("transfer-encoding") {
        return None;
    }
    if !request.has("content-length") {
        return Some(0);
    }
    let stated = request.header("content-length")?;
    let digits = !stated.is_empty() && stated.bytes().all(|byte| byte.is_ascii_digit());
    stated.parse().ok().filter(|length| digits && *length <= BODY_MAX)
}

/// An answer.
pub(super) struct Response {
    /// The status with its words, such as `200 OK`.
    pub status: &'static str,
    /// The type of the body.
    pub kind: &'static str,
    /// The body.
    pub body: Vec<u8>,
}

/// The headers of all answers. The page may run its own scripts and ask the server that it comes from; no other page may
/// show or read it.
const HEADERS: &str = "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
    img-src data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
    X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
    Cross-Origin-Opener-Policy: same-origin\r\nCache-Control: no-store\r\nConnection: close\r\n";

/// Writes an answer to a connection.
///
/// # Errors
/// The operating system's error, also where the client does not take it in time.
pub(super) fn write(stream: &mut TcpStream, response: &Response) -> io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    let Response { status, kind, body } = response;
    let length = body.len();
    let head =
        format!("HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n{HEADERS}\r\n");
    stream.write_all(head.as_bytes())?;
    stream.write_all(body)?;
    stream.flush()?;
    stream.shutdown(std::net::Shutdown::Write)
}
