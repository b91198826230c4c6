//! The interface as border: constraint modes, Schur complement, counts and solves against dense algebra.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};
use supel::factor::{Cholesky, ShiftedFactor, Storage, condensed, count_below, count_below_freeing};
use supel::input::{Digits, Input, MatrixInput};
use supel::job::{Coupling, InterfaceJob, NodeSelection};
use supel::model::Model;
use supel::partition::Partition;
use supel::sparse::{AssemblyNotes, SparseMatrix, product};

use crate::matrices::{diagonal, families, symmetric};
use crate::{dense, loads};

/// K of a family and a diagonal mass; the interface in units a million times smaller.
fn partition(matrix: &SparseMatrix, mass: impl Fn(usize) -> f64, interface: &[usize]) -> Partition {
    let n = matrix.rows();
    let unit: Vec<f64> = (0..n).map(|dof| if interface.contains(&dof) { 1e6 } else { 1.0 }).collect();
    let mut stiffness = matrix.clone();
    for (row, mut entries) in stiffness.outer_iterator_mut().enumerate() {
        for (col, value) in entries.iter_mut() {
            *value *= unit[row] * unit[col];
        }
    }
    let mass: Vec<f64> = unit.iter().enumerate().map(|(dof, unit)| unit * unit * mass(dof)).collect();
    let read = |matrix| MatrixInput {
        matrix,
        notes: AssemblyNotes::default(),
        digits: Digits::DOUBLE,
        path: "generated".into(),
        layout: None,
        digest: String::new(),
    };
    let input = Input {
        stiffness: read(stiffness),
        mass: read(diagonal(&mass)),
        dofs: None,
        labels: Default::default(),
        cells: Vec::new(),
        nodes: None,
        rows: Default::default(),
        constraints: None,
        internal_forces: None,
        turning: None,
        axes: None,
        digests: Default::default(),
        notes: Vec::new(),
    };
    let nodes = NodeSelection::Rows { rows: interface.to_vec() };
    let interface = InterfaceJob::new("border", nodes, Coupling::Direct);
    Partition::new(Model::new(input).expect("a model"), &[interface]).expect("a partition")
}

/// Every tree with a border of one dof, of some, and of all but one.
fn partitions() -> Vec<(String, Partition)> {
    let small = families().into_iter().filter(|(_, matrix)| matrix.rows() <= 700);
    let of = |(name, matrix): (&str, SparseMatrix)| {
        let n = matrix.rows();
        [vec![n / 2], (0..17).map(|i| i * (n / 17)).collect(), (0..n - 1).collect()].map(|rows| {
            let partition = partition(&matrix, |dof| 1.0 + (dof % 5) as f64, &rows);
            (format!("{name}, {} at the border", rows.len()), partition)
        })
    };
    small.flat_map(of).collect()
}

/// A shift in the midst of the spectrum, and the eigenvalues below it with the interface free and held.
fn shift(partition: &Partition) -> (f64, usize, usize) {
    let n_i = partition.n_internal;
    let scale: Vec<f64> = (0..partition.n_dofs()).map(|i| partition.mass.get(i, i).expect("mass").sqrt()).collect();
    let k = dense(&partition.stiffness);
    let standard = Mat::from_fn(k.nrows(), k.ncols(), |i, j| k[(i, j)] / (scale[i] * scale[j]));
    let values = |a: MatRef<'_, f64>| a.self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
    let (free, held) = (values(standard.as_ref()), values(standard.as_ref().submatrix(0, 0, n_i, n_i)));
    let mut all: Vec<f64> = free.iter().chain(&held).copied().collect();
    all.sort_by(f64::total_cmp);
    // In the widest of the gaps in the middle third.
    let third = all.len() / 3..=2 * all.len() / 3;
    let at = third.max_by(|a, b| (all[a + 1] - all[*a]).total_cmp(&(all[b + 1] - all[*b]))).expect("a gap");
    let sigma = 0.5 * (all[at] + all[at + 1]);
    let below = |values: &[f64]| values.iter().filter(|value| **value < sigma).count();
    (sigma, below(&free), below(&held))
}

fn shifted(partition: &Partition, sigma: f64) -> Mat<f64> {
    dense(&partition.stiffness) - faer::Scale(sigma) * dense(&partition.mass)
}

