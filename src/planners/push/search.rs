//! The search itself: stage by stage holes are filled, lines of cells at once as many as can move beside each other.

use super::Bounds;
use super::boxes::{Boxes, Snapshot};
use super::grid::{DIRECTIONS, Direction, Grid, axis_of, opposite};
use super::routes::{Routes, UNREACHED};
use super::stage::Stage;
use crate::optimize::random::SplitMix64;
use std::cmp::Reverse;

/// The greatest number of stages that are taken back, and of stages at random, in one run.
const SETBACKS_MAX: usize = 60;

/// The greatest number of lines that are tried for a stage at random, and of those that are taken.
const RANDOM_LINES: (usize, usize) = (300, 3);

/// The number of stages for which the robot grows from its core once no other stage is found.
const CORE_STAGES: usize = 8;

/// The greatest number of ways that are tried for a surplus cell, and by how much they may be longer than the best.
const WAYS: (usize, usize) = (6, 2);

/// The duration of a stage in which cells move by one cell, and of half a turn, in units of time, for cells whose
/// speed limit is 1.
const LINE_TIME: f64 = 2.0;
const TURN_TIME: f64 = 1.0;

/// The order in which holes, or surplus cells, get their turn.
#[derive(Clone, Copy, Debug)]
enum Order {
    Random,
    NearestFirst,
    FarthestFirst,
}

/// The choices that differ from run to run.
#[derive(Clone, Copy, Debug)]
struct Style {
    holes: Order,
    surplus: Order,
    /// The part of the stages, in percent, in which surplus cells move before holes make the robot touch by edges.
    surplus_first: usize,
    /// The cost from which on a hole may come towards the cell that is on its way to it.
    meet_from: usize,
}

/// The steps in which a stage is filled with lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    /// Lines that join pieces which touch by edges only.
    Heal,
    /// Sites with two cells pass one on, or turn.
    Doubles,
    /// Holes are filled, and the robot hangs together over faces at the end.
    FirmHoles,
    /// Surplus cells move in beside others.
    Surplus,
    /// Holes are filled, and the robot may touch by edges at the end.
    LooseHoles,
}

/// The tasks that are left in a stage.
struct Tasks {
    /// The holes that no cell is on its way to.
    holes: Vec<usize>,
    /// The sites that can give a cell, and have not in this stage.
    supply: Vec<usize>,
    /// The number of pieces that hang together during the stage.
    pieces: usize,
}

/// The result of a run: the states between the stages.
pub(super) struct Found {
    /// The states, one more than there are stages.
    pub(super) states: Vec<Snapshot>,
    /// An estimate of the duration, in units of time.
    pub(super) time: f64,
}

/// A search for one overlay of a goal on a start.
pub(super) struct Search<'a> {
    grid: &'a Grid,
    boxes: Boxes,
    stage: Stage,
    routes: Routes,
    is_goal: Vec<bool>,
    goal: &'a [usize],
    /// True if two cells fit into one site.
    squeezes: bool,
    style: Style,
    random: &'a mut SplitMix64,
}

