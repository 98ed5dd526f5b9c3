//! The robot of a design, for the back end (robotics): one assembly with its library, its start state and
//! kinematics.

use super::tolerances::TOLERANCES;
use crate::check::typed::DefId;
use crate::geometry::{Pose, Vec3};
use crate::interpret::design::{Design, DesignKind, PartElement};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::robot::{Robot, joint_index};
use crate::interpret::stop::{Eval, Stop};
use crate::robot::{Assembly, Bond, Kinematics, Library, ModuleInstance, PortRef, State};
use crate::source::{Diagnostic, Span, code};
use std::rc::Rc;
use std::sync::Arc;

impl Interpreter<'_> {
    /// Returns the robot of a design, assembled once; `None` where it is broken, not complete yet, or no robot.
    ///
    /// # Errors
    /// A fault at `span` where it has no modules, a fault of a declaration that the robot needs, or `Stop::Halt` if a
    /// limit is reached or the user cancels.
    pub(super) fn assemble_robot(&mut self, design: &Rc<Design>, span: Span) -> Eval<Option<Rc<Robot>>> {
        let cell = match &design.kind {
            DesignKind::Module(module) => &module.robot,
            DesignKind::Config(config) if config.complete.get() && !design.broken.get() => &config.robot,
            _ => return Ok(None),
        };
        if let Some(robot) = cell.get() {
            return Ok(robot.clone());
        }
        if design.module_count() == 0 {
            return Err(self.no_modules(design, span));
        }
        let robot = self.build_robot(design)?.map(Rc::new);
        // Building does not come back here, so the cell is still empty.
        Ok(cell.get_or_init(|| robot).clone())
    }

    fn no_modules(&self, design: &Rc<Design>, span: Span) -> Stop {
        let declared = self.shared.program.def(design.def).span;
        let message = format!("`{}` has no modules, so there is no robot", design.name);
        let diagnostic = Diagnostic::error(code::NO_MODULES, message).label(span, "a robot is wanted here");
        let diagnostic = if span == declared {
            diagnostic
        } else {
            diagnostic.label(declared, "declared without modules")
        };
        diagnostic.hint("a `part` of a module, or of a configuration with modules, is missing").into()
    }

    /// Assembles the robot of a design in its start state; `None` where a connector is broken. The base, if
    /// none is named, is the most central of the candidates.
    fn build_robot(&mut self, design: &Rc<Design>) -> Eval<Option<Robot>> {
        let Some((library, kinds)) = self.library_of(design)? else { return Ok(None) };
        let modules = kinds
            .iter()
            .enumerate()
            .map(|(index, kind)| ModuleInstance { name: design.module_name(index).to_string(), kind: *kind });
        let bonds = design.bonds().into_iter().map(|bond| Bond {
            a: PortRef { module: bond.a.0, port: bond.a.1 },
            b: PortRef { module: bond.b.0, port: bond.b.1 },
            turn: bond.turn,
        });
        let named = design.config().and_then(|config| config.base.get());
        let mut assembly = Assembly {
            name: design.name.clone(),
            library: Arc::new(library),
            modules: modules.collect(),
            bonds: bonds.collect(),
            base: named.unwrap_or(0),
            closed: design.config().is_some_and(|config| config.closed),
            misalignments: vec![],
        };
        let holds = vec![true; assembly.bonds.len()];
        if let Some(scene) = design.scene() {
            let kinematics = Kinematics::new(&assembly, &holds, assembly.base);
            let joints = start_joints(design, &assembly, &kinematics);
            let (start, poses) = self.place_robots(design, &mut assembly, joints)?;
            let kinematics = Kinematics::new(&assembly, &holds, assembly.base);
            let (assembly, obstacles, world) = (Arc::new(assembly), design.obstacles(), scene.world.get());
            return Ok(Some(Robot { assembly, start, kinematics, poses, obstacles, world }));
        }
        let mut kinematics = Kinematics::new(&assembly, &holds, assembly.base);
        let joints = start_joints(design, &assembly, &kinematics);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&joints, &Pose::identity(), &mut poses);
        if named.is_none() {
            let candidates = self.base_candidates(design, &assembly)?;
            assembly.base = central_module(&assembly, &kinematics, &poses, &candidates);
            kinematics = Kinematics::new(&assembly, &holds, assembly.base);
            kinematics.link_poses(&joints, &Pose::identity(), &mut poses);
        }
        let start =
            State { joints, bonds: holds, base: Pose::identity(), clusters: vec![], misalignments: vec![] };
        let (assembly, obstacles, world) = (Arc::new(assembly), Arc::default(), None);
        Ok(Some(Robot { assembly, start, kinematics, poses, obstacles, world }))
    }

    /// Returns the modules that may be the base where none is named: that of each part than which no other is
    /// heavier. A car with a long arm stands on the car, whichever module is nearest to the centre of mass.
    /// Every module is a candidate where all parts are single modules.
    fn base_candidates(&mut self, design: &Rc<Design>, assembly: &Assembly) -> Eval<Vec<usize>> {
        let Some(parts) = design.config().and_then(|config| config.parts.get()) else { return Ok(vec![0]) };
        let mass_of = |part: &PartElement| -> f64 {
            let modules = part.offset..part.offset + part.design.module_count();
            modules.flat_map(|m| &assembly.module_type(m).links).map(|link| link.mass).sum()
        };
        let elements: Vec<&PartElement> = parts.iter().flat_map(|group| &group.elements).collect();
        if elements.iter().all(|part| part.design.module_count() == 1) {
            return Ok((0..assembly.modules.len()).collect());
        }
        let masses: Vec<f64> = elements.iter().map(|part| mass_of(part)).collect();
        let heaviest = masses.iter().copied().fold(0.0, f64::max) * (1.0 - TOLERANCES.tie_mass);
        let mut candidates = Vec::new();
        let heavy = elements.iter().zip(&masses).filter(|(_, mass)| **mass >= heaviest);
        for (part, _) in heavy.filter(|(part, _)| part.design.module_count() > 0) {
            let base = self
                .assemble_robot(&part.design, self.shared.program.def(design.def).span)?
                .map_or(0, |robot| robot.assembly.base);
            candidates.push(part.offset + base);
        }
        Ok(candidates)
    }

    /// Returns (library, types) of a robot: its module types and connectors, and for each of its modules, in order,
    /// the index of its type in that library; `None` where a connector is broken.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels while a connector is elaborated.
    pub(crate) fn library_of(&mut self, design: &Rc<Design>) -> Eval<Option<(Library, Vec<usize>)>> {
        let mut types: Vec<Rc<Design>> = Vec::new();
        let mut kinds = Vec::new();
        for index in 0..design.module_count() {
            let module = design.module_at(index);
            let known = types.iter().position(|t| Rc::ptr_eq(t, &module));
            kinds.push(known.unwrap_or_else(|| {
                types.push(module);
                types.len() - 1
            }));
        }
        let of_types = types.iter().filter_map(|t| t.module()).flat_map(|m| m.connectors.iter().copied());
        let Some(connectors) = self.with_mates(of_types.collect())? else { return Ok(None) };
        let mut library = Library::default();
        let index_of = |def: DefId| connectors.iter().position(|d| *d == def);
        for def in &connectors {
            let Some(design) = self.connector(*def)? else { return Ok(None) };
            let mut connector = design.connector.clone();
            connector.mates = design.mates.iter().filter_map(|mate| index_of(*mate)).collect();
            library.connectors.push(connector);
        }
        for module in types.iter().filter_map(|t| t.module()) {
            let mut kind = module.module.as_ref().clone();
            for port in &mut kind.ports {
                port.connector =
                    index_of(module.connectors[port.connector]).expect("all connectors were collected");
            }
            library.modules.push(kind);
        }
        Ok(Some((library, kinds)))
    }

    /// Returns the connectors and, transitively, those that they mate with, each once; `None` where one is
    /// broken.
    fn with_mates(&mut self, first: Vec<DefId>) -> Eval<Option<Vec<DefId>>> {
        let mut all: Vec<DefId> = Vec::new();
        let mut waiting: std::collections::VecDeque<DefId> = first.into();
        while let Some(def) = waiting.pop_front() {
            if all.contains(&def) {
                continue;
            }
            let Some(design) = self.connector(def)? else { return Ok(None) };
            all.push(def);
            waiting.extend(design.mates.iter().copied());
        }
        Ok(Some(all))
    }
}

