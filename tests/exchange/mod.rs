//! Plans in the formats of other programs: what is in the files, and what the readers of these programs say of it.

mod command;
mod designs;
mod files;
mod imports;
mod maps;
mod readers;
mod smores;
mod smores_motions;
mod traps;

use modl::exchange::{Export, ExportFile, PlanFormat};
use modl::plan::Plan;

use crate::support::desk::run_clean;

/// The plan of a program that leaves it in `p`.
pub fn planned(program: &str) -> Plan {
    let written = run_clean(&format!("{program}\nemit(p, \"p.json\")\n"));
    written.plan("p.json")
}

/// The files of a plan in a format.
pub fn exported(plan: &Plan, format: &str) -> Vec<ExportFile> {
    let format = PlanFormat::named(format).expect("there is this format");
    format.write(&Export::new(plan, "robot", "plan")).expect("the format has a meaning for the plan")
}

/// The text of the file of this name.
pub fn text<'f>(files: &'f [ExportFile], name: &str) -> &'f str {
    let found = files.iter().find(|file| file.name == name).unwrap_or_else(|| panic!("no {name}"));
    std::str::from_utf8(&found.bytes).expect("it is text")
}
