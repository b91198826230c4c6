//! A superelement as a model: K̂, M̂ and further matrices, what each row is, where its interface nodes are, its load vectors.
//!
//! Modal amplitudes are scalar dofs, rows that no node has and no rigid-body motion moves, because Ψ carries rigid-body motion by the
//! interface alone (24). Where rigid-body modes are coordinates next to an interface amplitudes do move, which no dof map can say. K̂ carries
//! the rounding of the stiffness that it was condensed from, see [`super::condensed_digits`].

use std::collections::HashMap;
use std::path::Path;

use supel_runtime::{Coordinate, Flag, Matrix, Superelement, Verdict};

use super::allowance::Allowance;
use super::assembled::Collector;
use super::condensed_digits::digits_of;
use super::digits::Digits;
use super::file_start::FileStart;
use super::format::{
    DofMapFormat, Format, MatrixFormat, MatrixSource, NodeFormat, ReadDofs, ReadMatrix, ReadNodes, Sureness,
};
use super::member::split_member;
use super::named::chosen;
use super::strainless::{Condensed, condensed_stiffness};
use super::unsupported_format::{PACKED_SUPERELEMENT, is_packed_superelement};
use super::{MatrixInput, MatrixRole};
use crate::dofs::{Dof, DofMap, Nodes};
use crate::error::{Error, Result};
use crate::job::{AssumesJob, Layout, ModelJob, unseen_hz};
use crate::number::{counted, quantity};
use crate::regular_file;

/// What supel itself writes.
pub(super) struct SuperelementFile;

impl Format for SuperelementFile {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if begins(start) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

/// Whether a file is a superelement, by its first bytes; one that is packed is one, too, and cannot be read.
///
/// # Errors
/// A file that cannot be opened or read.
pub fn is_superelement(path: &Path) -> Result<bool> {
    let start = FileStart::of(path)?;
    Ok(begins(&start) || is_packed_superelement(&start))
}

/// Refuses a superelement, with its BLAKE3, that is read for `what` and is not the one that the stiffness is read of.
///
/// # Errors
/// [`Error::OtherSuperelement`]; [`Error::Changed`] where the file was written between two readings; a file that cannot be read.
pub(super) fn refuse_other(stiffness: &MatrixInput, what: &'static str, (path, digest): (&Path, &str)) -> Result<()> {
    if digest == stiffness.digest || !is_superelement(&split_member(path).0)? || !is_superelement(&stiffness.path)? {
        return Ok(());
    }
    if split_member(path).0 == stiffness.path {
        return Err(Error::Changed { path: stiffness.path.clone() });
    }
    Err(Error::OtherSuperelement { path: path.to_owned(), what, stiffness: stiffness.path.clone() })
}

/// Whether a file that begins so is a superelement.
pub(super) fn begins(start: &FileStart<'_>) -> bool {
    start.packing.is_none() && supel_runtime::begins_as_superelement(&start.head)
}

impl MatrixFormat for SuperelementFile {
    fn layout(&self) -> Layout {
        Layout::Superelement
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let path = source.file.as_path();
        let (superelement, digest) = opened(path, source.allowance)?;
        let (name, matrix) = wanted(&superelement, source)?;
        if name == MASS
            && superelement.metadata().flags.contains(&Flag::SingularMass)
            && source.role == MatrixRole::Mass
        {
            return Err(no_model(path, "has the singular mass of MacNeal's method", SINGULAR_MASS));
        }
        if matches!((name, source.role), (STIFFNESS, MatrixRole::Mass) | (MASS, MatrixRole::Stiffness)) {
            return Err(no_model(path, "has the other matrix of the two under this name", "exchange the two names"));
        }
        let is_of_model = name == STIFFNESS && source.role == MatrixRole::Stiffness;
        let condensed = is_of_model.then(|| condensed_stiffness(&superelement)).transpose()?;
        if condensed.as_ref().is_some_and(|condensed| has_free_dof(&superelement, condensed)) {
            return Err(no_model(path, NO_STIFFNESS, FREE_DOF));
        }
        let matrix = condensed.as_ref().map_or(matrix, |condensed| &condensed.stiffness);
        let mut input =
            entries(matrix, source)?.into_matrix(source, (matrix.rows() as u32, source.role.undeclared()), digest)?;
        if name == STIFFNESS && source.stated_digits.is_none() {
            input.digits = digits_shown(&superelement, matrix, input.digits)?;
        }
        Ok(ReadMatrix::with_size(input))
    }
}

impl DofMapFormat for SuperelementFile {
    fn read(&self, path: &Path, n: usize, allowance: &Allowance) -> Result<ReadDofs> {
        let (superelement, _) = opened(path, allowance)?;
        if superelement.has_rigid_amplitudes() {
            return Err(no_model(
                path,
                "has modal amplitudes that move with rigid-body motion, which no dof map can say",
                NO_MAP,
            ));
        }
        let mut dofs = labelled(&superelement);
        let n_rows = dofs.len();
        dofs.truncate(n);
        Ok(ReadDofs::new(dofs, n_rows))
    }
}

/// What each row is; modal amplitudes are no dofs of nodes.
fn labelled(superelement: &Superelement) -> DofMap {
    let metadata = superelement.metadata();
    let labels = metadata.interface_labels();
    let dof = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, direction } => Some(Dof { node: labels[*node], direction: *direction }),
        _ => None,
    };
    metadata.coordinates.iter().map(dof).collect()
}

