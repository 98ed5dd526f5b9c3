//! A configuration as a graph in SVG: modules at their positions, in a view from a corner, and the bonds
//! between them.

use super::bodies::link_poses;
use super::colour::{PALETTE, groups};
use super::drawing::{Drawing, INK, SOFT, around};
use super::input::RenderInput;
use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;
use crate::plan::Tracks;
use crate::robot::{Assembly, PortRef};

/// The length of a mean bond in pixels.
const BOND: f64 = 120.0;

/// The position of a port's name along its bond, in parts of the bond's length.
const NEAR: f64 = 0.36;

/// Returns the SVG of a configuration at the start of the plan: a circle for each module, lines between bonded ones
/// with the names of their ports, broken where the bond is open, and a ring around the base.
pub(super) fn graph(input: &RenderInput, tracks: &Tracks) -> String {
    let robot = &tracks.robot;
    let places = places(input, tracks);
    let group = groups(robot);
    let mut drawing = Drawing::default();
    for (bond, holds) in robot.bonds.iter().zip(&tracks.start.bonds) {
        let (a, b) = (places[bond.a.module], places[bond.b.module]);
        let look =
            if *holds { "stroke-width=\"3\"" } else { "stroke-width=\"1.5\" stroke-dasharray=\"3 5\"" };
        drawing.line(a, b, &format!("stroke=\"{SOFT}\" {look}"));
        let on = |u: f64| [a[0] + (b[0] - a[0]) * u, a[1] + (b[1] - a[1]) * u];
        drawing.words(on(NEAR), 8.0, INK, port(robot, bond.a));
        drawing.words(on(1.0 - NEAR), 8.0, INK, port(robot, bond.b));
        if bond.turn > 0 {
            let turns = robot.connector(bond.a).turns.max(1);
            let degrees = 360.0 * f64::from(bond.turn) / f64::from(turns);
            drawing.words(on(0.5), 8.0, SOFT, &format!("{degrees}°"));
        }
    }
    for (module, instance) in robot.modules.iter().enumerate() {
        let at = places[module];
        let fill = PALETTE[group[module] % PALETTE.len()].code();
        if module == robot.base {
            drawing.circle(at, 17.0, &format!("fill=\"none\" stroke=\"{INK}\" stroke-width=\"1.5\""));
        }
        drawing.circle(at, 13.0, &format!("fill=\"{fill}\" stroke=\"{INK}\" stroke-width=\"1.2\""));
        drawing.words([at[0], at[1] + 24.0], 10.0, INK, &instance.name);
    }
    let (from, size) = around(places.iter().copied(), 60.0);
    drawing.finish(input.title, from, size, "px")
}

/// Returns the name of a port.
fn port(robot: &Assembly, at: PortRef) -> &str {
    &robot.module_type(at.module).ports[at.port].name
}

/// Returns the centres of the modules in the drawing, in pixels, scaled so that labels of bonds have room.
fn places(input: &RenderInput, tracks: &Tracks) -> Vec<[f64; 2]> {
    let poses = link_poses(input, tracks, 0.0);
    let mut first = 0;
    let middles: Vec<Vec3> = (0..tracks.robot.modules.len())
        .map(|module| {
            let at = poses[first].translation.vector;
            first += tracks.robot.module_type(module).links.len();
            at
        })
        .collect();
    let back = Vec3::new(0.57, -0.71, 0.52).normalize();
    let right = Vec3::z().cross(&back).normalize();
    let up = back.cross(&right);
    let flat: Vec<[f64; 2]> = middles.iter().map(|p| [p.dot(&right), -p.dot(&up)]).collect();
    let length = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
    let bonds = &tracks.robot.bonds;
    let mean = bonds.iter().map(|b| length(flat[b.a.module], flat[b.b.module])).sum::<f64>()
        / bonds.len().max(1) as f64;
    let scale = if mean > TOLERANCES.size { BOND / mean } else { 1.0 };
    flat.iter().map(|p| p.map(|x| x * scale)).collect()
}
