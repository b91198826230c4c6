//! Meshes of Gmsh (`.msh`), versions 2.2 and 4.1, in text and binary.
//!
//! Physical groups become groups of nodes by their names. A group without a name is called by its dimension and number, as `surface 7`.

mod element_kind;
mod entities;
mod read;

pub(in crate::input) use read::begins;
pub(super) use read::{read, sureness};
