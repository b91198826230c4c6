//! Files of the corpus in their own formats against the Matrix Market files that were made of them by other programs.

use std::path::Path;

use supel::input::{Input, MatrixInput, read};
use supel::job::ModelJob;

use super::job;

fn of(pairs: &Path, name: &str) -> std::path::PathBuf {
    pairs.join(name)
}

/// The largest difference of two matrices of one order, relative to the largest entry.
fn difference(a: &MatrixInput, b: &MatrixInput) -> f64 {
    assert_eq!(a.matrix.rows(), b.matrix.rows());
    let largest = b.matrix.data().iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
    let one_way = |a: &MatrixInput, b: &MatrixInput| {
        let of_entry = |(value, (row, col)): (&f64, (u32, u32))| {
            (value - b.matrix.get(row as usize, col as usize).copied().unwrap_or(0.0)).abs()
        };
        a.matrix.iter().map(of_entry).fold(0.0f64, f64::max)
    };
    one_way(a, b).max(one_way(b, a)) / largest
}

/// What is left open by a text of sixteen digits: half a unit of the last one, of a number that begins with a 1.
const SIXTEEN_DIGITS: f64 = 5e-16;

/// Files, what they are compared with, and the largest difference that the digits of either leave.
const FILES: [([&str; 2], [&str; 2], f64); 9] = [
    (
        ["hb_bcsst01/bcsstk01.rsa", "hb_bcsst01/bcsstm01.mat:Problem.A"],
        ["hb_bcsst01/bcsstk01_K.mtx", "hb_bcsst01/bcsstm01.mtx"],
        0.0,
    ),
    (
        ["hb_bcsst01/bcsstk01.rb", "hb_bcsst01/bcsstm01.mat:Problem.A"],
        ["hb_bcsst01/bcsstk01_K.mtx", "hb_bcsst01/bcsstm01.mtx"],
        0.0,
    ),
    (
        ["nastran_pch_1/test_case.pch1:KAAX", "nastran_pch_1/test_case.pch1:MAAX"],
        ["nastran_pch_1/K.mtx", "nastran_pch_1/M.mtx"],
        0.0,
    ),
    (
        [
            "nastran_pch_mAEWing1_FEMv5p1/sol103_maewing1_femv5p1.pch1.gz",
            "nastran_pch_mAEWing1_FEMv5p1/sol103_maewing1_femv5p1.pch1.gz",
        ],
        ["nastran_pch_mAEWing1_FEMv5p1/K.mtx", "nastran_pch_mAEWing1_FEMv5p1/M.mtx"],
        0.0,
    ),
    (
        ["../nastran_cb/pyyeti/nas2cam_csuper/inboard.op4:KXX", "../nastran_cb/pyyeti/nas2cam_csuper/inboard.op4:MXX"],
        ["nastran_cb_nas2cam_csuper_inboard/K.mtx.gz", "nastran_cb_nas2cam_csuper_inboard/M.mtx.gz"],
        SIXTEEN_DIGITS,
    ),
    (
        ["../nastran_cb/pyNastran/testplate_kgg.op4", "../nastran_cb/pyNastran/testplate_kgg.op4:KGG"],
        [
            "../nastran_cb/pyNastran/testplate_kgg_ascii.op4.gz",
            "../nastran_cb/pyNastran/testplate_kgg_ascii.op4.gz:KGG",
        ],
        // The text has ten digits.
        1e-9,
    ),
    (
        ["nlevp_sandwich_beam_168/sandwich_beam_168.mat:Ke", "nlevp_sandwich_beam_168/sandwich_beam_168.mat:M"],
        ["nlevp_sandwich_beam_168/K.mtx.gz", "nlevp_sandwich_beam_168/M.mtx.gz"],
        SIXTEEN_DIGITS,
    ),
    (
        ["oberwolfach_rail_109/ODE_unit_matrices_109.mat:M", "oberwolfach_rail_109/ODE_unit_matrices_109.mat:M"],
        ["oberwolfach_rail_109/M.mtx.gz", "oberwolfach_rail_109/M.mtx.gz"],
        0.0,
    ),
    (
        ["oberwolfach_rail_5177/ODE_unit_matrices_5177.mat:M", "oberwolfach_rail_5177/ODE_unit_matrices_5177.mat:M"],
        ["oberwolfach_rail_5177/M.mtx.gz", "oberwolfach_rail_5177/M.mtx.gz"],
        0.0,
    ),
];

#[test]
fn files_of_other_programs_are_what_others_read() {
    let Some(pairs) = supel_testing::corpus::corpus() else { return };
    let mut faults = Vec::new();
    for (files, reference, allowed) in FILES {
        let read = |[k, m]: [&str; 2]| read(&job(&of(&pairs, k), &of(&pairs, m)));
        let outcome = read(files).and_then(|input| Ok((input, read(reference)?)));
        match outcome {
            Ok((input, reference)) => {
                let worst =
                    difference(&input.stiffness, &reference.stiffness).max(difference(&input.mass, &reference.mass));
                let n = input.stiffness.matrix.rows();
                println!("{} | {n} | {} | {worst:.1e}", files[0], input.stiffness.matrix.nnz());
                if worst > allowed {
                    faults.push(format!("{}: differs by {worst:e}", files[0]));
                }
            }
            Err(error) => faults.push(format!("{}: {error}", files[0])),
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// EXTRN of the superelement lists the rows of its matrices.
#[test]
fn rows_of_an_external_superelement_come_from_its_punch_file() {
    let Some(pairs) = supel_testing::corpus::corpus() else { return };
    let folder = pairs.join("../nastran_cb/pyyeti/nas2cam_csuper");
    let matrices = folder.join("inboard.op4");
    let model = ModelJob {
        dofs: Some(folder.join("inboard.asm")),
        ..job(&folder.join("inboard.op4:KXX"), &folder.join("inboard.op4:MXX"))
    };
    let input: Input = read(&model).unwrap_or_else(|error| panic!("{}: {error}", matrices.display()));
    let dofs = input.dofs.expect("a map");
    assert_eq!(dofs.len(), 32);
    assert_eq!(
        dofs.iter().flatten().map(|dof| dof.node).collect::<Vec<_>>(),
        [[3; 6], [11; 6], [19; 6], [27; 6]].concat()
    );
    assert_eq!(dofs.iter().filter(|dof| dof.is_none()).count(), 8, "modal amplitudes");
}
