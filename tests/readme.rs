//! Every command in the README runs, in the order of the page, in a folder of its own; every job of README and `docs/job.md`
//! is a job.

#![cfg(feature = "hdf5")]

use std::path::{Path, PathBuf};
use std::process::Command;

use supel::job::Job;

const README: &str = include_str!("../README.md");
const JOB: &str = include_str!("../docs/job.md");
const FORMATS: &str = include_str!("../docs/formats.md");

/// The fenced blocks of a page: language with its marks, and content.
fn blocks(page: &'static str) -> Vec<(&'static str, &'static str)> {
    let mut blocks = Vec::new();
    let mut rest = page;
    while let Some((_, block)) = rest.split_once("\n```") {
        let (mark, block) = block.split_once('\n').expect("a fence ends its line");
        let (content, after) = block.split_once("\n```").expect("a block ends");
        blocks.push((mark, content));
        rest = after;
    }
    blocks
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder with the bundled examples and the comparison with peers, as a copy of the repository has them.
fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("folder");
    for part in ["examples/bracket", "examples/beam", "benches/peers"] {
        let copy = folder.path().join(part);
        std::fs::create_dir_all(&copy).expect("folder");
        for entry in std::fs::read_dir(root().join(part)).expect("a folder of the repository") {
            let path = entry.expect("entry").path();
            if path.is_file() {
                std::fs::copy(&path, copy.join(path.file_name().expect("name"))).expect("copied");
            }
        }
    }
    folder
}

/// What the comparison with peers lacks on this machine; nothing is installed to find out.
fn lacking(folder: &Path, content: &str) -> Option<String> {
    let check = format!("{content} --check");
    let ended = Command::new("bash").args(["-c", &check]).current_dir(folder).env("PATH", search_path()).output();
    let ended = ended.expect("a shell");
    (!ended.status.success()).then(|| String::from_utf8_lossy(&ended.stderr).trim().replace('\n', "; "))
}

/// The search path with the program under test in front.
fn search_path() -> std::ffi::OsString {
    let program = PathBuf::from(assert_cmd::cargo::cargo_bin!("supel"));
    let folders = program.parent().map(Path::to_owned).into_iter();
    let others = std::env::var_os("PATH").unwrap_or_default();
    std::env::join_paths(folders.chain(std::env::split_paths(&others))).expect("a search path")
}

fn assert_is_job(text: &str) {
    let job = Job::parse(text, Path::new("job.toml")).expect("a job");
    job.validate().expect("valid");
}

fn run(folder: &Path, program: &str, args: &[&str]) {
    let mut command = Command::new(program);
    command.args(args).current_dir(folder).env("PATH", search_path()).env("XDG_CACHE_HOME", folder);
    let ended = command.output();
    let ended = ended.unwrap_or_else(|error| panic!("{program}: {error}"));
    let (out, err) = (String::from_utf8_lossy(&ended.stdout), String::from_utf8_lossy(&ended.stderr));
    assert!(ended.status.success(), "{}\n{out}\n{err}", args.join(" "));
    assert!(!out.contains("False"), "{out}");
}

#[test]
fn every_conversion_of_the_page_of_formats_runs() {
    let folder = workplace();
    let commands: Vec<&str> =
        blocks(FORMATS).into_iter().filter(|(mark, _)| *mark == "sh run").map(|block| block.1).collect();
    assert_eq!(commands.len(), 1);
    commands.iter().for_each(|content| run(folder.path(), "bash", &["-euo", "pipefail", "-c", content]));
    assert!(folder.path().join("K.mtx").exists());
}

