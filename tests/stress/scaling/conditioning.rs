//! Contrast, grading, incompressibility, near nodes, inertia relief, dependent modes: C-03 to C-06, C-08, C-09.

use faer::Mat;
use supel::basis::{Basis, DynamicColumns};
use supel::error::Error;
use supel::outcome::Outcome;
use supel::verification::check::Verdict;
use supel_models::model::Assembler;
use supel_models::transform::rounded;
use supel_models::{Material, Model, brick, spectrum};
use supel_testing::cases::{solid, tied};

use crate::chain::{self, direct, rows};
use crate::oracle::{self, Tridiagonal, Two};
use crate::program::{ALL, Case, METHODS, array, bars, checks, eigensolvers, eigenvalues, lines, warnings};

/// A chain of springs and unit masses between a free hub and the ground, the matrices as a program writes them and as they
/// should be: sums of stiffnesses keep in `exact` what rounding takes away.
fn chain_of(springs: &[f64]) -> (Model, Tridiagonal) {
    let n = springs.len();
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    let mut exact = Tridiagonal { diagonal: vec![Two(0.0, 0.0); n], off_diagonal: Vec::new() };
    for (i, k) in springs.iter().enumerate() {
        let next = i + 1;
        for end in [i, next].into_iter().filter(|end| *end < n) {
            stiffness.add(end as u32, end as u32, *k);
            exact.diagonal[end] = exact.diagonal[end].plus(Two(*k, 0.0));
        }
        if next < n {
            stiffness.add(i as u32, next as u32, -k);
            exact.off_diagonal.push(Two(-k, 0.0));
        }
        mass.add(i as u32, i as u32, 1.0);
    }
    let nodes = (0..n).map(|i| [i as f64, 0.0, 0.0]).collect();
    (Model::node_major(nodes, &[0], stiffness, mass), exact)
}

fn unit(n: usize) -> Tridiagonal {
    Tridiagonal { diagonal: vec![Two(1.0, 0.0); n], off_diagonal: vec![Two(0.0, 0.0); n - 1] }
}

/// A penalty between hub and face takes digits of all that it is added to. The bar knows how many, whatever the contrast.
#[test]
fn c_03_penalty_contrast_shows_in_the_bars() {
    let mut told = Vec::new();
    for exponent in 3..=15 {
        // Stiffnesses that are no short binary fractions.
        let mut springs: Vec<f64> = (0..30).map(|i| 0.3 + 0.01 * f64::from(i)).collect();
        springs[1] = 0.7 * 10f64.powi(exponent);
        let (model, exact) = chain_of(&springs);
        let exact = oracle::eigenvalues(&exact, &unit(30), 4, 4.0 * springs[1]);
        for eigensolver in eigensolvers() {
            let case = Case { method: "herting", ..Case::new(&model, &[rows("hub", &[0])]).count(4).by(eigensolver) };
            let outcome = match case.run() {
                // Above 1/(1024 ε) = 4·10¹² a pivot is all rounding, and the factor says so; one of K − σM, of which σ takes the
                // larger part of a spring of 0.3, from 10¹² on.
                Err(Error::NotDefinite { .. }) if exponent > 12 => continue,
                Err(Error::SturmPivot) if exponent >= 12 => continue,
                outcome => outcome.unwrap_or_else(|error| panic!("10^{exponent}, {eigensolver}: {error}")),
            };
            for ((found, exact), bar) in eigenvalues(&outcome).iter().zip(&exact).zip(bars(&outcome)) {
                let error = (found / exact - 1.0).abs();
                assert!(error <= bar, "10^{exponent}, {eigensolver}: error {error:e}, bar {bar:e}");
            }
            let largest = bars(&outcome).into_iter().fold(0.0, f64::max);
            let is_told = warnings(&outcome).contains(&"W-DATA-PRECISION");
            assert_eq!(is_told, 0.5 * largest > 1e-4, "10^{exponent}: {largest:e}");
            // Up to 10⁹ nothing fails; beyond, measures may, and the file is refused: it is never wrong silently.
            let failed = lines(&outcome, Verdict::Fail);
            assert!(failed.is_empty() || exponent > 9, "10^{exponent}: {failed:?}");
            told.push((exponent, is_told));
        }
    }
    assert!(
        told.iter().all(|(exponent, is_told)| (*exponent > 6 || !is_told) && (*exponent < 12 || *is_told)),
        "{told:?}"
    );
}

