//! Asking the processor for memory before it is needed.

/// Starts to load the cache line of an entry into the second-level cache, where the processor has an instruction for that; nothing
/// where there is no such entry.
#[inline(always)]
#[cfg_attr(target_arch = "x86_64", allow(unsafe_code))]
pub(super) fn prefetch<T>(entries: &[T], at: usize) {
    if let Some(entry) = entries.get(at) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
            // SAFETY: the instruction is part of every x86-64 processor and changes no value, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T1>(std::ptr::from_ref(entry).cast()) };
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = entry;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A place outside is not a fault of the bounds and not one of the processor.
    #[test]
    fn asking_for_what_is_not_there_is_no_fault() {
        (0..1000).for_each(|at| prefetch(&[0.0; 100], at));
        prefetch::<f64>(&[], usize::MAX);
    }
}
