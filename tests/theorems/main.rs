//! The theorems of section 2 of the paper, one test each, on generated models that cover what the theorems range over:
//! both methods, interfaces of nodes and of rigid patches, free, held and half-held components, singular mass.
//!
//! What a test compares with is computed densely from the model's own entries; see `chain`.

mod average;
mod basis;
mod eigenpairs;
mod macneal;
mod reduction;
mod rigid_body;
mod rubin;

use supel_testing::{cases, chain};
