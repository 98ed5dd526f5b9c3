//! Contacts with the floor in models of MuJoCo: discs that lie flat during a whole plan stand on eight points of their lower rims,
//! and every shape that may touch the floor has a pair with the friction of its link.

use super::mjcf::{Element, elements};
use crate::support::desk::run_clean;
use std::collections::BTreeMap;

/// A disc that lies flat, a second one on an arm that turns by `ANGLE`, and a ball.
const PROGRAM: &str = "\
module Stand {
  link foot = cylinder(radius: 50mm, length: 20mm, axis: Z, mass: 1kg, friction: 0.7)
  link flap = cylinder(radius: 30mm, length: 10mm, axis: Z, mass: 10g, friction: 0.4) at [0mm, 0mm, 100mm]
  link ball = sphere(radius: 5mm, mass: 1g, friction: 0.2) at [0mm, 0mm, 40mm]
  joint turn : foot -> flap = revolute(axis: X, range: -90deg..90deg, max_torque: 1N*m) at [0mm, 0mm, 100mm]
  joint held : foot -> ball = fixed()
}
let s = Stand()
save(plan(move(s.turn, to: ANGLE, in: 2s), world: WORLD), \"p.mjcf.xml\")
";

/// Returns the elements of the model of the plan with this angle and world.
fn model(angle: &str, world: &str) -> Vec<Element> {
    let program = PROGRAM.replace("ANGLE", angle).replace("WORLD", world);
    elements(run_clean(&program).text("p.mjcf.xml"))
}

/// Returns the numbers of an attribute of an element; empty without it.
fn numbers(element: &Element, key: &str) -> Vec<f64> {
    let text = element.attributes.get(key).map_or("", String::as_str);
    text.split_whitespace().map(|number| number.parse().expect("a number")).collect()
}

/// Returns the points of rims, m, in the axes of their links, by the name of the link.
fn rims(model: &[Element]) -> BTreeMap<String, Vec<Vec<f64>>> {
    let mut found: BTreeMap<String, Vec<Vec<f64>>> = BTreeMap::new();
    let is_point =
        |e: &&Element| e.name == "geom" && e.attributes.get("class").is_some_and(|class| class == "rim");
    let points = model.iter().filter(is_point);
    for point in points {
        let link = point.attributes["name"].split('.').nth(1).expect("a link's name").to_owned();
        found.entry(link).or_default().push(numbers(point, "pos"));
    }
    found
}

#[test]
fn discs_that_lie_flat_during_the_plan_stand_on_eight_points_of_their_lower_rims() {
    // Discs with radius and half length, mm.
    let (foot, flap) = (("foot", 50.0, 10.0), ("flap", 30.0, 5.0));
    for (angle, flat) in [("10deg", vec![foot, flap]), ("90deg", vec![foot]), ("-60deg", vec![foot])] {
        let rims = rims(&model(angle, "world(friction: 1)"));
        assert_eq!(rims.len(), flat.len(), "{angle}");
        for (link, radius, half) in flat {
            let points = &rims[link];
            assert_eq!(points.len(), 8, "{angle}: {link}");
            for (index, point) in points.iter().enumerate() {
                // The lowest points of spheres of 0.1 mm are on the end face, the outermost on the rim.
                assert!(
                    (libm::hypot(point[0], point[1]) - (1e-3 * radius - 1e-4)).abs() < 1e-12,
                    "{point:?}"
                );
                assert!((point[2] + 1e-3 * half - 1e-4).abs() < 1e-12, "{point:?}");
                let next = &points[(index + 1) % 8];
                let outer = 1e-3 * radius - 1e-4;
                let inner = (point[0] * next[0] + point[1] * next[1]) / (outer * outer);
                assert!((inner - std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-9, "45 degrees apart");
            }
        }
    }
}

#[test]
fn what_may_touch_the_floor_has_a_pair_with_the_friction_of_its_link() {
    let all = model("90deg", "world(friction: 0.5)");
    let pairs: BTreeMap<&str, Vec<f64>> = all
        .iter()
        .filter(|e| e.name == "pair" && e.attributes.contains_key("geom1"))
        .inspect(|e| assert_eq!(e.attributes["geom1"], "floor"))
        .map(|e| (e.attributes["geom2"].as_str(), numbers(e, "friction")))
        .collect();
    let geoms: Vec<&str> = all
        .iter()
        .filter(|e| e.name == "geom")
        .filter_map(|e| e.attributes.get("name"))
        .map(String::as_str)
        .collect();
    assert!(pairs.keys().all(|name| geoms.contains(name)), "{pairs:?}");
    // Eight points of the foot, which does not touch the floor otherwise; the flap and the ball.
    assert_eq!(pairs.len(), 10, "{pairs:?}");
    for (name, friction) in pairs {
        let stated = [("foot", 0.35), ("flap", 0.2), ("ball", 0.1)];
        let wanted = stated.iter().find(|(link, _)| name.contains(link)).expect("a link").1;
        assert!(friction.iter().all(|f| (f - wanted).abs() < 1e-12), "{name}: {friction:?}");
    }
    // Without a floor there is none of this.
    let free = model("10deg", "world(ground: off)");
    assert!(free.iter().all(|e| e.name != "pair") && rims(&free).is_empty());
}
