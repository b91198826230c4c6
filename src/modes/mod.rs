//! Modes: the expansion modes V that the reduction method keeps.
//!
//! ```text
//! free-free modes             K x = λ M x on all dofs, rigid-body modes deflated
//! fixed-interface modes       K_II v = λ M_II v
//! ```
//! Both come from the factor of K_II at shift zero. Eigenvalues are recomputed as Rayleigh quotients, whose error is the
//! square of the vector's; each carries the bar that rounding and the digits of the data put on it.

#[cfg(feature = "arpack")]
mod arpack;
mod certificate;
mod cluster;
mod eigenproblem;
mod equilibration;
mod lanczos;
mod operator;
mod orthogonalisation;
mod quality;
mod random;
mod retained;
mod ritz;
mod shifted;

use faer::{Mat, MatRef};

use crate::error::Result;
use crate::job::Eigensolver;
use crate::model::Precision;
use crate::rigid::RigidBodyModes;
use crate::sparse::SparseMatrix;

pub use certificate::{Certificate, certified};
pub use cluster::REPEATED_WITHIN;
pub use eigenproblem::{CLUSTER_GAP, EigenWork, Eigenpairs, Problem, Wanted};
pub use equilibration::Equilibrated;
pub use lanczos::lanczos;
pub use operator::{Factored, FreeAtZero, ShiftInvert};
pub use orthogonalisation::gram_schmidt;
pub use quality::{ModeError, mass_orthogonality};
pub(crate) use random::SplitMix64;
pub use retained::{Component, Retained, retained};
pub use shifted::{Shifted, shift_of_factor, shifted};

/// Elastic modes of one boundary condition.
#[derive(Clone, Debug)]
pub struct Modes {
    /// λ = ω² in scaled units, ascending: Rayleigh quotients.
    pub lambda: Vec<f64>,
    /// Mode shapes, n × k, M-orthonormal.
    pub shapes: Mat<f64>,
    /// How well each is known.
    pub errors: Vec<ModeError>,
    /// The end of the band that was searched, where one was asked for.
    pub searched_to: Option<f64>,
    /// The next eigenvalue above, where there is one.
    pub next: Option<f64>,
    /// What they cost.
    pub work: EigenWork,
}

impl Modes {
    /// Number of modes k.
    pub fn count(&self) -> usize {
        self.lambda.len()
    }

    /// A shift above the highest mode and the band that was searched, and below the next mode, at this fraction of the
    /// way: where a Sturm count is taken.
    pub fn shift_above(&self, fraction: f64) -> f64 {
        let top = self.lambda.last().copied().into_iter().chain(self.searched_to).fold(0.0, f64::max);
        match self.next.filter(|next| *next > top) {
            Some(next) => top + fraction * (next - top),
            None if top > 0.0 => (1.0 + fraction) * top,
            None => fraction,
        }
    }
}

/// The boundary condition modes are computed under.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// Interface free.
    FreeInterface,
    /// Interface held.
    FixedInterface,
}

/// A symmetric pencil whose modes are wanted, with what is deflated.
#[derive(Clone, Copy, Debug)]
pub struct ModalProblem<'a> {
    /// K, n × n.
    pub stiffness: &'a SparseMatrix,
    /// M, n × n.
    pub mass: &'a SparseMatrix,
    /// Rigid-body modes of the same dofs, where the component is free.
    pub rigid: Option<&'a RigidBodyModes>,
    /// Relative precision of the data.
    pub precision: Precision,
}

/// Which modes, by which solver.
#[derive(Clone, Copy, Debug)]
pub struct ModeRequest {
    /// Count or band, in scaled units.
    pub wanted: Wanted,
    /// Lanczos or the independent witness.
    pub eigensolver: Eigensolver,
    /// Seed of the start vectors.
    pub seed: u64,
}

/// Seed of the first attempt; a repeated one takes another.
pub const SEED: u64 = 0x5eed_0001;

/// Finds elastic modes with a shift-invert operator.
///
/// # Errors
/// The eigensolver does not converge.
pub fn elastic_modes(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, request: ModeRequest) -> Result<Modes> {
    let nothing = Mat::<f64>::zeros(problem.mass.rows(), 0);
    let deflated: [MatRef<'_, f64>; 2] = match problem.rigid {
        Some(rigid) => [rigid.orthonormal.as_ref(), rigid.mass_orthonormal.as_ref()],
        None => [nothing.as_ref(), nothing.as_ref()],
    };
    let eigenproblem = Problem { operator, mass: problem.mass, deflated };
    let pairs = match request.eigensolver {
        Eigensolver::Lanczos => lanczos(eigenproblem, request.wanted, request.seed)?,
        Eigensolver::Arpack => by_arpack(eigenproblem, request)?,
    };
    let mut shapes = pairs.vectors;
    quality::normalise(problem.mass, &mut shapes);
    let (mut lambda, mut errors, mut residuals) = quality::rayleigh_quotients(problem, shapes.as_ref());
    let repeated = cluster::repeated(&lambda, &errors);
    if !repeated.is_empty() {
        cluster::canonicalise(problem.mass, &repeated, &mut shapes);
        (lambda, errors, residuals) = quality::rayleigh_quotients(problem, shapes.as_ref());
        cluster::average(&repeated, &mut lambda);
    }
    quality::add_residual_bars(eigenproblem, &lambda, &mut errors, residuals, pairs.next);
    let work = EigenWork { solves: pairs.work.solves + lambda.len(), ..pairs.work };
    Ok(Modes {
        lambda,
        shapes,
        errors,
        searched_to: match request.wanted {
            Wanted::Count(_) => None,
            Wanted::UpTo(limit) => Some(limit),
        },
        next: pairs.next,
        work,
    })
}

#[cfg(feature = "arpack")]
fn by_arpack(problem: Problem<'_>, request: ModeRequest) -> Result<Eigenpairs> {
    arpack::arpack(problem, request.wanted, request.seed)
}

#[cfg(not(feature = "arpack"))]
fn by_arpack(_: Problem<'_>, _: ModeRequest) -> Result<Eigenpairs> {
    Err(crate::error::Error::EigensolverMissing)
}
