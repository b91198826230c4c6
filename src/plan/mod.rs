//! What the scene needs, and no more: which work a run does, and which it leaves out by which rule.
//!
//! ```text
//! job            → Scene      what the simulation will ask, gathered from all of the job
//! Scene, Facts   → decisions  one for each of the rules K-1 to K-30, typed, with the reason in words
//! decisions      → Plan       the job as the stages do it, what of the interface it leaves out, and a row for each rule
//! ```
//!
//! The stages read decisions here and ask no scene themselves. Rules that leave out interface dofs act only on explicit statements of the
//! scene. Every decision depends on the job and the model alone, never on the machine, so that the same input gives the same bytes.
//!
//! A rule leaves something out in one of two ways. A pure omission changes no bit of what is kept. Others change it within the error bars of
//! what is kept, because an equal answer is computed in another way. `run.skip = "nothing"` (`--no-skip`) does without any of it, so
//! that the two can be compared. It keeps dofs at rest and rigid bodies of the scene, which are part of the mechanical problem; each rule has a guard that is measured in every run in which it acts.

mod facts;
#[expect(clippy::module_inception, reason = "the plan is what the folder makes")]
mod plan;
mod rule;
mod rules;
mod scene;
mod table;

pub use facts::{Facts, Hold, MassPattern};
pub use plan::{Plan, Row};
pub use rule::{Decision, Kind, Rule, RuleId};
pub use rules::{CutOff, Mass, Modes, Parting, Relief, Statics, Unseen};
pub use scene::Scene;
pub use table::RULES;
