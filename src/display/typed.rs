//! Values by their kind, for programs in other languages.

use super::value::without_radians;
use crate::check::typed::DefKind;
use crate::geometry::Pose;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::printed::{SiUnit, TypedPose, TypedValue};
use crate::interpret::record::{DeclaredRecord, Record};
use crate::interpret::value::Value;
use crate::units::{Dimension, base_units, dimension_name};

/// The greatest depth of nested lists and records that is written: readers of JSON bear few levels.
const LEVELS_MAX: usize = 24;
/// The size in bytes that a value without texts counts for, about that of its JSON.
const VALUE_BYTES: usize = 64;

impl Interpreter<'_> {
    /// Returns a value in the form in which it is written as JSON. The bytes that it takes are subtracted from
    /// `bytes_left`; what does not fit is left out. `level`: the number of values around it.
    pub(super) fn typed_value(&self, value: &Value, level: usize, bytes_left: &mut usize) -> TypedValue {
        let text = if let Value::Text(text) = value { text.len() } else { 0 };
        let Some(left) = bytes_left.checked_sub(VALUE_BYTES + text).filter(|_| level <= LEVELS_MAX) else {
            return TypedValue::Omitted { omitted: true };
        };
        *bytes_left = left;
        match value {
            Value::Missing => TypedValue::Missing { missing: true },
            Value::Bool(b) => TypedValue::Bool { bool: *b },
            Value::Int(n) => TypedValue::Whole { number: *n },
            Value::Big(n) => {
                TypedValue::Big { number: value.as_number().unwrap_or(f64::NAN), digits: n.to_string() }
            }
            Value::Quantity(x, d) if x.is_infinite() => {
                TypedValue::Infinite { infinite: if *x > 0.0 { 1 } else { -1 }, unit: si_unit(*d) }
            }
            Value::Quantity(x, d) => TypedValue::Quantity { number: *x, unit: si_unit(*d) },
            Value::Text(text) => TypedValue::Text { text: text.to_string() },
            Value::Word(word) => TypedValue::Word { word: word.as_str() },
            Value::Vec3(v, d) => TypedValue::Vector { vector: (*v).into(), unit: si_unit(*d) },
            Value::Pose(pose) => TypedValue::Pose { pose: typed_pose(pose) },
            Value::Range(ends) => TypedValue::Range {
                from: Box::new(self.typed_value(&ends.0, level + 1, bytes_left)),
                to: Box::new(self.typed_value(&ends.1, level + 1, bytes_left)),
            },
            Value::List(elements) => self.typed_list(elements, level, bytes_left),
            Value::Record(record) if let Record::Declared(record) = &**record => {
                self.typed_record(record, level, bytes_left)
            }
            other => {
                let shown = self.show_value(other);
                *bytes_left = bytes_left.saturating_sub(shown.len());
                TypedValue::Other { shown }
            }
        }
    }

    fn typed_list(&self, elements: &[Value], level: usize, bytes_left: &mut usize) -> TypedValue {
        let mut list = Vec::new();
        for element in elements.iter().take_while(|_| level < LEVELS_MAX) {
            if *bytes_left < VALUE_BYTES {
                break;
            }
            list.push(self.typed_value(element, level + 1, bytes_left));
        }
        TypedValue::List { omitted: elements.len() - list.len(), list }
    }

    fn typed_record(&self, record: &DeclaredRecord, level: usize, bytes_left: &mut usize) -> TypedValue {
        let DefKind::Record(declared) = &self.shared.program.def(record.def).kind else {
            return TypedValue::Omitted { omitted: true };
        };
        let fields = declared.fields.iter().zip(&record.fields);
        let field = |(field, value): (&crate::check::typed::RecordField, &Value)| {
            (field.name.as_str(), self.typed_value(value, level + 1, bytes_left))
        };
        TypedValue::Record { record: self.name(record.def).as_str(), fields: fields.map(field).collect() }
    }
}

/// Returns the SI unit of a dimension, shown without radians as `print` does; `None` for plain numbers.
fn si_unit(dimension: Dimension) -> Option<SiUnit> {
    let dimension = without_radians(dimension);
    (dimension != Dimension::NUMBER)
        .then(|| SiUnit { unit: base_units(dimension), dimension: dimension_name(dimension) })
}

fn typed_pose(pose: &Pose) -> TypedPose {
    let q = pose.rotation.quaternion();
    TypedPose { p: pose.translation.vector.into(), q: [q.w, q.i, q.j, q.k] }
}
