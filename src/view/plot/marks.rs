//! The marks that a plot consists of, in pixels from the upper left corner.

/// A colour as red, green and blue, 0 to 255, sRGB encoded.
pub(super) type Colour = [u8; 3];

/// An element of a drawn plot, in pixels. Later ones cover earlier ones.
#[derive(Clone, Debug)]
pub(super) enum Mark {
    /// A line through points, with round joints; dashed where `dash` says how many pixels are drawn and left out.
    Line { points: Vec<[f64; 2]>, width: f64, colour: Colour, dash: Option<[f64; 2]> },
    /// A filled polygon.
    Area { corners: Vec<[f64; 2]>, colour: Colour },
    /// A filled circle.
    Dot { at: [f64; 2], radius: f64, colour: Colour },
    /// A line of text, on its baseline.
    Text { at: [f64; 2], size: f64, colour: Colour, anchor: Anchor, upwards: bool, text: String },
}

/// The point of a text that is put at the text's position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A plot laid out: its elements, and its size in pixels.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    /// The width and height of the drawing, in pixels.
    pub size: [f64; 2],
    /// The marks, in the order in which they are drawn.
    pub marks: Vec<Mark>,
}
