//! The eigensolvers: modes of a symmetric pencil by a shift-invert operator, with what is known of their errors.
//!
//! ```text
//! K x = λ M x      n × n, through an operator (K − σM)⁻¹ and products with M
//! Q                n × n_r, motions that are deflated
//! ```
//! Nothing here knows a component, its interface or its rigid-body modes: a pencil, an operator and vectors to deflate are all
//! there is. [`lanczos`] is the solver; ARPACK-NG is a second one that shares nothing with it but the operator.

#[cfg(feature = "arpack")]
mod arpack;
mod block_width;
mod cluster;
mod columns;
mod dense_pencil;
mod elastic;
mod elastic_scale;
mod equilibration;
mod lanczos;
pub(crate) mod massless;
mod modal_problem;
mod modes;
mod operator;
mod orthogonalisation;
mod problem;
mod quality;
mod recorded;
mod ritz;
mod shifted;
mod spectral;
pub(crate) mod zero;

pub use cluster::REPEATED_WITHIN;
pub(crate) use cluster::{mean_is_away, taken_for_one};
pub(crate) use dense_pencil::{eigenvalue_beyond, eigenvalues, lowest_eigenpairs, lowest_ratio_of};
pub(crate) use elastic::{CARRIES_NOTHING, are_left_inexact, judged, pairs_between, purified, settled_at};
pub use elastic::{Eigensolver, ModeRequest, elastic_modes};
pub(crate) use elastic_scale::{elastic_scale, relief_scale};
pub use equilibration::Equilibrated;
pub use lanczos::{lanczos, lanczos_between};
pub(crate) use massless::{ByInertia, NO_MASS};
pub use modal_problem::{EnergyNoise, ModalProblem};
pub(crate) use modal_problem::{median_ratio, ratios, relative_residual, rows_with_mass};
pub use modes::{ElasticCount, Modes};
pub use operator::{Factored, ShiftInvert};
pub use orthogonalisation::mass_qr;
pub use problem::{CLUSTER_GAP, EigenWork, Eigenpairs, Interval, Problem, Wanted};
pub(crate) use problem::{are_clustered, is_above};
pub use quality::{MassOrthogonality, ModeError, NOTICED_BAR, mass_orthogonality};
pub(crate) use quality::{bar_of_lambda, bars_with_neighbours, frequency_bar, rayleigh_quotients};
pub(crate) use ritz::RESIDUAL_FLOOR;
pub(crate) use shifted::first_shift;
pub use shifted::{Shifted, shifted};
pub(crate) use spectral::{Spectral, complex_shift, scaled_by, sharpen};
