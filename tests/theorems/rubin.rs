//! Section 2.6: Rubin's attachment modes, the space they share with Herting's, and the maps between both.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef};
use supel::job::{ModeSelection, ReductionJob};
use supel::modes::Retained;
use supel::rubin::{Rubin, rubin_where_asked};

use crate::cases::{N_MODES, for_each_case, solid, tied};
use crate::chain::{Chain, EPS, Method, Twin, absolute, direct, psi, reduce, terms};

fn rubin(chain: &Chain) -> Rubin {
    let job = ReductionJob::new(Method::Rubin, ModeSelection::Count { count: N_MODES });
    let retained = Retained::of(chain.modes.clone(), Method::Rubin.boundary());
    let found = rubin_where_asked(&job, &chain.basis, &chain.reduction, &retained);
    found.expect("an interior that deforms").expect("an interface")
}

/// [A_B A_I] in the order of the twin: static answers to forces at the interface, (40), from the bordered system of section 2.3 of
/// the notes on the paper, [K MU; UᵀM 0].
pub(super) fn attachment_modes(twin: &Twin, u: MatRef<'_, f64>) -> Mat<f64> {
    let (n, n_r, n_b) = (twin.k.nrows(), u.ncols(), twin.k.nrows() - twin.n_i);
    let momenta = &twin.m * u;
    let mut bordered = Mat::zeros(n + n_r, n + n_r);
    bordered.as_mut().submatrix_mut(0, 0, n, n).copy_from(&twin.k);
    bordered.as_mut().submatrix_mut(0, n, n, n_r).copy_from(&momenta);
    bordered.as_mut().submatrix_mut(n, 0, n_r, n).copy_from(momenta.transpose());
    let mut loads = Mat::zeros(n + n_r, n_b);
    (0..n_b).for_each(|j| loads[(twin.n_i + j, j)] = 1.0);
    let answers = bordered.partial_piv_lu().solve(loads);
    answers.as_ref().subrows(0, n).to_owned()
}

pub(super) fn condition(a: MatRef<'_, f64>) -> f64 {
    let values = a.singular_values().expect("finite");
    values[0] / values[values.len() - 1]
}

/// Equations (40), (41) and (49): Ψ_R = A_I A_B⁻¹, without A_B.
#[test]
fn static_modes_are_those_of_the_attachment_modes() {
    for_each_case(Method::Rubin, |case, chain, twin| {
        let (rubin, n_i) = (rubin(chain), twin.n_i);
        let a = attachment_modes(twin, chain.rigid.modes.as_ref());
        let (a_i, a_b) = a.as_ref().split_at_row(n_i);
        let expected = a_b.transpose().partial_piv_lu().solve(a_i.transpose()).transpose().to_owned();
        let n_b = a_b.ncols();
        let found = psi(&chain.basis) * rubin.columns.as_ref().subcols(0, n_b);
        let error = (found.as_ref().subrows(0, n_i) - &expected).norm_max() / expected.norm_max();
        // The reference loses the digits of A_B, which this way does not; units of rotations take part in its condition.
        let bound = twin.solve_error() + twin.k.nrows() as f64 * EPS * condition(a_b);
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
        // A bound that lets anything pass would prove nothing.
        assert!(bound < 1e-3, "{}: {bound:e}", case.name);
    });
}

