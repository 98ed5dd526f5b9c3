//! A thread with a large stack for the evaluator, and its requests to the host.
//!
//! Evaluation is recursive, and programs nest deeper than the stack of a thread that another program made.
//! Files and host stay on the thread of the caller, which serves requests.

use super::host::{Host, WriteError};
use super::printed::PrintedValue;
use crate::interrupt::{self, CancelState, Ended};
use crate::source::{Files, ReadError};
use std::cell::Cell;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::Builder;

/// The greatest depth of evaluations within evaluations, where the system gives the whole stack.
const NESTING_MAX: usize = 80_000;

/// The size of the stack for one level of evaluation, in bytes: several times what was measured. Without
/// optimisation a level takes more.
const LEVEL_BYTES: usize = if cfg!(debug_assertions) { 24 << 10 } else { 6 << 10 };

/// The size of the part of the stack, bytes, that is left for work besides evaluation: elaborating, planning, judging,
/// and dropping values.
pub(super) const REST_BYTES: usize = 16 << 20;

/// The size of the stack that is asked for; pages that are never touched cost nothing.
const STACK_BYTES: usize = NESTING_MAX * LEVEL_BYTES + REST_BYTES;

/// The least size of the stack to work with. With so little memory programs may nest less deeply, and no result
/// differs but for the refusal to nest deeper.
const STACK_BYTES_MIN: usize = REST_BYTES + (4 << 20);

/// The greatest number of requests that wait to be served; an evaluator that prints faster than the terminal
/// takes it is blocked.
const WAITING_MAX: usize = 256;

/// A request of the evaluator to the caller's thread, or a report that it is done.
enum Request {
    /// Print a line.
    Print(String),
    /// Receive a value that the next lines show.
    PrintValue(PrintedValue),
    /// Show a progress report.
    Progress(String),
    /// Write a file of the output folder.
    Write(String, Vec<u8>, Sender<Result<String, WriteError>>),
    /// Read a file of the project.
    Read(String, Sender<Result<Vec<u8>, ReadError>>),
    /// Return the seconds since some instant.
    Elapsed(Sender<f64>),
    /// The job at hand is done, and its result waits.
    Done,
    /// The user abandons the job at hand: nobody is to wait for it.
    GivenUp,
}

/// The evaluator's access to the files and the host of a run, which answer on the caller's thread.
#[derive(Clone)]
pub struct HostProxy {
    requests: SyncSender<Request>,
    /// The cancellation state of the run, shared with the caller.
    pub cancel_state: CancelState,
    /// The greatest depth of evaluations within evaluations that the stack bears.
    pub nesting_max: usize,
}

impl HostProxy {
    /// Prints a line, given without its line end. Waits while the queue of requests is full; unwinds to
    /// [`interrupt::catch`] once the work is cancelled or nobody serves requests any more, as all requests do.
    pub fn print(&self, line: String) {
        self.send(Request::Print(line));
    }

    /// Sends the host a value that the lines printed next show. Waits and unwinds as [`print`](Self::print) does.
    pub fn print_value(&self, value: PrintedValue) {
        self.send(Request::PrintValue(value));
    }

