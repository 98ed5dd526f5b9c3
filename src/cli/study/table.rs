//! The table of a study: rows as CSV, and shards merged.

use super::identity::Identity;
use super::store::{Line, Listing, Store};
use crate::cli::disk::system_words;
use crate::cli::output;
use crate::interpret::study::RowCells;
use crate::interpret::study_columns::{Cell, StudyColumn};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The most characters of a number that is written without an exponent.
const PLAIN_MAX: usize = 24;

/// The description of a table, in the file beside it.
#[derive(Debug, Serialize)]
struct Description<'t> {
    #[serde(flatten)]
    identity: &'t Identity,
    /// The sampler as it is written, with what stands after `each`.
    sampler: &'t str,
    rows: u64,
    /// The number of rows without values, by the code of their errors.
    failed: &'t BTreeMap<String, u64>,
    columns: Vec<Column<'t>>,
    /// The SHA-256 of each file that the rows read, by its path.
    files: BTreeMap<String, String>,
    /// The first row that is best, of a search.
    #[serde(skip_serializing_if = "Option::is_none")]
    best: Option<u64>,
}

#[derive(Debug, Serialize)]
struct Column<'t> {
    name: &'t str,
    #[serde(rename = "type")]
    ty: &'t str,
    #[serde(skip_serializing_if = "str::is_empty")]
    unit: &'t str,
    axis: bool,
}

/// A merged table.
pub(super) struct Merged {
    /// The path of the table in CSV.
    pub csv: PathBuf,
    /// The number of rows without values, by the code of their errors.
    pub failed: BTreeMap<String, u64>,
    /// The first row that is best, of a search.
    pub best: Option<u64>,
}

/// Returns the first line of a table: the names of the columns with their units.
fn header(columns: &[StudyColumn]) -> String {
    let head = |column: &StudyColumn| match column.unit.as_str() {
        "" => quoted(&column.name),
        unit => quoted(&format!("{} [{unit}]", column.name)),
    };
    let names: Vec<String> = columns.iter().map(head).collect();
    format!("row,{},code,message", names.join(","))
}

/// Returns a row as a line of the table. `columns`: the number of columns of axes and fields.
pub(super) fn line(row: u64, cells: &RowCells, columns: usize) -> Line {
    let mut fields = vec![row.to_string()];
    fields.extend(cells.axes.iter().map(shown));
    let (code, message) = match &cells.outcome {
        Ok(values) => {
            fields.extend(values.iter().map(shown));
            (String::new(), String::new())
        }
        Err(fault) => (fault.code.to_owned(), fault.message.replace(['\n', '\r'], " ")),
    };
    fields.resize(columns + 1, String::new());
    fields.extend([code.clone(), quoted(&message)]);
    Line { csv: fields.join(","), code, sought: cells.sought.filter(|x| x.is_finite()) }
}

/// Returns a cell as CSV: numbers with the fewest digits that read back to the same value.
pub(super) fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Missing => String::new(),
        Cell::Bool(b) => b.to_string(),
        Cell::Whole(n) => n.to_string(),
        Cell::Number(x) => {
            let plain = x.to_string();
            if plain.len() > PLAIN_MAX { format!("{x:e}") } else { plain }
        }
        Cell::Text(text) => quoted(text),
    }
}

/// Returns a field as RFC 4180 wants it.
fn quoted(field: &str) -> String {
    let plain = !field.contains([',', '"', '\n', '\r']) && field.trim() == field;
    if plain { field.to_owned() } else { format!("\"{}\"", field.replace('"', "\"\"")) }
}

/// Merges the shards of a complete listing to the table and its description, which are written whole or not at all, shard
/// by shard. `greatest`: true if the greatest of what a search seeks is best.
///
/// # Errors
/// A message if a shard is missing or unsound, or the system refuses.
pub(super) fn merge(
    store: &Store,
    listing: &Listing,
    (identity, sampler): (&Identity, &str),
    (rows, columns): (u64, &[StudyColumn]),
    greatest: bool,
    out: &Path,
) -> Result<Merged, String> {
    let system = |e: io::Error| format!("the table can't be written: {}", system_words(&e));
    std::fs::create_dir_all(out).map_err(system)?;
    let file = output::begun(out).map_err(system)?;
    let mut writer = BufWriter::new(file);
    write!(writer, "{}\r\n", header(columns)).map_err(system)?;
    let mut failed = BTreeMap::new();
    let mut best: Option<(u64, f64)> = None;
    let (next, files) = store.each_row(listing, |row, line| {
        write!(writer, "{}\r\n", line.csv).map_err(system)?;
        if !line.code.is_empty() {
            *failed.entry(line.code).or_insert(0) += 1;
        }
        if let Some(x) = line.sought
            && best.is_none_or(|(_, old)| if greatest { x > old } else { x < old })
        {
            best = Some((row, x));
        }
        Ok(())
    })?;
    if next != rows {
        return Err(format!("row {next} is missing"));
    }
    let csv = out.join(format!("{}.csv", identity.study));
    let file = writer.into_inner().map_err(|e| system(e.into_error()))?;
    output::persisted(file, &csv).map_err(system)?;
    let column = |column| {
        let StudyColumn { name, ty, unit, axis, .. }: &StudyColumn = column;
        Column { name, ty, unit, axis: *axis }
    };
    let columns = columns.iter().map(column).collect();
    let best = best.map(|(row, _)| row);
    let description = Description { identity, sampler, rows, failed: &failed, columns, files, best };
    let text = serde_json::to_string_pretty(&description).expect("its keys are texts") + "\n";
    let name = format!("{}.json", identity.study);
    output::write(out, &name, text.as_bytes()).map_err(|_| format!("`{name}` can't be written"))?;
    Ok(Merged { csv, failed, best })
}
