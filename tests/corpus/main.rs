//! Free modes of real models against reference eigenvalues. Skipped, with a message, where the corpus is absent.

mod aircraft;
mod false_alarms;
mod pairs;
mod reference;

use supel_testing::corpus::corpus;
use supel_testing::place;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::prelude::*;
use supel::eigen::{Factored, ModalProblem, ModeError, ModeRequest, Modes, Wanted, elastic_modes, shifted};
use supel::error::Result;
use supel::factor::{Analysis, count_below};
use supel::input::{Input, MatrixInput, read};
use supel::job::{Eigensolver, ModelJob};
use supel::model::Model;
use supel::partition::Partition;
use supel::random::SEED;
use supel::rigid::rigid_body_modes;
use supel::sparse::SparseMatrix;

use pairs::{Expected, PAIRS, Pair, Reason, Rows, Size, Source};
use reference::Reference;

/// A file, plain or gzipped.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    [name.to_owned(), format!("{name}.gz")].iter().map(|name| folder.join(name)).find(|path| path.is_file())
}

fn model_job(pairs: &Path, pair: &Pair) -> ModelJob {
    let folder = pairs.join(pair.folder);
    let matrix = |name: &str| find(&folder, name).unwrap_or_else(|| panic!("{}: no {name}", pair.name));
    let next_to_it = |names: &[&str]| {
        (pair.source == Source::Coordinates).then(|| names.iter().find_map(|name| find(&folder, name))).flatten()
    };
    ModelJob {
        stiffness: matrix(pair.files[0]),
        mass: Some(matrix(pair.files[1])),
        dofs: next_to_it(&["model.dof", "dof.csv"]),
        nodes: next_to_it(&["nodes.csv"]),
        ..ModelJob::default()
    }
}

/// Leaves out the rows that a file lists, counted from zero.
fn without_rows(input: Input, list: &Path) -> Input {
    let text = std::fs::read_to_string(list).expect("a list of rows");
    let removed: BTreeSet<usize> = text.split_whitespace().map(|row| row.parse().expect("a row")).collect();
    let kept: Vec<usize> = (0..input.stiffness.matrix.rows()).filter(|row| !removed.contains(row)).collect();
    let restrict = |input: MatrixInput| MatrixInput { matrix: principal_submatrix(&input.matrix, &kept), ..input };
    Input {
        stiffness: restrict(input.stiffness),
        mass: restrict(input.mass),
        dofs: input.dofs.map(|dofs| kept.iter().map(|row| dofs[*row]).collect()),
        ..input
    }
}

fn principal_submatrix(matrix: &SparseMatrix, kept: &[usize]) -> SparseMatrix {
    let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in kept {
        for (col, value) in matrix.outer_view(*row).expect("a row").iter() {
            if let Ok(at) = kept.binary_search(&col) {
                columns.push(at as u32);
                values.push(*value);
            }
        }
        pointers.push(columns.len());
    }
    SparseMatrix::new((kept.len(), kept.len()), pointers, columns, values)
}

/// What the stages find for a pair.
struct Found {
    n_dofs: usize,
    n_rigid: usize,
    modes: Modes,
    /// Eigenvalues below a shift above the highest mode, and modes found below it.
    counted: [usize; 2],
    /// Whether Sturm counts enclose every eigenvalue; true where the reference needs no second judge.
    is_enclosed: bool,
    unit: f64,
}

fn free_modes(pairs: &Path, pair: &Pair, n_modes: usize) -> Result<Found> {
    let mut input = read(&model_job(pairs, pair))?;
    if pair.rows == Rows::Unconstrained {
        input = without_rows(input, &pairs.join(pair.folder).join("constrained_rows.txt"));
    }
    let model = Model::new(input)?;
    let partition = Partition::new(model, &[])?;
    let (rigid, _) = rigid_body_modes(&partition)?;
    let analysis = partition.analysis()?;
    let problem = ModalProblem::of(partition.pencil(), partition.precision).deflating(rigid.deflated());
    let found = shifted(&analysis, problem, &|dof| partition.name_of(dof))?;
    let request = ModeRequest { wanted: Wanted::Count(n_modes), eigensolver: Eigensolver::Lanczos, seed: SEED };
    let modes = elastic_modes(problem, &Factored::new(&found.factor, found.sigma), request)?;
    let count = count_below(&analysis, partition.pencil(), modes.shift_above(0.5))?;
    let counted = [count.free, rigid.count() + modes.count()];
    let is_enclosed = pair.reference_error == 0.0 || enclosed(&partition, &analysis, rigid.count(), &modes)?;
    let (n_dofs, n_rigid, unit) = (partition.n_dofs(), rigid.count(), partition.scaling.eigenvalue_unit());
    Ok(Found { n_dofs, n_rigid, modes, counted, is_enclosed, unit })
}

/// The comparison that is nearest to its limit, or beyond it.
#[derive(Clone, Copy)]
struct Difference {
    relative: f64,
    allowed: f64,
}

