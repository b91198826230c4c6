//! Where the result of another program is.

use super::claims::PairFiles;
use super::superelement::ReducedFiles;

/// What is held against a model.
#[derive(Clone, Debug)]
pub enum ResultFiles {
    /// Eigenpairs.
    Pairs(PairFiles),
    /// A superelement with its basis.
    Superelement(ReducedFiles),
}
