//! Units of matrices and of dofs: C-01, C-02, C-15, and coordinates in other units than the matrices.

use supel::error::Error;
use supel_models::transform::{dof_scaled, scaled};
use supel_models::{Ends, Inertia, Material, Model, Section, brick, frame, spring};

use crate::chain::{direct, rows};
use crate::program::{ALL, Case, METHODS, checks, eigensolvers, eigenvalues, lines, motions, worst_ratio};
use supel::verification::check::Verdict;

fn block() -> Model {
    brick([3, 2, 2], [3.0, 2.1, 1.9], &Material::UNIT)
}

/// Results do not depend on the units: to the bit for powers of two.
///
/// ARPACK alone stops at once where all its θ lie below 4e-11 and returns eigenvalues several times too large without a
/// word; behind the power-of-two scaling it is right in every unit.
#[test]
fn c_01_units_of_stiffness_and_mass() {
    let pins = [direct("pins", &[1, 12, 28])];
    for method in METHODS {
        for eigensolver in eigensolvers() {
            let reference = Case::new(&block(), &pins).method(method).by(eigensolver).clean();
            let lambda = eigenvalues(&reference);
            for (a, b) in [(1e-3, 1e-3), (1e-6, 1e-6), (1e12, 1e12), (1e12, 1e-12), (1e-12, 1e12), (1e-155, 1e-155)] {
                let outcome = Case::new(&scaled(&block(), a, b), &pins).method(method).by(eigensolver).clean();
                let back: Vec<f64> = eigenvalues(&outcome).iter().map(|found| found * (b / a)).collect();
                assert!(worst_ratio(&back, &lambda) <= 1e-12, "{a:e}, {b:e}, {method}, {eigensolver}");
            }
            for (p, q) in [(40, -40), (-3, 20), (200, 204)] {
                let (a, b) = (2f64.powi(p), 2f64.powi(q));
                let outcome = Case::new(&scaled(&block(), a, b), &pins).method(method).by(eigensolver).clean();
                let (found, expected) = (outcome.superelement.tensors(), reference.superelement.tensors());
                let n_b = 9;
                for i in 0..n_b {
                    for j in 0..n_b {
                        assert!(found.stiffness[(i, j)] == a * expected.stiffness[(i, j)], "K({i}, {j})");
                        assert!(found.mass[(i, j)] == b * expected.mass[(i, j)], "M({i}, {j})");
                    }
                }
                // ω carries the root of an even power.
                let root = 2f64.powi((p - q) / 2);
                if (p - q) % 2 == 0 {
                    let omega: Vec<f64> = expected.frequencies.iter().map(|omega| omega * root).collect();
                    assert_eq!(found.frequencies, omega);
                }
            }
        }
    }
    // λ of 10²⁹⁸ is representable, and Craig-Bampton gives it. Inertia-relief modes K_II⁻¹(MU)_I of 10⁻³⁰⁰ together with
    // mass-normalised ones of 10⁷⁵ are not: the mixing matrix would hold 10³⁷⁵.
    let extreme = scaled(&block(), 1e150, 1e-150);
    let reference = eigenvalues(&Case::new(&block(), &pins).method("craig-bampton").clean());
    let found = eigenvalues(&Case::new(&extreme, &pins).method("craig-bampton").clean());
    let back: Vec<f64> = found.iter().map(|found| found / 1e150 / 1e150).collect();
    assert!(worst_ratio(&back, &reference) <= 1e-12);
    let error =
        Case::new(&extreme, &pins).refused(&["inertia-relief modes", "range of double precision", "other units"]);
    assert!(matches!(error, Error::UnitRange { .. }), "{error}");
}

/// The interface of every method in other units: to the bit for powers of two, to rounding of K and M otherwise.
#[test]
fn c_01_units_by_every_method() {
    let pins = [direct("pins", &[1, 12, 28])];
    // Lengths of the columns of a file do not matter, so that one file serves all units.
    let shapes = motions(&block(), 12);
    for method in ALL {
        let reduced = |a: f64, b: f64| {
            let case = Case::new(&scaled(&block(), a, b), &pins).method(method);
            Case { files: vec![("V.mtx", shapes.clone())], ..case }.accepted()
        };
        let reference = reduced(1.0, 1.0);
        let expected = reference.superelement.tensors();
        let at = || (0..9).flat_map(|i| (0..9).map(move |j| (i, j)));
        for (p, q) in [(40, -40), (-3, 20)] {
            let (a, b) = (2f64.powi(p), 2f64.powi(q));
            let outcome = reduced(a, b);
            let found = outcome.superelement.tensors();
            assert!(at().all(|at| found.stiffness[at] == a * expected.stiffness[at]), "{method}: K by 2^{p}");
            assert!(at().all(|at| found.mass[at] == b * expected.mass[at]), "{method}: M by 2^{q}");
        }
        for (a, b) in [(1e12, 1e-12), (1e-12, 1e12), (1e12, 1e12)] {
            let outcome = reduced(a, b);
            let found = outcome.superelement.tensors();
            for (name, unit, found, expected) in
                [("K", a, &found.stiffness, &expected.stiffness), ("M", b, &found.mass, &expected.mass)]
            {
                for (i, j) in at() {
                    let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
                    let error = (found[(i, j)] / unit - expected[(i, j)]).abs();
                    assert!(error <= 1e-12 * size, "{method}, {a:e}, {b:e}: {name}({i}, {j}) {error:e} of {size:e}");
                }
            }
            let back: Vec<f64> = eigenvalues(&outcome).iter().map(|found| found * (b / a)).collect();
            assert!(worst_ratio(&back, &eigenvalues(&reference)) <= 1e-12, "{method}, {a:e}, {b:e}");
        }
    }
}

