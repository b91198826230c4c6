//! A rule: what it leaves out, why that is safe, what would notice if it were not, and how it decides.

use serde::Serialize;

use super::facts::Facts;
use super::scene::Scene;

/// The rules by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RuleId {
    /// Statics alone.
    K1,
    /// The interface stiffness alone.
    K2,
    /// Free modes of a method of held ones.
    K3,
    /// Held modes of a method of free ones.
    K4,
    /// Attachment modes.
    K5,
    /// Rigid-body modes by an eigensolver.
    K6,
    /// Rigid-body motion of a held component.
    K7,
    /// Interface dofs that nothing acts on.
    K8,
    /// Interface dofs at rest.
    K9,
    /// Interface dofs of one rigid body.
    K10,
    /// Modes above the band.
    K11,
    /// Modes below the band.
    K12,
    /// Inertia relief without gravity.
    K13,
    /// Inertia relief of other directions than that of gravity.
    K14,
    /// Answers to loads that act on the interface alone.
    K15,
    /// Rows of the basis that nobody asks for.
    K16,
    /// Storage of the constraint modes.
    K17,
    /// Digits of recovered rows.
    K18,
    /// Inertia shape integrals.
    K19,
    /// Columns that depend on others.
    K20,
    /// Coupling of parts that the interface separates.
    K21,
    /// Repeated sectors.
    K22,
    /// What an earlier run has computed.
    K23,
    /// The factor of an unchanged stiffness.
    K24,
    /// Proofs that are not asked for.
    K25,
    /// The sparse path of small models.
    K26,
    /// Products with a diagonal mass.
    K27,
    /// Damping that is not asked for.
    K28,
    /// Sorting of sorted files.
    K29,
    /// Outputs that are not asked for.
    K30,
}

impl RuleId {
    /// Its name: `K-8`.
    pub fn name(self) -> String {
        format!("K-{}", self as usize + 1)
    }
}

/// What a rule does to what is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// It changes no bit of what is kept.
    Omission,
    /// What is kept is computed in another way and agrees within its error bars.
    WithinBars,
    /// The program is built so: there is nothing to decide.
    Always,
    /// It is not done; the reason says why.
    Struck,
}

/// What a rule decides for a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Decision {
    /// Something is left out: what, in words.
    LeftOut(String),
    /// Nothing is left out: why not, in words.
    Kept(String),
    /// It depends on a model that has not been read.
    Open,
}

impl Decision {
    /// Something is left out.
    pub(super) fn left_out(words: impl Into<String>) -> Self {
        Self::LeftOut(words.into())
    }

    /// Nothing is left out.
    pub(super) fn kept(words: impl Into<String>) -> Self {
        Self::Kept(words.into())
    }
}

/// A rule of the table.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Its number.
    pub id: RuleId,
    /// What it leaves out.
    pub leaves_out: &'static str,
    /// What it does to what is kept.
    pub kind: Kind,
    /// Why that is safe, with the equation.
    pub because: &'static str,
    /// What is measured in every run in which it acts, and would be wrong if the reason did not hold.
    pub guard: &'static str,
    /// The decision, from the scene and, once it is known, the model.
    pub(super) decide: fn(&Scene<'_>, Option<&Facts>) -> Decision,
}