/// What each row of the superelement in a file is; none where it has no nodes or amplitudes that move with rigid-body motion.
///
/// # Errors
/// A superelement that cannot be read or is no model; [`Error::MemoryRead`].
pub(super) fn dof_map(path: &Path, allowance: &Allowance) -> Result<Option<DofMap>> {
    let (superelement, _) = opened(path, allowance)?;
    let has_map = !superelement.has_rigid_amplitudes() && !superelement.metadata().interface_nodes.is_empty();
    Ok(has_map.then(|| labelled(&superelement)))
}

impl NodeFormat for SuperelementFile {
    fn read(&self, path: &Path, allowance: &Allowance) -> Result<ReadNodes> {
        let (superelement, _) = opened(path, allowance)?;
        let metadata = superelement.metadata();
        if metadata.interface_nodes.is_empty() {
            return Err(no_model(path, "has an interface of rows without nodes", NO_MAP));
        }
        let mut nodes = Nodes::default();
        let mut found: HashMap<i64, usize> = HashMap::new();
        for (own, label) in metadata.interface_nodes.iter().zip(metadata.interface_labels()) {
            // A node of two interfaces comes once for each.
            let at = *found.entry(label).or_insert_with(|| {
                nodes.labels.push(label);
                nodes.coordinates.push(own.position);
                nodes.labels.len() - 1
            });
            nodes.groups.entry(own.name.clone()).or_default().push(at);
        }
        Ok(ReadNodes::along_the_axes(nodes, None))
    }
}

/// The load vectors of a superelement, one in each column.
pub(super) struct LoadVectors {
    pub(super) columns: Matrix,
    /// BLAKE3 of the file.
    pub(super) digest: String,
}

/// The load vectors of the superelement in a file; no column where it has none.
///
/// # Errors
/// A superelement that cannot be read or is no model; [`Error::MemoryRead`].
pub(super) fn load_vectors(path: &Path, allowance: &Allowance) -> Result<LoadVectors> {
    let (superelement, digest) = opened(path, allowance)?;
    let none = || Matrix::from_fn(superelement.n_coordinates(), 0, |_, _| 0.0);
    let columns = superelement.tensors().load_vectors.clone().unwrap_or_else(none);
    Ok(LoadVectors { columns, digest })
}

const STIFFNESS: &str = "stiffness";
const MASS: &str = "mass";

/// What speaks against a superelement with a dof whose stiffness rounding may have left.
pub(crate) const NO_STIFFNESS: &str = "has no stiffness but rounding at a dof of its interface";

/// Whether a dof of the interface whose stiffness does not follow from that of others has one that is nothing next to the largest of its
/// kind, translations or rotations. In a K̂ that is condensed from larger numbers rounding is as much, of either sign.
pub(crate) fn has_free_dof(superelement: &Superelement, condensed: &Condensed) -> bool {
    /// Bending of a beam of 1:1000 has 10⁻⁶ of its axial stiffness.
    const NOTHING: f64 = 1e-10;
    let turns = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { direction, .. } => Some(direction.is_rotation()),
        Coordinate::InterfaceRow { .. } => Some(false),
        _ => None,
    };
    let kinds: Vec<Option<bool>> = superelement.metadata().coordinates.iter().map(turns).collect();
    let Condensed { stiffness, following } = condensed;
    [false, true].into_iter().any(|kind| {
        let rows = || (0..kinds.len()).filter(|row| kinds[*row] == Some(kind));
        let largest = rows().map(|row| stiffness[(row, row)]).fold(0.0, f64::max);
        let is_nothing = |value: f64| value != 0.0 && value < NOTHING * largest;
        rows().any(|row| !following.contains(&row) && is_nothing(stiffness[(row, row)]))
    })
}

/// What to do instead.
const FREE_DOF: &str = "reduce the full model with more interface nodes, or with these as a rigid patch";
const SINGULAR_MASS: &str = "reduce the full model by another method";
const NO_MAP: &str = "leave model.dofs and model.nodes out and name rows";

fn no_model(path: &Path, found: &'static str, remedy: &'static str) -> Error {
    Error::NoModel { path: path.to_owned(), found, remedy }
}

/// The superelement in a file, and the bytes of that.
///
/// # Errors
/// A file that cannot be read or is none; [`Error::FormatNotRead`] where it is packed.
pub fn superelement(path: &Path) -> Result<(Superelement, Vec<u8>)> {
    let failed = |error| match FileStart::of(path) {
        Ok(start) if is_packed_superelement(&start) => {
            let (found, expected) = (PACKED_SUPERELEMENT, "a superelement as supel writes it");
            Error::FormatNotRead { path: path.to_owned(), found, expected, advice: "unpack it" }
        }
        _ => Error::of_superelement(path, error),
    };
    regular_file::open(path).map(drop)?;
    let bytes = supel_runtime::file_bytes(path).map_err(failed)?;
    let superelement = Superelement::from_bytes(&bytes).map_err(failed)?;
    Ok((superelement, bytes))
}

