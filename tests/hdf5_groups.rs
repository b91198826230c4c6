//! HDF5 files whose groups are not as their convention has them, one change at a time, read by the program: it ends soon, with a matrix, a
//! mesh or one line that says what is wrong. The library itself is sound on such files: only their meaning is broken.
//!
//! The changes are the same in every run. `SUPEL_CASES=1` makes all of them, not one in so many.

#![cfg(feature = "hdf5")]

use std::path::{Path, PathBuf};
use std::time::Duration;

use hdf5_metno::{File, Group, Location};
use rayon::prelude::*;

/// A file of each convention, and what it is converted to.
const FILES: [(&str, &str); 22] = [
    ("hdf5/matlab.mat", "mtx"),
    ("hdf5/anndata.h5ad", "mtx"),
    ("hdf5/h5sparse.h5", "mtx"),
    ("hdf5/exudyn.hdf5", "mtx"),
    ("hdf5/plain.h5", "mtx"),
    ("hdf5/half.h5", "mtx"),
    ("hdf5/single_precision.h5", "mtx"),
    ("hdf5/filters.h5", "mtx"),
    ("hdf5/nastran.h5", "mtx"),
    ("matrices/octave.h5", "mtx"),
    ("matrices/julia.h5", "mtx"),
    ("matrices/binsparse.h5", "mtx"),
    ("hdf5/mesh.h5m", "vtkhdf"),
    ("hdf5/mesh.hmf", "vtkhdf"),
    ("hdf5/mesh.med", "vtkhdf"),
    ("mesh/box.hmf", "vtkhdf"),
    ("mesh/box.e", "vtkhdf"),
    ("mesh/box.cgns", "vtkhdf"),
    ("mesh/box.vtkhdf", "vtkhdf"),
    ("results/exudyn_part.hdf5", "mtx"),
    // Data of the XDMF file next to it, which is what is read.
    ("hdf5/mesh.h5", "vtkhdf"),
    ("mesh/box.h5", "vtkhdf"),
];
/// One change in so many is made: no divisor of their number, so that each kind is.
const STRIDE: usize = 7;
/// A run that takes longer hangs.
const LONGEST: Duration = Duration::from_secs(60);

/// What is done to a member of a group.
#[derive(Clone, Copy, Debug)]
enum Change {
    Removed,
    Group,
    Reals,
    Wholes,
    Negative,
    Huge,
    OtherShape,
    Single,
    Nothing,
    NotFinite,
    Bytes,
    Promised,
    LinkToItself,
    LinkToRoot,
    LinkOutside,
    HardCircle,
    NoAttributes,
    RealAttributes,
    LongAttributes,
    NegativeAttributes,
}

const CHANGES: [Change; 20] = [
    Change::Removed,
    Change::Group,
    Change::Reals,
    Change::Wholes,
    Change::Negative,
    Change::Huge,
    Change::OtherShape,
    Change::Single,
    Change::Nothing,
    Change::NotFinite,
    Change::Bytes,
    Change::Promised,
    Change::LinkToItself,
    Change::LinkToRoot,
    Change::LinkOutside,
    Change::HardCircle,
    Change::NoAttributes,
    Change::RealAttributes,
    Change::LongAttributes,
    Change::NegativeAttributes,
];

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

/// Paths of all groups and datasets below a group.
fn members(group: &Group, found: &mut Vec<String>) {
    for name in group.member_names().expect("names") {
        found.push(format!("{}/{name}", group.name().trim_end_matches('/')));
        if let Ok(below) = group.group(&name) {
            members(&below, found);
        }
    }
}

/// How many numbers a member has: those of a dataset, or a few.
fn n_numbers(group: &Group, name: &str) -> usize {
    group.dataset(name).map_or(4, |dataset| dataset.size().clamp(1, 1 << 12))
}

