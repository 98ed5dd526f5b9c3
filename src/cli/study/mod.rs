//! `modl study`: computes the rows of a study, on all processors or a part of them, and keeps them in a table.
//!
//! A row is a function of the identity of its study (`identity`) and its number. `drive` has threads (`workers`) compute the
//! rows that the study's folder lacks, and writes them as shards (`store`); `claims` keeps drivers on one folder apart;
//! `table` merges shards. Any cut into shards, any order and any interruption gives the same table.

pub(super) mod answer;
mod claims;
mod drive;
mod identity;
mod plots;
mod replay;
mod store;
mod submit;
mod table;
mod workers;

use super::arguments::{Globals, StudyArguments};
use super::disk::Project;
use super::output;
use super::program;
use super::report::{self, Report};
use super::terminal::{Terminal, listen_for_cancel, print, print_error};
use super::{CallError, Ending};
use crate::check::typed::{DefId, DefKind};
use crate::check::{self, Checked};
use crate::interpret::Options;
use crate::interpret::study_columns::StudyColumn;
use crate::source::{Diagnostic, code};
use crate::study::Goal;
use crate::units::counted;
use answer::JsonStudy;
use claims::Attempts;
use drive::{Driven, Plan, drive};
use identity::{Identity, Recorder};
use plots::Numbers;
use std::ops::Range;
use store::{Listing, Store};
use workers::{Quiet, Subject};

/// The most strange files that are told of.
const STRANGERS_SHOWN: usize = 5;

/// A study of a program that the command works on.
struct Studied<'s> {
    subject: Subject<'s>,
    identity: Identity,
    sampler: String,
    plan: Plan,
    columns: Vec<StudyColumn>,
    store: Store,
}

/// Runs the command `modl study`.
///
/// # Errors
/// A message if the file can't be read, has no such study, or the folder can't be written.
pub(super) fn run(arguments: &StudyArguments, globals: &Globals) -> Result<Ending, CallError> {
    let project = Project::open(&arguments.file, globals.root.as_deref(), globals.stdlib.as_deref())?;
    listen_for_cancel();
    let mut report = Report::default();
    let checked = check::check(&project, &project.name);
    let style = report::style(globals, &project.folder);
    report.add(&checked.sources, &checked.diagnostics, &style, globals);
    if checked.has_errors() {
        report.finish(false, globals);
        return Ok(Ending::Wrong);
    }
    let study = found(&checked, arguments)?;
    let name = checked.program.def(study).name.to_string();
    if arguments.emit.is_some() {
        submit::print_script(arguments, &name, globals);
        report.finish(true, globals);
        return Ok(Ending::Fine);
    }
    let files = Recorder::new(&project);
    let options = Options {
        seed: globals.seed,
        verified_pages: arguments.row.filter(|_| arguments.show).map(|row| format!("{name}-{row}")),
        command: format!("modl study {} {name}", project.name),
        limits: program::limits(globals),
        // The rows are computed beside each other.
        threads: if arguments.row.is_some() { program::threads(globals) } else { 1 },
        ..Options::default()
    };
    let subject = Subject { checked: &checked, files: &files, options: &options, study };
    let studied = match begun(subject, &name, globals) {
        Ok(Some(studied)) => studied,
        Ok(None) => return Ok(Ending::Cancelled),
        Err(diagnostics) => {
            report.add(&checked.sources, &diagnostics, &style, globals);
            report.finish(false, globals);
            return Ok(Ending::Wrong);
        }
    };
    let ended = studied.carry_out(arguments, &mut report, globals)?;
    report.finish(ended == Ending::Fine, globals);
    Ok(ended)
}

/// Returns the study of a program that a call names, or its only one.
fn found(checked: &Checked, arguments: &StudyArguments) -> Result<DefId, CallError> {
    let program = &checked.program;
    let own = program.own.iter().copied();
    let studies: Vec<DefId> = own.filter(|id| matches!(program.def(*id).kind, DefKind::Study(_))).collect();
    let names: Vec<String> = studies.iter().map(|id| format!("`{}`", program.def(*id).name)).collect();
    let file = arguments.file.display();
    match (&arguments.name, studies.as_slice()) {
        (_, []) => Err(CallError(format!("`{file}` declares no study"))),
        (Some(name), all) => {
            let named = all.iter().find(|id| program.def(**id).name == name.as_str());
            named.copied().ok_or_else(|| {
                CallError(format!("`{file}` has no study `{name}`; there is {}", names.join(", ")))
            })
        }
        (None, [one]) => Ok(*one),
        (None, _) => Err(CallError(format!("`{file}` has several studies; name one: {}", names.join(", ")))),
    }
}

