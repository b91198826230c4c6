//! Files of known formats that are not read, told by how they begin, and the way round each.

use std::io::Read;
use std::path::Path;

use super::regular;
use crate::error::{Error, Result};

/// Bytes looked at.
const HEAD: u64 = 1 << 12;
/// What is read in place of a format of matrices, of a mesh, or of both.
const MATRIX: &str = "a matrix in Matrix Market, HDF5 or lines `row column value`";
const MESH: &str = "nodes as a table, or a mesh as XDMF, MED or HDF5";
const DECK: &str = "matrices, a dof map and nodes";

/// A format that is not read.
struct Foreign {
    /// Whether a file begins as one of it does.
    begins: fn(&[u8]) -> bool,
    found: &'static str,
    expected: &'static str,
    advice: &'static str,
}

/// The formats, the more particular first.
const FORMATS: [Foreign; 8] = [
    Foreign {
        begins: |head| head.starts_with(b"PK") && holds(head, b".npy"),
        found: "a NumPy archive (.npz)",
        expected: MATRIX,
        advice: "write it by scipy.io.mmwrite(\"K.mtx\", scipy.sparse.load_npz(\"K.npz\"), precision=17)",
    },
    Foreign {
        begins: |head| head.starts_with(b"PK"),
        found: "a zip archive",
        expected: "the file itself or a gzipped one",
        advice: "unpack it",
    },
    Foreign {
        begins: |head| head.starts_with(b"\x93NUMPY"),
        found: "a NumPy array (.npy)",
        expected: MATRIX,
        advice: "write it by scipy.io.mmwrite(\"K.mtx\", scipy.sparse.csc_matrix(numpy.load(\"K.npy\")), precision=17)",
    },
    Foreign {
        begins: |head| head.starts_with(b"MATLAB 5.0"),
        found: "a MATLAB file of version 7 or older (.mat)",
        expected: "a MATLAB file of version 7.3, which is HDF5",
        advice: "save it with -v7.3, as in save('K.mat', 'K', '-v7.3')",
    },
    Foreign {
        begins: |head| first_line(head).starts_with(b"$MeshFormat"),
        found: "a Gmsh mesh (.msh)",
        expected: MESH,
        advice: "convert it by `meshio convert mesh.msh mesh.xdmf`",
    },
    Foreign {
        begins: |head| head.starts_with(b"    1C"),
        found: "a CalculiX result file (.frd)",
        expected: MESH,
        advice: "take the nodes of the deck, by `meshio convert deck.inp mesh.xdmf`",
    },
    Foreign {
        begins: begins_as_deck,
        found: "an input deck of Abaqus or CalculiX (.inp)",
        expected: DECK,
        advice: "have the program write its matrices (CalculiX: *FREQUENCY, SOLVER=MATRIXSTORAGE; Abaqus: *MATRIX GENERATE) \
                 and take the nodes by `meshio convert deck.inp mesh.xdmf`",
    },
    Foreign {
        begins: begins_as_bulk,
        found: "a Nastran deck (.bdf)",
        expected: DECK,
        advice: "have the program write its matrices (DMIG or OP4, read by pyNastran and written by scipy.io.mmwrite) and take \
                 the nodes by `meshio convert deck.bdf mesh.xdmf`",
    },
];

/// Refuses a file of a known format that is not read, by name.
///
/// # Errors
/// [`Error::FormatNotRead`]; those of opening the file.
pub(super) fn refuse(path: &Path) -> Result<()> {
    let mut head = Vec::new();
    let read = regular::open(path)?.take(HEAD).read_to_end(&mut head);
    read.map_err(|source| Error::Read { path: path.to_owned(), source })?;
    match FORMATS.iter().find(|format| (format.begins)(&head)) {
        Some(Foreign { found, expected, advice, .. }) => {
            Err(Error::FormatNotRead { path: path.to_owned(), found, expected, advice })
        }
        None => Ok(()),
    }
}

fn holds(head: &[u8], word: &[u8]) -> bool {
    head.windows(word.len()).any(|window| window == word)
}

/// The lines of a text with neither space nor line end around them.
fn lines(head: &[u8]) -> impl Iterator<Item = &[u8]> {
    head.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty())
}

fn first_line(head: &[u8]) -> &[u8] {
    lines(head).next().unwrap_or_default()
}

/// A keyword after one asterisk, below comments of two: no matrix, map or table begins so.
fn begins_as_deck(head: &[u8]) -> bool {
    let line = lines(head).find(|line| !line.starts_with(b"**"));
    line.is_some_and(|line| line.len() > 1 && line[0] == b'*' && line[1].is_ascii_alphabetic())
}

/// A section of a Nastran deck or its first card, below comments of a dollar.
fn begins_as_bulk(head: &[u8]) -> bool {
    const SECTIONS: [&[u8]; 3] = [b"SOL ", b"CEND", b"BEGIN BULK"];
    let line = lines(head).find(|line| !line.starts_with(b"$")).unwrap_or_default().to_ascii_uppercase();
    SECTIONS.iter().any(|word| line.starts_with(word)) || line.strip_prefix(b"GRID").is_some_and(is_rest_of_card)
}

/// What follows the name of a card that has a number first; a column of a table may have the name of a card.
fn is_rest_of_card(rest: &[u8]) -> bool {
    let field = rest.strip_prefix(b"*").unwrap_or(rest);
    let field = field.strip_prefix(b",").unwrap_or(field).trim_ascii_start();
    field.first().is_some_and(u8::is_ascii_digit)
}
