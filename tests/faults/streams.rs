//! Streams that take nothing, files that may not grow, a parent that is gone.

use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};

use supel_models::{Ends, Material, brick, spring};

use crate::place::Place;

/// The program started by a shell script, in which it is `"$0" "$@"`.
fn shell(script: &str, args: &[&str]) -> (Option<i32>, String) {
    let program = assert_cmd::cargo::cargo_bin!("supel");
    let ended = Command::new("sh").args(["-c", script]).arg(program).args(args).output().expect("a shell");
    (ended.status.code(), String::from_utf8_lossy(&ended.stderr).into_owned())
}

/// The program with a pipe for its stdout that nobody reads.
fn without_reader(args: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("supel"));
    let mut child = command.args(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    drop(child.stdout.take());
    let ended = child.wait_with_output().expect("ended");
    (ended.status.code(), String::from_utf8_lossy(&ended.stderr).into_owned())
}

/// A chain with its superelement.
fn place() -> (Place, Vec<String>) {
    let place = Place::with(&spring(12, Ends::Free));
    let mut args = vec!["reduce".to_owned(), "--force".to_owned(), "--output".to_owned(), place.text("x.supel")];
    args.extend(place.matrix_flags());
    args.extend(
        "--interface ends=rows:0,11 --method craig-bampton --modes 2 --threads 1".split(' ').map(str::to_owned),
    );
    let texts: Vec<&str> = args.iter().map(String::as_str).collect();
    assert_eq!(shell("exec \"$0\" \"$@\" > /dev/null", &texts).0, Some(0));
    (place, args)
}

#[test]
fn an_answer_that_does_not_arrive_is_exit_7() {
    let (place, args) = place();
    let file = place.text("x.supel");
    let reduce: Vec<&str> = args.iter().map(String::as_str).collect();
    let with = |flag| [reduce.as_slice(), &[flag]].concat();
    let commands: [&[&str]; 8] = [
        &["inspect", &file],
        &["inspect", &file, "--json"],
        &["verify", &file],
        &["verify", &file, "--json"],
        &reduce,
        &with("--json"),
        &["--help"],
        &["--version"],
    ];
    for args in commands {
        for script in ["exec \"$0\" \"$@\" > /dev/full", "exec \"$0\" \"$@\" >&-"] {
            let (code, err) = shell(script, args);
            assert_eq!(code, Some(7), "{script} {args:?}: {err}");
            assert!(err.starts_with("supel: error[E-STDOUT]: the answer could not be written to stdout: "), "{err}");
            assert_eq!(err.lines().count(), 1, "{err}");
        }
        // A reader that has gone away needs no answer.
        assert_eq!(without_reader(args), (Some(0), String::new()), "{args:?}");
        assert_eq!(shell("exec \"$0\" \"$@\" > /dev/null", args).0, Some(0), "the null device takes everything");
    }
    for script in ["exec \"$0\" \"$@\" > /dev/full", "exec \"$0\" \"$@\" >&-"] {
        assert_eq!(shell(script, &with("--quiet")), (Some(0), String::new()), "no answer was asked for");
        // An error that was told on stderr keeps its code.
        assert_eq!(shell(script, &["inspect", "/no/such.supel", "--json"]).0, Some(7));
        assert_eq!(shell(script, &["reduce", "--modes", "x", "--json"]).0, Some(2));
    }
}

/// A limit on the size of files is an error like a full disk, not the end of the process.
#[test]
fn a_file_that_may_not_grow_is_an_error() {
    let (place, args) = place();
    let before = (place.bytes("x.supel"), place.bytes("x.report.json"));
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    for blocks in 0..12 {
        let (code, err) = shell(&format!("ulimit -f {blocks}; exec \"$0\" \"$@\" > /dev/null"), &args);
        assert_eq!(code, Some(7), "{blocks} blocks: {err}");
        assert!(err.starts_with("supel: error[E-WRITE]: ") && err.contains("File too large"), "{err}");
        assert!((place.bytes("x.supel"), place.bytes("x.report.json")) == before, "{blocks} blocks");
    }
    let names = std::fs::read_dir(place.path("")).expect("a folder");
    assert!(names.flatten().all(|entry| !entry.file_name().to_string_lossy().ends_with(".part")));
}

