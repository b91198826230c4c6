//! Random vectors and motions.

use supel_runtime::motion::{Motion, Vector3, Vector6};

use crate::random::SplitMix64;

impl SplitMix64 {
    /// Uniform in [−1, 1).
    pub fn either_sign(&mut self) -> f64 {
        2.0 * self.uniform() - 1.0
    }

    /// `n` numbers within ±`size`.
    pub fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| size * self.either_sign()).collect()
    }

    /// Three numbers within ±`size`.
    pub fn vector_3(&mut self, size: f64) -> Vector3 {
        std::array::from_fn(|_| size * self.either_sign())
    }

    /// Six numbers within ±`size`.
    pub fn vector_6(&mut self, size: f64) -> Vector6 {
        std::array::from_fn(|_| size * self.either_sign())
    }

    /// A motion whose vector (u; θ) has entries within ±`size`.
    pub fn motion(&mut self, size: f64) -> Motion {
        Motion::exp(&self.vector_6(size))
    }
}
