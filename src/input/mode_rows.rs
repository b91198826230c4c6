//! What the rows of K and M are, for modes whose values stand at nodes and directions.

use crate::dofs::Dof;
use crate::sparse::Turning;

/// The rows of K and M in their files.
#[derive(Clone, Debug)]
pub struct ModeRows {
    /// How many there are in the files.
    pub n: usize,
    /// Rows that are left of the model by their numbers in the files, from zero, each with its node and direction. A row has none where no
    /// map tells it, or where it is scalar.
    pub left: Vec<(usize, Option<Dof>)>,
    /// Rows of the files that are along axes of their own, which those that are left are not.
    pub turning: Option<Turning>,
}
