//! `--html` and `--junit` of `supel reduce`: what is written, and that it is all or nothing.

use std::ffi::OsString;
use std::path::Path;

use supel::cli::{ExitCode, Pipeline, Reduce, Terminal, run};
use supel::error::Result;
use supel::job::Job;
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::report::Observer;

use super::{by_id, parse, sample, text};

const FLAGS: [&str; 12] = [
    "supel",
    "reduce",
    "--stiffness",
    "K.mtx",
    "--mass",
    "M.mtx",
    "--interface",
    "hub=12",
    "--method",
    "herting",
    "--modes",
    "3",
];

/// Runs `supel reduce` with outputs `x.supel` and those of `rest`, all in `folder`.
fn reduce(reduce: Reduce, folder: &Path, rest: &[(&str, &str)]) -> (ExitCode, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let outputs = [("--output", "x.supel")].iter().chain(rest);
    let outputs = outputs.flat_map(|(flag, name)| [OsString::from(flag), folder.join(name).into_os_string()]);
    let args = FLAGS.into_iter().map(OsString::from).chain(outputs).chain(["--quiet".into()]);
    let code = run(args, Pipeline { reduce, ..supel::PIPELINE }, &mut Terminal::plain(&mut out, &mut err));
    (code, String::from_utf8(err).expect("UTF-8"))
}

fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("entry").file_name().into_string().expect("name")).collect();
    names.sort();
    names
}

fn failing(job: &Job, resources: Resources, observer: &mut dyn Observer) -> Result<Outcome> {
    let outcome = sample::pipeline(job, resources, observer)?;
    Ok(Outcome { report: sample::full_report(), ..outcome })
}

#[test]
fn page_and_junit_are_written_next_to_the_superelement() {
    let folder = tempfile::tempdir().expect("folder");
    let (code, err) = reduce(sample::pipeline, folder.path(), &[("--html", "x.html"), ("--junit", "x.xml")]);
    assert_eq!(code, ExitCode::Done, "{err}");
    assert_eq!(files(folder.path()), ["x.html", "x.report.json", "x.supel", "x.xml"]);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("read");
    let page = read("x.html");
    let page = parse(&page);
    // The page names the file by the digest that the file itself carries.
    let superelement = std::fs::read(folder.path().join("x.supel")).expect("read");
    let digest = text(by_id(&page, "of-run")).split_once("BLAKE3 ").expect("a digest").1.to_owned();
    assert!(superelement.windows(64).any(|window| window == digest.as_bytes()), "{digest} is not in the file");
    assert!(text(by_id(&page, "checks")).contains("M-26"));
    assert!(read("x.xml").contains("M-26 file read back"));
}

#[test]
fn nothing_is_written_where_one_output_cannot_be() {
    for rest in
        [[("--html", "x.html"), ("--junit", "missing/x.xml")], [("--html", "missing/x.html"), ("--junit", "x.xml")]]
    {
        let folder = tempfile::tempdir().expect("folder");
        let (code, err) = reduce(sample::pipeline, folder.path(), &rest);
        assert_eq!(code, ExitCode::Io, "{err}");
        assert!(err.contains("missing/x."), "{err}");
        assert_eq!(files(folder.path()), Vec::<String>::new());
    }
}

#[test]
fn failed_check_leaves_the_reports_without_a_superelement() {
    let folder = tempfile::tempdir().expect("folder");
    let (code, err) = reduce(failing, folder.path(), &[("--html", "x.html"), ("--junit", "x.xml")]);
    assert_eq!(code, ExitCode::CheckFailed, "{err}");
    assert_eq!(files(folder.path()), ["x.html", "x.report.json", "x.xml"]);
    let page = std::fs::read_to_string(folder.path().join("x.html")).expect("read");
    assert!(text(by_id(&parse(&page), "verdict")).contains("✗ Not verified"));
}
