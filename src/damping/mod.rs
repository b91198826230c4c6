//! Damping of the reduced component.
//!
//! ```text
//! C   n × n   damping matrices of the job
//! Ĉ = Σ ΨᵀCΨ + α M̂ + β K̂ + M̂ Φ diag(2ζω) Φᵀ M̂     r × r, in the user's units
//! ```
//! Φ are the elastic modes of the reduced component with its interface free, ΦᵀM̂Φ = I, so that ΦᵀĈΦ = diag(2ζω) of the last part. It
//! leaves rigid-body motion alone, Ĉ Û = 0, and so does β K̂. That of matrices is looked at on the full model, before anything is reduced.

mod component;
mod law;
mod resistance;

pub use component::Damping;
pub use law::Reduced;
pub use resistance::refuse_resistance;