/// Compares mode by mode: the difference may reach the error bar of the data, the reference's own error and ten times
/// the rounding of the cancelling terms, whichever is largest.
fn compare(found: &Found, reference: &Reference, known_error: f64) -> Difference {
    let mut worst = Difference { relative: 0.0, allowed: f64::INFINITY };
    for ((lambda, error), expected) in found.modes.lambda.iter().zip(&found.modes.errors).zip(&reference.elastic) {
        let relative = (lambda * found.unit / expected - 1.0).abs();
        let own = reference.own_error(*expected).max(known_error);
        let allowed = bar(error).max(own);
        if relative / allowed >= worst.relative / worst.allowed {
            worst = Difference { relative, allowed };
        }
    }
    worst
}

/// The error bar of the data or ten times the rounding of the cancelling terms.
fn bar(error: &ModeError) -> f64 {
    error.relative_bar.max(10.0 * f64::EPSILON * error.cancellation)
}

/// Whether each eigenvalue is the one of its number: counts a bar below and above it differ accordingly. Bars of
/// neighbours that overlap make one cluster.
fn enclosed(partition: &Partition, analysis: &Analysis, n_rigid: usize, modes: &Modes) -> Result<bool> {
    let ends = |j: usize, side: f64| modes.lambda[j] * (1.0 + side * bar(&modes.errors[j]));
    for j in 0..modes.count() {
        let below = count_below(analysis, partition.pencil(), ends(j, -1.0))?.free;
        let above = count_below(analysis, partition.pencil(), ends(j, 1.0))?.free;
        if below > n_rigid + j || above <= n_rigid + j {
            return Ok(false);
        }
    }
    Ok(true)
}

/// A line of the printed table, and what is wrong with the pair.
fn examine(pairs: &Path, pair: &Pair) -> (String, Option<String>) {
    let start = Instant::now();
    let reference = pairs.join(pair.folder).join(pair.reference);
    let (line, fault) = match pair.expected {
        Expected::Refused(reason) => match free_modes(pairs, pair, 1) {
            Ok(found) => {
                (format!("{} | {} | | | | accepted", found.n_dofs, found.n_rigid), Some("is not refused".to_owned()))
            }
            Err(error) => {
                let fault = (Reason::of(&error) != Some(reason)).then(|| format!("expected {reason:?}: {error}"));
                (format!(" | | | | | refused: {error}"), fault)
            }
        },
        Expected::Agrees => {
            let reference = Reference::read(&reference);
            let n_modes = reference.elastic.len().min(pair.at_most);
            match free_modes(pairs, pair, n_modes) {
                Ok(found) => agreement(&found, &reference, (n_modes, pair.reference_error)),
                Err(error) => (format!(" | /{} | | | | refused: {error}", reference.n_zero), Some(error.to_string())),
            }
        }
    };
    let line = format!("| {} | {line} | {:.1} s |", pair.name, start.elapsed().as_secs_f64());
    println!("{line}");
    (line, fault.map(|fault| format!("{}: {fault}", pair.name)))
}

fn agreement(found: &Found, reference: &Reference, (n_modes, known_error): (usize, f64)) -> (String, Option<String>) {
    let worst = compare(found, reference, known_error);
    let n_compared = found.modes.count().min(reference.elastic.len());
    let [counted, below] = found.counted;
    let fault = if found.n_rigid != reference.n_zero {
        Some(format!("{} rigid-body modes, the reference has {}", found.n_rigid, reference.n_zero))
    } else if n_compared < n_modes {
        Some(format!("{n_compared} modes of {n_modes}"))
    } else if counted != below {
        Some(format!("{counted} eigenvalues counted, {below} found"))
    } else if !found.is_enclosed {
        Some("an eigenvalue is not where the Sturm counts say".to_owned())
    } else if worst.relative > worst.allowed {
        Some(format!("differs by {:.1e}, allowed {:.1e}", worst.relative, worst.allowed))
    } else {
        None
    };
    let outcome = fault.as_deref().unwrap_or("agrees");
    let line = format!(
        "{} | {}/{} | {n_compared} | {:.1e} | {:.1e} | {outcome}",
        found.n_dofs, found.n_rigid, reference.n_zero, worst.relative, worst.allowed
    );
    (line, fault)
}

#[test]
fn free_modes_agree_with_their_references_or_the_error_names_the_reason() {
    let Some(pairs) = corpus() else { return };
    // As `reduce` does: small dense decompositions run on one thread.
    faer::set_global_parallelism(faer::Par::Seq);
    let with_large = std::env::var_os("SUPEL_CORPUS_LARGE").is_some();
    let (wanted, left_out): (Vec<&Pair>, Vec<&Pair>) =
        PAIRS.iter().partition(|pair| with_large || pair.size == Size::Small);
    for pair in left_out {
        println!("skipped: {}, set SUPEL_CORPUS_LARGE to run it", pair.name);
    }
    let rows: Vec<_> = wanted.par_iter().map(|pair| examine(&pairs, pair)).collect();
    println!(
        "\n| pair | n | rigid found/reference | modes | difference nearest its limit | allowed | outcome | time |"
    );
    println!("|-|-|-|-|-|-|-|-|");
    rows.iter().for_each(|(line, _)| println!("{line}"));
    let faults: Vec<&String> = rows.iter().filter_map(|(_, fault)| fault.as_ref()).collect();
    assert!(faults.is_empty(), "{faults:#?}");
}
