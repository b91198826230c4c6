//! Facts of floating-point arithmetic that the method is built on: each test fails where its measure is taken out.

use faer::Mat;
use supel::basis::Basis;
use supel::constraint::StaticModes;
use supel::dense;
use supel::job::Method;
use supel::model::Model;
use supel::reduction::Reduction;
use supel::sparse::product_and_terms;
use supel::verification::check::{ActiveLimit, Check, Limits, Verdict};
use supel_models::transform::supported;
use supel_models::{Ends, Inertia, Material, Section, bar, bar_spectrum, brick, frame, spring, spring_spectrum};

use crate::chain::{direct, input, rows};
use crate::evidence::{checks, complaints, with_model};

/// Eigenvalues are Rayleigh quotients of deflated vectors: their error is that of the terms of the quotient added in
/// random order, ε c / √n, where the eigensolver's own 1/θ + σ is off by ε κ.
#[test]
fn eigenvalues_are_rayleigh_quotients() {
    let n = 20_000;
    let chain = || spring(n, Ends::Free);
    for (name, method, model, exact) in [
        ("bar", Method::Herting, bar(n), bar_spectrum(n)),
        ("free chain", Method::Herting, chain(), spring_spectrum(n, Ends::Free)[1..].to_vec()),
        // A free component's operator is refined, that of a held one is the factor as it is.
        ("held chain", Method::CraigBampton, chain(), spring_spectrum(n - 2, Ends::Fixed)),
    ] {
        with_model(&model, &[rows("ends", &[0, n - 1])], (method, 6), |evidence| {
            let unit = evidence.partition.scaling.eigenvalue_unit();
            let modes = &evidence.retained.modes;
            for ((lambda, error), exact) in modes.lambda.iter().zip(&modes.errors).zip(&exact) {
                let off = (lambda * unit / exact - 1.0).abs();
                let bound = f64::EPSILON * error.cancellation / (n as f64).sqrt();
                assert!(off <= bound, "{name}: off {off:.1e}, bound {bound:.1e}");
            }
            // Of simple eigenvalues they are the quotients of the very shapes that are handed over, to the last bit.
            let pencil = match method {
                Method::CraigBampton => evidence.partition.internal(),
                _ => evidence.partition.pencil(),
            };
            let [forces, momenta] =
                [pencil.stiffness, pencil.mass].map(|matrix| product_and_terms(matrix, modes.shapes.as_ref()).0);
            for (j, lambda) in modes.lambda.iter().enumerate() {
                let [x, force, momentum] =
                    [&modes.shapes, &forces, &momenta].map(|columns| dense::column(columns.as_ref(), j));
                assert_eq!(*lambda, dense::dot(x, force) / dense::dot(x, momentum), "{name}, mode {}", j + 1);
            }
        });
    }
}

/// Orthonormalising a whole space in a mass that hardly sees one motion blows that motion up from rounding; a solve takes it out.
/// A chain whose mass lets one combination of its rows nearly pass: of all measures only that of the mass itself warns.
#[test]
fn what_the_mass_hardly_sees_is_no_part_of_a_mode() {
    let v: Vec<f64> = (0..12).map(|i| f64::sin(f64::from(1 + 3 * i))).collect();
    let mean = v.iter().sum::<f64>() / 12.0;
    let square: f64 = v.iter().map(|value| (value - mean).powi(2)).sum();
    let of = |i: u32, j: u32| (v[i as usize] - mean) * (v[j as usize] - mean) / square;
    let entry = |(i, j)| (i, j, f64::from(u8::from(i == j)) - (1.0 - 1e-8) * of(i, j));
    let mass = (0..12).flat_map(|i| (0..12).map(move |j| (i, j))).map(entry).collect();
    let model = supel_models::Model { mass, ..spring(12, Ends::Free) };
    for method in [Method::Herting, Method::CraigBampton] {
        let found =
            with_model(&model, &[rows("ends", &[0, 11])], (method, 10), |evidence| complaints(&checks(&evidence)));
        assert_eq!(found, [("M-23", Verdict::Warn)], "{method:?}");
    }
}

