//! The files that a job names, before they are read.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::allowance::Allowance;
use super::bulk_lines::included_files;
use super::member::split_member;
use super::model_files::{further_source, own_sources};
use super::{formats, hdf5_format};
use crate::job::{Job, ModelJob};

/// The file of a path that may name a place in it, as `model.h5:/V` does.
pub fn file_of(path: &Path) -> PathBuf {
    split_member(path).0
}

/// Every file of a model with what it is, those that its files refer to among them. Files that cannot be read are listed all the same.
pub fn files(model: &ModelJob) -> Vec<(&'static str, PathBuf)> {
    let mut files = vec![("the stiffness", file_of(&model.stiffness))];
    files.extend(model.mass.as_deref().map(|path| ("the mass", file_of(path))));
    files.extend(model.dofs.clone().map(|path| ("the dof map", path)));
    files.extend(model.frames.clone().map(|path| ("the axes of nodes", path)));
    files.extend(model.constraints.clone().map(|path| ("the constraints", path)));
    let decks = std::iter::once(&model.stiffness).chain(&model.mass).chain(&model.dofs);
    let included = decks.flat_map(|path| included_files(&file_of(path)));
    files.extend(included.map(|path| ("what a deck includes", path)));
    files.extend(model.internal_forces.clone().map(|path| ("the internal forces", path)));
    if let Some(nodes) = &model.nodes {
        files.push(("the nodes", nodes.clone()));
        let referenced = formats::of_nodes(nodes).map(|format| format.referenced_files(nodes)).unwrap_or_default();
        files.extend(referenced.into_iter().map(|path| ("the data of the nodes", path)));
    }
    files
}

/// Bytes of the files of K, M and the further matrices, as far as they can be read.
pub fn bytes_of_matrices(job: &Job) -> u64 {
    let further = job.matrices.iter().map(|matrix| &matrix.file);
    let files: BTreeSet<PathBuf> =
        std::iter::once(&job.model.stiffness).chain(&job.model.mass).chain(further).map(|path| file_of(path)).collect();
    files.iter().map(|file| std::fs::metadata(file).map_or(0, |file| file.len())).sum()
}

/// The first file of a job, or of results that are read in addition to it, that the HDF5 library reads, where one is.
pub fn hdf5_file(job: &Job, results: &[PathBuf]) -> Option<PathBuf> {
    let model = &job.model;
    let modes = job.reduction.modes_file().into_iter().chain(results.iter().map(PathBuf::as_path));
    let modes = modes.filter(|path| hdf5_format::has_modes(path)).map(file_of);
    let allowance = Allowance::of(None);
    let further = job.matrices.iter().map(|matrix| further_source(matrix, &allowance));
    let (stiffness, mass) = own_sources(model, &allowance);
    let matrices = std::iter::once(stiffness).chain(mass).chain(further);
    let matrices = matrices.filter(|source| formats::of_matrix(source).is_ok_and(|format| format.is_parsed_in_c()));
    let matrices = matrices.map(|source| source.file);
    let nodes = model.nodes.iter().filter(|file| formats::of_nodes(file).is_ok_and(|format| format.is_parsed_in_c()));
    matrices.chain(nodes.cloned()).chain(modes).next()
}