/// Evaluates axes and settings of a study; `None` if the user cancels.
fn begun<'s>(
    subject: Subject<'s>,
    name: &str,
    globals: &Globals,
) -> Result<Option<Studied<'s>>, Vec<Diagnostic>> {
    let mut host = Quiet(super::terminal::cancel_state());
    let known = subject.evaluate(&mut host, |worker| {
        let study = worker.study();
        let goal = study.objective.map(|(_, goal)| goal);
        let columns = worker.columns().to_vec();
        let plan = Plan { design: study.design.clone(), rows: study.rows, goal, columns: columns.len() };
        (plan, columns)
    })?;
    let Some((plan, columns)) = known else { return Ok(None) };
    let identity = Identity::of(subject.checked, name, globals);
    let DefKind::Study(declared) = &subject.checked.program.def(subject.study).kind else {
        unreachable!("it is a study")
    };
    let sampler = subject.checked.sources.text(declared.sampler_span).to_owned();
    let store = Store::new(&globals.out, &identity);
    Ok(Some(Studied { subject, identity, sampler, plan, columns, store }))
}

impl Studied<'_> {
    /// Does what the arguments say with the study.
    fn carry_out(
        &self,
        arguments: &StudyArguments,
        report: &mut Report,
        globals: &Globals,
    ) -> Result<Ending, CallError> {
        if let Some(row) = arguments.row {
            let Some(found) = replay::row(self, row, report, globals)? else { return Ok(Ending::Cancelled) };
            let ok = found.code.is_empty();
            let listing = self.store.list(self.subject.files);
            report.study = Some(JsonStudy { row: Some(found), ..self.json(&listing) });
            return Ok(if ok { Ending::Fine } else { Ending::Wrong });
        }
        if arguments.retry {
            self.retry()?;
        }
        let mut driven = Driven::Done;
        if !arguments.status && !arguments.merge {
            let rows = self.part(arguments.shard)?;
            let mut terminal = Terminal::new(globals);
            let threads = program::threads(globals);
            driven = drive(&self.store, &self.plan, self.subject, rows, threads, &mut terminal)?;
            terminal.clear_progress();
        }
        let ended = match driven {
            Driven::Done => Ending::Fine,
            Driven::Cancelled => {
                print_error("interrupted; the same command goes on\n");
                Ending::Cancelled
            }
            Driven::Failed(diagnostics) => {
                self.tell(&diagnostics, report, globals);
                Ending::Wrong
            }
            Driven::Unwritten(why) => {
                let message =
                    format!("the rows can't be written to `{}`: {why}", self.store.folder.display());
                let hint = "what was written stays; the same command goes on";
                self.tell(&[Diagnostic::error(code::CANNOT_WRITE, message).hint(hint)], report, globals);
                Ending::Wrong
            }
        };
        let listing = self.store.list(self.subject.files);
        let complete = listing.missing(0..self.plan.rows).is_empty();
        let mut json = self.json(&listing);
        let mut merged_well = true;
        if complete && ended == Ending::Fine && !arguments.status {
            merged_well = self.merge(&listing, &mut json, report, globals);
        }
        if !globals.json {
            self.print_state(&json, arguments, ended == Ending::Fine);
        }
        if json.table.is_some() {
            merged_well &= self.draw(&listing, arguments, report, globals);
        } else if !arguments.plot.is_empty() {
            print_error("plots are drawn once all rows are there\n");
        }
        let missing = arguments.merge && !complete;
        if missing {
            let lacks = listing.missing(0..self.plan.rows);
            let rows: u64 = lacks.iter().map(|range| range.end - range.start).sum();
            let message = format!("{} of `{}` are not computed", counted_rows(rows), self.identity.study);
            let diagnostic = Diagnostic::error(code::NO_ROW, message).hint(format!(
                "the first is row {}; `modl study` without `--merge` computes them",
                lacks[0].start
            ));
            self.tell(&[diagnostic], report, globals);
        }
        report.study = Some(json);
        Ok(if ended == Ending::Fine && (missing || !merged_well) { Ending::Wrong } else { ended })
    }

    /// Merges the shards to the table; returns false, after a report, if that fails.
    fn merge(&self, listing: &Listing, json: &mut JsonStudy, report: &mut Report, globals: &Globals) -> bool {
        let greatest = self.plan.goal == Some(Goal::Greatest);
        let (what, table) = ((&self.identity, self.sampler.as_str()), (self.plan.rows, &self.columns[..]));
        match table::merge(&self.store, listing, what, table, greatest, &globals.out) {
            Ok(merged) => {
                json.table = Some(merged.csv.to_string_lossy().into_owned());
                json.failed = Some(merged.failed);
                json.best = merged.best;
                report.written.get_or_insert_default().extend(json.table.clone());
                true
            }
            Err(why) => {
                self.tell(&[Diagnostic::error(code::CANNOT_WRITE, why)], report, globals);
                false
            }
        }
    }

    /// Draws the plots of the table; returns false, after a report, if one can't be drawn.
    fn draw(
        &self,
        listing: &Listing,
        arguments: &StudyArguments,
        report: &mut Report,
        globals: &Globals,
    ) -> bool {
        if arguments.plot.is_empty() {
            return true;
        }
        let mut lines = Vec::new();
        let read = self.store.each_row(listing, |_, line| {
            lines.push(line.csv);
            Ok(())
        });
        if let Err(why) = read {
            self.tell(&[Diagnostic::error(code::CANNOT_WRITE, why)], report, globals);
            return false;
        }
        let numbers = Numbers::read(&self.columns, lines.iter().map(String::as_str));
        let mut well = true;
        for wanted in &arguments.plot {
            let name = plots::file(wanted, &self.identity.study);
            let drawn = numbers.drawn(wanted, &self.identity.study).and_then(|text| {
                output::write(&globals.out, &name, text.as_bytes())
                    .map_err(|_| format!("`{name}` can't be written"))
            });
            match drawn {
                Ok(path) => {
                    if !globals.json {
                        print_error(&format!("wrote {path}\n"));
                    }
                    report.written.get_or_insert_default().push(path);
                }
                Err(why) => {
                    self.tell(&[Diagnostic::error(code::CANNOT_WRITE, why)], report, globals);
                    well = false;
                }
            }
        }
        well
    }

    /// Returns the rows that are to be computed.
    fn part(&self, shard: Option<(u64, u64)>) -> Result<Range<u64>, CallError> {
        let rows = self.plan.rows;
        match shard {
            None => Ok(0..rows),
            Some(_) if self.plan.goal.is_some() => Err(CallError(format!(
                "`{}` is a search, whose rows depend on those before them: it has no parts; `--threads` computes each \
                 generation beside each other",
                self.identity.study
            ))),
            Some((i, n)) => {
                let at =
                    |i: u64| u64::try_from(u128::from(rows) * u128::from(i) / u128::from(n)).unwrap_or(rows);
                Ok(at(i - 1)..at(i))
            }
        }
    }

    /// Forgets the rows that were set aside, and all of their shards.
    fn retry(&self) -> Result<(), CallError> {
        for shard in self.store.list(self.subject.files).shards {
            let Ok((lines, _)) = self.store.read(&shard) else { continue };
            if lines.iter().any(|line| line.code == code::NO_ROW.0) {
                self.store.remove(&shard).map_err(CallError)?;
            }
        }
        Attempts::of(&self.store.folder).forget();
        Ok(())
    }

    fn tell(&self, diagnostics: &[Diagnostic], report: &mut Report, globals: &Globals) {
        let style = report::style(globals, "");
        report.add(&self.subject.checked.sources, diagnostics, &style, globals);
    }

    fn json(&self, listing: &Listing) -> JsonStudy {
        let lacking: u64 =
            listing.missing(0..self.plan.rows).iter().map(|range| range.end - range.start).sum();
        JsonStudy {
            name: self.identity.study.clone(),
            hash: self.identity.hash.clone(),
            rows: self.plan.rows,
            computed: self.plan.rows - lacking,
            folder: self.store.folder.to_string_lossy().into_owned(),
            table: None,
            failed: None,
            best: None,
            strangers: listing.strangers.clone(),
            row: None,
        }
    }

    /// Returns true if a call computes all rows.
    fn is_whole(arguments: &StudyArguments) -> bool {
        arguments.shard.is_none() && !arguments.status && !arguments.merge
    }

    /// Prints what is computed. `fine`: true if the driver ended well.
    fn print_state(&self, json: &JsonStudy, arguments: &StudyArguments, fine: bool) {
        let mut text = format!("{}: {} of {} computed", json.name, json.computed, counted_rows(json.rows));
        if let Some(failed) = json.failed.as_ref().filter(|failed| !failed.is_empty()) {
            let each: Vec<String> = failed.iter().map(|(code, n)| format!("{n} with {code}")).collect();
            text.push_str(&format!("; without values: {}", each.join(", ")));
        }
        if let Some(best) = json.best {
            text.push_str(&format!("; the best is row {best}"));
        }
        print(&format!("{text}\n"));
        if let Some(table) = &json.table {
            print_error(&format!("wrote {table}\n"));
        } else if fine && json.computed < json.rows && Studied::is_whole(arguments) {
            print_error("the others are being computed by another driver on this folder\n");
        }
        for (name, why) in json.strangers.iter().take(STRANGERS_SHOWN) {
            print_error(&format!("left out {}/{name}: {why}\n", json.folder));
        }
        let code = code::NO_ROW.0;
        if json.failed.as_ref().is_some_and(|failed| failed.contains_key(code)) {
            let (file, name) = (arguments.file.display(), &json.name);
            print_error(&format!(
                "rows with {code} were set aside; `modl study {file} {name} --row N` computes one alone, and `--retry` \
                 all again\n"
            ));
        }
    }
}

fn counted_rows(rows: u64) -> String {
    counted(usize::try_from(rows).unwrap_or(usize::MAX), "row")
}
