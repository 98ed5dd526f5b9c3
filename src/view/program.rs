//! A behaviour as its series-parallel graph in SVG: serial steps side by side, parallel branches one below
//! the other.

use super::colour::{PALETTE, groups};
use super::drawing::{Drawing, INK, LETTER, PAPER, SOFT};
use super::input::RenderInput;
use crate::plan::{Action, Command, Node, Target, Tracks};
use crate::robot::{Assembly, JointId, JointOwner};
use crate::units::{Dimension, quantity};

/// The most actions drawn; an ellipsis stands for those beyond.
const ACTIONS_MAX: usize = 1500;

/// The deepest nesting drawn.
const DEPTH_MAX: usize = 60;

/// The font size of an action's label, px.
const SIZE: f64 = 11.0;
/// The height of a label, px.
const TALL: f64 = 24.0;
/// The gap between serial steps, px.
const BESIDE: f64 = 22.0;
/// The gap between parallel branches, px.
const BELOW: f64 = 8.0;
/// The margin within a frame, px.
const RIM: f64 = 9.0;
/// The height of a frame's title, px.
const HEAD: f64 = 16.0;

/// The kind of a piece of the graph, with the pieces in it.
enum Piece {
    Label { words: String, colour: String },
    Row(Vec<LaidOut>),
    Column(Vec<LaidOut>),
    Frame(String, Box<LaidOut>),
}

/// A laid-out piece of the graph; lengths in px, y down.
struct LaidOut {
    piece: Piece,
    /// The upper left corner, from that of the piece around it.
    at: [f64; 2],
    size: [f64; 2],
}

/// Returns the SVG of a behaviour: the actions of the plan's program from left to right, its joints and modules by
/// name; "nothing" for a plan without a program.
pub(super) fn program(input: &RenderInput, tracks: &Tracks) -> String {
    let mut drawer =
        Drawer { robot: &tracks.robot, group: groups(&tracks.robot), names: names(&tracks.robot), drawn: 0 };
    let root = input.plan.program.as_ref().map(|program| &*program.root);
    let whole = root.map_or_else(|| label("nothing".into(), SOFT.into()), |root| drawer.piece(root, 0));
    let mut drawing = Drawing::default();
    let rim = 24.0;
    let middle = rim + whole.size[1] / 2.0;
    let (left, right) = (rim, rim + 20.0 + whole.size[0] + 20.0);
    let pen = format!("stroke=\"{SOFT}\" stroke-width=\"1.5\"");
    drawing.line([left, middle], [left + 20.0, middle], &pen);
    drawing.line([right - 20.0, middle], [right, middle], &pen);
    draw(&mut drawing, &whole, [left + 20.0, rim]);
    drawing.circle([left, middle], 5.0, &format!("fill=\"{INK}\""));
    drawing.circle([right, middle], 5.0, &format!("fill=\"{PAPER}\" stroke=\"{INK}\" stroke-width=\"2\""));
    drawing.finish(input.title, [0.0, 0.0], [right + rim, whole.size[1] + 2.0 * rim], "px")
}

struct Drawer<'a> {
    robot: &'a Assembly,
    group: Vec<usize>,
    /// The name, the module and true if it is prismatic, of each joint.
    names: Vec<(String, Option<usize>, bool)>,
    drawn: usize,
}

/// Returns the name, the module and true if it is prismatic, of each joint.
fn names(robot: &Assembly) -> Vec<(String, Option<usize>, bool)> {
    let module = |owner| match owner {
        JointOwner::Module { module, .. } => Some(module),
        JointOwner::Bond(_) => None,
    };
    robot.joints().map(|owner| (robot.joint_name(owner), module(owner), robot.slides(owner))).collect()
}

/// Returns an action's label, as wide as its text.
fn label(words: String, colour: String) -> LaidOut {
    let wide = words.chars().count() as f64 * SIZE * LETTER + 18.0;
    LaidOut { piece: Piece::Label { words, colour }, at: [0.0; 2], size: [wide, TALL] }
}

