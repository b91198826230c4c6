//! What a superelement has that no model which is reduced again carries on.

use supel_runtime::{Flag, Superelement};

/// What a superelement has that is no part of a model which is reduced again.
pub(super) fn not_of_a_model(superelement: &Superelement) -> Vec<&'static str> {
    let tensors = superelement.tensors();
    // A job that held dofs made loads of gravity that count the mass of these. Of a preloaded component fewer motions are free.
    let is_preloaded = superelement.metadata().flags.contains(&Flag::Preloaded);
    let is_held = tensors.gravity.is_some() && superelement.n_rigid() < 6 && !is_preloaded;
    let contents = [
        ("damping", tensors.damping.is_some()),
        ("loads of gravity on the mass of held dofs", is_held),
        ("recovery", tensors.recovery.is_some()),
        ("quantities", tensors.quantities.is_some()),
        ("further matrices", !tensors.matrices.is_empty()),
    ];
    contents.into_iter().filter(|(_, is_there)| *is_there).map(|(name, _)| name).collect()
}
