//! Coordinates: whether coordinates, dof map and stiffness belong together.
//!
//! ```text
//! C    n × 6    the six unit motions of every body about its own middle, by the dof map and the coordinates; rotations
//!               scaled to the size of the body
//! F    n × 6    K C, the forces of these motions
//! T    n × 6    |K||C|, the terms that the forces are sums of
//! ```
//! Elements store no energy in rigid-body motion, so that a row of K which no support touches shows no force under any of
//! the six motions. Translations need the dof map alone and tell which rows supports touch; rotations need the coordinates
//! too and must vanish on all other rows.
//!
//! K is examined as it was read, before rigid patches are applied. A patch ties its nodes by their coordinates, even when
//! these are wrong. Wrong coordinates make the component stiffer, and then a motion that they do not explain no longer shows
//! as one without energy.
//!
//! Three things can be wrong, and the zero modes of K tell which:
//!
//! - There are more motions without energy than the coordinates explain. Coordinates or dof map belong to another model.
//! - There are as many, with free translations and held rotations. No solid has such supports.
//! - Motions cost hardly anything. The coordinates are rounded; they are corrected with the motions that K knows.
//!
//! What a motion by coordinates costs below zero none of them explains: `below_zero` asks for a negative spring.
//!
//! K of a preloaded state answers rotations with its internal forces as they turn; `preload` compares them, and nothing is mended.
//!
//! Axes that the job gives for nodes to few digits make forces at these nodes, within what the digits leave open: `axis_digits` refuses
//! them.
//!
//! Local frames at a few nodes look like supports to K, and `local_frames` tells them apart where no support is near. Next to one a mass
//! that couples nodes shows them, and `patch_nodes` says which nodes of patches nothing confirms there.

mod axis_digits;
mod below_zero;
mod doubt;
mod free;
mod judgement;
mod local_frames;
mod mass;
mod mended;
mod motions;
mod nodes;
mod passing;
mod patch_nodes;
mod preload;
mod rounded_axes;
mod zeros;

use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::job::Mechanisms;
use crate::model::{CoordinateFit, Finding, Model, Supports};
use crate::partition::TiedNodes;

use motions::Motions;
use nodes::Nodes;

/// What a report says of a preloaded state; nothing of any other.
pub fn remark(model: &Model) -> Option<&'static str> {
    model.fit.is_preloaded().then_some(
        "the stiffness is the tangent of a preloaded state: translations are free, and rotations turn the internal forces, as was confirmed \
         at every node to 1 % of the largest force",
    )
}

/// Compares the coordinates and the dof map of a model with its stiffness; `held` lists rotations that the job says to be
/// held by supports although no translation is, `tied` the nodes that patches tie by their coordinates.
///
/// One product with K where nothing is in doubt. Supports cost one more factorisation, a doubt a few.
///
/// # Errors
/// [`Error::CoordinatesDoNotFit`] and [`Error::RotationsHeld`]; those of finding the zero modes of K. Of a preloaded state
/// [`Error::PreloadCoordinates`], [`Error::PreloadHeld`], [`Error::PreloadUnbalanced`], [`Error::PreloadMisfit`], [`Error::PreloadNone`]
/// and [`Error::PreloadTied`].
pub fn compared(model: Model, (held, mechanisms): (&[Direction], Mechanisms), tied: &TiedNodes) -> Result<Model> {
    let Some(sites) = model.sites() else {
        return if model.internal_forces.is_some() { Err(Error::PreloadCoordinates) } else { Ok(model) };
    };
    let motions = Motions::of(&model, &sites);
    let nodes = Nodes::of_model(&motions);
    axis_digits::refuse_few_digits(&motions)?;
    local_frames::refuse_local_frames(&motions, &nodes)?;
    if let Some(forces) = &model.internal_forces {
        preload::confirmed(&motions, &nodes, forces, tied)?;
        let mut findings = model.findings.clone();
        findings.extend(mass::by_direction(&motions, &nodes));
        return Ok(Model { fit: CoordinateFit::Preloaded, supports: Supports::None, findings, ..model });
    }
    let doubts = doubt::doubts(&motions, &nodes, held);
    let fit = if doubts.is_empty() {
        CoordinateFit::Exact
    } else {
        judgement::settled(&motions, &doubts, (mechanisms, tied))?
    };
    let fit = match fit {
        CoordinateFit::Exact => judgement::with_axes_as_known(&motions, &doubts)?,
        fit => fit,
    };
    // Rotations that rounding of the coordinates alone makes costly are no supports, where every translation passes.
    let is_free = doubts.is_empty() || fit.rounded().is_some() && doubts.iter().all(|doubt| doubt.n_touched == 0);
    let supports = if is_free { Supports::None } else { Supports::Perhaps };
    let mut findings = model.findings.clone();
    let untested = match doubt::untested(&motions, &doubts) {
        None => patch_nodes::unconfirmed(&motions, &nodes, tied)?,
        all => all,
    };
    findings.extend(untested);
    findings.extend(matches!(fit, CoordinateFit::Unknown).then_some(Finding::MotionsUncounted));
    findings.extend(doubt::not_held(&motions, held));
    findings.extend(mass::by_direction(&motions, &nodes));
    Ok(Model { fit, supports, findings, ..model })
}
