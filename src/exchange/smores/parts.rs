//! A robot of SMORES modules as its files state it: modules with places and joint positions, and what is connected.

use super::super::import_fault::ImportFault;
use super::MODULES_MAX;
use super::order::Graph;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// The farthest that two faces may be from each other, m: the capture of their magnets in the library.
const APART_MAX: f64 = 4e-3;
/// The most that two faces may lean against each other, or miss a quarter turn, rad: likewise.
const LEAN_MAX: f64 = 5.0 * PI / 180.0;
/// The parts of both that are rounding in a file.
const ROUNDING: (f64, f64) = (1e-4, 2e-3);

/// A face of a module, in the order of the numbers that the tools give them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Face {
    Top,
    Left,
    Right,
    Bottom,
}

impl Face {
    /// The faces by their numbers.
    pub(super) const ALL: [Face; 4] = [Face::Top, Face::Left, Face::Right, Face::Bottom];

    /// Returns the name of the port in the library.
    pub(super) fn port(self) -> &'static str {
        ["top", "left", "right", "bottom"][self as usize]
    }
}

/// The names of the joints in the library, in the order in which the tools state them.
pub(super) const JOINTS: [&str; 4] = ["front", "left", "right", "tilt"];

/// Returns what is wrong with a tilt, rad, if it is out of the range of the joint; 1.5708 is a quarter turn.
pub(super) fn tilt_fault(tilt: f64) -> Option<String> {
    let out = tilt.abs() > FRAC_PI_2 + 5e-6;
    out.then(|| format!("a tilt of {:.1}°: modules tilt by 90° at most", tilt.to_degrees()))
}

/// A place in a file: line and column, from 1.
pub(super) type Place = (usize, usize);

/// A module of a robot.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// The name in the file.
    pub(super) name: String,
    /// The pose of the chassis in the world of the file, with +z up; m.
    pub(super) X: Pose,
    /// The positions of the joints by the library's signs, rad, in the order of [`JOINTS`].
    pub(super) state: [f64; 4],
}

/// A connection of two faces.
#[derive(Clone, Debug)]
pub(super) struct Bond {
    /// The modules and their faces.
    pub(super) ends: [(usize, Face); 2],
    /// The number of quarter turns between them.
    pub(super) turn: u8,
    /// True if the file's turn is the one that its places want.
    pub(super) stated: bool,
    /// The place where the file states it.
    pub(super) place: Place,
}

/// A robot of a file.
#[derive(Clone, Debug)]
pub(super) struct Robot {
    pub(super) members: Vec<Member>,
    pub(super) bonds: Vec<Bond>,
    /// The distance between opposite faces, m.
    pub(super) pitch: f64,
    /// The facts that a user has to know, in words.
    pub(super) notes: Vec<String>,
    /// The first module that needs more tilt than the later generation has, if there is one.
    pub(super) wide: Option<String>,
}

/// A motion of a robot, from a file.
pub(super) struct Motion {
    pub(super) file: String,
    pub(super) graph: Graph<Action>,
}

/// The effect of one command, by the library's signs; SI units, radians. A time is `None` where the file states none.
#[derive(Clone, Debug)]
pub(super) enum Action {
    Move { module: usize, joint: usize, to: f64, time: Option<f64> },
    Spin { module: usize, joint: usize, speed: f64, time: f64 },
    Wait(f64),
    Dock([(usize, Face); 2]),
    Undock((usize, Face)),
}

impl Robot {
    pub(super) fn new(pitch: f64) -> Robot {
        Robot { members: Vec::new(), bonds: Vec::new(), pitch, notes: Vec::new(), wide: None }
    }

    /// Returns the index of a module by its name.
    pub(super) fn index(&self) -> BTreeMap<&str, usize> {
        self.members.iter().enumerate().map(|(index, member)| (member.name.as_str(), index)).collect()
    }

    /// Returns the pose of a face in its module's chassis: x out of the face, z its upper mark.
    pub(super) fn face(&self, (module, face): (usize, Face)) -> Pose {
        let [front, left, right, tilt] = self.members[module].state;
        let out = shifted(Vec3::new(self.pitch / 2.0, 0.0, 0.0));
        let about = |axis, angle| turned(axis, angle);
        match face {
            Face::Top => about(Vec3::y(), -tilt) * out * about(Vec3::x(), front),
            Face::Left => about(Vec3::z(), FRAC_PI_2) * out * about(Vec3::x(), left),
            Face::Right => about(Vec3::z(), -FRAC_PI_2) * out * about(Vec3::x(), -right),
            Face::Bottom => about(Vec3::z(), PI) * out,
        }
    }

    /// Returns the pose of the second chassis in the first that a connection means.
    pub(super) fn mate(&self, ends: [(usize, Face); 2], turn: f64) -> Pose {
        let facing = turned(Vec3::z(), PI) * turned(Vec3::x(), turn);
        self.face(ends[0]) * facing * self.face(ends[1]).inverse()
    }

