//! The torques of hinges while a sheet folds: inverse dynamics of a tree of its panels, projected onto what the loops leave
//! open.
//!
//! The creases move together, so a motion asks for the torque of each direction in which they can move, and not of each hinge:
//! of all torques that cause a motion, those with the least sum of squares are taken. These are the torques that the hinges of
//! any tree would need, without the part that the loops take (d'Alembert); in a sheet without loops nothing is taken away.

use super::loops::Loops;
use super::path::free_part;
use super::timing::Keyframes;
use crate::geometry::Vec3;
use crate::planners::fold::dynamics::{Dynamics, Hinging};
use crate::planners::fold::inertia::{Body, Inertia};
use crate::planners::fold::{Layout, Target};
use nalgebra::DVector;

/// The points of Gauss's quadrature with two values on 0..1, each with half of the weight.
const POINTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// The effort of the hinges of a sheet in a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SheetEffort {
    /// The sum over all hinges of the mean of their absolute torque, N·m.
    pub energy: f64,
    /// The greatest torque of a hinge, N·m.
    pub peak: f64,
}

/// Returns the effort of a motion of all creases; `tree`: a layout of the folded form `target`, whose root is held. `masses`:
/// those of the panels (kg), even polygons without thickness; `gravity`: the vector (m/s²) in the frame of the target.
pub(super) fn effort(
    target: &Target,
    (loops, tree): (&Loops, &Layout),
    (masses, gravity): (&[f64], Vec3),
    keyframes: &Keyframes,
) -> SheetEffort {
    let bodies = Body::of_target(target, masses, Inertia::Lamina);
    let mut dynamics = Dynamics::new(target, tree, &bodies, gravity);
    let mut by_face = vec![0.0; target.faces.len()];
    let creases = target.hinges.len();
    let pieces = keyframes.first().map_or(0, |track| track.len() - 1);
    let mut effort = SheetEffort::default();
    for piece in 0..pieces {
        crate::interrupt::checkpoint();
        for part in POINTS {
            let motion: Vec<Hinging> =
                keyframes.iter().map(|track| within(&track[piece], &track[piece + 1], part)).collect();
            let of_face = |face: usize| tree.hinge[face].map_or(Hinging::default(), |hinge| motion[hinge]);
            dynamics.torques(of_face, &mut by_face);
            let mut torques = DVector::zeros(creases);
            for (face, torque) in by_face.iter().enumerate() {
                if let Some(hinge) = tree.hinge[face] {
                    torques[hinge] = *torque;
                }
            }
            let angles: Vec<f64> = motion.iter().map(|hinging| hinging.angle).collect();
            let torques = free_part(&loops.jacobian(&angles), &torques).unwrap_or(torques);
            effort.energy += torques.iter().map(|torque| torque.abs()).sum::<f64>();
            effort.peak = effort.peak.max(torques.amax());
        }
    }
    effort.energy /= (pieces * POINTS.len()).max(1) as f64;
    effort
}

/// Returns the motion at a part (0 to 1) of the way between two keyframes, on the cubic through both.
fn within(from: &[f64; 3], to: &[f64; 3], part: f64) -> Hinging {
    let [start, angle, speed] = *from;
    let [end, next, next_speed] = *to;
    let time = end - start;
    // The coefficients of the cubic in the part.
    let (first, turn) = (speed * time, next - angle);
    let second = 3.0 * turn - (2.0 * speed + next_speed) * time;
    let third = (speed + next_speed) * time - 2.0 * turn;
    Hinging {
        angle: angle + part * (first + part * (second + part * third)),
        speed: (first + part * (2.0 * second + part * 3.0 * third)) / time,
        acceleration: (2.0 * second + 6.0 * part * third) / (time * time),
    }
}
