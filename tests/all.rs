//! The one test program: a folder for each subject.

mod behavior;
mod desk;
mod dynamics;
mod editor;
mod exchange;
#[path = "../fuzz/mod.rs"]
mod fuzz;
mod fuzzing;
mod hostile;
mod house;
mod judge;
mod language;
mod live;
mod planners;
mod plans;
mod robots;
mod simulate;
mod studies;
mod support;

use mimalloc::MiMalloc;
use modl::interrupt::memory::Counting;

/// The allocator of the tool, so that the tests take the time that it takes.
#[global_allocator]
static ALLOCATOR: Counting<MiMalloc> = Counting(MiMalloc);
