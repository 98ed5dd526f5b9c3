//! Values that a program prints, as programs in other languages read them.

use serde::{Serialize, Serializer};

/// A value that was printed. Its fields are those of the JSON object (`docs/json.md`).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PrintedValue {
    /// The text that was printed for the value: one line, or all lines of a table.
    pub text: String,
    /// The value itself, by its kind.
    pub value: TypedValue,
}

/// A value as JSON, by its kind, which the names of its fields tell. Quantities are in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum TypedValue {
    /// A finite quantity with its unit.
    Quantity {
        /// The number of SI units that the quantity has.
        number: f64,
        /// The SI unit, a product of base units such as `kg*m/s^2`, and the dimension; `None` for a plain number.
        #[serde(flatten)]
        unit: Option<SiUnit>,
    },
    /// A quantity beyond all bounds, such as a margin that nothing limits.
    Infinite {
        /// The sign of the infinite quantity, 1 or -1.
        infinite: i8,
        /// The SI unit of the quantity and its dimension; `None` for a plain number.
        #[serde(flatten)]
        unit: Option<SiUnit>,
    },
    /// A whole number that fits in 64 bits.
    Whole {
        /// The whole number.
        number: i64,
    },
    /// A whole number that does not fit in 64 bits.
    Big {
        /// The whole number, rounded to a double; JSON has `null` for one beyond 1.8e308.
        number: f64,
        /// The decimal digits of the whole number.
        digits: String,
    },
    /// A truth value: `true` or `false`.
    Bool {
        /// The truth value, true or false.
        bool: bool,
    },
    /// A text of the type `Text`.
    Text {
        /// The text itself, without quotes.
        text: String,
    },
    /// A word of a choice, such as `auto`.
    Word {
        /// The word, as programs write it.
        word: &'static str,
    },
    /// A vector, in the order x, y, z.
    Vector {
        /// The components x, y and z, in SI units.
        vector: [f64; 3],
        /// The SI unit of each component and the dimension; `None` for plain numbers.
        #[serde(flatten)]
        unit: Option<SiUnit>,
    },
    /// A pose, in the form that plan files have.
    Pose {
        /// The position and the rotation.
        pose: TypedPose,
    },
    /// A range `from..to` with its two ends.
    Range {
        /// The first end of the range.
        from: Box<TypedValue>,
        /// The second end of the range.
        to: Box<TypedValue>,
    },
    /// A list of values, in order.
    List {
        /// The elements of the list, in order.
        list: Vec<TypedValue>,
        /// The number of further elements of the list that are left out, because there were too many.
        #[serde(skip_serializing_if = "is_zero")]
        omitted: usize,
    },
    /// A record of a type that the program declares.
    Record {
        /// The name of the record's declaration.
        record: &'static str,
        /// The fields of the record by name, in the order of the declaration.
        #[serde(serialize_with = "as_map")]
        fields: Vec<(&'static str, TypedValue)>,
    },
    /// The missing value of an optional type.
    Missing {
        /// The flag that marks a missing value, always true.
        missing: bool,
    },
    /// A value of another kind, such as a plan or a robot.
    Other {
        /// The text that is printed for the value.
        shown: String,
    },
    /// A value that is left out, because there were too many before it or it lies too deep.
    Omitted {
        /// The flag that marks a value that is left out, always true.
        omitted: bool,
    },
}

/// The SI unit of a quantity, with its dimension.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SiUnit {
    /// The SI unit as a product of base units: `m`, `kg*m/s^2`.
    pub unit: String,
    /// The dimension as programs write it: `Length`, `Quantity<kg*m^2>`.
    pub dimension: String,
}

/// A pose in the form that plan files have.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TypedPose {
    /// The position x, y, z, m, in the frame of the context.
    pub p: [f64; 3],
    /// The rotation as a unit quaternion in the order w, x, y, z.
    pub q: [f64; 4],
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

fn as_map<S: Serializer>(fields: &[(&'static str, TypedValue)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(fields.iter().map(|(name, value)| (name, value)))
}
