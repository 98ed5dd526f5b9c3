//! Folding: what proofs and enumeration take, shape by shape, and how proofs grow with the
//! number of faces.
//!
//! `cargo bench --bench fold_proofs` prints tables; with `-- growth FILE.svg` it draws the growth. Times are
//! of the processor.

use modl::geometry::{Vec3, subdivide};
use modl::planners::fold::Observer;
use modl::planners::fold::branch_and_bound::{self, Optimum, Proof, optimum};
use modl::planners::fold::enumerate::{self, enumerate_energies};
use modl::planners::fold::{Target, Weights};
use std::fmt::Write as _;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

const MASS: f64 = 0.026;
const SIDE: f64 = 0.08;
const REPEATS: u32 = 1_000;

/// Steps that take about ten seconds on one of the cores that the tables were made on.
const BUDGET: u64 = 100_000_000;

/// Steps for one point of the plot of growth, of which many end so.
const GROWTH_BUDGET: u64 = BUDGET / 2;

type Mesh = (Vec<Vec3>, Vec<Vec<usize>>);

fn of_truth(shape: &serde_json::Value) -> Mesh {
    let rows = |key: &str| shape[key].as_array().expect("a list").clone();
    let point = |row: &serde_json::Value| Vec3::from_fn(|k, _| row[k].as_f64().expect("a number") * SIDE);
    let corners =
        |row: &serde_json::Value| (0..3).map(|k| row[k].as_u64().expect("a place") as usize).collect();
    (rows("vertices_unit_edge").iter().map(point).collect(), rows("faces_ccw").iter().map(corners).collect())
}

fn split((points, faces): &Mesh, parts: usize, round: bool) -> Mesh {
    let faces: Vec<[usize; 3]> = faces.iter().map(|f| [f[0], f[1], f[2]]).collect();
    let (points, faces) = subdivide(points, &faces, parts);
    let place = |p: Vec3| if round { p.normalize() * SIDE * parts as f64 } else { p };
    (points.into_iter().map(place).collect(), faces.iter().map(|f| f.to_vec()).collect())
}

/// Every vertex off its place by up to a part of the side.
fn shaken((mut points, faces): Mesh, part: f64) -> Mesh {
    for (i, point) in points.iter_mut().enumerate() {
        let shake = |k: usize| part * SIDE * libm::sin(12.9898 * (3 * i + k) as f64 * 78.233);
        *point += Vec3::new(shake(0), shake(1), shake(2));
    }
    (points, faces)
}

/// Every vertex nearer to or farther from the centre by up to a part of its distance: a surface with dents.
fn dented((mut points, faces): Mesh, part: f64) -> Mesh {
    for (i, point) in points.iter_mut().enumerate() {
        *point *= 1.0 + part * libm::sin(12.9898 * (i + 1) as f64 * 78.233);
    }
    (points, faces)
}

/// A spike on every face of a sphere, or a dent: its tip is at a part of the side above the middle of the face.
fn spiked((points, faces): &Mesh, height: f64) -> Mesh {
    let (mut points, mut spiked) = (points.clone(), vec![]);
    for face in faces {
        let middle = face.iter().fold(Vec3::zeros(), |sum, &corner| sum + points[corner]) / 3.0;
        points.push(middle + middle.normalize() * (height * SIDE));
        let tip = points.len() - 1;
        spiked.extend((0..3).map(|k| vec![face[k], face[(k + 1) % 3], tip]));
    }
    (points, spiked)
}

