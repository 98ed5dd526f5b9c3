//! The memory that the program has allocated, and the limit at which long work ends.
//!
//! An allocator that is wrapped in [`Counting`] counts what it hands out. A [`checkpoint`](super::checkpoint) ends the
//! work of its thread where more is allocated than [`limit`]. The count is exact but for [`BATCH`] bytes for each of
//! [`SHARDS`] groups of threads, and does not include stacks, code, and memory that the allocator keeps for later.
//! Without such an allocator nothing is counted, and no limit is reached.

use std::alloc::{GlobalAlloc, Layout};
use std::cell::Cell;
use std::sync::atomic::{AtomicIsize, AtomicUsize, Ordering};

/// The number of groups of threads that count apart, so that threads do not wait for each other.
pub const SHARDS: usize = 64;

/// The number of bytes that a group counts before it adds them to the sum.
pub const BATCH: isize = 64 << 10;

/// The bytes that a group of threads has allocated and not yet added to the sum. Each has a cache line of its own.
#[repr(align(128))]
struct Shard(AtomicIsize);

static COUNTED: [Shard; SHARDS] = [const { Shard(AtomicIsize::new(0)) }; SHARDS];
static IN_USE: AtomicIsize = AtomicIsize::new(0);
static PEAK: AtomicIsize = AtomicIsize::new(0);
static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);
static THREADS: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    /// The group of this thread, from 0; `SHARDS` before its first allocation. It needs no destructor, and so takes no
    /// memory to register one.
    static GROUP: Cell<usize> = const { Cell::new(SHARDS) };
}

/// Returns the bytes that are allocated now; 0 without a [`Counting`] allocator.
pub fn in_use() -> usize {
    usize::try_from(IN_USE.load(Ordering::Relaxed)).unwrap_or(0)
}

/// Returns the most bytes that were allocated at once since the start, or since [`reset_peak`].
pub fn peak() -> usize {
    usize::try_from(PEAK.load(Ordering::Relaxed)).unwrap_or(0)
}

/// Takes what is allocated now as the new peak.
pub fn reset_peak() {
    PEAK.store(IN_USE.load(Ordering::Relaxed), Ordering::Relaxed);
}

/// Returns the limit at which work ends, bytes; `usize::MAX` where none was set.
pub fn limit() -> usize {
    LIMIT.load(Ordering::Relaxed)
}

/// Sets the limit at which work ends, bytes, for the whole process.
pub fn set_limit(bytes: usize) {
    LIMIT.store(bytes, Ordering::Relaxed);
}

/// Returns true if more is allocated than the limit. It costs a nanosecond.
pub fn is_exceeded() -> bool {
    in_use() > limit()
}

/// An allocator that counts what another one, `A`, hands out.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counting<A>(pub A);

/// Counts bytes that were allocated, or freed if negative.
fn count(bytes: isize) {
    let group = GROUP.try_with(|group| {
        if group.get() == SHARDS {
            group.set(THREADS.fetch_add(1, Ordering::Relaxed) % SHARDS);
        }
        group.get()
    });
    let shard = &COUNTED[group.unwrap_or(0)].0;
    let counted = shard.fetch_add(bytes, Ordering::Relaxed) + bytes;
    if counted.abs() >= BATCH {
        let batch = shard.swap(0, Ordering::Relaxed);
        let sum = IN_USE.fetch_add(batch, Ordering::Relaxed) + batch;
        if batch > 0 {
            PEAK.fetch_max(sum, Ordering::Relaxed);
        }
    }
}

/// Returns a size as a signed number: no layout is larger than `isize::MAX`.
const fn signed(bytes: usize) -> isize {
    bytes.cast_signed()
}

// SAFETY: every call goes to `A` with the arguments that came, and its answer goes back; counting allocates nothing.
unsafe impl<A: GlobalAlloc> GlobalAlloc for Counting<A> {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(signed(layout.size()));
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { self.0.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-signed(layout.size()));
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { self.0.dealloc(pointer, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(signed(layout.size()));
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        unsafe { self.0.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(signed(size) - signed(layout.size()));
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { self.0.realloc(pointer, layout, size) }
    }
}
