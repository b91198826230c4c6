//! Which modes are computed. K-3 to K-5, K-11, K-12.

use crate::job::{Boundary, Job, ModeOrigin, ModeSelection, ModesJob};
use crate::number::quantity;
use crate::plan::facts::{Facts, Hold};
use crate::plan::rule::Decision;
use crate::plan::scene::Scene;

/// Whether an eigensolver runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modes {
    /// It finds the modes that the method keeps, and the one above them.
    Computed,
    /// Nothing that is asked depends on a mode.
    NotAsked,
}

/// Whether an eigensolver runs for a scene.
pub(in crate::plan) fn modes(scene: &Scene<'_>) -> Modes {
    if scene.is_static() { Modes::NotAsked } else { Modes::Computed }
}

/// How far above the band modes are kept where the job says no number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOff {
    /// Times the end of the band.
    pub factor: f64,
    /// Up to this frequency, in Hz.
    pub up_to_hz: f64,
}

/// Free modes are kept to this multiple of the band: the response of components measured is then right to 0.2 to 0.8 dB.
const FREE_MODES: f64 = 2.0;
/// Modes with some or all of the interface held: at four times the band their response is right to 2 to 5 dB.
const HELD_MODES: f64 = 4.0;

/// The frequency up to which modes are kept, or looked at first, where the job leaves that to the scene.
fn cut_off(scene: &Scene<'_>) -> Option<CutOff> {
    let (boundary, band_end) = (scene.boundary_of_modes()?, scene.band_end_hz()?);
    if matches!(scene.job.reduction.modes, Some(ModesJob::Computed(_) | ModesJob::File { .. })) {
        return None;
    }
    let factor = match boundary {
        Boundary::FreeInterface => FREE_MODES,
        Boundary::FixedInterface | Boundary::MixedInterface => HELD_MODES,
    };
    Some(CutOff { factor, up_to_hz: factor * band_end })
}

/// Chooses how many modes are kept where the job leaves that to the scene.
pub(super) fn choose_cut_off(scene: &Scene<'_>, job: &mut Job) {
    if job.reduction.method.modes() != ModeOrigin::Computed {
        return;
    }
    if let Some(CutOff { up_to_hz, .. }) = cut_off(scene) {
        job.reduction.modes = Some(ModeSelection::UpTo { up_to_hz }.into());
    }
}

pub(in crate::plan) fn k3(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match scene.boundary_of_modes() {
        Some(Boundary::FixedInterface) => Decision::left_out(
            "free modes, and a factor of K − σM on all dofs: the method keeps modes of the held interface",
        ),
        _ => Decision::kept("the method keeps no modes of the held interface"),
    }
}

pub(in crate::plan) fn k4(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match scene.boundary_of_modes() {
        Some(Boundary::FreeInterface) => Decision::left_out(
            "modes of the held interface, and an ordering of their own for the free ones: one factor serves both",
        ),
        _ => Decision::kept("the method keeps no free modes"),
    }
}

pub(in crate::plan) fn k5(scene: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    match (scene.method().has_attachment_modes(), facts) {
        (false, _) => Decision::kept("the method has no attachment modes"),
        (true, None) => Decision::Open,
        (true, Some(facts)) if facts.hold == Hold::Part => Decision::kept(
            "the interface leaves rigid-body motions free, where there are no constraint modes to start from",
        ),
        (true, Some(_)) => {
            Decision::left_out("attachment modes and the inverse of A_B: the space is that of Herting's method (50)")
        }
    }
}

pub(in crate::plan) fn k11(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    let is_accepted = matches!(scene.job.reduction.modes, Some(ModesJob::Accepted { .. }));
    match (cut_off(scene), scene.boundary_of_modes()) {
        (Some(_), _) if is_accepted => Decision::left_out("modes above those with which what the scene accepts is met"),
        (Some(CutOff { factor, up_to_hz }), _) => Decision::left_out(format!(
            "modes above {} Hz, {} times the end of the band",
            quantity(up_to_hz, 5),
            quantity(factor, 2)
        )),
        (None, Some(_)) => Decision::kept("the job says which modes are kept"),
        (None, None) => Decision::kept("the method computes no modes"),
    }
}

pub(in crate::plan) fn k12(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match scene.boundary_of_modes() {
        Some(_) => Decision::kept("modes below the band are kept"),
        None => Decision::kept("the method computes no modes"),
    }
}
