//! Superelements joined at nodes, and the modes of what they make: a reduced model reduced once more.
//!
//! ```text
//! q                 n           what moves of the assembly: joined dofs are one, held dofs are out
//! p_c = B_c q       r_c × n     B_c has zeros and ones
//! K = Σ B_cᵀ K̂_c B_c,  M = Σ B_cᵀ M̂_c B_c + point masses
//! K x = λ M x,      rigid-body motions deflated
//! ```
//! A superelement is its full model with the interior tied to Ψ. So the assembly of superelements is that of the full models, which are
//! joined, held and loaded at the same interface dofs, with motions left out; by Rayleigh and Ritz no frequency of the full assembly
//! lies above the one of the same number that is found here. From below they are bounded by what the files say of the modes that were left out
//! ([`Omitted`]).

mod absence;
#[expect(clippy::module_inception, reason = "the assembly is what the folder makes")]
mod assembly;
mod component;
mod joined_model;
mod joint;
mod modes;
mod omitted;
mod place;
mod rigid;
mod selection;
mod spectrum;
mod storage;

pub use absence::{Absence, absence};
pub use assembly::{Assembly, Held, Joint, Loaded, PointMass};
pub use component::Component;
pub use joined_model::{JoinedModel, JoinedNode, JoinedRow, JoinedSelection, Members};
pub use modes::{AssemblyMode, AssemblyModes, Kind, Wanted};
pub use omitted::{Omitted, SprungMass};
pub use storage::within_memory;