/// `tube`: radius of the tube, as a part of the ring's.
fn torus(around: usize, across: usize, tube: f64) -> Mesh {
    let turn = |i: usize, of: usize| libm::sincos(std::f64::consts::TAU * i as f64 / of as f64);
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for i in 0..around {
        for j in 0..across {
            let ((s, c), (t, d)) = (turn(i, around), turn(j, across));
            points.push(Vec3::new((1.0 + tube * d) * c, (1.0 + tube * d) * s, tube * t) * 0.15);
            let at = |i: usize, j: usize| i % around * across + j % across;
            faces.push(vec![at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            faces.push(vec![at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (points, faces)
}

fn tube(sides: usize, rings: usize) -> Mesh {
    let half = std::f64::consts::PI / sides as f64;
    let radius = SIDE / (2.0 * libm::sin(half));
    let shift = 2.0 * radius * libm::sin(half / 2.0);
    let height = libm::sqrt(SIDE * SIDE - shift * shift);
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for k in 0..=rings {
        for i in 0..sides {
            let (s, c) = libm::sincos(half * (2 * i + k % 2) as f64);
            points.push(Vec3::new(radius * c, radius * s, height * k as f64));
        }
    }
    for k in 0..rings {
        for i in 0..sides {
            let above = |i: usize| (k + 1) * sides + (i + k % 2) % sides;
            faces.push(vec![k * sides + i, k * sides + (i + 1) % sides, above(i)]);
            faces.push(vec![k * sides + i, above(i), above(i + sides - 1)]);
        }
    }
    (points, faces)
}

fn target((points, faces): Mesh) -> Target {
    Target::new(points, &faces).expect("it folds")
}

/// What this thread has had of a processor: others may use the machine, too. Where the system does not
/// tell, what has passed since the first call.
fn worked() -> Duration {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    let begin = BEGIN.get_or_init(Instant::now);
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|told| told.split_whitespace().next()?.parse().ok());
    nanoseconds.map_or_else(|| begin.elapsed(), Duration::from_nanos)
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = worked();
    let made = work();
    (made, worked() - start)
}

fn proved(target: &Target, flat: bool, budget: u64) -> (Optimum, Duration) {
    let weights = Weights::uniform(target, MASS);
    let settings = branch_and_bound::Settings { flat, budget, ..branch_and_bound::Settings::default() };
    timed(|| optimum(target, &weights, &settings).expect("it has layouts"))
}

fn main() {
    let truth: serde_json::Value =
        serde_json::from_str(include_str!("../tests/truth/fold.json")).expect("the truth is JSON");
    let shapes = truth["shapes"].as_object().expect("an object");
    let icosahedron = of_truth(&shapes["icosahedron"]);
    let asked: Vec<String> = std::env::args().skip_while(|a| a != "growth").collect();
    if let [_, file, ..] = &asked[..] {
        return growth(shapes, file);
    }
    println!("| shape | faces | all roots | branchings | gap |");
    println!("|---|---|---|---|---|");
    let mut meshes: Vec<(String, Mesh)> = shapes.iter().map(|(n, s)| (n.clone(), of_truth(s))).collect();
    meshes.extend([
        ("tube 4x6".into(), tube(4, 6)),
        ("icosahedron split into 80".into(), split(&icosahedron, 2, false)),
        ("geodesic 80, shaken".into(), shaken(split(&icosahedron, 2, true), 0.1)),
        ("geodesic 180".into(), split(&icosahedron, 3, true)),
        ("geodesic 180, shaken".into(), shaken(split(&icosahedron, 3, true), 0.1)),
        ("icosahedron with spikes, shaken".into(), shaken(spiked(&icosahedron, 0.3), 0.1)),
        ("icosahedron with dents, shaken".into(), shaken(spiked(&icosahedron, -0.3), 0.1)),
        ("geodesic 80, dented".into(), dented(split(&icosahedron, 2, true), 0.25)),
        ("torus 12x6, tube 0.3 of the radius".into(), torus(12, 6, 0.3)),
        ("torus 12x6, tube 0.4 of the radius".into(), torus(12, 6, 0.4)),
        ("torus 12x6, tube 0.5 of the radius".into(), torus(12, 6, 0.5)),
    ]);
    for (name, mesh) in meshes {
        let target = target(mesh);
        let (found, mut exact) = proved(&target, false, BUDGET);
        // The system's account of short times is coarse.
        if exact < Duration::from_millis(5) {
            exact = timed(|| (0..REPEATS).for_each(|_| drop(proved(&target, false, BUDGET)))).1 / REPEATS;
        }
        let gap = match found.proof {
            Proof::Optimal => "proved".to_owned(),
            Proof::Open => format!("{:.4} %", 100.0 * (1.0 - found.bound / found.energy)),
        };
        println!("| {name} | {} | {exact:.3?} | {} | {gap} |", target.faces.len(), found.nodes);
    }
    let stella = target(of_truth(&shapes["stella_octangula"]));
    let flat = proved(&stella, true, BUDGET).0;
    let time = timed(|| (0..REPEATS).for_each(|_| drop(proved(&stella, true, BUDGET)))).1 / REPEATS;
    let price = flat.energy / proved(&stella, false, BUDGET).0.energy;
    println!("\nstella octangula without overlap: {price:.9} times the energy, proved in {time:.3?}");
    let target = target(icosahedron);
    let all = enumerate::Settings { root: None, spectrum: false, budget: u64::MAX };
    let weights = Weights::uniform(&target, MASS);
    let (found, time) =
        timed(|| enumerate_energies(&target, &weights, &all, &Observer::none()).expect("few faces"));
    println!("icosahedron: {} layouts with 20 roots enumerated in {time:.3?}", found.layouts);
}

/// Draws how long proofs take against the number of faces: the convex deltahedra, then spheres, whole
/// and shaken, tubes and tori. What the budget ends is drawn hollow, with its gap.
fn growth(shapes: &serde_json::Map<String, serde_json::Value>, file: &str) {
    let icosahedron = of_truth(&shapes["icosahedron"]);
    let mut small: Vec<Mesh> = DELTAHEDRA.iter().map(|name| of_truth(&shapes[*name])).collect();
    let spheres: Vec<Mesh> = (1..=4).map(|parts| split(&icosahedron, parts, true)).collect();
    let rough = small.iter().chain(&spheres).map(|mesh| shaken(mesh.clone(), 0.1)).collect();
    small.extend(spheres);
    let tubes = (1..=12).map(|rings| tube(6, rings)).collect();
    let tori = (2..=7).map(|n| torus(2 * n, n, 0.4)).skip(1).collect();
    let series: [(&str, &str, Vec<Mesh>); 4] = [
        ("deltahedra, geodesic spheres", "#0b63a5", small),
        ("the same, shaken", "#c0392b", rough),
        ("tubes of six sides", "#2e7d32", tubes),
        ("tori, tube 0.4 of the radius", "#8e44ad", tori),
    ];
    let mut drawn = String::new();
    for (line, (name, colour, meshes)) in series.into_iter().enumerate() {
        let mut points = Vec::new();
        for mesh in meshes {
            let target = target(mesh);
            let (found, mut time) = proved(&target, false, GROWTH_BUDGET);
            if time < Duration::from_millis(5) {
                let again = || (0..REPEATS).for_each(|_| drop(proved(&target, false, GROWTH_BUDGET)));
                time = timed(again).1 / REPEATS;
            }
            let gap = (found.proof == Proof::Open).then(|| 100.0 * (1.0 - found.bound / found.energy));
            println!("{name}: {} faces, {time:.3?}, {:?}, gap {gap:?} %", target.faces.len(), found.proof);
            points.push((target.faces.len() as f64, time.as_secs_f64(), gap));
        }
        series_drawn(&mut drawn, name, colour, line, &points);
    }
    std::fs::write(file, framed(&drawn)).expect("the file can be written");
}

/// Convex ones of the truth.
const DELTAHEDRA: [&str; 4] = ["tetrahedron", "triangular_bipyramid", "octahedron", "snub_disphenoid"];

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 440.0;
/// Faces are drawn from 3 to 400, on a scale of logarithms; decades of seconds from 1e-6 to 1e2.
const FACES: [f64; 2] = [3.0, 400.0];
const MARKED: [f64; 7] = [4.0, 8.0, 20.0, 40.0, 80.0, 180.0, 320.0];
const SECONDS: [f64; 2] = [1e-6, 1e2];

fn place(faces: f64, seconds: f64) -> [f64; 2] {
    let along = |x: f64, [low, high]: [f64; 2]| libm::log(x / low) / libm::log(high / low);
    [70.0 + along(faces, FACES) * (WIDTH - 90.0), HEIGHT - 50.0 - along(seconds, SECONDS) * (HEIGHT - 70.0)]
}

/// A point: faces, seconds, and the gap in per cent where the proof is open.
type Point = (f64, f64, Option<f64>);

fn series_drawn(out: &mut String, name: &str, colour: &str, line: usize, points: &[Point]) {
    let at: Vec<[f64; 2]> = points.iter().map(|p| place(p.0, p.1)).collect();
    let way: Vec<String> = at.iter().map(|p| format!("{:.1},{:.1}", p[0], p[1])).collect();
    writeln!(out, r#"<polyline points="{}" fill="none" stroke="{colour}"/>"#, way.join(" "))
        .expect("text grows");
    for ([x, y], (.., gap)) in at.iter().zip(points) {
        let fill = if gap.is_none() { colour } else { "#fffefb" };
        writeln!(out, r#"<circle cx="{x:.1}" cy="{y:.1}" r="4" fill="{fill}" stroke="{colour}"/>"#)
            .expect("text grows");
        if let Some(gap) = gap {
            // Those of one number of faces end at about the same time.
            let above = y - 8.0 - 14.0 * line as f64;
            let open = if *gap < 0.01 { "&lt;0.01".to_owned() } else { format!("{gap:.2}") };
            writeln!(
                out,
                r#"<text x="{x:.1}" y="{above:.1}" text-anchor="middle" font-size="11" fill="{colour}">{open} %</text>"#
            )
            .expect("text grows");
        }
    }
    let y = 40 + 18 * line;
    writeln!(out, r#"<text x="85" y="{y}" fill="{colour}">{name}</text>"#).expect("text grows");
}

fn framed(inside: &str) -> String {
    let mut grid = String::new();
    for faces in MARKED {
        let [x, y] = place(faces, SECONDS[0]);
        writeln!(grid, r#"<text x="{x:.1}" y="{:.1}" text-anchor="middle">{faces}</text>"#, y + 18.0)
            .expect("text grows");
    }
    for decade in -6..=2 {
        let [x, y] = place(FACES[0], libm::pow(10.0, f64::from(decade)));
        let end = WIDTH - 20.0;
        writeln!(
            grid,
            r##"<line x1="{x:.1}" y1="{y:.1}" x2="{end}" y2="{y:.1}" stroke="#ddd"/><text x="{:.1}" y="{:.1}" text-anchor="end">1e{decade} s</text>"##,
            x - 8.0,
            y + 4.0
        )
        .expect("text grows");
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fffefb\"/>\n{grid}{inside}\
         <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">faces</text>\n</svg>\n",
        WIDTH / 2.0,
        HEIGHT - 12.0
    )
}
