//! Panels joined by the hinges of a layout, as a configuration of the language.

use crate::interpret::design::{BondRecord, ConfigDesign, Design, DesignKind, FlatModule};
use crate::interpret::robot::Robot;
use crate::planners::fold::{Layout, Panels, Sheet, Target};
use crate::source::Span;
use std::cell::Cell;
use std::rc::Rc;

/// A layout of a target with the designs of the panels that it joins, by face.
pub(super) struct Joined<'t> {
    /// The surface that is folded, whose faces are the panels.
    pub target: &'t Target,
    /// The layout of the surface, by which the panels are joined.
    pub layout: &'t Layout,
    /// The designs of the panels: entry k is that of the panel for face k of the target.
    pub designs: &'t [Rc<Design>],
    /// The span of the call that joins them.
    pub span: Span,
}

impl Joined<'_> {
    /// Returns (configuration, robot) of the panels, joined along the layout; the start state of the robot is the
    /// folded one. `panels`: the panels as the planner was given them.
    pub(super) fn design(&self, panels: &Panels) -> (Rc<Design>, Rc<Robot>) {
        let sheet = Sheet::new(self.target, panels, self.layout).expect("the planner joined it");
        let start = sheet.folded(self.target, self.layout);
        let robot = Rc::new(Robot::alone(sheet.assembly, start));
        let design = self.joined();
        let config = design.config().expect("made as a configuration");
        assert!(config.robot.set(Some(robot.clone())).is_ok(), "it was just made");
        (design, robot)
    }

    /// Returns the configuration of the panels, with a bond for each hinge of the layout and the root as its
    /// base.
    fn joined(&self) -> Rc<Design> {
        let name = |face: usize| -> Rc<str> { format!("panel[{face}]").into() };
        let panels = self.designs.iter().enumerate();
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
        let panel = &self.designs[self.layout.root];
        Rc::new(Design {
            // Of its panels: it has no declaration of its own.
            def: panel.def,
            name: format!("{}[{}]", panel.name, self.designs.len()),
            args: Vec::new(),
            kind: DesignKind::Config(config),
            broken: Cell::new(false),
        })
    }
}
