//! A host and files that fail at each of their calls in turn: every run ends with a code, and what it wrote is whole.

use super::PARTS;
use crate::support::suite::MapFiles;
use modl::interpret::{Host, Mode, Options, Outcome, WriteError};
use modl::interrupt::CancelState;
use modl::source::{Files, ReadError};
use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// What happens at one call.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    NotFound,
    Outside,
    TooLarge,
    NoPermission,
    /// Only half of a file is there.
    Half,
    /// Another text is there than before.
    Changed,
    NoSpace,
    /// The user cancels.
    Cancel,
    /// From this call on, the clock goes backwards.
    ClockBack,
}

/// The kind of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Call {
    Read,
    Library,
    Print,
    Write,
    Elapsed,
}

impl Fault {
    /// The calls at which it can happen.
    fn happens_at(self) -> &'static [Call] {
        match self {
            Fault::None => &[],
            Fault::NotFound | Fault::Half | Fault::Changed => &[Call::Read, Call::Library],
            Fault::Outside | Fault::NoPermission => &[Call::Read, Call::Write],
            Fault::TooLarge => &[Call::Read],
            Fault::NoSpace => &[Call::Write],
            Fault::Cancel => &[Call::Print, Call::Write, Call::Elapsed],
            Fault::ClockBack => &[Call::Elapsed],
        }
    }
}

/// Counts calls, and says which one fails.
#[derive(Clone)]
struct Turn {
    calls: Rc<RefCell<Vec<Call>>>,
    fails: usize,
    fault: Fault,
}

impl Turn {
    /// Returns the fault of this call.
    fn next(&self, call: Call) -> Fault {
        let mut calls = self.calls.borrow_mut();
        calls.push(call);
        if calls.len() == self.fails { self.fault } else { Fault::None }
    }
}

struct RefusingFiles<'f> {
    files: &'f MapFiles,
    turn: Turn,
}

impl Files for RefusingFiles<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        let bytes = self.files.read(path);
        match self.turn.next(Call::Read) {
            Fault::NotFound => Err(ReadError::NotFound),
            Fault::Outside => Err(ReadError::Outside),
            Fault::TooLarge => Err(ReadError::TooLarge(1000)),
            Fault::NoPermission => Err(ReadError::Failed("permission denied".to_owned())),
            Fault::Half => bytes.map(|bytes| bytes[..bytes.len() / 2].to_vec()),
            Fault::Changed => Ok(b"\xff another file \0".to_vec()),
            _ => bytes,
        }
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        match self.turn.next(Call::Library) {
            Fault::NotFound => None,
            Fault::Half => self
                .files
                .library(path)
                .map(|text| Cow::Owned(text.lines().take(20).map(|l| format!("{l}\n")).collect())),
            Fault::Changed => Some(Cow::Borrowed("let changed = 1\n")),
            _ => self.files.library(path),
        }
    }
}

struct RefusingHost {
    turn: Turn,
    cancel_state: CancelState,
    printed: Vec<String>,
    written: BTreeMap<String, Vec<u8>>,
    clock: Cell<f64>,
    backwards: Cell<bool>,
}

impl RefusingHost {
    fn turn(&self, call: Call) -> Fault {
        let fault = self.turn.next(call);
        if fault == Fault::Cancel {
            self.cancel_state.cancel();
        }
        if fault == Fault::ClockBack {
            self.backwards.set(true);
        }
        fault
    }
}

impl Host for RefusingHost {
    fn print(&mut self, line: &str) {
        self.turn(Call::Print);
        self.printed.push(line.to_owned());
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        match self.turn(Call::Write) {
            Fault::Outside => Err(WriteError::Outside),
            Fault::NoSpace => Err(WriteError::Failed("no space left on device".to_owned())),
            Fault::NoPermission => Err(WriteError::Failed("permission denied".to_owned())),
            _ => {
                self.written.insert(path.to_owned(), bytes.to_vec());
                Ok(path.to_owned())
            }
        }
    }

    fn progress(&mut self, _: &str) {}

    fn cancel_state(&self) -> CancelState {
        self.cancel_state.clone()
    }

    fn elapsed(&self) -> f64 {
        self.turn(Call::Elapsed);
        let step = if self.backwards.get() { -1e6 } else { 1e-3 };
        self.clock.set(self.clock.get() + step);
        self.clock.get()
    }
}

/// What a run gave: its codes, printed lines, files, calls, and whether it was cancelled.
struct Ran {
    codes: Vec<&'static str>,
    printed: Vec<String>,
    written: BTreeMap<String, Vec<u8>>,
    calls: Vec<Call>,
    cancelled: bool,
}