/// Elements from one to a millionth, side by side.
#[test]
fn c_04_graded_mesh_stays_within_its_bars() {
    let n = 40;
    let ratio = 1e6f64.powf(1.0 / n as f64);
    let h: Vec<f64> = (0..=n).map(|i| ratio.powi(-i)).collect();
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    let zeros = || Tridiagonal { diagonal: vec![Two(0.0, 0.0); n as usize], off_diagonal: Vec::new() };
    let (mut k, mut m) = (zeros(), zeros());
    for (element, h) in h.iter().enumerate() {
        let (left, right) = (element.checked_sub(1), (element < n as usize).then_some(element));
        for end in [left, right].into_iter().flatten() {
            stiffness.add(end as u32, end as u32, 1.0 / h);
            mass.add(end as u32, end as u32, h / 3.0);
            k.diagonal[end] = k.diagonal[end].plus(Two(1.0 / h, 0.0));
            m.diagonal[end] = m.diagonal[end].plus(Two(h / 3.0, 0.0));
        }
        if let (Some(left), Some(right)) = (left, right) {
            stiffness.add(left as u32, right as u32, -1.0 / h);
            mass.add(left as u32, right as u32, h / 6.0);
            k.off_diagonal.push(Two(-1.0 / h, 0.0));
            m.off_diagonal.push(Two(h / 6.0, 0.0));
        }
    }
    let nodes = (0..n).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let model = Model::node_major(nodes, &[0], stiffness, mass);
    let exact = oracle::eigenvalues(&k, &m, 6, 1e16);
    for eigensolver in eigensolvers() {
        let outcome = Case::new(&model, &[rows("end", &[0])]).by(eigensolver).accepted();
        for ((found, exact), bar) in eigenvalues(&outcome).iter().zip(&exact).zip(bars(&outcome)) {
            let error = (found / exact - 1.0).abs();
            assert!(error <= bar && bar <= 1e-4, "{eigensolver}: error {error:e}, bar {bar:e}");
        }
    }
}

#[test]
fn c_05_nearly_incompressible_solid() {
    let material = Material { young: 1.0, poisson: 0.499_999_9, density: 1.0 };
    let model = brick([4, 2, 2], [4.0, 2.1, 1.9], &material);
    let exact = spectrum(&model);
    // Jacobi rotations leave n ε of the largest eigenvalue, here 10⁷ times the elastic ones.
    let rounding = model.n as f64 * 1e-15 * exact[model.n - 1];
    for method in METHODS {
        Case::new(&model, &[direct("pins", &[1, 15, 33])]).method(method).accepted();
    }
    for eigensolver in eigensolvers() {
        let outcome = Case::new(&model, &[direct("pins", &[1, 15, 33])]).by(eigensolver).accepted();
        for ((found, exact), bar) in eigenvalues(&outcome).iter().zip(&exact[6..]).zip(bars(&outcome)) {
            assert!((found - exact).abs() <= rounding + bar * found, "{eigensolver}: {found} for {exact}");
            assert!(bar <= 1e-6, "{bar:e}");
        }
    }
}

/// Interface nodes 0.1, 0.025 and 0.00625 of the length apart.
#[test]
fn c_06_near_interface_nodes() {
    let model = brick([160, 1, 1], [16.0, 1.0, 1.0], &Material::UNIT);
    let waves = waves_along(&model, 16.0);
    for distance in [16, 4, 1] {
        for method in ALL {
            let pins = [direct("pins", &[1, 1 + distance, 1 + 161, 1 + 322])];
            let case = Case { files: vec![("V.mtx", waves.clone())], ..Case::new(&model, &pins).method(method) };
            let outcome = case.accepted();
            let failed_or_warned = lines(&outcome, Verdict::Warn);
            assert!(
                failed_or_warned.iter().all(|line| line.starts_with("M-23")),
                "{method}, {distance}: {failed_or_warned:?}"
            );
            if method == "rubin" {
                let left = named(&outcome, "M-22", "attachment modes are free of rigid-body motion");
                assert!(left <= 1e-12, "{distance}: {left:e}");
            }
        }
    }
}

/// Interface nodes that a spring c times as stiff as the component ties: Rubin's attachment modes stay free of rigid-body motion, and the
/// file is right by itself and against its model. A penalty that leaves a count no digits is named; without the count it is reduced and
/// verified, with the shift of its full model as far from zero as the rounding of the penalty is.
#[test]
fn c_07_tied_interface_nodes_by_the_program() {
    for contrast in [1.0, 1e4, 1e8, 1e12] {
        let mut case = Case::new(&tied(solid(), [1, 5], contrast), &[direct("pins", &[1, 5, 15, 45])]).method("rubin");
        if contrast > 1e10 {
            let error = case.refused(&["penalty", "run.certify = \"none\""]);
            assert!(matches!(error, Error::SturmPivot), "{error}");
            case.tables = "[run]\ncertify = \"none\"\n".to_owned();
        }
        let outcome = case.accepted();
        let left = named(&outcome, "M-22", "attachment modes are free of rigid-body motion");
        assert!(left <= 1e-12, "{contrast:e}: {left:e}");
        let is_named = warnings(&outcome).contains(&"W-PENALTY");
        assert_eq!(is_named, contrast >= 1e8, "{contrast:e}: {:?}", warnings(&outcome));
        case.verified();
    }
}

