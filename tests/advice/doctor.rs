//! `supel doctor`: what a pair of matrices is, and what is wrong with it.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::{carrying, grounded, join, rounded, scaled, supported};
use supel_models::{Inertia, Material, Model, Section, brick, frame};
use supel_testing::place::{Ended, Place, steel_brick, supel};
use supel_testing::schema::{assert_follows, validator};

/// `supel doctor K.mtx M.mtx` with further arguments, in which a word that ends like a file is one of the folder.
fn doctor(place: &Place, rest: &str) -> Ended {
    let word = |word: &str| if word.contains('.') { place.text(word) } else { word.to_owned() };
    let rest: Vec<String> = rest.split_whitespace().map(word).collect();
    let mut args = vec!["doctor"];
    args.extend(rest.iter().map(String::as_str));
    supel(&args)
}

const ALL: &str = "K.mtx M.mtx --dofs dofs.txt --nodes nodes.csv";

/// The document, which follows its schema.
#[track_caller]
fn examined(place: &Place, rest: &str, code: ExitCode) -> Value {
    let document = serde_json::from_str(&doctor(place, &format!("{rest} --json")).expect(code).out).expect("JSON");
    assert_follows(&validator("examination"), &document);
    document
}

/// What is found, by code; an empty one where there is none.
fn findings(document: &Value) -> Vec<(&str, String)> {
    let findings = document["findings"].as_array().expect("findings").iter();
    findings.map(|finding| (finding["code"].as_str().unwrap_or_default(), finding.to_string())).collect()
}

/// The only finding of a code.
#[track_caller]
fn finding(document: &Value, code: &str) -> String {
    let of_code: Vec<String> =
        findings(document).into_iter().filter(|(of_finding, _)| *of_finding == code).map(|(_, text)| text).collect();
    assert_eq!(of_code.len(), 1, "{code}: {document}");
    of_code[0].clone()
}

#[test]
fn a_sound_pair_has_nothing_to_be_found() {
    let place = Place::with(&steel_brick());
    let found = examined(&place, ALL, ExitCode::Done);
    assert_eq!((&found["severity"], findings(&found).len()), (&Value::Null, 0), "{found}");
    assert_eq!(found["modes"].as_array().expect("modes").len(), 8);
    assert_eq!(found["units"][0]["label"], "m-kg-s");
    let text = doctor(&place, ALL).expect(ExitCode::Done).out;
    for told in [
        "six free",
        "135 rows · 45 nodes · 1 body",
        "m, kg, s",
        "1 × 0.31 × 0.23",
        "✓ nothing: the pair can be reduced",
    ] {
        assert!(text.contains(told), "{told}: {text}");
    }
    // Matrices alone are a pair, too.
    let alone = examined(&place, "K.mtx M.mtx", ExitCode::Done);
    assert_eq!((&alone["extents"], &alone["grounded"], findings(&alone).len()), (&Value::Null, &Value::Null, 0));
}

#[test]
fn one_file_given_twice() {
    let place = Place::with(&steel_brick());
    let found = examined(&place, "K.mtx K.mtx", ExitCode::CheckFailed);
    assert!(finding(&found, "E-SAME-MATRIX").contains("give the file of the other one"), "{found}");
    let copy = place.bytes("M.mtx");
    place.write("copy.mtx", &copy);
    finding(&examined(&place, "M.mtx copy.mtx", ExitCode::CheckFailed), "E-SAME-MATRIX");
}

/// The examination goes on with the files exchanged, and finds the frequencies of the pair.
#[test]
fn exchanged_matrices() {
    let place = Place::with(&steel_brick());
    let right = examined(&place, ALL, ExitCode::Done);
    let found = examined(&place, &ALL.replace("K.mtx M.mtx", "M.mtx K.mtx"), ExitCode::CheckFailed);
    assert!(finding(&found, "E-SWAPPED").contains("with the two files exchanged"), "{found}");
    assert_eq!(found["modes"], right["modes"]);
}

