//! The `modl` command.

use mimalloc::MiMalloc;
use modl::interrupt::memory::Counting;

/// A program is a tree of many small pieces: with this allocator it is read a fifth faster. What it hands out is counted,
/// for the limit of memory.
#[global_allocator]
static ALLOCATOR: Counting<MiMalloc> = Counting(MiMalloc);

fn main() -> std::process::ExitCode {
    modl::cli::main()
}