/// ‖D (A X − B)‖ relative to ‖DAD‖‖D⁻¹X‖ + ‖DB‖ in the largest entries, D = 1/√K_ii: units do not count.
fn backward_error(a: &Mat<f64>, scale: &[f64], x: MatRef<'_, f64>, b: MatRef<'_, f64>) -> f64 {
    let residual = a * x - b;
    let largest = |block: MatRef<'_, f64>, scale: &dyn Fn(usize) -> f64| {
        (0..block.ncols())
            .flat_map(|j| (0..block.nrows()).map(move |i| (i, j)))
            .fold(0.0f64, |max, (i, j)| max.max((block[(i, j)] * scale(i)).abs()))
    };
    let norm = (0..a.nrows()).map(|i| (0..a.ncols()).map(|j| (a[(i, j)] * scale[i] * scale[j]).abs()).sum::<f64>());
    let of_x = largest(x, &|i| 1.0 / scale[i]);
    largest(residual.as_ref(), &|i| scale[i]) / (norm.fold(0.0, f64::max) * of_x + largest(b, &|i| scale[i]))
}

fn scale(partition: &Partition) -> Vec<f64> {
    (0..partition.n_dofs()).map(|i| 1.0 / partition.stiffness.get(i, i).expect("a diagonal").sqrt()).collect()
}

#[test]
fn constraint_modes_are_those_of_dense_algebra() {
    for (name, partition) in partitions() {
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        let analysis = partition.analysis().expect("memory");
        let modes = [Storage::Double, Storage::Single].map(|storage| {
            let factor = Cholesky::kept(&analysis, (partition.pencil(), 0.0), storage, &|dof| dof.to_string());
            let factor = factor.expect("definite");
            let modes = factor.follow_border(Mat::<f64>::identity(n_b, n_b).as_ref());
            assert!(factor.refinement().is_ok(), "{name}");
            modes
        });
        let k = dense(&partition.stiffness);
        let expected = k.as_ref().submatrix(0, 0, n_i, n_i).llt(Side::Lower).expect("definite");
        let expected = expected.solve(k.as_ref().submatrix(0, n_i, n_i, n_b));
        // Diagonally dominant matrices: the condition is below 1e4 in scales that make the diagonal one.
        for modes in modes {
            let error = (&modes + &expected).norm_max();
            assert!(error <= 1e4 * f64::EPSILON * expected.norm_max(), "{name}: {error:e}");
        }
    }
}

#[test]
fn counts_and_solves_inside_the_spectrum_are_those_of_dense_algebra() {
    for (name, partition) in partitions() {
        let (sigma, free, held) = shift(&partition);
        let analysis = partition.analysis().expect("memory");
        let count = count_below(&analysis, partition.pencil(), sigma).expect("off the eigenvalues");
        assert_eq!((count.free, count.clamped), (free, held), "{name}");
        let factor = ShiftedFactor::new(&analysis, partition.pencil(), sigma).expect("off the eigenvalues");
        assert_eq!(factor.count, count, "{name}: a factor that is kept has the same pivots");
        let (n, n_i, a, scale) =
            (partition.n_dofs(), partition.n_internal, shifted(&partition, sigma), scale(&partition));
        let b = Mat::from_fn(n, 9, |i, j| loads(n, 9)[(i, j)] / scale[i]);
        let mut x = b.clone();
        factor.solve_free(x.as_mut());
        // Growth of a few, n roundings, and pivots exchanged within panels only.
        let bar = 100.0 * count.growth * n as f64 * f64::EPSILON;
        let error = backward_error(&a, &scale, x.as_ref(), b.as_ref());
        assert!(error <= bar, "{name}, free: {error:e} above {bar:e}");
        let (held, b) = (a.as_ref().submatrix(0, 0, n_i, n_i).to_owned(), b.as_ref().subrows(0, n_i));
        let mut x = b.to_owned();
        factor.solve_held(x.as_mut());
        let error = backward_error(&held, &scale[..n_i], x.as_ref(), b);
        assert!(error <= bar, "{name}, held: {error:e} above {bar:e}");
    }
}

/// Some of the border free and the rest held: S(σ) of the part that is free counts and solves.
#[test]
fn counts_and_solves_with_some_of_the_border_free_are_those_of_dense_algebra() {
    let mut n_mixed = 0;
    for (name, partition) in partitions() {
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        let free: Vec<usize> = (0..n_b).filter(|dof| dof % 3 != 1).collect();
        if free.len() == n_b {
            continue;
        }
        n_mixed += 1;
        let (sigma, ..) = shift(&partition);
        let kept: Vec<usize> = (0..n_i).chain(free.iter().map(|dof| n_i + dof)).collect();
        let n = kept.len();
        let (whole, of_whole) = (shifted(&partition, sigma), scale(&partition));
        let a = Mat::from_fn(n, n, |i, j| whole[(kept[i], kept[j])]);
        let scale: Vec<f64> = kept.iter().map(|dof| of_whole[*dof]).collect();
        let unit = Mat::from_fn(n, n, |i, j| a[(i, j)] * scale[i] * scale[j]);
        let values = unit.self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
        // A sign that rounding decides says nothing.
        let least = values.iter().fold(f64::INFINITY, |least: f64, value| least.min(value.abs()));
        assert!(least > 1e-9, "{name}: the shift is on an eigenvalue");
        let analysis = partition.analysis().expect("memory");
        let count =
            count_below_freeing(&analysis, partition.pencil(), sigma, Some(&free)).expect("off the eigenvalues");
        assert_eq!(count.free, values.iter().filter(|value| **value < 0.0).count(), "{name}");
        let factor = ShiftedFactor::freeing(&analysis, partition.pencil(), sigma, Some(&free)).expect("off them");
        assert_eq!(factor.count, count, "{name}: a factor that is kept has the same pivots");
        let b = Mat::from_fn(n, 9, |i, j| loads(n, 9)[(i, j)] / scale[i]);
        let mut x = b.clone();
        factor.solve_free(x.as_mut());
        let bar = 100.0 * count.growth * n as f64 * f64::EPSILON;
        let error = backward_error(&a, &scale, x.as_ref(), b.as_ref());
        assert!(error <= bar, "{name}: {error:e} above {bar:e}");
    }
    assert!(n_mixed > 5, "{n_mixed} partitions have a border to hold some of");
}

