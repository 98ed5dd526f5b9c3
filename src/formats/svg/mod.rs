//! Straight lines with their strokes from drawings in SVG (Scalable Vector Graphics 1.1, W3C 2011): `line`, `polyline`,
//! `polygon`, `rect` and `path` without curves, in groups with transformations, with the style that attributes, a `style`
//! attribute and a simple style sheet give them.

mod colour;
mod numbers;
mod outline;
mod style;
mod transform;

use super::fault::FormatFault;
use roxmltree::{Document, Node, ParsingOptions};
use style::{Style, StyleSheet};
use transform::Affine;

pub(super) use colour::Colour;

/// A point in the plane of a drawing, x to the right and y down, in the drawing's unit of length.
pub(super) type Point = [f64; 2];

/// The greatest number of straight lines of a drawing: every two are compared.
pub(super) const LINES_MAX: usize = 1_000;

/// The greatest number of elements, texts and comments of a drawing.
const NODES_MAX: u32 = 200_000;

/// The greatest magnitude of a coordinate: sums and products of a few such numbers are finite and exact enough.
const NUMBER_MAX: f64 = 1e9;

/// The namespace of the elements of SVG.
const NAMESPACE: &str = "http://www.w3.org/2000/svg";

/// Elements whose content is not drawn where it stands, or is no line.
const NOT_DRAWN: &[&str] = &[
    "defs",
    "symbol",
    "clipPath",
    "mask",
    "marker",
    "pattern",
    "metadata",
    "title",
    "desc",
    "style",
    "script",
    "text",
    "image",
    "linearGradient",
    "radialGradient",
    "filter",
];

/// A straight line of a drawing.
#[derive(Clone, Debug)]
pub(super) struct DrawnLine {
    /// The ends in the coordinates of the whole drawing.
    pub(super) ends: [Point; 2],
    /// The colour of the stroke.
    pub(super) colour: Colour,
    /// The opacity of the stroke, that of its groups included, 0 to 1.
    pub(super) opacity: f64,
    /// The byte of the file at which the element begins.
    pub(super) byte: usize,
}

/// The reason why a part of a drawing is not read.
#[derive(Debug)]
pub(super) struct Unread {
    /// The part that was found, in words.
    found: String,
    /// The remedy, in words.
    mend: &'static str,
}

impl Unread {
    /// Returns the reason with its remedy.
    fn new(found: impl Into<String>, mend: &'static str) -> Unread {
        Unread { found: found.into(), mend }
    }
}

/// An element that is to be read, with all that it takes over from the groups around it.
struct Waiting<'a, 'input> {
    node: Node<'a, 'input>,
    transform: Affine,
    style: Style<'a>,
}

/// Reads the straight lines of a drawing in the order in which they are drawn; those without a stroke are left out.
///
/// # Errors
/// A [`FormatFault`] where it is no SVG, holds a curve or another part that can't be read, or too many lines.
pub(super) fn read(text: &str) -> Result<Vec<DrawnLine>, FormatFault> {
    if text.contains("<!ENTITY") {
        let found = "it declares entities, which are not read";
        let mend = "save it as plain SVG, without what is kept for the drawing program";
        return Err(FormatFault::Drawing { found: found.to_owned(), mend: mend.to_owned() });
    }
    let options = ParsingOptions { allow_dtd: true, nodes_limit: NODES_MAX, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options)
        .map_err(|error| FormatFault::Reader(format!("it is no XML: {error}")))?;
    let root = document.root_element();
    if !is(root, "svg") {
        let found = root.tag_name().name();
        return Err(FormatFault::Reader(format!("its first element is `{found}`; `svg` is wanted")));
    }
    let rules: Vec<&str> =
        root.descendants().filter(|node| is(*node, "style")).filter_map(|node| node.text()).collect();
    let rules = style::without_comments(&rules.join("\n"));
    let sheet = StyleSheet::read(&rules).map_err(|unread| fault(root, unread))?;
    let mut lines = Vec::new();
    let mut waiting = vec![Waiting { node: root, transform: Affine::IDENTITY, style: Style::default() }];
    while let Some(Waiting { node, transform, style }) = waiting.pop() {
        let refuse = |unread: Unread| fault(node, unread);
        let name = node.tag_name().name();
        if !is(node, name) || NOT_DRAWN.contains(&name) {
            continue;
        }
        let Some(style) = style.within(node, &sheet).map_err(refuse)? else { continue };
        let transform = transform.then(&transform::of(node).map_err(refuse)?);
        match name {
            "g" | "a" => within(node, transform, &style, &mut waiting),
            "svg" if node == root => within(node, transform, &style, &mut waiting),
            _ => drawn(node, &transform, &style, &mut lines).map_err(refuse)?,
        }
    }
    Ok(lines)
}

/// Adds the elements of a group to those that are to be read, so that the first is the next.
fn within<'a, 'input>(
    node: Node<'a, 'input>,
    transform: Affine,
    style: &Style<'a>,
    waiting: &mut Vec<Waiting<'a, 'input>>,
) {
    let inner = node.children().filter(Node::is_element);
    let first = waiting.len();
    waiting.extend(inner.map(|node| Waiting { node, transform, style: style.clone() }));
    waiting[first..].reverse();
}

/// Adds the straight lines that an element draws.
///
/// # Errors
/// The reason why they can't be read.
fn drawn(node: Node, transform: &Affine, style: &Style, lines: &mut Vec<DrawnLine>) -> Result<(), Unread> {
    let name = node.tag_name().name();
    if ["use", "svg", "switch", "foreignObject"].contains(&name) {
        let mend = "write its lines where it stands: in Inkscape, unlink clones and ungroup";
        return Err(Unread::new(format!("the element `{name}` is not read"), mend));
    }
    let Some(paint) = style.paint() else { return Ok(()) };
    let segments = outline::segments(node, LINES_MAX - lines.len())?;
    if segments.is_empty() {
        return Ok(());
    }
    let (colour, alpha) = Colour::read(paint)?;
    let byte = node.range().start;
    for segment in segments {
        let ends = segment.map(|point| transform.of_point(point));
        if ends.iter().flatten().any(|x| x.is_nan() || x.abs() > NUMBER_MAX) {
            let found = format!("a coordinate of the `{name}` is beyond {NUMBER_MAX:e}");
            return Err(Unread::new(found, "state finite numbers of a usual size"));
        }
        lines.push(DrawnLine { ends, colour: colour.clone(), opacity: style.opacity() * alpha, byte });
    }
    Ok(())
}

/// Returns true if a node is an element of SVG with this name.
fn is(node: Node, name: &str) -> bool {
    let tag = node.tag_name();
    node.is_element() && tag.name() == name && tag.namespace().is_none_or(|space| space == NAMESPACE)
}

/// Returns the fault of a part of a drawing that is not read, with the line where it stands.
fn fault(node: Node, unread: Unread) -> FormatFault {
    let row = node.document().text_pos_at(node.range().start).row;
    FormatFault::Drawing { found: format!("line {row}: {}", unread.found), mend: unread.mend.to_owned() }
}
