//! Graph isomorphism of robots: two are the same but for the names of their modules if there is a map that keeps module
//! types, ports, turns and joint positions, where a module may lie turned round if it is the same then.
//!
//! A connected robot is explored from one module along its bonds, and a bond leaves by a known port:
//! so the image of one module fixes all others. Every image of the first module is tried in turn,
//! which takes time in the square of the number of modules at worst.

use super::assembly::{Assembly, JointOwner, PortRef, State};
use super::kinematics::Kinematics;
use super::library::{JointKind, Library};
use super::symmetry::{Symmetry, symmetries};
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// An isomorphism from robot B to robot A: the images of its modules, bonds and joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Matching {
    /// The index of the module of A for each module of B, in the order of B's.
    pub modules: Vec<usize>,
    /// The symmetry by which each module of B lies in its image, in the order of B's modules.
    pub turned: Vec<Symmetry>,
    /// The index of the bond of A for each bond of B, in the order of B's; `None` for bonds that do not hold.
    pub bonds: Vec<Option<usize>>,
    /// The offset from each joint's position in B to that in A, by the number in its [`JointId`](super::JointId) in B,
    /// rad or m: whole turns, and 0 for joints with limits, fixed joints and mimics.
    pub offsets: Vec<f64>,
}

impl Matching {
    /// Returns the image in A of a port of B, both by index of the module and of the port in its type. Panics if B
    /// has no such module or port.
    pub fn port(&self, port: PortRef) -> PortRef {
        let turned = &self.turned[port.module];
        PortRef { module: self.modules[port.module], port: turned.ports[port.port] }
    }

    /// Returns the image in A of a joint of a module of B, given by their indices, as (module, joint): the index of
    /// the module in A, and that of the joint in its type. Panics if B has no such module or joint.
    pub fn joint(&self, module: usize, joint: usize) -> (usize, usize) {
        (self.modules[module], self.turned[module].joints[joint])
    }
}

/// The reason that robot B does not match robot A; modules are given by path name.
#[derive(Clone, Debug, PartialEq)]
pub enum Mismatch {
    /// The robots have different numbers of modules, or none.
    Count {
        /// The number of modules of A.
        a: usize,
        /// The number of modules of B.
        b: usize,
    },
    /// B is not connected, so that the bonds do not identify the modules.
    Pieces,
    /// A module of B is of another type than the module of A that the best attempt maps it to.
    Kind {
        /// The path name of the module in B.
        module: String,
        /// The name of the type of the module in B.
        kind: String,
    },
    /// One of two modules that the best attempt maps to each other is docked at a port and the other not, or to
    /// another port or with another turn.
    Bond {
        /// The path name of the module in A.
        a: String,
        /// The path name of the module in B.
        b: String,
        /// The name of the port of the module in B.
        port: String,
    },
    /// The positions of two joints differ in the best attempt by more than the tolerance.
    Joint {
        /// The path name of the joint in A.
        a: String,
        /// The path name of the joint in B.
        b: String,
        /// The position of the joint in A, rad or m.
        a_position: f64,
        /// The position of the joint in B, rad or m.
        b_position: f64,
    },
}

impl std::fmt::Display for Mismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Mismatch::Count { a, b } => write!(f, "one has {a} modules, the other {b}"),
            Mismatch::Pieces => write!(f, "the second robot is not in one piece"),
            Mismatch::Kind { module, kind } => {
                write!(f, "`{module}` is a `{kind}`, which the first robot lacks there")
            }
            Mismatch::Bond { a, b, port } => {
                write!(f, "at `{port}`, `{a}` and `{b}` are not docked to the same")
            }
            Mismatch::Joint { a, b, a_position, b_position } => {
                write!(f, "`{a}` is at {a_position:.6}, `{b}` at {b_position:.6}")
            }
        }
    }
}

/// Finds an isomorphism from robot `b`, in its state, to robot `a`, in its own: a map of modules that keeps module
/// types, ports, turns and joint positions. Joint positions agree within `tol_joint` (rad or m), those of endless
/// joints up to whole turns. Of several, the one that maps the first module of B to a module of the same name is
/// preferred. Every image of the first module is tried, in quadratic time in the number of modules. Of several clusters
/// with poses, the others are matched by the name of their first module.
///
/// # Errors
/// The first difference in the attempt that mapped the most modules, or [`Mismatch::Count`] if they have different
/// numbers of modules, or none.
pub fn matching(
    a: (&Assembly, &State),
    b: (&Assembly, &State),
    tol_joint: f64,
) -> Result<Matching, Mismatch> {
    let count = (a.0.modules.len(), b.0.modules.len());
    if count.0 != count.1 || count.0 == 0 {
        return Err(Mismatch::Count { a: count.0, b: count.1 });
    }
    let turns = b.0.library.modules.iter().map(symmetries).collect();
    let search = Search { a: Side::new(a.0, a.1), b: Side::new(b.0, b.1), turns, tol_joint };
    // The module of the same name first: names are kept where they can be.
    let first = &b.0.modules[0];
    let same_name = a.0.modules.iter().position(|m| m.name == first.name);
    let others = (0..count.0).filter(|i| Some(*i) != same_name);
    let mut best: Option<(usize, Mismatch)> = None;
    for image in same_name.into_iter().chain(others) {
        for turn in &search.turns[b.0.modules[0].kind] {
            match search.from(image, turn) {
                Ok(found) => return Ok(found),
                Err((reached, mismatch)) => {
                    if best.as_ref().is_none_or(|(most, _)| reached > *most) {
                        best = Some((reached, mismatch));
                    }
                }
            }
        }
    }
    Err(best.expect("there is at least one module").1)
}

