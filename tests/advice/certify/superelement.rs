//! Superelements of other programs with their basis.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::transform::supported;
use supel_testing::pencil::{eigen, matrices, part};
use supel_testing::place::{Ended, Place, steel_brick, supel};
use supel_testing::schema::{assert_follows, validator};

use super::{array, assert_near};

/// A superelement as another program would write it.
#[derive(Clone)]
pub(super) struct Foreign {
    pub(super) basis: Mat<f64>,
    pub(super) stiffness: Mat<f64>,
    pub(super) mass: Mat<f64>,
}

fn projected(a: &Mat<f64>, basis: &Mat<f64>) -> Mat<f64> {
    basis.transpose() * a * basis
}

impl Foreign {
    pub(super) fn of(model: &Model, basis: Mat<f64>) -> Self {
        let [k, m] = matrices(model);
        Self { stiffness: projected(&k, &basis), mass: projected(&m, &basis), basis }
    }

    /// Craig and Bampton's with some rows as its interface, by dense algebra: Ψ = [I; −K_II⁻¹K_IB  Φ], an interface last.
    pub(super) fn craig_bampton(model: &Model, interface: &[usize], n_modes: usize) -> Self {
        let [k, m] = matrices(model);
        let inner: Vec<usize> = (0..model.n).filter(|row| !interface.contains(row)).collect();
        let k_ii = part(k.as_ref(), &inner);
        let k_ib = Mat::from_fn(inner.len(), interface.len(), |i, j| k[(inner[i], interface[j])]);
        let statics = k_ii.llt(Side::Lower).expect("definite").solve(&k_ib);
        let (_, modes) = eigen(k_ii.as_ref(), part(m.as_ref(), &inner).as_ref(), 1e6);
        let mut basis = Mat::zeros(model.n, n_modes + interface.len());
        for (i, row) in inner.iter().enumerate() {
            (0..n_modes).for_each(|j| basis[(*row, j)] = modes[(i, j)]);
            (0..interface.len()).for_each(|j| basis[(*row, n_modes + j)] = -statics[(i, j)]);
        }
        interface.iter().enumerate().for_each(|(j, row)| basis[(*row, n_modes + j)] = 1.0);
        Self::of(model, basis)
    }

    pub(super) fn write(&self, place: &Place) {
        let columns = |a: &Mat<f64>| -> Vec<Vec<f64>> {
            (0..a.ncols()).map(|j| (0..a.nrows()).map(|i| a[(i, j)]).collect()).collect()
        };
        place.write("psi.mtx", array(&columns(&self.basis)).as_bytes());
        for (name, matrix) in [("khat.mtx", &self.stiffness), ("mhat.mtx", &self.mass)] {
            let r = matrix.nrows();
            let mut text = format!("%%MatrixMarket matrix coordinate real general\n{r} {r} {}\n", r * r);
            for j in 0..r {
                (0..r).for_each(|i| {
                    text += &format!("{} {} {:e}\n", i + 1, j + 1, 0.5 * (matrix[(i, j)] + matrix[(j, i)]))
                });
            }
            place.write(name, text.as_bytes());
        }
    }
}

/// Nodes of the block at three corners of one end and one at the other, all of whose dofs are the interface.
pub(super) fn interface() -> Vec<usize> {
    [0, 2, 8, 44].into_iter().flat_map(|node| (3 * node..).take(3)).collect()
}

pub(super) fn certify(place: &Place, rest: &str) -> Ended {
    let paths =
        ["K.mtx", "M.mtx", "psi.mtx", "khat.mtx", "mhat.mtx", "dofs.txt", "nodes.csv"].map(|name| place.text(name));
    let [k, m, psi, khat, mhat, dofs, nodes] = &paths;
    let mut args: Vec<&str> = vec!["certify", k, m, psi, "--reduced-stiffness", khat, "--reduced-mass", mhat];
    args.extend(["--dofs", dofs, "--nodes", nodes]);
    args.extend(rest.split_whitespace());
    supel(&args)
}

#[track_caller]
pub(super) fn document(model: &Model, foreign: &Foreign, code: ExitCode) -> Value {
    let place = Place::with(model);
    foreign.write(&place);
    serde_json::from_str(&certify(&place, "--json").expect(code).out).expect("JSON")
}

/// Identifier, verdict and worst place of the checks that fail.
pub(super) fn failed(document: &Value) -> Vec<(String, String)> {
    let checks = document["checks"].as_array().expect("checks").iter();
    let text = |check: &Value, key: &str| check[key].as_str().unwrap_or_default().to_owned();
    checks.filter(|check| check["verdict"] == "fail").map(|check| (text(check, "id"), text(check, "worst"))).collect()
}

