//! Which part of a job selects nodes, as messages call it.

use std::fmt;

/// A part of a job that selects nodes or rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Selector {
    /// An interface by its name.
    Interface(String),
    /// Held dofs by their name, or by their place in the job where they have none.
    Fixed(String),
    /// A load by its name.
    Load(String),
    /// A further matrix by its name.
    Matrix(String),
    /// The nodes whose displacements are recovered.
    Recovery,
    /// The nodes inside at which the scene looks.
    Outputs,
    /// The rows of the matrices on which quantities depend.
    Quantities,
}

impl Selector {
    /// The name, or the key where there is none.
    pub fn name(&self) -> &str {
        match self {
            Self::Interface(name) | Self::Fixed(name) | Self::Load(name) | Self::Matrix(name) => name,
            Self::Recovery => "write.recovery",
            Self::Outputs => "scene.outputs",
            Self::Quantities => "write.quantities",
        }
    }

    /// What to do where a node lacks a direction that is asked for.
    pub(super) fn remedy_of_missing_dof(&self) -> &'static str {
        match self {
            Self::Load(_) => "leave out what the load has along it",
            Self::Interface(_) => "use coupling = \"rigid\" or list the dofs",
            _ => "list the dofs",
        }
    }
}

impl fmt::Display for Selector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Interface(name) => write!(f, "interface {name:?}"),
            Self::Fixed(name) => write!(f, "fixed {name:?}"),
            Self::Load(name) => write!(f, "load {name:?}"),
            Self::Matrix(name) => write!(f, "matrix {name:?}"),
            Self::Recovery | Self::Outputs | Self::Quantities => f.write_str(self.name()),
        }
    }
}
