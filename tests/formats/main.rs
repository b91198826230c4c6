//! The formats of other programs: matrices and meshes, each from files that those programs wrote, and from damaged ones.

mod corpus;
mod matrices;
mod meshes;