#[test]
fn a_right_one_is_certified_and_compared_at_its_interface() {
    let foreign = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let found = document(&steel_brick(), &foreign, ExitCode::Done);
    assert_eq!((&found["n_coordinates"], &found["n_interface"]), (&24.into(), &12.into()), "{found}");
    assert_eq!((&found["n_rigid"], &found["n_without_stiffness"]), (&6.into(), &6.into()));
    let preservation = &found["preservation"];
    assert_eq!(preservation["statics"].as_array().expect("statics").len(), 4, "an interface for each node");
    let boundaries: Vec<&str> = preservation["boundaries"]
        .as_array()
        .expect("boundaries")
        .iter()
        .filter_map(|line| line["boundary"].as_str())
        .collect();
    assert_eq!(boundaries.len(), 9, "free, each held, each loaded: {boundaries:?}");
    assert!(preservation["response"].is_object(), "{preservation}");
    let ids: Vec<&str> =
        found["checks"].as_array().expect("checks").iter().filter_map(|check| check["id"].as_str()).collect();
    for id in ["C-07", "C-08", "C-09", "M-06", "M-11", "M-12", "M-16", "M-17", "M-20", "M-23", "M-24", "M-25"] {
        assert!(ids.contains(&id), "{id} in {ids:?}");
    }
    // The interface free, one comparison pairs by shape and the other by number, and of all pairings that one has the smallest
    // largest difference.
    let [free, again] =
        [&found["free"], &preservation["boundaries"][0]].map(|line| line["worst_in_band"].as_f64().expect("a number"));
    assert!(free >= again - 1e-6 && again > 0.0, "{free} and {again}");
}

/// What keeps all rows has no modes with its interface held, and none that it could lack.
#[test]
fn one_that_keeps_all_rows_is_certified() {
    let model = supel_models::brick([2, 1, 1], [1.0, 0.1, 0.1], &supel_models::Material::STEEL_SI);
    let foreign = Foreign::of(&model, Mat::identity(model.n, model.n));
    let found = document(&model, &foreign, ExitCode::Done);
    assert_eq!(found["n_interface"], Value::from(model.n), "{found}");
    assert_eq!(super::verdict(&found, "C-07"), Some("pass"), "{found}");
}

#[test]
fn matrices_of_another_basis_are_named_by_their_coordinates() {
    let right = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let mut wrong = right.clone();
    wrong.stiffness[(12, 12)] *= 1.05;
    let found = failed(&document(&steel_brick(), &wrong, ExitCode::CheckFailed));
    let (_, worst) = found.iter().find(|(id, _)| id == "C-07").expect("C-07");
    assert!(worst.contains("coordinate 13 (node 1 ux)") && worst.contains("1.05 times as large"), "{worst}");
    let mut heavy = right.clone();
    heavy.mass *= faer::Scale(1.02);
    let found = failed(&document(&steel_brick(), &heavy, ExitCode::CheckFailed));
    assert!(found.iter().any(|(id, worst)| id == "M-16" && worst.contains("1.02 of its mass")), "{found:?}");
    assert!(found.iter().any(|(id, worst)| id == "C-07" && worst.contains("1.02 times as large")), "{found:?}");
    // Amplitudes without stiffness are motions without energy, at zero or a rounding below it: no sample of a response lies there.
    for energy in [0.0, -1e-6] {
        let mut loose = right.clone();
        (12..24).for_each(|i| (12..24).for_each(|j| loose.stiffness[(i, j)] = if i == j { energy } else { 0.0 }));
        let found = document(&steel_brick(), &loose, ExitCode::CheckFailed);
        assert!(
            !found["checks"].to_string().contains("NaN") && !found["preservation"]["response"].is_null(),
            "{found}"
        );
    }
    let mut negative = right;
    negative.mass[(3, 3)] *= -1.0;
    let found = failed(&document(&steel_brick(), &negative, ExitCode::CheckFailed));
    assert!(found.iter().any(|(id, _)| id == "M-25"), "{found:?}");
}

