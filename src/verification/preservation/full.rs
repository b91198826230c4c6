//! The full model under a boundary of the scene: its eigenvalues from the factor of K_II.
//!
//! Holding interface dofs takes rows and columns away, loading them adds to the diagonal of M, springs add to that of K; K_II
//! stays as it is, and so does its factor. Where that factor is not accurate enough, K − σM of the supported model is factored anew.

use faer::Mat;

use super::super::evidence::Evidence;
use super::boundary::Boundary;
use crate::constraint::{FreeAtZero, FreeStatics};
use crate::eigen::{Factored, ModalProblem, ModeRequest, Modes, Wanted, elastic_modes, shifted};
use crate::error::{Error, Result};
use crate::factor::Analysis;
use crate::job::Eigensolver;
use crate::modes::massive;
use crate::partition::EntriesAt;
use crate::rigid::{RigidBodyModes, passing_motions, that_pass};
use crate::sparse::Pencil;
use crate::sparse::{SparseMatrix, principal};

/// Backward error up to which a pair found with the factor of K_II is taken. Sound supports give 10⁻¹⁶ to 10⁻¹⁴; where the
/// lowest λ is 10⁻⁹ of ‖K‖, as in slender models, its Rayleigh quotient then errs by (10⁻¹²/10⁻⁹)² = 10⁻⁶ at most.
const MAX_BACKWARD_ERROR: f64 = 1e-12;
/// A supported full model.
pub(super) struct Supported {
    stiffness: SparseMatrix,
    mass: SparseMatrix,
    /// Dofs of the partition that are left.
    kept: Vec<usize>,
    /// Numbers of the interface dofs that are not held.
    free: Vec<usize>,
    rigid: RigidBodyModes,
    /// Whether K is that of the component, without springs.
    is_own_stiffness: bool,
}

impl Supported {
    /// Takes away the held dofs and adds the loads and the springs.
    ///
    /// # Errors
    /// A rigid-body motion without mass that the support lets pass; a dense eigenproblem that does not converge.
    pub(super) fn new(evidence: &Evidence<'_>, boundary: &Boundary) -> Result<Self> {
        let partition = evidence.partition;
        let n_i = partition.n_internal;
        let free: Vec<usize> = (0..partition.n_interface()).filter(|dof| !boundary.held[*dof]).collect();
        let kept: Vec<usize> = (0..n_i).chain(free.iter().map(|dof| n_i + dof)).collect();
        let on_all =
            |of_interface: &[f64]| -> Vec<f64> { (0..n_i).map(|_| 0.0).chain(of_interface.iter().copied()).collect() };
        let mass = principal(&partition.mass, &kept, &on_all(&boundary.load));
        let stiffness = match boundary.has_springs() {
            true => principal(&partition.stiffness, &kept, &on_all(&boundary.springs)),
            false => principal(&partition.stiffness, &kept, &[]),
        };
        let resisting = boundary.resisting();
        massive(partition, that_pass(partition, evidence.rigid.massless(), &resisting)?.as_ref())?;
        let rigid = passing_motions((partition, evidence.rigid), &resisting, (&kept, &mass))?;
        Ok(Self { stiffness, mass, kept, free, rigid, is_own_stiffness: !boundary.has_springs() })
    }

    /// The rigid-body motions that the support lets pass, in the reduced coordinates that are not held: those of the interface dofs, behind
    /// them amplitudes where rigid-body modes have some.
    pub(super) fn passing(&self, evidence: &Evidence<'_>) -> Mat<f64> {
        let motions = self.rigid.orthonormal.as_ref();
        if evidence.is_held() {
            return motions.subrows(motions.nrows() - self.free.len(), self.free.len()).to_owned();
        }
        let n_b = evidence.partition.n_interface();
        let mut whole = Mat::zeros(evidence.partition.n_dofs(), motions.ncols());
        for (row, dof) in self.kept.iter().enumerate() {
            whole.row_mut(*dof).copy_from(motions.row(row));
        }
        let reduced = evidence.rigid_coordinates(whole.as_ref());
        let rows: Vec<usize> = self.free.iter().copied().chain(n_b..reduced.nrows()).collect();
        Mat::from_fn(rows.len(), reduced.ncols(), |i, j| reduced[(rows[i], j)])
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
        if evidence.is_held() {
            match self.by_factor(evidence, problem, request) {
                // Few digits leave what the interface condenses to no more definite than a mechanism does.
                Err(Error::Mechanism { .. }) if partition.has_few_digits() => {}
                Ok(modes) if modes.errors.iter().any(|error| error.backward > MAX_BACKWARD_ERROR) => {}
                found => return found,
            }
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
        if self.is_own_stiffness && self.free.len() == evidence.partition.n_interface() {
            return elastic_modes(
                problem,
                &FreeAtZero::new(factor, &self.stiffness, constraint, &self.rigid)?,
                request,
            );
        }
        let statics = FreeStatics::of(factor, (&self.stiffness).into(), (&self.free, evidence.partition.n_interface()));
        elastic_modes(problem, &statics.operator(&self.rigid)?, request)
    }
}
