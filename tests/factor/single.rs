//! Factors kept in single precision, whose solves conjugate gradients bring to double.

use faer::{Mat, MatRef};
use supel::factor::{Analysis, Cholesky, SolveOperator, Storage};
use supel::sparse::Pencil;
use supel::sparse::{SparseMatrix, absolute_product, product};

use super::matrices::{diagonal, families, symmetric};
use super::{dense, loads, pencil, unit};

fn in_single<'a>(analysis: &'a Analysis, pencil: Pencil<'a>, sigma: f64) -> Cholesky<'a> {
    let name = |dof: usize| dof.to_string();
    Cholesky::kept(analysis, (pencil, sigma), Storage::Single, &name).expect("a definite matrix")
}

/// |B − AX| / (|A||X| + |B|) in the worst row.
fn residual(matrix: &SparseMatrix, x: MatRef<'_, f64>, b: MatRef<'_, f64>) -> f64 {
    let (force, terms) = (product(matrix, x), absolute_product(matrix, x));
    let of_row = |i, j| (b[(i, j)] - force[(i, j)]).abs() / (b[(i, j)].abs() + terms[(i, j)]);
    let rows = |j| (0..matrix.rows()).map(move |i| (i, j)).filter(|at| b[*at] != force[*at]);
    (0..x.ncols()).flat_map(rows).map(|(i, j)| of_row(i, j)).fold(0.0, f64::max)
}

/// The squared second differences of a path held at one end, as a cantilever: κ grows with n⁴.
fn cantilever(n: usize) -> SparseMatrix {
    let edges: Vec<(u32, u32)> = (1..n as u32).flat_map(|i| (i.saturating_sub(2)..i).map(move |j| (i, j))).collect();
    let diagonal = |i: usize| match n - 1 - i {
        0 => 1.0,
        1 => 5.0,
        _ => 6.0,
    };
    let last = n as u32 - 1;
    symmetric(
        n,
        &edges,
        |i, j| {
            if i - j == 2 {
                1.0
            } else if i == last {
                -2.0
            } else {
                -4.0
            }
        },
        diagonal,
    )
}

#[test]
fn solutions_are_as_accurate_as_those_in_double_precision() {
    let cantilever = ("a cantilever", cantilever(600));
    for (name, matrix) in families().into_iter().chain([cantilever]) {
        let mass = unit(matrix.rows());
        let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
        let factor = in_single(&analysis, pencil(&matrix, &mass), 0.0);
        let double = super::factor(&analysis, &matrix, &mass);
        assert_eq!(factor.smallest_pivot_ratio, double.smallest_pivot_ratio, "{name}: elimination is the same");
        let b = loads(matrix.rows(), 11);
        let mut x = b.clone();
        factor.solve_in_place(x.as_mut());
        // 16 ε are aimed at in every row, and no row of these is at rest.
        let left = residual(&matrix, x.as_ref(), b.as_ref());
        assert!(left <= 16.0 * f64::EPSILON, "{name}: {left:e}");
        let work = factor.refinement().expect("all solves").expect("refined");
        assert_eq!(work.n_solves, 11, "{name}");
        // One step leaves rounding of single precision, which no product of 600 stiff springs hides.
        assert!(work.most_steps > 1 || matrix.nnz() == matrix.rows(), "{name}: {work:?}");
    }
}

/// A matrix perturbed by rounding of single precision would have other eigenvalues altogether; its factor acts by κ(L) = √κ.
#[test]
fn c_11_ill_conditioned_solutions_take_few_steps() {
    let matrix = cantilever(600);
    let mass = unit(600);
    let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
    let eigenvalues = dense(&matrix).self_adjoint_eigenvalues(faer::Side::Lower).expect("eigenvalues");
    let condition = eigenvalues[599] / eigenvalues[0];
    assert!(condition * f64::from(f32::EPSILON) > 1e3, "{condition:e}");
    let factor = in_single(&analysis, pencil(&matrix, &mass), 0.0);
    let mut x = loads(600, 8);
    factor.solve_in_place(x.as_mut());
    // Each step takes an error to ε √κ of itself, 10⁻² here, from 1 to rounding of double precision: 16 digits, 2 at a time.
    let work = factor.refinement().expect("all solves").expect("refined");
    assert!((3..=8).contains(&work.most_steps), "{work:?}");
}

