//! The folder from which the paths of a job count, where its file was reached through a link.
//!
//! A document is written by a person, who may link one job into the folders of several models: the folder of the link goes first. The
//! paths in a superelement were written by the program, counted from the folder of the file itself: that goes first. Where the inputs are not
//! there and all are in the other folder, that one is taken.

use std::path::{Path, PathBuf};

use super::types::Job;
use crate::error::Result;
use crate::linked;

/// What holds a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holder {
    /// A document.
    Document,
    /// A superelement.
    Superelement,
}

impl Job {
    /// This job of the file at `path` with its paths made absolute, and what is to be said where they count from another folder than
    /// that of the name `path`.
    ///
    /// # Errors
    ///
    /// The errors of [`Job::resolve`].
    pub fn located(self, path: &Path, holder: Holder) -> Result<(Self, Option<String>)> {
        let named = linked::named_folder(path);
        let Some(own) = linked::own_folder(path) else { return Ok((self.resolve(named)?, None)) };
        let is_own = match holder {
            Holder::Document => !self.has_inputs_in(named) && self.has_inputs_in(&own),
            Holder::Superelement => self.has_inputs_in(&own) || !self.has_inputs_in(named),
        };
        if !is_own {
            return Ok((self.resolve(named)?, None));
        }
        let (link, folder) = (path.display(), own.display());
        let remark =
            format!("supel: {link}: a link – the paths of its job count from the folder of the file, {folder}");
        Ok((self.resolve(&own)?, Some(remark)))
    }

    fn has_inputs_in(&self, folder: &Path) -> bool {
        let files = self.model.files().map(|(_, path)| Some(path));
        let of_loads = self.loads.iter().map(|load| load.file.as_ref());
        let of_matrices = self.matrices.iter().map(|matrix| Some(&matrix.file));
        let of_quantities = self.write.quantities.iter().flat_map(|rows| [Some(&rows.matrix), Some(&rows.names)]);
        let modes = self.reduction.modes_file().is_none_or(|path| is_there(&folder.join(path)));
        let mut named = files.chain(of_loads).chain(of_matrices).chain(of_quantities).flatten();
        modes && named.all(|path| is_there(&folder.join(path)))
    }
}

/// Whether there is such a file, or one that a group follows as in `model.h5:/K`.
fn is_there(path: &Path) -> bool {
    let without_group = || path.to_str().and_then(|text| text.rsplit_once(":/")).map(|(file, _)| PathBuf::from(file));
    path.exists() || without_group().is_some_and(|file| file.exists())
}
