//! Elaborated declarations and the instances that are views of them.
//!
//! A design is a declaration with its arguments, elaborated once and shared by all its instances. An instance
//! is a design as a part of a robot, the outermost design: joints and ports of a part are joints and ports of
//! the whole.

use super::cells::Cells;
use super::groups::Groups;
use super::identity::{Identity, Name};
use super::module_map::ModuleMap;
use super::robot::Robot;
use super::scene::{Place, SceneDesign};
use super::value::{JointValue, Lazy, PortValue, Value};
use crate::check::typed::DefId;
use crate::geometry::{Pose, Vec3};
use crate::robot::truss::Rigidity;
use crate::robot::{Cell, Connector, JointId, JointOwner, Library, ModuleType, PortRef, Strut};
use crate::source::{Span, Symbol};
use crate::units::Dimension;
use std::cell::{Cell as Flag, OnceCell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;

/// Most names that a message lists.
const NAMES_SHOWN: usize = 12;

/// A design: a declaration with its arguments, elaborated once, which all its instances share.
pub struct Design {
    /// The declaration that was elaborated.
    pub def: DefId,
    /// The name of the declaration, with the arguments where they differ from the defaults: `Walker(bend: 35deg)`.
    pub name: String,
    /// The arguments, one value for every parameter, in the order of the declaration.
    pub args: Vec<Value>,
    /// The kind of declaration, with what it declares.
    pub kind: DesignKind,
    /// True if something is wrong with the declaration, which has been reported: instances of it are unknown.
    pub broken: Flag<bool>,
}

/// The kind of a design, with what elaboration made of the declaration's body.
pub enum DesignKind {
    /// A module with its links, joints and ports.
    Module(ModuleDesign),
    /// A configuration: instances of modules and configurations, connected by bonds.
    Config(ConfigDesign),
    /// A cell, of which lattices are made.
    Cell(Cell),
    /// A strut, of which trusses are made.
    Strut(Strut),
    /// A lattice: cells of one kind on a grid.
    Lattice(LatticeDesign),
    /// A truss of struts and nodes.
    Truss(TrussDesign),
}

/// A module, elaborated: its type in numbers, and what the language knows beside that.
pub struct ModuleDesign {
    /// The module type; the connectors of its ports are indices into `connectors` here, not into a library.
    pub module: Rc<ModuleType>,
    /// The declarations of the module's connectors; the index here, from 0, is the connector of a port in `module`.
    pub connectors: Vec<DefId>,
    /// The ports of each entry of [`ModuleDef::ports`](crate::check::typed::ModuleDef::ports), in order, as (index of
    /// its first port in `module`, number of its ports).
    pub port_groups: Vec<(usize, usize)>,
    /// The dimension of the position of each joint of `module`, in their order.
    pub joint_dimensions: Vec<Dimension>,
    /// The assembled robot, once it was asked for; `None` where there is none.
    pub robot: OnceCell<Option<Rc<Robot>>>,
}

/// A configuration, which is filled in order while its body is elaborated; the body can refer to what is there already.
#[derive(Default)]
pub struct ConfigDesign {
    /// The parts of the configuration, in the order of [`ConfigDef::parts`](crate::check::typed::ConfigDef::parts).
    pub parts: OnceCell<Vec<PartGroup>>,
    /// All modules, those of the parts in order; indices of modules elsewhere count in this list, from 0.
    pub modules: OnceCell<Vec<FlatModule>>,
    /// The connections, in the order of the clauses.
    pub bonds: RefCell<Vec<BondRecord>>,
    /// The index in `bonds` of the bond at each port, given as (index of the module, index of the port), that has one.
    pub taken: RefCell<HashMap<(usize, usize), usize>>,
    /// The connected components of modules, as far as connections have been made.
    pub groups: RefCell<Groups>,
    /// The start positions, in the order of the clauses.
    pub sets: RefCell<Vec<SetRecord>>,
    /// The index in `modules` of the module named by `base`; `None` if none is named.
    pub base: Flag<Option<usize>>,
    /// True if the configuration says that loops may be closed.
    pub closed: bool,
    /// The order of the configuration: one more than the largest order of its parts.
    pub order: Flag<usize>,
    /// The scene that the design is, without its parts; `None` for a configuration.
    pub scene: Option<SceneDesign>,
    /// True once all clauses have been run, so that its geometry is known.
    pub complete: Flag<bool>,
    /// The assembled robot, once it was asked for; `None` where there is none.
    pub robot: OnceCell<Option<Rc<Robot>>>,
}

/// A part of a configuration, or a list of parts.
pub struct PartGroup {
    /// True if the part was declared as a list.
    pub list: bool,
    /// The parts in order; one if it was not declared as a list.
    pub elements: Vec<PartElement>,
}

/// A part of a configuration, single or an element of a list of parts, with the place of its modules among all.
pub struct PartElement {
    /// The elaborated declaration of the part.
    pub design: Rc<Design>,
    /// The index of the part's first module in [`ConfigDesign::modules`].
    pub offset: usize,
    /// The name of the part: `leg`, or `leg[2]` in a list.
    pub name: Rc<str>,
    /// The place of the part in a scene; `None` where none is stated.
    pub place: Option<Place>,
}

/// A module of a configuration, at any depth of its parts, by its path name.
#[derive(Clone)]
pub struct FlatModule {
    /// The path name of the module, such as `leg[2].m[0]`.
    pub name: Rc<str>,
    /// The elaborated declaration of the module.
    pub design: Rc<Design>,
}

/// A connection (`connect`), with its position in the source.
#[derive(Clone)]
pub struct BondRecord {
    /// The first port, as (index of the module in [`ConfigDesign::modules`], index of the port in its type).
    pub a: (usize, usize),
    /// The second port, as (index of the module in [`ConfigDesign::modules`], index of the port in its type).
    pub b: (usize, usize),
    /// The turn of the second connector about their common normal, 0 to `turns` - 1, in steps of 360° divided by the
    /// connector's `turns`.
    pub turn: u32,
    /// The span of the clause `connect`.
    pub span: Span,
    /// The spans of the two paths, of the first end and the second.
    pub ends: (Span, Span),
    /// The path of the part and the loop variables, such as `leg[2] (i = 3)`, or a line of a RoFI file; may be empty.
    pub instance: Rc<str>,
}

/// A start position (`set`), with its position in the source.
#[derive(Clone)]
pub struct SetRecord {
    /// The joint whose position is set.
    pub joint: JointOwner,
    /// The position of the joint at the start, rad or m.
    pub value: f64,
    /// The span of the clause `set`.
    pub span: Span,
    /// The path of the part and the loop variables, such as `leg[2] (i = 3)`, or a module of a RoFI file; may be empty.
    pub instance: Rc<str>,
}

/// A lattice: cells of one kind in an arrangement.
pub struct LatticeDesign {
    /// The design of the cell that the lattice is made of.
    pub of: Rc<Design>,
    /// The positions of the cells on the grid.
    pub cells: Rc<Cells>,
}

/// A truss: nodes, and struts of one kind between them.
pub struct TrussDesign {
    /// The design of the strut that the truss is made of.
    pub of: Rc<Design>,
    /// The nodes, in the order of the declaration.
    pub nodes: Vec<Node>,
    /// The struts, each as the indices in `nodes` of its first and second node, from 0.
    pub struts: Vec<(usize, usize)>,
    /// The infinitesimal rigidity of the truss in the start pose: the rank of its rigidity matrix, with the degrees of
    /// freedom that follow from it.
    pub rigidity: Rigidity,
}

/// A node of a truss, a single one or an element of an array, with its position in the start pose.
#[derive(Clone)]
pub struct Node {
    /// The name of the node: `ring[3]`, or `top` for a node that is no array's.
    pub name: String,
    /// The name of the array that the node belongs to, such as `ring`; `None` for a single node.
    pub group: Option<Symbol>,
    /// The position of the node in the start pose, m, in the frame of the declaration.
    pub position: Vec3,
    /// The span of the clause that declares the node.
    pub span: Span,
}

impl TrussDesign {
    /// Returns the name of the strut of this index: those of its two nodes, `a -- b`. Panics if there is no such strut.
    pub fn strut_name(&self, strut: usize) -> String {
        let (a, b) = self.struts[strut];
        format!("{} -- {}", self.nodes[a].name, self.nodes[b].name)
    }

    /// Returns the kind of the struts; `None` where its declaration is broken.
    pub fn strut_kind(&self) -> Option<&Strut> {
        match &self.of.kind {
            DesignKind::Strut(strut) => Some(strut),
            _ => None,
        }
    }

    /// Returns each free motion in words: the nodes that move, each with its direction. Components up to 0.005 are
    /// left out, and the nodes are listed as by [`shorten`].
    pub fn free_motions(&self) -> Vec<String> {
        let moves = |(node, d): &(usize, Vec3)| {
            let axis = ["x", "y", "z"];
            let along: Vec<String> = (0..3)
                .filter(|&k| d[k].abs() > 0.005)
                .map(|k| format!("{}{:.2}", axis[k], d[k]).replacen(axis[k], &format!("{} ", axis[k]), 1))
                .collect();
            format!("{} ({})", self.nodes[*node].name, along.join(", "))
        };
        let motions = self.rigidity.free.iter();
        motions.map(|m| shorten(&m.nodes.iter().map(moves).collect::<Vec<_>>())).collect()
    }

    /// Returns the position of a node, or the list of those of an array in the order of the declaration; `None` where
    /// there is no such node.
    pub fn position_of(&self, name: Symbol) -> Option<Value> {
        let position = |node: &Node| Value::Vec3(node.position, Dimension::LENGTH);
        let mut of_group = self.nodes.iter().filter(|n| n.group == Some(name)).peekable();
        match of_group.peek() {
            Some(node) if node.name == name.as_str() => Some(position(node)),
            Some(_) => Some(Value::list(of_group.map(position).collect())),
            None => None,
        }
    }
}

/// A connector, elaborated: its type in numbers, and the declarations that it docks with.
pub struct ConnectorDesign {
    /// The declaration of the connector.
    pub def: DefId,
    /// The connector in numbers; its `mates` are empty here, as they are declarations, in [`ConnectorDesign::mates`].
    pub connector: Connector,
    /// The declarations of the connectors that it docks with.
    pub mates: Vec<DefId>,
}

impl ConfigDesign {
    /// Returns a configuration of modules side by side, one list of parts, with no bonds yet, for a robot that no
    /// declaration's body describes. It is not marked as complete.
    pub fn of_modules(modules: Vec<FlatModule>) -> ConfigDesign {
        let config = ConfigDesign::default();
        let part = |(offset, module): (usize, &FlatModule)| PartElement {
            design: module.design.clone(),
            offset,
            name: module.name.clone(),
            place: None,
        };
        let elements = modules.iter().enumerate().map(part).collect();
        config.parts.get_or_init(|| vec![PartGroup { list: true, elements }]);
        config.modules.get_or_init(|| modules);
        config.order.set(1);
        config
    }

    /// Adds a connection to the configuration, marks its two ports as taken, and joins the components of its modules.
    pub fn add_bond(&self, bond: BondRecord) {
        let index = self.bonds.borrow().len();
        self.taken.borrow_mut().extend([(bond.a, index), (bond.b, index)]);
        self.groups.borrow_mut().join(bond.a.0, bond.b.0);
        self.bonds.borrow_mut().push(bond);
    }
}

impl Design {
    /// Returns the module that the design is; `None` for other designs.
    pub fn module(&self) -> Option<&ModuleDesign> {
        match &self.kind {
            DesignKind::Module(module) => Some(module),
            _ => None,
        }
    }

    /// Returns the configuration that the design is; `None` for other designs.
    pub fn config(&self) -> Option<&ConfigDesign> {
        match &self.kind {
            DesignKind::Config(config) => Some(config),
            _ => None,
        }
    }

    /// Returns the number of modules of the design; 0 for a design that is not a robot or not far enough elaborated.
    pub fn module_count(&self) -> usize {
        match &self.kind {
            DesignKind::Module(_) => 1,
            DesignKind::Config(config) => config.modules.get().map_or(0, Vec::len),
            _ => 0,
        }
    }

    /// Returns the number of elements of the design: cells of a lattice, struts of a truss, else modules; 0 for a
    /// single cell or strut.
    pub fn element_count(&self) -> usize {
        match &self.kind {
            DesignKind::Lattice(lattice) => lattice.cells.positions.len(),
            DesignKind::Truss(truss) => truss.struts.len(),
            DesignKind::Module(_) | DesignKind::Config(_) => self.module_count(),
            DesignKind::Cell(_) | DesignKind::Strut(_) => 0,
        }
    }

    /// Returns the mass of the whole design, kg; 0 for a configuration that is not far enough elaborated, and for a
    /// truss whose strut is broken.
    pub fn mass(self: &Rc<Design>) -> f64 {
        match &self.kind {
            DesignKind::Cell(cell) => cell.mass,
            DesignKind::Strut(strut) => strut.mass,
            DesignKind::Lattice(LatticeDesign { of, .. }) => of.mass() * self.element_count() as f64,
            DesignKind::Truss(truss) => {
                truss.strut_kind().map_or(0.0, |strut| strut.mass) * self.element_count() as f64
            }
            DesignKind::Module(_) | DesignKind::Config(_) => (0..self.module_count())
                .map(|module| self.module_type(module).links.iter().map(|link| link.mass).sum::<f64>())
                .sum(),
        }
    }

    /// Returns a library of nothing but the cell or strut that the design is; `None` for any other design.
    pub fn library_of_element(&self) -> Option<Library> {
        match &self.kind {
            DesignKind::Cell(cell) => Some(Library { cells: vec![cell.clone()], ..Library::default() }),
            DesignKind::Strut(strut) => Some(Library { struts: vec![strut.clone()], ..Library::default() }),
            _ => None,
        }
    }

    /// Returns the module design at an index; itself for a design that is not a configuration. Panics if the modules
    /// of a configuration are not listed yet, or the index is out of range.
    pub fn module_at(self: &Rc<Design>, index: usize) -> Rc<Design> {
        match &self.kind {
            DesignKind::Config(config) => {
                config.modules.get().expect("modules are listed before they are named")[index].design.clone()
            }
            _ => self.clone(),
        }
    }

    /// Returns the type of the module at an index. Panics if the modules of a configuration are not listed yet, the
    /// index is out of range, or the design is not a robot.
    pub fn module_type(self: &Rc<Design>, index: usize) -> Rc<ModuleType> {
        self.module_at(index).module().expect("only modules are listed").module.clone()
    }

    /// Returns the path name of the module at an index, such as `leg[2].m[0]`; for a design that is not a
    /// configuration, the name of the design. Panics if the modules of a configuration are not listed yet, or the
    /// index is out of range.
    pub fn module_name(&self, index: usize) -> Rc<str> {
        match &self.kind {
            DesignKind::Config(config) => {
                config.modules.get().expect("modules are listed before they are named")[index].name.clone()
            }
            _ => self.name.as_str().into(),
        }
    }

    /// Returns the order of a configuration: one more than the largest order of its parts, by which Tosun, Jing,
    /// Kress-Gazit and Yim sort the library of their compositional-design paper; 0 for other designs.
    pub fn order(&self) -> usize {
        self.config().map_or(0, |config| config.order.get())
    }

    /// Returns the connections of a configuration, in the order of its clauses; an empty list for other designs.
    pub fn bonds(&self) -> Vec<BondRecord> {
        self.config().map_or_else(Vec::new, |config| config.bonds.borrow().clone())
    }

    /// Returns the connection at an index of [`Design::bonds`]. Panics if the design is not a configuration, or the
    /// index is out of range.
    pub fn bond(&self, index: usize) -> BondRecord {
        self.config().expect("only configurations have bonds").bonds.borrow()[index].clone()
    }

    /// Returns the start positions that a configuration sets; an empty list for other designs.
    pub fn sets(&self) -> Vec<SetRecord> {
        self.config().map_or_else(Vec::new, |config| config.sets.borrow().clone())
    }
}

impl std::fmt::Debug for Design {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.name)
    }
}