/// K̂ is right, and M̂ is some times too large or lacks the coupling of static columns and amplitudes.
#[test]
fn a_wrong_mass_takes_no_stiffness_away() {
    let right = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let times = |factor: f64| Foreign { mass: &right.mass * faer::Scale(factor), ..right.clone() };
    let mut uncoupled = right.clone();
    for (i, j) in (0..12).flat_map(|i| (12..24).map(move |j| (i, j))) {
        uncoupled.mass[(i, j)] = 0.0;
        uncoupled.mass[(j, i)] = 0.0;
    }
    for wrong in [times(4.0), times(100.0), times(1e6), times(1e-6), uncoupled] {
        let found = document(&steel_brick(), &wrong, ExitCode::CheckFailed);
        assert_eq!(found["n_without_stiffness"], 6, "{found}");
        let failed = failed(&found);
        assert!(failed.iter().all(|(id, _)| id != "M-12"), "{failed:?}");
        let said = |id: &str, words: &str| failed.iter().any(|(found, worst)| found == id && worst.contains(words));
        assert!(said("C-07", "times as large"), "{failed:?}");
        assert!(!said("C-08", "which it has not"), "{failed:?}");
    }
    let found = failed(&document(&steel_brick(), &times(100.0), ExitCode::CheckFailed));
    let words = "in the superelement, by its mass, which is not that of the basis";
    assert!(found.iter().any(|(id, worst)| id == "C-08" && worst.ends_with(words)), "{found:?}");
    // All of K̂ too soft leaves as many motions free.
    let soft = Foreign { stiffness: &right.stiffness * faer::Scale(1e-4), ..right };
    let found = document(&steel_brick(), &soft, ExitCode::CheckFailed);
    assert_eq!(found["n_without_stiffness"], 6, "{found}");
    assert!(found["checks"].to_string().contains("by its stiffness, which is not that of the basis"), "{found}");
}

/// A rigid body has no stiffness and no elastic modes, and a superelement of it neither.
#[test]
fn one_of_a_stiffness_of_zeros_is_certified() {
    let place = Place::new();
    place.write("K.mtx", b"%%MatrixMarket matrix coordinate real symmetric\n6 6 1\n1 1 0.\n");
    let mass = "%%MatrixMarket matrix coordinate real symmetric\n6 6 8\n1 1 2.\n2 2 2.\n3 3 2.\n4 4 .1\n5 5 .2\n6 6 .25\n5 3 -.02\n6 2 .02\n";
    place.write("M.mtx", mass.as_bytes());
    place.write("nodes.csv", b"node,x,y,z\n1,0.,0.,0.\n");
    place.write("dofs.txt", b"1.1\n1.2\n1.3\n1.4\n1.5\n1.6\n");
    place.write("khat.mtx", &place.bytes("K.mtx"));
    place.write("mhat.mtx", mass.as_bytes());
    let unit = |j: usize| (0..6).map(|i| f64::from(u8::from(i == j))).collect();
    place.write("psi.mtx", array(&(0..6).map(unit).collect::<Vec<Vec<f64>>>()).as_bytes());
    let ended = certify(&place, "--json").expect(ExitCode::Done);
    let found: Value = serde_json::from_str(&ended.out).expect("JSON");
    assert_eq!((&found["n_rigid"], &found["n_without_stiffness"]), (&6.into(), &6.into()), "{found}");
    assert!(failed(&found).is_empty() && !ended.out.contains("NaN"), "{found}");
    assert!(found["preservation"]["not_compared"].to_string().contains("no elastic mode"), "{found}");
    place.write("mhat.mtx", mass.replace("4 4 .1", "4 4 .2").as_bytes());
    let ended = certify(&place, "--json").expect(ExitCode::CheckFailed);
    let found = failed(&serde_json::from_str(&ended.out).expect("JSON"));
    assert!(found.iter().all(|(id, _)| ["C-07", "M-16"].contains(&id.as_str())) && found.len() == 2, "{found:?}");
}

/// K̂ and M̂ are those of the basis, and the basis is a poor one: its static columns do not solve the full model.
#[test]
fn a_basis_without_static_answers_fails_in_statics() {
    let right = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let mut basis = right.basis;
    // The motion of one interface dof is stretched inside, by a mode of the held interface, and rigid-body motion with it.
    (0..basis.nrows()).for_each(|row| basis[(row, 12)] += 1e-2 * basis[(row, 3)] / basis.col(3).norm_max());
    let found = document(&steel_brick(), &Foreign::of(&steel_brick(), basis), ExitCode::Done);
    let notes = found["preservation"]["not_compared"].to_string();
    assert!(notes.contains("does not carry the component as a rigid body"), "{notes}");
    assert_eq!(super::verdict(&found, "M-33"), Some("warn"), "{found}");
    // Without its modes the same columns do not span what they have to.
    let found = failed(&document(&steel_brick(), &guyan_turned(), ExitCode::CheckFailed));
    assert!(found.iter().any(|(id, _)| id == "M-11"), "{found:?}");
}

