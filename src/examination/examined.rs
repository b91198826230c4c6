//! What an examination found.

use super::culprits::{self, Grounded};
use super::ends::{self, EndFace};
use super::finding::{Finding, Severity};
use super::interfaces::{self, Candidate};
use super::retreat::{Retreat, retreat};
use super::units::{self, Sizes, UnitGuess};
use crate::dofs::Nodes;
use crate::eigen::median_ratio;
use crate::error::Error;
use crate::input::InputFacts;
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
    n_massless: Option<usize>,
    extents: Option<[f64; 3]>,
    units: Vec<UnitGuess>,
    interfaces: Vec<Candidate>,
    ends: Vec<EndFace>,
    facts: Option<InputFacts>,
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
    pub units: Vec<UnitGuess>,
    /// The groups of the mesh.
    pub interfaces: Vec<Candidate>,
    /// Flat faces at the ends of its longest extent, where no group can be an interface.
    pub ends: Vec<EndFace>,
    /// The job that was examined last, with what stages had refused left out.
    pub job: Job,
    /// What the matrices are, where they could be read.
    pub facts: Option<InputFacts>,
    /// What the lowest modes say of it, where no stage refused it.
    pub body: Option<ReportBody>,
}

impl Examination {
    /// Keeps what a stage has refused, unless that has been said before.
    pub fn refused(&mut self, finding: Finding) {
        if !self.findings.iter().any(|other| other.code == finding.code && other.what == finding.what) {
            self.findings.push(finding);
        }
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
        let masses = diagonal(&partition.mass);
        self.n_massless = Some(masses.iter().filter(|mass| **mass == 0.0).count());
        self.extents = culprits::extents(partition);
        if let (Some(extents), Some(spacing), Some(mass)) =
            (self.extents, culprits::spacing(partition), culprits::total_mass(partition))
        {
            let ratio = median_ratio(partition.free_problem()) * partition.scaling.eigenvalue_unit();
            self.units = units::guesses(Sizes { mass, extents, spacing, ratio });
        }
        self.interfaces = nodes.map_or_else(Vec::new, |nodes| interfaces::candidates(partition, nodes));
        if !self.interfaces.iter().any(Candidate::holds_all) {
            self.ends = ends::end_faces(partition);
        }
    }

    /// Ends with what the lowest modes say of the model of a job, where no stage refused it.
    pub fn ended(self, job: Job, body: Option<ReportBody>) -> Examined {
        let Self { mut findings, grounded, n_massless, extents, units, interfaces, ends, facts } = self;
        let unit = units.first().map_or("", |guess| guess.stiffness);
        findings.extend(grounded.as_ref().and_then(|grounded| held(grounded, body.as_ref(), unit)));
        findings.extend(units.first().and_then(of_units));
        if let Some(body) = &body {
            findings.extend(of_body(body));
        }
        findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
        Examined { findings, grounded, n_massless, extents, units, interfaces, ends, job, facts, body }
    }
}

impl Examined {
    /// The worst severity; none where nothing was found.
    pub fn severity(&self) -> Option<Severity> {
        self.findings.iter().map(|finding| finding.severity).max()
    }
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
                "supports hold the component: {} next to dofs that are not in the matrices, first {}",
                counted(grounded.n_touched, "row is", "rows are"),
                first.dof
            ),
            "leave the supports out of what is exported if the simulation is to move the component; hold dofs by [[fixed]] of the job then"
                .to_owned(),
        )
    };
    let lines = vec![
        "*BOUNDARY, OP=NEW           ** Abaqus, CalculiX: in the step of the export, without data lines".to_owned(),
        "DDELE, ALL, ALL             ! Ansys, before the solution that is exported".to_owned(),
    ];
    Some(Finding { severity, code: None, what, remedy, lines, went_on: None })
}

/// Units that do not go together, and frequencies that are in kHz.
fn of_units(guess: &UnitGuess) -> Option<Finding> {
    let finding = |severity, what: String, remedy: &str, lines: Vec<String>| Finding {
        severity,
        code: None,
        what,
        remedy: remedy.to_owned(),
        lines,
        went_on: None,
    };
    match (guess.is_mixed, guess.label) {
        (true, _) => Some(finding(
            Severity::Warning,
            format!(
                "density and speed of sound are those of {}: frequencies come out {}",
                guess.system, guess.frequencies
            ),
            "write both matrices in one system of units",
            Vec::new(),
        )),
        (false, Some(label)) if guess.frequencies.contains("kHz") => Some(finding(
            Severity::Remark,
            format!("the units look like {}: frequencies are {}", guess.system, guess.frequencies),
            "give --up-to-hz and bands of the job in kHz, or write the matrices with time in seconds",
            vec![format!("units = \"{label}\"          # [model] of the job")],
        )),
        _ => None,
    }
}

/// Warnings and failed checks of the reduction to the lowest modes.
fn of_body(body: &ReportBody) -> Vec<Finding> {
    let warnings = body.warnings.iter().filter(|warning| !warning.is_of_scene());
    let mut findings: Vec<Finding> = warnings.map(Finding::of_warning).collect();
    let failed = body.checks.iter().filter(|check| check.verdict() == Verdict::Fail);
    findings.extend(failed.map(Finding::of_check));
    let notes = body.model.notes.iter().map(|note| Finding {
        severity: Severity::Remark,
        code: None,
        what: note.clone(),
        remedy: String::new(),
        lines: Vec::new(),
        went_on: None,
    });
    findings.extend(notes);
    findings
}
