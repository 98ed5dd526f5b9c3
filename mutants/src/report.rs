//! The report: a table by folder, and the mutants that no test notices, each with its reason where there is one.

use crate::mutant::{Mutant, spaced};
use crate::trial::Fate;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Why mutants may survive. What is left out fits every mutant of the function.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reason {
    pub file: String,
    pub function: String,
    /// The original text, with single spaces.
    pub original: Option<String>,
    /// The text in its place, with single spaces.
    pub mutated: Option<String>,
    /// The number among those of the same texts in the function, from 0.
    pub ordinal: Option<usize>,
    pub reason: String,
}

impl Reason {
    /// Returns true if this is the reason of a mutant.
    pub fn fits(&self, mutant: &Mutant) -> bool {
        let same = |own: &Option<String>, other: &str| own.as_ref().is_none_or(|own| spaced(own) == other);
        self.file == mutant.file
            && self.function == mutant.function
            && same(&self.original, &mutant.original)
            && same(&self.mutated, &mutant.mutated)
            && self.ordinal.is_none_or(|ordinal| ordinal == mutant.ordinal)
    }
}

#[derive(Clone, Copy, Default)]
struct Row {
    drawn: usize,
    killed: usize,
    reasoned: usize,
    survived: usize,
    unreached: usize,
}

impl Row {
    /// Returns the share of killed mutants among those that have no reason, in percent.
    fn share(&self) -> f64 {
        100.0 * self.killed as f64 / (self.drawn - self.reasoned).max(1) as f64
    }

    fn line(&self, name: &str) -> String {
        let Row { drawn, killed, reasoned, survived, unreached } = self;
        let raw = 100.0 * *killed as f64 / (*drawn).max(1) as f64;
        format!(
            "| {name} | {drawn} | {killed} | {survived} | {unreached} | {reasoned} | {raw:.1} % | {:.1} % |\n",
            self.share()
        )
    }
}

/// Returns the folder that a file is counted in: the third of the judge's, the second of others.
fn folder(file: &str) -> String {
    let parts: Vec<&str> = file.trim_start_matches("src/").split('/').collect();
    let dynamics = parts.len() > 4 && parts[3] == "dynamics";
    let depth = match parts[..] {
        ["plan", "verify", _, _, ..] if dynamics => 4,
        ["plan", "verify", _, _, ..] => 3,
        ["plan", ..] => 2,
        _ => 1,
    };
    let file = parts.len() == 2 && parts[0] == "robot";
    parts[..if file { 2 } else { depth }].join("/").trim_end_matches(".rs").to_owned()
}

/// Returns the report as Markdown, and the share of killed mutants among those without a reason, in percent.
pub fn write(
    mutants: &[&Mutant],
    fates: &BTreeMap<String, Fate>,
    reasons: &[Reason],
    head: &str,
    left_out: &[String],
) -> (String, f64) {
    let mut rows: BTreeMap<String, Row> = BTreeMap::new();
    let (mut all, mut open, mut reasoned) = (Row::default(), String::new(), String::new());
    for mutant in mutants {
        let fate = fates.get(&mutant.key());
        let noticed = fate.is_some_and(Fate::noticed);
        let reason = reasons.iter().find(|reason| reason.fits(mutant)).filter(|_| !noticed);
        if fate.is_none() && reason.is_none() {
            continue;
        }
        for row in [&mut all, rows.entry(folder(&mutant.file)).or_default()] {
            row.drawn += 1;
            match (fate, reason) {
                (_, Some(_)) => row.reasoned += 1,
                (Some(Fate::Killed { .. } | Fate::Endless { .. }), _) => row.killed += 1,
                (Some(Fate::Survived { .. }), _) => row.survived += 1,
                (Some(Fate::Unreached) | None, _) => row.unreached += 1,
            }
        }
        if noticed {
            continue;
        }
        let Mutant { file, line, function, operator, original, mutated, .. } = mutant;
        let place = format!("- {file}:{line} `{function}`, {operator}: `{original}` → `{mutated}`");
        match (reason, fate) {
            (Some(reason), _) => writeln!(reasoned, "{place}\n  {}", reason.reason),
            (None, Some(Fate::Survived { tests })) => writeln!(open, "{place}\n  {tests} tests reach it"),
            (None, _) => writeln!(open, "{place}\n  unreached"),
        }
        .expect("a text can be written");
    }
    let mut out = format!(
        "# Mutants\n\n{head}\n\n| folder | drawn | killed | survived | unreached | with a reason | killed of all | \
         killed of those without a reason |\n|---|--:|--:|--:|--:|--:|--:|--:|\n"
    );
    rows.iter().for_each(|(name, row)| out += &row.line(name));
    out += &all.line("all");
    write!(out, "\n## Survivors\n\n{open}\n## Survivors with a reason\n\n{reasoned}\n## Tests left out\n\n")
        .expect("text");
    left_out.iter().for_each(|why| writeln!(out, "- {why}").expect("a text can be written"));
    (out, all.share())
}