/// The robot that a value belongs to: the outermost design, and which of the robots that are equal to it.
#[derive(Clone)]
pub struct Subject {
    /// The outermost design, of which the value is a part.
    pub design: Rc<Design>,
    /// The identity of the robot among those that are equal to it.
    pub identity: Identity,
}

impl Subject {
    /// Returns the robot of a design as a new one, which has no name yet.
    pub fn new(design: Rc<Design>) -> Subject {
        Subject { design, identity: Identity::default() }
    }
}

impl std::ops::Deref for Subject {
    type Target = Rc<Design>;

    fn deref(&self) -> &Rc<Design> {
        &self.design
    }
}

impl std::fmt::Debug for Subject {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.design.fmt(f)
    }
}

/// An instance of a design: a part of a robot, or the whole.
pub struct Instance {
    /// The elaborated declaration of the instance.
    pub design: Rc<Design>,
    /// The robot that the instance is a part of.
    pub robot: Subject,
    /// The modules of the robot that are those of the instance.
    pub modules: ModuleMap,
    /// The path name of the instance within the robot, such as `leg[2]`; empty for the whole. That of an embedding
    /// names its design and first module.
    pub path: Rc<str>,
    /// The parts as values, by part group; made when they are first asked for.
    parts: OnceCell<Vec<Value>>,
    /// The lets and ports of the body that were asked for, by their index among the members of the declaration.
    pub lazy: RefCell<HashMap<usize, Lazy>>,
}

