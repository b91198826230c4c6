//! Modes that nothing starts and nothing sees. K-20.

use crate::job::ModesJob;
use crate::number::quantity;
use crate::plan::facts::Facts;
use crate::plan::rule::Decision;
use crate::plan::scene::Scene;

/// What becomes of modes that nothing starts and nothing sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unseen {
    /// They have no coordinate.
    LeftOut,
    /// They are kept as any other.
    Kept,
}

/// Why they are kept; nothing where the scene lets them go.
fn why_kept(scene: &Scene<'_>) -> Option<&'static str> {
    let job = scene.job;
    let modal = job.damping.as_ref().and_then(|damping| damping.modal.as_ref());
    let is_chosen_by_scene = matches!(job.reduction.modes, Some(ModesJob::Accepted { .. }));
    let reasons = [
        (scene.boundary_of_modes().is_none() || scene.is_static(), "no modes are computed"),
        (!scene.may_skip(), "the job leaves nothing out"),
        (job.interfaces.is_empty(), "without an interface the modes are the model"),
        (modal.is_some_and(|modal| modal.n_named() > 0), "damping names modes by their numbers"),
        (
            !is_chosen_by_scene && !scene.looks_at_outputs(),
            "the job says which modes are kept, and its scene does not say with `outputs` what is looked at inside",
        ),
    ];
    reasons.into_iter().find(|(holds, _)| *holds).map(|(_, why)| why)
}

/// What becomes of such modes in a scene.
pub(in crate::plan) fn unseen(scene: &Scene<'_>) -> Unseen {
    if why_kept(scene).is_none() { Unseen::LeftOut } else { Unseen::Kept }
}

/// What leaving them out takes for granted: all that may act on the component, and all that is looked at in it.
pub(super) fn assumption(scene: &Scene<'_>) -> Option<String> {
    if unseen(scene) == Unseen::Kept {
        return None;
    }
    let names: Vec<&str> = scene.job.loads.iter().map(|load| load.name.as_str()).collect();
    let loads = if names.is_empty() { String::new() } else { format!(", as the loads {}", names.join(", ")) };
    let gravity = match scene.gravity() {
        None => ", as gravity".to_owned(),
        Some(direction) if direction == [0.0; 3] => String::new(),
        Some(direction) => {
            let [x, y, z] = direction.map(|component| quantity(component, 4));
            format!(", as gravity along ({x}, {y}, {z})")
        }
    };
    let looked_at = if scene.looks_at_outputs() { " and no output of the scene sees" } else { "" };
    Some(format!(
        "the component starts at rest, and forces act on it at its interface{loads}{gravity} and nowhere else: modes that none of \
         these starts{looked_at} are left out"
    ))
}

pub(in crate::plan) fn k20(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match why_kept(scene) {
        Some(why) => Decision::kept(format!("{why}; columns that others span are left out by name in any case")),
        None => Decision::left_out(
            "such modes as interface, loads and gravity do not start and outputs do not see, each by name",
        ),
    }
}
