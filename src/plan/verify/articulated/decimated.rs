//! Decimation: a selection at even distances from a sequence of unknown length.

/// A bounded selection from a sequence of unknown length: the items whose index is a multiple of a stride. The stride
/// is 1 at first, and doubles whenever one more item would not fit.
pub(super) struct Decimated<T> {
    kept: Vec<T>,
    /// The greatest number of items kept.
    most: usize,
    /// The distance between selected items: one in this many is kept.
    stride: usize,
    /// The number of items counted so far.
    seen: usize,
}

impl<T> Decimated<T> {
    /// Returns an empty selection of at most `most` items. `most` must be even: else the items kept are not evenly
    /// spaced after the stride doubles.
    pub(super) fn new(most: usize) -> Decimated<T> {
        Decimated { kept: vec![], most, stride: 1, seen: 0 }
    }

    /// Counts the next item of the sequence; returns true if it belongs to the selection, and must then be handed to
    /// [`keep`](Self::keep). Drops every second item kept if there is no room for it.
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

    /// Appends the item for which [`next_is_kept`](Self::next_is_kept) returned true last.
    pub(super) fn keep(&mut self, item: T) {
        self.kept.push(item);
    }

    /// Returns the present stride: the difference of index of neighbouring items kept.
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// Returns the number of items counted so far, kept or not.
    pub(super) fn seen(&self) -> usize {
        self.seen
    }

    /// Returns the items kept, in the order in which they came.
    pub(super) fn into_kept(self) -> Vec<T> {
        self.kept
    }
}