fn run(files: &MapFiles, mode: Mode, fails: usize, fault: Fault) -> Ran {
    let calls = Rc::new(RefCell::new(Vec::new()));
    let turn = Turn { calls: calls.clone(), fails, fault };
    let refusing = RefusingFiles { files, turn: turn.clone() };
    let mut host = RefusingHost {
        turn,
        cancel_state: CancelState::default(),
        printed: Vec::new(),
        written: BTreeMap::new(),
        clock: Cell::new(0.0),
        backwards: Cell::new(false),
    };
    let checked = modl::check::check(&refusing, "main.mod");
    let mut outcome = Outcome::default();
    if !checked.has_errors() {
        outcome = modl::execute::run(&checked, mode, &refusing, &mut host, &Options::default());
    }
    let errors = checked.diagnostics.iter().chain(&outcome.diagnostics).filter(|d| d.is_error());
    Ran {
        codes: errors.map(|error| error.code.0).collect(),
        printed: host.printed,
        written: host.written,
        calls: calls.take(),
        cancelled: outcome.cancelled,
    }
}

const MAIN: &str = "use \"parts.mod\".{Pair}
use std.rofi.Ring
let p = plan(Pair().turn(), world: world(ground: off, gravity: off))
print(p.duration)
emit(p, \"turn.plan.json\")
print(faces(load_mesh(\"wedge.off\", scale: 80mm)))
print(tosnake(Ring(n: 6), timeout: 1000s).docks)
emit(reverse(load_plan(\"turn.plan.json\", Pair())), \"back.plan.json\")
show(p, \"turn.html\")
test \"it turns\" { expect p.duration > 0s }
";
const WEDGE: &str = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

/// The project, in which the plan that is loaded is the one that a run emits.
fn project() -> MapFiles {
    let file = |name: &str, text: &str| (name.to_owned(), text.as_bytes().to_vec());
    let mut files = MapFiles(BTreeMap::from([
        file("main.mod", MAIN),
        file("parts.mod", PARTS),
        file("wedge.off", WEDGE),
    ]));
    let alone: String =
        MAIN.lines().filter(|line| !line.contains("load_plan")).map(|l| format!("{l}\n")).collect();
    let mut first = MapFiles(files.0.clone());
    first.0.insert("main.mod".to_owned(), alone.into_bytes());
    let first = run(&first, Mode::Run, 0, Fault::None);
    let plan = first.written.get("turn.plan.json").expect("the first plan is emitted").clone();
    files.0.insert("turn.plan.json".to_owned(), plan);
    files
}

#[test]
fn every_call_of_host_and_files_may_fail() {
    const FAULTS: &[Fault] = &[
        Fault::NotFound,
        Fault::Outside,
        Fault::TooLarge,
        Fault::NoPermission,
        Fault::Half,
        Fault::Changed,
        Fault::NoSpace,
        Fault::Cancel,
        Fault::ClockBack,
    ];
    let files = project();
    for mode in [Mode::Run, Mode::Test, Mode::Check] {
        let sound = run(&files, mode, 0, Fault::None);
        assert_eq!(sound.codes, [""; 0], "{mode:?}");
        let mut told = BTreeMap::new();
        for fault in FAULTS {
            let happens = |(_, call): &(usize, &Call)| fault.happens_at().contains(call);
            for (index, call) in sound.calls.iter().enumerate().filter(happens) {
                let fails = index + 1;
                let ran = run(&files, mode, fails, *fault);
                let at = format!("{mode:?}, {fault:?} at call {fails}, {call:?}, of {}", sound.calls.len());
                // What is written is what a sound run writes, whole, or it is not there.
                for (path, bytes) in &ran.written {
                    assert_eq!(sound.written.get(path), Some(bytes), "{at}: {path}");
                }
                let same = ran.written == sound.written && ran.printed == sound.printed;
                assert!(same || !ran.codes.is_empty() || ran.cancelled, "{at}: something is missing, unsaid");
                assert!(*fault != Fault::ClockBack || same, "{at}: a clock changes what is computed");
                assert!(*fault == Fault::Cancel || !ran.cancelled, "{at}: nobody cancelled");
                *told.entry(format!("{fault:?}")).or_insert(0) +=
                    usize::from(!ran.codes.is_empty() || ran.cancelled);
            }
        }
        println!("{mode:?}: {} calls, faults told: {told:?}", sound.calls.len());
        assert!(told["NotFound"] > 4, "{told:?}");
        assert!(mode != Mode::Run || told["NoSpace"] == 3 && told["Cancel"] > 3, "{told:?}");
    }
}
