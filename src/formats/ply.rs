//! Meshes from PLY files, in text and binary.

use super::content::Content;
use super::fault::FormatFault;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// The greatest number of characters of a message of the crate that is shown: it may quote the file.
const SHOWN: usize = 120;

/// Reads the vertices and faces of a PLY file, in text or binary, in the file's own unit of length.
///
/// # Errors
/// The first [`FormatFault`] of the bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Content, FormatFault> {
    let mut reader = Reader::new(bytes);
    let parser = Parser::<Row>::new();
    let header = parser.read_header(&mut reader).map_err(|error| said(&error))?;
    let mut read = Content::default();
    for element in header.elements.values() {
        // A row takes a byte at least, or a short file could ask for any number of them.
        let left = reader.get_ref().len();
        if element.count > left || element.properties.is_empty() && element.count > 0 {
            let (element, count) = (shown(&element.name), element.count);
            return Err(FormatFault::Announced { element, count });
        }
        let rows = parser.read_payload_for_element(&mut reader, element, &header);
        let rows = rows.map_err(|error| said(&error))?;
        match element.name.as_str() {
            "vertex" => {
                let place = |(index, row): (usize, &Row)| match row.place {
                    [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
                    _ => Err(FormatFault::NoCoordinates { vertex: index }),
                };
                read.vertices = rows.iter().enumerate().map(place).collect::<Result<_, FormatFault>>()?;
            }
            "face" => {
                let corners =
                    |(index, row): (usize, Row)| row.corners.ok_or(FormatFault::NoCornerList { face: index });
                read.faces = rows.into_iter().enumerate().map(corners).collect::<Result<_, FormatFault>>()?;
            }
            _ => {}
        }
    }
    Ok(read)
}

/// Returns the crate's message as a fault.
fn said(error: &ParseError) -> FormatFault {
    let whole = error.to_string();
    let words: Vec<&str> = whole.split_whitespace().collect();
    // The crate counts lines in the same way, but begins a sentence with them.
    let text = words.join(" ");
    let text = text.strip_prefix("Line ").map_or_else(|| text.clone(), |rest| format!("line {rest}"));
    FormatFault::Reader(shown(&text))
}

/// Returns a text short enough for a message.
fn shown(text: &str) -> String {
    text.chars().take(SHOWN).collect()
}

/// The values kept of a row: a vertex's position, a face's corners.
struct Row {
    place: [Option<f64>; 3],
    corners: Option<Vec<usize>>,
}

impl PropertyAccess for Row {
    fn new() -> Row {
        Row { place: [None; 3], corners: None }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        match name {
            "x" => self.place[0] = number(&property),
            "y" => self.place[1] = number(&property),
            "z" => self.place[2] = number(&property),
            "vertex_indices" | "vertex_index" => {
                let corners = property.to_u32_list();
                self.corners = corners.map(|list| list.into_iter().map(|corner| corner as usize).collect());
            }
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

/// Returns the number that a property holds; `None` for a list.
fn number(property: &Property) -> Option<f64> {
    match *property {
        Property::Float(x) => Some(x.into()),
        Property::Double(x) => Some(x),
        Property::Char(x) => Some(x.into()),
        Property::UChar(x) => Some(x.into()),
        Property::Short(x) => Some(x.into()),
        Property::UShort(x) => Some(x.into()),
        Property::Int(x) => Some(x.into()),
        Property::UInt(x) => Some(x.into()),
        _ => None,
    }
}
