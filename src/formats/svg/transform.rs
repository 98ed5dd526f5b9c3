//! Transformations of groups and elements.

use super::numbers::{Numbers, shown};
use super::{Point, Unread};
use roxmltree::Node;

/// The remedy of a transformation that can't be read.
const MEND: &str = "`translate`, `scale`, `rotate`, `matrix`, `skewX` and `skewY` are read; a drawing program can apply them";

/// An affine map of the plane: the numbers a to f of SVG's `matrix(a b c d e f)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine([f64; 6]);

impl Affine {
    /// The map that leaves all points in their places.
    pub(super) const IDENTITY: Affine = Affine([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);

    /// Returns the place of a point.
    pub(super) fn of_point(&self, [x, y]: Point) -> Point {
        let Affine([a, b, c, d, e, f]) = self;
        [a * x + c * y + e, b * x + d * y + f]
    }

    /// Returns the map that applies `inner`, and then this one.
    pub(super) fn then(&self, inner: &Affine) -> Affine {
        let Affine([a, b, c, d, ..]) = self;
        let Affine([p, q, r, s, t, u]) = inner;
        let [e, f] = self.of_point([*t, *u]);
        Affine([a * p + c * q, b * p + d * q, a * r + c * s, b * r + d * s, e, f])
    }
}

/// Returns the transformation that an element states for itself and its content.
///
/// # Errors
/// The reason why it can't be read.
pub(super) fn of(node: Node) -> Result<Affine, Unread> {
    let mut whole = Affine::IDENTITY;
    let mut rest = node.attribute("transform").unwrap_or("").trim();
    while !rest.is_empty() && rest != "none" {
        let unread = || Unread::new(format!("the transformation `{}` is not read", shown(rest)), MEND);
        let (name, after) = rest.split_once('(').ok_or_else(unread)?;
        let (inside, after) = after.split_once(')').ok_or_else(unread)?;
        let mut numbers = Numbers::of(inside);
        let mut values = Vec::new();
        while !numbers.ended() && values.len() < 7 {
            values.push(numbers.number()?);
        }
        whole = whole.then(&map(name.trim(), &values).ok_or_else(unread)?);
        rest = after.trim_start_matches(|c: char| c.is_ascii_whitespace() || c == ',');
    }
    Ok(whole)
}

/// Returns the map that a function of SVG makes of its arguments; `None` if there is no such function, or it takes others.
fn map(name: &str, values: &[f64]) -> Option<Affine> {
    let moved = |x: f64, y: f64| Affine([1.0, 0.0, 0.0, 1.0, x, y]);
    let turned = |degrees: f64| {
        let (sine, cosine) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
        Affine([cosine, sine, -sine, cosine, 0.0, 0.0])
    };
    let tangent = |degrees: f64| libm::tan(degrees.to_radians());
    let map = match (name, values) {
        ("translate", &[x]) => moved(x, 0.0),
        ("translate", &[x, y]) => moved(x, y),
        ("scale", &[by]) => Affine([by, 0.0, 0.0, by, 0.0, 0.0]),
        ("scale", &[x, y]) => Affine([x, 0.0, 0.0, y, 0.0, 0.0]),
        ("rotate", &[degrees]) => turned(degrees),
        ("rotate", &[degrees, x, y]) => moved(x, y).then(&turned(degrees)).then(&moved(-x, -y)),
        ("skewX", &[degrees]) => Affine([1.0, 0.0, tangent(degrees), 1.0, 0.0, 0.0]),
        ("skewY", &[degrees]) => Affine([1.0, tangent(degrees), 0.0, 1.0, 0.0, 0.0]),
        ("matrix", &[a, b, c, d, e, f]) => Affine([a, b, c, d, e, f]),
        _ => return None,
    };
    Some(map)
}
