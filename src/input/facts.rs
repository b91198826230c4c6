//! What is remembered of the input after its matrices have gone into the model.

use std::collections::BTreeMap;

use super::{Digits, FurtherMatrix, Input, InputNote, LoadColumn, MatrixInput, ModeColumns, PatchFaces, QuantityRows};
use crate::error::Warning;
use crate::job::{Layout, LoadJob};
use crate::sparse::{Triangle, Turning};

/// What is remembered of the input after its matrices have gone into the model.
#[derive(Clone, Debug)]
pub struct InputFacts {
    /// Digits and digest of K and M.
    pub matrices: [MatrixFacts; 2],
    /// Digests of the other files by their role: `dofs`, `dofs_data` for what CalculiX wrote next to the map, `nodes`, `nodes_data` for what those refer to, `constraints`, `internal_forces`, `quantities` and
    /// `quantity_names`.
    pub files: BTreeMap<&'static str, String>,
    /// Digests of the files of loads by the name of the load.
    pub loads: BTreeMap<String, String>,
    /// Digests of the files of further matrices by the name of the matrix.
    pub further: BTreeMap<String, String>,
    /// Digest of the file of the modes, where the job names one.
    pub modes: Option<String>,
    /// Remarks of the readers that are not warnings.
    pub notes: Vec<String>,
    /// Faces of the patches, as far as the mesh tells.
    pub faces: Vec<PatchFaces>,
    /// Remarks that are warnings.
    pub warnings: Vec<Warning>,
    /// Rows of the files that were along axes of their own, where some were.
    pub turning: Option<Turning>,
}

/// What is remembered of one matrix.
#[derive(Clone, Debug)]
pub struct MatrixFacts {
    /// Stored entries, both triangles.
    pub n_nonzeros: usize,
    /// How many digits or decimals its entries carry.
    pub digits: Digits,
    /// The format of its file; none where it is from no file.
    pub layout: Option<Layout>,
    /// The only triangle that the file has; none where it has entries in both.
    pub triangle: Option<Triangle>,
    /// BLAKE3 of the file.
    pub digest: String,
}

impl InputFacts {
    /// Records the facts of an input.
    pub fn of(input: &Input) -> Self {
        let facts = |matrix: &MatrixInput| MatrixFacts {
            n_nonzeros: matrix.matrix.nnz(),
            digits: matrix.digits,
            layout: matrix.layout,
            triangle: matrix.notes.triangle,
            digest: matrix.digest.clone(),
        };
        Self {
            matrices: [facts(&input.stiffness), facts(&input.mass)],
            files: input.digests.clone(),
            loads: BTreeMap::new(),
            further: BTreeMap::new(),
            modes: None,
            faces: Vec::new(),
            notes: input.notes.iter().filter(|note| note.warning_code().is_none()).map(ToString::to_string).collect(),
            warnings: input.notes.iter().filter_map(warning).collect(),
            turning: input.turning.clone(),
        }
    }

    /// These facts with one remark more.
    #[must_use]
    pub fn remarking(&self, remark: String) -> Self {
        let mut facts = self.clone();
        facts.notes.push(remark);
        facts
    }

    /// These facts with the digests of the files of quantities, where there are some.
    #[must_use]
    pub fn with_quantities(mut self, rows: Option<&QuantityRows>) -> Self {
        let digests = rows.into_iter().flat_map(|rows| ["quantities", "quantity_names"].into_iter().zip(&rows.digests));
        self.files.extend(digests.map(|(role, digest)| (role, digest.clone())));
        self
    }

    /// These facts with the digests of the files of loads.
    #[must_use]
    pub fn with_loads(mut self, jobs: &[LoadJob], columns: &[Option<LoadColumn>]) -> Self {
        let digests = jobs.iter().zip(columns).filter_map(|(job, column)| Some((job, column.as_ref()?)));
        self.loads = digests.map(|(job, column)| (job.name.clone(), column.digest.clone())).collect();
        self
    }

    /// These facts with the digests of the files of further matrices, and what reading them needed.
    #[must_use]
    pub fn with_matrices(mut self, matrices: &[FurtherMatrix]) -> Self {
        self.further = matrices.iter().map(|matrix| (matrix.name.clone(), matrix.input.digest.clone())).collect();
        let repeated = matrices.iter().map(|matrix| &matrix.input).filter(|input| input.notes.n_duplicates > 0);
        let note =
            |input: &MatrixInput| InputNote::Duplicates { path: input.path.clone(), count: input.notes.n_duplicates };
        self.notes.extend(repeated.map(note).map(|note| note.to_string()));
        self
    }

    /// These facts with the digest of the file of the modes.
    #[must_use]
    pub fn with_modes(self, modes: Option<&ModeColumns>) -> Self {
        Self { modes: modes.map(|modes| modes.digest.clone()), ..self }
    }

    /// What is remembered of M; none where its file was not opened.
    pub fn mass(&self) -> Option<&MatrixFacts> {
        Some(&self.matrices[1]).filter(|mass| !mass.digest.is_empty())
    }

    /// BLAKE3 of every file by its role, as the superelement keeps them.
    pub fn digests(&self) -> BTreeMap<String, &str> {
        let mass = self.mass().map(|mass| ("mass", mass.digest.as_str()));
        let matrices = std::iter::once(("stiffness", self.matrices[0].digest.as_str())).chain(mass);
        let files = self.files.iter().map(|(role, digest)| (*role, digest.as_str()));
        let modes = self.modes.iter().map(|digest| ("modes", digest.as_str()));
        let files = files.chain(modes);
        let loads = self.loads.iter().map(|(name, digest)| (format!("load {name}"), digest.as_str()));
        let further = self.further.iter().map(|(name, digest)| (format!("matrix {name}"), digest.as_str()));
        let named = loads.chain(further);
        matrices.chain(files).map(|(role, digest)| (role.to_owned(), digest)).chain(named).collect()
    }
}

fn warning(note: &InputNote) -> Option<Warning> {
    note.warning_code().map(|code| Warning { code, message: note.to_string() })
}
