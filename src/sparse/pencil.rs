//! Two symmetric matrices of one size, and the precision of their entries.

use super::leading::Leading;
use super::rounding::Rounding;

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

/// How well the entries of K and M are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision {
    /// Of the entries of K.
    pub stiffness: Rounding,
    /// Of the entries of M.
    pub mass: Rounding,
}

impl Precision {
    /// The larger of the two shares that stand for the matrices.
    pub fn share(self) -> f64 {
        self.stiffness.share.max(self.mass.share)
    }
}
