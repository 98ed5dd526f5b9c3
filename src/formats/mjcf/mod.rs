//! Robots with their plans as models of MuJoCo (MJCF, `.mjcf.xml`).
//!
//! A model is written with explicit masses, so that nothing is inferred from shapes: a body for each link, with the
//! frame that the link has here. Links that hang together during the whole plan are one tree of bodies. Bonds that
//! close loops, and those that dock or undock on the way, are constraints. The servos and the stiffness of contacts and
//! constraints, which the language does not state yet, stand in `servo` and here, and in the `default` element of the
//! model.
#![allow(non_snake_case)]

mod bodies;
mod connections;
mod fault;
mod floor_contacts;
mod servo;
mod tree;

use crate::formats::xml::{Xml, number, numbers};
use crate::plan::verify::articulated::start_poses;
use crate::plan::{DockingKind, Ground, Plan, Tracks, World, validation};
pub use fault::MjcfFault;
use floor_contacts::FloorContacts;
use tree::Trees;

/// The ending of the names of MuJoCo model files, after the first dot.
pub const ENDING: &str = "mjcf.xml";

/// The step of the simulation, s. At 1 ms what should stick creeps under stiff servos.
const TIME_STEP: f64 = 2.5e-4;
/// The ratio of the stiffness of friction to that of the normal force. With MuJoCo's own, 1, feet creep; the softer the
/// constraint of the normal force, the greater it has to be.
const FRICTION_STIFFNESS: f64 = 2000.0;
/// The time constant of constraints, s; two steps at least. MuJoCo's own, 0.02 s, is soft for a bond.
const BOND_TIME: f64 = 4e-3;
/// The stiffness of contacts for each kilogram that rests on them, N/m: a module of 0.5 kg yields by 50 µm. With that of MuJoCo's
/// own time constant of 0.02 s the ground is softer than the servos, and a robot on many feet has all of them down, which it has
/// not.
const CONTACT_STIFFNESS: f64 = 2e5;
/// The damping of contacts for each kilogram that rests on them, N·s/m. Divided by [`CONTACT_IMPEDANCE`] it is the rate (1/s) at which
/// slip decays where friction holds, at most the inverse of the time step.
const CONTACT_DAMPING: f64 = 70.0;
/// The part of a contact's acceleration that its constraint removes, 0 to 1. With MuJoCo's own, 0.9 to 0.95, contacts that slide
/// are lifted off the ground: they hop, and their friction is not against their slip. The less, the more they are springs.
const CONTACT_IMPEDANCE: f64 = 0.1;
/// The coefficient of friction of the floor and of obstacles. It is not used: pairs state their own, and else links have the higher
/// priority, so that theirs counts.
const FLOOR_FRICTION: f64 = 1e-3;

/// The greatest number of bodies inside each other that MuJoCo's reader takes, by trial with its version 4.0.
const DEPTH_MAX: usize = 496;

/// Returns the MuJoCo model (MJCF, XML) of a plan's robot, with the state in which the plan starts as the keyframe
/// `start`: all robots stand where the judge places them, among the plan's obstacles. The text is the same for the same
/// plan.
///
/// # Errors
/// A [`MjcfFault`] for a lattice or truss, for a plan that is not valid, and for a chain of too many links.
pub fn write(plan: &Plan) -> Result<String, MjcfFault> {
    let tracks = plan.body.tracks().ok_or(MjcfFault::NoJoints)?;
    validation::check(plan).map_err(MjcfFault::Invalid)?;
    let (X_WB, clusters) = start_poses(plan, tracks);
    let trees = Trees::new(tracks, &X_WB, &clusters);
    let depth = trees.depth();
    if depth > DEPTH_MAX {
        return Err(MjcfFault::TooDeep { depth, most: DEPTH_MAX });
    }
    Ok(model(plan, tracks, &trees))
}

/// The names by which a MuJoCo model is driven along a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Drives {
    /// The actuators in the order of the model's, each as (name, terms): its command is the sum of factor times the
    /// position (rad or m) of a joint, given by its number, over the terms.
    pub actuators: Vec<(String, Vec<(usize, f64)>)>,
    /// The equality constraints of bonds that are in no tree, each as (index of the bond, name).
    pub constraints: Vec<(usize, String)>,
}

