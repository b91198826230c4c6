//! The plan of a run: the job as its scene needs it, and what each rule decides.

use std::borrow::Cow;
use std::collections::BTreeSet;

use supel_runtime::Flag;

use super::facts::Facts;
use super::rule::{Decision, Kind, RuleId};
use super::rules;
use super::scene::Scene;
use super::table::RULES;
use crate::job::{Certify, Job, ModeSelection, ModesJob, SceneJob};

/// What a run does.
#[derive(Clone, Debug)]
pub struct Plan {
    given: Job,
    job: Job,
    /// What the scene says of interface dofs, as far as this run heeds it.
    statements: Option<SceneJob>,
    facts: Option<Facts>,
}

/// What a rule decides, for people and for documents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The rule.
    pub rule: RuleId,
    /// Its decision.
    pub decision: Decision,
}

impl Plan {
    /// The plan of a job, before anything is read.
    pub fn of(given: &Job) -> Self {
        let scene = Scene::of(given);
        let statements = scene.statements().filter(|stated| stated.has_statements()).map(Cow::into_owned);
        Self { given: given.clone(), job: rules::needed(&scene), statements, facts: None }
    }

    /// The plan once the model is known.
    #[must_use]
    pub fn knowing(&self, facts: Facts) -> Self {
        Self { facts: Some(facts), ..self.clone() }
    }

    /// The plan with these modes.
    #[must_use]
    pub fn keeping(&self, modes: ModeSelection) -> Self {
        let mut plan = self.clone();
        plan.job.reduction.modes = Some(modes.into());
        plan
    }

    /// The plan of a look at modes: those that are chosen of them are certified by the run that keeps them.
    #[must_use]
    pub fn uncertified(&self) -> Self {
        let mut plan = self.clone();
        plan.job.run.certify = Certify::None;
        plan
    }

    /// The plan of what a file answers that keeps so many modes: where the job leaves their number to the scene, these.
    #[must_use]
    pub fn with_modes_of_file(&self, count: usize) -> Self {
        match self.searched_hz() {
            Some(_) => self.keeping(ModeSelection::Count { count }),
            None => self.clone(),
        }
    }

    /// The band that is looked through for the fewest modes that meet what the scene accepts, in Hz; none where the job says how many.
    pub fn searched_hz(&self) -> Option<f64> {
        match (&self.given.reduction.modes, self.job.reduction.wanted()) {
            (Some(ModesJob::Accepted { .. }), ModeSelection::UpTo { up_to_hz }) => Some(up_to_hz),
            _ => None,
        }
    }

    /// The job as it was given; the superelement keeps it.
    pub fn given(&self) -> &Job {
        &self.given
    }

    /// The job as the stages do it: what the scene never asks is left out of it.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// What is known of the model.
    pub fn facts(&self) -> Option<&Facts> {
        self.facts.as_ref()
    }

    /// Whether, as far as is known of the model, it has no interface and nothing holds it.
    pub fn is_free_without_interface(&self) -> bool {
        self.facts.as_ref().is_some_and(|facts| facts.n_interface == 0 && facts.n_rigid > 0)
    }

    /// What the scene says of interface dofs, as far as this run heeds it; none where that is nothing.
    pub fn statements(&self) -> Option<&SceneJob> {
        self.statements.as_ref()
    }

    /// What the superelement takes for granted of the simulation, one sentence each: what the job states, and what the scene lets a run leave
    /// out. A superelement that is reduced again may have taken the same for granted.
    pub fn assumptions(&self) -> Vec<String> {
        let mut said = BTreeSet::new();
        let all = self.job.assumptions().into_iter().chain(rules::assumptions(&self.scene()));
        all.filter(|sentence| said.insert(sentence.clone())).collect()
    }

    /// Along what alone gravity may act, in axes of the model, zero where it may not act; none where it may act along anything.
    pub fn gravity(&self) -> Option<[f64; 3]> {
        let assumed = self.job.model.assumes.as_ref().and_then(|assumes| assumes.gravity);
        rules::gravity(&self.scene()).or(assumed)
    }

    /// Whether dofs of the component are held at rest, by the job or by its scene.
    pub fn holds_dofs(&self) -> bool {
        !self.job.fixed.is_empty() || self.statements().is_some_and(|stated| !stated.grounded.is_empty())
    }

    /// What a client of the superelement must know: what the job says, and what the scene lets a run leave out.
    pub fn flags(&self) -> BTreeSet<Flag> {
        let of_statics = (self.mass() == rules::Mass::NotAsked).then_some(Flag::StiffnessOnly);
        self.job.flags().into_iter().chain(of_statics).collect()
    }

    /// Which accelerations have a column of inertia relief.
    pub fn relief(&self) -> rules::Relief {
        rules::relief(&self.scene())
    }

    /// How parts of the interior that the interface separates are ordered for elimination.
    pub fn parting(&self) -> rules::Parting {
        rules::parting(&self.scene())
    }

    /// Whether the mass is part of what the run makes.
    pub fn mass(&self) -> rules::Mass {
        rules::mass(&self.scene())
    }

    /// Whether an eigensolver runs.
    pub fn modes(&self) -> rules::Modes {
        rules::modes(&self.scene())
    }

    /// What becomes of modes that nothing starts and nothing sees.
    pub fn unseen(&self) -> rules::Unseen {
        rules::unseen(&self.scene())
    }

    /// In which form the constraint modes are made: stored where the model is not known.
    pub fn statics(&self) -> rules::Statics {
        self.facts.as_ref().map_or(rules::Statics::Stored, |facts| rules::statics(&self.scene(), facts))
    }

    /// What every rule decides, in the order of their numbers.
    pub fn rows(&self) -> Vec<Row> {
        let scene = self.scene();
        RULES.iter().map(|rule| Row { rule: rule.id, decision: (rule.decide)(&scene, self.facts.as_ref()) }).collect()
    }

    /// What rules leave out that `skip = "nothing"` would not.
    pub fn skipped(&self) -> Vec<(RuleId, String)> {
        let is_switched = |row: &Row| matches!(RULES[row.rule as usize].kind, Kind::Omission | Kind::WithinBars);
        let words = |row: Row| match row.decision {
            Decision::LeftOut(words) => Some((row.rule, words)),
            Decision::Kept(_) | Decision::Open => None,
        };
        self.rows().into_iter().filter(is_switched).filter_map(words).collect()
    }

    /// What a rule decides.
    pub fn decision(&self, rule: RuleId) -> Decision {
        (RULES[rule as usize].decide)(&self.scene(), self.facts.as_ref())
    }

    fn scene(&self) -> Scene<'_> {
        Scene::of(&self.given)
    }
}
