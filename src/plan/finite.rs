//! Looks through a value that is to be written as JSON for what JSON cannot hold: numbers that are
//! not finite (they would become `null`), and nesting deeper than a reader takes.

use serde::ser::{self, Serialize};

/// What cannot be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault(String);

/// Deepest nesting that is written; readers refuse more than 128.
const DEPTH_MAX: usize = 100;

/// Refuses numbers that are not finite, and nesting deeper than [`DEPTH_MAX`].
pub fn check(value: &impl Serialize) -> Result<(), Fault> {
    value.serialize(&mut Walk { field: "", depth: 0 })
}

struct Walk {
    /// The field that is being looked at.
    field: &'static str,
    depth: usize,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Fault {}

impl ser::Error for Fault {
    fn custom<T: std::fmt::Display>(message: T) -> Fault {
        Fault(message.to_string())
    }
}

impl Walk {
    fn enter(&mut self) -> Result<&mut Walk, Fault> {
        self.depth += 1;
        if self.depth > DEPTH_MAX {
            return Err(Fault(format!("`{}` is nested too deeply to be written", self.field)));
        }
        Ok(self)
    }

    fn leave(&mut self) -> Result<(), Fault> {
        self.depth -= 1;
        Ok(())
    }
}

macro_rules! fine {
    ($($name:ident($type:ty)),*) => { $(fn $name(self, _: $type) -> Result<(), Fault> { Ok(()) })* };
}

impl<'a> ser::Serializer for &'a mut Walk {
    type Ok = ();
    type Error = Fault;
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

    fn serialize_f32(self, v: f32) -> Result<(), Fault> {
        self.serialize_f64(f64::from(v))
    }
    fn serialize_f64(self, v: f64) -> Result<(), Fault> {
        if v.is_finite() {
            Ok(())
        } else {
            Err(Fault(format!("`{}` holds {v}, which no plan file can", self.field)))
        }
    }
    fn serialize_none(self) -> Result<(), Fault> {
        Ok(())
    }
    fn serialize_unit(self) -> Result<(), Fault> {
        Ok(())
    }
    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Fault> {
        value.serialize(self)
    }
    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<(), Fault> {
        Ok(())
    }
    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<(), Fault> {
        value.serialize(self)
    }
    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        value: &T,
    ) -> Result<(), Fault> {
        let walk = self.enter()?;
        value.serialize(&mut *walk)?;
        walk.leave()
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<&'a mut Walk, Fault> {
        self.enter()
    }
    fn serialize_tuple(self, _: usize) -> Result<&'a mut Walk, Fault> {
        self.enter()
    }
    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<&'a mut Walk, Fault> {
        self.enter()
    }
    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<&'a mut Walk, Fault> {
        self.enter()
    }
    fn serialize_map(self, _: Option<usize>) -> Result<&'a mut Walk, Fault> {
        self.enter()
    }
    fn serialize_struct(self, _: &'static str, _: usize) -> Result<&'a mut Walk, Fault> {
        self.enter()
    }
    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<&'a mut Walk, Fault> {
        // The variant and its fields are two objects in JSON.
        self.enter()
    }
}

macro_rules! elements {
    ($($trait:ident::$method:ident),*) => { $(
        impl ser::$trait for &mut Walk {
            type Ok = ();
            type Error = Fault;
            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Fault> {
                value.serialize(&mut **self)
            }
            fn end(self) -> Result<(), Fault> {
                self.leave()
            }
        }
    )* };
}

macro_rules! fields {
    ($($trait:ident),*) => { $(
        impl ser::$trait for &mut Walk {
            type Ok = ();
            type Error = Fault;
            fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Fault> {
                self.field = key;
                value.serialize(&mut **self)
            }
            fn end(self) -> Result<(), Fault> {
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
    type Error = Fault;
    fn serialize_key<T: Serialize + ?Sized>(&mut self, _: &T) -> Result<(), Fault> {
        Ok(())
    }
    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Fault> {
        value.serialize(&mut **self)
    }
    fn end(self) -> Result<(), Fault> {
        self.leave()
    }
}
