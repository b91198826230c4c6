//! The component as a rigid body: mass properties by three routes, grounding, effective mass.

use serde::Serialize;

use super::MassProperties;

/// What is known of the component as a rigid body.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RigidBodyEvidence {
    /// Mass properties by independent routes.
    pub mass_routes: Vec<MassRoute>,
    /// Frequencies of the rigid-body modes of the reduced model; zero but for rounding.
    pub frequencies_hz: Vec<f64>,
    /// How far each rigid-body motion is from straining the component.
    pub grounding: Vec<Grounding>,
    /// Share of each rigid direction that each mode carries.
    pub effective_mass: Vec<EffectiveMass>,
}

/// Mass properties by one route.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MassRoute {
    /// `geometry` (node coordinates), `stiffness` (interface moved rigidly through K̂), `eigenvectors` (zero modes) or
    /// `expected` (the job).
    pub route: &'static str,
    /// What it gives.
    pub properties: MassProperties,
}

/// Strain energy of one rigid-body motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grounding {
    /// `translation x`, `rotation z`.
    pub direction: String,
    /// uᵀKu / (λ uᵀMu), λ the first elastic eigenvalue.
    pub energy_ratio: f64,
    /// max |Ku| / (|K||u|).
    pub force_ratio: f64,
    /// Node and direction of the largest force.
    pub worst: Option<String>,
}

/// Effective mass of one mode of the reduced model with its interface held.
///
/// For fixed-interface modes these are the retained modes themselves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectiveMass {
    /// Number of the mode, from one, ascending in frequency.
    pub mode: usize,
    /// Share of the inertia of the interior in each direction, in the order of [`RigidBodyEvidence::grounding`] where
    /// coordinates are known, else in that of the rigid-body modes.
    pub share: Vec<f64>,
    /// Sum of the shares up to this mode.
    pub cumulated: Vec<f64>,
}
