//! What was typed, as clap reads it.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Parser, Subcommand};

use super::flag_values::values;
use super::subject_flags::{CertifyFlags, DoctorFlags, InitFlags};
use super::superelement_flags::{ExportFlags, InspectFlags, ModesFlags, RecoverFlags, VerifyFlags};
use super::text_flags::{ExplainFlags, RecipeFlags};
use crate::conversion::Target;
use crate::job::{Certify, Eigensolver, InterfacePart, Layout, Method, Precision};
use crate::sparse::Triangle;

/// Turns finite element models into verified superelements for multibody simulation.
#[derive(Debug, Parser)]
#[command(name = "supel", version, max_term_width = 100, arg_required_else_help = true)]
pub(super) struct CommandLine {
    #[command(subcommand)]
    pub(super) command: Typed,
}

#[derive(Debug, Subcommand)]
pub(super) enum Typed {
    /// Reduce a model, verify the result and write superelement and report
    #[command(after_help = EXIT_CODES)]
    Reduce(Box<ReduceFlags>),
    /// Say what a job will do and what it will cost: stages, time, memory, size of the answer
    #[command(after_help = EXIT_CODES)]
    Plan(PlanFlags),
    /// Check a superelement file: by itself, against the full matrices (--job) or by running its job again (--reproduce)
    #[command(after_help = EXIT_CODES)]
    Verify(VerifyFlags),
    /// Show what is in a superelement file
    Inspect(InspectFlags),
    /// Find out what a pair of matrices is, what is wrong with it, and what to do about it
    #[command(after_help = EXIT_CODES)]
    Doctor(Box<DoctorFlags>),
    /// Hold eigenpairs or a superelement of another program against K and M: modes missing, invented, inexact; what is not preserved
    #[command(after_help = EXIT_CODES)]
    Certify(Box<CertifyFlags>),
    /// Propose a job for a pair of matrices, from its groups and faces, with comments
    #[command(after_help = EXIT_CODES)]
    Init(Box<InitFlags>),
    /// Find the modes of superelements that are joined, held and loaded at their interfaces
    #[command(after_help = EXIT_CODES)]
    Modes(ModesFlags),
    /// Expand states of a simulation to the nodes that a superelement recovers
    #[command(after_help = EXIT_CODES)]
    Recover(RecoverFlags),
    /// Write a superelement in a format of other programs, or as a model that can be reduced again; or an assembly as one model
    #[command(after_help = EXIT_CODES)]
    Export(ExportFlags),
    /// Write a matrix in another format, every bit kept, or a mesh as VTKHDF for ParaView
    #[command(after_help = EXIT_CODES)]
    Convert(ConvertFlags),
    /// Print what a code means and what to do about it, or all codes
    Explain(ExplainFlags),
    /// Print what to write into the deck of a program so that it exports K, M and what their rows are
    Recipe(RecipeFlags),
    /// Read a model described on stdin and discard it
    #[command(hide = true, name = super::rehearsal::SUBCOMMAND)]
    RehearseReading,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done and verified; 1 done, a check failed; 2 usage; 3 input data; 4 model physics;
5 numerical limit; 6 resources; 7 input or output; 70 a defect of supel; 130 interrupted.";

#[derive(Debug, Args)]
pub(super) struct ReduceFlags {
    /// Job document, TOML or JSON, or a superelement; flags override its keys, interfaces and held dofs by name
    pub(super) job: Option<PathBuf>,
    /// Reduce every job in a folder and below it, or the components of an assembly document, side by side; --threads and
    /// --memory-gib are those of all together
    #[arg(long, value_name = "FOLDER|FILE", conflicts_with_all = [
        "job", "ModelFlags", "ReductionFlags", "output", "report", "html", "junit", "precision", "no_skip",
    ])]
    pub(super) all: Option<PathBuf>,
    #[command(flatten)]
    pub(super) model: ModelFlags,
    #[command(flatten)]
    pub(super) reduction: ReductionFlags,
    #[command(flatten)]
    pub(super) output: OutputFlags,
    #[command(flatten)]
    pub(super) run: RunFlags,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Model")]
