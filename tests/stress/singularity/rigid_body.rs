//! Zero modes of free, joined, plane and partly held components: S-01, S-03, S-04, S-07 to S-12.

use supel::dense;
use supel::dofs::Direction;
use supel::error::Error;
use supel::job::InterfaceJob;
use supel::rigid::{self, RigidSource};
use supel::verification::check::Verdict;
use supel_models::transform::{grounded, join, supported, translated};
use supel_models::{Inertia, Material, Model, Section, brick, frame, membrane, spectrum};

use super::{CORNERS, block};
use crate::chain::{direct, rigid_of};
use crate::program::{
    ALL, Case, FREE, METHODS, bars, checks, eigensolvers, eigenvalues, lines, message_of, n_rigid, warnings,
    worst_ratio,
};

/// Both eigensolvers give the dense elastic spectrum, to the rounding of the dense solution.
#[track_caller]
fn agrees_with_dense(model: &Model, interfaces: &[InterfaceJob], n_rigid_expected: usize) {
    let exact = spectrum(model);
    // Jacobi rotations and the Cholesky factor of M leave some ε of the largest eigenvalue for each of n rows.
    let rounding = model.n as f64 * 1e-15 * exact[model.n - 1];
    for eigensolver in eigensolvers() {
        let outcome = Case::new(model, interfaces).by(eigensolver).accepted();
        assert_eq!(n_rigid(&outcome), n_rigid_expected, "{eigensolver}");
        for (found, exact) in eigenvalues(&outcome).iter().zip(&exact[n_rigid_expected..]) {
            assert!((found - exact).abs() <= rounding, "{eigensolver}: {found} for {exact}, rounding {rounding:e}");
        }
    }
}

/// Free-free: six rigid-body modes whose span the matrices alone confirm.
#[test]
fn s_01_free_solid_has_six_rigid_body_modes() {
    let model = block();
    for method in METHODS {
        let outcome = Case::new(&model, &[direct("pins", &CORNERS)]).method(method).clean();
        assert_eq!(n_rigid(&outcome), 6, "{method}");
    }
    agrees_with_dense(&model, &[direct("pins", &CORNERS)], 6);

    let (partition, geometric) = rigid_of(&model, &[direct("pins", &CORNERS)]).expect("rigid-body modes");
    let (algebraic, _) = rigid::from_matrices(&partition).expect("zero modes");
    assert_eq!((algebraic.count(), algebraic.source), (6, RigidSource::Algebraic));
    // sin of the largest angle between the spans: what of the algebraic modes the geometric ones leave over.
    let along = dense::gram(geometric.mass_orthonormal.as_ref(), algebraic.orthonormal.as_ref());
    let mut rest = algebraic.orthonormal.clone();
    dense::add_product(rest.as_mut(), -1.0, geometric.orthonormal.as_ref(), along.as_ref());
    let squares = dense::gram(rest.as_ref(), supel::sparse::product(&partition.mass, rest.as_ref()).as_ref());
    let (values, _) = dense::symmetric_eigen(squares.as_ref()).expect("six values");
    let sine = values.last().expect("six values").max(0.0).sqrt();
    let exact = spectrum(&model);
    let kappa = exact[model.n - 1] / exact[6];
    assert!(sine <= 10.0 * f64::EPSILON * kappa, "{sine:e} of {kappa:e}");
    // λ of the motions over the first elastic one.
    let quotient = geometric.energy.largest_quotient * partition.scaling.eigenvalue_unit() / exact[6];
    assert!(quotient <= f64::EPSILON * kappa, "{quotient:e}");
}

