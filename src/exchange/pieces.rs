//! The topologies of a plan: the robot between two changes of its bonds, taken apart into what hangs together.

use crate::plan::Tracks;
use crate::robot::Kinematics;

/// The part of a robot that bonds hold together, over the time in which none of its bonds changes.
pub(super) struct Piece {
    /// The time from which on it is so, s.
    pub(super) from: f64,
    /// The time until which it is so, s.
    pub(super) to: f64,
    /// The kinematics from its root: the base module, or the first of its modules.
    pub(super) kinematics: Kinematics,
    /// The end of the stem of its files: empty if a plan has only one piece.
    pub(super) suffix: String,
}

impl Piece {
    /// Returns the number of the link that carries all others, among all links.
    pub(super) fn root(&self) -> usize {
        self.kinematics.link(self.kinematics.root, 0)
    }

    /// Returns the numbers of the links of the piece: the root first, then the others, parents before children.
    pub(super) fn links(&self) -> Vec<usize> {
        std::iter::once(self.root()).chain(self.kinematics.steps.iter().map(|step| step.link)).collect()
    }
}

/// Returns the pieces of a plan in order of their beginning, then of their first module, the one of the base first. A
/// piece that a change of bonds elsewhere leaves as it is goes on.
pub(super) fn pieces(tracks: &Tracks) -> Vec<Piece> {
    let robot = &tracks.robot;
    let mut from: Vec<f64> = tracks.events.iter().map(|event| event.time).filter(|t| *t > 0.0).collect();
    from.insert(0, 0.0);
    from.dedup();
    let mut pieces: Vec<Piece> = Vec::new();
    for (index, &start) in from.iter().enumerate() {
        let end = from.get(index + 1).copied().unwrap_or(tracks.duration);
        let holds = tracks.bonds(start);
        let mut seen = vec![false; robot.modules.len()];
        let known = pieces.len();
        for root in std::iter::once(robot.base).chain(0..robot.modules.len()) {
            if seen[root] {
                continue;
            }
            let kinematics = Kinematics::new(robot, &holds, root);
            kinematics.tree.order.iter().for_each(|(module, _)| seen[*module] = true);
            let same = |piece: &&mut Piece| {
                let (a, b) = (&piece.kinematics.tree, &kinematics.tree);
                piece.to == start && a.order == b.order && a.closing == b.closing
            };
            match pieces[..known].iter_mut().find(same) {
                Some(before) => before.to = end,
                None => pieces.push(Piece { from: start, to: end, kinematics, suffix: String::new() }),
            }
        }
    }
    if pieces.len() > 1 {
        pieces.iter_mut().enumerate().for_each(|(i, piece)| piece.suffix = format!("-{}", i + 1));
    }
    pieces
}
