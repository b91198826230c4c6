//! Small files of every format, cut at every byte and with every byte changed: an answer or an error that names the file, never a panic.

use std::path::Path;

use supel::error::Error;

use super::{Folder, fixture, read};

/// A small file of each format.
const FILES: [&str; 13] = [
    "mesh/box22.msh",
    "mesh/box22b.msh",
    "mesh/box41.msh",
    "mesh/box41b.msh",
    "calculix/block.inp",
    "calculix/plate.frd",
    "calculix/plate.inp",
    "mesh/box.vtk",
    "mesh/box-text.vtk",
    "mesh/box.vtu",
    "mesh/box-raw.vtu",
    "mesh/box-text.vtu",
    "mesh/box42.vtk",
];

/// Whether an error says which file it is about.
fn names(error: &Error, path: &Path) -> bool {
    error.to_string().contains(&path.display().to_string())
}

#[test]
fn a_file_cut_anywhere_is_read_or_refused() {
    let folder = Folder::new();
    for file in FILES {
        let whole = std::fs::read(fixture(file)).expect("a fixture");
        let mut n_refused = 0;
        for length in 0..whole.len() {
            let path = folder.write("cut", &whole[..length]);
            if let Err(error) = read(&path) {
                assert!(names(&error, &path), "{file} at {length}: {error}");
                n_refused += 1;
            }
        }
        assert!(n_refused > 16, "{file}: {n_refused}");
    }
}

/// Bytes from one that is changed to the next: every field of text and every number of four bytes and more is hit.
const STRIDE: usize = 3;

/// Every third byte by turns becomes another digit, a minus sign, zero, the largest byte, the end of a line, or a comma.
#[test]
fn a_byte_that_changed_is_read_or_refused() {
    let folder = Folder::new();
    for file in FILES {
        let mut bytes = std::fs::read(fixture(file)).expect("a fixture");
        for at in (0..bytes.len()).step_by(STRIDE) {
            let before = bytes[at];
            bytes[at] = [b'9', b'-', 0, 0xff, b'\n', b','][at / STRIDE % 6];
            let path = folder.write("changed", &bytes);
            if let Err(error) = read(&path) {
                assert!(names(&error, &path), "{file} at {at}: {error}");
            }
            bytes[at] = before;
        }
    }
}

/// XML whose data are in a file next to it, cut at every byte.
#[cfg(feature = "hdf5")]
#[test]
fn a_description_cut_anywhere_is_read_or_refused() {
    let folder = Folder::new();
    for data in ["hdf5/mesh.h5", "mesh/box.h5"] {
        folder.write(data.rsplit('/').next().expect("a name"), std::fs::read(fixture(data)).expect("a fixture"));
    }
    for file in ["hdf5/mesh.xdmf", "hdf5/flat.xdmf", "mesh/box.xdmf"] {
        let whole = std::fs::read(fixture(file)).expect("a fixture");
        // What closes the document is blank at its end.
        for length in 0..whole.trim_ascii_end().len() {
            let path = folder.write("cut.xdmf", &whole[..length]);
            let error = read(&path).expect_err(file);
            assert!(names(&error, &path), "{file} at {length}: {error}");
        }
    }
}
