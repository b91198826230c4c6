//! Writing, syncing, linking, naming and removing files.

use std::path::Path;

use supel_models::{Ends, spring};
use supel_runtime::Superelement;

use crate::place::Place;
use crate::shim::{Calls, Ended, Mode, count, run};

/// No space left on device.
const ENOSPC: i32 = 28;

const OUTPUTS: [&str; 4] = ["x.report.json", "x.html", "x.xml", "x.supel"];

/// A chain, its outputs named in a folder of their own.
struct Case {
    place: Place,
    args: Vec<String>,
}

impl Case {
    fn new() -> Self {
        let place = Place::with(&spring(12, Ends::Free));
        std::fs::create_dir(place.path("out")).expect("a folder");
        let mut args = vec!["reduce".to_owned(), "--force".to_owned()];
        args.extend(place.matrix_flags());
        args.extend("--interface ends=rows:0,11 --method craig-bampton --threads 1".split(' ').map(str::to_owned));
        for (flag, name) in [("--output", "x.supel"), ("--html", "x.html"), ("--junit", "x.xml")] {
            args.extend([flag.to_owned(), place.text(&format!("out/{name}"))]);
        }
        Self { place, args }
    }

    /// A run for so many modes; the number tells the runs apart.
    fn args<'a>(&'a self, modes: &'a str) -> Vec<&'a str> {
        self.args.iter().map(String::as_str).chain(["--modes", modes]).collect()
    }

    fn calls(&self) -> Calls {
        Calls::Files(self.place.path("out"), ENOSPC)
    }

    /// Writes the outputs of an earlier run.
    fn earlier(&self) -> String {
        self.clear();
        let ended = run(&self.args("1"), &self.calls(), 0, Mode::Once);
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        self.digest().expect("written")
    }

    fn clear(&self) {
        std::fs::remove_dir_all(self.place.path("out")).expect("removed");
        std::fs::create_dir(self.place.path("out")).expect("a folder");
    }

    fn digest(&self) -> Option<String> {
        let path = self.place.path("out/x.supel");
        path.exists().then(|| Superelement::open(&path).expect("whole").to_bytes().expect("bytes").digest)
    }

    /// Which of the outputs carry a digest.
    fn carriers(&self, digest: &str) -> Vec<&'static str> {
        let carries = |name: &&&str| {
            let text = std::fs::read(self.place.path(&format!("out/{name}"))).unwrap_or_default();
            text.windows(digest.len()).any(|window| window == digest.as_bytes())
        };
        OUTPUTS.iter().filter(carries).copied().collect()
    }

    fn parts(&self) -> Vec<String> {
        let names = std::fs::read_dir(self.place.path("out")).expect("a folder");
        let names = names.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
        names.filter(|name| !OUTPUTS.contains(&name.as_str())).collect()
    }

    /// What `supel verify` says of the superelement, without a fault.
    fn verified(&self) -> String {
        let file = self.place.text("out/x.supel");
        run(&["verify", &file], &Calls::Files(Path::new("/none").into(), 0), 0, Mode::Once).out
    }
}

/// The outputs are all of one run: of the one before where this one failed.
#[track_caller]
fn assert_of_one_run(case: &Case, ended: &Ended, earlier: Option<&str>, what: &str) {
    let Ended { code, err, .. } = ended;
    let found = case.digest();
    let is_new = found.as_deref() != earlier;
    match code {
        Some(0) => assert!(is_new, "{what}: done, and nothing is new: {err}"),
        Some(7) if err.contains("error[E-SYNC]") => assert!(is_new, "{what}: {err}"),
        Some(7) => {
            assert!(err.contains("error[E-WRITE]") && err.contains("cannot be written"), "{what}: {err}");
            assert!(!is_new, "{what}: refused, and the superelement is new: {err}");
        }
        other => panic!("{what}: exit code {other:?}: {err}"),
    }
    match &found {
        Some(digest) => assert_eq!(case.carriers(digest), OUTPUTS, "{what}: {err}"),
        None => assert!(OUTPUTS.iter().all(|name| !case.place.path(&format!("out/{name}")).exists()), "{what}: {err}"),
    }
}