/// Below the first pivot all other entries vanish exactly, in a panel wider than the blocks of a dense factorisation.
#[test]
fn columns_that_vanish_exactly_are_zero_in_the_factor() {
    let n = 300;
    let all: Vec<(u32, u32)> = (1..n as u32).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
    // 11ᵀ + I/4 with half the mass at the first dof: at σ = ½ its pivot is one, and −I/4 is left of the others.
    let ones = symmetric(n, &all, |_, _| 1.0, |_| 1.25);
    let partition = partition(&ones, |dof| if dof == 0 { 0.5 } else { 1.0 }, &[n - 1]);
    let sigma = 0.5 / partition.scaling.eigenvalue_unit();
    let analysis = partition.analysis().expect("memory");
    let factor = ShiftedFactor::new(&analysis, partition.pencil(), sigma).expect("off the eigenvalues");
    assert_eq!((factor.count.clamped, factor.count.free), (n - 2, n - 1));
    let (a, scale, b) = (shifted(&partition, sigma), scale(&partition), loads(n, 3));
    let mut x = b.clone();
    factor.solve_free(x.as_mut());
    let error = backward_error(&a, &scale, x.as_ref(), b.as_ref());
    assert!(error <= n as f64 * f64::EPSILON, "{error:e}");
}

#[test]
fn schur_complement_is_what_the_border_feels() {
    for (name, partition) in partitions() {
        let (sigma, ..) = shift(&partition);
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        let analysis = partition.analysis().expect("memory");
        let (count, schur) = condensed(&analysis, partition.pencil(), sigma).expect("off the eigenvalues");
        let a = shifted(&partition, sigma);
        let coupling = a.as_ref().submatrix(0, n_i, n_i, n_b);
        let inner = a.as_ref().submatrix(0, 0, n_i, n_i).lblt(Side::Lower).solve(coupling);
        let expected = a.as_ref().submatrix(n_i, n_i, n_b, n_b) - coupling.transpose() * inner;
        let scale = scale(&partition);
        let error = Mat::from_fn(n_b, n_b, |i, j| (schur[(i, j)] - expected[(i, j)]) * scale[n_i + i] * scale[n_i + j]);
        let size =
            Mat::from_fn(n_b, n_b, |i, j| expected[(i, j)] * scale[n_i + i] * scale[n_i + j]).norm_max().max(1.0);
        // Both err by n ε times growth, relative to pivots that may be small.
        let bar = 1e3 * f64::EPSILON * count.growth / count.pivot_gap.min(1.0);
        assert!(error.norm_max() / size <= bar, "{name}: {:e} above {bar:e}", error.norm_max() / size);
    }
}

#[test]
fn border_has_the_same_bits_for_any_number_of_threads() {
    // As the tool has it: dense decompositions of the interface use one thread.
    faer::set_global_parallelism(faer::Par::Seq);
    for (name, partition) in partitions() {
        let (sigma, ..) = shift(&partition);
        let analysis = partition.analysis().expect("memory");
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| {
                let factor = ShiftedFactor::new(&analysis, partition.pencil(), sigma).expect("off the eigenvalues");
                let mut x = product(&partition.mass, loads(partition.n_dofs(), 17).as_ref());
                factor.solve_free(x.as_mut());
                (x, condensed(&analysis, partition.pencil(), sigma).expect("off the eigenvalues"))
            })
        };
        let reference = run(1);
        for threads in [2, 3, 8] {
            let (x, condensed) = run(threads);
            assert!(condensed == reference.1, "{name}, S with {threads} threads");
            assert!(x == reference.0, "{name}, solves with {threads} threads");
        }
    }
}