/// Ended by a signal at any time, a run leaves its whole file or none.
#[test]
fn f_06_an_interrupted_run_leaves_nothing() {
    let place = Place::with(&spring(4000, Ends::Free));
    let mut args = vec!["reduce".to_owned(), "--quiet".to_owned(), "--output".to_owned(), place.text("x.supel")];
    args.extend(place.matrix_flags());
    args.extend("--interface ends=rows:0,3999 --method herting --modes 4".split(' ').map(str::to_owned));
    let mut n_ended = 0;
    for (signal, wait) in ["-INT", "-TERM"].iter().flat_map(|signal| [0, 10, 30, 90, 270].map(|wait| (signal, wait))) {
        for name in ["x.supel", "x.report.json"] {
            let _ = std::fs::remove_file(place.path(name));
        }
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("supel"));
        let mut child = command.args(&args).stderr(Stdio::null()).spawn().expect("started");
        std::thread::sleep(std::time::Duration::from_millis(wait));
        // A run that has ended takes no signal any more.
        let _ = Command::new("kill").arg(signal).arg(child.id().to_string()).stderr(Stdio::null()).status();
        let ended = child.wait().expect("ended");
        n_ended += usize::from(ended.code().is_none());
        let expected = if signal == &"-INT" { libc::SIGINT } else { libc::SIGTERM };
        assert!(ended.code() == Some(0) || ended.signal() == Some(expected), "{signal} after {wait} ms: {ended}");
        assert!(ended.code().is_none() || place.path("x.supel").exists());
        if place.path("x.supel").exists() {
            place.superelement("x.supel");
        }
        let names: Vec<_> =
            std::fs::read_dir(place.path("")).expect("a folder").flatten().map(|e| e.file_name()).collect();
        let is_left = names.iter().any(|name| name.to_string_lossy().contains(".part"));
        assert!(!is_left, "{signal} after {wait} ms: {names:?}");
    }
    assert!(n_ended >= 2, "{n_ended} of ten runs were ended by the signal");
}

/// METIS takes the handler of SIGTERM for itself while it orders the nodes of a solid, half of the time of this run.
#[test]
fn a_run_that_orders_nodes_is_ended_by_the_signal() {
    let place = Place::with(&brick([11, 11, 11], [1.0; 3], &Material::UNIT));
    let mut args = vec!["reduce".to_owned(), "--quiet".to_owned(), "--output".to_owned(), place.text("x.supel")];
    args.extend(place.matrix_flags());
    args.extend("--interface end=rows:0,1,2 --method guyan --force".split(' ').map(str::to_owned));
    for wait in (2..20).map(|step| 15 * step) {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("supel"));
        let mut child = command.args(&args).stderr(Stdio::null()).spawn().expect("started");
        std::thread::sleep(std::time::Duration::from_millis(wait));
        let _ = Command::new("kill").arg("-TERM").arg(child.id().to_string()).stderr(Stdio::null()).status();
        let ended = child.wait().expect("ended");
        assert!(ended.code().is_some() || ended.signal() == Some(libc::SIGTERM), "after {wait} ms: {ended}");
    }
}

/// The child that reads HDF5 first ends when the other end of its stdin is closed, which the end of its parent does in any case.
#[cfg(feature = "hdf5")]
#[test]
fn the_child_ends_with_its_parent() {
    use std::io::Write;

    let place = Place::with(&spring(5, Ends::Free));
    // Reading this takes seconds.
    let file = hdf5_metno::File::create(place.path("locked.hmf")).expect("a file");
    let grid = file.create_group("domain").and_then(|domain| domain.create_group("grid")).expect("groups");
    let builder = grid.new_dataset_builder().deflate(1).chunk((1 << 16, 3));
    let zeros = vec![[0.0; 3]; 1 << 24];
    builder.with_data::<_, f64, _>(zeros.as_slice()).create("Geometry").expect("a dataset");
    drop(grid);
    file.close().expect("closed");
    // A process that another test started in between may hold the lock of what was written.
    std::fs::copy(place.path("locked.hmf"), place.path("zeros.hmf")).expect("copied");
    let model = serde_json::json!({ "stiffness": place.path("K.mtx"), "mass": place.path("M.mtx"), "nodes": place.path("zeros.hmf") });
    let task =
        serde_json::json!({ "model": model, "matrices": [], "modes": [], "cells": "Unwanted", "memory_bytes": null });
    let task = format!("{task}\n");
    let child = || {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("supel"));
        command.arg("rehearse-reading").stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().expect("started");
        let mut stdin = child.stdin.take().expect("a pipe");
        stdin.write_all(task.as_bytes()).expect("written");
        (child, stdin)
    };
    let (mut alone, stdin) = child();
    drop(stdin);
    assert_eq!(alone.wait().expect("ended").code(), Some(6), "it went on reading");
    let (mut kept, stdin) = child();
    assert_eq!(kept.wait().expect("ended").code(), Some(0));
    drop(stdin);
}
