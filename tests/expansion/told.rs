//! What report, page and file say of the modes of a file, and whether a comparison notices other ones.

use faer::prelude::Solve;
use faer::{Mat, Side};
use serde_json::{Value, json};
use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::model::{dot, multiply};
use supel_testing::place::{Place, steel_brick, supel};

use crate::{AVERAGE, Case, OF_FILE, PATCH, TIP, WALL, array, place_with};

fn modes(model: &Model) -> Vec<Vec<f64>> {
    let mut modes: Vec<Vec<f64>> =
        (0..2).map(|mode| (0..model.n).map(|row| (0.3 + (1.7 + mode as f64) * row as f64).sin()).collect()).collect();
    modes.push(modes[0].clone());
    modes
}

fn warnings(report: &Value) -> Vec<(String, String)> {
    let text = |value: &Value| value.as_str().expect("a text").to_owned();
    let list = report["body"]["warnings"].as_array().expect("a list");
    list.iter().map(|warning| (text(&warning["code"]), text(&warning["message"]))).collect()
}

#[test]
fn report_page_and_file_tell_what_is_known_of_the_modes() {
    let model = steel_brick();
    let place = place_with(&model, &modes(&model));
    let ended = Case { interface: TIP, fixed: "", reduction: OF_FILE }.run(&place).expect(ExitCode::Done);
    let text = ended.out;
    for words in [
        "mode acceleration",
        "2 expansion modes",
        "3 modes of a file",
        "expansion mode 3: depends on the columns before it",
        "completeness of the modes is not certified: they come from a file",
    ] {
        assert!(text.contains(words), "{words:?} is not in {text}");
    }
    let report = place.report("x.report.json");
    let schema: Value = serde_json::from_str(include_str!("../../schemas/report.schema.json")).expect("a schema");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let violations: Vec<String> = validator.iter_errors(&report).map(|error| error.to_string()).collect();
    assert_eq!(violations, Vec::<String>::new());
    let expansion = &report["body"]["reduction"]["expansion"];
    let kept: Vec<&Value> = expansion["modes"].as_array().expect("a list").iter().map(|mode| &mode["kept"]).collect();
    assert_eq!(kept, [&json!(true), &json!(true), &json!(false)]);
    assert_eq!(expansion["reduced_hz"].as_array().expect("a list").len(), 3);
    assert_eq!(report["body"]["reduction"]["n_modes"], 0, "no mode was computed");
    assert_eq!(report["body"]["completeness"]["is_certified"], false);
    let ids: Vec<&Value> =
        report["body"]["checks"].as_array().expect("a list").iter().map(|check| &check["id"]).collect();
    assert!(!ids.contains(&&json!("M-06")), "nothing was counted");
    let page = String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    assert!(page.contains("modes of a file") && page.contains("no frequency of the full model was computed"));
    let file = place.superelement("x.supel");
    assert!(file.metadata().inputs.contains_key("modes") && file.tensors().frequencies.is_empty());
    assert_eq!(file.metadata().job["reduction"]["modes"], json!({ "file": "modes.mtx" }));
    let shown = supel(&["inspect", "--json", &place.text("x.supel")]).expect(ExitCode::Done).out;
    let document: Value = serde_json::from_str(&shown).expect("JSON");
    assert_eq!(document["sizes"]["n_expansion_modes"], 2);
    let shown = supel(&["modes", &place.text("x.supel")]).expect(ExitCode::Done).out;
    assert!(shown.contains("its modes come from a file,"), "{shown}");
}

