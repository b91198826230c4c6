//! How the system's allocator treats large blocks: it keeps them.
//!
//! A reduction allocates and frees blocks of vectors, fronts and panels of many megabytes all the time. By default the GNU allocator
//! maps such a block when it is asked for and gives it back when it is freed, so that the kernel clears the same pages again and again:
//! a sixth of the time of a reduction of 91,000 dofs. Kept in one heap they are used again at once, and the peak of memory stays what it
//! was. Other allocators are left alone.

/// Keeps freed memory in one heap for the next block, large ones too. To be called before any other thread exists: a heap of a
/// thread cannot hold a large block, so that each thread would ask the kernel again.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)]
pub(crate) fn keep_large_blocks() {
    /// "Never" for a threshold.
    const NEVER: libc::c_int = -1;
    let settings = [(libc::M_MMAP_MAX, 0), (libc::M_TRIM_THRESHOLD, NEVER), (libc::M_ARENA_MAX, 1)];
    for (setting, value) in settings {
        // SAFETY: `mallopt` takes two integers and changes nothing but the allocator's settings. One that it does not know stays
        // what it was, which is slower and nothing else.
        unsafe { libc::mallopt(setting, value) };
    }
}

/// Nothing to be done.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(crate) fn keep_large_blocks() {}