    /// Adds a connection, at the turn that the places of its modules want. `stated`: the turn in the file, rad.
    pub(super) fn connect(
        &mut self,
        ends: [(usize, Face); 2],
        stated: f64,
        place: Place,
    ) -> Result<(), ImportFault> {
        let fault = |message: String| ImportFault { message, line: place.0, column: place.1 };
        let names =
            ends.map(|(module, face)| format!("the {} of `{}`", face.port(), self.members[module].name));
        if ends[0].0 == ends[1].0 {
            return Err(fault(format!("{} and {} are of one module", names[0], names[1])));
        }
        for (end, name) in ends.iter().zip(&names) {
            if self.bonds.iter().any(|bond| bond.ends.contains(end)) {
                return Err(fault(format!("{name} is connected twice")));
            }
        }
        let [a, b] = ends.map(|(module, _)| self.members[module].X);
        // The pose is what is left of the placed mate beyond the one that a connection without a turn means.
        let X = turned(Vec3::z(), -PI) * (a * self.face(ends[0])).inverse() * b * self.face(ends[1]);
        let apart = X.translation.vector.norm();
        let side = X.rotation * Vec3::y();
        let angle = libm::atan2(side.z, side.y);
        let quarter = libm::round(angle / FRAC_PI_2);
        let lean = (X.rotation.inverse() * turned(Vec3::x(), quarter * FRAC_PI_2).rotation).angle();
        if apart > APART_MAX || lean > LEAN_MAX {
            let so = format!("{:.1} mm and {:.1}° from each other", apart * 1e3, lean.to_degrees());
            return Err(fault(format!(
                "{} and {} are connected, but the file places them {so}; 4 mm and 5° off a quarter turn are allowed",
                names[0], names[1]
            )));
        }
        if apart > ROUNDING.0 || lean > ROUNDING.1 {
            self.notes.push(format!(
                "{} and {} are {:.1} mm and {:.1}° from each other in the file, and are put together",
                names[0],
                names[1],
                apart * 1e3,
                lean.to_degrees()
            ));
        }
        let turn = (quarter as i64).rem_euclid(4) as u8;
        let stated = libm::round(stated / FRAC_PI_2) as i64;
        self.bonds.push(Bond { ends, turn, stated: stated.rem_euclid(4) as u8 == turn, place });
        Ok(())
    }

    /// Checks that the robot is one, and tells what the file's turns are not.
    pub(super) fn check_bonds(&mut self) -> Result<(), ImportFault> {
        if self.members.is_empty() {
            return Err(ImportFault::of_file("there are no modules"));
        }
        if self.members.len() > MODULES_MAX {
            let message = format!("{} modules are more than {MODULES_MAX}", self.members.len());
            return Err(ImportFault::of_file(message));
        }
        let reached = self.reached();
        if let Some(alone) = reached.iter().position(|reached| !reached) {
            let (first, alone) = (&self.members[0].name, &self.members[alone].name);
            let message =
                format!("nothing connects `{alone}` with `{first}`, and a configuration hangs together");
            return Err(ImportFault::of_file(message));
        }
        let wrong: Vec<&Bond> = self.bonds.iter().filter(|bond| !bond.stated).collect();
        if let Some(first) = wrong.first() {
            self.notes.push(format!(
                "the places of the modules want other turns than {} of {} connections state, the first at line {}: those of \
                 the places are written",
                wrong.len(),
                self.bonds.len(),
                first.place.0
            ));
        }
        Ok(())
    }

    /// Returns of each module whether connections lead to it from the first.
    fn reached(&self) -> Vec<bool> {
        let mut near = vec![Vec::new(); self.members.len()];
        for [(a, _), (b, _)] in self.bonds.iter().map(|bond| bond.ends) {
            near[a].push(b);
            near[b].push(a);
        }
        let mut reached = vec![false; self.members.len()];
        let mut next = vec![0];
        while let Some(module) = next.pop() {
            if !std::mem::replace(&mut reached[module], true) {
                next.extend(&near[module]);
            }
        }
        reached
    }

    /// Returns the index of the module that is drawn upright: of those that the file places upright the one nearest to the
    /// middle; `None` if it places none so.
    pub(super) fn upright(&self) -> Option<usize> {
        let places = self.members.iter().map(|member| member.X.translation.vector);
        let middle = places.clone().sum::<Vec3>() / self.members.len() as f64;
        let lean = |member: &Member| crate::geometry::pose::lean(&member.X.rotation);
        let upright = (0..self.members.len()).filter(|index| lean(&self.members[*index]) < LEAN_MAX);
        let away: Vec<f64> = places.map(|place| (place - middle).norm()).collect();
        upright.min_by(|a, b| away[*a].total_cmp(&away[*b]))
    }
}
