//! Digits of the text and the last bits of a double: C-13, C-14.

use supel::sparse::product;
use supel::verification::check::Verdict;
use supel_models::transform::rounded;
use supel_models::{Material, Model, SplitMix64, brick, fnv1a};

use crate::chain::{self, direct};
use crate::program::{Case, bars, eigensolvers, eigenvalues, lines, n_rigid, warnings};

/// K and M written with d digits: the bar holds the true error and is no more than a thousand times as large.
#[test]
fn c_13_bars_follow_the_digits_of_the_text() {
    let model = brick([5, 2, 2], [5.0, 2.1, 1.9], &Material::STEEL_SI);
    let pins = [direct("pins", &[1, 18, 40])];
    let exact = eigenvalues(&Case::new(&model, &pins).clean());
    for digits in [14, 12, 10, 9, 7, 5] {
        for eigensolver in eigensolvers() {
            let case = Case::new(&rounded(&model, digits), &pins).by(eigensolver);
            if digits == 5 {
                // No check fails for what the digits explain: the bars hold, checks past their limits warn, and the digits are named.
                let outcome = case.run().expect("modes");
                assert_eq!(outcome.report.body.verdict(), Verdict::Warn, "{:#?}", outcome.report.body.checks);
                assert!(warnings(&outcome).contains(&"W-DATA-PRECISION"), "{:?}", outcome.report.body.warnings);
                for ((found, exact), bar) in eigenvalues(&outcome).iter().zip(&exact).zip(bars(&outcome)) {
                    assert!((found / exact - 1.0).abs() <= bar, "{found} for {exact}, bar {bar:e}");
                }
                assert_eq!(n_rigid(&outcome), 6);
                println!("5 digits, {eigensolver}: {:#?}", lines(&outcome, Verdict::Warn));
                continue;
            }
            let outcome = case.accepted();
            assert_eq!(outcome.report.body.model.stiffness.digits.significant as usize, digits);
            assert_eq!(n_rigid(&outcome), 6, "{digits} digits");
            let found = eigenvalues(&outcome);
            let errors = found.iter().zip(&exact).map(|(found, exact)| (found / exact - 1.0).abs());
            let shares: Vec<f64> = errors.zip(bars(&outcome)).map(|(error, bar)| bar / error).collect();
            // A mode may be right by chance; the least lucky one shows how far the bar is.
            let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
            assert!((1.0..=1000.0).contains(&least), "{digits} digits, {eigensolver}: bar over error {shares:?}");
            let largest = bars(&outcome).into_iter().fold(0.0, f64::max);
            assert_eq!(warnings(&outcome).contains(&"W-DATA-PRECISION"), 0.5 * largest > 1e-4, "{digits}: {largest:e}");
        }
    }
    // Sixteen digits are as good as binary.
    let outcome = Case::new(&rounded(&model, 16), &pins).clean();
    for ((found, exact), bar) in eigenvalues(&outcome).iter().zip(&exact).zip(bars(&outcome)) {
        assert!((found / exact - 1.0).abs() <= 2.0 * bar, "{found} for {exact}, bar {bar:e}");
    }
}

/// Every entry moved by a rounding: the pairs of a square beam may turn by any angle, and come out the same, because the
/// modes of a repeated eigenvalue are brought into the basis that their subspace defines.
#[test]
fn c_14_noise_in_the_last_bit_changes_no_mode() {
    let model = brick([8, 2, 2], [8.0, 2.0, 2.0], &Material::UNIT);
    let pins = [direct("pins", &[1, 9, 81])];
    let reference = chain::reduce(&model, &pins, chain::Method::Herting, 8).expect("a chain");
    let pairs = (1..reference.modes.count()).filter(|j| reference.modes.lambda[*j] == reference.modes.lambda[j - 1]);
    assert!(pairs.count() >= 2, "no pairs in {:?}", reference.modes.lambda);
    for seed in ["first", "second", "third"] {
        let found = chain::reduce(&noisy(&model, fnv1a(seed)), &pins, chain::Method::Herting, 8).expect("a chain");
        let (x, y) = (&reference.modes.shapes, &found.modes.shapes);
        assert_eq!(y.ncols(), x.ncols());
        let mass_x = product(&reference.partition.mass, x.as_ref());
        for j in 0..x.ncols() {
            let mac: f64 = (0..x.nrows()).map(|i| mass_x[(i, j)] * y[(i, j)]).sum();
            // Subspaces differ by ε κ, pivots of a half of the largest share by a few of these.
            assert!((mac - 1.0).abs() <= 1e-8, "{seed}: mode {} is turned, cosine {mac}", j + 1);
        }
        let difference = (&found.reduction.mass - &reference.reduction.mass).norm_max();
        assert!(difference <= 1e-8 * reference.reduction.mass.norm_max(), "{seed}: {difference:e}");
    }
}

/// Every entry times 1 ± ε, the same for (i, j) and (j, i).
fn noisy(model: &Model, seed: u64) -> Model {
    let noise = |entries: &[supel_models::model::Entry]| {
        let of = |i: u32, j: u32| {
            let bits = SplitMix64::new(seed ^ (u64::from(i.min(j)) << 32 | u64::from(i.max(j)))).next_u64();
            [1.0 - f64::EPSILON, 1.0, 1.0 + f64::EPSILON][(bits % 3) as usize]
        };
        entries.iter().map(|(i, j, value)| (*i, *j, value * of(*i, *j))).collect()
    };
    Model { stiffness: noise(&model.stiffness), mass: noise(&model.mass), ..model.clone() }
}
