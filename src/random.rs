//! Start vectors: the same for the same seed on every machine.

use faer::MatMut;

/// Seed of the first attempt; a repeated one takes another.
pub const SEED: u64 = 0x5eed_0001;

/// SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub(crate) struct SplitMix64(u64);

impl SplitMix64 {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in (−1, 1).
    fn symmetric(&mut self) -> f64 {
        (self.next() >> 11) as f64 * 2f64.powi(-52) - 1.0
    }

    /// Fills a block with uniform values, column by column.
    pub(crate) fn fill(&mut self, mut block: MatMut<'_, f64>) {
        for j in 0..block.ncols() {
            for i in 0..block.nrows() {
                block[(i, j)] = self.symmetric();
            }
        }
    }
}
