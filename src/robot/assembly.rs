//! A robot as connected modules, and the state it is in: Definitions IV.2 and V.1 of the compositional-design paper
//! (Tosun, Jing, Kress-Gazit and Yim), flattened.
//!
//! A configuration is a tree of parts to a person; here it is a list of modules with path names and a list of bonds
//! between their ports.

use super::library::{Connector, Hinge, JointKind, Library, ModuleType, Servo};
use crate::geometry::Pose;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A robot: modules, and every bond between them that exists at some time. Indices of modules and bonds count from 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Assembly {
    /// The name of the configuration that the program declares.
    pub name: String,
    /// The declarations of module types and connectors that the modules and their ports refer to by index.
    pub library: Arc<Library>,
    /// The modules; a module is referred to by its index here.
    pub modules: Vec<ModuleInstance>,
    /// Every bond that exists at some time; a bond is referred to by its index here, and which of them hold at the
    /// moment is part of the state.
    pub bonds: Vec<Bond>,
    /// The index in `modules` of the base module: its body's pose in the world is part of the state, and is reported.
    pub base: usize,
    /// True if the connections may close loops.
    pub closed: bool,
    /// The misalignments of bonds that joined robots which stood by themselves, as (index of the bond, pose of its second
    /// port in the frame that a perfect mate would give it, m); ascending by bond. Other bonds mate perfectly. The judge
    /// finds them: they are no part of a plan.
    #[serde(skip)]
    pub misalignments: Vec<(usize, Pose)>,
}

/// A module of an assembly: a path name and a module type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModuleInstance {
    /// The path name of the module, such as `leg[2].m[0]`; unique in the assembly.
    pub name: String,
    /// The index of the module's type in [`Library::modules`].
    pub kind: usize,
}

/// A port of a module of the assembly, by index of the module and of the port in the module's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PortRef {
    /// The index of the module in [`Assembly::modules`].
    pub module: usize,
    /// The index of the port in [`ModuleType::ports`](super::ModuleType::ports) of the module's type.
    pub port: usize,
}

/// A bond: port `b` is docked to port `a`. With P at `a` and Q at `b`, `X_PQ = Rz(180°) · Rx(turn · 360° / turns)`
/// with the `turns` of the connector; if that has a hinge at q, `Rot(axis, q)` stands before it ([`Hinge`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bond {
    /// The first port, P.
    pub a: PortRef,
    /// The second port, Q.
    pub b: PortRef,
    /// The turn about the common normal, in steps of 360° divided by the `turns` of the connector: 0 to `turns` - 1.
    pub turn: u32,
}

/// A joint of the assembly: its index, from 0, in the order of [`Assembly::joints`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct JointId(pub u32);

/// The owner of a joint in the assembly: a module or a bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum JointOwner {
    /// A joint of a module. Fixed joints are listed too, so that numbering is plain; they and mimics take no
    /// commands, and what the state holds for them is ignored.
    Module {
        /// Index of the module in [`Assembly::modules`].
        module: usize,
        /// Index of the joint in [`ModuleType::joints`](super::ModuleType::joints) of the module's type.
        joint: usize,
    },
    /// The hinge of the bond of this index in [`Assembly::bonds`].
    Bond(usize),
}

/// The pose of a cluster: modules that bonds connect with each other, and not with the base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClusterPose {
    /// The index in [`Assembly::modules`] of the module whose body's pose stands for that of the cluster.
    pub reference: usize,
    /// The world pose of that body, `X_WR`, in metres.
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
}

/// The error with which a bond docked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Misalignment {
    /// The index of the bond in [`Assembly::bonds`].
    pub bond: usize,
    /// The pose of its second port in the frame that a perfect mate would give it, in metres.
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
}

