//! Modes that nothing starts and nothing sees have no coordinate where the scene chooses the modes or says what is looked at inside.
//!
//! A block with one end at rest, joined at the middle line of the other end in its plane of symmetry, and looked at on its axis: torsion moves
//! neither, nor does gravity start it.

use faer::Mat;
use serde_json::Value;
use supel::cli::ExitCode;
use supel::dense::{symmetric_eigen, unpacked};
use supel_models::Model;
use supel_models::springs::springs;
use supel_runtime::{DropCause, Matrix, Metadata, Superelement, Tensors};

use crate::place::{Place, supel};

const OUTPUTS: &str = "outputs = { nodes = [23] }, boundaries = [\"free\"], band_hz = [0, 2000]";

/// The job of the block by a method, with the modes, the scene and further tables.
fn write_job(place: &Place, (method, modes): (&str, &str), scene: &str, rest: &str) {
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
         fixed = [{{ name = \"wall\", nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41] }}]\n\
         interface = [{{ name = \"tip\", nodes = [10, 25, 40], dofs = [\"ux\", \"uz\"] }}]\n\
         reduction = {{ method = \"{method}\", modes = {{ {modes} }} }}\n\
         scene = {{ {scene} }}\n\
         write = {{ superelement = \"x.supel\", html = \"x.html\" }}\n{rest}"
    );
    place.write("job.toml", text.as_bytes());
}

fn reduced(place: &Place, more: &[&str]) -> (Superelement, Value) {
    supel(&[&["reduce", &place.text("job.toml")], more].concat()).expect(ExitCode::Done);
    (place.superelement("x.supel"), place.report("x.report.json")["body"].take())
}

/// Numbers of the modes that have no coordinate because nothing sees them.
fn left_out(file: &Superelement) -> Vec<usize> {
    file.metadata().unseen_modes().collect()
}

/// The verification against the job, and how it ended.
fn verified(place: &Place, name: &str) -> (Value, ExitCode) {
    let ended = supel(&["verify", &place.text(name), "--job", &place.text("job.toml"), "--json"]);
    (serde_json::from_str(&ended.out).unwrap_or_else(|_| panic!("{}{}", ended.out, ended.err)), ended.code)
}

/// Checks that fail, by their identifiers.
fn failed(audit: &Value) -> Vec<&str> {
    let checks = audit["checks"].as_array().expect("checks").iter();
    checks
        .filter(|check| check["verdict"] == "fail")
        .map(|check| check["id"].as_str().expect("an identifier"))
        .collect()
}

fn check<'a>(document: &'a Value, id: &str) -> &'a Value {
    document["checks"].as_array().expect("checks").iter().find(|check| check["id"] == id).expect(id)
}

/// Rows and columns of a square matrix.
fn part(matrix: &Matrix, kept: &[usize]) -> Matrix {
    Matrix::from_fn(kept.len(), kept.len(), |i, j| matrix[(kept[i], kept[j])])
}

