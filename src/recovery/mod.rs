//! States of a simulation expanded to what happens inside the component.
//!
//! ```text
//! q       r      a state: displacements of the interface, then modal amplitudes
//! W       m × r  rows of Ψ at the recovered nodes
//! W q     m      displacements; W q̇ velocities and W q̈ accelerations
//! R T Ψ   m × r  rows of quantities, stresses for instance
//! F       r      loads on the interface, K̂ q + M̂ q̈ less those of gravity
//! ```
//! States are read and expanded one by one, so that their number needs no memory. The expansion is linear: displacements and rotations of
//! a state are small, in the frame of the model. Large motion is what [`ModalComponent::recover`] is for.
//!
//! [`ModalComponent::recover`]: supel_runtime::component::ModalComponent::recover

mod coordinate_names;
mod displacements;
mod interface_loads;
mod motion_series;
mod product;
mod quantities;
mod sheet;
mod state;
mod states;
mod vtk_grid;
#[cfg_attr(not(feature = "hdf5"), path = "no_series.rs")]
mod vtk_series;

pub use coordinate_names::coordinate_names;
pub use displacements::Displacements;
pub use interface_loads::InterfaceLoads;
pub use motion_series::MotionSeries;
pub use quantities::Quantities;
pub use sheet::{Sheet, SheetOutput, fill};
pub use state::{Order, State};
pub use states::{StateFiles, States};
pub use vtk_grid::{Cells, Field, Values};
pub use vtk_series::Series;
