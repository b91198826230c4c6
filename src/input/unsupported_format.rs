//! Files of known formats that are not read: how they are recognised, and how each can be converted.

use super::bulk_start::is_bulk;
use super::file_start::FileStart;
use super::mesh;
use crate::error::{Error, Result};
use crate::regular_file::is_utf16;

/// What a file is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Stiffness or mass.
    Matrix,
    /// Nodes, or the dof of each row.
    Table,
}

impl Wanted {
    fn expected(self) -> &'static str {
        match self {
            Self::Matrix => "a matrix: docs/formats.md lists every format",
            Self::Table => "a table, a dof map, or a mesh: docs/meshes.md lists every format",
        }
    }
}

/// What to do where a mesh was given for a matrix.
const NO_MATRIX: &str = "it holds no assembled matrices: have the program that made the model write them (`supel convert` writes a mesh as \
                         NAME.vtkhdf)";
/// What to do where a deck was given for a matrix.
const FROM_DECK: &str =
    "have the program write its matrices (CalculiX: *FREQUENCY, SOLVER=MATRIXSTORAGE; Abaqus: *MATRIX GENERATE)";
/// What to do where numbers of Python were given for a table.
const AS_TABLE: &str = "write the numbers as a table with the header node,x,y,z, or as node.direction for each row";

/// What to do where a mesh was given for a dof map.
const AS_NODES: &str =
    "it has nodes and no rows: give it as model.nodes, and as dof map the one written with the matrices";

/// What to do with text in another encoding.
const AS_UTF8: &str = "write it as UTF-8 (in PowerShell: Get-Content FILE | Set-Content -Encoding utf8 NEW)";

/// What a superelement is called that its reader does not unpack.
pub(super) const PACKED_SUPERELEMENT: &str = "a packed superelement";

/// Whether a file is a superelement, packed.
pub(super) fn is_packed_superelement(start: &FileStart<'_>) -> bool {
    start.packing.is_some() && supel_runtime::begins_as_superelement(&start.head)
}

