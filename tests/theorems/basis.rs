//! Section 2.3.1, 2.4 and 2.5: the mode-acceleration method and its two special cases.

use faer::{Mat, MatRef};
use supel::basis::DynamicCoordinate;
use supel_models::{Ends, spring};

use crate::cases::{for_each_case, for_each_method};
use crate::chain::{Chain, EPS, Method, Twin, absolute, column_difference, difference, direct, reduce};

/// Residual at which the eigensolver takes a pair; a mode shape may be wrong by this over the gap to its neighbours, which
/// is above a hundredth of the frequency in these models.
const MODE_ERROR: f64 = 1e-12 / 1e-2;

/// Equation (23), first half: Ψ_S = −K_II⁻¹ K_IB.
#[test]
fn constraint_modes_are_static_answers_to_unit_interface_displacements() {
    for_each_case(Method::CraigBampton, |case, chain, twin| {
        let expected = -twin.solve(twin.k_ib());
        let (error, bound) =
            (difference(chain.constraint.modes.to_columns().as_ref(), expected.as_ref()), twin.solve_error());
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
    });
}

/// Equation (24): Ψ_S U_B = U_I, to the rounding of the product whatever the condition of K_II.
#[test]
fn constraint_modes_reproduce_rigid_body_motion() {
    for_each_case(Method::CraigBampton, |case, chain, twin| {
        if case.n_rigid == 0 {
            return;
        }
        let (u_i, u_b) = chain.rigid.modes.as_ref().split_at_row(twin.n_i);
        let psi_s = chain.constraint.modes.to_columns();
        let psi_s = psi_s.as_ref();
        let carried = psi_s * u_b;
        let terms = absolute(psi_s) * absolute(u_b);
        // n_B products and sums, made once in the correction and once here.
        let bound = 4.0 * u_b.nrows() as f64 * EPS * terms.norm_max() / u_i.norm_max();
        let error = difference(carried.as_ref(), u_i);
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
        let (raw, bound) = (chain.constraint.raw_rigid_error, twin.solve_error());
        assert!(raw <= bound, "{}: {raw:e} before the correction, bound {bound:e}", case.name);
    });
}

/// Equation (37): both forms of the inertia-relief modes agree, and the first columns of Ψ_D are minus them.
#[test]
fn inertia_relief_modes_answer_rigid_body_accelerations() {
    for_each_case(Method::Herting, |case, chain, twin| {
        let (u_i, u_b) = chain.rigid.modes.as_ref().split_at_row(twin.n_i);
        let of_both = -twin.solve((twin.m_ib() * u_b + twin.m_ii() * u_i).as_ref());
        let psi_s = -twin.solve(twin.k_ib());
        let of_interface = -twin.solve(((twin.m_ib() + twin.m_ii() * &psi_s) * u_b).as_ref());
        let bound = twin.solve_error();
        let forms = column_difference(of_interface.as_ref(), of_both.as_ref());
        assert!(forms <= bound, "{}: the two forms differ by {forms:e}, bound {bound:e}", case.name);
        let found = chain.named.columns.as_ref().subcols(0, case.n_rigid);
        let error = column_difference(found, (-of_both).as_ref());
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
        let expected: Vec<_> = (0..case.n_rigid).map(DynamicCoordinate::InertiaRelief).collect();
        assert_eq!(chain.named.coordinates[..case.n_rigid], expected);
    });
}

/// Equation (23), second half, for free-free modes: K_II⁻¹ (M_IB X_B + M_II X_I) = ω⁻² (X_I − Ψ_S X_B), which is what
/// Herting's columns (36) hold.
#[test]
fn free_free_columns_are_mode_accelerated() {
    for_each_case(Method::Herting, |case, chain, twin| {
        let (x_i, x_b) = chain.modes.shapes.as_ref().split_at_row(twin.n_i);
        let accelerated = twin.solve((twin.m_ib() * x_b + twin.m_ii() * x_i).as_ref());
        let expected = times_lambda(accelerated.as_ref(), chain);
        let found = chain.named.columns.as_ref().subcols(case.n_rigid, chain.modes.count());
        // X_I − Ψ_S X_B may cancel: the bound is relative to the shapes, not to what is left.
        let error = (found - &expected).norm_max() / chain.modes.shapes.norm_max();
        let bound = twin.solve_error() + MODE_ERROR;
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
    });
}

