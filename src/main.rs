//! The `modl` command.

use mimalloc::MiMalloc;
use modl::document::Manual;
use modl::interrupt::memory::Counting;

/// A program is a tree of many small pieces: with this allocator it is read a fifth faster. Its memory is counted, for the
/// limit.
#[global_allocator]
static ALLOCATOR: Counting<MiMalloc> = Counting(MiMalloc);

/// Pairs names of files below a folder with their texts.
macro_rules! embed {
    ($folder:literal: $($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../", $folder, $name)))),*]
    };
}

/// The manual that `modl doc` puts into its sites. It is embedded here and not in the library, which would be compiled anew with
/// every change of a text.
const MANUAL: Manual = Manual { groups: GROUPS, files: FILES };

/// The groups of pages, each with its title, and their texts by path below `docs/`.
const GROUPS: &[(&str, &[(&str, &str)])] = &[
    (
        "Learn",
        embed!["docs/": "tour.md", "language.md", "repl.md", "editors.md", "live_page.md", "style.md", "documentation.md"],
    ),
    (
        "Planners",
        embed!["docs/": "planners/fold.md", "planners/squeeze.md", "planners/tosnake.md", "planners/truss.md",
            "planners/goals.md", "planners/fastest.md", "planners/planar_path.md"],
    ),
    (
        "Verdicts",
        embed!["docs/": "dynamics.md", "simulation.md", "limits.md", "performance.md", "mutants.md", "fuzzing.md"],
    ),
    ("Other programs", embed!["docs/": "exchange.md", "executing.md", "mujoco.md", "json.md", "studies.md"]),
];

/// The files that pages of the manual lead to, by path from the root of the repository.
const FILES: &[(&str, &str)] = embed!["": "docs/pictures/fold_growth.svg", "docs/plan.schema.json", "docs/robot-map.schema.json",
    "examples/bumper.mod", "examples/fold_layouts.mod", "examples/hexapod.mod", "examples/merging.mod", "examples/mobile_manipulator.mod",
    "examples/parting.mod", "examples/payload.mod", "examples/pick_and_place.mod", "examples/quadruped.mod",
    "examples/robustness.mod", "examples/rough.mod", "examples/smores_hexapod.mod", "examples/snake.mod",
    "examples/studies.mod", "examples/two_nines.mod", "examples/walkbot.mod"];

fn main() -> std::process::ExitCode {
    modl::cli::main(&MANUAL)
}
