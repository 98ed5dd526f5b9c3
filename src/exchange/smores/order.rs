//! The order of commands that wait for each other, as series and parallel parts.
//!
//! A part whose commands fall into groups that nothing orders is parallel; one with a command group that all others follow
//! is a series (Valdes, Tarjan, Lawler, The recognition of series parallel digraphs, 1982). An order that is neither becomes a
//! series of layers, in which some commands wait longer than they have to.

use std::collections::BTreeMap;

/// Parts that run one after another, or at once.
#[derive(Clone, Debug)]
pub(super) enum Graph<T> {
    One(T),
    Series(Vec<Graph<T>>),
    Parallel(Vec<Graph<T>>),
}

/// The most parts within parts; a deeper order becomes layers.
const DEPTH_MAX: usize = 40;

/// The order of some commands.
#[derive(Default)]
pub(super) struct Order {
    /// The commands that directly follow each one in the queue of its module.
    pub(super) queues: Vec<(usize, usize)>,
    /// The commands that carry a label, and those that wait for all of them.
    pub(super) labels: Vec<(Vec<usize>, Vec<usize>)>,
}

/// The commands of an order, arranged.
pub(super) struct Arranged {
    pub(super) graph: Graph<usize>,
    /// True if some of the order had to become layers.
    pub(super) layered: bool,
}

/// The commands before each one, as sets of bits.
struct Before {
    order: Order,
    sets: Vec<Vec<u64>>,
    layers: Vec<usize>,
    layered: bool,
}

/// Arranges commands by their order.
///
/// # Errors
/// A command that waits for itself, by way of others.
pub(super) fn arrange(count: usize, order: Order) -> Result<Arranged, usize> {
    let mut before = Before::of(count, order)?;
    let graph = before.part((0..count).collect(), 0);
    Ok(Arranged { graph, layered: before.layered })
}

impl Before {
    fn of(count: usize, order: Order) -> Result<Before, usize> {
        // Labels are nodes of their own behind the commands, so that there are few edges.
        let nodes = count + order.labels.len();
        let mut next: Vec<Vec<usize>> = vec![Vec::new(); nodes];
        let mut open = vec![0; nodes];
        let mut edge = |from: usize, to: usize| {
            next[from].push(to);
            open[to] += 1;
        };
        order.queues.iter().for_each(|(from, to)| edge(*from, *to));
        for (number, (carry, wait)) in order.labels.iter().enumerate() {
            carry.iter().for_each(|command| edge(*command, count + number));
            wait.iter().for_each(|command| edge(count + number, *command));
        }
        let mut sets = vec![vec![0u64; count.div_ceil(64)]; nodes];
        let mut layers = vec![0; nodes];
        let mut ready: Vec<usize> = (0..nodes).filter(|node| open[*node] == 0).collect();
        let mut done = 0;
        while let Some(node) = ready.pop() {
            done += 1;
            let mut own = std::mem::take(&mut sets[node]);
            let layer = layers[node] + usize::from(node < count);
            if node < count {
                own[node / 64] |= 1 << (node % 64);
            }
            for &to in &next[node] {
                sets[to].iter_mut().zip(&own).for_each(|(word, more)| *word |= more);
                layers[to] = layers[to].max(layer);
                open[to] -= 1;
                if open[to] == 0 {
                    ready.push(to);
                }
            }
            if node < count {
                own[node / 64] &= !(1 << (node % 64));
            }
            sets[node] = own;
        }
        if done < nodes {
            return Err(on_cycle(count, &next, &open));
        }
        sets.truncate(count);
        layers.truncate(count);
        Ok(Before { order, sets, layers, layered: false })
    }

    /// Arranges some commands, which are a part of the whole.
    fn part(&mut self, commands: Vec<usize>, depth: usize) -> Graph<usize> {
        if let [only] = commands[..] {
            return Graph::One(only);
        }
        let groups = self.groups(&commands);
        if groups.len() > 1 && depth < DEPTH_MAX {
            return Graph::Parallel(groups.into_iter().map(|group| self.part(group, depth + 1)).collect());
        }
        let stages = self.stages(&commands);
        if stages.len() > 1 && depth < DEPTH_MAX {
            return Graph::Series(stages.into_iter().map(|stage| self.part(stage, depth + 1)).collect());
        }
        self.layered = true;
        let mut layers: BTreeMap<usize, Vec<Graph<usize>>> = BTreeMap::new();
        for command in commands {
            layers.entry(self.layers[command]).or_default().push(Graph::One(command));
        }
        Graph::Series(layers.into_values().map(Graph::Parallel).collect())
    }

