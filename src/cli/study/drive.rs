//! The driver of a study: which rows are computed, and when they are written.

use super::claims::{ATTEMPTS_MAX, Attempts, Claim, Journal, claim};
use super::store::{Line, Store};
use super::table;
use super::workers::{CloseOnDrop, Queue, Subject, Task, Told};
use crate::cli::CallError;
use crate::cli::disk::system_words;
use crate::cli::terminal::{Terminal, cancel_state, cancelled};
use crate::interpret::{Host, WriteError};
use crate::source::Diagnostic;
use crate::study::{Coordinate, Design, Goal, Search};
use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// The number of blocks into which the rows of a study are cut, at least.
const BLOCKS: u64 = 64;
/// The greatest number of rows of a block.
const BLOCK_MAX: u64 = 4096;
/// The time for which threads have tasks in advance, s: rows that take long are left to other drivers.
const AHEAD: f64 = 0.05;
/// The greatest number of tasks that wait for threads.
const WAITING: usize = 1024;
/// The time after which computed rows are written, though their block is not complete.
const WRITE_INTERVAL: Duration = Duration::from_secs(10);
/// The time between two looks at whether the user cancels, and two reports of progress.
const TELL_INTERVAL: Duration = Duration::from_millis(100);

/// The numbers that say what a study computes.
pub(super) struct Plan {
    /// The axes with the sampler.
    pub design: Design,
    /// The number of rows.
    pub rows: u64,
    /// The direction of a search; `None` for other samplers.
    pub goal: Option<Goal>,
    /// The number of columns of axes and fields.
    pub columns: usize,
}

/// The outcome of a driver.
#[derive(Debug)]
pub(super) enum Driven {
    /// All rows that it could claim are there.
    Done,
    /// The user cancelled; what was computed is written.
    Cancelled,
    /// The study has no rows, for these reasons.
    Failed(Vec<Diagnostic>),
    /// Rows could not be written, in the words of the system.
    Unwritten(String),
}

/// A driver at work.
struct Driver<'d> {
    store: &'d Store,
    plan: &'d Plan,
    subject: Subject<'d>,
    attempts: Option<Attempts>,
    queue: &'d Queue,
    told: Receiver<Told>,
    terminal: &'d mut Terminal,
    /// The number of tasks that threads have.
    out: usize,
    /// The computed rows that are not written.
    lines: BTreeMap<u64, Line>,
    threads: usize,
    begun: Instant,
    written_at: Instant,
    told_at: Instant,
    computed: u64,
    failed: u64,
}

/// Ends a driver before its rows are computed.
type Ended<T> = Result<T, Driven>;

/// Computes the rows of a range that the folder lacks, on so many threads, and writes them. Rows that other drivers are at
/// are left to them.
///
/// # Errors
/// A message if the folder can't be written.
pub(super) fn drive(
    store: &Store,
    plan: &Plan,
    subject: Subject,
    rows: Range<u64>,
    threads: usize,
    terminal: &mut Terminal,
) -> Result<Driven, CallError> {
    let attempts = Some(Attempts::of(&store.folder)).filter(Attempts::any);
    let journal = Journal::begin(&store.folder, threads)?;
    let queue = Queue::default();
    let (sender, told) = channel();
    Ok(std::thread::scope(|scope| {
        let closes = CloseOnDrop(&queue);
        for thread in 0..threads {
            let (queue, journal, sender) = (&queue, &journal, sender.clone());
            let work = move || subject.work(queue, journal, thread, cancel_state(), &sender);
            if std::thread::Builder::new().name("study".into()).spawn_scoped(scope, work).is_err()
                && thread == 0
            {
                return Driven::Unwritten("the system gives no memory for a thread".to_owned());
            }
        }
        drop(sender);
        let now = Instant::now();
        let mut driver = Driver {
            store,
            plan,
            subject,
            attempts,
            queue: &queue,
            told,
            terminal,
            out: 0,
            lines: BTreeMap::new(),
            threads,
            begun: now,
            written_at: now,
            told_at: now,
            computed: 0,
            failed: 0,
        };
        let ended = match plan.goal {
            Some(goal) => driver.search(goal),
            None => driver.blocks(rows),
        };
        // Computed rows stay, however it ended.
        let kept = driver.write_all();
        if ended.is_err() || kept.is_err() {
            cancel_state().cancel();
        }
        drop(closes);
        match (ended, kept) {
            (Err(ended), _) | (Ok(()), Err(ended)) => ended,
            (Ok(()), Ok(())) => Driven::Done,
        }
    }))
}

