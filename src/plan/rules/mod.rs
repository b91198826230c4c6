//! The decisions of the rules, by what they are about.

mod inertia;
mod interface;
mod modes;
mod proofs;
mod reuse;
mod statics;
mod unseen;

use super::scene::Scene;
use crate::job::Job;

pub(super) use inertia::{k13, k14, k15, k19, k27, k28};
pub(super) use interface::{k6, k7, k8, k9, k10, k21, k22};
pub(super) use modes::{k3, k4, k5, k11, k12};
pub(super) use proofs::{k25, k26, k29, k30};
pub(super) use reuse::{k23, k24};
pub(super) use statics::{k1, k2, k16, k17, k18};

pub use inertia::Relief;
pub(super) use inertia::{gravity, relief};
pub use interface::Parting;
pub(super) use interface::parting;
pub(super) use modes::modes;
pub use modes::{CutOff, Modes};
pub use statics::{Mass, Statics};
pub(super) use statics::{mass, statics};
pub use unseen::Unseen;
pub(super) use unseen::{k20, unseen};

/// The job as its scene needs it.
pub(super) fn needed(scene: &Scene<'_>) -> Job {
    let mut job = scene.job.clone();
    statics::leave_dynamics_out(scene, &mut job);
    modes::choose_cut_off(scene, &mut job);
    job.write.recovery = scene.recovery();
    job.reduction.inertia_relief = match relief(scene) {
        Relief::None => false,
        Relief::Every | Relief::Translations(_) => !job.reduction.method.has_inertia_relief(),
    };
    job
}

/// What the decisions take for granted of the simulation, one sentence each.
pub(super) fn assumptions(scene: &Scene<'_>) -> Vec<String> {
    let of_statics = scene.is_static().then(|| "statics is all that is asked: the component has no modes".to_owned());
    let of_modes = inertia::assumption(scene).into_iter().chain(unseen::assumption(scene));
    of_statics.into_iter().chain(interface::assumptions(scene)).chain(of_modes).collect()
}
