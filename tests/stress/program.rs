//! A generated model put through the whole program, from files to the report.

use std::fs;
use std::path::Path;

use supel::dense;
use supel::error::Error;
use supel::job::{Coupling, InterfaceJob, Job, NodeSelection};
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::verification::check::{Check, Verdict};
use supel_models::{Model, write};
pub(crate) use supel_testing::chain::certified::eigensolver_words as eigensolvers;

/// What a reduction is asked for.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) model: Model,
    pub(crate) interfaces: Vec<InterfaceJob>,
    pub(crate) method: &'static str,
    pub(crate) modes: String,
    pub(crate) eigensolver: &'static str,
    /// Further lines of the table `model`.
    pub(crate) of_model: String,
}

/// Both methods.
pub(crate) const METHODS: [&str; 2] = ["craig-bampton", "herting"];

impl Case {
    /// A model reduced by Herting's method to six modes.
    pub(crate) fn new(model: &Model, interfaces: &[InterfaceJob]) -> Self {
        Self {
            model: model.clone(),
            interfaces: interfaces.to_vec(),
            method: "herting",
            modes: "{ count = 6 }".into(),
            eigensolver: "lanczos",
            of_model: String::new(),
        }
    }

    pub(crate) fn method(self, method: &'static str) -> Self {
        Self { method, ..self }
    }

    pub(crate) fn count(self, count: usize) -> Self {
        Self { modes: format!("{{ count = {count} }}"), ..self }
    }

    pub(crate) fn by(self, eigensolver: &'static str) -> Self {
        Self { eigensolver, ..self }
    }

    /// Runs the program on files of the model.
    pub(crate) fn run(&self) -> Result<Outcome, Error> {
        let folder = tempfile::tempdir().expect("a folder");
        self.write(folder.path());
        let path = folder.path().join("job.toml");
        let job = Job::parse(&self.job(), &path).and_then(|job| {
            job.validate()?;
            job.resolve(folder.path())
        });
        supel::reduce(&job?, Resources::default(), &mut ())
    }

    /// The outcome of a run that must not fail, without a failed check.
    #[track_caller]
    pub(crate) fn accepted(&self) -> Outcome {
        let outcome = self.run().unwrap_or_else(|error| panic!("refused: {error}"));
        let failed = lines(&outcome, Verdict::Fail);
        assert!(failed.is_empty(), "failed checks: {failed:#?}");
        outcome
    }

    /// The outcome of a run without any failed check, warned check or warning.
    #[track_caller]
    pub(crate) fn clean(&self) -> Outcome {
        let outcome = self.accepted();
        let warned = lines(&outcome, Verdict::Warn);
        assert!(warned.is_empty() && warnings(&outcome).is_empty(), "{warned:#?}{:#?}", outcome.report.body.warnings);
        outcome
    }

    /// The outcome of a run with exactly these warnings and no failed check.
    #[track_caller]
    pub(crate) fn warned(&self, codes: &[&str]) -> Outcome {
        let outcome = self.accepted();
        assert_eq!(warnings(&outcome), codes, "{:#?}", outcome.report.body.warnings);
        outcome
    }

    /// The error of a run that must be refused; its message holds all of these.
    #[track_caller]
    pub(crate) fn refused(&self, parts: &[&str]) -> Error {
        match self.run() {
            Ok(outcome) => panic!("accepted: {:?}", outcome.report.body.verdict()),
            Err(error) => {
                let message = error.to_string();
                parts.iter().for_each(|part| assert!(message.contains(part), "{part:?} is not in {message:?}"));
                error
            }
        }
    }

    fn write(&self, folder: &Path) {
        let model = &self.model;
        let put = |name: &str, content: Vec<u8>| fs::write(folder.join(name), content).expect("written");
        for (name, entries) in [("K.mtx", &model.stiffness), ("M.mtx", &model.mass)] {
            let mut bytes = Vec::new();
            write::matrix_market(&mut bytes, model.n, entries, "").expect("written");
            put(name, bytes);
        }
        let (mut dofs, mut nodes) = (Vec::new(), Vec::new());
        write::dof_map(&mut dofs, model).expect("written");
        write::nodes_csv(&mut nodes, model).expect("written");
        put("dofs.txt", dofs);
        put("nodes.csv", nodes);
    }

