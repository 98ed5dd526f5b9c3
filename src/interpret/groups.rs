//! The connected components of modules, while connections are made.

/// The connected components of modules: a disjoint-set forest (union and find).
#[derive(Default)]
pub struct Groups(Vec<usize>);

impl Groups {
    fn root(&mut self, module: usize) -> usize {
        self.0.extend(self.0.len()..=module);
        let mut at = module;
        while self.0[at] != at {
            self.0[at] = self.0[self.0[at]];
            at = self.0[at];
        }
        at
    }

    /// Returns true if two modules, given by index from 0, are in one component.
    pub fn together(&mut self, a: usize, b: usize) -> bool {
        self.root(a) == self.root(b)
    }

    /// Joins the components of two modules, given by index from 0.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[b] = a;
    }
}