/// Rows with next to no mass follow the others, and an iteration that sees vectors by their mass alone carries along what it does
/// not see there. A step of inverse iteration leaves nothing of it.
#[test]
fn modes_among_rows_of_next_to_no_mass_lose_no_digits() {
    let model = brick([6, 3, 2], [1.0; 3], &Material::UNIT);
    // Every fifth node is heavy. Without that step backward errors are 1e-11 and 1e-13.
    let mass = (0..model.n as u32).map(|row| (row, row, if (row / 3) % 5 == 0 { 1.0 } else { 1e-12 }));
    let model = supel_models::Model { mass: mass.collect(), ..model };
    for (method, n_modes) in [(Method::Herting, 3), (Method::CraigBampton, 10)] {
        with_model(&model, &[direct("ends", &[1, 11, 28, 84])], (method, n_modes), |evidence| {
            let checks = checks(&evidence);
            for id in ["M-01", "M-02"] {
                let check = checks.iter().find(|check| check.id == id).expect("a line");
                assert_eq!(check.verdict(), Verdict::Pass, "{method:?}: {check:?}");
            }
            // What is left is rounding of a residual of 81 terms in a row.
            let worst = evidence.retained.modes.errors.iter().map(|error| error.backward).fold(0.0, f64::max);
            assert!(worst <= 1e-14, "{method:?}: {worst:e}");
        });
    }
}

/// The operator at zero of a free frame that one end holds leaves forces of rigid-body motion, roundings along the whole frame, and modes
/// of it are those of a stiffness that differs by them. A step of refinement takes them out, few digits or not.
#[test]
fn modes_of_a_slender_frame_are_those_of_its_stiffness() {
    let place = |k: f64| [0.1 * k, 0.2 * (0.7 * k).sin(), 0.15 * (0.4 * k).cos()];
    let nodes: Vec<[f64; 3]> = (0..80).map(f64::from).map(place).collect();
    let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|k| [k - 1, k]).collect();
    let model = frame(&nodes, &edges, &Section::round(0.003), &Material::STEEL_SI, Inertia::Consistent);
    for end in [&[1][..], &[1, 2]] {
        with_model(&model, &[direct("end", end)], (Method::Herting, 6), |evidence| {
            let checks = checks(&evidence);
            assert_eq!(complaints(&checks), [], "{end:?}");
            // Without that step they have to be found once more, by a factor of K − σM.
            assert_eq!(evidence.retained.modes.work.factorisations, 0, "{end:?}: {:?}", evidence.retained.modes.work);
        });
    }
}

/// A rotation that one node lacks and others have takes mass of a body out where M couples it with translations.
#[test]
fn a_node_without_a_rotation_is_not_whole() {
    let nodes: Vec<[f64; 3]> = (0..5).map(|k| [0.2 * f64::from(k), 0.1 * f64::from(k % 2), 0.0]).collect();
    let edges: Vec<[usize; 2]> = (1..5).map(|k| [k - 1, k]).collect();
    for (inertia, is_taken, is_whole) in [
        (Inertia::Consistent, false, true),
        (Inertia::Consistent, true, false),
        // Half of the mass at each end moves with no rotation.
        (Inertia::LumpedTranslations, true, true),
    ] {
        let whole = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, inertia);
        let model = supported(&whole, |dof| is_taken && dof == (3, 5));
        let weight = Model::new(input(&model)).expect("a model").weight().expect("a map");
        assert_eq!(weight.has_whole_nodes, is_whole, "{inertia:?}, {is_taken}");
    }
}

