//! How long reading a matrix takes, and how much memory. Prints one JSON document.
//!
//! ```text
//! cargo bench --bench reading -- FILE THREADS REPEATS
//! ```
//! The best of the repeats; what is read is a matrix in compressed rows, both triangles stored. `benches/peers/reading.py` calls it in turn
//! with other programs.

use std::path::PathBuf;
use std::time::Instant;

use supel::input::{Allowance, SingleMatrix};

fn main() {
    // Cargo adds an argument of its own.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let [file, threads, repeats] = words.as_slice() else {
        eprintln!("usage: cargo bench --bench reading -- FILE THREADS REPEATS");
        return;
    };
    let (threads, repeats) = (threads.parse().expect("threads"), repeats.parse::<usize>().expect("repeats"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let matrix = SingleMatrix { file: PathBuf::from(file), layout: None, dofs: None };
    let (mut best, mut entries) = (f64::INFINITY, 0);
    for _ in 0..repeats {
        let start = Instant::now();
        let read = pool.install(|| matrix.read(&Allowance::of(None))).expect("a matrix");
        best = best.min(start.elapsed().as_secs_f64());
        entries = read.input.matrix.nnz();
    }
    println!("{{\"seconds\": {best:.4}, \"entries\": {entries}, \"peak_bytes\": {}}}", peak_bytes());
}

/// The most memory that the process had, by the system.
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kib| kib.parse::<u64>().ok()).unwrap_or(0) * 1024
}
