//! The multifrontal factorisation against faer's own sparse and dense ones.

mod border;
mod matrices;
mod single;

use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, MatRef, Side};
use supel::error::Error;
use supel::factor::{Analysis, Cholesky, SolveOperator, Storage, count_negative, whole_count};
use supel::sparse::Pencil;
use supel::sparse::{Leading, SparseMatrix, absolute_product, product};

use matrices::{diagonal, families, grid, spd};

fn pencil<'a>(stiffness: &'a SparseMatrix, mass: &'a SparseMatrix) -> Pencil<'a> {
    Pencil::new(stiffness, mass)
}

fn unit(n: usize) -> SparseMatrix {
    diagonal(&vec![1.0; n])
}

fn dense(matrix: &SparseMatrix) -> Mat<f64> {
    Mat::from_fn(matrix.rows(), matrix.cols(), |i, j| matrix.get(i, j).copied().unwrap_or(0.0))
}

fn loads(n: usize, k: usize) -> Mat<f64> {
    Mat::from_fn(n, k, |i, j| ((i * 31 + j * 17) % 23) as f64 - 11.0)
}

fn factor<'a>(analysis: &'a Analysis, matrix: &SparseMatrix, mass: &SparseMatrix) -> Cholesky<'a> {
    Cholesky::new(analysis, pencil(matrix, mass), 0.0, &|dof| dof.to_string()).expect("a definite matrix")
}

/// ‖A X − B‖ relative to ‖A‖‖X‖ + ‖B‖ in the largest entries and row sums.
fn backward_error(matrix: &SparseMatrix, x: MatRef<'_, f64>, b: MatRef<'_, f64>) -> f64 {
    let largest = |block: MatRef<'_, f64>| block.norm_max();
    let norm = (0..matrix.rows()).map(|row| matrix.outer_view(row).expect("a row").iter().map(|(_, v)| v.abs()).sum());
    let norm = norm.fold(0.0, f64::max);
    let residual = product(matrix, x) - b;
    largest(residual.as_ref()) / (norm * largest(x) + largest(b))
}

#[test]
fn solutions_are_as_good_as_those_of_faer() {
    for (name, matrix) in families() {
        let n = matrix.rows();
        let triplets: Vec<_> =
            matrix.iter().map(|(value, (i, j))| Triplet::new(i as usize, j as usize, *value)).collect();
        let oracle = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &triplets).expect("a matrix");
        let oracle = oracle.sp_cholesky(Side::Lower).expect("definite");
        let mass = unit(n);
        let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
        let factor = factor(&analysis, &matrix, &mass);
        for k in [1, 3, 4, 5, 8, 13] {
            let b = loads(n, k);
            let mut x = b.clone();
            factor.solve_in_place(x.as_mut());
            let theirs = backward_error(&matrix, oracle.solve(&b).as_ref(), b.as_ref());
            let ours = backward_error(&matrix, x.as_ref(), b.as_ref());
            // Both are bounded by n ε and reach a few ε; neither is allowed to be ten times the other.
            assert!(ours <= 10.0 * theirs.max(f64::EPSILON), "{name}, {k} loads: {ours:e}, faer {theirs:e}");
        }
    }
}