#[test]
fn a_solution_never_depends_on_the_others_or_on_threads() {
    for (name, matrix) in families().into_iter().filter(|(_, matrix)| matrix.rows() > 700) {
        let mass = unit(matrix.rows());
        let analysis = Analysis::new(pencil(&matrix, &mass)).expect("an analysis");
        let run = |threads: usize, columns: std::ops::Range<usize>| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| {
                let factor = in_single(&analysis, pencil(&matrix, &mass), 0.0);
                let mut x = loads(matrix.rows(), 9).as_ref().subcols(columns.start, columns.len()).to_owned();
                // A column without loads stays at rest.
                if columns.contains(&5) {
                    x.as_mut().col_mut(5 - columns.start).fill(0.0);
                }
                factor.solve_in_place(x.as_mut());
                x
            })
        };
        let together = run(1, 0..9);
        assert!(together.col(5).iter().all(|value| *value == 0.0), "{name}");
        assert!(run(3, 0..9) == together, "{name}, 3 threads");
        for (start, width) in [(0, 1), (4, 3), (8, 1)] {
            let alone = run(2, start..start + width);
            assert!(alone.as_ref() == together.as_ref().subcols(start, width), "{name}, columns from {start}");
        }
    }
}

#[test]
fn shifted_matrices_of_any_units_are_solved_alike() {
    let n = 700;
    // Every third dof in units of 2⁵⁰⁰: squares of them leave the range of single precision by far.
    let unit_of = |dof: u32| if dof.is_multiple_of(3) { 2f64.powi(500) } else { 1.0 };
    let path: Vec<(u32, u32)> = (1..n).map(|i| (i, i - 1)).collect();
    let stiffness = symmetric(n as usize, &path, |i, j| -unit_of(i) * unit_of(j), |i| 2.0 * unit_of(i as u32).powi(2));
    let mass = diagonal(&(0..n).map(|i| unit_of(i).powi(2)).collect::<Vec<_>>());
    let plain = symmetric(n as usize, &path, |_, _| -1.0, |_| 2.0);
    let ones = unit(n as usize);
    let solved = |stiffness: &SparseMatrix, mass: &SparseMatrix, unit_of: &dyn Fn(u32) -> f64| {
        let pencil = Pencil::new(stiffness, mass);
        let analysis = Analysis::new(pencil).expect("an analysis");
        let factor = in_single(&analysis, pencil, -1e-3);
        let b = loads(n as usize, 3);
        let mut x = Mat::from_fn(n as usize, 3, |i, j| b[(i, j)] * unit_of(i as u32));
        factor.solve_in_place(x.as_mut());
        assert!(factor.refinement().is_ok());
        Mat::from_fn(n as usize, 3, |i, j| x[(i, j)] * unit_of(i as u32))
    };
    assert!(solved(&stiffness, &mass, &unit_of) == solved(&plain, &ones, &|_| 1.0), "units are powers of two");
}

#[test]
fn what_is_not_definite_is_named_as_in_double_precision() {
    let mut values: Vec<f64> = (0..50).map(|i| 1.0 + f64::from(i)).collect();
    values[17] = 0.0;
    for expected in ["E-NOT-DEFINITE", "E-NEGATIVE-STIFFNESS"] {
        let (matrix, mass) = (diagonal(&values), unit(50));
        let pencil = pencil(&matrix, &mass);
        let analysis = Analysis::new(pencil).expect("an analysis");
        let name = |dof: usize| dof.to_string();
        let error = Cholesky::kept(&analysis, (pencil, 0.0), Storage::Single, &name).expect_err("not definite");
        assert_eq!(error.code(), expected);
        values[17] = -1.0;
    }
}
