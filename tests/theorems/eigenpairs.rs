//! Sections 2.1 and 2.3.4: the modes, and what of them the reduced model keeps.

use faer::Mat;
use supel_models::{Ends, spring, spring_spectrum};

use crate::cases::{N_MODES, for_each_case, for_each_method};
use crate::chain::{
    Chain, EPS, Method, Twin, against_bound, column_difference, direct, partition, psi, spectrum, terms,
};

/// Equation (4): the modes are the lowest elastic ones of the dense problem, none left out.
#[test]
fn elastic_modes_are_the_lowest() {
    for_each_case(Method::Herting, |case, chain, twin| {
        compare(case.name, chain, &chain.modes.lambda, &twin.free_spectrum()[case.n_rigid..]);
        assert!(chain.modes.count() >= N_MODES, "{}", case.name);
    });
    for_each_case(Method::CraigBampton, |case, chain, twin| {
        compare(case.name, chain, &chain.modes.lambda, &twin.clamped_spectrum());
        assert!(chain.modes.count() >= N_MODES, "{}", case.name);
    });
}

/// Equation (5): UᵀMX = 0.
#[test]
fn elastic_modes_are_orthogonal_to_rigid_body_modes() {
    for_each_case(Method::Herting, |case, chain, twin| {
        let (q, x) = (chain.rigid.orthonormal.as_ref(), chain.modes.shapes.as_ref());
        let products = q.transpose() * &twin.m * x;
        // The rounding of the products themselves, once for deflating and once here.
        let bound = terms(q, &twin.m_terms, x) * faer::Scale(2.0 * twin.k.nrows() as f64 * EPS);
        let error = against_bound(products.as_ref(), Mat::zeros(q.ncols(), x.ncols()).as_ref(), bound.as_ref());
        assert!(error <= 1.0, "{}: {error} of the bound", case.name);
    });
}

/// After (5): XᵀMX and XᵀKX are diagonal.
#[test]
fn elastic_modes_are_orthogonal_in_mass_and_stiffness() {
    for_each_case(Method::Herting, |case, chain, twin| {
        let (x, lambda) = (&chain.modes.shapes, &chain.modes.lambda);
        let (masses, energies) = (x.transpose() * &twin.m * x, x.transpose() * &twin.k * x);
        let n = twin.k.nrows() as f64;
        let sizes = terms(x.as_ref(), &twin.m_terms, x.as_ref());
        for j in 0..lambda.len() {
            for i in 0..j {
                // The eigensolver takes a pair at a residual of 1e-12 θ or 16 ε θ₁, where θ = 1/λ. Ten of them: where the
                // iteration has spanned all of a small model, its last directions are rounding and add to this.
                let residual = 10.0 * f64::max(1e-12, 16.0 * EPS * lambda[j] / lambda[0]);
                let (coupling, bound) = (masses[(i, j)].abs(), residual + n * EPS * sizes[(i, j)]);
                assert!(coupling <= bound, "{}: XᵀMX of {i} and {j} is {coupling:e}, bound {bound:e}", case.name);
                let coupling = energies[(i, j)].abs() / (lambda[i] * lambda[j]).sqrt();
                // K x = λ M x + r: what is left of XᵀMX enters in addition to the residual.
                let bound = 2.0 * residual * (lambda[j] / lambda[i]).sqrt() + n * (bar(chain, i) + bar(chain, j));
                assert!(coupling <= bound, "{}: XᵀKX of {i} and {j} is {coupling:e}, bound {bound:e}", case.name);
            }
        }
    });
}

/// Equation (35): Ψ V̄ = V, with V̄ of equation (34).
#[test]
fn retained_modes_expand_to_themselves() {
    for_each_method(|case, chain, twin| {
        let expanded = psi(&chain.basis) * chain.basis.reduced_modes(&chain.modes, twin.n_i);
        let shapes = &chain.modes.shapes;
        // Fixed-interface modes leave the interface at rest.
        let expected =
            Mat::from_fn(
                expanded.nrows(),
                shapes.ncols(),
                |i, j| {
                    if i < shapes.nrows() { shapes[(i, j)] } else { 0.0 }
                },
            );
        // X_I − Ψ_S X_B is made and undone: n_B products, and those of the orthogonalisation.
        let bound = 8.0 * (twin.n_i + chain.basis.n_reduced()) as f64 * EPS;
        let error = column_difference(expanded.as_ref(), expected.as_ref());
        assert!(error <= bound, "{}: {error:e}, bound {bound:e}", case.name);
    });
}