/// Returns true if two module types are the same but for the numbering of their connectors.
pub(super) fn same_kind(a: (&Library, usize), b: (&Library, usize)) -> bool {
    let (of_a, of_b) = (&a.0.modules[a.1], &b.0.modules[b.1]);
    if std::ptr::eq(of_a, of_b) {
        return true;
    }
    let mut renumbered = of_b.clone();
    for (port, like) in renumbered.ports.iter_mut().zip(&of_a.ports) {
        let (x, y) = (&a.0.connectors[like.connector], &b.0.connectors[port.connector]);
        if x.name != y.name || x.turns != y.turns || x.hinge != y.hinge {
            return false;
        }
        port.connector = like.connector;
    }
    *of_a == renumbered
}

/// The port that is docked at a port, and its turn.
#[derive(Clone, Copy)]
struct Docked {
    module: usize,
    port: usize,
    turn: u32,
    bond: usize,
    /// True if this port is the first of the bond; kept only where that matters, in hinges.
    leads: Option<bool>,
}

/// A robot in a state, prepared for exploring.
struct Side<'a> {
    robot: &'a Assembly,
    state: &'a State,
    kinematics: Kinematics,
    /// The port docked to each port, by module and port.
    docked: Vec<Vec<Option<Docked>>>,
}

impl<'a> Side<'a> {
    fn new(robot: &'a Assembly, state: &'a State) -> Side<'a> {
        let ports = |m| vec![None; robot.module_type(m).ports.len()];
        let mut docked: Vec<Vec<Option<Docked>>> = (0..robot.modules.len()).map(ports).collect();
        for (index, bond) in robot.bonds.iter().enumerate().filter(|(i, _)| state.bonds[*i]) {
            for (here, there, leads) in [(bond.a, bond.b, true), (bond.b, bond.a, false)] {
                let leads = robot.hinge(index).map(|_| leads);
                let (module, port, turn) = (there.module, there.port, bond.turn);
                docked[here.module][here.port] = Some(Docked { module, port, turn, bond: index, leads });
            }
        }
        Side { robot, state, kinematics: Kinematics::new(robot, &state.bonds, 0), docked }
    }

    fn name(&self, module: usize) -> String {
        self.robot.modules[module].name.clone()
    }
}

struct Search<'a> {
    a: Side<'a>,
    b: Side<'a>,
    /// The symmetries of each module type of B.
    turns: Vec<Vec<Symmetry>>,
    tol_joint: f64,
}

impl<'a> Search<'a> {
    /// Tries one image of the first module of B with one symmetry; otherwise returns the number of modules
    /// that agreed, and the first difference.
    fn from(&self, image: usize, turn: &Symmetry) -> Result<Matching, (usize, Mismatch)> {
        let n = self.b.robot.modules.len();
        let mut images: Vec<Option<(usize, &Symmetry)>> = vec![None; n];
        let mut taken = vec![false; n];
        let mut found = Matching {
            modules: vec![],
            turned: vec![],
            bonds: vec![None; self.b.robot.bonds.len()],
            offsets: vec![0.0; self.b.state.joints.len()],
        };
        (images[0], taken[image]) = (Some((image, turn)), true);
        let mut queue = VecDeque::from([0]);
        let mut reached = 0;
        // A joint at another position does not end the attempt: if the rest fits, the difference is worth reporting.
        let mut elsewhere: Option<Mismatch> = None;
        // Breadth-first search along the bonds of B; at every port the image must be docked alike.
        while let Some(x) = queue.pop_front().or_else(|| self.next_cluster(&mut images, &mut taken)) {
            let (y, turned) = images[x].expect("what is queued has an image");
            self.same_type(x, y).map_err(|mismatch| (reached, mismatch))?;
            elsewhere = elsewhere.or(self.joints((x, y), turned, &mut found).err());
            reached += 1;
            for port in 0..self.b.docked[x].len() {
                let (here, there) = (self.b.docked[x][port], self.a.docked[y][turned.ports[port]]);
                let (Some(u), Some(v)) = (here, there) else {
                    if here.is_some() != there.is_some() {
                        return Err((reached, self.differ(x, y, port)));
                    }
                    continue;
                };
                // The image of the neighbour is known, or it takes the symmetry that maps its port to the one docked
                // in A.
                let kind = self.b.robot.modules[u.module].kind;
                let image = match images[u.module] {
                    Some((module, turned)) => (module == v.module).then_some(turned),
                    None if taken[v.module] => None,
                    None => self.turns[kind].iter().find(|turned| turned.ports[u.port] == v.port),
                };
                let image = image.filter(|turned| turned.ports[u.port] == v.port);
                let Some(image) = image.filter(|_| u.turn == v.turn && u.leads == v.leads) else {
                    return Err((reached, self.differ(x, y, port)));
                };
                elsewhere = elsewhere.or(self.hinge(u.bond, v.bond, &mut found).err());
                found.bonds[u.bond] = Some(v.bond);
                if images[u.module].is_none() {
                    (images[u.module], taken[v.module]) = (Some((v.module, image)), true);
                    queue.push_back(u.module);
                }
            }
        }
        // If a module of B has no image, no bonds lead to it.
        let images: Vec<(usize, &Symmetry)> =
            images.into_iter().collect::<Option<_>>().ok_or((reached, Mismatch::Pieces))?;
        found.modules = images.iter().map(|(module, _)| *module).collect();
        found.turned = images.iter().map(|(_, turned)| (*turned).clone()).collect();
        elsewhere.map_or(Ok(found), |mismatch| Err((reached, mismatch)))
    }

