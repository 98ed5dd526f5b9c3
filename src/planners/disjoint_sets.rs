//! Disjoint sets of numbers, which are joined one pair at a time: union and find (Tarjan 1975).

/// Sets of the numbers from 0 to a count; each number is in one of them.
#[derive(Clone, Debug)]
pub(in crate::planners) struct DisjointSets {
    /// A number of the same set for each; the least of a set stands for itself.
    above: Vec<usize>,
    /// The number of sets.
    count: usize,
}

impl DisjointSets {
    /// Returns a set for each number below `count`.
    pub(in crate::planners) fn new(count: usize) -> DisjointSets {
        DisjointSets { above: (0..count).collect(), count }
    }

    /// Returns the number of sets.
    pub(in crate::planners) fn count(&self) -> usize {
        self.count
    }

    /// Joins the sets of two numbers. Returns false if they were one.
    pub(in crate::planners) fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.least(a), self.least(b));
        if a == b {
            return false;
        }
        self.above[a.max(b)] = a.min(b);
        self.count -= 1;
        true
    }

    /// Returns the least number of the set of a number, and shortens the way to it.
    fn least(&mut self, mut number: usize) -> usize {
        while self.above[number] != number {
            self.above[number] = self.above[self.above[number]];
            number = self.above[number];
        }
        number
    }
}
