//! Files reached through symbolic links: from which folder the paths written in them count, and that it is said.
#![cfg(unix)]

use std::os::unix::fs::symlink;

use supel::cli::ExitCode;
use supel_models::{Ends, spring};

use crate::place::{Place, supel};

const JOB: &str = "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\n[[interface]]\nname = \"ends\"\nnodes = { rows = [0, 11] }\n\
                   [reduction]\nmethod = \"craig-bampton\"\nmodes = { count = 3 }\n[write]\nsuperelement = \"x.supel\"\n";
const SAID: &str = "a link – the paths of its job count from the folder of the file";

fn with_job(ends: Ends) -> Place {
    let place = Place::with(&spring(12, ends));
    place.write("job.toml", JOB.as_bytes());
    place
}

fn link(from: &Place, to: (&Place, &str)) -> String {
    symlink(to.0.path(to.1), from.path("link")).expect("a link");
    let path = from.text(&format!("linked-{}", to.1));
    std::fs::rename(from.path("link"), &path).expect("renamed");
    path
}

/// The files next to the link are taken where they are there, so that one job serves several models; else those next to the job.
#[test]
fn a_job_through_a_link() {
    let (place, empty, other) = (with_job(Ends::Free), Place::new(), Place::with(&spring(12, Ends::Fixed)));
    let (by_link, in_other) = (link(&empty, (&place, "job.toml")), link(&other, (&place, "job.toml")));
    let told = supel(&["reduce", &by_link]).expect(ExitCode::Done);
    assert!(told.err.contains(SAID), "{}", told.err);
    let first = place.bytes("x.supel");
    let silent = supel(&["reduce", &in_other]).expect(ExitCode::Done);
    assert!(!silent.err.contains(SAID), "{}", silent.err);
    assert_eq!(place.bytes("x.supel"), first, "nothing is written next to the job");
    assert!(other.bytes("x.supel") != first, "another model");
    let (file, quiet) = (place.text("x.supel"), ["verify", "--quiet", "--job"]);
    let told = supel(&["verify", &file, "--job", &by_link]).expect(ExitCode::Done);
    assert!(told.err.contains(SAID), "{}", told.err);
    let silent = supel(&[&quiet, [by_link.as_str(), &file].as_slice()].concat()).expect(ExitCode::Done);
    assert!(silent.err.is_empty(), "{}", silent.err);
}

/// The way to the inputs was counted from the file: what lies next to a link to it is another model.
#[test]
fn a_superelement_through_a_link() {
    let (place, other) = (with_job(Ends::Free), with_job(Ends::Fixed));
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    for elsewhere in [&Place::new(), &other] {
        let path = link(elsewhere, (&place, "x.supel"));
        let verified = supel(&["verify", &path, "--reproduce"]).expect(ExitCode::Done);
        assert!(verified.err.contains(SAID), "{}", verified.err);
        assert!(verified.out.contains("report in its folder names this file"), "{}", verified.out);
        let shown = supel(&["inspect", &path, "--job"]).expect(ExitCode::Done);
        assert!(shown.err.contains(SAID), "{}", shown.err);
        let job: serde_json::Value = serde_json::from_str(&shown.out).expect("JSON");
        assert_eq!(job["model"]["stiffness"], place.text("K.mtx"));
        assert_eq!(job["write"]["superelement"], place.text("x.supel"));
    }
}

/// As a store of large files does it: the file went elsewhere, and a link stayed in its place.
#[test]
fn a_superelement_that_was_moved_behind_a_link() {
    let (place, store) = (with_job(Ends::Free), Place::new());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    store.write("0815", &place.bytes("x.supel"));
    std::fs::remove_file(place.path("x.supel")).expect("removed");
    symlink(store.path("0815"), place.path("x.supel")).expect("a link");
    let verified = supel(&["verify", &place.text("x.supel"), "--reproduce"]).expect(ExitCode::Done);
    assert!(!verified.err.contains(SAID), "{}", verified.err);
    assert!(verified.out.contains("report in its folder names this file"), "{}", verified.out);
}