/// Slender bar and thin plate: κ takes the digits, the bars say how many, and what is reported lies within them.
#[test]
fn s_03_slender_bar_and_thin_plate_stay_within_their_bars() {
    let slender = brick([100, 1, 1], [100.0, 0.1, 0.1], &Material::UNIT);
    let plate = brick([12, 12, 1], [1.0, 1.0, 1e-3], &Material::UNIT);
    let held_slender = [direct("ends", &[1, 102, 203, 101, 404])];
    let held_plate = [direct("corners", &[1, 13, 157, 169 + 13])];
    for (name, model, interface) in [("slender", slender, &held_slender), ("plate", plate, &held_plate)] {
        let found: Vec<_> = METHODS
            .iter()
            .chain([&"herting"])
            .zip(["lanczos", "lanczos", *eigensolvers().last().expect("one")])
            .map(|(method, eigensolver)| Case::new(&model, interface).method(method).by(eigensolver).accepted())
            .collect();
        // Herting's modes are those of the free component whichever eigensolver finds them.
        let (lanczos, witness) = (&found[1], &found[2]);
        // Two Rayleigh quotients of one eigenvalue, each within its bar. The 10⁻⁷ of the catalogue is the spread of one plate
        // of its own; κ ε is 10⁻⁴ at this thickness, and 10⁻⁶ is reached for the first mode.
        let pairs = eigenvalues(lanczos).into_iter().zip(eigenvalues(witness));
        for ((a, b), bar) in pairs.zip(bars(lanczos)) {
            let spread = (a / b - 1.0).abs();
            assert!(spread <= 2.0 * bar && spread <= 1e-5, "{name}: {spread:e}, bar {bar:e}");
        }
        for outcome in &found {
            let limited = checks(outcome, "M-09")[0];
            assert!(limited.value <= 1e-3, "{name}: {:e}", limited.value);
        }
    }
}

/// Bodies are counted, not assumed; one without interface is named.
#[test]
fn s_04_every_body_brings_its_own_zero_modes() {
    let pair = join(&block(), &translated(&block(), [5.0, 0.0, 0.0]), &[]);
    let on_both = [direct("first", &CORNERS), direct("second", &CORNERS.map(|label| label + 36))];
    agrees_with_dense(&pair, &on_both, 12);
    for method in ALL {
        let outcome = Case::new(&pair, &on_both).method(method).clean();
        assert_eq!((n_rigid(&outcome), outcome.report.body.model.n_bodies), (12, 2), "{method}");
        let error =
            Case::new(&pair, &on_both[..1]).method(method).refused(&["1 of the 2 bodies", "add an interface node"]);
        assert!(matches!(error, Error::FloatingBody { n_floating: 1, n_bodies: 2, .. }), "{error}");
        let Error::FloatingBody { dof, .. } = &error else { unreachable!() };
        let node: i64 = dof.split(' ').nth(1).and_then(|label| label.parse().ok()).expect("node and label");
        assert!(node > 36, "{dof}");
    }
    let cube = brick([1, 1, 1], [1.0; 3], &Material::UNIT);
    let eight = (1..8).fold(cube.clone(), |all, i| join(&all, &translated(&cube, [2.0 * f64::from(i), 0.0, 0.0]), &[]));
    let labels: Vec<i64> = (0..8).flat_map(|body| [1, 4, 6].map(|label| label + 8 * body)).collect();
    for method in ALL {
        assert_eq!(n_rigid(&Case::new(&eight, &[direct("pins", &labels)]).method(method).accepted()), 48, "{method}");
    }
}

#[test]
fn s_07_plane_model_has_three_rigid_body_modes() {
    let plane = membrane([6, 4], [6.0, 4.0], &Material::UNIT);
    agrees_with_dense(&plane, &[direct("pins", &[1, 35])], 3);
    for method in METHODS {
        assert_eq!(n_rigid(&Case::new(&plane, &[direct("pins", &[1, 35])]).method(method).clean()), 3);
    }
}

