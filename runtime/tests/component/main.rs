//! The modal component in large motion.

mod batch;
#[path = "../beam/mod.rs"]
mod beam;
mod construction;
mod dynamics;
mod forces;
mod invariance;
mod loads;
#[path = "../random/mod.rs"]
mod random;
mod recovery;
mod situation;
