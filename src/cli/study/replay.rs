//! One row of a study, computed alone.

use super::Studied;
use super::answer::JsonRow;
use super::drive::{means, stored};
use super::table::shown;
use super::workers::Quiet;
use crate::cli::arguments::Globals;
use crate::cli::report::Report;
use crate::cli::terminal::{Terminal, cancel_state, print, print_error};
use crate::cli::{CallError, report};
use crate::interpret::study::{RowCells, StudyWorker};
use crate::interpret::study_columns::{Cell, StudyColumn};
use crate::study::{Coordinate, Goal, Search};
use serde_json::{Number, Value as Json};
use std::collections::BTreeMap;

/// Computes a row, with what it prints and, if asked for, pages of what it verifies, and prints it; `None` if the user
/// cancels. A row of a search needs those before it: what the folder lacks of them is computed.
///
/// # Errors
/// A message if the study has no such row.
pub(super) fn row(
    studied: &Studied,
    row: u64,
    report: &mut Report,
    globals: &Globals,
) -> Result<Option<JsonRow>, CallError> {
    let rows = studied.plan.rows;
    if row >= rows {
        return Err(CallError(format!("the study has the rows 0 to {}, and no row {row}", rows - 1)));
    }
    let Some(point) = point(studied, row) else { return Ok(None) };
    let mut terminal = Terminal::new(globals);
    let each = studied.plan.design.each_of(row);
    let found = studied.subject.evaluate(&mut terminal, |worker| {
        let cells = worker.row(&point, &each)?;
        Some((cells, worker.written()))
    });
    terminal.clear_progress();
    let found = found.map_err(|_| CallError("the study has no rows".to_owned()))?;
    let Some((cells, pages)) = found.flatten() else { return Ok(None) };
    if globals.json {
        report.printed = terminal.printed.take();
    } else {
        print_row(row, &cells, &studied.columns);
    }
    pages.iter().for_each(|page| print_page(page, globals));
    report.written.get_or_insert_default().extend(pages.iter().cloned());
    if let Err(fault) = &cells.outcome
        && let Some(diagnostic) = &fault.diagnostic
    {
        let style = report::style(globals, "");
        report.add(&studied.subject.checked.sources, std::slice::from_ref(diagnostic), &style, globals);
    }
    Ok(Some(json(row, &cells, &studied.columns, pages)))
}

fn print_page(page: &str, globals: &Globals) {
    if !globals.json {
        print_error(&format!("wrote {page}\n"));
    }
}

/// Returns the coordinates of the point of a row; `None` if the user cancels.
fn point(studied: &Studied, row: u64) -> Option<Vec<Coordinate>> {
    let design = &studied.plan.design;
    let count = design.rows_of_point();
    let Some(goal) = studied.plan.goal else { return design.point(row / count) };
    let sought = stored(&studied.store, studied.subject);
    let replayed = studied
        .subject
        .evaluate(&mut Quiet(cancel_state()), |worker| replayed(worker, studied, goal, row / count, sought));
    replayed.ok().flatten().flatten()
}

/// Returns a point of a search, from the rows before it.
fn replayed(
    worker: &mut StudyWorker,
    studied: &Studied,
    goal: Goal,
    wanted: u64,
    mut sought: BTreeMap<u64, Option<f64>>,
) -> Option<Vec<Coordinate>> {
    let design = &studied.plan.design;
    let count = design.rows_of_point();
    let mut search = Search::new(design, goal)?;
    let mut first = 0;
    loop {
        let points = search.ask();
        if points.is_empty() {
            return None;
        }
        let end = first + points.len() as u64;
        if wanted < end {
            return points.get(usize::try_from(wanted - first).ok()?).cloned();
        }
        for row in (first * count..end * count).filter(|row| !sought.contains_key(row)).collect::<Vec<_>>() {
            let point = &points[usize::try_from(row / count - first).ok()?];
            let cells = worker.row(point, &design.each_of(row))?;
            sought.insert(row, cells.sought.filter(|x| x.is_finite()));
        }
        search.tell(&means(&sought, first * count..end * count, count));
        first = end;
    }
}

/// Prints a row, a line for each column.
fn print_row(row: u64, cells: &RowCells, columns: &[StudyColumn]) {
    let width = columns.iter().map(|column| column.name.chars().count()).max().unwrap_or(0).max("row".len());
    let mut text = format!("{:width$}  {row}\n", "row");
    for (column, cell) in columns.iter().zip(values(cells)) {
        let unit = if column.unit.is_empty() { String::new() } else { format!(" {}", column.unit) };
        text.push_str(&format!("{:width$}  {}{unit}\n", column.name, shown(cell)));
    }
    print(&text);
}

/// Returns the cells of a row in the order of the columns, as far as it has any.
fn values(cells: &RowCells) -> impl Iterator<Item = &Cell> {
    cells.axes.iter().chain(cells.outcome.iter().flatten())
}

fn json(row: u64, cells: &RowCells, columns: &[StudyColumn], pages: Vec<String>) -> JsonRow {
    let value = |cell: &Cell| match cell {
        Cell::Missing => Json::Null,
        Cell::Bool(b) => Json::from(*b),
        Cell::Whole(n) => Json::from(*n),
        Cell::Number(x) => Number::from_f64(*x).map_or_else(|| Json::from(shown(cell)), Json::Number),
        Cell::Text(text) => Json::from(text.as_str()),
    };
    let named = columns.iter().zip(values(cells)).map(|(column, cell)| (column.name.clone(), value(cell)));
    let (code, message) = match &cells.outcome {
        Ok(_) => Default::default(),
        Err(fault) => (fault.code.to_owned(), fault.message.clone()),
    };
    JsonRow { row, cells: named.collect(), code, message, pages }
}
