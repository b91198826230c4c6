//! `supel convert` of a mesh: VTKHDF, which ParaView opens.

use serde_json::json;

use super::answer::{Program, Terminal};
use super::convert_command::{ConvertAnswer, MeshConversion};
use super::exit_code::ExitCode;
use super::outputs::{Outputs, abandoned, refuse_unwritable, writer};
use super::overwriting::OwnFiles;
use super::rehearsal::{self, Rehearsed};
use super::{memory, process};
use crate::conversion::{Target, write_mesh};
use crate::error::{Error, Result};
use crate::input::{Allowance, MeshInput};
use crate::number::counted;
use crate::report::{printable, value_text};

pub(super) fn run(conversion: &MeshConversion, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let MeshConversion { file, output, answer } = conversion;
    let own = OwnFiles::of(&[("the mesh", file.clone())], &[("OUTPUT", output.clone())])?;
    refuse_unwritable(&own)?;
    let memory_bytes = memory::available_bytes();
    let rehearsed = match terminal.program {
        Program::Supel => rehearsal::rehearse_mesh(file, memory_bytes)?,
        Program::Other => Rehearsed::Nothing,
    };
    let threads = process::threads(process::useful_threads(process::available_threads()))?;
    let read = threads.install(|| MeshInput::read(file, &Allowance::of(memory_bytes)));
    let mesh = read.map_err(|error| rehearsed.judge(error))?;
    let complaints = abandoned(&own);
    let mut outputs = Outputs::new(&own);
    let out = writer(&own, output)?;
    write_mesh(&mesh, output, &out)?;
    outputs.push(out.finish().map_err(Error::of_writing)?);
    let answer = match answer {
        ConvertAnswer::Text => text(conversion, &mesh),
        ConvertAnswer::Json => document(conversion, &mesh),
    };
    outputs.commit()?;
    terminal.answer(&answer);
    complaints.iter().for_each(|complaint| terminal.complain(complaint));
    Ok(ExitCode::Done)
}

/// What became of the cells, where it is not what they were.
fn notes(mesh: &MeshInput) -> Vec<String> {
    let unread = mesh.unread.as_ref().map(|what| {
        format!("no cells are written: the mesh has what supel does not read, {what}; its nodes are points")
    });
    let simplified = (mesh.n_simplified > 0).then(|| {
        let cells = counted(mesh.n_simplified, "cell is", "cells are");
        format!(
            "{cells} written without the nodes in the middles of faces and of the cell, which are points of their own"
        )
    });
    unread.into_iter().chain(simplified).collect()
}

fn text(conversion: &MeshConversion, mesh: &MeshInput) -> String {
    let shown = |path: &std::path::Path| printable(&path.display().to_string()).into_owned();
    let (n_nodes, n_groups) = (mesh.nodes.labels.len(), mesh.nodes.groups.len());
    let mut lines = vec![format!(
        "{}: {}, {}, {}",
        shown(&conversion.file),
        counted(n_nodes, "node", "nodes"),
        counted(mesh.n_cells(), "cell", "cells"),
        counted(n_groups, "group", "groups")
    )];
    lines.push(format!("{}: {}", shown(&conversion.output), Target::Vtkhdf.name()));
    lines.extend(notes(mesh).iter().map(|note| format!("note: {}", printable(note))));
    lines.join("\n") + "\n"
}

/// `schemas/conversion.schema.json` describes it.
fn document(conversion: &MeshConversion, mesh: &MeshInput) -> String {
    let groups: Vec<&String> = mesh.nodes.groups.keys().collect();
    value_text(&json!({
        "format_version": 1,
        "generator": { "name": env!("CARGO_PKG_NAME"), "version": env!("CARGO_PKG_VERSION") },
        "mesh": {
            "path": conversion.file,
            "blake3": mesh.digest,
            "nodes": mesh.nodes.labels.len(),
            "cells": mesh.n_cells(),
            "groups": groups,
        },
        "output": { "path": conversion.output, "format": Target::Vtkhdf.name() },
        "notes": notes(mesh),
    }))
}
