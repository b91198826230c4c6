//! `supel export`: a superelement in a format of other programs, or an assembly as one model.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use supel_runtime::{Superelement, Verdict};

use super::answer::Terminal;
use super::assembled::Files;
use super::assembly_command::AssemblyCommand;
use super::exit_code::ExitCode;
use super::export_command::{ExportAnswer, ExportCommand, Source};
use super::outputs::{Outputs, abandoned};
use super::overwriting::{Named, OwnFiles};
use super::unverified::refusal;
use crate::assembly::Assembly;
use crate::error::{Error, Result};
use crate::export::{ExportedFile, Joined, Names};
use crate::input;
use crate::number;
use crate::report::{printable, value_text};

pub(super) fn run(command: &ExportCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let made = match &command.source {
        Source::File(path) => of_file(command, path)?,
        Source::Assembly { assembly, kept } => of_assembly(command, assembly, kept)?,
    };
    refuse_left_over(command, &made)?;
    let own =
        OwnFiles::of(&made.inputs, &made.files.iter().map(|(path, _)| ("--output", path.clone())).collect::<Vec<_>>())?;
    let complaints = abandoned(&own);
    let mut outputs = Outputs::new(&own);
    made.files.iter().try_for_each(|(path, file)| outputs.stage(path, &file.bytes))?;
    let answer = match command.answer {
        ExportAnswer::Json => made.document(command),
        ExportAnswer::Text => made.text(),
    };
    outputs.commit()?;
    terminal.answer(&answer);
    complaints.iter().for_each(|complaint| terminal.complain(complaint));
    made.refused.iter().for_each(|path| terminal.complain(&refusal(path, "not exported", "export")));
    Ok(if made.verdict == Verdict::Fail { ExitCode::CheckFailed } else { ExitCode::Done })
}

