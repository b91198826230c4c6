//! A generated model put through the whole program, from files to the report.

use std::fs;
use std::path::Path;

use supel::dense;
use supel::error::Error;
use supel::job::{Coupling, InterfaceJob, Job, NodeSelection, Origin};
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::verification::check::{Check, Verdict};
use supel_models::{Model, write};
use supel_runtime::Superelement;
pub(crate) use supel_testing::chain::certified::eigensolver_words as eigensolvers;
use supel_testing::pencil::{eigen, matrices};

use crate::place::{Place, supel};
use supel::cli::ExitCode;

/// What a reduction is asked for.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) model: Model,
    pub(crate) interfaces: Vec<InterfaceJob>,
    pub(crate) method: &'static str,
    pub(crate) modes: String,
    pub(crate) eigensolver: &'static str,
    /// Whether inertia-relief modes are asked for.
    pub(crate) inertia_relief: bool,
    /// What `mixed-interface` holds, as a list of the job; the first interface where it is empty, in x alone where there are nodes.
    pub(crate) held: &'static str,
    /// Further lines of the table `model`.
    pub(crate) of_model: String,
    /// Further tables of the job.
    pub(crate) tables: String,
    /// Further files by their names. Without a `V.mtx` the modes of mode acceleration are the lowest motions of the model.
    pub(crate) files: Vec<(&'static str, String)>,
}

/// Craig-Bampton's and Herting's method: modes of the held and of the free component.
pub(crate) const METHODS: [&str; 2] = ["craig-bampton", "herting"];

/// Every method there is.
pub(crate) const ALL: [&str; 7] =
    ["craig-bampton", "herting", "rubin", "macneal", "guyan", "mixed-interface", "mode-acceleration"];

/// Those that keep modes of the free component.
pub(crate) const FREE: [&str; 3] = ["herting", "rubin", "macneal"];

impl Case {
    /// A model reduced by Herting's method to six modes.
    pub(crate) fn new(model: &Model, interfaces: &[InterfaceJob]) -> Self {
        Self {
            model: model.clone(),
            interfaces: interfaces.to_vec(),
            method: "herting",
            modes: "{ count = 6 }".into(),
            eigensolver: "lanczos",
            inertia_relief: false,
            held: "",
            of_model: String::new(),
            tables: String::new(),
            files: Vec::new(),
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

    /// Makes the file with the command, has it verified by itself and against the model, and returns it.
    #[track_caller]
    pub(crate) fn verified(&self) -> Superelement {
        let place = Place::new();
        self.write(&place.path(""));
        place.write("job.toml", self.job().as_bytes());
        let (file, job) = (place.text("x.supel"), place.text("job.toml"));
        for args in [&["reduce", &job, "--quiet"][..], &["verify", &file], &["verify", &file, "--job", &job]] {
            let ended = supel(args);
            assert_eq!(ended.code, ExitCode::Done, "{}, {}: {}{}", self.method, args[0], ended.out, ended.err);
        }
        place.superelement("x.supel")
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
        self.files.iter().for_each(|(name, content)| put(name, content.clone().into_bytes()));
        if self.method == "mode-acceleration" && self.files.iter().all(|(name, _)| *name != "V.mtx") {
            put("V.mtx", motions(model, self.n_asked() + 6).into_bytes());
        }
    }

    /// How many modes are asked for.
    fn n_asked(&self) -> usize {
        let digits: String = self.modes.chars().filter(char::is_ascii_digit).collect();
        digits.parse().expect("a number of modes")
    }

    /// The lines of the table `reduction`.
    fn reduction(&self) -> String {
        let first = self.interfaces.first().map(|interface| interface.name.as_str());
        let kept = match (self.method, self.held, first) {
            ("guyan", ..) => String::new(),
            ("mode-acceleration", ..) => "modes = { file = \"V.mtx\" }\n".to_owned(),
            ("mixed-interface", "", Some(first)) if self.model.dofs.is_empty() => {
                format!("modes = {}\nheld = [{first:?}]\n", self.modes)
            }
            ("mixed-interface", "", Some(first)) => format!("modes = {}\nheld = [\"{first}.ux\"]\n", self.modes),
            ("mixed-interface", held, _) => format!("modes = {}\nheld = [{held}]\n", self.modes),
            _ => format!("modes = {}\n", self.modes),
        };
        let relief = if self.inertia_relief { "inertia_relief = true\n" } else { "" };
        format!("method = \"{}\"\n{kept}{relief}eigensolver = \"{}\"\n", self.method, self.eigensolver)
    }

    fn job(&self) -> String {
        let maps = if self.model.dofs.is_empty() { "" } else { "dofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n" };
        let mut job = format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\n{maps}{}\n[reduction]\n{}\
             [write]\nsuperelement = \"x.supel\"\n{}\n",
            self.of_model,
            self.reduction(),
            self.tables
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
            if let Origin::Point(at) = interface.origin {
                job += &format!("origin = {at:?}\n");
            }
            if let Some(dofs) = &interface.dofs {
                let names: Vec<String> = dofs.iter().map(ToString::to_string).collect();
                job += &format!("dofs = {names:?}\n");
            }
        }
        job
    }
}

/// The lowest motions of a model by dense algebra, zero modes included, as a file of modes.
pub(crate) fn motions(model: &Model, count: usize) -> String {
    let [k, m] = matrices(model);
    let trace = |a: &faer::Mat<f64>| (0..model.n).map(|i| a[(i, i)]).sum::<f64>();
    // Far below the highest eigenvalue, so that low motions keep their digits.
    let (_, shapes) = eigen(k.as_ref(), m.as_ref(), 1e-3 * trace(&k) / trace(&m));
    let columns: Vec<Vec<f64>> =
        (0..count.min(model.n)).map(|j| (0..model.n).map(|i| shapes[(i, j)]).collect()).collect();
    array(&columns)
}

/// Columns as a Matrix Market array, every double to the bit.
pub(crate) fn array(columns: &[Vec<f64>]) -> String {
    let mut text = format!("%%MatrixMarket matrix array real general\n{} {}\n", columns[0].len(), columns.len());
    columns.iter().flatten().for_each(|value| text += &format!("{value:.17e}\n"));
    text
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
