//! The full model under a boundary of the scene: its eigenvalues from the factor of K_II.
//!
//! Holding interface dofs takes rows and columns away, loading them adds to the diagonal of M; K_II stays as it is, and
//! so does its factor. Where that factor is not accurate enough, K − σM of the supported model is factored anew.

use faer::{Mat, MatRef};

use super::super::evidence::Evidence;
use super::boundary::Boundary;
use crate::constraint::FreeAtZero;
use crate::dense;
use crate::eigen::{Factored, ModalProblem, ModeRequest, Modes, Wanted, elastic_modes, shifted};
use crate::error::Result;
use crate::factor::Analysis;
use crate::job::Eigensolver;
use crate::modes::massive;
use crate::partition::EntriesAt;
use crate::rigid::{RigidBodyModes, RigidEnergy};
use crate::sparse::Pencil;
use crate::sparse::diagonal;
use crate::sparse::{SparseMatrix, product};

/// Backward error up to which a pair found with the factor of K_II is taken. Sound supports give 10⁻¹⁶ to 10⁻¹⁴; where the
/// lowest λ is 10⁻⁹ of ‖K‖, as in slender models, its Rayleigh quotient then errs by (10⁻¹²/10⁻⁹)² = 10⁻⁶ at most.
const MAX_BACKWARD_ERROR: f64 = 1e-12;
/// Singular values of the rigid-body motions at the held dofs, relative to the largest, below which a motion passes. The
/// interface rank uses the same figure.
const PASSES: f64 = 1e-10;

/// A supported full model.
pub(super) struct Supported {
    stiffness: SparseMatrix,
    mass: SparseMatrix,
    /// Dofs of the partition that are left.
    kept: Vec<usize>,
    /// Numbers of the interface dofs that are not held.
    free: Vec<usize>,
    rigid: RigidBodyModes,
}

impl Supported {
    /// Takes away the held dofs and adds the load.
    ///
    /// # Errors
    /// A rigid-body motion without mass that the support lets pass; a dense eigenproblem that does not converge.
    pub(super) fn new(evidence: &Evidence<'_>, boundary: &Boundary) -> Result<Self> {
        let partition = evidence.partition;
        let n_i = partition.n_internal;
        let free: Vec<usize> = (0..partition.n_interface()).filter(|dof| !boundary.held[*dof]).collect();
        let kept: Vec<usize> = (0..n_i).chain(free.iter().map(|dof| n_i + dof)).collect();
        let load: Vec<f64> = (0..n_i).map(|_| 0.0).chain(boundary.load.iter().copied()).collect();
        let mass = restricted(&partition.mass, &kept, &load);
        let rigid = passing_motions(evidence, boundary, &kept, &mass)?;
        Ok(Self { stiffness: restricted(&partition.stiffness, &kept, &vec![0.0; load.len()]), mass, kept, free, rigid })
    }

    /// The rigid-body motions that the support lets pass, at the interface dofs that are not held.
    pub(super) fn passing(&self) -> Mat<f64> {
        let motions = self.rigid.orthonormal.as_ref();
        motions.subrows(motions.nrows() - self.free.len(), self.free.len()).to_owned()
    }

    /// The elastic modes up to a λ, from the start vectors of a seed.
    ///
    /// # Errors
    /// The eigensolver does not converge; no memory.
    pub(super) fn modes_up_to(&self, evidence: &Evidence<'_>, limit: f64, seed: u64) -> Result<Modes> {
        let request = ModeRequest { wanted: Wanted::UpTo(limit), eigensolver: Eigensolver::Lanczos, seed };
        let pencil = Pencil::new(&self.stiffness, &self.mass);
        let partition = evidence.partition;
        let problem = ModalProblem::of(pencil, partition.precision).deflating(self.rigid.deflated());
        let entries = EntriesAt { partition, kept: &self.kept };
        let problem = problem.with_noise(&entries);
        let modes = self.by_factor(evidence, problem, request)?;
        if modes.errors.iter().all(|error| error.backward <= MAX_BACKWARD_ERROR) {
            return Ok(modes);
        }
        let analysis = Analysis::new(pencil)?;
        let shifted = shifted(&analysis, problem, &|dof| evidence.partition.name_of(dof))?;
        elastic_modes(problem, &Factored::new(&shifted.factor, shifted.sigma), request)
    }

    fn by_factor(&self, evidence: &Evidence<'_>, problem: ModalProblem<'_>, request: ModeRequest) -> Result<Modes> {
        let (factor, constraint) = (evidence.factor, evidence.constraint);
        if self.free.is_empty() {
            return elastic_modes(problem, &Factored::new(factor, 0.0), request);
        }
        if self.free.len() == evidence.partition.n_interface() {
            return elastic_modes(
                problem,
                &FreeAtZero::new(factor, &self.stiffness, constraint, &self.rigid)?,
                request,
            );
        }
        // The loads of a support have a resultant, and what K does not know of rigid-body motion is part of what holds it.
        let (psi_s, schur) = self.condensed(evidence);
        let condensed = (psi_s.as_ref(), schur.as_ref());
        elastic_modes(problem, &FreeAtZero::uncorrected(factor, &self.stiffness, condensed, &self.rigid)?, request)
    }

