//! Two symmetric matrices of one size, and the precision of their entries.

use super::leading::Leading;

/// A symmetric pencil in its order of elimination: K and M of one size, whose combinations K − σM are factored.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<'a> {
    /// K, n × n.
    pub stiffness: Leading<'a>,
    /// M, n × n.
    pub mass: Leading<'a>,
}

impl<'a> Pencil<'a> {
    /// Of two matrices or leading blocks.
    pub fn new(stiffness: impl Into<Leading<'a>>, mass: impl Into<Leading<'a>>) -> Self {
        Self { stiffness: stiffness.into(), mass: mass.into() }
    }
}

/// Relative precision of the data: half a unit of the last decimal digit, or ε/2 for binary data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision {
    /// Of the entries of K.
    pub stiffness: f64,
    /// Of the entries of M.
    pub mass: f64,
}
