//! `modl what` and `:what`: what the standard library can do with a robot, as text and as JSON.

use super::arguments::Globals;
use super::report::Report;
use super::terminal::print;
use crate::session::{EmbeddedConfiguration, Repertoire};
use crate::units::counted;
use serde::Serialize;

/// A robot with the configurations that embed in it, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct JsonRobot {
    /// The name of the robot's design, with the arguments that differ from its defaults.
    pub name: String,
    /// The number of modules of the robot.
    pub modules: usize,
    /// The configurations that embed in the robot, first its own.
    pub configurations: Vec<JsonConfiguration>,
}

/// A configuration that embeds in a robot, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct JsonConfiguration {
    /// The name of the configuration, of one of the library its path.
    pub name: String,
    /// The number of its embeddings.
    pub embeddings: usize,
    /// The signatures of its behaviours.
    pub behaviors: Vec<String>,
}

/// Tells what the library can do with a robot: prints it, or adds it to the JSON object.
pub(super) fn tell(repertoire: Repertoire, report: &mut Report, globals: &Globals) {
    if !globals.json {
        print(&text(&repertoire));
        return;
    }
    let configuration = |EmbeddedConfiguration { name, embeddings, behaviors }| JsonConfiguration {
        name,
        embeddings,
        behaviors,
    };
    let Repertoire { robot: name, modules, configurations } = repertoire;
    let configurations = configurations.into_iter().map(configuration).collect();
    report.robot = Some(JsonRobot { name, modules, configurations });
}

/// Returns the configurations as text, each with its behaviours.
fn text(repertoire: &Repertoire) -> String {
    let Repertoire { robot, modules, configurations } = repertoire;
    let mut out = format!("{robot}: {}\n", counted(*modules, "module"));
    if configurations.is_empty() {
        out.push_str("no configuration of the library embeds in it\n");
    }
    for EmbeddedConfiguration { name, embeddings, behaviors } in configurations {
        let none = if behaviors.is_empty() { ", no behaviors" } else { "" };
        out.push_str(&format!("\n{name}: {}{none}\n", counted(*embeddings, "embedding")));
        behaviors.iter().for_each(|behavior| out.push_str(&format!("  {behavior}\n")));
    }
    out
}