#[test]
fn a_map_of_another_mesh() {
    let place = Place::with(&steel_brick());
    let other = Place::with(&brick([2, 2, 4], [0.31, 0.23, 1.0], &Material::STEEL_SI));
    place.write("nodes.csv", &other.bytes("nodes.csv"));
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    let code = findings(&found)[0].0.to_owned();
    assert!(code == "E-COORD" || code.starts_with("E-MAP"), "{found}");
    assert!(finding(&found, &code).contains("without the"), "{found}");
    assert_eq!(found["modes"].as_array().expect("modes").len(), 8, "it goes on");
    // One of another size does not even begin to fit.
    let other = Place::with(&brick([3, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI));
    place.write("dofs.txt", &other.bytes("dofs.txt"));
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert!(finding(&found, findings(&found)[0].0).contains("without the dof map"), "{found}");
}

/// A map that cannot be read leaves nothing that says which rows are those of a node: coordinates are not compared with rows in any order.
#[test]
fn a_damaged_map_is_the_only_finding() {
    let place = Place::with(&steel_brick());
    let nodes = String::from_utf8(place.bytes("nodes.csv")).expect("text");
    let mut lines: Vec<&str> = nodes.lines().collect();
    lines[1..].reverse();
    place.write("nodes.csv", (lines.join("\n") + "\n").as_bytes());
    assert_eq!(findings(&examined(&place, ALL, ExitCode::Done)), [], "the map tells the rows");
    let map = String::from_utf8(place.bytes("dofs.txt")).expect("text");
    let (first, rest) = map.split_once('\n').expect("lines");
    let shorter = rest.rsplit_once('\n').and_then(|(rest, _)| rest.rsplit_once('\n')).expect("lines").0;
    for (damaged, code) in [
        (format!("{}\n{rest}", first.replace('.', " ")), "E-MAP-TEXT"),
        (format!("{first}\n{shorter}\n"), "E-MAP-COUNT"),
        (format!("knot,dof\n{}", map.replace('.', ",")), "E-TABLE-COLUMN"),
    ] {
        place.write("dofs.txt", damaged.as_bytes());
        let found = examined(&place, ALL, ExitCode::CheckFailed);
        let codes: Vec<&str> = findings(&found).iter().map(|(code, _)| *code).collect();
        assert_eq!(codes, [code], "{found}");
        assert!(finding(&found, code).contains("without the dof map, and so without the nodes"), "{found}");
        let text = doctor(&place, ALL).out;
        assert!(text.contains("the nodes that were given were left out") && !text.contains("give --nodes"), "{text}");
    }
}

#[test]
fn matrices_of_two_models() {
    let place = Place::with(&steel_brick());
    let other = Place::with(&brick([3, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI));
    place.write("M.mtx", &other.bytes("M.mtx"));
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert_eq!((findings(&found).len(), &found["modes"]), (1, &Value::Null), "{found}");
}

/// A spring to the ground is named with its node, its direction and its stiffness.
#[test]
fn a_support_left_in_is_named() {
    // Node 17 uz.
    let model = grounded(&steel_brick(), 3 * 16 + 2, 3e6);
    let found = examined(&Place::with(&model), ALL, ExitCode::Done);
    let told = finding(&found, "");
    for part in ["1 dof is grounded", "node 17 uz (3.00e+06 N/m)", "a support left in the step", "\"warning\""] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert_eq!(found["grounded"]["n_touched"], 1);
    let stiffness = found["grounded"]["culprits"][0]["stiffness"].as_f64().expect("a stiffness");
    assert!((stiffness / 3e6 - 1.0).abs() < 1e-6, "{stiffness}");
    assert!(told.contains("*BOUNDARY, OP=NEW"), "lines for the deck: {told}");
}

/// A spring shows by what it is above the rounding of its own matrices, however soft it is.
#[test]
fn a_soft_spring_to_the_ground_is_named() {
    for (stiffness, digits) in [(3e4, 17), (3e3, 17), (3e6, 9)] {
        let model = rounded(&grounded(&steel_brick(), 3 * 16 + 2, stiffness), digits);
        let found = examined(&Place::with(&model), ALL, ExitCode::Done);
        let named = found["grounded"]["culprits"][0]["dof"].as_str().unwrap_or_default();
        assert!(named.contains("node 17 uz"), "{stiffness:e} {digits}: {found}");
        let told = found["grounded"]["culprits"][0]["stiffness"].as_f64().expect("a stiffness");
        assert!((told / stiffness - 1.0).abs() < 1e-2, "{stiffness:e} {digits}: {told}");
    }
}

/// Rows that supports took out are told by their neighbours; the component is held, which may be meant.
#[test]
fn supports_that_took_rows_out() {
    let model = supported(&steel_brick(), |(label, _)| label <= 9);
    let found = examined(&Place::with(&model), ALL, ExitCode::Done);
    let all = findings(&found);
    let (_, told) = all.iter().find(|(_, text)| text.contains("supports hold the component")).expect("told");
    assert!(told.contains("\"severity\":\"remark\""), "{told}");
    assert!(all.iter().any(|(_, text)| text.contains("9 nodes have no row")), "{all:?}");
    let text = doctor(&Place::with(&model), ALL).expect(ExitCode::Done).out;
    assert!(text.contains("none free: supports hold it"), "{text}");
}

/// Conditions as some programs write them: a row and a column of zeros and a diagonal. They fill the lowest frequencies, with coordinates and
/// without.
#[test]
fn rows_of_conditions_are_told() {
    let mut model = steel_brick();
    let is_of_condition = |row: u32| row < 27;
    model.stiffness.retain(|(i, j, _)| i == j || !is_of_condition(*i) && !is_of_condition(*j));
    model.stiffness.iter_mut().filter(|(i, ..)| is_of_condition(*i)).for_each(|(.., value)| *value = 1.0);
    let place = Place::with(&model);
    for flags in [ALL, "K.mtx M.mtx"] {
        let found = examined(&place, flags, ExitCode::Done);
        let all = findings(&found);
        let (_, told) =
            all.iter().find(|(_, text)| text.contains("27 rows are coupled with no other one")).expect("told");
        assert!(told.contains("take rows of conditions out"), "{told}");
    }
    let whole = examined(&Place::with(&steel_brick()), ALL, ExitCode::Done);
    assert!(findings(&whole).iter().all(|(_, text)| !text.contains("coupled with no other one")), "{whole}");
}

/// What is held by a flag is meant.
#[test]
fn dofs_held_by_a_flag_are_no_finding() {
    let place = Place::with(&steel_brick());
    let found = examined(&place, &format!("{ALL} --fix foot=1,2,3,4,5,6,7,8,9"), ExitCode::Done);
    assert!(findings(&found).iter().all(|(_, text)| !text.contains("grounded")), "{found}");
}

/// A node with mass that no stiffness reaches, and what its neighbours feel of it.
#[test]
fn a_massive_node_that_nothing_holds() {
    let mut model = steel_brick();
    // Node 5, in the middle of an end.
    model.stiffness.retain(|(i, j, _)| ![i, j].iter().any(|row| **row / 3 == 4));
    let place = Place::with(&model);
    let found = examined(&place, ALL, ExitCode::Done);
    assert!(finding(&found, "W-FREE-PARTICLE").contains("node 5 ux"), "{found}");
    let all = findings(&found);
    assert_eq!(all.iter().filter(|(_, text)| text.contains("free particles")).count(), 1, "said once: {all:?}");
    // What is held at the place of the node is not nearly free.
    assert!(all.iter().all(|(code, _)| *code != "W-GROUNDED"), "{all:?}");
    let (_, held) = all.iter().find(|(_, text)| text.contains("supports hold the component")).expect("told");
    assert!(held.contains("next to dofs that are not in the stiffness"), "{held}");
    let text = doctor(&place, ALL).out;
    assert!(text.contains("6 motions are free") && !text.contains("as of a body in space"), "{text}");
}

/// A spring that pushes is named as one that pulls is, by its stiffness.
#[test]
fn a_negative_spring_is_named() {
    let model = grounded(&steel_brick(), 3 * 16 + 2, -3e6);
    let found = examined(&Place::with(&model), ALL, ExitCode::CheckFailed);
    let all = findings(&found);
    let (_, told) = all.iter().find(|(_, text)| text.contains("grounded")).expect("told");
    assert!(told.contains("node 17 uz (-3.00e+06 N/m)"), "{told}");
    assert!(all.iter().all(|(_, text)| !text.contains("supports hold the component")), "{all:?}");
}

/// What is wrong with the mass is the same without the nodes: it is said once, and that nothing went on. The job that is proposed has all
/// files.
#[test]
fn a_negative_mass_is_found_once() {
    let place = Place::with(&scaled(&steel_brick(), 1.0, -1.0));
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    let told = finding(&found, "E-NEG-MASS");
    assert!(told.contains("\"went_on\":null"), "{told}");
    assert!(!doctor(&place, ALL).expect(ExitCode::CheckFailed).out.contains("went on"), "{told}");
    let [k, m, dofs, nodes] = ["K.mtx", "M.mtx", "dofs.txt", "nodes.csv"].map(|name| place.text(name));
    let job = supel(&["init", &k, &m, "--dofs", &dofs, "--nodes", &nodes]).out;
    assert!(["dofs", "nodes"].iter().all(|key| job.contains(&format!("\n{key} "))), "{job}");
}

/// All that was left out is said, the dofs that a flag holds and the axes of nodes, too.
#[test]
fn what_goes_with_the_nodes_is_said() {
    let place = Place::with(&steel_brick());
    place.write("frames.csv", b"node,x1,x2,x3,y1,y2,y3\n3,1,0,0,0,1,0\n");
    place.write("short.txt", b"1 1\n");
    let rest = "K.mtx M.mtx --dofs short.txt --nodes nodes.csv --frames frames.csv --fix foot=1";
    let found = examined(&place, rest, ExitCode::CheckFailed);
    let told = finding(&found, "E-MAP-TEXT");
    for part in
        ["without the dof map, and so without the nodes", "without the axes of nodes", "with nothing held at nodes"]
    {
        assert!(told.contains(part), "{part}: {told}");
    }
    // A table of axes that is wrong is left out by itself.
    place.write("frames.csv", b"node,x1,x2,x3,y1,y2,y3\n3,1,0,0,2,0,0\n");
    let rest = format!("{ALL} --frames frames.csv --fix foot=1");
    let found = examined(&place, &rest, ExitCode::CheckFailed);
    let told = finding(&found, "E-FRAME-AXES");
    assert!(told.contains("\"went_on\":\"without the axes of nodes\""), "{told}");
    assert_eq!(found["severity"], "error");
}

/// Rows that were turned by axes of few digits fit no coordinates: without these the pair is looked at, and no second fault is made of it.
#[test]
fn axes_of_few_digits_are_one_finding() {
    let (s, c) = 0.7f64.sin_cos();
    let model = supel_models::transform::in_local_frames(
        &steel_brick(),
        &[[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]],
        |node| node == 15,
    );
    let place = Place::with(&model);
    place.write("frames.csv", format!("node,x1,x2,x3,y1,y2,y3\n15,{c:.3},{s:.3},0,-{s:.3},{c:.3},0\n").as_bytes());
    let found = examined(&place, &format!("{ALL} --frames frames.csv"), ExitCode::CheckFailed);
    let told = finding(&found, "E-FRAME-DIGITS");
    assert!(told.contains("\"went_on\":\"without the nodes\""), "{told}");
    assert!(findings(&found).iter().all(|(code, _)| *code == "E-FRAME-DIGITS" || !code.starts_with("E-")), "{found}");
}

/// What leaves frequencies open decides which lines help: triangles that differ are no matter of digits.
#[test]
fn advice_for_uncertain_frequencies_is_that_which_helps() {
    let model = boxed_frame(1.0, 0.005, &Material::STEEL_SI);
    let largest = model.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2.abs()));
    let place = Place::with(&model);
    let first = model.stiffness.iter().position(|entry| entry.0 < entry.1).expect("an entry");
    let n = model.n;
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n{n} {n} {}\n", model.stiffness.len());
    for (at, (row, col, value)) in model.stiffness.iter().enumerate() {
        let off = if at == first { 5e-7 * largest } else { 0.0 };
        text += &format!("{} {} {:e}\n", row + 1, col + 1, value + off);
    }
    place.write("K.mtx", text.as_bytes());
    let told = finding(&examined(&place, ALL, ExitCode::Done), "W-DATA-PRECISION");
    assert!(told.contains("symmetric = ") && !told.contains("_digits"), "{told}");
    let (row, col, _) = model.stiffness[first];
    let [a, b] = [row.max(col) + 1, row.min(col) + 1];
    for part in ["the triangles of the stiffness differ by".to_owned(), format!("most at row {a}, column {b}")] {
        assert!(told.contains(&part), "{part}: {told}");
    }
    // Of matrices one of which has all digits, the other one is named.
    let place = Place::with(&Model { mass: steel_brick().mass, ..rounded(&steel_brick(), 4) });
    let found = serde_json::from_str(&doctor(&place, &format!("{ALL} --json")).out).expect("JSON");
    let told = finding(&found, "W-DATA-PRECISION");
    assert!(told.contains("stiffness_digits = 17") && !told.contains("mass_digits"), "{told}");
}

