//! A thread with a large stack for the evaluator, and the way from there to the outside.
//!
//! Evaluation is recursive, and programs nest deeper than the stack of a thread that somebody else
//! made. The outside (files and host) stays on the thread of the caller, which serves requests.

use super::host::{Host, WriteError};
use crate::interrupt::{self, CancelState};
use crate::source::{Files, ReadError};
use std::cell::Cell;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};

/// Room for the evaluator's recursion; pages that are never touched cost nothing.
const STACK_BYTES: usize = 1 << 30;

/// Requests that wait to be served: who prints faster than a terminal takes it has to wait, too.
const WAITING_MAX: usize = 256;

enum Request {
    Print(String),
    Progress(String),
    Write(String, Vec<u8>, Sender<Result<String, WriteError>>),
    Read(String, Sender<Result<Vec<u8>, ReadError>>),
    Elapsed(Sender<f64>),
    /// The job at hand is done, and its result waits.
    Done,
    /// Nobody is to wait for the job at hand any longer.
    GivenUp,
}

/// The evaluator's end of the way to the outside.
#[derive(Clone)]
pub struct HostProxy {
    requests: SyncSender<Request>,
    /// Returns true once the user wants the run to end.
    pub cancel_state: CancelState,
}

impl HostProxy {
    /// Prints a line.
    pub fn print(&self, line: String) {
        self.send(Request::Print(line));
    }

    /// Returns a sink that sends progress reports to the host.
    pub fn progress_sink(&self) -> impl Fn(String) + 'static {
        let stage = self.clone();
        move |line| stage.send(Request::Progress(line))
    }

    /// Writes a file of the output folder and returns the path to show.
    pub fn write(&self, path: &str, bytes: Vec<u8>) -> Result<String, WriteError> {
        self.ask(|reply| Request::Write(path.into(), bytes, reply))
    }

    /// Reads a file of the project.
    pub fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.ask(|reply| Request::Read(path.into(), reply))
    }

    /// Returns true once the user wants the run to end.
    pub fn cancelled(&self) -> bool {
        self.cancel_state.is_cancelled()
    }

    /// Seconds since some instant; see [`Host::elapsed`].
    pub fn elapsed(&self) -> f64 {
        self.ask(Request::Elapsed)
    }

    /// Asked again and again by a search: whether it may go on, for so many seconds from now at most.
    pub fn until(&self, timeout: Option<f64>) -> impl Fn() -> bool {
        let begun = self.elapsed();
        move || !self.cancelled() && timeout.is_none_or(|most| self.elapsed() - begun <= most)
    }

    fn ask<T>(&self, request: impl FnOnce(Sender<T>) -> Request) -> T {
        let (sender, receiver) = channel();
        self.send(request(sender));
        receiver.recv().unwrap_or_else(|_| interrupt::unwind())
    }

    /// Sends a request to the outside; if that is gone, so is who wanted the work, and the work ends.
    fn send(&self, request: Request) {
        interrupt::checkpoint();
        if self.requests.send(request).is_err() {
            interrupt::unwind();
        }
    }
}

/// Runs `evaluate` on a thread of its own and serves its requests here until it ends.
pub fn run<T: Send>(
    files: &dyn Files,
    host: &mut dyn Host,
    evaluate: impl FnOnce(HostProxy) -> T + Send,
) -> T {
    let (sender, requests) = sync_channel(WAITING_MAX);
    let stage = HostProxy { requests: sender, cancel_state: host.cancel_state() };
    std::thread::scope(|scope| {
        let evaluator = std::thread::Builder::new()
            .name("evaluator".into())
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, move || evaluate(stage))
            .expect("the system can start a thread");
        requests.iter().for_each(|request| answer(request, files, host));
        evaluator.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// An evaluator that stays, with what it keeps from job to job.
pub struct EvaluatorThread<J, R> {
    jobs: Sender<J>,
    requests: Receiver<Request>,
    results: Receiver<R>,
    cancel_state: CancelState,
    /// Puts a request of the outside's own among those of the evaluator.
    waker: SyncSender<Request>,
    /// Returns true while a job is being done that nobody waits for any more.
    left: Cell<bool>,
}

impl<J: Send + 'static, R: Send + 'static> EvaluatorThread<J, R> {
    /// `begin` is called on the evaluator's thread; what it gives does the jobs, one by one.
    pub fn new<W: FnMut(J) -> R>(
        cancel_state: CancelState,
        begin: impl FnOnce(HostProxy) -> W + Send + 'static,
    ) -> EvaluatorThread<J, R> {
        let (jobs, to_do) = channel::<J>();
        let (requests, asked) = sync_channel(WAITING_MAX);
        let (done, results) = channel();
        let (waker, obeyed) = (requests.clone(), cancel_state.clone());
        std::thread::Builder::new()
            .name("evaluator".into())
            .stack_size(STACK_BYTES)
            .spawn(move || {
                let mut work = begin(HostProxy { requests: requests.clone(), cancel_state: obeyed });
                for job in to_do {
                    let result = work(job);
                    // Whoever does not wait for the result any more has dropped the other end.
                    if done.send(result).is_err() || requests.send(Request::Done).is_err() {
                        return;
                    }
                }
            })
            .expect("the system can start a thread");
        EvaluatorThread { jobs, requests: asked, results, cancel_state, waker, left: Cell::new(false) }
    }

    /// Has a job done, and serves its requests here until it is, or until nobody is to wait any longer:
    /// then it gives `None`, and the job ends by itself at its next checkpoint. The job before is settled.
    pub fn run(&self, job: J, files: &dyn Files, host: &mut dyn Host) -> Option<R> {
        assert!(!self.left.get(), "the job before was settled");
        let waker = self.waker.clone();
        // Where so many requests wait, who serves them is awake.
        self.cancel_state.on_abandon(move || drop(waker.try_send(Request::GivenUp)));
        self.jobs.send(job).expect("the evaluator waits for jobs");
        for request in &self.requests {
            match request {
                Request::Done => break,
                // Nobody wants to read on.
                Request::Print(_) | Request::Progress(_) if self.cancel_state.is_cancelled() => {}
                request => answer(request, files, host),
            }
            if self.cancel_state.is_abandoned() {
                self.left.set(true);
                return None;
            }
        }
        Some(self.results.recv().expect("a job that is done has a result"))
    }

    /// Returns true while a job is being done that nobody waits for any more.
    pub fn is_left(&self) -> bool {
        self.left.get()
    }

    /// Waits for a job that was left, and gives what came of it after all; `None` where nobody is to wait
    /// any longer. It stays cancelled.
    pub fn settle(&self) -> Option<R> {
        self.cancel_state.resume_waiting();
        for request in &self.requests {
            match request {
                Request::Done => {
                    self.left.set(false);
                    return Some(self.results.recv().expect("a job that is done has a result"));
                }
                _ if self.cancel_state.is_abandoned() => return None,
                // Who asks for anything is not answered, and ends.
                _ => {}
            }
        }
        None
    }
}

/// An answer that nobody waits for any more is dropped.
fn answer(request: Request, files: &dyn Files, host: &mut dyn Host) {
    match request {
        Request::Done | Request::GivenUp => {}
        Request::Print(line) => host.print(&line),
        Request::Progress(line) => host.progress(&line),
        Request::Write(path, bytes, reply) => drop(reply.send(host.write(&path, &bytes))),
        Request::Read(path, reply) => drop(reply.send(files.read(&path))),
        Request::Elapsed(reply) => drop(reply.send(host.elapsed())),
    }
}
