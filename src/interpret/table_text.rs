//! Tables as text: a line for each record, with aligned digits and one unit for each column.

use super::interpreter::Interpreter;
use super::table::{Column, Table};
use super::value::Value;
use crate::units::{fixed, number, to_si};

/// The greatest number of decimals in a column.
const DECIMALS_MAX: usize = 9;
/// The greatest number of rows that are shown; the rest are counted.
const ROWS_SHOWN: usize = 1000;

impl Interpreter<'_> {
    /// Returns a table as lines of text: the names of its columns, its first `ROWS_SHOWN` rows, and the number of the
    /// rest. `None` where it has no columns.
    pub fn show_table(&self, table: &Table) -> Option<String> {
        let columns: Vec<Shown> = table.columns.iter().map(|column| self.show_column(column)).collect();
        if columns.is_empty() {
            return None;
        }
        let mut lines = Vec::new();
        for row in 0..=table.rows.min(ROWS_SHOWN) {
            let mut line = String::new();
            for (i, column) in columns.iter().enumerate() {
                let cell = &column.cells[row];
                let blanks = " ".repeat(column.width - width(cell));
                line.push_str(if i > 0 { "  " } else { "" });
                line.push_str(&if column.right { blanks + cell } else { cell.clone() + &blanks });
            }
            lines.push(line.trim_end().to_string());
        }
        if table.rows > ROWS_SHOWN {
            lines.push(format!("and {} more", table.rows - ROWS_SHOWN));
        }
        Some(lines.join("\n"))
    }

    fn show_column(&self, column: &Column) -> Shown {
        let unit = column.unit();
        let (head, factor) = match &unit {
            Some((unit, factor)) => (format!("{} [{unit}]", column.name), to_si(1.0, *factor)),
            None => (column.name.clone(), 1.0),
        };
        let numbers: Vec<f64> = match column.dimension() {
            Some(_) => column.cells.iter().filter_map(Value::as_number).map(|x| x / factor).collect(),
            None => vec![],
        };
        let decimals = decimals(&numbers);
        let cell = |value: &Value| match (value, column.dimension()) {
            // Whole numbers may be larger than a quantity holds.
            (Value::Int(_) | Value::Big(_) | Value::Missing, _) | (_, None) => one_line(&self.show(value)),
            (value, Some(_)) => match value.as_number().map(|x| x / factor) {
                Some(x) if x.is_finite() => decimals.map_or_else(|| number(x), |places| fixed(x, places)),
                _ => self.show(value),
            },
        };
        let mut cells = vec![head];
        cells.extend(column.cells.iter().take(ROWS_SHOWN).map(cell));
        let width = cells.iter().map(|cell| width(cell)).max().unwrap_or(0);
        Shown { cells, width, right: column.dimension().is_some() }
    }
}

/// A column as texts.
struct Shown {
    /// The head, and a text for each record.
    cells: Vec<String>,
    /// The width of the widest, in characters.
    width: usize,
    /// True if texts end at one place, as numbers do.
    right: bool,
}

fn width(text: &str) -> usize {
    text.chars().count()
}

/// Returns a text on one line.
fn one_line(text: &str) -> String {
    text.replace('\n', " ")
}

/// Returns the number of decimals that all numbers of a column have: as many as the one that needs most, but at
/// most [`DECIMALS_MAX`]. `None` where one is shown with an exponent.
fn decimals(numbers: &[f64]) -> Option<usize> {
    let shown: Vec<String> = numbers.iter().filter(|x| x.is_finite()).map(|x| number(*x)).collect();
    if shown.iter().any(|text| text.contains('e')) {
        return None;
    }
    let after = |text: &String| text.split_once('.').map_or(0, |(_, after)| after.len());
    Some(shown.iter().map(after).max().unwrap_or(0).min(DECIMALS_MAX))
}
