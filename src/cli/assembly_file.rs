//! The document of an assembly: which jobs make its components, and which of their interfaces are joined.

use std::io::Read;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::{Error, Result};
use crate::regular_file;

/// The longest document.
const MAX_BYTES: u64 = 1 << 24;

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
        let wrong = |line, message| Error::JobSyntax { path: path.to_owned(), line, message };
        let mut text = String::new();
        let read = regular_file::open(path)?.take(MAX_BYTES).read_to_string(&mut text);
        read.map_err(|source| Error::Read { path: path.to_owned(), source })?;
        let document: Document = toml::from_str(&text).map_err(|error| {
            let before = error.span().map(|span| &text.as_bytes()[..span.start.min(text.len())]);
            let line = before.map(|before| before.iter().filter(|byte| **byte == b'\n').count() + 1);
            wrong(line, format!("this is no assembly: {}", error.message().replace('\n', ", ")))
        })?;
        if let Some(unnamed) = document.component.iter().find(|component| component.name.is_empty()) {
            return Err(wrong(None, format!("the component of {} has an empty name", unnamed.job.display())));
        }
        let folder = std::path::absolute(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        let folder = folder.parent().unwrap_or(Path::new("")).to_owned();
        let located = |component: ComponentTable| (component.name, folder.join(component.job));
        Ok(Self { jobs: document.component.into_iter().map(located).collect(), joins: document.join })
    }
}
