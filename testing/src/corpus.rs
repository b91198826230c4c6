//! Real models, which are not part of the repository.

use std::path::{Path, PathBuf};

/// The folder of the pairs K, M, `SUPEL_CORPUS` or the one next to the repository; `None`, with a message, where it is absent.
pub fn corpus() -> Option<PathBuf> {
    let given = std::env::var_os("SUPEL_CORPUS").map(PathBuf::from);
    let folder = given.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/corpus"));
    let pairs = folder.join("pairs");
    if pairs.is_dir() {
        return Some(pairs);
    }
    println!("skipped: no corpus at {}", folder.display());
    None
}