/// Static columns with a stretched one, and no modes to make up for it.
fn guyan_turned() -> Foreign {
    let with_modes = Foreign::craig_bampton(&steel_brick(), &interface(), 1);
    let mut basis = Mat::from_fn(with_modes.basis.nrows(), 12, |i, j| with_modes.basis[(i, j + 1)]);
    (0..basis.nrows())
        .for_each(|row| basis[(row, 0)] += 0.1 * with_modes.basis[(row, 0)] / with_modes.basis.col(0).norm_max());
    Foreign::of(&steel_brick(), basis)
}

#[test]
fn a_spring_to_ground_costs_energy() {
    let mut grounded = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    grounded.stiffness[(14, 14)] *= 1.5;
    let found = failed(&document(&steel_brick(), &grounded, ExitCode::CheckFailed));
    assert!(found.iter().filter(|(id, _)| id == "M-12").count() >= 1, "{found:?}");
}

#[test]
fn one_of_modes_alone_has_no_interface() {
    let [k, m] = matrices(&steel_brick());
    let (_, shapes) = eigen(k.as_ref(), m.as_ref(), 1e6);
    let modal = Foreign::of(&steel_brick(), Mat::from_fn(shapes.nrows(), 18, |i, j| shapes[(i, j)]));
    let found = document(&steel_brick(), &modal, ExitCode::Done);
    assert_eq!((&found["n_interface"], &found["preservation"]), (&0.into(), &Value::Null), "{found}");
    assert!(found["notes"].to_string().contains("there is no interface"), "{found}");
    for pair in found["free"]["frequencies"].as_array().expect("pairs").iter().take(8) {
        assert_near(pair["reduced_hz"].as_f64().expect("Hz"), pair["full_hz"].as_f64().expect("Hz"), 1e-8);
    }
    // What K̂ has of rigid-body motion is rounding, whatever its pattern.
    let mut rounded = Foreign::of(&steel_brick(), Mat::from_fn(shapes.nrows(), 18, |i, j| shapes[(i, j)]));
    let noise = f64::EPSILON * rounded.stiffness[(17, 17)];
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        rounded.stiffness[(i, j)] = if i == j { 1e-3 * noise } else { noise };
    }
    document(&steel_brick(), &rounded, ExitCode::Done);
    // One mode left out is one that the frequencies miss.
    let without: Vec<usize> = (0..18).filter(|mode| *mode != 8).collect();
    let lost = Foreign::of(&steel_brick(), Mat::from_fn(shapes.nrows(), 17, |i, j| shapes[(i, without[j])]));
    let found = failed(&document(&steel_brick(), &lost, ExitCode::CheckFailed));
    assert!(found.iter().any(|(id, worst)| id == "C-09" && worst.contains("has 0.0 %")), "{found:?}");
}

/// Coordinates in other units than the rows they move are amplitudes: a row that moves by a half is no coordinate.
#[test]
fn a_row_of_half_a_coordinate_is_no_interface() {
    let right = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let columns = right.basis.ncols();
    let halved =
        Mat::from_fn(right.basis.nrows(), columns, |i, j| right.basis[(i, j)] * if j >= 12 { 0.5 } else { 1.0 });
    let found = document(&steel_brick(), &Foreign::of(&steel_brick(), halved), ExitCode::Done);
    assert_eq!((&found["n_interface"], &found["preservation"]), (&0.into(), &Value::Null), "{found}");
}

#[test]
fn one_that_is_held_says_where() {
    let held: Vec<usize> = (0..27).collect();
    let rest: Vec<usize> = (27..135).collect();
    let [k, m] = matrices(&steel_brick());
    let (_, shapes) = eigen(part(k.as_ref(), &rest).as_ref(), part(m.as_ref(), &rest).as_ref(), 1e6);
    let basis = Mat::from_fn(135, 10, |i, j| if held.contains(&i) { 0.0 } else { shapes[(i - 27, j)] });
    let foreign = Foreign::of(&steel_brick(), basis);
    let found = document(&steel_brick(), &foreign, ExitCode::CheckFailed);
    let notes = found["notes"].to_string();
    assert!(notes.contains("27 rows of the model no column of the basis moves, node 1 ux"), "{notes}");
    // Held here too, all is well.
    let model = supported(&steel_brick(), |(label, _)| label <= 9);
    let [k, m] = matrices(&model);
    let (_, shapes) = eigen(k.as_ref(), m.as_ref(), 1e6);
    let foreign = Foreign::of(&model, Mat::from_fn(model.n, 10, |i, j| shapes[(i, j)]));
    let found = document(&model, &foreign, ExitCode::Done);
    assert_eq!((&found["n_rigid"], &found["n_without_stiffness"]), (&0.into(), &0.into()), "{found}");
}

