//! Flat panels joined by hinges as the pattern they are cut and folded from, true to scale: cut lines,
//! fold lines with their angles and their order, panels with their numbers.
#![allow(non_snake_case)]

use super::Showing;
use super::svg::{Drawing, INK, PAPER, SOFT, around};
use crate::geometry::{Pose, Shape, Vec3};
use crate::plan::Tracks;
use crate::robot::{JointOwner, Kinematics, ModuleType, PortRef};

/// A panel's corner may be this far above or below the sheet, m: rounding of poses.
const TOL_FLAT: f64 = 1e-6;

/// Angles smaller than this are no fold, rad.
const ANGLE_MIN: f64 = 1e-6;

const MILLIMETRES: f64 = 1e3;

/// A panel in the plane, mm.
struct Panel {
    corners: Vec<[f64; 2]>,
}

/// A fold line between two panels.
struct Fold {
    ends: [[f64; 2]; 2],
    /// At the end of the plan, rad.
    angle: f64,
    /// From 1, in order of time; 0 where it never moves.
    order: usize,
}

/// The pattern; `None` where the modules are no flat panels on hinges.
pub fn pattern(showing: &Showing, tracks: &Tracks) -> Option<String> {
    let robot = &tracks.robot;
    let hinged = !robot.bonds.is_empty() && (0..robot.bonds.len()).all(|bond| robot.hinge(bond).is_some());
    let rigid = robot.modules.iter().enumerate().all(|(m, _)| robot.module_type(m).joints.is_empty());
    if !hinged || !rigid || robot.closed {
        return None;
    }
    let kinematics = Kinematics::new(robot, &tracks.start.bonds, robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    let flat = vec![0.0; tracks.start.joints.len()];
    kinematics.link_poses(&flat, &Pose::identity(), &mut poses);
    let panels: Vec<Panel> = (0..robot.modules.len())
        .map(|module| panel(robot.module_type(module), &poses[kinematics.link(module, 0)]))
        .collect::<Option<_>>()?;
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
    let fold = |&(joint, bond): &(usize, usize)| {
        let bond = robot.bonds[bond];
        let at = |port: PortRef| kinematics.port_pose(robot, port, &poses).translation.vector;
        let middle = at(bond.a);
        let ends = side(&panels[bond.a.module], [middle.x * MILLIMETRES, -middle.y * MILLIMETRES]);
        let place = order.iter().position(|j| *j == joint).map_or(0, |i| i + 1);
        Fold { ends, angle: end.joints[joint], order: place }
    };
    Some(drawn(showing, &panels, &joints.iter().map(fold).collect::<Vec<Fold>>()))
}

/// The outline of a module's top face, if the module lies in the sheet.
fn panel(kind: &ModuleType, X: &Pose) -> Option<Panel> {
    let [link] = &kind.links[..] else { return None };
    let [placed] = &link.shape[..] else { return None };
    let points: &[Vec3] = match &placed.shape {
        Shape::Hull { points } => points,
        Shape::Mesh { vertices, .. } => vertices,
        _ => return None,
    };
    let upright =
        (X.rotation * Vec3::z()).z.abs() > 1.0 - TOL_FLAT && X.translation.vector.z.abs() < TOL_FLAT;
    let X = X * placed.pose;
    let world: Vec<Vec3> = points.iter().map(|p| X.transform_point(&(*p).into()).coords).collect();
    let top = world.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    // y goes down on paper.
    let mut corners: Vec<[f64; 2]> = world
        .iter()
        .filter(|p| top - p.z < TOL_FLAT)
        .map(|p| [p.x * MILLIMETRES, -p.y * MILLIMETRES])
        .collect();
    let middle = centre(&corners);
    corners.sort_by(|a, b| {
        let around = |p: &[f64; 2]| libm::atan2(p[1] - middle[1], p[0] - middle[0]);
        around(a).total_cmp(&around(b))
    });
    (upright && corners.len() >= 3).then_some(Panel { corners })
}

fn centre(points: &[[f64; 2]]) -> [f64; 2] {
    let count = points.len().max(1) as f64;
    [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / count)
}

/// The side of a panel whose middle is nearest to a place.
fn side(panel: &Panel, at: [f64; 2]) -> [[f64; 2]; 2] {
    let count = panel.corners.len();
    let sides = (0..count).map(|i| [panel.corners[i], panel.corners[(i + 1) % count]]);
    let away =
        |s: &[[f64; 2]; 2]| libm::hypot((s[0][0] + s[1][0]) / 2.0 - at[0], (s[0][1] + s[1][1]) / 2.0 - at[1]);
    sides.min_by(|a, b| away(a).total_cmp(&away(b))).expect("a panel has three sides")
}

/// Joints in the order in which they first move.
fn order(tracks: &Tracks) -> Vec<usize> {
    let moves = |track: &crate::plan::Track| {
        let first = track.segments.iter().find(|s| s.control.iter().any(|c| *c != s.control[0]))?;
        Some((first.start, track.joint.0 as usize))
    };
    let mut found: Vec<(f64, usize)> = tracks.tracks.iter().filter_map(moves).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.into_iter().map(|(_, joint)| joint).collect()
}

fn drawn(showing: &Showing, panels: &[Panel], folds: &[Fold]) -> String {
    let mut drawing = Drawing::default();
    let size = panels
        .first()
        .map_or(10.0, |p| libm::hypot(p.corners[1][0] - p.corners[0][0], p.corners[1][1] - p.corners[0][1]));
    let (text, pen) = (size * 0.085, size * 0.008);
    for (number, panel) in panels.iter().enumerate() {
        let look = format!("fill=\"#f3efe4\" stroke=\"{INK}\" stroke-width=\"{}\"", super::svg::short(pen));
        drawing.polygon(&panel.corners, &look);
        drawing.words(centre(&panel.corners), text * 1.4, SOFT, &number.to_string());
    }
    for fold in folds {
        let [a, b] = fold.ends;
        // The solid outline below is no cut here.
        drawing.line(a, b, &format!("stroke=\"{PAPER}\" stroke-width=\"{}\"", super::svg::short(pen * 3.0)));
        let [dash, gap] =
            if fold.angle >= 0.0 { [6.0, 3.0] } else { [1.0, 3.0] }.map(|x| super::svg::short(x * pen));
        let colour = if fold.angle >= 0.0 { "#0b63a5" } else { "#c44b00" };
        drawing.line(
            a,
            b,
            &format!(
                "stroke=\"{colour}\" stroke-width=\"{}\" stroke-dasharray=\"{dash} {gap}\"",
                super::svg::short(pen * 1.5)
            ),
        );
        let degrees = libm::round(fold.angle.to_degrees() * 10.0) / 10.0;
        let words = match (fold.angle.abs() > ANGLE_MIN, fold.order) {
            (true, 0) => format!("{degrees}°"),
            (true, order) => format!("{order}: {degrees}°"),
            (false, _) => continue,
        };
        drawing.words([(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0], text, colour, &words);
    }
    let (from, room) = around(panels.iter().flat_map(|p| p.corners.iter().copied()), size * 0.12);
    drawing.finish(showing.title, from, room, "mm")
}
