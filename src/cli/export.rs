//! `supel export`: a superelement in a format of other programs.

use std::path::{Path, PathBuf};

use serde_json::json;
use supel_runtime::{Superelement, Verdict};

use super::answer::Terminal;
use super::command::{Answer, ExportCommand};
use super::exit_code::ExitCode;
use super::outputs::{Outputs, abandoned};
use super::overwriting::OwnFiles;
use super::superelement_file;
use super::unverified::refusal;
use crate::error::{Error, Result};
use crate::export::{ExportedFile, Names};
use crate::number;
use crate::report::{printable, value_text};

pub(super) fn run(command: &ExportCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let (superelement, _) = superelement_file::read(&command.file)?;
    let verdict = superelement.metadata().verification.verdict;
    let is_refused = command.unverified.refuses(verdict);
    let files = if is_refused { Vec::new() } else { files(command, &superelement)? };
    let own = OwnFiles::of(
        &[("the superelement", command.file.clone())],
        &files.iter().map(|(path, _)| ("--output", path.clone())).collect::<Vec<_>>(),
    )?;
    let complaints = abandoned(&own);
    let mut outputs = Outputs::new(&own);
    files.iter().try_for_each(|(path, file)| outputs.stage(path, &file.bytes))?;
    let answer = match command.answer {
        Answer::Json => document(command, &superelement, &files)?,
        Answer::Text | Answer::Nothing => text(command, &superelement, &files),
    };
    outputs.commit()?;
    terminal.answer(&answer);
    complaints.iter().for_each(|complaint| terminal.complain(complaint));
    if is_refused {
        terminal.complain(&refusal(&command.file, "not exported", "export"));
    }
    Ok(if verdict == Verdict::Fail { ExitCode::CheckFailed } else { ExitCode::Done })
}

/// The files of the export and where they go. Their names stand in the answer and in one another, which are UTF-8.
fn files(command: &ExportCommand, superelement: &Superelement) -> Result<Vec<(PathBuf, ExportedFile)>> {
    for (key, path) in [("--output", &command.output), ("FILE", &command.file)] {
        path.to_str().ok_or_else(|| Error::NameNotText { key, path: path.clone() })?;
    }
    let output = command.output.as_path();
    let names = if output.is_dir() { Names::in_folder(output) } else { Names::starting_with(output) };
    let files = command.format.files(superelement, &names)?;
    Ok(files.into_iter().map(|file| (names.path(file.ending), file)).collect())
}

/// What the file says of its verification. Nothing is verified here.
fn recorded(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "verified",
        Verdict::Warn => "verified with warnings",
        Verdict::Fail => "a check failed",
    }
}

fn text(command: &ExportCommand, superelement: &Superelement, files: &[(PathBuf, ExportedFile)]) -> String {
    let metadata = superelement.metadata();
    let verdict = recorded(metadata.verification.verdict);
    let mut lines = vec![format!("{}: {verdict}, as recorded when it was made", shown(&command.file))];
    lines.extend(
        files.iter().map(|(path, file)| {
            format!("{}: {}, {}", shown(path), file.content, number::bytes(file.bytes.len() as u64))
        }),
    );
    if !files.is_empty() {
        let label = metadata.units.as_ref().map(|units| format!(", {}", printable(units))).unwrap_or_default();
        lines.push(format!("numbers are in the units of the model{label}"));
    }
    lines.join("\n") + "\n"
}

fn shown(path: &Path) -> String {
    printable(&path.display().to_string()).into_owned()
}

/// `schemas/export.schema.json` describes it.
fn document(command: &ExportCommand, superelement: &Superelement, files: &[(PathBuf, ExportedFile)]) -> Result<String> {
    let metadata = superelement.metadata();
    let sealed = superelement.to_bytes().map_err(|error| Error::of_superelement(&command.file, error))?;
    let of_file = |(path, file): &(PathBuf, ExportedFile)| {
        let digest = blake3::hash(&file.bytes).to_hex().to_string();
        json!({ "path": path, "content": file.content, "bytes": file.bytes.len(), "blake3": digest })
    };
    let files: Vec<serde_json::Value> = files.iter().map(of_file).collect();
    Ok(value_text(&json!({
        "format_version": 1,
        "generator": { "name": env!("CARGO_PKG_NAME"), "version": env!("CARGO_PKG_VERSION") },
        "superelement": { "path": command.file, "blake3": sealed.digest },
        "verdict": metadata.verification.verdict,
        "units": metadata.units,
        "format": command.format.name(),
        "files": files,
    })))
}
