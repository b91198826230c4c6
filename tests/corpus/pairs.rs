//! Every pair of the corpus and what must come of it.

use supel::error::Error;

/// Where rigid-body modes come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The dof map and the nodes that lie next to the matrices.
    Coordinates,
    /// The matrices alone.
    Matrices,
}

/// What is read from a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rows {
    /// The matrices as they are stored.
    All,
    /// Without the rows that `constrained_rows.txt` lists.
    Unconstrained,
}

/// Whether every run of the tests can afford a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Size {
    /// Seconds.
    Small,
    /// More than 20 000 dofs: run where the variable `SUPEL_CORPUS_LARGE` is set.
    Large,
}

/// Why a pair is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reason {
    /// Rows empty in K and M: a singular pencil.
    EmptyRows,
    /// K is not symmetric.
    Unsymmetric,
}

impl Reason {
    /// The reason an error gives, if it is one that a pair may be refused for.
    pub(crate) fn of(error: &Error) -> Option<Self> {
        match error {
            Error::EmptyRows { .. } => Some(Self::EmptyRows),
            Error::Unsymmetric { .. } => Some(Self::Unsymmetric),
            _ => None,
        }
    }
}

/// What must come of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Expected {
    /// Rigid-body modes and elastic eigenvalues agree with the reference.
    Agrees,
    /// An error gives this reason.
    Refused(Reason),
}

/// One pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub(crate) name: &'static str,
    pub(crate) folder: &'static str,
    pub(crate) files: [&'static str; 2],
    pub(crate) reference: &'static str,
    pub(crate) rows: Rows,
    pub(crate) source: Source,
    /// Elastic modes compared at most: all of the reference, fewer where a test would take minutes.
    pub(crate) at_most: usize,
    /// Relative error of the reference where it is known to be worse than its method promises. Found eigenvalues must
    /// then be enclosed by Sturm counts as narrowly as the reference should have been.
    pub(crate) reference_error: f64,
    /// Large pairs take minutes and are asked for by name.
    pub(crate) size: Size,
    pub(crate) expected: Expected,
}

impl Pair {
    const fn agrees(folder: &'static str, source: Source) -> Self {
        Self {
            name: folder,
            folder,
            files: ["K.mtx", "M.mtx"],
            reference: "ref.json",
            rows: Rows::All,
            source,
            at_most: usize::MAX,
            reference_error: 0.0,
            size: Size::Small,
            expected: Expected::Agrees,
        }
    }

    const fn refused(folder: &'static str, source: Source, reason: Reason) -> Self {
        Self { expected: Expected::Refused(reason), ..Self::agrees(folder, source) }
    }