/// fᵀA⁻¹f by the forward half of a solve, and by whole ones.
#[test]
fn compliances_are_those_of_the_solutions() {
    for (name, matrix) in families() {
        let n = matrix.rows();
        let mass = unit(n);
        let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
        let name_of = |dof: usize| dof.to_string();
        let single =
            Cholesky::kept(&analysis, (pencil(&matrix, &mass), 0.0), Storage::Single, &name_of).expect("definite");
        let double = factor(&analysis, &matrix, &mass);
        for k in [1, 8, 16, 19] {
            let f = loads(n, k);
            let mut x = f.clone();
            double.solve_in_place(x.as_mut());
            let terms = absolute_product(&matrix, x.as_ref());
            for (storage, found) in
                [("double", double.compliances(f.as_ref())), ("single", single.compliances(f.as_ref()))]
            {
                assert_eq!(found.len(), k);
                for (j, found) in found.into_iter().enumerate() {
                    let expected: f64 = (0..n).map(|i| f[(i, j)] * x[(i, j)]).sum();
                    // Each way is exact for a matrix within n ε |A| of A, which changes xᵀAx by |x|ᵀ|A||x| times that; and
                    // there are the sums themselves.
                    let size: f64 = (0..n).map(|i| x[(i, j)].abs() * (terms[(i, j)] + f[(i, j)].abs())).sum();
                    let bound = 2.0 * n as f64 * f64::EPSILON * size;
                    assert!(
                        (found - expected).abs() <= bound,
                        "{name}, {storage}, load {j} of {k}: {found} for {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn inertia_is_that_of_the_eigenvalues() {
    for (name, matrix) in families().into_iter().filter(|(_, matrix)| matrix.rows() <= 700) {
        let n = matrix.rows();
        let mass = unit(n);
        let eigenvalues = dense(&matrix).self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
        let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
        for place in [n / 50, n / 7, n / 3, n / 2, n - 2] {
            let (low, high) = (eigenvalues[place], eigenvalues[place + 1]);
            if high - low < 1e-9 * high {
                continue;
            }
            let count = whole_count(&analysis, pencil(&matrix, &mass), 0.5 * (low + high)).expect("a count");
            assert_eq!(count.below, place + 1, "{name} at {place}");
        }
    }
}

#[test]
fn same_bits_for_any_number_of_threads() {
    for (name, matrix) in families() {
        let mass = unit(matrix.rows());
        let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| {
                let factor = factor(&analysis, &matrix, &mass);
                let mut x = loads(matrix.rows(), 8);
                factor.solve_in_place(x.as_mut());
                let count = whole_count(&analysis, pencil(&matrix, &mass), 0.7 * matrix.get(0, 0).unwrap());
                (x, count.expect("a count"))
            })
        };
        let reference = run(1);
        for threads in [2, 3, 8] {
            assert!(run(threads) == reference, "{name}, {threads} threads");
        }
    }
}

#[test]
fn a_pivot_that_is_not_positive_is_named_by_its_dof() {
    let mut values: Vec<f64> = (0..50).map(|i| 1.0 + f64::from(i)).collect();
    values[17] = 0.0;
    let (matrix, mass) = (diagonal(&values), unit(50));
    let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
    let name = |dof: usize| format!("dof {dof}");
    let error = Cholesky::new(&analysis, pencil(&matrix, &mass), 0.0, &name).expect_err("singular");
    assert!(matches!(&error, Error::NotDefinite { dof, .. } if dof == "dof 17"), "{error}");
    values[17] = -1.0;
    let matrix = diagonal(&values);
    let error = Cholesky::new(&analysis, pencil(&matrix, &mass), 0.0, &name).expect_err("indefinite");
    assert!(matches!(error, Error::IndefiniteStiffness { count: 1, .. }), "{error}");
    assert!(error.to_string().contains("with no interface held"), "{error}");
    // As the border of the elimination, or left out of the block, an interface is held.
    let whole = pencil(&matrix, &mass);
    let bordered = Analysis::with_border(whole, 5).expect("an analysis");
    let block = Pencil::new(Leading::new(&matrix, 45), Leading::new(&mass, 45));
    let of_block = Analysis::new(block).expect("an analysis");
    for (analysis, pencil) in [(&bordered, whole), (&of_block, block)] {
        let error = Cholesky::new(analysis, pencil, 0.0, &name).expect_err("indefinite");
        assert!(error.to_string().contains("with the interface held"), "{error}");
    }
    assert_eq!(count_negative(&analysis, &matrix).expect("a count"), 1);
}

#[test]
fn nothing_is_factored_of_nothing() {
    let empty = diagonal(&[]);
    let analysis = Analysis::new(pencil(&empty, &empty)).expect("an analysis");
    let factor = factor(&analysis, &empty, &empty);
    let mut x = Mat::zeros(0, 3);
    factor.solve_in_place(x.as_mut());
    assert_eq!(factor.n(), 0);
}

/// K + τM is factored straight from both matrices, whichever of them an entry is in.
#[test]
fn patterns_of_both_matrices_count() {
    let (matrix, mass) = (diagonal(&[4.0; 120]), grid([10, 12, 1]));
    let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
    let factor = Cholesky::new(&analysis, pencil(&matrix, &mass), -0.5, &|dof| dof.to_string()).expect("definite");
    let b = loads(120, 2);
    let mut x = b.clone();
    factor.solve_in_place(x.as_mut());
    let residual = product(&matrix, x.as_ref()) + faer::Scale(0.5) * product(&mass, x.as_ref()) - &b;
    assert!(residual.norm_max() <= 120.0 * f64::EPSILON * b.norm_max());
}

/// The entries of the factor and its flops are those of the columns, whatever zeros supernodes store.
#[test]
fn work_is_counted_without_the_zeros_of_supernodes() {
    let arrow = spd(5, &[(4, 0), (4, 1), (4, 2), (4, 3)]);
    let analysis = Analysis::new(pencil(&arrow, &arrow)).expect("an analysis");
    assert_eq!((analysis.nnz_factor, analysis.flops), (9.0, 17.0));
}
