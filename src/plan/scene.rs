//! What the simulation will ask, gathered from all of a job.

use std::borrow::Cow;

use crate::job::{AnalysisJob, Boundary, InterfaceJob, Job, Method, ModeOrigin, RecoveryJob, SceneJob, Skip};

/// The scene of a job with what other keys say of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    pub(super) job: &'a Job,
    stated: Option<&'a SceneJob>,
}

impl<'a> Scene<'a> {
    /// The scene of a job.
    pub fn of(job: &'a Job) -> Self {
        Self { job, stated: job.scene.as_ref() }
    }

    /// What `[scene]` says, where a run may leave out what it never asks.
    pub(super) fn stated(&self) -> Option<&'a SceneJob> {
        self.stated.filter(|_| self.may_skip())
    }

    /// What the scene says of interface dofs and other parts of the mechanical problem. What is at rest or moves as a rigid body does so in
    /// every run; what nothing acts on is a coordinate where a run leaves nothing out.
    pub(super) fn statements(&self) -> Option<Cow<'a, SceneJob>> {
        self.stated.map(|stated| match self.may_skip() {
            true => Cow::Borrowed(stated),
            false => Cow::Owned(stated.with_every_dof()),
        })
    }

    /// Whether the run may leave anything out.
    pub(super) fn may_skip(&self) -> bool {
        self.job.run.skip == Skip::ByScene
    }

    /// Whether equilibrium is all that is asked.
    pub fn is_static(&self) -> bool {
        self.stated().is_some_and(|stated| stated.analysis == Some(AnalysisJob::Static))
    }

    /// The one direction in which gravity acts on the component, zero where it does not act at all; none where it may act in any.
    pub fn gravity(&self) -> Option<[f64; 3]> {
        self.stated()?.gravity?.direction()
    }

    /// Whether neither gravity nor acceleration of the whole deflects the component.
    pub fn is_without_gravity(&self) -> bool {
        self.gravity() == Some([0.0; 3])
    }

    /// Whether displacements inside the component, or what follows from them, are wanted.
    pub fn recovers(&self) -> bool {
        self.recovery().is_some() || self.job.write.quantities.is_some()
    }

    /// Whether the scene says what is looked at inside the component.
    pub(super) fn looks_at_outputs(&self) -> bool {
        self.stated().is_some_and(|stated| stated.outputs.is_some())
    }

    /// The recovery that the job asks for, otherwise that of the nodes at which its scene looks.
    pub(super) fn recovery(&self) -> Option<RecoveryJob> {
        let of_scene = || Some(self.stated?.outputs.as_ref()?.recovery());
        self.job.write.recovery.clone().or_else(of_scene)
    }

    /// Whether what is not recovered is left out because the scene names the nodes at which it looks.
    pub(super) fn looks_at_outputs_alone(&self) -> bool {
        self.stated().is_some_and(|stated| stated.outputs.is_some())
    }

    /// The end of the band, where the scene states one.
    pub(super) fn band_end_hz(&self) -> Option<f64> {
        self.stated.and_then(|stated| stated.band_hz).map(|[_, high]| high)
    }

    /// The method that the job asks for.
    pub(super) fn method(&self) -> Method {
        self.job.reduction.method
    }

    /// Whether the method computes modes, and under which boundary.
    pub(super) fn boundary_of_modes(&self) -> Option<Boundary> {
        (self.method().modes() == ModeOrigin::Computed).then(|| self.method().boundary())
    }

    /// The interfaces of the job.
    pub(super) fn interfaces(&self) -> &'a [InterfaceJob] {
        &self.job.interfaces
    }
}
