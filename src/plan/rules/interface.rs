//! The interface and what it separates. K-6 to K-10, K-21, K-22.

use crate::job::DofUse;
use crate::number::counted;
use crate::plan::facts::Facts;
use crate::plan::rule::Decision;
use crate::plan::scene::Scene;

pub(in crate::plan) fn k6(scene: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    match facts {
        None if scene.job.model.nodes.is_none() => {
            Decision::kept("without coordinates rigid-body modes come from the matrices")
        }
        None => Decision::Open,
        Some(facts) if facts.has_geometric_modes => Decision::left_out(
            "an eigensolution of the rigid-body modes: the coordinates give them, and M-05 holds them to K",
        ),
        Some(_) => Decision::kept("rigid-body modes come from the matrices"),
    }
}

pub(in crate::plan) fn k7(_: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    match facts {
        None => Decision::Open,
        Some(facts) if facts.n_rigid == 0 => Decision::left_out(
            "rigid-body modes, inertia relief, projectors, the mass of the frame: nothing is free to move",
        ),
        Some(facts) => {
            Decision::kept(format!("{} move freely", counted(facts.n_rigid, "rigid-body motion", "rigid-body motions")))
        }
    }
}

/// How parts of the interior that the interface separates are ordered for elimination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parting {
    /// Each by itself, so that no separator is spent on what is separate.
    Apart,
    /// All at once.
    Together,
}

/// How parts of the interior are ordered.
pub(in crate::plan) fn parting(scene: &Scene<'_>) -> Parting {
    if scene.may_skip() { Parting::Apart } else { Parting::Together }
}

/// What the scene says of interfaces, as a list of names.
fn named(scene: &Scene<'_>, is_meant: impl Fn(DofUse) -> bool) -> Vec<String> {
    let Some(stated) = scene.statements() else { return Vec::new() };
    let mut names = Vec::new();
    for interface in scene.interfaces() {
        match stated.use_of_whole(scene.interfaces(), &interface.name) {
            Some(of) if is_meant(of) => names.push(interface.name.clone()),
            Some(_) => {}
            None => names.extend(
                crate::dofs::Direction::ALL
                    .into_iter()
                    .filter(|direction| {
                        is_meant(stated.use_of(scene.interfaces(), (&interface.name, Some(*direction))))
                    })
                    .map(|direction| format!("{}.{direction}", interface.name)),
            ),
        }
    }
    names
}

/// What statements about the interface take for granted.
pub(super) fn assumptions(scene: &Scene<'_>) -> Vec<String> {
    let Some(stated) = scene.statements() else { return Vec::new() };
    let of = |is_meant: fn(DofUse) -> bool, words: &str| {
        let names = named(scene, is_meant);
        (!names.is_empty()).then(|| format!("{words}: {}", names.join(", ")))
    };
    let unloaded =
        of(|of| of == DofUse::Unloaded, "nothing is connected to these interface dofs and no load acts on them");
    let grounded = of(|of| of == DofUse::Grounded, "these interface dofs are at rest");
    let carried = stated
        .prescribed
        .iter()
        .map(|carrier| format!("{} move as parts of the rigid body {}", carrier.interfaces.join(", "), carrier.name));
    let inside =
        scene.looks_at_outputs_alone().then(|| "inside the component recovered nodes alone are looked at".to_owned());
    unloaded.into_iter().chain(grounded).chain(carried).chain(inside).collect()
}

pub(in crate::plan) fn k8(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match named(scene, |of| of == DofUse::Unloaded) {
        names if names.is_empty() => {
            Decision::kept("the scene does not say that anything of the interface is unloaded")
        }
        names => Decision::left_out(format!("{} as interface dofs: nothing acts on them", names.join(", "))),
    }
}

pub(in crate::plan) fn k9(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match named(scene, |of| of == DofUse::Grounded) {
        names if names.is_empty() => Decision::kept("the scene does not say that anything of the interface is at rest"),
        names => Decision::left_out(format!("{} with their rows of K and M: they are at rest", names.join(", "))),
    }
}

pub(in crate::plan) fn k10(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match named(scene, |of| matches!(of, DofUse::Prescribed(_))) {
        names if names.is_empty() => {
            Decision::kept("the scene does not say that interfaces are parts of one rigid body")
        }
        names => Decision::left_out(format!(
            "deformation of the interface at {}: they move as parts of one rigid body",
            names.join(", ")
        )),
    }
}

pub(in crate::plan) fn k21(_: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    match facts {
        None => Decision::Open,
        Some(facts) if facts.n_parts > 1 => {
            Decision::left_out(format!("fill-in between {} parts that the interface separates", facts.n_parts))
        }
        Some(_) => Decision::kept("the interior is one part"),
    }
}

pub(in crate::plan) fn k22(_: &Scene<'_>, _: Option<&Facts>) -> Decision {
    Decision::kept("every sector is factored")
}