/// Refuses the job of a superelement that does not say what that takes for granted.
///
/// # Errors
/// [`Error::AssumedUnsaid`]; a file that cannot be read.
pub fn refuse_unsaid(job: &ModelJob) -> Result<()> {
    let path = split_member(&job.stiffness).0;
    if !is_superelement(&path)? {
        return Ok(());
    }
    let (superelement, _) = superelement(&path)?;
    let validity = &superelement.metadata().validity;
    let default = AssumesJob::default();
    let said = job.assumes.as_ref().unwrap_or(&default);
    let unsaid = validity.assumptions.iter().find(|sentence| !said.sentences.contains(sentence)).cloned();
    let of_gravity = validity.gravity.filter(|gravity| said.gravity != Some(*gravity));
    let of_gravity = of_gravity.map(|[x, y, z]| format!("gravity acts along ({x}, {y}, {z}) alone"));
    let unseen: Vec<f64> = unseen_hz(&superelement).into_iter().filter(|hz| !said.unseen_hz.contains(hz)).collect();
    let of_modes = unseen.iter().copied().reduce(f64::min).map(|lowest| {
        let n = counted(unseen.len(), "mode", "modes");
        format!("{n} that nothing starts or sees are left out, the lowest at {} Hz (unseen_hz)", quantity(lowest, 7))
    });
    match unsaid.or(of_gravity).or(of_modes) {
        Some(sentence) => Err(Error::AssumedUnsaid { path, sentence }),
        None => Ok(()),
    }
}

/// The superelement that is a model, and the digest of its bytes.
fn opened(path: &Path, allowance: &Allowance) -> Result<(Superelement, String)> {
    let size = std::fs::metadata(path).map_err(|source| Error::Read { path: path.to_owned(), source })?.len();
    let claim = allowance.claim(path);
    // The bytes and the numbers made of them, until what is wanted of them is taken.
    claim.set(size.saturating_mul(2))?;
    let (superelement, bytes) = superelement(path)?;
    claim.set(0)?;
    if superelement.metadata().verification.verdict == Verdict::Fail {
        let remedy = "see `supel inspect`, or go on with what `supel export --allow-unverified` writes";
        return Err(no_model(path, "failed a check when it was made", remedy));
    }
    if superelement.metadata().flags.contains(&Flag::Preloaded) {
        let remedy = "reduce the full model, or several of them as one";
        return Err(no_model(path, "is preloaded, and its internal forces are not in its file", remedy));
    }
    Ok((superelement, blake3::hash(&bytes).to_hex().to_string()))
}

/// The matrix that is wanted: K̂ or M̂ by its role or its name, which a further matrix may have too.
fn wanted<'a>(superelement: &'a Superelement, source: &MatrixSource<'_>) -> Result<(&'a str, &'a Matrix)> {
    let named = matrices(superelement);
    let member = source.member.as_deref().or(match source.role {
        MatrixRole::Stiffness => Some(STIFFNESS),
        MatrixRole::Mass => Some(MASS),
        MatrixRole::Further | MatrixRole::Conversion | MatrixRole::Reduced => None,
    });
    // The first of a name is the one that every superelement has.
    if let Some(found) = named.iter().find(|(name, _)| Some(*name) == member) {
        return Ok(*found);
    }
    let names: Vec<&str> = named.iter().map(|(name, _)| *name).collect();
    Ok(named[chosen(&source.file, &names, member, source.role)?])
}

/// Its matrices with their names; no mass where the job asked for none.
fn matrices(superelement: &Superelement) -> Vec<(&str, &Matrix)> {
    let tensors = superelement.tensors();
    let mass = (tensors.mass.rows() > 0).then_some((MASS, &tensors.mass));
    let damping = tensors.damping.as_ref().map(|damping| ("damping", damping));
    let names = superelement.metadata().matrices.iter().map(|matrix| matrix.name.as_str());
    let further = names.zip(&tensors.matrices);
    std::iter::once((STIFFNESS, &tensors.stiffness)).chain(mass).chain(damping).chain(further).collect()
}

/// Its entries but for zeros, row by row.
fn entries<'a>(matrix: &Matrix, source: &MatrixSource<'a>) -> Result<Collector<'a>> {
    let mut entries = Collector::new(source, source.role.undeclared());
    let n = matrix.rows();
    for (row, col) in (0..n).flat_map(|row| (0..n).map(move |col| (row, col))) {
        let value = matrix[(row, col)];
        if value != 0.0 {
            entries.push(row as u32, col as u32, value)?;
        }
    }
    Ok(entries)
}

/// The digits that rigid-body motion shows K̂ to have, no more than its values.
fn digits_shown(superelement: &Superelement, stiffness: &Matrix, of_values: Digits) -> Result<Digits> {
    let shown = digits_of(superelement, stiffness)?;
    Ok(shown.map_or(of_values, |shown| Digits::condensed((shown as u32).min(of_values.significant))))
}
