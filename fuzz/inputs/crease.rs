//! Crease patterns, as a seed states them: any polygons, creases and steps whose indices are those of the pattern.

use super::dice::Dice;
use modl::formats::{Crease, CreasePattern};

/// Returns a crease pattern. Its numbers need not be those of a sheet that folds.
pub fn pattern(dice: &mut Dice) -> CreasePattern {
    let many = 3 + dice.below(9);
    let vertices: Vec<[f64; 2]> = (0..many).map(|_| [0; 2].map(|_| number(dice))).collect();
    let face = |dice: &mut Dice| (0..3 + dice.below(3)).map(|_| dice.below(many)).collect();
    let faces: Vec<Vec<usize>> = (0..1 + dice.below(6)).map(|_| face(dice)).collect();
    let steps = dice.below(3);
    let edge = |dice: &mut Dice| {
        let hinge = dice.below(2) == 1;
        Crease {
            vertices: [0; 2].map(|_| dice.below(many)),
            faces: (0..1 + usize::from(hinge)).map(|_| dice.below(faces.len())).collect(),
            angle: hinge.then(|| dice.between(-3.2, 3.2)),
            step: (hinge && steps > 0).then(|| 1 + dice.below(steps)),
            glued: None,
        }
    };
    let edges = (0..dice.below(8)).map(|_| edge(dice)).collect();
    let folded = (0..steps).map(|_| (0..many).map(|_| [0; 3].map(|_| number(dice))).collect()).collect();
    let modules = faces.iter().enumerate().map(|(face, _)| format!("m[{face}]\"<")).collect();
    CreasePattern { title: "a \"title\"\n".to_owned(), vertices, faces, modules, edges, folded }
}

fn number(dice: &mut Dice) -> f64 {
    match dice.below(12) {
        0 => 0.0,
        1 => 1e-300,
        2 => 1e300,
        3 => -0.0,
        _ => dice.between(-0.5, 0.5),
    }
}
