//! `supel inspect`: what is in a superelement file.

use serde_json::json;
use supel_runtime::{Coordinate, FORMAT_VERSION, Superelement};

use super::answer::Terminal;
use super::command::{InspectAnswer, InspectCommand};
use super::exit_code::ExitCode;
use crate::error::{Error, Result};
use crate::report::inspection;

pub(super) fn run(command: &InspectCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let failed = |error| Error::from_file(&command.file, error);
    let superelement = Superelement::open(&command.file).map_err(failed)?;
    let text = match command.answer {
        InspectAnswer::Text => {
            let file_bytes = superelement.to_bytes().map_err(failed)?.bytes.len();
            inspection(&superelement, file_bytes as u64, terminal.paint)
        }
        InspectAnswer::Json => pretty(&document(&superelement)),
        InspectAnswer::Job => pretty(&superelement.metadata().job),
    };
    terminal.answer(&text);
    Ok(ExitCode::Done)
}

fn pretty(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}

/// Everything but the matrices.
fn document(superelement: &Superelement) -> serde_json::Value {
    let tensors = superelement.tensors();
    let n_inertia_relief = superelement
        .metadata()
        .coordinates
        .iter()
        .filter(|coordinate| matches!(coordinate, Coordinate::InertiaRelief { .. }))
        .count();
    json!({
        "format_version": FORMAT_VERSION,
        "sizes": {
            "n_reduced": superelement.n_coordinates(),
            "n_interface": superelement.n_interface(),
            "n_inertia_relief": n_inertia_relief,
            "n_modal": superelement.n_modal(),
            "n_rigid": superelement.n_rigid(),
        },
        "frequencies_hz": tensors.frequencies.iter().map(|omega| omega / std::f64::consts::TAU).collect::<Vec<f64>>(),
        "metadata": superelement.metadata(),
    })
}
