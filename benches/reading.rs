//! How long reading a file takes, and how much memory. Prints one JSON document.
//!
//! ```text
//! cargo bench --bench reading -- FILE THREADS
//! ```
//! What is read of a matrix are compressed rows, both triangles stored; of a mesh (`.inp`) its nodes and groups.
//! `benches/peers/reading.py` calls it in turn with other programs.

use std::path::PathBuf;
use std::time::Instant;

use supel::input::{Allowance, SingleMatrix, nodes};

fn main() {
    // Cargo adds an argument of its own.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let [file, threads] = words.as_slice() else {
        eprintln!("usage: cargo bench --bench reading -- FILE THREADS");
        return;
    };
    let (file, threads) = (PathBuf::from(file), threads.parse().expect("threads"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let allowance = Allowance::of(None);
    let is_mesh = file.extension().is_some_and(|ending| ending == "inp");
    let start = Instant::now();
    let items = pool.install(|| {
        if is_mesh {
            return nodes(&file, &allowance).expect("a mesh").labels.len();
        }
        SingleMatrix { file, layout: None, dofs: None }.read(&allowance).expect("a matrix").input.matrix.nnz()
    });
    let seconds = start.elapsed().as_secs_f64();
    println!("{{\"seconds\": {seconds:.4}, \"items\": {items}, \"peak_bytes\": {}}}", peak_bytes());
}

/// The most memory that the process had, by the system.
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kib| kib.parse::<u64>().ok()).unwrap_or(0) * 1024
}