    const fn from(self, files: [&'static str; 2]) -> Self {
        Self { files, ..self }
    }

    const fn large(self, at_most: usize) -> Self {
        Self { at_most, size: Size::Large, ..self }
    }

    const fn against_poor_reference(self, reference_error: f64) -> Self {
        Self { reference_error, ..self }
    }
}

use Source::{Coordinates, Matrices};

/// Pairs without nodes, and plane elements, shells and beams that CalculiX expands into solids, whose rows carry the label
/// of one node several times, go by the matrices alone.
pub(crate) const PAIRS: [Pair; 46] = [
    Pair::refused("ansys_full_beam963", Coordinates, Reason::EmptyRows),
    Pair {
        name: "ansys_full_beam963_constrained",
        reference: "../ansys_full_beam963_constrained/ref.json",
        rows: Rows::Unconstrained,
        ..Pair::agrees("ansys_full_beam963", Coordinates)
    },
    Pair::agrees("ccx_acou3", Coordinates),
    Pair::agrees("ccx_alum_cyl", Coordinates).large(6),
    Pair::agrees("ccx_beam8f", Coordinates),
    Pair::agrees("ccx_beamf", Coordinates),
    Pair::agrees("ccx_beamf2", Coordinates),
    Pair::agrees("ccx_beamf4", Coordinates),
    Pair::agrees("ccx_beamptied7", Coordinates),
    Pair::agrees("ccx_boxprofile", Matrices),
    Pair::agrees("ccx_dashpot1", Coordinates),
    Pair::agrees("ccx_dloadlin20f", Coordinates),
    Pair::agrees("ccx_dloadlinIf", Matrices),
    // Free, and shifted to a hundredth of the first elastic eigenvalue: solves lose the digits that the rigid-body
    // component takes, and the references miss their tolerance by three orders of magnitude.
    Pair::agrees("ccx_exudyn_conrod", Coordinates).against_poor_reference(1e-8),
    Pair::agrees("ccx_fullseg", Coordinates).against_poor_reference(1e-8),
    Pair::agrees("ccx_mass2", Coordinates),
    Pair::agrees("ccx_onshape_part", Coordinates).large(4),
    Pair::agrees("ccx_rotor3", Coordinates),
    Pair::agrees("ccx_segmentmass", Coordinates),
    Pair::agrees("ccx_segmenttet", Coordinates),
    Pair::agrees("ccx_shellf", Matrices),
    Pair::agrees("ccx_simplebeampipe3", Matrices),
    Pair::agrees("ccx_spring3", Coordinates),
    Pair::agrees("ccx_spring4", Coordinates),
    Pair::agrees("ccx_transition", Coordinates),
    Pair::agrees("evsl_A_B", Matrices).from(["A.mtx", "B.mtx"]),
    Pair::agrees("exudyn_abaqus_blockC3D20", Matrices).from(["blockC3D20_STIF1.mtx", "blockC3D20_MASS1.mtx"]),
    Pair::agrees("exudyn_abaqus_blockC3D4", Matrices).from(["blockC3D4_STIF1.mtx", "blockC3D4_MASS1.mtx"]),
    Pair::agrees("exudyn_abaqus_blockC3D8", Matrices).from(["blockC3D8_STIF1.mtx", "blockC3D8_MASS1.mtx"]),
    Pair::agrees("exudyn_abaqus_rotorDisc", Matrices).from(["rotorDiscTestSTIF1.mtx", "rotorDiscTestMASS1.mtx"]),
    Pair::agrees("hb_bcsst01", Matrices).from(["bcsstk01_K.mtx", "bcsstm01.mtx"]),
    Pair::agrees("hb_bcsst11", Matrices).from(["bcsstk11.mtx", "bcsstm11.mtx"]),
    Pair::agrees("nafems_FV12_free_thin_plate_S8R", Matrices),
    Pair::agrees("nafems_FV32_tapered_membrane_CPS8", Matrices),
    Pair::agrees("nastran_cb_nas2cam_csuper_inboard", Matrices),
    Pair::agrees("nastran_cb_nas2cam_csuper_inboard_mk", Matrices),
    Pair::agrees("nastran_cb_nas2cam_extseout_inboard", Matrices),
    Pair::refused("nastran_h5_dc3_SOL103_structure_only", Matrices, Reason::EmptyRows),
    Pair {
        name: "nastran_h5_dc3_SOL103_structure_only f-set",
        files: ["Kff.mtx", "Mff.mtx"],
        reference: "ref_fset.json",
        ..Pair::agrees("nastran_h5_dc3_SOL103_structure_only", Matrices)
    },
    Pair::agrees("nastran_pch_1", Matrices),
    Pair::agrees("nastran_pch_mAEWing1_FEMv5p1", Matrices),
    Pair::agrees("nlevp_concrete", Matrices),
    Pair::refused("nlevp_piston", Matrices, Reason::Unsymmetric),
    Pair::agrees("nlevp_sandwich_beam_168", Matrices),
    Pair::agrees("oberwolfach_rail_109", Matrices),
    Pair::agrees("oberwolfach_rail_5177", Matrices),
];
