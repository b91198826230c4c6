//! Rigid-body modes, mechanisms and supports: lines S-01 to S-27.

mod interfaces;
mod mechanisms;
mod rigid_body;

use supel_models::{Material, Model, brick};

/// A free block of 36 nodes: label 1 + i + 4 (j + 3 k) at (i, j, k).
pub(crate) fn block() -> Model {
    brick([3, 2, 2], [3.0, 2.0, 2.0], &Material::UNIT)
}

/// Three corners of the block that hold it well.
pub(crate) const CORNERS: [i64; 3] = [1, 12, 28];
