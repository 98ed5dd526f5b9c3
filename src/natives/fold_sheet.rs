//! Panels joined as a flat pattern says: the robot that folds, and its program.

use crate::elaborate::robot_of::Robot;
use crate::geometry::Pose;
use crate::interpret::design::{BondRecord, ConfigDesign, Design, DesignKind, FlatModule};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target as MoveTarget};
use crate::planners::fold::{Layout, Target};
use crate::robot::{JointId, State};
use crate::source::Span;
use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

/// Why panels are no robot that folds.
pub enum NoSheet {
    /// The module is not sound; that has been reported.
    Unsound,
    /// Edges that meet have no hinge.
    NoHinge,
}

/// What folds.
pub struct Sheet {
    /// Its own pose is the folded one.
    pub design: Rc<Design>,
    pub robot: Rc<Robot>,
    /// All panels level.
    pub flat: State,
}

/// A pattern with what it is made of.
pub struct Pieces<'t> {
    pub target: &'t Target,
    pub layout: &'t Layout,
    /// By face.
    pub panels: &'t [Rc<Design>],
    pub span: Span,
}

impl Pieces<'_> {
    fn angle(&self, face: usize) -> f64 {
        self.layout.hinge[face].map_or(0.0, |hinge| self.target.hinges[hinge].angle)
    }

    /// One step after the other, each of `step` seconds.
    pub fn program(&self, robot: &Robot, order: &[Vec<usize>], step: f64) -> Arc<Node> {
        let fold = |face: usize| {
            let joint = robot.kinematics.hinge(bond_of(self.layout, face)).expect("every bond has a hinge");
            let command = Command::Move {
                joint: JointId(joint as u32),
                target: MoveTarget::To(self.angle(face)),
                duration: Some(step),
                profile: Profile::Smooth,
            };
            let otherwise = Otherwise::Proceed;
            Node::Action(Action { command, until: None, timeout: None, otherwise, cause: CauseId(0) })
        };
        let moving = |faces: &Vec<usize>| -> Vec<Arc<Node>> {
            let faces = faces.iter().filter(|face| self.angle(**face) != 0.0);
            faces.map(|face| Arc::new(fold(*face))).collect()
        };
        let steps = order.iter().map(moving).filter(|moves| !moves.is_empty());
        Arc::new(Node::Series(steps.map(|moves| Arc::new(Node::Parallel(moves))).collect()))
    }

    /// The panels of a layout joined by their hinges.
    pub fn sheet(&self, interpreter: &mut Interpreter) -> Eval<Result<Sheet, NoSheet>> {
        let level = self.joined();
        let Some(robot) = interpreter.robot_of(&level)? else { return Ok(Err(NoSheet::Unsound)) };
        if (0..robot.assembly.bonds.len()).any(|bond| robot.kinematics.hinge(bond).is_none()) {
            return Ok(Err(NoSheet::NoHinge));
        }
        let mut start = robot.start.clone();
        for &face in &self.layout.order[1..] {
            let joint = robot.kinematics.hinge(bond_of(self.layout, face)).expect("every bond has a hinge");
            start.joints[joint] = self.angle(face);
        }
        let mut poses = vec![Pose::identity(); robot.kinematics.link_count()];
        robot.kinematics.link_poses(&start.joints, &Pose::identity(), &mut poses);
        let folded =
            Robot { assembly: robot.assembly.clone(), start, kinematics: robot.kinematics.clone(), poses };
        let folded = Rc::new(folded);
        let design = self.joined();
        let config = design.config().expect("made as a configuration");
        assert!(config.robot.set(Some(folded.clone())).is_ok(), "it was just made");
        Ok(Ok(Sheet { design, robot: folded, flat: robot.start.clone() }))
    }

    fn joined(&self) -> Rc<Design> {
        let name = |face: usize| -> Rc<str> { format!("panel[{face}]").into() };
        let panels = self.panels.iter().enumerate();
        let modules = panels.map(|(face, panel)| FlatModule { name: name(face), design: panel.clone() });
        let config = ConfigDesign::of_modules(modules.collect());
        for &face in &self.layout.order[1..] {
            let across = self.layout.across(self.target, face);
            config.add_bond(BondRecord {
                a: (across.parent, across.parent_side),
                b: (face, across.side),
                turn: 0,
                span: self.span,
                ends: (self.span, self.span),
                instance: "".into(),
            });
        }
        config.base.set(Some(self.layout.root));
        config.complete.set(true);
        let panel = &self.panels[self.layout.root];
        Rc::new(Design {
            // Of its panels: no declaration of its own stands behind it.
            def: panel.def,
            name: format!("{}[{}]", panel.name, self.panels.len()),
            args: Vec::new(),
            kind: DesignKind::Config(config),
            broken: Cell::new(false),
        })
    }
}

/// Bonds are made in the layout's order, one for each face but the root.
fn bond_of(layout: &Layout, face: usize) -> usize {
    layout.order.iter().position(|f| *f == face).expect("the order names every face") - 1
}
