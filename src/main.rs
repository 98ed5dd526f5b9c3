//! The `modl` command.

use mimalloc::MiMalloc;
use modl::interrupt::memory::Counting;

/// A program is a tree of many small pieces: with this allocator it is read a fifth faster. Its memory is counted, for the
/// limit.
#[global_allocator]
static ALLOCATOR: Counting<MiMalloc> = Counting(MiMalloc);

fn main() -> std::process::ExitCode {
    modl::cli::main()
}
