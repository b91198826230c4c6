//! The partition: which degrees of freedom are interface, which internal, and the two matrices in that order.
//!
//! ```text
//! T            n × n'      original rows from partitioned dofs; identity but for the rows of patches, those that follow others by
//!                          constraints and those that the job holds, which are empty
//! K = TᵀKT     n' × n'     internal dofs first, in the order of elimination, then the interface dofs in job order
//! M = TᵀMT     n' × n'
//! n' = n_I + n_B
//! ```
//!
//! The internal dofs are put into a fill-reducing order once, here, so that no later stage permutes a vector.

mod average_patch;
mod axes;
mod boundary;
mod carried_loads;
mod congruence;
mod constraint_digits;
mod constraint_ground;
mod constraints;
mod direct_nodes;
mod distortions;
mod earlier;
mod elimination;
mod expansion;
mod faces;
mod far_masses;
mod fitted;
mod follower;
mod further_matrices;
mod gravity;
mod held;
mod interface;
mod interface_node;
mod internal_directions;
mod keys;
mod load;
mod made_entries;
mod metis;
mod minimum_degree;
mod missing_directions;
mod mixed_interface;
mod node_catalogue;
mod noise;
mod ordering;
mod origin;
#[expect(clippy::module_inception, reason = "the partition is what the folder makes")]
mod partition;
mod parts;
mod patch_bodies;
mod placement;
mod pressure;
mod problem;
mod quantities;
mod reference_node;
mod region;
mod rigid_patch;
mod roundings;
mod sites;
mod statements;
mod transformation;
mod transformation_row;
mod turned_forces;
mod unloaded;

pub use axes::Frame;
pub(crate) use axes::{OF_THE_MODEL, of_job as axes_of_job};
pub use expansion::{Expansion, ExpansionFacts, RowModes, expansion_modes};
pub use faces::with_faces;
pub use fitted::Fit;
pub(crate) use fitted::{hole, sphere};
pub use follower::Follower;
pub use further_matrices::{CarriedMatrix, MatrixFacts, RowMatrix, further_matrices};
pub use gravity::Gravity;
pub use held::{Held, HeldSelection, held};
pub use interface::{Output, RecoveredRows, TiedNodes, nodes_of_patches, outputs, patches, recovered_rows};
pub use interface_node::InterfaceNode;
pub use load::{LoadFacts, Loads, RowLoad, loads};
pub use mixed_interface::MixedInterface;
pub use noise::CHANCE_OF_MORE;
pub use partition::{LARGEST_INTERFACE, Partition};
pub use problem::EntriesAt;
pub use quantities::{ModelQuantities, Quantities, quantities};
pub use reference_node::reference_nodes;
pub(crate) use region::contains;
pub use transformation::{DofOrigin, ReducedDof, Transformation};
pub use transformation_row::TransformationRow;