/// The state of a robot, or of several that are modelled as one assembly of several clusters: the positions of all joints,
/// the bonds that hold, and the pose of the base and of each further cluster.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// The position of each joint by [`JointId`], rad or m; those of fixed joints and mimics are ignored.
    pub joints: Vec<f64>,
    /// One flag for every bond of the assembly: true if it holds.
    pub bonds: Vec<bool>,
    /// The world pose of the base module's body, `X_WB`, in metres.
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub base: Pose,
    /// The poses of the clusters that the base does not belong to, ascending by reference; empty for one robot.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub clusters: Vec<ClusterPose>,
    /// The misalignments of bonds that hold, ascending by bond: those by which robots docked that stood by themselves. Other
    /// bonds mate perfectly.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub misalignments: Vec<Misalignment>,
}

impl Assembly {
    /// Returns the type of the module of an index in [`Assembly::modules`]. Panics if there is no such module.
    pub fn module_type(&self, module: usize) -> &ModuleType {
        &self.library.modules[self.modules[module].kind]
    }

    /// Iterates over the owners of all joints in the order of the joints' ids ([`JointId`]): those of the modules in
    /// order, then the hinges of the bonds whose connectors have one.
    pub fn joints(&self) -> impl Iterator<Item = JointOwner> + '_ {
        let of_modules = (0..self.modules.len()).flat_map(move |module| {
            (0..self.module_type(module).joints.len()).map(move |joint| JointOwner::Module { module, joint })
        });
        let of_bonds = (0..self.bonds.len()).filter(|&b| self.hinge(b).is_some()).map(JointOwner::Bond);
        of_modules.chain(of_bonds)
    }

    /// Returns the index of the module that a joint belongs to; of a bond's hinge, that of its first port. Panics if there
    /// is no such bond.
    pub fn module_of(&self, owner: JointOwner) -> usize {
        match owner {
            JointOwner::Module { module, .. } => module,
            JointOwner::Bond(bond) => self.bonds[bond].a.module,
        }
    }

    /// Returns the name of the link of this number among those of all modules, as in `leg[2].m[0].body`; no text if there
    /// is no such link.
    pub fn link_name(&self, link: usize) -> String {
        let mut rest = link;
        for (module, instance) in self.modules.iter().enumerate() {
            let links = &self.module_type(module).links;
            if rest < links.len() {
                return format!("{}.{}", instance.name, links[rest].name);
            }
            rest -= links.len();
        }
        String::new()
    }

    /// Returns true if a joint takes commands; the hinge of a bond always does, and its index is not checked. Panics if there
    /// is no such module or joint.
    pub fn takes_commands(&self, owner: JointOwner) -> bool {
        match owner {
            JointOwner::Module { module, joint } => self.module_type(module).joints[joint].takes_commands(),
            JointOwner::Bond(_) => true,
        }
    }

    /// Returns the greatest effort of a joint's motor, N·m or N; `None` if none is stated, and for a joint that is
    /// passive or follows others and a bond without a hinge. Panics if there is no such module, joint or bond.
    pub fn effort_limit(&self, owner: JointOwner) -> Option<f64> {
        match owner {
            JointOwner::Module { module, joint } => {
                let declared = &self.module_type(module).joints[joint];
                let own = !declared.passive && declared.mimic.is_none();
                declared.limits.effort.filter(|_| own)
            }
            JointOwner::Bond(bond) => self.hinge(bond).and_then(|hinge| hinge.limits.effort),
        }
    }

    /// Returns the stiffness of a joint's servo, N·m/rad or N/m ([`Servo::stiffness`]). Panics if there is no such
    /// module, joint or bond.
    pub fn servo_stiffness(&self, owner: JointOwner) -> f64 {
        self.servo(owner).stiffness(self.slides(owner), self.effort_limit(owner))
    }

    /// Returns the facts of a joint's servo; none are stated of the hinges of bonds, whose index is not checked. Panics
    /// if there is no such module or joint.
    pub fn servo(&self, owner: JointOwner) -> Servo {
        match owner {
            JointOwner::Module { module, joint } => self.module_type(module).joints[joint].servo,
            JointOwner::Bond(_) => Servo::default(),
        }
    }

    /// Returns true if a joint is prismatic, so that its positions are in metres; those of all others, hinges of bonds
    /// included, are in radians. The index of a bond is not checked. Panics if there is no such module or joint.
    pub fn slides(&self, owner: JointOwner) -> bool {
        match owner {
            JointOwner::Module { module, joint } => {
                self.module_type(module).joints[joint].kind == JointKind::Prismatic
            }
            JointOwner::Bond(_) => false,
        }
    }

    /// Returns the misalignment of a bond, given by its index ([`Assembly::misalignments`]); the identity for one that
    /// mates perfectly.
    pub fn misalignment(&self, bond: usize) -> Pose {
        let known = self.misalignments.binary_search_by_key(&bond, |(bond, _)| *bond);
        known.map_or(Pose::identity(), |index| self.misalignments[index].1)
    }

    /// Returns the hinge of a bond, given by its index: that of the connector at its first port; `None` for a bond
    /// that does not turn. Panics if there is no such bond.
    pub fn hinge(&self, bond: usize) -> Option<&Hinge> {
        self.connector(self.bonds[bond].a).hinge.as_ref()
    }

    /// Returns the connector of a port. Panics if there is no such port.
    pub fn connector(&self, port: PortRef) -> &Connector {
        &self.library.connectors[self.module_type(port.module).ports[port.port].connector]
    }

    /// Returns the greatest pull along the normal (N) and the greatest moment (N·m) that a bond, given by its index,
    /// holds: what the weaker of its two connectors states; `None` where neither states a limit. Panics if there is no
    /// such bond.
    pub fn bond_strength(&self, bond: usize) -> (Option<f64>, Option<f64>) {
        let least = |x: Option<f64>, y: Option<f64>| match (x, y) {
            (Some(x), Some(y)) => Some(x.min(y)),
            (x, y) => x.or(y),
        };
        let Bond { a, b, .. } = self.bonds[bond];
        let (a, b) = (self.connector(a), self.connector(b));
        (least(a.holds_force, b.holds_force), least(a.holds_moment, b.holds_moment))
    }

    /// Returns true if docking draws the ports of a bond, given by its index, together: if one of its connectors does so. Panics
    /// if there is no such bond.
    pub fn snaps(&self, bond: usize) -> bool {
        let Bond { a, b, .. } = self.bonds[bond];
        [a, b].iter().any(|port| self.connector(*port).snaps)
    }

    /// Returns the path name of a joint, such as `leg[2].m[0].tilt`; a bond's hinge is named by its ports, `a.front --
    /// b.back`, also where the bond has none. Panics if there is no such module, joint or bond.
    pub fn joint_name(&self, owner: JointOwner) -> String {
        match owner {
            JointOwner::Module { module, joint } => {
                format!("{}.{}", self.modules[module].name, self.module_type(module).joints[joint].name)
            }
            JointOwner::Bond(bond) => self.bond_name(bond),
        }
    }

    /// Returns the path name of a joint by its id, as [`joint_name`](Self::joint_name) does; empty if there is none.
    pub fn name_of(&self, joint: JointId) -> String {
        self.joints().nth(joint.0 as usize).map_or_else(String::new, |owner| self.joint_name(owner))
    }

    /// Returns the name of a bond, given by its index: those of its two ports, such as `a.front -- b.back`. Panics if
    /// there is no such bond.
    pub fn bond_name(&self, bond: usize) -> String {
        format!("{} -- {}", self.port_name(self.bonds[bond].a), self.port_name(self.bonds[bond].b))
    }

    /// Returns the path name of a port, such as `leg[2].m[0].front`. Panics if there is no such port.
    pub fn port_name(&self, p: PortRef) -> String {
        format!("{}.{}", self.modules[p.module].name, self.module_type(p.module).ports[p.port].name)
    }
}
