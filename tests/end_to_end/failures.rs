//! What ends a run, with which exit code, and what is left on disk.

use supel::cli::ExitCode;
use supel_models::{Ends, spring};

use crate::place::{Ended, Place, supel};

const FOOT: &str = "--interface foot=1,11,31,41 --method herting --modes 5";

#[test]
fn a_matrix_that_is_not_one_is_an_input_error() {
    let place = Place::with_brick();
    place.write("M.mtx", b"%%MatrixMarket matrix coordinate real symmetric\n135 135 1\n1 1 one\n");
    let ended = place.reduce(&place.model_flags(), FOOT).expect(ExitCode::InputData);
    assert!(ended.err.contains("M.mtx: line 3") || ended.err.contains("M.mtx:3"), "{}", ended.err);
    assert!(!place.path("x.supel").exists());
    assert!(!place.path("x.report.json").exists());
}

#[test]
fn an_interface_that_cannot_react_rigid_motion_is_a_physics_error() {
    let place = Place::with_brick();
    let ended = place
        .reduce(&place.model_flags(), "--interface foot=1 --method herting --modes 5")
        .expect(ExitCode::ModelPhysics);
    assert!(ended.err.contains("interface"), "{}", ended.err);
    assert!(!place.path("x.supel").exists());
}

#[test]
fn a_run_that_does_not_fit_is_refused() {
    let place = Place::with_brick();
    let limited = |gib: f64| {
        place.reduce(&place.model_flags(), &format!("{FOOT} --memory-gib {gib}")).expect(ExitCode::Resources)
    };
    // From too little to read the files to too little for the factor.
    let limit = |step: usize| 1e-6 * 1.1_f64.powi(step as i32);
    let limits = (0..100).map(limit);
    // K and M are read at the same time, so that the step at which both fit is not that of every run.
    let mut ended: Vec<Ended> = Vec::new();
    for limit in limits {
        ended.push(limited(limit));
        if !ended[ended.len() - 1].err.contains("error[E-MEM-READ]") {
            break;
        }
    }
    assert!(ended.len() > 4 && ended[0].err.contains("– 1.05 KiB of memory is available –"), "{}", ended[0].err);
    let ended = &ended[ended.len() - 1];
    assert!(ended.err.starts_with("supel: error[E-MEM]: "), "{}", ended.err);
    let needed = ended.err.split(" – ").next().unwrap_or_default();
    assert!(needed.ends_with("KiB") || needed.ends_with("MiB"), "{}", ended.err);
    assert!(ended.err.contains(" of memory is available –"), "{}", ended.err);
    assert!(!place.path("x.supel").exists());
}

/// A job for the brick whose expected mass is the true one times a factor.
fn expecting(mass_factor: f64) -> Place {
    let place = Place::with_brick();
    let mass = 7850.0 * 0.31 * 0.23 * mass_factor;
    let job = format!(
        r#"
model = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv", expect = {{ mass = {mass} }} }}
interface = [{{ name = "foot", nodes = [1, 11, 31, 41] }}]
reduction = {{ method = "herting", modes = {{ count = 5 }} }}
write = {{ superelement = "x.supel" }}
"#
    );
    place.write("job.toml", job.as_bytes());
    place
}

fn reduce(place: &Place, flags: &[&str]) -> Ended {
    let job = place.text("job.toml");
    supel(&[["reduce", &job].as_slice(), flags].concat())
}

#[test]
fn a_failed_check_leaves_a_report_and_no_superelement() {
    let place = expecting(1.1);
    let ended = reduce(&place, &[]).expect(ExitCode::CheckFailed);
    assert!(ended.err.contains("not written: a check failed"), "{}", ended.err);
    assert!(!place.path("x.supel").exists());
    let report = place.report("x.report.json");
    assert_eq!(report["body"]["verdict"], "fail");
    let failed: Vec<_> = report["body"]["checks"].as_array().expect("checks").iter().collect();
    let failed: Vec<_> = failed.iter().filter(|check| check["verdict"] == "fail").collect();
    assert_eq!(failed.len(), 1, "{failed:?}");
    assert_eq!(failed[0]["id"], "M-16");
}

#[test]
fn an_unverified_superelement_says_so_itself() {
    let place = expecting(1.1);
    reduce(&place, &["--allow-unverified"]).expect(ExitCode::CheckFailed);
    let verdict = place.superelement("x.supel").metadata().verification.verdict;
    assert_eq!(verdict, supel_runtime::Verdict::Fail);
}

#[test]
fn a_warning_fails_only_where_asked() {
    // Between the limit 1e-4 and the failure at 1e-2.
    let place = expecting(1.001);
    reduce(&place, &["--strict"]).expect(ExitCode::CheckFailed);
    assert!(!place.path("x.supel").exists());
    reduce(&place, &[]).expect(ExitCode::Done);
    assert_eq!(place.report("x.report.json")["body"]["verdict"], "warn");
    reduce(&expecting(1.0), &["--strict"]).expect(ExitCode::Done);
}