/// Makes a change of one member of a file.
fn changed(file: &File, path: &str, change: Change) -> hdf5_metno::Result<()> {
    let (folder, name) = path.rsplit_once('/').expect("a path");
    let group = file.group(if folder.is_empty() { "/" } else { folder })?;
    let n = n_numbers(&group, name);
    let attributes = |write: &dyn Fn(&Location, &str) -> hdf5_metno::Result<()>| {
        let found: Location = match group.dataset(name) {
            Ok(dataset) => (**dataset).clone(),
            Err(_) => (*group.group(name)?).clone(),
        };
        for attribute in found.attr_names()? {
            found.delete_attr(&attribute)?;
            write(&found, &attribute)?;
        }
        Ok(())
    };
    match change {
        Change::NoAttributes => return attributes(&|_, _| Ok(())),
        Change::RealAttributes => {
            return attributes(&|place, name| place.new_attr::<f64>().create(name)?.write_scalar(&f64::NAN));
        }
        Change::LongAttributes => {
            return attributes(&|place, name| {
                place.new_attr::<i64>().shape(70).create(name)?.write_raw(&[i64::MAX; 70])
            });
        }
        Change::NegativeAttributes => {
            return attributes(&|place, name| place.new_attr::<i64>().create(name)?.write_scalar(&i64::MIN));
        }
        Change::HardCircle => {
            let below = group.group(name)?;
            return below.link_hard(if folder.is_empty() { "/" } else { folder }, "circle");
        }
        _ => group.unlink(name)?,
    }
    let put = |values: &[i64]| group.new_dataset::<i64>().shape(values.len()).create(name)?.write_raw(values);
    match change {
        Change::Group => group.create_group(name).map(drop),
        Change::Reals => group.new_dataset::<f64>().shape(n).create(name)?.write_raw(&vec![0.5; n]),
        Change::NotFinite => group.new_dataset::<f64>().shape(n).create(name)?.write_raw(&vec![f64::NAN; n]),
        Change::Wholes => put(&(0..n as i64).collect::<Vec<_>>()),
        Change::Negative => put(&vec![-1; n]),
        Change::Huge => put(&vec![i64::MAX; n]),
        Change::OtherShape => {
            group.new_dataset::<i32>().shape((1, n, 1)).create(name)?.write_raw(&(0..n as i32).collect::<Vec<_>>())
        }
        Change::Single => group.new_dataset::<i64>().create(name)?.write_scalar(&1),
        Change::Nothing => group.new_dataset::<f64>().shape(0).create(name).map(drop),
        Change::Bytes => group.new_dataset::<i8>().shape(n).create(name)?.write_raw(&vec![-128; n]),
        // Nothing of it is stored.
        Change::Promised => group.new_dataset::<f64>().chunk(1 << 10).shape(1usize << 40).create(name).map(drop),
        Change::LinkToItself => group.link_soft(path, name),
        Change::LinkToRoot => group.link_soft("/", name),
        Change::LinkOutside => group.link_external("/etc/passwd", "/", name),
        _ => Ok(()),
    }
}

/// A folder with a file of a convention, and with what refers to it.
fn copied(name: &str) -> (tempfile::TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let copy = |name: &str| {
        let path = folder.path().join(Path::new(name).file_name().expect("a name"));
        std::fs::copy(fixture(name), &path).expect("copied");
        path
    };
    let data = copy(name);
    let read = match name {
        "hdf5/mesh.h5" => copy("hdf5/mesh.xdmf"),
        "mesh/box.h5" => copy("mesh/box.xdmf"),
        _ => data.clone(),
    };
    (folder, data, read)
}

/// What is wrong with how the program ended on a file of this kind; none where it ended well.
fn fault(read: &Path, target: &str) -> Option<String> {
    let new = read.with_extension(format!("new.{target}"));
    let ended = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("supel"))
        .arg("convert")
        .args([read, &new])
        .timeout(LONGEST)
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    let errors: Vec<&str> = said.lines().filter(|line| line.starts_with("supel: error")).collect();
    match (ended.status.code(), errors.as_slice()) {
        (Some(0), []) => None,
        // What the library cannot survive has a code of its own, and a sound library survives a sound file.
        (Some(3..=6), [only]) if !only.contains("E-HDF5-CRASH") && !only.contains("E-HDF5-TIME") => None,
        (code, _) => Some(format!("{code:?}: {said}")),
    }
}

#[test]
fn groups_that_break_their_convention_end_in_one_line() {
    let stride = if std::env::var_os("SUPEL_CASES").is_some() { 1 } else { STRIDE };
    let mut cases = Vec::new();
    for (name, target) in FILES {
        let mut paths = Vec::new();
        let file = File::open(fixture(name)).expect("HDF5");
        members(&file.group("/").expect("the root"), &mut paths);
        paths.truncate(60);
        cases.extend(paths.into_iter().flat_map(|path| CHANGES.map(|change| (name, target, path.clone(), change))));
    }
    let cases: Vec<_> = cases.into_iter().enumerate().filter(|(at, _)| at % stride == 0).collect();
    let outcomes: Vec<Option<String>> = cases
        .par_iter()
        .filter_map(|(_, (name, target, path, change))| {
            let (_folder, data, read) = copied(name);
            // What cannot be made of an object is not a case.
            let file = File::open_rw(&data).expect("HDF5");
            changed(&file, path, *change).ok()?;
            file.close().expect("closed");
            Some(fault(&read, target).map(|fault| format!("{name} {path} {change:?}: {fault}")))
        })
        .collect();
    assert!(outcomes.len() > 300, "{} of {} cases were made", outcomes.len(), cases.len());
    let faults: Vec<&String> = outcomes.iter().flatten().collect();
    assert!(faults.is_empty(), "{} of {}: {faults:#?}", faults.len(), outcomes.len());
}

/// The files as they are: what the changes are made of is read.
#[test]
fn every_file_is_read_as_it_is() {
    for (name, target) in FILES {
        // Of these several matrices could be meant.
        if target == "vtkhdf" {
            let (_folder, _, read) = copied(name);
            assert_eq!(fault(&read, target), None, "{name}");
        }
    }
}
