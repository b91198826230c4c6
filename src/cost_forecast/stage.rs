//! The stages of a run with what each costs, what needs it, and what it holds.

use super::sizes::{Proofs, Sizes};
use super::work::Work;
use crate::job::Boundary;
use crate::plan::{Mass, Modes, RuleId, Statics};

/// Solves that a probe of a condition takes, one right-hand side at a time.
const PROBES_OF_CONDITION: f64 = 10.0;
/// Motions of each interface whose static stiffness is compared.
const MOTIONS_OF_AN_INTERFACE: f64 = 6.0;

/// The stage that finds the modes.
pub(super) const MODES: &str = "modes";

/// A stage of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its name, as progress and report have it.
    pub name: &'static str,
    /// What needs it, or why it is skipped.
    pub need: Need,
    /// What it costs: nothing where it is skipped.
    pub work: Work,
}

/// Why a stage runs or does not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Need {
    /// It is needed by something.
    By(&'static str),
    /// A rule skips it.
    Skipped(RuleId),
    /// It is left out by itself, for this reason.
    LeftOut(String),
}

impl Stage {
    /// What is left out, and why.
    pub(super) fn left_out(&self) -> Option<String> {
        match &self.need {
            Need::LeftOut(why) => Some(format!("{}: {why}", self.name)),
            Need::By(_) | Need::Skipped(_) => None,
        }
    }
}

const fn stage(name: &'static str, needed_by: &'static str, work: Work) -> Stage {
    Stage { name, need: Need::By(needed_by), work }
}

/// A stage that runs unless a rule skips it.
fn stage_unless(rule: Option<RuleId>, name: &'static str, needed_by: &'static str, work: Work) -> Stage {
    match rule {
        Some(rule) => Stage { name, need: Need::Skipped(rule), work: Work::default() },
        None => stage(name, needed_by, work),
    }
}

/// The stages of a run in their order, without the comparison of what moves with the full model.
pub fn stages(sizes: &Sizes) -> Vec<Stage> {
    let of_statics = (sizes.modes == Modes::NotAsked).then_some(RuleId::K1);
    let of_proofs = |least: Proofs| of_statics.or((sizes.proofs < least).then_some(RuleId::K25));
    vec![
        stage("read", "everything", Work { text_bytes: sizes.text_bytes, ..Work::default() }),
        stage("check", "everything", sizes.passes(20.0)),
        stage("coordinates", "rigid-body modes, patches", sizes.passes(4.0) + sizes.dense(12.0, 12.0)),
        stage("partition", "the factor", ordered(sizes, 1.0) + sizes.passes(4.0)),
        stage("rigid-body modes", "the factor, K̂Û = 0", ordered(sizes, 0.4) + sizes.products(24.0)),
        stage("factor", "constraint modes, modes", sizes.factor()),
        stage("constraint modes", "K̂", constraint_modes(sizes)),
        stage_unless(of_statics, MODES, "the band", modes(sizes)),
        stage_unless(of_proofs(Proofs::Count), "certificate", "that no mode is missing", certificate(sizes)),
        stage("basis", "K̂, rows of recovery", basis(sizes)),
        stage("projection", "the superelement", projection(sizes)),
        stage_unless(of_proofs(Proofs::Intervals), "enclosures", "error bars that are proved", enclosures(sizes)),
        stage("verification", "the verdict", verification(sizes)),
        stage("preservation of statics", "the verdict", statics(sizes)),
    ]
}

/// The choice of the fewest modes that the scene accepts: a basis of all that are looked through, its projection, and these comparisons with
/// the full model.
pub(super) fn choice_of_modes(sizes: &Sizes, compared: Work) -> Stage {
    stage("choice of modes", "the errors that the scene accepts", basis(sizes) + projection(sizes) + compared)
}

/// Ordering and analysis of the pattern.
fn ordered(sizes: &Sizes, share: f64) -> Work {
    Work { pattern_entries: share * sizes.entries, ..Work::default() }
}