#[test]
fn every_command_of_the_readme_runs() {
    let folder = workplace();
    let python = std::env::var("SUPEL_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_python = Command::new(&python)
        .args(["-c", "import numpy, safetensors"])
        .output()
        .is_ok_and(|ended| ended.status.success());
    let mut n_run = 0;
    for (mark, content) in blocks(README) {
        match mark {
            "sh peers" => match lacking(folder.path(), content) {
                None => run(folder.path(), "bash", &["-euo", "pipefail", "-c", content]),
                Some(what) => println!("skipped: {content}: {what}"),
            },
            "sh run" => run(folder.path(), "bash", &["-euo", "pipefail", "-c", content]),
            "python run" if has_python => run(folder.path(), &python, &["-c", content]),
            "python run" => println!("skipped: {python} has no numpy and safetensors; set SUPEL_PYTHON"),
            // The continuous integration script runs these.
            "sh" => assert!(content.starts_with("./setup.sh "), "not marked `run`: {content}"),
            "toml" => assert_is_job(content),
            _ => panic!("a block of an unknown kind: {mark}"),
        }
        n_run += usize::from(mark.ends_with(" run") || mark.ends_with(" peers"));
    }
    assert_eq!(n_run, 18, "blocks that are run");
    let again = Job::read(&folder.path().join("again.json")).expect("the job kept in the file is a job");
    assert_eq!(again.write.superelement.file_name(), Some("small.supel".as_ref()));
    let named = [
        "examples/bracket/bracket.supel",
        "examples/bracket/bracket.report.json",
        "bracket-cb.supel",
        "bracket.html",
        "checks.xml",
        "displacements.csv",
        "small.op4",
        "again.again.supel",
        "beam.supel",
    ];
    for name in named {
        assert!(folder.path().join(name).exists(), "{name} was not written");
    }
}

#[test]
fn the_page_of_the_job_has_every_key() {
    let all = blocks(JOB);
    let jobs: Vec<_> = all.iter().filter(|(mark, _)| *mark == "toml").collect();
    assert_eq!(jobs.len(), 2);
    jobs.iter().for_each(|(_, content)| assert_is_job(content));
    let schema: serde_json::Value =
        serde_json::from_str(include_str!("../schemas/job.schema.json")).expect("the schema is JSON");
    let mut keys = Vec::new();
    collect_keys(&schema, &mut keys);
    assert!(keys.len() > 40, "{keys:?}");
    let words: Vec<&str> = JOB.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let missing: Vec<_> = keys.iter().filter(|key| !words.contains(&key.as_str())).collect();
    assert!(missing.is_empty(), "docs/job.md lacks {missing:?}");
}

/// The names of all properties in a JSON schema.
fn collect_keys(schema: &serde_json::Value, keys: &mut Vec<String>) {
    let inside: Vec<&serde_json::Value> = match schema {
        serde_json::Value::Object(map) => map.values().collect(),
        serde_json::Value::Array(list) => list.iter().collect(),
        _ => Vec::new(),
    };
    if let Some(properties) = schema.get("properties").and_then(serde_json::Value::as_object) {
        keys.extend(properties.keys().cloned());
    }
    inside.into_iter().for_each(|value| collect_keys(value, keys));
}

/// Terminals and side-by-side views show 120 columns.
#[test]
fn lines_of_the_readme_are_short() {
    for (number, line) in README.lines().chain(JOB.lines()).enumerate() {
        assert!(line.chars().count() <= 120, "line {}: {line}", number + 1);
    }
}

#[test]
fn files_that_the_readme_names_exist() {
    for name in [
        "schemas/job.schema.json",
        "schemas/report.schema.json",
        "schemas/superelement.schema.json",
        "schemas/inspection.schema.json",
        "docs/what-the-report-proves.md",
        "docs/images/report.png",
        "docs/export.md",
        "docs/job.md",
        "docs/errors.md",
        "docs/what-verify-sees.md",
        "docs/assemblies.md",
        "docs/certify.md",
        "docs/doctor.md",
        "schemas/modes.schema.json",
        "benches/README.md",
        "benches/results/B-brick.svg",
        "benches/results/B-brick.csv",
        "benches/results/B-summary.md",
        "benches/results/C-slender-90987.svg",
        "benches/results/E-slender-herting.svg",
        "runtime/capi/supel.h",
        "runtime/capi/example.c",
        "CONTRIBUTING.md",
        "validation/README.md",
        "schemas/export.schema.json",
        "schemas/verification.schema.json",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "setup.sh",
    ] {
        assert!(README.contains(name), "{name} is not named");
        assert!(root().join(name).exists(), "{name} does not exist");
    }
}
