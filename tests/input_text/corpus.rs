//! Real models. Skipped, with a message, where the corpus is absent.

use std::path::{Path, PathBuf};

use supel::error::{Error, Result};
use supel::input::{Input, InputNote, read};
use supel::sparse::Given;
use supel_testing::corpus::corpus;

use crate::job;

/// Plane elements, shells and beams that CalculiX expands into solids: rows carry the label of one node several times,
/// or of nodes that it made.
const EXPANDED: [&str; 6] = [
    "ccx_boxprofile",
    "ccx_dloadlinIf",
    "ccx_shellf",
    "ccx_simplebeampipe3",
    "nafems_FV12_free_thin_plate_S8R",
    "nafems_FV32_tapered_membrane_CPS8",
];

/// The first of these names that exists in a folder.
fn pick(folder: &Path, names: &[&str]) -> Option<PathBuf> {
    names.iter().map(|name| folder.join(name)).find(|path| path.is_file())
}

fn read_pair(folder: &Path) -> Option<Result<Input>> {
    let stiffness = pick(folder, &["K.mtx.gz", "K.mtx"])?;
    let mass = pick(folder, &["M.mtx.gz", "M.mtx"])?;
    let mut model = job(&stiffness, &mass);
    model.dofs = pick(folder, &["model.dof", "model.dof.gz", "dof.csv"]);
    model.nodes = pick(folder, &["nodes.csv", "nodes.csv.gz"]);
    Some(read(&model))
}

#[test]
fn pairs_are_read_or_refused_for_the_true_reason() {
    let Some(pairs) = corpus() else { return };
    let mut n_read = 0;
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(&pairs).expect("a folder").map(|e| e.expect("an entry").path()).collect();
    folders.sort();
    for folder in folders {
        let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
        let Some(outcome) = read_pair(&folder) else { continue };
        match outcome {
            Ok(input) => {
                n_read += 1;
                assert!(!EXPANDED.contains(&name.as_str()), "{name} is expected to be refused");
                let (k, m) = (&input.stiffness, &input.mass);
                println!(
                    "{name}: n {} nnz {} digits {} {}",
                    k.matrix.rows(),
                    k.matrix.nnz(),
                    k.digits.significant,
                    m.digits.significant
                );
                input.notes.iter().for_each(|note| println!("    {note}"));
            }
            Err(error) => {
                println!("{name}: {error}");
                let is_true = matches!(error, Error::DofRepeated { .. } | Error::DofNodeMissing { .. });
                assert!(is_true && EXPANDED.contains(&name.as_str()), "{name}: {error}");
            }
        }
    }
    assert!(n_read >= 30, "{n_read} pairs");
}

#[test]
fn calculix_values_carry_fourteen_digits() {
    let Some(pairs) = corpus() else { return };
    for name in ["ccx_beamf", "ccx_exudyn_conrod", "ccx_alum_cyl"] {
        let input = read_pair(&pairs.join(name)).expect("a pair").expect("a model");
        assert_eq!((input.stiffness.digits.significant, input.mass.digits.significant), (14, 14), "{name}");
    }
    let input = read_pair(&pairs.join("ansys_full_beam963")).expect("a pair").expect("a model");
    assert_eq!(input.stiffness.digits.significant, 17);
    assert!(input.notes.iter().any(|note| matches!(note, InputNote::DirectionsFromZero { .. })));
}

#[test]
fn abaqus_triplets_have_both_triangles_and_no_header() {
    let Some(pairs) = corpus() else { return };
    for name in ["blockC3D20", "blockC3D4", "blockC3D8"] {
        let folder = pairs.join(format!("exudyn_abaqus_{name}"));
        let stiffness = folder.join(format!("{name}_STIF1.mtx.gz"));
        let mass = folder.join(format!("{name}_MASS1.mtx.gz"));
        let input = read(&job(&stiffness, &mass)).expect("a model");
        assert_eq!(input.stiffness.notes.given, Given::Whole, "{name}");
        assert!(input.notes.iter().any(|note| matches!(note, InputNote::OrderFromIndices { .. })), "{name}");
    }
}

#[test]
fn a_size_line_without_a_banner() {
    let Some(pairs) = corpus() else { return };
    let folder = pairs.join("hb_bcsst01");
    let bare = read(&job(&folder.join("bcsstk01.mtx"), &folder.join("bcsstm01.mtx"))).expect("a model");
    let full = read(&job(&folder.join("bcsstk01_K.mtx"), &folder.join("bcsstm01.mtx"))).expect("a model");
    assert_eq!((bare.stiffness.notes.given, full.stiffness.notes.given), (Given::OneTriangle, Given::Whole));
    assert_eq!(bare.stiffness.matrix.indices(), full.stiffness.matrix.indices());
    assert_eq!(bare.stiffness.matrix.shape(), (48, 48));
}

#[test]
fn rectangular_matrices_are_refused() {
    let Some(pairs) = corpus() else { return };
    let rectangular = pairs.join("nastran_h5_dc3_SOL103_structure_only/GM.mtx.gz");
    let error = read(&job(&rectangular, &rectangular)).expect_err("an error");
    assert!(matches!(error, Error::MatrixNotSquare { rows: 1170, cols: 498, .. }), "{error}");
    let dense = pairs.join("hb_bcsst11/bcsst11eig.mtx.gz");
    let error = read(&job(&dense, &dense)).expect_err("an error");
    assert!(matches!(error, Error::MatrixNotSquare { cols: 1, .. }), "{error}");
}