    /// Gives the first module of B that bonds do not lead to the image of its name, as it lies, if several clusters have
    /// poses in either state: nothing else tells equal robots apart. Returns that module; `None` if there is none.
    fn next_cluster<'s>(
        &'s self,
        images: &mut [Option<(usize, &'s Symmetry)>],
        taken: &mut [bool],
    ) -> Option<usize> {
        if self.a.state.clusters.is_empty() && self.b.state.clusters.is_empty() {
            return None;
        }
        let x = images.iter().position(Option::is_none)?;
        let module = &self.b.robot.modules[x];
        let y = self.a.robot.modules.iter().position(|other| other.name == module.name)?;
        let as_it_lies = |turned: &&Symmetry| turned.ports.iter().enumerate().all(|(port, to)| port == *to);
        let turned = self.turns[module.kind].iter().find(as_it_lies)?;
        if std::mem::replace(&mut taken[y], true) {
            return None;
        }
        images[x] = Some((y, turned));
        Some(x)
    }

    fn same_type(&self, x: usize, y: usize) -> Result<(), Mismatch> {
        let (a, b) = (self.a.robot, self.b.robot);
        if !same_kind((&a.library, a.modules[y].kind), (&b.library, b.modules[x].kind)) {
            return Err(Mismatch::Kind { module: self.b.name(x), kind: b.module_type(x).name.clone() });
        }
        Ok(())
    }

    /// Compares the joint positions of a module of B and one of A of the same type.
    fn joints(
        &self,
        (x, y): (usize, usize),
        turned: &Symmetry,
        found: &mut Matching,
    ) -> Result<(), Mismatch> {
        for (index, joint) in self.b.robot.module_type(x).joints.iter().enumerate() {
            if joint.kind == JointKind::Fixed || joint.mimic.is_some() {
                continue;
            }
            let endless = joint.kind == JointKind::Revolute && joint.limits.range.is_none();
            let image = turned.joints[index];
            let (at_a, at_b) = (self.a.kinematics.joint(y, image), self.b.kinematics.joint(x, index));
            let name = |side: &Side, module, joint: usize| {
                format!("{}.{}", side.name(module), side.robot.module_type(module).joints[joint].name)
            };
            let (in_a, in_b) = (name(&self.a, y, image), name(&self.b, x, index));
            self.joint((at_a, in_a), (at_b, in_b), endless, found)?;
        }
        Ok(())
    }

    fn hinge(&self, bond_b: usize, bond_a: usize, found: &mut Matching) -> Result<(), Mismatch> {
        let (Some(at_a), Some(at_b)) = (self.a.kinematics.hinge(bond_a), self.b.kinematics.hinge(bond_b))
        else {
            return Ok(());
        };
        let name = |side: &Side, bond| side.robot.joint_name(JointOwner::Bond(bond));
        let endless = self.b.robot.hinge(bond_b).is_some_and(|h| h.limits.range.is_none());
        self.joint((at_a, name(&self.a, bond_a)), (at_b, name(&self.b, bond_b)), endless, found)
    }

    fn joint(
        &self,
        a: (usize, String),
        b: (usize, String),
        endless: bool,
        found: &mut Matching,
    ) -> Result<(), Mismatch> {
        let (p, q) = (self.a.state.joints[a.0], self.b.state.joints[b.0]);
        let offset = if endless { libm::round((p - q) / TAU) * TAU } else { 0.0 };
        if (p - q - offset).abs() > self.tol_joint {
            return Err(Mismatch::Joint { a: a.1, b: b.1, a_position: p, b_position: q });
        }
        found.offsets[b.0] = offset;
        Ok(())
    }

    fn differ(&self, x: usize, y: usize, port: usize) -> Mismatch {
        let port = self.b.robot.module_type(x).ports[port].name.clone();
        Mismatch::Bond { a: self.a.name(y), b: self.b.name(x), port }
    }
}