/// A format that is not read.
struct Foreign {
    /// Whether a file begins as one of it does.
    begins: fn(&FileStart<'_>) -> bool,
    found: &'static str,
    for_matrix: &'static str,
    for_table: &'static str,
}

/// The formats, the more particular first.
const FORMATS: [Foreign; 17] = [
    Foreign { begins: |start| is_utf16(&start.head), found: "text in UTF-16", for_matrix: AS_UTF8, for_table: AS_UTF8 },
    Foreign {
        begins: |start| start.packing.is_some() && start.head.starts_with(b"PK"),
        found: "a packed archive (.npz or .zip)",
        for_matrix: "unpack it",
        for_table: "unpack it",
    },
    Foreign {
        begins: |start| start.head.starts_with(b"PK") && start.holds(b".npy"),
        found: "a NumPy archive (.npz)",
        for_matrix: AS_TABLE,
        for_table: AS_TABLE,
    },
    Foreign {
        begins: |start| start.head.starts_with(b"PK"),
        found: "a zip archive",
        for_matrix: "unpack it",
        for_table: "unpack it",
    },
    Foreign {
        begins: |start| start.packing.is_some() && start.begins_as_hdf5(),
        found: "a packed HDF5 file",
        for_matrix: "unpack it",
        for_table: "unpack it",
    },
    Foreign {
        begins: is_packed_superelement,
        found: PACKED_SUPERELEMENT,
        for_matrix: "unpack it",
        for_table: "unpack it",
    },
    Foreign {
        begins: |start| start.head.starts_with(b"\x93NUMPY"),
        found: "a NumPy array (.npy)",
        for_matrix: AS_TABLE,
        for_table: AS_TABLE,
    },
    Foreign {
        begins: |start| start.head.starts_with(b"MATLAB 5.0"),
        found: "a MATLAB file of version 7 or older (.mat)",
        for_matrix: AS_TABLE,
        for_table: AS_TABLE,
    },
    Foreign {
        begins: begins_as_output2,
        found: "a file of Nastran's OUTPUT2 (.op2)",
        for_matrix: "write its matrices as OUTPUT4 with pyYeti: docs/formats.md has the lines, under OUTPUT2 of Nastran",
        for_table: "write its rows as a dof map with pyYeti: docs/formats.md has the lines, under OUTPUT2 of Nastran",
    },
    Foreign {
        begins: |start| start.head.starts_with(ANSYS_HEAD),
        found: "a binary file of Ansys (.full, .emat, .rst)",
        for_matrix: "write its matrices by HBMAT of /AUX2: `supel recipe ansys` has the lines",
        for_table: "give the mapping that HBMAT writes next to a matrix as dof map, and the nodes as a table: `supel recipe ansys` has the lines",
    },
    Foreign {
        begins: begins_as_matlab4,
        found: "a MATLAB file of level 4 (.mat)",
        for_matrix: "save it again by `save -v7` of MATLAB, `save -v6` of Octave or `scipy.io.savemat`",
        for_table: AS_TABLE,
    },
    Foreign { begins: mesh::begins_as_gmsh, found: "a Gmsh mesh (.msh)", for_matrix: NO_MATRIX, for_table: AS_NODES },
    Foreign {
        begins: |start| start.head.starts_with(b"    1C"),
        found: "a CalculiX result file (.frd)",
        for_matrix: NO_MATRIX,
        for_table: AS_NODES,
    },
    Foreign {
        begins: begins_as_deck,
        found: "an input deck of Abaqus or CalculiX (.inp)",
        for_matrix: FROM_DECK,
        for_table: AS_NODES,
    },
    Foreign {
        begins: |start| start.head.starts_with(b"@(#)ADF") || start.holds(b"ADF Database Version"),
        found: "a CGNS file in ADF",
        for_matrix: NO_MATRIX,
        for_table: "convert it by `adf2hdf`",
    },
    Foreign {
        begins: begins_as_fluent,
        found: "a mesh of Fluent (.msh)",
        for_matrix: NO_MATRIX,
        for_table: "write it as VTK or in the format of Gmsh",
    },
    Foreign {
        begins: is_bulk,
        found: "a Nastran deck (.bdf)",
        for_matrix: "have the program write its matrices (DMIG or OP4)",
        for_table: "give it as the nodes or as the dof map, which are read from GRID entries",
    },
];

/// Refuses a file of a known format that is not read, by name.
///
/// # Errors
/// [`Error::FormatNotRead`].
pub(super) fn refuse(start: &FileStart<'_>, wanted: Wanted) -> Result<()> {
    match FORMATS.iter().find(|format| (format.begins)(start)) {
        Some(Foreign { found, for_matrix, for_table, .. }) => {
            let advice = if wanted == Wanted::Matrix { for_matrix } else { for_table };
            Err(Error::FormatNotRead { path: start.path.to_owned(), found, expected: wanted.expected(), advice })
        }
        None => Ok(()),
    }
}

/// Sections in brackets, each of which begins with its number: a comment is 0, the header 1, the dimensions 2.
fn begins_as_fluent(start: &FileStart<'_>) -> bool {
    let head = start.head.trim_ascii_start();
    head.first() == Some(&b'(') && matches!(head.get(1..3), Some([b'0'..=b'2', b' ']))
}

/// How binary files of Ansys begin: a record of a hundred words, whose mark says that they are whole numbers.
const ANSYS_HEAD: &[u8] = &[100, 0, 0, 0, 0, 0, 0, 0x80];

/// Records of Fortran, the first of which is one word: how many words the next one has, which is the date or the name of a table.
fn begins_as_output2(start: &FileStart<'_>) -> bool {
    [
        (4, u32::from_le_bytes as fn([u8; 4]) -> u32),
        (4, u32::from_be_bytes),
        (8, u32::from_le_bytes),
        (8, u32::from_be_bytes),
    ]
    .into_iter()
    .any(|(word, of_bytes)| {
        let number = |at: usize| start.head.get(at..).and_then(|rest| rest.first_chunk()).map(|bytes| of_bytes(*bytes));
        // The upper half of a word of eight bytes is zero.
        let low = if of_bytes([1, 0, 0, 0]) == 1 { 4 } else { word };
        let n_words = number(low).filter(|n_words| (1..=64).contains(n_words));
        let marks = [0, 4 + word, 8 + word].map(number);
        n_words.is_some_and(|n_words| marks == [Some(word as u32), Some(word as u32), Some(n_words * word as u32)])
    })
}

/// Five numbers of four bytes, the kind of the array, its rows, its columns, whether it is complex and the length of its name, and that name
/// with a zero at its end.
fn begins_as_matlab4(start: &FileStart<'_>) -> bool {
    let number = |at: usize, of_bytes: fn([u8; 4]) -> u32| {
        start.head.get(4 * at..).and_then(|rest| rest.first_chunk()).map_or(u32::MAX, |bytes| of_bytes(*bytes))
    };
    // The first digit tells the order of bytes, the third the type of the numbers, the last whether they are a matrix, text or sparse.
    [(0, u32::from_le_bytes as fn([u8; 4]) -> u32), (1, u32::from_be_bytes)].into_iter().any(|(order, of_bytes)| {
        let [kind, rows, columns, complex, length] = [0, 1, 2, 3, 4].map(|at| number(at, of_bytes));
        let is_kind = kind / 1000 == order && kind / 100 % 10 == 0 && kind / 10 % 10 <= 5 && kind % 10 <= 2;
        let name = start.head.get(20..20 + length.min(64) as usize).unwrap_or_default();
        let is_name = matches!(name, [first, .., 0] if first.is_ascii_alphabetic());
        is_kind && rows.max(columns) <= i32::MAX as u32 && complex <= 1 && is_name
    })
}

/// A keyword after one asterisk, below comments of two: no matrix, map or table begins so.
fn begins_as_deck(start: &FileStart<'_>) -> bool {
    let line = start.lines().find(|line| !line.starts_with(b"**"));
    line.is_some_and(|line| line.len() > 1 && line[0] == b'*' && line[1].is_ascii_alphabetic())
}
