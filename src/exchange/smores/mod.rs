//! Robots and motions of the published tools for SMORES, as configurations and behaviours of the language: `.conf`,
//! `.struct` and `.gait` files of the simulator and designer of 2013 to 2015, and the XML of VSPARC, which followed them.
//!
//! Frames and signs are those that the tools' own sources state (MOD-ASL/designer, MOD-ASL/SimulationPlugins,
//! MOD-ASL/GAZEBO_model, MOD-ASL/ModularRobotSystemToolKit), held against the positions in their published files.
//! docs/exchange.md has the tables.

mod configuration;
mod gait;
mod order;
mod parts;
mod structure;
mod text;
mod vsparc;
mod xml;

use super::import_fault::{ImportFault, document};
use super::module_text::{ImportFile, Imported, import_urdf};
use parts::{Motion, Robot};
use roxmltree::{Document, Node};

/// The file of an import, by its index, and what is wrong in it.
pub type FaultIn = (usize, ImportFault);

/// The number of modules that a robot may have, as in the language.
const MODULES_MAX: usize = 10_000;
/// The number of commands that one motion may have.
const COMMANDS_MAX: usize = 10_000;

/// Returns the robot that files of other programs make: a description in URDF becomes a module; a configuration of the
/// SMORES tools becomes a configuration, with a behaviour for each of the motions that follow it. `open` returns the bytes of
/// a file that a file names, if there is one.
///
/// # Errors
/// The first [`ImportFault`], with the index of its file.
pub fn import(
    files: &[ImportFile],
    open: &mut dyn FnMut(&str) -> Option<Vec<u8>>,
) -> Result<Imported, FaultIn> {
    let Some((first, others)) = files.split_first() else {
        return Err((0, ImportFault::of_file("there is no file")));
    };
    if !first.text.trim_start().starts_with('<') && first.name.ends_with(".gait") {
        let message = "a gait moves the modules of a configuration, which stands before it: `modl import robot.conf walk.gait`";
        return Err((0, ImportFault::of_file(message)));
    }
    let document = document(first.text).map_err(|fault| (0, fault))?;
    let root = document.root_element();
    let robot = match root.tag_name().name() {
        "configuration" => configuration::read(&document),
        "Structure" => structure::read(&document, open),
        "RobotStateObject" | "RobotState" => vsparc::read(&document),
        "Behavior" => Err(ImportFault::at_node(
            root,
            "a behaviour of VSPARC moves the modules of a configuration, which stands before it: `modl import robot.xml \
             walk.xml`",
        )),
        _ if others.is_empty() => {
            return import_urdf(first.text, first.name, open).map_err(|fault| (0, fault));
        }
        _ => {
            let message = "a robot description becomes a module, and has no behaviours beside it";
            return Err((1, ImportFault::of_file(message)));
        }
    };
    let mut robot = robot.map_err(|fault| (0, fault))?;
    robot.check_bonds().map_err(|fault| (0, fault))?;
    let mut motions = Vec::new();
    for (index, file) in others.iter().enumerate() {
        motions.push(motion(file, &mut robot).map_err(|fault| (index + 1, fault))?);
    }
    Ok(text::write(first.name, &mut robot, &motions))
}

/// Returns the motion that a file states for a robot.
fn motion(file: &ImportFile, robot: &mut Robot) -> Result<Motion, ImportFault> {
    let graph = if file.text.trim_start().starts_with('<') {
        let document = document(file.text)?;
        vsparc::read_behavior(&document, robot)?
    } else {
        gait::read(file.text, robot)?
    };
    Ok(Motion { file: file.name.to_owned(), graph })
}
