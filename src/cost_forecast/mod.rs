//! What a run will cost, stage by stage, known before any number is computed.
//!
//! ```text
//! Sizes    what the cost depends on: dofs, entries of K, M and L, modes, columns
//! Work     operations and bytes by the way they are spent, independent of the machine
//! Rates    seconds for each of these on one machine
//! ```
//! Decisions rest on [`Work`] alone and on nominal rates, so that they are the same on every machine; seconds are for people.

mod comparison;
mod expected;
mod forecast;
mod foreseen;
mod scan;
mod sizes;
mod stage;
mod work;

pub use comparison::{Band, Comparisons};
pub use expected::{Counting, ExpectedModes, Known};
pub use forecast::Forecast;
pub use foreseen::Foreseen;
pub(crate) use scan::{FOLLOWED, MAX_FLOPS, WIDEST_STEP, flops_of_a_point, points};
pub use sizes::{Proofs, Sizes};
pub use stage::{Need, Stage, stages};
pub use work::{NOMINAL, Rates, Work};
