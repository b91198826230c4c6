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

    /// Asking changes nothing, and asking for what is not there is no fault.
    #[test]
    fn entries_stay_as_they_are() {
        let entries: Vec<f64> = (0..100).map(f64::from).collect();
        (0..1000).for_each(|at| prefetch(&entries, at));
        prefetch::<f64>(&[], 0);
        assert!(entries.iter().zip(0..100).all(|(entry, i)| *entry == f64::from(i)));
    }
}
