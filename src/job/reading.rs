//! A job from its document: read, checked, its paths resolved.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use supel_runtime::{Flag, MatrixKind};

use super::accept::AcceptJob;
use super::analysis::AnalysisJob;
use super::damping::{ComponentDampingJob, RigidMotionDamping};
use super::gravity::GravityJob;
use super::location::Holder;
use super::mechanisms::Mechanisms;
use super::reduction::ModesJob;
use super::run::{Certify, Skip};
use super::scene::SceneJob;
use super::types::{ConstraintsToGround, Job, ModelJob, ModelState};
use super::{document, validation};
use crate::error::{Error, Result};

impl Job {
    /// The job in the document at `path`, checked, its paths made absolute.
    ///
    /// # Errors
    ///
    /// [`Error::Read`] where there is no such file, [`Error::NotAFile`] for a folder or a pipe, and everything that [`Job::parse`] and [`Job::validate`] find.
    pub fn read(path: &Path) -> Result<Self> {
        Self::read_and_remark(path).map(|(job, _)| job)
    }

    /// The job in the document at `path` as [`Job::read`] gives it, and what is to be said of the folder from which its paths count.
    ///
    /// # Errors
    ///
    /// The errors of [`Job::read`].
    pub fn read_and_remark(path: &Path) -> Result<(Self, Option<String>)> {
        let job = Self::parse(&document::text_of(path)?, path)?;
        job.validate()?;
        job.located(path, Holder::Document)
    }