    /// Ψ_S of the interface dofs that are not held, as the factor gives it, and S = K_BB + K_BI Ψ_S.
    fn condensed(&self, evidence: &Evidence<'_>) -> (Mat<f64>, Mat<f64>) {
        let (n_b, n_f) = (evidence.partition.n_interface(), self.free.len());
        let unit = Mat::from_fn(n_b, n_f, |i, j| f64::from(u8::from(i == self.free[j])));
        let psi_s = evidence.factor.follow_border(unit.as_ref());
        let identity = Mat::<f64>::identity(n_f, n_f);
        let psi = faer::concat![[psi_s.as_ref()], [identity.as_ref()]];
        let mut schur = dense::gram(psi.as_ref(), product(&self.stiffness, psi.as_ref()).as_ref());
        dense::symmetrise(&mut schur);
        (psi_s, schur)
    }
}

/// Rows and columns `kept` (ascending) of a matrix with `load` added to its diagonal.
fn restricted(matrix: &SparseMatrix, kept: &[usize], load: &[f64]) -> SparseMatrix {
    let mut position = vec![None; matrix.rows()];
    kept.iter().enumerate().for_each(|(new, old)| position[*old] = Some(new as u32));
    let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (new, old) in kept.iter().enumerate() {
        let mut entries: Vec<(u32, f64)> = matrix
            .outer_view(*old)
            .into_iter()
            .flat_map(|row| row.iter().map(|(col, value)| (col, *value)).collect::<Vec<_>>())
            .filter_map(|(col, value)| position[col].map(|col| (col, value)))
            .collect();
        if load[*old] != 0.0 {
            match entries.binary_search_by_key(&(new as u32), |entry| entry.0) {
                Ok(at) => entries[at].1 += load[*old],
                Err(at) => entries.insert(at, (new as u32, load[*old])),
            }
        }
        columns.extend(entries.iter().map(|entry| entry.0));
        values.extend(entries.iter().map(|entry| entry.1));
        pointers.push(columns.len());
    }
    SparseMatrix::new((kept.len(), kept.len()), pointers, columns, values)
}

/// The rigid-body motions that leave the held dofs at rest, orthonormal in the mass with its load.
fn passing_motions(
    evidence: &Evidence<'_>,
    boundary: &Boundary,
    kept: &[usize],
    mass: &SparseMatrix,
) -> Result<RigidBodyModes> {
    let n_i = evidence.partition.n_internal;
    let stiffness = diagonal(&evidence.partition.stiffness);
    let held: Vec<usize> = (0..boundary.held.len()).filter(|dof| boundary.held[*dof]).map(|dof| n_i + dof).collect();
    let that_pass = |q: MatRef<'_, f64>| Ok(dense::product(q, passing(q, &held, &stiffness)?.as_ref()));
    massive(evidence.partition, that_pass(evidence.rigid.massless())?.as_ref())?;
    let motions = that_pass(evidence.rigid.massive())?;
    let mut motions = Mat::from_fn(kept.len(), motions.ncols(), |i, j| motions[(kept[i], j)]);
    // The second pass takes up the rounding of the first.
    for _ in 0..2 {
        let mut modal = dense::gram(motions.as_ref(), product(mass, motions.as_ref()).as_ref());
        dense::symmetrise(&mut modal);
        let (masses, directions) = dense::symmetric_eigen(modal.as_ref())?;
        let unit = Mat::from_fn(masses.len(), masses.len(), |i, j| directions[(i, j)] / masses[j].sqrt());
        motions = dense::product(motions.as_ref(), unit.as_ref());
    }
    Ok(RigidBodyModes {
        mass_orthonormal: product(mass, motions.as_ref()),
        modes: motions.clone(),
        orthonormal: motions,
        n_massless: 0,
        n_mechanisms: 0,
        n_grey: 0,
        source: evidence.rigid.source,
        is_classical: false,
        energy: RigidEnergy::default(),
    })
}

/// Combinations of the motions that vanish at the held dofs; rows weighted by stiffness, so that rotations and
/// translations count alike.
fn passing(q: MatRef<'_, f64>, held: &[usize], stiffness: &[f64]) -> Result<Mat<f64>> {
    let n_r = q.ncols();
    if held.is_empty() || n_r == 0 {
        return Ok(Mat::identity(n_r, n_r));
    }
    // A free particle has no stiffness and is held all the same.
    let weight = |dof: usize| if stiffness[dof] > 0.0 { stiffness[dof].sqrt() } else { 1.0 };
    let at_held =
        Mat::from_fn(held.len().max(n_r), n_r, |i, j| held.get(i).map_or(0.0, |dof| q[(*dof, j)] * weight(*dof)));
    let (singular, v) = dense::right_singular(at_held.as_ref())?;
    let rank = singular.iter().filter(|value| **value > PASSES * singular[0]).count();
    Ok(v.as_ref().subcols(rank, n_r - rank).to_owned())
}
