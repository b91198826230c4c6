//! Healthy models: every check passes, none warns.

use supel::job::{InterfaceJob, Method};
use supel::verification::check::Verdict;
use supel_models::transform::{dof_scaled, scaled, translated};
use supel_models::{Ends, Material, Model, bar, brick, known, ring, spring};

use crate::cases::{N_MODES, average, cases};
use crate::chain::{direct, rigid_group, rows};
use crate::evidence::{checks, complaints, line, with_model};

const METHODS: [Method; 2] = [Method::CraigBampton, Method::Herting];

/// Every check passes but for warnings that are true of the model, which `true_warning` names.
fn assert_warns_only(name: &str, model: &Model, interfaces: &[InterfaceJob], count: usize, true_warning: &[&str]) {
    for method in METHODS {
        with_model(model, interfaces, (method, count), |evidence| {
            let checks = checks(&evidence);
            if std::env::var_os("SHOW").is_some() {
                checks.iter().for_each(|c| println!("{name} {method:?} | {}", line(c)));
            }
            let complaints: Vec<_> = complaints(&checks)
                .into_iter()
                .filter(|(id, verdict)| *verdict == Verdict::Fail || !true_warning.contains(id))
                .collect();
            let lines: Vec<String> = checks.iter().map(line).collect();
            assert!(complaints.is_empty(), "{name}, {method:?}: {complaints:?}\n{}", lines.join("\n"));
        });
    }
}

fn assert_healthy(name: &str, model: &Model, interfaces: &[InterfaceJob], count: usize) {
    assert_warns_only(name, model, interfaces, count, &[]);
}

#[test]
fn models_of_the_theorems_pass() {
    // Mechanisms are found by a stage that this chain lacks; the stress catalogue measures them.
    for case in cases().into_iter().filter(|case| !case.name.contains("hinge")) {
        // Without rotary inertia there are more reduced coordinates than masses: M̂ is singular.
        let true_warning: &[&str] = if case.name.contains("massless") { &["M-23"] } else { &[] };
        assert_warns_only(case.name, &case.model, &case.interfaces, N_MODES, true_warning);
    }
}

#[test]
fn chains_with_closed_spectra_pass() {
    for n in [12, 60, 2000] {
        assert_healthy("free chain", &spring(n, Ends::Free), &[rows("ends", &[0, n - 1])], 6);
        assert_healthy("held chain", &spring(n, Ends::Fixed), &[rows("middle", &[n / 2])], 6);
        assert_healthy("bar", &bar(n), &[rows("middle", &[n / 3])], 6);
        assert_healthy("ring", &ring(n, 0.01), &[rows("one", &[0])], 6);
    }
    let mut lambda = vec![1.0, 1.0, 1.0, 1.0 + 1e-10, 2.0, 2.0];
    lambda.extend((3..80).map(f64::from));
    assert_healthy("known", &known(&lambda, 7), &[rows("some", &[0, 40])], 10);
}

#[test]
fn slender_and_thin_solids_pass() {
    let slender = brick([100, 1, 1], [100.0, 0.1, 0.1], &Material::UNIT);
    // Holding three corners of an end and lifting one swings the other end a thousand times as far.
    assert_warns_only("slender", &slender, &[direct("ends", &[1, 102, 203, 101])], 6, &["M-23"]);
    // Three nodes a thousandth of the length apart react its rotations a thousand times worse than its translations.
    assert_warns_only("slender, one end", &slender, &[direct("end", &[1, 102, 203])], 6, &["M-23"]);
    let plate = brick([30, 30, 1], [1.0, 1.0, 1e-3], &Material::UNIT);
    // c = 10¹¹: the roundings of the program that wrote K may shift a frequency by more than a tenth of a per mille.
    assert_warns_only("plate", &plate, &[direct("corners", &[1, 31, 931])], 6, &["M-09"]);
    let beam = brick([20, 2, 2], [10.0, 1.0, 1.0], &Material::UNIT);
    assert_healthy("beam", &beam, &[direct("end", &[1, 22, 64])], 12);
}

/// A plate of one layer of elements twists a hundred thousand times more softly than its corners give way in their plane: its first
/// mode has an eigenvalue of 10⁻⁹ of the largest of K̂ and is known to ten digits.
#[test]
fn soft_modes_of_a_stiff_interface_are_no_zero_modes() {
    for thickness in [10.0, 1.2] {
        let plate = brick([12, 10, 1], [1200.0, 1000.0, thickness], &Material::STEEL_MM_T_S);
        assert_healthy("plate by its corners", &plate, &[direct("corners", &[1, 13, 131, 143, 144])], 12);
        let bar = brick([60, 1, 1], [1000.0, 0.9 * thickness, thickness], &Material::STEEL_MM_T_S);
        assert_healthy("bar by its ends", &bar, &[direct("ends", &[1, 61, 62, 123, 181])], 12);
    }
}

/// K̂ of a free component that one patch holds is rounding at the interface. In which unit a rotation is worth more than a mode is no matter.
#[test]
fn one_patch_holds_a_free_component_in_any_unit_of_length() {
    let part = brick([5, 2, 2], [0.25, 0.1, 0.08], &Material::STEEL_SI);
    for unit in [1.0, 1e3, 1e6, 1e9] {
        let mut model = scaled(&part, 1.0 / unit, 1.0 / unit);
        model.nodes.iter_mut().flatten().for_each(|x| *x *= unit);
        for interface in [rigid_group("XMIN"), average("XMIN")] {
            assert_healthy(&format!("one patch, unit {unit:e}"), &model, &[interface], 6);
        }
    }
}

#[test]
fn units_and_places_do_not_matter() {
    let beam = brick([10, 2, 2], [10.0, 1.1, 0.9], &Material::UNIT);
    let interface = [direct("ends", &[1, 12, 34, 99])];
    for (k, m) in [(1e12, 1e-12), (1e-6, 1e3), (1e150, 1e-150)] {
        assert_healthy("scaled", &scaled(&beam, k, m), &interface, 6);
    }
    assert_healthy("far away", &translated(&beam, [1e4, -3e3, 7.0]), &interface, 6);
    let anonymous = Model { dofs: Vec::new(), ..beam };
    let factors: Vec<f64> = (0..anonymous.n).map(|i| [1.0, 1e3, 1e-5][i % 3]).collect();
    let rows = rows("ends", &[0, 1, 2, 33, 34, 35, 99, 100, 101, 294, 295, 296]);
    assert_healthy("dof scaled", &dof_scaled(&anonymous, &factors), &[rows], 6);
}
