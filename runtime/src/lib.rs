//! Superelements: the file that holds a finite element component reduced to its interface and a few modal amplitudes, and
//! the modal component that takes it through large motion.
//!
//! [`Superelement`] reads, checks and writes the file; [`component::ModalComponent`] turns it into forces and tangent
//! matrices for a multibody simulation; [`motion`] has the rigid-body motions both sides speak of. The crate does no
//! input or output but that of the file.
//!
//! # The format
//!
//! A superelement file is a [safetensors](https://github.com/huggingface/safetensors) container. Eight bytes hold the
//! length of the header (little-endian, unsigned, at most 100,000,000). The header is one JSON object in UTF-8, padded
//! with spaces to a multiple of eight: for each tensor its `dtype`, `shape` and `data_offsets`, and under
//! `__metadata__` the single key `supel`. The numbers of the tensors follow, little-endian, rows one after the other,
//! tensor after tensor without a gap up to the last byte of the file.
//!
//! With r reduced coordinates, k interface nodes, n_r rigid-body modes, n_modes frequencies and n_η modal amplitudes
//! the tensors are
//!
//! | name | shape | what |
//! |---|---|---|
//! | `stiffness`, `mass` | r × r | K̂ and M̂, symmetric to the bit |
//! | `rigid_body_modes` | r × n_r | Û; K̂ Û = 0 |
//! | `rigid_body_mass` | n_r × n_r | M_F = UᵀMU of the full model |
//! | `interface_positions` | k × 3 | nodes in the reference configuration |
//! | `interface_frames` | k × 3 × 3 | rotation matrices; columns are the node's axes |
//! | `frequencies` | n_modes | rad/s, ascending |
//! | `damping` | r × r | optional; skew parts are kept |
//! | `matrices` | m × r × r | optional: further matrices, by name and kind in the metadata |
//! | `mixing` | n_η × n_η | optional: stored dynamic modes = named modes · mixing |
//! | `gravity` | r × 3 | optional: loads of a unit gravity field along x, y, z |
//! | `load_vectors` | r × n_loads | optional |
//! | `recovery`, `recovery_dofs` | rows × r, rows × 2 | optional: basis rows, and the node label and direction (0 to 5) of each |
//! | `quantities` | m × r | optional: rows R Ψ of quantities that follow from displacements |
//! | `recovery_positions` | nodes × 3 | optional, with those: where the recovered nodes are, in the order of their first rows |
//! | `recovery_faces`, `recovery_face_offsets` | ids, faces + 1 | optional, with those: the surface between recovered nodes, see below |
//!
//! all of them 64-bit floating point, except `recovery_dofs` and the two of the faces (64-bit integers) and `recovery`, which may be
//! 32-bit where it is applied to the deformation only. No other tensor may occur. The reduced coordinates are displacements and
//! rotations of the interface nodes in the inertial frame, node by node, each node with any subset of ux, uy, uz, rx,
//! ry, rz; then interface rows of models that have no nodes; then the modal amplitudes. Units are those of the model.
//!
//! Face f of the mesh has the nodes `recovery_faces[recovery_face_offsets[f]..recovery_face_offsets[f + 1]]`, numbers from 0 of rows of
//! `recovery_positions`: three or four corners along the border, counterclockwise as seen from outside the cell of the mesh that the face
//! belongs to; behind them the nodes in the middles of the edges, if the mesh has some, from that between the first two corners on; and the
//! node in the middle. So 3, 6 and 7 nodes are a triangle, 4, 8 and 9 a quadrilateral.
//!
//! The text under `supel` is a JSON document that follows `schemas/superelement.schema.json`: `format_version` (`"1"`),
//! `blake3`, and the fields of [`Metadata`]: generator, method, what every coordinate is, what was dropped and why, the
//! model's mass properties, digests of the inputs, the resolved job, and what the verification said. `blake3` is the
//! BLAKE3 digest of the whole file in which the digest's own 64 characters are taken as the character zero. There are
//! no times and no unordered keys in the file: the same superelement gives the same bytes.
//!
//! A reader of this crate refuses every file that breaks one of these rules, with one variant of [`FileError`] for each.
//! It never allocates more than the size of the file calls for.
//!
//! # In Python
//!
//! ```python
//! tensors = safetensors.numpy.load_file("bracket.supel")
//! metadata = json.loads(safetensors.safe_open("bracket.supel", "numpy").metadata()["supel"])
//! ```
//!
//! # In Rust
//!
//! ```no_run
//! use supel_runtime::Superelement;
//!
//! let bracket = Superelement::open("bracket.supel".as_ref())?;
//! println!("{} coordinates, made by {}", bracket.n_coordinates(), bracket.metadata().generator.name);
//! # Ok::<(), supel_runtime::FileError>(())
//! ```
//!
//! # In a multibody simulation
//!
//! The simulation keeps the change of configuration H_j of each interface node, the modal amplitudes, and their material
//! velocities and accelerations. The component answers with forces: elastic + inertial + damping = external forces. They
//! do not depend on where the component is, and the tangent matrices hardly change: for small deformation
//! [`reference_stiffness`](component::ModalComponent::reference_stiffness) and
//! [`reference_mass`](component::ModalComponent::reference_mass) may be factored once for the whole simulation.
//!
//! ```no_run
//! use supel_runtime::Superelement;
//! use supel_runtime::component::{DeadLoad, FloatingFrame, ModalComponent, State};
//! use supel_runtime::motion::Motion;
//!
//! let bracket = Superelement::open("bracket.supel".as_ref())?;
//! let bracket = ModalComponent::new(&bracket, FloatingFrame::MassWeighted)?;
//! let mut workspace = bracket.workspace();
//!
//! // At rest, turned by one radian about the z axis of the inertial frame.
//! let motions = vec![Motion::exp(&[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]); bracket.n_nodes()];
//! let amplitudes = vec![0.0; bracket.n_modal()];
//! let rest = vec![0.0; bracket.n_coordinates()];
//! let state = State { motions: &motions, amplitudes: &amplitudes, velocities: &rest, accelerations: &rest };
//! bracket.evaluate(&state, &mut workspace)?;
//!
//! let mut external = bracket.gravity_forces(&[0.0, 0.0, -9.81], &mut workspace)?.to_vec();
//! let load = DeadLoad { node: 0, force: [0.0, 100.0, 0.0], moment: [0.0; 3] };
//! bracket.add_load(&load, &motions, &mut external)?;
//! let (elastic, inertial, damping) =
//!     (workspace.elastic_forces(), workspace.inertial_forces(), workspace.damping_forces());
//! let residual: Vec<f64> =
//!     (0..external.len()).map(|i| elastic[i] + inertial[i] + damping[i] - external[i]).collect();
//! # let _ = residual;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Where the deformation is large or the rotation fast, [`exact_tangents`](component::ModalComponent::exact_tangents) gives the whole
//! derivative of the forces, for Newton's method and for vibration about a steady motion. No tangent contains stress
//! stiffening inside a component: [what a component leaves out](component#what-a-component-leaves-out).
//! `examples/own_integrator.rs` moves one component with an integrator written by the client.
//!
//! A component cannot be changed and an evaluation allocates nothing: threads share components and have one workspace for
//! each component, and the results have the same bits for any number of threads.
//!
//! Programs in C use the component through `capi/supel.h` (feature `capi`).
//!
//! # Without the standard library
//!
//! With `default-features = false` the crate needs `core`, `alloc` and an atomic counter, for controllers without an operating system: bytes
//! become a superelement by [`Superelement::from_bytes`], and everything of the component and of [`motion`] is there. What is missing are
//! files ([`Superelement::open`], [`Superelement::write`], [`StagedFile`]) and the threads of
//! [`evaluate_all`](component::evaluate_all). Only [`Motion::exp`](motion::Motion::exp) may differ in its last bits: its sine is that of `libm`.

