//! What comes out, compared with closed formulae, with other ways in, and with what Python finds in the file.

use std::path::Path;
use std::process::Command;

use supel::cli::ExitCode;
use supel_models::{Ends, spectrum, spring, spring_spectrum};
use supel_runtime::Method;

use crate::place::{Ended, Place, assert_close, frequencies_hz, steel_brick, supel, warnings_of_reduction};

/// Lanczos and the formulae are both right to some ten roundings of the largest eigenvalue, which is below 1e3 times the
/// smallest in these models.
const SAME: f64 = 1e-11;

fn hertz(eigenvalues: &[f64]) -> Vec<f64> {
    eigenvalues.iter().map(|value| value.sqrt() / std::f64::consts::TAU).collect()
}

/// `supel inspect FILE --job > job.json` in one folder, `supel reduce job.json` of what is in another.
#[test]
fn the_job_kept_in_a_file_runs_from_any_folder() {
    let (place, elsewhere) = (Place::with_brick(), Place::new());
    let flags = "--interface foot=1,11,31,41 --method herting --modes 4";
    place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
    let made = place.bytes("x.supel");
    // An output named by a way through another folder keeps the same way to the inputs.
    std::fs::create_dir(place.path("inner")).expect("a folder");
    let output = place.text("inner/../x.supel");
    let model = place.model_flags();
    let mut args: Vec<&str> = vec!["reduce", "--output", &output];
    args.extend(model.iter().map(String::as_str).chain(flags.split_whitespace()));
    supel(&args).expect(ExitCode::Done);
    assert!(place.bytes("x.supel") == made, "the same file, by another name of its folder");
    let job = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
    elsewhere.write("job.json", job.as_bytes());
    std::fs::remove_file(place.path("x.supel")).expect("removed");
    let again = elsewhere.text("again.supel");
    supel(&["reduce", &elsewhere.text("job.json"), "--output", &again]).expect(ExitCode::Done);
    let first = supel_runtime::Superelement::from_bytes(&made).expect("a file");
    assert_eq!(elsewhere.superelement("again.supel").tensors(), first.tensors());
    supel(&["reduce", &elsewhere.text("job.json")]).expect(ExitCode::Done);
    assert!(place.bytes("x.supel") == made, "the same file, in its own folder");
}

#[test]
fn herting_keeps_the_modes_of_the_free_component() {
    let place = Place::with(&spring(12, Ends::Free));
    place.reduce(&place.matrix_flags(), "--interface ends=rows:0,11 --method herting --modes 4").expect(ExitCode::Done);
    let superelement = place.superelement("x.supel");
    assert_eq!(superelement.metadata().method, Method::Herting);
    let exact = hertz(&spring_spectrum(12, Ends::Free)[1..5]);
    assert_close(&frequencies_hz(&superelement), &exact, SAME);
}

#[test]
fn craig_bampton_keeps_the_modes_of_the_held_component() {
    let place = Place::with(&spring(12, Ends::Free));
    place
        .reduce(&place.matrix_flags(), "--interface ends=rows:0,11 --method craig-bampton --modes 4")
        .expect(ExitCode::Done);
    let superelement = place.superelement("x.supel");
    assert_eq!(superelement.metadata().method, Method::CraigBampton);
    assert_eq!(superelement.tensors().stiffness.rows(), 6);
    let exact = hertz(&spring_spectrum(10, Ends::Fixed)[..4]);
    assert_close(&frequencies_hz(&superelement), &exact, SAME);
}

#[test]
fn a_band_keeps_the_modes_below_its_end() {
    let place = Place::with(&spring(12, Ends::Free));
    let exact = hertz(&spring_spectrum(12, Ends::Free)[1..]);
    let end = (exact[4] + exact[5]) / 2.0;
    place
        .reduce(&place.matrix_flags(), &format!("--interface ends=rows:0,11 --method herting --up-to-hz {end}"))
        .expect(ExitCode::Done);
    assert_close(&frequencies_hz(&place.superelement("x.supel")), &exact[..5], SAME);
}