/// What ends with exit code 1 and without a superelement is called verified nowhere.
#[test]
fn a_strict_run_with_a_warning_is_called_not_accepted() {
    let place = expecting(1.001);
    let page = place.text("x.html");
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let told = one_line(&reduce(&place, &["--html", &page, "--strict"]).expect(ExitCode::CheckFailed).out);
    assert!(!told.contains("! verified") && told.contains("! not accepted: 1 check past its limit (M-16)"), "{told}");
    assert!(told.contains("--strict accepts none – no superelement was written"), "{told}");
    let heading = |place: &Place| String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    assert!(heading(&place).contains("</span> Not accepted with checks past their limits"));
    assert_eq!(place.report("x.report.json")["body"]["verdict"], "warn");
    let told = reduce(&place, &["--html", &page]).expect(ExitCode::Done).out;
    assert!(told.contains("! verified, with 1 check past its limit (M-16)"), "{told}");
    assert!(heading(&place).contains("</span> Verified, with checks past their limits"));
}

fn small_chain() -> (Place, Vec<String>) {
    let place = Place::with(&spring(5, Ends::Free));
    let flags = place.matrix_flags();
    (place, flags)
}

const CHAIN: &str = "--interface ends=rows:0,4 --method craig-bampton --modes 1 --threads 1";

#[test]
fn a_superelement_cut_anywhere_is_refused() {
    let (place, flags) = small_chain();
    place.reduce(&flags, CHAIN).expect(ExitCode::Done);
    let whole = place.bytes("x.supel");
    let cut = place.text("cut.supel");
    for length in 0..whole.len() {
        place.write("cut.supel", &whole[..length]);
        let ended = supel(&["inspect", &cut]);
        assert_eq!(ended.code, ExitCode::InputData, "{length} bytes: {}{}", ended.out, ended.err);
        assert!(ended.err.starts_with("supel: error[E-"), "{}", ended.err);
    }
}

#[test]
fn a_matrix_cut_anywhere_is_refused() {
    let (place, flags) = small_chain();
    for name in ["K.mtx", "M.mtx"] {
        let whole = place.bytes(name);
        // The last line is `5 5 1e0`; without its end it may still be the same number.
        let certain = whole.len() - "e0\n".len();
        for length in 0..certain {
            place.write(name, &whole[..length]);
            let ended = place.reduce(&flags, CHAIN);
            assert_eq!(ended.code, ExitCode::InputData, "{name}, {length} bytes: {}{}", ended.out, ended.err);
        }
        place.write(name, &whole);
    }
    place.reduce(&flags, CHAIN).expect(ExitCode::Done);
}

/// A run that failed leaves its report with the superelement of the run before: `verify` says that they are not of one run.
#[test]
fn a_report_of_another_run_is_noticed() {
    let place = expecting(1.0);
    reduce(&place, &[]).expect(ExitCode::Done);
    let (file, name) = (place.text("x.supel"), "report in its folder names this file");
    let verified = supel(&["verify", &file, "--strict"]).expect(ExitCode::Done);
    assert!(verified.out.contains(name), "{}", verified.out);
    place.write("job.toml", &expecting(1.001).bytes("job.toml"));
    reduce(&place, &["--strict"]).expect(ExitCode::CheckFailed);
    let told = supel(&["verify", &file, "--json"]).expect(ExitCode::Done);
    let document: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    let check = document["checks"].as_array().expect("checks").iter().find(|check| check["name"] == name).expect("one");
    assert_eq!(
        (&check["verdict"], &check["worst"]),
        (&"warn".into(), &"x.report.json is of a run that wrote no superelement".into())
    );
    supel(&["verify", &file, "--strict"]).expect(ExitCode::CheckFailed);

    let other = expecting(1.0);
    reduce(&other, &["--modes", "7"]).expect(ExitCode::Done);
    std::fs::copy(other.path("x.report.json"), place.path("x.report.json")).expect("copied");
    let told = supel(&["verify", &file]).expect(ExitCode::Done);
    assert!(told.out.contains("x.report.json is of a file with BLAKE3"), "{}", told.out);
    std::fs::remove_file(place.path("x.report.json")).expect("removed");
    assert!(!supel(&["verify", &file, "--strict"]).expect(ExitCode::Done).out.contains(name));
}

/// Page and JUnit file carry the digest of the superelement, and are held to it as the report is.
#[test]
fn a_page_or_a_junit_file_of_another_run_is_noticed() {
    let with_all = |modes: &str| {
        let place = expecting(1.0);
        let job = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
        let written = "write = { superelement = \"x.supel\", html = \"x.html\", junit = \"x.xml\" }";
        place.write("job.toml", job.replace("write = { superelement = \"x.supel\" }", written).as_bytes());
        reduce(&place, &["--modes", modes]).expect(ExitCode::Done);
        place
    };
    let (place, other) = (with_all("5"), with_all("7"));
    let verified = || supel(&["verify", &place.text("x.supel"), "--strict"]);
    verified().expect(ExitCode::Done);
    for name in ["x.html", "x.xml"] {
        let own = place.bytes(name);
        place.write(name, &other.bytes(name));
        let told = verified().expect(ExitCode::CheckFailed);
        assert!(told.out.contains(&format!("{name} is of a file with BLAKE3")), "{}", told.out);
        // That of a run that wrote no superelement has no digest.
        let text = String::from_utf8(own.clone()).expect("UTF-8");
        let without: Vec<&str> =
            text.lines().filter(|line| !line.contains("BLAKE3 ") && !line.contains("blake3")).collect();
        place.write(name, without.join("\n").as_bytes());
        let told = verified().expect(ExitCode::CheckFailed);
        assert!(told.out.contains(&format!("{name} is of a run that wrote no superelement")), "{}", told.out);
        place.write(name, &own);
        verified().expect(ExitCode::Done);
    }
}