/// Held dofs and rigid patches take a part of a mode, which is told, and warned of from a modal assurance criterion of 0.9 on.
#[test]
fn what_held_dofs_and_patches_cannot_follow_is_told() {
    let model = steel_brick();
    let of_wall = |row: usize| model.dofs[row].0 % 5 == 1;
    let of_tip = |row: usize| model.dofs[row].0 % 5 == 0;
    // Nodes of the tip against each other.
    let of_row = |row: usize| match of_tip(row) {
        true => [1.0, -1.0][row / 15 % 2],
        false => 0.1,
    };
    let stretch: Vec<f64> = (0..model.n).map(of_row).collect();
    let rigid = model.rigid_body_modes()[5].clone();
    // vᵀMv less that of the motion of some columns that is nearest in the mass, by dense algebra.
    let mut mass = Mat::<f64>::zeros(model.n, model.n);
    model.mass.iter().for_each(|&(i, j, value)| mass[(i as usize, j as usize)] = value);
    let share = |mode: &[f64], columns: &[Vec<f64>]| {
        let t = Mat::from_fn(model.n, columns.len(), |i, j| columns[j][i]);
        let momenta = multiply(&model.mass, mode);
        let load = t.transpose() * Mat::from_fn(model.n, 1, |i, _| momenta[i]);
        let followed = (t.transpose() * &mass * &t).llt(Side::Lower).expect("definite").solve(&load);
        (1.0 - (load.transpose() * followed)[(0, 0)] / dot(mode, &momenta)).sqrt()
    };
    let free_but = |takes: &dyn Fn(usize) -> bool| -> Vec<Vec<f64>> {
        let unit = |row: usize| (0..model.n).map(|i| f64::from(u8::from(i == row))).collect();
        (0..model.n).filter(|row| !takes(*row)).map(unit).collect()
    };
    let place = place_with(&model, &[rigid.clone(), stretch.clone()]);
    let told = |place: &Place, case: Case| -> (Vec<f64>, Vec<(String, String)>) {
        case.run(place).expect(ExitCode::Done);
        let report = place.report("x.report.json");
        let rows = report["body"]["reduction"]["expansion"]["modes"].as_array().expect("a list").clone();
        (rows.iter().map(|row| row["not_followed"].as_f64().expect("a share")).collect(), warnings(&report))
    };
    let (lost, _) = told(&place, Case { interface: TIP, fixed: "", reduction: OF_FILE });
    assert_eq!(lost, [0.0, 0.0], "every row is a dof of its own");
    let (lost, _) = told(&place, Case { interface: AVERAGE, fixed: "", reduction: OF_FILE });
    assert_eq!(lost, [0.0, 0.0], "an average ties nothing");
    let (lost, warned) = told(&place, Case { interface: TIP, fixed: WALL, reduction: OF_FILE });
    for (lost, mode) in lost.iter().zip([&rigid, &stretch]) {
        // Steps end where 1e-15 is left in the norm of the diagonal, of which M is at most 27 times as large.
        assert!((lost - share(mode, &free_but(&of_wall))).abs() <= 1e-13, "{lost}");
    }
    let expected = lost.iter().any(|lost| lost * lost > 0.1);
    assert_eq!(warned.iter().any(|(code, _)| code == "W-MODES-HELD"), expected);
    let (lost, warned) = told(&place, Case { interface: PATCH, fixed: "", reduction: OF_FILE });
    assert_eq!(lost[0], 0.0, "a patch follows rigid-body motion");
    let of_patch = |motion: &Vec<f64>| (0..model.n).map(|row| if of_tip(row) { motion[row] } else { 0.0 }).collect();
    let mut columns = free_but(&of_tip);
    columns.extend(model.rigid_body_modes().iter().map(of_patch));
    assert!((lost[1] - share(&stretch, &columns)).abs() <= 1e-12, "{}", lost[1]);
    let (_, message) = warned.iter().find(|(code, _)| code == "W-MODES-HELD").expect("a warning");
    assert!(message.contains("of mode 2 of the file") && !message.contains("mode 1"), "{message}");
}

/// Other modes under the same name: the comparison with the job notices them by digest and by matrices.
#[test]
fn a_comparison_notices_other_modes() {
    let model = steel_brick();
    let mut modes = modes(&model);
    modes.truncate(2);
    let place = place_with(&model, &modes);
    Case { interface: TIP, fixed: "", reduction: OF_FILE }.made(&place);
    let compared = || supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
    // The same numbers written otherwise are the same modes, with a warning.
    place.write("modes.mtx", array(&modes).replace("e0\n", "E0\n").as_bytes());
    let said = compared().expect(ExitCode::Done).out;
    assert!(said.contains("it was made from the files of the job"), "{said}");
    modes[1][60] *= 1.001;
    place.write("modes.mtx", array(&modes).as_bytes());
    let said = compared().expect(ExitCode::CheckFailed).out;
    assert!(said.contains("modes"), "{said}");
    supel(&["verify", &place.text("x.supel"), "--reproduce"]).expect(ExitCode::CheckFailed);
}

/// A scene has the reduced model compared with the full one, and full certification proves what there is to prove.
#[test]
fn a_scene_compares_the_reduced_model_with_the_full_one() {
    let model = steel_brick();
    // All rigid-body motions and waves that are near bending: enough for the lowest frequencies.
    let mut modes = model.rigid_body_modes().to_vec();
    for (mode, axis) in (1..=4).flat_map(|mode| (0..3).map(move |axis| (mode, axis))) {
        let wave = |(node, direction): &(i64, u8)| {
            let x = model.nodes[*node as usize - 1][0];
            if *direction == axis { (f64::from(mode) * std::f64::consts::PI * x).cos() } else { 0.0 }
        };
        modes.push(model.dofs.iter().map(wave).collect());
    }
    let place = place_with(&model, &modes);
    Case { interface: TIP, fixed: "", reduction: OF_FILE }.run(&place).expect(ExitCode::Done);
    let job = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
    place.write(
        "job.toml",
        format!("{job}scene = {{ band_hz = [0, 2000] }}\nrun = {{ certify = \"full\" }}\n").as_bytes(),
    );
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let report = place.report("x.report.json");
    let boundaries = report["body"]["preservation"]["boundaries"].as_array().expect("a list");
    assert_eq!(boundaries.len(), 3, "free, held, loaded");
    let free = boundaries.iter().find(|boundary| boundary["boundary"] == "free").expect("free");
    let pairs = free["frequencies"].as_array().expect("a list");
    assert!(!pairs.is_empty());
    for pair in pairs {
        let [full, reduced] = ["full_hz", "reduced_hz"].map(|key| pair[key].as_f64().expect("a frequency"));
        assert!(reduced >= full * (1.0 - 1e-9), "{reduced} Hz bounds {full} Hz from above");
    }
}
