//! Short loops, closed exactly: where joints stand at quarter turns there are only so many postures of two
//! or three modules, and all of them are looked at. Descent can't find such a posture where it lies at
//! the ends of the joints' ranges.

use super::merging::Pair;
use super::piece::Piece;
use super::robot::{GAMMA, RED, across, mate};
use super::state::{Joints, State};
use crate::geometry::RigidTransform;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Loops of more modules are left to descent: every module has 36 postures.
pub const LENGTH_MAX: usize = 3;

/// Entries of matrices; those of two different places on the lattice are half a pitch apart.
const TOL: f64 = 1e-6;

/// Where the joints of a pair's loop bring its docks together, one turn away that is free; of such
/// postures the one that is reached with the least turning.
pub fn leap(state: &State, pair: &Pair, work: &mut u64) -> Option<Joints> {
    let tree = &state.tree;
    let path = tree.path(tree.place[pair.a.shoe()], tree.place[pair.b.shoe()]);
    let here = &state.robot.joints;
    let mut found = Postures {
        pieces: Piece::along(tree, &state.poses, &path.places),
        wanted: mate(RED, 0, RED),
        joints: here.clone(),
        closed: Vec::new(),
    };
    found.look(0, RigidTransform::identity(), work);
    let turning = |to: &Joints| -> f64 {
        to.iter().zip(here).map(|(to, from)| (0..3).map(|k| (to[k] - from[k]).abs()).sum::<f64>()).sum()
    };
    let mut closed = found.closed;
    closed.sort_by(|a, b| turning(a).total_cmp(&turning(b)));
    let scene = state.scene();
    closed.into_iter().find(|to| scene.is_free(here, to, work))
}

struct Postures {
    pieces: Vec<Piece>,
    wanted: RigidTransform,
    joints: Joints,
    closed: Vec<Joints>,
}

impl Postures {
    /// All postures of the pieces from `next` on, where those before end at `pose`.
    fn look(&mut self, next: usize, pose: RigidTransform, work: &mut u64) {
        crate::interrupt::checkpoint();
        let Some(piece) = self.pieces.get(next).copied() else {
            let turn = (pose.rotation - self.wanted.rotation).amax();
            if turn.max((pose.translation - self.wanted.translation).amax()) < TOL {
                self.closed.push(self.joints.clone());
            }
            return;
        };
        let Piece::Module { module, near, far } = piece else {
            return self.look(next + 1, pose.then(&piece.pose(&self.joints)), work);
        };
        *work += 1;
        let before = self.joints[module];
        for (first, second, turn) in (0..36).map(|i| (i / 12, i / 4 % 3, i % 4)) {
            let q = &mut self.joints[module];
            q[near] = FRAC_PI_2 * (first as f64 - 1.0);
            q[far] = FRAC_PI_2 * (second as f64 - 1.0);
            let gamma = FRAC_PI_2 * turn as f64;
            q[GAMMA] = gamma + TAU * libm::round((before[GAMMA] - gamma) / TAU);
            let over = across(q[near], q[far], q[GAMMA]);
            self.look(next + 1, pose.then(&over), work);
        }
        self.joints[module] = before;
    }
}
