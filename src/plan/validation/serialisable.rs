//! A check of values that are to be written as JSON for what JSON cannot hold: numbers that are not
//! finite (they would become `null`), and nesting deeper than a reader takes.

use serde::ser::{self, Serialize};

/// A part of a value that JSON cannot hold, as the serialisation of the value finds it.
#[derive(Clone, Debug, PartialEq)]
pub enum Unwritable {
    /// A number that is not finite.
    Number {
        /// The name of the last named field that holds the number; empty if there is none.
        field: &'static str,
        /// The number that was found: infinite or NaN.
        value: f64,
    },
    /// A field that is nested more deeply than readers take.
    TooDeep {
        /// The name of the field that is nested too deeply; empty if there is none.
        field: &'static str,
    },
    /// Another reason, in the words of the value's serialisation.
    Other(String),
}

/// The greatest depth of nesting that is written; readers refuse more than 128.
const DEPTH_MAX: usize = 100;

/// Checks that all numbers are finite, and nesting is not deeper than [`DEPTH_MAX`].
///
/// # Errors
/// The first [`Unwritable`] part.
pub(in crate::plan) fn check_serialisable(value: &impl Serialize) -> Result<(), Unwritable> {
    value.serialize(&mut Walk { field: "", depth: 0 })
}

struct Walk {
    /// The field that the walk is in.
    field: &'static str,
    depth: usize,
}

impl std::fmt::Display for Unwritable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Unwritable::Number { field, value } => {
                write!(f, "`{field}` holds {value}, which no plan file can")
            }
            Unwritable::TooDeep { field } => write!(f, "`{field}` is nested too deeply to be written"),
            Unwritable::Other(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Unwritable {}

impl ser::Error for Unwritable {
    fn custom<T: std::fmt::Display>(message: T) -> Unwritable {
        Unwritable::Other(message.to_string())
    }
}

impl Walk {
    fn enter(&mut self) -> Result<&mut Walk, Unwritable> {
        self.depth += 1;
        if self.depth > DEPTH_MAX {
            return Err(Unwritable::TooDeep { field: self.field });
        }
        Ok(self)
    }

    fn leave(&mut self) -> Result<(), Unwritable> {
        self.depth -= 1;
        Ok(())
    }
}

macro_rules! fine {
    ($($name:ident($type:ty)),*) => { $(fn $name(self, _: $type) -> Result<(), Unwritable> { Ok(()) })* };
}

impl<'a> ser::Serializer for &'a mut Walk {
    type Ok = ();
    type Error = Unwritable;
    type SerializeSeq = &'a mut Walk;
    type SerializeTuple = &'a mut Walk;
    type SerializeTupleStruct = &'a mut Walk;
    type SerializeTupleVariant = &'a mut Walk;
    type SerializeMap = &'a mut Walk;
    type SerializeStruct = &'a mut Walk;
    type SerializeStructVariant = &'a mut Walk;

    fine!(serialize_bool(bool), serialize_i8(i8), serialize_i16(i16), serialize_i32(i32), serialize_i64(i64));
    fine!(serialize_u8(u8), serialize_u16(u16), serialize_u32(u32), serialize_u64(u64));
    fine!(
        serialize_char(char),
        serialize_str(&str),
        serialize_bytes(&[u8]),
        serialize_unit_struct(&'static str)
    );

    fn serialize_f32(self, v: f32) -> Result<(), Unwritable> {
        self.serialize_f64(f64::from(v))
    }
    fn serialize_f64(self, v: f64) -> Result<(), Unwritable> {
        if v.is_finite() { Ok(()) } else { Err(Unwritable::Number { field: self.field, value: v }) }
    }
    fn serialize_none(self) -> Result<(), Unwritable> {
        Ok(())
    }
    fn serialize_unit(self) -> Result<(), Unwritable> {
        Ok(())
    }
    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Unwritable> {
        value.serialize(self)
    }
    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<(), Unwritable> {
        Ok(())
    }
    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<(), Unwritable> {
        value.serialize(self)
    }
    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        value: &T,
    ) -> Result<(), Unwritable> {
        let walk = self.enter()?;
        value.serialize(&mut *walk)?;
        walk.leave()
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<&'a mut Walk, Unwritable> {
        self.enter()
    }
    fn serialize_tuple(self, _: usize) -> Result<&'a mut Walk, Unwritable> {
        self.enter()
    }
    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<&'a mut Walk, Unwritable> {
        self.enter()
    }
    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<&'a mut Walk, Unwritable> {
        self.enter()
    }
    fn serialize_map(self, _: Option<usize>) -> Result<&'a mut Walk, Unwritable> {
        self.enter()
    }
    fn serialize_struct(self, _: &'static str, _: usize) -> Result<&'a mut Walk, Unwritable> {
        self.enter()
    }
    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<&'a mut Walk, Unwritable> {
        // The variant and its fields are two objects in JSON.
        self.enter()
    }
}

macro_rules! elements {
    ($($trait:ident::$method:ident),*) => { $(
        impl ser::$trait for &mut Walk {
            type Ok = ();
            type Error = Unwritable;
            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unwritable> {
                value.serialize(&mut **self)
            }
            fn end(self) -> Result<(), Unwritable> {
                self.leave()
            }
        }
    )* };
}

macro_rules! fields {
    ($($trait:ident),*) => { $(
        impl ser::$trait for &mut Walk {
            type Ok = ();
            type Error = Unwritable;
            fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Unwritable> {
                self.field = key;
                value.serialize(&mut **self)
            }
            fn end(self) -> Result<(), Unwritable> {
                self.leave()
            }
        }
    )* };
}

elements!(SerializeSeq::serialize_element, SerializeTuple::serialize_element);
elements!(SerializeTupleStruct::serialize_field, SerializeTupleVariant::serialize_field);
fields!(SerializeStruct, SerializeStructVariant);

impl ser::SerializeMap for &mut Walk {
    type Ok = ();
    type Error = Unwritable;
    fn serialize_key<T: Serialize + ?Sized>(&mut self, _: &T) -> Result<(), Unwritable> {
        Ok(())
    }
    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unwritable> {
        value.serialize(&mut **self)
    }
    fn end(self) -> Result<(), Unwritable> {
        self.leave()
    }
}
