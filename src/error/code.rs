//! What scripts know an error by: its code and its class.

use supel_runtime::FileError;

use super::Error;

/// The class of an [`Error`]; its number is the exit code of the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorClass {
    /// The command line or the job document is wrong.
    Usage = 2,
    /// A file's content is wrong.
    InputData = 3,
    /// The matrices do not describe a component that can be reduced as asked.
    ModelPhysics = 4,
    /// The arithmetic cannot give what was asked.
    NumericalLimit = 5,
    /// Not enough memory.
    Resources = 6,
    /// A file could not be read or written.
    Io = 7,
}

/// The code of a command line that cannot be read at all; no [`Error`] has it.
pub const USAGE_CODE: &str = "E-USAGE";
/// The code of a defect of the program; no [`Error`] has it.
pub const INTERNAL_CODE: &str = "E-INTERNAL";

/// One line for each variant, so that a new one cannot be forgotten.
macro_rules! codes {
    ($($variant:ident => $code:literal, $class:ident;)*) => {
        impl Error {
            /// Variant, code and class of every error, in the order of the enum.
            pub const CODES: &[(&str, &str, ErrorClass)] =
                &[$((stringify!($variant), $code, ErrorClass::$class)),*];

            /// The code of this error, for scripts; `docs/errors.md` has a line for each.
            pub fn code(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => $code,)*
                }
            }

            /// The class of this error, which is its exit code.
            pub fn class(&self) -> ErrorClass {
                match self {
                    Self::SuperelementFile { source: FileError::OutOfMemory { .. }, .. } => ErrorClass::Resources,
                    // The system has no memory for itself.
                    Self::Read { source, .. } | Self::Write { source, .. }
                        if source.kind() == std::io::ErrorKind::OutOfMemory =>
                    {
                        ErrorClass::Resources
                    }
                    $(Self::$variant { .. } => ErrorClass::$class,)*
                }
            }
        }
    };
}

