//! Panels joined as a layout says: the assembly that folds, its program, and its plan before the judge.

use super::layout::Layout;
use super::panel::Panels;
use super::target::Target;
use super::turns::Turn;
use crate::geometry::Pose;
use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target as MoveTarget};
use crate::robot::{Assembly, Bond, JointId, Kinematics, ModuleInstance, PortRef, State};
use std::sync::Arc;

/// A layout as a robot: an assembly of panel modules that are joined by hinges, flat at first.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The assembly: module k is the panel of face k of the target; bond i joins face `layout.order[i + 1]` to its
    /// parent.
    pub assembly: Assembly,
    /// For each bond of the assembly, in their order, the joint of its hinge.
    pub joints: Vec<JointId>,
    /// The state with all panels level, all bonds closed, and the root's panel at the origin.
    pub flat: State,
}

/// The reason why panels are not a sheet: the connector of a bond of the layout has no hinge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoHinge;

impl Sheet {
    /// Returns the assembly of the panels of a target, bonded along the hinges of a layout and lying flat.
    ///
    /// # Errors
    /// [`NoHinge`] if the connector of a bond of the layout has no hinge.
    pub fn new(target: &Target, panels: &Panels, layout: &Layout) -> Result<Sheet, NoHinge> {
        let name = &panels.library.modules[panels.kinds[layout.root]].name;
        let module =
            |(face, kind): (usize, &usize)| ModuleInstance { name: format!("panel[{face}]"), kind: *kind };
        let bond = |face: &usize| {
            let across = layout.across(target, *face);
            let a = PortRef { module: across.parent, port: across.parent_side };
            Bond { a, b: PortRef { module: *face, port: across.side }, turn: 0 }
        };
        let assembly = Assembly {
            name: format!("{name}[{}]", panels.kinds.len()),
            library: panels.library.clone(),
            modules: panels.kinds.iter().enumerate().map(module).collect(),
            bonds: layout.order[1..].iter().map(bond).collect(),
            base: layout.root,
            closed: false,
            misalignments: vec![],
        };
        let holds = vec![true; assembly.bonds.len()];
        let kinematics = Kinematics::new(&assembly, &holds, assembly.base);
        let joint = |bond: usize| kinematics.hinge(bond).map(|joint| JointId(joint as u32)).ok_or(NoHinge);
        let joints = (0..assembly.bonds.len()).map(joint).collect::<Result<Vec<_>, _>>()?;
        let flat = State {
            joints: vec![0.0; assembly.joints().count()],
            bonds: holds,
            base: Pose::identity(),
            clusters: vec![],
            misalignments: vec![],
        };
        Ok(Sheet { assembly, joints, flat })
    }

    /// Returns the state in which every hinge is at its fold angle in the target, all bonds are closed, and the root's
    /// panel is at the world's origin. `target` and `layout`: the surface and the layout that the sheet was made from.
    pub fn folded(&self, target: &Target, layout: &Layout) -> State {
        let mut state = self.flat.clone();
        for (joint, face) in self.joints.iter().zip(&layout.order[1..]) {
            state.joints[joint.0 as usize] = layout.angle(target, *face);
        }
        state
    }

    /// Returns the joint of the hinge between a face (an index in [`Target::faces`]) and its parent. `layout`: the
    /// layout that the sheet was made from. Panics for the root, which has none, and for an index that is not a face.
    pub fn joint(&self, layout: &Layout, face: usize) -> JointId {
        let place = layout.order.iter().position(|f| *f == face).expect("the order names every face");
        self.joints[place - 1]
    }

    /// Returns the program that folds the sheet in steps of `time` seconds; `turns`: for each step the turns of the
    /// hinges that move at the same time. Hinges that stay as they are get no action, steps without motion are left
    /// out, and all actions have cause 0. `layout`: the layout that the sheet was made from. The root, if named, gets no
    /// action either.
    pub fn program(&self, layout: &Layout, turns: &[Vec<Turn>], time: f64) -> Arc<Node> {
        let moving = |turns: &Vec<Turn>| -> Vec<Arc<Node>> {
            let bent = turns.iter().filter(|turn| turn.to != turn.from);
            bent.map(|Turn { face, to, .. }| Arc::new(turn(self.joint(layout, *face), *to, time))).collect()
        };
        let steps = turns.iter().map(moving).filter(|moves| !moves.is_empty());
        Arc::new(Node::Series(steps.map(|moves| Arc::new(Node::Parallel(moves))).collect()))
    }
}

/// Returns the action of cause 0 that moves a joint to a position (rad) in a time (s) by the quintic law.
pub(crate) fn turn(joint: JointId, to: f64, time: f64) -> Node {
    let target = MoveTarget::To(to);
    action(Command::Move { joint, target, duration: Some(time), profile: Profile::Smooth })
}

/// Returns a command as a plan node: an action of cause 0 without a condition to wait for and without a timeout.
pub(crate) fn action(command: Command) -> Node {
    let otherwise = Otherwise::Proceed;
    Node::Action(Action { command, until: None, timeout: None, otherwise, cause: CauseId(0) })
}
