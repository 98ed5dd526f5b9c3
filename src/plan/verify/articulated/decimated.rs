//! Decimation: a selection at even distances from a sequence of unknown length.

/// A bounded selection from a sequence of any length: every item whose index is a multiple of a stride, which doubles
/// when one more would not fit.
pub(super) struct Decimated<T> {
    kept: Vec<T>,
    /// The greatest number of items kept.
    most: usize,
    /// The distance between selected items: one in this many is kept.
    stride: usize,
    seen: usize,
}

impl<T> Decimated<T> {
    /// Returns an empty selection of at most `most` items; `most` is even, or the distances would not be.
    pub(super) fn new(most: usize) -> Decimated<T> {
        Decimated { kept: vec![], most, stride: 1, seen: 0 }
    }

    /// Counts one more item; returns true if it belongs to the selection.
    pub(super) fn next_is_kept(&mut self) -> bool {
        let next_is_kept = self.seen.is_multiple_of(self.stride);
        self.seen += 1;
        if next_is_kept && self.kept.len() == self.most {
            let mut odd = false;
            self.kept.retain(|_| {
                odd = !odd;
                odd
            });
            self.stride *= 2;
        }
        next_is_kept
    }

    /// Keeps the item for which `next_is_kept` returned true.
    pub(super) fn keep(&mut self, item: T) {
        self.kept.push(item);
    }

    /// Returns the number of items seen for each one kept.
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// Returns the number of items seen.
    pub(super) fn seen(&self) -> usize {
        self.seen
    }

    /// Returns the items kept, in the order in which they came.
    pub(super) fn into_kept(self) -> Vec<T> {
        self.kept
    }
}
