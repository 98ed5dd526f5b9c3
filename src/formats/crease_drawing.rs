//! Crease patterns from drawings in SVG, by the colours that Origami Simulator gives them (Ghassaei, Demaine and Gershenfeld
//! 2018): black is the border, red a mountain, blue a valley, yellow stays flat; the opacity of the stroke is the fold
//! angle by 180 degrees.

use super::arrangement::{self, Arrangement};
use super::crease_reader::{self, CreaseSheet, rounded};
use super::fault::FormatFault;
use super::svg::{self, Colour, DrawnLine};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::fmt;

/// Points nearer to each other than this part of the greater side of the drawing are one, and a line goes through points
/// that are as near to it: lines are drawn by hand and rounded, so that ends miss others by some ten-thousandths.
const TOL_MEET: f64 = 1e-3;

/// Fold angles of one crease that was drawn twice differ by no more than this, rad: rounding.
const TOL_ANGLE: f64 = 1e-6;

/// The greatest number of points or edges of a pattern: lines that cross each other everywhere are none.
const EDGES_MAX: usize = 10_000;

/// The remedy of colours without a meaning.
const COLOURS: &str = "black is the border, red a mountain, blue a valley, yellow a crease that stays flat; leave out what is \
                       none of these, or give it no stroke";

/// The meaning of a line of a crease pattern.
#[derive(Clone, Copy, Debug)]
enum Meaning {
    /// The border of the sheet.
    Border,
    /// A crease with its fold angle, rad, positive at a mountain.
    Crease(f64),
}

impl Meaning {
    /// Returns true if two lines mean the same.
    fn agrees(self, other: Meaning) -> bool {
        match (self, other) {
            (Meaning::Border, Meaning::Border) => true,
            (Meaning::Crease(a), Meaning::Crease(b)) => (a - b).abs() <= TOL_ANGLE,
            (Meaning::Border, Meaning::Crease(_)) | (Meaning::Crease(_), Meaning::Border) => false,
        }
    }
}

impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Meaning::Border => f.write_str("the border"),
            Meaning::Crease(0.0) => f.write_str("a flat crease"),
            Meaning::Crease(angle) => {
                let kind = if *angle > 0.0 { "mountain" } else { "valley" };
                write!(f, "a {kind} of {} degrees", rounded(angle.abs().to_degrees()))
            }
        }
    }
}

/// The pattern that a drawing states, its lines split where they meet.
struct Pattern<'a> {
    text: &'a str,
    lines: Vec<DrawnLine>,
    meanings: Vec<Meaning>,
    /// The points with y upwards.
    points: Vec<[f64; 2]>,
    /// The line that covers each edge, the first of those that do.
    edges: BTreeMap<[usize; 2], usize>,
    tol: f64,
}

/// Reads the crease pattern that a drawing in SVG shows from the front: its lines are split where they cross or touch, and
/// its faces are what they enclose.
///
/// # Errors
/// A [`FormatFault`] where it is no SVG, has lines that are no creases or contradict each other, or is no sheet with a
/// border all round whose creases end at others or at the border.
pub(super) fn read(bytes: &[u8]) -> Result<CreaseSheet, FormatFault> {
    let text = std::str::from_utf8(bytes).map_err(|_| FormatFault::NotText)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let pattern = Pattern::read(text)?;
    pattern.check_ends()?;
    let edges: Vec<[usize; 2]> = pattern.edges.keys().copied().collect();
    pattern.check_joined(&edges)?;
    let walks = arrangement::walks(&pattern.points, &edges);
    pattern.check_sides(&walks)?;
    Ok(pattern.sheet(&walks))
}

