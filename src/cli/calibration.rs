//! How fast this machine is: each kind of work timed on a small model, and kept in the cache folder of the user.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use faer::Mat;
use serde::{Deserialize, Serialize};
use supel_runtime::StagedFile;

use super::pipeline::Calibration;
use super::signals;
use crate::cost_forecast::{Proofs, Rates, Sizes};
use crate::dense::gram;
use crate::error::{Error, Result};
use crate::factor::{Cholesky, SolveOperator, count_below};
use crate::input;
use crate::job::Job;
use crate::model::Model;
use crate::partition::Partition;
use crate::report::Observer;
use crate::sparse::product;

/// Nodes along each edge of the cube that is timed, with three dofs each.
const EDGE: usize = 20;
/// Repeats of what takes a moment.
const REPEATS: usize = 5;
/// Columns of a block.
const COLUMNS: usize = 8;
/// More than the weights of 26 neighbours, 6 of them one step away, 12 two and 8 three.
const OF_ALL_NEIGHBOURS: f64 = 6.0 / 3.7 + 12.0 / 4.7 + 8.0 / 5.7 + 0.001;
/// Columns of a dense product.
const TALL: usize = 64;

/// The job of the cube; nothing is ever written.
const JOB: &str = r#"
[model]
stiffness = "K.mtx"
mass = "M.mtx"
[[interface]]
name = "corner"
nodes = { rows = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11] }
[reduction]
method = "guyan"
[write]
superelement = "cube.supel"
"#;

/// What is kept of one machine with one number of threads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    version: String,
    processor: String,
    n_threads: usize,
    rates: Rates,
}

/// How fast this machine is with so many threads: as it was found earlier, or measured in a few seconds and kept.
///
/// # Errors
/// No room for a model of 24,000 dofs, in memory or in the folder of temporary files.
pub fn rates(n_threads: usize, calibration: Calibration, observer: &mut dyn Observer) -> Result<Rates> {
    let file = cache_folder().map(|folder| folder.join("supel").join("rates.json"));
    let mut all = file.as_deref().map(kept).unwrap_or_default();
    let is_this = |kept: &Kept| {
        (kept.version.as_str(), kept.processor.as_str(), kept.n_threads)
            == (env!("CARGO_PKG_VERSION"), processor().as_str(), n_threads)
    };
    if let Some(known) = all.iter().find(|kept| is_this(kept)).filter(|_| calibration == Calibration::Kept) {
        return Ok(known.rates);
    }
    observer.stage("calibration of this machine");
    let rates = measured()?;
    all.retain(|kept| !is_this(kept));
    let (version, processor) = (env!("CARGO_PKG_VERSION").to_owned(), processor());
    all.push(Kept { version, processor, n_threads, rates });
    // What cannot be kept is measured again next time.
    let _ = file.map(|file| keep(&file, &all));
    Ok(rates)
}

/// The folder in which programs of this user keep what they can make again.
fn cache_folder() -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    folder("XDG_CACHE_HOME").or_else(|| folder("LOCALAPPDATA")).or_else(|| Some(folder("HOME")?.join(".cache")))
}

/// What is kept, where it can be read and is sound; nothing elsewhere.
fn kept(file: &Path) -> Vec<Kept> {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let all: Vec<Kept> = serde_json::from_str(&text).unwrap_or_default();
    all.into_iter().filter(|kept| kept.rates.are_sound()).collect()
}

/// Keeps what was measured: whole or not at all.
fn keep(file: &Path, all: &[Kept]) -> Result<()> {
    let folder = file.parent().unwrap_or(Path::new(""));
    std::fs::create_dir_all(folder).map_err(|source| Error::Write { path: folder.to_owned(), source })?;
    let text = serde_json::to_string_pretty(all).unwrap_or_default();
    let written = || StagedFile::write(file, text.as_bytes()).and_then(StagedFile::commit);
    signals::deferred(written).map_err(Error::of_writing)
}

/// The name of the processor, where the system tells: folders of users move between machines.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

/// Seconds that `run` takes, and what it makes.
fn timed<T>(run: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let start = Instant::now();
    run().map(|made| (made, start.elapsed().as_secs_f64()))
}

/// Seconds of the median of some repeats: the fastest finds in fast memory what larger models do not have there.
fn median(mut run: impl FnMut() -> Result<()>) -> Result<f64> {
    let seconds = (0..REPEATS).map(|_| timed(&mut run).map(|((), seconds)| seconds));
    let mut all = seconds.collect::<Result<Vec<f64>>>()?;
    all.sort_by(f64::total_cmp);
    Ok(all[REPEATS / 2])
}

