//! Input decks of Abaqus and CalculiX (`.inp`): nodes, elements, sets and surfaces, in files included from the folder of the deck too.
//!
//! A deck is read once, line by line. What it says of the mesh goes into a [`scope::Scope`]: one for a flat deck, one for each part and
//! instance otherwise. Sets are resolved at the end, when all nodes and elements are known.

mod assembly;
mod elements;
mod keyword;
mod lines;
mod read;
mod resolved;
mod scope;
mod sections;
mod surfaces;
mod transforms;

pub(super) use lines::{digest_of_included, included_files};
pub(in crate::input) use read::n_incompatible;
pub(super) use read::{read, sureness};
