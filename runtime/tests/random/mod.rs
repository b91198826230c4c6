//! Numbers that look random and are the same in every run.

#![allow(dead_code, unreachable_pub)]

use supel_runtime::motion::{Motion, Vector3, Vector6};

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    /// Uniform in (−1, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// `n` numbers within ±`size`.
    pub fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| size * self.next()).collect()
    }

    /// Three numbers within ±`size`.
    pub fn vector_3(&mut self, size: f64) -> Vector3 {
        std::array::from_fn(|_| size * self.next())
    }

    /// Six numbers within ±`size`.
    pub fn vector_6(&mut self, size: f64) -> Vector6 {
        std::array::from_fn(|_| size * self.next())
    }

    /// A motion whose vector (u; θ) has entries within ±`size`.
    pub fn motion(&mut self, size: f64) -> Motion {
        Motion::exp(&self.vector_6(size))
    }
}
