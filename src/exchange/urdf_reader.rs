//! Robot descriptions in URDF, read: links, joints, masses and shapes as they stand in the file.

use super::import_fault::{ImportFault, document};
use crate::formats::MESH_FORMATS;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3};
use crate::robot::validation::{MODULE_EXTENT_MAX, POSITION_MAX, QUANTITY_MAX};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;

/// The greatest magnitude of a number that counts as finite: sums and products of a few such numbers are finite, too.
const NUMBER_MAX: f64 = 1e30;

/// A robot description.
#[derive(Clone, Debug, Default)]
pub(super) struct Urdf {
    /// The name of the robot.
    pub(super) name: String,
    /// The links, in the order of the file.
    pub(super) links: Vec<UrdfLink>,
    /// The joints, in the order of the file.
    pub(super) joints: Vec<UrdfJoint>,
    /// The parts that were left out, in words.
    pub(super) notes: Vec<String>,
}

/// A link of a description.
#[derive(Clone, Debug)]
pub(super) struct UrdfLink {
    /// The name of the link.
    pub(super) name: String,
    /// Its mass, kg; `None` if none is stated.
    pub(super) mass: Option<f64>,
    /// The centre of mass in the link's frame, m, with the orientation of the axes of inertia.
    pub(super) centre: Pose,
    /// The entries xx, yy, zz, xy, xz, yz of the inertia, kg·m², about the centre, along the axes of `centre`.
    pub(super) inertia: [f64; 6],
    /// The shapes to judge, in the link's frame; those to draw where none are stated.
    pub(super) shapes: Vec<(Pose, UrdfShape)>,
}

/// A shape of a description, in metres.
#[derive(Clone, Debug)]
pub(super) enum UrdfShape {
    /// A box with these edges.
    Box(Vec3),
    /// A cylinder along z.
    Cylinder { radius: f64, length: f64 },
    /// A cylinder along z with round caps.
    Capsule { radius: f64, length: f64 },
    /// A ball of this radius.
    Sphere(f64),
    /// The hull of points.
    Points(Vec<Vec3>),
}

/// The kind of a joint of a description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UrdfKind {
    /// A joint that turns between two ends.
    Revolute,
    /// A joint that turns for ever.
    Continuous,
    /// A joint that slides.
    Prismatic,
    /// A joint that does not move.
    Fixed,
}

/// A joint of a description.
#[derive(Clone, Debug)]
pub(super) struct UrdfJoint {
    /// The name of the joint.
    pub(super) name: String,
    /// Its kind.
    pub(super) kind: UrdfKind,
    /// The index of the link that carries.
    pub(super) parent: usize,
    /// The index of the link that is carried.
    pub(super) child: usize,
    /// The pose of the child's frame in that of the parent at the position 0.
    pub(super) origin: Pose,
    /// The unit axis in the child's frame.
    pub(super) axis: Vec3,
    /// The lowest and the highest position, rad or m; `None`: not stated.
    pub(super) range: Option<(f64, f64)>,
    /// The greatest effort, N·m or N; `None`: not stated.
    pub(super) effort: Option<f64>,
    /// The greatest speed, rad/s or m/s; `None`: not stated.
    pub(super) speed: Option<f64>,
    /// The damping, N·m·s/rad or N·s/m; `None`: not stated.
    pub(super) damping: Option<f64>,
    /// The joint that it follows, by its index, with factor and offset.
    pub(super) mimic: Option<(usize, f64, f64)>,
}

/// The reader of a description.
struct Reader<'d, 'r> {
    document: &'d Document<'d>,
    /// The reader of the files that the description names.
    open: &'r mut dyn FnMut(&str) -> Option<Vec<u8>>,
    urdf: Urdf,
}

/// Reads a description. `open` returns the bytes of a mesh by the name that stands in the file.
///
/// # Errors
/// The first [`ImportFault`]: no XML, no robot, a link or joint that makes no sense, or one that modl does not have.
pub(super) fn read(text: &str, open: &mut dyn FnMut(&str) -> Option<Vec<u8>>) -> Result<Urdf, ImportFault> {
    let document = document(text)?;
    let mut reader = Reader { document: &document, open, urdf: Urdf::default() };
    reader.robot()?;
    Ok(reader.urdf)
}

