//! The checker is checked: each fault is put into sound evidence and seen by the checks that must see it, and by no other.

use supel::basis::Basis;
use supel::constraint::ConstraintModes;
use supel::job::{Boundary, Expectation, Method};
use supel::modes::{Certificate, CountedInterval, Mending, Retained};
use supel::reduction::Reduction;
use supel::rigid::RigidBodyModes;
use supel::verification::Evidence;
use supel::verification::check::Verdict;
use supel_models::{Material, Model, brick};

use crate::chain::direct;
use crate::evidence::{checks, complaints, line, with_model};

fn model() -> Model {
    brick([6, 2, 2], [6.0, 1.1, 0.9], &Material::UNIT)
}

/// Evidence that can be broken.
struct Parts<'a> {
    retained: Retained,
    basis: Basis<'a>,
    reduction: Reduction,
    rigid: RigidBodyModes,
    constraint: ConstraintModes<'a>,
    n_i: usize,
}

impl Parts<'_> {
    /// Ψ_S of the basis.
    fn static_modes(&mut self) -> &mut faer::Mat<f64> {
        self.basis.constraint_modes.stored_mut().expect("stored")
    }
}

/// Breaks the evidence of a sound model and returns the identifiers of the checks that complain.
#[track_caller]
fn found(method: Method, fault: impl FnOnce(&mut Parts<'_>)) -> Vec<&'static str> {
    with_model(&model(), &[direct("ends", &[1, 8, 22, 14])], (method, 5), |evidence| {
        assert_eq!(complaints(&checks(&evidence)), [], "the sound model");
        let mut parts = Parts {
            retained: evidence.retained.clone(),
            basis: evidence.basis.clone(),
            reduction: evidence.reduction.clone(),
            rigid: evidence.rigid.clone(),
            constraint: evidence.constraint.clone(),
            n_i: evidence.partition.n_internal,
        };
        fault(&mut parts);
        let Parts { retained, basis, reduction, rigid, constraint, .. } = &parts;
        let broken = Evidence { retained, basis, reduction, rigid, constraint, ..evidence };
        let checks = checks(&broken);
        checks.iter().filter(|check| check.verdict() > Verdict::Pass).for_each(|check| println!("{}", line(check)));
        complaints(&checks).into_iter().map(|(id, _)| id).collect()
    })
}

/// Adds a share of the largest entry of a column to one of its entries.
fn disturb(matrix: &mut faer::Mat<f64>, (row, column): (usize, usize), share: f64) {
    let largest = (0..matrix.nrows()).map(|i| matrix[(i, column)].abs()).fold(0.0, f64::max);
    matrix[(row, column)] += share * largest;
}

/// Adds to an entry on both sides of the diagonal, relative to it.
fn disturb_pair(matrix: &mut faer::Mat<f64>, (i, j): (usize, usize), share: f64) {
    let by = share * (matrix[(i, i)] * matrix[(j, j)]).sqrt();
    matrix[(i, j)] += by;
    if i != j {
        matrix[(j, i)] += by;
    }
}

#[test]
fn a_mode_shape_with_a_wrong_entry() {
    let ids = found(Method::CraigBampton, |parts| disturb(&mut parts.retained.modes.shapes, (40, 2), 1e-4));
    assert_eq!(ids, ["M-01", "M-02", "M-03", "M-04"]);
}

#[test]
fn a_mode_that_is_not_normalised() {
    let ids = found(Method::CraigBampton, |parts| {
        let shapes = &mut parts.retained.modes.shapes;
        (0..shapes.nrows()).for_each(|i| shapes[(i, 1)] *= 1.0 + 1e-8);
    });
    assert_eq!(ids, ["M-03"]);
}

#[test]
fn an_eigenvalue_that_is_not_its_modes() {
    let ids = found(Method::CraigBampton, |parts| parts.retained.modes.lambda[3] *= 1.0 + 1e-6);
    assert_eq!(ids, ["M-01", "M-02", "M-14"]);
}

#[test]
fn two_modes_mixed() {
    let ids = found(Method::Herting, |parts| {
        let shapes = &mut parts.retained.modes.shapes;
        let (c, s) = (1e-6f64.cos(), 1e-6f64.sin());
        for i in 0..shapes.nrows() {
            let (a, b) = (shapes[(i, 0)], shapes[(i, 3)]);
            (shapes[(i, 0)], shapes[(i, 3)]) = (c * a + s * b, c * b - s * a);
        }
    });
    // Still orthonormal in the mass; the reduced model no longer holds what the shapes say at the interface.
    assert_eq!(ids, ["M-01", "M-02", "M-04", "M-14"]);
}

#[test]
fn a_mode_that_was_not_found() {
    with_model(&model(), &[direct("ends", &[1, 8, 22, 14])], (Method::CraigBampton, 5), |evidence| {
        let count = supel::factor::InertiaCount { sigma: 1.0, ..certificate_count() };
        let interval = CountedInterval { from: 0.0, to: 1.0, n_counted: 6, n_found: 5, growth: 1.0, growth_limit: 1e6 };
        let certificate = Certificate {
            count,
            boundary: Boundary::FixedInterface,
            n_counted: 6,
            n_found: 5,
            intervals: vec![interval],
            n_finite: None,
            mending: Mending::None,
            n_factorisations: 1,
        };
        let broken = checks(&Evidence { certificate: Some(&certificate), ..evidence });
        assert_eq!(complaints(&broken), [("M-06", Verdict::Fail)]);
    });
}

fn certificate_count() -> supel::factor::InertiaCount {
    supel::factor::InertiaCount {
        sigma: 0.0,
        clamped: 6,
        free: 12,
        growth: 1.0,
        pivot_gap: 1.0,
        schur_gap: 1.0,
        condensed_gap: 1.0,
    }
}

#[test]
fn rigid_body_modes_that_strain_the_component() {
    let ids = found(Method::CraigBampton, |parts| parts.rigid.energy.largest_quotient = 1e-3);
    assert_eq!(ids, ["M-05"]);
    let ids = found(Method::CraigBampton, |parts| parts.rigid.energy.largest_residual = 1e-12);
    assert_eq!(ids, ["M-05"]);
}

#[test]
fn a_constraint_mode_with_a_wrong_entry() {
    let ids = found(Method::CraigBampton, |parts| disturb(parts.static_modes(), (17, 3), 1e-8));
    assert_eq!(ids, ["M-10", "M-11"]);
}

#[test]
fn constraint_modes_out_of_equilibrium_that_carry_rigid_body_motion() {
    let ids = found(Method::CraigBampton, |parts| {
        // A row z with z U_B = 0, so that equation (24) holds and the equilibrium alone is lost.
        let n_i = parts.n_i;
        let u_b = parts.rigid.orthonormal.as_ref().split_at_row(n_i).1;
        let mut z = faer::Mat::from_fn(1, u_b.nrows(), |_, j| ((3 * j + 1) as f64).sin());
        let q = u_b.qr().compute_thin_Q();
        let along = &z * &q;
        z -= &along * q.transpose();
        for j in 0..z.ncols() {
            parts.static_modes()[(17, j)] += 1e-8 * z[(0, j)];
        }
    });
    assert_eq!(ids, ["M-10"]);
}

#[test]
fn an_entry_of_the_condensed_stiffness() {
    let by = |share| found(Method::CraigBampton, |parts| disturb_pair(&mut parts.reduction.stiffness, (2, 5), share));
    // Rigid-body motion makes forces, and its null space is another.
    assert_eq!(by(1e-8), ["M-12", "M-16"]);
    // An eigenvalue goes below zero by more than what practice takes for a rigid-body mode.
    assert!(by(1e-6).contains(&"M-25"));
}

#[test]
fn an_entry_of_the_modal_stiffness() {
    let ids = found(Method::CraigBampton, |parts| {
        let last = parts.reduction.stiffness.nrows() - 1;
        disturb_pair(&mut parts.reduction.stiffness, (last, last), 1e-6);
    });
    assert_eq!(ids, ["M-14"]);
    // With inertia relief the deflection under gravity rests on the same entries.
    let ids = found(Method::Herting, |parts| {
        let first = parts.n_i.min(12);
        disturb_pair(&mut parts.reduction.stiffness, (first, first), 1e-4);
    });
    assert_eq!(ids, ["M-14", "M-18"]);
}

#[test]
fn an_inertia_relief_column_with_a_wrong_entry() {
    let ids = found(Method::Herting, |parts| disturb(&mut parts.basis.dynamic_modes, (40, 1), 1e-3));
    assert_eq!(ids, ["M-18"]);
}

#[test]
fn an_entry_of_the_reduced_mass() {
    let ids = found(Method::CraigBampton, |parts| disturb_pair(&mut parts.reduction.mass, (2, 5), 1e-6));
    assert_eq!(ids, ["M-16"]);
}

#[test]
fn interface_dofs_in_another_order() {
    let ids = found(Method::CraigBampton, |parts| {
        for matrix in [&mut parts.reduction.stiffness, &mut parts.reduction.mass] {
            faer::perm::swap_rows_idx(matrix.as_mut(), 3, 7);
            faer::perm::swap_cols_idx(matrix.as_mut(), 3, 7);
        }
    });
    assert_eq!(ids, ["M-12", "M-16"]);
}

#[test]
fn a_node_frame_that_is_transposed() {
    let ids = found(Method::CraigBampton, |parts| {
        // The axes of the second node turned one way in K̂ and M̂ and the other way in Û.
        let u = &mut parts.reduction.rigid_body_modes;
        let (c, s) = (0.1f64.cos(), 0.1f64.sin());
        for j in 0..u.ncols() {
            let (x, y) = (u[(3, j)], u[(4, j)]);
            (u[(3, j)], u[(4, j)]) = (c * x + s * y, c * y - s * x);
        }
    });
    assert_eq!(ids, ["M-12", "M-16"]);
}

/// What excuses a value is measured on results; results gone wrong may not excuse themselves.
#[test]
fn excuses_are_capped() {
    let ids = found(Method::Herting, |parts| {
        parts.constraint.cancellation = 1e12;
        parts.constraint.raw_rigid_error = 1.0;
        parts.retained.modes.errors.iter_mut().for_each(|error| error.cancellation = 1e15);
        parts.retained.modes.errors.iter_mut().for_each(|error| error.data_bar = 0.4);
        parts.reduction.measured.block_coupling = 1e-2;
        parts.reduction.measured.stiffness_asymmetry = 1e-2;
        disturb_pair(&mut parts.reduction.stiffness, (2, 5), 0.3);
        let shapes = &mut parts.retained.modes.shapes;
        (0..shapes.nrows()).for_each(|i| shapes[(i, 0)] += 0.1 * shapes[(i, 2)]);
    });
    for id in ["M-01", "M-02", "M-04", "M-12", "M-13", "M-14", "M-25"] {
        assert!(ids.contains(&id), "{id} let itself be excused: {ids:?}");
    }
}

#[test]
fn blocks_that_couple() {
    let ids = found(Method::Herting, |parts| parts.reduction.measured.block_coupling = 1e-8);
    assert_eq!(ids, ["M-13"]);
}

#[test]
fn projections_that_are_not_symmetric() {
    let ids = found(Method::Herting, |parts| parts.reduction.measured.mass_asymmetry = 1e-8);
    assert_eq!(ids, ["M-25"]);
}

#[test]
fn a_mass_that_is_negative() {
    let ids = found(Method::CraigBampton, |parts| {
        let last = parts.reduction.mass.nrows() - 1;
        disturb_pair(&mut parts.reduction.mass, (last - 1, last), 1.5);
    });
    assert!(ids.contains(&"M-25") && ids.contains(&"M-14"), "{ids:?}");
}

#[test]
fn an_interface_that_reacts_badly() {
    with_model(&model(), &[direct("ends", &[1, 8, 22, 14])], (Method::CraigBampton, 5), |evidence| {
        let rank = supel::rigid::InterfaceRank { singular_ratio: 1e-3 };
        assert_eq!(complaints(&checks(&Evidence { rank, ..evidence })), [("M-23", Verdict::Warn)]);
    });
}

#[test]
fn a_mass_that_was_not_expected() {
    with_model(&model(), &[direct("ends", &[1, 8, 22, 14])], (Method::CraigBampton, 5), |evidence| {
        let of = |mass: f64, cg: [f64; 3]| {
            let expect = Expectation { mass: Some(mass), cg: Some(cg) };
            complaints(&checks(&Evidence { expect: Some(&expect), ..evidence }))
        };
        let (mass, cg) = (6.0 * 1.1 * 0.9 * Material::UNIT.density, [3.0, 0.55, 0.45]);
        assert_eq!(of(mass, cg), []);
        assert_eq!(of(1.001 * mass, cg), [("M-16", Verdict::Warn)]);
        assert_eq!(of(mass, [3.0, 0.55, 0.9]), [("M-16", Verdict::Fail)]);
    });
}

/// A value that is not a number fails wherever it stands.
#[test]
fn values_that_are_no_numbers() {
    let of = |ids: Vec<&'static str>, must: &[&str]| must.iter().all(|id| ids.contains(id));
    let nan = |matrix: &mut faer::Mat<f64>| matrix[(1, 1)] = f64::NAN;
    assert!(of(
        found(Method::Herting, |parts| nan(&mut parts.retained.modes.shapes)),
        &["M-01", "M-02", "M-03", "M-04"]
    ));
    assert!(of(found(Method::Herting, |parts| nan(parts.static_modes())), &["M-10", "M-11"]));
    assert!(of(found(Method::Herting, |parts| nan(&mut parts.basis.dynamic_modes)), &["M-18"]));
}
