//! The loads of a file in the coordinates of a component.

use alloc::string::String;
use alloc::vec::Vec;

/// Loads with their names.
#[derive(Clone, Debug)]
pub(super) struct LoadVectors {
    /// Names, in the order of the file.
    pub(super) names: Vec<String>,
    /// One load after the other, each with a value for every coordinate of the measures.
    pub(super) values: Vec<f64>,
}