/// Torsion is left out by name, of every method; all that is kept has the bits that it has with `--no-skip`.
#[test]
fn torsion_has_no_coordinate_and_nothing_else_changes() {
    let place = Place::with_brick();
    for method in ["craig-bampton", "herting", "macneal"] {
        write_job(
            &place,
            (method, "count = 10"),
            OUTPUTS,
            "load = [{ name = \"pull\", nodes = [25], force = [1, 0, 0] }]\n",
        );
        let (all, _) = reduced(&place, &["--no-skip"]);
        let (some, body) = reduced(&place, &[]);
        let unseen = left_out(&some);
        assert!(!unseen.is_empty() && left_out(&all).is_empty(), "{method}: {unseen:?}");
        assert_eq!(all.tensors().frequencies, some.tensors().frequencies, "{method}");
        assert_eq!(some.n_coordinates() + unseen.len(), all.n_coordinates(), "{method}");
        let is_kept = |at: &usize| some.metadata().coordinates.contains(&all.metadata().coordinates[*at]);
        let kept: Vec<usize> = (0..all.n_coordinates()).filter(is_kept).collect();
        for (a, b) in
            [(&all.tensors().stiffness, &some.tensors().stiffness), (&all.tensors().mass, &some.tensors().mass)]
        {
            assert_eq!(&part(a, &kept), b, "{method}");
        }
        // Neither loads nor interface have anything of what is gone, and of the rows on the axis it has nothing either.
        let of = |file: &Superelement| file.tensors().load_vectors.clone().expect("a load");
        for (at, slot) in kept.iter().zip(0..) {
            assert_eq!(of(&all)[(*at, 0)], of(&some)[(slot, 0)], "{method}");
        }
        let rows = |file: &Superelement| file.tensors().recovery.as_ref().expect("rows of the output").rows().clone();
        let (all_rows, some_rows) = (rows(&all), rows(&some));
        assert_eq!(Matrix::from_fn(3, kept.len(), |i, j| all_rows[(i, kept[j])]), some_rows, "{method}");
        let largest = all_rows.as_slice().iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
        let is_at_rest = |at: usize| (0..3).all(|row| all_rows[(row, at)].abs() <= 1e-6 * largest);
        assert!((0..all.n_coordinates()).filter(|at| !kept.contains(at)).all(is_at_rest), "{method}");
        told(&place, (&some, &body), &unseen);
        let (audit, code) = verified(&place, "x.supel");
        assert_eq!(code, ExitCode::Done, "{method}: {audit:#}");
        let counts = audit["checks"].as_array().expect("checks").iter().filter(|check| check["id"] == "M-06");
        let words = format!("10 stated, {} of them left out", unseen.len());
        assert!(counts.map(|check| check["worst"].to_string()).any(|worst| worst.contains(&words)), "{method}");
        supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
    }
}

/// Report, page, plan and file say what was left out, why, and what that takes for granted; the count says that every mode was found.
fn told(place: &Place, (file, body): (&Superelement, &Value), unseen: &[usize]) {
    let metadata = file.metadata();
    let assumes = |words: &str| metadata.validity.assumptions.iter().any(|assumption| assumption.contains(words));
    assert!(assumes("starts at rest") && assumes("as the loads pull") && assumes("no output of the scene sees"));
    for dropped in metadata.dropped.iter().filter(|dropped| dropped.cause == DropCause::Unseen) {
        assert!(dropped.reason.contains("nothing starts it"), "{}", dropped.reason);
    }
    let listed = body["reduction"]["dropped"].as_array().expect("a list");
    for mode in unseen {
        let name = format!("mode {}", mode + 1);
        let row = listed.iter().find(|row| row["coordinate"] == name.as_str()).expect("the mode");
        assert!(row["reason"].as_str().is_some_and(|reason| reason.contains("Hz: nothing starts it")), "{row}");
    }
    assert!(body["reduction"]["skipped"].to_string().contains("K-20"), "{}", body["reduction"]["skipped"]);
    assert_eq!(body["reduction"]["n_reduced"], file.n_coordinates());
    assert_eq!(check(body, "M-35")["verdict"], "pass");
    let words = check(body, "M-06")["worst"].as_str().expect("words").to_owned();
    assert!(
        words.contains(&format!(
            "counted 10, found 10 ({} in the superelement, {} left out)",
            10 - unseen.len(),
            unseen.len()
        )),
        "{words}"
    );
    let page = String::from_utf8(place.bytes("x.html")).expect("text");
    assert!(page.contains("nothing starts it"), "the page has them");
    let plan = supel(&["plan", &place.text("job.toml")]).expect(ExitCode::Done).out;
    assert!(plan.contains("starts at rest"), "{plan}");
    let inspected = supel(&["inspect", &place.text("x.supel")]).expect(ExitCode::Done);
    assert!(inspected.out.contains("nothing starts it"), "{}", inspected.out);
}