/// Every call that changes a file fails once, where there was an earlier run and where there was none.
#[test]
fn a_call_that_fails_leaves_the_outputs_of_one_run() {
    let case = Case::new();
    let mut n_unsynced = 0;
    for has_earlier in [true, false] {
        let prepare = || {
            if has_earlier {
                Some(case.earlier())
            } else {
                {
                    case.clear();
                    None
                }
            }
        };
        prepare();
        let n_calls = count(&case.args("2"), &case.calls(), &case.place.path(""));
        assert!(n_calls > 20, "the shim sees {n_calls} calls");
        for at in 1..=n_calls {
            let earlier = prepare();
            let what = format!("call {at} of {n_calls}, earlier run: {has_earlier}");
            let ended = run(&case.args("2"), &case.calls(), at, Mode::Once);
            assert_of_one_run(&case, &ended, earlier.as_deref(), &what);
            n_unsynced += usize::from(ended.err.contains("error[E-SYNC]: ") && ended.err.contains("written, but"));
            // A removal that failed is all that may leave something, and the next run names it.
            let parts = case.parts();
            let next = run(&case.args("2"), &case.calls(), 0, Mode::Once);
            assert!(
                parts.len() <= 1 && parts.iter().all(|part| next.err.contains(part)),
                "{what}: {parts:?} {}",
                next.err
            );
        }
    }
    assert_eq!(n_unsynced, 2, "the last sync of each sweep");
}

/// A request to terminate comes after every call that changes a file: while outputs are tried, written, read back and named. All outputs are of one run,
/// and nothing else is left.
#[test]
fn a_request_to_terminate_leaves_the_outputs_of_one_run() {
    let case = Case::new();
    case.earlier();
    let n_calls = count(&case.args("2"), &case.calls(), &case.place.path(""));
    for at in 1..=n_calls {
        let earlier = case.earlier();
        let ended = run(&case.args("2"), &case.calls(), at, Mode::Terminate);
        let what = format!("after call {at} of {n_calls}: {}", ended.err);
        assert_eq!(ended.code, None, "{what}");
        let digest = case.digest().expect("one of the two");
        assert!(at < n_calls || digest != earlier, "the last call comes after the names");
        assert_eq!(case.carriers(&digest), OUTPUTS, "{what}");
        assert_eq!(case.parts(), [""; 0], "{what}");
    }
}

/// From some call on nothing works any more, as on a disk that is gone: what could not be taken back is named, and `verify` sees that report
/// and superelement are of two runs.
#[test]
fn a_disk_that_goes_away_leaves_outputs_that_can_be_told_apart() {
    let case = Case::new();
    case.earlier();
    let n_calls = count(&case.args("2"), &case.calls(), &case.place.path(""));
    let mut n_mixed = 0;
    for at in 1..=n_calls {
        let earlier = case.earlier();
        let ended = run(&case.args("2"), &case.calls(), at, Mode::From);
        let what = format!("from call {at} of {n_calls} on: {}", ended.err);
        let digest = case.digest().expect("one of the two");
        let parts = case.parts();
        if ended.err.contains("error[E-HALF-WRITTEN]") {
            n_mixed += 1;
            assert_eq!((ended.code, &digest), (Some(7), &earlier), "{what}");
            assert!(ended.err.contains("is new, its old content is in"), "{what}");
            assert!(case.verified().contains("report in its folder names this file"), "{what}: {}", case.verified());
            assert!(case.verified().contains("! warn"), "{what}: {}", case.verified());
        } else {
            assert_of_one_run(&case, &ended, Some(&earlier), &what);
        }
        let next = run(&case.args("2"), &case.calls(), 0, Mode::Once);
        assert!(parts.iter().all(|part| next.err.contains(part)), "{what}: {parts:?} {}", next.err);
    }
    assert!(n_mixed > 0, "no fault came between the first name and the last");
}