/// A frame with its rotations in milliradian, and at lengths from micrometre to thousand kilometres.
#[test]
fn c_02_units_of_dofs_and_lengths() {
    let at = |size: f64| {
        let nodes: Vec<[f64; 3]> =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.5, 1.0, 0.7], [2.0, 1.3, 0.7]]
                .map(|x: [f64; 3]| x.map(|x| x * size))
                .to_vec();
        let edges = [[0, 1], [1, 2], [2, 3], [3, 4]];
        let section = Section::round(0.05 * size);
        let model = frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent);
        supel_models::transform::supported(&model, |(label, _)| label == 1)
    };
    let anonymous = |model: Model| Model { dofs: Vec::new(), ..model };
    // The last node's six dofs.
    let tip = [rows("tip", &[18, 19, 20, 21, 22, 23])];
    for method in METHODS {
        let reference = Case::new(&anonymous(at(1.0)), &tip).method(method).accepted();
        let lambda = eigenvalues(&reference);
        for factor in [1e3, 1e-3, 57.3] {
            let model = at(1.0);
            let factors: Vec<f64> =
                model.dofs.iter().map(|(_, direction)| if *direction < 3 { 1.0 } else { factor }).collect();
            let outcome = Case::new(&anonymous(dof_scaled(&model, &factors)), &tip).method(method).accepted();
            assert!(worst_ratio(&eigenvalues(&outcome), &lambda) <= 1e-11, "{method}, {factor}");
            // M-02: backward error dof by dof.
            let componentwise = checks(&outcome, "M-02")[0].value;
            assert!(componentwise <= 1e-11, "{method}, {factor}: {componentwise:e}");
        }
        for size in [1e-6, 1e-3, 1e3, 1e6] {
            let outcome = Case::new(&anonymous(at(size)), &tip).method(method).accepted();
            // E and ρ fixed: frequencies go with one over the length.
            let back: Vec<f64> = eigenvalues(&outcome).iter().map(|found| found * size * size).collect();
            assert!(worst_ratio(&back, &lambda) <= 1e-11, "{method}, {size:e}");
        }
    }
}

/// Entries near the ends of the range: normalised where the answer is representable, refused by name where not.
#[test]
fn c_15_denormal_and_huge_entries() {
    let pins = [direct("pins", &[1, 12, 28])];
    for (a, b) in [(1e-310, 1.0), (1.0, 1e-310), (1e300, 1e-30), (1e-300, 1.0), (1e-200, 1e200)] {
        for method in METHODS {
            let error =
                Case::new(&scaled(&block(), a, b), &pins).method(method).refused(&["range of double precision"]);
            assert!(matches!(error, Error::UnitRange { .. }), "{a:e}, {b:e}: {error}");
        }
    }
    // A denormal coupling among ordinary entries is nothing; a spring of 1e300 leaves the others no digits.
    let chain = spring(30, Ends::Fixed);
    let reference = eigenvalues(&Case::new(&chain, &[rows("end", &[0])]).clean());
    let mut faint = chain.clone();
    faint.stiffness.extend([(2, 9, 1e-310), (9, 2, 1e-310)]);
    let found = eigenvalues(&Case::new(&faint, &[rows("end", &[0])]).accepted());
    assert!(worst_ratio(&found, &reference) <= 1e-13);
    let mut pinned = chain.clone();
    for entry in pinned.stiffness.iter_mut().filter(|entry| (entry.0, entry.1) == (29, 29)) {
        entry.2 += 1e300;
    }
    let error =
        Case::new(&pinned, &[rows("end", &[0])]).refused(&["the smallest diagonal entry, relative to the largest,"]);
    assert!(matches!(error, Error::UnitRange { .. }), "{error}");
}

/// Coordinates in millimetres with matrices in metres: K of a solid cannot tell, only what the user knows of its mass
/// properties can. Without the expectation nothing is seen, with it the centre gives it away.
#[test]
fn coordinates_in_wrong_units_show_in_the_expected_centre_alone() {
    let right = block();
    let nodes = right.nodes.iter().map(|x| x.map(|x| 1e3 * x)).collect();
    let wrong = Model { nodes, ..right.clone() };
    let pins = [direct("pins", &[1, 12, 28])];
    let mass = right.total_mass(0);
    let expect = format!("expect = {{ mass = {mass:?}, cg = [1.5, 1.05, 0.95] }}\n");
    for method in METHODS {
        let with = |model: &Model, of_model: &str| {
            Case { of_model: of_model.to_owned(), ..Case::new(model, &pins).method(method) }.run().expect("a reduction")
        };
        assert_eq!(lines(&with(&wrong, ""), Verdict::Fail), [""; 0]);
        assert_eq!(lines(&with(&right, &expect), Verdict::Fail), [""; 0]);
        let failed = lines(&with(&wrong, &expect), Verdict::Fail);
        assert!(failed.len() == 1 && failed[0].starts_with("M-16 mass and centre are those expected"), "{failed:?}");
    }
}
