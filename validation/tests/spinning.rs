//! Vibration of a spinning beam by the tangents of its components: what is exact, and what a component leaves out.

use faer::{Mat, Side};
use supel_runtime::Superelement;
use validation::spinning::{Spinning, Stiffness, parts};

fn beam(n_components: usize, n_modes: usize) -> Vec<Superelement> {
    parts(n_components, n_modes, tempfile::tempdir().expect("folder").path()).expect("verified")
}

fn frequencies(parts: &[Superelement], spin: f64, stiffness: Stiffness) -> Vec<f64> {
    let mut spinning = Spinning::new(parts, spin).expect("a steady state");
    let mut found = spinning.frequencies(stiffness).expect("eigenvalues");
    found.truncate(6);
    found
}

/// In turn along and across the plane of rotation.
fn across(found: &[f64]) -> [f64; 2] {
    [found[1], found[3]]
}

fn along(found: &[f64]) -> [f64; 2] {
    [found[0], found[2]]
}

/// The exact tangents are those of the component's own forces; the paper's hardly see the rotation.
#[test]
fn exact_tangents_give_the_frequencies_of_the_forces_and_the_papers_do_not() {
    for (n_components, n_modes) in [(1_u8, 0), (1, 4), (2, 4)] {
        let parts = beam(n_components.into(), n_modes);
        for spin in [2.0, 6.0, 12.0] {
            let [exact, differences, papers] = [Stiffness::Exact, Stiffness::Differences, Stiffness::Papers]
                .map(|stiffness| frequencies(&parts, spin, stiffness));
            println!("{n_components}, {n_modes}, {spin}: {exact:.5?} {differences:.5?} {papers:.5?}");
            for (found, expected) in exact.iter().zip(&differences).take(4) {
                // Forces of the size of EA/l = 1e5 n times the displacements are rounded at ten times 1e-16 of the beam's length;
                // over steps of 1e-4 and modal masses of a twentieth that is so much of the square of a frequency.
                let limit = 10.0 * 1e-16 * 1e5 * f64::from(n_components) / 1e-4 * 20.0;
                assert!((found * found - expected * expected).abs() < limit, "{exact:?} {differences:?}");
            }
            // K_T leaves the frequency of the beam at rest, 3.516, for one of at least Ω across the plane.
            assert!((papers[1] - 3.52).abs() < 0.02 && exact[1] > spin, "{papers:?}");
        }
    }
}

/// Frequencies across the plane of a spinning beam, Hodges and Rutkowski, AIAA Journal 19 (1981), 1459, and Wright et al., Journal of
/// Applied Mechanics 49 (1982), 197: without hub, Euler-Bernoulli.
const PUBLISHED: [(f64, [f64; 2]); 4] =
    [(0.0, [3.5160, 22.0345]), (2.0, [4.1373, 22.6149]), (6.0, [7.3604, 26.8091]), (12.0, [13.1702, 37.6031])];

/// The full finite element model with stress stiffening: Hermite elements under the centrifugal force Ω² (1 − x²)/2.
fn stiffened(spin: f64) -> [f64; 2] {
    const N: usize = 64;
    let l = 1.0 / N as f64;
    let (mut k, mut m) = (Mat::<f64>::zeros(2 * N + 2, 2 * N + 2), Mat::<f64>::zeros(2 * N + 2, 2 * N + 2));
    // Gauss-Legendre, four points: products of cubics and their derivatives with a parabola have degree six.
    let points =
        [(0.861_136_311_594_052_6, 0.347_854_845_137_453_85), (0.339_981_043_584_856_26, 0.652_145_154_862_546_1)];
    for e in 0..N {
        for (x, weight) in
            points.into_iter().flat_map(|(x, w)| [(0.5 + 0.5 * x, 0.5 * w * l), (0.5 - 0.5 * x, 0.5 * w * l)])
        {
            let place = (e as f64 + x) * l;
            let tension = 0.5 * spin * spin * (1.0 - place * place);
            let shift = [
                1.0 - 3.0 * x * x + 2.0 * x * x * x,
                l * x * (1.0 - x) * (1.0 - x),
                x * x * (3.0 - 2.0 * x),
                l * x * x * (x - 1.0),
            ];
            let slope =
                [6.0 * x * (x - 1.0) / l, 1.0 - 4.0 * x + 3.0 * x * x, 6.0 * x * (1.0 - x) / l, x * (3.0 * x - 2.0)];
            let bend = [(12.0 * x - 6.0) / l / l, (6.0 * x - 4.0) / l, (6.0 - 12.0 * x) / l / l, (6.0 * x - 2.0) / l];
            for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
                k[(2 * e + i, 2 * e + j)] += weight * (bend[i] * bend[j] + tension * slope[i] * slope[j]);
                m[(2 * e + i, 2 * e + j)] += weight * shift[i] * shift[j];
            }
        }
    }
    let free = 2 * N;
    let (k, m) = (k.submatrix(2, 2, free, free), m.submatrix(2, 2, free, free));
    // 1/ω² are the largest eigenvalues of K⁻¹M, in the form L⁻¹ M L⁻ᵀ.
    let factor = k.llt(Side::Lower).expect("definite");
    let mut half = m.to_owned();
    factor.L().solve_lower_triangular_in_place(&mut half);
    let mut whole = half.transpose().to_owned();
    factor.L().solve_lower_triangular_in_place(&mut whole);
    let values = Mat::from_fn(free, free, |i, j| 0.5 * (whole[(i, j)] + whole[(j, i)]));
    let values = values.self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
    [free - 1, free - 2].map(|i| values[i].sqrt().recip())
}

#[test]
fn full_model_has_the_published_frequencies() {
    for (spin, expected) in PUBLISHED {
        let found = stiffened(spin);
        println!("{spin}: {found:?}");
        // Five digits are printed; 64 elements are right to (k l)⁴/720 = 1e-8.
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 6e-5),
            "{spin}: {found:?}"
        );
    }
}

/// Without stress stiffening inside it, one component has the second frequency of a fast beam wrong; several find it between them.
#[test]
fn stress_stiffening_is_found_between_components_and_not_inside() {
    let mut rows = String::new();
    for spin in [2.0, 6.0, 12.0] {
        let expected = stiffened(spin);
        let in_plane = expected.map(|omega| (omega * omega - spin * spin).sqrt());
        let mut row = format!("| {spin} | {:.2}, {:.2} |", expected[0], expected[1]);
        let mut errors = Vec::new();
        for n_components in [1, 2, 4] {
            let found = frequencies(&beam(n_components, 4), spin, Stiffness::Exact);
            let [first, second] = across(&found);
            row += &format!(" {first:.2}, {second:.2} |");
            let pairs = across(&found).into_iter().zip(expected).chain(along(&found).into_iter().zip(in_plane));
            errors.push(pairs.map(|(found, expected)| (found / expected - 1.0).abs()).collect::<Vec<_>>());
        }
        println!("{row} {errors:.5?}");
        rows += &(row + "\n");
        // Two halvings of the components leave a sixteenth at most, as errors of the second order do.
        for i in 0..4 {
            // Shear and rotary inertia, which the published beam has not, take (EI/GA + j) k²/2 of the second frequency, k = 4.7.
            let floor = 2.0 * (1.0 / 4e4 + 1e-5) * 4.7_f64.powi(2) / 2.0;
            assert!(errors[2][i] < errors[0][i] / 16.0 + floor, "{errors:?}");
        }
    }
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).expect("README");
    for row in rows.lines() {
        assert!(readme.lines().any(|line| line == row), "README.md lacks the row\n{row}");
    }
}