impl Drawer<'_> {
    /// Lays out a node of the program with all below it.
    fn piece(&mut self, node: &Node, depth: usize) -> LaidOut {
        if depth > DEPTH_MAX || self.drawn >= ACTIONS_MAX {
            return label("...".into(), SOFT.into());
        }
        match node {
            Node::Action(action) => {
                self.drawn += 1;
                self.action(action)
            }
            Node::Series(list) => row(list.iter().map(|n| self.piece(n, depth + 1)).collect()),
            Node::Parallel(list) => column(list.iter().map(|n| self.piece(n, depth + 1)).collect()),
            Node::Repeat { body, times, until } => {
                let most = if until.is_some() { "at most " } else { "" };
                framed(format!("{most}{times} times"), self.piece(body, depth + 1))
            }
            Node::Phase { body, shift, .. } => {
                framed(format!("from {shift} of its cycle"), self.piece(body, depth + 1))
            }
            Node::Approach { shift, .. } => label(format!("to {shift} of the cycle"), SOFT.into()),
            Node::Stretch { body, duration, .. } => {
                framed(format!("in {}", quantity(*duration, Dimension::TIME)), self.piece(body, depth + 1))
            }
            Node::Exempt { body, kind, .. } => {
                framed(format!("allows {}", kind.name()), self.piece(body, depth + 1))
            }
            Node::Contract { body, .. } => self.piece(body, depth + 1),
            Node::Goal(goal) => label(goal.name().into(), SOFT.into()),
        }
    }

    /// Returns the label of an action, in the colour of its module.
    fn action(&self, action: &Action) -> LaidOut {
        let time = |t: f64| quantity(t, Dimension::TIME);
        let (joint, words) = match &action.command {
            Command::Move { joint, target: Target::To(to), .. } => {
                (Some(*joint), format!("to {}", self.amount(*joint, *to)))
            }
            Command::Move { joint, target: Target::By(by), .. } => {
                (Some(*joint), format!("by {}", self.amount(*joint, *by)))
            }
            Command::Spin { joint, speed, duration } => {
                let long = duration.map_or(String::new(), |t| format!(" for {}", time(t)));
                (Some(*joint), format!("at {}{long}", quantity(*speed, Dimension::ANGULAR_SPEED)))
            }
            Command::Follow { joint, .. } => (Some(*joint), "follows a curve".into()),
            Command::Wait { duration } => (None, format!("wait {}", time(*duration))),
            Command::Dock { a, b } => {
                (None, format!("dock {} -- {}", self.robot.port_name(*a), self.robot.port_name(*b)))
            }
            Command::Undock { port } => (None, format!("undock {}", self.robot.port_name(*port))),
        };
        let known = joint.and_then(|j| self.names.get(j.0 as usize));
        let colour = known.and_then(|(_, module, _)| *module);
        let colour =
            colour.map_or_else(|| SOFT.to_owned(), |m| PALETTE[self.group[m] % PALETTE.len()].code());
        label(known.map_or(words.clone(), |(name, _, _)| format!("{name} {words}")), colour)
    }

    /// Returns a joint's position or displacement as text: a length, or an angle in degrees.
    fn amount(&self, joint: JointId, x: f64) -> String {
        let slides = self.names.get(joint.0 as usize).is_some_and(|(_, _, slides)| *slides);
        if slides {
            quantity(x, Dimension::LENGTH)
        } else {
            format!("{}°", libm::round(x.to_degrees() * 10.0) / 10.0)
        }
    }
}

/// Lays out serial pieces side by side.
fn row(mut pieces: Vec<LaidOut>) -> LaidOut {
    let tall = pieces.iter().map(|p| p.size[1]).fold(TALL, f64::max);
    let mut x = 0.0;
    for piece in &mut pieces {
        piece.at = [x, (tall - piece.size[1]) / 2.0];
        x += piece.size[0] + BESIDE;
    }
    LaidOut { piece: Piece::Row(pieces), at: [0.0; 2], size: [(x - BESIDE).max(0.0), tall] }
}