codes! {
    Read => "E-READ", Io;
    Write => "E-WRITE", Io;
    NoFolder => "E-FOLDER", Io;
    NotSynced => "E-SYNC", Io;
    HalfWritten => "E-HALF-WRITTEN", Io;
    Answer => "E-STDOUT", Io;
    NotAFile => "E-NOT-A-FILE", InputData;
    Changed => "E-CHANGED", Io;
    NotText => "E-UTF8", InputData;
    MemoryRead => "E-MEM-READ", Resources;
    FormatNotRead => "E-FORMAT", InputData;
    GzipDamaged => "E-GZIP", InputData;
    GzipInflation => "E-GZIP-BOMB", InputData;
    LineTooLong => "E-LINE", InputData;
    NoData => "E-NO-DATA", InputData;
    MatrixBanner => "E-BANNER", InputData;
    MatrixFlavour => "E-FLAVOUR", InputData;
    MatrixSizeLine => "E-SIZE-LINE", InputData;
    MatrixNotSquare => "E-DIM-SQUARE", InputData;
    MatrixOrder => "E-DIM-ORDER", InputData;
    MatrixMostlyEmpty => "E-MOSTLY-EMPTY", InputData;
    EntryField => "E-ENTRY", InputData;
    EntryExcess => "E-ENTRY-EXCESS", InputData;
    EntryIndex => "E-INDEX", InputData;
    NonFinite => "E-NONFINITE", InputData;
    EntryCount => "E-NNZ", InputData;
    EntriesSurplus => "E-NNZ-SURPLUS", InputData;
    Duplicates => "E-DUPLICATES", InputData;
    DoubleTriangle => "E-DOUBLE-TRIANGLE", InputData;
    SameMatrix => "E-SAME-MATRIX", InputData;
    SizeMismatch => "E-DIM", InputData;
    TableColumn => "E-TABLE-COLUMN", InputData;
    TableRow => "E-TABLE-ROW", InputData;
    TableField => "E-TABLE-FIELD", InputData;
    NodeRepeated => "E-NODE-REPEATED", InputData;
    NodeRange => "E-NODE-RANGE", InputData;
    DofText => "E-MAP-TEXT", InputData;
    DofDirection => "E-MAP-DIRECTION", InputData;
    DofRepeated => "E-MAP-REPEATED", InputData;
    DofRowOrder => "E-MAP-ORDER", InputData;
    DofCount => "E-MAP-COUNT", InputData;
    DofNodeMissing => "E-MAP-NODE", InputData;
    DofOrderUnknown => "E-MAP-NEEDED", InputData;
    FeatureMissing => "E-FEATURE", Usage;
    Hdf5Signature => "E-HDF5-SIGNATURE", InputData;
    Hdf5Open => "E-HDF5-OPEN", InputData;
    Hdf5Crash => "E-HDF5-CRASH", InputData;
    Hdf5Time => "E-HDF5-TIME", InputData;
    RehearsalKilled => "E-CHILD-KILLED", Resources;
    Rehearsal => "E-CHILD", Resources;
    Hdf5Read => "E-HDF5-READ", InputData;
    Hdf5Missing => "E-HDF5-MISSING", InputData;
    Hdf5Link => "E-HDF5-LINK", InputData;
    Hdf5ExternalStorage => "E-HDF5-EXTERNAL", InputData;
    Hdf5Filter => "E-HDF5-FILTER", InputData;
    Hdf5Size => "E-HDF5-SIZE", InputData;
    Hdf5Depth => "E-HDF5-DEPTH", InputData;
    Hdf5Type => "E-HDF5-TYPE", InputData;
    Hdf5Value => "E-HDF5-VALUE", InputData;
    Hdf5Shape => "E-HDF5-SHAPE", InputData;
    Hdf5NoMatrix => "E-HDF5-NO-MATRIX", InputData;
    Hdf5AmbiguousMatrix => "E-HDF5-AMBIGUOUS", InputData;
    Hdf5EmptyMatrix => "E-HDF5-EMPTY", InputData;
    Hdf5NotSquare => "E-HDF5-SQUARE", InputData;
    Hdf5Pointer => "E-HDF5-POINTER", InputData;
    Hdf5Index => "E-HDF5-INDEX", InputData;
    Hdf5NotFinite => "E-HDF5-NONFINITE", InputData;
    MeshUnknown => "E-MESH", InputData;
    MeshNotOne => "E-MESH-NOT-ONE", InputData;
    MeshUnsupported => "E-MESH-UNSUPPORTED", InputData;
    MeshNotFinite => "E-MESH-NONFINITE", InputData;
    MeshLabelTwice => "E-MESH-LABEL", InputData;
    XdmfSyntax => "E-XDMF", InputData;
    XdmfSize => "E-XDMF-SIZE", InputData;
    XdmfReference => "E-XDMF-REFERENCE", InputData;
    JobSyntax => "E-JOB", Usage;
    JobKey => "E-JOB-KEY", Usage;
    JobNumber => "E-ARG", Usage;
    JobEmpty => "E-JOB-EMPTY", Usage;
    InterfaceTwice => "E-INTERFACE-NAME", Usage;
    SceneInterface => "E-SCENE-INTERFACE", Usage;
    InterfaceRepeats => "E-DUP-INTERFACE", Usage;
    InterfaceOverlap => "E-INTERFACE-OVERLAP", Usage;
    InterfaceNodes => "E-INTERFACE-NODES", Usage;
    InterfaceConflict => "E-INTERFACE-KEY", Usage;
    OutputName => "E-OUTPUT-NAME", Usage;
    OutputIsInput => "E-OVERWRITE", Usage;
    OutputTwice => "E-OUTPUT-TWICE", Usage;
    OutputKind => "E-OUTPUT-KIND", Io;
    MissingFlags => "E-FLAGS", Usage;
    FlagText => "E-FLAG-TEXT", Usage;
    OtherVersion => "E-OTHER-VERSION", Usage;
    KeptJob => "E-KEPT-JOB", Usage;
    Threads => "E-THREADS", Resources;
    Unsymmetric => "E-UNSYMMETRIC", InputData;
    Swapped => "E-SWAPPED", InputData;
    NoMass => "E-NO-MASS", InputData;
    IndefiniteMass => "E-INDEF-MASS", ModelPhysics;
    UnitRange => "E-RANGE", InputData;
    RecoveryRange => "E-RECOVERY-RANGE", InputData;
    EmptyRows => "E-EMPTY-ROWS", InputData;
    MultiplierRow => "E-LAGRANGE", InputData;
    NegativeStiffness => "E-NEG-DIAG", ModelPhysics;
    NegativeMass => "E-NEG-MASS", ModelPhysics;
    CoordinatesDoNotFit => "E-COORD", InputData;
    RotationsHeld => "E-ROTATIONS-HELD", InputData;
    NegativeRigidEnergy => "E-NEG-RIGID", ModelPhysics;
    MasslessRigidMotion => "E-RIGID-MASS", ModelPhysics;
    MasslessFreeMotion => "E-FREE-MASSLESS", ModelPhysics;
    DenseEigen => "E-DENSE-EIGEN", NumericalLimit;
    MasslessMechanism => "E-MASSLESS-MECHANISM", ModelPhysics;
    InterfaceTooLarge => "E-INTERFACE-SIZE", InputData;
    SelectionNeedsNodes => "E-NO-NODES", InputData;
    RigidNeedsCoordinates => "E-NO-COORDINATES", InputData;
    UnknownGroup => "E-GROUP", InputData;
    EmptyInterface => "E-INTERFACE-EMPTY", InputData;
    InterfaceNodeWithoutRows => "E-CONSTRAINED-INTERFACE", InputData;
    DofMissing => "E-DOF-MISSING", InputData;
    InterfaceRow => "E-INTERFACE-ROW", InputData;
    DofTwice => "E-DOF-TWICE", InputData;
    PatchRank => "E-PATCH-RANK", InputData;
    FloatingBody => "E-FLOATING-BODY", ModelPhysics;
    InterfaceRank => "E-INTERFACE-RANK", ModelPhysics;
    DigitsTooFew => "E-DATA-PRECISION", InputData;
    NotDefinite => "E-NOT-DEFINITE", ModelPhysics;
    IndefiniteStiffness => "E-NEGATIVE-STIFFNESS", ModelPhysics;
    MemoryForecast => "E-MEM", Resources;
    MemoryComparison => "E-MEM-VERIFY", Resources;
    OutOfMemory => "E-OUT-OF-MEMORY", Resources;
    NotRefined => "E-NOT-REFINED", NumericalLimit;
    SturmPivot => "E-STURM-PIVOT", NumericalLimit;
    LanczosStalled => "E-STALLED", NumericalLimit;
    Mechanism => "E-MECHANISM", ModelPhysics;
    ModesMissing => "E-MODES-MISSING", NumericalLimit;
    EigensolverMissing => "E-NO-ARPACK", Usage;
    Arpack => "E-ARPACK", NumericalLimit;
    SuperelementFile => "E-SUPERELEMENT", InputData;
}
