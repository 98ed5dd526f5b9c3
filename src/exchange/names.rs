//! The names of links and joints in files of other programs: those of the plan, where such files can hold them.

use crate::robot::Assembly;
use std::collections::BTreeSet;

/// The names of a robot's links and joints in exported files, the same in all formats. They are the plan's path names,
/// with a `_` for each control character, which XML attributes do not keep; where two become one, the later gets a
/// number.
pub(super) struct Names {
    /// The name of each link, by its number.
    pub(super) links: Vec<String>,
    /// The name of each joint, by the number in its `JointId`.
    pub(super) joints: Vec<String>,
}

impl Names {
    /// Returns the names of a robot.
    pub(super) fn of(robot: &Assembly) -> Names {
        let links = (0..robot.modules.len()).flat_map(|module| {
            let own = &robot.modules[module].name;
            robot.module_type(module).links.iter().map(move |link| format!("{own}.{}", link.name))
        });
        let joints = robot.joints().map(|owner| robot.joint_name(owner));
        Names { links: unique(links), joints: unique(joints) }
    }
}

/// Returns names without control characters, each once.
fn unique(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut known = BTreeSet::new();
    let once = |name: String| {
        let plain: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
        let numbered = (2..).map(|number| format!("{plain} ({number})"));
        let free = std::iter::once(plain.clone()).chain(numbered).find(|name| !known.contains(name));
        let free = free.expect("numbers do not end");
        known.insert(free.clone());
        free
    };
    names.map(once).collect()
}

/// Returns a text as part of a file name that every system and every URI takes: letters, digits, `-` and `_`; others
/// become `_`.
pub(super) fn plain_file_name(text: &str) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let plain: String = text.chars().map(kept).collect();
    if plain.is_empty() { "_".to_owned() } else { plain }
}
