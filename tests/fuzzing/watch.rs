//! The watch over inputs: one that does not end ends the program, and tells which it was.

use crate::fuzz::inputs::corpus::root;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// How long an input may take.
#[derive(Clone, Copy, PartialEq)]
pub enum Patience {
    /// In the gate, beside other tests: so long that only a hang takes longer.
    Gate,
    /// In a run of its own: ten seconds of the processor.
    Run,
}

/// The seconds by the clock after which an input hangs: those of the gate, where other tests run beside it.
const CLOCK_MAX: f64 = 120.0;
/// The seconds of the processor that an input may take.
const COMPUTED_MAX: f64 = 10.0;
/// The time between two looks.
const LOOK: Duration = Duration::from_millis(250);

/// The input at hand: its target and its name.
type Input = Arc<Mutex<Option<(&'static str, String)>>>;

/// A thread that ends the program where an input takes too long. It ends with the watch.
pub struct Watch {
    input: Input,
    _ends: Sender<()>,
}

impl Watch {
    /// Begins a watch.
    pub fn new(patience: Patience) -> Watch {
        let input = Input::default();
        let watched = input.clone();
        let (ends, ended) = channel::<()>();
        std::thread::spawn(move || {
            let mut last = None;
            let (mut begun, mut computed) = (Instant::now(), processor_seconds());
            while ended.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                let now = watched.lock().expect("nobody panics with it").clone();
                if now != last || now.is_none() {
                    (last, begun, computed) = (now, Instant::now(), processor_seconds());
                    continue;
                }
                let clock = begun.elapsed().as_secs_f64();
                let used = processor_seconds().zip(computed).map_or(clock, |(now, then)| now - then);
                if clock > CLOCK_MAX || patience == Patience::Run && used > COMPUTED_MAX {
                    eprintln!(
                        "{now:?} takes more than {used:.1} s of the processor, {clock:.1} s by the clock"
                    );
                    std::process::abort();
                }
            }
        });
        Watch { input, _ends: ends }
    }

    /// Tells the watch which input begins.
    pub fn begins(&self, target: &'static str, name: &str) {
        *self.input.lock().expect("nobody panics with it") = Some((target, name.to_owned()));
    }
}

/// Returns the seconds that this process has computed for; `None` where the system does not count them so.
pub fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let ticks = stat.rsplit(')').next()?.split_whitespace().skip(11).take(2);
    let ticks: Option<f64> = ticks.map(|word| word.parse::<f64>().ok()).sum();
    // The hundredth of a second is what Linux tells in.
    ticks.map(|ticks| ticks / 100.0)
}

/// The file that names the input at hand, for whoever finds that the program has ended: no panic tells of a stack that is full.
pub struct AtHand(std::fs::File);

impl AtHand {
    /// Returns the path of the file.
    pub fn path() -> std::path::PathBuf {
        std::env::var_os("MODL_FUZZ_AT_HAND").map_or(root().join("target/fuzz_at_hand"), Into::into)
    }

    /// Opens the file.
    pub fn open() -> AtHand {
        AtHand(std::fs::File::create(Self::path()).expect("the file can be written"))
    }

    /// Names an input.
    pub fn names(&mut self, target: &str, seed: u64) {
        use std::io::{Seek, SeekFrom, Write};
        let line = format!("{target} {seed}\n{:20}\n", "");
        self.0
            .seek(SeekFrom::Start(0))
            .and_then(|_| self.0.write_all(line.as_bytes()))
            .expect("the file can be written");
    }
}