/// K̂ = ΨᵀKΨ is of second order in the error of Ψ_S; K_BB + K_BI Ψ_S would be of first order.
#[test]
fn reduced_stiffness_forgives_the_constraint_modes_in_second_order() {
    let model = brick([6, 2, 2], [6.0, 1.1, 0.9], &Material::UNIT);
    with_model(&model, &[direct("ends", &[1, 8, 22, 14])], (Method::CraigBampton, 3), |evidence| {
        let share = 1e-5;
        let psi_s = evidence.basis.constraint_modes.to_columns();
        let off_by_a_share = |i: usize, j: usize| psi_s[(i, j)] + share * ((7 * i + 13 * j) as f64).sin();
        let off = Basis {
            constraint_modes: StaticModes::stored(Mat::from_fn(psi_s.nrows(), psi_s.ncols(), off_by_a_share)),
            ..evidence.basis.clone()
        };
        let n_b = evidence.partition.n_interface();
        let block = |reduction: &Reduction| reduction.stiffness.submatrix(0, 0, n_b, n_b).to_owned();
        let exact = block(evidence.reduction);
        let found = block(&Reduction::new(evidence.partition, &off, evidence.rigid));
        let error = (&found - &exact).norm_max();
        // K_II of scaled entries of order one and at most 81 a row: Δᵀ K_II Δ ≤ n_I · 81 · share².
        let bound = evidence.partition.n_internal as f64 * 81.0 * share * share;
        assert!(error <= bound, "{error:e}, bound {bound:e}");
        // The bound tells first from second order.
        assert!(bound < 0.5 * share, "{bound:e}");
        assert!(error > 0.0, "the disturbance is not seen at all");
    });
}

/// A slender component passes by a limit of the arithmetic, which says so; the engineering figure alone would warn.
#[test]
fn limits_are_what_arithmetic_can_give() {
    let slender = brick([60, 1, 1], [60.0, 0.1, 0.1], &Material::UNIT);
    with_model(&slender, &[direct("ends", &[1, 62, 123, 61])], (Method::Herting, 4), |evidence| {
        let checks = checks(&evidence);
        let by_arithmetic: Vec<_> = checks
            .iter()
            .filter(|check| check.value > check.limits.engineering && check.verdict() == Verdict::Pass)
            .collect();
        assert!(!by_arithmetic.is_empty());
        for check in by_arithmetic {
            assert_eq!(check.limits.active(), ActiveLimit::Arithmetic, "{check:?}");
        }
    });
}

/// K̂ of a free component is singular: its spectrum, its zero modes and its elastic condition are found all the same.
#[test]
fn reduced_stiffness_of_a_free_component_is_never_factored_as_if_it_were_definite() {
    let model = brick([6, 2, 2], [6.0, 1.1, 0.9], &Material::UNIT);
    with_model(&model, &[direct("ends", &[1, 8, 22, 14])], (Method::Herting, 3), |evidence| {
        let n_b = evidence.partition.n_interface();
        let block = evidence.reduction.stiffness.submatrix(0, 0, n_b, n_b).to_owned();
        let values = block.self_adjoint_eigenvalues(faer::Side::Lower).expect("finite");
        let n_zero = values.iter().filter(|value| value.abs() <= 1e-12 * values[n_b - 1]).count();
        assert_eq!(n_zero, 6, "{values:?}");
        let checks = checks(&evidence);
        let of = |id: &'static str| checks.iter().filter(move |check| check.id == id);
        assert!(of("M-12").chain(of("M-14")).all(|check| check.verdict() == Verdict::Pass), "{checks:?}");
        let condition = of("M-23").find(|check| check.name.contains("elastic stiffness")).expect("a line");
        assert!(condition.value < 1e6, "{condition:?}");
    });
}

/// Limits that arithmetic or data set may have reached the figure at which a check fails.
#[test]
fn a_value_just_above_its_limit_never_fails() {
    let of = |value: f64, engineering: f64, arithmetic: f64| {
        let limits = Limits { engineering, arithmetic, data: 0.0 };
        Check { id: "M-14", name: "", equation: "", value, limits, fail_above: 1e3 * engineering, worst: None }
            .verdict()
    };
    assert_eq!([1e-9, 2e-9, 1.1e-6].map(|value| of(value, 1e-9, 0.0)), [Verdict::Pass, Verdict::Warn, Verdict::Fail]);
    assert_eq!(
        [1e-5, 1.9e-5, 2.1e-5].map(|value| of(value, 1e-9, 1e-5)),
        [Verdict::Pass, Verdict::Warn, Verdict::Fail]
    );
    // A count that should be zero has no figure near it.
    assert_eq!(of(1.0, 0.0, 0.0), Verdict::Fail);
}
