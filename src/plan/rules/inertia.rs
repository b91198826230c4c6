//! Loads, inertia and damping. K-13 to K-15, K-19, K-27, K-28.

use supel_runtime::RigidBodyModes;

use super::unseen::{Unseen, unseen};
use crate::job::{Method, ReductionJob};
use crate::number::{counted, quantity};
use crate::plan::facts::{Facts, MassPattern};
use crate::plan::rule::Decision;
use crate::plan::scene::Scene;

/// The accelerations of the component as a whole whose deflection has a column of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relief {
    /// None.
    None,
    /// Every rigid-body motion.
    Every,
    /// Translations along these axes of the model, where the rigid-body modes are the six unit motions; every one elsewhere.
    Translations([bool; 3]),
}

impl Relief {
    /// That of a reduction by itself, whatever a scene says.
    pub fn of_reduction(job: &ReductionJob) -> Self {
        if job.has_inertia_relief() { Self::Every } else { Self::None }
    }

    /// Numbers of the rigid-body modes that have a column, of `n_rigid` that are the six unit motions or others.
    pub fn motions(self, n_rigid: usize, modes: RigidBodyModes) -> Vec<usize> {
        match self {
            Self::None => Vec::new(),
            Self::Translations(axes) if modes == RigidBodyModes::Geometric && n_rigid == 6 => {
                (0..3).filter(|axis| axes[*axis]).collect()
            }
            Self::Every | Self::Translations(_) => (0..n_rigid).collect(),
        }
    }
}

/// Which accelerations have a column of inertia relief.
pub(in crate::plan) fn relief(scene: &Scene<'_>) -> Relief {
    let method = if scene.is_static() { Method::Guyan } else { scene.method() };
    if method.has_inertia_relief() {
        return Relief::Every;
    }
    let is_asked = match scene.is_static() {
        // Statics has the answer to gravity in K̂ and its loads; displacements inside need the column.
        true => scene.recovers(),
        false => scene.job.reduction.inertia_relief,
    };
    match (is_asked, scene.gravity()) {
        (false, _) => Relief::None,
        (true, Some(direction)) if direction == [0.0; 3] => Relief::None,
        (true, Some(direction)) => Relief::Translations(direction.map(|component| component != 0.0)),
        (true, None) if scene.is_static() => Relief::Translations([true; 3]),
        (true, None) => Relief::Every,
    }
}

/// The direction of gravity for which anything is left out: columns of inertia relief, or modes that gravity along others would start.
pub(in crate::plan) fn gravity(scene: &Scene<'_>) -> Option<[f64; 3]> {
    relieved(scene).or_else(|| scene.gravity().filter(|_| unseen(scene) == Unseen::LeftOut))
}

/// The direction of gravity for which columns of inertia relief are left out.
fn relieved(scene: &Scene<'_>) -> Option<[f64; 3]> {
    let is_asked = scene.job.reduction.inertia_relief && !scene.method().has_inertia_relief();
    scene.gravity().filter(|_| is_asked || scene.is_static())
}

/// What the columns of inertia relief that are left out take for granted.
pub(super) fn assumption(scene: &Scene<'_>) -> Option<String> {
    match relieved(scene)? {
        direction if direction == [0.0; 3] => {
            Some("neither gravity nor acceleration of the whole deflects the component".to_owned())
        }
        direction => {
            let [x, y, z] = direction.map(|component| quantity(component, 4));
            Some(format!("gravity and acceleration of the whole act along ({x}, {y}, {z}) of the model alone"))
        }
    }
}

pub(in crate::plan) fn k13(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    if !scene.is_without_gravity() {
        return Decision::kept("the scene does not say that there is no gravity");
    }
    match scene.method().has_inertia_relief() && !scene.is_static() {
        true => Decision::kept("inertia relief is part of the method (37)"),
        false => Decision::left_out("inertia relief: the scene has neither gravity nor acceleration of the whole"),
    }
}

pub(in crate::plan) fn k14(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match (relief(scene), scene.gravity()) {
        (Relief::Translations(axes), Some(_)) => {
            let n_kept = axes.iter().filter(|axis| **axis).count();
            let kept = counted(n_kept, "translation", "translations");
            Decision::left_out(format!("inertia relief but that of {kept}: the scene has gravity in one direction"))
        }
        (Relief::Every, Some(_)) => Decision::kept("inertia relief is part of the method (37)"),
        (_, Some(_)) => Decision::kept("the job has no inertia relief"),
        (_, None) => Decision::kept("the scene does not say in which direction gravity acts"),
    }
}

pub(in crate::plan) fn k15(scene: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    if scene.job.loads.is_empty() {
        return Decision::kept("the job has no loads");
    }
    let Some(facts) = facts else { return Decision::Open };
    match facts.loads_inside.iter().filter(|inside| !**inside).count() {
        0 => Decision::kept("every load acts inside"),
        n => Decision::left_out(format!(
            "the answer to {}: they act on the interface alone",
            counted(n, "load", "loads")
        )),
    }
}

pub(in crate::plan) fn k19(_: &Scene<'_>, _: Option<&Facts>) -> Decision {
    Decision::left_out("inertia shape integrals of floating frames: K̂, M̂ and Û are all that the motion formalism takes")
}

pub(in crate::plan) fn k27(_: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    match facts {
        None => Decision::Open,
        Some(facts) if facts.mass == MassPattern::Diagonal => {
            Decision::left_out("all of the product with M but its diagonal: M has nothing else")
        }
        Some(_) => Decision::kept("M couples dofs"),
    }
}

pub(in crate::plan) fn k28(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match (scene.job.has_damping(), scene.is_static()) {
        (false, _) => Decision::left_out("the damping matrix: the job asks for none"),
        (true, true) => Decision::left_out("the damping matrix: statics has no velocities"),
        (true, false) => Decision::kept("the job asks for damping"),
    }
}