/// Lays out parallel pieces one below the other.
fn column(mut pieces: Vec<LaidOut>) -> LaidOut {
    let wide = pieces.iter().map(|p| p.size[0]).fold(0.0, f64::max);
    let mut y = 0.0;
    for piece in &mut pieces {
        piece.at = [BESIDE / 2.0 + (wide - piece.size[0]) / 2.0, y];
        y += piece.size[1] + BELOW;
    }
    LaidOut { piece: Piece::Column(pieces), at: [0.0; 2], size: [wide + BESIDE, (y - BELOW).max(0.0)] }
}

/// Lays out a piece in a frame with a title.
fn framed(words: String, mut inner: LaidOut) -> LaidOut {
    inner.at = [RIM, HEAD];
    let wide = words.chars().count() as f64 * 9.0 * LETTER + 2.0 * RIM;
    let size = [(inner.size[0] + 2.0 * RIM).max(wide), inner.size[1] + HEAD + RIM];
    LaidOut { piece: Piece::Frame(words, Box::new(inner)), at: [0.0; 2], size }
}

/// Draws a piece with its upper left corner at `at`, and the lines between the pieces in it.
fn draw(drawing: &mut Drawing, placed: &LaidOut, at: [f64; 2]) {
    let [w, h] = placed.size;
    let middle = at[1] + h / 2.0;
    let pen = format!("stroke=\"{SOFT}\" stroke-width=\"1.5\"");
    let inside = |p: &LaidOut| [at[0] + p.at[0], at[1] + p.at[1]];
    match &placed.piece {
        Piece::Label { words, colour } => {
            drawing.rect(
                at,
                [w, h],
                5.0,
                &format!("fill=\"{colour}\" fill-opacity=\"0.22\" stroke=\"{colour}\" stroke-width=\"1.3\""),
            );
            drawing.words([at[0] + w / 2.0, middle], SIZE, INK, words);
        }
        Piece::Row(pieces) => {
            // A line leads from each piece to the next.
            for (i, piece) in pieces.iter().enumerate() {
                let from = inside(piece);
                if i > 0 {
                    drawing.line([from[0] - BESIDE, middle], [from[0], middle], &pen);
                }
                draw(drawing, piece, from);
            }
        }
        Piece::Column(pieces) => {
            let (left, right) = (at[0], at[0] + w);
            let middles: Vec<f64> = pieces.iter().map(|p| inside(p)[1] + p.size[1] / 2.0).collect();
            let (top, bottom) = (middles.first().unwrap_or(&middle), middles.last().unwrap_or(&middle));
            // A bar on either side, with a line to each branch.
            for x in [left, right] {
                drawing.line([x, *top], [x, *bottom], &format!("stroke=\"{INK}\" stroke-width=\"2.5\""));
            }
            for (piece, y) in pieces.iter().zip(&middles) {
                let from = inside(piece);
                drawing.line([left, *y], [from[0], *y], &pen);
                drawing.line([from[0] + piece.size[0], *y], [right, *y], &pen);
                draw(drawing, piece, from);
            }
        }
        Piece::Frame(words, inner) => {
            drawing.rect(
                at,
                [w, h],
                8.0,
                &format!("fill=\"none\" stroke=\"{SOFT}\" stroke-dasharray=\"4 4\""),
            );
            let from = inside(inner);
            let y = from[1] + inner.size[1] / 2.0;
            drawing.line([at[0], y], [from[0], y], &pen);
            drawing.line([from[0] + inner.size[0], y], [at[0] + w, y], &pen);
            drawing.words([at[0] + w / 2.0, at[1] + 8.0], 9.0, SOFT, words);
            draw(drawing, inner, from);
        }
    }
}
