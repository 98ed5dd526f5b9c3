//! Percent-encoding (RFC 3986): `%` and two digits stand for a byte of UTF-8, in URIs and their queries.

/// Returns the text that a percent-encoded one stands for; `None` if two digits do not follow each `%`, or the bytes are
/// no UTF-8.
pub fn decoded(encoded: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(encoded.len());
    let mut left = encoded.bytes();
    while let Some(byte) = left.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digits = [left.next()?, left.next()?];
        bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?);
    }
    String::from_utf8(bytes).ok()
}
