//! Simulation of a folding by inverse dynamics: the torque of every hinge in every step. This is the paper's
//! Alg. 1; where the closed form of `weights` holds, both agree.

use super::dynamics::{Dynamics, Hinging};
use super::inertia::Body;
use super::layout::Layout;
use super::legendre::{Rule, Series, Size, TERMS};
use super::target::Target;
use super::turns::{Turn, turns};
use crate::geometry::Vec3;

/// The duration of a step and the gravity of a simulation.
#[derive(Clone, Copy, Debug)]
pub struct Circumstances {
    /// The duration of a step, s.
    pub step: f64,
    /// The gravity, m/s², along the root's outward normal: the root lies on the ground with its outside down. 0 for
    /// none.
    pub gravity: f64,
}

/// The torques of all hinges in a folding, step by step, as [`simulate`] computes them.
#[derive(Clone, Debug)]
pub struct Torques {
    /// The mean and the peak of the absolute torque of each hinge, N·m: an entry for each step, in their order, with
    /// an entry for each face, which is that of the hinge to its parent; those of the root are 0.
    pub steps: Vec<Vec<Size>>,
}

/// The joints whose torques count in energy and peak torque.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Count {
    /// The joints that move in a step; those that are locked do not count.
    #[default]
    Moving,
    /// All joints, also those that are locked in a step.
    All,
}

/// The middles of the two halves of a step, which are integrated apart: between them the acceleration changes its
/// sign.
const HALVES: [f64; 2] = [0.25, 0.75];

/// Simulates a folding in steps by inverse dynamics (Alg. 1 of [Yao et al.](super)): in each step the hinges of its
/// faces go from level to folded by the quintic law, and all others are locked. Torques are in N·m. `bodies`: one for
/// each face, in the order of [`Target::faces`]; `steps`: for each step the faces (indices) whose hinges fold. `target`
/// and `layout`: the surface and how it is unfolded; `circumstances`: the duration of a step, and gravity.
pub fn simulate(
    target: &Target,
    layout: &Layout,
    bodies: &[Body],
    steps: &[Vec<usize>],
    circumstances: &Circumstances,
) -> Torques {
    simulate_turns(target, layout, bodies, &turns(target, layout, steps, &[]), circumstances)
}

/// Simulates a folding as [`simulate`] does, with hinges that may stop on their way: `turns` has for each step the
/// turns of the hinges that move in it.
pub(super) fn simulate_turns(
    target: &Target,
    layout: &Layout,
    bodies: &[Body],
    turns: &[Vec<Turn>],
    circumstances: &Circumstances,
) -> Torques {
    let rule = Rule::default();
    let faces = bodies.len();
    let gravity: Vec3 = target.normal(layout.root) * circumstances.gravity;
    let mut dynamics = Dynamics::new(target, layout, bodies, gravity);
    let mut hinging = vec![Hinging::default(); faces];
    let mut values = vec![[0.0; TERMS]; faces];
    let mut torques = vec![0.0; faces];
    let mut all = Vec::with_capacity(turns.len());
    for step in turns {
        crate::interrupt::checkpoint();
        let mut sizes = vec![Size::default(); faces];
        for middle in HALVES {
            // Inverse dynamics at the Gauss points of half a step.
            for (i, point) in rule.points.iter().enumerate() {
                let at = quintic(middle + 0.25 * point, circumstances.step);
                for &Turn { face, from, to } in step {
                    let Hinging { angle, speed, acceleration } = at;
                    let by = to - from;
                    hinging[face] = Hinging {
                        angle: from + by * angle,
                        speed: by * speed,
                        acceleration: by * acceleration,
                    };
                }
                dynamics.torques(|face| hinging[face], &mut torques);
                values.iter_mut().zip(&torques).for_each(|(values, torque)| values[i] = *torque);
            }
            // Mean and peak of the absolute torque, from the Legendre series.
            for (size, values) in sizes.iter_mut().zip(&values) {
                let half = Series::size(&rule.series(values));
                size.mean += half.mean / 2.0;
                size.peak = size.peak.max(half.peak);
            }
        }
        // From here on the hinges of the step are locked.
        for &Turn { face, to, .. } in step {
            hinging[face] = Hinging { angle: to, ..Hinging::default() };
        }
        all.push(sizes);
    }
    Torques { steps: all }
}

/// Returns position (rad), speed (rad/s) and acceleration (rad/s²) of the quintic law from 0 to 1 rad after the part
/// `x` (0 to 1) of the time (s).
pub fn quintic(x: f64, time: f64) -> Hinging {
    Hinging {
        angle: x * x * x * (10.0 - 15.0 * x + 6.0 * x * x),
        speed: 30.0 * x * x * (1.0 - x) * (1.0 - x) / time,
        acceleration: 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (time * time),
    }
}

impl Torques {
    /// Returns the energy (Eq. 5 of [Yao et al.](super)), N·m: the sum over all steps of the mean absolute torques of
    /// the joints that count. `count`: the joints whose torques count; `steps`: those that were simulated.
    pub fn energy(&self, count: Count, steps: &[Vec<usize>]) -> f64 {
        self.counted(count, steps).map(|size| size.mean).sum()
    }

    /// Returns the greatest absolute torque of the joints that count, N·m; 0 without steps. `count`: the joints whose
    /// torques count; `steps`: those that were simulated.
    pub fn peak(&self, count: Count, steps: &[Vec<usize>]) -> f64 {
        self.counted(count, steps).map(|size| size.peak).fold(0.0, f64::max)
    }

    /// Returns the sizes of the torques that count.
    fn counted<'s>(&'s self, count: Count, steps: &'s [Vec<usize>]) -> impl Iterator<Item = &'s Size> {
        self.steps.iter().zip(steps).flat_map(move |(sizes, moving)| {
            let counts = move |face: &usize| count == Count::All || moving.contains(face);
            (0..sizes.len()).filter(counts).map(|face| &sizes[face])
        })
    }
}
