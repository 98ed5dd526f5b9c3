//! The robot as the planner sees it: modules of two shoes, each shoe a ball of diameter 1 with three
//! docks, and three joints between them. Lengths are in pitches, angles in radians.

use crate::geometry::rigid_transform::rotation_z;
use crate::geometry::{RigidTransform, Vec3, sin_cos};
use nalgebra::Matrix3;
use std::f64::consts::FRAC_PI_2;

/// The index in a module's entry of [`Robot::joints`] of the tilt of shoe A against its body, within ±π/2 rad.
pub const ALPHA: usize = 0;
/// The index in a module's entry of [`Robot::joints`] of the tilt of shoe B against its body, within ±π/2 rad.
pub const BETA: usize = 1;
/// The index in a module's entry of [`Robot::joints`] of the twist of the two bodies against each other, rad, without
/// limits.
pub const GAMMA: usize = 2;

/// The number of docks of a module: those of shoe A at indices 0 to 2, then those of shoe B.
pub const DOCKS: usize = 6;
/// The number of docks of a shoe: +X, -X and -Z, in that order.
pub const FACES: usize = 3;
/// The index among the docks of a shoe, 0 to 2, of the dock -Z at its end: the red connector of [Mrázek et
/// al.](super).
pub const RED: usize = 2;

/// A dock of a module, numbered through both of its shoes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dock {
    /// The index of the module in [`Robot::joints`], from 0.
    pub module: usize,
    /// The number of the dock, 0 to 5: [`FACES`] times 0 for shoe A or 1 for shoe B, plus 0 for +X, 1 for -X, [`RED`]
    /// for -Z.
    pub dock: usize,
}

/// A bond: two docks that are docked to each other, or were.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bond {
    /// The first dock of the bond.
    pub a: Dock,
    /// The second dock of the bond.
    pub b: Dock,
    /// The turn about the common normal in quarter turns: 0 is north (N), 1 east (E), 2 south (S), 3 west (W).
    pub turn: u32,
}

/// A configuration of RoFI modules: joint positions and bonds.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// The positions of alpha, beta and gamma of each module, rad; the index of a module here, from 0, names it in
    /// the whole planner.
    pub joints: Vec<[f64; 3]>,
    /// The bonds of the robot, closed and open ones.
    pub bonds: Vec<Bond>,
    /// The flag of each bond of [`Robot::bonds`]: true if it is closed.
    pub holds: Vec<bool>,
}

impl Dock {
    /// Returns the number of the shoe that carries the dock: twice the module's index, plus one for shoe B.
    pub fn shoe(self) -> usize {
        2 * self.module + self.dock / FACES
    }

    /// Returns the face of the shoe that carries the dock: 0 for +X, 1 for -X, [`RED`] for -Z.
    pub fn face(self) -> usize {
        self.dock % FACES
    }

    /// Returns true for a dock -Z, one of the two of each module by which modules form a snake.
    pub fn is_red(self) -> bool {
        self.face() == RED
    }

    /// Returns the dock -Z of a shoe, given by the number of the shoe ([`Dock::shoe`]).
    pub fn red(shoe: usize) -> Dock {
        Dock { module: shoe / 2, dock: shoe % 2 * FACES + RED }
    }
}

impl Bond {
    /// Returns true if a snake may have this bond: it is between two docks -Z, without a turn (orientation N).
    pub fn is_snake_bond(&self) -> bool {
        self.a.is_red() && self.b.is_red() && self.turn == 0
    }
}

impl Robot {
    /// Returns the number of modules of the robot.
    pub fn modules(&self) -> usize {
        self.joints.len()
    }

    /// Returns the closed bonds as (index in [`Robot::bonds`], bond), ascending.
    pub fn held(&self) -> impl Iterator<Item = (usize, &Bond)> {
        self.bonds.iter().enumerate().filter(|(index, _)| self.holds[*index])
    }

    /// Returns for each module and each of its docks, 0 to 5 as in [`Dock::dock`], the index in [`Robot::bonds`] of
    /// the closed bond there; `None` for a free dock.
    pub fn bond_at(&self) -> Vec<[Option<usize>; DOCKS]> {
        let mut at = vec![[None; DOCKS]; self.modules()];
        for (index, bond) in self.held() {
            at[bond.a.module][bond.a.dock] = Some(index);
            at[bond.b.module][bond.b.dock] = Some(index);
        }
        at
    }