/// Equation (38): the Craig-Bampton columns are the fixed-interface normal modes, K_II⁻¹ M_II V_I = V_I ω⁻².
#[test]
fn craig_bampton_columns_are_fixed_interface_normal_modes() {
    for_each_case(Method::CraigBampton, |case, chain, twin| {
        let v_i = chain.modes.shapes.as_ref();
        let expected = times_lambda(twin.solve((twin.m_ii() * v_i).as_ref()).as_ref(), chain);
        let error = column_difference(chain.named.columns.as_ref(), expected.as_ref());
        let bound = twin.solve_error() + MODE_ERROR;
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
    });
}

/// The dynamic modes span what was named: Ψ_D R gives every column back, with Ψ_DᵀM_IIΨ_D = I.
#[test]
fn dynamic_modes_give_the_named_columns_back() {
    for_each_method(|case, chain, twin| {
        assert!(chain.basis.dropped.is_empty(), "{}: {:?}", case.name, chain.basis.dropped);
        let psi_d = chain.basis.dynamic_modes.as_ref();
        let n_eta = psi_d.ncols();
        // Two passes of orthonormalisation: n_I products and n_η subtractions each.
        let bound = 4.0 * (twin.n_i + n_eta) as f64 * EPS;
        let back = psi_d * &chain.basis.mixing;
        let error = column_difference(back.as_ref(), chain.named.columns.as_ref());
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
        let products = psi_d.transpose() * twin.m_ii() * psi_d;
        let error = (products - Mat::<f64>::identity(n_eta, n_eta)).norm_max();
        assert!(error <= bound, "{}: ΨᵀMΨ is {error:e} off, bound {bound:e}", case.name);
    });
}

/// After (37): a mode that adds nothing to the rank of Ψ_D is left out, and named.
#[test]
fn dependent_columns_are_left_out_by_name() {
    // Four internal dofs cannot carry one inertia-relief mode and four elastic modes.
    let model = spring(5, Ends::Free);
    let chain = reduce(&model, &[direct("end", &[5])], Method::Herting, 4).expect("a free chain");
    assert_eq!((chain.named.columns.ncols(), chain.basis.n_dynamic()), (5, 4));
    let dropped: Vec<_> = chain.basis.dropped.iter().map(|column| column.coordinate).collect();
    assert_eq!(dropped, [DynamicCoordinate::FreeFree(3)]);
    assert!(chain.basis.dropped[0].remaining <= 1e-8, "{:?}", chain.basis.dropped);
    // With all four the reduced model is the full one, and its spectrum the chain's: n roundings of entries of order one.
    let found = crate::chain::spectrum(chain.reduction.stiffness.as_ref(), chain.reduction.mass.as_ref());
    let unit = chain.partition.scaling.eigenvalue_unit();
    for (found, exact) in found.iter().zip(supel_models::spring_spectrum(5, Ends::Free)) {
        assert!((found * unit - exact).abs() <= 100.0 * EPS * 4.0, "{found} for {exact}");
    }
}

fn times_lambda(columns: MatRef<'_, f64>, chain: &Chain) -> Mat<f64> {
    Mat::from_fn(columns.nrows(), columns.ncols(), |i, j| columns[(i, j)] * chain.modes.lambda[j])
}

/// A twin is the partition's congruence TᵀKT, computed without the library.
#[test]
fn partition_is_a_congruence_of_the_model() {
    for_each_case(Method::CraigBampton, |case, chain, twin: &Twin| {
        let n = case.model.n as f64;
        for (found, expected, terms) in
            [(&chain.partition.stiffness, &twin.k, &twin.k_terms), (&chain.partition.mass, &twin.m, &twin.m_terms)]
        {
            // At most n products a side, twice.
            let bound = terms * faer::Scale(2.0 * n * EPS);
            let found = crate::chain::dense(found);
            let error = crate::chain::against_bound(found.as_ref(), expected.as_ref(), bound.as_ref());
            assert!(error <= 1.0, "{}: {error} of the bound", case.name);
        }
    });
}
