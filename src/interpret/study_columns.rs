//! The columns of a study's table, and values as cells of it.

use super::interpreter::Interpreter;
use super::record::{DeclaredRecord, Record};
use super::value::Value;
use crate::check::typed::{DefId, DefKind, Program, RecordDef};
use crate::check::{Checked, Type};
use crate::source::Symbol;
use crate::units::{Dimension, base_units};

/// A column of a study's table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudyColumn {
    /// The name of the column: that of an axis or a field; that of a field in a record is `outer.inner`, of a vector
    /// `field.x`.
    pub name: String,
    /// The type of the column's values, as programs write it: `Speed`, `Int`.
    pub ty: String,
    /// The unit of the column's numbers, a product of base units of the SI; empty for others.
    pub unit: String,
    /// The dimension of the column's numbers; `None` for other values.
    pub dimension: Option<Dimension>,
    /// True for an axis, false for a field of the row.
    pub axis: bool,
}

/// A value of a study's table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A missing value.
    Missing,
    /// A truth value.
    Bool(bool),
    /// A whole number.
    Whole(i64),
    /// A number, in SI units.
    Number(f64),
    /// A text, a word of a choice, or a whole number beyond 64 bits.
    Text(String),
}

impl StudyColumn {
    /// Returns the columns of a study's table: its axes, those after `each`, then the fields of its row. Panics if the
    /// declaration is no study.
    pub fn all(checked: &Checked, study: DefId) -> Vec<StudyColumn> {
        let program = &checked.program;
        let DefKind::Study(study) = &program.def(study).kind else { unreachable!("it is a study") };
        let axes = study.axes.iter().chain(&study.each);
        let mut columns: Vec<StudyColumn> =
            axes.map(|axis| StudyColumn::of(program, axis.name.to_string(), &axis.ty, true)).collect();
        let axes = columns.len();
        if let Some(row) = study.row {
            add_fields(program, row, "", &mut columns);
        }
        // A field that repeats an axis is no column of its own.
        let names: Vec<String> = columns[..axes].iter().map(|axis| axis.name.clone()).collect();
        columns.retain(|column| column.axis || !names.contains(&column.name));
        columns
    }

    fn of(program: &Program, name: String, ty: &Type, axis: bool) -> StudyColumn {
        let inner = if let Type::Optional(inner) = ty { inner } else { ty };
        let dimension = inner.dimension();
        let unit = dimension.map(base_units).unwrap_or_default();
        StudyColumn { name, ty: program.type_name(ty), unit, dimension, axis }
    }
}

/// Adds the columns of the fields of a record.
fn add_fields(program: &Program, record: DefId, prefix: &str, columns: &mut Vec<StudyColumn>) {
    let DefKind::Record(RecordDef { fields, .. }) = &program.def(record).kind else { return };
    for field in fields {
        let name = format!("{prefix}{}", field.name);
        match &field.ty {
            Type::Record(inner) => add_fields(program, *inner, &format!("{name}."), columns),
            Type::Vec3(inner) => {
                let part = |axis| StudyColumn::of(program, format!("{name}.{axis}"), inner, false);
                columns.extend(["x", "y", "z"].map(part));
            }
            ty => columns.push(StudyColumn::of(program, name, ty, false)),
        }
    }
}

impl Cell {
    /// Returns a value as a cell.
    pub(super) fn of(interpreter: &Interpreter, value: &Value) -> Cell {
        match value {
            Value::Missing => Cell::Missing,
            Value::Bool(b) => Cell::Bool(*b),
            Value::Int(n) => Cell::Whole(*n),
            Value::Quantity(x, _) => Cell::Number(*x),
            value => Cell::Text(interpreter.show(value)),
        }
    }
}

impl Interpreter<'_> {
    /// Returns the cells of a row's record, in the order of the columns. `axes`: the names and values of the axes, which
    /// fields may repeat.
    ///
    /// # Errors
    /// The name of a field that has the name of an axis, but not its value.
    pub(super) fn row_cells(&self, row: &Value, axes: &[(Symbol, Value)]) -> Result<Vec<Cell>, Symbol> {
        let mut cells = Vec::new();
        let Some(record) = declared(row) else { return Ok(cells) };
        let DefKind::Record(RecordDef { fields, .. }) = &self.shared.program.def(record.def).kind else {
            return Ok(cells);
        };
        for (field, value) in fields.iter().zip(&record.fields) {
            match axes.iter().find(|(axis, _)| *axis == field.name) {
                Some((_, axis)) if Cell::of(self, axis) == Cell::of(self, value) => {}
                Some((name, _)) => return Err(*name),
                None => self.add_cells(value, &mut cells),
            }
        }
        Ok(cells)
    }

    fn add_cells(&self, value: &Value, cells: &mut Vec<Cell>) {
        match (declared(value), value) {
            (Some(record), _) => record.fields.iter().for_each(|field| self.add_cells(field, cells)),
            (None, Value::Vec3(v, _)) => cells.extend(v.iter().map(|x| Cell::Number(*x))),
            (None, value) => cells.push(Cell::of(self, value)),
        }
    }
}

fn declared(value: &Value) -> Option<&DeclaredRecord> {
    match value {
        Value::Record(record) => match &**record {
            Record::Declared(declared) => Some(declared),
            _ => None,
        },
        _ => None,
    }
}
