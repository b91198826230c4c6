//! Section 2.1 and 2.2: rigid-body modes, floating frame, projectors.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};
use supel::rigid::RigidSource;

use crate::cases::{cases, for_each_case};
use crate::chain::{Chain, EPS, Method, Twin, absolute, against_bound, difference, rigid_of};

/// Equation (2): the rigid-body modes of one free body are the unit motions about the origin, at every row of the
/// model.
#[test]
fn rigid_body_modes_are_unit_motions() {
    let mut n_classical = 0;
    // A mechanism is found by the stage of the constraint modes.
    for case in cases().into_iter().filter(|case| !case.name.contains("hinge")) {
        let (partition, rigid) = rigid_of(&case.model, &case.interfaces).expect(case.name);
        assert_eq!(rigid.count(), case.n_rigid, "{}", case.name);
        if !rigid.is_classical {
            continue;
        }
        n_classical += 1;
        let t = Twin::new(&case.model, &case.interfaces, &partition).transformation;
        let unit_motions = case.model.rigid_body_modes();
        let expected = Mat::from_fn(case.model.n, 6, |i, j| unit_motions[j][i]);
        // A row of T has at most six entries; the mean of a patch has as many roundings as nodes, below ten.
        let bound = absolute(t.as_ref()) * absolute(rigid.modes.as_ref()) * faer::Scale(32.0 * EPS);
        let error = against_bound((&t * &rigid.modes).as_ref(), expected.as_ref(), bound.as_ref());
        assert!(error <= 1.0, "{}: {error} of the bound", case.name);
    }
    assert_eq!(n_classical, 7, "bodies with six geometric rigid-body modes");
}

/// Equation (3): K U = 0.
#[test]
fn rigid_body_motion_meets_no_elastic_force() {
    for_each_case(Method::CraigBampton, |case, chain, twin| {
        let forces = &twin.k * &chain.rigid.modes;
        let terms = &twin.k_terms * absolute(chain.rigid.modes.as_ref());
        for j in 0..case.n_rigid {
            // A row sums up to 81 terms, each an element entry with some twenty roundings of its own. Without coordinates
            // the mode is an eigenvector taken at a residual of 16 ε in θ, which K − σM turns into that share of its terms.
            let residual = if chain.rigid.source == RigidSource::Algebraic { 16.0 } else { 0.0 };
            let bound = (100.0 + 2.0 * residual) * EPS * terms.col(j).norm_max();
            let force = forces.col(j).norm_max();
            assert!(force <= bound, "{}: mode {j} meets {force:e}, bound {bound:e}", case.name);
        }
    });
}

/// Equations (13) to (15): the space that the solver deflates is that of the projector P∥ = U (UᵀMU)⁻¹ UᵀM, and what
/// P⊥ leaves of any displacement is free of rigid-body momentum.
#[test]
fn floating_frame_takes_all_rigid_body_momentum() {
    for_each_case(Method::CraigBampton, |case, chain, twin| {
        if case.n_rigid == 0 {
            return;
        }
        let expected = projector(chain.rigid.modes.as_ref(), twin.m.as_ref());
        let n = twin.k.nrows();
        let found = &chain.rigid.orthonormal * chain.rigid.mass_orthonormal.transpose();
        // Solving with UᵀMU loses its condition; so does making U orthonormal.
        let tolerance = n as f64 * EPS * momentum_condition(chain, twin);
        let error = difference(found.as_ref(), expected.as_ref());
        assert!(error <= tolerance, "{}: projectors differ by {error:e}, bound {tolerance:e}", case.name);
        let squared = difference((&found * &found).as_ref(), found.as_ref());
        assert!(squared <= tolerance, "{}: P² and P differ by {squared:e}, bound {tolerance:e}", case.name);
        let kept = difference((&found * &chain.rigid.modes).as_ref(), chain.rigid.modes.as_ref());
        assert!(kept <= tolerance, "{}: P U and U differ by {kept:e}, bound {tolerance:e}", case.name);
        let displacement = Mat::from_fn(n, 3, |i, j| (((i + 1) * (7 * j + 3)) as f64).sin());
        let deformation = &displacement - &found * &displacement;
        let momentum = chain.rigid.modes.transpose() * &twin.m * &deformation;
        let terms = absolute(chain.rigid.modes.as_ref()).transpose() * &twin.m_terms * absolute(displacement.as_ref());
        let left = momentum.norm_max() / terms.norm_max();
        assert!(left <= tolerance, "{}: momentum {left:e} is left, bound {tolerance:e}", case.name);
    });
}

/// The modes found without coordinates span the unit motions that coordinates give.
#[test]
fn matrices_alone_give_the_same_rigid_body_space() {
    let case = |name: &str| cases().into_iter().find(|case| case.name == name).expect("a case");
    let with = case("free solid, nodes");
    let without = case("free solid without coordinates");
    let (anonymous, rigid) = rigid_of(&without.model, &without.interfaces).expect("free");
    assert_eq!((rigid.source, rigid.count()), (RigidSource::Algebraic, 6));
    let (partition, geometric) = rigid_of(&with.model, &without.interfaces).expect("free");
    assert_eq!((geometric.source, geometric.count()), (RigidSource::Geometric, 6));
    // The two partitions eliminate in orders of their own; the model's rows are common to both.
    let in_rows = |t: &Mat<f64>, p: Mat<f64>| t * p * t.transpose();
    let t = Twin::new(&without.model, &without.interfaces, &anonymous).transformation;
    let by_matrices = in_rows(&t, &rigid.orthonormal * rigid.mass_orthonormal.transpose());
    let twin = Twin::new(&with.model, &without.interfaces, &partition);
    let by_coordinates = in_rows(&twin.transformation, projector(geometric.modes.as_ref(), twin.m.as_ref()));
    // The eigensolver leaves 1e-12 of a residual relative to the gap between zero and the first elastic mode.
    let error = difference(by_matrices.as_ref(), by_coordinates.as_ref());
    assert!(error <= 1e-11, "{error:e}");
}

/// U (UᵀMU)⁻¹ UᵀM.
fn projector(u: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Mat<f64> {
    let momenta = u.transpose() * m;
    let m_f = &momenta * u;
    u * m_f.llt(Side::Lower).expect("rigid-body modes with mass").solve(&momenta)
}

/// Condition of UᵀMU with unit diagonal.
fn momentum_condition(chain: &Chain, twin: &Twin) -> f64 {
    let m_f = chain.rigid.modes.transpose() * &twin.m * &chain.rigid.modes;
    let n = m_f.nrows();
    let scaled = Mat::from_fn(n, n, |i, j| m_f[(i, j)] / (m_f[(i, i)] * m_f[(j, j)]).sqrt());
    let eigenvalues = scaled.self_adjoint_eigenvalues(Side::Lower).expect("a finite matrix");
    eigenvalues[n - 1] / eigenvalues[0]
}
