//! `supel init`: a job that is proposed of a pair of matrices.

use std::path::{Path, PathBuf};

use super::answer::Terminal;
use super::doctor::examined;
use super::exit_code::ExitCode;
use super::outputs::{Outputs, refuse_unwritable};
use super::overwriting::{self, OwnFiles};
use super::pipeline::Pipeline;
use super::subject_command::SubjectCommand;
use super::subject_flags::InitFlags;
use crate::error::{Error, Result};
use crate::examination::{N_MODES, proposal};
use crate::job::ends_in;

/// A pair of matrices that a job is to be proposed of.
#[derive(Debug)]
pub(super) struct InitCommand {
    subject: SubjectCommand,
    /// Where the job goes; to stdout where there is none.
    output: Option<PathBuf>,
}

impl InitCommand {
    /// # Errors
    /// Those of [`SubjectCommand::build`]; [`Error::OutputName`] for an output that has another ending; [`Error::OutputExists`].
    pub(super) fn build(flags: InitFlags) -> Result<Self> {
        let InitFlags { subject, rows, output } = flags;
        if let Some(path) = output.as_deref() {
            ends_in("--output", path, ".toml")?;
            if path.exists() {
                return Err(Error::OutputExists { path: path.to_owned() });
            }
        }
        Ok(Self { subject: SubjectCommand::build(subject, rows, N_MODES)?, output })
    }
}

pub(super) fn run(command: &InitCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let outputs: Vec<_> = command.output.iter().map(|path| ("--output", path.clone())).collect();
    let own = OwnFiles::of(&overwriting::inputs(&command.subject.job, None), &outputs)?;
    refuse_unwritable(&own)?;
    let examined = examined(&command.subject, pipeline, terminal)?;
    let folder = command.output.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    let folder = std::path::absolute(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let named = command.output.as_deref().unwrap_or(&command.subject.job.model.stiffness);
    let text = proposal(&examined, &folder.unwrap_or_default(), &format!("{}.supel", stem(named)));
    match &command.output {
        Some(path) => {
            let mut outputs = Outputs::new(&own);
            outputs.stage(path, text.as_bytes())?;
            outputs.commit()?;
        }
        None => terminal.answer(&text),
    }
    Ok(if examined.body.is_some() { ExitCode::Done } else { ExitCode::CheckFailed })
}

/// The name of a file up to its first dot.
fn stem(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.split(['.', ':']).find(|part| !part.is_empty()).unwrap_or("part").to_owned()
}
