//! Whether the files of a job are still those whose digests an earlier reading recorded.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::bulk_lines::digest_with_included;
use super::calculix::digests_next_to;
use super::formats;
use super::named_files::file_of;
use crate::error::Result;
use crate::job::Job;

/// The role of the first file that another digest was recorded of than it has now, or that there is no record of; none where every file is
/// the one that was read. `job` is one as the stages do it, `recorded` what [`InputFacts::digests`](super::InputFacts::digests) gave then.
///
/// Files are hashed, each once, and not parsed but for what they refer to.
///
/// # Errors
/// A file that cannot be read.
pub fn changed_role(job: &Job, recorded: &BTreeMap<String, String>) -> Result<Option<String>> {
    let mut now = digests(&files_by_role(job))?;
    if let Some(nodes) = &job.model.nodes {
        let data = formats::of_nodes(nodes)?.data_digest(nodes)?;
        now.extend(data.map(|digest| (NODES_DATA.to_owned(), digest)));
    }
    // Whether these files were read depends on the map and the nodes, which are compared as well.
    if let (Some(map), Some(digest)) = (&job.model.dofs, recorded.get(DOFS_DATA))
        && digests_next_to(map)?.contains(digest)
    {
        now.insert(DOFS_DATA.to_owned(), digest.clone());
    }
    let differs = |role: &&String| now.get(*role) != recorded.get(*role);
    Ok(now.keys().chain(recorded.keys()).find(differs).cloned())
}

/// What the nodes refer to.
const NODES_DATA: &str = "nodes_data";
/// What lies next to the dof map.
const DOFS_DATA: &str = "dofs_data";

/// The files that a job names, by the roles under which their digests are recorded.
fn files_by_role(job: &Job) -> BTreeMap<String, PathBuf> {
    let of_model = job.model.files().map(|(role, path)| (role, Some(path.as_path())));
    let quantities = job.write.quantities.as_ref();
    let others = [
        ("modes", job.reduction.modes_file()),
        ("quantities", quantities.map(|rows| rows.matrix.as_path())),
        ("quantity_names", quantities.map(|rows| rows.names.as_path())),
    ];
    let named = of_model.chain(others).filter_map(|(role, path)| Some((role.to_owned(), file_of(path?))));
    let loads = job.loads.iter().filter_map(|load| Some((format!("load {}", load.name), load.file.clone()?)));
    let matrices = job.matrices.iter().map(|matrix| (format!("matrix {}", matrix.name), file_of(&matrix.file)));
    named.chain(loads).chain(matrices).collect()
}

/// The digests of files as they are now, those of several roles computed once.
fn digests(files: &BTreeMap<String, PathBuf>) -> Result<BTreeMap<String, String>> {
    let paths: std::collections::BTreeSet<&Path> = files.values().map(PathBuf::as_path).collect();
    let of_paths: BTreeMap<&Path, String> =
        paths.into_par_iter().map(|path| Ok((path, digest_with_included(path)?))).collect::<Result<_>>()?;
    Ok(files.iter().map(|(role, path)| (role.clone(), of_paths[path.as_path()].clone())).collect())
}
