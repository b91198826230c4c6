//! What several test programs of supel share: the stages run on generated models, dense twins to judge them by, the command
//! line run in folders of its own, reports to render, VTK to read files, and the way to a corpus of real models.
//!
//! Only programs in `tests/` may use it. Unit tests of `src` are compiled into another copy of the crate `supel`, whose types are
//! not those that stand here.

#![allow(missing_docs, reason = "names and tests say it")]

pub mod cases;
pub mod chain;
pub mod corpus;
pub mod evidence;
pub mod pencil;
pub mod place;
pub mod sample;
pub mod schema;
pub mod sources;
pub mod vtk;
