//! Other trusses than the paper's, and other targets: every plan passes the judge.

use crate::desk::cli::Sandbox;
use crate::support::properties::whole;
use modl::geometry::Vec3;
use std::fmt::Write;

const HEAD: &str = "use std.truss.PneumaticReel\nuse std.shapes.{cube, geodesic}\n";

/// A truss of struts of about 1 m between places, as a person would write it.
fn written(name: &str, of: &str, places: &[[f64; 3]], centre: bool) -> String {
    let mut text = format!("truss {name} of {of} {{\n");
    for (i, [x, y, z]) in places.iter().enumerate() {
        writeln!(text, "  node p[{i}] = [{x}m, {y}m, {z}m]").expect("it is a string");
    }
    if centre {
        text += "  node c = [0m, 0m, 0m]\n";
        writeln!(text, "  for i in 0..{} {{ strut c -- p[i] }}", places.len()).expect("it is a string");
    }
    for i in 0..places.len() {
        for j in i + 1..places.len() {
            let apart = (Vec3::from(places[i]) - Vec3::from(places[j])).norm_squared();
            if (apart - 1.0).abs() < 1e-6 {
                writeln!(text, "  strut p[{i}] -- p[{j}]").expect("it is a string");
            }
        }
    }
    text + "}\n"
}

/// An icosahedron with a node in its middle: 42 struts.
fn icosahedron() -> String {
    let golden = (1.0 + libm::sqrt(5.0)) / 4.0;
    let mut places = Vec::new();
    for (a, b) in [(0.5, golden), (-0.5, golden), (0.5, -golden), (-0.5, -golden)] {
        places.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
    }
    written("Ball", "PneumaticReel", &places, true)
}

/// An octahedron and a tetrahedron on each of two sides: 8 nodes and 18 struts, as many as the least variable
/// topology truss has that can change its topology.
fn variable() -> String {
    let (high, up) = (libm::sqrt(0.75), libm::sqrt(2.0 / 3.0));
    let sides = [[1.0, 0.0, 0.0], [0.5, high, 0.0], [0.5, high / 3.0, up]];
    let corner = |n: usize| std::array::from_fn(|k| (0..3).map(|s| (n >> s & 1) as f64 * sides[s][k]).sum());
    let places: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let strut =
        "strut Long { length 200mm..4m  max_speed 50mm/s  max_force 200N  mass 1kg  clearance 50mm }\n";
    strut.to_owned() + &written("Variable", "Long", &places, false)
}

