//! Scenes: robots and obstacles placed anywhere, behaviours of several robots, worlds; half of them damaged.

use super::damage::{damaged_numbers, damaged_tokens};
use super::dice::Dice;
use super::programs::MODULE;
use std::fmt::Write;

fn length(dice: &mut Dice) -> String {
    format!("{}mm", dice.below(2001) as i64 - 1000)
}

fn placed(dice: &mut Dice) -> String {
    let at = [0; 3].map(|_| length(dice)).join(", ");
    match dice.below(3) {
        0 => String::new(),
        1 => format!(" at [{at}]"),
        _ => format!(" at [{at}] turned({}, {}deg)", dice.of(&["X", "Y", "Z"]), dice.below(360)),
    }
}

fn shape(dice: &mut Dice) -> String {
    let size = |dice: &mut Dice| format!("{}mm", 1 + dice.below(400));
    let (a, b, c) = (size(dice), size(dice), size(dice));
    match dice.below(5) {
        0 => format!("sphere({a})"),
        1 => format!("cylinder(radius: {a}, length: {b}, axis: {})", dice.of(&["X", "Y", "Z"])),
        2 => format!("capsule(radius: {a}, length: {b}, axis: Z)"),
        3 => format!("hull([[0mm, 0mm, 0mm], [{a}, 0mm, 0mm], [0mm, {b}, 0mm], [0mm, 0mm, {c}]])"),
        _ => format!("box({a}, {b}, {c})"),
    }
}

fn world(dice: &mut Dice) -> String {
    let worlds = [
        "",
        "ground: off, gravity: off",
        "ground: off",
        "ground: held",
        "ground: fixed",
        "friction: 0.3",
        "gravity: off",
        "ground: off, gravity: off, dynamics: statics",
        "terrain: slope(10deg)",
        "friction: 0, dynamics: full",
    ];
    dice.of(&worlds).to_owned()
}

/// Returns a program with a scene, that plans a behaviour of its robots and emits the plan.
pub fn scene(dice: &mut Dice) -> String {
    let mut text = String::from(MODULE);
    let modules = 1 + dice.below(3);
    let _ =
        writeln!(text, "config Robot(bend: Angle = {}deg) {{\n  part h[{modules}]: Hinge", dice.below(60));
    for module in 1..modules {
        let _ = writeln!(text, "  connect h[{}].front -- h[{module}].back", module - 1);
    }
    text.push_str("  set h[0].bend = bend\n  base h[0]\n  behavior go(to: Angle = 20deg) = Pc([move(x.bend, to: to) for x in h])\n}\n");
    let robots = 1 + dice.below(3);
    text.push_str("scene Yard(gap: Length = 600mm) {\n");
    for robot in 0..robots {
        let at = placed(dice);
        let of = dice.of(&["Robot", "Robot(bend: 5deg)", "Hinge"]);
        let _ = writeln!(text, "  part r{robot}: {of}{at}");
    }
    for obstacle in 0..dice.below(3) {
        let (shape, at) = (shape(dice), placed(dice));
        let _ = writeln!(text, "  obstacle o{obstacle} = {shape}{at}");
    }
    if dice.below(3) == 0 {
        let _ = writeln!(
            text,
            "  for i in 0..{} {{ obstacle post[i] = sphere(10mm) at [i * 100mm, gap, 0mm] }}",
            dice.below(4)
        );
    }
    let stated = world(dice);
    if dice.below(3) == 0 {
        let _ = writeln!(text, "  world({stated})");
    }
    let action = |dice: &mut Dice| {
        let robot = dice.below(robots);
        match dice.below(4) {
            0 => format!("wait({}ms)", dice.below(900)),
            1 => format!("move(r{robot}.bend, to: {}deg)", dice.below(120) as i64 - 60),
            _ => format!("r{robot}.go(to: {}deg)", dice.below(120) as i64 - 60),
        }
    };
    let (a, b) = (action(dice), action(dice));
    let _ = writeln!(text, "  behavior all = {}({a}, {b})\n}}", dice.of(&["Sc", "Pc"]));
    let stated = if dice.below(2) == 0 { String::new() } else { format!(", world: world({})", world(dice)) };
    let _ = writeln!(
        text,
        "let y = Yard()\nlet p = plan(y.all(){stated})\nprint(p.duration, verify(p))\nemit(p, \"p.json\")"
    );
    match dice.below(4) {
        0 | 1 => text,
        2 => damaged_tokens(dice, &text),
        _ => damaged_numbers(dice, &text),
    }
}