/// A map in another order fits the count of rows as well: what could tell is asked for.
#[test]
fn a_map_without_nodes_is_said_to_be_unseen() {
    const SAID: &str = "without nodes a map that exchanges rows cannot be seen";
    let place = Place::with(&steel_brick());
    let says = |rest: &str| examined(&place, rest, ExitCode::Done)["findings"].to_string().contains(SAID);
    assert!(says("K.mtx M.mtx --dofs dofs.txt"));
    assert!(!says(ALL) && !says("K.mtx M.mtx"));
    let page = doctor(&place, "K.mtx M.mtx --dofs dofs.txt").expect(ExitCode::Done).out;
    assert!(page.split_whitespace().collect::<Vec<_>>().join(" ").contains(SAID), "{page}");
}

#[test]
fn parts_that_nothing_joins() {
    let far = supel_models::transform::translated(&steel_brick(), [3.0, 0.0, 0.0]);
    let both: Model = join(&steel_brick(), &far, &[]);
    let place = Place::with(&both);
    let text = doctor(&place, ALL).out;
    assert!(text.contains("2 bodies") && text.contains("12 motions are free"), "{text}");
}

/// Systems of units by their labels: metres, kilograms and seconds in their units.
const SYSTEMS: [(&str, [f64; 3]); 7] = [
    ("m-kg-s", [1.0, 1.0, 1.0]),
    ("mm-t-s", [1e-3, 1e3, 1.0]),
    ("mm-kg-ms", [1e-3, 1.0, 1e-3]),
    ("mm-g-ms", [1e-3, 1e-3, 1e-3]),
    ("cm-g-s", [1e-2, 1e-3, 1.0]),
    ("in-slinch-s", [0.0254, 175.126_8, 1.0]),
    ("ft-slug-s", [0.3048, 14.593_9, 1.0]),
];

