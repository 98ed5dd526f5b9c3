//! Values that a program prints, as programs in other languages read them.

use serde::{Serialize, Serializer};

/// A value that was printed. Its fields are those of the JSON object (`docs/json.md`).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PrintedValue {
    /// The text that was printed for it: one line, or all lines of a table.
    pub text: String,
    /// The value itself.
    pub value: TypedValue,
}

/// A value by its kind, which the names of its fields tell. Quantities are in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum TypedValue {
    /// A finite quantity.
    Quantity {
        /// The number of SI units.
        number: f64,
        /// The unit, a product of base units such as `kg*m/s^2`, and the dimension; `None` for a plain number.
        #[serde(flatten)]
        unit: Option<SiUnit>,
    },
    /// A quantity beyond all bounds, such as a margin that nothing limits.
    Infinite {
        /// The sign, 1 or -1.
        infinite: i8,
        /// The unit and the dimension; `None` for a plain number.
        #[serde(flatten)]
        unit: Option<SiUnit>,
    },
    /// A whole number that fits in 64 bits.
    Whole {
        /// The number.
        number: i64,
    },
    /// A whole number beyond 64 bits.
    Big {
        /// The number, rounded to a double; JSON has `null` for one beyond 1.8e308.
        number: f64,
        /// Its decimal digits.
        digits: String,
    },
    /// A truth value.
    Bool {
        /// The value.
        bool: bool,
    },
    /// A text.
    Text {
        /// The text, as it is.
        text: String,
    },
    /// A word of a choice, such as `auto`.
    Word {
        /// The word.
        word: &'static str,
    },
    /// A vector, in the order x, y, z.
    Vector {
        /// The numbers of SI units.
        vector: [f64; 3],
        /// The unit and the dimension of each; `None` for plain numbers.
        #[serde(flatten)]
        unit: Option<SiUnit>,
    },
    /// A pose, as plan files have it.
    Pose {
        /// Position and rotation.
        pose: TypedPose,
    },
    /// A range `from..to`.
    Range {
        /// The first end.
        from: Box<TypedValue>,
        /// The second end.
        to: Box<TypedValue>,
    },
    /// A list.
    List {
        /// The elements, in order.
        list: Vec<TypedValue>,
        /// The number of elements behind them that are left out, because there were too many.
        #[serde(skip_serializing_if = "is_zero")]
        omitted: usize,
    },
    /// A record that the program declares.
    Record {
        /// The name of its declaration.
        record: &'static str,
        /// The fields by name, in the order of the declaration.
        #[serde(serialize_with = "as_map")]
        fields: Vec<(&'static str, TypedValue)>,
    },
    /// The missing value.
    Missing {
        /// Always true.
        missing: bool,
    },
    /// A value of another kind, such as a plan or a robot.
    Other {
        /// The text that is printed for it.
        shown: String,
    },
    /// A value that is left out, because there were too many before it or it lies too deep.
    Omitted {
        /// Always true.
        omitted: bool,
    },
}

/// The SI unit of a quantity, with its dimension.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SiUnit {
    /// The unit, a product of base units: `m`, `kg*m/s^2`.
    pub unit: String,
    /// The dimension as it is written in programs: `Length`, `Quantity<kg*m^2>`.
    pub dimension: String,
}

/// A pose, as plan files have it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TypedPose {
    /// The position x, y, z, m.
    pub p: [f64; 3],
    /// The rotation as a unit quaternion w, x, y, z.
    pub q: [f64; 4],
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

fn as_map<S: Serializer>(fields: &[(&'static str, TypedValue)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(fields.iter().map(|(name, value)| (name, value)))
}
