//! The command line: commands, options, and their help texts.

use super::choices::TablePlot;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// A language for robots that change shape.
///
/// Describe modules, compose robots and behaviours, and get plans that were verified before they
/// were written.
#[derive(Debug, Parser)]
#[command(name = "modl", version, arg_required_else_help = true, after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The command; none: the help is shown.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Evaluate and print; several are entered one after the other
    #[arg(short = 'e', value_name = "EXPR")]
    pub expressions: Vec<String>,
    /// The options of every command.
    #[command(flatten)]
    pub globals: Globals,
}

const EXAMPLES: &str = "\
Examples:
  modl new rover                   begin a project
  modl run rover/main.mod          write its plans to out/
  modl show rover/main.mod --open  see it move
  modl check --json *.mod          diagnostics for an editor
  modl verify out/drive.plan.json  judge a plan again, from nothing but its file
  modl export out/drive.plan.json --to bundle   for ROS, MuJoCo, Blender and Foxglove
  modl explain E0301               what a code means and how to mend it
  modl what rover/main.mod Rover   what the library can do with a robot
  modl repl rover/main.mod         ask and try things out
  modl -e '4 * 90deg'              a question at once

Exit codes: 0 fine, 1 the program is wrong, 2 the call is wrong or standard output can't be written,
130 interrupted by Ctrl-C. SIGTERM ends it at once (a shell tells 143); files are whole or not there.";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run a program: print, verify, and write its plans
    #[command(
        after_help = "Examples:\n  modl run walkbot.mod\n  modl run walkbot.mod --out plans --seed 7\n  \
        modl run - < walkbot.mod\n\nFiles are written below the output folder, each whole or not at all."
    )]
    Run {
        /// The program; `-` reads standard input
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Find what is wrong in programs, without planning or writing
    #[command(
        after_help = "Examples:\n  modl check walkbot.mod\n  modl check --json parts/*.mod\n  modl check .\n\nOf a folder all `.mod` files \
        below it are taken, hidden ones and links left out; the folder is then the\nproject."
    )]
    Check {
        /// Programs and folders; `-` reads standard input
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
    },
    /// Run the tests that programs contain, and the examples in their documentation
    #[command(
        after_help = "Examples:\n  modl test walkbot.mod\n  modl test *.mod --filter order\n  modl test .\n\nOf a folder all `.mod` files \
        below it are taken, hidden ones and links left out; the folder is then the\nproject."
    )]
    Test {
        /// Programs and folders; `-` reads standard input
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
        /// Run only tests whose name contains TEXT
        #[arg(long, value_name = "TEXT")]
        filter: Option<String>,
    },
    /// Check programs again whenever a file changes that they read
    #[command(
        after_help = "Examples:\n  modl watch walkbot.mod\n  modl watch --test parts/*.mod\n\nWatched are the programs, \
        what they import, and the files they read. A run that takes\nlong is given up for a newer text. Ctrl-C ends.\n\n\
        `modl watch --page walkbot.mod` prints the address of a page, on this machine only, that\nshows the robot while it is \
        typed: a click selects a part in the text, and sliders, joints\nand free ports change the text. docs/live_page.md tells \
        of it."
    )]
    Watch {
        /// The programs
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
        /// Run the programs instead
        #[arg(long, conflicts_with = "test")]
        run: bool,
        /// Run their tests instead
        #[arg(long)]
        test: bool,
        /// Show the robot of one program on a page, which changes the text, too
        #[arg(long, conflicts_with_all = ["run", "test"])]
        page: bool,
        /// The port of the page; a free one by default
        #[arg(long, value_name = "PORT", requires = "page")]
        port: Option<u16>,
        /// Open the page in the browser
        #[arg(long, requires = "page")]
        open: bool,
    },
    /// Serve an editor with diagnostics, completion and documentation
    #[command(
        after_help = "Speaks the Language Server Protocol on standard input and output: an editor starts it.\n\
        docs/editors.md says how Neovim, Helix and others are told."
    )]
    Lsp {
        /// Standard input and output, as some editors say; there is no other way
        #[arg(long)]
        stdio: bool,
        /// In place of the global option, so that no help offers what is refused
        #[arg(long, hide = true)]
        json: bool,
    },
    /// Judge plan files again, from nothing but the files
    #[command(after_help = "Prints every check with its status, and the worst values found.\n\n\
        Example:\n  modl verify out/walkbot.plan.json")]
    Verify {
        /// Plan files; `-` reads standard input
        #[arg(value_name = "PLANFILE", required = true)]
        files: Vec<PathBuf>,
    },
    /// Play a program's plans, or plan files, by rigid bodies: what the robots really do
    #[command(
        after_help = "Servos follow the plan within their torque, links touch the ground and each other with \
        friction,\nbonds break at what they hold. What half the time step changes is said, and where the verdict says \
        otherwise.\nThe exit code is 1 if a robot falls, a bond breaks, ports do not dock or a program is aborted, in the \
        plan's\nown run or in one of `--runs`.\n\n\
        Examples:\n  modl simulate walkbot.mod\n  modl simulate out/walkbot.plan.json\n  modl simulate walkbot.mod --runs 100 \
        --friction-spread 0.3 --seed 7\n\nOf a program, each plan that it emits is played, also one that can't be verified; no \
        file is written."
    )]
    Simulate(SimulateArguments),
    /// Compute a study's table, on all processors or a part of it
    #[command(
        after_help = "Examples:\n  modl study snake.mod gait -o sweep\n  modl study snake.mod gait -o sweep --status\n  \
        modl study snake.mod gait -o sweep --shard 17/64\n  modl study snake.mod gait -o sweep --row 123 --show\n  \
        modl study snake.mod gait -o sweep --emit slurm > gait.sh\n\nRows are kept in a folder below the output folder as they \
        are computed, and are not computed again; a study\nthat was interrupted or killed goes on with the same command. When \
        all rows are there, the table is written\nto NAME.csv, with its origin beside it in NAME.json. docs/studies.md tells more."
    )]
    Study(StudyArguments),
    /// Write plans in the formats of other programs: ROS, MuJoCo, Blender, Foxglove
    #[command(
        after_help = "Examples:\n  modl export out/walk.plan.json --to urdf\n  modl export out/walk.plan.json --to bundle -o \
        exchange\n\nFiles are written below the output folder, named after the plan file; a bundle is a folder of this name, \
        which\nis there as a whole or not at all. What a robot could execute is judged again first. docs/exchange.md tells \
        of each\nformat."
    )]
    Export {
        /// A program, or plan files; `-` reads a plan file from standard input
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
        /// The format, or `bundle` for all of them
        #[arg(long, value_name = "FORMAT", value_parser = super::choices::targets())]
        to: String,
    },
    /// Write the module or configuration that files of other programs declare
    #[command(
        after_help = "Examples:\n  modl import robots/arm.urdf -o robots\n  modl import walkbot.conf walkbot.gait\n\nURDF becomes \
        a module, with links, joints, limits, masses and shapes, and a place for ports; meshes (STL, OBJ,\nOFF, PLY) become \
        hulls. Configurations of the SMORES tools (.conf, .struct, VSPARC's XML) become\nconfigurations, and the motions \
        (.gait, VSPARC's XML) named after them their behaviours. The program is\nwritten below the output folder, named after \
        the first file. docs/exchange.md tells more."
    )]
    Import {
        /// The robot, and motions of it
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
    },
    /// Say what a plan file holds, sample it, and hold it against the map of a robot
    #[command(
        after_help = "Examples:\n  modl plan out/walk.plan.json\n  modl plan out/walk.plan.json --series joints --rate 100Hz > \
        walk.csv\n  modl plan out/walk.plan.json --map robot.json\n  modl plan out/walk.plan.json --map robot.json --series \
        joints > targets.csv\n  modl plan out/walk.plan.json --series speeds --npy > walk.npy\n\nA series is a table in CSV, SI units and radians; with a map its columns are the targets of \
        motors,\n`BUS/CHANNEL`. docs/executing.md tells how a robot executes a plan."
    )]
    Plan {
        /// A plan file; `-` reads standard input
        #[arg(value_name = "PLANFILE")]
        file: PathBuf,
        /// Print a series over time
        #[arg(long, value_name = "SERIES", value_parser = super::choices::series_names())]
        series: Option<String>,
        /// The samples a second, such as 100Hz
        #[arg(long, value_name = "RATE", requires = "series", value_parser = super::choices::rate, default_value = "100Hz")]
        rate: f64,
        /// Print the series as a file of NumPy, an array of records, instead of CSV
        #[arg(long, requires = "series", conflicts_with = "json")]
        npy: bool,
        /// The map from joints to the motors of a robot (docs/robot-map.schema.json)
        #[arg(long, value_name = "MAPFILE")]
        map: Option<PathBuf>,
    },
    /// Draw what a program plans, or a plan file, as a page that plays it
    #[command(
        after_help = "Example:\n  modl show walkbot.mod --open\n  modl show out/walkbot.plan.json\n\nOf a program, \
        each plan that it emits gets a page, a failed one up to its failure; of a program that emits\nand shows \
        nothing, each robot that it declares. Pages are written below the output folder."
    )]
    Show {
        /// A program, or a plan file; `-` reads a program from standard input
        #[arg(value_name = "FILE")]
        file: PathBuf,
        /// Open the page (of several the last) in the browser
        #[arg(long)]
        open: bool,
    },
    /// List what the standard library can do with a robot
    #[command(
        after_help = "Lists the configurations that the robot contains, by the number of their embeddings, with the \
        behaviors\nthat it can therefore execute: `embed(Grasper7, in: w)[0].squeeze()`. None of the program's \
        statements is run.\n\nExamples:\n  modl what walkbot.mod Walkbot\n  modl what walkbot.mod 'Walkbot(bend: 20deg)'"
    )]
    What {
        /// The program, whose declarations are taken in; `-` reads standard input
        #[arg(value_name = "FILE")]
        file: PathBuf,
        /// The robot: a configuration that the program declares, or an expression that gives one
        #[arg(value_name = "ROBOT")]
        robot: String,
    },
    /// Type declarations, statements and expressions, and see what they are
    #[command(
        after_help = "Examples:\n  modl repl\n  modl repl walkbot.mod\n  modl repl < session.txt\n\n`:help` lists the commands \
        of a session. What is piped in is entered entry by entry; the exit\ncode is 1 if something in it was wrong."
    )]
    Repl {
        /// A program whose declarations are taken in first; none of its statements is run
        #[arg(value_name = "FILE")]
        file: Option<PathBuf>,
        /// In place of the global option, so that no help offers what is refused
        #[arg(long, hide = true)]
        json: bool,
    },
    /// Write the documentation of a project, and of the standard library, as a site
    #[command(
        after_help = "Examples:\n  modl doc\n  modl doc rover --open\n\nThe site is written to doc/ below the output folder, works \
        from there without a server, and can be searched.\nIn documentation [`Name`] is a link to a declaration; links that lead \
        nowhere are errors."
    )]
    Doc {
        /// The project: all programs in it
        #[arg(value_name = "FOLDER", default_value = ".")]
        folder: PathBuf,
        /// Leave the standard library out
        #[arg(long)]
        only: bool,
        /// Open it in the browser
        #[arg(long)]
        open: bool,
    },
    /// Lay programs out in the one style
    #[command(
        after_help = "Examples:\n  modl fmt walkbot.mod\n  modl fmt .\n  modl fmt --check parts/*.mod\n  \
        modl fmt - < walkbot.mod\n\nLine breaks are yours; indentation, spaces and blank lines are not. Of a folder all `.mod` \
        files are taken.\nWhat can't be read stays as it is."
    )]
    Fmt {
        /// Programs and folders; `-` reads standard input and writes to standard output
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
        /// Write nothing; fail where something is not in style
        #[arg(long)]
        check: bool,
    },
    /// Begin a project: a folder with a program that runs, and a test
    #[command(
        after_help = "Example:\n  modl new rover && modl run rover/main.mod\n\nNothing is ever overwritten."
    )]
    New {
        /// The folder to make
        #[arg(value_name = "NAME")]
        name: PathBuf,
    },
    /// Explain a diagnostic's code; without one, list all codes
    #[command(after_help = "Example:\n  modl explain E0301")]
    Explain {
        /// Such as E0301
        #[arg(value_name = "CODE")]
        code: Option<String>,
    },
    /// Print a completion script for a shell
    #[command(
        after_help = "Example:\n  modl completions bash > ~/.local/share/bash-completion/completions/modl"
    )]
    Completions {
        #[arg(value_name = "SHELL")]
        shell: clap_complete::Shell,
        /// In place of the global option, so that no help offers what is refused
        #[arg(long, hide = true)]
        json: bool,
    },
}

