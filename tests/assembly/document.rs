//! What `supel modes` prints.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::{carrying, rounded, scaled, translated};
use supel_models::{Material, Model, brick};
use supel_testing::place::{Place, supel};

use crate::{beams, line};

fn violations(document: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(include_str!("../../schemas/modes.schema.json")).expect("schema is JSON");
    let validator = jsonschema::validator_for(&schema).expect("schema is a schema");
    validator.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

/// The two halves of the line as left.supel and right.supel.
fn halves(method: &str) -> Place {
    let all = Place::new();
    for (name, nodes) in [("left.supel", 0..7), ("right.supel", 6..13)] {
        let place = Place::with(&beams(&line()[nodes]));
        let flags = format!("--interface a=1 --interface z=7 {method}");
        place.reduce(&place.model_flags(), &flags).expect(ExitCode::Done);
        all.write(name, &place.bytes("x.supel"));
    }
    all
}

fn modes(place: &Place, more: &[&str]) -> String {
    let (left, right) = (place.text("left.supel"), format!("b={}", place.text("right.supel")));
    supel(&[&["modes", &left, &right, "--join", "left.z=b.a"], more].concat()).expect(ExitCode::Done).out
}

#[test]
fn json_follows_its_schema() {
    let place = halves("--method craig-bampton --modes 6");
    let more = ["--fix", "b.z", "--mass", "left.a=2.5,0.1,0.1,0.2", "--count", "5", "--json"];
    let document: Value = serde_json::from_str(&modes(&place, &more)).expect("JSON");
    assert_eq!(violations(&document), Vec::<String>::new());
    assert_eq!(document["modes"].as_array().expect("a list").len(), 5);
    assert_eq!(document["components"][1]["name"], "b");
    assert_eq!(document["masses"][0]["inertia"][2], 0.2);
    let free: Value = serde_json::from_str(&modes(&place, &["--json"])).expect("JSON");
    assert_eq!(violations(&free), Vec::<String>::new());
    assert_eq!((&free["n_rigid"], &free["modes"][0]["kind"]), (&6.into(), &"rigid_body".into()));
    let guyan: Value = serde_json::from_str(&modes(&halves("--method guyan"), &["--json"])).expect("JSON");
    assert_eq!(violations(&guyan), Vec::<String>::new());
    assert!(guyan["components"][0]["omits_unknown"].is_string() && guyan["modes"][7]["at_least_hz"].is_null());
    for (key, value) in [("surplus", Value::from(1)), ("modes", Value::Null)] {
        let mut wrong = document.clone();
        wrong[key] = value;
        assert_ne!(violations(&wrong), Vec::<String>::new());
    }
}

#[test]
fn text_fits_the_page_and_says_what_the_figures_are() {
    let place = halves("--method craig-bampton --modes 6");
    let text = modes(&place, &["--fix", "b.z", "--mass", "left.a=2.5", "--count", "30"]);
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    for words in [
        "left · Craig-Bampton · 18 coordinates",
        "left.z = b.a · 1 pair of nodes · 6 dofs",
        "b.z · 6 dofs",
        "left.a · 2.5",
        "! beyond the band",
        "Each frequency is an upper bound",
    ] {
        assert!(text.contains(words), "{words:?} is not in\n{text}");
    }
    let in_one_line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(in_one_line.contains("is the least certain, by what "), "{text}");
    let guyan = modes(&halves("--method guyan"), &[]);
    assert!(guyan.contains("There are no lower bounds, as left, b do not say what they leave out."), "{guyan}");
    assert!(guyan.lines().all(|line| line.chars().count() <= 100), "{guyan}");
    let apart = supel(&["modes", &place.text("left.supel"), &place.text("right.supel")]).expect(ExitCode::Done);
    assert!(apart.out.contains("left is joined to nothing"), "{}", apart.out);
}

/// Next to a heavy mass elastic modes move what is by it in the opposite direction by much less than as a rigid body: what is not known of
/// energies by few digits is of what they move.
#[test]
fn few_digits_leave_elastic_modes_beside_a_heavy_mass_their_energy() {
    let beam = brick([3, 2, 2], [3.0, 0.05, 0.05], &Material::UNIT);
    let at = |x: f64| {
        let nodes = beam.labels.iter().zip(&beam.nodes).filter(|(_, place)| place[0] == x);
        nodes.map(|(label, _)| label.to_string()).collect::<Vec<String>>().join(",")
    };
    let inside = beam.labels.iter().zip(&beam.nodes).find(|(_, place)| place[0] == 1.0).expect("a node");
    let found = |mass: f64, digits: usize| {
        let place = Place::with(&rounded(&carrying(&beam, &[*inside.0], mass), digits));
        let ends = format!("--rigid-interface a={} --rigid-interface b={}", at(0.0), at(3.0));
        place.reduce(&place.model_flags(), &format!("{ends} --method craig-bampton --modes 6")).expect(ExitCode::Done);
        let ended = supel(&["modes", &place.text("x.supel"), "--count", "12", "--json"]).expect(ExitCode::Done);
        let document: Value = serde_json::from_str(&ended.out).expect("JSON");
        let modes = document["modes"].as_array().expect("a list")[6..].to_vec();
        modes
            .into_iter()
            .map(|mode| (mode["kind"].clone(), mode["frequency_hz"].as_f64().expect("Hz")))
            .collect::<Vec<_>>()
    };
    // The beam weighs 0.0075.
    for (mass, digits) in [(7.5, 9), (75.0, 9), (75_000.0, 12)] {
        let (short, whole) = (found(mass, digits), found(mass, 17));
        assert_eq!((short.len(), whole.len()), (6, 6), "{mass}, {digits} digits");
        for ((kind, hertz), (_, expected)) in short.into_iter().zip(whole) {
            assert_eq!(kind, "elastic", "{mass}, {digits} digits");
            // Nine digits of a beam of 1:60 leave five of its first frequency.
            assert!((hertz / expected - 1.0).abs() < 1e-4, "{mass}, {digits} digits: {hertz} for {expected}");
        }
    }
}

/// Rounding of a stiff part is no spring to the ground for it, however soft what holds it, and its error bar is nothing to its rigid-body motion.
#[test]
fn few_digits_of_a_stiff_part_do_not_hold_it() {
    let beam = brick([3, 2, 2], [3.0, 0.05, 0.05], &Material::UNIT);
    let next = translated(&beam, [3.0, 0.0, 0.0]);
    let at = |x: f64| {
        let nodes = beam.labels.iter().zip(&beam.nodes).filter(|(_, place)| place[0] == x);
        nodes.map(|(label, _)| label.to_string()).collect::<Vec<String>>().join(",")
    };
    let ends = format!("--rigid-interface a={} --rigid-interface b={}", at(0.0), at(3.0));
    let all = Place::new();
    let reduce = |name: &str, model: &Model| {
        let place = Place::with(model);
        place.reduce(&place.model_flags(), &format!("{ends} --method craig-bampton --modes 6")).expect(ExitCode::Done);
        all.write(name, &place.bytes("x.supel"));
    };
    let softness = 1e-5;
    reduce("soft.supel", &scaled(&next, softness, 1.0));
    let mut found = Vec::new();
    for digits in [17, 9, 8, 7] {
        reduce("stiff.supel", &rounded(&beam, digits));
        let (stiff, soft) = (all.text("stiff.supel"), all.text("soft.supel"));
        let flags = ["--join", "stiff.b=soft.a", "--fix", "soft.b", "--count", "8", "--json"];
        let ended = supel(&[&["modes", &stiff, &soft], &flags[..]].concat()).expect(ExitCode::Done);
        let document: Value = serde_json::from_str(&ended.out).expect("JSON");
        assert!(document["components"][0]["omits_unknown"].is_null(), "{digits} digits: {document:#}");
        let modes = document["modes"].as_array().expect("a list").iter();
        let hertz = |mode: &Value| {
            assert_eq!(mode["kind"], "elastic", "{digits} digits");
            mode["frequency_hz"].as_f64().expect("Hz")
        };
        found.push(modes.map(hertz).collect::<Vec<f64>>());
    }
    // The stiff part takes a share of the energy like the softness of the other, and at seven digits a tenth of its bending is not known.
    let tolerance = 0.1 * softness;
    for hertz in &found[1..] {
        assert_eq!((hertz.len(), found[0].len()), (8, 8));
        for (short, whole) in hertz.iter().zip(&found[0]) {
            assert!((short / whole - 1.0).abs() < tolerance, "{short} for {whole} Hz");
        }
    }
}