/// Young's modulus in Pa and density in kg/m³ of steel, aluminium and rubber.
const MATERIALS: [[f64; 2]; 3] = [[2.1e11, 7850.0], [7e10, 2700.0], [1e7, 1100.0]];

/// A material in a system of units.
fn in_units([young, density]: [f64; 2], [length, mass, time]: [f64; 3]) -> Material {
    let poisson = 0.3;
    Material { young: young * length * time * time / mass, poisson, density: density * length.powi(3) / mass }
}

/// A frame of a box, with beams of a slenderness, in metres over the unit of length.
fn boxed_frame(size: f64, slenderness: f64, material: &Material) -> Model {
    let corners: Vec<[f64; 3]> = (0..8u8)
        .map(|at| [at & 1, (at >> 1) & 1, at >> 2])
        .map(|at| [f64::from(at[0]) * size, f64::from(at[1]) * 0.6 * size, f64::from(at[2]) * 0.4 * size])
        .collect();
    let edges: Vec<[usize; 2]> =
        (0..8usize).flat_map(|a| [1, 2, 4].map(|bit| [a, a | bit])).filter(|[a, b]| a != b).collect();
    frame(&corners, &edges, &Section::round(0.5 * slenderness * size), material, Inertia::Consistent)
}

/// The units of a model.
#[track_caller]
fn units(model: &Model) -> (Value, String) {
    let place = Place::with(model);
    let found = examined(&place, ALL, ExitCode::Done);
    let text = doctor(&place, ALL).expect(ExitCode::Done).out;
    (found, text)
}

