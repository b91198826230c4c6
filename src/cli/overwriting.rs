//! Outputs that would be written over an input or over each other. Files are compared, not their names.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::input;
use crate::job::{Job, WriteJob};

/// A file that a command reads or writes, with what messages call it: its role as an input, its key or flag as an output.
pub(super) type Named = (&'static str, PathBuf);

/// The outputs of a command, each a file of its own. Nothing is written without one, so that every command that writes has asked.
pub(super) struct OwnFiles(Vec<PathBuf>);

impl OwnFiles {
    /// The outputs of a command that reads `inputs`, in the order in which they get their names.
    ///
    /// # Errors
    /// [`Error::OutputIsInput`], [`Error::OutputTwice`].
    pub(super) fn of(inputs: &[Named], outputs: &[Named]) -> Result<Self> {
        refuse(&roles(inputs, ""), &keys(outputs, ""))?;
        Ok(Self(outputs.iter().map(|(_, path)| path.clone()).collect()))
    }

    /// Where they are, in the order in which they get their names.
    pub(super) fn paths(&self) -> &[PathBuf] {
        &self.0
    }
}

/// Refuses jobs of which one writes what another one, or itself, reads or writes. Each comes with the name of its document.
///
/// # Errors
/// [`Error::OutputIsInput`], [`Error::OutputTwice`].
pub(super) fn refuse_shared<'a>(jobs: impl Iterator<Item = (&'a Path, &'a Job, Option<&'a Path>)>) -> Result<()> {
    let (mut all_inputs, mut all_outputs) = (Vec::new(), Vec::new());
    for (name, job, document) in jobs {
        let owner = format!(" of {}", name.display());
        all_inputs.extend(roles(&inputs(job, document), &owner));
        all_outputs.extend(keys(&outputs(&job.write), &owner));
    }
    refuse(&all_inputs, &all_outputs)
}

/// Inputs with their roles, and whose they are.
fn roles(inputs: &[Named], owner: &str) -> Vec<(String, PathBuf)> {
    inputs.iter().map(|(role, path)| (format!("{role}{owner}"), path.clone())).collect()
}

/// Outputs with their keys or flags as they are typed, and whose they are.
fn keys(outputs: &[Named], owner: &str) -> Vec<(String, PathBuf)> {
    outputs.iter().map(|(key, path)| (format!("`{key}`{owner}"), path.clone())).collect()
}

fn refuse(inputs: &[(String, PathBuf)], outputs: &[(String, PathBuf)]) -> Result<()> {
    let inputs: Vec<(&String, &PathBuf, Place)> =
        inputs.iter().map(|(role, path)| (role, path, Place::of(path))).collect();
    let mut earlier: Vec<(&String, Place)> = Vec::new();
    for (key, path) in outputs {
        let place = Place::of(path);
        if let Some((role, input, _)) = inputs.iter().find(|(.., input)| input.is(&place)) {
            let (role, input) = ((*role).clone(), (*input).clone());
            return Err(Error::OutputIsInput { key: key.clone(), path: path.clone(), role, input });
        }
        if let Some((other, _)) = earlier.iter().find(|(_, other)| other.is(&place)) {
            return Err(Error::OutputTwice { key: key.clone(), path: path.clone(), other: (*other).clone() });
        }
        earlier.push((key, place));
    }
    Ok(())
}

/// The files that a job reads; `document` is the job document, where there is one.
pub(super) fn inputs(job: &Job, document: Option<&Path>) -> Vec<Named> {
    let document = document.map(|path| ("the job document", path.to_owned()));
    let loads = job.loads.iter().filter_map(|load| Some(("a load", load.file.clone()?)));
    let quantities = job.write.quantities.iter();
    let quantities = quantities.flat_map(|rows| [("the quantities", &rows.matrix), ("their names", &rows.names)]);
    let quantities = quantities.map(|(role, path)| (role, path.clone()));
    let matrices = job.matrices.iter().map(|matrix| ("a further matrix", input::file_of(&matrix.file)));
    let modes = job.reduction.modes_file().map(|path| ("the modes", input::file_of(path)));
    input::files(&job.model)
        .into_iter()
        .chain(loads)
        .chain(matrices)
        .chain(modes)
        .chain(quantities)
        .chain(document)
        .collect()
}

/// The outputs of a job in the order in which they get their names: the superelement, which the others tell about, last.
pub(super) fn outputs(write: &WriteJob) -> Vec<Named> {
    let others = [
        ("write.report", Some(write.report_path())),
        ("write.html", write.html.clone()),
        ("write.junit", write.junit.clone()),
        ("write.superelement", Some(write.superelement.clone())),
    ];
    others.into_iter().filter_map(|(key, path)| Some((key, path?))).collect()
}

/// Where a path leads: the file there, and the name in its folder, which may be that of nothing yet or of a link.
struct Place {
    file: Option<Identity>,
    name: Option<(Identity, OsString)>,
}

impl Place {
    fn of(path: &Path) -> Self {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let name = identity(folder).zip(path.file_name()).map(|(folder, name)| (folder, name.to_owned()));
        Self { file: identity(path), name }
    }

    fn is(&self, other: &Self) -> bool {
        let is_same_file = self.file.is_some() && self.file == other.file;
        is_same_file || (self.name.is_some() && self.name == other.name)
    }
}

/// Device and number of a file, through links.
#[cfg(unix)]
type Identity = (u64, u64);

#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata(path).ok().map(|facts| (facts.dev(), facts.ino()))
}

/// The path without links and detours.
#[cfg(not(unix))]
type Identity = PathBuf;

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    path.canonicalize().ok()
}
