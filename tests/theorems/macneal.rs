//! MacNeal's method: the textbook's residual flexibility, in the coordinates of the file.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Scale};

use crate::cases::{Case, N_MODES, for_each_case};
use crate::chain::{Chain, EPS, Method, Twin, difference, reduce};
use crate::rubin::{attachment_modes, condition};

/// The flexibility at the interface of MacNeal's component at λ = z, n_B × n_B, from the full model:
///
/// ```text
/// H(z) = −U_B M_F⁻¹ U_Bᵀ / z + Φ_B diag(1/(λ − z)) Φ_Bᵀ + (G_BB − Φ_B Λ⁻¹ Φ_Bᵀ)
/// ```
/// with the residual flexibility in brackets, G_BB the elastic flexibility of the free component.
fn textbook(chain: &Chain, twin: &Twin, z: f64) -> Mat<f64> {
    let n_b = twin.k.nrows() - twin.n_i;
    let u = &chain.rigid.modes;
    let u_b = u.as_ref().subrows(twin.n_i, n_b);
    let flexibility = attachment_modes(twin, u.as_ref()).as_ref().subrows(twin.n_i, n_b).to_owned();
    let phi = chain.modes.shapes.as_ref().subrows(twin.n_i, n_b);
    let weighted =
        |of: &dyn Fn(f64) -> f64| Mat::from_fn(n_b, phi.ncols(), |i, j| phi[(i, j)] * of(chain.modes.lambda[j]));
    let modal = weighted(&|lambda| 1.0 / (lambda - z)) * phi.transpose();
    let static_part = weighted(&|lambda| 1.0 / lambda) * phi.transpose();
    let residual = flexibility - static_part;
    if u.ncols() == 0 {
        return modal + residual;
    }
    let m_f = u.transpose() * &twin.m * u;
    let rigid = u_b * m_f.partial_piv_lu().solve(u_b.transpose());
    modal + residual - rigid * Scale(1.0 / z)
}

/// The block of the interface of (K̂ − zM̂)⁻¹, and the condition of what is inverted, with unit diagonal of K̂ + zM̂.
fn reduced(chain: &Chain, mass: MatRef<'_, f64>, z: f64, n_b: usize) -> (Mat<f64>, f64) {
    let (k, r) = (&chain.reduction.stiffness, chain.reduction.n_reduced());
    let d: Vec<f64> = (0..r).map(|i| (k[(i, i)] + z * chain.reduction.mass[(i, i)]).sqrt().recip()).collect();
    let dynamic = Mat::from_fn(r, r, |i, j| (k[(i, j)] - z * mass[(i, j)]) * d[i] * d[j]);
    let inverse = dynamic.partial_piv_lu().solve(Mat::<f64>::identity(r, r));
    (Mat::from_fn(n_b, n_b, |i, j| inverse[(i, j)] * d[i] * d[j]), condition(dynamic.as_ref()))
}

/// The condition of the elastic flexibility: that of [K MU; UᵀM 0] with unit diagonal of K.
fn condition_of_flexibility(twin: &Twin, u: MatRef<'_, f64>) -> f64 {
    let n = twin.k.nrows();
    let d: Vec<f64> = (0..n).map(|i| twin.k[(i, i)].sqrt().recip()).collect();
    let momenta = &twin.m * u;
    let scaled = Mat::from_fn(n, u.ncols(), |i, j| momenta[(i, j)] * d[i]);
    let lengths: Vec<f64> = scaled.col_iter().map(|column| column.norm_l2()).collect();
    let bordered = Mat::from_fn(n + u.ncols(), n + u.ncols(), |i, j| match (i < n, j < n) {
        (true, true) => twin.k[(i, j)] * d[i] * d[j],
        (true, false) => scaled[(i, j - n)] / lengths[j - n],
        (false, true) => scaled[(j, i - n)] / lengths[i - n],
        (false, false) => 0.0,
    });
    condition(bordered.as_ref())
}

