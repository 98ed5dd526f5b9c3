//! XML text: elements with attributes, a line each.

#![allow(non_snake_case)]

use crate::geometry::{Pose, Vec3};

/// An XML document that is written from its start to its end.
pub(crate) struct Xml {
    text: String,
    /// The number of elements that are open.
    depth: usize,
}

/// An attribute: its name and its value, not yet escaped.
pub(crate) type Attribute<'a> = (&'a str, String);

/// Numbers of a magnitude from here to [`WIDE`] are written without an exponent.
const NARROW: f64 = 1e-4;
const WIDE: f64 = 1e15;

impl Xml {
    /// Returns a document without elements.
    pub(crate) fn new() -> Xml {
        Xml { text: String::new(), depth: 0 }
    }

    /// Returns the text of the document.
    pub(crate) fn into_text(self) -> String {
        self.text
    }

    /// Adds the start tag of an element that will contain others; [`close`](Self::close) ends it.
    pub(crate) fn open(&mut self, name: &str, attributes: &[Attribute]) {
        self.tag(name, attributes, ">");
        self.depth += 1;
    }

    /// Adds the end tag of the element that was opened last, which must have this name.
    pub(crate) fn close(&mut self, name: &str) {
        self.depth -= 1;
        self.indent();
        self.text.push_str(&format!("</{name}>\n"));
    }

    /// Adds an element that contains no others.
    pub(crate) fn leaf(&mut self, name: &str, attributes: &[Attribute]) {
        self.tag(name, attributes, "/>");
    }

    /// Adds a comment on a line of its own. Two hyphens in a row, which end a comment, are set apart.
    pub(crate) fn comment(&mut self, words: &str) {
        let mut plain = words.replace("--", "- -").replace("--", "- -");
        if plain.ends_with('-') {
            plain.push(' ');
        }
        self.indent();
        self.text.push_str(&format!("<!-- {} -->\n", escaped(&plain)));
    }

    fn tag(&mut self, name: &str, attributes: &[Attribute], end: &str) {
        self.indent();
        self.text.push_str(&format!("<{name}"));
        for (key, value) in attributes {
            self.text.push_str(&format!(" {key}=\"{}\"", escaped(value)));
        }
        self.text.push_str(end);
        self.text.push('\n');
    }

    fn indent(&mut self) {
        self.text.extend(std::iter::repeat_n("  ", self.depth));
    }
}

/// Returns a text as it stands inside an attribute. Control characters, which XML does not have, become U+FFFD.
fn escaped(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => plain.push_str("&amp;"),
            '<' => plain.push_str("&lt;"),
            '>' => plain.push_str("&gt;"),
            '"' => plain.push_str("&quot;"),
            control if control.is_control() => plain.push('\u{fffd}'),
            other => plain.push(other),
        }
    }
    plain
}

/// Returns a number as the shortest decimal text that reads back to it; `0` for both zeros.
pub(crate) fn number(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        size if (NARROW..WIDE).contains(&size) => format!("{x}"),
        _ => format!("{x:e}"),
    }
}

/// Returns numbers as text, each as by [`number`], with one space between any two.
pub(crate) fn numbers(all: impl IntoIterator<Item = f64>) -> String {
    all.into_iter().map(number).collect::<Vec<_>>().join(" ")
}

/// Returns a vector as text: x, y and z with one space between.
pub(crate) fn vector(v: &Vec3) -> String {
    numbers(v.iter().copied())
}

/// Returns the rotation of a pose as text: the unit quaternion in MuJoCo's order w x y z.
pub(crate) fn quaternion(X: &Pose) -> String {
    let q = &X.rotation;
    numbers([q.w, q.i, q.j, q.k])
}

/// Returns the attributes `pos` (m) and `quat` of a pose, each only where it is not the default.
pub(crate) fn placed(X: &Pose) -> Vec<Attribute<'static>> {
    let mut attributes = Vec::new();
    if X.translation.vector != Vec3::zeros() {
        attributes.push(("pos", vector(&X.translation.vector)));
    }
    if X.rotation.w != 1.0 {
        attributes.push(("quat", quaternion(X)));
    }
    attributes
}
