//! Tables of numbers as files of NumPy (NEP 1, version 3.0 of the form): an array of records.

use super::table::{RecordCell, RecordColumn, RecordTable};

/// The bytes at the start of a file, with the version of the form.
const MAGIC: &[u8] = b"\x93NUMPY\x03\x00";

/// The number of bytes that the head of a file is a multiple of.
const ALIGNMENT: usize = 64;

/// Returns a table as an `.npy` file: a field for each column, named as the column is without its unit, and a record for each
/// row. Columns of truth values are of the type `bool`, all others little-endian `float64` in SI units, in which what is no
/// number is NaN.
pub fn npy(table: &RecordTable) -> Vec<u8> {
    let truths: Vec<bool> = table.columns.iter().map(holds_truths).collect();
    let field = |(column, truth): (&RecordColumn, &bool)| {
        format!("({}, '{}')", literal(&column.name), if *truth { "|b1" } else { "<f8" })
    };
    let fields: Vec<String> = table.columns.iter().zip(&truths).map(field).collect();
    // The comma makes a list of one field a list, too.
    let fields = format!("[{}]", fields.iter().map(|field| format!("{field}, ")).collect::<String>());
    let mut head = format!("{{'descr': {fields}, 'fortran_order': False, 'shape': ({},), }}", table.rows);
    let before = MAGIC.len() + 4;
    let blanks = (before + head.len() + 1).next_multiple_of(ALIGNMENT) - (before + head.len() + 1);
    head.extend(std::iter::repeat_n(' ', blanks));
    head.push('\n');

    let mut bytes = MAGIC.to_vec();
    bytes.extend(u32::try_from(head.len()).expect("a head is short").to_le_bytes());
    bytes.extend(head.as_bytes());
    let record: usize = truths.iter().map(|truth| if *truth { 1 } else { 8 }).sum();
    bytes.reserve(table.rows * record);
    for row in 0..table.rows {
        for (column, truth) in table.columns.iter().zip(&truths) {
            match (&column.cells[row], truth) {
                (RecordCell::Bool(b), true) => bytes.push(u8::from(*b)),
                (cell, _) => bytes.extend(number(cell).to_le_bytes()),
            }
        }
    }
    bytes
}

/// Returns true if all cells of a column are truth values.
fn holds_truths(column: &RecordColumn) -> bool {
    !column.cells.is_empty() && column.cells.iter().all(|cell| matches!(cell, RecordCell::Bool(_)))
}

/// Returns the number of a cell, NaN for others.
fn number(cell: &RecordCell) -> f64 {
    match cell {
        RecordCell::Whole(n) => *n as f64,
        RecordCell::Quantity { si, .. } => *si,
        RecordCell::Missing | RecordCell::Bool(_) | RecordCell::Text(_) => f64::NAN,
    }
}

/// Returns a text as a literal of Python.
fn literal(text: &str) -> String {
    let mut quoted = String::from("'");
    for c in text.chars() {
        match c {
            '\'' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push_str(&format!("\\U{:08x}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('\'');
    quoted
}