/// Returns the names by which the MuJoCo model of a plan is driven: those of the model that [`write()`] returns.
///
/// # Errors
/// As for [`write()`].
pub fn drives(plan: &Plan) -> Result<Drives, MjcfFault> {
    let tracks = plan.body.tracks().ok_or(MjcfFault::NoJoints)?;
    validation::check(plan).map_err(MjcfFault::Invalid)?;
    let trees = Trees::new(tracks, &tracks.start.base, &tracks.start.clusters);
    let driven = trees.moved().into_iter().filter(|(joint, _)| trees.is_driven(*joint));
    let terms = |link: usize| trees.steps[link].as_ref().map_or(Vec::new(), |step| step.terms().to_vec());
    let actuators = driven.map(|(joint, link)| (trees.joint_name(joint), terms(link))).collect();
    let names = |&bond: &usize| {
        let names = connections::constraint_names(&trees, bond);
        names.into_iter().map(move |name| (bond, name)).collect::<Vec<_>>()
    };
    let constraints = trees.constraints.iter().flat_map(names).collect();
    Ok(Drives { actuators, constraints })
}

fn model(plan: &Plan, tracks: &Tracks, trees: &Trees) -> String {
    let world = plan.worlds.first().map_or(World::FREE, |first| first.world);
    let mut floor_contacts = FloorContacts::of(plan, tracks, trees, &world);
    let mut xml = Xml::new();
    xml.open("mujoco", &[("model", tracks.robot.name.clone())]);
    notes(&mut xml, plan, tracks);
    xml.leaf("compiler", &[("angle", "radian".into()), ("autolimits", "true".into())]);
    // A robot that floats is judged without weight.
    let gravity = if world.ground == Ground::Off { 0.0 } else { world.gravity };
    xml.leaf(
        "option",
        &[
            ("timestep", number(TIME_STEP)),
            ("gravity", numbers([0.0, 0.0, -gravity])),
            ("integrator", "implicitfast".into()),
            ("cone", "elliptic".into()),
            ("impratio", number(FRICTION_STIFFNESS)),
        ],
    );
    xml.open("default", &[]);
    xml.leaf(
        "geom",
        &[
            ("condim", "3".into()),
            ("priority", "1".into()),
            ("solref", numbers([-CONTACT_STIFFNESS, -CONTACT_DAMPING])),
            ("solimp", numbers([CONTACT_IMPEDANCE, CONTACT_IMPEDANCE])),
            ("contype", "3".into()),
            ("conaffinity", "3".into()),
        ],
    );
    if let Some(contacts) = &floor_contacts {
        contacts.defaults(&mut xml, CONTACT_STIFFNESS, CONTACT_IMPEDANCE);
    }
    xml.leaf("equality", &[("solref", numbers([BOND_TIME, 1.0]))]);
    servo::defaults(&mut xml);
    xml.close("default");
    bodies::assets(&mut xml, trees, &tracks.obstacles);
    xml.open("worldbody", &[]);
    if world.has_floor() {
        xml.comment("Contacts of links with the floor are those of the pairs below.");
        let mut floor = vec![
            ("name", "floor".into()),
            ("type", "plane".into()),
            ("size", numbers([0.0, 0.0, 1.0])),
            ("contype", "1".into()),
            ("conaffinity", "1".into()),
            ("priority", "0".into()),
            ("friction", number(FLOOR_FRICTION)),
        ];
        if world.is_sloped() {
            let turn = world.ground_pose().rotation;
            floor.push(("quat", numbers([turn.w, turn.i, turn.j, turn.k])));
        }
        xml.leaf("geom", &floor);
    }
    bodies::obstacles(&mut xml, &tracks.obstacles, FLOOR_FRICTION);
    let held = matches!(world.ground, Ground::Fixed | Ground::Held);
    bodies::bodies(&mut xml, trees, held, world.friction, floor_contacts.as_mut());
    xml.close("worldbody");
    xml.open("contact", &[]);
    connections::exclusions(&mut xml, trees);
    if let Some(contacts) = floor_contacts {
        contacts.pairs(&mut xml);
    }
    xml.close("contact");
    connections::couplings(&mut xml, trees, &tracks.start.bonds);
    servo::actuators(&mut xml, trees);
    connections::start(&mut xml, trees, held, &tracks.start.joints);
    xml.close("mujoco");
    xml.into_text()
}

/// Adds comments that say what the model is of, and what it leaves out.
fn notes(xml: &mut Xml, plan: &Plan, tracks: &Tracks) {
    let robot = &tracks.robot;
    xml.comment(&format!(
        "{}, from modl. SI units, z up; bodies, joints and constraints have the plan's names.",
        robot.name
    ));
    if plan.worlds.len() > 1 {
        let later: Vec<String> = plan.worlds[1..].iter().map(|w| format!("{} s", number(w.from))).collect();
        xml.comment(&format!(
            "The world is that of the start; in the plan it changes at {}.",
            later.join(", ")
        ));
    }
    for event in &tracks.events {
        let what = match event.kind {
            DockingKind::Dock => "docks",
            DockingKind::Undock => "undocks",
        };
        let name = robot.bond_name(event.bond);
        xml.comment(&format!("At {} s {name} {what}.", number(event.time)));
    }
}
