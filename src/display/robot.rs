//! Robots as trees of their parts.

use super::pretty::{Branch, listed};
use super::shape;
use super::truss;
use crate::check::typed::{DefId, DefKind, RecordField};
use crate::elaborate::free_ports;
use crate::interpret::design::{ConfigDesign, Design, DesignKind, Instance, ModuleDesign, PartElement};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::robot::{Joint, JointKind};
use crate::units::{Dimension, counted, quantity};
use std::rc::Rc;

/// The number of elements of a list of different parts that are drawn, if there are more than one beyond it.
const ELEMENTS_DRAWN: usize = 3;

impl Interpreter<'_> {
    /// Returns an instance as text by its family: a tree of joints, ports or parts, a picture of cells or nodes, or a
    /// line of facts.
    ///
    /// # Errors
    /// None: the result is always `Ok`.
    pub(super) fn display_instance(&mut self, instance: &Rc<Instance>) -> Eval<String> {
        let design = &instance.design;
        Ok(match &design.kind {
            DesignKind::Module(module) => self.module_tree(instance, module).drawn(),
            DesignKind::Config(_) => self.config_tree(instance).drawn(),
            DesignKind::Lattice(lattice) => {
                format!("{} of {}\n{}", design.name, lattice.of.name, shape::cells(&lattice.cells))
            }
            DesignKind::Truss(truss) => truss::truss(design, truss),
            DesignKind::Cell(cell) => format!(
                "{}: {}, shrinks to {}, {}{}",
                design.name,
                quantity(cell.size, Dimension::LENGTH),
                quantity(cell.shrinks_to, Dimension::LENGTH),
                quantity(cell.mass, Dimension::MASS),
                if cell.slides { "" } else { ", does not slide" }
            ),
            DesignKind::Strut(strut) => format!(
                "{}: {} to {}, {}",
                design.name,
                quantity(strut.length.0, Dimension::LENGTH),
                quantity(strut.length.1, Dimension::LENGTH),
                quantity(strut.mass, Dimension::MASS)
            ),
        })
    }

    fn module_tree(&self, instance: &Instance, module: &ModuleDesign) -> Branch {
        let design = &instance.design;
        let joints = module.module.joints.iter().enumerate().map(|(i, joint)| {
            let dimension = module.joint_dimensions.get(i).copied().unwrap_or(Dimension::ANGLE);
            Branch::leaf(format!("joint {}: {}", joint.name, joint_words(joint, dimension)))
        });
        let mut below: Vec<Branch> = joints.collect();
        let ports: Vec<String> = module.module.ports.iter().map(|port| port.name.to_string()).collect();
        if !ports.is_empty() {
            below.push(Branch::leaf(format!("{}: {}", plural(ports.len(), "port"), listed(&ports))));
        }
        let title = if instance.path.is_empty() {
            design.name.clone()
        } else {
            format!("{}, a {}", instance.path, design.name)
        };
        Branch { text: format!("{title}: a module of {}", mass_words(design)), below }
    }

    /// Returns the tree of a configuration: its parts, named and free ports, and behaviours.
    fn config_tree(&self, instance: &Instance) -> Branch {
        let design = &instance.design;
        let title = if instance.path.is_empty() {
            design.name.clone()
        } else {
            format!("{}, a {}", instance.path, design.name)
        };
        let text = format!("{title}: {}", self.config_words(design));
        let mut below = self.parts(design);
        let named = self.named_ports(design.def);
        if !named.is_empty() {
            below.push(Branch::leaf(format!("{}: {}", plural(named.len(), "port"), listed(&named))));
        }
        let obstacles: Vec<String> = design.obstacles().iter().map(|o| o.name.clone()).collect();
        if !obstacles.is_empty() {
            below.push(Branch::leaf(format!(
                "{}: {}",
                plural(obstacles.len(), "obstacle"),
                listed(&obstacles)
            )));
        }
        let free = free_of(instance);
        if !free.is_empty() {
            below.push(Branch::leaf(format!("free: {}", listed(&free))));
        }
        let behaviors = self.behaviors(design.def);
        if !behaviors.is_empty() {
            below.push(Branch::leaf(format!(
                "{}: {}",
                plural(behaviors.len(), "behavior"),
                listed(&behaviors)
            )));
        }
        Branch { text, below }
    }

    /// Returns the size of a configuration in words: its order, modules and mass, or the number of robots of a scene.
    fn config_words(&self, design: &Rc<Design>) -> String {
        let size = match design.scene() {
            Some(_) => counted(design.robots(self.limits().robots).len(), "robot"),
            None => format!("order {}", design.order()),
        };
        format!("{size}, {}, {}", counted(design.module_count(), "module"), mass_words(design))
    }

    /// Returns the branches of the parts, each with its own parts; equal elements of a list are one branch.
    fn parts(&self, design: &Rc<Design>) -> Vec<Branch> {
        let Some(groups) = design.config().and_then(|config| config.parts.get()) else { return Vec::new() };
        let mut found = Vec::new();
        for group in groups {
            let placed = group.elements.iter().any(|part| part.place.is_some());
            let equal = |pair: &[PartElement]| Rc::ptr_eq(&pair[0].design, &pair[1].design);
            let alike = !placed && group.elements.windows(2).all(equal);
            let count = group.elements.len();
            match group.elements.first() {
                None => {}
                Some(first) if count > 1 && alike => {
                    let name = first.name.split('[').next().unwrap_or(&first.name);
                    found.push(self.part(format!("{name}[{count}]"), first));
                }
                Some(_) => {
                    let shown = if count > ELEMENTS_DRAWN + 1 { ELEMENTS_DRAWN } else { count };
                    let each = group.elements.iter().take(shown);
                    found.extend(each.map(|element| self.part(element.name.to_string(), element)));
                    if count > shown {
                        found.push(Branch::leaf(format!("... and {} more", count - shown)));
                    }
                }
            }
        }
        found
    }

    fn part(&self, name: String, part: &PartElement) -> Branch {
        let at = part.place.as_ref().map_or_else(String::new, |place| {
            let position = place.pose.translation.vector;
            let [x, y, z] = [position.x, position.y, position.z].map(|c| quantity(c, Dimension::LENGTH));
            format!(" at [{x}, {y}, {z}]")
        });
        Branch { text: format!("{name}: {}{at}", part.design.name), below: self.parts(&part.design) }
    }

    /// Returns the names that a configuration gives to ports.
    fn named_ports(&self, def: DefId) -> Vec<String> {
        use crate::check::typed::MemberKind;
        let DefKind::Config(config) = &self.shared.program.def(def).kind else { return Vec::new() };
        let ports = config.members.iter().filter(|m| matches!(m.kind, MemberKind::Port { .. }));
        ports.map(|m| m.name.to_string()).collect()
    }

    fn behaviors(&self, def: DefId) -> Vec<String> {
        let DefKind::Config(config) = &self.shared.program.def(def).kind else { return Vec::new() };
        config.behaviors.iter().map(|b| b.name.to_string()).collect()
    }

    /// Returns a line about a declaration: the signature of a function, the fields of a record, else keyword and name
    /// with facts about the instance with all defaults, such as its order, modules and mass. The facts are left out
    /// where it can't be elaborated.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while its instance with all defaults is elaborated.
    pub(super) fn describe_declaration_line(&mut self, def: DefId) -> Eval<String> {
        let program = self.shared.program;
        let declared = program.def(def);
        let name = declared.name;
        let kind = match &declared.kind {
            DefKind::Fn(function) => {
                let params: Vec<String> = function
                    .params
                    .iter()
                    .map(|p| format!("{}: {}", p.name, program.type_name(&p.ty)))
                    .collect();
                let result = program.type_name(&function.result);
                return Ok(format!("fn {name}({}) -> {result}", params.join(", ")));
            }
            DefKind::Record(record) => {
                let field = |f: &RecordField| format!("{}: {}", f.name, program.type_name(&f.ty));
                let fields: Vec<String> = record.fields.iter().map(field).collect();
                return Ok(format!("record {name} {{ {} }}", fields.join(", ")));
            }
            DefKind::Study(study) => {
                let axes = study.axes.iter().chain(&study.each).map(|axis| axis.name.to_string());
                let row = study.row.map_or_else(String::new, |row| format!(" of {}", program.def(row).name));
                return Ok(format!("study {name}{row}: axes {}", listed(&axes.collect::<Vec<_>>())));
            }
            DefKind::Connector(_) => "connector",
            kind => kind.instantiable().map_or("declared", |body| body.word),
        };
        let facts = self.default_design(def)?.map(|design| match &design.kind {
            DesignKind::Module(module) => {
                let (joints, ports) = (module.module.joints.len(), module.module.ports.len());
                format!(": {}, {}, {}", counted(joints, "joint"), counted(ports, "port"), mass_words(&design))
            }
            DesignKind::Config(_) => format!(": {}", self.config_words(&design)),
            DesignKind::Lattice(lattice) => format!(": {}", counted(lattice.cells.positions.len(), "cell")),
            DesignKind::Truss(truss) => {
                format!(": {}, {}", counted(truss.nodes.len(), "node"), counted(truss.struts.len(), "strut"))
            }
            DesignKind::Cell(_) | DesignKind::Strut(_) => String::new(),
        });
        Ok(format!("{kind} {name}{}", facts.unwrap_or_default()))
    }
}

