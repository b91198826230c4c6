//! What an examination found.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::culprits::Grounded;
use super::ends::{self, EndFace};
use super::finding::{Finding, Severity};
use super::interfaces::{self, Candidate};
use super::patches::{self, SurfacePatch};
use super::retreat::{Retreat, retreat};
use super::sizes::{self, Sizes};
use super::units::{self, Units};
use crate::dofs::Nodes;
use crate::error::Error;
use crate::input::{Face, InputFacts};
use crate::job::Job;
use crate::number::{counted, quantity};
use crate::partition::Partition;
use crate::report::ReportBody;
use crate::sparse::diagonal;
use crate::verification::check::Verdict;

/// Modes that an examination looks for.
pub const N_MODES: usize = 8;

/// What is being found, stage by stage.
#[derive(Debug, Default)]
pub struct Examination {
    findings: Vec<Finding>,
    grounded: Option<Grounded>,
    apart: Option<Finding>,
    n_massless: Option<usize>,
    extents: Option<[f64; 3]>,
    units: Units,
    interfaces: Vec<Candidate>,
    ends: Vec<EndFace>,
    patches: Vec<SurfacePatch>,
    facts: Option<InputFacts>,
    /// The nodes of the job, whatever was left out since.
    given_nodes: Option<PathBuf>,
    /// The job that a stage refused first for what it refuses still.
    refused: Option<Job>,
}

/// What was found.
#[derive(Debug)]
pub struct Examined {
    /// Everything that is wrong or worth knowing, the worst first.
    pub findings: Vec<Finding>,
    /// What holds the component against translations; none where nothing is known of it.
    pub grounded: Option<Grounded>,
    /// Dofs without mass; none where nothing is known of them.
    pub n_massless: Option<usize>,
    /// Its extents along the axes.
    pub extents: Option<[f64; 3]>,
    /// The systems of units that it may be in.
    pub units: Units,
    /// The groups of the mesh.
    pub interfaces: Vec<Candidate>,
    /// Flat faces at the ends of its longest extent, where no group can be an interface.
    pub ends: Vec<EndFace>,
    /// Holes and further flat faces of its outer surface, likewise.
    pub patches: Vec<SurfacePatch>,
    /// The job that was examined last, with what stages had refused left out.
    pub job: Job,
    /// What the matrices are, where they could be read.
    pub facts: Option<InputFacts>,
    /// What the lowest modes say of it, where no stage refused it.
    pub body: Option<ReportBody>,
}

impl Examination {
    /// Of the model of a job.
    pub fn of(job: &Job) -> Self {
        Self { given_nodes: job.model.nodes.clone(), ..Self::default() }
    }

    /// Keeps why a stage has refused a job, and how it goes on; what was wrong before and still is, is said once, with all that was left out
    /// for it. Where that did not help, it went on nowhere.
    pub fn refused(&mut self, job: &Job, error: &Error, went_on: Option<&str>) {
        let finding = Finding::of_error(error, went_on);
        // Without nodes and map another name of the place is all that differs.
        let is_of_matrices = error.class().is_of_matrices();
        let is_known =
            |other: &&mut Finding| other.code == finding.code && (is_of_matrices || other.what == finding.what);
        match self.findings.iter_mut().find(is_known) {
            Some(known) => {
                known.went_on = known.went_on.take().zip(went_on).map(|(before, now)| format!("{before}, {now}"))
            }
            None => {
                self.refused = Some(job.clone());
                self.findings.push(finding);
            }
        }
    }

    /// Ends with a model that stages refuse whatever is left out of the last job: the job is the one that has all that did not matter.
    pub fn given_up(mut self, last: Job) -> Examined {
        let job = self.refused.take().unwrap_or(last);
        self.ended(job, None)
    }

    /// What to try after an error. Matrices that are exchanged either way are not tried a third time.
    pub fn retreat(&self, job: &Job, error: &Error) -> Option<Retreat> {
        let is_known = self.findings.iter().any(|finding| finding.code == Some(error.code()));
        if is_known && matches!(error, Error::Swapped { .. }) { None } else { retreat(job, error) }
    }

