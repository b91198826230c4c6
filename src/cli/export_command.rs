//! What was typed after `supel export`, checked.

use std::path::PathBuf;

use super::assembly_command::AssemblyCommand;
use super::superelement_flags::{AssemblyFlags, ExportFlags};
use super::unverified::Unverified;
use crate::error::{Error, Result};
use crate::export::Format;

/// Write a superelement in another format, or an assembly as one model.
#[derive(Debug)]
pub(super) struct ExportCommand {
    pub(super) source: Source,
    pub(super) format: &'static dyn Format,
    /// The start of the names of the files, or their folder.
    pub(super) output: PathBuf,
    pub(super) answer: ExportAnswer,
    pub(super) unverified: Unverified,
}

/// What is exported.
#[derive(Debug)]
pub(super) enum Source {
    File(PathBuf),
    Assembly {
        assembly: AssemblyCommand,
        /// Joined interfaces that remain interfaces.
        kept: Vec<String>,
    },
}

/// What `supel export` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ExportAnswer {
    Text,
    Json,
}

impl ExportCommand {
    /// # Errors
    /// [`Error::MissingFlags`] for an assembly without `--output`; [`Error::NameNotText`]; those of [`AssemblyCommand::build`].
    pub(super) fn build(flags: ExportFlags) -> Result<Self> {
        let ExportFlags { files, to, assembly, keep, output, json, allow_unverified } = flags;
        let AssemblyFlags { join, fix, mass } = &assembly;
        let is_plain = [join, fix, mass, &keep].into_iter().all(Vec::is_empty);
        let (source, output) = match files.as_slice() {
            [file] if is_plain => (Source::File(file.clone()), output.unwrap_or_else(|| file.with_extension(""))),
            files => {
                let text = |path: &PathBuf| match path.to_str() {
                    Some(text) => Ok(text.to_owned()),
                    None => Err(Error::NameNotText { key: "FILE", path: path.clone() }),
                };
                let texts: Vec<String> = files.iter().map(text).collect::<Result<_>>()?;
                let output = output.ok_or(Error::MissingFlags { flags: vec!["--output"] })?;
                (Source::Assembly { assembly: AssemblyCommand::build(&texts, assembly)?, kept: keep }, output)
            }
        };
        let answer = if json { ExportAnswer::Json } else { ExportAnswer::Text };
        Ok(Self { source, format: to, output, answer, unverified: allow_unverified.into() })
    }
}
