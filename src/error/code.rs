//! What scripts and documents know an error by: its code, its class, its meaning and its remedy.

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

/// What is known of an error without its values; `docs/errors.md` is made from these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ErrorEntry {
    /// Its name in the enum.
    pub variant: &'static str,
    /// Its code, which never changes its meaning.
    pub code: &'static str,
    /// Its class, which is the exit code.
    pub class: ErrorClass,
    /// What is wrong.
    pub what: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

/// Code, class, meaning and remedy of each variant; one that is forgotten does not compile.
macro_rules! codes {
    ($($variant:ident => $code:literal, $class:ident, $what:literal, $remedy:literal;)*) => {
        impl Error {
            /// Every error, in the order of the enum.
            pub const CODES: &[ErrorEntry] = &[$(ErrorEntry {
                variant: stringify!($variant),
                code: $code,
                class: ErrorClass::$class,
                what: $what,
                remedy: $remedy,
            }),*];

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
    Read => "E-READ", Io,
        "a file cannot be opened or read",
        "check the path and the permissions; the system's reason is in the message";
    Write => "E-WRITE", Io,
        "a file cannot be written",
        "check that the folder exists, is writable and has room";
    NoFolder => "E-FOLDER", Io,
        "the folder of an output does not exist or takes no files",
        "create it, or give the output another place";
    NotSynced => "E-SYNC", Io,
        "the outputs are written, but the system did not confirm that they are on the disk",
        "sync the disk or write them again; they may not outlive a power cut";
    HalfWritten => "E-HALF-WRITTEN", Io,
        "an output cannot be written, and those before it cannot be taken back",
        "the message says which files are new and where their old content is: put it back or run again";
    Answer => "E-STDOUT", Io,
        "the answer could not be written to stdout; files were written all the same",
        "give stdout a place with room; `reduce` and `verify` give no answer with `--quiet`";
    NotAFile => "E-NOT-A-FILE", InputData,
        "a path is a folder, a pipe, a device or made up by the kernel",
        "give a regular file; write a pipe to disk first";
    Changed => "E-CHANGED", Io,
        "a file was written, cut or exchanged while it was read",
        "wait until it is written and run again";
    NotText => "E-UTF8", InputData,
        "an XDMF file is not UTF-8; rows of a table that are not end with E-TABLE-FIELD, and matrices, dof maps and comments may hold any bytes where no number belongs",
        "write it as UTF-8";
    MemoryRead => "E-MEM-READ", Resources,
        "what the input files hold does not fit into the memory",
        "free memory, raise `run.memory_gib` or reduce a smaller model";
    FormatNotRead => "E-FORMAT", InputData,
        "a file of a known format that is not read: NumPy, MATLAB before 7.3, Gmsh, an input deck, CalculiX results, zip",
        "convert it as the message says";
    GzipDamaged => "E-GZIP", InputData,
        "gzipped data are damaged or cut short",
        "copy or create the file again";
    GzipInflation => "E-GZIP-BOMB", InputData,
        "gzipped data inflate more than a table of numbers can",
        "check where the file comes from";
    LineTooLong => "E-LINE", InputData,
        "a line is longer than any line of numbers",
        "check that the file is text";
    NoData => "E-NO-DATA", InputData,
        "a text file holds no data",
        "export it again; the message says what belongs there";
    MatrixBanner => "E-BANNER", InputData,
        "the first line of a matrix is neither a Matrix Market banner nor numbers",
        "write `%%MatrixMarket matrix coordinate real symmetric`, or lines `row column value`";
    MatrixFlavour => "E-FLAVOUR", InputData,
        "a Matrix Market flavour other than coordinate, real or integer, symmetric or general",
        "export a real coordinate matrix; complex and pattern matrices are no stiffness or mass";
    MatrixSizeLine => "E-SIZE-LINE", InputData,
        "the size line of a matrix cannot be read",
        "write `rows columns entries` below the banner";
    MatrixNotSquare => "E-DIM-SQUARE", InputData,
        "a matrix is rectangular",
        "export K and M as square matrices";
    MatrixOrder => "E-DIM-ORDER", InputData,
        "a matrix has no rows, or more than 2³¹ − 1",
        "check the size line and the largest index";
    MatrixMostlyEmpty => "E-MOSTLY-EMPTY", InputData,
        "a large matrix has hardly any entries",
        "check the size line and the indices";
    EntryField => "E-ENTRY", InputData,
        "a field of an entry is not a number",
        "correct the line; decimal commas are not read";
    EntryExcess => "E-ENTRY-EXCESS", InputData,
        "a line goes on after the value",
        "leave one entry on a line";
    EntryIndex => "E-INDEX", InputData,
        "an index is 0 or larger than the matrix",
        "count rows and columns from 1";
    NonFinite => "E-NONFINITE", InputData,
        "a matrix entry is NaN or infinite",
        "find out why the finite element program wrote it";
    EntryCount => "E-NNZ", InputData,
        "a file holds fewer entries than it declares",
        "the file is cut short: export or copy it again";
    EntriesSurplus => "E-NNZ-SURPLUS", InputData,
        "a file holds more entries than it declares",
        "correct the size line or export again";
    Duplicates => "E-DUPLICATES", InputData,
        "entries repeat a position, with `--strict` or `duplicates = \"refuse\"`",
        "assemble the matrix before exporting it, or leave both out: repeated entries are then added";
    DoubleTriangle => "E-DOUBLE-TRIANGLE", InputData,
        "a matrix declared symmetric has entries on both sides of the diagonal",
        "write one triangle, declare the matrix general, or say which triangle holds with `model.symmetric` (`reduce --symmetric`)";
    SameMatrix => "E-SAME-MATRIX", InputData,
        "K and M are one matrix",
        "give the file of the other one";
    SizeMismatch => "E-DIM", InputData,
        "K and M differ in size",
        "export both for the same degrees of freedom";
    TableColumn => "E-TABLE-COLUMN", InputData,
        "a table lacks a column",
        "name the columns as the message says";
    TableRow => "E-TABLE-ROW", InputData,
        "a row of a table has fewer or more fields than its header",
        "give each column one field; decimals take a point";
    TableField => "E-TABLE-FIELD", InputData,
        "a field of a table cannot be read",
        "correct it; decimals take a point";
    NodeRepeated => "E-NODE-REPEATED", InputData,
        "a node is listed twice",
        "list each node once";
    NodeRange => "E-NODE-RANGE", InputData,
        "coordinates are so large or so small that their squares leave the range of double precision",
        "check the number, or write the nodes in other units";
    DofText => "E-MAP-TEXT", InputData,
        "a line of a dof map is not `node.direction`",
        "write for example 412.1";
    DofDirection => "E-MAP-DIRECTION", InputData,
        "a direction of a dof map does not exist",
        "write 1 to 6 or ux to rz";
    DofRepeated => "E-MAP-REPEATED", InputData,
        "two rows of a dof map are the same degree of freedom",
        "give every row its own; renumber nodes that the program repeats, or go on by rows, without map and nodes";
    DofRowOrder => "E-MAP-ORDER", InputData,
        "row numbers of a dof map are not in order",
        "sort the map by row; every row of the matrices needs one";
    DofCount => "E-MAP-COUNT", InputData,
        "a dof map is longer or shorter than the matrices",
        "export map and matrices together";
    DofNodeMissing => "E-MAP-NODE", InputData,
        "a node of the dof map has no position",
        "add it to the nodes, leave the nodes out, or go on by rows";
    DofOrderUnknown => "E-MAP-NEEDED", InputData,
        "without a dof map the counts do not say what the rows are",
        "give a dof map with `model.dofs` (`reduce --dofs`)";
    FeatureMissing => "E-FEATURE", Usage,
        "the program was built without what a file needs",
        "rebuild with the feature that the message names";
    Hdf5Signature => "E-HDF5-SIGNATURE", InputData,
        "a file that should be HDF5 is something else",
        "give the file that the name promises";
    Hdf5Open => "E-HDF5-OPEN", InputData,
        "an HDF5 file is damaged",
        "write or copy it again";
    Hdf5Crash => "E-HDF5-CRASH", InputData,
        "the HDF5 library crashes on a damaged file, in the child process that reads it first",
        "copy or create the file again";
    Hdf5Time => "E-HDF5-TIME", InputData,
        "the HDF5 library was still reading a file long after it should have been done",
        "look at it with h5dump; write or copy it again";
    RehearsalKilled => "E-CHILD-KILLED", Resources,
        "the child process that reads HDF5 input first was ended from outside, as the system does when memory runs out",
        "free memory and run again";
    Rehearsal => "E-CHILD", Resources,
        "the child process that reads HDF5 input first cannot be started",
        "free processes or memory; the system's reason is in the message";
    Hdf5Read => "E-HDF5-READ", InputData,
        "an object of an HDF5 file cannot be read",
        "write or copy the file again; the library's reason is in the message";
    Hdf5Missing => "E-HDF5-MISSING", InputData,
        "a group, dataset or attribute is not there",
        "check the path after the colon";
    Hdf5Link => "E-HDF5-LINK", InputData,
        "a path leads through a soft or external link",
        "give the path of the object itself";
    Hdf5ExternalStorage => "E-HDF5-EXTERNAL", InputData,
        "a dataset keeps its values in other files",
        "repack the file with h5repack";
    Hdf5Filter => "E-HDF5-FILTER", InputData,
        "a dataset is compressed in a way that is not read",
        "rewrite it with `h5repack -f GZIP=4`";
    Hdf5Size => "E-HDF5-SIZE", InputData,
        "a dataset promises more than its bytes can hold",
        "the file is damaged or was never finished: write it again";
    Hdf5Depth => "E-HDF5-DEPTH", InputData,
        "groups are nested or numerous beyond reason",
        "write the file again; its groups may contain themselves";
    Hdf5Type => "E-HDF5-TYPE", InputData,
        "an object or value has the wrong type",
        "store it as the message says";
    Hdf5Value => "E-HDF5-VALUE", InputData,
        "a number cannot be read as it is: an unsigned one of 2⁶³ or more, or a whole one that no double equals",
        "store real numbers as 64-bit floats, indices as signed integers";
    Hdf5Shape => "E-HDF5-SHAPE", InputData,
        "a dataset has the wrong length or shape",
        "store it as the message says";
    Hdf5NoMatrix => "E-HDF5-NO-MATRIX", InputData,
        "there is no sparse matrix where one was looked for",
        "give its group after a colon, as in model.h5:/K";
    Hdf5AmbiguousMatrix => "E-HDF5-AMBIGUOUS", InputData,
        "several matrices could be meant",
        "choose one, as in model.h5:/K";
    Hdf5EmptyMatrix => "E-HDF5-EMPTY", InputData,
        "a matrix has no rows",
        "check what was exported";
    Hdf5NotSquare => "E-HDF5-SQUARE", InputData,
        "a matrix is not square or too large",
        "export K and M as square matrices";
    Hdf5Pointer => "E-HDF5-POINTER", InputData,
        "row or column pointers do not rise from zero to the number of entries",
        "write the matrix again";
    Hdf5Index => "E-HDF5-INDEX", InputData,
        "an index lies outside the matrix or the mesh",
        "write the matrix or mesh again";
    Hdf5NotFinite => "E-HDF5-NONFINITE", InputData,
        "a matrix entry is NaN or infinite",
        "find out why the finite element program wrote it";
    MeshUnknown => "E-MESH", InputData,
        "no known mesh is in the file",
        "give a .med, .h5m, .hmf or XDMF mesh, or a node table";
    MeshNotOne => "E-MESH-NOT-ONE", InputData,
        "no or several meshes, time steps or geometries",
        "leave one in the file";
    MeshUnsupported => "E-MESH-UNSUPPORTED", InputData,
        "a property of a mesh is not supported",
        "export it as the message says";
    MeshNotFinite => "E-MESH-NONFINITE", InputData,
        "a coordinate is NaN or infinite",
        "export the mesh again";
    MeshLabelTwice => "E-MESH-LABEL", InputData,
        "two nodes of a mesh have one label",
        "renumber the nodes";
    XdmfSyntax => "E-XDMF", InputData,
        "an XDMF file is not well-formed XML",
        "write it again";
    XdmfSize => "E-XDMF-SIZE", InputData,
        "an XDMF file has more attributes or namespaces than any mesh",
        "write it again";
    XdmfReference => "E-XDMF-REFERENCE", InputData,
        "an XDMF file names data outside its own folder",
        "move the data next to it";
    JobSyntax => "E-JOB", Usage,
        "the job document is not valid TOML or JSON, or a value has the wrong kind",
        "correct the line";
    JobKey => "E-JOB-KEY", Usage,
        "the job document holds an unknown key",
        "use the key the message offers, or remove it";
    JobNumber => "E-ARG", Usage,
        "a number of the job is out of range",
        "give one in the range of the message";
    JobEmpty => "E-JOB-EMPTY", Usage,
        "a text or list of the job is empty",
        "fill it or remove the key";
    InterfaceTwice => "E-INTERFACE-NAME", Usage,
        "two interfaces have one name",
        "give each its own";
    SceneInterface => "E-SCENE-INTERFACE", Usage,
        "a boundary of the scene is about an interface that the job does not have",
        "use the name of an interface; the message lists them";
    InterfaceRepeats => "E-DUP-INTERFACE", Usage,
        "an interface lists a node, row or direction twice",
        "list each once";
    InterfaceOverlap => "E-INTERFACE-OVERLAP", Usage,
        "two interfaces list the same node or row",
        "leave it in one of them";
    InterfaceNodes => "E-INTERFACE-NODES", Usage,
        "a selection of nodes cannot be understood",
        "write a list, \"group:NAME\", a region or rows";
    InterfaceConflict => "E-INTERFACE-KEY", Usage,
        "a key of an interface contradicts its nodes or coupling",
        "remove it, or do as the message says";
    NameNotText => "E-NAME", Usage,
        "a file or a folder of the job has a name that is not UTF-8, which the report and the superelement cannot keep",
        "rename the one that the message names";
    NotJson => "E-JSON", Usage,
        "a report or a job cannot be written as JSON",
        "rename files and folders whose names are not UTF-8";
    OutputName => "E-OUTPUT-NAME", Usage,
        "an output has the wrong extension",
        "name it as the message says";
    OutputIsInput => "E-OVERWRITE", Usage,
        "an output would be written over an input, by whatever name or link",
        "give the output another name";
    OutputTwice => "E-OUTPUT-TWICE", Usage,
        "two outputs would be written over each other",
        "give one of them another name";
    OutputKind => "E-OUTPUT-KIND", Io,
        "the name of an output is taken by a folder, a pipe or a device",
        "give the output another name";
    MissingFlags => "E-FLAGS", Usage,
        "neither a job document nor the flags that replace it",
        "give one or the other";
    FlagText => "E-FLAG-TEXT", Usage,
        "the text of a flag cannot be understood",
        "write it as the message says";
    OtherVersion => "E-OTHER-VERSION", Usage,
        "`verify --reproduce` of a file that another program or version made",
        "run that version, or compare with `verify --job` alone";
    KeptJob => "E-KEPT-JOB", Usage,
        "`verify --reproduce` or `inspect --job` of a file that keeps no job of this version",
        "run the version that made it, or give the job by `verify --job`";
    Threads => "E-THREADS", Resources,
        "the working threads cannot be started",
        "ask for fewer with `--threads`";
    Unsymmetric => "E-UNSYMMETRIC", InputData,
        "K or M is not symmetric",
        "leave out follower forces, gyroscopic and friction terms; where a triangle is incomplete, say which one holds with `model.symmetric` (`reduce --symmetric`)";
    Swapped => "E-SWAPPED", InputData,
        "K and M are exchanged",
        "exchange the two files";
    NoMass => "E-NO-MASS", InputData,
        "the mass matrix is zero",
        "give the mass matrix";
    IndefiniteMass => "E-INDEF-MASS", ModelPhysics,
        "M gives some motion a negative kinetic energy",
        "check point masses, offsets and the coupling terms of the mass";
    UnitRange => "E-RANGE", InputData,
        "K, M or the frequencies leave the range of double precision",
        "write the matrices in other units";
    RecoveryRange => "E-RECOVERY-RANGE", InputData,
        "the shapes of `write.recovery` are too large or too small for single precision",
        "set its precision to `\"double\"`, or write the matrices in other units";
    EmptyRows => "E-EMPTY-ROWS", InputData,
        "rows have neither stiffness nor mass",
        "leave unused and constrained dofs out of both matrices, or drop them with `model.drop_empty` (`reduce --drop-empty`)";
    MultiplierRow => "E-LAGRANGE", InputData,
        "K has a zero diagonal in a row with other entries",
        "eliminate constraints before exporting: multipliers have no mass and no stiffness";
    NegativeStiffness => "E-NEG-DIAG", ModelPhysics,
        "a diagonal entry of K is negative",
        "the structure is unstable or loaded beyond buckling: reduce it unloaded";
    NegativeMass => "E-NEG-MASS", ModelPhysics,
        "a diagonal entry of M is negative",
        "check point masses and offsets";
    CoordinatesDoNotFit => "E-COORD", InputData,
        "the coordinates or the dof map do not belong to K",
        "check units, axes, local node frames and the order of nodes and rows, first at the nodes named; use the coordinates of the state that K was made in; or leave the nodes out";
    RotationsHeld => "E-ROTATIONS-HELD", InputData,
        "K lets the component move in every direction but not turn",
        "check map, order of nodes, local frames and the state of the coordinates; look for springs between distant nodes; where supports hold rotations alone, list them in `model.held_rotations`";
    MassInAnotherOrder => "E-MASS-ORDER", InputData,
        "M couples other nodes than K",
        "write K and M with their rows in one order, that of the dof map";
    NegativeRigidEnergy => "E-NEG-RIGID", ModelPhysics,
        "a rigid-body motion has negative energy, and a count finds the eigenvalue",
        "check preload and negative springs";
    MasslessRigidMotion => "E-RIGID-MASS", ModelPhysics,
        "a rigid-body motion moves no mass",
        "give the massless part its mass";
    MasslessFreeMotion => "E-FREE-MASSLESS", ModelPhysics,
        "free modes of a component with a rigid-body motion that moves no mass",
        "give the nodes rotary inertia, or keep fixed-interface modes with the method `craig-bampton`";
    DenseEigen => "E-DENSE-EIGEN", NumericalLimit,
        "a small dense eigenproblem did not converge",
        "check the magnitudes of the input for values near the ends of the range of a double";
    MasslessMechanism => "E-MASSLESS-MECHANISM", ModelPhysics,
        "a motion has neither stiffness nor mass",
        "give the dof named stiffness or mass, or leave it out of both matrices";
    InterfaceTooLarge => "E-INTERFACE-SIZE", InputData,
        "the interface has more dofs than dense matrices can have",
        "take fewer interface nodes or couple their patches rigidly";
    SelectionNeedsNodes => "E-NO-NODES", InputData,
        "an interface names nodes and the model has none",
        "give `model.dofs` and `model.nodes` (`reduce --dofs`, `reduce --nodes`), or select rows";
    RigidNeedsCoordinates => "E-NO-COORDINATES", InputData,
        "a rigid interface has nodes without coordinates",
        "give a table or mesh with every node of the patch";
    UnknownGroup => "E-GROUP", InputData,
        "the mesh has no such group",
        "use one of the names in the message";
    EmptyInterface => "E-INTERFACE-EMPTY", InputData,
        "an interface selects no node",
        "check the list or the region against the coordinates";
    InterfaceNodeWithoutRows => "E-CONSTRAINED-INTERFACE", InputData,
        "an interface node has no row in the matrices",
        "it is constrained, unused or not in the dof map: take another or free it";
    DofMissing => "E-DOF-MISSING", InputData,
        "an interface asks for a dof that its node does not have",
        "list the dofs, or use `coupling = \"rigid\"`";
    InterfaceRow => "E-INTERFACE-ROW", InputData,
        "an interface names a row beyond the matrices",
        "count rows from zero";
    DofTwice => "E-DOF-TWICE", InputData,
        "two interfaces claim one dof",
        "take it out of one of them";
    OriginTooFar => "E-ORIGIN-FAR", InputData,
        "the origin of a rigid patch is more than a hundred times the size of the part away from it",
        "give the origin in the unit of the coordinates, or leave it out for the mean of the nodes";
    WhollyRigid => "E-WHOLLY-RIGID", ModelPhysics,
        "rigid patches tie all nodes, and nothing elastic is left",
        "leave nodes out of the patch; a rigid part needs no superelement";
    PatchRank => "E-PATCH-RANK", InputData,
        "a rigid patch cannot follow all motions of its node",
        "add nodes off the line, or list fewer dofs";
    FloatingBody => "E-FLOATING-BODY", ModelPhysics,
        "a body that nothing holds has no interface node",
        "add an interface node there, connect the body or leave it out";
    InterfaceRank => "E-INTERFACE-RANK", ModelPhysics,
        "the interface leaves a rigid-body motion free, as far as the digits of the stiffness tell",
        "add interface nodes off the axis named, or give them rotations";
    DigitsTooFew => "E-DATA-PRECISION", InputData,
        "the digits of the stiffness leave open whether it is definite, or how many motions cost no energy",
        "write the stiffness with more digits, best in binary";
    NotDefinite => "E-NOT-DEFINITE", ModelPhysics,
        "the stiffness is not positive definite, with the interface held or, as it says then, with none held",
        "close the mechanism at the dof named, or remove what makes the structure unstable";
    IndefiniteStiffness => "E-NEGATIVE-STIFFNESS", ModelPhysics,
        "the stiffness has negative eigenvalues, counted",
        "reduce at a smaller preload, check negative springs and the digits of the matrix";
    MemoryForecast => "E-MEM", Resources,
        "the forecast exceeds the memory",
        "free memory, raise `run.memory_gib`, make the part that is named first smaller, or set `run.precision = \"mixed\"` where the message says that this fits";
    MemoryComparison => "E-MEM-VERIFY", Resources,
        "the forecast of `supel verify --job` exceeds the memory",
        "free memory, raise `run.memory_gib` of the job, or verify the file by itself";
    OutOfMemory => "E-OUT-OF-MEMORY", Resources,
        "an allocation failed",
        "free memory or reduce a smaller model";
    NotRefined => "E-NOT-REFINED", NumericalLimit,
        "a solve by a factor in single precision stays less accurate than one in double",
        "use `precision = \"double\"`";
    SturmPivot => "E-STURM-PIVOT", NumericalLimit,
        "the shift of a Sturm count lies on an eigenvalue",
        "ask for one mode more or less";
    LanczosStalled => "E-STALLED", NumericalLimit,
        "the eigensolver stalled",
        "ask for another number of modes or another band, or set the other `eigensolver` in the job";
    Mechanism => "E-MECHANISM", ModelPhysics,
        "motions without energy in addition to the rigid-body modes",
        "close hinges and sliding joints or give them stiffness";
    ModesMissing => "E-MODES-MISSING", NumericalLimit,
        "modes are missing and a restart found no more",
        "compare with the eigensolver `arpack`";
    EigensolverMissing => "E-NO-ARPACK", Usage,
        "the program was built without ARPACK",
        "use the eigensolver `lanczos` or rebuild with the feature `arpack`";
    Arpack => "E-ARPACK", NumericalLimit,
        "ARPACK failed",
        "set `eigensolver = \"lanczos\"` in the job";
    SuperelementFile => "E-SUPERELEMENT", InputData,
        "a file is not a superelement, or cannot be made one",
        "the message says what is wrong with it; write it again with `supel reduce`";
}
