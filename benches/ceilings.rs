//! What this machine can do at best: products of dense matrices and reading memory. Prints one JSON document.
//!
//! ```text
//! cargo bench --bench ceilings -- 2        threads
//! ```
//! Medians of repeated measurements, so that a neighbour on the machine does not decide.

use std::time::Instant;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use rayon::prelude::*;

/// Order of the dense matrices: large enough for the best rate.
const ORDER: usize = 4096;
/// Numbers that are read: a gibibyte, beyond every cache.
const NUMBERS: usize = 1 << 27;
const REPEATS: usize = 7;

fn main() {
    // Cargo adds an argument of its own.
    let n_threads = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(2);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads");
    let (gflops, gb_per_s) = pool.install(|| (product_rate(n_threads), read_rate()));
    println!("{{\"threads\": {n_threads}, \"product_gflops\": {gflops:.1}, \"read_gb_per_s\": {gb_per_s:.1}}}");
}

/// Gigaflops of a product of dense matrices.
fn product_rate(n_threads: usize) -> f64 {
    let a = Mat::from_fn(ORDER, ORDER, |i, j| 1.0 / (1 + i + 2 * j) as f64);
    let mut c = Mat::zeros(ORDER, ORDER);
    let par = if n_threads > 1 { Par::rayon(n_threads) } else { Par::Seq };
    let seconds = median(|| matmul(c.as_mut(), Accum::Replace, a.as_ref(), a.as_ref(), 1.0, par));
    2.0 * (ORDER as f64).powi(3) / seconds / 1e9
}

/// Gigabytes of memory that all threads together read in a second.
fn read_rate() -> f64 {
    let numbers = vec![1.0f64; NUMBERS];
    let sum = |chunk: &[f64]| {
        let mut sums = [0.0; 16];
        chunk.chunks_exact(16).for_each(|group| sums.iter_mut().zip(group).for_each(|(sum, x)| *sum += x));
        sums.iter().sum::<f64>()
    };
    let seconds = median(|| {
        std::hint::black_box(numbers.par_chunks(1 << 20).map(sum).sum::<f64>());
    });
    (8 * NUMBERS) as f64 / seconds / 1e9
}

fn median(mut run: impl FnMut()) -> f64 {
    let mut seconds: Vec<f64> = (0..REPEATS)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    seconds[REPEATS / 2]
}
