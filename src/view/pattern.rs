//! Crease patterns as SVG: flat panels joined by hinges, cut and folded from one sheet, true to scale, in
//! layers for panels, cuts, mountains, valleys, flat hinges and numbers.
//!
//! The sheet is seen from the front of the panels, the outside of the folded shape. Panels are numbered
//! from 0 as in the design; hinges from 1 in the order in which they fold, with their angles; two cut edges
//! that coincide in the end have the same letter.
#![allow(non_snake_case)]

use super::drawing::{Drawing, INK, SOFT, around, short};
use super::input::RenderInput;
use super::tolerances::TOLERANCES;
use crate::geometry::{Pose, Shape, Vec3};
use crate::plan::Tracks;
use crate::robot::{JointOwner, Kinematics, ModuleType, PortRef};

/// Millimetres per metre.
const MILLIMETRES: f64 = 1e3;

const MOUNTAIN: &str = "#c0392b";
const VALLEY: &str = "#0b63a5";

/// A point in the drawing, in mm, y down.
type Point = [f64; 2];
/// An edge from its first to its second end.
type Edge = [Point; 2];

/// A panel as a polygon in the drawing.
struct Panel {
    corners: Vec<Point>,
}

/// A fold line between two panels.
struct Fold {
    ends: Edge,
    /// The angle at the end of the plan, in radians.
    angle: f64,
    /// The position in folding order, from 1; 0 for a hinge that never moves.
    order: usize,
}

/// An edge along which the sheet is cut.
struct Cut {
    ends: Edge,
    /// The centre of its panel.
    inside: Point,
    /// The number of the letter that it shares with the edge it coincides with in the end; `None` without such an edge.
    meets: Option<usize>,
}

/// Returns the crease pattern of a plan as SVG; `None` if its modules are not flat panels on hinges.
pub(super) fn pattern(input: &RenderInput, tracks: &Tracks) -> Option<String> {
    let robot = &tracks.robot;
    let hinged = !robot.bonds.is_empty() && (0..robot.bonds.len()).all(|bond| robot.hinge(bond).is_some());
    let rigid = robot.modules.iter().enumerate().all(|(m, _)| robot.module_type(m).joints.is_empty());
    if !hinged || !rigid || robot.closed {
        return None;
    }
    // The panels where the sheet is flat.
    let kinematics = Kinematics::new(robot, &tracks.start.bonds, robot.base);
    let poses_at = |joints: &[f64]| {
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(joints, &Pose::identity(), &mut poses);
        poses
    };
    let poses = poses_at(&vec![0.0; tracks.start.joints.len()]);
    let panels: Vec<Panel> = (0..robot.modules.len())
        .map(|module| panel(robot.module_type(module), &poses[kinematics.link(module, 0)]))
        .collect::<Option<_>>()?;
    // The folds, with their angles at the end.
    let order = order(tracks);
    let end = tracks.end();
    let joints: Vec<(usize, usize)> = robot
        .joints()
        .enumerate()
        .filter_map(|(joint, owner)| match owner {
            JointOwner::Bond(bond) => Some((joint, bond)),
            JointOwner::Module { .. } => None,
        })
        .collect();
    let middle = |port: PortRef| on_paper(&kinematics.port_pose(robot, port, &poses).translation.vector);
    let fold = |&(joint, bond): &(usize, usize)| {
        let bond = robot.bonds[bond];
        let ends = side(&panels[bond.a.module], middle(bond.a));
        let place = order.iter().position(|j| *j == joint).map_or(0, |i| i + 1);
        Fold { ends, angle: end.joints[joint], order: place }
    };
    let folds: Vec<Fold> = joints.iter().map(fold).collect();
    // The free ports that coincide in the folded shape, and the cut edges.
    let folded = poses_at(&end.joints);
    let bonded: Vec<PortRef> = robot.bonds.iter().flat_map(|bond| [bond.a, bond.b]).collect();
    let ports = (0..robot.modules.len()).flat_map(|module| {
        (0..robot.module_type(module).ports.len()).map(move |port| PortRef { module, port })
    });
    let free: Vec<(PortRef, Vec3)> = ports
        .filter(|port| !bonded.contains(port))
        .map(|port| (port, kinematics.port_pose(robot, port, &folded).translation.vector))
        .collect();
    let pairs = meeting(&free);
    let mut cuts = Vec::new();
    for (module, panel) in panels.iter().enumerate() {
        let own = |port: &PortRef| port.module == module;
        let hinged: Vec<Edge> = bonded.iter().filter(|p| own(p)).map(|p| side(panel, middle(*p))).collect();
        for ends in sides(panel).filter(|ends| !hinged.contains(ends)) {
            let port = free.iter().position(|(port, _)| own(port) && side(panel, middle(*port)) == ends);
            let meets = port.and_then(|port| pairs[port]);
            cuts.push(Cut { ends, inside: centre(&panel.corners), meets });
        }
    }
    Some(drawn(input, &panels, &folds, &cuts))
}