impl Instance {
    /// Returns a new instance that is the whole of a design: another robot at each call, without a name.
    pub fn whole(design: Rc<Design>) -> Rc<Instance> {
        let robot = Subject::new(design.clone());
        Instance::new(design, robot, ModuleMap::whole(), "".into())
    }

    /// Returns an instance of a design whose modules are those of a robot that `modules` lists, in their order.
    pub fn embedded(design: Rc<Design>, robot: Subject, modules: ModuleMap) -> Rc<Instance> {
        let name = robot.module_name(modules.index(0));
        let path = if design.config().is_none() { name } else { format!("{} at {name}", design.name).into() };
        Instance::new(design, robot, modules, path)
    }

    fn new(design: Rc<Design>, robot: Subject, modules: ModuleMap, path: Rc<str>) -> Rc<Instance> {
        Rc::new(Instance { design, robot, modules, path, parts: OnceCell::new(), lazy: RefCell::default() })
    }

    /// Adds a name to the robot, if the instance is a whole robot. A part gets none: it goes by the names of its robot.
    pub fn bind(&self, name: Name) {
        if self.path.is_empty() {
            self.robot.identity.bind(name);
        }
    }

    /// Returns the parts of a configuration as values: an instance or a list of instances for each group. `None` while
    /// they are being elaborated, and for an instance that is not a configuration.
    pub fn parts(&self) -> Option<&[Value]> {
        let groups = self.design.config()?.parts.get()?;
        Some(self.parts.get_or_init(|| groups.iter().map(|group| self.part_values(group)).collect()))
    }