    /// Looks at the matrices on the dofs that move.
    pub fn look_at(&mut self, partition: &Partition, facts: &InputFacts, nodes: Option<&Nodes>) {
        self.facts = Some(facts.clone());
        self.grounded = Grounded::of(partition);
        self.apart = apart(partition);
        let masses = diagonal(&partition.mass);
        self.n_massless = Some(masses.iter().filter(|mass| **mass == 0.0).count());
        self.extents = sizes::extents(partition);
        self.units = match Sizes::of(partition) {
            Some(sizes) => match units::of(sizes) {
                Units::Guessed(guesses) if guesses.is_empty() && sizes::has_rows_without_place(partition) => {
                    Units::NoPlace
                }
                units => units,
            },
            None if self.extents.is_some() => Units::NoSpeed,
            None if self.given_nodes.is_some() => Units::LeftOut,
            None => Units::Untold,
        };
        let held = held_positions(partition, nodes);
        self.interfaces = nodes.map_or_else(Vec::new, |nodes| interfaces::candidates(partition, nodes, &held));
        if self.lacks_interfaces() {
            self.ends = ends::end_faces(partition, &held);
        }
    }

    /// Whether no group of the mesh can be an interface, so that its surface is worth a look.
    pub fn lacks_interfaces(&self) -> bool {
        !self.interfaces.iter().any(Candidate::holds_all)
    }

    /// Looks at the outer faces of the mesh.
    pub fn look_at_surface(&mut self, partition: &Partition, nodes: &Nodes, faces: &[Face]) {
        let held = held_positions(partition, Some(nodes));
        let ends = std::mem::take(&mut self.ends);
        (self.patches, self.ends) = patches::patches((partition, nodes), faces, &held, ends);
    }

    /// Ends with what the lowest modes say of the model of a job, where no stage refused it.
    pub fn ended(self, job: Job, body: Option<ReportBody>) -> Examined {
        let Self {
            mut findings,
            grounded,
            apart,
            n_massless,
            extents,
            units,
            interfaces,
            ends,
            patches,
            facts,
            given_nodes,
            ..
        } = self;
        findings.extend(apart);
        let unit = units.only().map_or("", |guess| guess.stiffness);
        findings.extend(grounded.as_ref().and_then(|grounded| held(grounded, body.as_ref(), unit)));
        findings.extend(units.finding());
        if let Some(body) = &body {
            findings.extend(of_body(body));
            findings.extend(map_unseen(&job).filter(|_| extents.is_none() && given_nodes.is_none()));
        }
        findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
        Examined { findings, grounded, n_massless, extents, units, interfaces, ends, patches, job, facts, body }
    }
}

impl Examined {
    /// The worst severity; none where nothing was found.
    pub fn severity(&self) -> Option<Severity> {
        self.findings.iter().map(|finding| finding.severity).max()
    }
}

/// Where nodes have a dof that the job or a constraint holds, as often as they have some.
fn held_positions(partition: &Partition, nodes: Option<&Nodes>) -> Vec<[f64; 3]> {
    let by_constraints: BTreeSet<i64> = partition
        .followers
        .iter()
        .filter(|follower| follower.is_held)
        .filter_map(|follower| Some(follower.dof?.node))
        .collect();
    let of_nodes = nodes.into_iter().flat_map(|nodes| nodes.labels.iter().zip(&nodes.coordinates));
    let by_constraints = of_nodes.filter(|(label, _)| by_constraints.contains(label)).map(|(_, position)| *position);
    partition.held.positions().chain(by_constraints).collect()
}

