//! Work that is compiled for several sets of instructions, of which the widest that the processor has is taken. All do the
//! same arithmetic: a product and a sum are never rounded as one.

/// Work that [`run_widest`] compiles for each set of instructions.
pub(crate) trait WideWork {
    /// The result of the work.
    type Output;

    /// Does the work. Only what is inlined here (`#[inline(always)]`), as this itself has to be, is compiled for the
    /// instructions of the caller.
    fn run(self) -> Self::Output;
}

/// Does some work with the widest instructions that the processor has.
pub(crate) fn run_widest<W: WideWork>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx512f") {
        // SAFETY: the processor has the instructions that the function was compiled for.
        return unsafe { run_with_avx512(work) };
    }
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has the instructions that the function was compiled for.
        return unsafe { run_with_avx2(work) };
    }
    work.run()
}

/// Does some work with instructions that take eight numbers at a time.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn run_with_avx512<W: WideWork>(work: W) -> W::Output {
    work.run()
}

/// Does some work with instructions that take four numbers at a time.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_with_avx2<W: WideWork>(work: W) -> W::Output {
    work.run()
}