/// The options of `modl study`.
#[derive(Clone, Debug, Args)]
pub(super) struct StudyArguments {
    /// The program
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The study; may be left out if the program has one
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Compute only one part of the rows, such as 17/64
    #[arg(long, value_name = "I/N", value_parser = super::choices::part)]
    pub shard: Option<(u64, u64)>,
    /// Say what is computed, and compute nothing
    #[arg(long, conflicts_with_all = ["shard", "merge", "row"])]
    pub status: bool,
    /// Write the table of what is computed, and compute nothing
    #[arg(long, conflicts_with_all = ["shard", "row"])]
    pub merge: bool,
    /// Compute one row alone, and print it
    #[arg(long, value_name = "N", conflicts_with = "shard")]
    pub row: Option<u64>,
    /// Draw a page of each plan that the row verifies
    #[arg(long, requires = "row")]
    pub show: bool,
    /// Compute rows again that were set aside
    #[arg(long)]
    pub retry: bool,
    /// Draw the table: front:speed,-energy (less energy is better), parallel, or histogram:speed
    #[arg(long, value_name = "PLOT", value_parser = TablePlot::read, conflicts_with_all = ["shard", "status", "row", "emit"])]
    pub plot: Vec<TablePlot>,
    /// Print a script that computes the study on a cluster
    #[arg(long, value_name = "SYSTEM", conflicts_with_all = ["shard", "status", "merge", "row"])]
    pub emit: Option<System>,
    /// The number of shards of the script
    #[arg(long, value_name = "N", default_value_t = 64, requires = "emit", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub shards: u64,
}

