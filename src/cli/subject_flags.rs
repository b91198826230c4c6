//! What was typed after commands that look at a model without reducing it, as clap reads it.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::flag_values::values;
use crate::job::{ConstraintsToGround, Layout};
use crate::sparse::Triangle;

/// A model: its matrices, what their rows are, and what is held of it.
#[derive(Debug, Args)]
pub(super) struct SubjectFlags {
    /// File of the stiffness matrix K; a group of an HDF5 file follows a colon: model.h5:/K
    #[arg(value_name = "K")]
    pub(super) stiffness: PathBuf,
    /// File of the mass matrix M
    #[arg(value_name = "M")]
    pub(super) mass: PathBuf,
}

/// What goes with the matrices of a model.
#[derive(Debug, Args)]
#[command(next_help_heading = "Model")]
pub(super) struct RowFlags {
    /// File that says which node and direction each row is
    #[arg(long, value_name = "FILE")]
    pub(super) dofs: Option<PathBuf>,
    /// Table of nodes or mesh
    #[arg(long, value_name = "FILE")]
    pub(super) nodes: Option<PathBuf>,
    /// Table of the axes of nodes whose rows are along axes of their own: node,x1,x2,x3,y1,y2,y3
    #[arg(long, value_name = "FILE")]
    pub(super) frames: Option<PathBuf>,
    /// Format of K and M, where their content leaves several
    #[arg(long, value_parser = values::<Layout>())]
    pub(super) layout: Option<Layout>,
    /// Which triangle of K and M is right, where the other is incomplete
    #[arg(long, value_parser = values::<Triangle>())]
    pub(super) symmetric: Option<Triangle>,
    /// Drop rows that have neither stiffness nor mass
    #[arg(long)]
    pub(super) drop_empty: bool,
    /// Multipoint constraints: Matrix Market file of G with G u = 0
    #[arg(long, value_name = "FILE")]
    pub(super) constraints: Option<PathBuf>,
    /// What becomes of constraints that hold the component to the ground [default: refuse]
    #[arg(long, value_name = "CHOICE", value_parser = values::<ConstraintsToGround>())]
    pub(super) constraints_to_ground: Option<ConstraintsToGround>,
    /// Dofs that are held at rest: foot=group:FOOT, or foot=12,17:ux,uy for some directions (repeatable)
    #[arg(long, value_name = "NAME=NODES[:DOFS]")]
    pub(super) fix: Vec<String>,
    /// Number of threads; results do not depend on it [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
    /// Memory for matrices, factors and vectors, in GiB [default: what is free]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(super) memory_gib: Option<f64>,
}

#[derive(Debug, Args)]
pub(super) struct DoctorFlags {
    #[command(flatten)]
    pub(super) subject: SubjectFlags,
    #[command(flatten)]
    pub(super) rows: RowFlags,
    /// Print what was found as JSON
    #[arg(long, help_heading = "Output")]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct InitFlags {
    #[command(flatten)]
    pub(super) subject: SubjectFlags,
    #[command(flatten)]
    pub(super) rows: RowFlags,
    /// Write the job, NAME.toml [default: print it]
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(super) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("frequencies").args(["hz", "rad_per_s", "eigenvalues"]))]
// One field for each switch that can be typed.
#[expect(clippy::struct_excessive_bools)]
pub(super) struct CertifyFlags {
    #[command(flatten)]
    pub(super) subject: SubjectFlags,
    /// Shapes, a mode in each column and a value for every row of K: Matrix Market, .npy, a dataset as in modes.h5:/V; or the HDF5
    /// file of Exudyn's FEMinterface or the .frd of CalculiX, which have the frequencies too. With --reduced-stiffness the basis of a
    /// superelement
    #[arg(value_name = "RESULT")]
    pub(super) result: PathBuf,
    /// Frequencies of the shapes in Hz: a file with one on each line, a dataset, or numbers as in 31.2,87.5
    #[arg(long, value_name = "VALUES", allow_hyphen_values = true)]
    pub(super) hz: Option<String>,
    /// Circular frequencies of the shapes in rad/s
    #[arg(long, value_name = "VALUES", allow_hyphen_values = true)]
    pub(super) rad_per_s: Option<String>,
    /// Eigenvalues λ = ω² of the shapes in (rad/s)²
    #[arg(long, value_name = "VALUES", allow_hyphen_values = true)]
    pub(super) eigenvalues: Option<String>,
    /// Reduced stiffness K̂ of a superelement whose basis Ψ is RESULT: a column for each coordinate
    #[arg(long, value_name = "FILE", requires = "reduced_mass", conflicts_with = "frequencies")]
    pub(super) reduced_stiffness: Option<PathBuf>,
    /// Reduced mass M̂ of that superelement
    #[arg(long, value_name = "FILE", requires = "reduced_stiffness")]
    pub(super) reduced_mass: Option<PathBuf>,
    /// Band in Hz that the result has to have all modes of [default: from zero to its highest mode]
    #[arg(long, value_name = "FROM,TO")]
    pub(super) band: Option<String>,
    #[command(flatten)]
    pub(super) rows: RowFlags,
    /// Write the report as a page to read, print and sign, NAME.html
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(super) html: Option<PathBuf>,
    /// Write the checks as JUnit XML, NAME.xml
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(super) junit: Option<PathBuf>,
    /// Print the report as JSON
    #[arg(long, help_heading = "Output")]
    pub(super) json: bool,
    /// Print only errors and failed checks, one line each; --json still prints the document
    #[arg(short, long, help_heading = "Output")]
    pub(super) quiet: bool,
    /// Treat warnings as failed checks and refuse repeated entries of the matrices
    #[arg(long, help_heading = "Output")]
    pub(super) strict: bool,
}