impl Driver<'_> {
    /// Computes a range block by block.
    fn blocks(&mut self, rows: Range<u64>) -> Ended<()> {
        let size = self.plan.rows.div_ceil(BLOCKS).clamp(1, BLOCK_MAX);
        let mut missing: VecDeque<Range<u64>> = self.store.list(self.subject.files).missing(rows).into();
        // The blocks that are not complete, each with its lock and the rows that it lacks.
        let mut open: Vec<(Range<u64>, Claim, u64)> = Vec::new();
        let mut waiting: VecDeque<u64> = VecDeque::new();
        loop {
            let depth = self.depth();
            while self.out + waiting.len() < depth
                && let Some(next) = missing.pop_front()
            {
                let block = next.start / size;
                let end = next.end.min((block + 1) * size);
                if end < next.end {
                    missing.push_front(end..next.end);
                }
                let piece = next.start..end;
                let name = format!("{:010}-{:010}", block * size, (block + 1) * size);
                match self.claimed(&name)? {
                    Some(claim) => {
                        // Another driver may have computed it since.
                        let lacks = self.store.lacks(self.subject.files, &piece);
                        let count = lacks.iter().map(|range| range.end - range.start).sum();
                        waiting.extend(lacks.into_iter().flatten());
                        if count > 0 {
                            open.push((piece, claim, count));
                        }
                    }
                    None => continue,
                }
            }
            while self.out < depth
                && let Some(row) = waiting.pop_front()
            {
                let point = self.plan.design.point(row / self.plan.design.rows_of_point());
                self.send(row, point.unwrap_or_default());
            }
            if self.out == 0 && missing.is_empty() {
                return Ok(());
            }
            if let Some(row) = self.receive()?
                && let Some(at) = open.iter().position(|(block, ..)| block.contains(&row))
            {
                open[at].2 -= 1;
                if open[at].2 == 0 {
                    let (block, claim, _) = open.swap_remove(at);
                    self.write(block)?;
                    drop(claim);
                }
            }
            if self.written_at.elapsed() > WRITE_INTERVAL {
                self.write_all()?;
            }
        }
    }

    /// Computes a search, generation by generation.
    fn search(&mut self, goal: Goal) -> Ended<()> {
        let Some(_claim) = self.claimed("search")? else { return Ok(()) };
        let mut sought = stored(self.store, self.subject);
        let Some(mut search) = Search::new(&self.plan.design, goal) else { return Ok(()) };
        let count = self.plan.design.rows_of_point();
        let mut first = 0;
        loop {
            let points = search.ask();
            if points.is_empty() {
                return Ok(());
            }
            let rows = first * count..(first + points.len() as u64) * count;
            for row in rows.clone().filter(|row| !sought.contains_key(row)) {
                let point = points[usize::try_from(row / count - first).expect("it is one of them")].clone();
                self.send(row, point);
            }
            while self.out > 0 {
                if let Some(row) = self.receive()? {
                    sought.insert(row, self.lines.get(&row).and_then(|line| line.sought));
                }
            }
            self.write_all()?;
            search.tell(&means(&sought, rows, count));
            first += points.len() as u64;
        }
    }

    /// Returns the number of tasks that threads have in advance: as many as they do in a short while.
    fn depth(&self) -> usize {
        let rate = self.computed as f64 / self.begun.elapsed().as_secs_f64().max(AHEAD);
        ((rate * AHEAD) as usize).clamp(self.threads + 1, WAITING)
    }

    /// Locks something; `None` if another driver has it.
    fn claimed(&self, name: &str) -> Ended<Option<Claim>> {
        claim(&self.store.folder, name).map_err(|e| Driven::Unwritten(system_words(&e)))
    }

    fn send(&mut self, row: u64, point: Vec<Coordinate>) {
        let each = self.plan.design.each_of(row);
        let aside = self.attempts.as_ref().is_some_and(|attempts| attempts.count(row) >= ATTEMPTS_MAX);
        self.queue.push(Task { row, point, each, aside });
        self.out += 1;
    }

    /// Waits for a row, keeps it, and returns its number; `None` if none came for a while.
    fn receive(&mut self) -> Ended<Option<u64>> {
        let told = self.told.recv_timeout(TELL_INTERVAL);
        if self.told_at.elapsed() > TELL_INTERVAL {
            self.told_at = Instant::now();
            let (computed, failed, rows) = (self.computed, self.failed, self.plan.rows);
            self.terminal.progress(&format!("{computed} rows computed of {rows}, {failed} without values"));
        }
        match told {
            Ok(Told::Row(row, cells)) => {
                self.out -= 1;
                self.computed += 1;
                self.failed += u64::from(cells.outcome.is_err());
                self.lines.insert(row, table::line(row, &cells, self.plan.columns));
                Ok(Some(row))
            }
            Ok(Told::Failed(diagnostics)) => Err(Driven::Failed(diagnostics)),
            Ok(Told::Cancelled) => Err(Driven::Cancelled),
            Err(RecvTimeoutError::Timeout) if cancelled() => Err(Driven::Cancelled),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => {
                Err(Driven::Unwritten("the threads ended without an answer".to_owned()))
            }
        }
    }

    /// Writes the computed rows of a range.
    fn write(&mut self, rows: Range<u64>) -> Ended<()> {
        let mut later = self.lines.split_off(&rows.start);
        let mut rest = later.split_off(&rows.end);
        self.lines.append(&mut rest);
        let files = self.subject.files.read_so_far();
        let mut run: (u64, Vec<Line>) = (rows.start, Vec::new());
        for (row, line) in later {
            if row != run.0 + run.1.len() as u64 {
                self.write_run(&run, &files)?;
                run = (row, Vec::new());
            }
            run.1.push(line);
        }
        self.write_run(&run, &files)
    }

    fn write_run(&self, (start, lines): &(u64, Vec<Line>), files: &BTreeMap<String, String>) -> Ended<()> {
        if lines.is_empty() {
            return Ok(());
        }
        self.store.write(*start, lines, files.clone()).map_err(|e| {
            Driven::Unwritten(match e {
                WriteError::Outside => "it leads out of the output folder".to_owned(),
                WriteError::Failed(why) => why,
            })
        })
    }

    /// Writes all computed rows.
    fn write_all(&mut self) -> Ended<()> {
        self.written_at = Instant::now();
        self.write(0..u64::MAX)
    }
}

/// Returns what a search seeks in each row that the folder has.
pub(super) fn stored(store: &Store, subject: Subject) -> BTreeMap<u64, Option<f64>> {
    let mut sought = BTreeMap::new();
    for shard in store.list(subject.files).shards {
        let Ok((lines, _)) = store.read(&shard) else { continue };
        sought.extend(shard.rows.zip(lines.into_iter().map(|line| line.sought)));
    }
    sought
}

/// Returns the mean of what is sought over the rows of each point; `None` where a row lacks it.
pub(super) fn means(sought: &BTreeMap<u64, Option<f64>>, rows: Range<u64>, count: u64) -> Vec<Option<f64>> {
    let points = rows.start / count..rows.end / count;
    let mean = |point: u64| {
        let values = (point * count..(point + 1) * count).map(|row| sought.get(&row).copied().flatten());
        values.sum::<Option<f64>>().map(|sum| sum / count as f64)
    };
    points.map(mean).collect()
}
