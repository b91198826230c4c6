//! The files of a part, as programs read them.

use std::fs::{self, File};
use std::io::{BufWriter, Result, Write};
use std::path::Path;

use crate::model::Entry;
use crate::part::{FACES, MATERIAL, Part};
use crate::write;

/// Distance from the plane of a face up to which a node belongs to it, mm; they lie on it.
const TOLERANCE: f64 = 1e-3;

impl Part {
    /// Writes stiffness.mtx, mass.mtx, nodes.csv, model.dof, a job for supel that holds both faces as rigid patches and asks
    /// for `modes` modes, for solids a CalculiX deck without steps (model.inp), and model.json, which tells scripts what
    /// the job tells supel.
    ///
    /// # Errors
    /// The folder cannot be made or a file not be written.
    pub fn write(&self, folder: &Path, modes: usize) -> Result<()> {
        fs::create_dir_all(folder)?;
        let Self { family, model, .. } = self;
        let text =
            |name: &str| -> Result<_> { Ok(BufWriter::with_capacity(1 << 20, File::create(folder.join(name))?)) };
        let matrix = |name: &str, entries: &[Entry]| -> Result<()> {
            let mut out = text(name)?;
            write::matrix_market(&mut out, model.n, entries, &format!("{} part; N, mm, tonne, s", family.name()))?;
            out.flush()
        };
        std::thread::scope(|scope| {
            let mass = scope.spawn(|| matrix("mass.mtx", &model.mass));
            matrix("stiffness.mtx", &model.stiffness)?;
            mass.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })?;
        write::nodes_csv(&mut text("nodes.csv")?, model)?;
        write::dof_map(&mut text("model.dof")?, model)?;
        if let Some(mesh) = &self.solid {
            write::calculix(&mut text("model.inp")?, mesh, &MATERIAL, model)?;
        }
        fs::write(folder.join("job.toml"), job(self, modes))?;
        fs::write(folder.join("model.json"), facts(self, modes))
    }
}

fn job(part: &Part, modes: usize) -> String {
    let mut job = String::from(
        "[model]\nstiffness = \"stiffness.mtx\"\nmass      = \"mass.mtx\"\nnodes     = \"nodes.csv\"\n\
         dofs      = \"model.dof\"\nunits     = \"mm-t-s\"\n",
    );
    for (name, at) in FACES.iter().zip(part.faces) {
        let along = |value: f64| {
            let mut vector = [0.0; 3];
            vector[part.family.axis()] = value;
            vector
        };
        job += &format!(
            "\n[[interface]]\nname     = \"{}\"\nnodes    = {{ within = {{ plane = {{ point = {:?}, normal = {:?}, tolerance = \
             {TOLERANCE:?} }} }} }}\ncoupling = \"rigid\"\n",
            name.to_lowercase(),
            along(at),
            along(1.0),
        );
    }
    job + &format!(
        "\n[reduction]\nmethod = \"herting\"\nmodes  = {{ count = {modes} }}\n\n[write]\nsuperelement = \"part.supel\"\n"
    )
}

/// What scripts need in addition to the matrices.
fn facts(part: &Part, modes: usize) -> String {
    let Part { family, model, faces, .. } = part;
    let directions = model.n / model.nodes.len();
    format!(
        "{{\"family\": \"{}\", \"n\": {}, \"directions\": {directions}, \"axis\": {}, \"faces\": {faces:?}, \
         \"tolerance\": {TOLERANCE:?}, \"modes\": {modes}}}\n",
        family.name(),
        model.n,
        family.axis(),
    )
}
