//! The order of minimum degree (Tinney and Walker 1967), on the quotient graph (George and Liu 1989): rows of a sparse
//! symmetric matrix are eliminated so that its decomposition fills little.

/// Returns the rows of a symmetric matrix in the order of their elimination: each time a row that shares entries with the
/// fewest others, those that elimination has filled included; of equal ones that of least index. `neighbours` lists for
/// each row the others with which it shares an entry, as [`neighbours`](super::cuthill_mckee::neighbours) does. Panics if
/// an index is not less than the number of rows.
pub fn minimum_degree(neighbours: &[Vec<usize>]) -> Vec<usize> {
    minimum_degree_in_groups(neighbours, &[(0..neighbours.len()).collect()])
}

/// Returns the rows in the order of their elimination as [`minimum_degree`] does, but with the rows of each group after
/// those of the groups before it. Panics if a row is in more than one group.
pub fn minimum_degree_in_groups(neighbours: &[Vec<usize>], groups: &[Vec<usize>]) -> Vec<usize> {
    let count = neighbours.len();
    let mut graph = QuotientGraph {
        rows: neighbours.to_vec(),
        elements: vec![Vec::new(); count],
        members: vec![Vec::new(); count],
        marks: vec![usize::MAX; count],
        mark: 0,
    };
    let mut order = Vec::with_capacity(count);
    // The degree of each row of the present group; none of other rows.
    let mut degrees: Vec<Option<usize>> = vec![None; count];
    for group in groups {
        group.iter().for_each(|row| degrees[*row] = Some(graph.degree(*row)));
        let mut left = group.clone();
        while let Some(at) = (0..left.len()).min_by_key(|&at| (degrees[left[at]], left[at])) {
            let row = left.swap_remove(at);
            degrees[row] = None;
            order.push(row);
            for changed in graph.eliminate(row) {
                if degrees[changed].is_some() {
                    degrees[changed] = Some(graph.degree(changed));
                }
            }
        }
    }
    order
}

/// The graph of the rows that are left: eliminated rows stay as elements, cliques of rows that share entries.
struct QuotientGraph {
    /// The rows that share an entry of the matrix with each row, in no clique with it.
    rows: Vec<Vec<usize>>,
    /// The elements whose cliques each row belongs to.
    elements: Vec<Vec<usize>>,
    /// The rows of the clique of each element.
    members: Vec<Vec<usize>>,
    /// The last mark of each row.
    marks: Vec<usize>,
    mark: usize,
}

impl QuotientGraph {
    /// Makes a row an element, which takes over the elements that the row belongs to. Returns the rows of its clique.
    fn eliminate(&mut self, row: usize) -> Vec<usize> {
        let absorbed = std::mem::take(&mut self.elements[row]);
        let direct = std::mem::take(&mut self.rows[row]);
        let begun = self.next_mark(row);
        let mut clique = Vec::new();
        for other in absorbed.iter().flat_map(|element| &self.members[*element]).chain(&direct) {
            if self.marks[*other] != begun {
                self.marks[*other] = begun;
                clique.push(*other);
            }
        }
        for &other in &clique {
            let marks = &self.marks;
            self.rows[other].retain(|next| marks[*next] != begun);
            self.elements[other].retain(|element| !absorbed.contains(element));
            self.elements[other].push(row);
        }
        absorbed.iter().for_each(|element| self.members[*element] = Vec::new());
        self.members[row].clone_from(&clique);
        clique
    }

    /// Returns the number of other rows with which a row shares an entry.
    fn degree(&mut self, row: usize) -> usize {
        let begun = self.next_mark(row);
        let mut degree = self.rows[row].len();
        for element in &self.elements[row] {
            for other in &self.members[*element] {
                degree += usize::from(self.marks[*other] != begun);
                self.marks[*other] = begun;
            }
        }
        degree
    }

    /// Begins to mark anew, with a row that is marked already.
    fn next_mark(&mut self, row: usize) -> usize {
        self.mark += 1;
        self.marks[row] = self.mark;
        self.mark
    }
}