/// Below the first mode, between two, and beyond all of them.
fn places(lambda: &[f64]) -> [f64; 3] {
    [0.3 * lambda[0], 0.5 * (lambda[2] + lambda[3]), 2.5 * lambda[lambda.len() - 1]]
}

fn check(case: &Case, chain: &Chain, twin: &Twin) {
    let n_b = twin.k.nrows() - twin.n_i;
    let n = twin.k.nrows() as f64;
    let of_full = condition_of_flexibility(twin, chain.rigid.modes.as_ref()) + twin.solve_error() / (n * EPS);
    for z in places(&chain.modes.lambda) {
        let expected = textbook(chain, twin, z);
        let (found, of_reduced) = reduced(chain, chain.reduction.mass.as_ref(), z, n_b);
        let error = difference(found.as_ref(), expected.as_ref());
        // Each of the two systems loses n ε of its condition (Higham 2002, theorem 7.2).
        let bound = n * EPS * (of_full + of_reduced);
        assert!(error <= bound, "{}, λ = {z:e}: {error:e}, bound {bound:e}", case.name);
        assert!(bound < 1e-3, "{}: {bound:e}", case.name);
    }
}

/// The response at the interface is that of the textbook at any frequency: with the modes, the rigid-body motions and the residual
/// flexibility of the full model.
#[test]
fn interface_response_is_that_of_the_residual_flexibility() {
    for_each_case(Method::Macneal, check);
}

/// Rank, rigid-body inertia and momenta of the retained modes of M̂, and Herting's K̂ to the bit.
#[test]
fn mass_sees_the_modes_and_rigid_body_motion_alone() {
    for_each_case(Method::Macneal, |case, chain, twin| {
        let herting = reduce(&case.model, &case.interfaces, Method::Herting, N_MODES).expect("reduced");
        let (found, whole) = (&chain.reduction, &herting.reduction);
        assert!(found.stiffness == whole.stiffness, "{}: the static answers are Herting's", case.name);
        let r = found.n_reduced();
        let rank = case.n_rigid + N_MODES;
        assert_eq!(found.mass_rank(), (rank < r).then_some(rank), "{}", case.name);
        let d: Vec<f64> = (0..r).map(|i| whole.mass[(i, i)].sqrt().recip()).collect();
        let scaled = |a: &Mat<f64>| Mat::from_fn(r, r, |i, j| a[(i, j)] * d[i] * d[j]);
        let values = scaled(&found.mass).self_adjoint_eigenvalues(faer::Side::Lower).expect("numbers");
        // The diagonal of M̂ is at most that of Herting's, one: sums of r products of entries below one.
        let rounding = 10.0 * (r as f64) * EPS;
        assert!(values[..r - rank].iter().all(|value| value.abs() <= rounding), "{}: {values:?}", case.name);
        let modes = chain.basis.reduced_modes(&chain.modes, twin.n_i);
        for motions in [&found.rigid_body_modes, &modes] {
            let (own, of_whole) = (&found.mass * motions, &whole.mass * motions);
            let size = Mat::from_fn(r, motions.ncols(), |i, j| of_whole[(i, j)] * d[i]).norm_max();
            let off = Mat::from_fn(r, motions.ncols(), |i, j| (own[(i, j)] - of_whole[(i, j)]) * d[i]).norm_max();
            let amplified = condition(scaled(&whole.mass).as_ref());
            assert!(off <= r as f64 * EPS * amplified.max(10.0) * size.max(1.0), "{}: {off:e}", case.name);
        }
        // What is left out is energy of motion: Herting's mass is larger in every motion.
        let left_out = scaled(&whole.mass) - scaled(&found.mass);
        let values = left_out.self_adjoint_eigenvalues(faer::Side::Lower).expect("numbers");
        assert!(values[0] >= -rounding, "{}: {:e}", case.name, values[0]);
        assert!(values[r - 1] > 1e-6, "{}: nothing was left out", case.name);
    });
}