/// The system of a sound model is among those that are listed, and nothing says that its mass is wrong.
#[test]
fn sound_models_keep_their_mass() {
    for (label, scale) in SYSTEMS {
        for of in MATERIALS {
            let material = in_units(of, scale);
            let solid = brick([3, 1, 1], [0.1, 0.031, 0.023].map(|length| length / scale[0]), &material);
            let frames = [0.02, 0.004].map(|slenderness| boxed_frame(1.3 / scale[0], slenderness, &material));
            for (kind, model) in [("solid", &solid), ("frame", &frames[0]), ("slender frame", &frames[1])] {
                let found = examined(&Place::with(model), ALL, ExitCode::Done);
                let listed = found["units"].as_array().expect("units");
                assert!(listed.iter().any(|guess| guess["label"] == label), "{kind} {of:?} {label}: {listed:?}");
                assert!(listed[0]["is_mixed"] == false, "{kind} {of:?} {label}: {listed:?}");
                assert!(!found.to_string().contains("divide the mass"), "{kind} {of:?} {label}: {found}");
            }
        }
    }
}

/// Nodes on a line or in a plane span no volume, and the page says that rather than blaming the matrices.
#[test]
fn beams_in_a_row_have_no_density() {
    let nodes: Vec<[f64; 3]> = (0..6u8).map(|at| [0.2 * f64::from(at), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..5).map(|at| [at, at + 1]).collect();
    let steel = in_units(MATERIALS[0], [1.0; 3]);
    let (found, text) = units(&frame(&nodes, &edges, &Section::round(0.01), &steel, Inertia::Consistent));
    assert_eq!(found["units"].as_array().map(Vec::len), Some(0), "{found}");
    assert!(text.contains("so that the density is unknown") && !text.contains("no system"), "{text}");
}

/// Steel in millimetres, with stiffness in N/mm and mass in kilograms: frequencies are wrong by √1000, and nothing else shows it. A block
/// of it could be a thin shell of wood in inches; so both are listed.
#[test]
fn units_that_do_not_go_together() {
    let in_millimetres = Material { young: 210_000.0, poisson: 0.3, density: 7.85e-9 };
    let sound = brick([4, 2, 2], [100.0, 31.0, 23.0], &in_millimetres);
    let found = examined(&Place::with(&sound), ALL, ExitCode::Done);
    assert_eq!((&found["units"][0]["label"], findings(&found).len()), (&"mm-t-s".into(), 0), "{found}");
    let found = examined(&Place::with(&scaled(&sound, 1.0, 1e3)), ALL, ExitCode::Done);
    let last = found["units"].as_array().and_then(|units| units.last()).expect("units");
    assert_eq!((&last["is_mixed"], &last["label"]), (&true.into(), &Value::Null), "{found}");
    assert!(last["frequencies"].as_str().is_some_and(|told| told.contains("31.6 times too low")), "{found}");
    let text = doctor(&Place::with(&scaled(&sound, 1.0, 1e3)), ALL).expect(ExitCode::Done).out;
    assert!(text.contains("a mixture of stiffness in N/mm") && text.contains("31.6"), "{text}");
    // Where it fills little of its box, no sound system has so little density, and the mass on a scale decides.
    let mut hollow = scaled(&sound, 1.0, 1e3 * 0.1);
    hollow = scaled(&hollow, 0.1, 1.0);
    let told = finding(&examined(&Place::with(&hollow), ALL, ExitCode::Done), "");
    for part in ["\"remark\"", "31.6 times too low", "compare the mass of the body", "if that is in kg, divide"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    // kN/mm, kg and ms go together; frequencies are in kHz.
    let found = examined(&Place::with(&scaled(&sound, 1e-3, 1e3)), ALL, ExitCode::Done);
    let told = finding(&found, "");
    assert!(told.contains("kHz") && told.contains("units = \\\"mm-kg-ms\\\""), "{told}");
}

/// Nodes in millimetres next to N/m and kg: frequencies are right, and all that coordinates tell is wrong.
#[test]
fn nodes_in_another_unit_than_the_matrices_are_a_finding() {
    let in_metres = Material::STEEL_SI;
    let sound = brick([4, 2, 2], [0.1, 0.031, 0.023], &in_metres);
    let place = Place::with(&sound);
    let large = |factor: f64| brick([4, 2, 2], [0.1, 0.031, 0.023].map(|length| factor * length), &in_metres);
    for (factor, words) in [
        (1e3, ["nodes in mm", "divide the coordinates by 1000"]),
        (1e6, ["no system of units that is known", "bring nodes and matrices into one system"]),
    ] {
        place.write("nodes.csv", &Place::with(&large(factor)).bytes("nodes.csv"));
        let found = examined(&place, ALL, ExitCode::Done);
        let told = finding(&found, "");
        assert!(words.iter().all(|words| told.contains(words)), "{told}");
        assert_eq!(findings(&found).len(), 1, "{found}");
    }
    let found = examined(&Place::with(&sound), ALL, ExitCode::Done);
    assert_eq!((&found["units"][0]["label"], findings(&found).len()), (&"m-kg-s".into(), 0), "{found}");
}

/// A point mass that is a thousand times as heavy as what carries it says nothing of the density.
#[test]
fn a_point_mass_leaves_the_units_as_they_are() {
    let in_millimetres = Material { young: 210_000.0, poisson: 0.3, density: 7.85e-9 };
    let model = brick([4, 2, 2], [100.0, 31.0, 23.0], &in_millimetres);
    let weight = model.total_mass(0);
    let found = examined(&Place::with(&carrying(&model, &[23], 1e3 * weight)), ALL, ExitCode::Done);
    assert_eq!(found["units"][0]["label"], "mm-t-s", "{found}");
    assert!(!found.to_string().contains("no system"), "{found}");
}

/// What a remark says is no remedy, unless it asks for something.
#[test]
fn remarks_ask_for_what_they_ask_for() {
    let place = Place::with(&steel_brick());
    let text = String::from_utf8(place.bytes("K.mtx")).expect("text");
    let triplets: Vec<&str> = text.lines().filter(|line| !line.starts_with('%')).skip(1).collect();
    place.write("K.mtx", triplets.join("\n").as_bytes());
    let found = examined(&place, ALL, ExitCode::Done);
    let told: Vec<(&str, &str)> = found["findings"]
        .as_array()
        .expect("findings")
        .iter()
        .filter_map(|finding| finding["what"].as_str().zip(finding["remedy"].as_str()))
        .collect();
    let of = |words: &str| told.iter().find(|(what, _)| what.contains(words)).unwrap_or_else(|| panic!("{told:?}"));
    assert!(of("no size line; the largest index makes it a matrix of").1.starts_with("nothing"), "{told:?}");
    assert_eq!(of("the last line has no line end").1, "check that the file is complete", "{told:?}");
}

/// The lower triangle of a matrix is complete, or the upper one, or neither; of a matrix that gives each pair once, both are.
#[test]
fn matrices_that_lack_entries() {
    let place = Place::with(&steel_brick());
    let whole = steel_brick().stiffness;
    let market = |entries: &[(u32, u32, f64)]| {
        let lines: String =
            entries.iter().map(|(row, col, value)| format!("{} {} {value:e}\n", row + 1, col + 1)).collect();
        format!("%%MatrixMarket matrix coordinate real general\n135 135 {}\n{lines}", entries.len())
    };
    let write = |is_kept: &dyn Fn(u32, u32) -> bool| {
        let kept: Vec<_> = whole.iter().copied().filter(|(row, col, _)| is_kept(*row, *col)).collect();
        assert!(kept.len() < whole.len());
        place.write("K.mtx", market(&kept).as_bytes());
    };
    let right = examined(&place, ALL, ExitCode::Done);
    write(&|row, col| row <= col || row % 7 != 0);
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert!(finding(&found, "E-UNSYMMETRIC").contains("with the upper triangle for both"), "{found}");
    assert_eq!(found["modes"], right["modes"]);
    write(&|row, col| row >= col || row % 7 != 0);
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert!(finding(&found, "E-UNSYMMETRIC").contains("with the lower triangle for both"), "{found}");
    assert_eq!(found["modes"], right["modes"]);
    // Neither triangle is the matrix: nothing is made of it, and nothing else is blamed.
    write(&|row, col| row == col || (row + col) % 7 != if row > col { 0 } else { 1 });
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert_eq!((findings(&found).len(), &found["modes"]), (1, &Value::Null), "{found}");
    finding(&found, "E-UNSYMMETRIC");
    write(&|row, col| row == col || ((row + col) % 2 == 0) == (row > col));
    let found = examined(&place, ALL, ExitCode::Done);
    assert_eq!(found["modes"], right["modes"]);
    assert!(finding(&found, "").contains("each pair of rows is given once"), "{found}");
}

/// An error of reading is a finding like any other; a file that is not there is none of the pair.
#[test]
fn files_that_cannot_be_read() {
    let place = Place::with(&steel_brick());
    let text = String::from_utf8(place.bytes("K.mtx")).expect("UTF-8");
    place.write("K.mtx", text.replacen("e9", "x9", 1).as_bytes());
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    assert!(found["stiffness"].is_null() && findings(&found).len() == 1, "{found}");
    let ended = doctor(&place, "none.mtx M.mtx").expect(ExitCode::Io);
    assert!(ended.err.contains("E-READ"), "{}", ended.err);
}

#[test]
fn empty_rows_are_left_out() {
    // The last node has neither stiffness nor mass.
    let mut model = steel_brick();
    for entries in [&mut model.stiffness, &mut model.mass] {
        entries.retain(|(row, column, _)| *row < 132 && *column < 132);
    }
    let place = Place::with(&model);
    let found = examined(&place, ALL, ExitCode::CheckFailed);
    let told = finding(&found, "E-EMPTY-ROWS");
    assert!(told.contains("without the empty rows") && told.contains("drop_empty = true"), "{told}");
}

/// The groups of a mesh are listed with what they can be.
#[cfg(feature = "hdf5")]
#[test]
fn groups_that_may_be_interfaces() {
    let place = Place::with_example();
    let found = examined(&place, "stiffness.mtx.gz mass.mtx.gz --nodes bracket.med", ExitCode::Done);
    let groups: Vec<(&str, String)> = found["interfaces"]
        .as_array()
        .expect("groups")
        .iter()
        .map(|group| (group["group"].as_str().expect("a name"), group["couplings"].to_string()))
        .collect();
    let of = |name: &str| groups.iter().find(|(group, _)| *group == name).map(|(_, couplings)| couplings.as_str());
    assert_eq!(of("EYE"), Some("[\"rigid\",\"average\"]"), "{groups:?}");
    let text = doctor(&place, "stiffness.mtx.gz mass.mtx.gz --nodes bracket.med").expect(ExitCode::Done).out;
    assert!(text.contains("Groups that may be interfaces"), "{text}");
}

/// The answer is the same for any number of threads.
#[test]
fn the_number_of_threads_changes_nothing() {
    let place = Place::with(&steel_brick());
    let [one, three] =
        ["--threads 1", "--threads 3"].map(|threads| doctor(&place, &format!("{ALL} --json {threads}")).out);
    assert_eq!(one, three);
}

/// The format of each file, and which triangle it has.
#[test]
fn formats_and_triangles_are_named() {
    let place = Place::with(&steel_brick());
    let found = examined(&place, ALL, ExitCode::Done);
    assert_eq!(
        (&found["stiffness"]["format"], &found["stiffness"]["triangle"]),
        (&"matrix-market".into(), &"lower".into())
    );
    let text = doctor(&place, ALL).expect(ExitCode::Done).out;
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("from matrix-market · lower triangle stored"), "{text}");
    let (k, archive) = (place.text("K.mtx"), place.text("K.npz"));
    supel(&["convert", &k, &archive]).expect(ExitCode::Done);
    let found = examined(&place, &ALL.replace("K.mtx", "K.npz"), ExitCode::Done);
    assert_eq!((&found["stiffness"]["format"], &found["stiffness"]["triangle"]), (&"npz".into(), &Value::Null));
}

/// A point mass has no stiffness, and is a model: six motions without energy, and no frequencies.
#[test]
fn a_stiffness_of_zeros_is_a_rigid_body() {
    let place = Place::new();
    let banner = "%%MatrixMarket matrix coordinate real symmetric\n6 6";
    place.write("K.mtx", format!("{banner} 1\n1 1 0\n").as_bytes());
    let masses: String =
        [2.0, 2.0, 2.0, 0.1, 0.2, 0.3].iter().zip(1..).map(|(m, row)| format!("{row} {row} {m}\n")).collect();
    place.write("M.mtx", format!("{banner} 6\n{masses}").as_bytes());
    place.write("dofs.txt", b"1.1\n1.2\n1.3\n1.4\n1.5\n1.6\n");
    place.write("nodes.csv", b"node,x,y,z\n1,0,0,0\n");
    for files in [ALL, "K.mtx M.mtx"] {
        let found = examined(&place, files, ExitCode::Done);
        assert_eq!(found["modes"].as_array().expect("a list").len(), 0, "{found}");
        assert_eq!(found["model"]["rigid_body_modes"]["count"], 6, "{found}");
        let is_error = |(_, text): &(&str, String)| text.contains("\"severity\":\"error\"");
        assert!(!findings(&found).iter().any(is_error), "{found}");
    }
}

/// Whatever is found, something is said to do about it.
#[test]
fn every_finding_has_a_remedy() {
    let particles = {
        let mut model = steel_brick();
        model.stiffness.retain(|(row, column, _)| *row < 132 && *column < 132);
        model
    };
    let models = [
        supported(&steel_brick(), |(label, _)| label <= 9),
        grounded(&steel_brick(), 3 * 16 + 2, 3e6),
        rounded(&steel_brick(), 4),
        particles,
    ];
    let mut n_found = 0;
    for model in &models {
        let ended = doctor(&Place::with(model), &format!("{ALL} --json"));
        let document: Value = serde_json::from_str(&ended.out).expect("JSON");
        for finding in document["findings"].as_array().expect("findings") {
            n_found += 1;
            assert!(finding["remedy"].as_str().is_some_and(|remedy| !remedy.is_empty()), "{finding}");
        }
    }
    assert!(n_found >= 4, "{n_found}");
}
