//! A flexible part: its finite element files, a job for supel, and the superelement that comes out.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use supel::job::Job;
use supel::memory_forecast::Resources;
use supel::report::Observer;
use supel_models::{Model, write};
use supel_runtime::{Superelement, Verdict};

use crate::Result;

/// A finite element model and the nodes by which it is joined to others.
#[derive(Clone, Debug)]
pub struct Part {
    /// Name of its folder.
    pub name: String,
    /// The model, six dofs a node.
    pub model: Model,
    /// Labels of the nodes of each interface, in the order of the component's nodes; several move as a rigid patch.
    pub interface: Vec<Vec<i64>>,
    /// Labels of the nodes whose displacements the superelement recovers.
    pub recovered: Vec<i64>,
    /// Label of the units.
    pub units: &'static str,
    /// Free-free modes that the superelement keeps, from which the modes of every variant are taken.
    pub n_modes: usize,
}

impl Part {
    /// Writes `stiffness.mtx`, `mass.mtx`, `nodes.csv`, `model.dof` and `job.toml` into a folder and returns the job's path.
    ///
    /// # Errors
    /// The folder cannot be made or a file not be written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf> {
        fs::create_dir_all(folder)?;
        let file = |name: &str| -> Result<_> { Ok(BufWriter::new(File::create(folder.join(name))?)) };
        for (name, entries) in [("stiffness.mtx", &self.model.stiffness), ("mass.mtx", &self.model.mass)] {
            let mut out = file(name)?;
            write::matrix_market(&mut out, self.model.n, entries, &format!("{}; {}", self.name, self.units))?;
            out.flush()?;
        }
        write::nodes_csv(&mut file("nodes.csv")?, &self.model)?;
        write::dof_map(&mut file("model.dof")?, &self.model)?;
        let job = folder.join("job.toml");
        fs::write(&job, self.job())?;
        Ok(job)
    }

    fn job(&self) -> String {
        let interface = |(number, labels): (usize, &Vec<i64>)| {
            let coupling = if labels.len() > 1 { "rigid" } else { "direct" };
            format!("[[interface]]\nname = \"{}\"\nnodes = {labels:?}\ncoupling = \"{coupling}\"\n\n", number + 1)
        };
        let recovery = match self.recovered.as_slice() {
            [] => String::new(),
            labels => format!("recovery = {{ nodes = {labels:?} }}\n"),
        };
        format!(
            "[model]\nstiffness = \"stiffness.mtx\"\nmass      = \"mass.mtx\"\nnodes     = \"nodes.csv\"\n\
             dofs      = \"model.dof\"\nunits     = \"{}\"\n\n{}[reduction]\nmethod = \"herting\"\n\
             modes  = {{ count = {} }}\n\n[write]\nsuperelement = \"part.supel\"\n{recovery}",
            self.units,
            self.interface.iter().enumerate().map(interface).collect::<String>(),
            self.n_modes,
        )
    }
}

/// The superelement of a job, by the library; nothing but the model's files is touched.
///
/// # Errors
/// The errors of supel; a verification that did not pass.
pub fn reduced(job: &Path) -> Result<Superelement> {
    struct Silent;
    impl Observer for Silent {
        fn stage(&mut self, _: &'static str) {}
    }
    let superelement = supel::reduce(&Job::read(job)?, Resources::default(), &mut Silent)?.superelement;
    let verification = &superelement.metadata().verification;
    if verification.verdict == Verdict::Fail {
        let failed = verification.checks.iter().filter(|check| check.verdict == Verdict::Fail);
        let names: Vec<&str> = failed.map(|check| check.id.as_str()).collect();
        return Err(format!("{}: verification failed: {}", job.display(), names.join(", ")).into());
    }
    Ok(superelement)
}

/// The superelement of a job, by the program `supel reduce` and the file that it writes.
///
/// # Errors
/// The program cannot be started or fails; its file cannot be read.
pub fn reduced_by_command(program: &Path, job: &Path) -> Result<Superelement> {
    let output = Command::new(program).arg("reduce").arg(job).arg("--force").output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{} reduce {}: {}: {said}", program.display(), job.display(), output.status).into());
    }
    Ok(Superelement::open(&Job::read(job)?.write.superelement)?)
}

/// The superelements of parts, reduced in folders of their names.
///
/// # Errors
/// The errors of writing the files and of supel.
pub fn reduced_parts(parts: &[Part], folder: &Path) -> Result<Vec<Superelement>> {
    parts.iter().map(|part| reduced(&part.write(&folder.join(&part.name))?)).collect()
}
