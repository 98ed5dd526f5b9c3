//! Positions: a file and a range of bytes in it.

/// The identity of a text among [`Sources`](super::Sources): its index, from 0, in order of adding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(pub u32);

/// A half-open range of bytes `start..end` of one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// The file of which the span is a range, by its identity among [`Sources`](super::Sources).
    pub file: FileId,
    /// The offset of the first byte in the file, from 0.
    pub start: u32,
    /// The offset, from 0, after the last byte; that of an empty span is `start`.
    pub end: u32,
}

impl Span {
    /// Returns the span of the bytes `start..end` of a file. Panics on offsets of 4 GiB or more.
    pub fn new(file: FileId, start: usize, end: usize) -> Span {
        Span {
            file,
            start: u32::try_from(start).expect("texts are shorter than 4 GiB"),
            end: u32::try_from(end).expect("texts are shorter than 4 GiB"),
        }
    }

    /// Returns the smallest span that covers both `self` and `other`. Both must be in one file, which debug builds
    /// check.
    pub fn to(self, other: Span) -> Span {
        debug_assert_eq!(self.file, other.file);
        Span { file: self.file, start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// Returns the range of bytes in the file, half-open.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }

    /// Returns true if `other` is inside this span, or the same; false for another file.
    pub fn contains(self, other: Span) -> bool {
        self.file == other.file && self.start <= other.start && other.end <= self.end
    }
}