/// Equation (50) and the map (51): [u_B; η; u_F] and T of it move the component alike, there and back.
#[test]
fn both_coordinates_describe_the_same_motions() {
    for_each_case(Method::Rubin, |case, chain, twin| {
        let rubin = rubin(chain);
        let (n_b, k, n_r) = (rubin.n_interface(), chain.modes.count(), rubin.n_rigid());
        let (psi, u) = (psi(&chain.basis), chain.rigid.modes.as_ref());
        let statics = &psi * rubin.columns.as_ref().subcols(0, n_b);
        // (43): the deformation of the interface is what the floating frame leaves of its displacement.
        let frame = u - &statics * u.subrows(twin.n_i, n_b);
        let x_b = chain.modes.shapes.as_ref().subrows(twin.n_i, n_b);
        let dynamics = &chain.modes.shapes - &statics * x_b;
        let to = rubin.to_herting();
        for (what, expected, found) in [
            ("u_B", statics.as_ref(), to.as_ref().subcols(0, n_b)),
            ("η", dynamics.as_ref(), to.as_ref().subcols(n_b, k)),
            ("u_F", frame.as_ref(), to.as_ref().subcols(n_b + k, n_r)),
        ] {
            let moved = &psi * found;
            let sizes = absolute(psi.as_ref()) * absolute(found);
            let error = (&moved - expected).norm_max();
            // Modes are eigenvectors to 1e-12 over their gaps, which are above a hundredth.
            let bound = (twin.solve_error() + 1e-10) * sizes.norm_max().max(1e-300);
            assert!(error <= bound, "{}, {what}: {error:e}, bound {bound:e}", case.name);
        }
        let Some(from) = rubin.from_herting() else {
            assert!(!chain.basis.dropped.is_empty(), "{}: nothing was left out", case.name);
            return;
        };
        let identity = &to * &from;
        // In rows and columns of one length the inverse is off by n ε κ, with room for the growth of the elimination.
        let n = to.nrows();
        let lengths: Vec<f64> = (0..n).map(|k| to.col(k).norm_l2()).collect();
        let rows: Vec<f64> =
            (0..n).map(|i| (0..n).map(|k| (to[(i, k)] / lengths[k]).abs()).fold(0.0, f64::max)).collect();
        let scaled = Mat::from_fn(n, n, |i, k| to[(i, k)] / (lengths[k] * rows[i]));
        let bound = 10.0 * n as f64 * EPS * condition(scaled.as_ref());
        assert!(bound < 1e-4, "{}: {bound:e}", case.name);
        for i in 0..n {
            for j in 0..n {
                let error = (identity[(i, j)] - f64::from(u8::from(i == j))).abs() * rows[j] / rows[i];
                assert!(error <= bound, "{}: {error:e} at {i}, {j}, bound {bound:e}", case.name);
            }
        }
    });
}

/// Equations (45) and (47): Rubin's matrices are those of the file in other coordinates.
#[test]
fn matrices_are_those_of_the_file_in_other_coordinates() {
    for_each_case(Method::Rubin, |case, chain, _| {
        let rubin = rubin(chain);
        let to = rubin.to_herting();
        for (what, of_file, found) in
            [("K", &chain.reduction.stiffness, rubin.stiffness()), ("M", &chain.reduction.mass, rubin.mass())]
        {
            let expected = to.transpose() * of_file * &to;
            let bound = terms(to.as_ref(), &absolute(of_file.as_ref()), to.as_ref());
            let n = to.nrows() as f64;
            for i in 0..found.nrows() {
                for j in 0..found.ncols() {
                    let error = (found[(i, j)] - expected[(i, j)]).abs();
                    // (47) leaves out UᵀMΨ_R, which vanishes to 1e-12 of its terms (M-22), and (45) K̂Û.
                    let limit = (1e2 * n * EPS + 1e-11) * bound[(i, j)];
                    assert!(error <= limit, "{}, {what}: {error:e} at {i}, {j}, limit {limit:e}", case.name);
                }
            }
        }
    });
}

/// Interface nodes tied by a spring that is c times as stiff as the component: A_B has a condition of 400 c, and what is found
/// without it stays orthogonal to rigid-body motion to rounding.
#[test]
fn c_07_tied_interface_nodes_cost_no_digits() {
    for contrast in [1.0, 1e4, 1e8, 1e12] {
        let model = tied(solid(), [1, 5], contrast);
        let interfaces = [direct("pins", &[1, 5, 15, 45])];
        let chain = reduce(&model, &interfaces, Method::Rubin, N_MODES).expect("reduced");
        let twin = Twin::new(&model, &interfaces, &chain.partition);
        let statics = psi(&chain.basis) * rubin(&chain).columns.as_ref().subcols(0, 12);
        let left = chain.rigid.mass_orthonormal.transpose() * &statics;
        let momenta = &twin.m * &statics;
        for j in 0..12 {
            let length = (statics.col(j).transpose() * momenta.col(j)).sqrt();
            let error = left.col(j).norm_l2() / length;
            assert!(error <= 1e-12, "contrast {contrast:e}: {error:e}");
        }
    }
}
