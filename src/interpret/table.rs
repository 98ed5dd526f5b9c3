//! Tables: lists of records with a column for each field.

use super::interpreter::Interpreter;
use super::record::{DeclaredRecord, Record};
use super::value::Value;
use crate::check::typed::{DefKind, RecordDef};
use crate::units::{Dimension, base_units, fitting_unit, to_si, usual_unit};

/// The greatest depth of records within records that have columns of their own; deeper ones are one text.
const LEVELS_MAX: usize = 8;

/// A table: a list of records of one declaration, by columns.
pub struct Table {
    /// The columns of the table, in the order of the fields.
    pub columns: Vec<Column>,
    /// The number of rows of the table, which is the number of records.
    pub rows: usize,
}

/// The values of one field of all records of a [`Table`]; a record or vector in it is several columns.
pub struct Column {
    /// The name of the column's field; that of a field of a record in a record is `outer.inner`, of a vector
    /// `field.x`.
    pub name: String,
    /// The values of the column, one for each record in their order.
    pub cells: Vec<Value>,
}

impl Interpreter<'_> {
    /// Returns a list of records of one declaration as a table; `None` for other values, and for an empty list.
    pub fn table(&self, value: &Value) -> Option<Table> {
        let Value::List(elements) = value else { return None };
        let records: Option<Vec<&DeclaredRecord>> = elements.iter().map(declared).collect();
        let records = records?;
        let def = records.first()?.def;
        if records.iter().any(|record| record.def != def) {
            return None;
        }
        let mut columns = Vec::new();
        self.add_columns("", &records, 0, &mut columns);
        Some(Table { columns, rows: records.len() })
    }

    fn add_columns(
        &self,
        prefix: &str,
        records: &[&DeclaredRecord],
        level: usize,
        columns: &mut Vec<Column>,
    ) {
        let Some(first) = records.first() else { return };
        let DefKind::Record(RecordDef { fields, .. }) = &self.shared.program.def(first.def).kind else {
            return;
        };
        for (index, field) in fields.iter().enumerate() {
            let name = format!("{prefix}{}", field.name);
            let cells: Vec<Value> = records.iter().map(|record| record.fields[index].clone()).collect();
            let inner: Option<Vec<&DeclaredRecord>> = cells.iter().map(declared).collect();
            if let Some(inner) = inner.filter(|_| level < LEVELS_MAX) {
                self.add_columns(&format!("{name}."), &inner, level + 1, columns);
            } else if cells.iter().all(|cell| matches!(cell, Value::Vec3(..))) {
                for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                    let part = |cell: &Value| match cell {
                        Value::Vec3(v, dimension) => Value::Quantity(v[axis], *dimension),
                        other => other.clone(),
                    };
                    let cells = cells.iter().map(part).collect();
                    columns.push(Column { name: format!("{name}.{letter}"), cells });
                }
            } else {
                columns.push(Column { name, cells });
            }
        }
    }
}

fn declared(value: &Value) -> Option<&DeclaredRecord> {
    let Value::Record(record) = value else { return None };
    match &**record {
        Record::Declared(record) => Some(record),
        _ => None,
    }
}

impl Column {
    /// Returns the dimension of the column's quantities, missing ones left out; `None` where it holds something else,
    /// or nothing.
    pub fn dimension(&self) -> Option<Dimension> {
        let other = |cell: &Value| !matches!(cell, Value::Missing) && cell.as_dimension().is_none();
        if self.cells.iter().any(other) {
            return None;
        }
        self.cells.iter().find_map(Value::as_dimension)
    }

    /// Returns the unit that suits the largest of the column's quantities, as (name, factor to SI); `None` for numbers
    /// and for other values.
    pub fn unit(&self) -> Option<(String, f64)> {
        let dimension = self.dimension().filter(|dimension| *dimension != Dimension::NUMBER)?;
        let finite = self.cells.iter().filter_map(Value::as_number).filter(|x| x.is_finite());
        let largest = finite.fold(0.0, |largest: f64, x| largest.max(x.abs()));
        Some(if largest == 0.0 { (usual_unit(dimension), 1.0) } else { fitting_unit(largest, dimension) })
    }

    /// Returns the unit in which files hold the column, as (name, factor to SI): the one that suits it, if every value
    /// comes back from its decimals exactly; else the base units. `None` for numbers and for other values, as
    /// [`unit`](Self::unit).
    pub fn exact_unit(&self) -> Option<(String, f64)> {
        let (unit, factor) = self.unit()?;
        let mut finite = self.cells.iter().filter_map(Value::as_number).filter(|x| x.is_finite());
        match finite.all(|x| in_unit(x, factor).is_some()) {
            true => Some((unit, factor)),
            false => self.dimension().map(|dimension| (base_units(dimension), 1.0)),
        }
    }
}

/// Returns the number that gives `value` (SI) back to the bit when it is read in a unit with this factor to SI: the
/// quotient of `value` and one unit, rounded to ten significant digits if that reads back exactly, else the quotient
/// itself or one of the two doubles next to it; `None` if none of these does. With the factor 1 it is `value` itself.
pub fn in_unit(value: f64, factor: f64) -> Option<f64> {
    if factor == 1.0 {
        return Some(value);
    }
    let near = value / to_si(1.0, factor);
    let round = format!("{near:.9e}").parse().unwrap_or(near);
    [round, near, near.next_up(), near.next_down()].into_iter().find(|x| to_si(*x, factor) == value)
}