    fn job(&self) -> String {
        let maps = if self.model.dofs.is_empty() { "" } else { "dofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n" };
        let mut job = format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\n{maps}{}\n[reduction]\nmethod = \"{}\"\nmodes = {}\n\
             eigensolver = \"{}\"\n[write]\nsuperelement = \"x.supel\"\n",
            self.of_model, self.method, self.modes, self.eigensolver
        );
        for interface in &self.interfaces {
            let nodes = match &interface.nodes {
                NodeSelection::Labels(labels) => format!("{labels:?}"),
                NodeSelection::Rows { rows } => format!("{{ rows = {rows:?} }}"),
                // The node table knows no groups.
                NodeSelection::Group(name) => format!("{:?}", self.model.groups[name.trim_start_matches("group:")]),
                NodeSelection::Region { .. } => panic!("no region in these tests"),
            };
            let coupling = if interface.coupling == Coupling::Rigid { "rigid" } else { "direct" };
            job +=
                &format!("[[interface]]\nname = \"{}\"\nnodes = {nodes}\ncoupling = \"{coupling}\"\n", interface.name);
            if let Some(dofs) = &interface.dofs {
                let names: Vec<String> = dofs.iter().map(ToString::to_string).collect();
                job += &format!("dofs = {names:?}\n");
            }
        }
        job
    }
}

/// The codes of the warnings, in their order.
pub(crate) fn warnings(outcome: &Outcome) -> Vec<&'static str> {
    // How far a reduction suits a scene is no matter of these models.
    let warnings = outcome.report.body.warnings.iter().filter(|warning| !warning.is_of_scene());
    warnings.map(|warning| warning.code).collect()
}

/// The message of a warning.
#[track_caller]
pub(crate) fn message_of<'a>(outcome: &'a Outcome, code: &str) -> &'a str {
    let found = outcome.report.body.warnings.iter().find(|warning| warning.code == code);
    &found.unwrap_or_else(|| panic!("no {code} in {:?}", warnings(outcome))).message
}

/// Measures with this verdict, in words.
pub(crate) fn lines(outcome: &Outcome, verdict: Verdict) -> Vec<String> {
    let checks = outcome.report.body.checks.iter().filter(|check| check.verdict() == verdict);
    checks.map(|c| format!("{} {}: {:e} above {:e}, {:?}", c.id, c.name, c.value, c.limits.value(), c.worst)).collect()
}

/// The measures of an identifier.
#[track_caller]
pub(crate) fn checks<'a>(outcome: &'a Outcome, id: &str) -> Vec<&'a Check> {
    let found: Vec<&Check> = outcome.report.body.checks.iter().filter(|check| check.id == id).collect();
    assert!(!found.is_empty(), "no measure {id}");
    found
}

/// λ = ω² of the retained modes, in user units.
pub(crate) fn eigenvalues(outcome: &Outcome) -> Vec<f64> {
    outcome.superelement.tensors().frequencies.iter().map(|omega| omega * omega).collect()
}

/// The relative error bar of each λ in the report.
pub(crate) fn bars(outcome: &Outcome) -> Vec<f64> {
    let rows = outcome.report.body.reduction.modes.iter();
    // That of a frequency is half that of its square.
    rows.map(|row| 2.0 * row.error_bar_hz / row.frequency_hz).collect()
}

/// n_r as the report has it.
pub(crate) fn n_rigid(outcome: &Outcome) -> usize {
    outcome.report.body.model.rigid_body_modes.count
}

/// The largest |a/b − 1|.
#[track_caller]
pub(crate) fn worst_ratio(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "{a:?}\n{b:?}");
    a.iter().zip(b).fold(0.0, |worst, (a, b)| {
        let error = (a / b - 1.0).abs();
        if dense::worse(error, worst) { error } else { worst }
    })
}
