//! A child process reads HDF5 input before this one does.
//!
//! The HDF5 library parses damaged metadata in C and can crash on it, which no check of ours can prevent. The child
//! runs the same readers on the same files: where it dies of a signal, the user gets an error that names the file, and
//! this process never opens it. Text is read by code of ours alone and needs no rehearsal.

use std::io::{Read, Write};
use std::process::{Command, Stdio};

use crate::error::{Error, Result};
use crate::input;
use crate::job::ModelJob;

/// The hidden subcommand of the child.
pub(super) const SUBCOMMAND: &str = "rehearse-reading";

/// Reads the files of a model in a child process, where one of them is HDF5.
///
/// An error that the child finds is not passed on: this process finds the same one.
///
/// # Errors
/// [`Error::Hdf5Crash`] where the child died of a signal; [`Error::Rehearsal`] where it could not be started.
pub(super) fn rehearse(model: &ModelJob) -> Result<()> {
    let Some(path) = input::hdf5_file(model) else { return Ok(()) };
    let ended = std::env::current_exe().and_then(|program| {
        let mut child = Command::new(program)
            .arg(SUBCOMMAND)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()?;
        // A child that dies at once closes the pipe; how it ended says more than the broken pipe.
        if let Some(mut stdin) = child.stdin.take() {
            let _ = stdin.write_all(serde_json::to_string(model)?.as_bytes());
        }
        child.wait()
    });
    match ended {
        Ok(status) if status.code().is_none() => Err(Error::Hdf5Crash { path: path.to_owned() }),
        Ok(_) => Ok(()),
        Err(source) => Err(Error::Rehearsal { source }),
    }
}

/// What the child does: reads the model whose description comes through stdin and forgets it.
///
/// # Errors
/// Those of the readers.
pub(super) fn read_from_stdin() -> Result<()> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).map_err(|source| Error::Rehearsal { source })?;
    let model: ModelJob =
        serde_json::from_str(&text).map_err(|error| Error::Rehearsal { source: std::io::Error::other(error) })?;
    input::read(&model).map(drop)
}