fn constraint_modes(sizes: &Sizes) -> Work {
    let n_b = sizes.n_interface;
    match sizes.statics {
        // The backward half of a solve for each, K̂ and its terms.
        Statics::Stored => sizes.solves(n_b) * 0.5 + sizes.products(2.0 * n_b) + sizes.dense(n_b, n_b),
        // Both halves of one, and its backward half again for the weights of the correction.
        Statics::ByFactor => sizes.solves(n_b) * 1.5 + sizes.products(2.0 * n_b),
        Statics::Condensed => sizes.solves(n_b.min(16.0)) * 0.5 + sizes.products(n_b.min(16.0)),
        Statics::Carried => sizes.products(2.0 * n_b) + sizes.dense(n_b, 2.0 * n_b),
    }
}

fn modes(sizes: &Sizes) -> Work {
    let search = sizes.eigensolution(sizes.n_modes);
    // With the interface free every solve goes through the constraint modes as well.
    let of_interface = match sizes.boundary {
        Boundary::FixedInterface => Work::default(),
        Boundary::FreeInterface | Boundary::MixedInterface => {
            sizes.dense(2.0 * sizes.n_interface, Sizes::iterated(sizes.n_modes))
        }
    };
    let counted = if sizes.is_band { sizes.count() } else { Work::default() };
    counted + sizes.factor() * sizes.n_shifts + search + of_interface
}

fn certificate(sizes: &Sizes) -> Work {
    match (sizes.proofs, sizes.is_band) {
        // The count at the end of the band serves.
        (Proofs::None, _) | (_, true) => Work::default(),
        (Proofs::Count | Proofs::Intervals, false) => sizes.count(),
    }
}

fn basis(sizes: &Sizes) -> Work {
    let n_eta = sizes.n_modes + sizes.n_answers;
    sizes.solves(sizes.n_answers) + sizes.products(2.0 * n_eta) + sizes.dense(n_eta, 2.0 * n_eta + sizes.n_interface)
}

fn projection(sizes: &Sizes) -> Work {
    let (r, n_b) = (sizes.n_reduced(), sizes.n_interface);
    let of_stiffness = sizes.products(r) + sizes.dense(r, r);
    let of_mass = match sizes.mass {
        Mass::Reduced => of_stiffness,
        Mass::NotAsked => Work::default(),
    };
    match sizes.statics {
        Statics::Stored => of_stiffness + of_mass,
        // K̂_BB is known; the factor makes and gathers the columns of M̂.
        Statics::ByFactor | Statics::Condensed | Statics::Carried => {
            let made = if sizes.mass == Mass::Reduced { sizes.solves(n_b) } else { Work::default() };
            made + of_mass + sizes.products(r - n_b) + sizes.solves(r - n_b) * 0.5
        }
    }
}

fn enclosures(sizes: &Sizes) -> Work {
    sizes.factor() + sizes.count() * 2.0 + sizes.solves(3.0 * sizes.n_modes) + sizes.products(8.0 * sizes.n_modes)
}

fn verification(sizes: &Sizes) -> Work {
    let (r, n_b) = (sizes.n_reduced(), sizes.n_interface);
    // A solve with one right-hand side reads what one of four does.
    let condition = sizes.solves(1.0) * PROBES_OF_CONDITION;
    let looked_at = if sizes.statics == Statics::Stored { n_b.min(64.0) } else { 8.0 };
    let of_statics = sizes.products(2.0 * looked_at) + sizes.dense(looked_at, n_b);
    let of_modes = sizes.products(8.0 * sizes.n_modes) + sizes.dense(sizes.n_modes, 4.0 * sizes.n_modes);
    match sizes.mass {
        Mass::NotAsked => condition + of_statics + sizes.products(12.0),
        Mass::Reduced => {
            condition + of_statics + of_modes + sizes.solves(6.0) + sizes.products(4.0 * r) + sizes.dense(r, 12.0)
        }
    }
}

fn statics(sizes: &Sizes) -> Work {
    let motions = MOTIONS_OF_AN_INTERFACE * sizes.n_interfaces;
    // Each with a step of refinement.
    sizes.solves(2.0 * motions) + sizes.products(4.0 * motions)
}