impl<'d> Reader<'d, '_> {
    fn robot(&mut self) -> Result<(), ImportFault> {
        let root = self.document.root_element();
        if !root.has_tag_name("robot") {
            let found = root.tag_name().name();
            return Err(ImportFault::at_node(root, format!("`<robot>` is wanted, and this is `<{found}>`")));
        }
        self.urdf.name = root.attribute("name").unwrap_or("robot").to_owned();
        let mut links = BTreeMap::new();
        for node in root.children().filter(|node| node.has_tag_name("link")) {
            let name = self.name(node)?;
            let link = self.link(node, name.clone())?;
            if links.insert(name.clone(), self.urdf.links.len()).is_some() {
                return Err(ImportFault::at_node(node, format!("the link `{name}` is there twice")));
            }
            self.urdf.links.push(link);
        }
        if links.is_empty() {
            let xacro = root.namespaces().any(|space| space.name() == Some("xacro"));
            let how = if xacro { ": it is made of macros, which `xacro` expands" } else { "" };
            return Err(ImportFault::at_node(root, format!("the robot has no links{how}")));
        }
        let nodes: Vec<Node> = root.children().filter(|node| node.has_tag_name("joint")).collect();
        let mut joints = BTreeMap::new();
        for (index, node) in nodes.iter().enumerate() {
            let name = self.name(*node)?;
            if joints.insert(name.clone(), index).is_some() {
                return Err(ImportFault::at_node(*node, format!("the joint `{name}` is there twice")));
            }
        }
        for node in &nodes {
            let joint = self.joint(*node, &links, &joints)?;
            self.urdf.joints.push(joint);
        }
        self.check_mimics(&nodes)?;
        self.check_tree(root)
    }

    fn name(&self, node: Node) -> Result<String, ImportFault> {
        let name = node.attribute("name").filter(|name| !name.is_empty());
        name.map(str::to_owned).ok_or_else(|| {
            ImportFault::at_node(node, format!("a `<{}>` without a name", node.tag_name().name()))
        })
    }

    /// Returns the only child of a name.
    fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
        node.children().find(|child| child.has_tag_name(name))
    }

    /// Returns the finite numbers of an attribute.
    fn numbers<const N: usize>(
        &self,
        node: Node,
        key: &str,
        default: [f64; N],
    ) -> Result<[f64; N], ImportFault> {
        let Some(text) = node.attribute(key) else { return Ok(default) };
        let read: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let count = text.split_whitespace().count();
        match <[f64; N]>::try_from(read) {
            Ok(all) if count == N && all.iter().all(|x| x.abs() <= NUMBER_MAX) => Ok(all),
            _ => {
                Err(ImportFault::at_node(node, format!("`{key}=\"{text}\"`: {N} finite numbers are wanted")))
            }
        }
    }

    fn number(&self, node: Node, key: &str) -> Result<Option<f64>, ImportFault> {
        if node.attribute(key).is_none() {
            return Ok(None);
        }
        self.numbers::<1>(node, key, [0.0]).map(|[x]| Some(x))
    }

    fn positive(&self, node: Node, key: &str) -> Result<f64, ImportFault> {
        self.number(node, key)?
            .filter(|x| *x > 0.0)
            .ok_or_else(|| ImportFault::at_node(node, format!("a positive `{key}` is wanted")))
    }

    /// Returns the pose that the element `origin` of a node states.
    fn origin(&self, node: Node<'d, 'd>) -> Result<Pose, ImportFault> {
        let Some(origin) = Self::child(node, "origin") else { return Ok(Pose::identity()) };
        let xyz = self.numbers(origin, "xyz", [0.0; 3])?;
        let [roll, pitch, yaw] = self.numbers(origin, "rpy", [0.0; 3])?;
        let turn = turned(Vec3::z(), yaw) * turned(Vec3::y(), pitch) * turned(Vec3::x(), roll);
        Ok(shifted(Vec3::from(xyz)) * turn)
    }

    fn link(&mut self, node: Node<'d, 'd>, name: String) -> Result<UrdfLink, ImportFault> {
        let mut link =
            UrdfLink { name, mass: None, centre: Pose::identity(), inertia: [0.0; 6], shapes: Vec::new() };
        if let Some(inertial) = Self::child(node, "inertial") {
            link.centre = self.origin(inertial)?;
            if let Some(mass) = Self::child(inertial, "mass") {
                link.mass = self.number(mass, "value")?;
            }
            if link.mass.is_some_and(|mass| mass < 0.0) {
                return Err(ImportFault::at_node(
                    inertial,
                    format!("the mass of `{}` is negative", link.name),
                ));
            }
            if let Some(inertia) = Self::child(inertial, "inertia") {
                for (entry, key) in link.inertia.iter_mut().zip(["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]) {
                    *entry = self.number(inertia, key)?.unwrap_or(0.0);
                }
            }
        }
        for element in ["collision", "visual"] {
            for shown in node.children().filter(|child| child.has_tag_name(element)) {
                let X = self.origin(shown)?;
                if let Some(shape) = self.shape(shown, &link.name)? {
                    link.shapes.push((X, shape));
                }
            }
            if !link.shapes.is_empty() {
                break;
            }
        }
        Ok(link)
    }

    /// Returns the shape of a node `collision` or `visual`; `None`, with a note, for a mesh that can't be read.
    fn shape(&mut self, node: Node<'d, 'd>, link: &str) -> Result<Option<UrdfShape>, ImportFault> {
        let Some(geometry) = Self::child(node, "geometry") else {
            return Err(ImportFault::at_node(node, "a shape without `<geometry>`"));
        };
        let Some(shape) = geometry.children().find(Node::is_element) else {
            return Err(ImportFault::at_node(geometry, "`<geometry>` without a shape"));
        };
        let round =
            |reader: &Self| Ok((reader.positive(shape, "radius")?, reader.positive(shape, "length")?));
        Ok(Some(match shape.tag_name().name() {
            "box" => {
                let size = self.numbers(shape, "size", [0.0; 3])?;
                if size.iter().any(|edge| *edge <= 0.0) {
                    return Err(ImportFault::at_node(shape, "the edges of a box are positive"));
                }
                UrdfShape::Box(Vec3::from(size))
            }
            "cylinder" => {
                let (radius, length) = round(self)?;
                UrdfShape::Cylinder { radius, length }
            }
            "capsule" => {
                let (radius, length) = round(self)?;
                UrdfShape::Capsule { radius, length }
            }
            "sphere" => UrdfShape::Sphere(self.positive(shape, "radius")?),
            "mesh" => return self.mesh(shape, link),
            other => return Err(ImportFault::at_node(shape, format!("modl has no shape `{other}`"))),
        }))
    }

    fn mesh(&mut self, node: Node, link: &str) -> Result<Option<UrdfShape>, ImportFault> {
        let scale = self.numbers(node, "scale", [1.0; 3])?;
        let Some(name) = node.attribute("filename") else {
            return Err(ImportFault::at_node(node, "a mesh without `filename`"));
        };
        let ending = name.rsplit_once('.').map_or(String::new(), |(_, ending)| ending.to_lowercase());
        let mut left_out = |why: String| {
            self.urdf.notes.push(format!("the mesh `{name}` of `{link}` is left out: {why}"));
            Ok(None)
        };
        let Some(format) = MESH_FORMATS.iter().find(|format| format.ending == ending) else {
            let known: Vec<&str> = MESH_FORMATS.iter().map(|format| format.name).collect();
            return left_out(format!("`.{ending}` is none of {}", known.join(", ")));
        };
        let Some(bytes) = (self.open)(name) else { return left_out("there is no such file".to_owned()) };
        match format.read_mesh(&bytes) {
            Err(fault) => left_out(fault.to_string()),
            Ok(mesh) => {
                let point = |v: &[f64; 3]| Vec3::from(*v).component_mul(&Vec3::from(scale));
                Ok(Some(UrdfShape::Points(mesh.vertices.iter().map(point).collect())))
            }
        }
    }

    fn joint(
        &self,
        node: Node<'d, 'd>,
        links: &BTreeMap<String, usize>,
        joints: &BTreeMap<String, usize>,
    ) -> Result<UrdfJoint, ImportFault> {
        let name = self.name(node)?;
        let kind = match node.attribute("type") {
            Some("revolute") => UrdfKind::Revolute,
            Some("continuous") => UrdfKind::Continuous,
            Some("prismatic") => UrdfKind::Prismatic,
            Some("fixed") => UrdfKind::Fixed,
            Some(other) => {
                let message =
                    format!("the joint `{name}` is `{other}`, and modl has joints of one axis only");
                return Err(ImportFault::at_node(node, message));
            }
            None => return Err(ImportFault::at_node(node, format!("the joint `{name}` has no `type`"))),
        };
        let end = |key: &str| {
            let link = Self::child(node, key).and_then(|end| end.attribute("link"));
            let link = link
                .ok_or_else(|| ImportFault::at_node(node, format!("the joint `{name}` has no `<{key}>`")))?;
            links.get(link).copied().ok_or_else(|| {
                ImportFault::at_node(
                    node,
                    format!("the `<{key}>` of `{name}`, `{link}`, is no link of the robot"),
                )
            })
        };
        let (parent, child) = (end("parent")?, end("child")?);
        let mut axis = Vec3::x();
        // The axis of a joint that does not move has no meaning, and is often zero.
        if let Some(stated) = Self::child(node, "axis").filter(|_| kind != UrdfKind::Fixed) {
            axis = Vec3::from(self.numbers(stated, "xyz", [1.0, 0.0, 0.0])?);
        }
        let Some(axis) = axis.try_normalize(0.0) else {
            return Err(ImportFault::at_node(node, format!("the axis of `{name}` has no length")));
        };
        let limit = Self::child(node, "limit");
        let stated = |key: &str| match limit {
            Some(limit) => self.number(limit, key),
            None => Ok(None),
        };
        let (low, high) = (stated("lower")?.unwrap_or(0.0), stated("upper")?.unwrap_or(0.0));
        let bounded = matches!(kind, UrdfKind::Revolute | UrdfKind::Prismatic);
        if bounded && low > high {
            return Err(ImportFault::at_node(
                node,
                format!("the limits of `{name}` are the wrong way round"),
            ));
        }
        // Zeros, and numbers beyond all limits, stand for what is not known.
        let known = |x: &f64| *x > 0.0 && *x <= QUANTITY_MAX;
        let (effort, speed) = (stated("effort")?.filter(known), stated("velocity")?.filter(known));
        let damping = match Self::child(node, "dynamics") {
            Some(dynamics) => self.number(dynamics, "damping")?.filter(|x| *x > 0.0),
            None => None,
        };
        let mimic = match Self::child(node, "mimic") {
            Some(mimic) => {
                let followed = mimic.attribute("joint").unwrap_or_default();
                let index = joints.get(followed).copied().ok_or_else(|| {
                    ImportFault::at_node(mimic, format!("`{name}` follows `{followed}`, which is no joint"))
                })?;
                let factor = self.number(mimic, "multiplier")?.unwrap_or(1.0);
                Some((index, factor, self.number(mimic, "offset")?.unwrap_or(0.0)))
            }
            None => None,
        };
        let most = if kind == UrdfKind::Prismatic { MODULE_EXTENT_MAX } else { POSITION_MAX };
        let limits = low.abs().max(high.abs()) <= most;
        let range = (bounded && low < high && limits).then_some((low, high));
        let origin = self.origin(node)?;
        Ok(UrdfJoint { name, kind, parent, child, origin, axis, range, effort, speed, damping, mimic })
    }

    /// Checks that no joint follows itself, directly or over others.
    fn check_mimics(&self, nodes: &[Node]) -> Result<(), ImportFault> {
        let joints = &self.urdf.joints;
        let followed = |joint: &usize| joints[*joint].mimic.map(|(followed, ..)| followed);
        for (joint, node) in nodes.iter().enumerate() {
            let chain = std::iter::successors(followed(&joint), followed);
            if chain.take(joints.len()).any(|other| other == joint) {
                let message = format!("the joint `{}` follows itself", joints[joint].name);
                return Err(ImportFault::at_node(*node, message));
            }
        }
        Ok(())
    }

    /// Checks that the joints make one tree of the links.
    fn check_tree(&self, root: Node) -> Result<(), ImportFault> {
        let urdf = &self.urdf;
        let mut carried = vec![false; urdf.links.len()];
        for joint in &urdf.joints {
            if std::mem::replace(&mut carried[joint.child], true) {
                let link = &urdf.links[joint.child].name;
                return Err(ImportFault::at_node(root, format!("two joints carry the link `{link}`")));
            }
        }
        let roots: Vec<&str> = urdf
            .links
            .iter()
            .zip(&carried)
            .filter(|(_, c)| !**c)
            .map(|(link, _)| link.name.as_str())
            .collect();
        if roots.len() != 1 || urdf.in_order().len() != urdf.links.len() {
            let found = match roots[..] {
                [] => "no link is carried by none".to_owned(),
                [_] => "some links carry each other in a circle".to_owned(),
                _ => format!("nothing carries {}", roots.join(", ")),
            };
            return Err(ImportFault::at_node(root, format!("the links are not one tree: {found}")));
        }
        Ok(())
    }
}

impl Urdf {
    /// Returns the indices of the links that the root carries, each with the joint that carries it; the root first, parents
    /// before children.
    pub(super) fn in_order(&self) -> Vec<(usize, Option<usize>)> {
        let root = (0..self.links.len()).find(|link| self.joints.iter().all(|joint| joint.child != *link));
        let mut order: Vec<(usize, Option<usize>)> = root.into_iter().map(|root| (root, None)).collect();
        let mut next = 0;
        while next < order.len() {
            let carrying = order[next].0;
            let carried = self.joints.iter().enumerate().filter(|(_, joint)| joint.parent == carrying);
            order.extend(carried.map(|(index, joint)| (joint.child, Some(index))));
            next += 1;
        }
        order
    }
}