/// A scene that chooses the modes leaves them out without outputs, and its limits hold for the file.
#[test]
fn modes_chosen_by_target_are_without_those_that_nothing_sees() {
    let place = Place::with_brick();
    let scene = "band_hz = [0, 4000], boundaries = [\"free\", \"fix:tip\"], accept = { frequency = 1e-3 }";
    write_job(&place, ("craig-bampton", "accept = true"), scene, "");
    let (file, body) = reduced(&place, &[]);
    let unseen = left_out(&file);
    assert!(!unseen.is_empty(), "{}", body["reduction"]["modes"]);
    assert_eq!(check(&body, "M-29")["verdict"], "pass");
    let (audit, code) = verified(&place, "x.supel");
    assert_eq!(code, ExitCode::Done, "{audit:#}");
    let value = |document: &Value| check(document, "M-29")["value"].as_f64().expect("a number");
    assert!((value(&audit) / value(&body) - 1.0).abs() < 1e-6, "{} and {}", value(&audit), value(&body));
    // Where the job says how many, and nobody says what is looked at, all stay.
    write_job(&place, ("craig-bampton", "count = 10"), "band_hz = [0, 4000]", "");
    assert!(left_out(&reduced(&place, &[]).0).is_empty());
}

/// A file without one of its coordinates, which it says that nothing sees.
fn without(file: &Superelement, at: usize) -> Superelement {
    let kept: Vec<usize> = (0..file.n_coordinates()).filter(|other| *other != at).collect();
    let rows = |matrix: &Matrix| Matrix::from_fn(kept.len(), matrix.cols(), |i, j| matrix[(kept[i], j)]);
    let (mut tensors, mut metadata): (Tensors, Metadata) = (file.tensors().clone(), file.metadata().clone());
    tensors.stiffness = part(&tensors.stiffness, &kept);
    tensors.mass = part(&tensors.mass, &kept);
    tensors.rigid_body_modes = rows(&tensors.rigid_body_modes);
    tensors.gravity = tensors.gravity.as_ref().map(rows);
    let recovery = tensors.recovery.as_ref().expect("rows");
    let values = Matrix::from_fn(recovery.rows().rows(), kept.len(), |i, j| recovery.rows()[(i, kept[j])]);
    let again = supel_runtime::Recovery::new(values, recovery.dofs().to_vec(), recovery.precision()).expect("rows");
    tensors.recovery = Some(again.with_positions(recovery.positions().expect("positions").to_vec()).expect("as many"));
    let column = metadata.coordinates.remove(at);
    let mut dropped = metadata.dropped[0].clone();
    dropped.column = column;
    metadata.dropped.push(dropped);
    metadata.dropped.sort_by_key(|dropped| dropped.column.mode().map(|(mode, _)| mode));
    Superelement::new(tensors, metadata).expect("a superelement still")
}

/// A mode that the interface sees was taken out of the file, and said to be one that nothing sees: the model tells.
#[test]
fn a_mode_that_is_seen_and_said_to_be_left_out_is_found() {
    let place = Place::with_brick();
    write_job(&place, ("craig-bampton", "count = 10"), OUTPUTS, "");
    let (file, _) = reduced(&place, &[]);
    for at in file.n_interface()..file.n_coordinates() {
        without(&file, at).write(&place.path("less.supel")).expect("written");
        let (audit, code) = verified(&place, "less.supel");
        assert_eq!(code, ExitCode::CheckFailed);
        assert!(failed(&audit).contains(&"M-35"), "{at}: {:?}", failed(&audit));
    }
    // The file under a job whose outputs see torsion, which no matrix of the file tells, and under one that keeps every mode.
    for scene in [OUTPUTS.replace("23", "5"), "boundaries = [\"free\"]".to_owned()] {
        write_job(&place, ("craig-bampton", "count = 10"), &scene, "");
        let (audit, code) = verified(&place, "x.supel");
        assert_eq!((code, failed(&audit).contains(&"M-35")), (ExitCode::CheckFailed, true), "{:?}", failed(&audit));
    }
}

