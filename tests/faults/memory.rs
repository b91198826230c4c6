//! Allocations that fail: the run ends with exit code 6 and says in which stage, or with the right answer; it never aborts, never hangs and
//! writes nothing.

use supel_models::{Ends, Material, brick, spring};

use crate::place::Place;
use crate::shim::{Calls, Ended, Mode, count, run};

/// Runs of one command, and how many of them ended without memory.
struct Sweep<'a> {
    place: &'a Place,
    args: &'a [&'a str],
    /// Files that the command writes; none of them is there after a run without memory.
    written: &'a [&'a str],
}

impl Sweep<'_> {
    /// Fails `n_runs` allocations of at least so many bytes, spread over the run.
    fn run(&self, least: usize, n_runs: usize, mode: Mode) -> usize {
        self.clear();
        let calls = Calls::Heap(least);
        let n_calls = count(self.args, &calls, &self.place.path(""));
        assert!(n_calls > 0, "the shim sees no allocation of {least} bytes");
        let expected = self.contents();
        let mut n_without = 0;
        for at in (0..n_runs.min(n_calls)).map(|run| 1 + run * n_calls / n_runs.min(n_calls)) {
            self.clear();
            let ended = run(self.args, &calls, at, mode);
            let what = format!("{:?}, allocation {at} of {n_calls} of {least} bytes ({mode:?})", self.args[0]);
            n_without += usize::from(self.assert_sound(&ended, &expected, &what));
        }
        n_without
    }

    fn clear(&self) {
        self.written.iter().for_each(|name| drop(std::fs::remove_file(self.place.path(name))));
    }

    /// The superelement; reports differ by their times.
    fn contents(&self) -> Option<Vec<u8>> {
        self.written.first().map(|name| self.place.bytes(name))
    }

    /// Whether the run ended without memory.
    #[track_caller]
    fn assert_sound(&self, ended: &Ended, expected: &Option<Vec<u8>>, what: &str) -> bool {
        let Ended { code, out, err } = ended;
        match code {
            Some(0) => {
                assert_eq!(&self.contents(), expected, "{what}: done, with another answer");
                return false;
            }
            Some(6) => {}
            // The standard library allocates the handle of a thread past the program's allocator and ends the process where that fails:
            // one allocation of some fifty bytes for each thread, from memory that any program has left. So does the C library where it
            // notes what a thread has to clear at its end. Nothing is written then.
            None if is_of_thread(err) => {
                assert!(self.written.iter().all(|name| !self.place.path(name).exists()), "{what}: {err}");
                return true;
            }
            other => panic!("{what}: exit code {other:?}\n{out}\n{err}"),
        }
        let lines: Vec<&str> = err.lines().filter(|line| line.starts_with("supel: error[")).collect();
        assert_eq!(lines.len(), 1, "{what}: {err}");
        let named = ["could not be allocated", "cannot be started", "(os error 12)"];
        assert!(named.iter().any(|words| lines[0].contains(words)), "{what}: {err}");
        let in_folder = std::fs::read_dir(self.place.path("")).expect("a folder");
        for entry in in_folder {
            let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
            assert!(
                !self.written.contains(&name.as_str()) && !name.ends_with(".part"),
                "{what}: {name} is there\n{err}"
            );
        }
        true
    }
}

/// Whether the memory was that of a thread: of its handle, which its size tells, or of what the C library clears at its end.
fn is_of_thread(err: &str) -> bool {
    const LARGEST_HANDLE: usize = 64;
    if err.starts_with("Fatal glibc error: failed to register TLS destructor: out of memory") {
        return true;
    }
    let failed = err.strip_prefix("memory allocation of ").filter(|err| err.contains("failed"));
    let size = failed.and_then(|err| err.split(' ').next()?.parse().ok());
    size.is_some_and(|size: usize| size <= LARGEST_HANDLE)
}

/// Whether a signal ended the run within the HDF5 library: without a word, after its own words, or with those of the C library whose heap it
/// has overwritten.
#[cfg(feature = "hdf5")]
fn is_crash_of_library(err: &str) -> bool {
    let words = ["HDF5-DIAG", "malloc()", "free()", "corrupted"];
    err.is_empty() || err.contains("overflowed its stack") || words.iter().any(|words| err.starts_with(words))
}

fn texts(args: &[String]) -> Vec<&str> {
    args.iter().map(String::as_str).collect()
}