/// The modes of a solid by dense rotations, an algorithm that shares nothing with the program's.
#[test]
fn flags_alone_reduce_a_solid_by_both_methods() {
    let place = Place::with_brick();
    let exact = hertz(&spectrum(&steel_brick())[6..11]);
    // The corners of the face x = 0, and three of the opposite one.
    let interface = "--interface foot=1,11,31,41 --rigid-interface head=5,15,35";
    let by = |method: &str| {
        place.reduce(&place.model_flags(), &format!("{interface} --method {method} --modes 5")).expect(ExitCode::Done);
        place.superelement("x.supel")
    };
    let (herting, craig_bampton) = (by("herting"), by("craig-bampton"));
    for superelement in [&herting, &craig_bampton] {
        assert_eq!(superelement.tensors().rigid_body_modes.cols(), 6);
        assert_eq!(superelement.metadata().interface_nodes.len(), 5);
    }
    // The rigid patch stiffens the block and the clamps stiffen it further.
    let (free, held) = (frequencies_hz(&herting), frequencies_hz(&craig_bampton));
    assert!(free.iter().zip(&exact).all(|(free, exact)| free > exact), "{free:?}\n{exact:?}");
    assert!(held[0] != free[0], "{held:?}");
    place.reduce(&place.model_flags(), "--interface foot=1,11,31,41 --method herting --modes 5").expect(ExitCode::Done);
    assert_close(&frequencies_hz(&place.superelement("x.supel")), &exact, SAME);
}

#[test]
fn without_a_certificate_the_modes_are_the_same_and_the_report_says_so() {
    let place = Place::with_brick();
    let flags = "--interface foot=1,11,31,41 --method herting --modes 5";
    place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
    let certified = frequencies_hz(&place.superelement("x.supel"));
    assert_eq!(place.report("x.report.json")["body"]["completeness"]["is_certified"], true);
    let ended = place.reduce(&place.model_flags(), &format!("{flags} --certify none")).expect(ExitCode::Done);
    assert_eq!(frequencies_hz(&place.superelement("x.supel")), certified);
    assert_eq!(place.report("x.report.json")["body"]["completeness"]["is_certified"], false);
    assert!(ended.out.contains("not certified: --certify none was asked"), "{}", ended.out);
}

/// Without coordinates the rigid-body modes come from the matrices; the component is the same.
#[test]
fn a_model_without_coordinates_is_reduced_from_its_matrices() {
    let place = Place::with_brick();
    let end = "--method herting --modes 5";
    place.reduce(&place.model_flags(), &format!("--interface foot=1,11,31,41 {end}")).expect(ExitCode::Done);
    let known = place.superelement("x.supel");
    let ended = place
        .reduce(&place.matrix_flags(), &format!("--interface foot=rows:0,1,2,30,31,32,90,91,92,120,121,122 {end}"))
        .expect(ExitCode::Done);
    let bare = place.superelement("x.supel");
    assert!(ended.out.contains("6 modes from the matrices"), "{}", ended.out);
    let rigid = &place.report("x.report.json")["body"]["model"]["rigid_body_modes"];
    assert_eq!(rigid["source"], "algebraic");
    assert_eq!(rigid["count"], 6);
    assert!(bare.metadata().interface_nodes.is_empty());
    // Only the noise of the algebraic modes, about 1e-9 of the smallest elastic eigenvalue, may tell them apart.
    assert_close(&frequencies_hz(&bare), &frequencies_hz(&known), 1e-9);
}

#[test]
fn python_confirms_the_files_of_both_methods() {
    let python = std::env::var_os("SUPEL_PYTHON").unwrap_or_else(|| "python3".into());
    let probe = Command::new(&python).args(["-c", "import numpy, safetensors"]).output();
    if !probe.is_ok_and(|probe| probe.status.success()) {
        println!("skipped: {} has no numpy and safetensors; set SUPEL_PYTHON", python.display());
        return;
    }
    let place = Place::with_brick();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/superelement_file.py");
    for method in ["herting", "craig-bampton"] {
        let flags = format!("--interface foot=1,11,31,41 --rigid-interface head=5,15,35 --method {method} --modes 6");
        place.reduce(&place.model_flags(), &flags).expect(ExitCode::Done);
        let ended = Command::new(&python)
            .arg(&script)
            .arg(place.path("x.supel"))
            .env("PYTHONUTF8", "1")
            .output()
            .expect("started");
        let text = String::from_utf8_lossy(&ended.stdout).into_owned();
        assert!(ended.status.success(), "{method}: {text}{}", String::from_utf8_lossy(&ended.stderr));
        assert!(text.contains("frequencies: 6 agree") && text.contains("mass properties: mass "), "{text}");
    }
}

#[test]
fn inspect_shows_what_was_reduced() {
    let place = Place::with_brick();
    let flags = "--interface foot=1,11,31,41 --method herting --modes 5";
    place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
    let shown = supel(&["inspect", &place.text("x.supel")]).expect(ExitCode::Done);
    assert!(shown.out.contains("foot") && shown.out.contains("Herting"), "{}", shown.out);
    let document = supel(&["inspect", &place.text("x.supel"), "--json"]).expect(ExitCode::Done);
    let document: serde_json::Value = serde_json::from_str(&document.out).expect("JSON");
    assert_eq!(document["sizes"]["n_reduced"], place.superelement("x.supel").tensors().mass.rows());
    assert_eq!(document["metadata"]["job"]["run"].get("memory_gib"), None, "the machine's memory is in the file");
}