/// Returns for each free port the number of the pair of edges that coincide, if it belongs to one.
fn meeting(free: &[(PortRef, Vec3)]) -> Vec<Option<usize>> {
    let mut pairs = vec![None; free.len()];
    let mut count = 0;
    for i in 0..free.len() {
        let near = |j: &usize| pairs[*j].is_none() && (free[*j].1 - free[i].1).norm() < TOLERANCES.meet;
        if pairs[i].is_none()
            && let Some(j) = (i + 1..free.len()).find(near)
        {
            (pairs[i], pairs[j]) = (Some(count), Some(count));
            count += 1;
        }
    }
    pairs
}

/// Returns the position on the sheet in mm, y down, of a point in metres.
fn on_paper(place: &Vec3) -> Point {
    [place.x * MILLIMETRES, -place.y * MILLIMETRES]
}

/// Returns the outline of a module at pose `X`; `None` unless it is one hull or mesh that lies in the sheet. A
/// triangle with a port in the middle of each edge extends from edge to edge, though its body may be inset a little.
fn panel(kind: &ModuleType, X: &Pose) -> Option<Panel> {
    let [link] = &kind.links[..] else { return None };
    let [placed] = &link.shape[..] else { return None };
    let points: &[Vec3] = match &placed.shape {
        Shape::Hull { points } => points,
        Shape::Mesh { vertices, .. } => vertices,
        _ => return None,
    };
    let upright = (X.rotation * Vec3::z()).z.abs() > 1.0 - TOLERANCES.flat
        && X.translation.vector.z.abs() < TOLERANCES.flat;
    let X_body = X * placed.pose;
    let world: Vec<Vec3> = points.iter().map(|p| X_body.transform_point(&(*p).into()).coords).collect();
    let top = world.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    let mut corners: Vec<Point> =
        world.iter().filter(|p| top - p.z < TOLERANCES.flat).map(on_paper).collect();
    if let ([a, b, c], 3) = (&kind.ports[..], corners.len()) {
        let [a, b, c] = [a, b, c].map(|port| (X * port.pose).translation.vector);
        corners = [a + b - c, b + c - a, c + a - b].iter().map(on_paper).collect();
    }
    let middle = centre(&corners);
    corners.sort_by(|a, b| {
        let around = |p: &Point| libm::atan2(p[1] - middle[1], p[0] - middle[0]);
        around(a).total_cmp(&around(b))
    });
    (upright && corners.len() >= 3).then_some(Panel { corners })
}

/// Returns the mean of points.
fn centre(points: &[Point]) -> Point {
    let count = points.len().max(1) as f64;
    [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / count)
}

/// Returns the edges of a panel.
fn sides(panel: &Panel) -> impl Iterator<Item = Edge> + '_ {
    let count = panel.corners.len();
    (0..count).map(move |i| [panel.corners[i], panel.corners[(i + 1) % count]])
}

/// Returns the edge of a panel whose midpoint is nearest to a point.
fn side(panel: &Panel, at: Point) -> Edge {
    let away = |s: &Edge| {
        let [x, y] = centre(s);
        libm::hypot(x - at[0], y - at[1])
    };
    sides(panel).min_by(|a, b| away(a).total_cmp(&away(b))).expect("a panel has three sides")
}

/// Returns the joints that move, in the order in which they first do.
fn order(tracks: &Tracks) -> Vec<usize> {
    let moves = |track: &crate::plan::Track| {
        let first = track.segments.iter().find(|s| s.control.iter().any(|c| *c != s.control[0]))?;
        Some((first.start, track.joint.0 as usize))
    };
    let mut found: Vec<(f64, usize)> = tracks.tracks.iter().filter_map(moves).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.into_iter().map(|(_, joint)| joint).collect()
}

