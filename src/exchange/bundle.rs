//! All formats of a plan in one folder, with a page that says how they are opened.

use super::export::{Export, ExportFile};
use super::plan_formats::PLAN_FORMATS;

/// The formats that a bundle leaves out: the same again, or as many files as pictures.
const LEFT_OUT: &[&str] = &["trajectory-json", "frames"];

/// Returns the files of a plan in all formats that have a meaning for it, with a `README.md` that says what they are,
/// what refused it and why, and the commands that open them.
pub fn bundle(export: &Export) -> Vec<ExportFile> {
    let mut files = Vec::new();
    let (mut listed, mut refused) = (String::new(), String::new());
    for format in PLAN_FORMATS.iter().filter(|format| !LEFT_OUT.contains(&format.name)) {
        match format.write(export) {
            Ok(written) => {
                for file in written.iter().filter(|file| !file.name.contains('/')) {
                    listed.push_str(&format!("- `{}`: {}\n", file.name, format.says));
                }
                files.extend(written);
            }
            Err(refusal) => refused.push_str(&format!("- {}: {refusal}\n", format.name)),
        }
    }
    let page = page(export, &files, &listed, &refused);
    files.insert(0, ExportFile::text("README.md".to_owned(), page));
    files
}

/// Returns the page of a bundle.
fn page(export: &Export, files: &[ExportFile], listed: &str, refused: &str) -> String {
    let title: String = export.title.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let mut page = format!("{FIRST_LINE} {title}\n\n{listed}\n");
    if !refused.is_empty() {
        page.push_str(&format!("What has no meaning for this plan:\n\n{refused}\n"));
    }
    let first = |ending: &str| files.iter().map(|file| &file.name).find(|name| name.ends_with(ending));
    let commands = [
        (".mjcf.xml", "MuJoCo", "python -m mujoco.viewer --mjcf="),
        (".urdf", "The robot description (`pip install yourdfpy`)", "yourdfpy "),
        (".mcap", "The recording (Foxglove opens it, too)", "rerun "),
        (".glb", "Blender", "blender --python-expr \"import bpy; bpy.ops.import_scene.gltf(filepath='"),
    ];
    let known = commands.iter().filter_map(|(ending, words, command)| Some((first(ending)?, words, command)));
    page.push_str("## How they are opened\n\n");
    for (file, words, command) in known {
        let end = if command.starts_with("blender") { "')\"" } else { "" };
        page.push_str(&format!("{words}:\n\n```sh\n{command}{file}{end}\n```\n\n"));
    }
    page.push_str(
        "`ros2 topic pub --once /joint_trajectory_controller/joint_trajectory \
         trajectory_msgs/msg/JointTrajectory \"$(cat FILE.trajectory.yaml)\"` sends a trajectory to a controller of ROS 2.\n",
    );
    page
}

/// The beginning of the page of a bundle, by which one is known.
pub const FIRST_LINE: &str = "# A plan in the formats of other programs:";
