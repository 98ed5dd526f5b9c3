//! The torques that a sheet needs while it folds, against closed forms and the balance of power, and the weight of sheets.

use crate::language::interpret::ran;
use crate::support::suite::MapFiles;
use modl::formats::CREASE_FORMATS;
use modl::geometry::Vec3;
use modl::interpret::{Mode, Options};
use modl::planners::fold::Target;
use modl::planners::fold_sheet::folded;
use std::f64::consts::PI;

/// Returns what a program prints, as numbers, and what is said of it.
fn numbers(program: &str) -> (Vec<f64>, Vec<String>) {
    let mut project = MapFiles::of(program);
    project.0.insert("vertex.fold".to_owned(), include_bytes!("../../examples/vertex.fold").to_vec());
    let done = ran(&project, "main.mod", Mode::Run, &Options::default());
    let said = done.outcome.diagnostics.iter();
    let said = said.map(|d| format!("{} {}\n{}", d.code, d.message, d.hints.join("\n"))).collect();
    (done.host.printed.iter().map(|line| line.parse().expect("a number")).collect(), said)
}

/// The part of the way (0 to 1) after a part of the time, and its first and second derivative: from rest to rest.
fn quintic(x: f64) -> [f64; 3] {
    [
        x * x * x * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * x * x * (1.0 - x) * (1.0 - x),
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
    ]
}

/// The mean of a function over 0..1 by the midpoint rule.
fn mean(of: impl Fn(f64) -> f64) -> f64 {
    const SAMPLES: usize = 4000;
    (0..SAMPLES).map(|k| of((k as f64 + 0.5) / SAMPLES as f64)).sum::<f64>() / SAMPLES as f64
}

/// Two rectangles of 100 by 80 mm on a hinge: without weight the energy is 3.75 |φ| K / T² with K = m b² / 3, as `fold` has
/// it; the greatest torque is that of the quintic law, 10 |φ| K / (√3 T²). With the first one held level, the other's weight
/// adds m g b cos(φ) / 2, which never changes its sign.
#[test]
fn two_panels_need_what_their_hinge_turns_and_lifts() {
    let program = |ground: &str| {
        format!(
            "use std.mori.Polygon
let angle = 60deg
let tent = polyhedron(
  [[0mm, 0mm, 0mm], [0mm, 100mm, 0mm], [-80mm, 100mm, 0mm], [-80mm, 0mm, 0mm],
   [80mm * cos(angle), 0mm, 80mm * sin(angle)], [80mm * cos(angle), 100mm, 80mm * sin(angle)]],
  [[3, 0, 1, 2], [0, 4, 5, 1]],
)
let sheet = fold_sheet(tent, module: Polygon(thickness: 3mm, motor: 0g, plate: 2kg/m^2), time: 2s, ground: {ground})
print((sheet.energy else 0J) / 1J)
print((sheet.peak_torque else 0N*m) / (1N*m))
print(mass(sheet.robot) / 1kg)"
        )
    };
    let (m, b, angle, time) = (2.0 * 0.1 * 0.08, 0.08, PI / 3.0, 2.0);
    let inertia = m * b * b / 3.0;
    let (free, said) = numbers(&program("off"));
    assert!(said.is_empty(), "{said:?}");
    let energy = 3.75 * angle * inertia / (time * time);
    let peak = 10.0 / libm::sqrt(3.0) * angle * inertia / (time * time);
    assert!((free[2] - 2.0 * m).abs() < 1e-9);
    assert!((free[0] / energy - 1.0).abs() < 1e-3, "{} is not {energy}", free[0]);
    assert!((free[1] / peak - 1.0).abs() < 1e-2, "{} is not {peak}", free[1]);
    let (held, said) = numbers(&program("held"));
    assert!(said.is_empty(), "{said:?}");
    let torque = |x: f64| {
        let [at, _, acceleration] = quintic(x);
        m * 9.80665 * b / 2.0 * libm::cos(angle * at) + inertia * angle * acceleration / (time * time)
    };
    let energy = mean(|x| torque(x).abs());
    assert!((held[0] / energy - 1.0).abs() < 1e-4, "{} is not {energy}", held[0]);
}

/// The kinetic energy (J) by the square of a speed (m/s) of an even plate of `density` (kg/m²): its corners move so.
fn kinetic(density: f64, face: &[usize], places: &[Vec3], velocities: &[Vec3]) -> f64 {
    let triangles = (1..face.len() - 1).map(|k| [face[0], face[k], face[k + 1]]);
    let energy = |[a, b, c]: [usize; 3]| {
        let area = (places[b] - places[a]).cross(&(places[c] - places[a])).norm() / 2.0;
        let [u, v, w] = [a, b, c].map(|corner| velocities[corner]);
        let squares = u.dot(&u) + v.dot(&v) + w.dot(&w) + u.dot(&v) + v.dot(&w) + w.dot(&u);
        density * area * squares / 12.0
    };
    triangles.map(energy).sum()
}

