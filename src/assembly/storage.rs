//! What memory the modes of an assembly take.

use crate::error::{Error, Result};
use crate::memory_forecast::Resources;

/// Dense matrices of the order of all coordinates that are held at the same time. The bounds have up to twice the order, which makes four
/// of each, and a decomposition holds about fifteen.
const N_MATRICES: u64 = 60;

/// Refuses `n` coordinates of all components whose matrices would not fit into what is free.
///
/// # Errors
/// [`Error::MemoryAssembly`].
pub fn within_memory(n: usize, resources: Resources) -> Result<()> {
    let needed = N_MATRICES.saturating_mul((n as u64).saturating_pow(2)).saturating_mul(size_of::<f64>() as u64);
    match resources.memory_bytes {
        Some(available) if needed > available => Err(Error::MemoryAssembly { n, needed, available }),
        _ => Ok(()),
    }
}
