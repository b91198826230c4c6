//! What the targets call: a file of any content, read as a matrix, a dof map, nodes, a mesh, modes, frequencies, a superelement, a job, an
//! assembly or states. A reader gives a value or an error, and takes no more memory than a multiple of the file.
//!
//! The test `fuzz_regressions` of the program has this file, too: it hands every file of `regressions` to the target of its folder.

use std::cell::RefCell;
use std::path::Path;

use supel::cli::AssemblyFile;
use supel::dofs::{Direction, Dof};
use supel::error::Selector;
use supel::input::{
    Allowance, MeshInput, ModeRows, ModeValues, Patch, Patches, SingleMatrix, StateTable, ValueSource, ValueUnit,
    foreign_modes, nodes, patch_faces, read, superelement,
};
use supel::job::{Job, Layout, ModelJob};

/// Memory that reading may claim.
const ALLOWANCE: u64 = 1 << 30;
/// A model of three rows for dof maps and nodes.
const MATRIX: &str = "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 1\n2 2 1\n3 3 1\n";

thread_local! {
    static FOLDER: RefCell<tempfile::TempDir> = RefCell::new(tempfile::tempdir().expect("a folder"));
}

/// Writes a file of this content and hands its path to `then`.
fn with_file(content: &[u8], then: impl FnOnce(&Path)) {
    FOLDER.with_borrow(|folder| {
        let path = folder.path().join("content");
        std::fs::write(&path, content).expect("written");
        then(&path);
    });
}

