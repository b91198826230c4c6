//! Work by the way it is spent, and how long a machine takes for it.

use std::iter::Sum;
use std::ops::{Add, Mul};

use serde::{Deserialize, Serialize};

/// Work of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Work {
    /// Operations of Cholesky factorisations.
    pub factor_flops: f64,
    /// Operations of counting factorisations, with pivots of either sign.
    pub count_flops: f64,
    /// Bytes of factors that solves read.
    pub solve_bytes: f64,
    /// Bytes of sparse matrices that products read.
    pub product_bytes: f64,
    /// Operations on tall dense columns.
    pub dense_flops: f64,
    /// Entries whose pattern is ordered and analysed.
    pub pattern_entries: f64,
    /// Bytes of text that is read.
    pub text_bytes: f64,
}

/// Seconds for one of each kind of work, on one machine with some number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rates {
    /// Of a Cholesky factorisation.
    pub factor_flop: f64,
    /// Of a counting factorisation.
    pub count_flop: f64,
    /// Of a solve.
    pub solve_byte: f64,
    /// Of a sparse product.
    pub product_byte: f64,
    /// Of a dense product.
    pub dense_flop: f64,
    /// Of ordering and analysis.
    pub pattern_entry: f64,
    /// Of reading text.
    pub text_byte: f64,
}

/// Two cores of a server of 2023, by which decisions are made on every machine: 20 and 10 Gflop/s, 8 GB/s of factors, 10 GB/s of matrices,
/// 10 Gflop/s on columns, 8 million entries and 100 MB of text a second.
pub const NOMINAL: Rates = Rates {
    factor_flop: 5e-11,
    count_flop: 1e-10,
    solve_byte: 1.25e-10,
    product_byte: 1e-10,
    dense_flop: 1e-10,
    pattern_entry: 1.25e-7,
    text_byte: 1e-8,
};

impl Rates {
    /// Whether each is a time that something can take.
    pub fn are_sound(&self) -> bool {
        let Self { factor_flop, count_flop, solve_byte, product_byte, dense_flop, pattern_entry, text_byte } = *self;
        [factor_flop, count_flop, solve_byte, product_byte, dense_flop, pattern_entry, text_byte]
            .into_iter()
            .all(|seconds| seconds.is_finite() && seconds > 0.0)
    }
}

impl Work {
    /// Seconds by the rates of a machine.
    pub fn seconds(&self, rates: &Rates) -> f64 {
        self.factor_flops * rates.factor_flop
            + self.count_flops * rates.count_flop
            + self.solve_bytes * rates.solve_byte
            + self.product_bytes * rates.product_byte
            + self.dense_flops * rates.dense_flop
            + self.pattern_entries * rates.pattern_entry
            + self.text_bytes * rates.text_byte
    }

    /// Floating-point operations: a byte of a factor takes part in four right-hand sides of a block of eight, twice an operation of two, and a
    /// byte of a matrix, a twelfth of an entry, in sixteen operations of a block.
    pub fn flops(&self) -> f64 {
        const OF_A_FACTOR_BYTE: f64 = 2.0;
        const OF_A_MATRIX_BYTE: f64 = 16.0 / 12.0;
        self.factor_flops
            + self.count_flops
            + self.dense_flops
            + OF_A_FACTOR_BYTE * self.solve_bytes
            + OF_A_MATRIX_BYTE * self.product_bytes
    }

    /// Bytes that pass through memory.
    pub fn bytes(&self) -> f64 {
        self.solve_bytes + self.product_bytes + self.text_bytes
    }
}

impl Add for Work {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            factor_flops: self.factor_flops + other.factor_flops,
            count_flops: self.count_flops + other.count_flops,
            solve_bytes: self.solve_bytes + other.solve_bytes,
            product_bytes: self.product_bytes + other.product_bytes,
            dense_flops: self.dense_flops + other.dense_flops,
            pattern_entries: self.pattern_entries + other.pattern_entries,
            text_bytes: self.text_bytes + other.text_bytes,
        }
    }
}

impl Mul<f64> for Work {
    type Output = Self;

    fn mul(self, times: f64) -> Self {
        Self {
            factor_flops: times * self.factor_flops,
            count_flops: times * self.count_flops,
            solve_bytes: times * self.solve_bytes,
            product_bytes: times * self.product_bytes,
            dense_flops: times * self.dense_flops,
            pattern_entries: times * self.pattern_entries,
            text_bytes: times * self.text_bytes,
        }
    }
}

impl Sum for Work {
    fn sum<I: Iterator<Item = Self>>(works: I) -> Self {
        works.fold(Self::default(), Add::add)
    }
}
