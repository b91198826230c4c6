//! Where the files of an export go.

use std::path::{Path, PathBuf};

/// The names of the files of an export, which have the start in common.
#[derive(Clone, Debug)]
pub struct Names {
    start: PathBuf,
    is_folder: bool,
}

impl Names {
    /// Names that start with a path.
    pub fn starting_with(path: &Path) -> Self {
        Self { start: path.to_owned(), is_folder: false }
    }

    /// Names in a folder.
    pub fn in_folder(path: &Path) -> Self {
        Self { start: path.to_owned(), is_folder: true }
    }

    /// The file with an ending: `x.op4` for the starts `x` and `x.op4`, in a folder just `op4`.
    pub fn path(&self, ending: &str) -> PathBuf {
        if self.is_folder {
            return self.start.join(ending);
        }
        let mut name = self.start.file_name().unwrap_or_default().to_owned();
        if Path::new(&name).extension().is_none_or(|extension| extension != ending) {
            name.push(".");
            name.push(ending);
        }
        self.start.with_file_name(name)
    }

    /// Its name without folders.
    pub fn name(&self, ending: &str) -> String {
        self.path(ending).file_name().unwrap_or_default().to_string_lossy().into_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_their_start_in_common() {
        let names = Names::starting_with(Path::new("far/away/hub.v2"));
        assert_eq!(names.path("mass.mtx"), Path::new("far/away/hub.v2.mass.mtx"));
        assert_eq!(names.name("op4"), "hub.v2.op4");
        assert_eq!(Names::starting_with(Path::new("far/hub.op4")).path("op4"), Path::new("far/hub.op4"));
        assert_eq!(Names::in_folder(Path::new("far")).path("mass.mtx"), Path::new("far/mass.mtx"));
    }
}
