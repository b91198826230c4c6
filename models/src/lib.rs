//! Deterministic finite element models for the tests and examples of supel.
//!
//! Every model is computed, none is read: the same arguments give the same bits on every machine that rounds as
//! IEEE 754 says. Families with a closed-form spectrum ([`mod@bar`], [`spring`], [`ring`], [`mod@known`]) come with it; the
//! solids ([`brick`], [`hexahedra`], [`tetrahedra`]), membranes ([`mod@membrane`]), shells ([`mod@shell`]) and frames ([`mod@frame`]) carry their rigid-body modes to
//! rounding. [`mod@part`] makes three of them in any size for benchmarks. [`superelements`]
//! are what programs that simulate read. [`transform`] turns one model into another: joined, scaled, rounded.

pub mod bar;
pub mod bracket;
pub mod dense;
pub mod element;
mod files;
pub mod frame;
pub mod hexahedra;
pub mod known;
#[cfg(feature = "med")]
pub mod med;
pub mod membrane;
pub mod model;
pub mod part;
pub mod random;
pub mod shell;
pub mod springs;
pub mod superelements;
pub mod tetrahedra;
pub mod tetrahedron;
pub mod transform;
pub mod two_node;
pub mod write;

pub use bar::{Ends, bar, bar_spectrum, ring, ring_spectrum, spring, spring_spectrum};
pub use bracket::{bracket, bracket_mesh};
pub use dense::spectrum;
pub use frame::{Inertia, Section, frame};
pub use hexahedra::{HexMesh, brick};
pub use known::known;
pub use membrane::membrane;
pub use model::{Assembler, Material, Model};
pub use part::{Family, Part};
pub use random::{SplitMix64, fnv1a};
pub use shell::{Wall, shell};
pub use tetrahedra::TetMesh;
