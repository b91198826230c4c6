//! Files cut at every byte and with bytes changed: an error that names file and place, or a matrix of finite numbers, never a panic.

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use supel::input::read;

use super::{fixture, job, stiffness};

/// One small file of every kind.
const FILES: [&str; 17] = [
    "k_csr.npz",
    "k_csc.npz",
    "k_dia.npz",
    "dense.npz",
    "k.npy",
    "sparse.mat",
    "sparse_deflated.mat",
    "sparse_big.mat",
    "dense_text.op4",
    "string_text.op4",
    "big_little.op4",
    "string_big_endian.op4",
    "k_large.pch",
    "small.bdf",
    "k.rsa",
    "k_labels.mtx",
    "user_element.mtx",
];

/// Files of lines, in which a cut between two entries leaves a smaller matrix.
const OF_LINES: [&str; 4] = ["k_large.pch", "small.bdf", "k_labels.mtx", "user_element.mtx"];

fn written(folder: &Path, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).expect("written");
    path
}

#[test]
fn every_file_cut_at_every_byte() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in FILES {
        let content = std::fs::read(fixture(name)).expect("a fixture");
        let mut last_read = None;
        for end in 0..content.len() {
            let path = written(folder.path(), name, &content[..end]);
            match read(&job(&path, &path)) {
                Ok(input) => {
                    assert!(input.stiffness.matrix.data().iter().all(|value| value.is_finite()), "{name} up to {end}");
                    last_read = Some(end);
                }
                Err(error) => assert!(error.to_string().contains(name), "{name} up to {end}: {error}"),
            }
            if let Ok(matrix) = stiffness(&path) {
                // What ends the second matrix, or fills up a record, may be missing where the first is read; a head of numbers that
                // is cut short is a line of three numbers.
                let is_in_head = name.ends_with("text.op4") && end < 40;
                // Without its last end of the line a number of Harwell and Boeing's may be cut.
                let least = if name.ends_with(".rsa") || name.ends_with(".rua") { 2 } else { 16 };
                let is_at_end = end + least > content.len();
                // Behind its first matrix a file of OUTPUT4 is one of a single matrix.
                let is_behind_first = name.ends_with(".op4") && 2 * end > content.len();
                let is_of_parts = OF_LINES.contains(&name) || name.ends_with(".mat") || is_behind_first;
                let may_be_read = is_of_parts || is_in_head || is_at_end;
                assert!(may_be_read, "{name} up to {end} of {} bytes: {matrix:?}", content.len());
            }
        }
        // A file of MATLAB that ends between two arrays is whole.
        let may_be_cut = OF_LINES.contains(&name) || name.ends_with(".mat");
        assert!(last_read.is_none_or(|end| may_be_cut || end + 16 > content.len()), "{name}: {last_read:?}");
    }
}

/// A checksum tells damage from another matrix: what is read of a packed file is the sound matrix, or nothing.
#[test]
fn packed_files_with_a_changed_bit_hold_no_other_matrix() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["sparse_deflated.mat", "k_csr.npz"] {
        let content = std::fs::read(fixture(name)).expect("a fixture");
        let sound = stiffness(&written(folder.path(), name, &content)).expect("a matrix");
        for (at, bit) in (0..content.len()).flat_map(|at| (0..8).map(move |bit| (at, bit))) {
            let mut changed = content.clone();
            changed[at] ^= 1 << bit;
            if let Ok(found) = stiffness(&written(folder.path(), name, &changed)) {
                assert_eq!(found, sound, "{name}: bit {bit} of byte {at}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn bytes_that_are_changed_never_panic(
        file in 0..FILES.len(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let name = FILES[file];
        let mut content = std::fs::read(fixture(name)).expect("a fixture");
        for (index, byte) in changes {
            let at = index.index(content.len());
            content[at] = byte;
        }
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(folder.path(), name, &content);
        match stiffness(&path) {
            Ok(matrix) => prop_assert!(matrix.data().iter().all(|value| value.is_finite())),
            Err(error) => prop_assert!(error.to_string().contains(name) || error.to_string().contains("m.mtx"), "{}", error),
        }
    }
}