#[cfg(feature = "arpack")]
#[test]
fn both_eigensolvers_find_the_same_modes() {
    let place = Place::with_brick();
    for method in ["herting", "craig-bampton"] {
        let flags = format!("--interface foot=1,11,31,41 --method {method} --modes 5");
        let by = |solver: &str| {
            place.reduce(&place.model_flags(), &format!("{flags} --eigensolver {solver}")).expect(ExitCode::Done);
            frequencies_hz(&place.superelement("x.supel"))
        };
        // Rounding that a solve amplifies: ε times the condition of the stiffness, below 1e6 here.
        assert_close(&by("arpack"), &by("lanczos"), 1e-9);
    }
}

/// An interface that just holds the component has no stiffness of its own: K̂_BB = 0, which is right and no failure.
#[test]
fn a_statically_determinate_interface_is_no_failure() {
    let chain = Place::with(&spring(12, Ends::Free));
    let brick = Place::with_brick();
    for method in ["herting", "craig-bampton"] {
        let is_silent = |place: &Place, ended: Ended| {
            ended.expect(ExitCode::Done);
            let report = place.report("x.report.json");
            let checks = report["body"]["checks"].as_array().expect("checks").iter();
            let is_loud = |check: &serde_json::Value| check["verdict"] == "warn" || check["verdict"] == "fail";
            assert!(checks.filter(|check| is_loud(check)).count() == 0 && warnings_of_reduction(&report).is_empty());
        };
        let rest = format!("--interface end=rows:0 --method {method} --modes 4");
        is_silent(&chain, chain.reduce(&chain.matrix_flags(), &rest));
        for interface in ["--interface foot=1,11,31", "--rigid-interface foot=1,11,31"] {
            let rest = format!("{interface} --method {method} --modes 5");
            is_silent(&brick, brick.reduce(&brick.model_flags(), &rest));
        }
    }
}

/// Matrices, dof map, nodes, and what an XDMF refers to: in the superelement, in every kind of report, and compared by `verify`.
#[test]
fn digests_of_all_inputs_are_recorded() {
    let place = Place::with_brick();
    let rest = "--interface foot=1,11,31,41 --method herting --modes 4";
    let (html, junit) = (place.text("x.html"), place.text("x.xml"));
    let args = format!("{rest} --html {html} --junit {junit}");
    let ended = place.reduce(&place.model_flags(), &args).expect(ExitCode::Done);
    let digest = |name: &str| blake3::hash(&place.bytes(name)).to_hex().to_string();
    let inputs = place.superelement("x.supel").metadata().inputs.clone();
    let expected = [("dofs", "dofs.txt"), ("mass", "M.mtx"), ("nodes", "nodes.csv"), ("stiffness", "K.mtx")];
    let expected: Vec<(String, String)> =
        expected.iter().map(|(role, name)| ((*role).to_owned(), digest(name))).collect();
    assert_eq!(inputs.into_iter().collect::<Vec<_>>(), expected);
    let model = place.report("x.report.json")["body"]["model"].clone();
    assert_eq!(model["files"], serde_json::json!({ "dofs": digest("dofs.txt"), "nodes": digest("nodes.csv") }));
    let page = String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    assert!(page.contains(&digest("nodes.csv")) && page.contains("BLAKE3 of dof map"), "{page}");
    assert!(ended.out.contains(&format!("blake3 {}", &digest("dofs.txt")[..12])), "{}", ended.out);

    let of_file = place.superelement("x.supel").to_bytes().expect("bytes").digest;
    let junit = String::from_utf8(place.bytes("x.xml")).expect("UTF-8");
    assert!(junit.contains(&format!("<property name=\"blake3\" value=\"{of_file}\"/>")), "{junit}");
    assert!(junit.contains("<property name=\"superelement\" value=\"x.supel\"/>"), "{junit}");

    let job = supel(&["inspect", &place.text("x.supel"), "--job"]).out;
    place.write("job.json", job.as_bytes());
    let (file, job) = (place.text("x.supel"), place.text("job.json"));
    supel(&["verify", &file, "--job", &job, "--strict"]).expect(ExitCode::Done);
    let nodes = String::from_utf8(place.bytes("nodes.csv")).expect("text") + "\n";
    place.write("nodes.csv", nodes.as_bytes());
    let told = supel(&["verify", &file, "--job", &job]);
    assert!(told.out.contains("worst at nodes"), "{}", told.out);
}
