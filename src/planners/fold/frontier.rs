//! The priority queue of Dijkstra's algorithm and of A* on the faces of a target.

/// A priority queue of faces by their costs: the cheapest comes first, of equal costs the face of least index.
///
/// It is a sorted list. The searches reach only some dozen faces ahead of those that are settled, and add mostly costs
/// that are among the greatest or the least of them, so that few entries give way; the first one is taken at no cost.
#[derive(Clone, Debug, Default)]
pub(super) struct Frontier {
    /// Bits of the cost, which for costs that are not negative have the same order, and after them the face; ascending
    /// from `first` on.
    entries: Vec<u128>,
    first: usize,
}

impl Frontier {
    /// Empties the queue, and adds a face (by its index) at a cost of 0.
    #[inline]
    pub(super) fn begin(&mut self, face: usize) {
        self.entries.clear();
        self.entries.push(face as u128);
        self.first = 0;
    }

    /// Adds a face by its index. `cost`: in the unit of the others, positive or +0.
    #[inline]
    pub(super) fn push(&mut self, cost: f64, face: usize) {
        let entry = u128::from(cost.to_bits()) << 64 | face as u128;
        if let Some(before) = self.first.checked_sub(1)
            && self.entries.get(self.first).is_none_or(|cheapest| entry < *cheapest)
        {
            self.entries[before] = entry;
            self.first = before;
            return;
        }
        self.entries.push(entry);
        let waiting = &mut self.entries[self.first..];
        let mut at = waiting.len() - 1;
        while at > 0 && waiting[at - 1] > entry {
            waiting[at] = waiting[at - 1];
            at -= 1;
        }
        waiting[at] = entry;
    }

    /// Removes the entry of least cost, and returns its cost and its face; `None` if the queue is empty.
    #[inline]
    pub(super) fn pop(&mut self) -> Option<(f64, usize)> {
        let entry = *self.entries.get(self.first)?;
        self.first += 1;
        Some((f64::from_bits((entry >> 64) as u64), entry as u64 as usize))
    }
}