    /// Returns the groups of some commands that nothing orders, in the order of their first.
    fn groups(&self, commands: &[usize]) -> Vec<Vec<usize>> {
        let mut leader: BTreeMap<usize, usize> =
            commands.iter().map(|command| (*command, *command)).collect();
        fn find(leader: &mut BTreeMap<usize, usize>, mut at: usize) -> usize {
            while leader[&at] != at {
                let above = leader[&leader[&at]];
                leader.insert(at, above);
                at = above;
            }
            at
        }
        let mut join = |a: usize, b: usize| {
            let (a, b) = (find(&mut leader, a), find(&mut leader, b));
            leader.insert(a.max(b), a.min(b));
        };
        let inside: std::collections::BTreeSet<usize> = commands.iter().copied().collect();
        for &(from, to) in &self.order.queues {
            if inside.contains(&from) && inside.contains(&to) {
                join(from, to);
            }
        }
        for (carry, wait) in &self.order.labels {
            let carrying: Vec<usize> = carry.iter().copied().filter(|c| inside.contains(c)).collect();
            let waiting: Vec<usize> = wait.iter().copied().filter(|c| inside.contains(c)).collect();
            if let (Some(first), Some(_)) = (carrying.first(), waiting.first()) {
                carrying.iter().chain(&waiting).for_each(|other| join(*first, *other));
            }
        }
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &command in commands {
            groups.entry(find(&mut leader, command)).or_default().push(command);
        }
        groups.into_values().collect()
    }

    /// Returns the stages of some commands: each command of a stage comes before all of the next.
    fn stages(&self, commands: &[usize]) -> Vec<Vec<usize>> {
        let words = self.sets.first().map_or(0, Vec::len);
        let mut inside = vec![0u64; words];
        commands.iter().for_each(|command| inside[command / 64] |= 1 << (command % 64));
        let count = |set: &[u64]| -> usize {
            set.iter().zip(&inside).map(|(word, mask)| (word & mask).count_ones() as usize).sum()
        };
        let mut sorted: Vec<(usize, usize)> =
            commands.iter().map(|command| (count(&self.sets[*command]), *command)).collect();
        sorted.sort_unstable();
        // From the end: what comes before all that follow a cut has to be all that stands before it.
        let mut common = inside.clone();
        let mut cuts = Vec::new();
        for at in (1..sorted.len()).rev() {
            common.iter_mut().zip(&self.sets[sorted[at].1]).for_each(|(word, set)| *word &= set);
            if count(&common) == at {
                cuts.push(at);
            }
        }
        let ends = cuts.iter().rev().copied().chain([sorted.len()]);
        let mut from = 0;
        let mut stages = Vec::new();
        for to in ends {
            let mut stage: Vec<usize> = sorted[from..to].iter().map(|(_, command)| *command).collect();
            stage.sort_unstable();
            stages.push(stage);
            from = to;
        }
        stages
    }
}

/// Returns a command that waits for itself. `open`: how many nodes each one still waits for.
fn on_cycle(count: usize, next: &[Vec<usize>], open: &[usize]) -> usize {
    let mut back = vec![usize::MAX; next.len()];
    for (node, follow) in next.iter().enumerate().filter(|(node, _)| open[*node] > 0) {
        follow.iter().filter(|to| open[**to] > 0).for_each(|to| back[*to] = node);
    }
    // Each node that waits has one before it that waits, too: going back ends in the circle.
    let mut at = (0..next.len()).find(|node| open[*node] > 0).unwrap_or(0);
    for _ in 0..next.len() {
        at = back[at];
    }
    let circle = std::iter::successors(Some(at), |node| Some(back[*node])).take(next.len());
    circle.filter(|node| *node < count).min().unwrap_or(0)
}
