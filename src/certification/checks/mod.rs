//! The checks of a result.
//!
//! Their limits are those of practice: another program may stop its iteration earlier than this one does, and write fewer digits.

mod completeness;
mod frequencies;
mod list;
mod notes;
mod shapes;
mod subject;

pub(super) use list::checks;
pub(super) use notes::notes;
