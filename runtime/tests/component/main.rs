//! The modal component in large motion.

mod at_nodes;
#[cfg(feature = "std")]
mod batch;
use supel_models::superelements::beam;
mod construction;
mod damping;
mod dynamics;
mod exact;
mod forces;
mod gravity;
mod invariance;
mod load_vectors;
mod loads;
mod recovery;
mod situation;