/// A plane model with directions that nothing fills.
#[test]
fn s_08_plane_model_with_empty_rows_is_refused() {
    let plane = membrane([3, 2], [3.0, 2.0], &Material::UNIT);
    let dofs = plane.labels.iter().flat_map(|label| (0..3).map(|direction| (*label, direction))).collect();
    let spread = |row: u32| row / 2 * 3 + row % 2;
    let widen = |entries: &[supel_models::model::Entry]| {
        entries.iter().map(|(row, column, value)| (spread(*row), spread(*column), *value)).collect()
    };
    let model =
        Model { n: plane.n / 2 * 3, stiffness: widen(&plane.stiffness), mass: widen(&plane.mass), dofs, ..plane };
    let error = Case::new(&model, &[direct("pins", &[1, 12])]).refused(&["12 rows", "node 1 uz", "--drop-empty"]);
    assert!(matches!(error, Error::EmptyRows { n_rows: 12, row: 3, .. }), "{error}");
}

#[test]
fn s_09_rotation_of_a_solid_node_is_refused() {
    let six = InterfaceJob { dofs: Some(Direction::ALL.to_vec()), ..direct("tip", &[7]) };
    let error = Case::new(&block(), &[six]).refused(&["tip", "node 7 rx", "coupling = \"rigid\""]);
    assert!(matches!(error, Error::DofMissing { .. }), "{error}");
}

/// A straight beam of lumped masses: the rotation about its axis costs nothing and moves nothing.
#[test]
fn s_10_rotation_without_inertia_is_kept_out_of_inertia_relief() {
    let nodes: Vec<[f64; 3]> = (0..6).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..5).map(|i| [i, i + 1]).collect();
    let straight = frame(&nodes, &edges, &Section::round(0.1), &Material::UNIT, Inertia::LumpedTranslations);
    let outcome = Case::new(&straight, &[direct("ends", &[1, 6])]).method("craig-bampton").count(3).accepted();
    assert_eq!(n_rigid(&outcome), 6);
    assert!(message_of(&outcome, "W-RIGID-MASS").contains("rank 5 of 6"), "{:?}", warnings(&outcome));
    // The inertia about the axis is what is left: nothing.
    let inertia = outcome.report.body.model.mass_properties.inertia.expect("mass properties");
    assert!(inertia[0][0].abs() <= 1e-12 * inertia[1][1], "{inertia:?}");
    // Held at its ends it has modes to compare with; free, and loaded where it does not turn, it has none that are defined.
    let preservation = &outcome.report.body.preservation;
    let compared: Vec<&str> = preservation.boundaries.iter().map(|line| line.boundary.as_str()).collect();
    assert_eq!(compared, ["fix:ends"]);
    for name in ["free", "mass:ends"] {
        let named = preservation.not_compared.iter().find(|note| note.contains(&format!("boundary {name}: ")));
        assert!(named.is_some_and(|note| note.contains("moves no mass")), "{:?}", preservation.not_compared);
    }
    // Herting's method keeps free modes.
    for eigensolver in eigensolvers() {
        for modes in ["{ count = 3 }", "{ up_to_hz = 0.02 }"] {
            let case = Case { modes: modes.into(), ..Case::new(&straight, &[direct("ends", &[1, 6])]) };
            let error = case.by(eigensolver).refused(&["moves no mass", "rx", "rotary inertia", "craig-bampton"]);
            assert!(matches!(error, Error::MasslessFreeMotion { .. }), "{error}");
        }
    }
}

