//! The document of an assembly: which jobs make its components, and which of their interfaces are joined.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::{Error, Result};
use crate::job::{text_of, toml_failure};

/// An assembly by its document.
#[derive(Debug)]
pub(super) struct AssemblyFile {
    /// Components by their names, with the documents of their jobs.
    pub(super) jobs: Vec<(String, PathBuf)>,
    /// Pairs of interfaces, as after `--join`.
    pub(super) joins: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    component: Vec<ComponentTable>,
    #[serde(default)]
    join: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ComponentTable {
    name: String,
    job: PathBuf,
}

impl AssemblyFile {
    /// The assembly in a document, whose paths count from its folder.
    ///
    /// # Errors
    /// A file that cannot be read; [`Error::JobSyntax`].
    pub(super) fn read(path: &Path) -> Result<Self> {
        let text = text_of(path)?;
        let document: Document =
            toml::from_str(&text).map_err(|error| toml_failure("this is no assembly: ", &error, &text, path))?;
        if let Some(unnamed) = document.component.iter().find(|component| component.name.is_empty()) {
            let message = format!("the component of {} has an empty name", unnamed.job.display());
            return Err(Error::JobSyntax { path: path.to_owned(), line: None, message });
        }
        let folder = std::path::absolute(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        let folder = folder.parent().unwrap_or(Path::new("")).to_owned();
        let located = |component: ComponentTable| (component.name, folder.join(component.job));
        Ok(Self { jobs: document.component.into_iter().map(located).collect(), joins: document.join })
    }
}