/// The systems for which scripts are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum System {
    /// An array job of Slurm
    Slurm,
}

#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Global options")]
pub(super) struct Globals {
    /// Print one JSON object to standard output instead of text
    #[arg(long, global = true)]
    pub json: bool,
    /// Colouring of diagnostics
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value = "auto")]
    pub color: Color,
    /// The folder for plans; nothing is written anywhere else
    #[arg(short = 'o', long, global = true, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// The project: nothing outside is read [default: the folder of the file]
    #[arg(long, global = true, value_name = "DIR")]
    pub root: Option<PathBuf>,
    /// Use the standard library in this folder instead of the one built in
    #[arg(long, global = true, value_name = "DIR")]
    pub stdlib: Option<PathBuf>,
    /// Seed of the planners that a program gives none
    #[arg(long, global = true, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Threads that a planner may use; results don't depend on it [default: one for each processor]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=256))]
    pub threads: Option<u64>,
    /// Evaluation steps that a program may take
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub max_steps: Option<u64>,
    /// Modules that a robot may have
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub max_modules: Option<u64>,
    /// Samples that one verification may take
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub max_samples: Option<u64>,
    /// Memory that a command may take, such as 500MB or 4GB [default: three quarters of the machine's]
    #[arg(long, global = true, value_name = "SIZE", value_parser = super::choices::bytes)]
    pub max_memory: Option<usize>,
}

