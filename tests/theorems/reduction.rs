//! Sections 2.3.2 and 2.3.3: reduced matrices and floating frame.

use faer::{Mat, MatRef};

use crate::cases::{cases, for_each_method};
use crate::chain::{EPS, Method, absolute, against_bound, psi, reduce, terms};

/// Equation (25): UᵀMΨ = ÛᵀM̂, so the floating frame needs the rigid-body modes at the interface only.
#[test]
fn floating_frame_needs_only_the_interface() {
    for_each_method(|case, chain, twin| {
        let (u, psi, u_red) = (&chain.rigid.modes, psi(&chain.basis), &chain.reduction.rigid_body_modes);
        let expected = u.transpose() * &twin.m * &psi;
        let found = u_red.transpose() * &chain.reduction.mass;
        // Both products round, and by (24) Ψ Û stands for U in all of their terms.
        let carried = absolute(psi.as_ref()) * absolute(u_red.as_ref());
        let bound = terms(carried.as_ref(), &twin.m_terms, psi.as_ref()) * faer::Scale(rounding(twin.k.nrows()));
        let error = against_bound(found.as_ref(), expected.as_ref(), bound.as_ref());
        assert!(error <= 1.0, "{}: {error} of the bound", case.name);
    });
}

/// The mass properties of the full model are those of the reduced one: UᵀMU = ÛᵀM̂Û, the Hessian of (26).
#[test]
fn rigid_body_mass_is_kept() {
    for_each_method(|case, chain, twin| {
        let (u, u_red) = (&chain.rigid.modes, &chain.reduction.rigid_body_modes);
        let found = u_red.transpose() * &chain.reduction.mass * u_red;
        let expected = u.transpose() * &twin.m * u;
        let carried = absolute(psi(&chain.basis).as_ref()) * absolute(u_red.as_ref());
        let sizes = terms(carried.as_ref(), &twin.m_terms, carried.as_ref());
        let bound = sizes * faer::Scale(rounding(twin.k.nrows()));
        for found in [&found, &chain.reduction.rigid_body_mass] {
            let error = against_bound(found.as_ref(), expected.as_ref(), bound.as_ref());
            assert!(error <= 1.0, "{}: {error} of the bound", case.name);
        }
    });
}

/// Equation (29): K̂ = ΨᵀKΨ = diag(K_BB + K_BI Ψ_S, Ψ_DᵀK_IIΨ_D).
#[test]
fn reduced_stiffness_is_block_diagonal() {
    for_each_method(|case, chain, twin| {
        let psi = psi(&chain.basis);
        let n_b = chain.partition.n_interface();
        let found = &chain.reduction.stiffness;
        let n_eta = found.nrows() - n_b;
        let coupling = found.submatrix(0, n_b, n_b, n_eta);
        assert_eq!(coupling.norm_max(), 0.0, "{}", case.name);
        assert_eq!(found.submatrix(n_b, 0, n_eta, n_b).norm_max(), 0.0, "{}", case.name);
        let projected = psi.transpose() * &twin.k * &psi;
        // K_IB + K_II Ψ_S vanishes to the error of Ψ_S, which a backward stable solution holds to the size of its terms.
        let sizes = terms(psi.as_ref(), &twin.k_terms, psi.as_ref());
        let bound = sizes * faer::Scale(rounding(twin.k.nrows()));
        let error = against_bound(found.as_ref(), projected.as_ref(), bound.as_ref());
        assert!(error <= 1.0, "{}: {error} of the bound", case.name);
        let psi_s = -twin.solve(twin.k_ib());
        let condensed = twin.k_bb() + twin.k_ib().transpose() * &psi_s;
        let error = (found.submatrix(0, 0, n_b, n_b) - condensed).norm_max();
        let bound = twin.solve_error() * (absolute(twin.k_ib()).transpose() * absolute(psi_s.as_ref())).norm_max();
        assert!(error <= bound, "{}: K_BB + K_BI Ψ_S is off by {error:e}, bound {bound:e}", case.name);
    });
}

/// Equation (30): K̂ Û = 0, so elastic forces need no projection.
#[test]
fn reduced_stiffness_lets_rigid_body_motion_pass() {
    for_each_method(|case, chain, twin| {
        let u_red = &chain.reduction.rigid_body_modes;
        let forces = &chain.reduction.stiffness * u_red;
        let psi = psi(&chain.basis);
        let carried = absolute(psi.as_ref()) * absolute(u_red.as_ref());
        let sizes = terms(psi.as_ref(), &twin.k_terms, carried.as_ref());
        let bound = sizes * faer::Scale(rounding(twin.k.nrows()));
        let error = against_bound(forces.as_ref(), Mat::zeros(forces.nrows(), forces.ncols()).as_ref(), bound.as_ref());
        assert!(error <= 1.0, "{}: {error} of the bound", case.name);
    });
}

/// Equation (31): M̂ = ΨᵀMΨ, symmetric to the bit.
#[test]
fn reduced_mass_is_the_projected_mass() {
    for_each_method(|case, chain, twin| {
        let (psi, found) = (psi(&chain.basis), &chain.reduction.mass);
        let expected = psi.transpose() * &twin.m * &psi;
        let sizes = terms(psi.as_ref(), &twin.m_terms, psi.as_ref());
        let bound = sizes * faer::Scale(rounding(twin.k.nrows()));
        let error = against_bound(found.as_ref(), expected.as_ref(), bound.as_ref());
        assert!(error <= 1.0, "{}: {error} of the bound", case.name);
        assert!(is_symmetric(found.as_ref()) && is_symmetric(chain.reduction.stiffness.as_ref()), "{}", case.name);
    });
}

/// Weight against a unit field of gravity: ΨᵀM t for the three translations, of one free body only.
#[test]
fn gravity_is_the_projected_weight() {
    let mut n_with_gravity = 0;
    for case in cases() {
        let chain = reduce(&case.model, &case.interfaces, Method::Herting, 2).expect(case.name);
        let Some(gravity) = &chain.reduction.gravity else {
            continue;
        };
        n_with_gravity += 1;
        let unit = chain.partition.scaling.mass_unit();
        let u_red = &chain.reduction.rigid_body_modes;
        for axis in 0..3 {
            // The resultant along each axis is the total mass; n products of one sign.
            let resultant = (u_red.transpose() * gravity)[(axis, axis)] * unit;
            let mass = case.model.total_mass(axis);
            let error = (resultant - mass).abs() / mass;
            assert!(error <= 4.0 * rounding(case.model.n), "{}: {resultant:e} for {mass:e}", case.name);
        }
    }
    assert_eq!(n_with_gravity, 8, "free bodies with coordinates");
}

fn is_symmetric(a: MatRef<'_, f64>) -> bool {
    (0..a.nrows()).all(|i| (0..i).all(|j| a[(i, j)].to_bits() == a[(j, i)].to_bits()))
}

/// 4 n ε: two products of n terms on either side of a comparison.
fn rounding(n: usize) -> f64 {
    4.0 * n as f64 * EPS
}
