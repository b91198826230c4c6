//! What the system reports of this process.

use std::num::NonZeroUsize;

use std::io::Read;

use crate::error::{Error, Result};

/// Largest resident memory so far, in bytes, where the system tells.
pub(super) fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().next()?.parse().ok()?;
    kib.checked_mul(1024)
}

/// How many threads the machine runs at once.
pub(super) fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Has this process end when the other end of its stdin is closed, which happens when the parent is gone for whatever reason.
///
/// # Errors
/// [`Error::Rehearsal`] where the system has no thread for it.
pub(super) fn end_with_parent() -> Result<()> {
    let wait = || {
        let mut byte = [0];
        while std::io::stdin().lock().read(&mut byte).is_ok_and(|n_read| n_read > 0) {}
        crate::heap::exit_now();
    };
    std::thread::Builder::new().spawn(wait).map(drop).map_err(|source| Error::Rehearsal { source })
}

/// Threads for each that the machine runs at once, beyond which they only wait for each other: a job of 1.3 s takes 71 s with 512.
const MAX_PER_PROCESSOR: usize = 4;
/// Threads that any machine may be asked for.
const ALWAYS_ALLOWED: usize = 8;

/// How many working threads there will be where `asked` are asked for. The number changes no result.
pub(super) fn useful_threads(asked: usize) -> usize {
    asked.min((MAX_PER_PROCESSOR * available_threads()).max(ALWAYS_ALLOWED))
}

/// So many working threads.
///
/// # Errors
/// [`Error::Threads`] where the system has no more.
pub(super) fn threads(n_threads: usize) -> Result<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(n_threads)
        .build()
        .map_err(|source| Error::Threads { n_threads, source })
}