/// Equations (34) and (35), Herting: the free reduced model has the rigid-body modes and every retained frequency of the
/// full one, and no other frequency below its own of the full one.
#[test]
fn retained_eigenpairs_stay_exact() {
    for_each_case(Method::Herting, |case, chain, twin| {
        let reduced = spectrum(chain.reduction.stiffness.as_ref(), chain.reduction.mass.as_ref());
        let exact = twin.free_spectrum();
        let first = exact[case.n_rigid];
        for (k, zero) in reduced[..case.n_rigid].iter().enumerate() {
            let bound = bound(chain, 0, first);
            assert!(zero.abs() <= bound * first, "{}: zero mode {k} is {zero:e} of {first:e}", case.name);
        }
        compare(case.name, chain, &reduced[case.n_rigid..][..chain.modes.count()], &exact[case.n_rigid..]);
        for (k, (reduced, exact)) in reduced.iter().zip(&exact).enumerate().skip(case.n_rigid) {
            let bound = bound(chain, chain.modes.count() - 1, *exact);
            assert!(*reduced >= exact * (1.0 - bound), "{}: {k} is {reduced:e} below {exact:e}", case.name);
        }
    });
}

/// Equations (34) and (35), Craig-Bampton: the same with the interface held, the boundary condition of its modes.
#[test]
fn retained_fixed_interface_eigenpairs_stay_exact() {
    for_each_case(Method::CraigBampton, |case, chain, twin| {
        let n_b = chain.partition.n_interface();
        let n_eta = chain.basis.n_dynamic();
        let (k, m) = (&chain.reduction.stiffness, &chain.reduction.mass);
        let held = spectrum(k.submatrix(n_b, n_b, n_eta, n_eta), m.submatrix(n_b, n_b, n_eta, n_eta));
        assert_eq!(held.len(), chain.modes.count(), "{}", case.name);
        compare(case.name, chain, &held, &twin.clamped_spectrum());
    });
}

/// Rounding of the data of mode `i`, from the terms that its energy is summed from.
fn bar(chain: &Chain, i: usize) -> f64 {
    chain.modes.errors[i].relative_bar
}

/// Relative error that rounding may make in an eigenvalue near λ: n times that of the terms the energy of mode `i` is
/// summed from, and that of the dense oracle, ε (λ + s)²/(s λ) with its shift s at the first elastic eigenvalue.
fn bound(chain: &Chain, i: usize, lambda: f64) -> f64 {
    let s = chain.modes.lambda[0].min(lambda);
    let n = chain.partition.n_dofs() as f64;
    n * (bar(chain, i) + EPS * (lambda + s).powi(2) / (s * lambda))
}

fn compare(name: &str, chain: &Chain, found: &[f64], exact: &[f64]) {
    for (k, (found, exact)) in found.iter().zip(exact).enumerate() {
        let (error, bound) = ((found - exact).abs() / exact, bound(chain, k, *exact));
        assert!(error <= bound, "{name}: mode {k} is {found:e} for {exact:e}, off {error:e}, bound {bound:e}");
        // A bound that allows a thousandth would not tell one mode from another.
        assert!(bound < 1e-6, "{name}: mode {k} has the bound {bound:e}");
    }
}

/// The oracle agrees with a spectrum known in closed form, zero mode included.
#[test]
fn dense_oracle_is_exact() {
    let model = spring(12, Ends::Free);
    let interfaces = [direct("end", &[1])];
    let partition = partition(&model, &interfaces).expect("a chain");
    let twin = Twin::new(&model, &interfaces, &partition);
    let (found, exact) = (twin.free_spectrum(), spring_spectrum(12, Ends::Free));
    let s = exact[1];
    assert_eq!(found.len(), exact.len());
    for (found, exact) in found.iter().zip(&exact) {
        let error = (found * partition.scaling.eigenvalue_unit() - exact).abs();
        assert!(error <= 12.0 * EPS * (exact + s).powi(2) / s, "{found:e} for {exact:e}");
    }
}