/// Inertia relief is built on the five motions with inertia: no number is lost, and their accelerations are answered exactly. Methods that
/// keep free modes are refused, since the sixth motion has no mass.
#[test]
fn s_10_inertia_relief_of_the_motions_with_inertia() {
    let nodes: Vec<[f64; 3]> = (0..6).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..5).map(|i| [i, i + 1]).collect();
    let straight = frame(&nodes, &edges, &Section::round(0.1), &Material::UNIT, Inertia::LumpedTranslations);
    for method in ["craig-bampton", "guyan"] {
        let case = Case::new(&straight, &[direct("ends", &[1, 6])]).method(method).count(3);
        let outcome = Case { inertia_relief: true, ..case }.accepted();
        assert_eq!(outcome.report.body.reduction.n_inertia_relief, 5, "{method}");
        let deflection = checks(&outcome, "M-18");
        let is_exact = |check: &&supel::verification::check::Check| check.value <= 1e-9;
        assert!(deflection.iter().all(is_exact), "{method}: {deflection:?}");
        assert!(outcome.report.body.checks.iter().all(|check| check.value.is_finite()), "{method}");
        let tensors = outcome.superelement.tensors();
        let is_number = |matrix: &supel_runtime::Matrix| {
            (0..matrix.rows()).all(|i| (0..matrix.cols()).all(|j| matrix[(i, j)].is_finite()))
        };
        assert!(is_number(&tensors.stiffness) && is_number(&tensors.mass), "{method}");
    }
    for method in FREE {
        let case = Case::new(&straight, &[direct("ends", &[1, 6])]).method(method).count(3);
        let error = Case { inertia_relief: true, ..case }.refused(&["moves no mass", "rx", "rotary inertia"]);
        assert!(matches!(error, Error::MasslessFreeMotion { .. }), "{method}: {error}");
    }
}

#[test]
fn s_11_held_component_has_no_rigid_body_modes() {
    let block = block();
    let held = supported(&block, |(label, _)| block.groups["XMIN"].contains(&label));
    agrees_with_dense(&held, &[direct("tip", &[12])], 0);
    let exact = spectrum(&held);
    assert!(exact[0] >= 1e3 * f64::EPSILON * exact[held.n - 1]);
    for method in METHODS {
        let outcome = Case::new(&held, &[direct("tip", &[12])]).method(method).clean();
        assert_eq!(n_rigid(&outcome), 0);
        assert_eq!(outcome.superelement.tensors().rigid_body_modes.cols(), 0);
        assert_eq!(outcome.report.body.reduction.n_inertia_relief, 0);
    }
}

#[test]
fn s_12_partly_held_component_keeps_what_is_free() {
    // Two nodes on a hinge line leave one rotation, one node three.
    for (held, free) in [(vec![1, 2], 1), (vec![1], 3)] {
        let model = supported(&block(), |(label, _)| held.contains(&label));
        agrees_with_dense(&model, &[direct("pins", &[12, 28, 36])], free);
        let pins = [direct("pins", &[12, 28, 36])];
        let lambda = eigenvalues(&Case::new(&model, &pins).accepted());
        for method in ALL {
            let outcome = Case::new(&model, &pins).method(method).accepted();
            assert_eq!(n_rigid(&outcome), free, "{method}: {:?}", lines(&outcome, Verdict::Warn));
            if FREE.contains(&method) {
                assert!(worst_ratio(&eigenvalues(&outcome), &lambda) <= 1e-13, "{method}");
            }
        }
    }
}

/// A spring to the ground at one corner of a thin plate, r times the largest stiffness: found from r = 10⁻¹¹, where it holds
/// the plate a hundred times firmer than bending allows for; silent where it is rounding of the plate itself.
#[test]
fn s_13_weak_spring_to_the_ground_is_named() {
    let plate = brick([12, 12, 1], [1.0, 1.0, 1e-2], &Material::UNIT);
    let largest = plate.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    let interfaces = [direct("corners", &[1, 13, 157])];
    for (r, is_told) in [(1e-16, false), (1e-11, true), (1e-9, true)] {
        // The dof uz of node 79, away from the corners.
        let outcome = Case::new(&grounded(&plate, 3 * 78 + 2, r * largest), &interfaces).run();
        match outcome {
            Ok(outcome) => {
                assert_eq!(warnings(&outcome).contains(&"W-GROUNDED"), is_told, "r = {r:e}: {:?}", warnings(&outcome));
                if is_told {
                    let message = message_of(&outcome, "W-GROUNDED");
                    assert!(message.contains("node 79 uz"), "{message}");
                }
            }
            Err(error) => panic!("r = {r:e}: {error}"),
        }
    }
}