/// Returns the SVG of panels, folds and cuts.
fn drawn(input: &RenderInput, panels: &[Panel], folds: &[Fold], cuts: &[Cut]) -> String {
    let mut drawing = Drawing::default();
    let size = panels
        .first()
        .map_or(10.0, |p| libm::hypot(p.corners[1][0] - p.corners[0][0], p.corners[1][1] - p.corners[0][1]));
    let (text, pen) = (size * 0.075, size * 0.008);
    // Panels, cuts and folds, each in a layer.
    drawing.layer("panels", |layer| {
        for panel in panels {
            layer.polygon(&panel.corners, "fill=\"#f3efe4\"");
        }
    });
    let stroke = |colour: &str, width: f64| format!("stroke=\"{colour}\" stroke-width=\"{}\"", short(width));
    drawing.layer("cut", |layer| {
        cuts.iter().for_each(|cut| layer.line(cut.ends[0], cut.ends[1], &stroke(INK, pen)));
    });
    for FoldStyle { name, colour, dashes, belongs } in STYLES {
        let [dash, gap] = dashes.map(|x| short(x * pen));
        let look = format!("{} stroke-dasharray=\"{dash} {gap}\"", stroke(colour, pen * 1.5));
        drawing.layer(name, |layer| {
            let own = folds.iter().filter(|fold| belongs(fold.angle));
            own.for_each(|fold| layer.line(fold.ends[0], fold.ends[1], &look));
        });
    }
    // Numbers of panels, orders and angles of folds, and letters of cuts that meet.
    drawing.layer("numbers", |layer| {
        for (number, panel) in panels.iter().enumerate() {
            layer.words(centre(&panel.corners), text * 1.5, SOFT, &number.to_string());
        }
        for fold in folds.iter().filter(|fold| fold.angle.abs() >= TOLERANCES.crease) {
            let degrees = libm::round(fold.angle.to_degrees() * 10.0) / 10.0;
            let words =
                if fold.order == 0 { format!("{degrees}°") } else { format!("{}: {degrees}°", fold.order) };
            let colour = if fold.angle > 0.0 { MOUNTAIN } else { VALLEY };
            layer.words(centre(&fold.ends), text, colour, &words);
        }
        for cut in cuts {
            let Some(pair) = cut.meets else { continue };
            let middle = centre(&cut.ends);
            let inwards = [0, 1].map(|k| middle[k] + INWARDS * (cut.inside[k] - middle[k]));
            layer.words(inwards, text, INK, &letters(pair));
        }
    });
    let (from, room) = around(panels.iter().flat_map(|p| p.corners.iter().copied()), size * 0.12);
    drawing.finish(input.title, from, room, "mm")
}

/// The style of the fold lines of a layer.
struct FoldStyle {
    name: &'static str,
    colour: &'static str,
    /// Lengths of dash and gap, in widths of the pen.
    dashes: [f64; 2],
    /// The function that returns true if a hinge with this fold angle (rad) belongs to the layer.
    belongs: fn(f64) -> bool,
}

const STYLES: [FoldStyle; 3] = [
    FoldStyle {
        name: "mountain",
        colour: MOUNTAIN,
        dashes: [6.0, 3.0],
        belongs: |angle| angle >= TOLERANCES.crease,
    },
    FoldStyle {
        name: "valley",
        colour: VALLEY,
        dashes: [1.0, 3.0],
        belongs: |angle| angle <= -TOLERANCES.crease,
    },
    FoldStyle {
        name: "level",
        colour: SOFT,
        dashes: [2.0, 6.0],
        belongs: |angle| angle.abs() < TOLERANCES.crease,
    },
];

/// The distance of a letter from its edge, as a fraction of the distance to the panel's centre.
const INWARDS: f64 = 0.25;

/// Returns a label: A, B, ..., Z, AA, AB, ...
fn letters(number: usize) -> String {
    let last = char::from(b'A' + (number % 26) as u8);
    if number < 26 { last.to_string() } else { letters(number / 26 - 1) + &last.to_string() }
}