impl<'a> Pattern<'a> {
    /// Reads the lines of a drawing, and splits them where they meet.
    ///
    /// # Errors
    /// A fault where there are none, or one is no crease, or two that overlap contradict each other.
    fn read(text: &'a str) -> Result<Pattern<'a>, FormatFault> {
        let lines = svg::read(text)?;
        if lines.is_empty() {
            return Err(drawing("it holds no lines with a stroke", COLOURS));
        }
        let meanings = lines.iter().map(|line| meaning(text, line)).collect::<Result<Vec<_>, _>>()?;
        let upwards = lines.iter().map(|line| line.ends.map(|[x, y]| [x + 0.0, 0.0 - y]));
        let upwards: Vec<[[f64; 2]; 2]> = upwards.collect();
        let extent = |axis: usize| {
            let all = upwards.iter().flatten().map(|point| point[axis]);
            all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
        };
        let tol = TOL_MEET * extent(0).max(extent(1));
        let Some(Arrangement { points, edges }) = arrangement::arrangement(&upwards, tol, EDGES_MAX) else {
            let found =
                format!("its lines cross in so many places that there are more than {EDGES_MAX} edges");
            return Err(drawing(found, "sheets of up to 300 creases can be planned"));
        };
        let mut pattern = Pattern { text, lines, meanings, points, edges: BTreeMap::new(), tol };
        for (ends, covering) in edges {
            let first = covering[0];
            let other =
                covering.iter().find(|line| !pattern.meanings[**line].agrees(pattern.meanings[first]));
            if let Some(&other) = other {
                let [a, b] = ends.map(|end| pattern.place(end));
                let (one, two) = (pattern.named(first), pattern.named(other));
                let found = format!("from {a} to {b} lie both {one} and {two}");
                return Err(drawing(found, "leave one of them: an edge is drawn once, or twice alike"));
            }
            pattern.edges.insert(ends, first);
        }
        Ok(pattern)
    }

    /// Returns a point in the drawing's own coordinates, for messages.
    fn place(&self, point: usize) -> String {
        let [x, y] = self.points[point];
        crease_reader::place([x, -y])
    }

    /// Returns what a line means, and the line of the file where it stands, for messages.
    fn named(&self, line: usize) -> String {
        format!("{} (line {})", self.meanings[line], row(self.text, self.lines[line].byte))
    }

    /// Checks that every line ends at another.
    ///
    /// # Errors
    /// A fault that names the first that does not.
    fn check_ends(&self) -> Result<(), FormatFault> {
        let mut degree = vec![0; self.points.len()];
        self.edges.keys().flatten().for_each(|point| degree[*point] += 1);
        let loose = self.edges.iter().find_map(|(ends, line)| {
            let end = ends.iter().position(|point| degree[*point] == 1)?;
            Some((ends[end], ends[1 - end], *line))
        });
        let Some((end, other, line)) = loose else { return Ok(()) };
        let (line, end, other) = (self.named(line), self.place(end), self.place(other));
        let tol = rounded(self.tol);
        let found = format!("{line} from {other} ends at {end}, where no other line is");
        Err(drawing(
            found,
            format!("draw it up to a crease or the border; ends within {tol} of a line are on it"),
        ))
    }

    /// Checks that all edges hang together.
    ///
    /// # Errors
    /// A fault that names a point of either of two pieces.
    fn check_joined(&self, edges: &[[usize; 2]]) -> Result<(), FormatFault> {
        let mut neighbours = vec![Vec::new(); self.points.len()];
        for &[a, b] in edges {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        let Some(&[start, _]) = edges.first() else {
            return Err(drawing("its lines are points", COLOURS));
        };
        let mut seen = BTreeSet::from([start]);
        let mut waiting = vec![start];
        while let Some(point) = waiting.pop() {
            waiting.extend(neighbours[point].iter().filter(|other| seen.insert(**other)));
        }
        let Some(&[apart, _]) = edges.iter().find(|[a, _]| !seen.contains(a)) else { return Ok(()) };
        let found = format!("no lines join {} and {}", self.place(start), self.place(apart));
        Err(drawing(found, "draw one sheet in a file, without holes and without lines beside it"))
    }

    /// Checks that the border goes round the outside and nowhere else, and that every crease has two faces.
    ///
    /// # Errors
    /// A fault that names the first edge of which this is not so.
    fn check_sides(&self, walks: &[Vec<usize>]) -> Result<(), FormatFault> {
        let outside = |walk: &[usize]| arrangement::area(&self.points, walk) <= 0.0;
        let mut faces: BTreeMap<[usize; 2], Vec<(usize, bool)>> = BTreeMap::new();
        for (index, walk) in walks.iter().enumerate() {
            let side = (index, outside(walk));
            edges_of(walk).for_each(|ends| faces.entry(ends).or_default().push(side));
        }
        for (ends, line) in &self.edges {
            let [a, b] = ends.map(|end| self.place(end));
            let edge = format!("from {a} to {b} {}", self.named(*line));
            match (faces[ends].as_slice(), self.meanings[*line]) {
                ([one, other], _) if one.0 == other.0 => {
                    return Err(drawing(
                        format!("{edge} has the same on either side: no face ends there"),
                        "creases end at others or at the border, and parts of a sheet hang together along creases",
                    ));
                }
                (sides, Meaning::Border) if sides.iter().all(|side| !side.1) => {
                    return Err(drawing(
                        format!("{edge} has a face on either side"),
                        "black is the border of the sheet; a crease that stays flat is yellow, and cuts are not folded",
                    ));
                }
                (sides, Meaning::Crease(_)) if sides.iter().any(|side| side.1) => {
                    return Err(drawing(
                        format!("{edge} has a face on one side alone"),
                        "draw the border of the sheet in black, all round",
                    ));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns the sheet with these walks: those round faces, without points in which an edge merely goes on.
    fn sheet(&self, walks: &[Vec<usize>]) -> CreaseSheet {
        let mut neighbours: Vec<Vec<(usize, usize)>> = vec![Vec::new(); self.points.len()];
        for (&[a, b], line) in &self.edges {
            neighbours[a].push((b, *line));
            neighbours[b].push((a, *line));
        }
        let goes_on = |point: usize| match neighbours[point].as_slice() {
            &[(before, one), (after, two)] => {
                let line = [before, after].map(|end| self.points[end]);
                let alike = self.meanings[one].agrees(self.meanings[two]);
                alike && arrangement::part_on(line, self.points[point], self.tol).is_some()
            }
            _ => false,
        };
        let mut index = BTreeMap::new();
        let mut vertices = Vec::new();
        let mut number = |point: usize| {
            *index.entry(point).or_insert_with(|| {
                vertices.push(self.points[point]);
                vertices.len() - 1
            })
        };
        let (mut faces, mut angles) = (Vec::new(), BTreeMap::new());
        for walk in walks.iter().filter(|walk| arrangement::area(&self.points, walk) > 0.0) {
            let kept: Vec<usize> = (0..walk.len()).filter(|at| !goes_on(walk[*at])).collect();
            let corners: Vec<usize> = kept.iter().map(|at| number(walk[*at])).collect();
            for (corner, &at) in kept.iter().enumerate() {
                // A side means the same all the way to the next corner.
                let first = ordered([walk[at], walk[(at + 1) % walk.len()]]);
                if let Meaning::Crease(angle) = self.meanings[self.edges[&first]] {
                    angles.insert(ordered([corners[corner], corners[(corner + 1) % corners.len()]]), angle);
                }
            }
            faces.push(corners);
        }
        CreaseSheet { vertices, faces, angles, unstated: None, downwards: true }
    }
}

/// Returns what a line means by its colour and opacity.
///
/// # Errors
/// A fault where it is no line of a crease pattern, or of one that can be folded.
fn meaning(text: &str, line: &DrawnLine) -> Result<Meaning, FormatFault> {
    let fault =
        |found: String, mend: &str| Err(drawing(format!("line {}: {found}", row(text, line.byte)), mend));
    let angle = line.opacity * PI;
    match &line.colour {
        Colour::Black => Ok(Meaning::Border),
        Colour::Red => Ok(Meaning::Crease(angle)),
        Colour::Blue => Ok(Meaning::Crease(0.0 - angle)),
        Colour::Yellow => Ok(Meaning::Crease(0.0)),
        Colour::Green => {
            fault("a green line is a cut".to_owned(), "sheets with cuts are not folded; the border is black")
        }
        Colour::Magenta => fault(
            "a magenta line is a crease that no one drives, so its angle is not stated".to_owned(),
            "red or blue with an opacity states how far a crease folds",
        ),
        Colour::Other(colour) => fault(format!("the colour `{colour}` of a line says nothing"), COLOURS),
    }
}

/// Returns the edges along a closed walk.
fn edges_of(walk: &[usize]) -> impl Iterator<Item = [usize; 2]> {
    (0..walk.len()).map(|k| ordered([walk[k], walk[(k + 1) % walk.len()]]))
}

/// Returns two points, the lesser first.
fn ordered([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// Returns the number of the line of a text in which a byte stands, from 1.
fn row(text: &str, byte: usize) -> usize {
    1 + text.as_bytes()[..byte].iter().filter(|byte| **byte == b'\n').count()
}

/// Returns the fault of a drawing with its remedy.
fn drawing(found: impl Into<String>, mend: impl Into<String>) -> FormatFault {
    FormatFault::Drawing { found: found.into(), mend: mend.into() }
}
