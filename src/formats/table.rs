//! Tables of records as CSV (RFC 4180) and as JSON.

use serde::Serialize;
use serde_json::{Number, Value as Json};

/// A table of records to be exported, by columns of equal length.
pub struct RecordTable {
    /// The columns of the table, in order.
    pub columns: Vec<RecordColumn>,
    /// The number of rows of the table, one for each record.
    pub rows: usize,
}

/// A column of a table: the values of one field of all records, with their unit.
pub struct RecordColumn {
    /// The name of the column, that of a field of the records.
    pub name: String,
    /// The unit of the column's numbers in CSV, as it is written, such as `mm`; `None` where they have none, or it
    /// holds something else.
    pub unit: Option<String>,
    /// The quantities of the column as (base unit, dimension in words), such as (`m`, `length`); `None` where it
    /// holds something else.
    pub quantity: Option<(String, String)>,
    /// The cells of the column, one for each record, in the order of the records.
    pub cells: Vec<RecordCell>,
}

/// A value of a table, as files can hold it: other values than these are text.
pub enum RecordCell {
    /// A missing value, which stays empty in CSV.
    Missing,
    /// A truth value, true or false.
    Bool(bool),
    /// A whole number, without unit.
    Whole(i64),
    /// A finite quantity, with or without unit.
    Quantity {
        /// The number of the quantity in the column's unit.
        shown: f64,
        /// The value of the quantity in SI units.
        si: f64,
    },
    /// Any other value, as text in words.
    Text(String),
}

/// Returns a table as CSV in UTF-8: a header line with units, then one line for each record, ended by CR LF. Numbers
/// are written with the fewest digits that read back to the same value; a missing value is an empty field.
pub(super) fn csv(table: &RecordTable) -> String {
    let head = |column: &RecordColumn| match &column.unit {
        Some(unit) => quoted(&format!("{} [{unit}]", column.name)),
        None => quoted(&column.name),
    };
    let cell = |cell: &RecordCell| match cell {
        RecordCell::Missing => String::new(),
        RecordCell::Bool(b) => b.to_string(),
        RecordCell::Whole(n) => n.to_string(),
        RecordCell::Quantity { shown, .. } => shown.to_string(),
        RecordCell::Text(text) => quoted(text),
    };
    let mut lines = vec![table.columns.iter().map(head).collect::<Vec<_>>().join(",")];
    for row in 0..table.rows {
        let cells: Vec<String> = table.columns.iter().map(|column| cell(&column.cells[row])).collect();
        lines.push(cells.join(","));
    }
    lines.push(String::new());
    lines.join("\r\n")
}

/// Returns a field as RFC 4180 wants it: in quotes where it holds a comma, a quote, a line break or outer blanks.
fn quoted(field: &str) -> String {
    let plain = !field.contains([',', '"', '\n', '\r']) && field.trim() == field;
    if plain { field.to_string() } else { format!("\"{}\"", field.replace('"', "\"\"")) }
}

#[derive(Serialize)]
struct TableJson<'t> {
    rows: usize,
    columns: Vec<ColumnJson<'t>>,
}

#[derive(Serialize)]
struct ColumnJson<'t> {
    name: &'t str,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'t str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    dimension: Option<&'t str>,
    values: Vec<Json>,
}

/// Returns a table as JSON: for each column its name, the unit and dimension of its quantities, and the values in that
/// unit, SI; a missing one is `null`.
pub(super) fn json(table: &RecordTable) -> String {
    let value = |cell: &RecordCell| match cell {
        RecordCell::Missing => Json::Null,
        RecordCell::Bool(b) => Json::from(*b),
        RecordCell::Whole(n) => Json::from(*n),
        RecordCell::Quantity { si, .. } => Number::from_f64(*si).map_or(Json::Null, Json::Number),
        RecordCell::Text(text) => Json::from(text.as_str()),
    };
    let column = |column| {
        let RecordColumn { name, quantity, cells, .. }: &RecordColumn = column;
        let (unit, dimension) = quantity.as_ref().map(|(u, d)| (u.as_str(), d.as_str())).unzip();
        ColumnJson { name, unit, dimension, values: cells.iter().map(value).collect() }
    };
    let whole = TableJson { rows: table.rows, columns: table.columns.iter().map(column).collect() };
    let mut text = serde_json::to_string_pretty(&whole).expect("its keys are texts");
    text.push('\n');
    text
}