/// A damper at a corner ties torsion to bending, and torsion stays; one on the axis does not.
#[test]
fn a_damper_that_ties_a_mode_to_others_keeps_it() {
    let place = Place::with_brick();
    let dofs = String::from_utf8(place.bytes("dofs.txt")).expect("text");
    let n = dofs.lines().filter(|line| line.starts_with(|first: char| first.is_ascii_digit())).count();
    let damped = |node: usize| {
        // Rows go node by node, along x, y and z.
        let row = 3 * (node - 1) + 2;
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} 1\n{row} {row} 20.0\n");
        place.write("C.mtx", text.as_bytes());
        let rest = "matrix = [{ name = \"damper\", kind = \"damping\", file = \"C.mtx\" }]\n";
        write_job(&place, ("herting", "count = 10"), OUTPUTS, rest);
        let (file, body) = reduced(&place, &[]);
        let (audit, code) = verified(&place, "x.supel");
        assert_eq!(code, ExitCode::Done, "{node}: {:?}", failed(&audit));
        (left_out(&file), body["reduction"]["unseen"].as_array().expect("numbers").len())
    };
    let (on_axis, n_unseen) = damped(24);
    assert_eq!(on_axis.len(), n_unseen);
    assert!(n_unseen > 0);
    assert_eq!(damped(5), (Vec::new(), n_unseen));
}

/// Two pendulums of one kind inside a body: against each other they move nothing. With the interface free that is a mode of its own, and has no
/// coordinate; with it held both modes have one frequency, and a cluster that is seen in part stays as a whole.
#[test]
fn pendulums_against_each_other_have_no_coordinate_unless_their_cluster_is_seen() {
    let place = Place::with(&springs(&[5.0, 1.0, 1.0, 2.0], &[(3, 9e3)], &[(0, 1, 1e3), (0, 2, 1e3), (0, 3, 4e3)]));
    for (method, n_left_out) in [("herting", 1), ("craig-bampton", 0)] {
        let text = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\" }}\n\
             interface = [{{ name = \"body\", nodes = {{ rows = [0] }} }}]\n\
             reduction = {{ method = \"{method}\", modes = {{ accept = true }} }}\n\
             scene = {{ band_hz = [0, 8], accept = {{ frequency = 1e-6 }} }}\n\
             write = {{ superelement = \"x.supel\" }}\n"
        );
        place.write("job.toml", text.as_bytes());
        let (file, body) = reduced(&place, &[]);
        assert_eq!(left_out(&file).len(), n_left_out, "{method}: {}", body["reduction"]["modes"]);
        assert_eq!(verified(&place, "x.supel").1, ExitCode::Done, "{method}");
    }
}

/// Two rods of ten masses from one body, tied to each other so that the modes of one against the other, which nothing sees, lie `step`/2 above the
/// modes of both together.
fn rods(step: f64) -> Model {
    const N: u32 = 10;
    let row = |rod: u32, at: u32| 1 + rod * N + at;
    let tie = 0.5 * (rod_alone(2) * (1.0 + 0.5 * step).powi(2) - rod_alone(1));
    let along = (0..2).flat_map(|rod| (1..N).map(move |at| (row(rod, at - 1), row(rod, at), 1e6)));
    let at_body = (0..2).map(|rod| (0, row(rod, 0), 1e6));
    let across = (0..N).map(|at| (row(0, at), row(1, at), tie));
    springs(
        &[[2.0; 1].as_slice(), &[1.0; 2 * N as usize]].concat(),
        &[],
        &along.chain(at_body).chain(across).collect::<Vec<_>>(),
    )
}

/// λ of mode `j` of ten masses of 1 on springs of 1e6, the first of which ends at rest: 4k/m sin²((2j − 1)π/42).
fn rod_alone(j: u32) -> f64 {
    4e6 * (f64::from(2 * j - 1) * std::f64::consts::PI / 42.0).sin().powi(2)
}