/// Digits that do not tell bending from nothing are the reason of what is refused, and never a mechanism.
#[test]
fn few_digits_of_a_slender_beam_are_no_mechanism() {
    let beam = brick([8, 1, 1], [1.0, 1e-3, 1e-3], &Material::STEEL_SI);
    for (digits, method) in (7..=12).flat_map(|digits| ["herting", "craig-bampton"].map(|method| (digits, method))) {
        let model = rounded(&beam, digits);
        match Case::new(&model, &[direct("ends", &[1, 10, 19, 28, 9, 18, 27, 36])]).method(method).run() {
            Ok(_) | Err(Error::DigitsTooFew { .. }) => {}
            Err(error) => panic!("{digits} digits, {method}: {error}"),
        }
    }
}

/// Cosines in all three directions along x: shapes for mode acceleration of a beam that is too large for a dense spectrum.
fn waves_along(model: &Model, length: f64) -> String {
    let wave = |k: u32, direction: u8| {
        let phase = |node: usize| f64::from(k) * std::f64::consts::PI * model.nodes[node][0] / length;
        let of = |(row, dof): (usize, &(i64, u8))| if dof.1 == direction { phase(row / 3).cos() } else { 0.0 };
        model.dofs.iter().enumerate().map(of).collect::<Vec<f64>>()
    };
    let columns: Vec<Vec<f64>> =
        (1..4).flat_map(|k| (0..3).map(move |direction| (k, direction))).map(|(k, d)| wave(k, d)).collect();
    array(&columns)
}

/// The value of a check.
#[track_caller]
fn named(outcome: &Outcome, id: &str, name: &str) -> f64 {
    let found = checks(outcome, id).into_iter().find(|check| check.name == name);
    found.unwrap_or_else(|| panic!("no {name:?} among {:?}", checks(outcome, id))).value
}

/// Inertia-relief columns together with modes: unit length and orthogonality keep M̂ well conditioned, and deflection under
/// unit accelerations is exact.
#[test]
fn c_08_inertia_relief_leaves_the_reduced_mass_well_conditioned() {
    let model = brick([10, 2, 2], [10.0, 2.1, 1.9], &Material::STEEL_SI);
    for method in ALL {
        for count in if method == "guyan" { &[0][..] } else { &[9, 19, 33] } {
            let case =
                Case { inertia_relief: true, ..Case::new(&model, &[direct("pins", &[1, 11, 97])]).method(method) };
            let outcome = case.count(*count).accepted();
            let condition = named(&outcome, "M-23", "condition of the reduced mass");
            assert!(condition <= 1e8, "{method}, {count} modes: {condition:e}");
            let deflection = named(&outcome, "M-18", "deflection under unit accelerations");
            assert!(deflection <= 1e-9, "{method}, {count} modes: {deflection:e}");
        }
    }
}

/// Columns that depend on others are left out by name, and what stays keeps its independence.
#[test]
fn c_09_dependent_columns_are_left_out_by_name() {
    let model = brick([4, 2, 2], [4.0, 2.1, 1.9], &Material::UNIT);
    let reduced = chain::reduce(&model, &[direct("pins", &[1, 15, 33])], chain::Method::Herting, 5).expect("a chain");
    let n = reduced.named.columns.ncols();
    // The last mode again, and a sum of two others with 10⁻¹⁰ of something new.
    let columns = Mat::from_fn(reduced.named.columns.nrows(), n + 2, |i, j| {
        let of = |j: usize| reduced.named.columns[(i, j)];
        match j.checked_sub(n) {
            None => of(j),
            Some(0) => of(n - 1),
            Some(_) => of(1) / of_size(&reduced.named.columns, 1) + 1e-10 * ((i * 37 % 101) as f64 / 101.0),
        }
    });
    let mut coordinates = reduced.named.coordinates.clone();
    coordinates.extend([coordinates[n - 1], coordinates[1]]);
    let basis = Basis::new(
        &reduced.constraint,
        &DynamicColumns { columns, coordinates: coordinates.clone() },
        reduced.partition.internal().mass,
    );
    assert_eq!(basis.n_dynamic(), n);
    let dropped: Vec<_> = basis.dropped.iter().map(|column| column.coordinate).collect();
    assert_eq!(dropped, coordinates[n..]);
    assert!(basis.dropped.iter().all(|column| column.remaining <= 1e-8), "{:?}", basis.dropped);
    // A chain whose interior has no mass has nothing to move by itself.
    let mut massless = supel_models::spring(20, supel_models::Ends::Free);
    massless.mass.retain(|entry| entry.0 == 0 || entry.0 == 19);
    let outcome = Case::new(&massless, &[rows("ends", &[0, 19])]).accepted();
    let dropped = &outcome.report.body.reduction.dropped;
    assert!(
        dropped.len() == 2 && dropped.iter().all(|column| column.reason.contains("of its length is left")),
        "{dropped:?}"
    );
}

fn of_size(columns: &Mat<f64>, j: usize) -> f64 {
    (0..columns.nrows()).map(|i| columns[(i, j)].powi(2)).sum::<f64>().sqrt()
}