    /// Returns a function that sends a line of progress to the host. A call waits while the queue of requests
    /// is full, and unwinds to [`interrupt::catch`] once the work is cancelled or nobody serves requests any
    /// more.
    pub fn progress_sink(&self) -> impl Fn(String) + 'static {
        let proxy = self.clone();
        move |line| proxy.send(Request::Progress(line))
    }

    /// Writes a file of the output folder, given by its path from that folder, and returns the path to show. `bytes`:
    /// the contents of the file.
    ///
    /// # Errors
    /// [`WriteError`] where the path leads out of the output folder, or the operating system refuses.
    pub fn write(&self, path: &str, bytes: Vec<u8>) -> Result<String, WriteError> {
        self.ask(|reply| Request::Write(path.into(), bytes, reply))
    }

    /// Returns the bytes of a file of the project, given by its path from the project's root.
    ///
    /// # Errors
    /// The [`ReadError`] for which the file can't be read.
    pub fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.ask(|reply| Request::Read(path.into(), reply))
    }

    /// Returns true once the user wants the run to end.
    pub fn cancelled(&self) -> bool {
        self.cancel_state.is_cancelled()
    }

    /// Returns the time since some fixed instant, s; see [`Host::elapsed`].
    pub fn elapsed(&self) -> f64 {
        self.ask(Request::Elapsed)
    }

    /// Returns a function that is true as long as a search may continue: until the user cancels, or `timeout`
    /// seconds from now have passed. `None`: no timeout.
    pub fn until(&self, timeout: Option<f64>) -> impl Fn() -> bool {
        let begun = self.elapsed();
        move || !self.cancelled() && timeout.is_none_or(|most| self.elapsed() - begun <= most)
    }

    fn ask<T>(&self, request: impl FnOnce(Sender<T>) -> Request) -> T {
        let (sender, receiver) = channel();
        self.send(request(sender));
        receiver.recv().unwrap_or_else(|_| interrupt::unwind(Ended::Cancelled))
    }

    /// Sends a request to the caller's thread; unwinds the evaluation if that has dropped the receiver, since
    /// then nobody wants the result.
    fn send(&self, request: Request) {
        interrupt::checkpoint();
        if self.requests.send(request).is_err() {
            interrupt::unwind(Ended::Cancelled);
        }
    }
}

/// Starts a thread with as large a stack as the system gives: `start` is called with the name and size of the
/// stack and the nesting that it bears, again and again with half the size.
///
/// # Errors
/// The system's words where not even the least stack can be had.
fn with_stack<T, E: ToString>(mut start: impl FnMut(Builder, usize) -> Result<T, E>) -> Result<T, String> {
    let mut bytes = STACK_BYTES;
    loop {
        let nesting_max = (bytes - REST_BYTES) / LEVEL_BYTES;
        match start(Builder::new().name("evaluator".into()).stack_size(bytes), nesting_max) {
            Err(_) if bytes > STACK_BYTES_MIN => bytes = (bytes / 2).max(STACK_BYTES_MIN),
            started => return started.map_err(|why| why.to_string()),
        }
    }
}

