//! Messages of ROS 2 as bytes: CDR, the common data representation of the OMG, little endian, version 1.

/// A message under construction.
pub(super) struct Cdr {
    bytes: Vec<u8>,
}

/// The bytes before a message, which say how it is encoded; alignment counts from behind them.
const HEAD: [u8; 4] = [0, 1, 0, 0];

impl Cdr {
    /// Returns a message without fields.
    pub(super) fn new() -> Cdr {
        Cdr { bytes: HEAD.to_vec() }
    }

    /// Returns the bytes of the message.
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    fn align(&mut self, size: usize) {
        let used = self.bytes.len() - HEAD.len();
        self.bytes.resize(HEAD.len() + used.next_multiple_of(size), 0);
    }

    /// Adds a whole number of 8 bits.
    pub(super) fn byte(&mut self, x: u8) -> &mut Cdr {
        self.bytes.push(x);
        self
    }

    /// Adds a whole number of 32 bits.
    pub(super) fn word(&mut self, x: u32) -> &mut Cdr {
        self.align(4);
        self.bytes.extend(x.to_le_bytes());
        self
    }

    /// Adds a real number of 64 bits.
    pub(super) fn real(&mut self, x: f64) -> &mut Cdr {
        self.align(8);
        self.bytes.extend(x.to_le_bytes());
        self
    }

    /// Adds a text; zeros, which end texts, are left out.
    pub(super) fn text(&mut self, text: &str) -> &mut Cdr {
        let kept: Vec<u8> = text.bytes().filter(|byte| *byte != 0).collect();
        self.word(kept.len() as u32 + 1);
        self.bytes.extend(kept);
        self.bytes.push(0);
        self
    }

    /// Adds a sequence of real numbers.
    pub(super) fn reals(&mut self, all: &[f64]) -> &mut Cdr {
        self.word(all.len() as u32);
        all.iter().for_each(|x| {
            self.real(*x);
        });
        self
    }

    /// Adds a sequence of texts.
    pub(super) fn texts<'t>(&mut self, all: impl ExactSizeIterator<Item = &'t str>) -> &mut Cdr {
        self.word(all.len() as u32);
        all.for_each(|text| {
            self.text(text);
        });
        self
    }

    /// Adds a time or duration: seconds and nanoseconds of so many nanoseconds.
    pub(super) fn time(&mut self, nanoseconds: u64) -> &mut Cdr {
        self.word((nanoseconds / 1_000_000_000) as u32);
        self.word((nanoseconds % 1_000_000_000) as u32)
    }

    /// Adds a `std_msgs/Header`.
    pub(super) fn header(&mut self, nanoseconds: u64, frame: &str) -> &mut Cdr {
        self.time(nanoseconds).text(frame)
    }
}