    /// Returns the number of balls of the chain that is docked to the dock -Z of a shoe, given by its number
    /// ([`Dock::shoe`]): two for each module. The chain goes on from the dock -Z of each module's other shoe. For a
    /// ring the number is greater than that of all balls of the robot. Panics if there is no such shoe.
    pub fn beyond(&self, shoe: usize) -> usize {
        let at = self.bond_at();
        let (mut shoe, mut count) = (shoe, 0);
        while let Some(bond) = at[shoe / 2][Dock::red(shoe).dock].map(|bond| self.bonds[bond]) {
            let far = if bond.a == Dock::red(shoe) { bond.b } else { bond.a };
            shoe = far.shoe() ^ 1;
            count += 2;
            if count > 2 * self.modules() {
                break;
            }
        }
        count
    }

    /// Opens the bond of an index in [`Robot::bonds`]. Panics if there is none.
    pub fn undock(&mut self, bond: usize) {
        self.holds[bond] = false;
    }

    /// Closes a bond and returns its index in [`Robot::bonds`]: that of the same bond in the list, with its docks in
    /// either order, or a new one at the end of the list. It is not checked that its docks are free.
    pub fn dock(&mut self, bond: Bond) -> usize {
        let same =
            |known: &Bond| *known == bond || (known.a, known.b, known.turn) == (bond.b, bond.a, bond.turn);
        let known = self.bonds.iter().position(same);
        let index = known.unwrap_or_else(|| {
            self.bonds.push(bond);
            self.holds.push(false);
            self.bonds.len() - 1
        });
        self.holds[index] = true;
        index
    }
}

/// Returns the pose of one shoe of a module in the frame of the other, in pitches. `near` is the tilt of the shoe whose
/// frame it is, `far` that of the other, `gamma` the twist between them (rad):
/// `Rx(near) · Rz(gamma) · T(0, 0, 1) · Ry(180°) · Rx(-far)`, multiplied out, for planners ask for it a million times.
pub fn across(near: f64, far: f64, gamma: f64) -> RigidTransform {
    across_by_sines([near, far, gamma].map(sin_cos))
}

/// Returns the pose that [`across`] does, from (sine, cosine) of its three angles.
pub(super) fn across_by_sines([(sn, cn), (sf, cf), (sg, cg)]: [(f64, f64); 3]) -> RigidTransform {
    // Rx(near) · Rz(gamma) · Ry(180°), by rows.
    let turned = [[-cg, -sg, 0.0], [-(cn * sg), cn * cg, sn], [-(sn * sg), sn * cg, -cn]];
    let tilted = turned.map(|[x, y, z]| [x, y * cf - z * sf, y * sf + z * cf]);
    RigidTransform {
        rotation: Matrix3::from_fn(|row, column| tilted[row][column]),
        translation: Vec3::new(0.0, -sn, cn),
    }
}

/// Returns the pose of a shoe docked by face `b` in the frame of the shoe that holds it by face `a`, in pitches:
/// `F(a) · Rz(turn) · T(0, 0, -1) · Rx(180°) · F(b)⁻¹`, with F the frame of a face, `turn` in quarter turns, and faces
/// counted as by [`Dock::face`].
pub fn mate(a: usize, turn: u32, b: usize) -> RigidTransform {
    let half_turn = Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0);
    let quarter = rotation_z(FRAC_PI_2 * f64::from(turn)).map(libm::round);
    let frame = face(a);
    RigidTransform {
        rotation: frame * quarter * half_turn * face(b).transpose(),
        translation: -frame.column(2).into_owned(),
    }
}

/// Returns the frame of a dock's face in the frame of its shoe; the outward normal is its -z.
fn face(face: usize) -> Matrix3<f64> {
    match face {
        0 => Matrix3::new(0.0, 0.0, -1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0),
        1 => Matrix3::new(0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0),
        _ => Matrix3::identity(),
    }
}
