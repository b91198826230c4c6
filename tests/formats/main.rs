//! The formats of other programs: matrices and meshes, each from files that those programs wrote, and from damaged ones.

#[cfg(feature = "hdf5")]
mod corpus;
mod matrices;
mod meshes;
