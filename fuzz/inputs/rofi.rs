//! Configurations of RoFI modules as text and JSON: trees, some with loops, and then damaged.

use super::damage::damaged;
use super::dice::Dice;
use std::fmt::Write;

const FACES: [&str; 3] = ["+X", "-X", "-Z"];
const TURNS: [&str; 4] = ["North", "East", "South", "West"];

/// A connection: module, shoe and face of both ends, and the turn.
struct Edge {
    ends: [(usize, &'static str, &'static str); 2],
    turn: &'static str,
}

/// Returns a file: `rofi` or `json`, a line break, and the text.
pub fn file(dice: &mut Dice) -> Vec<u8> {
    let many = 1 + dice.below(6);
    let id = |module: usize, gaps: bool| if gaps { 7 * module + 3 } else { module };
    let gaps = dice.below(3) == 1;
    let joints: Vec<[f64; 3]> =
        (0..many).map(|_| [0; 3].map(|_| dice.below(1441) as f64 / 8.0 - 90.0)).collect();
    let end = |dice: &mut Dice, module: usize| (module, dice.of(&["A", "B"]), dice.of(&FACES));
    let mut edges = Vec::new();
    for module in 1..many + dice.below(2) {
        let from = dice.below(module.min(many));
        let to = module.min(many - 1);
        edges.push(Edge { ends: [end(dice, from), end(dice, to)], turn: dice.of(&TURNS) });
    }
    let json = dice.below(2) == 1;
    let text = if json {
        let modules = joints.iter().enumerate().map(|(module, [alpha, beta, gamma])| {
            serde_json::json!({ "id": id(module, gaps), "type": "universal", "alpha": alpha, "beta": beta, "gamma": gamma })
        });
        let end = |(module, side, face): (usize, &str, &str)| serde_json::json!({ "id": id(module, gaps), "connector": format!("{side}{face}") });
        let edges = edges.iter().map(
            |e| serde_json::json!({ "from": end(e.ends[0]), "to": end(e.ends[1]), "orientation": e.turn }),
        );
        let file = serde_json::json!({ "modules": modules.collect::<Vec<_>>(), "moduleJoints": edges.collect::<Vec<_>>() });
        serde_json::to_string_pretty(&file).expect("it is JSON")
    } else {
        let mut text = String::from("C\n# one\n");
        for (module, [alpha, beta, gamma]) in joints.iter().enumerate() {
            let _ = writeln!(text, "M {} {alpha} {beta} {gamma}", id(module, gaps));
        }
        for Edge { ends: [(a, side_a, face_a), (b, side_b, face_b)], turn } in &edges {
            let (a, b) = (id(*a, gaps), id(*b, gaps));
            let _ = writeln!(text, "E {a} {side_a} {face_a} {} {face_b} {side_b} {b}", &turn[..1]);
        }
        text
    };
    let text = if dice.below(3) == 0 { text } else { damaged(dice, &text) };
    format!("{}\n{text}", if json { "json" } else { "rofi" }).into_bytes()
}