fn run(program: &str) -> String {
    let sandbox = Sandbox::new(&[("robots.mod", format!("{HEAD}{program}").as_bytes())]);
    let ran = sandbox.run(&["run", "robots.mod"]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran.out
}

#[test]
fn other_trusses_walk_and_their_plans_pass() {
    let mut program = icosahedron() + &variable();
    program += "truss Helix of PneumaticReel = tetrahelix(5, edge: 1m)\n";
    program += "truss Pile of PneumaticReel = octet(edge: 3m, divisions: 3)\n";
    for (i, robot) in ["Ball", "Variable", "Helix", "Pile"].iter().enumerate() {
        program += &format!("let w{i} = locomote({robot}, path: [[4m, 1m, 0m]])\n");
        program += &format!("print(w{i}.ended, w{i}.distance > 1m, verify(w{i}).ok)\n");
    }
    program += "let soft = locomote(Ball, path: [[4m, 1m, 0m]], impact: false)\n";
    program += "print(soft.ended, soft.footholds > 0, verify(soft).ok)\n";
    assert_eq!(run(&program), "arrived true true\n".repeat(5));
}

/// The S of the paper, with the library's struts: the judge finds forces within their limit all along, by linear
/// programming, and nothing slides farther than a metre. Without the limit the struts would bear twice as much.
#[test]
fn walks_carry_their_weight() {
    let headings: &[i32] =
        if whole() { &[0, 10, 25, 45, 77, 90, 130, 157, 200, 222, 260, 300, 330, 345] } else { &[90] };
    let objectives: &[&str] = if whole() { &["springs", "lengths", "restoring"] } else { &["springs"] };
    let mut bad = Vec::new();
    for (turned, objective) in headings.iter().flat_map(|t| objectives.iter().map(move |o| (t, o))) {
        let program = format!(
            "truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)\n\
             let a = {turned}deg\n\
             let corners = [[0, 0], [8, 0], [8, 6], [0, 6], [0, 12], [8, 12]]\n\
             let path: List<Vec3<Length>> = [[(p[0] * cos(a) - p[1] * sin(a)) * 1m, \
             (p[0] * sin(a) + p[1] * cos(a)) * 1m, 0m] for p in corners]\n\
             let w = locomote(Pyramid, path: path, objective: {objective})\n\
             let v = verify(w)\n\
             print(w.ended, v.ok, w.slip < 1m)\n\
             print(w.steps, w.rolls, w.slip, v.duration, v.rigidity, v.force_margin)\n\
             for c in v.checks {{ print(c) }}\n"
        );
        let out = run(&program);
        // All are travelled, so that each has its row.
        if !out.starts_with("arrived true true") {
            bad.push(format!("{turned}, {objective}: {out}"));
        }
        assert!(out.contains("strut load: sampled("), "{out}");
        assert!(out.contains("acceleration: proved"), "{out}");
        eprintln!("{turned}, {objective}: {}", out.lines().nth(1).unwrap_or_default());
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

/// On a cube of this edge, in so few steps, shapes are as rigid as they must be at both ends of a long step and not between, before
/// others are found.
#[test]
fn steps_of_a_morph_stay_rigid_between_their_ends() {
    let out = run("truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)\n\
         let made = morph(Pyramid, cube(edge: 2.1m), budget: 100, tolerance: 1mm)\n\
         print(verify(made).ok)\n");
    assert_eq!(out, "true\n");
}

/// A step over the edge of the support ends on it, where it has to be as rigid as at its own end; and where a node slides, the
/// support may leave the centre of mass between the ends of a step that stands at both.
#[test]
fn steps_at_the_edge_of_the_support_keep_all_limits() {
    for (turned, path) in [
        ("25deg", "[[c, s, 0m], [c - 0.75 * s, s + 0.75 * c, 0m]]"),
        ("300deg", "[[0m, 0m, 0m], [c, s, 0m]]"),
    ] {
        let out = run(&format!(
            "truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)\n\
             let c = 8m * cos({turned})\n\
             let s = 8m * sin({turned})\n\
             let path: List<Vec3<Length>> = {path}\n\
             let w = locomote(Pyramid, path: path, objective: restoring)\n\
             print(w.ended, verify(w).ok)\n"
        ));
        assert_eq!(out, "arrived true\n", "{turned}");
    }
}

/// A step that ends at the limit of rigidity may pass through a shape that is not rigid.
#[test]
fn steps_that_end_at_the_limit_of_rigidity_are_rigid_on_the_way() {
    let out = run("truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)\n\
         let m = morph(Pyramid, cube(edge: 2m), angle: 10deg)\n\
         print(verify(m).ok)\n");
    assert_eq!(out, "true\n");
}

/// Half as far from the target as at the start is what the coarsest of them gets to.
#[test]
fn other_trusses_and_targets_morph_and_their_plans_pass() {
    let mut program = icosahedron() + &variable();
    program += "truss Helix of PneumaticReel = tetrahelix(5, edge: 1m)\n";
    program += "truss Pile of PneumaticReel = octet(edge: 3m, divisions: 3)\n";
    program += "let ball = geodesic(radius: 1.2m, parts: 3)\n";
    program += "let angles = [30deg * i for i in 0..12]\n";
    program += "let tilts = [20deg * i for i in -4..5]\n";
    program += "let egg = cloud([[1.8m * cos(a) * cos(b), 1.2m * sin(a) * cos(b), 1m * sin(b)] for a in angles for b in tilts])\n";
    for (i, (robot, target)) in [
        ("Ball", "ball"),
        ("Ball", "egg"),
        ("Variable", "cube(edge: 900mm)"),
        ("Helix", "ball"),
        ("Pile", "egg"),
    ]
    .iter()
    .enumerate()
    {
        program += &format!("let m{i} = morph({robot}, {target}, budget: 60)\n");
        program += &format!("print(m{i}.rms < 0.5 * m{i}.start_rms, verify(m{i}).ok)\n");
    }
    assert_eq!(run(&program), "true true\n".repeat(5));
}

/// What a call asks for beside the limits of the struts: names that are wrong, values out of range, a
/// timeout; and what a plan then keeps, judged from its file.
#[test]
fn limits_are_asked_for_by_name() {
    let with = |options: &str| {
        let text = format!(
            "{HEAD}truss P of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)\n\
             let m = morph(P, cube(edge: 1m), budget: 20, {options})\n\
             print(verify(m).ok, verify(m).angle > 15deg, verify(m).rigidity > 0.1)\n\
             emit(m, \"m.plan.json\")\n"
        );
        let sandbox = Sandbox::new(&[("limits.mod", text.as_bytes())]);
        let ran = sandbox.run(&["run", "limits.mod"]);
        (sandbox, ran)
    };
    for (options, wanted) in [
        ("failed: [\"0 -- 99\"]", "no strut `0 -- 99`"),
        ("failed: [\"0 -- 1\", \"1 -- 0\"]", "twice"),
        ("angle: 61deg", "less than 60deg"),
        ("rigidity: -1", "not negative"),
        ("perimeters: [[\"0 -- 1\"]]", "at least two"),
        ("timeout: 0s", "timeout"),
        ("timeout: 1us", "within the timeout"),
    ] {
        let (_, ran) = with(options);
        assert!(ran.code != 0 && ran.err.contains(wanted), "{options}: {}", ran.err);
    }
    let options = "angle: 15deg, rigidity: 0.1, failed: [\"1 -- 0\"], perimeters: [[\"0 -- 3\", \"0 -- 6\"]]";
    let (sandbox, ran) = with(options);
    assert_eq!((ran.code, ran.out.lines().next()), (0, Some("true true true")), "{}", ran.err);
    let judged = sandbox.run(&["verify", "out/m.plan.json"]);
    assert_eq!(judged.code, 0, "{}{}", judged.out, judged.err);
    assert!(judged.out.contains("angle") && judged.out.contains("rigidity"), "{}", judged.out);
}

/// The corners of a cube from a file of either kind are the same target as the list of them.
#[test]
fn clouds_come_from_files() {
    let corners = (0..8).map(|n| [n & 1, n >> 1 & 1, n >> 2 & 1].map(|bit| 2 * bit));
    let lines: Vec<String> = corners.map(|[x, y, z]| format!("{x} {y} {z}")).collect();
    let xyz = format!("# a cube\n{}\n", lines.join(" 255 0 0\n"));
    let header = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    let ply = format!("{header}{}\n", lines.join("\n"));
    let list: Vec<String> = lines.iter().map(|line| format!("[{}m]", line.replace(' ', "m, "))).collect();
    let program = format!(
        "{HEAD}print(load_cloud(\"a.xyz\", scale: 1m) == cloud([{0}]), load_cloud(\"a.ply\", scale: 1m) == cloud([{0}]))\n",
        list.join(", ")
    );
    let files: [(&str, &[u8]); 3] =
        [("p.mod", program.as_bytes()), ("a.xyz", xyz.as_bytes()), ("a.ply", ply.as_bytes())];
    let ran = Sandbox::new(&files).run(&["run", "p.mod"]);
    assert_eq!((ran.code, ran.out.as_str()), (0, "true true\n"), "{}", ran.err);
    for (text, wanted) in
        [("0 0\n", "line 1"), ("0 0 0\n1 2 x\n", "line 2"), ("", "no points"), ("1 2 inf\n", "finite")]
    {
        let files: [(&str, &[u8]); 2] =
            [("p.mod", b"let c = load_cloud(\"a.xyz\")\n"), ("a.xyz", text.as_bytes())];
        let ran = Sandbox::new(&files).run(&["run", "p.mod"]);
        assert!(ran.code != 0 && ran.err.contains(wanted), "{text}: {}", ran.err);
    }
}
