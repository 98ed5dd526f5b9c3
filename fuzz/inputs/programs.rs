//! Programs that are right by construction: numbers, a robot that is a tree, behaviours within its limits.

use super::dice::Dice;
use std::fmt::Write;

/// The module of the robots.
pub const MODULE: &str = "connector Face { mates Face, turns 4, holds 80N }
module Hinge(length: Length = 40mm) {
  mass 150g
  link base = box(length, 40mm, 40mm)
  link tip = box(length, 40mm, 40mm) at [length + 20mm, 0mm, 0mm]
  joint bend: base -> tip = revolute(axis: Y, range: -60deg..60deg, max_speed: 60deg/s) at [length / 2 + 10mm, 0mm, 0mm]
  port back: Face on base at [-length / 2, 0mm, 0mm] facing -X up +Z
  port front: Face on tip at [length / 2, 0mm, 0mm] facing +X up +Z
  for i in 0..2 { port side[i]: Face on base at [0mm, if i == 0 { 20mm } else { -20mm }, 0mm] facing [0, 1 - 2 * i, 0] up +Z }
}
";

/// A program that is right: numbers, a robot that is a tree, behaviours within its limits.
pub fn program(dice: &mut Dice) -> String {
    let mut text = String::from(MODULE);
    let modules = 2 + dice.below(4);
    arithmetic(dice, &mut text);
    writeln!(text, "config Robot(bend: Angle = {}deg) {{", dice.below(30)).expect("text grows");
    writeln!(text, "  part h[{modules}]: Hinge(length: {}mm)", 40 + dice.below(20)).expect("text grows");
    let mut free = vec!["h[0].front".to_string(), "h[0].side[0]".into(), "h[0].side[1]".into()];
    for module in 1..modules {
        let port = free.swap_remove(dice.below(free.len()));
        let turn = dice.of(&["", " turn 90deg", " turn 180deg"]);
        writeln!(text, "  connect {port} -- h[{module}].back{turn}").expect("text grows");
        free.push(format!("h[{module}].front"));
        free.push(format!("h[{module}].side[{}]", dice.below(2)));
    }
    writeln!(text, "  set h[{}].bend = bend\n  base h[0]", dice.below(modules)).expect("text grows");
    writeln!(text, "  behavior all(to: Angle = bend) = Pc([move(x.bend, to: to) for x in h])")
        .expect("text grows");
    writeln!(text, "  behavior some = {}", behavior(dice, 0..modules, 3)).expect("text grows");
    text.push_str("}\nlet r = Robot()\n");
    text.push_str("print(r, count(r), mass(r), com(r), plan(r.all()).duration)\n");
    text.push_str("let p = plan(Sc(r.some(), r.all(10deg)))\n");
    text.push_str("print(p.duration, p.actions, reverse(p).duration, (p ++ r.some()).steps)\n");
    text
}

fn arithmetic(dice: &mut Dice, text: &mut String) {
    let (a, b, c) = (1 + dice.below(9), 1 + dice.below(9), 1 + dice.below(9));
    let op = dice.of(&["+", "-", "*"]);
    writeln!(text, "let n = {a} {op} {b}\nlet x = {c}mm / {b}").expect("text grows");
    writeln!(text, "fn f(k: Int, l: Length = {a}cm) -> Length = if k > {b} {{ l * k }} else {{ l / {c} }}")
        .expect("text grows");
    writeln!(text, "print(n, x + f({b}), [f(i, x) for i in 0..{a} if i % 2 == 0], \"{{n}} of {{x}}\")")
        .expect("text grows");
}

/// Of joints that no sibling in parallel uses.
fn behavior(dice: &mut Dice, joints: std::ops::Range<usize>, depth: usize) -> String {
    let simple = |dice: &mut Dice| {
        let joint = joints.start + dice.below(joints.len());
        let to = dice.below(100) as i64 - 50;
        format!("move(h[{joint}].bend, to: {to}deg)")
    };
    match dice.below(if depth == 0 { 2 } else { 5 }) {
        0 => simple(dice),
        1 => format!("wait({}ms)", 100 + dice.below(900)),
        2 => format!(
            "Sc({}, {})",
            behavior(dice, joints.clone(), depth - 1),
            behavior(dice, joints, depth - 1)
        ),
        3 if joints.len() > 1 => {
            let middle = joints.start + joints.len() / 2;
            let (a, b) = (
                behavior(dice, joints.start..middle, depth - 1),
                behavior(dice, middle..joints.end, depth - 1),
            );
            format!("Pc({a}, {b})")
        }
        _ => format!(
            "repeat(Sc({}, {}), {})",
            simple(dice),
            behavior(dice, joints.clone(), depth - 1),
            1 + dice.below(3)
        ),
    }
}
