//! Trusses as pictures of dots, seen from the front and from above, and what their plans achieve.

use crate::geometry::Vec3;
use crate::interpret::design::Design;
use crate::interpret::design::TrussDesign;
use crate::interpret::plan_value::PlanValue;
use crate::plan::NodePaths;
use crate::planners::{locomote, morph};
use crate::units::{Dimension, counted, number, quantity};

/// The width of a picture in characters; each holds two dots by four.
const WIDTH: usize = 32;
/// The height of a picture in characters.
const HEIGHT: usize = 10;
/// The number of characters between two pictures.
const APART: usize = 4;
/// The greatest number of struts that are drawn; a larger truss has no picture.
const STRUTS_DRAWN: usize = 2_000;

/// The side from which nodes are seen: a function to their coordinates to the right and up.
type Side = fn(&Vec3) -> [f64; 2];

const FRONT: Side = |p| [p.x, p.z];
const ABOVE: Side = |p| [p.x, p.y];

/// Returns a truss as text: its facts and two pictures made of dots, from the front and from above.
pub(super) fn truss(design: &Design, truss: &TrussDesign) -> String {
    let metres = |x: f64| quantity(x, Dimension::LENGTH);
    let nodes: Vec<Vec3> = truss.nodes.iter().map(|node| node.position).collect();
    let lengths = truss.struts.iter().map(|&(a, b)| (nodes[a] - nodes[b]).norm());
    let (least, most) = lengths.fold((f64::INFINITY, 0.0f64), |(least, most), l| (least.min(l), most.max(l)));
    let mut lines = vec![format!(
        "{}: {}, {} of {}",
        design.name,
        counted(nodes.len(), "node"),
        counted(truss.struts.len(), "strut"),
        truss.of.name
    )];
    if let Some(strut) = truss.strut_kind() {
        let (low, high) = strut.length;
        let now =
            if least == most { metres(least) } else { format!("{} to {}", metres(least), metres(most)) };
        lines.push(format!("  struts of {now}, they reach from {} to {}", metres(low), metres(high)));
    }
    let rigidity = &truss.rigidity;
    lines.push(format!(
        "  rigid: rank {}, {}, weakest {}",
        rigidity.rank,
        counted(rigidity.redundant.len(), "redundant strut"),
        number(rigidity.weakest)
    ));
    let views = [("from the front", &nodes[..], FRONT), ("from above", &nodes[..], ABOVE)];
    lines.extend(pictures(&views, [&truss.struts[..]; 2]));
    lines.join("\n")
}

/// Returns lines of text about a truss plan: the planner's figures, and pictures of the truss before and after; empty
/// for a plan without node paths.
pub(super) fn made(planned: &PlanValue) -> Vec<String> {
    let metres = |x: f64| quantity(x, Dimension::LENGTH);
    let mut lines = Vec::new();
    if let Some(morph::Report { distance, start, ended, .. }) = planned.report() {
        lines.push(format!(
            "  {} from the target at the start, {} at the end",
            metres(start.target_to_surface),
            metres(distance.target_to_surface)
        ));
        lines.push(format!(
            "  {} at worst, {} from the target to the truss; ended: {ended}",
            metres(distance.worst),
            metres(distance.surface_to_target)
        ));
    }
    if let Some(report) = planned.report::<locomote::Report>() {
        lines.push(format!(
            "  {} travelled, {}, {}, {} reached",
            metres(report.distance),
            counted(report.rolls, "roll"),
            counted(report.footholds, "foothold"),
            counted(report.reached, "point")
        ));
        lines.push(format!("  {} of slip; ended: {}", metres(report.slip), report.ended));
    }
    if let Some(paths) = planned.plan.body.node_paths() {
        lines.extend(before_and_after(paths));
    }
    lines
}

fn before_and_after(paths: &NodePaths) -> Vec<String> {
    let places = |nodes: &[[f64; 3]]| nodes.iter().map(|p| Vec3::from(*p)).collect::<Vec<_>>();
    let (Some(first), Some(last)) = (paths.keyframes.first(), paths.keyframes.last()) else {
        return Vec::new();
    };
    let (first, last) = (places(&first.nodes), places(&last.nodes));
    let views = [("at the start, from the front", &first[..], FRONT), ("at the end", &last[..], FRONT)];
    pictures(&views, [&paths.struts, &paths.topology_at_end().struts])
}