fn reducing(place: &Place, model: Vec<String>, rest: &str) -> Vec<String> {
    let mut args = vec!["reduce".to_owned(), "--force".to_owned()];
    args.extend(model);
    args.extend(
        ["--output", "--html", "--junit"]
            .iter()
            .zip(["x.supel", "x.html", "x.xml"])
            .flat_map(|(flag, name)| [(*flag).to_owned(), place.text(name)]),
    );
    args.extend(rest.split(' ').map(str::to_owned));
    args
}

const WRITTEN: [&str; 4] = ["x.supel", "x.report.json", "x.html", "x.xml"];

/// From text, with every kind of output; nearly every failure ends the run.
#[test]
fn reduce_without_memory() {
    let place = Place::with(&brick([4, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI));
    let args =
        reducing(&place, place.model_flags(), "--interface foot=1,11,31,41 --method herting --modes 4 --threads 2");
    let sweep = Sweep { place: &place, args: &texts(&args), written: &WRITTEN };
    let n_small = sweep.run(1, 40, Mode::Once);
    let n_large = sweep.run(4096, 30, Mode::Once);
    let n_for_good = sweep.run(1, 20, Mode::From);
    assert!(n_small >= 36 && n_large >= 27 && n_for_good == 20, "{n_small} of 40, {n_large} of 30, {n_for_good} of 20");
}

/// With nodes in HDF5, which a child process reads first: neither it nor its parent takes a lack of memory for a damaged file, but where
/// the library crashes of it.
#[cfg(feature = "hdf5")]
#[test]
fn reduce_from_hdf5_without_memory() {
    let place = Place::with_example();
    let flags = ["--stiffness", "stiffness.mtx.gz", "--mass", "mass.mtx.gz", "--nodes", "bracket.med"];
    let model = flags.iter().map(|text| if text.starts_with("--") { (*text).to_owned() } else { place.text(text) });
    // No such group: the run ends after it has read everything.
    let rest = "--rigid-interface base=group:NONE --method herting --modes 4 --threads 2";
    let args = reducing(&place, model.collect(), rest);
    let calls = Calls::Heap(1);
    let args = texts(&args);
    let n_calls = count(&args, &calls, &place.path(""));
    let (mut n_without, mut n_crashed) = (0, 0);
    for at in (0..60).map(|run| 1 + run * n_calls / 60) {
        let ended = run(&args, &calls, at, Mode::Once);
        let what = format!("allocation {at} of {n_calls}: {:?} {}", ended.code, ended.err);
        match ended.code {
            Some(3) if ended.err.contains("error[E-GROUP]") => {}
            Some(6) => n_without += 1,
            // The library recurses until its stack ends where one of some two hundred allocations of its own start fails. They are
            // made from memory that the program has asked for before, so that only a test has them fail. Where one of a few others
            // fails, it uses what it did not get: in the child, where a crash looks like that of a damaged file, or here. Nothing is being
            // written yet.
            Some(3) if ended.err.contains("or memory that ran out within the library") => n_crashed += 1,
            None if is_crash_of_library(&ended.err) => n_crashed += 1,
            _ => panic!("{what}"),
        }
    }
    assert!(n_without > 30 && n_crashed <= 3, "{n_without} without memory, {n_crashed} crashed");
}

/// A library that calls `exit` where it has no memory, wherever that is: the run ends as one without memory.
#[test]
fn reduce_with_a_library_that_ends_the_process() {
    let place = Place::with(&brick([4, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI));
    let rest = "--interface foot=1,11,31,41 --method herting --modes 4 --threads 2 --json";
    let args = reducing(&place, place.model_flags(), rest);
    let (args, calls) = (texts(&args), Calls::Heap(1));
    let sweep = Sweep { place: &place, args: &args, written: &WRITTEN };
    let n_calls = count(&args, &calls, &place.path(""));
    // Neither before the program has begun nor after it has ended.
    for at in (1..20).map(|twentieth| twentieth * n_calls / 20) {
        sweep.clear();
        let ended = run(&args, &calls, at, Mode::Exit);
        let what = format!("exit at allocation {at} of {n_calls}");
        assert!(sweep.assert_sound(&ended, &None, &what), "{what}");
        assert!(ended.out.contains("\"exit_code\": 6"), "{what}: {}", ended.out);
    }
}

/// MiB of addresses that the linear algebra library reserves on each of two threads and the first one: twice the last cache of the
/// processor, of which servers have hundreds of MiB.
#[cfg(feature = "hdf5")]
fn linear_algebra_mib() -> usize {
    let size = std::fs::read_to_string("/sys/devices/system/cpu/cpu0/cache/index3/size").unwrap_or_default();
    let kib: usize = size.trim().trim_end_matches('K').parse().unwrap_or(0);
    3 * 2 * kib / 1024
}

/// Under a limit on addresses, as a shell or a batch system sets it, from too little for anything to enough.
#[cfg(feature = "hdf5")]
#[test]
fn reduce_from_hdf5_under_a_limit() {
    let place = Place::with_example();
    let (job, program) = (place.text("job.toml"), assert_cmd::cargo::cargo_bin!("supel"));
    let mut n_done = 0;
    let most = 400 + linear_algebra_mib();
    for mib in (40..most).step_by(most / 24) {
        let script = format!("ulimit -v {}; exec \"$0\" reduce \"$1\" --force --threads 2 --quiet", mib << 10);
        let ended =
            std::process::Command::new("sh").args(["-c", &script]).arg(program).arg(&job).output().expect("a shell");
        let err = String::from_utf8_lossy(&ended.stderr);
        match ended.status.code() {
            Some(0) => n_done += 1,
            Some(6) => assert!(err.starts_with("supel: error[E-"), "{mib} MiB: {err}"),
            // Not even the program and its libraries are loaded.
            Some(127) => assert!(mib < 100, "{mib} MiB: {err}"),
            other => panic!("{mib} MiB: {other:?} {err}"),
        }
    }
    assert!(n_done > 0, "the largest limit is too small");
}

#[test]
fn verify_inspect_and_a_run_without_work_without_memory() {
    let place = Place::with(&spring(30, Ends::Free));
    let job = "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\n[[interface]]\nname = \"ends\"\nnodes = { rows = [0, 29] }\n\
               [reduction]\nmethod = \"craig-bampton\"\nmodes = { count = 3 }\n[write]\nsuperelement = \"a.supel\"\n";
    place.write("job.toml", job.as_bytes());
    crate::place::supel(&["reduce", &place.text("job.toml"), "--threads", "1"]).expect(supel::cli::ExitCode::Done);
    let (file, job) = (place.text("a.supel"), place.text("job.toml"));
    let commands: [&[&str]; 5] = [
        // It is up to date.
        &["reduce", &job, "--threads", "1"],
        &["inspect", &file],
        &["inspect", &file, "--json"],
        &["verify", &file, "--threads", "1"],
        &["verify", &file, "--job", &job, "--threads", "1"],
    ];
    for args in commands {
        let sweep = Sweep { place: &place, args, written: &[] };
        let (n_once, n_for_good) = (sweep.run(1, 25, Mode::Once), sweep.run(1, 10, Mode::From));
        assert!(n_once >= 22 && n_for_good == 10, "{args:?}: {n_once} of 25, {n_for_good} of 10");
    }
}

/// What `--json` promises, and the stage.
#[test]
fn a_document_is_written_without_memory_too() {
    let place = Place::with(&brick([4, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI));
    let rest = "--interface foot=1,11,31,41 --method herting --modes 4 --threads 1 --json";
    let args = reducing(&place, place.model_flags(), rest);
    let (args, calls) = (texts(&args), Calls::Heap(1 << 14));
    let n_calls = count(&args, &calls, &place.path(""));
    let mut stages = std::collections::BTreeSet::new();
    for at in 1..=n_calls.min(60) {
        let ended = run(&args, &calls, 1 + at * (n_calls - 1) / n_calls.min(60), Mode::Once);
        if ended.code != Some(6) {
            continue;
        }
        let document: serde_json::Value = serde_json::from_str(&ended.out).expect("JSON");
        assert_eq!(
            (&document["error"]["code"], &document["error"]["exit_code"]),
            (&"E-OUT-OF-MEMORY".into(), &6.into())
        );
        let message = document["error"]["message"].as_str().expect("text");
        // The library of the ordering says something of its own before.
        let last = ended.err.lines().last().unwrap_or_default();
        assert_eq!(last, format!("supel: error[E-OUT-OF-MEMORY]: {message}"));
        stages.extend(
            message.split_once('`').and_then(|(_, rest)| rest.split_once('`')).map(|(stage, _)| stage.to_owned()),
        );
    }
    assert!(stages.len() >= 3 && !stages.contains("unknown"), "{stages:?}");
}
