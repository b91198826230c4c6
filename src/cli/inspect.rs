//! `supel inspect`: what is in a superelement file.

use std::path::Path;

use faer::Mat;
use serde_json::{Value, json};
use supel_runtime::{Coordinate, FORMAT_VERSION, Superelement};

use super::answer::Terminal;
use super::command::{InspectAnswer, InspectCommand};
use super::exit_code::ExitCode;
use super::verify::job_of_file;
use crate::error::{Error, Result, json_value};
use crate::input;
use crate::recovery::coordinate_names;
use crate::report::{inspection, value_text};
use crate::rubin::Rubin;

pub(super) fn run(command: &InspectCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let (superelement, bytes) = input::superelement(&command.file)?;
    let file_bytes = bytes.len();
    drop(bytes);
    let text = match command.answer {
        InspectAnswer::Text => inspection(&superelement, file_bytes as u64, terminal.paint),
        InspectAnswer::Json => value_text(&document(&superelement)?),
        InspectAnswer::Rubin => value_text(&rubin(&superelement, &command.file)?),
        InspectAnswer::Coordinates => coordinate_names(&superelement).join(",") + "\n",
        InspectAnswer::Job => {
            let (job, remark) = job_of_file(&superelement, &command.file)?;
            remark.iter().for_each(|remark| terminal.complain(remark));
            // Its paths are absolute, so that the answer is a job in whatever folder it is written to.
            value_text(&json_value("the job", &job)?)
        }
    };
    terminal.answer(&text);
    Ok(ExitCode::Done)
}

/// Rubin's matrices, and how their coordinates [u_B; η; u_F] make those of the file; matrices as lists of rows.
fn rubin(superelement: &Superelement, path: &Path) -> Result<Value> {
    let rubin = Rubin::of_file(superelement)?.ok_or_else(|| Error::NoInertiaRelief { path: path.to_owned() })?;
    let rows = |a: &Mat<f64>| -> Vec<Vec<f64>> {
        (0..a.nrows()).map(|i| (0..a.ncols()).map(|j| a[(i, j)]).collect()).collect()
    };
    Ok(json!({
        "sizes": {
            "n_interface": rubin.n_interface(),
            "n_modes": rubin.columns.ncols() - rubin.n_interface(),
            "n_rigid": rubin.n_rigid(),
        },
        "stiffness": rows(&rubin.stiffness()),
        "mass": rows(&rubin.mass()),
        "to_file": rows(&rubin.to_herting()),
    }))
}

/// Everything but the matrices.
fn document(superelement: &Superelement) -> Result<Value> {
    let metadata = json_value("the metadata of a superelement", superelement.metadata())?;
    let tensors = superelement.tensors();
    let count = |is_counted: fn(&Coordinate) -> bool| {
        superelement.metadata().coordinates.iter().filter(|coordinate| is_counted(coordinate)).count()
    };
    Ok(json!({
        "format_version": FORMAT_VERSION,
        "sizes": {
            "n_reduced": superelement.n_coordinates(),
            "n_interface": superelement.n_interface(),
            "n_inertia_relief": count(|coordinate| matches!(coordinate, Coordinate::InertiaRelief { .. })),
            "n_expansion_modes": count(|coordinate| matches!(coordinate, Coordinate::ExpansionMode { .. })),
            "n_residual_vectors": count(|coordinate| matches!(coordinate, Coordinate::ResidualVector { .. })),
            "n_modal": superelement.n_modal(),
            "n_rigid": superelement.n_rigid(),
        },
        "frequencies_hz": tensors.frequencies.iter().map(|omega| omega / std::f64::consts::TAU).collect::<Vec<f64>>(),
        "metadata": metadata,
    }))
}