/// A vertex of four creases has one degree of freedom, so the power of its hinges is the growth of the kinetic energy of
/// its panels, which follows from the places of their corners. The angles along the way are known (Huffman 1976), and so
/// is how the least squares of torques share the power: in proportion to the speeds.
#[test]
fn the_power_of_a_loop_is_the_growth_of_its_kinetic_energy() {
    let format = CREASE_FORMATS.iter().find(|format| format.ending == "fold").expect("it is read");
    let sheet = (format.read)(include_bytes!("../../examples/vertex.fold")).expect("it is read");
    let corners = sheet.vertices.iter().map(|[x, y]| Vec3::new(x * 0.1, y * 0.1, 0.0)).collect();
    let flat = Target::new(corners, &sheet.faces).expect("it is flat");
    let full: Vec<f64> = flat
        .hinges
        .iter()
        .map(|hinge| {
            let corners = &flat.faces[hinge.faces[0]];
            let (a, b) = (corners[hinge.sides[0]], corners[(hinge.sides[0] + 1) % corners.len()]);
            sheet.angles[&[a.min(b), a.max(b)]]
        })
        .collect();
    let widest = full.iter().fold(0.0_f64, |widest, angle| widest.max(angle.abs()));
    // The tangents of half the angles stay in proportion; one angle says the others.
    let at = |wide: f64| -> Vec<f64> {
        let scale = libm::tan(wide / 2.0) / libm::tan(widest / 2.0);
        full.iter().map(|angle| 2.0 * libm::atan(libm::tan(angle / 2.0) * scale)).collect()
    };
    let norm = |wide: f64| libm::sqrt(at(wide).iter().map(|angle| angle * angle).sum::<f64>());
    let wide_at = |part: f64| {
        let (mut low, mut high) = (0.0, widest);
        for _ in 0..80 {
            let middle = (low + high) / 2.0;
            if norm(middle) < part * norm(widest) { low = middle } else { high = middle }
        }
        low
    };
    let (time, density) = (3.0, 2.0);
    const STEP: f64 = 1e-3;
    let places = |x: f64| folded(&flat, &at(wide_at(quintic(x)[0]))).expect("it closes");
    let energy_at = |x: f64| {
        let (before, here, after) = (places(x - STEP), places(x), places(x + STEP));
        let velocities: Vec<Vec3> =
            before.iter().zip(&after).map(|(a, b)| (b - a) / (2.0 * STEP * time)).collect();
        flat.faces.iter().map(|face| kinetic(density, face, &here, &velocities)).sum::<f64>()
    };
    let speeds = |x: f64| -> Vec<f64> {
        let ends = [x - STEP, x + STEP].map(|x| at(wide_at(quintic(x)[0])));
        ends[0].iter().zip(&ends[1]).map(|(a, b)| (b - a) / (2.0 * STEP * time)).collect()
    };
    // Torques in proportion to the speeds come to power / |speeds|² times these.
    const SAMPLES: usize = 300;
    let sum = |x: f64| {
        let power = (energy_at(x + STEP) - energy_at(x - STEP)) / (2.0 * STEP * time);
        let speeds = speeds(x);
        let square: f64 = speeds.iter().map(|speed| speed * speed).sum();
        power.abs() * speeds.iter().map(|speed| speed.abs()).sum::<f64>() / square
    };
    let all: f64 = (2..SAMPLES - 2).map(|k| sum((k as f64 + 0.5) / SAMPLES as f64)).sum();
    let wanted = all / SAMPLES as f64;
    let (found, said) = numbers(
        "use std.mori.Polygon
let sheet = fold_sheet(
  load_creases(\"vertex.fold\", scale: 100mm), module: Polygon(thickness: 3mm, motor: 0g, plate: 2kg/m^2), time: 3s)
print((sheet.energy else 0J) / 1J)",
    );
    assert!(said.is_empty(), "{said:?}");
    assert!((found[0] / wanted - 1.0).abs() < 5e-3, "{} is not {wanted}", found[0]);
}

/// Weight is judged: panels that the hinges can lift fold on the ground and from a panel that is held, heavier ones do not.
#[test]
fn sheets_fold_under_their_weight_as_far_as_hinges_hold() {
    let program = |ground: &str, plate: f64| {
        format!(
            "use std.mori.Polygon
let sheet = fold_sheet(
  load_creases(\"vertex.fold\", scale: 100mm),
  module: Polygon(thickness: 3mm, motor: 6g, plate: {plate}kg/m^2),
  ground: {ground},
)
print(if verify(sheet).ok {{ 1 }} else {{ 0 }})
print(if (sheet.energy else -1J) < 0J {{ 1 }} else {{ 0 }})"
        )
    };
    for (ground, unknown) in [("off", 0.0), ("settle", 1.0), ("held", 0.0)] {
        let (found, said) = numbers(&program(ground, 2.0));
        assert!(said.is_empty(), "{ground}: {said:?}");
        assert_eq!(found, [1.0, unknown], "{ground}");
    }
    let (_, said) = numbers(&program("held", 80.0));
    assert!(said.len() == 1 && said[0].starts_with("E0801"), "{said:?}");
    assert!(said[0].contains("lighter or smaller panels"), "{said:?}");
}

/// The weight of a vertex that is held level, which its four hinges share. In the flat sheet small folds θ are possible where
/// `Σ θ u = 0`, with the directions u of the creases; the torques τ hold the weight where `Σ τ θ` is its work for two such
/// folds. The least greatest |τ| that does is at one of the points where three of the four are as great as each other.
fn least_greatest_torque(plate: f64) -> f64 {
    let format = CREASE_FORMATS.iter().find(|format| format.ending == "fold").expect("it is read");
    let sheet = (format.read)(include_bytes!("../../examples/vertex.fold")).expect("it is read");
    // The creases lead from vertex 0, counterclockwise, to the corners 1, 3, 5 and 7; face k lies between crease k and the next.
    let at = |vertex: usize| [sheet.vertices[vertex][0] * 0.1, sheet.vertices[vertex][1] * 0.1];
    let outlines = [[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 7], [0, 7, 8, 1]];
    let along: Vec<[f64; 2]> = [1, 3, 5, 7]
        .iter()
        .map(|corner| {
            let [x, y] = at(*corner);
            [x / libm::hypot(x, y), y / libm::hypot(x, y)]
        })
        .collect();
    // (mass, first moments) of the panels.
    let panels: Vec<(f64, [f64; 2])> = outlines
        .iter()
        .map(|outline| {
            let (mut area, mut moment) = (0.0, [0.0; 2]);
            for k in 0..4 {
                let ([a, b], [c, d]) = (at(outline[k]), at(outline[(k + 1) % 4]));
                let cross = a * d - b * c;
                area += cross / 2.0;
                moment = [moment[0] + (a + c) * cross / 6.0, moment[1] + (b + d) * cross / 6.0];
            }
            let mass = 4.0 * 0.006 + plate * area;
            (mass, moment.map(|m| m / area * mass))
        })
        .collect();
    // The root is the face that the reader finds first.
    let first: Vec<usize> = sheet.faces[0].clone();
    let root =
        outlines.iter().position(|outline| outline.iter().all(|v| first.contains(v))).expect("it is one");
    let work = |folds: &[f64; 4]| {
        let (mut turn, mut work) = ([0.0; 2], 0.0);
        for step in 1..4 {
            let face = (root + step) % 4;
            turn = [turn[0] + folds[face] * along[face][0], turn[1] + folds[face] * along[face][1]];
            let (_, [x, y]) = panels[face];
            work += 9.80665 * (turn[0] * y - turn[1] * x);
        }
        work
    };
    // Two independent small folds: three creases each.
    let three = |skip: usize| {
        let mut folds = [0.0; 4];
        let [a, b, c] = [1, 2, 3].map(|k| (skip + k) % 4);
        let cross = |p: usize, q: usize| along[p][0] * along[q][1] - along[p][1] * along[q][0];
        (folds[a], folds[b], folds[c]) = (cross(b, c), cross(c, a), cross(a, b));
        folds
    };
    let ways = [three(0), three(1)];
    let works = ways.map(|folds| work(&folds));
    let mut least = f64::INFINITY;
    // One torque is free, the others are ±t: two equations for both.
    for free in 0..4 {
        for signs in 0..8 {
            let mut sign = [0.0; 4];
            (0..3).for_each(|k| sign[(free + 1 + k) % 4] = if signs >> k & 1 == 1 { 1.0 } else { -1.0 });
            let row = |way: &[f64; 4]| [way[free], (0..4).map(|k| way[k] * sign[k]).sum::<f64>()];
            let ([a, b], [c, d]) = (row(&ways[0]), row(&ways[1]));
            let determinant = a * d - b * c;
            if determinant.abs() < 1e-12 {
                continue;
            }
            let alone = (works[0] * d - b * works[1]) / determinant;
            let all = (a * works[1] - c * works[0]) / determinant;
            if all >= 0.0 && alone.abs() <= all * (1.0 + 1e-9) {
                least = least.min(all);
            }
        }
    }
    least
}

/// The hinge that closes the loop holds no more than the others: a vertex is refused where no way to share its weight leaves
/// all four hinges within 0.1 N·m, and passes where one does.
#[test]
fn the_hinge_that_closes_a_loop_has_its_limit_too() {
    let limit = 0.1;
    let critical = {
        let (mut low, mut high) = (1.0, 100.0);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if least_greatest_torque(middle) < limit { low = middle } else { high = middle }
        }
        low
    };
    let program = |plate: f64| {
        format!(
            "use std.mori.Polygon
let sheet = fold_sheet(
  load_creases(\"vertex.fold\", scale: 100mm),
  module: Polygon(thickness: 3mm, motor: 6g, plate: {plate}kg/m^2),
  ground: held,
)
print(1 - verify(sheet).torque_margin)"
        )
    };
    let (margin, said) = numbers(&program(critical * 0.97));
    assert!(said.is_empty(), "{critical}: {said:?}");
    let wanted = least_greatest_torque(critical * 0.97) / limit;
    assert!((margin[0] - wanted).abs() < 0.01, "{} is not {wanted}", margin[0]);
    let (_, said) = numbers(&program(critical * 1.03));
    assert!(said.len() == 1 && said[0].starts_with("E0801"), "{critical}: {said:?}");
}
