//! The robot as the planner sees it: modules of two shoes, each shoe a ball of diameter 1 with three
//! docks, and three joints between them. Lengths are in parts of the pitch.

use crate::geometry::rigid_transform::{rotation_x, rotation_z};
use crate::geometry::{RigidTransform, Vec3};
use nalgebra::Matrix3;
use std::f64::consts::FRAC_PI_2;

/// The joints of a module by their places in [`Robot::joints`].
pub const ALPHA: usize = 0;
pub const BETA: usize = 1;
pub const GAMMA: usize = 2;

/// Docks of a module: those of shoe A, then those of shoe B.
pub const DOCKS: usize = 6;
/// +X, -X and -Z of a shoe.
pub const FACES: usize = 3;
/// The dock at the end of a shoe: the paper's red connector.
pub const RED: usize = 2;

/// A dock of a module: 0 to 5, by shoe and then by face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dock {
    pub module: usize,
    pub dock: usize,
}

/// Two docks that hold each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bond {
    pub a: Dock,
    pub b: Dock,
    /// In quarter turns: 0 is N, 1 E, 2 S, 3 W.
    pub turn: u32,
}

/// A configuration. A bond that is let go stays in the list, and does not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// alpha, beta and gamma of each module, rad.
    pub joints: Vec<[f64; 3]>,
    pub bonds: Vec<Bond>,
    pub holds: Vec<bool>,
}

impl Dock {
    /// The shoe that carries it: twice the module, and one more for shoe B.
    pub fn shoe(self) -> usize {
        2 * self.module + self.dock / FACES
    }

    pub fn face(self) -> usize {
        self.dock % FACES
    }

    pub fn is_red(self) -> bool {
        self.face() == RED
    }

    /// The red dock of a shoe.
    pub fn red(shoe: usize) -> Dock {
        Dock { module: shoe / 2, dock: shoe % 2 * FACES + RED }
    }
}

impl Bond {
    /// Whether it is one of a snake: two red docks in orientation N.
    pub fn is_good(&self) -> bool {
        self.a.is_red() && self.b.is_red() && self.turn == 0
    }
}

impl Robot {
    pub fn modules(&self) -> usize {
        self.joints.len()
    }

    /// The bonds that hold, with their numbers.
    pub fn held(&self) -> impl Iterator<Item = (usize, &Bond)> {
        self.bonds.iter().enumerate().filter(|(index, _)| self.holds[*index])
    }

    /// By module and dock: the bond that holds there.
    pub fn bond_at(&self) -> Vec<[Option<usize>; DOCKS]> {
        let mut at = vec![[None; DOCKS]; self.modules()];
        for (index, bond) in self.held() {
            at[bond.a.module][bond.a.dock] = Some(index);
            at[bond.b.module][bond.b.dock] = Some(index);
        }
        at
    }

    /// How many balls of a chain are beyond the end of a shoe.
    pub fn beyond(&self, shoe: usize) -> usize {
        let at = self.bond_at();
        let (mut shoe, mut count) = (shoe, 0);
        while let Some(bond) = at[shoe / 2][Dock::red(shoe).dock].map(|bond| self.bonds[bond]) {
            let far = if bond.a == Dock::red(shoe) { bond.b } else { bond.a };
            shoe = far.shoe() ^ 1;
            count += 2;
            if count > 2 * self.modules() {
                break; // a ring
            }
        }
        count
    }

    /// The bond of a number is let go.
    pub fn undock(&mut self, bond: usize) {
        self.holds[bond] = false;
    }

    /// A bond begins to hold; gives its number.
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

/// From one shoe of a module to the other. `near` is the tilt at the shoe that it starts from, `far`
/// that at the other: `Rx(near) · Rz(gamma) · T(0, 0, 1) · Ry(180°) · Rx(-far)`.
pub fn across(near: f64, far: f64, gamma: f64) -> RigidTransform {
    let half_turn = Matrix3::new(-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0);
    let tilt = rotation_x(near);
    RigidTransform {
        rotation: tilt * rotation_z(gamma) * half_turn * rotation_x(-far),
        translation: tilt * Vec3::z(),
    }
}

/// From the shoe of face `a` to the shoe of face `b` that is docked to it:
/// `F(a) · Rz(turn) · T(0, 0, -1) · Rx(180°) · F(b)⁻¹`.
pub fn mate(a: usize, turn: u32, b: usize) -> RigidTransform {
    let half_turn = Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0);
    let quarter = rotation_z(FRAC_PI_2 * f64::from(turn)).map(libm::round);
    let frame = face(a);
    RigidTransform {
        rotation: frame * quarter * half_turn * face(b).transpose(),
        translation: -frame.column(2).into_owned(),
    }
}

/// The frame of a dock's face against its shoe; the outward normal is its -z.
fn face(face: usize) -> Matrix3<f64> {
    match face {
        0 => Matrix3::new(0.0, 0.0, -1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0),
        1 => Matrix3::new(0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0),
        _ => Matrix3::identity(),
    }
}