/// Returns the lines of two pictures side by side, each under its words and with its struts, in one scale.
fn pictures(views: &[(&str, &[Vec3], Side); 2], struts: [&[(usize, usize)]; 2]) -> Vec<String> {
    if struts[0].len() > STRUTS_DRAWN {
        return Vec::new();
    }
    let flat: Vec<Vec<[f64; 2]>> =
        views.iter().map(|(_, nodes, side)| nodes.iter().map(side).collect()).collect();
    let ends: Vec<[[f64; 2]; 2]> = flat.iter().map(|points| bounds(points)).collect();
    let (wide, high) = (WIDTH * 2 - 1, HEIGHT * 4 - 1);
    let fits = |[low, high_end]: &[[f64; 2]; 2]| {
        let [x, y] = [0, 1].map(|axis| (high_end[axis] - low[axis]).max(f64::MIN_POSITIVE));
        (wide as f64 / x).min(high as f64 / y)
    };
    let scale = ends.iter().map(fits).fold(f64::INFINITY, f64::min);
    let drawn: Vec<Vec<String>> = flat
        .iter()
        .zip(&ends)
        .zip(struts)
        .map(|((points, [low, _]), own)| dots(points, *low, scale, own))
        .collect();
    let rows = drawn.iter().map(Vec::len).max().unwrap_or(0);
    let titles: Vec<String> = views.iter().map(|(words, ..)| (*words).to_owned()).collect();
    let mut lines = vec![beside(&titles)];
    // The pictures are aligned at their lowest rows.
    for row in 0..rows {
        let pieces: Vec<String> = drawn
            .iter()
            .map(|own| (row + own.len()).checked_sub(rows).map_or_else(String::new, |at| own[at].clone()))
            .collect();
        lines.push(beside(&pieces));
    }
    lines
}

fn beside(pieces: &[String]) -> String {
    let wide = WIDTH + APART;
    let padded = pieces.iter().map(|piece| format!("{piece:<wide$}"));
    format!("  {}", padded.collect::<String>()).trim_end().to_owned()
}

/// Returns the least and the greatest coordinates.
fn bounds(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let of = |pick: fn(f64, f64) -> f64, begin: f64| {
        [0, 1].map(|axis| points.iter().map(|p| p[axis]).fold(begin, pick))
    };
    [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
}

/// Returns the segments between points as rows of braille characters (U+2800 to U+28FF), `scale` dots for each
/// metre.
fn dots(points: &[[f64; 2]], low: [f64; 2], scale: f64, struts: &[(usize, usize)]) -> Vec<String> {
    let place = |p: [f64; 2]| [0, 1].map(|axis| (p[axis] - low[axis]) * scale);
    let top = points.iter().map(|p| place(*p)[1]).fold(0.0, f64::max);
    let rows = (top as usize / 4 + 1).min(HEIGHT);
    let mut cells = vec![[0u8; WIDTH]; rows];
    for &(a, b) in struts {
        let (p, q) = (place(points[a]), place(points[b]));
        let steps = (p[0] - q[0]).abs().max((p[1] - q[1]).abs()).max(1.0) as usize;
        for step in 0..=steps {
            let t = step as f64 / steps as f64;
            let [x, y] = [0, 1].map(|axis| (p[axis] + (q[axis] - p[axis]) * t + 0.5) as usize);
            let (x, y) = (x.min(WIDTH * 2 - 1), y.min(rows * 4 - 1));
            cells[rows - 1 - y / 4][x / 2] |= dot(x % 2, 3 - y % 4);
        }
    }
    let character = |bits: &u8| char::from_u32(0x2800 + u32::from(*bits)).unwrap_or(' ');
    // The empty character of dots is wider than a space in some fonts.
    let shown = |bits: &u8| if *bits == 0 { ' ' } else { character(bits) };
    cells.iter().map(|row| row.iter().map(shown).collect::<String>().trim_end().to_owned()).collect()
}

/// Returns the bit of a dot, by column and by row from the top.
fn dot(column: usize, row: usize) -> u8 {
    match (column, row) {
        (0, 3) => 0x40,
        (1, 3) => 0x80,
        (0, row) => 1 << row,
        (_, row) => 8 << row,
    }
}
