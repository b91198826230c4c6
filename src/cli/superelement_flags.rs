//! What was typed after commands that read superelements, as clap reads it.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args};

use crate::export::{FORMATS, Format};

#[derive(Debug, Args)]
// One field for each switch that can be typed.
#[expect(clippy::struct_excessive_bools)]
pub(super) struct InspectFlags {
    /// Superelement file
    pub(super) file: PathBuf,
    /// Print all content except the matrices as JSON
    #[arg(long, conflicts_with_all = ["job", "rubin", "coordinates"])]
    pub(super) json: bool,
    /// Print Rubin's own matrices (45) and (47) and the map (51) to the coordinates of the file, as JSON
    #[arg(long, conflicts_with_all = ["job", "coordinates"])]
    pub(super) rubin: bool,
    /// Print the names of the coordinates in one line, the header of a table for `supel recover`
    #[arg(long, conflicts_with = "job")]
    pub(super) coordinates: bool,
    /// Print the job that made the file, as JSON that `supel reduce` accepts in any folder: its paths are absolute
    #[arg(long)]
    pub(super) job: bool,
}

/// How superelements become an assembly.
#[derive(Debug, Args)]
pub(super) struct AssemblyFlags {
    /// Join interfaces node by node: a.hub=b.pin, or a.hub.17=b.pin.4 for two of several nodes, a.rows:0,1=b.rows:8,9
    /// without nodes (repeatable)
    #[arg(long, value_name = "A=B")]
    pub(super) join: Vec<String>,
    /// Hold an interface: b.foot, or b.foot.ux for one direction (repeatable)
    #[arg(long, value_name = "PLACE")]
    pub(super) fix: Vec<String>,
    /// Add a mass, shared by the nodes of an interface: a.tip=2.5, with moments of inertia a.tip=2.5,0.1,0.1,0.2
    /// (repeatable)
    #[arg(long, value_name = "PLACE=MASS")]
    pub(super) mass: Vec<String>,
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("how many modes").args(["count", "up_to_hz"]))]
pub(super) struct ModesFlags {
    /// Superelement files; a component has the name of its file without .supel, or NAME
    #[arg(required = true, value_name = "[NAME=]FILE")]
    pub(super) files: Vec<String>,
    #[command(flatten)]
    pub(super) assembly: AssemblyFlags,
    /// Show this many modes [default: 20]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) count: Option<u32>,
    /// Show the modes up to this frequency
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    pub(super) up_to_hz: Option<f64>,
    /// Print the modes as JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("results").args(["output", "vtkhdf", "quantities", "loads"]).required(true).multiple(true))]
pub(super) struct RecoverFlags {
    /// Superelement file
    pub(super) file: PathBuf,
    /// Table of states: a column for each coordinate, named as `supel inspect FILE --coordinates` prints them, and `time` if
    /// it is known
    #[arg(long, value_name = "TABLE")]
    pub(super) state: PathBuf,
    /// Velocities of the coordinates in the same states, in a table of the same form
    #[arg(long, value_name = "TABLE")]
    pub(super) velocity: Option<PathBuf>,
    /// Accelerations of the coordinates in the same states
    #[arg(long, value_name = "TABLE")]
    pub(super) acceleration: Option<PathBuf>,
    /// File for the motion of the recovered nodes, NAME.csv
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// File for the same motion as a series that ParaView opens, NAME.vtkhdf: a vertex at each recovered node
    #[arg(long, value_name = "FILE")]
    pub(super) vtkhdf: Option<PathBuf>,
    /// File for the quantities of the superelement, stresses for instance, NAME.csv
    #[arg(long, value_name = "FILE")]
    pub(super) quantities: Option<PathBuf>,
    /// File for the loads on the interface and their resultants, NAME.csv; inertia counts where accelerations are given
    #[arg(long, value_name = "FILE")]
    pub(super) loads: Option<PathBuf>,
    /// Gravity in which the loads act, an acceleration: --gravity=0,0,-9.81
    #[arg(long, value_name = "X,Y,Z", requires = "loads", allow_hyphen_values = true)]
    pub(super) gravity: Option<String>,
    /// Use even a superelement that failed a check; the exit code stays 1
    #[arg(long)]
    pub(super) allow_unverified: bool,
}

#[derive(Debug, Args)]
// One field for each switch that can be typed.
#[expect(clippy::struct_excessive_bools)]
pub(super) struct ExportFlags {
    /// Superelement file; several become an assembly, whose components have the names of their files without .supel, or NAME
    #[arg(required = true, value_name = "[NAME=]FILE")]
    pub(super) files: Vec<PathBuf>,
    /// Format
    #[arg(long, value_name = "FORMAT", value_parser = formats())]
    pub(super) to: &'static dyn Format,
    #[command(flatten)]
    pub(super) assembly: AssemblyFlags,
    /// Keep a joined interface as one of the assembly; others that are joined become interior: a.hub (repeatable)
    #[arg(long, value_name = "PLACE")]
    pub(super) keep: Vec<String>,
    /// Start of the names of the files, or a folder that is there; an assembly needs it [default: the superelement without
    /// its ending]
    #[arg(short, long, value_name = "PATH")]
    pub(super) output: Option<PathBuf>,
    /// Print what was written as JSON
    #[arg(long)]
    pub(super) json: bool,
    /// Export even a superelement that failed a check; the exit code stays 1
    #[arg(long)]
    pub(super) allow_unverified: bool,
}

#[derive(Debug, Args)]
// One field for each switch that can be typed.
#[expect(clippy::struct_excessive_bools)]
pub(super) struct VerifyFlags {
    /// Superelement file
    pub(super) file: PathBuf,
    /// Job document of the model, or the superelement that is the model: compare with its full matrices
    #[arg(long, value_name = "JOB")]
    pub(super) job: Option<PathBuf>,
    /// Run the job again, from --job or from the file itself, and compare bytes
    #[arg(long)]
    pub(super) reproduce: bool,
    /// Print the checks as JSON
    #[arg(long)]
    pub(super) json: bool,
    /// Print only errors and failed checks, one line each; --json still prints the document
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// Treat warnings as failed checks and refuse repeated entries of the matrices of --job
    #[arg(long)]
    pub(super) strict: bool,
    /// Number of threads; results do not depend on it [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
}

/// The formats of exports by name.
fn formats() -> impl TypedValueParser<Value = &'static dyn Format> {
    let named = |name: String| FORMATS.into_iter().find(|format| format.name() == name).ok_or("not a format");
    PossibleValuesParser::new(FORMATS.map(Format::name)).try_map(named)
}