impl<'a> Search<'a> {
    /// Returns the search for a way from the sites `start` to the sites `goal` of a grid within `bounds`. `squeezes`:
    /// whether cells shrink to half their size.
    pub(super) fn new(
        grid: &'a Grid,
        start: &[usize],
        goal: &'a [usize],
        (squeezes, bounds): (bool, Bounds),
        random: &'a mut SplitMix64,
    ) -> Search<'a> {
        let mut stage = Stage::new(grid.len());
        stage.bind(grid.sites_within(bounds.fixed), grid.sites_within(bounds.obstacles));
        let mut is_goal = vec![false; grid.len()];
        goal.iter().for_each(|&site| is_goal[site] = true);
        let orders = [Order::Random, Order::NearestFirst, Order::FarthestFirst];
        let style = Style {
            holes: orders[random.below(3)],
            surplus: orders[random.below(3)],
            surplus_first: [0, 20, 50, 90][random.below(4)],
            meet_from: [3, 5, usize::MAX][random.below(3)],
        };
        Search {
            grid,
            boxes: Boxes::whole(grid.len(), start),
            stage,
            routes: Routes::new(grid.len()),
            is_goal,
            goal,
            squeezes,
            style,
            random,
        }
    }

    /// Returns the work of the search so far, in visits of sites.
    pub(super) fn work(&self) -> u64 {
        self.stage.work + self.routes.work
    }

    /// Runs the search until the goal is reached; `None` if it takes at least `time_limit` (in units of time) or
    /// `work_limit` visits of sites, or gets stuck.
    pub(super) fn run(&mut self, time_limit: f64, work_limit: u64) -> Option<Found> {
        let mut states: Vec<(Snapshot, f64)> = vec![];
        let mut time = 0.0;
        let (mut setbacks, mut firm, mut from_core) = (0, false, 0_usize);
        while time < time_limit && self.work() < work_limit && setbacks <= SETBACKS_MAX {
            crate::interrupt::checkpoint();
            self.stage.begin(&self.boxes);
            let now = self.boxes.snapshot(self.stage.filled());
            if self.is_done() {
                let states = states.into_iter().map(|(state, _)| state).chain([now]).collect();
                return Some(Found { states, time });
            }
            if self.fill_stage(firm, from_core > 0) > 1 {
                // Pieces touch by edges only and no line joins them: one stage back.
                let (last, before) = states.pop()?;
                self.stage.begin(&self.boxes);
                self.boxes.restore(&last, self.stage.filled());
                (time, firm, setbacks) = (before, true, setbacks + 1);
                continue;
            }
            from_core = from_core.saturating_sub(1);
            if self.stage.is_empty() {
                if from_core == 0 {
                    from_core = CORE_STAGES;
                    continue;
                }
                setbacks += 1;
                self.random_lines();
                if self.stage.is_empty() {
                    return None;
                }
            }
            states.push((now, time));
            time += if self.stage.lines.is_empty() { TURN_TIME } else { LINE_TIME };
            firm = false;
            if self.stage.lines.iter().any(|line| self.grid.is_marginal(line.to)) {
                return None;
            }
            self.make_stage();
        }
        None
    }

    fn is_done(&self) -> bool {
        self.goal.iter().all(|&site| self.boxes.is_single(site))
    }

    /// Moves the cells as the stage says.
    fn make_stage(&mut self) {
        for line in &self.stage.lines {
            self.boxes.advance(self.grid, line.from, line.to, line.direction);
        }
        for &(site, axis) in &self.stage.turns {
            self.boxes.turn(site, axis);
        }
    }

    /// Fills a stage with lines and turns; returns the number of pieces in it. With `firm`, the robot hangs together
    /// over faces at its end. With `from_core`, holes beside the largest piece of the robot that is part of the goal are
    /// filled from all that is not: so that piece grows even where surplus cells hold others together.
    fn fill_stage(&mut self, firm: bool, from_core: bool) -> usize {
        let mut tasks = self.tasks(from_core);
        let (surplus, loose) = (Pass::Surplus, Pass::LooseHoles);
        let surplus_first = self.random.below(100) < self.style.surplus_first;
        let last = match (firm, surplus_first) {
            (true, _) => [surplus, surplus],
            (false, true) => [surplus, loose],
            (false, false) => [loose, surplus],
        };
        for pass in [Pass::Heal, Pass::Doubles, Pass::FirmHoles].into_iter().chain(last) {
            match pass {
                Pass::Heal if tasks.pieces == 1 => {}
                Pass::Heal => self.fill_holes(&mut tasks, pass, firm),
                _ if tasks.pieces > 1 => break,
                Pass::Doubles | Pass::Surplus if !self.squeezes => {}
                Pass::Doubles | Pass::Surplus => self.move_supply(&mut tasks, pass),
                Pass::FirmHoles | Pass::LooseHoles => self.fill_holes(&mut tasks, pass, firm),
            }
        }
        tasks.pieces
    }

    /// Returns what is to do in a stage.
    fn tasks(&mut self, from_core: bool) -> Tasks {
        let pieces = self.stage.pieces(self.grid, &self.boxes);
        let is_hole = |site: &&usize| !self.boxes.is_filled(**site);
        let mut holes: Vec<usize> = self.goal.iter().filter(is_hole).copied().collect();
        let core = if from_core { self.core() } else { vec![] };
        if from_core {
            holes.retain(|&hole| {
                DIRECTIONS.into_iter().any(|d| core.binary_search(&self.grid.next(hole, d)).is_ok())
            });
        }
        let gives = |site: usize| match from_core {
            true => core.binary_search(&site).is_err(),
            false => !self.is_goal[site],
        };
        let is_supply =
            |site: &&usize| self.stage.is_still(**site) && (self.boxes.is_double(**site) || gives(**site));
        let supply = self.stage.filled().iter().filter(is_supply).copied().collect();
        Tasks { holes, supply, pieces }
    }

    /// Returns the largest set of filled sites of the goal that hang together over faces, in ascending order.
    fn core(&self) -> Vec<usize> {
        let mut seen = vec![false; self.grid.len()];
        let mut largest: Vec<usize> = vec![];
        for &site in self.stage.filled().iter().filter(|site| self.is_goal[**site]) {
            if seen[site] {
                continue;
            }
            let mut piece = vec![site];
            seen[site] = true;
            let mut at = 0;
            while at < piece.len() {
                for direction in DIRECTIONS {
                    let next = self.grid.next(piece[at], direction);
                    if self.is_goal[next] && self.boxes.is_filled(next) && !seen[next] {
                        seen[next] = true;
                        piece.push(next);
                    }
                }
                at += 1;
            }
            if piece.len() > largest.len() {
                largest = piece;
            }
        }
        largest.sort_unstable();
        largest
    }

    /// Moves lines of cells into holes, so that each hole comes nearer to a cell that is too many: it wanders as a rook
    /// does.
    fn fill_holes(&mut self, tasks: &mut Tasks, pass: Pass, firm: bool) {
        let firm = pass == Pass::FirmHoles || (pass == Pass::Heal && firm);
        self.routes.measure_from_supply((self.grid, &self.boxes), &self.stage, &tasks.supply);
        let order = self.ordered(&tasks.holes, self.style.holes, |search, hole| search.routes.distance(hole));
        let mut stale = false;
        for hole in order {
            if stale {
                self.routes.measure_from_supply((self.grid, &self.boxes), &self.stage, &tasks.supply);
                stale = false;
            }
            if self.routes.distance(hole) == UNREACHED || self.stage.is_claimed(hole) {
                continue;
            }
            let mut lines = self.lines_into(hole);
            lines.sort_unstable();
            for (_, _, from, direction) in lines {
                let limit = if pass == Pass::Heal { tasks.pieces - 1 } else { tasks.pieces };
                let line = (from, hole, direction);
                let Some(pieces) = self.stage.try_line((self.grid, &self.boxes), line, limit, firm) else {
                    continue;
                };
                tasks.pieces = pieces;
                let source = self.routes.source(from);
                tasks.supply.retain(|&site| site != source);
                tasks.holes.retain(|&other| other != hole);
                stale = true;
                break;
            }
            if pass == Pass::Heal && tasks.pieces == 1 {
                break;
            }
        }
    }

    /// Returns the lines that can fill a hole and bring it nearer to a supply, each as (distance left, a random number,
    /// site that gets empty, direction of its cells).
    fn lines_into(&mut self, hole: usize) -> Vec<(u16, u64, usize, Direction)> {
        let mut lines = vec![];
        let reach = self.routes.distance(hole);
        for direction in DIRECTIONS {
            let mut from = self.grid.next(hole, opposite(direction));
            while self.boxes.is_filled(from) && self.stage.is_still(from) {
                let left = self.routes.distance(from);
                let double = self.boxes.is_double(from);
                if left < reach && (!double || (left == 0 && self.boxes.is_split_along(from, direction))) {
                    lines.push((left, self.random.next_u64(), from, direction));
                }
                if double {
                    break;
                }
                from = self.grid.next(from, opposite(direction));
            }
        }
        lines
    }

    /// Moves cells that are too many towards holes: into the site of another cell, on from there, or into a hole.
    fn move_supply(&mut self, tasks: &mut Tasks, pass: Pass) {
        // Holes that a cell is on its way to, and that may come towards it.
        let mut promised: Vec<usize> = vec![];
        self.routes.measure_from_holes((self.grid, &self.boxes), &self.stage, &tasks.holes);
        let wanted = pass == Pass::Doubles;
        let supply: Vec<usize> =
            tasks.supply.iter().copied().filter(|&site| self.boxes.is_double(site) == wanted).collect();
        let near = |search: &Search, site: usize| {
            DIRECTIONS
                .into_iter()
                .map(|d| search.routes.distance(search.grid.next(site, d)))
                .min()
                .unwrap_or(0)
        };
        let order = self.ordered(&supply, self.style.surplus, near);
        let mut stale = false;
        for site in order {
            if stale {
                let free = |hole: &usize| !promised.contains(hole);
                let holes: Vec<usize> = tasks.holes.iter().copied().filter(free).collect();
                self.routes.measure_from_holes((self.grid, &self.boxes), &self.stage, &holes);
                stale = false;
            }
            if !self.stage.is_still(site) {
                continue;
            }
            let Some((cost, to)) = self.move_one(site, tasks) else { continue };
            let hole = self.routes.source(to);
            if cost >= self.style.meet_from && pass == Pass::Doubles {
                promised.push(hole);
            } else {
                tasks.holes.retain(|&other| other != hole);
                tasks.supply.retain(|&other| other != site);
            }
            stale = true;
        }
    }

    /// Moves a cell of a site on towards a hole, or turns the split of the site; returns the cost of the way and the
    /// site that it leads to first.
    fn move_one(&mut self, site: usize, tasks: &mut Tasks) -> Option<(usize, usize)> {
        let mut ways = self.ways_from(site);
        ways.sort_unstable();
        let least = ways.first()?.0;
        for (cost, _, to, direction) in ways.into_iter().take(WAYS.0) {
            if cost > least + WAYS.1 {
                break;
            }
            let state = (self.grid, &self.boxes);
            let turns = self.boxes.is_double(site) && !self.boxes.is_split_along(site, direction);
            let pieces = if turns {
                self.stage.try_turn(state, (site, axis_of(direction)), tasks.pieces)
            } else {
                self.stage.try_line(state, (site, to, direction), tasks.pieces, true)
            };
            if let Some(pieces) = pieces {
                tasks.pieces = pieces;
                return Some((cost, to));
            }
        }
        None
    }

    /// Returns the lines on which a cell of a site can come nearer to a hole, each as (cost, a random number, site that
    /// it leads to, direction); a line and a turn cost one, and behind each line that leads to no hole there is a turn.
    fn ways_from(&mut self, site: usize) -> Vec<(usize, u64, usize, Direction)> {
        let mut ways = vec![];
        for direction in DIRECTIONS {
            let turns = self.boxes.is_double(site) && !self.boxes.is_split_along(site, direction);
            let first = 1 + 2 * usize::from(turns);
            let mut to = self.grid.next(site, direction);
            loop {
                let left = self.routes.distance(to);
                let filled = self.boxes.is_filled(to);
                if filled && !self.stage.is_passable(&self.boxes, to) {
                    break;
                }
                let is_way = if filled { left != UNREACHED } else { left == 0 };
                if is_way && !self.stage.is_claimed(to) {
                    ways.push((first + 2 * usize::from(left), self.random.next_u64(), to, direction));
                }
                if !filled {
                    break;
                }
                to = self.grid.next(to, direction);
            }
        }
        ways
    }

    /// Returns sites in an order of these distances, at random where they are equal.
    fn ordered(
        &mut self,
        sites: &[usize],
        order: Order,
        distance: impl Fn(&Search, usize) -> u16,
    ) -> Vec<usize> {
        let mut keyed: Vec<(u16, Reverse<u16>, u64, usize)> = Vec::with_capacity(sites.len());
        for &site in sites {
            let near = distance(self, site);
            let (up, down) = match order {
                Order::Random => (0, 0),
                Order::NearestFirst => (near, 0),
                Order::FarthestFirst => (0, near),
            };
            keyed.push((up, Reverse(down), self.random.next_u64(), site));
        }
        keyed.sort_unstable();
        keyed.into_iter().map(|(.., site)| site).collect()
    }

    /// Fills the stage with a few lines at random into empty sites.
    fn random_lines(&mut self) {
        let mut made = 0;
        for _ in 0..RANDOM_LINES.0 {
            let filled = self.stage.filled();
            let beside = filled[self.random.below(filled.len())];
            let to = self.grid.next(beside, self.random.below(6) as Direction);
            let direction = self.random.below(6) as Direction;
            if self.boxes.is_filled(to) || self.grid.is_marginal(to) {
                continue;
            }
            let mut length = 0;
            let mut from = self.grid.next(to, opposite(direction));
            while self.stage.is_passable(&self.boxes, from) {
                length += 1;
                from = self.grid.next(from, opposite(direction));
            }
            if length == 0 {
                continue;
            }
            let back = self.grid.stride(direction) * (1 + self.random.below(length) as isize);
            let line = ((to as isize - back) as usize, to, direction);
            if self.stage.try_line((self.grid, &self.boxes), line, 1, true).is_some() {
                made += 1;
                if made == RANDOM_LINES.1 {
                    return;
                }
            }
        }
    }
}