/// Returns `port` or `ports`, by how many there are.
fn plural(n: usize, what: &str) -> String {
    if n == 1 { what.to_owned() } else { format!("{what}s") }
}

/// Returns a joint in words: `revolute, -90deg..90deg, at most 1.5rad/s`.
fn joint_words(joint: &Joint, dimension: Dimension) -> String {
    let kind = match joint.kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
        JointKind::Fixed => return "fixed".to_owned(),
    };
    let range = match joint.limits.range {
        Some((from, to)) => format!(", {}..{}", quantity(from, dimension), quantity(to, dimension)),
        None => ", continuous".to_owned(),
    };
    let speed = joint.limits.speed.map(|speed| format!(", at most {}", quantity(speed, per_time(dimension))));
    format!("{kind}{range}{}", speed.unwrap_or_default())
}

fn per_time(dimension: Dimension) -> Dimension {
    if dimension == Dimension::LENGTH { Dimension::SPEED } else { Dimension::ANGULAR_SPEED }
}

fn mass_words(design: &Rc<Design>) -> String {
    let links = (0..design.module_count()).map(|m| design.module_type(m));
    let mass: f64 = links.map(|module| module.links.iter().map(|link| link.mass).sum::<f64>()).sum();
    quantity(mass, Dimension::MASS)
}

/// Returns the free ports, by module: `m[0].left`, as in the robot that the instance belongs to.
fn free_of(instance: &Instance) -> Vec<String> {
    let robot = &instance.robot;
    let lone = ConfigDesign::default();
    let config = robot.config().unwrap_or(&lone);
    let modules = instance.modules.indices(instance.design.module_count());
    modules
        .flat_map(|module| {
            let name = robot.module_name(module);
            free_ports(config, robot, module).map(move |port| format!("{name}.{port}")).collect::<Vec<_>>()
        })
        .collect()
}