pub(super) struct ModelFlags {
    /// File of the stiffness matrix K; its name in a file of several follows a colon: model.h5:/K, model.op4:KAA
    #[arg(long, value_name = "FILE")]
    pub(super) stiffness: Option<PathBuf>,
    /// File of the mass matrix M
    #[arg(long, value_name = "FILE")]
    pub(super) mass: Option<PathBuf>,
    /// File that says which node and direction each row is
    #[arg(long, value_name = "FILE")]
    pub(super) dofs: Option<PathBuf>,
    /// Table of nodes or mesh
    #[arg(long, value_name = "FILE")]
    pub(super) nodes: Option<PathBuf>,
    /// Table of the axes of nodes whose rows are along axes of their own: node,x1,x2,x3,y1,y2,y3
    #[arg(long, value_name = "FILE")]
    pub(super) frames: Option<PathBuf>,
    /// Format of the files of K and M, where their content leaves several
    #[arg(long, value_name = "FORMAT", value_parser = values::<Layout>())]
    pub(super) layout: Option<Layout>,
    /// Which triangle of K and M is right, where the other is incomplete
    #[arg(long, value_parser = values::<Triangle>())]
    pub(super) symmetric: Option<Triangle>,
    /// Drop rows that have neither stiffness nor mass; the report names them
    #[arg(long)]
    pub(super) drop_empty: bool,
    /// Interface whose nodes keep their own dofs: hub=12,17,19 or hub=group:HUB or hub=rows:0,1,2 (repeatable)
    #[arg(long, value_name = "NAME=NODES")]
    pub(super) interface: Vec<String>,
    /// Interface whose nodes move as a rigid body with one node of six dofs: hub=group:HUB (repeatable)
    #[arg(long, value_name = "NAME=NODES")]
    pub(super) rigid_interface: Vec<String>,
    /// Dofs that are held at rest: foot=group:FOOT, or foot=12,17:ux,uy for some directions (repeatable)
    #[arg(long, value_name = "NAME=NODES[:DOFS]")]
    pub(super) fix: Vec<String>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Reduction", group = ArgGroup::new("how many").args(["up_to_hz", "modes", "modes_from"]))]
pub(super) struct ReductionFlags {
    /// Reduction method
    #[arg(long, value_parser = values::<Method>())]
    pub(super) method: Option<Method>,
    /// Keep the modes up to this frequency
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    pub(super) up_to_hz: Option<f64>,
    /// Keep this many modes, extended to complete clusters
    #[arg(long, value_name = "N")]
    pub(super) modes: Option<usize>,
    /// Take the modes of a file, with mode-acceleration: Matrix Market, .npy, or a dataset as in model.h5:/V
    #[arg(long, value_name = "FILE")]
    pub(super) modes_from: Option<PathBuf>,
    /// Hold these interfaces, or directions of them, while the modes of mixed-interface are computed: base,hub.ux
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(super) held: Option<Vec<String>>,
    /// Add inertia-relief modes to the basis; herting and rubin have them anyway
    #[arg(long)]
    pub(super) inertia_relief: bool,
    /// Eigensolver [default: lanczos]
    #[arg(long, value_parser = values::<Eigensolver>())]
    pub(super) eigensolver: Option<Eigensolver>,
    /// How completeness of the modes is certified [default: count]
    #[arg(long, value_parser = values::<Certify>())]
    pub(super) certify: Option<Certify>,
}

impl ReductionFlags {
    /// What is held while modes are computed; nothing between commas is nothing held.
    pub(super) fn held(&self) -> Option<Vec<InterfacePart>> {
        let held = self.held.as_ref()?.iter().filter(|held| !held.is_empty());
        Some(held.cloned().map(InterfacePart).collect())
    }
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
// One field for each switch that can be typed; the checked command has enums in their place.
#[expect(clippy::struct_excessive_bools)]
pub(super) struct OutputFlags {
    /// Superelement file, NAME.supel
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Report file, NAME.json [default: next to the superelement, NAME.report.json]
    #[arg(long, value_name = "FILE")]
    pub(super) report: Option<PathBuf>,
    /// Also write the report as a page to read, print and sign, NAME.html
    #[arg(long, value_name = "FILE")]
    pub(super) html: Option<PathBuf>,
    /// Also write the checks as JUnit XML, NAME.xml
    #[arg(long, value_name = "FILE")]
    pub(super) junit: Option<PathBuf>,
    /// Print the report as JSON instead of the summary
    #[arg(long)]
    pub(super) json: bool,
    /// Print only errors and failed checks, one line each; --json still prints the document
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// Write the superelement even if a check failed; the exit code stays 1
    #[arg(long)]
    pub(super) allow_unverified: bool,
    /// Treat warnings as failed checks and refuse repeated entries
    #[arg(long)]
    pub(super) strict: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Run")]
// One field for each switch that can be typed.
#[expect(clippy::struct_excessive_bools)]
pub(super) struct RunFlags {
    /// Number of threads; results do not depend on it [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
    /// Memory for matrices, factors and vectors of the run, in GiB [default: what is free]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(super) memory_gib: Option<f64>,
    /// Precision of the stored factor: mixed takes half the memory and more time [default: double]
    #[arg(long, value_name = "HOW", value_parser = values::<Precision>())]
    pub(super) precision: Option<Precision>,
    /// Compute even what the scene never asks, to compare with
    #[arg(long)]
    pub(super) no_skip: bool,
    /// Reduce even where superelement and reports are up to date
    #[arg(long)]
    pub(super) force: bool,
    /// Folder that keeps factors, counts and modes for later runs, which change no result [default: that of the environment variable
    /// SUPEL_CACHE, or none]
    #[arg(long, value_name = "FOLDER")]
    pub(super) cache: Option<PathBuf>,
    /// How large that folder may become, in GiB [default: that of SUPEL_CACHE_GIB, or 10]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(super) cache_gib: Option<f64>,
    /// Memory that a run of several may plan with, in bytes; it ends with the process that started it
    #[arg(long, hide = true, value_name = "N")]
    pub(super) available_bytes: Option<u64>,
}

#[derive(Debug, Args)]
// One field for each switch that can be typed.
#[expect(clippy::struct_excessive_bools)]
pub(super) struct PlanFlags {
    /// Job document, TOML or JSON, or a superelement
    pub(super) job: PathBuf,
    /// Count the modes of a band even where that takes a long factorisation [otherwise their number is then a guess]
    #[arg(long)]
    pub(super) count_modes: bool,
    /// Measure how fast this machine is, even where it is known from earlier
    #[arg(long)]
    pub(super) calibrate: bool,
    /// Plan with what the scene never asks
    #[arg(long)]
    pub(super) no_skip: bool,
    /// Number of threads of the run [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
    /// Memory that the run may use, in GiB [default: what is free]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(super) memory_gib: Option<f64>,
    /// Print the plan as JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct ConvertFlags {
    /// File of the matrix; its name in a file of several follows a colon: model.h5:/K, model.op4:KAA. For .vtkhdf that of a mesh
    pub(super) from: PathBuf,
    /// File to be written; its ending says the format: .mtx, .mat, .npz, .op4, and of a mesh .vtkhdf
    pub(super) output: PathBuf,
    /// Format of the file that is read, where its content leaves several
    #[arg(long, value_name = "FORMAT", value_parser = values::<Layout>())]
    pub(super) layout: Option<Layout>,
    /// Format of the file that is written, where its ending does not say it
    #[arg(long, value_name = "FORMAT", value_parser = values::<Target>())]
    pub(super) to: Option<Target>,
    /// Dof map, in whose order the rows of a matrix that names them are written
    #[arg(long, value_name = "FILE")]
    pub(super) dofs: Option<PathBuf>,
    /// Write the node and direction of each row to this table
    #[arg(long, value_name = "FILE")]
    pub(super) write_dofs: Option<PathBuf>,
    /// Name of the matrix in formats that have names [default: that in the file read, or the name of the file written]
    #[arg(long)]
    pub(super) name: Option<String>,
    /// Print what was written as JSON
    #[arg(long)]
    pub(super) json: bool,
}