/// λ of a superelement with its first coordinate held, ascending.
fn held(file: &Superelement) -> Vec<f64> {
    let [k, m] = [&file.tensors().stiffness, &file.tensors().mass].map(unpacked);
    let n = k.nrows() - 1;
    let [k, m] = [k, m].map(|a| a.submatrix(1, 1, n, n).to_owned());
    let (masses, shapes) = symmetric_eigen(m.as_ref()).expect("a mass");
    let scaled = Mat::from_fn(n, n, |i, j| shapes[(i, j)] / masses[j].sqrt());
    symmetric_eigen((scaled.transpose() * &k * &scaled).as_ref()).expect("a stiffness").0
}

/// A mode that is left out lies between a frequency of the full model and the one that answers it. Put back among those of the reduced model it
/// would be taken for the answer: what the scene accepts would be exceeded, and be found met.
#[test]
fn errors_of_frequencies_are_those_of_what_the_superelement_has() {
    const ACCEPTED: f64 = 0.018;
    let place = Place::with(&rods(0.026));
    let hertz = |lambda: f64| lambda.sqrt() / std::f64::consts::TAU;
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", stiffness_digits = 17, mass_digits = 17 }}\n\
         interface = [{{ name = \"body\", nodes = {{ rows = [0] }} }}]\n\
         reduction = {{ method = \"herting\", modes = {{ accept = true }} }}\n\
         scene = {{ band_hz = [0, {}], boundaries = [\"free\", \"fix:body\"], accept = {{ frequency = {ACCEPTED} }} }}\n\
         write = {{ superelement = \"x.supel\" }}\n",
        1.12 * hertz(rod_alone(2))
    );
    place.write("job.toml", text.as_bytes());
    let (file, body) = reduced(&place, &[]);
    assert!(!left_out(&file).is_empty(), "{}", body["reduction"]["modes"]);
    let error = |at: usize| hertz(held(&file)[at]) / hertz(rod_alone(at as u32 + 1)) - 1.0;
    assert!(error(0) <= ACCEPTED && error(1) <= ACCEPTED, "{:e} {:e}", error(0), error(1));
    let said = check(&body, "M-29")["value"].as_f64().expect("a number");
    assert!(said >= error(1) * (1.0 - 1e-6), "{said:e} for {:e}", error(1));
    let (audit, code) = verified(&place, "x.supel");
    assert_eq!(code, ExitCode::Done, "{audit:#}");
}

/// Bending across the plane of symmetry moves neither tip nor loads: gravity alone starts it, where the scene lets it act along y.
#[test]
fn modes_that_gravity_alone_starts_are_left_out_where_it_does_not_act() {
    let place = Place::with_brick();
    let made = |gravity: &str| {
        let scene = format!(
            "band_hz = [0, 4000], boundaries = [\"free\"], accept = {{ frequency = 1e-3 }}, gravity = {gravity}"
        );
        write_job(&place, ("craig-bampton", "accept = true"), &scene, "");
        let (file, _) = reduced(&place, &[]);
        let (audit, code) = verified(&place, "x.supel");
        assert_eq!(code, ExitCode::Done, "{audit:#}");
        file
    };
    let (everywhere, nowhere, downwards) = (made("true"), made("false"), made("[0, 0, -9.81]"));
    assert!(left_out(&everywhere).len() < left_out(&nowhere).len(), "{:?}", left_out(&nowhere));
    assert_eq!(left_out(&downwards), left_out(&nowhere));
    let assumes =
        |file: &Superelement, words: &str| file.metadata().validity.assumptions.iter().any(|said| said.contains(words));
    assert!(assumes(&everywhere, "as gravity") && !assumes(&nowhere, "as gravity"));
    assert!(assumes(&downwards, "as gravity along (0, 0, "));
    assert_eq!((everywhere.metadata().validity.gravity, nowhere.metadata().validity.gravity), (None, Some([0.0; 3])));
}
