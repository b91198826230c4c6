//! What the reduction preserves: the reduced model beside the full one.
//!
//! ```text
//! mac          retained modes as eigenpairs of both models             (34) (35), M-15
//! boundaries   frequencies with interfaces held, free, loaded           M-24
//! counts       how many the full model has of them                      M-06
//! statics      stiffness of each interface by direct solves             M-17
//! response     frequency response of all pairs of interface dofs        M-20, M-21
//! sizes        the same errors of a smaller basis
//! ```
//! Every answer of the full model comes from the full sparse matrices with a residual that is looked at; the factor of
//! K_II, which is there already, only speeds it up. What would be dear and nobody asked for is left out by name.

mod boundaries;
mod boundary;
mod compared;
mod counts;
mod extended;
mod full;
mod interfaces;
mod mac;
mod outcome;
mod policy;
mod reduced;
mod reference;
mod response;
mod samples;
mod shift;
mod sizes;
mod statics;

pub use compared::{Compared, preservation};
pub use outcome::{
    BoundaryComparison, BoundaryCount, FrequencyPair, HighestFrequency, InterfaceStatics, Preservation, PreservedMode,
    ResponseComparison, ResponseSample, SizeError,
};
pub use policy::Plan;