/// Runs `evaluate` on a thread of its own and serves its requests here until it ends. `files` and `host` are what its
/// requests are answered from. Panics of the evaluator are resumed here.
///
/// # Errors
/// The operating system's message if the thread can't be started.
pub fn run<T: Send>(
    files: &dyn Files,
    host: &mut dyn Host,
    evaluate: impl FnOnce(HostProxy) -> T + Send,
) -> Result<T, String> {
    let (sender, requests) = sync_channel(WAITING_MAX);
    let cancel_state = host.cancel_state();
    // A thread that does not start takes its closure along, so the work waits outside of it.
    let work = Mutex::new(Some((evaluate, sender)));
    std::thread::scope(|scope| {
        let evaluator = with_stack(|builder, nesting_max| {
            let (work, cancel_state) = (&work, cancel_state.clone());
            builder.spawn_scoped(scope, move || {
                let (evaluate, requests) = taken(work);
                evaluate(HostProxy { requests, cancel_state, nesting_max })
            })
        })?;
        requests.iter().for_each(|request| answer(request, files, host));
        Ok(evaluator.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

/// Takes the work that one thread does.
fn taken<W>(work: &Mutex<Option<W>>) -> W {
    let taken = work.lock().unwrap_or_else(PoisonError::into_inner).take();
    taken.expect("of the threads that were tried one started")
}

/// An evaluator thread that stays from job to job, with its memory.
pub struct EvaluatorThread<J, R> {
    jobs: Sender<J>,
    requests: Receiver<Request>,
    results: Receiver<R>,
    cancel_state: CancelState,
    /// A sender for requests of the caller's thread to itself.
    waker: SyncSender<Request>,
    /// True while a job runs that nobody waits for any more.
    abandoned: Cell<bool>,
}

impl<J: Send + 'static, R: Send + 'static> EvaluatorThread<J, R> {
    /// Starts the thread. `begin` is called on it; the function that `begin` returns does the jobs, one by
    /// one.
    ///
    /// # Errors
    /// The operating system's message if the thread can't be started.
    pub fn new<W: FnMut(J) -> R>(
        cancel_state: CancelState,
        begin: impl FnOnce(HostProxy) -> W + Send + 'static,
    ) -> Result<EvaluatorThread<J, R>, String> {
        let (jobs, to_do) = channel::<J>();
        let (requests, asked) = sync_channel(WAITING_MAX);
        let (done, results) = channel();
        let waker = requests.clone();
        let parts = Arc::new(Mutex::new(Some((begin, to_do, requests, done))));
        with_stack(|builder, nesting_max| {
            let (parts, cancel_state) = (parts.clone(), cancel_state.clone());
            builder.spawn(move || {
                let (begin, to_do, requests, done) = taken(&parts);
                let mut work = begin(HostProxy { requests: requests.clone(), cancel_state, nesting_max });
                for job in to_do {
                    let result = work(job);
                    // A caller that does not wait for the result any more has dropped the receiver.
                    if done.send(result).is_err() || requests.send(Request::Done).is_err() {
                        return;
                    }
                }
            })
        })?;
        Ok(EvaluatorThread {
            jobs,
            requests: asked,
            results,
            cancel_state,
            waker,
            abandoned: Cell::new(false),
        })
    }

    /// Runs a job and serves its requests here until it is done. Returns `None` if the user abandons it meanwhile;
    /// then the job ends by itself at its next checkpoint. `files` and `host` are what its requests are answered
    /// from. Panics if an abandoned job has not been waited for. The job must not panic on its thread: this one would
    /// wait for it for ever.
    pub fn run(&self, job: J, files: &dyn Files, host: &mut dyn Host) -> Option<R> {
        assert!(!self.abandoned.get(), "the job before was settled");
        let waker = self.waker.clone();
        // With a full queue the serving thread is awake.
        self.cancel_state.on_abandon(move || drop(waker.try_send(Request::GivenUp)));
        self.jobs.send(job).expect("the evaluator waits for jobs");
        for request in &self.requests {
            match request {
                Request::Done => break,
                // After cancelling, output is not shown any more.
                Request::Print(_) | Request::PrintValue(_) | Request::Progress(_)
                    if self.cancel_state.is_cancelled() => {}
                request => answer(request, files, host),
            }
            if self.cancel_state.is_abandoned() {
                self.abandoned.set(true);
                return None;
            }
        }
        Some(self.results.recv().expect("a job that is done has a result"))
    }

    /// Returns true while a job runs that nobody waits for any more.
    pub fn is_abandoned(&self) -> bool {
        self.abandoned.get()
    }

    /// Waits for an abandoned job and returns its result; `None` if the user abandons the wait, too. The job stays
    /// cancelled, and its requests are not answered. There must be such a job ([`is_abandoned`](Self::is_abandoned)):
    /// otherwise the wait does not end by itself.
    pub fn wait_for_abandoned(&self) -> Option<R> {
        self.cancel_state.resume_waiting();
        for request in &self.requests {
            match request {
                Request::Done => {
                    self.abandoned.set(false);
                    return Some(self.results.recv().expect("a job that is done has a result"));
                }
                _ if self.cancel_state.is_abandoned() => return None,
                // Requests are not answered, so the job ends at its next one.
                _ => {}
            }
        }
        None
    }
}

/// Serves a request. An answer that nobody waits for any more is dropped.
fn answer(request: Request, files: &dyn Files, host: &mut dyn Host) {
    match request {
        Request::Done | Request::GivenUp => {}
        Request::Print(line) => host.print(&line),
        Request::PrintValue(value) => host.print_value(value),
        Request::Progress(line) => host.progress(&line),
        Request::Write(path, bytes, reply) => drop(reply.send(host.write(&path, &bytes))),
        Request::Read(path, reply) => drop(reply.send(files.read(&path))),
        Request::Elapsed(reply) => drop(reply.send(host.elapsed())),
    }
}