    fn part_values(&self, group: &PartGroup) -> Value {
        let mut elements: Vec<Value> = group.elements.iter().map(|e| Value::Instance(self.part(e))).collect();
        if group.list { Value::List(Rc::new(elements)) } else { elements.pop().unwrap_or(Value::Unknown) }
    }

    fn part(&self, element: &PartElement) -> Rc<Instance> {
        let (design, modules) = (element.design.clone(), self.modules.part(element.offset));
        if modules.is_embedding() && design.module_count() > 0 {
            return Instance::embedded(design, self.robot.clone(), modules);
        }
        Instance::new(design, self.robot.clone(), modules, join_path(&self.path, &element.name))
    }

    /// Returns a joint of a module instance, by its index in the module type; `None` for an instance that is not a
    /// module, or if there is no such joint.
    pub fn joint(&self, joint: usize) -> Option<Value> {
        let module = self.design.module()?;
        let dimension = *module.joint_dimensions.get(joint)?;
        let owner = JointOwner::Module { module: self.modules.index(0), joint };
        Some(Value::Joint(JointValue { robot: self.robot.clone(), owner, dimension }))
    }

    /// Returns a port of a module instance, or with `array` the list of an array's ports, by its index in
    /// [`ModuleDef::ports`](crate::check::typed::ModuleDef::ports); `None` for an instance that is not a module, or if
    /// there is no such port.
    pub fn port(&self, group: usize, array: bool) -> Option<Value> {
        let module = self.design.module()?;
        let (first, count) = *module.port_groups.get(group)?;
        let own = self.modules.index(0);
        let port = |port| Value::Port(PortValue { robot: self.robot.clone(), module: own, port });
        let mut ports = (first..first + count).map(port);
        if array { Some(Value::List(Rc::new(ports.collect()))) } else { ports.next() }
    }

