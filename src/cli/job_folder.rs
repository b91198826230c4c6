//! The jobs in a folder and below it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::job::text_of;

/// Tables that every job has, and of other documents hardly one.
const TABLES: [&str; 3] = ["model", "reduction", "write"];

/// The TOML documents of a folder.
#[derive(Debug, Default)]
pub(super) struct FolderJobs {
    /// Jobs by their names, which are their paths in the folder without `.toml`, in the order of these names.
    pub(super) jobs: Vec<(String, PathBuf)>,
    /// Documents that have no table of a job.
    pub(super) passed_over: Vec<PathBuf>,
}

/// Every `.toml` in a folder and in the folders below it that is a job. Hidden folders are left out, and links to folders are not followed.
///
/// # Errors
/// [`Error::Read`] where a folder cannot be read.
pub(super) fn jobs_below(folder: &Path) -> Result<FolderJobs> {
    let failed = |source| Error::Read { path: folder.to_owned(), source };
    let folder = std::path::absolute(folder).map_err(failed)?;
    let mut documents = Vec::new();
    collect(&folder, &mut documents)?;
    let name_of = |path: &Path| {
        let below = path.strip_prefix(&folder).unwrap_or(path).with_extension("");
        below.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect::<Vec<_>>().join("/")
    };
    let mut named: Vec<(String, PathBuf)> = documents.into_iter().map(|path| (name_of(&path), path)).collect();
    named.sort();
    let (jobs, others) = named.into_iter().partition(|(_, path)| may_be_job(path));
    let others: Vec<(String, PathBuf)> = others;
    Ok(FolderJobs { jobs, passed_over: others.into_iter().map(|(_, path)| path).collect() })
}

fn collect(folder: &Path, documents: &mut Vec<PathBuf>) -> Result<()> {
    let failed = |source| Error::Read { path: folder.to_owned(), source };
    for entry in fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let (kind, path) = (entry.file_type().map_err(failed)?, entry.path());
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if kind.is_dir() && !is_hidden {
            collect(&path, documents)?;
        } else if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) && !path.is_dir() {
            // A link that leads nowhere stands where a job was meant to be.
            documents.push(path);
        }
    }
    Ok(())
}

/// Whether a document is meant as a job: it has one of the tables of a job. What cannot be read as TOML is not passed over in silence.
fn may_be_job(path: &Path) -> bool {
    let Ok(text) = text_of(path) else { return true };
    let Ok(document) = text.parse::<toml::Table>() else { return true };
    TABLES.iter().any(|table| document.contains_key(*table))
}
