//! What report, page and file say of loads.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::model::Assembler;
use supel_models::{Inertia, Material, Model, Section, frame};
use supel_runtime::Coordinate;
use supel_testing::place::{steel_brick, supel};

use crate::Case;

const LOADS: &str = r#"
    { name = "thrust", nodes = [13, 18, 28], force = [2.0, 0.0, -3.0] },
    { name = "pressure", file = "pressure.mtx", residual = false }"#;

fn case(loads: &'static str) -> Case {
    Case { name: "told", model: steel_brick(), interface: r#"{ name = "tip", nodes = [5, 15, 45] }"#, fixed: "", loads }
}

#[test]
fn report_page_and_file_name_the_loads() {
    let (place, ended) = case(LOADS).run("craig-bampton", 4);
    let text = ended.expect(ExitCode::Done).out;
    let thrust = "thrust: force on 3 nodes, total (2, 0, -3), residual vector, static answer lacks";
    assert!(text.contains(thrust), "{text}");
    assert!(text.contains("pressure: file, total (") && text.contains("no residual vector"), "{text}");
    assert!(text.contains("4 elastic modes + 1 residual vector"), "{text}");
    assert!(text.contains("static answer to loads with residual vectors"), "{text}");
    let report = place.report("x.report.json");
    let loads = &report["body"]["reduction"]["loads"];
    assert_eq!(loads[0]["name"], "thrust");
    assert_eq!(loads[0]["residual_vector"], "kept");
    assert_eq!(loads[0]["resultant"], serde_json::json!([2.0, 0.0, -3.0]));
    assert_eq!(loads[1]["residual_vector"], "not-asked");
    let digests: Vec<bool> = [0, 1].map(|at| loads[at]["digest"].is_string()).to_vec();
    assert_eq!(digests, [false, true], "that of the file");
    assert!(loads[0]["lacking"].as_f64().expect("a share") <= 1e-9, "{loads}");
    assert!(loads[1]["lacking"].as_f64().expect("a share") >= 1e-3, "{loads}");
    let schema: Value = serde_json::from_str(include_str!("../../schemas/report.schema.json")).expect("a schema");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let violations: Vec<String> = validator.iter_errors(&report).map(|error| error.to_string()).collect();
    assert_eq!(violations, Vec::<String>::new());
    let page = String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    assert!(page.contains("Loads by name") && page.contains("force on 3 nodes"), "the page names them");
    let file = place.superelement("x.supel");
    assert_eq!(file.metadata().coordinates.last(), Some(&Coordinate::ResidualVector { load: 0 }));
    let schema: Value = serde_json::from_str(include_str!("../../schemas/superelement.schema.json")).expect("a schema");
    let shown = supel(&["inspect", "--json", &place.text("x.supel")]).expect(ExitCode::Done).out;
    let document: Value = serde_json::from_str(&shown).expect("JSON");
    assert_eq!(document["sizes"]["n_residual_vectors"], 1);
    let coordinates = &document["metadata"]["coordinates"];
    let of_file = &schema["$defs"]["coordinate"];
    let mut of_one = of_file.clone();
    of_one["$defs"] = schema["$defs"].clone();
    let validator = jsonschema::validator_for(&of_one).expect("a schema");
    assert!(coordinates.as_array().expect("a list").iter().all(|coordinate| validator.is_valid(coordinate)));
    let shown = supel(&["inspect", &place.text("x.supel")]).expect(ExitCode::Done).out;
    assert!(shown.contains("thrust, with its residual vector") && shown.contains("pressure"), "{shown}");
}

/// A job without loads says nothing of them.
#[test]
fn nothing_is_said_where_nothing_is_loaded() {
    let (place, _) = case("").made("craig-bampton", 4);
    let report = place.report("x.report.json");
    assert_eq!(report["body"]["reduction"].get("loads"), None);
    assert!(!String::from_utf8(place.bytes("x.html")).expect("UTF-8").contains("Loads by name"));
}

/// A residual vector of another load, or a load vector that is not that of its residual vector, does not go unnoticed in the file alone.
#[test]
fn the_file_alone_ties_residual_vectors_to_their_loads() {
    let (_, file) = case(LOADS).made("herting", 4);
    let audited = |file: &supel_runtime::Superelement| {
        let checks = supel::audit::of_file(file).expect("dense decompositions").checks;
        let answered = checks.into_iter().find(|check| check.id == "M-27").expect("M-27");
        (answered.verdict(), answered.value)
    };
    let sound = audited(&file);
    assert!(sound.0 == supel::verification::check::Verdict::Pass && sound.1 <= 1e-10, "{sound:?}");
    let mut tensors = file.tensors().clone();
    let own = tensors.load_vectors.expect("loads");
    let at = (file.n_interface() + 6, 0);
    let altered = |i, j| own[(i, j)] * if (i, j) == at { 1.0 + 1e-4 } else { 1.0 };
    tensors.load_vectors = Some(supel_runtime::Matrix::from_fn(own.rows(), own.cols(), altered));
    let altered = supel_runtime::Superelement::new(tensors, file.metadata().clone()).expect("the parts fit");
    assert!(audited(&altered).0 > supel::verification::check::Verdict::Pass, "{:?}", audited(&altered));
}

/// Rubin's coordinates have no residual vectors: his matrices are those of the file without the loads, and the map leads into this one.
#[test]
fn rubins_matrices_leave_residual_vectors_out() {
    let rubin = |loads: &'static str| -> (Value, usize) {
        let (place, file) = case(loads).made("rubin", 4);
        let shown = supel(&["inspect", "--rubin", &place.text("x.supel")]).expect(ExitCode::Done).out;
        (serde_json::from_str(&shown).expect("JSON"), file.n_coordinates())
    };
    let ((with, r), (without, r_without)) = (rubin(LOADS), rubin(""));
    assert_eq!((r, &with["sizes"]), (r_without + 1, &without["sizes"]));
    assert_eq!(with["to_file"].as_array().expect("rows").len(), r);
    let numbers = |value: &Value| -> Vec<f64> {
        let rows = value.as_array().expect("rows").iter();
        rows.flat_map(|row| row.as_array().expect("a row")).map(|entry| entry.as_f64().expect("a number")).collect()
    };
    for matrix in ["stiffness", "mass"] {
        let (found, expected) = (numbers(&with[matrix]), numbers(&without[matrix]));
        let size = expected.iter().fold(0.0f64, |size, value| size.max(value.abs()));
        // The part of a mode in the interface is found by least squares from numbers of sixteen digits, a condition of some 10⁶.
        let worst = found.iter().zip(&expected).fold(0.0f64, |worst, (a, b)| worst.max((a - b).abs()));
        assert!(worst <= 1e-9 * size, "{matrix}: {worst:e} of {size:e}");
    }
}

/// Modes that span all that has mass leave no coordinate for what a load does to the rest, which is said where its answer is missed.
#[test]
fn an_answer_without_mass_has_no_coordinate() {
    let nodes = [[0.0; 3], [0.1, 0.0, 0.0], [0.2, 0.0, 0.0], [0.3, 0.0, 0.05], [0.4, 0.0, 0.05]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4]];
    let shaft = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    // Mass at both ends alone.
    let mut mass = Assembler::default();
    (0..6).for_each(|row| mass.add(row, row, if row < 3 { 1.0 } else { 1e-3 }));
    (24..27).for_each(|row| mass.add(row, row, 2.0));
    let model = Model { mass: mass.finish(), ..shaft };
    let loads = r#"{ name = "F", nodes = [3], force = [0.0, 0.0, 1.0] }"#;
    let case = Case { name: "massless", model, interface: r#"{ name = "foot", nodes = [1] }"#, fixed: "", loads };
    let (_, ended) = case.run("craig-bampton", 2);
    ended.expect(ExitCode::Done);
    let (_, ended) = case.run("craig-bampton", 3);
    let text = ended.expect(ExitCode::CheckFailed).out;
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("F: the modes span all that has mass"), "{text}");
}
