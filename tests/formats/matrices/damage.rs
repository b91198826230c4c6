//! Files cut at every byte and with bytes changed: an error that names file and place, or a matrix of finite numbers, never a panic.

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use supel::error::{Error, ErrorClass};
use supel::input::read;

use super::{fixture, job, stiffness};

/// One small file of every kind.
const FILES: [&str; 31] = [
    "k.mtx",
    "k_array.mtx",
    "k_gzip.mtx",
    "k_bzip2.mtx",
    "k_zstd.mtx",
    "k_csr.npz",
    "k_csc.npz",
    "k_coo.npz",
    "k_bsr.npz",
    "k_dia.npz",
    "dense.npz",
    "k.npy",
    "k_half.npy",
    "m_fortran_big.npy",
    "sparse.mat",
    "octave6.mat",
    "octave7.mat",
    "sparse_deflated.mat",
    "sparse_big.mat",
    "dense_text.op4",
    "string_text.op4",
    "big_little.op4",
    "wide_words.op4",
    "string_big_endian.op4",
    "k_large.pch",
    "small.bdf",
    "k.rsa",
    "k.rua",
    "k_labels.mtx",
    "k_coordinate.sti",
    "user_element.mtx",
];

/// Files of lines, in which a cut between two entries leaves a smaller matrix.
const OF_LINES: [&str; 5] = ["k_large.pch", "small.bdf", "k_labels.mtx", "k_coordinate.sti", "user_element.mtx"];

/// A file of this name: one of the fixtures, or one that is made of the text of one.
fn content(name: &str) -> Vec<u8> {
    let text = || std::fs::read(fixture("k.mtx")).expect("a fixture");
    match name {
        "k_array.mtx" => b"%%MatrixMarket matrix array real symmetric\n2 2\n2.5\n-0.125\n4.0e3\n".to_vec(),
        "k_coordinate.sti" => b"1 1 2.5\n2 1 -0.125\n2 2 4.0\n".to_vec(),
        "k_gzip.mtx" => packed(flate2::read::GzEncoder::new(&text()[..], flate2::Compression::default())),
        "k_bzip2.mtx" => packed(bzip2::read::BzEncoder::new(&text()[..], bzip2::Compression::default())),
        "k_zstd.mtx" => ruzstd::encoding::compress_to_vec(&text()[..], ruzstd::encoding::CompressionLevel::Fastest),
        _ => std::fs::read(fixture(name)).expect("a fixture"),
    }
}

fn packed(mut encoder: impl std::io::Read) -> Vec<u8> {
    let mut bytes = Vec::new();
    encoder.read_to_end(&mut bytes).expect("packed");
    bytes
}

/// What is wrong with a file as a whole has no place in it: nothing in it, no matrix, a matrix of another size, two that differ.
const OF_WHOLE_FILE: [&str; 9] = [
    "E-NO-DATA",
    "E-NO-MATRIX",
    "E-NO-SUCH-MATRIX",
    "E-MATRIX-AMBIGUOUS",
    "E-SIZE-MISMATCH",
    "E-ROWS-UNNAMED",
    "E-MATRIX-SIZE",
    "E-FORMAT",
    "E-HDF5-SIGNATURE",
];

/// Whether a message says where in the file the damage is: a line, a byte, or how much was sound.
fn has_place(error: &Error, name: &str) -> bool {
    let text = error.to_string();
    let has_number = |before: &str| {
        text.match_indices(before).any(|(at, _)| text[at + before.len()..].starts_with(|c: char| c.is_ascii_digit()))
    };
    OF_WHOLE_FILE.contains(&error.code())
        || ["line ", "byte ", "first ", &format!("{name}:")].iter().any(|word| has_number(word))
}

fn written(folder: &Path, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).expect("written");
    path
}

#[test]
fn every_file_cut_at_every_byte() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut placeless = std::collections::BTreeMap::new();
    for name in FILES {
        let content = content(name);
        let mut last_read = None;
        for end in 0..content.len() {
            let path = written(folder.path(), name, &content[..end]);
            match read(&job(&path, &path)) {
                Ok(input) => {
                    assert!(input.stiffness.matrix.data().iter().all(|value| value.is_finite()), "{name} up to {end}");
                    last_read = Some(end);
                }
                Err(error) => {
                    assert!(error.to_string().contains(name), "{name} up to {end}: {error}");
                    if !has_place(&error, name) {
                        placeless.entry((error.code(), name)).or_insert((end, error.to_string()));
                    }
                }
            }
            if let Ok(matrix) = stiffness(&path) {
                // What ends the second matrix, or fills up a record, may be missing where the first is read; a head of numbers that
                // is cut short is a line of three numbers.
                let is_in_head = name.ends_with("text.op4") && end < 40;
                // Without its last end of the line a number of Harwell and Boeing's may be cut.
                let least = match name {
                    "k.rsa" | "k.rua" => 2,
                    // The last number of a text is one while one of its digits is left.
                    "k.mtx" | "k_array.mtx" => {
                        content.trim_ascii_end().rsplit(|byte| *byte == b'\n').next().map_or(0, |line| line.len() + 1)
                    }
                    _ => 16,
                };
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
        assert!(last_read.is_none_or(|end| may_be_cut || end + 32 > content.len()), "{name}: {last_read:?}");
    }
    assert!(placeless.is_empty(), "{placeless:#?}");
}

/// A checksum tells damage from another matrix: what is read of a packed file is the sound matrix, or nothing.
#[test]
fn packed_files_with_a_changed_bit_hold_no_other_matrix() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["sparse_deflated.mat", "k_csr.npz", "m_csc.npz"] {
        let content = std::fs::read(fixture(name)).expect("a fixture");
        let sound = stiffness(&written(folder.path(), name, &content)).expect("a matrix");
        for (at, bit) in (0..content.len()).flat_map(|at| (0..8).map(move |bit| (at, bit))) {
            let mut changed = content.clone();
            changed[at] ^= 1 << bit;
            match stiffness(&written(folder.path(), name, &changed)) {
                Ok(found) => assert_eq!(found, sound, "{name}: bit {bit} of byte {at}"),
                Err(error) => {
                    assert_eq!(error.class(), ErrorClass::InputData, "{name}: bit {bit} of byte {at}: {error}");
                }
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
        let mut content = content(name);
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