#![no_std]

#[macro_use]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

#[cfg(feature = "std")]
mod atomic_file;
#[cfg(feature = "capi")]
pub mod capi;
pub mod component;
mod container;
mod coordinate;
mod direction;
#[cfg(feature = "std")]
mod disk;
mod document;
mod elementary;
mod encoding;
mod error;
mod file;
mod further_matrix;
mod mass_properties;
mod matrix;
mod metadata;
pub mod motion;
mod recovered_faces;
mod strict_json;
mod superelement;
mod tensors;
mod validation;

#[cfg(feature = "std")]
pub use atomic_file::{StagedFile, StagedWriter, abandoned_parts, writer_of_part};
pub use container::begins_as_superelement;
pub use coordinate::Coordinate;
pub use direction::Direction;
#[cfg(feature = "std")]
pub use disk::file_bytes;
pub use document::FORMAT_VERSION;
pub use error::{FileError, Result};
pub use file::SealedBytes;
pub use further_matrix::{MatrixKind, NamedMatrix, Symmetry};
pub use mass_properties::mass_properties;
pub use matrix::Matrix;
pub use metadata::{
    CheckSummary, DropCause, DroppedColumn, Flag, Generator, InterfaceDof, InterfaceNode, MOTIONS, MassProperties,
    Metadata, Method, ModelSummary, Quantity, RigidBodyModes, Validity, Verdict, Verification,
};
pub use recovered_faces::RecoveredFaces;
pub use superelement::Superelement;
pub use tensors::{Precision, RecoveredDof, Recovery, Tensors};