/// Rows with a stiffness and a mass of their own that are coupled with no other one, next to rows that are. A note of the model has those
/// without mass.
fn apart(partition: &Partition) -> Option<Finding> {
    let stiffness = partition.pencil().stiffness;
    let [own_stiffness, own_mass] = [&partition.stiffness, &partition.mass].map(diagonal);
    let is_apart = |row: &usize| own_stiffness[*row] != 0.0 && own_mass[*row] > 0.0 && stiffness.is_diagonal_row(*row);
    let rows: Vec<usize> = (0..stiffness.rows()).filter(is_apart).collect();
    let first = rows.first().filter(|_| rows.len() < stiffness.rows())?;
    Some(Finding {
        severity: Severity::Remark,
        code: None,
        what: format!(
            "{} coupled with no other one, the first is {}: a diagonal that stands for a condition, as some programs write it, or a spring \
             to the ground",
            counted(rows.len(), "row is", "rows are"),
            partition.name_of(*first)
        ),
        remedy: "take rows of conditions out of both matrices: with mass in them their frequencies are no modes of the component"
            .to_owned(),
        lines: Vec::new(),
        went_on: None,
    })
}

/// A dof map that nothing can be held against.
fn map_unseen(job: &Job) -> Option<Finding> {
    let map = job.model.dofs.as_ref()?;
    Some(Finding {
        severity: Severity::Remark,
        code: None,
        what: format!(
            "without nodes a map that exchanges rows cannot be seen: {} has as many rows as the matrices, and that is all that is known of it",
            map.display()
        ),
        remedy: "give the nodes, so that the stiffness is held against them row by row".to_owned(),
        lines: vec!["--nodes MESH                # or nodes = \"MESH\" in [model] of the job".to_owned()],
        went_on: None,
    })
}

/// What holds a component against translations.
fn held(grounded: &Grounded, body: Option<&ReportBody>, unit: &str) -> Option<Finding> {
    let first = grounded.culprits.first()?;
    let is_of_job = body.is_some_and(|body| body.model.held.is_some());
    if is_of_job {
        return None;
    }
    let listed: Vec<String> = grounded
        .culprits
        .iter()
        .map(|culprit| format!("{} ({})", culprit.dof, format!("{} {unit}", quantity(culprit.stiffness, 3)).trim_end()))
        .collect();
    let (severity, what, remedy) = if grounded.are_springs {
        (
            Severity::Warning,
            format!(
                "{} grounded, with the stiffness in brackets: {}",
                counted(grounded.n_touched, "dof is", "dofs are"),
                listed.join(", ")
            ),
            "a support left in the step, or a spring to the ground? Take it out of what is exported, unless it is part of the component"
                .to_owned(),
        )
    } else {
        (
            Severity::Remark,
            format!(
                "supports hold the component: translations of the whole make forces at {}, as next to dofs that are not in the stiffness, \
                 the largest at {}",
                counted(grounded.n_touched, "row", "rows"),
                first.dof
            ),
            "leave the supports out of what is exported if the simulation is to move the component, and hold dofs by [[fixed]] of the job; \
             if none are meant, entries of these rows are wrong"
                .to_owned(),
        )
    };
    let lines = vec![
        "*BOUNDARY, OP=NEW           ** Abaqus, CalculiX: in the step of the export, without data lines".to_owned(),
        "DDELE, ALL, ALL             ! Ansys, before the solution that is exported".to_owned(),
    ];
    Some(Finding { severity, code: None, what, remedy, lines, went_on: None })
}

/// Warnings and failed checks of the reduction to the lowest modes.
fn of_body(body: &ReportBody) -> Vec<Finding> {
    let warnings = body.warnings.iter().filter(|warning| !warning.is_of_scene());
    let mut findings: Vec<Finding> = warnings.map(Finding::of_warning).collect();
    let failed = body.checks.iter().filter(|check| check.verdict() == Verdict::Fail);
    findings.extend(failed.map(Finding::of_check));
    let is_told = |note: &&String| !findings.iter().any(|finding| finding.what == **note);
    let notes: Vec<Finding> = body.model.notes.iter().filter(is_told).map(|note| Finding::of_note(note)).collect();
    findings.extend(notes);
    findings
}
