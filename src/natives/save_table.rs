//! Tables of records for files.

use crate::formats::{RecordCell, RecordColumn, RecordTable};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::table::{Column, Table, in_unit};
use crate::interpret::value::Value;
use crate::units::{base_units, dimension_name};

/// Returns a table in the form in which files hold it: columns with their units, and the cells of each record in those
/// units.
pub(super) fn for_file(interpreter: &Interpreter, table: &Table) -> RecordTable {
    let columns = table.columns.iter().map(|column| column_for_file(interpreter, column)).collect();
    RecordTable { columns, rows: table.rows }
}

fn column_for_file(interpreter: &Interpreter, column: &Column) -> RecordColumn {
    let unit = column.exact_unit();
    let factor = unit.as_ref().map_or(1.0, |(_, factor)| *factor);
    let cell = |value: &Value| match value {
        Value::Missing => RecordCell::Missing,
        Value::Bool(b) => RecordCell::Bool(*b),
        Value::Int(n) => RecordCell::Whole(*n),
        Value::Quantity(x, _) if x.is_finite() => {
            RecordCell::Quantity { shown: in_unit(*x, factor).unwrap_or(*x), si: *x }
        }
        value => RecordCell::Text(interpreter.show(value)),
    };
    RecordColumn {
        name: column.name.clone(),
        unit: unit.map(|(name, _)| name),
        quantity: column.dimension().map(|dimension| (base_units(dimension), dimension_name(dimension))),
        cells: column.cells.iter().map(cell).collect(),
    }
}