    /// The job written in `text`; `path` decides between TOML and JSON and appears in messages.
    ///
    /// # Errors
    ///
    /// [`Error::JobKey`] for a key that no job has, [`Error::JobSyntax`] for anything else that is not a job.
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        document::parse(text, path)
    }

    /// Checks the values: ranges, names, selections, names of outputs.
    ///
    /// # Errors
    ///
    /// The first mistake found, in the order of the document.
    pub fn validate(&self) -> Result<()> {
        validation::validate(self)
    }

    /// What the job takes for granted of the simulation, one sentence each.
    pub fn assumptions(&self) -> Vec<String> {
        let held = self.fixed.iter().enumerate().map(|(index, fixed)| fixed.assumption(index));
        let resisted = (self.has_damping() && self.rigid_motion() == RigidMotionDamping::Resist)
            .then(|| "damping may resist rigid-body motion of the component".to_owned());
        let grounded = (self.model.constraints_to_ground == ConstraintsToGround::Accept)
            .then(|| "constraints may hold the component to the ground".to_owned());
        let preloaded = (self.model.state == ModelState::Preloaded).then(|| {
            "the component stays near the preloaded state of its stiffness and turns by small angles".to_owned()
        });
        let loose = (self.model.mechanisms == Mechanisms::Accept)
            .then(|| "parts of the component may move without strain beyond rigid-body motion".to_owned());
        let of_model = self.model.assumes.iter().flat_map(|assumes| assumes.sentences.iter().cloned());
        of_model.chain(held).chain(resisted).chain(grounded).chain(loose).chain(preloaded).collect()
    }

    /// What the job says that a client of the superelement must know.
    pub fn flags(&self) -> BTreeSet<Flag> {
        (self.model.state == ModelState::Preloaded).then_some(Flag::Preloaded).into_iter().collect()
    }

    /// Whether the superelement has damping: that of matrices, or one that is made from the reduced ones.
    pub fn has_damping(&self) -> bool {
        let has_law = self.damping.as_ref().is_some_and(ComponentDampingJob::has_law);
        has_law || self.matrices.iter().any(|matrix| matrix.kind == MatrixKind::Damping)
    }

    /// What becomes of damping that resists rigid-body motion.
    pub fn rigid_motion(&self) -> RigidMotionDamping {
        self.damping.as_ref().map_or_else(RigidMotionDamping::default, |damping| damping.rigid_motion)
    }

    /// Whether nothing that is asked depends on the mass: statics of an unloaded state, without gravity, loads of inertia or a mass to be
    /// compared.
    pub fn does_without_mass(&self) -> bool {
        let is_static = |scene: &&SceneJob| scene.analysis == Some(AnalysisJob::Static);
        let is_still = |scene: &SceneJob| scene.gravity == Some(GravityJob::Anywhere(false));
        let has_inertia_loads = self.loads.iter().any(|load| load.rotation.is_some());
        self.scene.as_ref().filter(is_static).is_some_and(is_still)
            && self.run.skip == Skip::ByScene
            && !has_inertia_loads
            && self.added_masses.is_empty()
            && self.model.expect.is_none()
            && self.model.state == ModelState::Unloaded
    }

    /// The errors that the scene accepts; where it says nothing, of no kind.
    pub fn accepted(&self) -> AcceptJob {
        self.scene.as_ref().and_then(|scene| scene.accept).unwrap_or_default()
    }

    /// How completeness of the computed modes is certified: not at all where a file has the modes, which may leave out any others.
    pub fn certified(&self) -> Certify {
        match self.reduction.modes_file() {
            Some(_) => Certify::None,
            None => self.run.certify,
        }
    }

    /// This job with paths relative to `folder` made absolute, their folders without `..` and links: the superelement keeps the way
    /// from its own folder to the inputs, which is counted in names of folders.
    ///
    /// # Errors
    ///
    /// [`Error::Read`] where the current directory cannot be determined; [`Error::NameNotText`] where a name that the report or the
    /// superelement will keep is not UTF-8, which is known before anything is read.
    pub fn resolve(mut self, folder: &Path) -> Result<Self> {
        for (key, path) in self.paths_mut() {
            let joined = folder.join(&*path);
            let absolute = std::path::absolute(&joined).map_err(|source| Error::Read { path: joined, source })?;
            *path = in_real_folder(absolute);
            if path.to_str().is_none() {
                return Err(Error::NameNotText { key, path: path.clone() });
            }
        }
        Ok(self)
    }

    /// All paths of the job with their keys.
    pub(crate) fn paths_mut(&mut self) -> impl Iterator<Item = (&'static str, &mut PathBuf)> {
        let (model, write) = (&mut self.model, &mut self.write);
        let quantities = write.quantities.as_mut().map(|quantities| (&mut quantities.matrix, &mut quantities.names));
        let (matrix, names) = quantities.unzip();
        let modes = match &mut self.reduction.modes {
            Some(ModesJob::File { file }) => Some(file),
            Some(ModesJob::Accepted { .. } | ModesJob::Computed(_)) | None => None,
        };
        let paths = [
            ("model.stiffness", Some(&mut model.stiffness)),
            ("model.mass", model.mass.as_mut()),
            ("model.dofs", model.dofs.as_mut()),
            ("model.nodes", model.nodes.as_mut()),
            ("model.frames", model.frames.as_mut()),
            ("model.constraints", model.constraints.as_mut()),
            ("model.internal_forces", model.internal_forces.as_mut()),
            ("reduction.modes.file", modes),
            ("write.quantities.matrix", matrix),
            ("write.quantities.names", names),
            ("write.superelement", Some(&mut write.superelement)),
            ("write.report", write.report.as_mut()),
            ("write.html", write.html.as_mut()),
            ("write.junit", write.junit.as_mut()),
        ];
        let of_loads = self.loads.iter_mut().map(|load| ("load.file", load.file.as_mut()));
        let of_matrices = self.matrices.iter_mut().map(|matrix| ("matrix.file", Some(&mut matrix.file)));
        paths.into_iter().chain(of_loads).chain(of_matrices).filter_map(|(key, path)| Some((key, path?)))
    }
}

impl ModelJob {
    /// Its files by the keys of the job, which are the roles that their digests are recorded under.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, &PathBuf)> {
        let named = [
            ("stiffness", Some(&self.stiffness)),
            ("mass", self.mass.as_ref()),
            ("dofs", self.dofs.as_ref()),
            ("nodes", self.nodes.as_ref()),
            ("frames", self.frames.as_ref()),
            ("constraints", self.constraints.as_ref()),
            ("internal_forces", self.internal_forces.as_ref()),
        ];
        named.into_iter().filter_map(|(role, path)| Some((role, path?)))
    }
}

/// A path with the folders that exist named as the file system knows them. The last name stays: it may be a link of its own.
fn in_real_folder(path: PathBuf) -> PathBuf {
    let real = |folder: &Path| Some(folder.canonicalize().ok()?.join(path.strip_prefix(folder).ok()?));
    path.ancestors().skip(1).find_map(real).unwrap_or_else(|| path.clone())
}