/// What an export writes, and what its answer says of it.
struct Made {
    inputs: Vec<Named>,
    files: Vec<(PathBuf, ExportedFile)>,
    /// The worst of what the files record of their verification. Nothing is verified here.
    verdict: Verdict,
    /// Files for whose sake nothing is written.
    refused: Vec<PathBuf>,
    units: Option<String>,
    /// The first line of the answer in text.
    what: String,
    /// The key of the document that says what was exported, and its value.
    source: (&'static str, Value),
    notes: Vec<String>,
}

fn of_file(command: &ExportCommand, path: &Path) -> Result<Made> {
    let (superelement, _) = input::superelement(path)?;
    let metadata = superelement.metadata();
    let verdict = metadata.verification.verdict;
    let is_refused = command.unverified.refuses(verdict);
    let files = if is_refused { Vec::new() } else { files_of(command, path, &superelement)? };
    let mut inputs = vec![("the superelement", path.to_owned())];
    inputs.extend(of_models(&files, [&superelement]));
    let sealed = superelement.to_bytes().map_err(|error| Error::of_superelement(path, error))?;
    Ok(Made {
        inputs,
        files,
        verdict,
        refused: if is_refused { vec![path.to_owned()] } else { Vec::new() },
        units: metadata.units.clone(),
        what: format!("{}: {}, as recorded when it was made", shown(path), recorded(verdict)),
        source: ("superelement", json!({ "path": path, "blake3": sealed.digest })),
        notes: metadata.validity.assumptions.iter().map(|sentence| format!("takes for granted: {sentence}")).collect(),
    })
}

/// The files of a superelement and where they go. Their names stand in the answer and in one another, which are UTF-8.
fn files_of(command: &ExportCommand, path: &Path, superelement: &Superelement) -> Result<Vec<(PathBuf, ExportedFile)>> {
    path.to_str().ok_or_else(|| Error::NameNotText { key: "FILE", path: path.to_owned() })?;
    let names = names(command)?;
    Ok(placed(&names, command.format.files(superelement, &names)?))
}

fn of_assembly(command: &ExportCommand, parts: &AssemblyCommand, kept: &[String]) -> Result<Made> {
    let paths = || parts.components.iter().map(|(_, path)| path);
    let mut read = Files::read(parts)?;
    let digests = std::mem::take(&mut read.digests);
    let verdicts: Vec<Verdict> = read.verdicts().collect();
    let refused = paths().zip(&verdicts).filter(|(_, verdict)| command.unverified.refuses(**verdict));
    let refused: Vec<PathBuf> = refused.map(|(path, _)| path.clone()).collect();
    let verdict = Verdict::worst(verdicts);
    let assembly = read.assembled(parts)?;
    let joined = Joined::new(&assembly, kept)?;
    let names = names(command)?;
    let files = command.format.files_of_joined(&joined, &names).ok_or_else(|| Error::FlagText {
        flag: "--to",
        text: command.format.name().to_owned(),
        expected: "matrix-market, in which an assembly is a model",
    })?;
    let files = if refused.is_empty() { placed(&names, files) } else { Vec::new() };
    let mut inputs: Vec<Named> = paths().map(|path| ("a superelement", path.clone())).collect();
    inputs.extend(of_models(&files, assembly.components.iter().map(|component| &component.superelement)));
    let called: Vec<String> = parts.components.iter().map(|(name, _)| printable(name).into_owned()).collect();
    Ok(Made {
        inputs,
        files,
        verdict,
        refused,
        units: assembly.components.iter().find_map(|component| component.superelement.metadata().units.clone()),
        what: format!("assembly of {}: {}, as recorded when they were made", called.join(", "), recorded(verdict)),
        source: ("assembly", assembly_document(parts, &assembly, &joined, &digests)),
        notes: joined.notes,
    })
}

fn assembly_document(parts: &AssemblyCommand, assembly: &Assembly, joined: &Joined, digests: &[String]) -> Value {
    let components = parts.components.iter().zip(digests);
    let components: Vec<Value> =
        components.map(|((name, path), digest)| json!({ "name": name, "path": path, "blake3": digest })).collect();
    json!({
        "components": components,
        "joints": assembly.joints,
        "held": assembly.held,
        "masses": assembly.loaded,
        "notes": joined.notes,
    })
}

/// Refuses to write beside files of another export under these names: a job of that one would take them for its own.
fn refuse_left_over(command: &ExportCommand, made: &Made) -> Result<()> {
    if made.files.is_empty() {
        return Ok(());
    }
    let names = names(command)?;
    let all = command.format.endings().iter().map(|ending| names.path(ending));
    let mut left = all.filter(|path| path.exists() && !made.files.iter().any(|(own, _)| own == path));
    match left.next() {
        Some(path) => Err(Error::ExportLeftOver { path, n_more: left.count() }),
        None => Ok(()),
    }
}

/// The names of the files of an export.
fn names(command: &ExportCommand) -> Result<Names> {
    let output = command.output.as_path();
    output.to_str().ok_or_else(|| Error::NameNotText { key: "--output", path: output.to_owned() })?;
    Ok(if output.is_dir() { Names::in_folder(output) } else { Names::starting_with(output) })
}

fn placed(names: &Names, files: Vec<ExportedFile>) -> Vec<(PathBuf, ExportedFile)> {
    files.into_iter().map(|file| (names.path(file.ending), file)).collect()
}

/// Files that superelements were reduced from, among those that would be written over. A superelement keeps no paths: the bytes tell.
fn of_models<'a>(
    files: &[(PathBuf, ExportedFile)],
    superelements: impl IntoIterator<Item = &'a Superelement>,
) -> Vec<Named> {
    let digests: BTreeSet<&str> =
        superelements.into_iter().flat_map(|file| file.metadata().inputs.values()).map(String::as_str).collect();
    let is_input = |path: &&PathBuf| {
        path.is_file() && input::digest_with_included(path).is_ok_and(|found| digests.contains(found.as_str()))
    };
    files
        .iter()
        .map(|(path, _)| path)
        .filter(is_input)
        .map(|path| ("an input of the reduction", path.clone()))
        .collect()
}

/// What a file says of its verification.
fn recorded(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "verified",
        Verdict::Warn => "verified with warnings",
        Verdict::Fail => "a check failed",
    }
}

impl Made {
    fn text(&self) -> String {
        let mut lines = vec![self.what.clone()];
        lines.extend(self.files.iter().map(|(path, file)| {
            format!("{}: {}, {}", shown(path), file.content, number::bytes(file.bytes.len() as u64))
        }));
        lines.extend(self.notes.iter().map(|note| format!("note: {}", printable(note))));
        if !self.files.is_empty() {
            let label = self.units.as_ref().map(|units| format!(", {}", printable(units))).unwrap_or_default();
            lines.push(format!("numbers are in the units of the model{label}"));
        }
        lines.join("\n") + "\n"
    }

    /// `schemas/export.schema.json` describes it.
    fn document(&self, command: &ExportCommand) -> String {
        let of_file = |(path, file): &(PathBuf, ExportedFile)| {
            let digest = blake3::hash(&file.bytes).to_hex().to_string();
            json!({ "path": path, "content": file.content, "bytes": file.bytes.len(), "blake3": digest })
        };
        let files: Vec<Value> = self.files.iter().map(of_file).collect();
        let (key, source) = &self.source;
        value_text(&json!({
            "format_version": 1,
            "generator": { "name": env!("CARGO_PKG_NAME"), "version": env!("CARGO_PKG_VERSION") },
            (*key): source,
            "verdict": self.verdict,
            "units": self.units,
            "format": command.format.name(),
            "files": files,
        }))
    }
}

fn shown(path: &Path) -> String {
    printable(&path.display().to_string()).into_owned()
}
