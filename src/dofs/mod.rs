//! Degrees of freedom and nodes: what the rows of the matrices stand for, and what they are called in messages.

mod axes;
mod dof;
mod file_rows;
mod nodes;

pub(crate) use axes::{Axes, cross, spanned, unit};
pub use axes::{AxisDigits, RoundedAxes};
pub(crate) use dof::gyration;
pub use dof::{Dof, DofMap};
pub use file_rows::{FileRows, RowNames};
pub use nodes::Nodes;
pub use supel_runtime::Direction;
