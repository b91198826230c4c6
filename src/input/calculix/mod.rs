//! Models in which CalculiX has made solids of shells, beams and cells in the plane.
//!
//! CalculiX expands such elements: each of their nodes becomes several, through the thickness or around the section. In its dof map
//! (`.dof`) rows of all of these carry the label of the node in the deck, so that labels repeat. Two files that CalculiX writes next to the
//! map tell the rest: `JOB.12d` which nodes an element was given, and `JOB.frd` where they are, if the deck asks for it by
//! `*NODE OUTPUT, OUTPUT=3D` in a step before the one that stores the matrices.
//!
//! Elements of incompatible modes (`C3D8I`, and what linear shells and beams become) have three more nodes each, which stand for amplitudes
//! and move no point of the mesh.

mod expanded_map;
mod expansion;
mod rebuilt;

pub(super) use rebuilt::{digests_next_to, rebuilt};