/// Every rate, on a cube of springs.
fn measured() -> Result<Rates> {
    let no_folder = |source| Error::Write { path: std::env::temp_dir(), source };
    let folder = tempfile::tempdir().map_err(no_folder)?;
    let (job, text_bytes) = cube(folder.path())?;
    let (read, of_text) = timed(|| input::read(&job.model))?;
    let model = Model::new(read)?;
    let (partition, of_partition) = timed(|| Partition::new(model, &job.interfaces))?;
    let (analysis, of_analysis) = timed(|| partition.analysis())?;
    let sizes = Sizes { proofs: Proofs::None, ..Sizes::of_model(&job, &partition, &analysis, 0) };
    let name = |row: usize| row.to_string();
    let (factor, of_factor) = timed(|| Cholesky::new(&analysis, partition.pencil(), 0.0, &name))?;
    let (_, of_count) = timed(|| count_below(&analysis, partition.pencil(), 1.0))?;
    let n = partition.n_dofs();
    let mut block = Mat::from_fn(analysis.n(), COLUMNS, |i, j| ((i + j) % 7) as f64);
    let of_solve = median(|| {
        factor.solve_in_place(block.as_mut());
        Ok(())
    })?;
    let tall = Mat::from_fn(n, TALL, |i, j| ((i + 3 * j) % 5) as f64);
    let of_product = median(|| {
        drop(product(&partition.stiffness, tall.as_ref().get(.., ..COLUMNS)));
        Ok(())
    })?;
    let of_dense = median(|| {
        drop(gram(tall.as_ref(), tall.as_ref()));
        Ok(())
    })?;
    Ok(Rates {
        factor_flop: of_factor / analysis.flops,
        count_flop: of_count / analysis.flops,
        solve_byte: of_solve / sizes.solves(COLUMNS as f64).solve_bytes,
        product_byte: of_product / sizes.products(COLUMNS as f64).product_bytes,
        dense_flop: of_dense / sizes.dense(TALL as f64, TALL as f64).dense_flops,
        pattern_entry: (of_partition + of_analysis) / sizes.entries,
        text_byte: of_text / text_bytes,
    })
}

/// The job of a cube of nodes, each tied to its 26 neighbours, with all springs but those to the ground in its files; and their bytes.
fn cube(folder: &Path) -> Result<(Job, f64)> {
    // What couples the three directions of two nodes, in K and in M.
    const STIFFNESS: [[f64; 3]; 3] = [[2.1, 0.31, 0.17], [0.31, 1.9, 0.23], [0.17, 0.23, 2.3]];
    const MASS: [[f64; 3]; 3] = [[0.7, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, 0.0, 0.7]];
    let stiffness = matrix_text(|weight| STIFFNESS.map(|row| row.map(|entry| -weight * entry)));
    let mass = matrix_text(|weight| MASS.map(|row| row.map(|entry| weight * entry / 100.0)));
    let mut text_bytes = 0.0;
    for (name, text) in [("K.mtx", &stiffness), ("M.mtx", &mass)] {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|source| Error::Write { path, source })?;
        text_bytes += text.len() as f64;
    }
    let job = Job::parse(JOB, Path::new("the job of the calibration"))?.resolve(folder)?;
    Ok((job, text_bytes))
}

/// A symmetric matrix in Matrix Market: off the diagonal `block` of the weight of each pair, on it what makes it definite.
fn matrix_text(block: impl Fn(f64) -> [[f64; 3]; 3]) -> String {
    let n = EDGE.pow(3);
    let place = |node: usize| [node % EDGE, node / EDGE % EDGE, node / (EDGE * EDGE)];
    let weight = |a: usize, b: usize| {
        let (a, b) = (place(a), place(b));
        let apart = (0..3).map(|axis| a[axis].abs_diff(b[axis])).collect::<Vec<usize>>();
        let is_near = apart.iter().all(|steps| *steps <= 1);
        is_near.then(|| 1.0 / (2.7 + apart.iter().sum::<usize>() as f64))
    };
    let mut lines = String::new();
    let mut n_entries = 0;
    for a in 0..n {
        let from = a.saturating_sub(EDGE * EDGE + EDGE + 1);
        let below = (from..a).filter_map(|b| Some((b, weight(a, b)?)));
        // The weights of all 26 neighbours, there or not, and a spring to the ground.
        let own = std::iter::once((a, -OF_ALL_NEIGHBOURS));
        for (b, weight) in below.chain(own) {
            let block = block(weight);
            for (i, j) in (0..9).map(|at| (at / 3, at % 3)).filter(|(i, j)| a != b || j <= i) {
                let value = if a == b { block[i][j].abs() } else { block[i][j] };
                if value != 0.0 {
                    let _ = writeln!(lines, "{} {} {value:e}", 3 * a + i + 1, 3 * b + j + 1);
                    n_entries += 1;
                }
            }
        }
    }
    format!("%%MatrixMarket matrix coordinate real symmetric\n{} {} {n_entries}\n{lines}", 3 * n, 3 * n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_read_is_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("rates.json");
        assert!(kept(&file).is_empty());
        for broken in ["", "[{]", "[{\"version\": 1}]", "{}", "\u{0}"] {
            std::fs::write(&file, broken).expect("written");
            assert!(kept(&file).is_empty(), "{broken}");
        }
    }
}
