//! What the reduction preserves: the reduced model compared with the full one.
//!
//! ```text
//! mac          retained modes as eigenpairs of both models             (34) (35), M-15
//! boundaries   frequencies with interfaces held, free, loaded           M-24
//! counts       how many such frequencies the full model has             M-06
//! statics      stiffness of each interface by direct solves             M-17
//! response     frequency response between interface dofs, and at outputs  M-20, M-21
//! loads        internal loads under forces on the interface
//! scan         where between its samples the response errs most
//! sizes        these errors for a smaller basis
//! asked        the largest of them, and what the scene accepts          M-29 to M-31, M-34
//! unmade       comparisons that the matrices have no answer for         M-33
//! ```
//! Every answer of the full model comes from the full sparse matrices, and its residual is checked. The factor of K_II,
//! which exists already, only speeds this up. A costly comparison that the job does not ask for is left out, and the report
//! names it.

mod accuracy;
mod advice;
mod answered;
mod asked;
mod boundaries;
mod boundary;
mod compared;
mod counts;
mod enough;
mod explicit_step;
mod extended;
mod full;
mod full_response;
mod interfaces;
mod internal_loads;
mod leading;
mod levels;
mod mac;
mod observed;
mod outcome;
mod pair_error;
mod policy;
mod reduced;
mod reference;
mod response;
mod samples;
mod scan;
mod shift;
mod sizes;
mod space;
mod statics;
mod triangle;
mod unmade;

pub use accuracy::{Accuracy, AccuracyMeasure, LimitSource};
pub use compared::{Compared, preservation, preservation_of_file};
pub use enough::fewest_modes;
pub use outcome::{
    BoundaryComparison, BoundaryCount, FrequencyPair, HighestFrequency, InterfaceStatics, InternalLoads, LoadSample,
    Preservation, PreservedMode, ResponseComparison, ResponseSample, SizeError,
};
pub use policy::{Motion, Plan, ResponseExtent};
pub use unmade::{Unmade, unmade_check};
