//! What scripts and documents know an error by: its code, its class, its meaning and its remedy.

/// The class of an [`Error`](super::Error); its number is the exit code of the process.
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

impl ErrorClass {
    /// Whether it speaks of what the matrices are or of what arithmetic makes of them, and not of files, of the command line or of the machine.
    pub fn is_of_matrices(self) -> bool {
        matches!(self, Self::ModelPhysics | Self::NumericalLimit)
    }
}

/// The code of a command line that cannot be read at all; no [`Error`](super::Error) has it.
pub const USAGE_CODE: &str = "E-USAGE";
/// The code of a defect of the program; no [`Error`](super::Error) has it.
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
    /// What is wrong: the documentation of the variant, a sentence after a space.
    pub what: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

/// Makes the table of errors, and code and class of each, of what stands at each variant: its documentation, which says what is
/// wrong, and `#[entry(code, class, remedy)]`. A variant without them does not compile.
macro_rules! catalogued {
    (
        $(#[$of_enum:meta])*
        $vis:vis enum $name:ident {
            $(
                $(#[doc = $what:literal])+
                #[entry($code:literal, $class:ident, $remedy:literal)]
                #[error($($message:tt)*)]
                $variant:ident $({ $($fields:tt)* })?,
            )*
        }
    ) => {
        $(#[$of_enum])*
        $vis enum $name {
            $(
                $(#[doc = $what])+
                #[error($($message)*)]
                $variant $({ $($fields)* })?,
            )*
        }

        impl $name {
            /// Every error, in the order of the enum.
            pub const CODES: &[ErrorEntry] = &[$(ErrorEntry {
                variant: stringify!($variant),
                code: $code,
                class: ErrorClass::$class,
                what: concat!($($what),+),
                remedy: $remedy,
            }),*];

            /// The code of this error, for scripts; `docs/errors.md` has a line for each.
            pub fn code(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => $code,)*
                }
            }

            /// The class that its variant states.
            fn stated_class(&self) -> ErrorClass {
                match self {
                    $(Self::$variant { .. } => ErrorClass::$class,)*
                }
            }
        }
    };
}
pub(super) use catalogued;