/// The choices of `--color`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Color {
    /// On terminals, unless NO_COLOR is set
    Auto,
    Always,
    Never,
}

/// The arguments of `modl simulate`.
#[derive(Args, Debug)]
pub(super) struct SimulateArguments {
    /// A program, or plan files; `-` reads a plan file from standard input
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// The time step in milliseconds, 0.001 to 5
    #[arg(long, value_name = "MS", allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// The factor on all coefficients of friction
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    pub friction: Option<f64>,
    /// The number of further runs of each plan, with what the spreads draw by `--seed`
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub runs: usize,
    /// The spread of friction in the runs: 0.3 is a factor of 0.7 to 1.3
    #[arg(long, value_name = "PART", default_value_t = 0.0, allow_negative_numbers = true)]
    pub friction_spread: f64,
    /// The spread of masses
    #[arg(long, value_name = "PART", default_value_t = 0.0, allow_negative_numbers = true)]
    pub mass_spread: f64,
    /// The spread of the greatest torques and forces of motors
    #[arg(long, value_name = "PART", default_value_t = 0.0, allow_negative_numbers = true)]
    pub torque_spread: f64,
    /// The spread of the stiffness of servos
    #[arg(long, value_name = "PART", default_value_t = 0.0, allow_negative_numbers = true)]
    pub stiffness_spread: f64,
    /// The most by which the zeros of joints that turn are off, in degrees
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true)]
    pub joint_spread: f64,
}
