//! How many right-hand sides an eigensolver hands to the factor at once.
//!
//! A wide block reads the factor seldom but needs more vectors: the fewer steps build the space for m modes, the more vectors it
//! takes. The width with the least predicted time is used.

use crate::dense;

/// Widths that the kernels of the factor are made for.
const WIDTHS: [usize; 3] = [4, 8, 16];
/// Bytes of a factor that a processor's cache still holds.
const CACHED: u64 = 64 << 20;
/// Time to read an entry of the factor from memory over the time to use it for one right-hand side, and the same where the cache
/// holds the factor: solves of 4, 8 and 16 right-hand sides take 23, 25 and 34 ms with a factor of 307 MB, 0.8, 1.1 and 1.9 ms with
/// one of 16 MB.
const READ: f64 = 15.0;
const READ_CACHED: f64 = 3.0;

/// The width of the blocks for `n_modes` modes of a model of `n` dofs whose factor has `bytes` bytes.
pub(super) fn block_width(n: usize, bytes: u64, n_modes: usize) -> usize {
    let entries = (bytes / 8).max(n as u64) as f64;
    let read = if bytes > CACHED { READ } else { READ_CACHED };
    let time = |width: usize| {
        let n_vectors = vectors(n_modes, width);
        // For each vector: its share of reading the factor, its use, and the products with the vectors before it, twice.
        n_vectors * (read / width as f64 + 1.0 + n_vectors * n as f64 / entries / dense::GAIN)
    };
    let best = WIDTHS.into_iter().min_by(|a, b| time(*a).total_cmp(&time(*b)));
    best.unwrap_or(1).min(n)
}

/// Vectors until `n_modes` modes have converged. Measured on a slender solid of 91,000 dofs for widths of 4, 8 and 16: 52, 80 and
/// 128 vectors for 10 modes, 92, 128, 192 for 20, 160, 216, 320 for 50, and 344, 400, 544 for 100.
fn vectors(n_modes: usize, width: usize) -> f64 {
    let m = n_modes as f64;
    2.4 * m + 2.0 * m.sqrt() * width as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The measurement that the formula stands for, within the fifth that it is off at most where many vectors are in question.
    #[test]
    fn the_forecast_of_vectors_is_that_of_the_measurement() {
        let measured = [(10, [52, 80, 128]), (20, [92, 128, 192]), (50, [160, 216, 320]), (100, [344, 400, 544])];
        for (n_modes, counts) in measured {
            for (width, count) in WIDTHS.into_iter().zip(counts) {
                let ratio = vectors(n_modes, width) / f64::from(count);
                assert!((0.8..1.2).contains(&ratio), "{n_modes} modes in blocks of {width}: {ratio}");
            }
        }
    }

    #[test]
    fn wide_where_the_factor_is_read_from_memory_and_many_modes_are_wanted() {
        assert_eq!(block_width(91_000, 300 << 20, 50), 8);
        assert_eq!(block_width(30_000, 47 << 20, 50), 4, "a factor in the cache");
        assert_eq!(block_width(300_000, 3 << 30, 2), 4, "few modes");
        assert_eq!(block_width(300_000, 5 << 30, 150), 16, "many modes and a dense factor");
        assert_eq!(block_width(3, 72, 2), 3);
    }
}
