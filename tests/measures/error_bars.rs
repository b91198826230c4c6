//! Error bars contain the truth where it is known in closed form, and are no wider than they must be.

use faer::Mat;
use supel::eigen::{ModalProblem, ModeRequest, ShiftInvert, Wanted, elastic_modes};
use supel::input::{Digits, Input, MatrixInput};
use supel::job::{Eigensolver, Method};
use supel::random::SEED;
use supel_models::transform::rounded;
use supel_models::{Ends, Model, bar, bar_spectrum, known, ring, ring_spectrum, spring, spring_spectrum};

use crate::chain::{input, rows};
use crate::evidence::with_evidence;

/// A model, its elastic spectrum in closed form and the relative error of that spectrum's own numbers.
fn families() -> Vec<(&'static str, Model, Vec<f64>)> {
    let mut clusters = vec![1.0, 1.0, 1.0, 1.0 + 1e-10, 2.0, 2.0];
    clusters.extend((3..80).map(f64::from));
    let mut families = vec![("known", known(&clusters, 7), clusters)];
    for n in [12, 150, 2500] {
        families.push(("bar", bar(n), bar_spectrum(n)));
        families.push(("held chain", spring(n, Ends::Fixed), spring_spectrum(n, Ends::Fixed)));
        families.push(("free chain", spring(n, Ends::Free), spring_spectrum(n, Ends::Free)[1..].to_vec()));
        families.push(("ring", ring(n, 0.01), ring_spectrum(n, 0.01)));
    }
    families
}

/// A model whose files held that many digits.
fn with_digits(model: &Model, digits: u32) -> Input {
    let input = input(&if digits < 17 { rounded(model, digits as usize) } else { model.clone() });
    let known = Digits { significant: digits, ..Digits::DOUBLE };
    let of = |matrix: MatrixInput| MatrixInput { digits: known, ..matrix };
    Input { stiffness: of(input.stiffness), mass: of(input.mass), ..input }
}

/// |λ − exact| ≤ bar, for all digits of the data.
#[test]
fn bars_contain_closed_spectra() {
    for (name, model, exact) in families() {
        for digits in [17, 12, 9, 6] {
            let interfaces = [rows("one", &[0])];
            with_evidence(with_digits(&model, digits), &interfaces, (Method::Herting, 8), |evidence| {
                let unit = evidence.partition.scaling.eigenvalue_unit();
                let modes = &evidence.retained.modes;
                for ((lambda, error), exact) in modes.lambda.iter().zip(&modes.errors).zip(&exact) {
                    let off = (lambda * unit / exact - 1.0).abs();
                    // The closed formulae themselves round: a sine and three products.
                    let bar = error.relative_bar + 8.0 * f64::EPSILON;
                    assert!(off <= bar, "{name} of {}, {digits} digits: off {off:e}, bar {bar:e}", model.n);
                    // A bar that held anything would be true of any mode.
                    let least = 0.5 * 10f64.powi(1 - digits as i32).max(f64::EPSILON);
                    assert!(bar <= 1e3 * least * error.cancellation, "{name} of {}: bar {bar:e}", model.n);
                }
            });
        }
    }
}

/// An operator that leaves a share of another direction in what it solves.
struct Leaky<'a>(&'a dyn ShiftInvert, f64);

impl ShiftInvert for Leaky<'_> {
    fn n(&self) -> usize {
        self.0.n()
    }

    fn shift(&self) -> f64 {
        self.0.shift()
    }

    fn solve_in_place(&self, mut block: faer::MatMut<'_, f64>) {
        let loads = block.to_owned();
        self.0.solve_in_place(block.as_mut());
        // Symmetric, so that the eigensolver converges to the modes of another matrix without a complaint.
        for j in 0..block.ncols() {
            for i in 0..block.nrows() {
                block[(i, j)] += self.1 * if i % 2 == 0 { loads[(i, j)] } else { -loads[(i, j)] };
            }
        }
    }
}

/// Modes of a solve gone wrong have the wide bars they deserve.
#[test]
fn bars_own_up_to_a_bad_residual() {
    let n = 150;
    let model = spring(n, Ends::Fixed);
    let exact = spring_spectrum(n, Ends::Fixed);
    with_evidence(input(&model), &[rows("one", &[0])], (Method::CraigBampton, 4), |evidence| {
        let problem = ModalProblem::of(evidence.partition.pencil(), evidence.partition.precision);
        let dense = crate::chain::dense(&evidence.partition.stiffness);
        let sound = Dense(dense);
        let request = ModeRequest { wanted: Wanted::Count(4), eigensolver: Eigensolver::Lanczos, seed: SEED };
        let unit = evidence.partition.scaling.eigenvalue_unit();
        let mut widest = 0.0f64;
        for leak in [0.0, 1e-6, 1e-3, 1.0] {
            let modes = elastic_modes(problem, &Leaky(&sound, leak), request).expect("converges");
            for ((lambda, error), exact) in modes.lambda.iter().zip(&modes.errors).zip(&exact) {
                let off = (lambda * unit / exact - 1.0).abs();
                let bar = error.relative_bar + 8.0 * f64::EPSILON;
                assert!(off <= bar, "leak {leak:e}: off {off:e}, bar {bar:e}");
                widest = widest.max(off / error.data_bar);
            }
        }
        assert!(widest > 10.0, "the leaks do no harm that the digits of the data would not: {widest}");
    });
}

/// K⁻¹ by a dense factor.
struct Dense(Mat<f64>);

impl ShiftInvert for Dense {
    fn n(&self) -> usize {
        self.0.nrows()
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn solve_in_place(&self, mut block: faer::MatMut<'_, f64>) {
        use faer::linalg::solvers::Solve;
        self.0.llt(faer::Side::Lower).expect("definite").solve_in_place(block.as_mut());
    }
}
