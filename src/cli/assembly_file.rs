//! The document of an assembly: which jobs make its components, and which of their interfaces are joined.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::{Error, Result};
use crate::job::{text_of, toml_failure};

/// An assembly by its document.
#[derive(Debug)]
pub struct AssemblyFile {
    /// Components by their names, with the documents of their jobs.
    pub jobs: Vec<(String, PathBuf)>,
    /// Pairs of interfaces, as after `--join`.
    pub joins: Vec<String>,
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
    pub fn read(path: &Path) -> Result<Self> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A document cut anywhere or with a byte changed is an assembly or an error that names the file, and a cut one lacks something.
    #[test]
    fn damaged_documents_are_refused_by_name() {
        const TEXT: &str = "join = [\"a.left=b.right\"]\n[[component]]\nname = \"a\"\njob = \"a.toml\"\n";
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("assembly.toml");
        let read = |content: &[u8]| {
            std::fs::write(&path, content).expect("written");
            AssemblyFile::read(&path).map_err(|error| error.to_string())
        };
        assert_eq!(read(TEXT.as_bytes()).expect("an assembly").joins, ["a.left=b.right"]);
        for end in 0..TEXT.len() - 1 {
            let said = read(&TEXT.as_bytes()[..end]).expect_err("a part of it");
            assert!(said.contains("assembly.toml"), "{end}: {said}");
        }
        for (at, byte) in (0..TEXT.len()).flat_map(|at| [b'"', b'[', 0, 0xff, b'\n', b'='].map(|byte| (at, byte))) {
            let mut changed = TEXT.as_bytes().to_vec();
            changed[at] = byte;
            if let Err(said) = read(&changed) {
                assert!(said.contains("assembly.toml"), "{at}: {said}");
            }
        }
    }
}