/// Reads a content as a matrix of a format, or of the one that it looks like.
pub fn read_matrix(content: &[u8], layout: Option<Layout>) {
    with_file(content, |path| {
        let matrix = SingleMatrix { file: path.to_owned(), layout, dofs: None };
        match matrix.read(&Allowance::of(Some(ALLOWANCE))) {
            Ok(read) => assert!(read.input.matrix.data().iter().all(|value| value.is_finite())),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    });
}

fn read_model(fill: impl FnOnce(&mut ModelJob)) {
    FOLDER.with_borrow(|folder| {
        let matrix = folder.path().join("matrix.mtx");
        std::fs::write(&matrix, MATRIX).expect("written");
        let mut model = ModelJob { stiffness: matrix.clone(), mass: Some(matrix), ..ModelJob::default() };
        fill(&mut model);
        if let Err(error) = read(&model) {
            assert!(!error.to_string().is_empty());
        }
    });
}

/// Reads a content as the dof map of a model of three rows.
pub fn read_dof_map(content: &[u8]) {
    with_file(content, |path| read_model(|model| model.dofs = Some(path.to_owned())));
}

/// Reads a content as a table of nodes.
pub fn read_nodes(content: &[u8]) {
    with_file(content, |path| read_model(|model| model.nodes = Some(path.to_owned())));
}

/// Reads a content as modes of a model of two nodes, in whatever format it is.
pub fn read_modes(content: &[u8]) {
    let of_node = |node| [Direction::Ux, Direction::Uy, Direction::Uz].map(|direction| Some(Dof { node, direction }));
    let left: Vec<_> = [1, 2].into_iter().flat_map(of_node).enumerate().collect();
    with_file(content, |path| {
        let rows = ModeRows { n: left.len(), left, turning: None };
        match foreign_modes(path, &rows, &Allowance::of(Some(ALLOWANCE))) {
            Ok(read) => assert!(read.columns.iter().all(|column| column.iter().all(|value| value.is_finite()))),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    });
}

/// Reads a content as a superelement.
pub fn read_superelement(content: &[u8]) {
    with_file(content, |path| {
        if let Err(error) = superelement(path) {
            assert!(!error.to_string().is_empty());
        }
    });
}

/// Reads a content as a job, in text or as the document that a program writes.
pub fn read_job(content: &[u8]) {
    with_file(content, |path| {
        if let Err(error) = Job::read(path).and_then(|job| job.validate()) {
            assert!(!error.to_string().is_empty());
        }
    });
}

/// Reads a content as the document of an assembly.
pub fn read_assembly(content: &[u8]) {
    with_file(content, |path| match AssemblyFile::read(path) {
        Ok(assembly) => assert!(assembly.jobs.iter().all(|(name, job)| !name.is_empty() && job.is_absolute())),
        Err(error) => assert!(!error.to_string().is_empty()),
    });
}

/// Reads a content as states of a superelement of three coordinates.
pub fn read_states(content: &[u8]) {
    let names = ["a ux", "b uy", "mode 1"].map(str::to_owned);
    with_file(content, |path| {
        let Ok(mut table) = StateTable::open(path, &names) else { return };
        let mut values = [0.0; 3];
        while let Ok(Some(_)) = table.advance(&mut values) {
            assert!(values.iter().all(|value| value.is_finite()));
        }
    });
}

/// Reads a content as the frequencies of two modes.
pub fn read_values(content: &[u8]) {
    with_file(content, |path| {
        let source = ValueSource::File(path.to_owned());
        match ModeValues::read(ValueUnit::Hertz, &source, 2, &Allowance::of(Some(ALLOWANCE))) {
            Ok(values) => assert_eq!(values.numbers.len(), 2),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    });
}

/// Reads a content as what CalculiX lists of the nodes that it made of those of shells, `JOB.12d`.
pub fn read_expansion(content: &[u8]) {
    const FILES: [(&str, &[u8]); 5] = [
        ("plate.sti.gz", include_bytes!("../../fixtures/calculix/plate.sti.gz")),
        ("plate.mas.gz", include_bytes!("../../fixtures/calculix/plate.mas.gz")),
        ("plate.dof", include_bytes!("../../fixtures/calculix/plate.dof")),
        ("plate.inp", include_bytes!("../../fixtures/calculix/plate.inp")),
        ("plate.frd", include_bytes!("../../fixtures/calculix/plate.frd")),
    ];
    FOLDER.with_borrow(|folder| {
        let at = |name: &str| folder.path().join(name);
        for (name, bytes) in FILES.iter().filter(|(name, _)| !at(name).exists()) {
            std::fs::write(at(name), bytes).expect("written");
        }
        std::fs::write(at("plate.12d"), content).expect("written");
        let (dofs, nodes) = (Some(at("plate.dof")), Some(at("plate.inp")));
        let (stiffness, mass) = (at("plate.sti.gz"), Some(at("plate.mas.gz")));
        if let Err(error) = read(&ModelJob { stiffness, mass, dofs, nodes, ..ModelJob::default() }) {
            assert!(!error.to_string().is_empty());
        }
    });
}

/// Reads a content as a mesh: its nodes, its groups, and the faces of the first of these.
pub fn read_mesh(content: &[u8]) {
    with_file(content, |path| {
        let allowance = Allowance::of(Some(ALLOWANCE));
        let Ok(read) = nodes(path, &allowance).map_err(|error| assert!(!error.to_string().is_empty())) else { return };
        assert_eq!(read.labels.len(), read.coordinates.len());
        let members = read.groups.values().next().cloned().unwrap_or_else(|| vec![0]);
        let patch = Patch { of: Selector::Interface("patch".to_owned()), nodes: members };
        let patches = Patches { list: vec![patch], coordinates: &read.coordinates };
        let model = ModelJob { nodes: Some(path.to_owned()), ..ModelJob::default() };
        if let Err(error) = patch_faces(&model, &patches, &allowance) {
            assert!(!error.to_string().is_empty());
        }
        if let Ok(mesh) = MeshInput::read(path, &allowance) {
            let n = mesh.nodes.labels.len();
            assert!(mesh.cells.iter().flat_map(|cells| &cells.nodes).all(|node| (*node as usize) < n));
        }
    });
}
