//! Every way in which a superelement can be refused. Each has one variant, with the values that explain it.

use alloc::{string::String, vec::Vec};

#[cfg(feature = "std")]
use std::path::PathBuf;

use crate::direction::Direction;

/// The result of every fallible call of this crate.
pub type Result<T, E = FileError> = core::result::Result<T, E>;

/// Why a superelement file could not be read or written, or why its content is not a superelement.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    // ---- the file as a whole ---------------------------------------------------------------------------------------
    #[cfg(feature = "std")]
    /// The system refused to read the file.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    #[cfg(feature = "std")]
    /// The system refused to write the file.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    #[cfg(feature = "std")]
    /// The file has its name, but the system did not confirm that the folder is on the disk.
    #[error("{}: written, but the system did not confirm that it is on the disk: {source}; it may not outlive a power cut, write it again or sync the disk", path.display())]
    NotSynced {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    #[cfg(feature = "std")]
    /// One of several files could not be written, and what was written before it could not be taken back.
    #[error("{}: cannot be written: {source}; {left}", path.display())]
    HalfWritten {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
        /// Which files are new and where their old content is, in words.
        left: String,
    },
    #[cfg(feature = "std")]
    /// The name is that of a folder, a device or a pipe, or names no file at all.
    #[error("{}: is not a regular file; give the name of a superelement file", path.display())]
    NotAFile {
        /// The name.
        path: PathBuf,
    },
    #[cfg(feature = "std")]
    /// The file does not fit the memory.
    #[error("superelement file of {bytes} bytes does not fit the memory")]
    OutOfMemory {
        /// Size of the file.
        bytes: u64,
    },
    // ---- safetensors container -------------------------------------------------------------------------------------
    /// Fewer bytes than the length prefix takes.
    #[error("superelement file has {found} bytes; its length prefix alone takes 8: the file is cut off")]
    TooShort {
        /// Bytes in the file.
        found: usize,
    },
    /// The file is text.
    #[error("not a superelement file: found text that begins `{begins}` – give a .supel file written by supel reduce")]
    IsText {
        /// Its first letters.
        begins: String,
    },
    /// The header is longer than any reader of the format accepts.
    #[error(
        "not a superelement file: its first eight bytes would make a header of {found} bytes, at most {limit} are allowed – give a .supel file written by supel reduce"
    )]
    HeaderTooLarge {
        /// Length in the prefix, or of the metadata to be written.
        found: u64,
        /// The format's limit.
        limit: u64,
    },
    /// The file ends inside its header.
    #[error("superelement file ends inside its header: {found} bytes found, {expected} expected; the file is cut off")]
    HeaderTruncated {
        /// Bytes after the prefix.
        found: usize,
        /// Length in the prefix.
        expected: u64,
    },
    /// The header is not text.
    #[error("superelement file's header is not UTF-8 text at byte {offset}")]
    HeaderNotUtf8 {
        /// Offset from the start of the file.
        offset: usize,
    },
    /// The header is not one JSON object from its first byte on.
    #[error("superelement file's header is not a JSON object: {source}")]
    HeaderNotJson {
        /// Where and why.
        source: serde_json::Error,
    },
    /// The header does not begin with the brace of a JSON object.
    #[error("superelement file's header does not begin with an opening brace; this is not a safetensors file")]
    HeaderNotObject,
    /// A key occurs twice in one JSON object: readers would disagree which one counts.
    #[error("key `{key}` occurs twice in one object of the superelement file's {place}")]
    DuplicateKey {
        /// The key.
        key: String,
        /// Header or metadata.
        place: &'static str,
    },
    /// A safetensors file without the key `supel`.
    #[error("file has no text `supel` under `__metadata__`: it is a safetensors file, but not a superelement")]
    MetadataMissing,
    /// A foreign key in addition to `supel`.
    #[error("`__metadata__` holds `{key}` in addition to `supel`, which must be alone")]
    MetadataForeignKey {
        /// The key.
        key: String,
    },
    /// The description of a tensor is not `{dtype, shape, data_offsets}`.
    #[error("tensor `{tensor}`: {part} is missing, of the wrong kind, or not one of dtype, shape, data_offsets")]
    TensorEntry {
        /// Name of the tensor.
        tensor: String,
        /// Name of the part.
        part: String,
    },
    /// A number type that the format does not use.
    #[error("tensor `{tensor}` has number type `{found}`; a superelement uses F64, F32 and I64")]
    UnknownDtype {
        /// Name of the tensor.
        tensor: String,
        /// Type found.
        found: String,
    },
    /// A tensor that the format does not know.
    #[error("tensor `{tensor}` is not part of a superelement of this format version")]
    UnknownTensor {
        /// Name of the tensor.
        tensor: String,
    },
    /// A tensor that every superelement has is absent.
    #[error("tensor `{tensor}` is missing")]
    MissingTensor {
        /// Name of the tensor.
        tensor: &'static str,
    },
    /// A tensor has a known number type that is not its own.
    #[error("tensor `{tensor}` has number type {found}, expected {expected}")]
    WrongDtype {
        /// Name of the tensor.
        tensor: &'static str,
        /// Type found.
        found: &'static str,
        /// Types allowed.
        expected: &'static str,
    },
    /// The tensors do not follow each other without hole or overlap.
    #[error("tensor `{tensor}` begins at data byte {found}, expected {expected}: tensors must lie end to end")]
    TensorOffset {
        /// Name of the tensor.
        tensor: String,
        /// Where it begins.
        found: u64,
        /// Where the one before ends.
        expected: u64,
    },
    /// Shape times size of a number exceeds every memory.
    #[error("tensor `{tensor}`: the product of its shape overflows")]
    TensorOverflow {
        /// Name of the tensor.
        tensor: String,
    },
    /// The bytes given to a tensor are not those that its shape takes.
    #[error("tensor `{tensor}` occupies {found} bytes; its shape and number type take {expected}")]
    TensorSize {
        /// Name of the tensor.
        tensor: String,
        /// End minus begin of its data; negative when they are reversed.
        found: i128,
        /// Product of shape and size of a number.
        expected: u64,
    },
    /// The file is cut off in its data, or something follows them.
    #[error("superelement file holds {found} bytes of data, its header describes {expected}")]
    DataLength {
        /// Bytes after the header.
        found: u64,
        /// End of the last tensor.
        expected: u64,
    },
    // ---- metadata document -----------------------------------------------------------------------------------------
    /// The text under `supel` is not JSON.
    #[error("superelement metadata is not JSON: {source}")]
    MetadataNotJson {
        /// Where and why.
        source: serde_json::Error,
    },
    /// The metadata breaks its schema: a field is missing, unknown or of the wrong kind.
    #[error("superelement metadata does not follow its schema: {source}")]
    MetadataSchema {
        /// Where and why.
        source: serde_json::Error,
    },
    /// The file was written in a version of the format that this reader does not know.
    #[error(
        "superelement file has format version {found}; this reader knows version {expected}; reduce the model again"
    )]
    UnknownVersion {
        /// Version in the file.
        found: String,
        /// The version of this crate.
        expected: &'static str,
    },
    /// The digest is not 64 lower-case hexadecimal digits that stand in the header exactly once.
    #[error(
        "digest of the superelement file is malformed: 64 lower-case hexadecimal digits expected once in the header"
    )]
    DigestMalformed,
    /// The bytes are not those that were written.
    #[error(
        "superelement file is damaged: its bytes have BLAKE3 digest {found}, {expected} was recorded when it was written"
    )]
    DigestMismatch {
        /// Digest of the bytes.
        found: String,
        /// Digest in the metadata.
        expected: String,
    },
    // ---- content ---------------------------------------------------------------------------------------------------
    /// A matrix was given data of another size.
    #[error("matrix of {rows} × {cols} was given {found} values")]
    MatrixSize {
        /// Rows.
        rows: usize,
        /// Columns.
        cols: usize,
        /// Values given.
        found: usize,
    },
    /// A tensor's shape contradicts the coordinates or another tensor.
    #[error("tensor `{tensor}` has shape {found:?}, expected {expected:?} after the coordinates and the other tensors")]
    WrongShape {
        /// Name of the tensor.
        tensor: &'static str,
        /// Shape found.
        found: Vec<usize>,
        /// Shape expected.
        expected: Vec<usize>,
    },
    /// A tensor is a vector where a matrix is expected, or the like.
    #[error("tensor `{tensor}` has shape {found:?}, expected one of {expected} dimensions")]
    WrongRank {
        /// Name of the tensor.
        tensor: &'static str,
        /// Shape found.
        found: Vec<usize>,
        /// Number of dimensions expected.
        expected: usize,
    },
    /// An infinity or a NaN among the values.
    #[error("tensor `{tensor}` is not finite at entry {index} (row-major, from 0): {value}")]
    NotFinite {
        /// Name of the tensor.
        tensor: &'static str,
        /// Number of the entry in row-major order.
        index: usize,
        /// The value.
        value: f64,
    },
    /// Entries (i, j) and (j, i) differ.
    #[error("tensor `{tensor}` is not symmetric: ({row}, {col}) is {upper:e}, ({col}, {row}) is {lower:e}")]
    NotSymmetric {
        /// Name of the tensor.
        tensor: &'static str,
        /// Row of the upper entry.
        row: usize,
        /// Column of the upper entry.
        col: usize,
        /// Upper entry.
        upper: f64,
        /// Lower entry.
        lower: f64,
    },
    /// A number of the metadata is infinite or NaN, which JSON cannot hold.
    #[error("metadata `{field}` is not finite")]
    MetadataNotFinite {
        /// Path of the field.
        field: String,
    },
    /// Two interface nodes cannot be told apart.
    #[error("interface node `{name}` (label {label:?}) occurs twice")]
    InterfaceDuplicate {
        /// Name of the node.
        name: String,
        /// Label of the node.
        label: Option<i64>,
    },
    /// The degrees of freedom of an interface node are not a strictly ascending choice of the six.
    #[error(
        "interface node `{name}` lists its dofs out of order, twice, or not at all; give a choice of ux uy uz rx ry rz in this order"
    )]
    InterfaceDofs {
        /// Name of the node.
        name: String,
    },
    /// Metadata and tensor place an interface node differently.
    #[error("interface node `{name}` is at {metadata:?} in the metadata and at {tensor:?} in `interface_positions`")]
    InterfacePosition {
        /// Name of the node.
        name: String,
        /// Position in the metadata.
        metadata: [f64; 3],
        /// Position in the tensor.
        tensor: [f64; 3],
    },
    /// The frame of an interface node is not a rotation.
    #[error("frame of interface node `{name}` is not a rotation matrix")]
    InterfaceFrame {
        /// Name of the node.
        name: String,
    },
    /// The coordinates are not the interface nodes' dofs in order, then interface rows, then modal amplitudes.
    #[error(
        "coordinate {coordinate} (from 0) is out of place: first the dofs of the interface nodes in their order, then interface rows, then modes"
    )]
    CoordinateOrder {
        /// Number of the coordinate.
        coordinate: usize,
    },
    /// A modal coordinate names a mode without frequency, or one that another coordinate names too.
    #[error(
        "coordinate {coordinate} (from 0) names mode {mode}, which another coordinate names too or which is not among {n_modes} frequencies"
    )]
    CoordinateMode {
        /// Number of the coordinate.
        coordinate: usize,
        /// Number of the mode.
        mode: usize,
        /// Length of `frequencies`.
        n_modes: usize,
    },
    /// A coordinate is the residual vector of a load that is not there, or that has another one.
    #[error(
        "coordinate {coordinate} (from 0) is the residual vector of load {load}, which another coordinate is too or which is not among {n_loads} loads"
    )]
    CoordinateLoad {
        /// Number of the coordinate.
        coordinate: usize,
        /// Number of the load.
        load: usize,
        /// How many loads the file has.
        n_loads: usize,
    },
    /// Metadata and tensor give a mode different frequencies.
    #[error(
        "coordinate {coordinate} (from 0) has {frequency_hz} Hz in the metadata, `frequencies` holds {omega} rad/s"
    )]
    CoordinateFrequency {
        /// Number of the coordinate.
        coordinate: usize,
        /// Frequency in the metadata.
        frequency_hz: f64,
        /// Angular frequency in the tensor.
        omega: f64,
    },
    /// The frequencies are negative or do not ascend.
    #[error("`frequencies` must be ascending and not negative; mode {mode} (from 0) has {omega} rad/s")]
    FrequencyOrder {
        /// Number of the mode.
        mode: usize,
        /// Angular frequency.
        omega: f64,
    },
    /// The direction along which gravity may act is infinite or not a number.
    #[error("`validity.gravity` is infinite or not a number, expected a direction, or zero for none")]
    GravityDirection,
    /// A dof that is declared unloaded does not belong to the interface.
    #[error("`validity.unloaded` names {direction:?} of interface node {node} (from 0), which has no such dof")]
    UnloadedDof {
        /// Number of the interface node.
        node: usize,
        /// Direction.
        direction: Direction,
    },
    /// The coordinates held while modes were computed are no interface coordinates, or not in ascending order.
    #[error(
        "`modes_held` names coordinate {coordinate} (from 0), which is out of order or beyond the {n_interface} interface coordinates"
    )]
    ModesHeld {
        /// The coordinate.
        coordinate: usize,
        /// Number of interface coordinates.
        n_interface: usize,
    },
    /// Number of names and of load vectors differ.
    #[error("{names} load names for {vectors} load vectors")]
    LoadNames {
        /// Names in the metadata.
        names: usize,
        /// Columns of the tensor.
        vectors: usize,
    },
    /// Number of named quantities and of their rows differ.
    #[error("{names} named quantities for {rows} rows of `quantities`")]
    QuantityNames {
        /// Quantities in the metadata.
        names: usize,
        /// Rows of the tensor.
        rows: usize,
    },
    /// Number of named further matrices and of the matrices of the tensor differ.
    #[error("{names} named matrices for {matrices} of `matrices`")]
    MatrixNames {
        /// Matrices in the metadata.
        names: usize,
        /// Matrices of the tensor.
        matrices: usize,
    },
    /// A further matrix has no name, or that of another one.
    #[error("further matrix {name:?}: no name, or that of another one")]
    MatrixName {
        /// The name.
        name: String,
    },
    /// A matrix that its kind says to be skew is not.
    #[error("matrix {name:?} is not skew: ({row}, {col}) is {upper:e}, ({col}, {row}) is {lower:e}")]
    NotSkew {
        /// Name of the matrix.
        name: String,
        /// Row of the upper entry.
        row: usize,
        /// Column of the upper entry.
        col: usize,
        /// Upper entry.
        upper: f64,
        /// Lower entry.
        lower: f64,
    },
    /// Only one of `recovery` and `recovery_dofs` is there, or positions or faces without what they belong to.
    #[error(
        "`recovery` and `recovery_dofs` belong together, `recovery_positions` to both, and `recovery_faces` with \
         `recovery_face_offsets` to all; `{missing}` is missing"
    )]
    RecoveryIncomplete {
        /// The absent one.
        missing: &'static str,
    },
    /// A recovered row has a direction that is none of the six.
    #[error("row {row} (from 0) of `recovery_dofs` has direction {direction}; expected 0 to 5 for ux to rz")]
    RecoveryDirection {
        /// Number of the row.
        row: usize,
        /// Direction found.
        direction: i64,
    },
    /// A face between recovered nodes is none.
    #[error("face {face} (from 0) of `recovery_faces` has {found}")]
    RecoveryFace {
        /// Number of the face.
        face: usize,
        /// What is wrong with it.
        found: String,
    },
    /// The offsets of faces do not begin at zero or do not end with the last of the nodes.
    #[error("`recovery_face_offsets` has to begin with 0 and to end with {n_ids}, the length of `recovery_faces`")]
    RecoveryFaceOffsets {
        /// Length of `recovery_faces`.
        n_ids: usize,
    },
    /// The overall verdict is better than that of a check.
    #[error("the verdict of the verification is better than that of its check {check}")]
    Verdict {
        /// Identifier of the check.
        check: String,
    },
    /// A digest of an input file is not 64 lower-case hexadecimal digits.
    #[error("digest of input `{name}` is not 64 lower-case hexadecimal digits")]
    InputDigest {
        /// Name of the input.
        name: String,
    },
}

impl FileError {
    /// True where the system failed, false where the content is wrong.
    #[cfg(feature = "std")]
    pub fn is_io(&self) -> bool {
        matches!(
            self,
            Self::Read { .. }
                | Self::Write { .. }
                | Self::NotSynced { .. }
                | Self::HalfWritten { .. }
                | Self::NotAFile { .. }
        )
    }
}
