//! `supel convert`: a matrix, or a mesh, in another format.

use serde_json::json;

use super::answer::{Program, Terminal};
use super::convert_command::{ConvertAnswer, ConvertCommand, MatrixConversion};
use super::convert_mesh;
use super::exit_code::ExitCode;
use super::outputs::{Outputs, abandoned, refuse_unwritable, writer};
use super::overwriting::{Named, OwnFiles};
use super::rehearsal::{self, Rehearsed};
use super::{memory, process};
use crate::conversion::{Content, Shape};
use crate::dofs::{Dof, DofMap};
use crate::error::{Error, Result, Unnamed};
use crate::input::{Allowance, InputNote, ReadSingle, RowLabels};
use crate::number::counted;
use crate::report::{printable, value_text};

pub(super) fn run(command: &ConvertCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    match command {
        ConvertCommand::Matrix(conversion) => convert_matrix(conversion, terminal),
        ConvertCommand::Mesh(conversion) => convert_mesh::run(conversion, terminal),
    }
}

fn convert_matrix(command: &MatrixConversion, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let own = OwnFiles::of(&inputs(command), &outputs(command))?;
    refuse_unwritable(&own)?;
    let memory_bytes = memory::available_bytes();
    let rehearsed = match terminal.program {
        Program::Supel => rehearsal::rehearse_matrix(&command.matrix, memory_bytes)?,
        Program::Other => Rehearsed::Nothing,
    };
    let threads = process::threads(process::useful_threads(process::available_threads()))?;
    let read = threads.install(|| command.matrix.read(&Allowance::of(memory_bytes)));
    let mut read = read.map_err(|error| rehearsed.judge(error))?;
    let dofs = match (&command.dofs_output, &read.dofs) {
        (Some(_), None) => return Err(Error::RowsUnnamed { path: command.matrix.path(), of: Unnamed::Single }),
        (Some(path), Some(dofs)) => Some((path, table(dofs, &read.labels))),
        (None, _) => None,
    };
    let matrix = &read.input.matrix;
    let shape = Shape::of(matrix);
    let once = shape.given_once(matrix).map(|n_once| InputNote::GivenOnce { path: command.matrix.path(), n_once });
    read.notes.extend(once);
    let name = command.name(read.name.as_deref());
    let complaints = abandoned(&own);
    let mut outputs = Outputs::new(&own);
    if let Some((path, table)) = &dofs {
        outputs.stage(path, table.as_bytes())?;
    }
    let mut out = writer(&own, &command.output)?;
    command.target.write(Content { matrix, shape, name: &name }, &command.output, &mut out)?;
    outputs.push(out.finish().map_err(Error::of_writing)?);
    let answer = match command.answer {
        ConvertAnswer::Text => text(command, &read, shape),
        ConvertAnswer::Json => document(command, &read, shape),
    };
    outputs.commit()?;
    terminal.answer(&answer);
    complaints.iter().for_each(|complaint| terminal.complain(complaint));
    Ok(ExitCode::Done)
}

fn inputs(command: &MatrixConversion) -> Vec<Named> {
    let matrix = ("the matrix", command.matrix.path());
    std::iter::once(matrix).chain(command.matrix.dofs.clone().map(|path| ("the dof map", path))).collect()
}

/// The matrix goes last: the table describes it.
fn outputs(command: &MatrixConversion) -> Vec<Named> {
    let dofs = command.dofs_output.clone().map(|path| ("--write-dofs", path));
    dofs.into_iter().chain([("OUTPUT", command.output.clone())]).collect()
}

/// A dof map as `supel reduce` reads it.
fn table(dofs: &DofMap, labels: &RowLabels) -> String {
    let row = |(row, dof): (usize, &Option<Dof>)| match dof {
        Some(dof) => format!("{},{}\n", dof.node, dof.direction),
        None => labels.scalar_in_map(row).unwrap_or_else(|| ",scalar".to_owned()) + "\n",
    };
    std::iter::once("node,dof\n".to_owned()).chain(dofs.iter().enumerate().map(row)).collect()
}

fn text(command: &MatrixConversion, read: &ReadSingle, shape: Shape) -> String {
    let shown = |path: &std::path::Path| printable(&path.display().to_string()).into_owned();
    let (n, n_entries) = (read.input.matrix.rows(), read.input.matrix.nnz());
    let mut lines = vec![format!(
        "{} ({}): {}, {}, {}",
        shown(&command.matrix.file),
        read.layout.name(),
        counted(n, "row", "rows"),
        counted(n_entries, "entry", "entries"),
        shape.name()
    )];
    lines.push(format!("{}: {}", shown(&command.output), command.target.name()));
    lines.extend(command.dofs_output.as_ref().map(|path| format!("{}: node and direction of each row", shown(path))));
    lines.extend(read.notes.iter().map(|note| format!("note: {}", printable(&note.to_string()))));
    lines.join("\n") + "\n"
}

/// `schemas/conversion.schema.json` describes it.
fn document(command: &MatrixConversion, read: &ReadSingle, shape: Shape) -> String {
    let notes: Vec<String> = read.notes.iter().map(ToString::to_string).collect();
    value_text(&json!({
        "format_version": 1,
        "generator": { "name": env!("CARGO_PKG_NAME"), "version": env!("CARGO_PKG_VERSION") },
        "matrix": {
            "path": command.matrix.file,
            "blake3": read.input.digest,
            "format": read.layout.name(),
            "rows": read.input.matrix.rows(),
            "entries": read.input.matrix.nnz(),
            "shape": shape.name(),
        },
        "output": { "path": command.output, "format": command.target.name() },
        "dofs": command.dofs_output,
        "notes": notes,
    }))
}
