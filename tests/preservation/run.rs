//! Jobs on generated models, run through the library.

use std::fs;

use supel::job::{InterfaceJob, Job};
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::verification::preservation::Preservation;
use supel_models::{Material, Model, brick, write};

/// A model written to files, with its interfaces.
pub(crate) struct Files {
    folder: tempfile::TempDir,
    pub(crate) model: Model,
    pub(crate) interfaces: Vec<InterfaceJob>,
}

impl Files {
    pub(crate) fn new(model: Model, interfaces: Vec<InterfaceJob>) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let put = |name: &str, fill: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = Vec::new();
            fill(&mut bytes);
            fs::write(folder.path().join(name), bytes).expect("written");
        };
        put("K.mtx", &|bytes| write::matrix_market(bytes, model.n, &model.stiffness, "").expect("written"));
        put("M.mtx", &|bytes| write::matrix_market(bytes, model.n, &model.mass, "").expect("written"));
        put("dofs.txt", &|bytes| write::dof_map(bytes, &model).expect("written"));
        put("nodes.csv", &|bytes| write::nodes_csv(bytes, &model).expect("written"));
        Self { folder, model, interfaces }
    }

    /// The job with this method, these modes and this scene (lines of TOML).
    pub(crate) fn job(&self, method: &str, modes: &str, scene: &str) -> Job {
        self.job_of(&format!("method = \"{method}\"\nmodes = {{ {modes} }}"), scene)
    }

    /// The job with this reduction and this scene, both as lines of TOML.
    fn job_of(&self, reduction: &str, scene: &str) -> Job {
        let text = format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
             [reduction]\n{reduction}\n[scene]\n{scene}\n[write]\nsuperelement = \"x.supel\"\n"
        );
        let mut job = Job::parse(&text, "job.toml".as_ref()).expect("a job");
        job.interfaces.clone_from(&self.interfaces);
        job.model.nodes = Some("nodes.csv".into());
        // Groups are not part of a table of nodes.
        for interface in &mut job.interfaces {
            if let Some(name) = interface.nodes.group_name() {
                interface.nodes = supel::job::NodeSelection::Labels(self.model.groups[name].clone());
            }
        }
        job.validate().expect("sound");
        job.resolve(self.folder.path()).expect("a folder")
    }

    pub(crate) fn reduce(&self, method: &str, modes: &str, scene: &str) -> Outcome {
        let job = self.job(method, modes, scene);
        supel::reduce(&job, Resources::default(), &mut ()).expect("reduced")
    }

    /// What a reduction makes, given as lines of TOML.
    pub(crate) fn reduce_by(&self, reduction: &str, scene: &str) -> Outcome {
        supel::reduce(&self.job_of(reduction, scene), Resources::default(), &mut ()).expect("reduced")
    }

    pub(crate) fn preservation(&self, method: &str, modes: &str, scene: &str) -> Preservation {
        self.reduce(method, modes, scene).report.body.preservation
    }
}

/// 4 × 2 × 2 steel bricks, 135 dofs.
pub(crate) fn block() -> Model {
    brick([4, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI)
}