/// Returns the positions of all joints at the start, rad or m: as `set`, else 0.
fn start_joints(design: &Rc<Design>, assembly: &Assembly, kinematics: &Kinematics) -> Vec<f64> {
    let mut joints = vec![0.0; assembly.joints().count()];
    for set in design.sets() {
        joints[joint_index(kinematics, set.joint)] = set.value;
    }
    joints
}

/// Returns the candidate module whose centre of mass is nearest to that of the whole; of several the first by
/// name, and 0 without candidates.
fn central_module(
    assembly: &Assembly,
    kinematics: &Kinematics,
    poses: &[Pose],
    candidates: &[usize],
) -> usize {
    let (centre, _) = kinematics.centre_of_mass(assembly, poses);
    let distance = |module: usize| {
        let (mut moment, mut mass) = (Vec3::zeros(), 0.0);
        for (link, declared) in kinematics.links_of(module).zip(&assembly.module_type(module).links) {
            moment += (poses[link] * nalgebra::Point3::from(declared.com)).coords * declared.mass;
            mass += declared.mass;
        }
        (moment / mass - centre).norm()
    };
    let distances: Vec<f64> = candidates.iter().map(|&m| distance(m)).collect();
    let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
    let near = candidates.iter().zip(&distances).filter(|(_, d)| **d <= least + TOLERANCES.tie_distance);
    let names = &assembly.modules;
    near.map(|(&m, _)| m).min_by(|&a, &b| names[a].name.cmp(&names[b].name)).unwrap_or(0)
}
