//! The targets: each has a generator of inputs, and a check that panics where an input breaks a property.

mod exports;
mod imports;
mod plans;
mod programs;
mod scenes;
mod sessions;
mod texts;
mod wire;

use super::inputs::dice::Dice;

/// A target: inputs, and what must hold for each.
pub struct Target {
    /// The name of the target, and of its folder in `fuzz/corpus`.
    pub name: &'static str,
    /// The properties that are tried, in words.
    pub says: &'static str,
    /// The generator of inputs.
    pub input: fn(&mut Dice) -> Vec<u8>,
    /// The check of an input; it panics where a property does not hold.
    pub check: fn(&[u8]),
    /// The number of inputs that the gate tries.
    pub gate: u64,
    /// The number of inputs to be tried in all; long runs divide their time by it.
    pub aim: u64,
}

impl Target {
    /// Returns the target of a name; `None` if none has it.
    pub fn named(name: &str) -> Option<&'static Target> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// Returns the input of a seed.
    pub fn of_seed(&self, seed: u64) -> Vec<u8> {
        (self.input)(&mut Dice::new(seed))
    }

    /// Checks the input that the bytes of a fuzzer stand for.
    #[allow(dead_code, reason = "for the targets of cargo-fuzz")]
    pub fn check_bytes(&self, bytes: &[u8]) {
        (self.check)(&(self.input)(&mut Dice::of_bytes(bytes)));
    }
}

/// All targets, in the order of the rooms that they try.
pub const TARGETS: &[Target] = &[
    Target {
        name: "parse",
        says: "every place that is told lies in the text, and what could not be read is told",
        input: texts::input,
        check: texts::parse,
        gate: 8_000,
        aim: 1_000_000,
    },
    Target {
        name: "format",
        says: "the tree is kept, and the second time changes nothing",
        input: texts::input,
        check: texts::format,
        gate: 4_000,
        aim: 1_000_000,
    },
    Target {
        name: "check",
        says: "every place that is told lies in its file; the second time finds the same",
        input: programs::to_check,
        check: programs::check,
        gate: 3_000,
        aim: 1_000_000,
    },
    Target {
        name: "run",
        says: "with fuel: the run ends, says the same the second time, and what it writes as a plan is read and verified",
        input: programs::to_run,
        check: programs::run,
        gate: 1_500,
        aim: 100_000,
    },
    Target {
        name: "sessions",
        says: "an entry that fails changes nothing, and the session is a program that checks and is formatted",
        input: sessions::input,
        check: sessions::check,
        gate: 250,
        aim: 100_000,
    },
    Target {
        name: "articulated",
        says: "plan files of robots with joints: read or refused; what is read is written and read the same, judged, reversed and cut",
        input: plans::articulated,
        check: plans::check,
        gate: 1_000,
        aim: 20_000,
    },
    Target {
        name: "lattice",
        says: "the same of lattices",
        input: plans::lattice,
        check: plans::check,
        gate: 2_000,
        aim: 20_000,
    },
    Target {
        name: "truss",
        says: "the same of trusses",
        input: plans::truss,
        check: plans::check,
        gate: 300,
        aim: 20_000,
    },
    Target {
        name: "scenes",
        says: "scenes are planned and judged, and what is emitted is read and verified",
        input: scenes::input,
        check: scenes::check,
        gate: 250,
        aim: 100_000,
    },
    Target {
        name: "meshes",
        says: "OBJ, OFF, PLY, STL, XYZ and FOLD: read or refused; what is read is written, and read the same",
        input: imports::mesh_file,
        check: imports::meshes,
        gate: 20_000,
        aim: 100_000,
    },
    Target {
        name: "drawings",
        says: "crease patterns in SVG: read or refused; what is read is a sheet, and a grid has its cells",
        input: imports::drawing,
        check: imports::drawn,
        gate: 10_000,
        aim: 100_000,
    },
    Target {
        name: "rofi",
        says: "both formats of RoFI: what is read is written in both, and read the same; it makes a robot",
        input: imports::rofi_file,
        check: imports::rofi,
        gate: 20_000,
        aim: 100_000,
    },
    Target {
        name: "urdf",
        says: "descriptions: what comes in is formatted, checks and is elaborated",
        input: imports::description,
        check: imports::robots,
        gate: 600,
        aim: 100_000,
    },
    Target {
        name: "smores",
        says: "files of the SMORES tools and of VSPARC: what comes in is formatted, checks and is elaborated",
        input: imports::smores_files,
        check: imports::robots,
        gate: 2_000,
        aim: 100_000,
    },
    Target {
        name: "maps",
        says: "maps of motors: read or refused; what is read is checked against a plan",
        input: imports::map,
        check: imports::maps,
        gate: 10_000,
        aim: 100_000,
    },
    Target {
        name: "creases",
        says: "crease patterns are written as FOLD and read the same",
        input: imports::seed,
        check: imports::creases,
        gate: 10_000,
        aim: 100_000,
    },
    Target {
        name: "exports",
        says: "plans in all formats: XML, JSON, CSV, glTF and MCAP are well formed; descriptions come in again",
        input: exports::input,
        check: exports::check,
        gate: 600,
        aim: 100_000,
    },
    Target {
        name: "pictures",
        says: "the beginnings of plans as GIF and PNG",
        input: exports::input,
        check: exports::pictures,
        gate: 10,
        aim: 100_000,
    },
    Target {
        name: "wire",
        says: "conversations with the language server: each request has one answer, and no thread of the server panics",
        input: wire::input,
        check: wire::check,
        gate: 400,
        aim: 100_000,
    },
];
