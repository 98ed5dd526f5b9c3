//! A second replay of plans of RoFI modules: with the formulas of the RoFI project, in steps of at most a
//! degree, and with arithmetic of its own.
#![allow(non_snake_case)]

use modl::plan::{DockingKind, Tracks};
use modl::robot::{Bond, PortRef};
use std::f64::consts::{FRAC_PI_2, PI};

/// Balls nearer than this part of the pitch are in each other.
const APART: f64 = 0.999;

/// Docks that hold are off by no more than this, in parts of the pitch or entries of a turn's matrix.
const TOL_DOCK: f64 = 1e-6;

pub struct Replay<'a> {
    tracks: &'a Tracks,
    /// Of each joint.
    track_of: Vec<Option<usize>>,
}

pub type Matrix = [[f64; 4]; 4];

/// How a shoe is found from one that is known.
pub enum Hop {
    /// It is the other of its module.
    Module(usize),
    Mate(Matrix),
}

impl<'a> Replay<'a> {
    pub fn new(tracks: &'a Tracks) -> Replay<'a> {
        let of = |joint: usize| tracks.tracks.iter().position(|track| track.joint.0 as usize == joint);
        Replay { tracks, track_of: (0..tracks.start.joints.len()).map(of).collect() }
    }

    /// Position of a joint, by de Casteljau's construction.
    pub fn position(&self, joint: usize, t: f64) -> f64 {
        let start = self.tracks.start.joints[joint];
        let Some(track) = self.track_of[joint] else { return start };
        let segments = &self.tracks.tracks[track].segments;
        let begun = segments.partition_point(|segment| segment.start <= t);
        let Some(segment) = begun.checked_sub(1).map(|last| &segments[last]) else { return start };
        let u = ((t - segment.start) / (segment.end - segment.start)).min(1.0);
        let mut points = segment.control.clone();
        while points.len() > 1 {
            points = points.windows(2).map(|w| w[0] + u * (w[1] - w[0])).collect();
        }
        points[0]
    }

    pub fn bonds(&self, t: f64, inclusive: bool) -> Vec<bool> {
        let mut bonds = self.tracks.start.bonds.clone();
        for dock in self.tracks.events.iter().filter(|d| d.time < t || (inclusive && d.time == t)) {
            bonds[dock.bond] = dock.kind == DockingKind::Dock;
        }
        bonds
    }

    /// From the first shoe on, by which hop each other is found; an error where the modules do not hang
    /// together.
    pub fn hops(&self, bonds: &[bool], t: f64) -> Result<Vec<(usize, usize, Hop)>, String> {
        let shoes = 2 * self.tracks.robot.modules.len();
        let mut beside: Vec<Vec<(usize, Matrix)>> = vec![Vec::new(); shoes];
        for (bond, _) in self.tracks.robot.bonds.iter().zip(bonds).filter(|(_, holds)| **holds) {
            let (from, to, X) = self.mate(bond);
            beside[from].push((to, X));
            beside[to].push((from, inverse(&X)));
        }
        let mut known = vec![false; shoes];
        known[0] = true;
        let mut order = vec![0];
        let mut hops = Vec::new();
        let mut next = 0;
        while let Some(&from) = order.get(next) {
            next += 1;
            let other = from ^ 1;
            if !known[other] {
                known[other] = true;
                order.push(other);
                hops.push((from, other, Hop::Module(from / 2)));
            }
            for (to, X) in &beside[from] {
                if !known[*to] {
                    known[*to] = true;
                    order.push(*to);
                    hops.push((from, *to, Hop::Mate(*X)));
                }
            }
        }
        if order.len() == shoes { Ok(hops) } else { Err(format!("at {t} it is in pieces")) }
    }

    /// Poses of both shoes of every module in units of the pitch, the first at the origin.
    pub fn shoes(&self, t: f64, hops: &[(usize, usize, Hop)]) -> Vec<Matrix> {
        let mut shoes = vec![[[0.0; 4]; 4]; 2 * self.tracks.robot.modules.len()];
        shoes[0] = shift(0.0);
        for (from, to, hop) in hops {
            let X = match hop {
                Hop::Mate(X) => *X,
                Hop::Module(module) => {
                    let [alpha, gamma, beta] = [0, 1, 2].map(|joint| self.position(3 * module + joint, t));
                    let X = across(alpha, beta, gamma);
                    if from % 2 == 0 { X } else { inverse(&X) }
                }
            };
            shoes[*to] = times(&shoes[*from], &X);
        }
        shoes
    }

    /// The shoes of a bond, and the pose of the second against the first.
    fn mate(&self, bond: &Bond) -> (usize, usize, Matrix) {
        let robot = &self.tracks.robot;
        let shoe = |port: PortRef| {
            let name = &robot.module_type(port.module).ports[port.port].name;
            (2 * port.module + usize::from(name.starts_with('b')), face(&name[2..]))
        };
        let ((from, F), (to, G)) = (shoe(bond.a), shoe(bond.b));
        let quarter = about_z(FRAC_PI_2 * f64::from(bond.turn));
        let X = times(&times(&times(&F, &quarter), &shift(-1.0)), &times(&about_x(PI), &inverse(&G)));
        (from, to, X)
    }

    /// Walks through the whole plan.
    pub fn judge(&self) -> Result<(), String> {
        let mut instants: Vec<f64> = self.tracks.instants();
        instants.dedup();
        for ends in instants.windows(2) {
            let farthest = (0..self.tracks.start.joints.len())
                .map(|joint| (self.position(joint, ends[1]) - self.position(joint, ends[0])).abs())
                .fold(0.0, f64::max);
            // Smooth motions are up to twice as fast as on average.
            let steps = (2.0 * farthest.to_degrees()).ceil().max(1.0) as usize;
            let bonds = self.bonds(ends[0], true);
            let hops = self.hops(&bonds, ends[0])?;
            for step in 0..=steps {
                let t = ends[0] + (ends[1] - ends[0]) * step as f64 / steps as f64;
                self.state(t, &bonds, &hops)?;
            }
            // At the instant of docking both the old and the new bonds meet.
            let mut both = self.bonds(ends[1], false);
            for dock in self.tracks.events.iter().filter(|d| d.time == ends[1] && d.kind == DockingKind::Dock)
            {
                both[dock.bond] = true;
            }
            self.state(ends[1], &both, &hops)?;
        }
        Ok(())
    }

    /// One state: limits kept, docks that hold meet, no two balls in each other.
    fn state(&self, t: f64, bonds: &[bool], hops: &[(usize, usize, Hop)]) -> Result<(), String> {
        for module in 0..self.tracks.robot.modules.len() {
            for tilt in [3 * module, 3 * module + 2] {
                if self.position(tilt, t).abs() > FRAC_PI_2 + 1e-9 {
                    return Err(format!("at {t} a tilt is beyond its range"));
                }
            }
        }
        let shoes = self.shoes(t, hops);
        for (bond, _) in self.tracks.robot.bonds.iter().zip(bonds).filter(|(_, holds)| **holds) {
            let (from, to, X) = self.mate(bond);
            let (wanted, found) = (times(&shoes[from], &X), &shoes[to]);
            let missing =
                (0..16).map(|i| (wanted[i / 4][i % 4] - found[i / 4][i % 4]).abs()).fold(0.0, f64::max);
            if missing > TOL_DOCK {
                return Err(format!("at {t} docks are {missing} apart"));
            }
        }
        let centres: Vec<[f64; 3]> = shoes.iter().map(|s| [s[0][3], s[1][3], s[2][3]]).collect();
        for (i, a) in centres.iter().enumerate() {
            for b in &centres[i + 1..] {
                let squared: f64 = (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum();
                if squared < APART * APART {
                    return Err(format!("at {t} balls are {} apart", squared.sqrt()));
                }
            }
        }
        Ok(())
    }

    /// One chain of all modules over red docks in orientation N, straight.
    pub fn ends_as_snake(&self) -> Result<(), String> {
        let (robot, end) = (&self.tracks.robot, self.tracks.duration);
        let holding = self.bonds(end, true);
        let held: Vec<_> = robot.bonds.iter().zip(&holding).filter(|(_, h)| **h).map(|(b, _)| b).collect();
        if held.len() + 1 != robot.modules.len() {
            return Err(format!("{} bonds hold in the end", held.len()));
        }
        self.hops(&holding, end)?;
        for bond in held {
            let red = [bond.a, bond.b]
                .iter()
                .all(|port| robot.module_type(port.module).ports[port.port].name.ends_with("minus_z"));
            if !red || bond.turn != 0 {
                return Err("a bond is none of a snake".into());
            }
        }
        let bent = (0..self.tracks.start.joints.len()).find(|&joint| {
            let turns = self.position(joint, end) / (2.0 * PI);
            (turns - turns.round()).abs() > 1e-9 || (joint % 3 != 1 && turns.abs() > 1e-9)
        });
        bent.map_or(Ok(()), |joint| Err(format!("joint {joint} is not straight in the end")))
    }
}

/// From shoe A to shoe B of a module, in pitches; angles in rad.
pub fn across(alpha: f64, beta: f64, gamma: f64) -> Matrix {
    let half = [[-1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let first = times(&about_x(alpha), &about_z(gamma));
    times(&times(&first, &shift(1.0)), &times(&half, &about_x(-beta)))
}

/// A turn about x, rad.
pub fn about_x(angle: f64) -> Matrix {
    let (s, c) = libm::sincos(angle);
    [[1.0, 0.0, 0.0, 0.0], [0.0, c, -s, 0.0], [0.0, s, c, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

/// A turn about z, rad.
pub fn about_z(angle: f64) -> Matrix {
    let (s, c) = libm::sincos(angle);
    [[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

/// A shift along z, in pitches.
pub fn shift(z: f64) -> Matrix {
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]]
}

/// RoFI's frame of a dock.
pub fn face(name: &str) -> Matrix {
    match name {
        "plus_x" => {
            [[0.0, 0.0, -1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
        }
        "minus_x" => {
            [[0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
        }
        _ => shift(0.0),
    }
}

/// The product of two matrices.
pub fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let cell = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cell(i, j)))
}

/// The inverse of a rigid motion.
pub fn inverse(a: &Matrix) -> Matrix {
    let back = |i: usize| -> f64 { -(0..3).map(|k| a[k][i] * a[k][3]).sum::<f64>() };
    let row = |i: usize| [a[0][i], a[1][i], a[2][i], back(i)];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}