#[test]
fn document_page_and_suite() {
    let place = Place::with(&steel_brick());
    Foreign::craig_bampton(&steel_brick(), &interface(), 12).write(&place);
    let [html, junit] = ["x.html", "x.xml"].map(|name| place.text(name));
    let text = certify(&place, &format!("--html {html} --junit {junit}")).expect(ExitCode::Done).out;
    assert!(
        text.contains("135 → 24 degrees of freedom") && text.contains("12 of them rows of K, its interface"),
        "{text}"
    );
    let [html, junit] = ["x.html", "x.xml"].map(|name| String::from_utf8(place.bytes(name)).expect("UTF-8"));
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(&html, options).expect("well-formed");
    assert!(html.contains("Certification of a superelement"), "{html}");
    roxmltree::Document::parse(&junit).expect("well-formed");
    assert!(junit.contains("a superelement of 24 coordinates"), "{junit}");
    let schema = validator("certified-superelement");
    let [full, modal] = [Foreign::craig_bampton(&steel_brick(), &interface(), 12), guyan_turned()];
    for (foreign, code) in [(full, ExitCode::Done), (modal, ExitCode::CheckFailed)] {
        let found = document(&steel_brick(), &foreign, code);
        assert_follows(&schema, &found);
    }
}

#[test]
fn matrices_of_another_size_are_refused() {
    let place = Place::with(&steel_brick());
    let foreign = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let short = Mat::from_fn(135, 23, |i, j| foreign.basis[(i, j)]);
    Foreign { basis: short, ..foreign }.write(&place);
    let ended = certify(&place, "").expect(ExitCode::InputData);
    assert!(ended.err.contains("E-REDUCED-SIZE") && ended.err.contains("found 24 rows –"), "{}", ended.err);
    // Frequencies are those of pairs.
    let ended = certify(&place, "--hz 1,2").expect(ExitCode::Usage);
    assert!(ended.err.contains("--reduced-stiffness"), "{}", ended.err);
}

/// A band that ends below the first elastic mode has no mode of the component in it, and motions without stiffness are the same ones.
#[test]
fn a_band_below_the_first_elastic_mode_counts_no_more_motions_without_stiffness() {
    let place = Place::with(&steel_brick());
    Foreign::craig_bampton(&steel_brick(), &interface(), 12).write(&place);
    for band in ["0,1", "0,10"] {
        let ended = certify(&place, &format!("--json --band {band}")).expect(ExitCode::Done);
        let found: Value = serde_json::from_str(&ended.out).expect("JSON");
        assert_eq!((&found["n_rigid"], &found["n_without_stiffness"]), (&6.into(), &6.into()), "{found}");
    }
}

/// Courant and Fischer count from the lowest eigenvalue of all: a basis that lacks a rigid-body motion has one elastic mode more, and none of its
/// frequencies is too low for that.
#[test]
fn a_basis_without_a_rigid_body_motion_has_no_frequency_too_low() {
    let [k, m] = matrices(&steel_brick());
    let (lambda, shapes) = eigen(k.as_ref(), m.as_ref(), 1e6);
    let (first, far) = (lambda[6], lambda[40]);
    // The quotient of the first column, of unit mass in both parts, is 0.7 of the first elastic eigenvalue.
    let share = (0.7 * first / (far - 0.7 * first)).sqrt();
    let mixed = |i: usize, j: usize| shapes[(i, j)] + if j == 0 { share * shapes[(i, 40)] } else { 0.0 };
    let foreign = Foreign::of(&steel_brick(), Mat::from_fn(shapes.nrows(), 18, mixed));
    let found = document(&steel_brick(), &foreign, ExitCode::CheckFailed);
    assert_eq!(found["n_without_stiffness"], 5, "{found}");
    assert_eq!(super::verdict(&found, "M-24"), Some("pass"), "{found}");
    assert_eq!(super::verdict(&found, "M-11"), Some("fail"), "{found}");
}