    /// Returns the path name of the instance within the robot, such as `leg[2]`; for the robot as a whole, the name of
    /// its design.
    pub fn title(&self) -> &str {
        if self.path.is_empty() { &self.design.name } else { &self.path }
    }
}

impl std::fmt::Debug for Instance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.title())
    }
}

impl JointValue {
    /// Returns the path name of the joint, such as `leg[2].m[0].tilt`; the joint of a connection goes by its two ports.
    pub fn name(&self) -> String {
        match self.owner {
            JointOwner::Module { module, joint } => {
                let joint = &self.robot.module_type(module).joints[joint].name;
                format!("{}.{joint}", self.robot.module_name(module))
            }
            JointOwner::Bond(bond) => {
                let BondRecord { a, b, .. } = self.robot.bond(bond);
                let port = |(module, port)| PortValue { robot: self.robot.clone(), module, port }.name();
                format!("{} -- {}", port(a), port(b))
            }
        }
    }
}

impl PortValue {
    /// Returns the path name of the port, such as `leg[2].m[0].top`.
    pub fn name(&self) -> String {
        let port = &self.robot.module_type(self.module).ports[self.port].name;
        format!("{}.{port}", self.robot.module_name(self.module))
    }
}

/// Returns `a` and `b` as one path name, `a.b`; either may be empty.
pub fn join_path(a: &str, b: &str) -> Rc<str> {
    match (a.is_empty(), b.is_empty()) {
        (true, _) => b.into(),
        (_, true) => a.into(),
        _ => format!("{a}.{b}").into(),
    }
}

/// Returns a list of names in words; of more than `NAMES_SHOWN` all but the last of so many, and the number of the
/// rest.
pub fn shorten(names: &[String]) -> String {
    if names.len() <= NAMES_SHOWN {
        return names.join(", ");
    }
    let rest = names.len() - (NAMES_SHOWN - 1);
    format!("{} and {rest} more", names[..NAMES_SHOWN - 1].join(", "))
}

impl Robot {
    /// Returns the number of a joint of this robot (not checked: [`Robot::joint_of`]) in the assembly, from 0.
    pub fn joint(&self, joint: &JointValue) -> JointId {
        self.joint_of(joint.owner)
    }

    /// Returns the pose of a port in the start state, in the frame of the base module's body (metres). Panics if the
    /// robot has no such port.
    pub fn port_pose(&self, port: &PortValue) -> Pose {
        self.kinematics.port_pose(&self.assembly, port_ref(port), &self.poses)
    }
}

/// Returns a port as the indices of its module and of the port in the module's type, as an assembly names it.
pub fn port_ref(port: &PortValue) -> PortRef {
    PortRef { module: port.module, port: port.port }
}
